// SPDX-License-Identifier: MIT
#pragma once

// Polynomials in one variable with integer coefficients, and their roots in [0, 1] as exact numbers: a root is a square-free
// polynomial and a dyadic interval that holds no other root of it. Roots are counted by Sturm's theorem; the sign of another
// polynomial at a root is decided by bounds on the interval, and where these never decide, by the greatest common divisor.
// Nothing is rounded, whatever the coefficients are. For oracles: what is simple comes before what is fast.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "rational.hpp"

namespace abut::test {

inline int sign_of(const integer& x) { return x.sign(); }

/// The coefficient of x^i is c[i]; the last is not 0, and the polynomial 0 has none.
struct polynomial {
    std::vector<integer> c;

    polynomial() = default;
    explicit polynomial(std::vector<integer> coefficients) : c(std::move(coefficients)) { trim(); }

    [[nodiscard]] bool is_zero() const { return c.empty(); }
    [[nodiscard]] std::size_t degree() const { return c.empty() ? 0 : c.size() - 1; }

    void trim() {
        while (!c.empty() && c.back() == 0) c.pop_back();
    }

    friend polynomial operator+(const polynomial& p, const polynomial& q) { return combined(p, q, false); }
    friend polynomial operator-(const polynomial& p, const polynomial& q) { return combined(p, q, true); }
    friend polynomial operator-(const polynomial& p) { return polynomial() - p; }

