// SPDX-License-Identifier: MIT
#pragma once

// Meshes in motion in a stream (async.hpp): impacts, first_impact and safe_step of indices, without a wait. The stages are
// those of the search that waits (timed_search.hpp): candidates are gathered, tried and timed. What differs is who knows how
// many there are: each stage leaves that on the device, and the next is a loop over so many (for_each_indirect).

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/collide/async.hpp>
#include <abut/collide/feature_pairing.hpp>
#include <abut/collide/features.hpp>
#include <abut/collide/first_impact.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/safe_step.hpp>
#include <abut/collide/timed_search.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::detail {

/// Candidates are many, and few of them are left by the first try.
template <scalar T>
inline constexpr std::uint64_t most_open_of<impact<T>> = most_open_of<double>;

/// What kernels leave for those that follow, all 0 at first. The first three are as the counts of a loop (undecided_of).
struct motion_counts {
    std::uint64_t near, found, undecided;
    std::uint64_t of_vertices, of_edges;  ///< candidates of each kind
    std::uint64_t open;                   ///< what the first try leaves
    std::uint64_t least_time;             ///< by its bits, which have the order of times; the largest word if there is none
    std::uint64_t least_key;              ///< at that time
    std::uint32_t tries, timings;         ///< indices of the loops to come
    std::uint32_t spread;                 ///< a lane in so many times one
};
/// Between loops. Where candidates found no room none is tried.
struct begin_tries {
    motion_counts* counts;
    std::uint64_t capacity;
    ABUT_HD void operator()(std::size_t) const {
        counts->near = counts->of_vertices + counts->of_edges;
        counts->tries = counts->near <= capacity ? static_cast<std::uint32_t>(counts->near) : 0;
        counts->least_time = counts->least_key = ~std::uint64_t{0};
    }
};
struct begin_timings {
    motion_counts* counts;
    ABUT_HD void operator()(std::size_t) const {
        const auto n = static_cast<std::uint32_t>(counts->open);
        counts->spread = spread_of(n);
        counts->timings = n * counts->spread;
    }
};

template <class View, class Judge, class Open>
struct try_in_stream {
    View both;
    Judge judge;
    const std::uint64_t *begin, *end;
    const motion_counts* counts;
    Open open;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        const gathered_features near{begin, end, static_cast<std::size_t>(counts->of_vertices),
                                     static_cast<std::size_t>(counts->of_edges)};
        Open sink = open;
        try_gathered<View, Judge>{both, judge, near}(i, sink);
    }
};
/// take(both, place, key, time, counts) of each, also where its time is none or not known.
template <class View, class Judge, class Take>
struct time_in_stream {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    motion_counts* counts;
    Take take;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t spread = counts->spread;
        if (i % spread != 0) return;
        const std::uint64_t key = keys[i / spread];
        take(both, i / spread, key, both.with_shapes(key, time_by<Judge>{judge}), *counts);
    }
};

/// All, in a list of fixed room: `keys` is the sink of a queue.
template <class Keys>
struct take_all {
    Keys keys;
    double* times;
    ABUT_CALLS_ANY
    template <class View>
    ABUT_HD void operator()(const View&, std::size_t, std::uint64_t key, double time, motion_counts& counts) const {
        if (time == time_in_bits::unknown) execution::atomic_add(&counts.undecided, std::uint64_t{1});
        if (time < 0) return;
        const std::uint64_t at = keys.take_place();
        if (at >= keys.capacity) return;
        keys.data[at] = key;
        times[at] = time;
    }
};
ABUT_HD inline void keep_least(std::uint64_t* least, std::uint64_t word) {
    if (word < execution::atomic_load(least)) execution::atomic_min(least, word);
}
/// The least time, with all times by their bits, of which those below 0 are larger than others.
struct take_least {
    std::uint64_t* times;
    template <class View>
    ABUT_HD void operator()(const View&, std::size_t place, std::uint64_t, double time, motion_counts& counts) const {
        const auto bits = ABUT_BIT_CAST(std::uint64_t, time);
        times[place] = bits;
        if (time == time_in_bits::unknown) execution::atomic_add(&counts.undecided, std::uint64_t{1});
        if (time >= 0) keep_least(&counts.least_time, bits);
    }
};
/// The least key at the least time.
struct take_first_key {
    const std::uint64_t *keys, *times;
    motion_counts* counts;
    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t spread = counts->spread;
        if (i % spread != 0 || times[i / spread] != counts->least_time) return;
        execution::atomic_min(&counts->least_key, keys[i / spread]);
    }
};
/// The least time, where what is not known is no later than a bound.
struct take_safe {
    conservative_bounds bounds;
    template <class View>
    ABUT_HD void operator()(const View& both, std::size_t, std::uint64_t key, double time, motion_counts& counts) const {
        if (time == time_in_bits::unknown) {
            using judge = time_in_motion<conservative>;
            time = both.with_shapes(key, time_by<judge>{{bounds}});
            if (time >= 0) execution::atomic_add(&counts.undecided, std::uint64_t{1});
        }
        if (time >= 0) keep_least(&counts.least_time, ABUT_BIT_CAST(std::uint64_t, time));
    }
};

