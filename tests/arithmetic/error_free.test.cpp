// SPDX-License-Identifier: MIT
#include <abut/arithmetic/error_free.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/modes.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using test::integer;

/// Two numbers of which one matters to the other: near in exponent, cancelling, or far apart.
template <scalar T>
void draw(test::draws& d, T& a, T& b) {
    a = test::construction::any_finite<T>(d);
    b = test::construction::any_finite<T>(d);
    int e = 0;
    std::frexp(a, &e);
    constexpr int digits = std::numeric_limits<T>::digits;
    const int kind = d.below(4);
    if (kind == 0) b = std::ldexp(static_cast<T>(d.uniform(-1, 1)), e + d.below(2 * digits) - digits);
    if (kind == 1) b = -test::construction::stepped(a, d.below(5) - 2);
    if (kind == 2) {
        a = d.below(2) == 0 ? std::numeric_limits<T>::max() : -std::numeric_limits<T>::max();
        b = std::ldexp(static_cast<T>(d.uniform(-1, 1)), std::numeric_limits<T>::max_exponent - d.below(2 * digits));
    }
    if (!std::isfinite(b)) b = a;
}

template <scalar T>
int compare_sum(T a, T b, T r) {
    const auto z = test::to_integers(std::vector<T>{a, b, r});
    const integer sum = z[0] + z[1];
    return (sum > z[2]) - (sum < z[2]);
}

template <scalar T>
bool is_least_upper(T a, T b, T r) {
    constexpr T infinity = std::numeric_limits<T>::infinity(), largest = std::numeric_limits<T>::max();
    if (r == infinity) return compare_sum(a, b, largest) > 0;
    if (compare_sum(a, b, r) > 0) return false;
    return r == -largest || compare_sum(a, b, std::nextafter(r, -infinity)) > 0;
}

template <scalar T>
bool same_bits(T a, T b) {
    return a == b && std::signbit(a) == std::signbit(b);
}

}  // namespace

TEMPLATE_TEST_CASE("directed sums: the nearest representable number on the right side", "", float, double) {
    using T = TestType;
    test::draws d(test::sample_seed, 3, sizeof(T));
    std::uint64_t wrong = 0, exact_sums = 0, overflows = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        T a, b;
        draw(d, a, b);
        const T up = add_up(a, b), down = add_down(a, b);
        wrong += !is_least_upper(a, b, up) || !is_least_upper<T>(-a, -b, -down);
        exact_sums += up == down;
        overflows += std::isinf(up) || std::isinf(down);
    }
    CHECK(wrong == 0);
    CHECK(exact_sums > 0);
    CHECK(overflows > 0);
}

TEMPLATE_TEST_CASE("directed sums: the same bits in each floating-point mode", "", float, double) {
    using T = TestType;
    constexpr T normal = std::numeric_limits<T>::min(), tiny = std::numeric_limits<T>::denorm_min();
    constexpr int digits = std::numeric_limits<T>::digits;
    test::draws d(test::sample_seed, 5, sizeof(T));
    const auto near_zero = [&d] {
        const T steps = std::ldexp(T(d.below(9) - 4), d.below(digits + 2)) + T(d.below(5) - 2);
        return T(d.below(5) - 2) * normal + steps * tiny;
    };
    std::vector<std::array<T, 2>> pairs;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        T a, b;
        draw(d, a, b);
        pairs.push_back({a, b});
        const T x = near_zero();
        pairs.push_back({x, near_zero()});
        pairs.push_back({a, x});
    }
    const T edges[] = {0, T(-0.0), tiny, -tiny, normal - tiny, normal, normal + tiny, -normal, 1, -1};
    for (const T x : edges) {
        for (const T y : edges) pairs.push_back({x, y});
    }
    struct bounds {
        T up, down, next;
    };
    const auto compute = [&] {
        std::vector<bounds> r;
        for (const auto& [a, b] : pairs) {
            r.push_back({add_up(a, b), add_down(a, b), detail::next_up(a)});
        }
        return r;
    };
    const std::vector<bounds> expected = compute();
    std::uint64_t wrong = 0, denormal = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto [a, b] = pairs[i];
        wrong += !is_least_upper(a, b, expected[i].up) || !is_least_upper<T>(-a, -b, -expected[i].down);
        wrong += expected[i].next != std::nextafter(a, std::numeric_limits<T>::infinity());
        denormal += std::fpclassify(expected[i].up) == FP_SUBNORMAL;
    }
    CHECK(wrong == 0);
    CHECK(denormal > pairs.size() / 20);
    for (const test::floating_mode& mode : test::floating_modes()) {
        std::vector<bounds> found;
        test::in_mode(mode, [&] { found = compute(); });
        std::uint64_t differ = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const bounds &x = expected[i], &y = found[i];
            // The sign of an exact zero is the rounding mode's.
            differ += !(x.up == 0 ? y.up == 0 : same_bits(x.up, y.up)) || !same_bits(x.next, y.next);
            differ += !(x.down == 0 ? y.down == 0 : same_bits(x.down, y.down));
        }
        CAPTURE(mode.name);
        CHECK(differ == 0);
    }
}

