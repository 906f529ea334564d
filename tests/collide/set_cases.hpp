// SPDX-License-Identifier: MIT
#pragma once

// Sets of each shape against sets of each other that has a predicate with it, on every policy: complete, sorted, the same
// with each index on each side. The truth is a plain loop over `intersects<exact>`, whose own truth is tests/predicate.

#include <cmath>
#include <cstdio>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <class A, class B>
std::vector<index_pair> all_that_touch(const A& a, const B& b) {
    std::vector<index_pair> touching;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (intersects<exact>(a[i], b[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Shapes of one kind in a box of side 2: at random, or with small whole numbers over 4, so that many touch exactly.
template <class Shape>
class shape_maker {
    using T = scalar_type_of<Shape>;

public:
    shape_maker(uniform& random, bool on_lattice) : random_(random), on_lattice_(on_lattice) {}

    [[nodiscard]] std::vector<Shape> operator()(std::size_t n) const {
        std::vector<Shape> shapes;
        for (std::size_t i = 0; i < n; ++i) shapes.push_back(one());
        return shapes;
    }

private:
    [[nodiscard]] T number(double lower, double upper) const {
        const double x = random_(lower, upper);
        return static_cast<T>(on_lattice_ ? std::floor(x * 4 + 0.5) / 4 : x);
    }
    [[nodiscard]] vec3<T> point() const { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }
    [[nodiscard]] vec3<T> near(const vec3<T>& p) const {
        return p + vec3<T>{number(-0.5, 0.5), number(-0.5, 0.5), number(-0.5, 0.5)};
    }
    [[nodiscard]] Shape one() const {
        const vec3<T> p = point();
        if constexpr (std::same_as<Shape, vec3<T>>) {
            return p;
        } else if constexpr (std::same_as<Shape, triangle<T>>) {
            return {p, near(p), near(p)};
        } else if constexpr (std::same_as<Shape, segment<T>>) {
            return {p, near(p)};
        } else if constexpr (std::same_as<Shape, sphere<T>>) {
            return {p, number(0, 0.4)};
        } else if constexpr (std::same_as<Shape, capsule<T>>) {
            return {{p, near(p)}, number(0, 0.25)};
        } else if constexpr (std::same_as<Shape, cylinder<T>>) {
            return {{p, near(p)}, number(0, 0.25)};
        } else if constexpr (std::same_as<Shape, cone<T>>) {
            return {p, near(p), number(0, 0.5)};
        } else if constexpr (std::same_as<Shape, aabb<T>>) {
            return bounds(segment<T>{p, near(p)});
        } else {
            static_assert(std::same_as<Shape, plane<T>>);
            return {p, number(-1, 1)};
        }
    }

    uniform& random_;
    bool on_lattice_;
};

/// By brute force, indexed on one side, and on both.
template <class Policy, class A, class B>
std::size_t check_sets_of(const Policy& on, const shapes<A>& a, const shapes<B>& b) {
    const auto expected = all_that_touch(a.view(), b.view());
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    CAPTURE(a.size(), b.size(), expected.size());
    CHECK(to_host(pairs(on, there_a, there_b)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, there_a), there_b)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, there_a), make_bvh(on, there_b))) == expected);
    return expected.size();
}

template <class A, class B, class Policy>
void check_pair_of_shapes(const Policy& on, std::uint64_t seed) {
    CAPTURE(seed);
    uniform random(seed);
    std::size_t hits = 0;
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const shape_maker<A> make_a(random, on_lattice);
        const shape_maker<B> make_b(random, on_lattice);
        hits += check_sets_of(on, shapes<A>(make_a(180)), shapes<B>(make_b(220)));
    }
    // Points that are not on a lattice meet nothing but solids.
    CHECK(hits > 20);
    CHECK(hits < 180 * 220);
    check_sets_of(on, shapes<A>(), shapes<B>(shape_maker<B>(random, false)(3)));
    check_sets_of(on, shapes<A>(shape_maker<A>(random, false)(3)), shapes<B>());
}

template <class T, class Policy>
void check_all_pairs_of_shapes(const Policy& on) {
    std::printf("sets of each shape: seeds 61 to 69\n");
    check_pair_of_shapes<triangle<T>, triangle<T>>(on, 61);
    check_pair_of_shapes<segment<T>, triangle<T>>(on, 62);
    check_pair_of_shapes<triangle<T>, vec3<T>>(on, 63);
    check_pair_of_shapes<sphere<T>, triangle<T>>(on, 64);
    check_pair_of_shapes<triangle<T>, aabb<T>>(on, 65);
    check_pair_of_shapes<plane<T>, triangle<T>>(on, 66);
    check_pair_of_shapes<capsule<T>, triangle<T>>(on, 67);
    check_pair_of_shapes<segment<T>, sphere<T>>(on, 68);
    check_pair_of_shapes<sphere<T>, sphere<T>>(on, 69);
}

/// Sets of which none has triangles.
template <class T, class Policy>
void check_sets_without_triangles(const Policy& on) {
    std::printf("sets without triangles: seeds 91 to 96\n");
    check_pair_of_shapes<aabb<T>, capsule<T>>(on, 91);
    check_pair_of_shapes<sphere<T>, aabb<T>>(on, 92);
    check_pair_of_shapes<capsule<T>, segment<T>>(on, 93);
    check_pair_of_shapes<plane<T>, capsule<T>>(on, 94);
    check_pair_of_shapes<aabb<T>, aabb<T>>(on, 95);
    check_pair_of_shapes<vec3<T>, sphere<T>>(on, 96);
}

/// The pairs within one set.
template <class Shape, class Policy>
void check_self_pairs_of(const Policy& on, std::uint64_t seed) {
    CAPTURE(seed);
    uniform random(seed);
    for (const bool on_lattice : {false, true}) {
        const shapes<Shape> set(shape_maker<Shape>(random, on_lattice)(200));
        std::vector<index_pair> expected;
        for (const index_pair& p : all_that_touch(set.view(), set.view())) {
            if (p.a < p.b) expected.push_back(p);
        }
        CHECK(expected.size() > 20);
        CHECK(expected.size() < 199 * 100);
        const auto there = copy_to(on, set);
        CHECK(to_host(self_pairs(on, there)) == expected);
        CHECK(to_host(self_pairs(on, make_bvh(on, there))) == expected);
        CHECK(count_self_pairs(on, make_grid(on, there)) == expected.size());
    }
}

}  // namespace abut::test