    friend polynomial operator*(const polynomial& p, const polynomial& q) {
        polynomial r;
        if (p.is_zero() || q.is_zero()) return r;
        r.c.resize(p.c.size() + q.c.size() - 1);
        for (std::size_t i = 0; i < p.c.size(); ++i) {
            for (std::size_t j = 0; j < q.c.size(); ++j) r.c[i + j] += p.c[i] * q.c[j];
        }
        return r;
    }

private:
    static polynomial combined(const polynomial& p, const polynomial& q, bool minus) {
        polynomial r;
        r.c.resize(std::max(p.c.size(), q.c.size()));
        for (std::size_t i = 0; i < p.c.size(); ++i) r.c[i] = p.c[i];
        for (std::size_t i = 0; i < q.c.size(); ++i) {
            if (minus) {
                r.c[i] -= q.c[i];
            } else {
                r.c[i] += q.c[i];
            }
        }
        r.trim();
        return r;
    }
};

/// Divided by a positive number that divides all coefficients: the greatest one, or of large numbers, for which this would
/// take long, the greatest power of two.
inline polynomial reduced(polynomial p) {
    unsigned zeros = ~0u, bits = 0;
    for (const integer& x : p.c) {
        if (x == 0) continue;
        const integer magnitude = abs(x);
        zeros = std::min(zeros, static_cast<unsigned>(lsb(magnitude)));
        bits = std::max(bits, static_cast<unsigned>(msb(magnitude)));
    }
    if (bits > 2000) {
        for (integer& x : p.c) x = x < 0 ? integer(-(abs(x) >> zeros)) : integer(x >> zeros);
        return p;
    }
    integer content = 0;
    for (const integer& x : p.c) {
        content = gcd(content, x);
        if (content == 1) return p;
    }
    if (content > 1) {
        for (integer& x : p.c) x /= content;
    }
    return p;
}

inline polynomial derivative(const polynomial& p) {
    polynomial r;
    for (std::size_t i = 1; i < p.c.size(); ++i) r.c.push_back(p.c[i] * static_cast<unsigned>(i));
    return r;
}

struct division {
    polynomial quotient, remainder;
};

/// k p = quotient * q + remainder with a remainder of lower degree than q, which is not 0, for some integer k > 0.
inline division divided(const polynomial& p, const polynomial& q) {
    division r{{}, p};
    const integer lead = abs(q.c.back());
    const bool negative = q.c.back() < 0;
    while (r.remainder.c.size() >= q.c.size()) {
        const std::size_t shift = r.remainder.c.size() - q.c.size();
        const integer top = negative ? integer(-r.remainder.c.back()) : r.remainder.c.back();
        for (integer& x : r.quotient.c) x *= lead;
        for (integer& x : r.remainder.c) x *= lead;
        if (r.quotient.c.size() <= shift) r.quotient.c.resize(shift + 1);
        r.quotient.c[shift] += top;
        for (std::size_t i = 0; i < q.c.size(); ++i) r.remainder.c[i + shift] -= top * q.c[i];
        r.remainder.trim();
    }
    return r;
}

/// Whether two polynomials prove to have no common root, complex ones included: modulo a prime that divides no leading
/// coefficient, a common divisor keeps its degree. If they have none there, they have none. That is quick; the other answer
/// means nothing.
inline bool surely_coprime(const polynomial& p, const polynomial& q) {
    constexpr std::uint64_t prime = (std::uint64_t{1} << 31) - 1;
    std::vector<std::uint64_t> r[2];
    for (int i = 0; i < 2; ++i) {
        for (const integer& x : (i == 0 ? p : q).c) {
            const auto rest = static_cast<std::int64_t>(integer(x % prime));
            r[i].push_back(rest < 0 ? static_cast<std::uint64_t>(rest + static_cast<std::int64_t>(prime))
                                    : static_cast<std::uint64_t>(rest));
        }
        if (r[i].empty() || r[i].back() == 0) return false;
    }
    while (!r[1].empty()) {
        if (r[0].size() < r[1].size()) std::swap(r[0], r[1]);
        // r0 times the leading coefficient of r1, less a multiple of r1
        const std::uint64_t top = r[0].back(), lead = r[1].back();
        const std::size_t shift = r[0].size() - r[1].size();
        for (std::uint64_t& x : r[0]) x = x * lead % prime;
        for (std::size_t i = 0; i < r[1].size(); ++i) {
            std::uint64_t& x = r[0][i + shift];
            x = (x + prime - top * r[1][i] % prime) % prime;
        }
        while (!r[0].empty() && r[0].back() == 0) r[0].pop_back();
        std::swap(r[0], r[1]);
    }
    return r[0].size() == 1;
}

/// Of two polynomials that are not both 0; times some number.
inline polynomial greatest_common_divisor(polynomial p, polynomial q) {
    if (surely_coprime(p, q)) return polynomial({1});
    while (!q.is_zero()) {
        polynomial r = reduced(divided(p, q).remainder);
        p = std::move(q);
        q = std::move(r);
    }
    return reduced(std::move(p));
}

/// The same roots, each once. p is not 0.
inline polynomial square_free(const polynomial& p) {
    const polynomial repeated = greatest_common_divisor(p, derivative(p));
    return reduced(repeated.degree() == 0 ? p : divided(p, repeated).quotient);
}

/// The sign of p at n / 2^k.
inline int sign_at(const polynomial& p, const integer& n, unsigned k) {
    if (p.is_zero()) return 0;
    integer value = p.c.back();
    unsigned shift = 0;
    for (std::size_t i = p.c.size() - 1; i-- > 0;) {
        shift += k;
        value = value * n + (p.c[i] << shift);
    }
    return sign_of(value);
}

/// The sign of p everywhere between n / 2^k and (n + 1) / 2^k, these excluded, if all coefficients of p in Bernstein's basis
/// there agree on it; 0 if they do not, or p is 0.
inline int sign_between(const polynomial& p, const integer& n, unsigned k) {
    // q(x) = 2^(k d) p((n + x) / 2^k), by repeated synthetic division
    std::vector<integer> q = p.c;
    const std::size_t size = q.size();
    for (std::size_t i = 0; i < size; ++i) q[i] <<= k * static_cast<unsigned>(size - 1 - i);
    for (std::size_t i = 0; i + 1 < size; ++i) {
        for (std::size_t j = size - 1; j-- > i;) q[j] += n * q[j + 1];
    }
    // d! times the j-th coefficient is the sum over i <= j of j! / (j - i)! (d - i)! q_i.
    int sign = 0;
    for (std::size_t j = 0; j < size; ++j) {
        integer sum = 0;
        for (std::size_t i = 0; i <= j; ++i) {
            std::uint64_t factor = 1;
            for (std::size_t m = j - i + 1; m <= j; ++m) factor *= m;
            for (std::size_t m = 2; m + i < size; ++m) factor *= m;
            sum += q[i] * factor;
        }
        const int s = sign_of(sum);
        if (s * sign < 0) return 0;
        if (s != 0) sign = s;
    }
    return sign;
}

/// n / 2^k, for n >= 0, as the nearest double; of two, the one with the even last bit.
inline double to_double(const integer& n, unsigned k) {
    if (n == 0) return 0;
    const int top = static_cast<int>(msb(n)) - static_cast<int>(k);
    const int unit = std::max(top - 52, -1074), cut = unit + static_cast<int>(k);
    if (cut <= 0) return std::ldexp(static_cast<double>(static_cast<std::uint64_t>(n)), -static_cast<int>(k));
    const integer whole = n >> static_cast<unsigned>(cut), rest = n - (whole << static_cast<unsigned>(cut));
    const integer half = integer(1) << static_cast<unsigned>(cut - 1);
    auto m = static_cast<std::uint64_t>(whole);
    if (rest > half || (rest == half && m % 2 == 1)) ++m;
    return std::ldexp(static_cast<double>(m), unit);
}

/// A number in [0, 1]: n / 2^k, or the only root of `p` between n / 2^k and (n + 1) / 2^k, neither of which is a root.
class algebraic_number {
public:
    static constexpr unsigned leaps_from = 32;  // intervals that begin at 0 and are of length 2^-32

