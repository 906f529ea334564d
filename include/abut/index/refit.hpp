// SPDX-License-Identifier: MIT
#pragma once

// refit: a tree's boxes made anew around shapes that have moved, bottom-up in one pass, while its topology stays. A build
// sorts; this does not, and so it is what a step of a simulation pays for.
// How boxes are made from the leaves up: index/climb.hpp. Here each node starts its own leaves.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/climb.hpp>
#include <abut/index/operand.hpp>

namespace abut {

namespace detail {

/// Writes where each node hangs.
template <scalar T>
struct write_links {
    const bvh_node<T>* nodes;
    bvh_child root;
    std::uint32_t* above;
    ABUT_HD void operator()(std::size_t i) const {
        const auto node = static_cast<std::uint32_t>(i);
        for (std::uint32_t side = 0; side < 2; ++side) {
            const bvh_child child = nodes[i].child[side];
            if (!child.is_leaf()) above[child.index()] = 2 * node + side;
        }
        if (node == root.index()) above[node] = bvh_links<host_space>::none;
    }
};

/// The links of a tree with two shapes or more: made by whoever needs them first.
template <class Policy, class Storage>
const auto& links_of(const Policy& on, const Storage& tree) {
    using T = std::remove_cvref_t<decltype(tree.root.data()->bounds.lower.x)>;
    auto& links = *tree.links;
    const std::scoped_lock lock(links.making);
    if (!links.made) {
        const std::size_t n = tree.nodes.size();
        const bvh_node<T>* const nodes = tree.nodes.data();
        bvh_root<T> root;
        download(on, tree.root.data(), 1, &root);
        execution::buffer_of<Policy, std::uint32_t> above(on, n);
        for_each_index(on, n, write_links<T>{nodes, root.child, above.data()});
        synchronize(on);  // another policy may use them, in a stream of its own
        links.above = std::move(above);
        links.made = true;
    }
    return links;
}

/// Boxes as a set of shapes.
template <scalar T, memory_space Space>
struct box_view {
    using scalar_type = T;
    using shape_type = aabb<T>;
    using memory_space = Space;
    const aabb<T>* boxes;
    std::size_t count;
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    [[nodiscard]] ABUT_HD aabb<T> operator[](std::size_t i) const { return boxes[i]; }
};

template <shape_view Shapes>
struct write_box {
    Shapes shapes;
    aabb<typename Shapes::scalar_type>* boxes;
    ABUT_HD void operator()(std::size_t i) const { boxes[i] = bounds(shapes[i]); }
};

/// A tree whose boxes are made anew, to climb through (index/climb.hpp). Index i is node i, whose leaves start.
template <shape_view Shapes>
struct refitted_nodes {
    using T = typename Shapes::scalar_type;

    Shapes shapes;
    const bvh_node<T>* old;
    const std::uint32_t* links;  ///< bvh_links::above
    std::size_t count;

    struct subtree {
        aabb<T> box;
        bvh_child child;
        std::uint32_t place;
    };

    ABUT_CALLS_ANY
    template <class Hang>
    ABUT_HD void start(std::size_t i, const Hang& hang) const {
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now. Not in a function of its own:
        // g++ drops calls that do nothing else.
        if constexpr (std::same_as<Shapes, box_view<T, host_space>>) {
            constexpr std::size_t ahead = 16;
            if (i + ahead < count) {
                const bvh_node<T>& later = old[i + ahead];
                if (later.child[0].is_leaf()) __builtin_prefetch(shapes.boxes + later.child[0].index());
                if (later.child[1].is_leaf()) __builtin_prefetch(shapes.boxes + later.child[1].index());
            }
        }
#endif
        const bvh_child left = old[i].child[0], right = old[i].child[1];
        const auto place = 2 * static_cast<std::uint32_t>(i);
        if (left.is_leaf()) hang(subtree{bounds(shapes[left.index()]), left, place});
        if (right.is_leaf()) hang(subtree{bounds(shapes[right.index()]), right, place + 1});
    }
    ABUT_HD void notice(std::size_t) const {}
    [[nodiscard]] ABUT_HD bool is_all(const subtree& at) const { return at.place == bvh_links<host_space>::none; }
    template <class Reader>
    [[nodiscard]] ABUT_HD std::uint32_t above(const subtree& at, const Reader&) const {
        return at.place;
    }
    template <class Reader>
    [[nodiscard]] ABUT_HD std::uint32_t token(const subtree&, std::uint32_t place, const Reader& link) const {
        return link(place / 2);
    }
    [[nodiscard]] ABUT_HD subtree joined(std::uint32_t, std::uint32_t link) const { return {{}, {}, link}; }

