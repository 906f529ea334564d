// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts: continuous collision. Which vertices of one mesh in motion meet which faces of another, which edges
// meet which edges, and when.
//
// The rule of an index (pair_rule.hpp) says how pairs of features are found. By the default, feature_trees, features have
// trees of their own: faces, in which vertices look, and edges. So each pair is met once, and nothing has to be left out
// because another pair of triangles has it too. A search (timed_search.hpp) leaves the pairs that touch, with their times,
// and on a device the few that registers cannot decide. The host decides these, and those that do not touch are left out.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/collide/feature_pairing.hpp>
#include <abut/collide/features.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/search.hpp>
#include <abut/collide/timed_search.hpp>
#include <abut/execution/host.hpp>
#include <abut/narrow/feature_weights.hpp>
#include <abut/narrow/time_of_impact.hpp>
#include <abut/shape/motion.hpp>

namespace abut {

/// @defgroup motion Meshes in motion: what meets, and when
///
/// Continuous collision: `impacts` finds the vertices of one mesh that meet faces of another during a step, the edges that
/// meet edges, and when. `self_impacts` does so within one mesh. `first_impact` and `first_self_impact` find the earliest
/// alone. A mesh in motion is `moving(at_t0, at_t1)`. For steps one after another `make_impact_index` makes what the queries
/// look in, and `refit` brings it to the next step. docs/motion.md says what answers mean.
///
/// @par Memory
/// Sets and indices lie in the policy's memory; a set in host memory is copied for the call under `cuda`. Without an index a
/// query makes one for itself. A `result` of `impact` lies in the policy's memory, 32 bytes each; the first impact is a
/// `std::optional` on the host.
///
/// @par Errors
/// - `error`: a set or an index lies on another device, or two meshes of one step do not go together. With `conservative`
///   also a separation that is negative or above the largest number of the scalar, and a tolerance that is negative or NaN;
///   with any other arithmetic a separation that is not 0.
/// - `capacity_error`: more than 2^31 features of a kind, and as of `edges`.
/// - `std::bad_alloc`, `cuda_error`.
///
/// Poses are not taken by these: that does not compile. Bodies that turn are those of `first_meeting`.
///
/// @par Synchronisation
/// Each call returns when its answer is complete; under `cuda` it waits for the policy's stream, several times.
///
/// @par Example
/// @snippet motion.cpp motion
///@{

/// Two features that meet. In self queries faces never come first, and the smaller edge does.
template <scalar T>
struct impact {
    using scalar_type = T;  ///< of the meshes
    feature_pair kind;      ///< which features
    /// The vertex and the three of the face, in their order; or the two of the first mesh's edge, the smaller first, and the
    /// two of the other's.
    std::array<std::uint32_t, 4> vertices;
    double time;  ///< the earliest in [0, 1] at which they touch; a double also of meshes in float

    friend constexpr bool operator==(const impact&, const impact&) = default;
};

/// Options of `impacts`, `self_impacts`, `first_impact` and `first_self_impact`.
struct impact_options {
    /// By kind, then by the first feature's number, then by the second's: vertices and faces by their ids, edges in the
    /// order of their vertices. Without it the order is any, and may differ from call to call. The first impact is the same
    /// with and without it.
    flag sorted = true;
    /// Of `conservative` alone. Others take no notice of a tolerance, and throw `error` for a separation.
    conservative_bounds bounds = {};
};

struct impact_fronts;  // to make them, include <abut/experimental/impact_fronts.hpp>

/// An `impact` with vertex numbers in meshes of many parts.
/// @ingroup distributed
template <scalar T>
struct global_impact {
    using scalar_type = T;  ///< of the meshes
    feature_pair kind;      ///< which features
    /// As of `impact`: the vertex and the three of the face; or the two of a's edge and the two of b's.
    std::array<std::uint64_t, 4> vertices;
    double time;  ///< the earliest in [0, 1] at which they touch