    /// n / 2^k
    algebraic_number(integer n, unsigned k) : n_(std::move(n)), k_(k), exact_(true) {}

    algebraic_number(polynomial p, integer n, unsigned k)
        : p_(std::move(p)), n_(std::move(n)), k_(k), exact_(false), left_(sign_at(p_, n_, k_)) {}

    /// The sign of q at this number.
    int sign(const polynomial& q) {
        if (q.is_zero()) return 0;
        bool divisor_known = false;
        for (;;) {
            if (exact_) return sign_at(q, n_, k_);
            if (const int s = sign_between(q, n_, k_)) return s;
            if (k_ >= 40 && !divisor_known) {
                divisor_known = true;
                polynomial g = greatest_common_divisor(p_, q);
                const int s = sign_at(g, n_, k_);  // not 0: g divides p
                if (s * sign_at(g, n_ + 1, k_) < 0) {
                    p_ = std::move(g);
                    left_ = s;
                    return 0;
                }
            }
            refine();
        }
    }

    /// floor(2^bits x)
    integer floor_times(unsigned bits) {
        while (!exact_ && k_ < bits) refine();
        return k_ <= bits ? integer(n_ << (bits - k_)) : integer(n_ >> (k_ - bits));
    }

    /// The nearest double. Ends: where the number is half way between two doubles, some step of `refine` hits it.
    double nearest_double() {
        while (!exact_ && k_ < 56) refine();
        for (;;) {
            const double low = to_double(n_, k_);
            if (exact_ || low == to_double(n_ + 1, k_)) return low;
            refine();
        }
    }

    /// The sign of this number less n / 2^k.
    [[nodiscard]] int compared_to(const integer& n, unsigned k) const {
        const integer low = n_ << k, at = n << k_;
        if (exact_) return sign_of(integer(low - at));
        if (at <= low) return 1;
        if (at >= low + (integer(1) << k)) return -1;
        const int s = sign_at(p_, n, k);
        return s == 0 ? 0 : s == left_ ? 1 : -1;
    }

    /// The sign of this number less x, which is finite.
    [[nodiscard]] int compared_to(double x) const {
        if (x < 0) return 1;
        if (x > 1) return -1;
        int e = 0;
        const double m = std::ldexp(std::frexp(x, &e), 53);  // x = m 2^(e - 53), and e <= 1
        return compared_to(integer(static_cast<std::uint64_t>(m)), static_cast<unsigned>(53 - e));
    }

