// SPDX-License-Identifier: MIT
#pragma once

// safe_step, safe_self_step: how much of a step is free. safe_steps, safe_self_steps: how much of its own way each vertex
// may go, whatever the others do.
//
// The first is a question to first_impact. A time of impact is the true one rounded down, so it may be that of a contact
// itself; the multiple of 2^-40 before it is not.
//
// For the second, pairs of features are those of `impacts`: whose boxes around the whole step come near. A box holds each
// place that a vertex may take on its way, so features whose boxes are apart are apart whatever part of their ways their
// vertices go. Of the others a plane says how far each of the four vertices may go (narrow/safe_fractions.hpp, with the
// proof), and a vertex takes the least of what its pairs say. Then each pair that could meet is parted by its plane.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/collide/executor.hpp>
#include <abut/collide/features.hpp>
#include <abut/collide/first_impact.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/timed_search.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/narrow/safe_fractions.hpp>

namespace abut {

namespace detail {

/// As ask_first_impact, to which it is a question for all but a stream (async_motion.hpp).
template <bool Within>
struct ask_safe_step {
    static constexpr const char* function = Within ? "abut::safe_self_step" : "abut::safe_step";
};
/// The part of a step before the first contact, or up to where features come near.
ABUT_HD inline double safe_part(double first, bool is_contact) {
    return !is_contact ? first : first > last_time_bit ? first - last_time_bit : 0;
}
template <executor On, bool Within, class X, class Y>
double ask_motion(const On& on, const ask_safe_step<Within>& question, const X& a, const Y& b,
                  const conservative_bounds& bounds) {
    const impact_options options{.bounds = bounds};
    if (bounds.separation == 0) {
        const auto first = ask_motion(on, ask_first_impact<filtered, Within>{question.function}, a, b, options);
        return first ? safe_part(first->time, true) : 1;
    }
    const auto first = ask_motion(on, ask_first_impact<conservative, Within>{question.function}, a, b, options);
    return first ? safe_part(first->time, false) : 1;
}

template <class S, class U>
ABUT_HD safe_fractions safe_fractions_of(const S& s, const U& t, double separation) {
    return parting_plane<is_moving_edge<S>, scalar_type_of<S>>(points_of(s, t)).fractions(separation);
}

/// The judge of pairs of which a vertex may not go all of its way: the least part is their time.
struct least_fraction {
    double separation;

    template <class S, class U>
    ABUT_HD verdict decide(const S&, const U&) const {
        return verdict::unknown;
    }
    template <class S, class U>
    ABUT_HD double time(const S& s, const U& t) const {
        const double part = safe_fractions_of(s, t, separation).smallest();
        return part < 1 ? part : time_in_bits::none;
    }
    template <class S, class U>
    double time_on_host(const S& s, const U& t) const {
        return time(s, t);
    }
};

struct take_fractions {
    double separation;
    template <class S, class U>
    ABUT_HD safe_fractions operator()(const S& s, const U& t) const {
        return safe_fractions_of(s, t, separation);
    }
};
/// Leaves the least at each vertex of pair i. Numbers from 0 on have the order of their bits.
template <class View>
struct limit_vertices {
    View both;
    const std::uint64_t* keys;
    double separation;
    std::uint64_t *of_a, *of_b;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = keys[i];
        const safe_fractions part = both.with_shapes(key, take_fractions{separation});
        std::uint32_t vertices[4];
        both.write_vertices(key, vertices);
        const feature_pair kind = both.key.kind(key);
        for (int k = 0; k < 4; ++k) {
            execution::atomic_min((is_of_first(kind, k) ? of_a : of_b) + vertices[k], ABUT_BIT_CAST(std::uint64_t, part.of[k]));
        }
    }
};
struct bits_to_number {
    const std::uint64_t* bits;
    double* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = ABUT_BIT_CAST(double, bits[i]); }
};

/// For each vertex of a mesh the part of its way.
template <class Policy>
class vertex_limits {
public:
    vertex_limits(const Policy& policy, std::size_t count) : on_(policy), bits_(policy, count) {
        fill(on_, bits_.data(), count, ABUT_BIT_CAST(std::uint64_t, 1.0));
    }
    [[nodiscard]] std::uint64_t* data() { return bits_.data(); }
    [[nodiscard]] auto numbers() const {
        execution::buffer_of<Policy, double> out(on_, bits_.size());
        for_each_index(on_, bits_.size(), bits_to_number{bits_.data(), out.data()});
        return result<double, space_of<Policy>>(std::move(out));
    }

private:
    const Policy& on_;
    execution::buffer_of<Policy, std::uint64_t> bits_;
};

