// SPDX-License-Identifier: MIT
#pragma once

// traversal::from_front: where a walk of two trees, or of one with itself, came to its ends, for the next walk to begin
// there (Tang, Manocha and Tong 2010). Not for lists, nor for trees that are built anew for each query: a front belongs to
// two topologies, which `refit` hands on.
//
// All pairs of nodes that two trees could be walked to form a tree of pairs. An end is a pair whose boxes do not overlap, or
// one of leaves. Wherever boxes are, each pair of leaves is or lies below exactly one end, so a walk may begin at any set of
// ends, at those of other boxes too. What two nodes' children make is up to four ends that need the same two fetches; they
// are one item here, with a bit for each. A query that begins at a front
//
// 1. tests the children of each item's nodes, judges the pairs of leaves whose boxes overlap, and marks what is to be
//    opened: ends that are no leaves, and overlap now;
// 2. walks down from those, by for_each_descendant, and appends the items that hold their ends;
// 3. takes the marks away, and with them the ends that are none any more;
// 4. judges the pairs of leaves of what was appended.
//
// Loops that judge may run again, or stop early: marks are made from ends, which stay until 3. Items never go up again: that
// all ends below a pair of nodes could be replaced by the pair is not looked for. It would need to know of each item where
// the others below its parents are. Instead a front begins at the roots again (front_options).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/operand.hpp>
#include <abut/collide/routes.hpp>
#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/traverse/self_walk.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut {

/// What a front takes. They move speed and memory, never results.
/// @ingroup queries
struct front_options {
    /// Pairs of nodes that it may hold, 12 bytes each. Where they would be more, the query goes on without it, and the next
    /// one begins at the roots; where they are too many then, it goes without, and so do the next `reference_frames`.
    std::size_t most_items = std::size_t{1} << 24;
    /// It begins at the roots when it holds less than rebuild_threshold times as many items as that many queries ago: what
    /// does not grow any more is thought too deep for where the boxes are now. 0: it does not look at that.
    int reference_frames = 16;
    /// By what factor it has to have grown since then, or it begins at the roots.
    double rebuild_threshold = 1.05;
    /// It also begins there when it holds that many times as many as when it last did.
    double most_growth = 1.25;
};

/// What a front has seen.
/// @ingroup queries
struct front_report {
    std::uint64_t queries = 0;    ///< that began at it, or filled it
    std::uint64_t rebuilds = 0;   ///< of these, such that began at the roots
    std::uint64_t overflows = 0;  ///< queries that went without it, since it would have been too large
    std::uint64_t items = 0;      ///< pairs of nodes that it holds
    std::uint64_t kept = 0;       ///< of the last query: items that stayed as they were
    std::uint64_t opened = 0;     ///< of the last query: items of which an end, or more, was opened
    std::uint64_t added = 0;      ///< of the last query: items that it made
};

class front;

namespace detail {

struct from_front;

/// Two nodes, as an item of pair_walk names them, of which the pairs of children named by the lowest four bits are ends. Bit
/// 8 + k says that pair k is to be opened, and bit 16 that leaves' boxes overlap.
struct front_item {
    static constexpr std::uint32_t all = 0xf, meeting = 1u << 16;
    static constexpr int opened_at = 8;
    std::uint32_t a, b, marks;