    /// The sign of this number less another.
    int compared_to(algebraic_number& other) {
        bool divisor_known = false;
        for (;;) {
            if (other.exact_) return compared_to(other.n_, other.k_);
            if (exact_) return -other.compared_to(n_, k_);
            const integer low = n_ << other.k_, other_low = other.n_ << k_;
            if (low + (integer(1) << other.k_) <= other_low) return -1;
            if (other_low + (integer(1) << k_) <= low) return 1;
            // One interval holds the other. Where both numbers are roots of g, each is the only one in its interval.
            if (k_ >= 40 && other.k_ >= 40 && !divisor_known) {
                divisor_known = true;
                const polynomial g = greatest_common_divisor(p_, other.p_);
                const algebraic_number& finer = k_ > other.k_ ? *this : other;
                if (sign_at(g, finer.n_, finer.k_) * sign_at(g, finer.n_ + 1, finer.k_) < 0) return 0;
            }
            (k_ < other.k_ ? *this : other).refine();
        }
    }

private:
    /// Halves the interval, or better: a number close to 0 is brought to its power of two in leaps.
    void refine() {
        if (n_ == 0 && k_ >= leaps_from) {
            for (unsigned leap = 1; sign_at(p_, 1, k_ + leap) == -left_; leap *= 2) k_ += leap;
        }
        n_ <<= 1;
        ++k_;
        ++n_;
        const int s = sign_at(p_, n_, k_);
        if (s == 0) {
            exact_ = true;
        } else if (s != left_) {
            --n_;
        }
    }

    polynomial p_;  // square-free
    integer n_;
    unsigned k_;
    bool exact_;
    int left_ = 0;  // the sign of p at n / 2^k
};

/// The distinct real roots of a polynomial that is not 0, between 0 and 1, these included, in ascending order.
class root_finder {
public:
    explicit root_finder(const polynomial& p) : chain_{square_free(p)} {
        chain_.push_back(derivative(chain_[0]));
        while (!chain_.back().is_zero()) {
            chain_.push_back(reduced(-divided(chain_[chain_.size() - 2], chain_.back()).remainder));
        }
        chain_.pop_back();
    }

    /// Calls `visit(algebraic_number)` for each root until it returns true. Whether it did.
    template <class Visit>
    bool visit_roots(Visit visit) const {
        if (p().degree() == 0) return false;
        if (sign_at(p(), 0, 0) == 0 && visit(algebraic_number(0, 0))) return true;
        const int last = sign_at(p(), 1, 0);
        if (visit_between(0, 0, variations(0, 0), variations(1, 0), sign_at(p(), 0, 0), last, visit)) return true;
        return last == 0 && visit(algebraic_number(1, 0));
    }

private:
    [[nodiscard]] const polynomial& p() const { return chain_[0]; }

    /// Changes of sign along the chain at n / 2^k. Between a and b > a it drops by the number of roots in (a, b].
    [[nodiscard]] int variations(const integer& n, unsigned k) const {
        int count = 0, last = 0;
        for (const polynomial& f : chain_) {
            const int s = sign_at(f, n, k);
            if (s == 0) continue;
            if (s * last < 0) ++count;
            last = s;
        }
        return count;
    }

    template <class Visit>
    bool visit_between(const integer& n, unsigned k, int at_low, int at_high, int low, int high, Visit& visit) const {
        const int count = at_low - at_high - (high == 0 ? 1 : 0);
        if (count == 0) return false;
        if (n == 0 && k >= algebraic_number::leaps_from) {
            for (unsigned leap = 1;; leap *= 2) {  // while all roots are below 2^-(k + leap)
                const int at_next = variations(1, k + leap), next = sign_at(p(), 1, k + leap);
                if (at_low - at_next != count || next == 0) break;
                k += leap;
                at_high = at_next;
                high = next;
            }
        }
        if (count == 1 && low != 0 && high != 0) return visit(algebraic_number(p(), n, k));
        const integer middle = 2 * n + 1;
        const int at_middle = variations(middle, k + 1), s = sign_at(p(), middle, k + 1);
        if (visit_between(2 * n, k + 1, at_low, at_middle, low, s, visit)) return true;
        if (s == 0 && visit(algebraic_number(middle, k + 1))) return true;
        return visit_between(middle, k + 1, at_middle, at_high, s, high, visit);
    }

    std::vector<polynomial> chain_;  // Sturm's: the polynomial made square-free, its derivative, and negated remainders
};

}  // namespace abut::test