/// Of two meshes, or `Within` one, of which both are the same.
template <bool Within, class Policy, class X, class Y>
auto safe_steps_of(const Policy& on, const X& a, const Y& b, const conservative_bounds& bounds, const char* function) {
    using limits = vertex_limits<Policy>;
    if constexpr (can_collide<Within, Policy, X, Y>()) {
        const auto operands = impact_operands<Within>(on, a, b, function);
        const auto vertices = [](const auto& of) { return of.mesh().t0().view().vertices.count; };
        limits of_a(on, vertices(operands.first)), of_b(on, Within ? 0 : vertices(operands.second));
        const impact_options options{.bounds = bounds};
        with_search_of_indices<conservative, Within>(
            on, operands.first, operands.second, options, no_fronts{}, function, whole_search{},
            [&](const auto& both, const auto& search) {
                using view = std::remove_cvref_t<decltype(both)>;
                const timed_pairs<Policy> pairs(on, least_fraction{bounds.separation}, search);
                const limit_vertices<view> limit{both, pairs.keys.data(), bounds.separation, of_a.data(),
                                                 Within ? of_a.data() : of_b.data()};
                for_each_index(on, pairs.keys.size(), limit);
            });
        return std::pair(of_a.numbers(), of_b.numbers());
    } else {
        return std::pair(limits(on, 0).numbers(), limits(on, 0).numbers());
    }
}

}  // namespace detail

/// @addtogroup motion
///@{

/// How much of the step is free, from its start on, as a part of it: a double in [0, 1]. `a` and `b` are those of
/// `first_impact`, and so is the price.
///
/// Without a separation no feature of one mesh touches one of the other at any time in [0, t], decided exactly: 1 if nothing
/// is met; otherwise a multiple of 2^-40 that is less than 2^-39 below the time of the first contact, and not that time; 0
/// if it is there within 2^-40 of the start, or at it. With one, features are farther apart than it is at any time in [0,
/// t], and t is early by the tolerance at most, but as `conservative` says: 0 if features begin nearer, also if they go
/// away. A tolerance matters to this alone. What is never a contact of features, as a mesh in another, is not looked at.
///
/// Several devices and ranks (@ref distributed) take it as they take first_impact; all ranks have one answer.
///
///     const double t = abut::safe_step(on, step, ball, {.tolerance = 1e-3, .separation = 0.01f});
template <executor On, class X, class Y>
[[nodiscard]] auto safe_step(const On& on, const X& a, const Y& b, const conservative_bounds& bounds = {}) {
    return ask_motion(on, detail::ask_safe_step<false>{}, a, b, bounds);
}

/// The same of one mesh with itself: of its features that share no vertex, as `first_self_impact`.
template <executor On, class X>
[[nodiscard]] auto safe_self_step(const On& on, const X& x, const conservative_bounds& bounds = {}) {
    return ask_motion(on, detail::ask_safe_step<true>{}, x, x, bounds);
}

/// How far each vertex may go by itself: for each vertex of `a`, and for each of `b`, the part of its way, a double in [0,
/// 1]. Whatever part of its way each vertex takes, up to its own, and whenever it does, features of one mesh and of the
/// other do not touch, and stay farther apart than the separation if there is one. Rounded down, and proven of exact
/// positions: those that a program rounds may be off by that. A std::pair of `result`s in the policy's memory, 8 bytes for
/// each vertex. `a` and `b` are those of `impacts`; a policy alone answers. The tolerance takes no part.
///
/// It is a bound, and no search for the farthest: each pair of features that may meet is parted by a plane between the two
/// points that are nearest at the start, and vertices may go up to it (narrow/safe_fractions.hpp has the proof). Each side
/// has half of the gap, or what the other does not need of it. A vertex whose feature touches at the start, or is nearer
/// than the separation, or than double precision can tell, has 0; one that does not move has 1.
///
///     const auto [of_cloth, of_ball] = abut::safe_steps(on, step, ball);
template <execution_policy Policy, class X, class Y>
[[nodiscard]] auto safe_steps(const Policy& on, const X& a, const Y& b, const conservative_bounds& bounds = {}) {
    return detail::safe_steps_of<false>(on, a, b, bounds, "abut::safe_steps");
}

/// The same of one mesh with itself, of its features that share no vertex: one `result`, for each vertex. A mesh that begins
/// without intersections has none then.
template <execution_policy Policy, class X>
[[nodiscard]] auto safe_self_steps(const Policy& on, const X& x, const conservative_bounds& bounds = {}) {
    return detail::safe_steps_of<true>(on, x, x, bounds, "abut::safe_self_steps").first;
}

///@}

}  // namespace abut
