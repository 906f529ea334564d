// SPDX-License-Identifier: MIT
#pragma once

// Ordered walks from each of many indices (ordered_walk.hpp), and how a host takes several of them at once through a tree
// that is made for a processor: in steps in turn, or, of lines that go nearly the same way, from common entries.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/box_measure.hpp>
#include <abut/shape/line_bundle.hpp>
#include <abut/shape/view.hpp>
#include <abut/traverse/ordered_walk.hpp>

namespace abut::detail {

/// The same walk on a host in steps, each of which asks memory for what the next one reads. A core that takes the steps of
/// several walks in turn works on one while memory answers another: O. Kocberber, B. Falsafi, B. Grot, Asynchronous memory
/// access chaining (2015).
template <bvh_layout Tree>
class steps_through_tree {
public:
    explicit steps_through_tree(const ordered_tree_walk<Tree>& walk) : tree_(walk.tree), watch_(walk.watch) {}

    template <class Reach, class Best>
    void begin(Reach& reach, const Best& best) {
        bound_ = infinity<double>;
        tighten(reach, best, bound_);
        ties_ = ties_met<>(watch_);
        place_.begin(tree_, ties_.below);
        is_asked_for_ = false;
    }

    /// One node, or one shape: visitor(id). False after the last.
    template <shape_view Shapes, class Reach, class Best, class Visitor>
    bool step(const Shapes& shapes, Reach& reach, const Best& best, const Visitor& visitor) {
        const bvh_child child = place_.at.child;
        if (!reach.keeps(place_.at.least)) {
            if (!place_.next(reach, pending_)) return false;
        } else if (!child.is_leaf()) {
            if (!place_.descend(tree_, ties_.below, reach, pending_)) return false;
        } else if (!is_asked_for_) {
            prefetch_shape(shapes, child.index(), 1);
            is_asked_for_ = true;
            return true;
        } else {
            ties_.visit(visitor, child.index());
            tighten(reach, best, bound_);
            if (!place_.next(reach, pending_)) return false;
        }
        is_asked_for_ = false;
        if (place_.at.child.is_leaf()) {
            prefetch_shape(shapes, place_.at.child.index(), 0);
        } else {
            tree_.prefetch(place_.at.child);
        }
        return true;
    }

private:
    Tree tree_;
    tie_watch* watch_;
    ties_met<> ties_{nullptr};
    place_in_tree<Tree> place_;
    typename place_in_tree<Tree>::room pending_;
    double bound_;
    bool is_asked_for_;
};

/// Whether a walk can go in steps: through a tree that is made for a processor. Binary nodes are too little work for a step.
template <class Walk>
inline constexpr bool goes_in_steps = false;
template <bvh_layout Tree>
inline constexpr bool goes_in_steps<ordered_tree_walk<Tree>> = (Tree::width > 2);

/// What an index of `All` looks along, as its walk takes it.
template <class All>
using reach_of_look =
    line_reach_of<decltype(All::walk), typename decltype(std::declval<const All&>().seen(0))::scalar_type>;

/// One index after another walks in steps. `all` is that of from_each, and is referred to.
template <class All>
class steps_from {
    using tree_type = std::remove_cvref_t<decltype(std::declval<const All&>().walk.tree)>;
    using look_type = decltype(std::declval<const All&>().start(0));
    using reach_type = reach_of_look<All>;

public:
    explicit steps_from(const All& all) : all_(&all), steps_(all.walk) {}

    template <class Sink>
    void begin(std::size_t i, const Sink& sink) {
        look_ = all_->start(i);
        reach_.emplace(all_->seen(i));
        steps_.begin(*reach_, sink);
    }
    template <class Sink>
    bool step(Sink& sink) {
        return steps_.step(all_->shapes, *reach_, sink, [&](std::uint32_t id) { return look_(*all_, id, sink); });
    }
    template <class Sink>
    void end(std::size_t i, Sink& sink) {
        look_.end(*all_, i, sink);
    }

private:
    const All* all_;
    look_type look_;
    std::optional<reach_type> reach_;  // made in its place
    steps_through_tree<tree_type> steps_;
};

/// What some lines that are asked together may reach of a tree: shapes, and nodes where there was no room to go on, in groups
/// of four, near ones first. All lines go down from the root as one, to the nearest child first: A. Reshetov, A. Soupikov,
/// J. Hurley, Multi-level ray tracing algorithm (2005). So what lies in front is found down to its shapes, and what lies
/// behind that, which few of the lines come to, stays in nodes.
template <bvh_layout Tree>
class bundle_entries {
public:
    using T = typename Tree::scalar_type;
    static constexpr int most = 64;

