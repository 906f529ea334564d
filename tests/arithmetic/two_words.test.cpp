// SPDX-License-Identifier: MIT
#include <abut/arithmetic/two_words.hpp>

#include <abut/arithmetic/wide_int.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"

#if ABUT_INT128

namespace {

using namespace abut;

template <class N>
std::uint64_t upper(const N& n) {
    return static_cast<std::uint64_t>(n >> 64);
}

/// Whether a number in two words is the compiler's.
template <bool Signed, class N>
bool same(const detail::two_words<Signed>& a, const N& b) {
    return static_cast<std::uint64_t>(a) == static_cast<std::uint64_t>(b) && upper(a) == upper(b);
}

/// Words of which many are next to 0, to the largest one, or to half of it.
std::uint64_t word(test::draws& d) {
    const auto low = static_cast<std::uint64_t>(d.below(1 << 30));
    const std::uint64_t any = low << 34 ^ static_cast<std::uint64_t>(d.below(1 << 30)) << 17 ^ low;
    const std::uint64_t near[] = {any, 0, ~std::uint64_t{0}, std::uint64_t{1} << 63, any >> d.below(64)};
    return near[d.below(5)] + static_cast<std::uint64_t>(d.below(3)) - 1;
}

template <bool Signed, class N>
std::uint64_t wrong_of(std::uint64_t seed) {
    using words = detail::two_words<Signed>;
    test::draws d(20261128, seed, 0);
    std::uint64_t wrong = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t p[] = {word(d), word(d), word(d), word(d)};
        const words a = words(p[0]) << 64 | words(p[1]), b = words(p[2]) << 64 | words(p[3]);
        const N x = static_cast<N>(static_cast<uint128>(p[0]) << 64 | p[1]),
                y = static_cast<N>(static_cast<uint128>(p[2]) << 64 | p[3]);
        const int bits = d.below(128);
        wrong += !same(a, x) || !same(b, y) || !same(a | b, x | y) || !same(a & b, x & y);
        wrong += !same(a >> bits, x >> bits);
        wrong +=
            (a == b) != (x == y) || (a < b) != (x < y) || (a > b) != (x > y) || (a <= b) != (x <= y) || (a >= b) != (x >= y);
        // The compiler's may not overflow where it has a sign.
        const auto u = static_cast<uint128>(x), v = static_cast<uint128>(y);
        wrong += !same(a + b, u + v) || !same(a - b, u - v) || !same(a * b, u * v) || !same(a << bits, u << bits);
        const auto n = static_cast<std::int64_t>(p[0]), m = static_cast<std::int64_t>(p[2]);
        wrong += !same(words(n), static_cast<N>(n)) || !same(words(n) * m, static_cast<uint128>(static_cast<int128>(n) * m));
        wrong += !same(detail::two_words<!Signed>(a), u);
    }
    return wrong;
}

}  // namespace

TEST_CASE("integers of 128 bits in two words are those of the compiler") {
    CHECK(wrong_of<false, uint128>(11) == 0);
    CHECK(wrong_of<true, int128>(12) == 0);
    static_assert(detail::two_words<true>(-3) * 5 < 0 &&
                  static_cast<std::uint64_t>(detail::two_words<false>(7) << 70 >> 69) == 14);
}

#endif
