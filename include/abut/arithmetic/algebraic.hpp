// SPDX-License-Identifier: MIT
#pragma once

// Polynomials with integer coefficients, their roots in [0, 1], and the signs of other polynomials at such a root, all of
// them exact. For the few questions about moving features that floating point leaves open; on hosts alone. Degrees are
// small: all that grows is the length of the coefficients.
//
// Roots are isolated by bisection with Descartes' rule of signs (G. Collins, A. Akritas, Polynomial real root isolation
// using Descartes' rule of signs, 1976). A root is known by its cell: the interval [j, j + 1) / 2^48 in which it is, or a
// finer one.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/arithmetic/big_int.hpp>

namespace abut::detail {

/// c[0] + c[1] t + ...; the last coefficient is not 0, and 0 has none.
struct polynomial {
    std::vector<big_int> c;

    polynomial() = default;
    explicit polynomial(std::vector<big_int> coefficients) : c(std::move(coefficients)) {
        while (!c.empty() && c.back().sign() == 0) c.pop_back();
    }
    /// The number that is `at_0` at 0 and `at_1` at 1 and changes evenly.
    polynomial(const big_int& at_0, const big_int& at_1) : polynomial(std::vector<big_int>{at_0, at_1 - at_0}) {}

    [[nodiscard]] bool is_zero() const { return c.empty(); }
    [[nodiscard]] std::size_t degree() const { return c.empty() ? 0 : c.size() - 1; }

    friend polynomial operator+(const polynomial& a, const polynomial& b) { return sum<false>(a, b); }
    friend polynomial operator-(const polynomial& a, const polynomial& b) { return sum<true>(a, b); }
    friend polynomial operator*(const polynomial& a, const polynomial& b) {
        if (a.is_zero() || b.is_zero()) return {};
        std::vector<big_int> r(a.c.size() + b.c.size() - 1);
        for (std::size_t i = 0; i < a.c.size(); ++i) {
            for (std::size_t j = 0; j < b.c.size(); ++j) r[i + j] = r[i + j] + a.c[i] * b.c[j];
        }
        return polynomial(std::move(r));
    }

private:
    template <bool Minus>
    static polynomial sum(const polynomial& a, const polynomial& b) {
        std::vector<big_int> r(std::max(a.c.size(), b.c.size()));
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (i >= b.c.size()) {
                r[i] = a.c[i];
            } else if (i >= a.c.size()) {
                r[i] = Minus ? -b.c[i] : b.c[i];
            } else {
                r[i] = Minus ? a.c[i] - b.c[i] : a.c[i] + b.c[i];
            }
        }
        return polynomial(std::move(r));
    }
};

inline polynomial derivative(const polynomial& p) {
    std::vector<big_int> r;
    for (std::size_t i = 1; i < p.c.size(); ++i) r.push_back(p.c[i] * big_int(static_cast<std::int64_t>(i)));
    return polynomial(std::move(r));
}

/// What is left of a power of b's leading coefficient, times a, when it is divided by b; and the quotient.
struct pseudo_division {
    polynomial quotient, remainder;

    pseudo_division(const polynomial& a, const polynomial& b) : remainder(a) {
        const std::size_t n = b.degree();
        if (a.c.size() < b.c.size()) return;
        std::vector<big_int> q(a.c.size() - n), r = a.c;
        for (std::size_t k = q.size(); k-- > 0;) {
            const big_int lead = r[k + n];
            for (big_int& x : q) x = x * b.c[n];
            for (std::size_t i = 0; i < k + n; ++i) r[i] = r[i] * b.c[n];
            for (std::size_t i = 0; i < n; ++i) r[k + i] = r[k + i] - lead * b.c[i];
            r.pop_back();
            q[k] = q[k] + lead;
        }
        quotient = polynomial(std::move(q));
        remainder = polynomial(std::move(r));
    }
};

/// A greatest common divisor, up to a factor that is a number. Neither is 0.
inline polynomial common_divisor(polynomial a, polynomial b) {
    while (!b.is_zero()) {
        polynomial r = pseudo_division(a, b).remainder;
        a = std::move(b);
        b = std::move(r);
    }
    return a;
}

/// p(j / 2^depth) times a power of two: its sign.
inline int sign_at(const polynomial& p, const big_int& j, int depth) {
    if (p.is_zero()) return 0;
    const std::size_t n = p.degree();
    big_int value = p.c[n];
    for (std::size_t i = n; i-- > 0;) value = value * j + (p.c[i] << depth * static_cast<int>(n - i));
    return value.sign();
}

/// p((j + x) / 2^depth) times a power of two, as a polynomial in x: p as it is seen from the cell.
inline polynomial in_cell(const polynomial& p, const big_int& j, int depth) {
    std::vector<big_int> r = p.c;
    const std::size_t n = p.degree();
    for (std::size_t i = 0; i < n; ++i) r[i] = r[i] << depth * static_cast<int>(n - i);
    for (std::size_t i = 0; j.sign() != 0 && i < n; ++i) {
        for (std::size_t k = n; k-- > i;) r[k] = r[k] + j * r[k + 1];
    }
    return polynomial(std::move(r));
}
/// Its halves.
inline polynomial left_half(const polynomial& p) { return in_cell(p, big_int(), 1); }
inline polynomial right_half(const polynomial& p) { return in_cell(p, big_int(1), 1); }
inline int sign_in_the_middle(const polynomial& p) { return sign_at(p, big_int(1), 1); }

/// Changes of sign in the coefficients of (1 + x)^n p(1 / (1 + x)), n being the degree: as many as p has roots in the open
/// interval from 0 to 1, or more by an even number. And the last sign that is not 0, which is p's where there is no change.
struct descartes {
    int changes = 0, last = 0;

