// SPDX-License-Identifier: MIT
#pragma once

// What every policy's layouts promise. tests/index runs it on the host's policies, tests/cuda on the device.

#include <cmath>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// That a box is no smaller, and larger by less than a step on each side. Differences are taken in long double, where they
/// are exact for float and within a rounding for double.
template <class T>
bool is_close_above(const aabb<T>& outer, const aabb<T>& inner, const vec3<T>& step) {
    const auto side = [](T out, T in, T most) {
        if (out == in) return true;
        if (!std::isfinite(out) || !std::isfinite(in)) return std::fabs(out) >= std::fabs(in);
        return std::fabs(static_cast<long double>(out) - static_cast<long double>(in)) <= static_cast<long double>(most);
    };
    return contains(outer, inner) && side(outer.lower.x, inner.lower.x, step.x) &&
           side(outer.upper.x, inner.upper.x, step.x) && side(outer.lower.y, inner.lower.y, step.y) &&
           side(outer.upper.y, inner.upper.y, step.y) && side(outer.lower.z, inner.lower.z, step.z) &&
           side(outer.upper.z, inner.upper.z, step.z);
}

template <class Policy, class Set>
void check_layouts(const Policy& on, const Set& set) {
    using T = typename Set::scalar_type;
    const std::size_t n = set.size();
    const auto tree = make_bvh(on, set);
    const auto standard = tree.stored().to_host();

    const auto small = quantised(on, tree);
    const auto rounded = small.stored().to_host();
    const auto view = rounded.view_of(n);
    CHECK(find_flaw(view, set.view()) == "");
    bool close = true;
    for (std::size_t i = 0; i < standard.nodes.size(); ++i) {
        for (const int side : {0, 1}) {
            const auto node = view.fetch(static_cast<std::uint32_t>(i));
            close =
                close && is_close_above<T>(view.bounds(node, side), standard.nodes.data()[i].bounds[side], view.frame.step);
        }
    }
    if (n > 0) close = close && is_close_above<T>(view.root_bounds(), standard.root.data()->bounds, view.frame.step);
    CHECK(close);
    CHECK(small.bytes() == (n > 0 ? (n - 1) * 32 + sizeof(bvh_root<T>) : 0));

    const auto bare = leafless(on, tree);
    const auto dropped = bare.stored().to_host();
    CHECK(find_flaw(dropped.view_of(n), set.view()) == "");
    bool same = true;
    for (std::size_t i = 0; i < standard.nodes.size(); ++i) {
        const auto node = dropped.view_of(n).fetch(static_cast<std::uint32_t>(i));
        for (const int side : {0, 1}) {
            const auto& known = standard.nodes.data()[i];
            if (known.child[side].is_leaf()) continue;
            same = same && node.bounds[side].lower == known.bounds[side].lower &&
                   node.bounds[side].upper == known.bounds[side].upper;
        }
    }
    CHECK(same);
    CHECK(bare.bytes() == (n > 0 ? (n - 1) * sizeof(leafless_node<T>) + sizeof(bvh_root<T>) : 0));
}

template <class T, class Policy>
void check_all_layouts(const Policy& on) {
    uniform random(81);
    for (std::size_t n = 0; n <= 100; ++n) {
        CAPTURE(n);
        check_layouts(on, triangle_soup<T>(random_triangles<T>(n, random)));
    }
    check_layouts(on, spheres<T>(random_spheres<T>(20'000, random)));
    check_layouts(on, endless_spheres<T>(2000));
    for (const auto& [name, set] : hard_sets<T>(2000)) {
        CAPTURE(name);
        check_layouts(on, set);
    }
}

/// The same pairs from every layout on either side, posed or not. Builders come along in turn, where the policy has them.
template <class T, class Policy>
void check_layout_queries(const Policy& on) {
    constexpr bool on_host = host_policy<Policy>;
    uniform random(83);
    const triangle_soup<T> a(random_triangles<T>(600, random)), b(random_triangles<T>(500, random));
    const spheres<T> balls(random_spheres<T>(300, random));
    rigid<T> quarter{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {T(0.1), T(0.2), T(0.3)}};
    const auto expected = to_host(pairs(serial{}, a, b)), with_balls = to_host(pairs(serial{}, a, balls)),
               moved = to_host(pairs(serial{}, posed(a, quarter), b));
    CHECK(expected.size() > 200);
    CHECK(with_balls.size() > 200);
    CHECK(moved.size() > 100);
    const auto in_every_layout = [&](const auto& set, bvh_builder builder, const auto& use) {
        const auto tree = make_bvh(on, set, {.builder = on_host ? builder : bvh_builder::ploc});
        use(tree);
        use(quantised(on, tree));
        use(leafless(on, tree));
    };
    in_every_layout(a, bvh_builder::sah, [&](const auto& tree_a) {
        CHECK(to_host(pairs(on, tree_a, balls)) == with_balls);
        CHECK(count(on, tree_a, b) == expected.size());
        in_every_layout(b, bvh_builder::mean_split, [&](const auto& tree_b) {
            CHECK(to_host(pairs(on, tree_a, tree_b)) == expected);
            CHECK(to_host(pairs(on, posed(tree_a, quarter), tree_b)) == moved);
            CHECK(any(on, tree_b, tree_a));
        });
    });
}

}  // namespace abut::test