    [[nodiscard]] ABUT_HD std::uint32_t ends() const { return marks & all; }
    [[nodiscard]] ABUT_HD std::uint32_t opened() const { return marks >> opened_at & all; }
};

template <class Walk>
inline constexpr bool walks_itself = false;
template <class Tree, class Overlap>
inline constexpr bool walks_itself<self_walk<Tree, Overlap>> = true;

/// The pairs of children that an item means: of a leaf itself, of a node with itself each pair once.
template <class Walk>
ABUT_HD front_item whole_item(std::uint32_t a, std::uint32_t b) {
    std::uint32_t marks = front_item::all;
    if ((a & bvh_child::leaf_bit) != 0) marks &= 0b0011u << 2 * (a & 1);
    if ((b & bvh_child::leaf_bit) != 0) marks &= 0b0101u << (b & 1);
    if (walks_itself<Walk> && a == b) marks &= 0b1011u;
    return {a, b, marks};
}

/// The place of a pair of children, a number or a type that names one: a device cannot call what makes a number of the
/// latter.
template <class Number>
ABUT_INLINE ABUT_HD unsigned place_of(const Number& k) {
    if constexpr (requires { Number::value; }) {
        return Number::value;
    } else {
        return k;
    }
}

/// What becomes of an item's ends.
struct front_marks {
    std::uint32_t ends, opened = 0;
    bool meeting = false;
};

// What a step of a walk hands on. No lambdas, as in pair_walk.
template <class Walk, class Emitter>
struct mark_opened {
    front_marks& made;
    Emitter& emitter;
    ABUT_CALLS_ANY
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Item& next) const {
        const unsigned place = place_of(k);
        const bool meant = (made.ends >> place & 1) != 0;
        made.opened |= static_cast<std::uint32_t>(is & meant) << place;
        // A leaf with itself is no end.
        if (walks_itself<Walk> && next.a == next.b && (next.a & bvh_child::leaf_bit) != 0) made.ends &= ~(1u << place);
        emitter.add(k, is & meant, whole_item<Walk>(next.a, next.b));
    }
};
struct mark_meeting {
    front_marks& made;
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number, bool is, std::uint32_t, std::uint32_t) const {
        made.meeting |= is;
    }
};

/// A step: what becomes of the item's ends. Those that are opened are handed to the emitter.
ABUT_CALLS_ANY
template <class Walk, class Emitter>
ABUT_INLINE ABUT_HD front_marks step_of_front(const Walk& walk, const front_item& at, Emitter& emitter) {
    front_marks made{at.ends()};
    walk.expand({at.a, at.b}, mark_opened<Walk, Emitter>{made, emitter}, mark_meeting{made});
    return made;
}

/// The walk down from what is opened, as the verb for_each_descendant takes it. Its candidates are the items of the front.
template <class Walk>
struct expand_front {
    using item = front_item;
    using candidate = front_item;
    static constexpr unsigned most_children = Walk::most_children, most_depth = Walk::most_depth;
    static_assert(most_children == 4);
    Walk walk;
    const front_item* from;
    std::size_t n;

    [[nodiscard]] std::size_t seeds() const { return n; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return from[i]; }
    ABUT_INLINE void prefetch(const item& at) const { walk.prefetch({at.a, at.b}); }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        const front_marks made = step_of_front(walk, at, emitter);
        const std::uint32_t ends = made.ends & ~made.opened;
        emitter.push(std::integral_constant<unsigned, 0>{}, ends != 0,
                     front_item{at.a, at.b, ends | (made.meeting ? front_item::meeting : 0)});
    }
};
struct keep_item {
    ABUT_CALLS_ANY
    template <class Kept>
    ABUT_HD bool operator()(const front_item& at, Kept& kept, auto&...) const {
        kept.push(at);
        return true;
    }
    ABUT_HD void finish(const front_item&, auto&...) const {}
};

/// Where a walk begins that has no front.
template <class Walk>
struct write_root_item {
    Walk walk;
    front_item* out;
    ABUT_HD void operator()(std::size_t) const {
        const auto root = walk.seed(0);
        *out = whole_item<Walk>(root.a, root.b);
    }
};

// The loops over the items of a front.

/// What a step finds in the items of a front: it marks what is to be opened, and pushes the pairs of leaves.
template <class Emitter>
struct mark_and_push {
    std::uint32_t ends;
    std::uint32_t& opened;
    const Emitter& emitter;
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void add(Number k, bool is, const Item&) const {
        opened |= (static_cast<std::uint32_t>(is) << place_of(k)) & ends;
    }
    ABUT_CALLS_ANY
    template <class Number, class Candidate>
    ABUT_INLINE ABUT_HD void push(Number, bool is, const Candidate& c) const {
        if (is) emitter.push(c);
    }
};

/// Items from `first` on, as the verb for_each_candidate takes them: of all, or of those alone that have pairs of leaves
/// whose boxes overlap.
template <class Expand>
struct look_in_front {
    using candidate = typename Expand::candidate;
    struct cursor {};
    Expand expand;
    front_item* items;
    std::size_t first, n;
    bool new_ones;

