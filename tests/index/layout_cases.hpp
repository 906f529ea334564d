// SPDX-License-Identifier: MIT
#pragma once

// What every policy's layouts promise. tests/index runs it on the host's policies, tests/cuda on the device.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/find_flaw.hpp"
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

/// A wide tree of a binary one: children whose boxes and numbers are those of the binary tree, four of them unless all are
/// leaves, and the same bits from any number of threads.
template <class Policy, class Set>
void check_wide(const Policy& on, const Set& set, bvh_builder builder) {
    using T = typename Set::scalar_type;
    const auto same = [](const aabb<T>& a, const aabb<T>& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    const auto tree = make_bvh(on, set, {.builder = builder});
    const auto result = wide(on, tree);
    const auto view = result.view();
    const auto& nodes = result.stored().nodes;
    CHECK(find_flaw(view, set.view()) == "");
    CHECK(result.bytes() == nodes.size() * sizeof(wide_node<T>) + (set.size() > 0 ? sizeof(bvh_root<T>) : 0));
    if (set.size() == 0) return;
    CHECK(same(view.root_bounds(), tree.view().root_bounds()));
    CHECK(quality(result).greatest_depth <= quality(tree).greatest_depth);

    // Boxes of leaves and nodes, by what lies below them: the least shape there, and how many shapes.
    const auto boxes_of = [&](const auto& any_tree) {
        using box_of = std::pair<std::pair<std::uint32_t, std::size_t>, aabb<T>>;
        std::vector<box_of> boxes;
        const auto below = [&](const auto& self, bvh_child child) -> std::pair<std::uint32_t, std::size_t> {
            if (child.is_leaf()) return {child.index(), 1};
            const auto node = any_tree.fetch(child.index());
            std::pair<std::uint32_t, std::size_t> all{bvh_child::leaf_bit, 0};
            for (int side = 0; side < any_tree.children(node); ++side) {
                const auto part = self(self, any_tree.child(node, side));
                boxes.push_back({part, any_tree.bounds(node, side)});
                all = {std::min(all.first, part.first), all.second + part.second};
            }
            return all;
        };
        below(below, any_tree.root());
        std::sort(boxes.begin(), boxes.end(), [](const box_of& a, const box_of& b) { return a.first < b.first; });
        return boxes;
    };
    const auto known = boxes_of(tree.view()), kept = boxes_of(view);
    std::size_t found = 0;
    for (const auto& [what, box] : known) {
        found += found < kept.size() && kept[found].first == what && same(kept[found].second, box) ? 1 : 0;
    }
    CHECK(found == kept.size());

    bool full = true, empty = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const wide_node<T>& node = nodes.data()[i];
        bool leaves = true;
        for (int side = 0; side < view.children(node); ++side) leaves = leaves && view.child(node, side).is_leaf();
        full = full && (leaves || node.count == 4);
        for (int side = view.children(node); side < 4; ++side) {
            empty = empty && same(view.bounds(node, side), empty_box<T>()) && view.child(node, side) == bvh_child::leaf(0);
        }
    }
    CHECK(full);
    CHECK(empty);

    const auto other = wide(openmp{5}, tree);
    CHECK(other.stored().nodes.size() == nodes.size());
    bool equal = view.root() == other.view().root();
    for (std::size_t i = 0; equal && i < nodes.size(); ++i) {
        const wide_node<T>&a = nodes.data()[i], &b = other.stored().nodes.data()[i];
        equal = std::memcmp(&a, &b, offsetof(wide_node<T>, count) + sizeof a.count) == 0;
    }
    CHECK(equal);
}

template <class T, class Policy>
void check_all_wide(const Policy& on) {
    uniform random(82);
    for (const bvh_builder builder : {bvh_builder::linear, bvh_builder::mean_split, bvh_builder::sah}) {
        CAPTURE(static_cast<int>(builder));
        for (std::size_t n = 0; n <= 100; ++n) {
            CAPTURE(n);
            check_wide(on, triangle_soup<T>(random_triangles<T>(n, random)), builder);
        }
        check_wide(on, spheres<T>(random_spheres<T>(20'000, random)), builder);
        check_wide(on, endless_spheres<T>(2000), builder);
        for (const auto& [name, set] : hard_sets<T>(2000)) {
            CAPTURE(name);
            check_wide(on, set, builder);
        }
    }
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
        if constexpr (on_host) use(wide(on, tree));
    };
    in_every_layout(a, bvh_builder::sah, [&](const auto& tree_a) {
        CHECK(to_host(pairs(on, tree_a, balls)) == with_balls);
        CHECK(count(on, tree_a, b) == expected.size());
        in_every_layout(b, bvh_builder::mean_split, [&](const auto& tree_b) {
            CHECK(to_host(pairs(on, tree_a, tree_b)) == expected);
            CHECK(to_host(pairs(on, posed(tree_a, quarter), tree_b)) == moved);
            CHECK(to_host(pairs(on, posed(tree_a, quarter), posed(tree_b, rigid<T>{}))) == moved);
            CHECK(any(on, tree_b, tree_a));
        });
    });
}

}  // namespace abut::test
