// SPDX-License-Identifier: MIT
#pragma once

// raycast_detailed: what raycast finds, and of each hit where in the triangle it is and from which side. Rays walk as they
// do for raycast; the rest is computed of their hits alone.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/raycast.hpp>
#include <abut/narrow/hit_weights.hpp>
#include <abut/predicate/face_side.hpp>

namespace abut {

/// A `ray_hit`, `body_hit` or `global_ray_hit`, and more about it.
/// @ingroup queries
template <class Hit>
struct detailed_hit {
    Hit hit;                         ///< as `raycast` says it
    ray_side side;                   ///< from which the triangle is met; `any` along its plane, and where nothing is met
    vec3<decltype(Hit::t)> weights;  ///< of its corners, 0 or more each: a times the first and so on is the point; or zeros

    friend constexpr bool operator==(const detailed_hit&, const detailed_hit&) = default;
};

namespace detail {

/// What is known of a hit.
template <scalar T>
struct hit_details {
    execution::least_value met;  ///< the largest key where nothing is
    ray_side side;
    vec3<T> weights;
};
template <class A, class Line, scalar T>
ABUT_HD hit_details<T> details_of(const Line& line, const triangle<T>& t, const execution::least_value& met) {
    const int along = side_of_face<A>(line, t);
    return {met, along < 0 ? ray_side::front : along > 0 ? ray_side::back : ray_side::any, hit_weights(line, t, met.value)};
}

template <class A, class Shapes, class Lines, class Ids>
struct write_details {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    Lines lines;
    const execution::least_value* found;  ///< null for none
    Ids ids;
    hit_details<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = found == nullptr ? no_global_id : found[i].key;
        out[i] = {{}, ray_side::any, {0, 0, 0}};
        if (key == no_global_id) return;
        out[i] = details_of<A>(lines[i], shapes[key], {found[i].value, in_whole(ids, key)});
    }
};

/// What parts are asked, of triangles of T.
template <arithmetic A, class Options, scalar T>
struct details_in_parts : ask_first_hit<A, Options> {
    using answer = hit_details<T>;

    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        const auto both = lines_that_want(x, rows, options_in_part(this->options, ids));
        const auto shapes = x.shapes();
        const auto lines = rows.shapes();
        using write = write_details<A, std::remove_const_t<decltype(shapes)>, std::remove_const_t<decltype(lines)>, Ids>;
        look_for_first_hits<A>(on, both, false, [&](const execution::least_value* met) {
            for_each_index(on, both.size(), write{shapes, lines, met, ids, out});
            synchronize(on);
        });
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        if (other->met.comes_before(best->met)) *best = *other;
    }
    template <class Line>
    ABUT_HD bool may_change(const Line& line, const answer* best, const part_bounds<T>& part) const {
        return may_meet(line, part, this->last(best->met.value));
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(const answer& of) const {
        return {named_hit<decltype(Found::hit)>(of.met), of.side, of.weights};
    }
};

/// What a line meets first, and where.
template <arithmetic A, class Options>
struct ask_details : question_of_lines<Options, ask_details<A, Options>> {
    template <scalar T, class Id>
    using found = detailed_hit<by_id<Id, ray_hit<T>, body_hit<T>, global_ray_hit<T>>>;
    static constexpr const char* function = "abut::raycast_detailed";

    template <class Policy, class X, class Lines, bool Whole>
    static consteval bool takes() {
        if constexpr (question_of_lines<Options, ask_details>::template takes<Policy, X, Lines, Whole>()) {
            using shape_type = typename shape_of_argument<X>::type;
            constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
            static_assert(are, "abut: raycast_detailed tells where in a triangle a hit is; of solids there is raycast");
            return are;
        } else {
            return false;
        }
    }
    template <class Policy, class X, class Lines>
    auto at_once(const Policy& on, const X& x, const Lines& lines, double) const {
        using T = typename decltype(x.shapes())::scalar_type;
        const auto in_part = in_parts<T>(0);
        execution::buffer_of<Policy, hit_details<T>> answers(on, lines.shapes().size());
        in_part.ask(on, x, lines, same_key{}, answers.data());
        using row = found<T, operand_id<X>>;
        return result<row, space_of<Policy>>(named_answers<row>(on, in_part, std::move(answers)));
    }
    template <scalar T>
    [[nodiscard]] details_in_parts<A, Options, T> in_parts(double) const {
        return {{{{}, this->options}}};
    }
};

}  // namespace detail

/// For each of `rays` what `raycast` says, with the options too, and of the triangle that is met first the barycentric
/// weights of the place and the side: a `result` of `detailed_hit`. The side is decided exactly. Weights are computed in
/// double, in one order of operations, and add up to 1 but for rounding; they are as good as the time and the ray's distance
/// tell, and the same bits on every policy. Of triangles only; `index`, `rays` and executors are those of `raycast`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 24 bytes a ray in float and 48 in double; scratch takes as
/// much and 16 more.
///
/// @par Errors
/// Those of `raycast`, and `error` where a time of the options is negative or NaN.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp raycast_detailed
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays, class Filter = keep_all>
[[nodiscard]] auto raycast_detailed(const On& on, const X& index, const Rays& rays,
                                    const raycast_options<Filter>& options = {}) {
    return ask_rows(on, detail::ask_details<A, raycast_options<Filter>>{{{}, options}}, index, rays);
}

}  // namespace abut
