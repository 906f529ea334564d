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
#include <abut/execution/generic.hpp>
#include <abut/execution/group.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/node_part.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/refit_plan.hpp>
#include <abut/shape/posed.hpp>

namespace abut {

namespace detail {

/// The plan of a tree with two shapes or more: made by whoever needs it first.
template <class Policy, class Storage>
auto plan_of(const Policy& on, const Storage& tree) {
    const std::scoped_lock lock(tree.plan->making);
    auto& made = tree.plan->made;
    if (made == nullptr) {
        std::remove_cvref_t<decltype(*tree.root.data())> root;
        download(on, tree.root.data(), 1, &root);
        made = std::make_shared<const refit_plan<space_of<Policy>>>(
            make_refit_plan(on, tree.nodes.data(), tree.nodes.size(), root.child));
    }
    return made;
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
/// On a device number by number, so that neighbours do not meet in one bank of memory, nor the two entries of a step, nor
/// those who read one box together.
template <scalar T, unsigned Count>
struct box_table<T, device_space, Count> {
    T values[6][Count + 34];
    [[nodiscard]] ABUT_HD static unsigned column(unsigned k) { return k + k / execution::group_size * 16; }
    ABUT_HD void put(unsigned k, const aabb<T>& box) {
        const T numbers[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
        for (unsigned c = 0; c < 6; ++c) values[c][column(k)] = numbers[c];
    }
    [[nodiscard]] ABUT_HD aabb<T> operator[](unsigned k) const {
        const unsigned at = column(k);
        return {{values[0][at], values[1][at], values[2][at]}, {values[3][at], values[4][at], values[5][at]}};
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
        box_table<T, Space, 2 * group> boxes;
        std::uint16_t box_to[group];
        std::uint16_t starts[group_trees::turns + 1];  ///< the first step of each turn
        std::uint16_t turns;
    };

    /// Turn by turn. The last turns, of few, are a subgroup's.
    ABUT_HD void operator()(const execution::group<shared>& members) const {
        const std::size_t first = members.first;
        shared& with = members.shared;
        members.each([&](unsigned k) { load(first, k, with); });
        const auto make_box = [&](unsigned k) { step(k, with); };
        const unsigned turns = with.turns;
        unsigned t = 0;
        for (; t < turns && with.starts[t + 1] - with.starts[t] > int{execution::subgroup_size}; ++t) {
            members.each(with.starts[t], with.starts[t + 1], make_box);
        }
        members.in_subgroup([&](const execution::subgroup& some) {
            for (; t < turns; ++t) some.each(with.starts[t], with.starts[t + 1], make_box);
        });
        members.each(0, parts * group, [&](unsigned i) { write(first, i / parts, i % parts, with); });
    }

private:
    ABUT_HD void load(std::size_t first, unsigned k, shared& with) const {
        const std::size_t i = first + k;
        if (i >= count) return;
        // Reads first, then writes: a device would wait for the first before it asked for the others.
        const refit_step step = steps[i];
        const unsigned turn_before = steps[i > 0 ? i - 1 : 0].turn;
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now. Not in a function of its own:
        // g++ drops calls that do nothing else.
        if constexpr (std::same_as<Shapes, box_view<T, host_space>>) {
            constexpr std::size_t ahead = 16;
            if (i + ahead < count) ABUT_PREFETCH(shapes.boxes + leaves[i + ahead]);
        }
#endif
        const aabb<T> box = bounds(shapes[leaves[i]]);
        with.boxes.put(step.shape_to == refit_step::no_entry ? 0 : step.shape_to, box);
        with.box_to[k] = static_cast<std::uint16_t>(step.box_to);
        if (k == 0 && i + 1 == count) with.turns = 0;
        if (!is_step(first, k)) return;
        if (k == 0 || turn_before != step.turn) with.starts[step.turn] = static_cast<std::uint16_t>(k);
        if (!is_step(first, k + 1)) {
            with.turns = static_cast<std::uint16_t>(step.turn + 1);
            with.starts[step.turn + 1] = static_cast<std::uint16_t>(k + 1);
        }
    }
    ABUT_HD void step(unsigned k, shared& with) const {
        const unsigned to = with.box_to[k];
        if (to != refit_step::no_entry) with.boxes.put(to, merge(with.boxes[k], with.boxes[group + k]));
    }
    ABUT_HD void write(std::size_t first, unsigned k, unsigned part, const shared& with) const {
        if (k == 0 && part == 0) {
            const unsigned last = with.turns == 0 ? 0 : with.starts[with.turns] - 1u;
            groups[first / group] = with.turns == 0 ? with.boxes[0] : merge(with.boxes[last], with.boxes[group + last]);
        }
        if (!is_step(first, k)) return;
        const refit_step step = steps[first + k];
        if ((step.node & refit_step::spans) != 0) {
            if (part == 0) spanning[step.node & ~refit_step::spans] = {with.boxes[k], with.boxes[group + k]};
        } else if constexpr (parts == 1) {
            nodes[step.node] = {{with.boxes[k], with.boxes[group + k]}, {step.child[0], step.child[1]}};
        } else {
            const auto number = [&](unsigned q) {
                return with.boxes.values[q % 6][with.boxes.column(q < 6 ? k : group + k)];
            };
            write_node_part(nodes[step.node], part, number, step.child[0], step.child[1]);
        }
    }
    /// A group of m shapes has m - 1 steps.
    [[nodiscard]] ABUT_HD bool is_step(std::size_t first, unsigned k) const {
        return first + k + 1 < count && k + 1 < group;
    }
};

/// Boxes of runs of groups: in row j those of 2^j groups, from each group on. Runs stay within 256 groups; those that would
/// not are left as they are and not asked for. Row 0 is there.
template <scalar T, memory_space Space>
struct tabulate_runs {
    static constexpr unsigned group = execution::group_size, rows = 9;
    static_assert(1 << (rows - 1) == group);

    aabb<T>* table;
    std::size_t groups;

    struct shared {
        box_table<T, Space, group> runs[2];
    };
    ABUT_HD void operator()(const execution::group<shared>& members) const {
        const std::size_t first = members.first;
        shared& with = members.shared;
        members.each([&](unsigned k) { with.runs[0].put(k, table[first + k < groups ? first + k : groups - 1]); });
        for (unsigned row = 0; row + 1 < rows; ++row) {
            const auto& from = with.runs[row % 2];
            members.each([&](unsigned k) {
                const unsigned next = k + (1u << row);
                const aabb<T> box = next < group ? merge(from[k], from[next]) : from[k];
                with.runs[(row + 1) % 2].put(k, box);
                if (first + k < groups) table[(row + 1) * groups + first + k] = box;
            });
        }
    }
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
        const std::uint32_t own = at.border / group, first = at.first / group, last = at.last / group;
        const bool ends = ends_group(at.border);  // then the group is below the left side as far as that reaches
        const bool left_too = first != own || ends, right_too = last != own;
        // A child consists of up to three parts. For a part that it does not have, another of its parts is read twice, which
        // changes no box: so all are read at once, and none is waited for alone.
        const aabb<T>& left_near = in_group[i].left;
        const aabb<T>* const left_end = !left_too               ? &left_near
                                        : at.first % group == 0 ? &table[first]
                                                                : &in_group[at.before].right;
        const aabb<T>& right_near = in_group[i].right;
        const bool whole = ends_group(at.last) || at.last + 1 == count;
        const aabb<T>* const right_end = !right_too ? &right_near : whole ? &table[last] : &in_group[at.after].left;
        aabb<T> left = merged(*left_end, first + 1, left_too ? ends ? own + 1 : own : 0, ends ? *left_end : left_near);
        aabb<T> right = merged(ends ? *right_end : right_near, own + 1, right_too ? last : 0, *right_end);
        nodes[at.node] = {{left, right}, {at.child[0], at.child[1]}};
        if (at.first == 0 && at.last + 1 == count) *root = {merge(left, right), bvh_child::inner(at.node)};
    }

private:
    /// The boxes a and b and those of groups `from` to before `to`, which come between them; there may be none.
    [[nodiscard]] ABUT_HD aabb<T> merged(const aabb<T>& a, std::uint32_t from, std::uint32_t to, const aabb<T>& b) const {
        const bool none = from >= to;
        const std::uint32_t row = none ? 0 : highest_bit(to - from);
        if (!none && from / group != (to - 1) / group) return merge(merge(a, long_run(from, to)), b);
        const aabb<T>& run = none ? a : table[row * groups + from];
        const aabb<T>& more = none ? a : table[row * groups + to - (1u << row)];
        return merge(merge(a, merge(run, more)), b);
    }
    /// Of more than one row's reach.
    [[nodiscard]] ABUT_HD aabb<T> long_run(std::uint32_t from, std::uint32_t to) const {
        const std::uint32_t first = from / group, last = (to - 1) / group;
        aabb<T> box = short_run(from, (first + 1) * group);
        for (std::uint32_t k = first + 1; k < last; ++k) box = merge(box, table[8 * groups + k * group]);
        return merge(box, short_run(last * group, to));
    }
    /// Two runs cover it.
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
    const auto made = plan_of(on, old);
    const auto& plan = *made;
    const auto count = static_cast<std::uint32_t>(old.nodes.size() + 1);
    const std::size_t groups = (count - 1) / execution::group_size + 1;
    execution::buffer_of<Policy, side_boxes<T>> in_group(on, plan.spanning.size());
    execution::buffer_of<Policy, aabb<T>> table(on, runs::rows * groups);
    for_each_group(on, count,
                   refit_groups<Shapes>{shapes, count, plan.leaves.data(), plan.steps.data(), fresh.nodes.data(),
                                        in_group.data(), table.data()});
    if (groups == 1) {
        for_each_index(on, 1, write_root<T>{table.data(), old.root.data(), fresh.root.data()});
        return;
    }
    for_each_group(on, groups, runs{table.data(), groups});
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

/// The boxes of `fresh` around shapes, as many as `old` has, whose topology it has: it may be `old` itself. Does not wait
/// where the topology has a plan.
template <class Policy, class Storage, shape_view Shapes>
void refit_boxes(const Policy& on, const Storage& old, const Shapes& shapes, Storage& fresh) {
    using T = typename Shapes::scalar_type;
    const std::size_t n = shapes.size();
    if (n == 1) {
        for_each_index(on, 1, refit_single<Shapes>{shapes, fresh.root.data()});
    } else if (n > 1) {
        using boxes = box_view<T, space_of<Policy>>;
        if constexpr (host_policy<Policy> && !std::same_as<Shapes, boxes>) {
            // A processor waits for what it reads out of order: a box is one line of memory, a mesh's triangle up to four.
            execution::buffer_of<Policy, aabb<T>> made(on, n);
            for_each_index(on, n, write_box<Shapes>{shapes, made.data()});
            refit_nodes(on, boxes{made.data(), n}, old, fresh);
        } else {
            refit_nodes(on, shapes, old, fresh);
        }
    }
}

/// A tree of the topology of `old` around other shapes, as many. Waits for it.
template <class Policy, class Storage, shape_view Shapes>
std::shared_ptr<Storage> refit_storage(const Policy& on, const Storage& old, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    const std::size_t n = shapes.size();
    auto fresh = std::make_shared<Storage>();
    fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, n > 0 ? 1 : 0);
    fresh->nodes = execution::buffer_of<Policy, bvh_node<T>>(on, n > 0 ? n - 1 : 0);
    fresh->plan = old.plan;
    fresh->least_ids = old.least_ids;
    fresh->along_curve = old.along_curve;
    refit_boxes(on, old, shapes, *fresh);
    synchronize(on);
    return fresh;
}

/// Whether `refit` takes the tree and the set.
template <class Policy, class Tree, class Set>
consteval bool can_refit() {
    if constexpr (!can_reside<Policy, Set>()) {
        return false;
    } else if constexpr (!lies_there<Policy, Tree>()) {
        return false;
    } else {
        constexpr bool is_standard = std::same_as<typename Tree::layout_type, standard_layout>;
        static_assert(is_standard, "abut: refit takes a tree in the standard layout; refit that one and convert the result");
        constexpr bool one_scalar =
            std::same_as<typename Tree::scalar_type, scalar_type_of<typename shape_of_object<Set>::type>>;
        static_assert(one_scalar, "abut: the tree and the set have different scalar types");
        return is_standard && one_scalar;
    }
}

/// `refit` of arguments that have been looked at.
template <class Policy, class Tree, class Set>
auto refit_tree(const Policy& on, const Tree& tree, const Set& set) {
    auto resident = make_resident(on, set, "abut::refit");
    using tree_type = bvh<decltype(resident), space_of<Policy>>;
    const auto shapes = view_of(resident);
    const std::size_t n = shapes.size();
    if (n != tree.size()) {
        throw error("abut::refit: the tree has " + std::to_string(tree.size()) + " shapes, the set " + std::to_string(n));
    }
    require_same_device(on, tree, "abut::refit");
    auto fresh = refit_storage(on, tree.stored(), shapes);
    return tree_type(std::move(resident), std::move(fresh));
}

}  // namespace detail

/// @addtogroup indices
///@{

/// A tree of the topology of `tree` over the shapes of `set`, of which there are as many: shape i takes the place of shape
/// i. `tree` stays as it is, and the two share nothing that either could change. Results of queries are right however far
/// shapes have moved; only speed suffers. How much, `quality` shows, and needs_rebuild says when to call make_bvh instead
/// (index/quality.hpp): soon where shapes change places, hardly ever where they keep their neighbours.
///
/// The set may be of another kind than the tree's. It is brought to the policy's memory and checked as by make_bvh. A tree
/// in another layout than the standard one is refitted before it is converted.
///
/// The first refit of a topology also derives in what order boxes are made, which takes longer than the refit itself. That
/// takes some 21 bytes a shape, which all trees that come of it share, `tree` too: under cuda the stream of that first refit
/// has to outlive them all. Throws error for another number of shapes, and else as the group says.
template <execution_policy Policy, class OldSet, memory_space Space, bvh_layout_kind Layout, class Set>
[[nodiscard]] auto refit(const Policy& on, const bvh<OldSet, Space, Layout>& tree, const Set& set) {
    if constexpr (detail::can_refit<Policy, bvh<OldSet, Space, Layout>, Set>()) {
        return detail::refit_tree(on, tree, set);
    } else {
        return detail::refused();
    }
}

///@}

}  // namespace abut