    [[nodiscard]] ABUT_HD bool may_find(std::size_t i) const {
        return (items[first + i].marks & (new_ones ? front_item::meeting : front_item::all)) != 0;
    }
    /// Four candidates at most. A device has room for those of all walks.
    ABUT_CALLS_ANY
    template <class Emitter, class... Sinks>
    ABUT_HD bool operator()(std::size_t i, cursor&, const Emitter& emitter, Sinks&...) const {
#if !ABUT_DEVICE_CODE
        constexpr std::size_t ahead = 8;
        if (i + ahead < n) ask_for(items[first + i + ahead]);
#endif
        const front_item at = items[first + i];
        std::uint32_t opened = 0;
        expand({at.a, at.b}, mark_and_push<Emitter>{at.ends(), opened, emitter});
        // A loop that runs again, for want of room in a queue, has to find the new ones again.
        const std::uint32_t is_new = new_ones ? at.marks & front_item::meeting : 0;
        const std::uint32_t marks = at.ends() | opened << front_item::opened_at | is_new;
        if (marks != at.marks) items[first + i].marks = marks;
        return false;
    }

private:
    ABUT_INLINE ABUT_HD void ask_for(const front_item& next) const {
        const auto node = [](std::uint32_t half) {
            const bool is_leaf = (half & bvh_child::leaf_bit) != 0;
            return bvh_child::inner(is_leaf ? (half & ~bvh_child::leaf_bit) / 2 : half);
        };
        if constexpr (walks_itself<decltype(expand.walk)>) {
            expand.walk.tree().prefetch(node(next.a));
            expand.walk.tree().prefetch(node(next.b));
        } else {
            expand.walk.a.prefetch(node(next.a));
            expand.walk.b.prefetch(node(next.b));
        }
    }
};

struct find_opened {
    const front_item* items;
    ABUT_CALLS_ANY
    template <class Opened>
    ABUT_HD void operator()(std::size_t i, Opened& opened) const {
        if (items[i].opened() != 0) opened.push(static_cast<std::uint32_t>(i));
    }
};
struct fetch_opened {
    const front_item* items;
    const std::uint32_t* which;
    front_item* out;
    ABUT_HD void operator()(std::size_t i) const {
        const front_item at = items[which[i]];
        out[i] = {at.a, at.b, at.opened()};
    }
};
/// The last of an item's ends may be gone; then the item stays, without any.
struct close_opened {
    front_item* items;
    const std::uint32_t* which;
    ABUT_HD void operator()(std::size_t i) const {
        front_item& at = items[which[i]];
        at.marks = at.ends() & ~at.opened();
    }
};

/// The walk down from what is opened, where no front has room for its ends.
template <class Item, class Walk, class Emitter>
struct push_marked {
    std::uint32_t marks;
    Emitter& emitter;
    ABUT_CALLS_ANY
    template <class Number>
    ABUT_INLINE ABUT_HD void add(Number k, bool is, const Item& next) const {
        emitter.add(k, is & has(place_of(k)), whole_item<Walk>(next.a, next.b));
    }
    ABUT_CALLS_ANY
    template <class Number, class Candidate>
    ABUT_INLINE ABUT_HD void push(Number k, bool is, const Candidate& c) const {
        emitter.push(k, is & has(place_of(k)), c);
    }

private:
    [[nodiscard]] ABUT_INLINE ABUT_HD bool has(unsigned k) const { return (marks >> k & 1) != 0; }
};
template <class Expand>
struct expand_marked {
    using walk_type = decltype(Expand::walk);
    using item = front_item;
    using candidate = typename Expand::candidate;
    static constexpr unsigned most_children = Expand::most_children, most_depth = Expand::most_depth;
    Expand expand;
    const front_item* from;
    std::size_t n;

    [[nodiscard]] std::size_t seeds() const { return n; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return from[i]; }
    ABUT_INLINE void prefetch(const item& at) const { expand.prefetch({at.a, at.b}); }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        expand({at.a, at.b}, push_marked<typename Expand::item, walk_type, sink>{at.marks, emitter});
    }
};

/// The items in memory of one kind.
struct front_memory {
    front_memory() = default;
    front_memory(const front_memory&) = delete;
    front_memory& operator=(const front_memory&) = delete;
    virtual ~front_memory() = default;
};
template <memory_space Space>
struct front_memory_in : front_memory {
    template <class Policy>
    front_memory_in(const Policy& policy, std::size_t most) : items(policy, most) {}
    execution::bounded_queue<front_item, Space> items;
};

}  // namespace detail