    friend constexpr bool operator==(const global_impact&, const global_impact&) = default;
};

namespace detail {

/// When two features in motion first touch, by an arithmetic: the judge of impacts.
template <motion_arithmetic A>
struct time_in_motion {
    conservative_bounds bounds;

    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        if constexpr (arithmetic<A>) {
            using abut::decide;
            return decide<A>(s, t);
        } else {
            if (bounds.separation > 0) return verdict::unknown;
            return abut::decide<filtered>(s, t);
        }
    }
    /// Whether a look that costs little says no for sure; where it says nothing of any pair, sifts() is false.
    template <class S, class U>
        requires(!std::same_as<A, fast>)
    ABUT_HD bool is_apart(const S& s, const U& t) const {
        return motion_filter<is_moving_edge<S>>(points_of(s, t)).are_middles_apart();
    }
    [[nodiscard]] bool sifts() const { return bounds.separation == 0; }
    /// Whether the second stage says no, of those that the first one leaves.
    template <class S, class U>
        requires(!std::same_as<A, fast>)
    ABUT_HD bool is_apart_late(const S& s, const U& t) const {
        const auto points = points_of(s, t);
        const std::uint32_t shared = shared_coordinates<is_moving_edge<S>>(points);
        if (axis_of_plane<is_moving_edge<S>>(shared) >= 0 || come_together(points)) return false;
        return motion_filter<is_moving_edge<S>>(points).search(false, shared).touch == verdict::no;
    }
    template <class S, class U>
    ABUT_HD double time(const S& s, const U& t) const {
        return time_in_registers<A, is_moving_edge<S>>(points_of(s, t), bounds);
    }
    template <class S, class U>
    double time_on_host(const S& s, const U& t) const {
        return detail::time_on_host<A, is_moving_edge<S>>(points_of(s, t), bounds);
    }
};

/// How near boxes of features have to come. Throws where the bounds are no bounds.
template <motion_arithmetic A, scalar T>
auto nearness_of(const conservative_bounds& bounds, const char* function) {
    if constexpr (std::same_as<A, conservative>) {
        if (!(bounds.separation >= 0 && bounds.separation <= static_cast<double>(largest_finite<T>) &&
              bounds.tolerance >= 0)) {
            throw error(std::string(function) + ": separation is " + shortest(bounds.separation) + ", tolerance " +
                        shortest(bounds.tolerance) + "; expected 0 or more, and finite");
        }
        const T rounded = static_cast<T>(bounds.separation);
        return near_in_coordinates<T>{{static_cast<double>(rounded) < bounds.separation ? next_up(rounded) : rounded}};
    } else {
        if (!(bounds.separation == 0)) {
            throw error(std::string(function) + ": separation is " + shortest(bounds.separation) +
                        "; expected 0, since `conservative` alone keeps one: " + function + "<abut::conservative>");
        }
        return near_enough_to_touch{};
    }
}

struct split_hits {
    const timed_key* hits;
    std::uint64_t* keys;
    double* times;
    ABUT_HD void operator()(std::size_t i) const {
        keys[i] = hits[i].key;
        times[i] = hits[i].time;
    }
};

template <class View>
ABUT_HD impact<typename View::scalar_type> impact_of(const View& both, std::uint64_t key, double time) {
    impact<typename View::scalar_type> made;
    made.kind = both.key.kind(key);
    both.write_vertices(key, reinterpret_cast<std::uint32_t*>(&made.vertices));
    made.time = time;
    return made;
}
/// Writes impact i; hands on i where its time is not known.
template <class View>
struct write_impact {
    using T = typename View::scalar_type;
    View both;
    const std::uint64_t* keys;
    const double* times;
    impact<T>* out;

    ABUT_CALLS_ANY
    template <class Open>
    ABUT_HD void operator()(std::size_t i, Open& open) const {
        out[i] = impact_of(both, keys[i], times[i]);
        if (times[i] == time_in_bits::unknown) open.push(i);
    }
};

// What a device could not time, on its way to the host, and what the host says.

template <scalar T>
struct untimed_pair {
    moving_points<T> points;
    feature_pair kind;
};
template <scalar T>
struct take_points {
    template <class S, class U>
    ABUT_HD moving_points<T> operator()(const S& s, const U& t) const {
        return points_of(s, t);
    }
};
template <class View>
struct fetch_untimed {
    using T = typename View::scalar_type;
    View both;
    const std::uint64_t *keys, *which;
    untimed_pair<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = keys[which[i]];
        out[i] = {both.with_shapes(key, take_points<T>{}), both.key.kind(key)};
    }
};
template <scalar T>
struct set_time {
    const std::uint64_t* which;
    const double* times;
    impact<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[which[i]].time = times[i]; }
};
template <scalar T>
struct is_impact {
    const impact<T>* all;
    ABUT_HD bool operator()(std::size_t i) const { return all[i].time >= 0; }
};

