// SPDX-License-Identifier: MIT
#pragma once

// What every policy's indices promise. tests/index runs it on the host's policies, tests/cuda on the device.

#include <string>
#include <vector>

#include <abut/index/lbvh.hpp>

#include "support/catch.hpp"
#include "support/find_flaw.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// A tree's nodes and root, in host memory, with a view over them.
template <class T>
struct host_tree {
    std::vector<bvh_node<T>> nodes;
    std::vector<bvh_root<T>> root;

    bvh_view<T, host_space> view(std::size_t shapes) const { return {{nodes.data(), root.data(), shapes}}; }
};

template <class Policy, class Tree>
auto fetch_tree(const Policy& on, const Tree& tree) {
    using T = typename Tree::scalar_type;
    const std::size_t n = tree.size();
    host_tree<T> copy{std::vector<bvh_node<T>>(n > 0 ? n - 1 : 0), std::vector<bvh_root<T>>(n > 0 ? 1 : 0)};
    download(on, tree.view().nodes, copy.nodes.size(), copy.nodes.data());
    download(on, tree.view().top, copy.root.size(), copy.root.data());
    return copy;
}

template <class Policy, class Set>
void check_tree(const Policy& on, const Set& set, const bvh_options& options) {
    const auto tree = make_bvh(on, set, options);
    const auto copy = fetch_tree(on, tree);
    CHECK(find_flaw(copy.view(set.size()), set.view()) == "");
    // The serial build of the same shapes is the same tree, bit for bit.
    const auto reference = make_bvh(serial{}, set, options);
    const auto expected = fetch_tree(serial{}, reference);
    bool same = true;
    for (std::size_t i = 0; i < copy.nodes.size(); ++i) {
        for (const int side : {0, 1}) {
            same &= copy.nodes[i].child[side] == expected.nodes[i].child[side] &&
                    copy.nodes[i].bounds[side].lower == expected.nodes[i].bounds[side].lower &&
                    copy.nodes[i].bounds[side].upper == expected.nodes[i].bounds[side].upper;
        }
    }
    CHECK(same);
}

/// Well-formed for n = 0, 1, 2, ... and for input that gives Morton codes trouble.
template <class T, class Policy>
void check_trees(const Policy& on) {
    uniform random(11);
    for (const int bits : {0, 30, 63}) {
        const bvh_options options{.morton_bits = bits};
        for (std::size_t n = 0; n <= 100; ++n) {
            CAPTURE(bits, n);
            check_tree(on, triangle_soup<T>(random_triangles<T>(n, random)), options);
        }
        CAPTURE(bits);
        check_tree(on, spheres<T>(random_spheres<T>(20'000, random)), options);
        check_tree(on, equal_spheres<T>(std::vector<vec3<T>>(5000, {1, 2, 3}), T(0.5)), options);  // one code for all
        std::vector<vec3<T>> clusters;
        for (std::size_t i = 0; i < 4000; ++i) {
            const T far = i % 2 ? T(1e6) : T(0);
            clusters.push_back(vec3<T>{far, far, far} + random.point<T>(-1, 1));
        }
        check_tree(on, equal_spheres<T>(clusters, T(0.01)), options);
        std::vector<vec3<T>> line(3000, {0, 0, 0});  // flat in two axes, and doubling: as deep as trees get
        for (std::size_t i = 0; i < line.size(); ++i) line[i].x = std::ldexp(T(1), static_cast<int>(i % 120) - 60);
        check_tree(on, equal_spheres<T>(line, T(0)), options);
        constexpr T huge = std::numeric_limits<T>::max();
        check_tree(on, spheres<T>({{{huge, 0, 0}, 1}, {{-huge, 0, 0}, huge}, {{0, huge, -huge}, 0}, {{0, 0, 0}, 0}}),
                   options);
    }
}

}  // namespace abut::test
