// SPDX-License-Identifier: MIT
#include <abut/predicate/exact_revolution_within.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// Whether a quartic that is positive at both ends has a root above 0, as an edge that meets a torus does. The oracle is Sturm's
// chain of remainders in rationals, which knows no closed form of them, and no place to split at.

namespace {

using namespace abut;
using rational = boost::multiprecision::cpp_rational;
using polynomial = std::vector<rational>;  // the constant first

void trim(polynomial& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}
polynomial minus_remainder(polynomial p, const polynomial& q) {
    while (p.size() >= q.size()) {
        const rational factor = p.back() / q.back();
        for (std::size_t i = 0; i < q.size(); ++i) p[p.size() - q.size() + i] -= factor * q[i];
        p.pop_back();
    }
    trim(p);
    for (rational& x : p) x = -x;
    return p;
}
int changes(const std::vector<int>& signs) {
    int found = 0, last = 0;
    for (const int s : signs) {
        if (s == 0) continue;
        found += last != 0 && s != last;
        last = s;
    }
    return found;
}
bool has_root(const polynomial& p) {
    polynomial derivative;
    for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(p[i] * static_cast<int>(i));
    std::vector<polynomial> chain{p, derivative};
    while (!chain.back().empty()) {
        const polynomial next = minus_remainder(chain[chain.size() - 2], chain.back());
        chain.push_back(next);
    }
    chain.pop_back();
    std::vector<int> at_0, far_off;
    for (const polynomial& q : chain) {
        at_0.push_back(q.front().sign());
        far_off.push_back(q.back().sign());
    }
    return changes(at_0) > changes(far_off);
}

/// a x^4 + 4b x^3 + 2c x^2 + 4d x + e, in an arena.
struct asked {
    static constexpr int most_limbs = 580;
    ABUT_HD static constexpr bool holds(const detail::arena_int (&value)[5]) {
        const auto wide = [&](int i) {  // as long as numbers of degree 6 are
            detail::arena_sum x(*value[i].in, 6 * value[i].count);
            x.add(value[i]);
            return detail::arena_int(x);
        };
        return detail::quartic{wide(0), wide(1), wide(2), wide(3), wide(4)}.has_root();
    }
};

/// (x - r)^2 or (x^2 - 2 r x + s), times another one, so that double roots, and such as are nearly double, are frequent.
polynomial times(const polynomial& p, const polynomial& q) {
    polynomial product(p.size() + q.size() - 1);
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = 0; j < q.size(); ++j) product[i + j] += p[i] * q[j];
    }
    return product;
}

}  // namespace

TEST_CASE("quartic of a torus: it has a root above 0 where Sturm's chain says so") {
    std::uint64_t roots = 0, all = 0, splits = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        test::draws d(test::sample_seed, 41, k);
        const auto whole = [&](int n) { return static_cast<double>(d.below(2 * n + 1) - n); };
        std::array<double, 5> c{};  // a, b, c, d, e
        if (k % 3 == 0) {
            c = {1 + 0.5 * d.below(8), whole(8), whole(24), whole(8), 1 + 0.5 * d.below(8)};
        } else if (k % 3 == 1) {
            const auto part = [&] {
                const double r = whole(6), off = d.below(3) - 1.0;
                return polynomial{rational(r * r + off), rational(-2 * r), rational(1)};
            };
            const polynomial p = times(part(), part());
            c = {4 * static_cast<double>(p[4]), static_cast<double>(p[3]), 2 * static_cast<double>(p[2]),
                 static_cast<double>(p[1]), 4 * static_cast<double>(p[0])};
        } else {
            const auto far = [&] { return std::ldexp(1 + d.uniform(0, 1), d.below(801) - 400); };
            const auto sign = [&] { return d.below(3) == 0 ? 1.0 : -1.0; };
            c = {far(), sign() * far(), sign() * far(), sign() * far(), far()};
        }
        if (!(c[0] > 0 && c[4] > 0)) continue;
        // At another scale of x.
        if (k % 2 == 0) {
            const int s = d.below(61) - 30;
            for (int i = 0; i < 5; ++i) c[static_cast<std::size_t>(i)] = std::ldexp(c[static_cast<std::size_t>(i)], s * i);
        }
        const double value[5] = {c[0], c[1], c[2], c[3], c[4]};
        const bool found = detail::decide_in_arena<asked>(value);
        const verdict shortly = detail::decide_in_short_arena<asked>(value);
        const bool truth = has_root({rational(c[4]), 4 * rational(c[3]), 2 * rational(c[2]), 4 * rational(c[1]), rational(c[0])});
        ++all;
        roots += truth;
        splits += c[1] < 0 || c[2] < 0 || c[3] < 0;
        INFO(k << ": " << c[0] << " " << c[1] << " " << c[2] << " " << c[3] << " " << c[4]);
        CHECK(found == truth);
        CHECK(shortly != to_verdict(!truth));
    }
    std::printf("quartics: %llu, %llu have a root, %llu a negative coefficient\n", static_cast<unsigned long long>(all),
                static_cast<unsigned long long>(roots), static_cast<unsigned long long>(splits));
    CHECK(roots * 5 > all);
    CHECK(roots * 5 < all * 4);
}
