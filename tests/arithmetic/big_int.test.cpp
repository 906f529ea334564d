// SPDX-License-Identifier: MIT
#include <abut/arithmetic/big_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/arithmetic/algebraic.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// Integers of any length and the roots of polynomials over them, against Boost.Multiprecision and roots that are known.

namespace abut::test {

namespace {

using detail::big_int;
using detail::cell_of_root;
using detail::polynomial;
using detail::roots_in_unit_interval;
using integer = boost::multiprecision::cpp_int;

/// A number in both; of up to 20 limbs, among them rows of zeros and of ones, so that carries run far.
struct both {
    integer truth;
    big_int made;
};

both draw(draws& d, int most_limbs) {
    both b;
    const int limbs = d.below(most_limbs + 1), kind = d.below(4);
    for (int i = 0; i < limbs; ++i) {
        std::uint64_t limb = d.bits();
        if (kind == 1) limb = d.below(4) == 0 ? limb : 0;
        if (kind == 2) limb = d.below(4) == 0 ? limb : ~std::uint64_t{0};
        if (kind == 3) limb = d.below(2) == 0 ? 0 : ~std::uint64_t{0};
        b.truth = (b.truth << 64) + limb;
        // In 32 bits at a time, which are signed numbers of 64.
        b.made = (b.made << 32) + big_int(static_cast<std::int64_t>(limb >> 32));
        b.made = (b.made << 32) + big_int(static_cast<std::int64_t>(limb & 0xffffffffu));
    }
    if (d.below(2) == 0) {
        b.truth = -b.truth;
        b.made = -b.made;
    }
    return b;
}

/// All bits and the sign, by what big_int tells of itself.
integer value_of(const big_int& x) {
    integer r = 0;
    const big_int magnitude = x.sign() < 0 ? -x : x;
    const int bits = x.bits();
    big_int rest = magnitude;
    for (int low = (bits + 31) / 32 * 32 - 32; low >= 0; low -= 32) {
        const std::int64_t word = rest.shifted_down(low);
        r = (r << 32) + word;
        rest = rest - (big_int(word) << low);
    }
    if (rest.sign() != 0) return -1;
    return x.sign() < 0 ? integer(-r) : r;
}

int bits_of(const integer& x) { return x == 0 ? 0 : static_cast<int>(msb(integer(abs(x)))) + 1; }

bool is_same(const big_int& x, const integer& truth) {
    return x.sign() == truth.sign() && x.bits() == bits_of(truth) && value_of(x) == truth;
}

}  // namespace

TEST_CASE("big integers: sums, products and shifts") {
    const std::uint64_t n = sample_count();
    std::array<std::uint64_t, 8> wrong{};
    for (std::uint64_t i = 0; i < n; ++i) {
        draws d(sample_seed, 90, i);
        both a = draw(d, 20), b = draw(d, 20);
        if (i % 8 == 0) b = {-a.truth, -a.made};
        if (i % 8 == 1) b = {a.truth + 1, a.made + big_int(1)};
        const int shift = d.below(700);
        wrong[0] += !is_same(a.made, a.truth);
        wrong[1] += !is_same(a.made + b.made, a.truth + b.truth);
        wrong[2] += !is_same(a.made - b.made, a.truth - b.truth);
        wrong[3] += !is_same(a.made * b.made, a.truth * b.truth);
        wrong[4] += !is_same(a.made << shift, a.truth << shift);
        wrong[5] += !is_same(-a.made, -a.truth) || !is_same(a.made - a.made, 0);
        const integer magnitude = abs(a.truth);
        const int cut = std::max(0, bits_of(magnitude) - 1 - d.below(62));
        wrong[6] +=
            (a.truth < 0 ? -a.made : a.made).shifted_down(cut) != static_cast<std::int64_t>(integer(magnitude >> cut));
        // A double that is near it, and not of another sign.
        const int by = bits_of(magnitude);
        const double exact =
            a.truth == 0 ? 0 : std::ldexp(static_cast<double>(integer((magnitude << 1300) >> (1300 + by - 60))), -60);
        wrong[7] +=
            std::abs(std::abs(a.made.scaled(by)) - exact) > 0x1p-51 * exact || a.made.scaled(by) * a.truth.sign() < 0;
    }
    CHECK(wrong == std::array<std::uint64_t, 8>{});
}

TEST_CASE("big integers: the values that a number is made of") {
    constexpr std::int64_t least = INT64_MIN, most = INT64_MAX;
    for (const std::int64_t x : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, least, least + 1, most}) {
        for (const int shift : {0, 1, 63, 64, 65, 640, 2100}) CHECK(is_same(big_int(x, shift), integer(x) << shift));
    }
}

