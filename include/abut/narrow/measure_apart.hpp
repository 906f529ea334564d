// SPDX-License-Identifier: MIT
#pragma once

// Distances of shapes that do not touch, as walks ask for them that have a bound: most shapes are told to be farther apart by a slab
// between them, in a fraction of the time that measuring takes (distance.hpp).

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/predicate/as_hull.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Measures distances of shapes that do not touch.
struct measure_apart {
    template <class S, class U>
    requires measurable<S, U> ABUT_HD double measure(const S& s, const U& t, double bound) const {
        return look(s, t, bound, {0, 0, 0}).distance;
    }
    /// With a way; `along` is one that is likely to be along it.
    template <class S, class U>
        requires measurable<S, U> ABUT_HD distance_and_way look(const S& s, const U& t, double bound,
                                                                const vec3<double>& along)
    const {
        if constexpr (own_separation<S, U> || own_separation<U, S>) {
            return {positive_distance(s, t, static_cast<double>(separation_of(s, t, false).distance))};
        } else if constexpr (seen_as_hull<S> || seen_as_hull<U>) {
            const auto a = hull_form(s);
            const auto b = hull_form(t);
            return look(a.as_hull(), b.as_hull(), bound, along);
        } else if constexpr (is_half_space<S>) {
            return look(surface_of(s), t, bound, along);
        } else if constexpr (!contact_pair<S, U>) {
            const auto opposite = [](const vec3<double>& v) { return vec3<double>{-v.x, -v.y, -v.z}; };
            const distance_and_way found = look(t, s, bound, opposite(along));
            return {found.distance, opposite(found.way)};
        } else {
            if constexpr (solid_of_revolution<S>) {
                if (is_point(axis_of(s))) return look(ball_around(s), t, bound, along);
            }
            if constexpr (solid_of_revolution<U>) {
                if (is_point(axis_of(t))) return look(s, ball_around(t), bound, along);
            }
            if (is_surely_beyond(s, t, bound, along)) return {};
            return distance_apart(s, t);
        }
    }

private:
    /// Most pairs that a walk meets are told to be too far apart in a fraction of the time that measuring takes: surely they
    /// are, if there is a slab of that width between them. Tried are two vectors w, to which the slab is orthogonal: the
    /// given one, and the way from one's middle to the other's, as they are rounded.
    ///
    /// A corner's product with w is off by less than 5u |w| |corner|, and the gap by twice that of the largest. Nothing is
    /// said where the gap is below 2^-36 of |w| times the root of all corners' squares, so that it is off by 2^-16 of
    /// itself, and the distance, as it is measured, by less. What underflows is nothing beside 2^-900; what overflows says
    /// nothing.
    template <class S, class U>
    ABUT_HD static bool is_surely_beyond(const S& s, const U& t, double bound, const vec3<double>& along) {
        if constexpr (solid_of_revolution<S>) {  // by the capsule around it
            return is_surely_beyond(capsule_around(s), t, bound, along);
        } else if constexpr (solid_of_revolution<U>) {
            return is_surely_beyond(s, capsule_around(t), bound, along);
        } else if constexpr (requires { core_of(s).corners + core_of(t).corners; }) {
            const auto a = core_of(s);
            const auto b = core_of(t);
            constexpr int n = decltype(a)::corners, m = decltype(b)::corners;
            const vec3<double> origin = widened(a.at[0]);
            vec3<double> p[std::size_t{n}], q[std::size_t{m}], sum_a{0, 0, 0}, sum_b{0, 0, 0};
            double all = 0;
            for (int i = 0; i < n; ++i) {
                p[i] = widened(a.at[i]) - origin;
                sum_a = sum_a + p[i];
                all += dot(p[i], p[i]);
            }
            for (int j = 0; j < m; ++j) {
                q[j] = widened(b.at[j]) - origin;
                sum_b = sum_b + q[j];
                all += dot(q[j], q[j]);
            }
            const length_unit<scalar_type_of<S>> plain;
            const double far = bound + (core_radius(s, plain) + core_radius(t, plain));
            const double least_square = greatest(0x1p-72 * all, (1 + 0x1p-10) * (far * far));
            const auto tells = [&](const vec3<double>& w) {
                double from = 0, to = infinity<double>;
                for (int i = 1; i < n; ++i) from = greatest(from, dot(w, p[i]));
                for (int j = 0; j < m; ++j) to = least(to, dot(w, q[j]));
                const double gap = to - from, square = gap * gap;
                return gap > 0 && square > 0x1p-900 && square > dot(w, w) * least_square;
            };
            return tells(along) || tells(static_cast<double>(n) * sum_b - static_cast<double>(m) * sum_a);
        } else if constexpr (measured_hulls<S, U>) {
            return is_slab_between(
                core_points_of(s).as_hull(), core_points_of(t).as_hull(), along,
                bound + (static_cast<double>(radius_around_core(s)) + static_cast<double>(radius_around_core(t))));
        } else {
            return false;
        }
    }
    /// The same of convex hulls, and the given vector alone.
    template <scalar T>
    ABUT_NOINLINE ABUT_HD static bool is_slab_between(const hull<T>& a, const hull<T>& b, const vec3<double>& along,
                                                      double far) {
        const vec3<double> back{-along.x, -along.y, -along.z};
        const hulls_in_floats<true, T> x(a, b);
        std::uint32_t i = 0, j = 0;
        x.look_back(back, i, j);
        const double gap = x.ahead(back, i, j), square = gap * gap, all = 3 * x.size() * x.size();
        return gap > 0 && square > 0x1p-900 &&
               square > dot(along, along) * greatest(0x1p-72 * all, (1 + 0x1p-9) * (far * far));
    }
};

}  // namespace abut::detail