template <motion_arithmetic A, scalar T>
struct time_untimed {
    const untimed_pair<T>* pairs;
    const conservative_bounds& bounds;
    double* times;
    void operator()(std::size_t i) const {
        const untimed_pair<T>& pair = pairs[i];
        times[i] = pair.kind == feature_pair::edge_edge ? time_on_host<A, true>(pair.points, bounds)
                                                        : time_on_host<A, false>(pair.points, bounds);
    }
};
struct is_no_time {
    bool operator()(double time) const { return time < 0; }
};

/// Sets the times of the impacts `which`, some at a time, on all threads of the host: one may take 100 us. Returns whether
/// some of them are none.
template <motion_arithmetic A, class Policy, class View, scalar T>
bool time_on_host(const Policy& on, const View& both, const std::uint64_t* keys, const key_queue<Policy>& which,
                  const conservative_bounds& bounds, impact<T>* out) {
    constexpr std::size_t most_at_a_time = std::size_t{1} << 18;
    const std::size_t most = std::min(which.size(), most_at_a_time);
    std::vector<untimed_pair<T>> pairs(most);
    std::vector<double> times(most);
    execution::buffer_of<Policy, untimed_pair<T>> gathered(on, most);
    execution::buffer_of<Policy, double> there(on, most);
    bool some_are_none = false;
    for (std::size_t first = 0; first < which.size(); first += most) {
        const std::size_t n = std::min(which.size() - first, most);
        for_each_index(on, n, fetch_untimed<View>{both, keys, which.data() + first, gathered.data()});
        download(on, gathered.data(), n, pairs.data());
        for_each_task(openmp{}, n, time_untimed<A, T>{pairs.data(), bounds, times.data()});
        some_are_none |= std::any_of(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(n), is_no_time{});
        upload(on, times.data(), n, there.data());
        for_each_index(on, n, set_time<T>{which.data() + first, there.data(), out});
        synchronize(on);  // before what is uploaded is changed, or gone
    }
    return some_are_none;
}

/// Impacts, and the keys of their pairs.
template <scalar T, memory_space Space>
struct keyed_impacts {
    result<impact<T>, Space> found;
    result<std::uint64_t, Space> keys;
    feature_key key;
};

/// What a search found: keys of pairs, and their times.
template <class Policy>
struct timed_pairs {
    execution::buffer_of<Policy, std::uint64_t> keys;
    execution::buffer_of<Policy, double> times;

    /// What search(judge, hits) finds.
    template <class Judge, class Search>
    timed_pairs(const Policy& policy, const Judge& judge, const Search& search) : keys(policy, 0), times(policy, 0) {
        timed_queue<Policy> hits(policy, std::size_t{1} << 20);  // where it proves too small, a loop runs again
        search(judge, hits);
        const std::size_t n = hits.size();
        keys = execution::buffer_of<Policy, std::uint64_t>(policy, n);
        times = execution::buffer_of<Policy, double>(policy, n);
        for_each_index(policy, n, split_hits{hits.data(), keys.data(), times.data()});
        (void)hits.take();  // gives its memory back
    }
    timed_pairs(const Policy& policy, std::size_t n) : keys(policy, n), times(policy, n) {}
};

/// The impacts of pairs, in their order. Where `some_are_none` says so, there may be pairs without a time, which are left
/// out.
template <motion_arithmetic A, class Policy, class View>
auto impacts_at(const Policy& on, const conservative_bounds& bounds, const View& both, timed_pairs<Policy>&& pairs,
                bool some_are_none) {
    using T = typename View::scalar_type;
    using space = space_of<Policy>;
    const std::size_t n = pairs.keys.size();
    execution::buffer_of<Policy, impact<T>> all(on, n);
    key_queue<Policy> open(on, 1024);
    for_each_index(on, n, write_impact<View>{both, pairs.keys.data(), pairs.times.data(), all.data()}, open);
    if constexpr (!host_policy<Policy>) {
        if (open.size() > 0) some_are_none |= time_on_host<A>(on, both, pairs.keys.data(), open, bounds, all.data());
    }
    keyed_impacts<T, space> of_all{result<impact<T>, space>(std::move(all)),
                                   result<std::uint64_t, space>(std::move(pairs.keys)), both.key};
    if (some_are_none) {
        const is_impact<T> is{of_all.found.data()};
        of_all.keys = answers_with(on, of_all.keys, is);
        of_all.found = answers_with(on, of_all.found, is);
    }
    return of_all;
}