    explicit descartes(const polynomial& p) {
        std::vector<big_int> r(p.c.rbegin(), p.c.rend());
        for (std::size_t i = 0; i + 1 < r.size(); ++i) {
            for (std::size_t k = r.size() - 1; k-- > i;) r[k] = r[k] + r[k + 1];
        }
        for (const big_int& x : r) {
            const int s = x.sign();
            if (s == 0) continue;
            changes += last != 0 && s != last;
            last = s;
        }
    }
};

/// A root in [0, 1] of a polynomial without double roots, by its cell.
class cell_of_root {
public:
    /// j / 2^depth itself, or the only root of `of` between it and (j + 1) / 2^depth.
    cell_of_root(const polynomial* of, big_int j, int depth, bool is_exact)
        : of_(of), j_(std::move(j)), depth_(depth), exact_(is_exact) {}

    /// The largest integer that is not above the root times 2^bits, for bits no larger than 48.
    [[nodiscard]] std::int64_t floor(int bits) const { return j_.shifted_down(depth_ - bits); }

    /// The sign of g at the root.
    [[nodiscard]] int sign_of(const polynomial& g) const {
        if (g.is_zero()) return 0;
        if (exact_) return sign_at(g, j_, depth_);
        polynomial h = in_cell(g, j_, depth_);
        const descartes seen(h);
        if (seen.changes == 0) return seen.last;
        const polynomial common = common_divisor(*of_, g);
        if (common.degree() > 0 && descartes(in_cell(common, j_, depth_)).changes % 2 == 1) return 0;
        // It is not 0 there, and a cell that is small enough shows its sign.
        polynomial f = in_cell(*of_, j_, depth_);
        const int at_0 = sign_after_0(f);
        for (;;) {
            const int middle = sign_in_the_middle(f);
            if (middle == 0) return sign_in_the_middle(h);
            const bool right = middle == at_0;
            f = right ? right_half(f) : left_half(f);
            h = right ? right_half(h) : left_half(h);
            const descartes closer(h);
            if (closer.changes == 0) return closer.last;
        }
    }

private:
    static int sign_after_0(const polynomial& p) {
        std::size_t i = 0;
        while (p.c[i].sign() == 0) ++i;
        return p.c[i].sign();
    }

    const polynomial* of_;
    big_int j_;
    int depth_;
    bool exact_;
};

/// The roots of a polynomial in [0, 1], ascending; of 0 there are none here.
class roots_in_unit_interval {
public:
    explicit roots_in_unit_interval(const polynomial& p) {
        if (p.degree() == 0) return;
        const polynomial common = common_divisor(p, derivative(p));
        simple_ = common.degree() == 0 ? p : pseudo_division(p, common).quotient;
        isolate(simple_, big_int(), 0);
        if (sign_at(simple_, big_int(1), 0) == 0) add(big_int(1), 0, true);
    }
    roots_in_unit_interval(const roots_in_unit_interval&) = delete;
    roots_in_unit_interval& operator=(const roots_in_unit_interval&) = delete;

    [[nodiscard]] auto begin() const { return cells_.begin(); }
    [[nodiscard]] auto end() const { return cells_.end(); }

private:
    static constexpr int least_depth = 48;

    void add(const big_int& j, int depth, bool is_exact) {
        const int more = depth < least_depth ? least_depth - depth : 0;
        cells_.emplace_back(&simple_, j << more, depth + more, is_exact);
    }

    /// The roots in [j, j + 1) / 2^depth, of which `p` is the view from there.
    void isolate(polynomial p, const big_int& j, int depth) {
        if (p.c.front().sign() == 0) {
            add(j, depth, true);
            p.c.erase(p.c.begin());
        }
        const int changes = descartes(p).changes;
        if (changes == 1) refine(p, j, depth);
        if (changes > 1) {
            isolate(left_half(p), j << 1, depth + 1);
            isolate(right_half(p), (j << 1) + big_int(1), depth + 1);
        }
    }

    /// The cell of the one root between 0 and 1 of a view, which is not 0 at 0.
    void refine(const polynomial& p, const big_int& j, int depth) {
        if (depth >= least_depth) return add(j, depth, false);
        const int at_0 = p.c.front().sign(), further = least_depth - depth;
        const std::int64_t end = std::int64_t{1} << further;
        const auto sign_from = [&](std::int64_t k) {  // just before 1 where it is 0 there
            const int s = sign_at(p, big_int(k), further);
            return s == 0 && k == end ? -at_0 : s;
        };
        std::int64_t low = where_it_seems(p, at_0, end);
        if (sign_from(low) == at_0 && sign_from(low + 1) == -at_0) return add((j << further) + big_int(low), least_depth, false);
        low = 0;
        for (std::int64_t step = end / 2; step > 0; step /= 2) {
            const int middle = sign_from(low + step);
            if (middle == 0) return add((j << further) + big_int(low + step), least_depth, true);
            if (middle == at_0) low += step;
        }
        add((j << further) + big_int(low), least_depth, false);
    }

    /// In which of so many parts of the interval the root seems to be, in floating point.
    static std::int64_t where_it_seems(const polynomial& p, int at_0, std::int64_t parts) {
        int most = 0;
        for (const big_int& x : p.c) most = std::max(most, x.bits());
        std::vector<double> c;
        for (const big_int& x : p.c) c.push_back(x.scaled(most));
        double low = 0, high = 1;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            double value = 0;
            for (std::size_t k = c.size(); k-- > 0;) value = value * middle + c[k];
            (at_0 * value > 0 ? low : high) = middle;
        }
        return std::min(static_cast<std::int64_t>(low * static_cast<double>(parts)), parts - 1);
    }

    polynomial simple_;
    std::vector<cell_of_root> cells_;
};

}  // namespace abut::detail
