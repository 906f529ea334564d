// SPDX-License-Identifier: MIT
#pragma once

// The part that all top-down builders share: shapes are divided in place until one is left, and what a splitter chooses is
// carried out here. A subtree over k shapes owns k - 1 consecutive nodes, its root first and its left side next, so where a
// node lies depends on the shapes alone: threads work on subtrees of their own, and the tree is the same for any number of
// them. For the host's policies.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/limits.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/bounds.hpp>

namespace abut::detail {

/// A coordinate that is chosen at run time.
template <class T>
constexpr T coordinate(const vec3<T>& v, int axis) {
    using member = T vec3<T>::*;
    constexpr member members[] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    return v.*members[axis];
}

/// A shape while a tree is built over it.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 16 : 8) shape_ref {
    aabb<T> box;
    std::uint32_t id;

    /// Half the middle of the box, by which shapes are divided: then differences of two do not overflow. A sphere's box may
    /// end at infinity, and all of space has no middle: such a key is infinite or NaN. Splitters may get lost there, and
    /// then `median` decides.
    [[nodiscard]] vec3<T> key() const { return T(0.25) * box.lower + T(0.25) * box.upper; }
    [[nodiscard]] T key(int axis) const {
        return T(0.25) * coordinate(box.lower, axis) + T(0.25) * coordinate(box.upper, axis);
    }
};

/// The shapes of a subtree, refs [first, first + count), and the boxes around them and around their keys.
template <scalar T>
struct subtree {
    std::size_t first, count;
    aabb<T> box, keys;
    std::uint32_t node;  ///< its root, unless it is a leaf
    int depth;
};

/// A rule that divides shapes: true sends one to the left.
template <class C, class T>
concept split_rule = requires(const C& rule, const shape_ref<T>& ref) {
    { rule(ref) } -> std::same_as<bool>;
};

/// Chooses how to divide the shapes of a subtree, three or more, reading them and nothing else: the same shapes in the same
/// order give the same rule. Threads call it at once. A rule that leaves one side empty, or the tree too deep, is not taken.
template <class S, class T>
concept splitter = std::copyable<S> && requires(const S& choose, const shape_ref<T>* refs, const subtree<T>& part) {
    { choose(refs, part) } -> split_rule<T>;
};

/// The least d with 2^d >= count: the depth below which `count` shapes can be brought to leaves.
constexpr int least_depth(std::size_t count) {
    int depth = 0;
    while (count > std::size_t{1} << depth) ++depth;
    return depth;
}

template <scalar T, splitter<T> Splitter>
struct top_down {
    shape_ref<T>* refs;
    bvh_node<T>* nodes;
    Splitter choose;

    struct halves {
        subtree<T> side[2];
    };

    /// Writes the root of a subtree of two shapes or more.
    halves split(const subtree<T>& part) const {
        halves both = part.count > 2 ? divide(part, choose(refs + part.first, part)) : halves_at(part, 1);
        const std::size_t larger = std::max(both.side[0].count, both.side[1].count);
        // Halving takes one level of `least_depth`, so this never fails twice.
        if (larger == part.count || part.depth + 1 + least_depth(larger) > bvh_max_depth) both = median(part);
        both.side[0].node = part.node + 1;
        both.side[1].node = part.node + static_cast<std::uint32_t>(both.side[0].count);
        bvh_node<T>& node = nodes[part.node];
        for (int i = 0; i < 2; ++i) {
            const subtree<T>& side = both.side[i];
            node.bounds[i] = side.box;
            node.child[i] = side.count == 1 ? bvh_child::leaf(refs[side.first].id) : bvh_child::inner(side.node);
        }
        return both;
    }

    /// Writes all nodes of a subtree.
    void finish(const subtree<T>& start) const {
        subtree<T> pending[bvh_max_depth];  // at most one for each level above
        int size = 0;
        subtree<T> part = start;
        for (;;) {
            if (part.count > 1) {
                const halves both = split(part);
                pending[size++] = both.side[1];
                part = both.side[0];
            } else if (size > 0) {
                part = pending[--size];
            } else {
                return;
            }
        }
    }

private:
    /// Without branches on the rule, which nobody could predict.
    template <split_rule<T> Rule>
    halves divide(const subtree<T>& part, const Rule& goes_left) const {
        shape_ref<T>* const of = refs + part.first;
        std::size_t left = 0;
        for (std::size_t i = 0; i < part.count; ++i) {
            const shape_ref<T> ref = of[i];
            const bool moves = goes_left(ref);
            of[i] = of[left];
            of[left] = ref;
            left += moves;
        }
        return halves_at(part, left);
    }

