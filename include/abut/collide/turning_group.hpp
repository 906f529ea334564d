// SPDX-License-Identifier: MIT
#pragma once

// Motions of a list on a device, where a warp walks each entry (turning.hpp has the entry, and what one thread does with
// it). The members of a group open some pairs of nodes at a time. Pairs of shapes wait until each member can search one. So
// neither waits for the longest of 32 other entries. Pairs are not taken in the order of their times, which changes no
// answer: a pair's time is its own, and the first of all is taken.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/execution/group.hpp>
#include <abut/narrow/turning_time.hpp>
#include <abut/shape/turning_reach.hpp>
#include <abut/traverse/turning_walk.hpp>

namespace abut::detail {

/// What the members of a group share while they walk two trees.
template <class Walk, class Best>
struct turning_room {
    static constexpr unsigned members = execution::subgroup_size;
    /// Where more waits than that, pairs of nodes are opened one at a time.
    static constexpr unsigned many = 224;
    static constexpr unsigned room = many + members + static_cast<unsigned>(Walk::most_below);
    struct found_pair {
        std::uint32_t a, b;
        float from;
    };
    typename Walk::item waiting[std::size_t{room}];
    found_pair found[std::size_t{2 * members}];
    Best best;
};

/// The walk of a group. In `shared.best` is what has been found, whose until() is a time after which nothing is wanted.
/// search(a, b, from, until) tells when two shapes meet. Ends where has_ended(best).
template <class Walk, class Best, class Group, class Search, class Ended>
class turning_group {
    using item = typename Walk::item;
    using look = typename Walk::template look<Best>;
    using room = turning_room<Walk, Best>;
    static constexpr unsigned members = room::members, width = static_cast<unsigned>(Walk::width);

public:
    ABUT_HD turning_group(const Group& group, room& shared, const Walk& walk, const turning_pair& both,
                          const turning_bounds& bounds, double far, const Search& search, const Ended& has_ended)
        : group_(group),
          shared_(shared),
          walk_(walk),
          both_(both),
          bounds_(bounds),
          far_(far),
          search_(search),
          has_ended_(has_ended) {}

    ABUT_CALLS_ANY
    ABUT_HD void run(float begin) {
        if (walk_.a.size() == 0 || walk_.b.size() == 0) return;
        typename Group::template value<turned_frames> frames;
        group_.each([&](unsigned k) {
            frames[k] = {};
            item root = walk_.roots(begin);
            add(k == 0 && looking(frames[k]).keeps_roots(root), root);
        });
        while (waiting_ > 0 || found_ > 0) {
            if (waiting_ > 0) open_some(frames);
            if (found_ >= members || (waiting_ == 0 && found_ > 0)) {
                search_some();
                if (has_ended_(shared_.best)) return;
            }
        }
    }

private:
    [[nodiscard]] ABUT_HD look looking(turned_frames& frames) const {
        return {walk_, both_, bounds_, far_, shared_.best, frames};
    }
    /// Called by all members in one step.
    ABUT_HD void add(bool is, const item& one) {
        const bool are_shapes = is && walk_.is_pair_of_shapes(one);
        group_.append(found_, are_shapes, [&](unsigned at) {
            shared_.found[at] = {walk_.shape_a(one), walk_.shape_b(one), one.from};
        });
        group_.append(waiting_, is && !are_shapes, [&](unsigned at) { shared_.waiting[at] = one; });
    }
    /// Opens what came last. Each member looks at one child.
    ABUT_CALLS_ANY
    template <class Frames>
    ABUT_HD void open_some(Frames& frames) {
        const unsigned count = waiting_ > room::many ? 1 : least(waiting_, members / width), first = waiting_ - count;
        typename Group::template value<item> pairs;
        group_.each([&](unsigned k) {
            if (k / width < count) pairs[k] = shared_.waiting[first + k / width];
        });
        waiting_ = first;
        group_.each([&](unsigned k) {
            bool is_kept = false;
            item child{};
            if (k / width < count && static_cast<double>(pairs[k].from) <= shared_.best.until()) {
                look by = looking(frames[k]);
                const typename look::opened pair(by, pairs[k]);
                const auto i = static_cast<int>(k % width);
                child = pairs[k];
                is_kept = i < pair.children() && pair.keeps_child(by, i, child);
            }
            add(is_kept, child);
        });
    }
    /// Each member searches one pair of shapes. Of the times that they find the least is kept, with the least ids.
    ABUT_CALLS_ANY
    ABUT_HD void search_some() {
        const unsigned count = least(found_, members), first = found_ - count;
        typename Group::template value<turning_time> times;
        group_.each([&](unsigned k) {
            times[k] = {};
            if (k >= count) return;
            const auto pair = shared_.found[first + k];
            const double from = static_cast<double>(pair.from);
            if (shared_.best.may_come_first(from, pair.a, pair.b)) {
                times[k] = search_(pair.a, pair.b, from, shared_.best.until());
            }
        });
        found_ = first;
        const double time = group_.least([&](unsigned k) { return times[k].time; });
        if (!(time <= 1)) return;
        const auto key_of = [&](unsigned k) {
            return static_cast<std::uint64_t>(shared_.found[first + k].a) << 32 | shared_.found[first + k].b;
        };
        const std::uint64_t key =
            group_.least([&](unsigned k) { return k < count && times[k].time == time ? key_of(k) : ~std::uint64_t{0}; });
        group_.each([&](unsigned k) {
            if (k >= count || times[k].time != time || key_of(k) != key) return;
            shared_.best.offer(times[k], shared_.found[first + k].a, shared_.found[first + k].b);
        });
    }

    const Group& group_;
    room& shared_;
    const Walk& walk_;
    const turning_pair& both_;
    const turning_bounds& bounds_;
    double far_;
    const Search& search_;
    const Ended& has_ended_;
    unsigned waiting_ = 0, found_ = 0;
};

}  // namespace abut::detail
