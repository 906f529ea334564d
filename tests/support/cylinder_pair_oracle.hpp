// SPDX-License-Identifier: MIT
#pragma once

// The oracle for cylinders, capsules and cones with each other. It says yes only with a point that lies in both, and no only
// with a direction along which one is wholly before the other: both are tested in integers. How they are found need not be
// proved: both solids grow from their centres by one factor until they touch, and a barrier method of 53 digits, then of
// more, finds the factor, the point and the direction. Nothing here knows a feature, a quartic or a resultant. Where the
// solids seem to touch, points are tried whose coordinates are the simplest fractions near those found. Solids without
// radius are left to the oracles of segments.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/primitive.hpp>

#include "rational.hpp"
#include "revolution_oracle.hpp"

namespace abut::test {

/// What an oracle knows. `touching`: neither a point nor a direction, and the factor is 1 in as many digits as there are.
/// `failed`: none of all that.
enum class finding : int { no, yes, touching, failed };

enum class round_kind : int { cylinder, capsule, cone };

/// A cylinder, a capsule or a cone in integers of a unit that both of a pair have. A cone's apex is `a`.
struct round_body {
    round_kind kind;
    integer_point a, b;
    integer r;

    [[nodiscard]] bool is_capsule() const { return kind == round_kind::capsule; }
    [[nodiscard]] bool is_cone() const { return kind == round_kind::cone; }