/// The impacts that search(judge, hits) finds.
template <motion_arithmetic A, class Policy, class View, class Search>
auto impacts_of(const Policy& on, const impact_options& options, const View& both, const Search& search) {
    timed_pairs<Policy> pairs(on, time_in_motion<A>{options.bounds}, search);
    if (options.sorted) sort_by_key(on, pairs.keys, pairs.times, both.key.bits());
    return impacts_at<A>(on, options.bounds, both, std::move(pairs), false);
}

/// use(both, search) with the features of two indices, or `Within` one, and the search of them, or of a part of them.
template <motion_arithmetic A, bool Within, class Policy, class Index, class Fronts, class Part, class Use>
auto with_search_of_indices(const Policy& on, const Index& x, const Index& y, const impact_options& options,
                            const Fronts& fronts, const char* function, const Part& part, const Use& use) {
    const auto near = nearness_of<A, typename Index::scalar_type>(options.bounds, function);
    if constexpr (Index::rule == pair_rule::feature_trees) {
        const feature_pairing<Within, Index, std::remove_const_t<decltype(near)>, Fronts, Part> pairing(x, y, near, fronts,
                                                                                                        function, part);
        return use(pairing.view(),
                   [&](const auto& judge, timed_queue<Policy>& hits) { search_times(on, pairing, judge, hits); });
    } else {
        static_assert(std::same_as<Part, whole_search>, "abut: several devices take indices of pair_rule::feature_trees");
        static_assert(std::same_as<Fronts, no_fronts>, "abut: fronts are of trees over features, pair_rule::feature_trees");
        return impact_rule<Index::rule>::template with_search<Within>(on, x, y, near, function, use);
    }
}

/// The impacts of two indices, or `Within` one; or a part of them.
template <motion_arithmetic A, bool Within, class Policy, class Index, class Fronts, class Part = whole_search>
auto impacts_of_indices(const Policy& on, const Index& x, const Index& y, const impact_options& options,
                        const Fronts& fronts, const char* function, const Part& part = {}) {
    return with_search_of_indices<A, Within>(
        on, x, y, options, fronts, function, part,
        [&](const auto& both, const auto& search) { return impacts_of<A>(on, options, both, search); });
}

/// Both arguments of an impact query as indices; `Within` one mesh they are one.
template <bool Within, class Policy, class X, class Y>
auto impact_operands(const Policy& on, const X& a, const Y& b, const char* function) {
    constexpr pair_rule rule = rule_of<X, Y>();
    auto x = impact_operand<rule>(on, a, function);
    if constexpr (Within) {
        auto y = x;
        return std::pair(std::move(x), std::move(y));
    } else {
        auto y = impact_operand<rule>(on, b, function);
        return std::pair(std::move(x), std::move(y));
    }
}
/// Whether an impact query takes both; `Within` one mesh they are one.
template <bool Within, class Policy, class X, class Y>
consteval bool can_collide() {
    if constexpr (Within) {
        return can_move<Policy, X>();
    } else {
        return can_meet<Policy, X, Y>();
    }
}

/// What meets in motion, of two meshes or `Within` one: a question that executors answer by overloads of ask_motion. Of one
/// mesh both arguments are that. Fronts are a policy's alone.
template <motion_arithmetic A, bool Within>
struct ask_impacts {
    static constexpr const char* function = Within ? "abut::self_impacts" : "abut::impacts";
};
template <execution_policy Policy, motion_arithmetic A, bool Within, class X, class Y, class Fronts = no_fronts>
auto ask_motion(const Policy& on, const ask_impacts<A, Within>& question, const X& a, const Y& b,
                const impact_options& options, const Fronts& fronts = {}) {
    if constexpr (can_collide<Within, Policy, X, Y>()) {
        const auto [x, y] = impact_operands<Within>(on, a, b, question.function);
        return impacts_of_indices<A, Within>(on, x, y, options, fronts, question.function).found;
    } else {
        return result<impact<float>, space_of<Policy>>();
    }
}
template <class Fronts>
given_fronts fronts_of(Fronts& all) {
    return {&all.vertex_face, &all.face_vertex, &all.edge_edge};
}

}  // namespace detail