    struct local {
        std::uint32_t links[execution::group_size];
    };
    struct near_reader {
        const std::uint32_t *all, *links;
        std::uint32_t first;
        ABUT_HD std::uint32_t operator()(std::uint32_t node) const {
            return node - first < execution::group_size ? links[node - first] : all[node];  // unsigned: or before the first
        }
    };
    struct far_reader {
        const std::uint32_t* all;
        ABUT_HD std::uint32_t operator()(std::uint32_t node) const { return all[node]; }
    };
    ABUT_HD void load(std::size_t first, unsigned k, local& to) const {
        if (first + k < count) to.links[k] = links[first + k];
    }
    [[nodiscard]] ABUT_HD near_reader near(std::size_t first, const local& from) const {
        return {links, from.links, static_cast<std::uint32_t>(first)};
    }
    [[nodiscard]] ABUT_HD far_reader far() const { return {links}; }
};

/// The climb, with `shapes` read in the order of leaves.
template <class Policy, shape_view Shapes, class Storage>
void refit_nodes(const Policy& on, const Shapes& shapes, const Storage& old, Storage& fresh) {
    const std::size_t n = old.nodes.size();
    const refitted_nodes<Shapes> tree{shapes, old.nodes.data(), links_of(on, old).above.data(), n};
    climb_all(on, tree, n, n + 1, fresh.nodes.data(), fresh.root.data());
}

template <shape_view Shapes>
struct refit_single {
    Shapes shapes;
    bvh_root<typename Shapes::scalar_type>* root;
    ABUT_HD void operator()(std::size_t) const { *root = {bounds(shapes[0]), bvh_child::leaf(0)}; }
};

}  // namespace detail

/// A tree of the topology of `tree` over the shapes of `set`, of which there are as many: shape i takes the place of shape
/// i. `tree` stays as it is, and the two share nothing that either could change. Results of queries are right however far
/// shapes have moved; only speed suffers, and `quality` shows how much.
///
/// The set may be of another kind than the tree's. It is brought to the policy's memory and checked as by make_bvh; a tree
/// in another layout than the standard one is refitted before it is converted. Returns when the boxes are there. The first
/// refit of a topology also derives 4 bytes a node, which all trees that come of it
/// share, `tree` too: under cuda the stream of that first refit has to outlive them all. Throws invalid_geometry (views
/// only), error (another number of shapes, a tree on another device), std::bad_alloc, cuda_error.
template <execution_policy Policy, class OldSet, memory_space Space, bvh_layout_kind Layout, class Set>
[[nodiscard]] auto refit(const Policy& on, const bvh<OldSet, Space, Layout>& tree, const Set& set) {
    static_assert(std::same_as<Layout, standard_layout>,
                  "abut: refit takes a tree in the standard layout; refit that one and convert the result");
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: the index lies in other memory than the policy works in; make it with the same policy");
    auto resident = detail::make_resident(on, set, "abut::refit");
    using tree_type = bvh<decltype(resident), Space>;
    using T = typename tree_type::scalar_type;
    static_assert(std::same_as<T, typename OldSet::scalar_type>, "abut: the tree and the set have different scalar types");
    const auto shapes = detail::view_of(resident);
    using shapes_type = std::remove_const_t<decltype(shapes)>;
    const std::size_t n = shapes.size();
    if (n != tree.size()) {
        throw error("abut::refit: the tree has " + std::to_string(tree.size()) + " shapes, the set " + std::to_string(n));
    }
    detail::require_same_device(on, tree, "abut::refit");
    auto fresh = std::make_shared<typename tree_type::storage>();
    fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, n > 0 ? 1 : 0);
    fresh->nodes = execution::buffer_of<Policy, bvh_node<T>>(on, n > 0 ? n - 1 : 0);
    const auto& old = tree.stored();
    fresh->links = old.links;
    if (n == 1) {
        for_each_index(on, 1, detail::refit_single<shapes_type>{shapes, fresh->root.data()});
    } else if (n > 1) {
        if constexpr (host_policy<Policy>) {
            // A processor waits for what it reads out of order: a box is one line of memory, a mesh's triangle up to four.
            execution::buffer_of<Policy, aabb<T>> boxes(on, n);
            for_each_index(on, n, detail::write_box<shapes_type>{shapes, boxes.data()});
            detail::refit_nodes(on, detail::box_view<T, Space>{boxes.data(), n}, old, *fresh);
        } else {
            detail::refit_nodes(on, shapes, old, *fresh);
        }
    }
    synchronize(on);
    return tree_type(std::move(resident), std::move(fresh));
}

}  // namespace abut