    [[nodiscard]] integer_point along() const { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
    [[nodiscard]] integer_point twice_center() const { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

    /// Whether x / q lies in it.
    [[nodiscard]] bool contains(const integer_point& x, const integer& q) const {
        const integer_point w{x.x - q * a.x, x.y - q * a.y, x.z - q * a.z}, d = along();
        const integer dd = inner(d, d), ww = inner(w, w), s = inner(w, d), reach = q * r, rr = reach * reach, end = q * dd;
        if (dd == 0) return ww <= rr;
        if (s < 0) return is_capsule() && ww <= rr;
        if (s > end) return is_capsule() && ww - 2 * q * s + q * end <= rr;
        if (is_cone()) return (ww * dd - s * s) * dd <= r * r * s * s;
        return ww * dd - s * s <= rr * dd;
    }
    /// What the radius adds to its height along n, squared, is that over `unit`.
    [[nodiscard]] integer square_along(const integer_point& n, integer& unit) const {
        const integer_point d = along();
        const integer dd = inner(d, d), nn = inner(n, n), s = inner(n, d);
        unit = is_capsule() || dd == 0 ? integer(1) : dd;
        return is_capsule() || dd == 0 ? integer(r * r * nn) : integer(r * r * (nn * dd - s * s));
    }

    /// A height along n, and the square over `unit` that is added to it.
    struct top {
        integer height, square, unit;
    };
    /// The greatest of these is its greatest height along n: of a cone the apex and the base have one each.
    [[nodiscard]] std::vector<top> tops(const integer_point& n) const {
        const integer high_a = inner(n, a), high_b = inner(n, b);
        top round{is_cone() || high_a < high_b ? high_b : high_a, 0, 1};
        round.square = square_along(n, round.unit);
        if (!is_cone()) return {round};
        return {{high_a, 0, 1}, round};
    }
};

/// Whether all of s is before all of t along n.
inline bool is_before(const round_body& s, const round_body& t, const integer_point& n) {
    const std::vector<round_body::top> lower = s.tops(n), upper = t.tops({-n.x, -n.y, -n.z});
    for (const auto& p : lower) {
        for (const auto& q : upper) {
            const integer room = -q.height - p.height;
            if (room <= 0) return false;
            // room > sqrt(p.square / p.unit) + sqrt(q.square / q.unit)
            const integer first = p.square * q.unit, second = q.square * p.unit,
                          rest = room * room * p.unit * q.unit - first - second;
            if (!(rest > 0 && rest * rest > 4 * first * second)) return false;
        }
    }
    return true;
}

/// The integer in units of 2^shift.
template <class N>
N scaled(const integer& x, int shift) {
    using std::ldexp;
    if (x == 0) return N(0);
    const integer size = abs(x);
    const int excess = static_cast<int>(msb(size)) - std::numeric_limits<N>::digits - 2;
    const integer kept = excess > 0 ? integer(size >> excess) : size;
    const N value = ldexp(static_cast<N>(kept), (excess > 0 ? excess : 0) - shift);
    return x < 0 ? N(-value) : value;
}

/// x 2^shift, without what is behind the point.
inline integer whole(double x, int shift) {
    int e = 0;
    const double m = std::frexp(x, &e);
    integer r = static_cast<std::int64_t>(std::ldexp(m, 53));
    const int left = e - 53 + shift;
    return left >= 0 ? integer(r << left) : r < 0 ? integer(-integer(integer(-r) >> -left)) : integer(r >> -left);
}
template <class N>
integer whole(const N& x, int shift) {
    return static_cast<integer>(ldexp(x, shift));
}

/// The same number in another type, by doubles that add up to it.
template <class N, class M>
N in_pieces(const M& x) {
    using std::frexp, std::ldexp;
    int e = 0;
    M rest = frexp(x, &e);
    N sum(0);
    for (int i = 0; i <= std::numeric_limits<M>::digits / 50; ++i) {
        const auto piece = static_cast<double>(rest);
        rest -= piece;
        sum += piece;
    }
    return ldexp(sum, e);
}

/// The simplest fraction within 2^-close of x / 2^digits: the first convergent.
inline fraction simplest(const integer& x, int digits, int close) {
    const fraction value(x, integer(1) << digits), error(1, integer(1) << close);
    integer n = x, m = integer(1) << digits, p0 = 1, q0 = 0, p1 = 0, q1 = 1;
    bool is_first = true;
    while (m != 0) {
        integer a = n / m;
        if (a * m > n) --a;  // n may be negative
        const integer rest = n - a * m, p = is_first ? a : integer(a * p0 + p1),
                      q = is_first ? integer(1) : integer(a * q0 + q1);
        is_first = false;
        p1 = p0, q1 = q0, p0 = p, q0 = q;
        if (abs(fraction(fraction(p, q) - value)) <= error) return fraction(p, q);
        n = m, m = rest;
    }
    return value;
}

/// Two round bodies that grow from their centres, and the factor at which they touch. The first centre is the origin, and
/// lengths are twice what they are, so that half an axis is `d`. A body is one or two terms, each of one number that is as
/// large as the length of some others, or not negative where there are none: all linear in the place, the factor and, for
/// capsules, a place along the axis.
template <class N>
class growth {
public:
    static constexpr int digits = std::numeric_limits<N>::digits;
    static constexpr int most = 6;
    struct vector {
        N number[most];

        N& operator[](int i) { return number[i]; }
        const N& operator[](int i) const { return number[i]; }
    };
    struct square_matrix {
        vector row[most];

        vector& operator[](int i) { return row[i]; }
        const vector& operator[](int i) const { return row[i]; }
    };

    growth(const round_body& s, const round_body& t, int shift) : bodies_{&s, &t}, shift_(shift) {
        const integer_point o = s.twice_center(), c = t.twice_center();
        const integer from[3] = {c.x - o.x, c.y - o.y, c.z - o.z};
        for (int k = 0; k < 3; ++k) center_[1][k] = scaled<N>(from[k], shift), center_[0][k] = 0;
        for (int i = 0; i < 2; ++i) add_body(i);
    }

    /// A first place on the central path; false where numbers fail.
    bool begin() {
        v_ = {};
        for (int k = 0; k < 3; ++k) v_[k] = center_[1][k] / 2;
        v_[3] = 0;
        N largest(1);
        for (const term& c : terms_) {
            N sum(0);
            for (int i = 0; i < c.count; ++i) {
                const N x = value(c.row[i], c.constant[i], v_);
                sum += x * x;
            }
            if (!(sum >= 0)) return false;
            using std::sqrt;
            const N root = sqrt(sum);
            if (largest < root) largest = root;
        }
        v_[3] = 4 * largest;
        mu_ = v_[3];
        return centre(v_, mu_, 400);
    }
    /// From where another one got to.
    template <class M>
    bool begin_at(const growth<M>& o) {
        for (int i = 0; i < most; ++i) v_[i] = in_pieces<N>(o.v_[i]);
        mu_ = in_pieces<N>(o.mu_);
        return centre(v_, mu_, 60);
    }

    /// Nearer to the end of the path; false where the digits do not reach. The factor of the steps is kept in `step`.
    bool advance() {
        using std::sqrt, std::ldexp;
        if (mu_ < ldexp(N(1), -digits * 3 / 4)) return false;
        for (int i = 0; i < 12; ++i) {
            vector there{};
            const N next = mu_ / step_;
            if (tangent(there)) {
                vector moved = v_;
                for (int k = 0; k < size_; ++k) moved[k] -= (1 - 1 / step_) / mu_ * there[k];
                if (is_inside(moved) && centre(moved, next, 12)) {
                    v_ = moved, mu_ = next;
                    if (i == 0 && step_ < ldexp(N(1), digits / 24)) step_ = step_ * step_;
                    return true;
                }
            }
            step_ = sqrt(step_);
            if (step_ < 1.05) return false;
        }
        return false;
    }

    [[nodiscard]] const N& factor() const { return v_[3]; }
    [[nodiscard]] const N& width() const { return mu_; }

    /// Whether the point of the path lies in both.
    [[nodiscard]] bool has_point() const {
        if (!(v_[3] <= 1)) return false;
        integer q;
        const integer_point x = place(q);
        return bodies_[0]->contains(x, q) && bodies_[1]->contains(x, q);
    }
    /// Whether the direction of the path separates them.
    [[nodiscard]] bool has_direction() const {
        using std::sqrt, std::abs;
        N n[3] = {N(0), N(0), N(0)}, greatest(0);
        for (const term& c : terms_) {
            if (c.body != 0) continue;
            N x[4], q;
            if (!evaluate(c, v_, x, q)) return false;
            for (int k = 0; k < 3; ++k) {
                n[k] -= x[0] * c.row[0][k] / q;
                for (int i = 1; i < c.count; ++i) n[k] += x[i] * c.row[i][k] / q;
            }
        }
        for (const N& x : n) greatest = greatest < abs(x) ? N(abs(x)) : greatest;
        if (!(greatest > 0)) return false;
        N apart(0), reach(0), nn(0);
        for (int k = 0; k < 3; ++k) n[k] /= greatest, nn += n[k] * n[k], apart += n[k] * center_[1][k];
        for (int i = 0; i < 2; ++i) {
            N along(0);
            for (int k = 0; k < 3; ++k) along += n[k] * d_[i][k];
            if (i == 1) along = -along;
            const N across = bodies_[i]->is_capsule() || dd_[i] == 0 ? nn : N(nn - along * along / dd_[i]);
            const N round = across > 0 ? N(sqrt(across) * r_[i]) : N(0);
            if (bodies_[i]->is_cone() && dd_[i] > 0) {
                reach += -along < along + round ? N(along + round) : N(-along);
            } else {
                reach += abs(along) + round;
            }
        }
        if (!(apart > reach)) return false;
        const int p = 2 * digits;
        return is_before(*bodies_[0], *bodies_[1], {whole(n[0], p), whole(n[1], p), whole(n[2], p)});
    }

    /// Whether a simple point near that of the path lies in both: the simplest fractions, or those across an axis, along it
    /// or from an apex, where the solids touch in a segment or in a part of a plane.
    [[nodiscard]] bool has_simple_point() const {
        integer q;
        const integer_point x = place(q);
        const fraction exactly[3] = {fraction(x.x, q), fraction(x.y, q), fraction(x.z, q)};
        const int close = digits / 6 - shift_ > 8 ? digits / 6 - shift_ : 8;
        const auto near = [close](const fraction& f) {
            const int fine = 2 * digits + close;
            return simplest(integer((numerator(f) << fine) / denominator(f)), fine, close);
        };
        if (is_common(near(exactly[0]), near(exactly[1]), near(exactly[2]))) return true;
        for (const round_body* body : bodies_) {
            const integer_point d = body->along();
            const fraction dd(inner(d, d)), direction[3] = {fraction(d.x), fraction(d.y), fraction(d.z)},
                                            start[3] = {fraction(body->a.x), fraction(body->a.y), fraction(body->a.z)};
            if (dd == 0) continue;
            fraction along(0);
            for (int k = 0; k < 3; ++k) along += (exactly[k] - start[k]) * direction[k];
            along /= dd;
            fraction p[3];
            for (int k = 0; k < 3; ++k) p[k] = near(exactly[k] - start[k] - along * direction[k]);
            // In a segment along the axis.
            const fraction parts = fraction(integer((numerator(along) << 12) / denominator(along)), integer(1) << 12);
            for (int k = 0; k < 3; ++k) p[k] += start[k] + parts * direction[k];
            if (is_common(p[0], p[1], p[2])) return true;
            // In a segment from the apex, at a height that is as rough.
            if (body->is_cone() && parts > 0) {
                for (int k = 0; k < 3; ++k) p[k] = start[k] + parts * near((exactly[k] - start[k]) / along);
                if (is_common(p[0], p[1], p[2])) return true;
            }
            // In the plane of an end.
            for (int end = 0; end < 2; ++end) {
                for (int k = 0; k < 3; ++k) p[k] = exactly[k] + (end - along) * direction[k];
                if (is_common(p[0], p[1], p[2])) return true;
            }
        }
        return false;
    }

private:
    template <class M>
    friend class growth;

    struct term {
        int body, count;
        vector row[4];
        N constant[4];
    };

    void add_body(int i) {
        const round_body& b = *bodies_[i];
        const integer_point d = b.along();
        const integer along[3] = {d.x, d.y, d.z};
        for (int k = 0; k < 3; ++k) d_[i][k] = scaled<N>(along[k], shift_);
        r_[i] = scaled<N>(2 * b.r, shift_);
        dd_[i] = 0;
        for (int k = 0; k < 3; ++k) dd_[i] += d_[i][k] * d_[i][k];
        const auto blank = [i](int count) {
            term c{i, count, {}, {}};
            c.row[0][3] = 1;
            return c;
        };
        const bool has_axis = dd_[i] > 0;
        term across = blank(4);
        for (int k = 0; k < 3; ++k) {
            for (int l = 0; l < 3; ++l) {
                N x(k == l ? 1 : 0);
                if (has_axis && !b.is_capsule()) x -= d_[i][k] * d_[i][l] / dd_[i];
                across.row[k + 1][l] = x / r_[i];
            }
            if (has_axis && b.is_capsule()) across.row[k + 1][size_] = -d_[i][k] / r_[i];
        }
        // From the apex, at -1, to the base, at 1, the radius grows.
        if (has_axis && b.is_cone()) {
            across.row[0][3] = N(1) / 2;
            for (int l = 0; l < 3; ++l) across.row[0][l] = d_[i][l] / dd_[i] / 2;
        }
        set_constants(across);
        terms_.push_back(across);
        if (!has_axis) return;
        term ends = blank(b.is_cone() ? 1 : 2);
        if (b.is_cone()) {
            for (int l = 0; l < 3; ++l) ends.row[0][l] = -d_[i][l] / dd_[i];
        } else if (b.is_capsule()) {
            ends.row[1][size_++] = 1;
        } else {
            for (int l = 0; l < 3; ++l) ends.row[1][l] = d_[i][l] / dd_[i];
        }
        set_constants(ends);
        terms_.push_back(ends);
    }
    void set_constants(term& c) const {
        for (int k = 0; k < c.count; ++k) {
            for (int l = 0; l < 3; ++l) c.constant[k] -= c.row[k][l] * center_[c.body][l];
        }
    }

    [[nodiscard]] N value(const vector& row, const N& constant, const vector& v) const {
        N sum = constant;
        for (int k = 0; k < size_; ++k) sum += row[k] * v[k];
        return sum;
    }
    /// The numbers of a term; false where the place is not inside of it.
    bool evaluate(const term& c, const vector& v, N (&x)[4], N& q) const {
        using std::sqrt;
        N sum(0);
        for (int i = 0; i < c.count; ++i) {
            x[i] = value(c.row[i], c.constant[i], v);
            if (i > 0) sum += x[i] * x[i];
        }
        const N root = sqrt(sum);
        q = (x[0] - root) * (x[0] + root);
        return x[0] > 0 && q > 0;
    }
    [[nodiscard]] bool is_inside(const vector& v) const {
        N x[4], q;
        for (const term& c : terms_) {
            if (!evaluate(c, v, x, q)) return false;
        }
        return true;
    }

    /// The gradient and the matrix of the barrier, but for the factor's own.
    bool derive(const vector& v, vector& gradient, square_matrix& matrix) const {
        gradient = {};
        matrix = {};
        N x[4], q;
        for (const term& c : terms_) {
            if (!evaluate(c, v, x, q)) return false;
            vector g{};
            for (int k = 0; k < size_; ++k) {
                g[k] = x[0] * c.row[0][k];
                for (int i = 1; i < c.count; ++i) g[k] -= x[i] * c.row[i][k];
                g[k] *= 2 / q;
            }
            const N twice = 2 / q;
            for (int k = 0; k < size_; ++k) {
                gradient[k] -= g[k];
                for (int l = 0; l <= k; ++l) {
                    N sum = -c.row[0][k] * c.row[0][l];
                    for (int i = 1; i < c.count; ++i) sum += c.row[i][k] * c.row[i][l];
                    matrix[k][l] += g[k] * g[l] + twice * sum;
                }
            }
        }
        return true;
    }
    /// x with matrix x = b, by the roots of the matrix.
    bool solve(square_matrix& m, const vector& b, vector& x) const {
        using std::sqrt;
        for (int k = 0; k < size_; ++k) {
            for (int l = 0; l <= k; ++l) {
                N sum = m[k][l];
                for (int i = 0; i < l; ++i) sum -= m[k][i] * m[l][i];
                if (k == l && !(sum > 0)) return false;
                m[k][l] = k == l ? N(sqrt(sum)) : N(sum / m[l][l]);
            }
        }
        for (int k = 0; k < size_; ++k) {
            N sum = b[k];
            for (int i = 0; i < k; ++i) sum -= m[k][i] * x[i];
            x[k] = sum / m[k][k];
        }
        for (int k = size_ - 1; k >= 0; --k) {
            N sum = x[k];
            for (int i = k + 1; i < size_; ++i) sum -= m[i][k] * x[i];
            x[k] = sum / m[k][k];
        }
        return true;
    }
    bool centre(vector& v, const N& mu, int tries) const {
        using std::sqrt;
        vector gradient{}, move{};
        square_matrix matrix{};
        for (int i = 0; i < tries; ++i) {
            if (!derive(v, gradient, matrix)) return false;
            gradient[3] += 1 / mu;
            for (int k = 0; k < size_; ++k) gradient[k] = -gradient[k];
            if (!solve(matrix, gradient, move)) return false;
            N square(0);
            for (int k = 0; k < size_; ++k) square += gradient[k] * move[k];
            if (!(square >= 0)) return false;
            const N decrement = sqrt(square);
            const N part = decrement < 0.5 ? N(1) : N(1 / (1 + decrement));
            vector moved = v;
            for (int k = 0; k < size_; ++k) moved[k] += part * move[k];
            if (!is_inside(moved)) return false;
            v = moved;
            if (decrement < 0.1) return true;
        }
        return false;
    }
    bool tangent(vector& x) const {
        vector gradient{}, b{};
        square_matrix matrix{};
        if (!derive(v_, gradient, matrix)) return false;
        b[3] = 1;
        return solve(matrix, b, x);
    }

    /// The place found is that over q.
    [[nodiscard]] integer_point place(integer& q) const {
        const int p = 2 * digits, fine = p > shift_ ? p - shift_ : 0;
        const integer_point o = bodies_[0]->twice_center();
        const integer unit = integer(1) << fine;
        const int up = p > shift_ ? p : shift_;
        q = 2 * unit;
        return {whole(v_[0], up) + o.x * unit, whole(v_[1], up) + o.y * unit, whole(v_[2], up) + o.z * unit};
    }
    [[nodiscard]] bool is_common(const fraction& x, const fraction& y, const fraction& z) const {
        const integer q = denominator(x) * denominator(y) * denominator(z);
        const integer_point p{numerator(x) * (q / denominator(x)), numerator(y) * (q / denominator(y)),
                              numerator(z) * (q / denominator(z))};
        return bodies_[0]->contains(p, q) && bodies_[1]->contains(p, q);
    }

    const round_body* bodies_[2];
    int shift_, size_ = 4;
    N center_[2][3], d_[2][3], dd_[2], r_[2];
    std::vector<term> terms_;
    vector v_{};
    N mu_{}, step_{4};
};

/// Points and directions that need no search: centres, ends, their feet on the other axis, and what is between them. Numbers
/// of all exponents are mostly decided by them.
inline finding by_plain_guesses(const round_body& s, const round_body& t) {
    const integer_point d = s.along(), e = t.along();
    const auto cross_of = [](const integer_point& a, const integer_point& b) {
        return integer_point{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const auto twice = [](const integer_point& x) { return integer_point{2 * x.x, 2 * x.y, 2 * x.z}; };
    const integer_point o = s.twice_center(), c = t.twice_center(), w{c.x - o.x, c.y - o.y, c.z - o.z};
    for (const integer_point& x : {o, c, twice(s.a), twice(s.b), twice(t.a), twice(t.b)}) {
        if (s.contains(x, 2) && t.contains(x, 2)) return finding::yes;
    }
    for (const integer_point& n : {w, d, e, cross_of(d, e), cross_of(cross_of(d, w), d), cross_of(cross_of(e, w), e)}) {
        if (is_before(s, t, n) || is_before(t, s, n)) return finding::no;
    }
    for (int i = 0; i < 2; ++i) {
        const round_body &from = i == 0 ? s : t, &to = i == 0 ? t : s;
        const integer_point along = to.along();
        const integer unit = inner(along, along);
        if (unit == 0) continue;
        for (const integer_point& x : {from.twice_center(), twice(from.a), twice(from.b)}) {
            const integer_point v{x.x - 2 * to.a.x, x.y - 2 * to.a.y, x.z - 2 * to.a.z};
            integer at = inner(v, along);
            if (at < 0) at = 0;
            if (at > 2 * unit) at = 2 * unit;
            const integer_point n{unit * v.x - at * along.x, unit * v.y - at * along.y, unit * v.z - at * along.z};
            if (is_before(s, t, n) || is_before(t, s, n)) return finding::no;
            // The foot, and the point between it and x that is at the radius.
            const integer q = 2 * unit;
            const integer_point foot{unit * x.x - n.x, unit * x.y - n.y, unit * x.z - n.z};
            if (s.contains(foot, q) && t.contains(foot, q)) return finding::yes;
            const integer square = inner(n, n), reach = to.r * q;
            if (square == 0) continue;
            const integer size = sqrt(square) + 1;
            const integer_point near{foot.x * size + n.x * reach, foot.y * size + n.y * reach, foot.z * size + n.z * reach};
            const integer whole_unit = q * size;
            if (s.contains(near, whole_unit) && t.contains(near, whole_unit)) return finding::yes;
            if (!to.is_cone()) continue;
            // The normal of the line of the side that is nearest to x, and its nearest point.
            at = inner(v, along);
            const integer_point out{unit * v.x - at * along.x, unit * v.y - at * along.y, unit * v.z - at * along.z};
            const integer far = sqrt(inner(out, out)) + 1, back = to.r * far;
            const integer_point normal{unit * out.x - back * along.x, unit * out.y - back * along.y,
                                       unit * out.z - back * along.z};
            if (is_before(s, t, normal) || is_before(t, s, normal)) return finding::no;
            const integer_point line{far * along.x + to.r * out.x, far * along.y + to.r * out.y,
                                     far * along.z + to.r * out.z};
            integer part = inner(v, line), all = 2 * inner(line, line);
            if (part < 0) part = 0;
            if (part * far > all) part = 1, all = far;
            const integer_point on_side{to.a.x * all + part * line.x, to.a.y * all + part * line.y,
                                        to.a.z * all + part * line.z};
            if (s.contains(on_side, all) && t.contains(on_side, all)) return finding::yes;
        }
    }
    return finding::failed;
}

/// Along the path in numbers of the type N, from where those of M got to.
template <class N, class M>
finding search(const growth<M>* before, growth<N>& path, bool& is_begun) {
    using std::abs, std::ldexp;
    is_begun = before != nullptr && path.begin_at(*before);
    if (!is_begun) is_begun = path.begin();
    if (!is_begun) return finding::failed;
    do {
        if (path.has_point()) return finding::yes;
        if (path.has_direction()) return finding::no;
    } while (path.advance());
    // The factor is no farther from the one that is sought than 8 times the width.
    const bool seems_one =
        abs(N(path.factor() - 1)) < 1024 * path.width() && path.width() < ldexp(N(1), -growth<N>::digits / 4);
    if (!seems_one) return finding::failed;
    return growth<N>::digits > 53 && path.has_simple_point() ? finding::yes : finding::touching;
}

template <int digits>
using binary_number = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<digits, boost::multiprecision::digit_base_2, void, int>,
    boost::multiprecision::et_off>;

/// In numbers of one type after the other.
template <class N, class... More, class M>
finding search_in(const round_body& s, const round_body& t, int shift, const growth<M>* before) {
    growth<N> path(s, t, shift);
    bool is_begun = false;
    const finding found = search(before, path, is_begun);
    if constexpr (sizeof...(More) == 0) {
        return found;
    } else {
        if (found == finding::yes || found == finding::no) return found;
        return search_in<More...>(s, t, shift, is_begun ? &path : nullptr);
    }
}

/// Both have a radius. Where exponents are thousands apart it takes a minute to be `patient`.
inline finding examine_bodies(const round_body& first, const round_body& second, bool patient) {
    const auto size_of = [](const round_body& b) {
        const integer_point d = b.along();
        return integer(abs(d.x) + abs(d.y) + abs(d.z) + b.r);
    };
    // The place is seen from the smaller one.
    const bool swapped = size_of(second) < size_of(first);
    const round_body &s = swapped ? second : first, &t = swapped ? first : second;
    const integer_point o = s.twice_center(), c = t.twice_center();
    const integer largest = size_of(t) + abs(integer(c.x - o.x)) + abs(integer(c.y - o.y)) + abs(integer(c.z - o.z));
    const int shift = static_cast<int>(msb(largest));
    const growth<double>* const none = nullptr;
    if (shift > 150) {
        const finding plain = by_plain_guesses(s, t);
        if (plain != finding::failed) return plain;
    }
    const finding found = search_in<double, binary_number<200>, binary_number<700>, binary_number<2000>>(s, t, shift, none);
    return found == finding::failed && patient ? search_in<binary_number<5000>>(s, t, shift, none) : found;
}

namespace oracle {

template <class S>
inline constexpr round_kind kind_of_round = round_kind::cylinder;
template <scalar T>
inline constexpr round_kind kind_of_round<capsule<T>> = round_kind::capsule;
template <scalar T>
inline constexpr round_kind kind_of_round<cone<T>> = round_kind::cone;

template <scalar T>
const segment<T>& axis_of(const capsule<T>& s) {
    return s.axis;
}

/// Both in integers.
template <class S, class U, class T = decltype(S::radius)>
void bodies_of(const S& s, const U& t, round_body& p, round_body& q) {
    const segment<T> d = axis_of(s), e = axis_of(t);
    const auto v = to_integers(std::vector<T>{d.a.x, d.a.y, d.a.z, d.b.x, d.b.y, d.b.z, s.radius,  //
                                              e.a.x, e.a.y, e.a.z, e.b.x, e.b.y, e.b.z, t.radius});
    p = {kind_of_round<S>, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
    q = {kind_of_round<U>, {v[7], v[8], v[9]}, {v[10], v[11], v[12]}, v[13]};
}

/// A segment and a body, exactly.
inline bool segment_meets(const round_body& s, const round_body& t) {
    const auto minus = [](const integer_point& a, const integer_point& b) {
        return integer_point{a.x - b.x, a.y - b.y, a.z - b.z};
    };
    const integer_point d = t.along();
    const integer dd = inner(d, d);
    if (t.is_capsule() || dd == 0) {
        // A parallelogram of differences, as two triangles.
        return hull_reaches({minus(s.a, t.a), minus(s.b, t.a), minus(s.b, t.b)}, t.r * t.r) ||
               hull_reaches({minus(s.a, t.a), minus(s.a, t.b), minus(s.b, t.b)}, t.r * t.r);
    }
    const auto seen = [&](const integer_point& x) {
        const integer_point w = minus(x, t.a);
        return fraction_point{fraction(w.x), fraction(w.y), fraction(w.z)};
    };
    return polygon_meets({seen(s.a), seen(s.b)}, {t.is_cone(), seen(t.b), fraction(t.r), fraction(dd)});
}

template <class S, class U>
finding examine_round(const S& s, const U& t, bool patient = false) {
    round_body p, q;
    bodies_of(s, t, p, q);
    if (p.r == 0) return segment_meets(p, q) ? finding::yes : finding::no;
    if (q.r == 0) return segment_meets(q, p) ? finding::yes : finding::no;
    return examine_bodies(p, q, patient);
}

}  // namespace oracle

}  // namespace abut::test