    /// False where so little is left out below the root that the lines had better begin there. Shapes are asked for.
    template <shape_view Shapes>
    bool find(const Tree& tree, const bundle_reach<T>& lines, const Shapes& shapes) {
        constexpr int first_nodes = 16, most_nodes = 4 * most;
        part waits[most];  // not initialised
        int waiting = 0, opened = 0, looked_at = 0, left_out = 0;
        count_ = 0;
        if (tree.root().is_leaf()) return false;
        part at{nullptr, 0, 0};
        bvh_child child = tree.root();
        for (;;) {
            if (child.is_leaf() || count_ + waiting + Tree::width > most || opened == most_nodes) {
                add(at, child);
            } else {
                const auto& node = tree.fetch(child.index());
                const int children = tree.children(node), first = waiting;
                T times[4];
                for (unsigned kept = lines.reached(tree.all_planes(node), times) & ((1u << children) - 1); kept != 0; kept &= kept - 1) {
                    const auto slot = static_cast<int>(lowest_bit(kept));
                    const part one{&node, slot, times[slot]};
                    tree.prefetch(tree.child(node, slot));
                    if (tree.child(node, slot).is_leaf()) prefetch_shape(shapes, tree.child(node, slot).index(), 0);
                    int k = waiting++;
                    for (; k > first && one.time > waits[k - 1].time; --k) waits[k] = waits[k - 1];
                    waits[k] = one;
                }
                if (++opened <= first_nodes) {
                    looked_at += children;
                    left_out += children - (waiting - first);
                }
            }
            if (waiting == 0) break;
            at = waits[--waiting];
            child = tree.child(*at.node, at.slot);
        }
        finish(shapes);
        return 4 * left_out >= looked_at;
    }

    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] auto planes(int group) const -> const T (&)[6][4] { return planes_[group]; }
    /// Around each of four groups, from 4 k on.
    [[nodiscard]] auto around(int k) const -> const T (&)[6][4] { return around_[k]; }
    [[nodiscard]] bvh_child child(int k) const { return found_[k]; }

private:
    /// What a slot of a node holds, and when the lines come to it at the soonest.
    struct part {
        const typename Tree::node_type* node;
        int slot;
        T time;
    };

    void add(const part& at, bvh_child child) {
        const auto& planes = Tree::all_planes(*at.node);
        for (int plane = 0; plane < 6; ++plane) planes_[count_ / 4][plane][count_ % 4] = planes[plane][at.slot];
        found_[count_++] = child;
    }
    /// Empty slots hold what the last one does: they are passed over later.
    template <class Shapes>
    void finish(const Shapes& shapes) {
        const int groups = (count_ + 3) / 4;
        for (int k = count_; k % 4 != 0; ++k) {
            for (T(&row)[4] : planes_[k / 4]) row[k % 4] = row[0];
        }
        for (int g = 0; g < groups || g % 4 != 0; ++g) {
            for (int plane = 0; plane < 6; ++plane) {
                const T(&row)[4] = planes_[least(g, groups - 1)][plane];
                around_[g / 4][plane][g % 4] =
                    plane < 3 ? least(row[0], row[1], row[2], row[3]) : greatest(row[0], row[1], row[2], row[3]);
            }
        }
        for (int k = 0; k < count_; ++k) {
            if (found_[k].is_leaf()) prefetch_shape(shapes, found_[k].index(), 1);
        }
    }

    alignas(16) T planes_[most / 4][6][4];   // not initialised
    alignas(16) T around_[most / 16][6][4];  // likewise
    bvh_child found_[most];
    int count_ = 0;
};