TEST_CASE("big integers: copied and moved, short and long") {
    draws d(sample_seed, 91, 0);
    std::vector<both> kept;
    for (int i = 0; i < 40; ++i) kept.push_back(draw(d, 20));
    for (int i = 0; i < 20000; ++i) {
        both& a = kept[static_cast<std::size_t>(d.below(40))];
        both& b = kept[static_cast<std::size_t>(d.below(40))];
        switch (d.below(6)) {
            case 0:
                a = b;
                break;
            case 1:
                std::swap(a.truth, b.truth);
                std::swap(a.made, b.made);
                break;
            case 2: {
                both c = a;
                b = std::move(c);
                break;
            }
            case 3:
                a = draw(d, 20);
                break;
            case 4: {
                const both c = b;
                const both e(c);
                a.truth = e.truth - a.truth;
                a.made = e.made - a.made;
                break;
            }
            default: {
                both c = std::move(a);
                a = draw(d, 12);
                b = c;
            }
        }
        if (a.made.bits() > 2000) a = draw(d, 20);
        if (!is_same(a.made, a.truth) || !is_same(b.made, b.truth)) {
            FAIL("another number, in step " << i);
        }
    }
    for (const both& b : kept) CHECK(is_same(b.made, b.truth));
}

// --- roots
// -----------------------------------------------------------------------------------------------------------------

namespace {

/// A root n / 2^k, in [0, 1] or outside.
struct dyadic {
    std::int64_t n;
    int k;

    [[nodiscard]] bool inside() const { return n >= 0 && (k >= 63 || n <= std::int64_t{1} << k); }
    [[nodiscard]] bool less(const dyadic& r) const {
        const integer a = integer(n) << r.k, b = integer(r.n) << k;
        return a < b;
    }
    [[nodiscard]] bool same(const dyadic& r) const { return !less(r) && !r.less(*this); }
    [[nodiscard]] std::int64_t floor(int bits) const { return static_cast<std::int64_t>((integer(n) << bits) >> k); }
    /// 2^k x - n
    [[nodiscard]] polynomial factor() const { return polynomial(std::vector<big_int>{-big_int(n), big_int(1, k)}); }
};

polynomial number(std::int64_t n) { return polynomial(std::vector<big_int>{big_int(n)}); }

/// The roots of the product of their factors, each once, ascending, against what is found; and the sign of each factor
/// at each root.
void check_roots(std::vector<dyadic> roots, const polynomial& other) {
    polynomial p = other;
    for (const dyadic& r : roots) p = p * r.factor();
    std::vector<dyadic> expected;
    std::sort(roots.begin(), roots.end(), [](const dyadic& a, const dyadic& b) { return a.less(b); });
    for (const dyadic& r : roots) {
        if (r.inside() && (expected.empty() || !expected.back().same(r))) expected.push_back(r);
    }
    const roots_in_unit_interval found(p);
    REQUIRE(found.end() - found.begin() == static_cast<std::ptrdiff_t>(expected.size()));
    std::size_t k = 0;
    for (const cell_of_root& t : found) {
        const dyadic& r = expected[k++];
        CAPTURE(k, r.n, r.k);
        CHECK(t.floor(40) == r.floor(40));
        CHECK(t.floor(48) == r.floor(48));
        CHECK(t.sign_of(p) == 0);
        CHECK(t.sign_of(polynomial()) == 0);
        CHECK(t.sign_of(number(-3)) == -1);
        for (const dyadic& s : roots) {
            const int sign = s.less(r) ? 1 : r.less(s) ? -1 : 0;
            CHECK(t.sign_of(s.factor()) == sign);
            CHECK(t.sign_of(s.factor() * s.factor()) == sign * sign);
            CHECK(t.sign_of(s.factor() * number(-5)) == -sign);
            for (const dyadic& q : roots) {
                const int also = q.less(r) ? 1 : r.less(q) ? -1 : 0;
                CHECK(t.sign_of(s.factor() * q.factor()) == sign * also);
            }
        }
    }
}

}  // namespace

