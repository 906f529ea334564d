// SPDX-License-Identifier: MIT
#pragma once

// Does a ray meet a convex hull? If its line does, it goes through a triangle of three of the hull's points, and this finds
// one. Seen along the line, points are around it, or in a wedge that has it outside: points are added to a wedge one by one
// until one lies beyond both sides. Then the ray meets the hull if it meets that triangle, or begins inside of the hull.
//
// All that is asked of numbers are the sides on which the line passes those of two points, the sign of (p x q).d for ways p
// and q from its origin and its direction d. Of a hull that has no extent as seen along the line, all points are in one
// plane with it; then the triangle is a side between two points that the line passes between, or a point on it.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/hull_hull.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/ray_triangle.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Three of a hull's points: (p x q).d and so on are 0 or more, and one of them is not 0. Or, where all points are in one
/// plane with the line, two or one of them, of which the last is repeated.
struct hull_triangle {
    std::uint32_t corner[3] = {};
};

/// A line and a hull. Signs are certain: of doubles, where those tell and `Sifted` is set; and else of integers of up to
/// `Room` limbs, or unknown, if there is no room.
template <int Room, bool Sifted, scalar T>
class line_and_hull {
public:
    /// The line from an origin along the way from start to end.
    ABUT_HD constexpr line_and_hull(const hull<T>& h, const vec3<T>& origin, const vec3<T>& end, const vec3<T>& start)
        : h_(h), origin_(origin), end_(end), start_(start) {
        if constexpr (Room > 0) {
            const vec3<T> at[3] = {origin, end, start};
            const unit_of_hulls<T> unit(h, hull<T>(at, 3));
            fits_ = unit.width() + spare_bits <= 64 * Room;
            unit_ = unit;
        }
    }

    /// A triangle that the line goes through, if there is one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict find(hull_triangle& t) {
        if (Room > 0 && !fits_) return verdict::unknown;
        const auto n = static_cast<std::uint32_t>(h_.count);
        std::uint32_t right = 0, on_line = n;
        while (right < n && is_on_line(right)) ++right;
        if (is_lost_) return verdict::unknown;
        if (right == n) return begin_flat(t, 0, 0);
        std::uint32_t left = right;
        for (std::uint32_t p = 0; p < n && on_line == n; ++p) {
            if (p == right || p == left) continue;
            const int of_right = side(right, p), of_left = side(left, p);
            if (is_lost_) return verdict::unknown;
            if (of_right == 0 && of_left == 0) {
                if (is_on_line(p)) {
                    on_line = p;
                } else if (are_opposite(right, p)) {
                    return complete(right, p, t);
                }
            } else if (of_right <= 0 && of_left >= 0) {
                t = {{right, left, p}};
                return verdict::yes;
            } else if (of_left > 0) {
                left = p;
            } else if (of_right < 0) {
                right = p;
            }
        }
        return on_line == n ? verdict::no : complete(right, on_line, t);
    }

    /// The sign of (p x q).d
    [[nodiscard]] ABUT_HD constexpr int side(std::uint32_t p, std::uint32_t q) {
        return sign_of({origin_, h_[p]}, {origin_, h_[q]}, {start_, end_});
    }
    /// On which side of the plane of three points a fourth one is.
    [[nodiscard]] ABUT_HD constexpr int height(const hull_triangle& t, std::uint32_t p) {
        const vec3<T> from = h_[t.corner[0]];
        return sign_of({from, h_[p]}, {from, h_[t.corner[1]]}, {from, h_[t.corner[2]]});
    }
    /// Whether all points are in one plane with the line, as `find` found out.
    [[nodiscard]] ABUT_HD constexpr bool is_flat() const { return is_flat_; }
    /// Then the side or the point of the hull that the line comes to first, from what `find` found. Returns how often points
    /// were looked at. The two ends are on the line or left of it, and right of it: a point before the side takes the place
    /// of one of them, until there is none. So the line meets each side before the last one, or turns it about a point that
    /// is on the line. Where all points are in convex position, they are looked at no more than four times each.
    ABUT_NOINLINE ABUT_HD constexpr std::uint64_t find_first(hull_triangle& t) {
        const std::uint32_t n = static_cast<std::uint32_t>(h_.count), of = t.corner[0];
        choose_axis(of);
        std::uint32_t a = of, b = n, on_line = n;
        std::uint64_t looks = n;
        for (std::uint32_t p = 0; p < n; ++p) {
            const int s = beside(p);
            if (s < 0) b = p;
            if (s == 0 && (on_line == n || is_before(p, on_line))) on_line = p;
        }
        if (b == n) return begin_flat(t, on_line, on_line), looks;
        for (std::uint32_t p = 0, since = 0; since < n; ++since, ++looks, p = p + 1 < n ? p + 1 : 0) {
            if (turn({h_[a], h_[b]}, {h_[a], h_[p]}) >= 0) continue;
            (beside(p) < 0 ? b : a) = p;
            since = 0;
        }
        begin_flat(t, a, b);
        return looks;
    }

