// SPDX-License-Identifier: MIT
#pragma once

// The oracle for lines and solids, in unbounded numbers, by the definition of a first time: it is t or less if and only if
// the segment from the origin to the point at t meets the solid. Whether a segment does is asked of distances between hulls
// (rational.hpp), of separating axes, and of polygons (revolution_oracle.hpp). Nothing here knows a quadratic along a line
// or a root. A time is rounded as it should be if it is not above halfway to the next double and above halfway to the one
// before.

#include <cmath>
#include <concepts>
#include <vector>

#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

#include "rational.hpp"
#include "ray_oracle.hpp"
#include "revolution_oracle.hpp"

namespace abut::test {

/// A solid and a line, in integers of one unit.
template <class S>
class line_oracle {
    using T = scalar_type_of<S>;

public:
    line_oracle(const detail::line_of<T>& l, const S& s) : has_end_(l.has_end()) {
        std::vector<T> numbers{l.origin.x, l.origin.y, l.origin.z, l.end.x,  l.end.y,
                               l.end.z,    l.start.x,  l.start.y,  l.start.z};
        const auto add = [&](const vec3<T>& p) { numbers.insert(numbers.end(), {p.x, p.y, p.z}); };
        if constexpr (requires { s.lower; }) {
            add(s.lower), add(s.upper);
        } else {
            if constexpr (requires { s.center; }) {
                add(s.center), add(s.center);
            } else if constexpr (requires { s.apex; }) {
                add(s.apex), add(s.base_center);
            } else {
                add(s.axis.a), add(s.axis.b);
            }
            numbers.push_back(s.radius);
        }
        const std::vector<integer> v = to_integers(numbers);
        const auto point = [&](std::size_t i) { return integer_point{v[i], v[i + 1], v[i + 2]}; };
        origin_ = point(0), first_ = point(9), last_ = point(12);
        along_ = minus(point(3), point(6));
        if (v.size() > 15) radius_ = v[15];
    }

    /// Whether it is met at t or before that.
    [[nodiscard]] bool is_met_by(const rational& t) const {
        const integer p = numerator(t), q = denominator(t);
        const auto scaled = [&](const integer_point& x) { return integer_point{x.x * q, x.y * q, x.z * q}; };
        const integer_point from = scaled(origin_), to{from.x + p * along_.x, from.y + p * along_.y, from.z + p * along_.z};
        return meets(from, to, scaled(first_), scaled(last_), radius_ * q);
    }
    /// Whether it is met at all.
    [[nodiscard]] bool is_met() const { return is_met_by(has_end_ ? rational(1) : rational(far())); }

    /// Whether x is its first time, rounded to the nearest double, of two that are as near the lesser, or the largest one;
    /// or negative, if there is none.
    [[nodiscard]] bool is_right(double x) const {
        const bool met = is_met();
        if (x < 0 || !met) return x < 0 && !met;
        if (!std::isfinite(x)) return false;
        const double next = std::nextafter(x, HUGE_VAL), before = std::nextafter(x, -1.0);
        if (!std::isinf(next) && !is_met_by((exactly(x) + exactly(next)) / 2)) return false;
        return x == 0 || !is_met_by((exactly(before) + exactly(x)) / 2);
    }

private:
    static integer_point minus(const integer_point& a, const integer_point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    static integer size(const integer_point& a) { return abs(a.x) + abs(a.y) + abs(a.z); }
    /// A time at which the line has passed the solid.
    [[nodiscard]] integer far() const { return 4 * (size(origin_) + size(first_) + size(last_) + radius_ + 1); }

    [[nodiscard]] bool meets(const integer_point& p, const integer_point& q, const integer_point& first,
                             const integer_point& last, const integer& r) const {
        const bool is_ball = first.x == last.x && first.y == last.y && first.z == last.z;
        if constexpr (std::same_as<S, aabb<T>>) {
            return meets_box(p, q, first, last);
        } else if (is_ball || std::same_as<S, sphere<T>>) {
            return hull_reaches({minus(p, first), minus(q, first)}, r * r);
        } else if constexpr (std::same_as<S, capsule<T>>) {
            return hull_reaches({minus(p, first), minus(q, first), minus(q, last)}, r * r) ||
                   hull_reaches({minus(p, first), minus(p, last), minus(q, last)}, r * r);
        } else {
            const auto seen = [&](const integer_point& x) {
                const integer_point w = minus(x, first);
                return fraction_point{fraction(w.x), fraction(w.y), fraction(w.z)};
            };
            exact_solid solid{std::same_as<S, cone<T>>, seen(last), fraction(r), 0};
            solid.dd = inner(solid.d, solid.d);
            return polygon_meets({seen(p), seen(q)}, solid);
        }
    }
    /// Six axes: those of the box and their products with the segment.
    static bool meets_box(const integer_point& p, const integer_point& q, const integer_point& lower,
                          const integer_point& upper) {
        const integer_point e = minus(q, p);
        const integer_point axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, e.z, -e.y}, {-e.z, 0, e.x}, {e.y, -e.x, 0}};
        for (const integer_point& n : axes) {
            const integer at_p = inner(n, p), at_q = inner(n, q), least = at_p < at_q ? at_p : at_q,
                          most = at_p < at_q ? at_q : at_p;
            const integer low = n.x * (n.x > 0 ? lower.x : upper.x) + n.y * (n.y > 0 ? lower.y : upper.y) +
                                n.z * (n.z > 0 ? lower.z : upper.z);
            const integer high = n.x * (n.x > 0 ? upper.x : lower.x) + n.y * (n.y > 0 ? upper.y : lower.y) +
                                 n.z * (n.z > 0 ? upper.z : lower.z);
            if (most < low || high < least) return false;
        }
        return true;
    }

    integer_point origin_, along_, first_, last_;
    integer radius_ = 0;
    bool has_end_;
};

}  // namespace abut::test
