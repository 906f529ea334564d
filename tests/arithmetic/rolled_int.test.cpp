// SPDX-License-Identifier: MIT
#include <abut/arithmetic/rolled_int.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// Against Boost.Multiprecision.

namespace {

namespace rolled_int_cases {

using namespace abut;
using integer = boost::multiprecision::cpp_int;
using detail::rolled_int;

template <int Room>
integer value_of(const rolled_int<Room>& x) {
    integer r = 0;
    for (int i = x.count - 1; i >= 0; --i) r = (r << 64) + x.limb[i];
    return x.sign() < 0 ? integer(r - (integer(1) << (64 * x.count))) : r;
}

/// Of n limbs, with runs of zeros and of ones, which carries stumble over; `spare` leading bits repeat the sign.
template <int Room>
rolled_int<Room> draw(test::draws& d, int n, int spare) {
    rolled_int<Room> x;
    x.count = n;
    for (int i = 0; i < n; ++i) {
        const int kind = d.below(4);
        x.limb[i] = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : d.bits();
    }
    x.limb[n - 1] = static_cast<std::uint64_t>(static_cast<std::int64_t>(x.limb[n - 1]) >> spare);
    return x;
}

/// The double that is nearest to a / b, and of two the lesser, by a search among the bits of all.
double nearest_double(const integer& a, const integer& b) {
    const auto is_at_most = [&](std::uint64_t bits, bool twice) {  // a / b against a double, or the mean of it and the next
        const auto part = [](std::uint64_t w) {
            const std::uint64_t e = w >> 52, m = w & 0xfffffffffffff;
            return e == 0 ? integer(m) : integer(integer(m | std::uint64_t{1} << 52) << (e - 1));  // in units of 2^-1074
        };
        const integer sum = twice ? integer(part(bits) + part(bits + 1)) : integer(2 * part(bits));
        return integer(a << 1075) <= integer(sum * b);
    };
    std::uint64_t low = 0, high = 0x7fefffffffffffff;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (is_at_most(middle, true)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return __builtin_bit_cast(double, low);
}

}  // namespace rolled_int_cases

}  // namespace

TEST_CASE("rolled_int: sums, products and signs") {
    using namespace rolled_int_cases;
    test::draws d(test::sample_seed, 31, 0);
    std::uint64_t wrong = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        const int n = 1 + d.below(4), m = 1 + d.below(4);
        const auto a = draw<4>(d, n, 0);
        const auto b = draw<5>(d, m, 0);
        rolled_int<9> sum;
        sum.clear(2 * (n < m ? m : n) + 1);
        sum.add(a, b);
        integer truth = value_of(a) * value_of(b);
        wrong += value_of(sum) != truth;
        sum.add(b, a, true);
        wrong += sum.sign() != 0;
        sum.add(a);
        sum.add(b, true);
        truth = value_of(a) - value_of(b);
        wrong += value_of(sum) != truth || sum.sign() != truth.sign();
        sum.add(b, b, true);
        truth -= value_of(b) * value_of(b);
        wrong += value_of(sum) != truth || sum.sign() != truth.sign();
        const rolled_int<9> copy = sum;
        sum.drop_sign();
        wrong += value_of(sum) != abs(truth) || value_of(copy) != truth;
        sum = copy;
        wrong += sum.count != copy.count || value_of(sum) != truth;
    }
    CHECK(wrong == 0);
}

TEST_CASE("rolled_int: numbers of the input") {
    using namespace rolled_int_cases;
    test::draws d(test::sample_seed, 32, 0);
    std::uint64_t wrong = 0;
    for (int k = 0; k < 2000; ++k) {
        double values[3];
        for (double& x : values) x = std::ldexp(d.uniform(-1, 1), -d.below(300));
        values[k % 3] = k % 5 == 0 ? 0 : values[k % 3];
        const aligned<3> x(values);
        rolled_int<8> sum;
        sum.clear((x.width() + 2 + 63) / 64);
        sum.add(x, 0);
        sum.add(x, 1, true);
        const auto one = [&](int i) { return integer(integer(x.part[i].mantissa) << (x.part[i].mantissa == 0 ? 0 : x.part[i].exponent - x.low)); };
        wrong += value_of(sum) != one(0) - one(1);
    }
    CHECK(wrong == 0);
}

TEST_CASE("rolled_int: quotients are rounded once, and halves down") {
    using namespace rolled_int_cases;
    test::draws d(test::sample_seed, 33, 0);
    std::uint64_t wrong = 0, tiny = 0, huge = 0, halves = 0;
    const std::uint64_t count = test::sample_count();
    for (std::uint64_t k = 0; k < count; ++k) {
        auto a = draw<40>(d, k % 4 == 0 ? 40 : 3, 2), b = draw<40>(d, k % 4 == 0 ? 40 : 3, 2);
        if (k % 4 == 0) {
            // Of very different lengths: beyond the doubles, and among the subnormal ones.
            const int shorter = 3 + d.below(36);
            auto& one = k % 8 == 0 ? a : b;
            for (int i = shorter; i < 40; ++i) one.limb[i] = 0;
            if (d.below(4) == 0) {
                for (int i = 1; i < 40; ++i) a.limb[i] = 0, b.limb[i] = 0;
                a.limb[0] = std::uint64_t(1 + d.below(7));
                b.limb[0] = 4;
                detail::move_up(b.limb, 40, 1060 + d.below(20));
            }
        } else if (k % 4 == 1) {
            // Exactly between two doubles: an odd number of 54 bits over a power of two.
            a.clear(3);
            b.clear(3);
            a.limb[0] = (std::uint64_t{1} << 53) | (d.bits() >> 11) | 1;
            b.limb[0] = 1;
            detail::move_up(b.limb, 3, d.below(120));
            ++halves;
        }
        if (b.sign() == 0) b.limb[0] = 3;
        const integer x = abs(value_of(a)), y = abs(value_of(b));
        const double found = detail::rounded_quotient(a, b), truth = nearest_double(x, y);
        wrong += !(found == truth);
        tiny += truth < std::numeric_limits<double>::min();
        huge += truth == std::numeric_limits<double>::max();
    }
    CHECK(wrong == 0);
    CHECK(tiny * 50 > count);
    CHECK(huge * 50 > count);
    CHECK(halves * 5 > count);
}