private:
    static constexpr int room = Room > 0 ? Room : 1;
    using integers = hulls_in_integers<room, T, true>;
    struct way {
        vec3<T> from, to;
    };

    [[nodiscard]] ABUT_HD constexpr integers in_integers() const { return integers(h_, h_, unit_); }

    /// The sign of p . (q x r)
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int sign_of(const way& p, const way& q, const way& r) {
        if constexpr (Sifted) {
            if (!ABUT_CONSTANT_EVALUATED()) {
                const int s =
                    certain_side<T>(relative_to(p.from, p.to), relative_to(q.from, q.to), relative_to(r.from, r.to));
                if (s != 0) return s;
            }
        }
        if constexpr (Room > 0) {
            const integers x = in_integers();
            return sign_of_dot(cross(x.between(q.from, q.to), x.between(r.from, r.to)), x.between(p.from, p.to));
        }
        is_lost_ = true;
        return 0;
    }
    /// A side of a hull that is in one plane with the line.
    ABUT_HD constexpr verdict begin_flat(hull_triangle& t, std::uint32_t p, std::uint32_t q) {
        is_flat_ = true;
        t = {{p, q, q}};
        return verdict::yes;
    }
    /// The coordinate of d x p that is seen of such a hull: its largest one, whose sign is that of the left.
    ABUT_NOINLINE ABUT_HD constexpr void choose_axis(std::uint32_t p) {
        if constexpr (Room > 0) {
            const auto v = across(p);
            const int x = bits_of(v.x), y = bits_of(v.y), z = bits_of(v.z);
            axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
            left_ = axis_ == 0 ? v.x.sign() : axis_ == 1 ? v.y.sign() : v.z.sign();
        }
    }
    /// With that coordinate as the last one.
    template <class N>
    [[nodiscard]] ABUT_HD constexpr vec3<N> turned(const vec3<N>& v) const {
        return axis_ == 0 ? vec3<N>{v.y, v.z, v.x} : axis_ == 1 ? vec3<N>{v.z, v.x, v.y} : v;
    }
    /// Whether a way goes to the left of another one, 1, or to its right, -1.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int turn(const way& p, const way& q) const {
        if (Sifted && !ABUT_CONSTANT_EVALUATED()) {
            const vec3<double> v = turned(relative_to(p.from, p.to)), w = turned(relative_to(q.from, q.to));
            const double x = v.x * w.y, y = v.y * w.x, length = greatest(magnitudes(v), magnitudes(w));
            const double bound = 0x1p-48 * (absolute(x) + absolute(y)) +
                                 (lost_of_differences<T> * 0x1p4 * length + 0x1p-960);
            if (length < 0x1p300 && absolute(x - y) > bound) return x > y ? left_ : -left_;
        }
        if constexpr (Room > 0) {
            const integers x = in_integers();
            const auto v = turned(x.between(p.from, p.to)), w = turned(x.between(q.from, q.to));
            return cross(v, w).z.sign() * left_;
        }
        return 0;
    }
    [[nodiscard]] ABUT_HD constexpr int beside(std::uint32_t p) const { return turn({start_, end_}, {origin_, h_[p]}); }
    /// Of two points on the line, whether it comes to the first one first.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_before(std::uint32_t p, std::uint32_t q) const {
        if constexpr (Room > 0) {
            const integers x = in_integers();
            return sign_of_dot(x.between(start_, end_), x.between(h_[p], h_[q])) > 0;
        }
        return false;
    }
    /// d x p, of no length if p is on the line.
    [[nodiscard]] ABUT_HD constexpr auto across(std::uint32_t p) const {
        const integers x = in_integers();
        return cross(x.between(start_, end_), x.between(origin_, h_[p]));
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_on_line(std::uint32_t p) {
        if constexpr (Sifted) {
            if (!ABUT_CONSTANT_EVALUATED()) {
                // Coordinates of the product are within 5u of their terms' magnitudes, as the sums of three are.
                const vec3<double> d = relative_to(start_, end_), w = relative_to(origin_, h_[p]);
                const double length = greatest(magnitudes(d), magnitudes(w)), lost = lost_of_differences<T>;
                const vec3<double> product = absolute(cross(d, w));
                const double bound = 0x1p-48 * (magnitudes(d) * magnitudes(w)) + (lost * 0x1p4 * length + 0x1p-960);
                if (length < 0x1p300 && greatest(product.x, product.y, product.z) > bound) return false;
            }
        }
        if constexpr (Room > 0) {
            const auto v = across(p);
            return v.x.sign() == 0 && v.y.sign() == 0 && v.z.sign() == 0;
        }
        is_lost_ = true;
        return true;
    }
    /// Of points in one plane with the line, whether it passes between them.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool are_opposite(std::uint32_t p, std::uint32_t q) const {
        if constexpr (Room > 0) return sign_of_dot(across(p), across(q)) < 0;
        return false;
    }
    /// A triangle with a point that is beside the line and one that is on the line or opposite.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict complete(std::uint32_t beside, std::uint32_t other,
                                                                   hull_triangle& t) {
        for (std::uint32_t p = 0; p < h_.count; ++p) {
            const int s = side(beside, p);
            if (is_lost_) return verdict::unknown;
            if (s == 0) continue;
            t = s > 0 ? hull_triangle{{other, beside, p}} : hull_triangle{{beside, other, p}};
            return verdict::yes;
        }
        return begin_flat(t, beside, other);
    }

    const hull<T>& h_;
    vec3<T> origin_, end_, start_;
    unit_of_hulls<T> unit_{hull<T>(), hull<T>()};
    bool fits_ = true, is_lost_ = false, is_flat_ = false;
    int axis_ = 0, left_ = 0;
};

