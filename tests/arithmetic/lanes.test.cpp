// SPDX-License-Identifier: MIT
#include <abut/arithmetic/lanes.hpp>

#include <cmath>
#include <cstring>
#include <limits>

#include "support/catch.hpp"

using namespace abut;
using detail::lanes;

// In registers of processors where the compiler has them, and in plain numbers: both are compiled here.
template <class T, class Register>
void check_lanes() {
    constexpr T far = std::numeric_limits<T>::infinity(), none = std::numeric_limits<T>::quiet_NaN(),
                huge = std::numeric_limits<T>::max(), tiny = std::numeric_limits<T>::denorm_min();
    const T values[] = {0, -T(0), 1, -1, T(0.1), huge, -huge, tiny, -tiny, far, -far, none};
    constexpr std::size_t n = std::size(values);
    using many = lanes<T, Register>;
    const auto is = [](const many& x, int k, T expected) {
        T all[4];
        static_assert(sizeof x.at == sizeof all);
        std::memcpy(all, x.at, sizeof all);
        return std::isnan(expected) ? std::isnan(all[k])
                                    : all[k] == expected && std::signbit(all[k]) == std::signbit(expected);
    };
    for (std::size_t first = 0; first < n; ++first) {
        for (const T y : values) {
            T x[4];
            for (std::size_t k = 0; k < 4; ++k) x[k] = values[(first + k) % n];
            CAPTURE(x[0], x[1], x[2], x[3], y);
            const many a = many::load(x), b = many::all(y);
            unsigned at_most = 0, larger = 0;
            bool same = true;
            for (int k = 0; k < 4; ++k) {
                at_most |= static_cast<unsigned>(x[k] <= y) << k;
                larger |= static_cast<unsigned>(x[k] > y) << k;
                same = same && is(b, k, y) && is(a + b, k, x[k] + y) && is(a - b, k, x[k] - y) && is(a * b, k, x[k] * y) &&
                       (x[k] == 0 || is(absolute(a), k, std::fabs(x[k])));
            }
            CHECK(same);
            const auto less = a <= b, more = a > b;
            const typename many::mask one[] = {less}, four[] = {less, more, less & more, !(less | more)};
            CHECK(detail::bits_of(one) == at_most);
            CHECK(detail::bits_of(four) == (at_most | larger << 4 | (0xfu & ~(at_most | larger)) << 12));
        }
    }
}

TEST_CASE("lanes: each computes what a number does") {
    check_lanes<float, typename detail::register_of<float>::type>();
    check_lanes<double, typename detail::register_of<double>::type>();
    check_lanes<float, float>();
    check_lanes<double, double>();
}

TEST_CASE("lowest bit") {
    for (unsigned k = 0; k < 32; ++k) {
        CHECK(detail::lowest_bit(1u << k) == k);
        CHECK(detail::lowest_bit(~0u << k) == k);
    }
}
