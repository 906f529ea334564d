// SPDX-License-Identifier: MIT
#include <abut/arithmetic/wide_int.hpp>

#include <cstdio>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using integer = boost::multiprecision::cpp_int;

template <int N>
integer value_of(const wide_int<N>& x) {
    integer r = 0;
    for (int i = N - 1; i >= 0; --i) r = (r << 64) + x.limb[i];
    return x.negative() ? integer(r - (integer(1) << (64 * N))) : r;
}

/// Any bits, with runs of zeros and ones, which carries and borrows stumble over; `spare` leading bits repeat the sign.
template <int N>
wide_int<N> random_wide(test::draws& d, int spare) {
    wide_int<N> x{};
    for (std::uint64_t& limb : x.limb) {
        const int kind = d.below(4);
        limb = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : d.bits();
    }
    auto& top = x.limb[N - 1];
    top = static_cast<std::uint64_t>(static_cast<std::int64_t>(top) >> spare);
    return x;
}

template <int N, int M>
void check_against_integers() {
    test::draws d(test::sample_seed, static_cast<std::uint64_t>(100 * N + M), 0);
    const std::uint64_t count = test::sample_count();
    std::printf("wide_int<%d> and <%d>: %llu pairs, seed %llu\n", N, M, static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(test::sample_seed));
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto a = random_wide<N>(d, 2), b = random_wide<N>(d, 2);
        const auto c = random_wide<M>(d, 0);
        const integer x = value_of(a), y = value_of(b), z = value_of(c);
        wrong += value_of(a + b) != x + y || value_of(a - b) != x - y || value_of(-a) != -x;
        wrong += value_of(a * c) != x * z || value_of(c * a) != x * z;
        wrong += sign(a) != (x > 0) - (x < 0) || sign(a - b) != (x > y) - (x < y) || (a == b) != (x == y);
        wrong += squares_at_most(a, b) != (x * x <= y * y);
    }
    CHECK(wrong == 0);
}

template <int N>
void check_shifted() {
    test::draws d(test::sample_seed, 7, N);
    for (int shift = 0; shift < 64 * N; ++shift) {
        // The largest magnitude that fits beside the shift, a one, and a random number between, of either sign.
        const int room = 64 * N - 1 - shift < 62 ? 64 * N - 1 - shift : 62;
        const auto all = static_cast<std::int64_t>((std::uint64_t{1} << room) - 1);
        const auto some = static_cast<std::int64_t>(d.bits() >> 2) & all;
        for (const std::int64_t v : {all, -all, some, -some, std::int64_t{0}}) {
            CHECK(value_of(wide_int<N>::shifted(v, shift)) == integer(v) * (integer(1) << shift));
        }
    }
}

// Usable in constant expressions.
static_assert(sign(wide_int<2>::shifted(-3, 70) * wide_int<1>::shifted(5, 0)) == -1);
static_assert(wide_int<1>::shifted(-6, 1) * wide_int<1>::shifted(7, 0) == wide_int<2>::shifted(-84, 0));

}  // namespace

TEST_CASE("wide_int: arithmetic agrees with unbounded integers") {
    check_against_integers<1, 1>();
    check_against_integers<1, 2>();
    check_against_integers<2, 1>();
    check_against_integers<2, 2>();
    check_against_integers<3, 3>();
    check_against_integers<4, 2>();
    check_against_integers<6, 6>();
}

TEST_CASE("wide_int: shifted is value * 2^shift wherever that fits") {
    check_shifted<1>();
    check_shifted<2>();
    check_shifted<5>();
}