    /// The sides of a subtree whose first `left` shapes go to the left.
    halves halves_at(const subtree<T>& part, std::size_t left) const {
        return {
            {measured(part.first, left, part.depth + 1), measured(part.first + left, part.count - left, part.depth + 1)}};
    }
    subtree<T> measured(std::size_t first, std::size_t count, int depth) const {
        auto box = empty_box<T>(), keys = empty_box<T>();
        for (std::size_t i = first; i < first + count; ++i) {
            const vec3<T> key = refs[i].key();
            box = merge(box, refs[i].box);
            keys = merge(keys, aabb<T>{key, key});
        }
        return {first, count, box, keys, 0, depth};
    }

    /// Two sides of one size, by the axis along which keys are spread widest; ids tell equal ones apart.
    halves median(const subtree<T>& part) const {
        const vec3<T> spread = part.keys.upper - part.keys.lower;
        const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
        const auto before = [axis](const shape_ref<T>& a, const shape_ref<T>& b) {
            // NaN is not in the order of numbers; here it is at the lower end.
            const T x = greatest(a.key(axis), -infinity<T>), y = greatest(b.key(axis), -infinity<T>);
            return x < y || (x == y && a.id < b.id);
        };
        shape_ref<T>* const first = refs + part.first;
        if (part.count > 2) std::nth_element(first, first + part.count / 2, first + part.count, before);
        return halves_at(part, part.count / 2);
    }
};

template <shape_view Shapes>
struct make_ref {
    Shapes shapes;
    shape_ref<typename Shapes::scalar_type>* refs;
    void operator()(std::size_t i) const { refs[i] = {bounds(shapes[i]), static_cast<std::uint32_t>(i)}; }
};

template <scalar T>
struct join_subtrees {
    subtree<T> operator()(const subtree<T>& a, const subtree<T>& b) const {
        return {a.first, a.count, merge(a.box, b.box), merge(a.keys, b.keys), a.node, a.depth};
    }
};

/// Builds a tree over n > 0 shapes into storage of that size. Threads first halve the work between them: each round splits
/// every large part there is, until there are several for each thread.
template <host_policy Policy, shape_view Shapes, class Storage, splitter<typename Shapes::scalar_type> Splitter>
void build_top_down(const Policy& on, const Shapes& shapes, Storage& tree, const Splitter& choose) {
    using T = typename Shapes::scalar_type;
    const std::size_t n = shapes.size();
    execution::buffer_of<Policy, shape_ref<T>> refs(on, n);
    for_each_index(on, n, make_ref<Shapes>{shapes, refs.data()});
    const subtree<T> none{0, n, empty_box<T>(), empty_box<T>(), 0, 0};
    const auto one = [&](std::size_t i) {
        const vec3<T> key = refs.data()[i].key();
        return subtree<T>{0, n, refs.data()[i].box, {key, key}, 0, 0};
    };
    const subtree<T> all = reduce(on, n, none, join_subtrees<T>{}, one);
    *tree.root.data() = {all.box, n == 1 ? bvh_child::leaf(0) : bvh_child::inner(0)};

    constexpr std::size_t small = 1024, parts_of_a_thread = 8;
    const int threads = concurrency(on);
    const top_down<T, Splitter> build{refs.data(), tree.nodes.data(), choose};
    std::vector<subtree<T>> parts{all};
    const auto is_large = [&](const subtree<T>& part) { return part.count > small; };
    while (threads > 1 && parts.size() < parts_of_a_thread * static_cast<std::size_t>(threads) &&
           std::any_of(parts.begin(), parts.end(), is_large)) {
        std::vector<subtree<T>> next(2 * parts.size());
        for_each_task(on, parts.size(), [&](std::size_t i) {
            const auto both =
                is_large(parts[i]) ? build.split(parts[i]) : typename top_down<T, Splitter>::halves{{parts[i], parts[i]}};
            next[2 * i] = both.side[0];
            next[2 * i + 1] = both.side[1];
            if (!is_large(parts[i])) next[2 * i + 1].count = 0;
        });
        std::erase_if(next, [](const subtree<T>& part) { return part.count == 0; });
        parts = std::move(next);
    }
    for_each_task(on, parts.size(), [&](std::size_t i) { build.finish(parts[i]); });
}

}  // namespace abut::detail
