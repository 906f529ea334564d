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

}  // namespace abut::test