template <scalar T>
ABUT_HD constexpr triangle<T> triangle_of(const hull<T>& h, const hull_triangle& t) {
    return {h[t.corner[0]], h[t.corner[1]], h[t.corner[2]]};
}

/// By one line_and_hull; `ask` is a stage that a triangle or a point is asked in.
template <int Room, bool Sifted, scalar T, class Ask>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_ray(const ray<T>& r, const hull<T>& h, const Ask& ask) {
    line_and_hull<Room, Sifted, T> both(h, r.origin, r.direction, vec3<T>{0, 0, 0});
    hull_triangle t;
    const verdict found = both.find(t);
    if (found != verdict::yes) return found;
    // What the line has in common with a flat hull holds the origin, or is all ahead of it or all behind.
    const verdict met = ask(r, triangle_of(h, t));
    return met == verdict::yes ? met : met || ask(h, r.origin);
}

}  // namespace detail

/// One stage of the decision, as for a ray and a triangle. `exact` is unknown only where the exponents span more than 124
/// bits.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const ray<T>& r, const hull<T>& h) {
    const auto ask = [](const auto& s, const auto& t) { return decide<A>(s, t); };
    if constexpr (std::same_as<A, exact>) {
        return detail::decide_ray<2, false>(r, h, ask);
    } else {
        return detail::decide_ray<0, true>(r, h, ask);
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const ray<T>& r, const hull<T>& h) {
    const auto ask = [](const auto& s, const auto& t) { return to_verdict(resolve(s, t)); };
    return detail::decide_ray<detail::limbs_of_any<T>, true>(r, h, ask) == verdict::yes;
}

/// What the filter left: in integers, where doubles do not tell. `fast` always answers.
template <arithmetic A, scalar T>
    requires(!std::same_as<A, exact>)
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const ray<T>& r, const hull<T>& h) {
    const verdict met = detail::decide_ray<2, true>(r, h, [](const auto& s, const auto& t) { return decide<exact>(s, t); });
    return std::same_as<A, fast> && met == verdict::unknown ? to_verdict(resolve(r, h)) : met;
}

}  // namespace abut