/// Where queries came to their ends, for the next query to begin there (docs/hierarchies.md says when that pays). It is the
/// caller's, and given with the traversal `from_front`:
///
///     abut::front ends;
///     const abut::query_options<abut::keep_all, abut::traversal::from_front> options{.front = &ends};
///     while (next_frame()) {
///         tree = refit(on, tree, moved);
///         use(pairs(on, tree, ground, options));
///     }
///
/// A query that finds it empty, or made for other topologies, in other memory or by another kind of query (of one tree or of
/// two), begins at the roots and fills it. Two queries share it only one after the other. Answers do not depend on it. Poses
/// and filters do not matter to it: they may be others in each query. In device memory it is given back in the
/// order of the stream of the policy that filled it first, which has to outlive it. Movable, not copyable.
/// @ingroup queries
class front {
public:
    /// Empty: the first query begins at the roots. Takes no memory yet.
    explicit front(const front_options& options = {}) : options_(options) {}

    /// What it was made with.
    [[nodiscard]] const front_options& options() const { return options_; }
    /// What its queries did so far.
    [[nodiscard]] const front_report& report() const { return report_; }
    /// Forgets the ends and gives their memory back. The report stays.
    void clear() {
        memory_.reset();
        sizes_.clear();
        resting_ = 0;
        report_.items = 0;
    }

private:
    friend struct detail::from_front;

    template <class Policy, schedule Schedule, class Expand, class Run>
    void walk(const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand, const detail::topology& a,
              const detail::topology& b, const Run& run) {
        const bool is_mine = is_of<Expand>(on, a, b);
        const bool begins_here = is_mine && memory_ != nullptr && !is_too_deep();
        const bool rests = is_mine && resting_ > 0;
        // Where something is thrown in between, nothing is left that a query could begin at.
        auto memory = std::move(memory_);
        if (memory == nullptr || device_ != device_of(on)) {
            memory.reset();
            memory = std::make_unique<detail::front_memory_in<space_of<Policy>>>(on, most_items());
        }
        auto& items = static_cast<detail::front_memory_in<space_of<Policy>>&>(*memory).items;
        a_ = a;
        b_ = b;
        device_ = device_of(on);
        is_of_one_ = detail::walks_itself<decltype(expand.walk)>;
        resting_ = rests ? resting_ - 1 : 0;
        report_.items = report_.kept = report_.opened = report_.added = 0;
        if (begins_here ? !advance(on, how, expand, items, run) : !fill(on, how, expand, items, rests, run)) {
            ++report_.overflows;
            return;
        }
        ++report_.queries;
        report_.items = items.size();
        memory_ = std::move(memory);
    }

    static bool are_one(const detail::topology& x, const detail::topology& y) {
        return !x.owner_before(y) && !y.owner_before(x);
    }
    template <class Expand, class Policy>
    [[nodiscard]] bool is_of(const Policy& on, const detail::topology& a, const detail::topology& b) const {
        return are_one(a, a_) && are_one(b, b_) && device_ == device_of(on) &&
               is_of_one_ == detail::walks_itself<decltype(std::declval<Expand>().walk)>;
    }
    [[nodiscard]] bool is_too_deep() const {
        const double now = static_cast<double>(report_.items);
        if (now > options_.most_growth * static_cast<double>(first_size_)) return true;
        return options_.reference_frames > 0 && sizes_.size() > static_cast<std::size_t>(options_.reference_frames) &&
               now < options_.rebuild_threshold * static_cast<double>(sizes_.front());
    }
    void remember(std::size_t size) {
        if (options_.reference_frames <= 0) return;
        if (sizes_.size() > static_cast<std::size_t>(options_.reference_frames)) sizes_.erase(sizes_.begin());
        sizes_.push_back(size);
    }
    /// Items are numbered in 32 bits.
    [[nodiscard]] std::size_t most_items() const { return std::min(options_.most_items, std::size_t{0xffffffff}); }

    // These judge all candidates, and return whether the ends found room.