template <class View>
struct write_found_impacts {
    View both;
    const std::uint64_t* keys;
    const double* times;
    const async_state* state;
    impact<typename View::scalar_type>* out;
    ABUT_HD void operator()(std::size_t i) const {
        if (i < state->size) out[i] = impact_of(both, keys[i], times[i]);
    }
};
template <class View>
struct write_first_impact {
    View both;
    const motion_counts* counts;
    std::uint64_t open_capacity, capacity;
    async_state* state;
    impact<typename View::scalar_type>* out;
    ABUT_HD void operator()(std::size_t) const {
        const std::uint64_t needed = counts->least_key != ~std::uint64_t{0} ? 1 : 0, size = needed < capacity ? needed : capacity;
        *state = {size, needed, undecided_of(&counts->near, open_capacity)};
        if (size > 0) *out = impact_of(both, counts->least_key, ABUT_BIT_CAST(double, counts->least_time));
    }
};
struct write_safe_step {
    const motion_counts* counts;
    std::uint64_t open_capacity;
    bool is_contact;
    async_value_state<double>* out;
    ABUT_HD void operator()(std::size_t) const {
        const bool knows_all = counts->near <= open_capacity, meets = counts->least_time != ~std::uint64_t{0};
        const double part = meets ? safe_part(ABUT_BIT_CAST(double, counts->least_time), is_contact) : 1;
        *out = {knows_all ? part : 0, undecided_of(&counts->near, open_capacity)};
    }
};

/// A search of pairs of features in a stream, from candidates to those that a judge's first try leaves.
template <class Policy, class View, class Judge>
class motion_in_stream {
    using numbers = execution::buffer_of<Policy, std::uint64_t>;
    using queue = execution::capped_queue<std::uint64_t, space_of<Policy>>;
    using from_end = execution::capped_queue_from_end<std::uint64_t, space_of<Policy>>;

public:
    /// `loops` are those of a result, whose open capacity is the room for candidates.
    template <class Pairing, class Room>
    motion_in_stream(const Policy& policy, const Pairing& pairing, const Judge& judge, Room& loops)
        : on_(policy), both_(pairing.view()), judge_(judge), capacity_(room_for(both_, loops.open_capacity)),
          near_(policy, capacity_), open_(policy, capacity_), counts_(policy, 1) {
        static_assert(feature_judge<Judge, View>, "abut: the judge is no timing_judge of pairs of features");
        fill(on_, counts_.data(), 1, motion_counts{});
        fill(on_, loops.counters.data(), loops.counters.size(), std::uint64_t{0});
        motion_counts* const counts = counts_.data();
        const execution::async_loop loop{loops.counters.data(), loops.counts(), nullptr, 0};
        execution::async_queue<execution::counted_queue<queue>> vertices{{queue(near_.data(), capacity_), &counts->of_vertices}, loop};
        execution::counted_queue<from_end> edges{from_end(near_.data(), capacity_), &counts->of_edges};
        pairing.judge_candidates(on_, [&](const auto& run) { run(gather_features{{}, both_.key}, vertices, edges); });
        for_each_index(on_, 1, begin_tries{counts, capacity_});
        const auto sink = queue(open_.data(), capacity_).make_sink(&counts->open);
        const try_in_stream<View, Judge, std::remove_const_t<decltype(sink)>> tries{
            both_, judge_, near_.data(), near_.data() + capacity_, counts, sink};
        for_each_indirect(on_, &counts->tries, tries);
        for_each_index(on_, 1, begin_timings{counts});
    }

