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

/// What kernels leave for those that follow, 0 at first. The first three are as the counts of a loop (undecided_of).
struct motion_counts {
    std::uint64_t near, found, undecided;
    std::uint64_t of_vertices, of_edges;  ///< candidates of each kind
    std::uint64_t left_of_vertices, left_of_edges;  ///< and those that are left of them
    std::uint64_t open;                   ///< what first tries leave
    std::uint64_t late;                   ///< and second ones
    std::uint64_t first, last;            ///< of these, those that are timed now
    std::uint64_t least_time;             ///< by its bits, which have the order of times; `no_time` if there is none
    std::uint64_t least_exact;            ///< of times that are no bounds
    std::uint64_t least_key;              ///< at the least time
    std::uint32_t tries, timings;         ///< indices of the loops to come
    std::uint32_t spread;                 ///< a lane in so many times one
    static constexpr std::uint64_t no_time = ~std::uint64_t{0};
};
/// Between loops. Where candidates found no room none is tried.
struct begin_tries {
    motion_counts* counts;
    std::uint64_t capacity;
    ABUT_HD void operator()(std::size_t) const {
        counts->near = counts->of_vertices + counts->of_edges;
        counts->tries = counts->near <= capacity ? static_cast<std::uint32_t>(counts->near) : 0;
        counts->least_time = counts->least_exact = counts->least_key = motion_counts::no_time;
    }
};
/// What was sifted is what was gathered by now.
struct end_sifting {
    motion_counts* counts;
    ABUT_HD void operator()(std::size_t) const {
        counts->of_vertices = counts->left_of_vertices, counts->of_edges = counts->left_of_edges;
        counts->tries = counts->tries > 0 ? static_cast<std::uint32_t>(counts->of_vertices + counts->of_edges) : 0;
    }
};
struct begin_timings {
    motion_counts* counts;
    bool again;  ///< of all that was open
    ABUT_HD void operator()(std::size_t) const {
        counts->first = again ? 0 : counts->last;
        counts->last = counts->open;
        const auto n = static_cast<std::uint32_t>(counts->last - counts->first);
        counts->spread = again ? 1 : spread_of(n);
        counts->timings = n * counts->spread;
    }
};

/// A multiple of 2^-40 up to which two features are surely farther apart than `separation`: along one axis, where they come
/// together no faster than their fastest corners. 0 where that tells nothing, 2 where they never meet. Not above a time of
/// impact, which is one of these multiples too. Corners are at most m, so gap and speed are off by less than 2^-50 m.
template <bool Edges, scalar T>
ABUT_HD double apart_until(const moving_points<T>& p, double separation) {
    constexpr int first = Edges ? 2 : 1;
    const auto along = [&](T vec3<T>::*axis) {
        double low[2], high[2], slow[2], fast[2], most = separation;
        for (int k = 0; k < 4; ++k) {
            const int of = k < first ? 0 : 1;
            const double from = static_cast<double>(p.t0[k].*axis), to = static_cast<double>(p.t1[k].*axis), way = to - from;
            const bool begins = k == 0 || k == first;
            low[of] = begins ? from : least(low[of], from);
            high[of] = begins ? from : greatest(high[of], from);
            slow[of] = begins ? way : least(slow[of], way);
            fast[of] = begins ? way : greatest(fast[of], way);
            most = greatest(most, greatest(absolute(from), absolute(to)));
        }
        const double error = 0x1p-48 * most;
        const auto until = [&](double gap, double speed) {
            const double sure = gap - separation - error, together = speed + error;
            if (!(sure > 0)) return 0.0;
            return together > 0 ? least((1 - 0x1p-48) * (sure / together), 2.0) : 2.0;
        };
        return greatest(until(low[0] - high[1], fast[1] - slow[0]), until(low[1] - high[0], fast[0] - slow[1]));
    };
    const double until = greatest(greatest(along(&vec3<T>::x), along(&vec3<T>::y)), along(&vec3<T>::z));
    return static_cast<double>(static_cast<std::int64_t>(until * 0x1p40)) * last_time_bit;
}
/// A judge for the least time alone, of features that may meet in a part of the step and no later than others do. A time that
/// is not known is `unknown` less the time up to which they are apart. For times that are bounds it may be later than `judge`
/// has it, which it is for all runs alike: then they are apart up to there.
template <class Judge>
struct sooner_than_others {
    Judge judge;
    double separation, from, until;
    const motion_counts* counts;

    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        const double apart = apart_until<is_moving_edge<S>>(points_of(s, t), separation);
        return apart < from || !(apart < until) || is_later(apart) ? verdict::no : judge.decide(s, t);
    }
    template <class S, class U>
    ABUT_HD double time(const S& s, const U& t) const {
        const double apart = apart_until<is_moving_edge<S>>(points_of(s, t), separation);
        if (is_later(apart)) return time_in_bits::none;
        const double time = judge.time(s, t);
        if (time == time_in_bits::unknown) return time - apart;
        return time >= 0 && time < apart ? apart : time;
    }
    template <class S, class U>
    double time_on_host(const S& s, const U& t) const {
        return judge.time_on_host(s, t);
    }