/// All pairs of a vertex of one mesh and a face of the other, and of two edges, that touch during the step, each once, with
/// the earliest time at which they do. `a` and `b` are meshes in motion (`moving`), meshes at rest, or indices of either
/// (make_impact_index). In the policy's memory, 32 bytes each; sorted as impact_options says.
///
/// With `filtered`, the default, and `exact` no pair is missed and none is invented, for every finite input, degenerate and
/// coplanar motion as well; times are never later than the true ones and within 10^-12 of them. The same bits on every
/// policy. `fast` promises nothing. `conservative` misses none, and tells within its bounds when they come near. Two meshes
/// that intersect all the time without a contact of such features, as one inside the other, have no impact.
///
/// A policy takes one `impact_fronts` besides: then the search begins at these fronts, which are left at this step's ends.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one. Arguments are replicated meshes or indices,
/// meshes in host memory, or divided by divide_mesh; of divided ones the list is sorted, numbers are those of the whole
/// meshes, pieces of b come to the devices whose parts of a they come near, and all pieces of a device are there at a time,
/// with an index; the first device holds 56 bytes for each impact, three times for a moment. Of ranks (@ref distributed)
/// each gets a `global_impact` of its own part of a, 48 bytes each; parts have vertices of their own, so vertices on the
/// border of two parts are in both, and so are edges between them; lists of all ranks are that of one machine kind by kind.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     for (const auto& i : to_host(abut::impacts(on, step, ball))) use(i.kind, i.vertices, i.time);
template <motion_arithmetic A = filtered, executor On, class X, class Y, std::same_as<impact_fronts>... Fronts>
[[nodiscard]] auto impacts(const On& on, const X& a, const Y& b, const impact_options& options = {}, Fronts&... fronts) {
    return ask_motion(on, detail::ask_impacts<A, false>{}, a, b, options, detail::fronts_of(fronts)...);
}

/// The impacts of one mesh with itself: of all pairs that have no vertex index in common. Vertices that coincide in place
/// but not by index touch. `x` is a mesh in motion, or an index of one. Otherwise as `impacts`.
template <motion_arithmetic A = filtered, executor On, class X, std::same_as<impact_fronts>... Fronts>
[[nodiscard]] auto self_impacts(const On& on, const X& x, const impact_options& options = {}, Fronts&... fronts) {
    return ask_motion(on, detail::ask_impacts<A, true>{}, x, x, options, detail::fronts_of(fronts)...);
}

namespace detail {

/// f(vertex, face), or f(edge, edge), with the features of an impact.
ABUT_CALLS_ANY
template <scalar T, memory_space Space, class F>
ABUT_HD auto with_features_of(const impact<T>& found, const moving_view<mesh_view<T, Space>>& a,
                              const moving_view<mesh_view<T, Space>>& b, const F& f) {
    const auto* const v = reinterpret_cast<const std::uint32_t*>(&found.vertices);
    const auto point = [](const auto& m, std::uint32_t i) { return motion<vec3<T>>{m.t0.vertices[i], m.t1.vertices[i]}; };
    const auto edge_of = [&](const auto& m, std::uint32_t i, std::uint32_t j) {
        const auto from = point(m, i), to = point(m, j);
        return motion<segment<T>>{{from.t0, to.t0}, {from.t1, to.t1}};
    };
    if (found.kind == feature_pair::edge_edge) return f(edge_of(a, v[0], v[1]), edge_of(b, v[2], v[3]));
    const bool vertex_first = found.kind == feature_pair::vertex_face;
    const auto &of_vertex = vertex_first ? a : b, &of_face = vertex_first ? b : a;
    const auto x = point(of_face, v[1]), y = point(of_face, v[2]), z = point(of_face, v[3]);
    return f(point(of_vertex, v[0]), motion<triangle<T>>{{x.t0, y.t0, z.t0}, {x.t1, y.t1, z.t1}});
}
struct weights_at_time {
    double time;
    template <class S, class U>
    ABUT_HD feature_weights operator()(const S& s, const U& t) const {
        return weights_at(s, t, time);
    }
};

}  // namespace detail

/// Where the features of an impact touch (narrow/feature_weights.hpp). `a` and `b` are the meshes of the query as moving
/// views, of a self query the same one twice; reads their vertices, on hosts and devices.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     for (const auto& i : abut::self_impacts(on, step)) use(i, abut::weights_of(i, step.view(), step.view()));
template <scalar T, memory_space Space>
[[nodiscard]] ABUT_HD feature_weights weights_of(const impact<T>& found, const moving_view<mesh_view<T, Space>>& a,
                                                 const moving_view<mesh_view<T, Space>>& b) {
    return detail::with_features_of(found, a, b, detail::weights_at_time{found.time});
}

///@}

}  // namespace abut