    template <class Take>
    void time(const Take& take) {
        for_each_indirect(on_, &counts_.data()->timings,
                          time_in_stream<View, Judge, Take>{both_, judge_, open_.data(), counts_.data(), take});
    }
    [[nodiscard]] const View& both() const { return both_; }
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    [[nodiscard]] const std::uint64_t* keys() const { return open_.data(); }
    /// For a word of each that is timed.
    [[nodiscard]] std::uint64_t* words() { return near_.data(); }
    [[nodiscard]] motion_counts* counts() { return counts_.data(); }

private:
    static std::uint64_t room_for(const View& both, std::uint64_t asked) {
        const auto pairs_of = [](std::size_t n, std::size_t m) { return std::uint64_t{n} * m; };
        const std::uint64_t all = pairs_of(both.a.vertices.size(), both.b.faces.size()) +
                                  pairs_of(both.a.faces.size(), both.b.vertices.size()) +
                                  pairs_of(both.a.edges.size(), both.b.edges.size());
        return std::min({asked, all, std::uint64_t{1} << 31});
    }

    const Policy& on_;
    View both_;
    Judge judge_;
    std::uint64_t capacity_;
    numbers near_, open_;
    execution::buffer_of<Policy, motion_counts> counts_;
};

/// Whether an impact query in a stream takes both.
template <bool Within, class Policy, class X, class Y>
consteval bool can_collide_async() {
    constexpr bool on_device = !host_policy<Policy>;
    static_assert(on_device, "abut: calls that do not wait are for cuda; a host's policy has nothing to wait for");
    if constexpr (!on_device) {
        return false;
    } else if constexpr (!is_impact_index<X> || !is_impact_index<Y>) {
        constexpr bool are = is_impact_index<X> && is_impact_index<Y>;
        static_assert(are, "abut: calls that do not wait look for impacts of indices alone: make_impact_index, or an async_index");
        return false;
    } else if constexpr (!can_collide<Within, Policy, X, Y>()) {
        return false;
    } else {
        constexpr bool is_default = X::rule == pair_rule::feature_trees;
        static_assert(is_default, "abut: calls that do not wait take indices of pair_rule::feature_trees");
        return is_default;
    }
}

/// use(search) with a search of two indices, or `Within` one, in the stream.
template <motion_arithmetic A, bool Within, class Policy, class Outcome, class Index, class Judge, class Use>
void search_in_stream(const async<Policy, Outcome>& stream, const Index& a, const Index& b, const Judge& judge,
                      const conservative_bounds& bounds, const std::string& function, const Use& use) {
    const Policy& on = stream.policy();
    const auto near = nearness_of<A, typename Index::scalar_type>(bounds, function.c_str());
    require_same_device(on, a, function.c_str());
    require_same_device(on, b, function.c_str());
    check_outcome(on, stream.into(), function);
    const feature_pairing<Within, Index, std::remove_const_t<decltype(near)>, no_fronts> pairing(a, b, near, {}, function.c_str());
    motion_in_stream<Policy, std::remove_cvref_t<decltype(pairing.view())>, Judge> search(on, pairing, judge,
                                                                                          async_parts::room(stream.into()));
    use(search);
}

