// SPDX-License-Identifier: MIT
#pragma once

// The search for pairs of features that touch, with their times. A judge's first try leaves few pairs, and of these the time
// says whether they touch at all: so nothing is decided twice.
//
// A thread of the host does both where a pair is found. On a device there are three stages, each with full warps: candidates
// are gathered, as many as find room; the first try reads these; and what it leaves is timed. A walk that does all of it
// would hold the registers of all three. What a device cannot time it leaves to the host, which comes when all is found
// (impacts.hpp).

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/judge.hpp>
#include <abut/collide/search.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/narrow/time_of_impact.hpp>

namespace abut::detail {

/// A judge that tells when two features in motion first touch. Times are 0 or more, time_in_bits::none of features that do
/// not touch, and time_in_bits::unknown where a host has to be asked.
///   decide(s, t)        the first try: `no` of those that do not touch
///   time(s, t)          in registers
///   time_on_host(s, t)  known
template <class J, class S, class U>
concept timing_judge = requires(const J& judge, const S& s, const U& u) {
    { judge.decide(s, u) } -> std::same_as<verdict>;
    { judge.time(s, u) } -> std::same_as<double>;
    { judge.time_on_host(s, u) } -> std::same_as<double>;
};

// What such a judge says of the shapes of a pair.

template <class Judge>
struct first_try {
    const Judge& judge;
    template <class S, class U>
    ABUT_INLINE ABUT_HD bool operator()(const S& s, const U& t) const {
        return judge.decide(s, t) != verdict::no;
    }
};
template <class Judge>
struct time_by {
    const Judge& judge;
    template <class S, class U>
    ABUT_HD double operator()(const S& s, const U& t) const {
        return judge.time(s, t);
    }
};
template <class Judge>
struct time_on_host_by {
    const Judge& judge;
    template <class S, class U>
    double operator()(const S& s, const U& t) const {
        return judge.time_on_host(s, t);
    }
};

/// A pair that touches, or whose time is not known yet.
struct timed_key {
    std::uint64_t key;
    double time;
};
template <class Policy>
using timed_queue = execution::work_queue<timed_key, space_of<Policy>>;

/// On a host: judges candidates by their keys, as the verbs of a policy take a judge.
template <class View, class Judge>
struct time_at_once {
    View both;
    Judge judge;

    template <class Hits>
    bool operator()(std::uint64_t key, Hits&) const {
        return !both.with_shapes(key, first_try<Judge>{judge});
    }
    template <class Hits>
    void finish(std::uint64_t key, Hits& hits) const {
        const double time = both.with_shapes(key, time_on_host_by<Judge>{judge});
        if (time >= 0) hits.push({key, time});
    }
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const { both.prefetch(key, step); }
};
/// The same of a loop whose sink takes candidates.
template <class View, class Judge, class Hits>
struct time_pushed {
    const time_at_once<View, Judge>& judge;
    Hits& hits;
    void push(std::uint64_t key) const {
        if (!judge(key, hits)) judge.finish(key, hits);
    }
};

// On a device.

struct gather_candidate {
    part_of_open part;
    ABUT_CALLS_ANY
    template <class Near>
    ABUT_HD bool operator()(std::uint64_t key, Near& near, auto&...) const {
        if (part.holds(key)) near.push(key);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};
template <class View, class Judge>
struct try_gathered {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Open>
    ABUT_HD void operator()(std::size_t i, Open& open) const {
        if (both.with_shapes(keys[i], first_try<Judge>{judge})) open.push(keys[i]);
    }
};
template <class View, class Judge>
struct time_gathered {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD void operator()(std::size_t i, Hits& hits) const {
        const double time = both.with_shapes(keys[i], time_by<Judge>{judge});
        if (time != time_in_bits::none) hits.push({keys[i], time});
    }
};

/// Times candidates that have been gathered.
template <class Policy, class View, class Judge>
void time_candidates(const Policy& on, const View& both, const Judge& judge, const std::uint64_t* keys, std::size_t count,
                     timed_queue<Policy>& hits) {
    key_queue<Policy> open(on, std::max(count / 8, std::size_t{1} << 16));
    for_each_index(on, count, try_gathered<View, Judge>{both, judge, keys}, open);
    for_each_index(on, open.size(), time_gathered<View, Judge>{both, judge, open.data()}, hits);
}

/// Candidates that are gathered on a device at a time: 128 for each shape, 64 MiB of them at least and 512 at most.
inline constexpr std::size_t least_gathered = std::size_t{1} << 23, most_gathered = std::size_t{1} << 26;

/// Gathers candidates in `room`, as many as there is room for, and calls pass(count) when it has a part of them; until that
/// has been all of them.
template <class Policy, class Pairing, class Pass>
void gather_in_parts(const Policy& on, const Pairing& pairing, execution::buffer_of<Policy, std::uint64_t>& room,
                     const Pass& pass, part_of_open part = {}) {
    std::size_t count = 0;  // of all loops of a walk
    pairing.judge_candidates(on, [&](const auto& loop) {
        const std::size_t taken = std::min(count, room.size());
        execution::capped_queue<std::uint64_t, space_of<Policy>> near(room.data() + taken, room.size() - taken);
        loop(gather_candidate{part}, near);
        count += static_cast<std::size_t>(near.pushed());
    });
    if (count <= room.size()) return pass(count);
    const auto more = static_cast<std::uint32_t>(2 * count / room.size() + 1);
    for (std::uint32_t k = 0; k < more; ++k) gather_in_parts(on, pairing, room, pass, part.split(k, more));
}

/// Leaves in `hits` the pairs of a pairing that touch, with their times.
template <class Policy, class Pairing, class Judge>
void search_times(const Policy& on, const Pairing& pairing, const Judge& judge, timed_queue<Policy>& hits) {
    const auto both = pairing.view();
    using view = std::remove_const_t<decltype(both)>;
    if constexpr (host_policy<Policy>) {
        const time_at_once<view, Judge> time{both, judge};
        pairing.judge_candidates(on, [&](const auto& loop) { loop(time, hits); });
    } else {
        const std::size_t most = std::max(both.a.most(), both.b.most());
        execution::buffer_of<Policy, std::uint64_t> room(on, std::clamp(128 * most, least_gathered, most_gathered));
        gather_in_parts(on, pairing, room,
                        [&](std::size_t count) { time_candidates(on, both, judge, room.data(), count, hits); });
    }
}

}  // namespace abut::detail