private:
    [[nodiscard]] ABUT_HD bool is_later(double apart) const {
        return execution::atomic_load(&counts->least_time) < ABUT_BIT_CAST(std::uint64_t, apart);
    }
};

/// What was gathered, in a room whose counts a device knows.
struct gathered_in_stream {
    const std::uint64_t *begin, *end;
    const motion_counts* counts;
    ABUT_HD operator gathered_features() const {
        return {begin, end, static_cast<std::size_t>(counts->of_vertices), static_cast<std::size_t>(counts->of_edges)};
    }
};
template <class View, class Judge, class Vertices, class Edges>
struct sift_in_stream {
    View both;
    Judge judge;
    gathered_in_stream near;
    Vertices vertices;
    Edges edges;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        Vertices to_vertices = vertices;
        Edges to_edges = edges;
        sift_gathered<View, Judge>{both, judge, near}(i, to_vertices, to_edges);
    }
};
/// What is open is what second tries leave by now.
struct end_late {
    motion_counts* counts;
    ABUT_HD void operator()(std::size_t) const {
        counts->last = counts->open = counts->late;
        const auto n = static_cast<std::uint32_t>(counts->last);
        counts->spread = spread_of(n);
        counts->timings = n * static_cast<std::uint32_t>(counts->spread);
    }
};
/// A lane in `spread`, as in time_in_stream.
template <class View, class Judge, class Open>
struct sift_late_in_stream {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    const motion_counts* counts;
    Open open;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        Open sink = open;
        if (i % counts->spread == 0) sift_late<View, Judge>{both, judge, keys}(i / counts->spread, sink);
    }
};
template <class View, class Judge, class Open>
struct try_in_stream {
    View both;
    Judge judge;
    gathered_in_stream near;
    Open open;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
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
        const std::size_t place = static_cast<std::size_t>(counts->first) + i / spread;
        const std::uint64_t key = keys[place];
        take(both, place, key, both.with_shapes(key, time_by<Judge>{judge}), *counts);
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
/// The least time, with all times.
struct take_least {
    double* times;
    template <class View>
    ABUT_HD void operator()(const View&, std::size_t place, std::uint64_t, double time, motion_counts& counts) const {
        times[place] = time;
        if (time >= 0) keep_least(&counts.least_time, ABUT_BIT_CAST(std::uint64_t, time));
    }
};
/// The least key at the least time, and how many pairs may come before it or with it.
struct take_first_key {
    const std::uint64_t* keys;
    const double* times;
    motion_counts* counts;
    ABUT_HD void operator()(std::size_t i) const {
        const bool is_unknown = times[i] <= time_in_bits::unknown;
        const double from = is_unknown ? time_in_bits::unknown - times[i] : times[i];
        const auto bits = ABUT_BIT_CAST(std::uint64_t, from);
        if (is_unknown && bits <= counts->least_time) execution::atomic_add(&counts->undecided, std::uint64_t{1});
        if (!is_unknown && bits == counts->least_time) execution::atomic_min(&counts->least_key, keys[i]);
    }
};
/// The least time, where what is not known is no later than a bound.
struct take_safe {
    conservative_bounds bounds;
    template <class View>
    ABUT_HD void operator()(const View& both, std::size_t, std::uint64_t key, double time, motion_counts& counts) const {
        if (time >= 0) {
            keep_least(&counts.least_exact, ABUT_BIT_CAST(std::uint64_t, time));
        } else if (time <= time_in_bits::unknown) {
            using judge = time_in_motion<conservative>;
            const double apart = time_in_bits::unknown - time;
            time = both.with_shapes(key, time_by<judge>{{bounds}});
            time = time >= 0 && time < apart ? apart : time;
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
        const std::uint64_t needed = counts->least_key != motion_counts::no_time ? 1 : 0, size = needed < capacity ? needed : capacity;
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
        const bool knows_all = counts->near <= open_capacity, meets = counts->least_time != motion_counts::no_time;
        const double part = meets ? safe_part(ABUT_BIT_CAST(double, counts->least_time), is_contact) : 1;
        const bool is_bound = counts->least_time < counts->least_exact;
        *out = {knows_all ? part : 0, !knows_all ? counts->near : is_bound ? 1u : 0u};
    }
};

/// A search of pairs of features in a stream: gathers candidates, of which `look` asks.
template <class Policy, class View>
class motion_in_stream {
    using numbers = execution::buffer_of<Policy, std::uint64_t>;
    using queue = execution::capped_queue<std::uint64_t, space_of<Policy>>;
    using from_end = execution::capped_queue_from_end<std::uint64_t, space_of<Policy>>;
    using features = features_on_way<View>;

public:
    /// `loops` are those of a result, whose open capacity is the room for candidates.
    template <class Pairing, class Room>
    motion_in_stream(const Policy& policy, const Pairing& pairing, Room& loops)
        : on_(policy), both_(pairing.view()), capacity_(room_for(both_, loops.open_capacity)), near_(policy, capacity_),
          open_(policy, capacity_), counts_(policy, 1), vertices_(policy, both_) {
        fill(on_, counts_.data(), 1, motion_counts{});
        fill(on_, loops.counters.data(), loops.counters.size(), std::uint64_t{0});
        motion_counts* const counts = counts_.data();
        const execution::async_loop loop{loops.counters.data(), loops.counts(), nullptr, 0};
        execution::async_queue<execution::counted_queue<queue>> vertices{{queue(near_.data(), capacity_), &counts->of_vertices}, loop};
        execution::counted_queue<from_end> edges{from_end(near_.data(), capacity_), &counts->of_edges};
        pairing.judge_candidates(on_, [&](const auto& run) { run(gather_features{{}, both_.key}, vertices, edges); });
        for_each_index(on_, 1, begin_tries{counts, capacity_});
    }

