// SPDX-License-Identifier: MIT
#pragma once

// Does a ray meet a ball, a box, a capsule, a cylinder or a cone? All are solid: a ray that begins inside meets them.
// `filtered` asks estimates, `exact` integers of any length at once, and `fast` plain doubles. When is asked in
// narrow/solid_hit_time.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/certified_line.hpp>
#include <abut/predicate/exact_line_solid.hpp>
#include <abut/predicate/line_solid.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// f(place where a part is met first, the line in it) of each part of a solid.
template <scalar T, line_solid S, class F>
ABUT_HD constexpr void each_first_met(const line_of<T>& l, const S& s, const F& f) {
    line_in_solid<T> in(values_of(l, s).value, l.has_end());
    if constexpr (round_solid<S>) {
        const solid_part part = part_of(s);
        const bool has_caps = std::same_as<S, capsule<T>> && part == solid_part::cylinder;
        const solid_part parts[] = {part, solid_part::ball, solid_part::last_ball};
        ABUT_ROLLED
        for (int i = 0; i < (has_caps ? 3 : 1); ++i) f(in.meet(parts[i]), in);
    } else {
        f(in.meet_box(), in);
    }
}

/// Whether a line meets a solid: decides every finite input.
template <scalar T, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr bool meets_exactly(const line_of<T>& l, const S& s) {
    bool is_met = false;
    each_first_met(l, s, [&](first_met met, const auto&) { is_met = is_met || met != first_met::nothing; });
    return is_met;
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle.
template <arithmetic A, scalar T, detail::line_solid S>
    requires std::same_as<scalar_type_of<S>, T>
ABUT_HD constexpr verdict decide(const ray<T>& r, const S& s) {
    if constexpr (std::same_as<A, exact>) {
        return to_verdict(detail::meets_exactly(detail::line_of<T>(r), s));
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_line(detail::line_of<T>(r), s).met;
    } else {
        return detail::plain_entry(detail::line_of<T>(r), s).met;
    }
}

/// The last stage: decides every finite input.
template <scalar T, detail::line_solid S>
    requires std::same_as<scalar_type_of<S>, T>
ABUT_HD constexpr bool resolve(const ray<T>& r, const S& s) {
    return detail::meets_exactly(detail::line_of<T>(r), s);
}

}  // namespace abut