TEMPLATE_TEST_CASE("directed sums: edges of the range", "", float, double) {
    using T = TestType;
    constexpr T infinity = std::numeric_limits<T>::infinity(), largest = std::numeric_limits<T>::max();
    constexpr T tiny = std::numeric_limits<T>::denorm_min(), ulp = std::numeric_limits<T>::epsilon();
    CHECK(add_up(largest, largest) == infinity);
    CHECK(add_down(largest, largest) == largest);
    CHECK(add_up(-largest, -largest) == -largest);
    CHECK(add_down(-largest, -largest) == -infinity);
    CHECK(add_down(largest, tiny) == largest);
    CHECK(add_up(largest, tiny) == infinity);
    CHECK(add_up(infinity, T(1)) == infinity);
    CHECK(add_down(-infinity, T(1)) == -infinity);
    CHECK(add_down(infinity, -largest) == infinity);
    CHECK(std::isnan(add_up(infinity, -infinity)));
    CHECK(std::isnan(add_down(std::numeric_limits<T>::quiet_NaN(), T(1))));
    CHECK(add_up(T(1), tiny) == 1 + ulp);
    CHECK(add_down(T(1), -tiny) == 1 - ulp / 2);
    CHECK(add_up(T(-1), tiny) == -1 + ulp / 2);
    CHECK(add_up(tiny, tiny) == 2 * tiny);
    CHECK(add_down(tiny, -2 * tiny) == -tiny);
    CHECK(same_bits(add_up(T(1), T(-1)), T(0)));
    CHECK(same_bits(add_down(T(1), T(-1)), T(0)));
    CHECK(same_bits(add_down(T(-0.0), T(-0.0)), T(-0.0)));
    CHECK(same_bits(add_down(T(3), T(-0.5)), T(2.5)));
}

TEMPLATE_TEST_CASE("errors of products without an fma are those of an fma, to the bit", "", float, double) {
    using T = TestType;
    constexpr int digits = std::numeric_limits<T>::digits, least = std::numeric_limits<T>::min_exponent - digits;
    test::draws d(test::sample_seed, 7, sizeof(T));
    std::uint64_t wrong = 0, denormal = 0, overflows = 0, errors = 0;
    for (std::uint64_t i = 0; i < 4 * test::sample_count(); ++i) {
        T a, b;
        draw(d, a, b);
        if (i % 2 == 0) {  // products near a power of two: at the end of the normal numbers, of the denormal ones, of all
            a = std::ldexp(static_cast<T>(d.uniform(-1, 1)), d.below(40) - 20);
            const int end = i % 4 == 0 ? least + d.below(2 * digits + 8) : std::numeric_limits<T>::max_exponent - d.below(4);
            b = std::ldexp(static_cast<T>(d.uniform(-1, 1)), end);
            if (i % 8 == 0) a = 1 - std::ldexp(T(1), -1 - d.below(digits)), b = std::ldexp(T(1), end);
        }
        const T p = detail::plain_product(a, b), expected = std::fma(a, b, -p);
        const T found = detail::product_error_without_fma(a, b, p);
        wrong += !same_bits(found, expected);
        denormal += std::fpclassify(p) == FP_SUBNORMAL;
        overflows += std::isinf(p);
        errors += found != 0;
    }
    CHECK(wrong == 0);
    CHECK(denormal > 0);
    CHECK(overflows > 0);
    CHECK(errors > test::sample_count());
}

TEMPLATE_TEST_CASE("two_sum, two_diff, two_prod: value and error make the exact result", "", float, double) {
    using T = TestType;
    test::draws d(test::sample_seed, 4, sizeof(T));
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        T a, b;
        draw(d, a, b);
        if (std::isfinite(a + b) && std::fabs(a) < std::numeric_limits<T>::max() / 2) {
            const error_free<T> s = two_sum(a, b);
            const auto z = test::to_integers(std::vector<T>{a, b, s.value, s.error});
            wrong += z[0] + z[1] != z[2] + z[3] || s.value != a + b;
        }
        const T x = static_cast<T>(d.uniform(-2, 2)), y = static_cast<T>(d.uniform(-2, 2));
        const error_free<T> p = two_prod(x, y), m = two_diff(x, y);
        const auto z = test::to_integers(std::vector<T>{x, y, p.value, p.error, m.value, m.error, T(1)});
        wrong += z[0] * z[1] != (z[2] + z[3]) * z[6] || z[0] - z[1] != z[4] + z[5];
    }
    CHECK(wrong == 0);
}

TEST_CASE("directed sums are constant expressions") {
    static_assert(add_up(1.0, 0x1p-60) == 1 + 0x1p-52 && add_down(1.0, 0x1p-60) == 1);
    static_assert(add_down(1.0f, -0x1p-60f) == 1 - 0x1p-24f && two_sum(1.0, 0x1p-60).error == 0x1p-60);
}