TEST_CASE("roots in the unit interval: known ones") {
    constexpr std::int64_t one = std::int64_t{1} << 62;
    const polynomial none = number(-7);
    check_roots({{0, 0}}, none);
    check_roots({{1, 0}}, none);
    check_roots({{0, 0}, {1, 0}}, none);
    check_roots({{0, 0}, {0, 0}, {1, 0}, {1, 0}}, none);
    check_roots({{1, 1}, {1, 1}}, none);
    check_roots({{1, 1}, {1, 1}, {1, 1}}, none);
    check_roots({{1, 1}, {1, 1}, {3, 3}}, none);
    check_roots({{-1, 0}, {2, 0}, {3, 3}}, none);
    check_roots({{-1, 62}, {one + 1, 62}}, none);
    check_roots({{0, 0}, {1, 62}, {1, 60}}, none);
    // Two and three that are closer than a cell is wide, with one on its border, and in neighbouring cells.
    check_roots({{one / 3, 62}, {one / 3 + 1, 62}}, none);
    check_roots({{one / 3, 62}, {one / 3 + 1, 62}, {one / 3 + 2, 62}}, none);
    check_roots({{1, 1}, {one / 2 + 1, 62}, {one / 2 - 1, 62}}, none);
    check_roots({{5, 48}, {(5 << 14) + 1, 62}, {(6 << 14) - 1, 62}}, none);
    check_roots({{5, 48}, {6, 48}, {7, 48}}, none);
    check_roots({{(5 << 14) + 1, 62}, {6, 48}}, none);
    check_roots({{one - 1, 62}, {1, 0}}, none);
    check_roots({{one - 2, 62}, {one - 1, 62}}, none);
    // Closer than 2^-62: 2^-100 and 2^-90 from each other.
    check_roots({{3, 100}, {4, 100}, {0, 0}}, none);
    check_roots({{1, 100}, {1, 90}, {one / 5, 62}}, none);
    // Pairs of complex ones beside them: x^2 + 1 over 2^-80, and one above the middle.
    const polynomial near_0(std::vector<big_int>{big_int(1), big_int(), big_int(1, 160)});
    const polynomial near_half = polynomial(std::vector<big_int>{big_int(-1), big_int(2)}) *
                                     polynomial(std::vector<big_int>{big_int(-1), big_int(2)}) * number(1LL << 60) +
                                 number(1);
    check_roots({}, near_0);
    check_roots({{0, 0}}, near_0);
    check_roots({{1, 90}}, near_0);
    check_roots({{1, 1}}, near_half);
    check_roots({{one / 2 + 1, 62}, {one / 2 - 1, 62}}, near_half);
    CHECK(roots_in_unit_interval(polynomial()).begin() == roots_in_unit_interval(polynomial()).end());
}

TEST_CASE("roots in the unit interval: close to others, drawn") {
    const std::uint64_t n = sample_count() / 25 + 1;
    for (std::uint64_t i = 0; i < n; ++i) {
        draws d(sample_seed, 92, i);
        CAPTURE(i);
        std::vector<dyadic> roots;
        const int k = d.below(3) == 0 ? 48 : d.below(62) + 1;
        const std::int64_t size = std::int64_t{1} << k;
        for (int r = 1 + d.below(3); r > 0; --r) {
            if (!roots.empty() && d.below(2) == 0) {
                roots.push_back({roots[0].n + d.below(5) - 2, k});
            } else {
                const std::int64_t at = static_cast<std::int64_t>(d.bits() >> 1) % (size + 1);
                roots.push_back({d.below(4) == 0 ? (d.below(2) == 0 ? 0 : size) : at, k});
            }
        }
        check_roots(roots, number(d.below(2) == 0 ? 1 : -3));
    }
}

TEST_CASE("roots in the unit interval: irrational ones") {
    // x^2 = m / 2^60: floor(2^40 x) is an integer square root.
    for (std::uint64_t i = 0; i < sample_count() / 5; ++i) {
        draws d(sample_seed, 93, i);
        const auto m = static_cast<std::int64_t>(d.bits() >> (4 + d.below(40)));
        const roots_in_unit_interval found(polynomial(std::vector<big_int>{-big_int(m), big_int(), big_int(1, 60)}));
        REQUIRE(found.end() - found.begin() == 1);
        const cell_of_root& t = *found.begin();
        const integer root = boost::multiprecision::sqrt(integer(m) << 20),
                      finer = boost::multiprecision::sqrt(integer(m) << 36);
        CHECK(t.floor(40) == static_cast<std::int64_t>(root));
        CHECK(t.floor(48) == static_cast<std::int64_t>(finer));
        // Against numbers 2^-70 beside it, and other polynomials with it.
        const integer close = boost::multiprecision::sqrt(integer(m) << 80);
        const bool is_exact = close * close == integer(m) << 80;
        const auto at = [](const integer& c) {  // 2^70 x - c
            const auto upper = static_cast<std::int64_t>(integer(c >> 35)),
                       lower = static_cast<std::int64_t>(integer(c - ((c >> 35) << 35)));
            return polynomial(std::vector<big_int>{-(big_int(upper, 35) + big_int(lower)), big_int(1, 70)});
        };
        CHECK(t.sign_of(at(close)) == (is_exact ? 0 : 1));
        CHECK(t.sign_of(at(close + 1)) == -1);
        const polynomial square(std::vector<big_int>{-big_int(m), big_int(), big_int(1, 60)});
        CHECK(t.sign_of(square * at(3)) == 0);
        CHECK(t.sign_of(square * at(3) + number(1)) == 1);
        CHECK(t.sign_of(square * square - number(1)) == -1);
    }
}

}  // namespace abut::test