/// Walks of some lines that are asked together, one after another, from their entries on, if neighbours are less far apart
/// than shapes are long: what one line has read the next one then finds near. Lines that are farther apart wait for memory,
/// and are taken in turns sooner. Four entries are looked at at a time, and what is below them is done with before the next
/// four, which are farther away. Otherwise these walks are those of ordered_tree_walk, with a stack of their own.
template <class All>
class bundle_walk {
    using tree_type = std::remove_cvref_t<decltype(std::declval<const All&>().walk.tree)>;
    using T = typename tree_type::scalar_type;
    using entry = typename place_in_tree<tree_type>::entry;

public:
    explicit bundle_walk(const All& all) : all_(&all) {
        const aabb<T> box = all.walk.tree.root_bounds();
        const vec3<double> side = widened(box.upper) - widened(box.lower);
        middle_ = 0.5 * (widened(box.lower) + widened(box.upper));
        size_of_shape_ = std::sqrt(half_surface(side) / static_cast<double>(all.walk.tree.size()));
    }

    /// False, and nothing is done, where lines from first to last are too few, or go too different ways, to be asked
    /// together.
    template <class Sink>
    ABUT_NOINLINE bool operator()(std::size_t first, std::size_t last, Sink& sink) {
        constexpr std::size_t few = 8;
        if (last - first < few || (all_->walk.watch != nullptr && all_->walk.watch->is_known())) return false;
        line_bounds<T> between(all_->seen(first));
        for (std::size_t i = first + 1; i < last; ++i) between.add(all_->seen(i));
        if (!(apart(between, last - first) <= size_of_shape_)) return false;
        const bundle_reach<T> lines(between);
        if (lines.coordinates_told() < 2 || !entries_.find(all_->walk.tree, lines, all_->shapes)) {
            return false;
        }
        for (std::size_t i = first; i < last; ++i) {
            sink.begin(i);
            auto look = all_->start(i);
            if (entries_.count() > 0) {
                reach_of_look<All> reach(all_->seen(i));
                ties_met<> ties(all_->walk.watch);
                walk(reach, sink, [&](std::uint32_t id) {
                    ties.visit([&](std::uint32_t shape) { return look(*all_, shape, sink); }, id);
                });
            }
            look.end(*all_, i, sink);
            sink.end(i);
        }
        return true;
    }

private:
    /// How far apart neighbours are, about, where they are as far away as the middle of the tree. No number for some lines.
    [[nodiscard]] double apart(const line_bounds<T>& lines, std::size_t count) const {
        const aabb<T> origins = lines.origins(), directions = lines.directions();
        const auto middle = [](const aabb<T>& box) { return 0.5 * (widened(box.lower) + widened(box.upper)); };
        const auto longest = [](const vec3<double>& v) { return greatest(absolute(v.x), absolute(v.y), absolute(v.z)); };
        const auto sides = [](const aabb<T>& box) { return widened(box.upper) - widened(box.lower); };
        const double time = longest(middle_ - middle(origins)) / longest(middle(directions));
        return longest(sides(origins) + time * sides(directions)) / static_cast<double>(count - 1);
    }

