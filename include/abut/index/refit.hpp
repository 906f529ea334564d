// SPDX-License-Identifier: MIT
#pragma once

// refit: a tree's boxes made anew around shapes that have moved, while its topology stays. A build sorts; this does not, and
// so it is what a step of a simulation pays for. In which order boxes are made is known beforehand (index/refit_plan.hpp):
// groups of 256 shapes first, then boxes of runs of whole groups, then the nodes that have shapes of several groups.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/node_part.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/refit_plan.hpp>

namespace abut {

namespace detail {

/// The plan of a tree with two shapes or more: made by whoever needs it first.
template <class Policy, class Storage>
const auto& plan_of(const Policy& on, const Storage& tree) {
    auto& plan = *tree.plan;
    const std::scoped_lock lock(plan.making);
    if (!plan.made) {
        std::remove_cvref_t<decltype(*tree.root.data())> root;
        download(on, tree.root.data(), 1, &root);
        make_refit_plan(on, tree.nodes.data(), tree.nodes.size(), root.child, plan);
        plan.made = true;
    }
    return plan;
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

/// Boxes in the memory that a group shares.
template <scalar T, memory_space Space, unsigned Count>
struct box_table {
    aabb<T> boxes[Count];
    ABUT_HD void put(unsigned k, const aabb<T>& box) { boxes[k] = box; }
    [[nodiscard]] ABUT_HD const aabb<T>& operator[](unsigned k) const { return boxes[k]; }
};
/// On a device number by number, so that neighbours do not meet in one bank of memory; rows are a little longer for the sake
/// of those who read one box together.
template <scalar T, unsigned Count>
struct box_table<T, device_space, Count> {
    T values[6][Count + 4];
    ABUT_HD void put(unsigned k, const aabb<T>& box) {
        const T numbers[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
        for (unsigned c = 0; c < 6; ++c) values[c][k] = numbers[c];
    }
    [[nodiscard]] ABUT_HD aabb<T> operator[](unsigned k) const {
        return {{values[0][k], values[1][k], values[2][k]}, {values[3][k], values[4][k], values[5][k]}};
    }
};

/// The parts of both sides of a spanning node that lie in the group of its border.
template <scalar T>
struct side_boxes {
    aabb<T> left, right;
};

/// All that happens within groups.
template <shape_view Shapes>
struct refit_groups {
    using T = typename Shapes::scalar_type;
    using Space = typename Shapes::memory_space;
    static constexpr unsigned group = execution::group_size;
    /// In which a node is written: neighbours write side by side, since a device that writes nodes one by one takes twice as
    /// long.
    static constexpr unsigned parts = std::same_as<Space, device_space> ? node_parts<T> : 1;

    Shapes shapes;
    std::uint32_t count;
    const std::uint32_t* leaves;
    const refit_step* steps;
    bvh_node<T>* nodes;
    side_boxes<T>* spanning;
    aabb<T>* groups;

    struct shared {
        box_table<T, Space, 2 * group> boxes;  ///< of shapes, and from `group` on of what is below borders
        refit_step steps[group];
        std::uint16_t starts[group_trees::turns + 1];  ///< the first step of each turn
        std::uint16_t turns;
        std::uint16_t step_at[group];  ///< of a border
    };

    ABUT_HD void load(std::size_t first, unsigned k, shared& with) const {
        const std::size_t i = first + k;
        if (i >= count) return;
        // Reads first, then writes: a device would wait for the first before it asked for the others.
        const bool has_step = i + 1 < count && k + 1 < group;
        const std::size_t at = has_step ? i : 0;
        const refit_step step = steps[at];
        const unsigned turn_before = steps[at > 0 ? at - 1 : 0].turn;
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now. Not in a function of its own:
        // g++ drops calls that do nothing else.
        if constexpr (std::same_as<Shapes, box_view<T, host_space>>) {
            constexpr std::size_t ahead = 16;
            if (i + ahead < count) __builtin_prefetch(shapes.boxes + leaves[i + ahead]);
        }
#endif
        const aabb<T> box = bounds(shapes[leaves[i]]);
        if (k == 0 && i + 1 == count) with.turns = 0;
        if (has_step) {
            with.steps[k] = step;
            with.step_at[step.border] = static_cast<std::uint16_t>(k);
            if (k == 0 || turn_before != step.turn) with.starts[step.turn] = static_cast<std::uint16_t>(k);
            if (k + 2 == group || i + 2 == count) {
                with.turns = static_cast<std::uint16_t>(step.turn + 1);
                with.starts[step.turn + 1] = static_cast<std::uint16_t>(k + 1);
            }
        }
        with.boxes.put(k, box);
    }
    [[nodiscard]] ABUT_HD unsigned turns(const shared& with) const { return with.turns; }
    [[nodiscard]] ABUT_HD execution::index_range of_turn(unsigned t, const shared& with) const {
        return {with.starts[t], with.starts[t + 1]};
    }
    ABUT_HD void step(unsigned, std::size_t, unsigned k, shared& with) const {
        const refit_step& step = with.steps[k];
        with.boxes.put(group + step.border, merge(with.boxes[left(step)], with.boxes[right(step)]));
    }
    ABUT_HD void write(std::size_t first, unsigned k, unsigned part, const shared& with) const {
        if (k == 0 && part == 0)
            groups[first / group] = with.turns == 0 ? with.boxes[0] : with.boxes[group + last(with).border];
        if (first + k + 1 >= count || k + 1 == group) return;
        const refit_step& step = with.steps[with.step_at[k]];
        const unsigned a = left(step), b = right(step);
        if ((step.node & refit_step::spans) != 0) {
            if (part == 0) spanning[step.node & ~refit_step::spans] = {with.boxes[a], with.boxes[b]};
        } else if constexpr (parts == 1) {
            nodes[step.node] = {{with.boxes[a], with.boxes[b]}, {step.child[0], step.child[1]}};
        } else {
            const auto number = [&](unsigned q) { return with.boxes.values[q % 6][q < 6 ? a : b]; };
            write_node_part(nodes[step.node], part, number, step.child[0], step.child[1]);
        }
    }

private:
    [[nodiscard]] ABUT_HD static unsigned left(const refit_step& step) {
        return step.left == step.border ? step.border : group + step.left;
    }
    [[nodiscard]] ABUT_HD static unsigned right(const refit_step& step) {
        return step.right == step.border ? step.border + 1u : group + step.right;
    }
    [[nodiscard]] ABUT_HD static const refit_step& last(const shared& with) {
        return with.steps[with.starts[with.turns] - 1];
    }
};

/// Boxes of runs of groups: in row j those of 2^j groups, from each group on. Runs stay within 256 groups; those that would
/// not are left as they are and not asked for. Row 0 is there.
template <scalar T, memory_space Space>
struct tabulate_runs {
    static constexpr unsigned group = execution::group_size, parts = 0, rows = 9;
    static_assert(1 << (rows - 1) == group);

    aabb<T>* table;
    std::size_t groups;

    struct shared {
        box_table<T, Space, group> runs[2];
    };
    ABUT_HD void load(std::size_t first, unsigned k, shared& with) const {
        with.runs[0].put(k, table[first + k < groups ? first + k : groups - 1]);
    }
    [[nodiscard]] ABUT_HD unsigned turns(const shared&) const { return rows - 1; }
    [[nodiscard]] ABUT_HD execution::index_range of_turn(unsigned, const shared&) const { return {0, group}; }
    ABUT_HD void step(unsigned t, std::size_t first, unsigned k, shared& with) const {
        const auto& from = with.runs[t % 2];
        const unsigned next = k + (1u << t);
        const aabb<T> box = next < group ? merge(from[k], from[next]) : from[k];
        with.runs[(t + 1) % 2].put(k, box);
        if (first + k < groups) table[(t + 1) * groups + first + k] = box;
    }
    ABUT_HD void write(std::size_t, unsigned, unsigned, const shared&) const {}
};

/// Nodes with shapes of several groups.
template <scalar T>
struct refit_spanning {
    static constexpr std::uint32_t group = execution::group_size;

    const spanning_node* all;
    std::uint32_t count;  ///< of shapes
    std::size_t groups;
    const aabb<T>* table;           ///< see tabulate_runs
    const side_boxes<T>* in_group;  ///< what each has in the group of its border
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    ABUT_HD void operator()(std::size_t i) const {
        const spanning_node at = all[i];
        const std::uint32_t own = at.border / group;
        const bool ends = ends_group(at.border);  // then the group is below the left side as far as that reaches
        aabb<T> left = empty_box<T>(), right = empty_box<T>();
        if (at.first / group != own || ends) {
            left = at.first % group == 0 ? table[at.first / group] : in_group[at.before].right;
            left = merge(left, run(at.first / group + 1, ends ? own + 1 : own));
        }
        if (!ends) {
            left = merge(left, in_group[i].left);
            right = in_group[i].right;
        }
        if (at.last / group != own) {
            right = merge(right, run(own + 1, at.last / group));
            const bool whole = ends_group(at.last) || at.last + 1 == count;
            right = merge(right, whole ? table[at.last / group] : in_group[at.after].left);
        }
        nodes[at.node] = {{left, right}, {at.child[0], at.child[1]}};
        if (at.first == 0 && at.last + 1 == count) *root = {merge(left, right), bvh_child::inner(at.node)};
    }

private:
    /// Groups from `from` to before `to`; an empty box for none.
    [[nodiscard]] ABUT_HD aabb<T> run(std::uint32_t from, std::uint32_t to) const {
        if (from >= to) return empty_box<T>();
        const std::uint32_t first = from / group, last = (to - 1) / group;
        if (first == last) return short_run(from, to);
        aabb<T> box = short_run(from, (first + 1) * group);
        for (std::uint32_t k = first + 1; k < last; ++k) box = merge(box, table[8 * groups + k * group]);
        return merge(box, short_run(last * group, to));
    }
    /// Of one row's reach: two runs cover it.
    [[nodiscard]] ABUT_HD aabb<T> short_run(std::uint32_t from, std::uint32_t to) const {
        const std::uint32_t row = highest_bit(to - from);
        return merge(table[row * groups + from], table[row * groups + to - (1u << row)]);
    }
};

template <scalar T>
struct write_root {
    const aabb<T>* box;
    const bvh_root<T>* old;
    bvh_root<T>* root;
    ABUT_HD void operator()(std::size_t) const { *root = {*box, old->child}; }
};

/// The boxes, with `shapes` read in the order of leaves.
template <class Policy, shape_view Shapes, class Storage>
void refit_nodes(const Policy& on, const Shapes& shapes, const Storage& old, Storage& fresh) {
    using T = typename Shapes::scalar_type;
    using runs = tabulate_runs<T, space_of<Policy>>;
    const auto& plan = plan_of(on, old);
    const auto count = static_cast<std::uint32_t>(old.nodes.size() + 1);
    const std::size_t groups = (count - 1) / execution::group_size + 1;
    execution::buffer_of<Policy, side_boxes<T>> in_group(on, plan.spanning.size());
    execution::buffer_of<Policy, aabb<T>> table(on, runs::rows * groups);
    for_each_in_turns(on, count,
                      refit_groups<Shapes>{shapes, count, plan.leaves.data(), plan.steps.data(), fresh.nodes.data(),
                                           in_group.data(), table.data()});
    if (groups == 1) {
        for_each_index(on, 1, write_root<T>{table.data(), old.root.data(), fresh.root.data()});
        return;
    }
    for_each_in_turns(on, groups, runs{table.data(), groups});
    for_each_index(on, plan.spanning.size(),
                   refit_spanning<T>{plan.spanning.data(), count, groups, table.data(), in_group.data(), fresh.nodes.data(),
                                     fresh.root.data()});
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
/// refit of a topology also derives in what order boxes are made, which takes longer than the refit itself: some 21 bytes a
/// shape, which all trees that come of it share, `tree` too: under cuda the stream of that first refit has to outlive them
/// all. Throws invalid_geometry (views only), error (another number of shapes, a tree on another device), std::bad_alloc,
/// cuda_error.
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
    fresh->plan = old.plan;
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