    template <class Policy, schedule Schedule, class Expand, class Items, class Run>
    bool advance(const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand, Items& items,
                 const Run& run) {
        const std::size_t n = items.size();
        look(on, expand, items, 0, false, run);
        if constexpr (requires { run.is_over(); }) {
            if (run.is_over()) return true;  // not all has been marked, and no end has changed
        }
        execution::work_queue<std::uint32_t, space_of<Policy>> which(on);
        for_each_index(on, n, detail::find_opened{items.data()}, which);
        report_.opened = which.size();
        report_.kept = n - which.size();
        if (which.size() > 0) {
            execution::buffer_of<Policy, detail::front_item> opened(on, which.size());
            for_each_index(on, which.size(), detail::fetch_opened{items.data(), which.data(), opened.data()});
            if (!add_ends(on, how, expand, opened, items)) {
                judge_below(on, how, expand, opened, run);
                return false;
            }
            report_.added = items.size() - n;
            for_each_index(on, which.size(), detail::close_opened{items.data(), which.data()});
            look(on, expand, items, n, true, run);
        }
        remember(items.size());
        return true;
    }
    /// From the roots; if it `rests`, without looking for ends.
    template <class Policy, schedule Schedule, class Expand, class Items, class Run>
    bool fill(const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand, Items& items, bool rests,
              const Run& run) {
        execution::buffer_of<Policy, detail::front_item> root(on, 1);
        for_each_index(on, 1, detail::write_root_item<decltype(expand.walk)>{expand.walk, root.data()});
        items.clear();
        sizes_.clear();
        if (rests || !add_ends(on, how, expand, root, items)) {
            if (!rests) resting_ = std::max(options_.reference_frames, 0);
            judge_below(on, how, expand, root, run);
            return false;
        }
        ++report_.rebuilds;
        first_size_ = report_.added = items.size();
        remember(items.size());
        look(on, expand, items, 0, true, run);
        return true;
    }

    /// Appends the items that hold the ends below `opened`.
    template <class Policy, schedule Schedule, class Expand, class Opened, class Items>
    static bool add_ends(const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand,
                         const Opened& opened, Items& items) {
        const detail::expand_front<decltype(expand.walk)> down{expand.walk, opened.data(), opened.size()};
        for_each_descendant(on, how, down, detail::keep_item{}, items);
        return !items.overflowed();
    }
    template <class Policy, schedule Schedule, class Expand, class Opened, class Run>
    static void judge_below(const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand,
                            const Opened& opened, const Run& run) {
        const detail::expand_marked<Expand> down{expand, opened.data(), opened.size()};
        run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, down, judge, sinks...); });
    }
    template <class Policy, class Expand, class Items, class Run>
    static void look(const Policy& on, const Expand& expand, Items& items, std::size_t first, bool new_ones,
                     const Run& run) {
        const std::size_t n = items.size() - first;
        const detail::look_in_front<Expand> each{expand, items.data(), first, n, new_ones};
        run([&](const auto& judge, auto&... sinks) { return for_each_candidate(on, n, each, judge, sinks...); });
    }

    front_options options_;
    front_report report_;
    std::unique_ptr<detail::front_memory> memory_;
    detail::topology a_, b_;
    int device_ = -1;
    bool is_of_one_ = false;
    int resting_ = 0;                 ///< queries that still go without
    std::size_t first_size_ = 0;      ///< when it began at the roots
    std::vector<std::size_t> sizes_;  ///< since then, after each of the last queries
};

namespace detail {

/// Judges the candidates of a walk whose steps are `expand`, from a front; run(loop) runs a loop that judges.
struct from_front {
    template <class Policy, schedule Schedule, class Expand, class Run>
    static void walk(front& ends, const Policy& on, const execution::scheduled<Schedule>& how, const Expand& expand,
                     const topology& a, const topology& b, const Run& run) {
        ends.walk(on, how, expand, a, b, run);
    }
};

template <>
struct way_down<traversal::from_front> : goes_down {
    template <class Options>
    static void check(const Options& options, const char* function) {
        if (options.front == nullptr) throw error(std::string(function) + ": a query from a front has none");
    }
    /// Trees without a topology have no ends that another query could begin at.
    template <class Policy, class A, class B, class Expand, class Filter, schedule Schedule, class Run>
    static void descend(const Policy& on, const A& a, const B& b, const Expand& expand,
                        const query_options<Filter, traversal::from_front, Schedule>& options, const Run& run) {
        if constexpr (has_topology<A> && has_topology<B>) {
            const execution::scheduled<Schedule> how{options.scheduling};
            from_front::walk(*options.front, on, how, expand, a.shape_of_tree(), b.shape_of_tree(), run);
        } else {
            goes_down::descend(on, a, b, expand, options, run);
        }
    }
};

}  // namespace detail

}  // namespace abut