    template <class Reach, class Best, class Visitor>
    ABUT_INLINE void walk(Reach& reach, const Best& best, const Visitor& visitor) {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        T least_of[8][4], ignored[4];
        for (int begin = 0; begin < entries_.count(); begin += 32) {
            const int count = least(entries_.count() - begin, 32);
            const int first = begin / 4;
            unsigned groups = reach.least_in_four(entries_.around(first / 4), ignored);
            if (count > 16) groups |= reach.least_in_four(entries_.around(first / 4 + 1), ignored) << 4;
            unsigned kept = 0;
            for (groups &= ~0u >> (32 - (count + 3) / 4); groups != 0; groups &= groups - 1) {
                const auto g = static_cast<int>(lowest_bit(groups));
                kept |= reach.least_in_four(entries_.planes(first + g), least_of[g]) << 4 * g;
            }
            for (kept &= ~0u >> (32 - count); kept != 0; kept &= kept - 1) {
                const auto k = static_cast<int>(lowest_bit(kept));
                const entry at{entries_.child(begin + k), least_of[k / 4][k % 4]};
                if (!reach.keeps(at.least)) continue;
                if (at.child.is_leaf()) {
                    visitor(at.child.index());
                    tighten(reach, best, bound);
                } else {
                    pending_[0] = at;
                    take_waiting(pending_ + 1, reach, best, bound, visitor);
                }
            }
        }
    }
    /// Those that wait from pending_ up to `top`, until none does.
    template <class Reach, class Best, class Visitor>
    ABUT_INLINE void take_waiting(entry* top, Reach& reach, const Best& best, double& bound, const Visitor& visitor) {
        const tree_type& tree = all_->walk.tree;
        T least_of[4];
        while (top != pending_) {
            entry at = *--top;
            if (!reach.keeps(at.least)) continue;
            while (!at.child.is_leaf()) {
                const auto& node = tree.fetch(at.child.index());
                unsigned kept = reach.least_in_four(tree.all_planes(node), least_of) & ((1u << tree.children(node)) - 1);
                if (kept == 0) break;
                for (int slot = 0; slot < tree_type::width; ++slot) ask_for(tree.child(node, slot));
                const auto take = [&] {
                    const auto slot = static_cast<int>(lowest_bit(kept));
                    kept &= kept - 1;
                    return entry{tree.child(node, slot), least_of[slot]};
                };
                at = take();
                entry* const below = top;
                while (kept != 0) {
                    entry other = take();
                    if (other.least < at.least) std::swap(at, other);
                    entry* to = top++;
                    for (; to != below && other.least > to[-1].least; --to) *to = to[-1];
                    *to = other;
                }
            }
            if (!at.child.is_leaf()) continue;
            visitor(at.child.index());
            tighten(reach, best, bound);
        }
    }

    /// Of each node that is reached all children are asked for, those too that are not: a neighbour soon reaches them.
    ABUT_INLINE void ask_for(bvh_child child) const {
        if (child.is_leaf()) {
            prefetch_shape(all_->shapes, child.index(), 0);
            prefetch_shape(all_->shapes, child.index(), 1);
        } else {
            all_->walk.tree.prefetch(child);
        }
    }

    const All* all_;
    vec3<double> middle_;   ///< of the tree
    double size_of_shape_;  ///< about how long one is, if all lie on a surface like that of the box around them
    bundle_entries<tree_type> entries_;
    entry pending_[bvh_max_depth * (tree_type::width - 1) + 1 + 4];
};

/// A functor for for_each_ordered: a walk from each index. `all` has `walk` and `shapes`; all.start(i) is what looks from
/// index i: its look(all, id, sink) at shapes that it comes to, and look.end(all, i, sink) after the last. Where the least is
/// looked for, a look says whether it was at a tie. all.seen(i) is the line along which it looks. all.start_plainly(i), if it has
/// that, is a look that may give up in the end: on a device it goes first.
template <class All>
struct from_each {
    All all;

    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& sink) const {
#if ABUT_DEVICE_CODE
        if constexpr (requires { all.start_plainly(i); }) {
            Sink mine = sink;
            auto look = all.start_plainly(i);
            reach_of_look<All> reach(all.seen(i));
            all.walk(reach, mine, [&](walk_id<decltype(All::walk)> id) { look(all, id, mine); });
            // By value: nothing of the walk above has an address that others know.
            sink = look.end(all, mine) ? mine : walk_apart(all, i, sink);
            return;
        }
#endif
        walk(i, sink);
    }
    [[nodiscard]] bool pays_in_steps() const requires goes_in_steps<decltype(All::walk)> { return all.walk.pays_in_steps(); }
    [[nodiscard]] auto in_steps() const requires goes_in_steps<decltype(All::walk)> { return steps_from(all); }
    [[nodiscard]] auto in_bundles() const requires goes_in_steps<decltype(All::walk)> { return bundle_walk(all); }

private:
    template <class Sink>
    ABUT_NOINLINE ABUT_HD static Sink walk_apart(All all, std::size_t i, Sink sink) {
        from_each{all}.walk(i, sink);
        return sink;
    }
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void walk(std::size_t i, Sink& sink) const {
        auto look = all.start(i);
        reach_of_look<All> reach(all.seen(i));
        all.walk(reach, sink, [&](walk_id<decltype(All::walk)> id) { return look(all, id, sink); });
        look.end(all, i, sink);
    }
};
template <class All>
from_each(const All&) -> from_each<All>;

}  // namespace abut::detail
