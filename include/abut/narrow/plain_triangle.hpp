// SPDX-License-Identifier: MIT
#pragma once

// The first stage of distances and contacts between a triangle and a point or a sphere, as plain_ways.hpp is of other pairs.
// The nearest feature is looked for by regions (C. Ericson, Real-Time Collision Detection (2005), 5.1.5), and trusted where
// no corner lies before it, along the way from the centre, by more than u size, where `size` is the sum of magnitudes of the
// corners, as they are seen from the centre, and of the radius, below 7D. Of a face the corner is taken that is opposite to
// the longest edge, and caps are left, whose sine is small there too: so the foot is known to a few roundings of how far the
// corners are, also of needles.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <class S, class U>
    requires(corners_of_core<S> == 1 && std::same_as<U, triangle<scalar_type_of<S>>>)
struct plain_pair<S, U> : plain_gap {
    using T = scalar_type_of<S>;
    vec3<double> corner[3], edge[3];  ///< corners from the centre, and the edges that begin there
    vec3<double> to_triangle{}, ahead{};
    plain_place<T> nearest{};

    ABUT_HD constexpr plain_pair(const S& s, const U& t)
        : plain_gap{static_cast<double>(radius_around_core(s)), 0},
          corner{plain_way_to(core_of(s).at[0], t.a), plain_way_to(core_of(s).at[0], t.b),
                 plain_way_to(core_of(s).at[0], t.c)},
          edge{plain_way_to(t.a, t.b), plain_way_to(t.b, t.c), plain_way_to(t.c, t.a)} {
        look(t);
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return to_triangle; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_a(const S& s) const { return {core_of(s).at[0]}; }
    [[nodiscard]] ABUT_HD constexpr const plain_place<T>& on_b(const U&) const { return nearest; }

private:
    ABUT_NOINLINE ABUT_HD constexpr void look(const U& t) {
        using contact_math::plain_dot;
        size = plain_step_from(-radius_a, plain_sum(plain_magnitudes(corner[0]),
                                                    plain_sum(plain_magnitudes(corner[1]), plain_magnitudes(corner[2]))));
        if (!are_plain_sizes<T>(size)) return;
        // How far the centre is along each edge, from where that begins and to where it ends.
        double after[3]{}, before[3]{};
        for (int k = 0; k < 3; ++k) {
            after[k] = -plain_dot(edge[k], corner[k]);
            before[k] = plain_dot(edge[k], corner[k == 2 ? 0 : k + 1]);
        }
        // From the corner that is opposite to the longest edge, where the sine is largest.
        const double square[3] = {plain_dot(edge[0], edge[0]), plain_dot(edge[1], edge[1]), plain_dot(edge[2], edge[2])};
        const int at = square[0] >= square[1] && square[0] >= square[2] ? 2
                       : square[1] >= square[2]                         ? 0
                                                                        : 1,
                  last_at = at == 0 ? 2 : at - 1;
        const vec3<double> n = plain_cross(edge[last_at], edge[at]);
        bool is_known = false;
        for (int k = 0; k < 3 && !is_known; ++k) {
            const int last = k == 0 ? 2 : k - 1;
            if (after[k] <= 0 && before[last] <= 0) {
                is_known = true;
                take(t, k, 0, corner[k], corner[k]);
            } else if (after[k] > 0 && before[k] > 0 && plain_dot(plain_cross(edge[k], corner[k]), n) >= 0) {
                is_known = true;
                const double part = after[k] / square[k];
                const vec3<double> way = plain_step(corner[k], part, edge[k]);
                take(t, k, part, way, plain_step(way, -plain_dot(way, edge[k]) / square[k], edge[k]));
            }
        }
        if (!is_known) {
            const double whole = plain_dot(n, n), height = plain_dot(n, corner[at]);
            if (!(whole > 0x1p-5 * plain_product(square[at], square[last_at]))) return;
            take(t, at, 0, plain_times(height / whole, n), height < 0 ? contact_math::negated(n) : n);
            nearest.along = contact_math::plain_difference(to_triangle, corner[at]);
        }
    }
    /// The feature at a corner, or at a part of the edge from there.
    ABUT_HD constexpr void take(const U& t, int k, double part, const vec3<double>& way, const vec3<double>& straight) {
        using contact_math::plain_dot;
        to_triangle = way, ahead = straight;
        nearest = {k == 0 ? t.a : k == 1 ? t.b : t.c, plain_times(part, edge[k])};
        const double before = least(plain_dot(ahead, edge[k]), -plain_dot(ahead, edge[k == 0 ? 2 : k - 1])),
                     slack = 0x1p-53 * size;
        const double square = plain_dot(way, way);
        is_good = (before >= 0 || before * before <= slack * slack * plain_dot(ahead, ahead)) &&
                  square > 0x1p-40 * plain_product(size, size);
        if (is_good) length = contact_math::root(contact_math::one_double{square}).high;
    }
};

/// The triangle's point nearest to the centre, and straight away from there.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr first_contact<T> first_contact_of(const sphere<T>& s, const triangle<T>& t,
                                                                  const plain_pair<sphere<T>, triangle<T>>& both) {
    using namespace contact_math;
    first_contact<T> answer{both.touch()};
    if (answer.touch != verdict::yes) return answer;
    const double per_length = 1 / root(one_double{plain_dot(both.ahead, both.ahead)}).high;
    const point n = plain_normal<T>(plain_times(-per_length, both.ahead));
    const double reach = greatest(plain_dot(n, both.corner[0]), plain_dot(n, both.corner[1]), plain_dot(n, both.corner[2]));
    const double depth = plain_sum(both.radius_a, reach), excess = plain_sum(reach, both.length);
    if (!(excess <=
          8 * static_cast<double>(unit_roundoff<T>) * static_cast<double>(greatest(magnitude_of(s), magnitude_of(t)))))
        return {};
    answer.found = plain_contact(both.nearest.at(0, n), n, depth);
    return answer;
}

}  // namespace abut::detail
