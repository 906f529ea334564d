// SPDX-License-Identifier: MIT
#pragma once

// Which hits a query of rays wants: all, or those that options keep. A query without options has the first type, and pays
// for none.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include <abut/collide/options.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/error.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/hull_hit_time.hpp>
#include <abut/narrow/solid_hit_time.hpp>
#include <abut/predicate/face_side.hpp>

namespace abut {

/// From which side a ray meets a shape. The front of a triangle is the side from which its corners go round against the
/// clock; a solid is met from outside, which is its front.
/// @ingroup queries
enum class ray_side : unsigned char {
    any,    ///< from either; of a hit: along the plane of a triangle, or of one without area
    front,  ///< against the normal (b - a) x (c - a)
    back    ///< along the normal
};

/// Options of `raycast`, `raycast_any`, `raycast_all` and `raycast_detailed`. A hit that they leave out is none: the first
/// hit is the first of those that are left. With a filter write `raycast_options{.filter = f}` (see query_options).
///
///     const auto hits = abut::raycast(on, index, rays, {.most_t = 5, .side = abut::ray_side::front});
/// @ingroup queries
template <class Filter = keep_all>
struct raycast_options {
    /// filter(number of the ray, id) -> bool, of bodies filter(number of the ray, body, id): shapes for which it is false
    /// are not met. As in query_options. Ranks take none: rays of other ranks have no numbers there.
    Filter filter = {};
    /// Hits before this time, or after `most_t`, are left out; those at one of them are not. Times are as the query compares
    /// them: the true ones rounded to the nearest double. A solid in which a ray begins is met at 0.
    double least_t = 0;
    double most_t = infinity<double>;  ///< see least_t
    /// Triangles that are met from the other side, or along their plane, are left out. Decided exactly.
    ray_side side = ray_side::any;
};

namespace detail {

/// All hits are wanted.
struct all_hits_wanted {
    struct row_type {};
    [[nodiscard]] ABUT_HD row_type row(std::size_t) const { return {}; }
    [[nodiscard]] static double most() { return infinity<double>; }
    [[nodiscard]] static execution::until_stopped until() { return {}; }
    /// hit_time_bounds, hit_time and is_met of what is wanted.
    ///@{
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD time_bounds bounds(const row_type&, const Line& line, const S& s, std::uint64_t) const {
        return hit_time_bounds<A>(line, s);
    }
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD double time(const row_type&, const Line& line, const S& s, std::uint64_t) const {
        return hit_time<A>(line, s);
    }
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD bool meets(const row_type&, const Line& line, const S& s, std::uint64_t) const {
        return is_met<A>(line, s);
    }
    ///@}
};

/// What options keep. `Bodies` says that shapes have keys of bodies.
template <class Filter, class Numbers, bool Bodies>
struct some_hits_wanted {
    struct row_type {
        std::uint32_t number;
    };
    raycast_options<Filter> options;
    Numbers numbers;

    [[nodiscard]] ABUT_HD row_type row(std::size_t i) const { return {static_cast<std::uint32_t>(numbers(i))}; }
    [[nodiscard]] double most() const { return options.most_t; }
    [[nodiscard]] execution::until_stopped_below until() const { return execution::until_stopped_below(options.most_t); }
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD time_bounds bounds(const row_type& row, const Line& line, const S& s, std::uint64_t key) const {
        constexpr time_bounds none{-1, -1};
        if (!passes(row, key)) return none;
        time_bounds t = hit_time_bounds<A>(line, s);
        if (t.first < 0 || t.last < options.least_t || t.first > options.most_t || !is_on_side<A>(line, s)) return none;
        if (t.first < options.least_t || t.last > options.most_t) {
            t.first = t.last = hit_time_apart<A>(line, s);
            if (t.first < options.least_t || t.first > options.most_t) return none;
        }
        return t;
    }
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD double time(const row_type& row, const Line& line, const S& s, std::uint64_t key) const {
        if (!passes(row, key)) return -1;
        const double t = hit_time<A>(line, s);
        return t >= options.least_t && t <= options.most_t && is_on_side<A>(line, s) ? t : -1;
    }
    ABUT_CALLS_ANY
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD bool meets(const row_type& row, const Line& line, const S& s, std::uint64_t key) const {
        return bounds<A>(row, line, s, key).first >= 0;
    }

private:
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool passes(const row_type& row, std::uint64_t key) const {
        if constexpr (Bodies) {
            return options.filter(row.number, body_of_key(key), static_cast<std::uint32_t>(key));
        } else {
            return options.filter(row.number, static_cast<std::uint32_t>(key));
        }
    }
    template <class A, class Line, class S>
    [[nodiscard]] ABUT_HD bool is_on_side(const Line& line, const S& s) const {
        if (options.side == ray_side::any) return true;
        if constexpr (std::same_as<S, triangle<scalar_type_of<S>>>) {
            return side_of_face<A>(line, s) == (options.side == ray_side::front ? -1 : 1);
        } else {
            return options.side == ray_side::front;
        }
    }
};

/// Whether of two copies of a shape both are wanted or none is: a filter may tell them apart.
template <class Wanted>
inline constexpr bool takes_copies_alike = true;
template <class Filter, class Numbers, bool Bodies>
inline constexpr bool takes_copies_alike<some_hits_wanted<Filter, Numbers, Bodies>> = std::same_as<Filter, keep_all>;

/// Options of a query that is given none.
struct no_ray_options {};

inline void check(const no_ray_options&, const char*) {}
template <class Filter>
void check(const raycast_options<Filter>& options, const char* function) {
    if (options.least_t >= 0 && options.most_t >= 0) return;
    throw error(std::string(function) + ": least_t is " + shortest(options.least_t) + ", most_t is " +
                shortest(options.most_t) + "; expected 0 or more");
}

/// The hits that options want, of rows that may have numbers of their own.
template <bool Bodies, class Rows>
all_hits_wanted hits_wanted(const no_ray_options&, const Rows&) {
    return {};
}
template <bool Bodies, class Filter, class Rows>
auto hits_wanted(const raycast_options<Filter>& options, const Rows& rows) {
    const auto numbers = numbers_of(rows);
    return some_hits_wanted<Filter, std::remove_const_t<decltype(numbers)>, Bodies>{options, numbers};
}

/// The same options for a part's shapes.
template <class Ids>
no_ray_options options_in_part(const no_ray_options& options, const Ids&) {
    return options;
}
template <class Filter, class Ids>
auto options_in_part(const raycast_options<Filter>& options, const Ids& ids) {
    const auto filter = filter_in_part(options.filter, ids);
    return raycast_options<std::remove_const_t<decltype(filter)>>{filter, options.least_t, options.most_t, options.side};
}

template <class Options>
inline constexpr bool has_filter = false;
template <class Filter>
inline constexpr bool has_filter<raycast_options<Filter>> = !std::same_as<Filter, keep_all>;

}  // namespace detail

}  // namespace abut
