// SPDX-License-Identifier: MIT
#pragma once

// raycast: for each of many rays the triangle that it meets first, and when.
//
// By definition the answer is the triangle with the least time, as narrow/hit_time.hpp gives it, and of equal ones the one
// with the least id. The walk is that of `nearest`: nearer child first, and no farther than what is found.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/traverse/ordered_walk.hpp>

namespace abut {

/// What a ray meets first. Where it meets nothing: `no_id` and infinity.
/// @ingroup queries
template <scalar T>
struct ray_hit {
    std::uint32_t id;  ///< of the shape in its set
    T t;               ///< where: at origin + t direction, or a + t (b - a) of a segment

    friend constexpr bool operator==(const ray_hit&, const ray_hit&) = default;
};

namespace detail {

/// A walk through an index along each line.
template <arithmetic A, class Walk, class Frame, shape_view Shapes, shape_view Lines>
struct walk_along_lines {
    Walk walk;
    Frame frame;
    Shapes shapes;
    Lines lines;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        const auto line = lines[i];
        const line_of<typename Lines::scalar_type> l(line);
        auto reach = reach_of_line(frame, l.origin, l.direction(), l.last);
        walk(reach, best, [&](std::uint32_t id) {
            const double time = hit_time<A>(line, shapes[id]);
            if (time >= 0) best.offer(time, id);
        });
    }
};

template <scalar T>
struct write_hits {
    const execution::least_value* found;  ///< null for none
    ray_hit<T>* out;

    ABUT_HD void operator()(std::size_t i) const {
        if (found == nullptr || found[i].key >= no_id) {
            out[i] = {no_id, infinity<T>};
        } else {
            const double most = static_cast<double>(largest_finite<T>), time = found[i].value;
            out[i] = {static_cast<std::uint32_t>(found[i].key), static_cast<T>(time < most ? time : most)};
        }
    }
};

template <class X>
inline constexpr bool is_grid = false;
template <class Set, memory_space Space>
inline constexpr bool is_grid<grid<Set, Space>> = true;
template <class Object>
inline constexpr bool is_grid<posed_object<Object>> = is_grid<Object>;

template <class S>
inline constexpr bool is_line = std::same_as<S, ray<scalar_type_of<S>>> || std::same_as<S, segment<scalar_type_of<S>>>;

/// Whether `raycast` takes both arguments.
template <class Policy, class X, class Lines>
consteval bool can_be_met() {
    if constexpr (!can_be_asked<Policy, X>() || !can_be_asked<Policy, Lines>()) {
        return false;
    } else {
        using shape_type = typename shape_of_argument<X>::type;
        using line_type = typename shape_of_argument<Lines>::type;
        constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
        static_assert(are, "abut: raycast looks for triangles: a mesh, a triangle_soup, or a tree of one");
        constexpr bool has_walk = !is_grid<X>;
        static_assert(has_walk, "abut: raycast takes a tree, a set or one shape, and no grid");
        constexpr bool look = is_line<line_type>;
        static_assert(look, "abut: raycast takes rays or segments: a set of them, a view, or one");
        if constexpr (are && has_walk && look) return have_one_scalar<X, Lines>();
        return false;
    }
}

template <arithmetic A, class Policy, class X, class Lines>
auto raycast_of(const Policy& on, const X& index, const Lines& rays, const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    const auto x = make_operand(on, index, function);
    const auto looking = make_operand(on, rays, function);
    const auto there = x.shapes();
    const auto lines = looking.shapes();
    const std::size_t n = lines.size();
    execution::buffer_of<Policy, ray_hit<T>> out(on, n);
    const auto finish = [&](const execution::least_value* found) {
        for_each_index(on, n, write_hits<T>{found, out.data()});
        synchronize(on);
        return result<ray_hit<T>, space_of<Policy>>(std::move(out));
    };
    if (n == 0 || there.size() == 0) return finish(nullptr);
    const auto walk = ordered_walk_of(x);
    const auto frame = frame_of(x, length_unit<T>{});
    execution::best_of_each<space_of<Policy>> best(on, n);
    using walk_type = walk_along_lines<A, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                                       std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(lines)>>;
    for_each_ordered(on, n, walk_type{walk, frame, there, lines}, best);
    return finish(best.data());
}

}  // namespace detail

/// For each of `rays` the triangle of `index` that it meets first: a `result` of `ray_hit`, in the order of the rays. Of
/// triangles that are met at one time it has the least id; where nothing is met, `no_id` and infinity.
///
/// `index` is a tree of any layout, a mesh, a triangle_soup, a view or one triangle, posed or not. `rays` are `rays` or
/// `segments`: a set, a view, or one. Segments are met from their first end to their second, at times from 0 to 1. Triangles
/// are met from both sides, and along their planes.
///
/// With `filtered` and `exact` whether a ray meets a triangle is decided exactly: none slips through a closed mesh, not
/// through an edge and not through a vertex. Times are the true ones rounded to the nearest double, by which they are
/// compared, and then to the scalar type; those above its largest number are that. So triangles that are met at one place
/// are met at one time. The same bits on every policy. `fast` is approximate.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 8 bytes a ray in float and 16 in double.
///
/// @par Errors
/// - `invalid_geometry`: a view, a single shape or a ray has a number that is not finite, or a pose is no rotation.
/// - `error`: a set or an index lies on another device.
/// - `capacity_error`: a view has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp raycast
///
/// @ingroup queries
template <arithmetic A = filtered, execution_policy Policy, class X, class Rays>
[[nodiscard]] auto raycast(const Policy& on, const X& index, const Rays& rays) {
    if constexpr (detail::can_be_met<Policy, X, Rays>()) {
        return detail::raycast_of<A>(on, index, rays, "abut::raycast");
    } else {
        return result<ray_hit<float>, space_of<Policy>>();
    }
}

}  // namespace abut
