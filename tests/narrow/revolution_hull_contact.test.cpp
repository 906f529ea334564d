// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/revolution_contacts.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

// Cylinders and cones with convex hulls. revolution_contacts.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t hull_contact_seed = 20261127;

}  // namespace

TEMPLATE_TEST_CASE("contacts of cylinders and cones with hulls are what they say, in each family", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    std::printf("contacts with hulls: seed %llu\n", static_cast<unsigned long long>(hull_contact_seed));
    contact_figures few, many;
    each_revolution_case<TestType>(hull_contact_seed, 100, [&](const std::string& name, std::uint64_t k, const auto& c) {
        // Numbers of all exponents in one pair may take seconds.
        if (name == name_of(revolution_family::all_bit_patterns) && k % 10 != 0) return;
        const auto s = solid_of<TestType>(c.axis, c.radius);
        const std::vector<vec3<T>> corners{c.corner[0], c.corner[1], c.corner[2], c.corner[0] + (c.corner[1] - c.corner[2])};
        check_contact(name, k / 4, s, hull<T>(corners.data(), 1 + k % 4), few);
        const auto points = points_beside(hull_contact_seed, c, k);
        check_contact(name, k, s, hull<T>(points.data(), points.size()), many);
    });
    check_figures("hulls of few points", few);
    check_figures("hulls", many);
    for (const contact_figures& sum : {few, many}) {
        CHECK(sum.touching * 80 > some_samples(100) * revolution_family_count);
        CHECK(sum.moved * 10 > sum.touching * 8);
    }
}

TEST_CASE("contacts of cylinders and cones with hulls: by hand, and in constant expressions") {
    using vec = vec3<double>;
    static constexpr vec cube[8] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {0, 0, 2}, {2, 0, 2}, {0, 2, 2}, {2, 2, 2}};
    constexpr hull<double> h(cube, 8);
    static_assert(contact_of(cylinder<double>{{{1, 1, 1.75}, {1, 1, 5}}, 0.5}, h)->depth == 0.25);
    static_assert(contact_of(h, cylinder<double>{{{1, 1, 1.75}, {1, 1, 5}}, 0.5})->normal == vec{0, 0, -1});
    static_assert(contact_of(cylinder<double>{{{-9, 1, 2.75}, {9, 1, 2.75}}, 1}, h)->depth == 0.25);
    static_assert(contact_of(cone<double>{{1, 1, 1.5}, {1, 1, 5}, 1}, h)->depth == 0.5);
    static_assert(!contact_of(cone<double>{{1, 1, 2.5}, {1, 1, 5}, 1}, h));
    static_assert(contact_of(cylinder<double>{{{1, 1, 2.5}, {1, 1, 2.5}}, 1}, h)->depth == 0.5);  // a ball
    const auto deep = contact_of(cylinder<double>{{{0.5, 1, 1}, {1.5, 1, 1}}, 0.25}, h);
    CHECK(deep->depth == Approx(1.25));
    CHECK(intersects(deep->point, h));
}

// A triangle lies along the side of a cylinder, and the disc's plane is asked for the farthest points: what is left of its normal
// across the axis is no more than rounding, and leads to none of the disc's points.
TEST_CASE("contacts of cylinders and cones with hulls: where a flat end is seen straight on, a shorter move is found") {
    const std::vector<vec3<float>> p{{-37, -16, 39}, {-41, -9, 25}, {-51, 31, -19}}, q{{-8, 46, -32}, {-21, 32, -34}, {-13, 42, -30}};
    const auto first = contact_of(cylinder<float>{{{-1, -4, 0}, {2, 0x1.000002p+1F, 6}}, 45}, hull<float>(p.data(), p.size()));
    const auto second = contact_of(cylinder<float>{{{4, 4, -5}, {16, 0x1.400002p+3F, -17}}, 45}, hull<float>(q.data(), q.size()));
    CHECK(first.value().depth < 1e-4F);
    CHECK(second.value().depth < 1e-4F);
}

// Where the search does not end at a triangle that touches, it is found by questions about parts of the hull: their number has a
// bound. All is tangent in exact numbers, and turned by a matrix of whole numbers that is three times a rotation.
TEMPLATE_TEST_CASE("contacts of cylinders and cones with hulls: a touching triangle takes few questions", "", cylinder<double>,
                   cone<double>) {
    using vec = vec3<double>;
    const auto turned = [](const vec& p) {
        return vec{p.x + 2 * p.y + 2 * p.z, 2 * p.x + p.y - 2 * p.z, 2 * p.x - 2 * p.y + p.z};
    };
    std::uint64_t state = hull_contact_seed;
    const auto whole = [&](int from, int to) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(from + static_cast<int>((state >> 33) % static_cast<unsigned>(to - from + 1)));
    };
    int touching = 0;
    for (int run = 0; run < 60; ++run) {
        const std::size_t n = run < 3 ? 2000 : static_cast<std::size_t>(whole(1, 9));
        std::vector<vec> points;
        const int width = n == 2000 ? 1000 : 6;
        for (std::size_t i = 0; i < n; ++i) points.push_back(turned({whole(-width, width), whole(-width, width), run % 2 == 0 ? 0 : -whole(0, 2)}));
        // A side of the solid lies in the plane of the hull, or on its edge, and its axis above it.
        const vec at{whole(-3, 3), whole(-3, 3), 0};
        TestType s;
        if constexpr (std::same_as<TestType, cylinder<double>>) {
            s = {{turned(at + vec{-1, 0, 2}), turned(at + vec{1, 0, 2})}, 6};
        } else {
            s = {turned(at), turned(at + vec{4, 0, 3}), 3 * 3.75};  // 3.75 / 5 is 3 / 4
        }
        const hull<double> h(points.data(), n);
        if (!intersects<exact>(s, h)) continue;
        ++touching;
        std::size_t hulls = 0, faces = 0;
        const auto found = detail::touching_points(
            n, [&](std::size_t first, std::size_t count) { return ++hulls, intersects<exact>(s, h.part(first, count)); },
            [&](std::size_t i, std::size_t j, std::size_t k) {
                return ++faces, intersects<exact>(s, triangle<double>{points[i], points[j], points[k]});
            });
        CAPTURE(run, n, hulls, faces);
        CHECK(intersects<exact>(s, triangle<double>{points[found.id[0]], points[found.id[1]], points[found.id[2]]}));
        CHECK(hulls <= (n == 2000 ? 22 : 8));
        CHECK(faces <= n);
    }
    CHECK(touching > 20);
}

}  // namespace abut::test
