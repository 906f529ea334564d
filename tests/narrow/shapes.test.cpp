// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cstdio>
#include <string>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/families.hpp"
#include "support/other_shapes.hpp"

namespace abut::test {

constexpr std::uint64_t shapes_seed = 20261125;

TEMPLATE_TEST_CASE("contacts of spheres and triangles are what they say, in each family", "", float, double) {
    using T = TestType;
    std::printf("sphere contacts: seed %llu\n", static_cast<unsigned long long>(shapes_seed));
    contact_tally total;
    for (int f = 0; f < family_count; ++f) {
        const auto of = static_cast<family>(f);
        total += check_family(std::string("sphere, ") + name_of(of), 150, [&](std::uint64_t i) {
            const auto p = make_pair<T>(shapes_seed, of, i);
            return std::pair(p.s, p.t);
        });
        total += check_family(std::string("sphere, segment, ") + name_of(of), 60, [&](std::uint64_t i) {
            const auto p = make_pair<T>(shapes_seed + 1, of, i);
            return std::pair(i % 8 == 0 ? sphere<T>{p.t.b, p.s.radius} : p.s, segment<T>{p.t.a, p.t.b});
        });
        total += check_family(std::string("spheres, ") + name_of(of), 60, [&](std::uint64_t i) {
            const auto p = make_pair<T>(shapes_seed + 2, of, i), q = make_pair<T>(shapes_seed + 3, of, i);
            const T radius = i % 3 == 0 ? T(0) : q.s.radius;
            return std::pair(p.s, sphere<T>{i % 16 == 0 ? p.s.center : i % 2 == 0 ? p.t.a : q.s.center, radius});
        });
    }
    check_total("spheres", total, 5500);
}

template <template <class> class Shape, class T>
void check_shape_families(const std::string& name) {
    contact_tally total;
    for (int f = 0; f < shape_family_count; ++f) {
        const auto of = static_cast<shape_family>(f);
        total += check_family(name + ", family " + std::to_string(f), 120, [&](std::uint64_t i) {
            const auto p = make_shape_pair<Shape, T>(shapes_seed, of, i);
            return std::pair(p.s, p.t);
        });
    }
    check_total(name.c_str(), total, 2500);
}

TEMPLATE_TEST_CASE("contacts of boxes, planes and capsules with triangles are what they say, in each family", "", float,
                   double) {
    using T = TestType;
    check_shape_families<aabb, T>("box");
    check_shape_families<plane, T>("plane");
    check_shape_families<capsule, T>("capsule");
}

// What is left of the triangle in the corner is so thin that rounded ends of cuts are off by many units of roundoff.
TEST_CASE("contacts of boxes with a sliver of a triangle") {
    const triangle<double> t{{-0x1.123824587b3ecp+4, 0x1.50355542ae159p+5, -0x1.29b75f34a91fbp+6},
                             {-0x1.fb56165b41f0ep+4, 0x1.50c834c57195bp+5, 0x1.c4285e9524116p+5},
                             {0x1.8ea5ff32df7b5p+6, -0x1.6af1460d42be5p+5, -0x1.26b0a2a635d12p+6}};
    const aabb<double> box{{-0x1.594f38ed2ba15p+4, 0x1.505ac614cdf8dp+5, -0x1.4d729840ae2ddp+5},
                           {-0x1.3e5b67c5b75bp+4, 0x1.52126b032f975p+5, -0x1.4861d60fdc9cap+5}};
    const auto c = contact_of(box, t);
    REQUIRE(c);
    contact_tally tally;
    CHECK(wrong_with(box, t, *c, tally) == nullptr);
}

}  // namespace abut::test