    /// Leaves out candidates of which a judge says at little cost that they do not meet.
    template <class Judge>
    void sift(const Judge& judge) {
        if constexpr (sifting_judge<Judge>) {
            if (!judge.sifts()) return;
            motion_counts* const counts = counts_.data();
            const auto vertices = queue(open_.data(), capacity_).make_sink(&counts->left_of_vertices);
            const auto edges = from_end(open_.data(), capacity_).make_sink(&counts->left_of_edges);
            using sift = sift_in_stream<features, Judge, std::remove_const_t<decltype(vertices)>, std::remove_const_t<decltype(edges)>>;
            for_each_indirect(on_, &counts->tries, sift{vertices_.view(both_), judge, gathered(), vertices, edges});
            for_each_index(on_, 1, end_sifting{counts});
            std::swap(near_, open_);
        }
    }
    /// Tries all candidates, and times those that are left. `Once`, they are not needed again.
    template <bool Once, class Judge, class Take>
    void look(const Judge& judge, const Take& take) {
        static_assert(feature_judge<Judge, View>, "abut: the judge is no timing_judge of pairs of features");
        motion_counts* const counts = counts_.data();
        const auto sink = queue(open_.data(), capacity_).make_sink(&counts->open);
        const try_in_stream<features, Judge, std::remove_const_t<decltype(sink)>> tries{vertices_.view(both_), judge, gathered(), sink};
        for_each_indirect(on_, &counts->tries, tries);
        for_each_index(on_, 1, begin_timings{counts, false});
        if constexpr (Once && sifting_judge<Judge>) {
            if (judge.sifts()) {
                const auto late = queue(near_.data(), capacity_).make_sink(&counts->late);
                for_each_indirect(on_, &counts->timings,
                                  sift_late_in_stream<features, Judge, std::remove_const_t<decltype(late)>>{
                                      vertices_.view(both_), judge, open_.data(), counts, late});
                for_each_index(on_, 1, end_late{counts});
                std::swap(near_, open_);
            }
        }
        for_each_indirect(on_, &counts->timings,
                          time_in_stream<features, Judge, Take>{vertices_.view(both_), judge, open_.data(), counts, take});
    }
    /// The same for the least time alone: what may meet in the first part of the step, then what may still come before that.
    template <class Judge, class Take>
    void look_for_least(const Judge& judge, double separation, const Take& take) {
        constexpr double parts[] = {0, first_part_of_step, 1 + last_time_bit};
        for (int k = 0; k < 2; ++k) {
            look<false>(sooner_than_others<Judge>{judge, separation, parts[k], parts[k + 1], counts_.data()}, take);
        }
    }
    /// f(i) of all that was left.
    template <class F>
    void for_each_timed(const F& f) {
        for_each_index(on_, 1, begin_timings{counts_.data(), true});
        for_each_indirect(on_, &counts_.data()->timings, f);
    }
    [[nodiscard]] const View& both() const { return both_; }
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    [[nodiscard]] const std::uint64_t* keys() const { return open_.data(); }
    [[nodiscard]] motion_counts* counts() { return counts_.data(); }

private:
    [[nodiscard]] gathered_in_stream gathered() const { return {near_.data(), near_.data() + capacity_, counts_.data()}; }
    static std::uint64_t room_for(const View& both, std::uint64_t asked) {
        const auto pairs_of = [](std::size_t n, std::size_t m) { return std::uint64_t{n} * m; };
        const std::uint64_t all = pairs_of(both.a.vertices.size(), both.b.faces.size()) +
                                  pairs_of(both.a.faces.size(), both.b.vertices.size()) +
                                  pairs_of(both.a.edges.size(), both.b.edges.size());
        return std::min({asked, all, std::uint64_t{1} << 31});
    }