template <class Policy, class Outcome, motion_arithmetic A, bool Within, class X, class Y>
void ask_motion(const async<Policy, Outcome>& stream, const ask_impacts<A, Within>& question, const X& a, const Y& b,
                const impact_options& options) {
    if constexpr (can_collide_async<Within, Policy, X, Y>()) {
        using T = typename X::scalar_type;
        static_assert(std::same_as<Outcome, async_result<impact<T>, space_of<Policy>>>,
                      "abut: impacts go into an async_result of impact of the scalar type of their meshes");
        const Policy& on = stream.policy();
        const time_in_motion<A> judge{options.bounds};
        search_in_stream<A, Within>(
            stream, a, b, judge, options.bounds, std::string(question.function) + "_async", [&](auto& search) {
                using view = std::remove_cvref_t<decltype(search.both())>;
                const std::size_t capacity = stream.into().capacity();
                const int bits = search.both().key.bits();
                execution::buffer_of<Policy, std::uint64_t> keys(on, capacity);
                execution::buffer_of<Policy, double> times(on, capacity);
                // No pair has the largest key, so places that stay empty come last.
                if (options.sorted) fill(on, keys.data(), capacity, ~std::uint64_t{0} >> (64 - bits));
                execution::capped_queue<std::uint64_t, space_of<Policy>> found(keys.data(), capacity);
                const auto places = found.make_sink(&search.counts()->found);
                search.time(take_all<std::remove_const_t<decltype(places)>>{places, times.data()});
                if (options.sorted) sort_by_key(on, keys, times, bits);
                async_state* const state = async_parts::room(stream.into()).state.data();
                for_each_index(on, 1, write_list_state{&search.counts()->near, capacity, search.capacity(), state});
                for_each_index(on, capacity,
                               write_found_impacts<view>{search.both(), keys.data(), times.data(), state,
                                                         async_parts::items(stream.into())});
            });
        async_parts::room(stream.into()).again = [on, question, a, b, options] {
            return ask_motion(on, question, a, b, options);
        };
    }
}

template <class Policy, class Outcome, motion_arithmetic A, bool Within, class X, class Y>
void ask_motion(const async<Policy, Outcome>& stream, const ask_first_impact<A, Within>& question, const X& a, const Y& b,
                const impact_options& options) {
    if constexpr (can_collide_async<Within, Policy, X, Y>()) {
        using found = impact<typename X::scalar_type>;
        using list = result<found, space_of<Policy>>;
        static_assert(std::same_as<Outcome, async_result<found, space_of<Policy>>>,
                      "abut: a first impact goes into an async_result of impact of the scalar type of its meshes");
        const Policy& on = stream.policy();
        const time_in_motion<A> judge{options.bounds};
        search_in_stream<A, Within>(
            stream, a, b, judge, options.bounds, std::string(question.function) + "_async", [&](auto& search) {
                using view = std::remove_cvref_t<decltype(search.both())>;
                search.time(take_least{search.words()});
                for_each_indirect(on, &search.counts()->timings,
                                  take_first_key{search.keys(), search.words(), search.counts()});
                for_each_index(on, 1,
                               write_first_impact<view>{search.both(), search.counts(), search.capacity(),
                                                        stream.into().capacity(),
                                                        async_parts::room(stream.into()).state.data(),
                                                        async_parts::items(stream.into())});
            });
        async_parts::room(stream.into()).again = [on, question, a, b, options] {
            const auto first = ask_motion(on, question, a, b, options);
            execution::buffer_of<Policy, found> one(on, first ? 1 : 0);
            if (first) upload(on, &*first, 1, one.data());
            synchronize(on);
            return list(std::move(one));
        };
    }
}

template <class Policy, class Outcome, bool Within, class X, class Y>
void ask_motion(const async<Policy, Outcome>& stream, const ask_safe_step<Within>& question, const X& a, const Y& b,
                const conservative_bounds& bounds) {
    if constexpr (can_collide_async<Within, Policy, X, Y>()) {
        static_assert(std::same_as<Outcome, async_value<double, space_of<Policy>>>,
                      "abut: a safe step goes into an async_value of double");
        const Policy& on = stream.policy();
        const std::string function = std::string(question.function) + "_async";
        const bool is_contact = bounds.separation == 0;
        const auto finish = [&](auto& search) {
            search.time(take_safe{bounds});
            for_each_index(on, 1, write_safe_step{search.counts(), search.capacity(), is_contact,
                                                  async_parts::room(stream.into()).state.data()});
        };
        if (is_contact) {
            search_in_stream<filtered, Within>(stream, a, b, time_in_motion<filtered>{bounds}, bounds, function, finish);
        } else {
            search_in_stream<conservative, Within>(stream, a, b, time_in_motion<conservative>{bounds}, bounds, function, finish);
        }
        async_parts::room(stream.into()).again = [on, question, a, b, bounds] { return ask_motion(on, question, a, b, bounds); };
    }
}

}  // namespace abut::detail
