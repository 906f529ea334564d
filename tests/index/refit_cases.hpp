// SPDX-License-Identifier: MIT
#pragma once

// What refit promises on every policy. tests/index runs it on the host's policies, tests/cuda on the device.

#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/find_flaw.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Every box is the smallest around what lies below it, bit for bit, of zeros of both signs the left side's: the boxes of a
/// tree that refit has made depend on nothing else. A tree in host memory.
template <class Layout, class Shapes>
bool is_tight(const Layout& tree, const Shapes& shapes) {
    using T = typename Layout::scalar_type;
    struct tight {
        const Layout& tree;
        const Shapes& shapes;
        bool all = true;
        aabb<T> box(bvh_child child) {
            if (child.is_leaf()) return bounds(shapes[child.index()]);
            const auto node = tree.fetch(child.index());
            const aabb<T> left = box(tree.child(node, 0)), right = box(tree.child(node, 1));
            all = all && same(left, tree.bounds(node, 0)) && same(right, tree.bounds(node, 1));
            return merge(left, right);
        }
        static bool same(const aabb<T>& a, const aabb<T>& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
    };
    if (shapes.size() == 0) return true;
    tight check{tree, shapes};
    return check.same(check.box(tree.root()), tree.root_bounds()) && check.all;
}

/// Refits `tree` to `set`, twice: the second uses what the first has kept.
template <class Policy, class Tree, class Set>
void check_refit(const Policy& on, const Tree& tree, const Set& set) {
    const auto before = tree.stored().to_host();
    const auto refitted = refit(on, tree, set);
    const auto again = refit(on, refitted, set);
    const auto after = refitted.stored().to_host(), last = again.stored().to_host();
    CHECK(find_flaw(after.view_of(set.size()), set.view()) == "");
    CHECK(is_tight(after.view_of(set.size()), set.view()));
    CHECK(same_bits(after, last));
    CHECK(refitted.stored().plan == tree.stored().plan);
    CHECK(same_bits(before, tree.stored().to_host()));
    bool same_topology = before.nodes.size() == after.nodes.size();
    for (std::size_t i = 0; same_topology && i < before.nodes.size(); ++i) {
        for (const int side : {0, 1})
            same_topology &= before.nodes.data()[i].child[side] == after.nodes.data()[i].child[side];
    }
    CHECK(same_topology);
    if (set.size() > 0) CHECK(before.root.data()[0].child == after.root.data()[0].child);
}

/// A tree that is refitted to the shapes it was built over is the same tree.
template <class T, class Policy>
void check_unmoved(const Policy& on, const triangle_soup<T>& set) {
    const auto tree = make_bvh(on, set);
    const auto before = tree.stored().to_host(), after = refit(on, tree, set).stored().to_host();
    bool same = before.nodes.size() == after.nodes.size();
    for (std::size_t i = 0; same && i < before.nodes.size(); ++i) {
        for (const int side : {0, 1}) {
            same &= before.nodes.data()[i].bounds[side].lower == after.nodes.data()[i].bounds[side].lower &&
                    before.nodes.data()[i].bounds[side].upper == after.nodes.data()[i].bounds[side].upper;
        }
    }
    CHECK(same);
}

template <class T, class Policy>
void check_refits(const Policy& on) {
    uniform random(51);
    std::vector<std::size_t> sizes(101);
    std::iota(sizes.begin(), sizes.end(), std::size_t{0});
    // Groups that are whole, and a last one with one shape or two; and as many groups as a row of runs reaches, or one more.
    for (const std::size_t n : {255u, 256u, 257u, 258u, 511u, 512u, 513u, 514u, 65'535u, 65'536u, 65'537u})
        sizes.push_back(n);
    for (const std::size_t n : sizes) {
        CAPTURE(n);
        const triangle_soup<T> first(random_triangles<T>(n, random)), second(random_triangles<T>(n, random));
        check_refit(on, make_bvh(on, first), second);
        check_unmoved(on, first);
    }
    const triangle_soup<T> many(random_triangles<T>(300'000, random));
    check_refit(on, make_bvh(on, many), triangle_soup<T>(random_triangles<T>(300'000, random)));
    check_unmoved(on, many);
    // From one hard set to the next, and to shapes of another kind.
    const auto sets = hard_sets<T>(2000);
    for (std::size_t i = 0; i < sets.size(); ++i) {
        const auto& next = sets[(i + 1) % sets.size()];
        CAPTURE(sets[i].name, next.name);
        check_refit(on, make_bvh(on, sets[i].set), next.set);
    }
    check_refit(on, make_bvh(on, many), spheres<T>(random_spheres<T>(300'000, random)));
    check_refit(on, make_bvh(on, sets[0].set), endless_spheres<T>(2000));
}

/// A moving mesh, step by step: what touches is what a tree built anew finds.
template <class T, class Policy>
void check_steps(const Policy& on) {
    torus<T> shape(40, 20, 1, 0.4);
    const mesh<T> still(torus<T>(30, 15, 0.9, 0.3).vertices, torus<T>(30, 15, 0.9, 0.3).faces);
    const auto other = make_bvh(on, still);
    auto tree = make_bvh(on, mesh<T>(shape.vertices, shape.faces));
    std::size_t hits = 0;
    for (int step = 0; step < 6; ++step) {
        for (auto& p : shape.vertices) p = {p.x + T(0.05) * p.z, p.y * T(1.02), p.z - T(0.07) * p.x};
        const mesh<T> moved(shape.vertices, shape.faces);
        tree = refit(on, tree, moved);
        const auto expected = to_host(pairs(on, make_bvh(on, moved), other));
        CHECK(to_host(pairs(on, tree, other)) == expected);
        hits += expected.size();
    }
    CHECK(hits > 100);
}

template <class T, class Policy>
void check_refit_refusals(const Policy& on) {
    const auto triangles = [](std::size_t n) { return triangle_soup<T>(std::vector<triangle<T>>(n)); };
    const auto tree = make_bvh(on, triangles(3));
    CHECK_THROWS_WITH(refit(on, tree, triangles(4)), "abut::refit: the tree has 3 shapes, the set 4");
    CHECK_THROWS_WITH(refit(on, tree, triangles(0)), "abut::refit: the tree has 3 shapes, the set 0");
    CHECK_THROWS_WITH(refit(on, make_bvh(on, sphere<T>{{0, 0, 0}, 1}), sphere<T>{{0, 0, 0}, -1}),
                      "abut::refit: shape 0: radius is negative (-1)");
    const auto one = refit(on, make_bvh(on, sphere<T>{{0, 0, 0}, 1}), sphere<T>{{5, 0, 0}, 2}).stored().to_host();
    CHECK(one.root.data()->bounds.upper == vec3<T>{7, 2, 2});
}

}  // namespace abut::test