    const Policy& on_;
    View both_;
    std::uint64_t capacity_;
    numbers near_, open_;
    execution::buffer_of<Policy, motion_counts> counts_;
    vertices_on_way<Policy, View> vertices_;
};

/// Whether an impact query in a stream takes both.
template <bool Within, class Policy, class X, class Y>
consteval bool can_collide_async() {
    if constexpr (!has_stream<Policy>()) {
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
template <motion_arithmetic A, bool Within, class Policy, class Outcome, class Index, class Use>
void search_in_stream(const async<Policy, Outcome>& stream, const Index& a, const Index& b, const conservative_bounds& bounds,
                      const std::string& function, const Use& use) {
    const Policy& on = stream.policy();
    const auto near = nearness_of<A, typename Index::scalar_type>(bounds, function.c_str());
    require_same_device(on, a, function.c_str());
    require_same_device(on, b, function.c_str());
    check_outcome(on, stream.into(), function);
    const feature_pairing<Within, Index, std::remove_const_t<decltype(near)>, no_fronts> pairing(a, b, near, {}, function.c_str());
    motion_in_stream<Policy, std::remove_cvref_t<decltype(pairing.view())>> search(on, pairing, async_parts::room(stream.into()));
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
            stream, a, b, options.bounds, std::string(question.function) + "_async", [&](auto& search) {
                using view = std::remove_cvref_t<decltype(search.both())>;
                const std::size_t capacity = stream.into().capacity();
                const int bits = search.both().key.bits();
                execution::buffer_of<Policy, std::uint64_t> keys(on, capacity);
                execution::buffer_of<Policy, double> times(on, capacity);
                // No pair has the largest key, so places that stay empty come last.
                if (options.sorted) fill(on, keys.data(), capacity, ~std::uint64_t{0} >> (64 - bits));
                execution::capped_queue<std::uint64_t, space_of<Policy>> found(keys.data(), capacity);
                const auto places = found.make_sink(&search.counts()->found);
                search.sift(judge);
                search.template look<true>(judge, take_all<std::remove_const_t<decltype(places)>>{places, times.data()});
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
            stream, a, b, options.bounds, std::string(question.function) + "_async", [&](auto& search) {
                using view = std::remove_cvref_t<decltype(search.both())>;
                execution::buffer_of<Policy, double> times(on, search.capacity());
                search.sift(judge);
                search.look_for_least(judge, options.bounds.separation, take_least{times.data()});
                search.for_each_timed(take_first_key{search.keys(), times.data(), search.counts()});
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
        const auto look = [&]<class A>(const time_in_motion<A>& judge) {
            search_in_stream<A, Within>(stream, a, b, bounds, function, [&](auto& search) {
                search.sift(judge);
                search.look_for_least(judge, bounds.separation, take_safe{bounds});
                for_each_index(on, 1, write_safe_step{search.counts(), search.capacity(), is_contact,
                                                      async_parts::room(stream.into()).state.data()});
            });
        };
        if (is_contact) {
            look(time_in_motion<filtered>{bounds});
        } else {
            look(time_in_motion<conservative>{bounds});
        }
        async_parts::room(stream.into()).again = [on, question, a, b, bounds] { return ask_motion(on, question, a, b, bounds); };
    }
}

}  // namespace abut::detail
