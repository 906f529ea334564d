// SPDX-License-Identifier: MIT
#include <abut/arithmetic/exact_stages.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/zero_area.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// The words of the integer stage: numbers become them without loss, and predicates of as many digits as are allowed do not
// overflow in them.

namespace {

using namespace abut;

/// Whether `short_integers` says the same as `aligned`, which takes numbers apart one by one.
template <scalar T, int V>
bool agree(const T (&value)[V]) {
    const aligned<V> parts(value);
    const detail::short_integers<V> whole(value);
    if (parts.width() > 59 || !whole.exact) return (parts.width() > 59) == !whole.exact;
    int unit = 1 << 20;  // of the integers, against that of `parts`: one power of two for all
    for (int i = 0; i < V; ++i) {
        if (parts.part[i].mantissa == 0) {
            if (whole.at[i] != 0) return false;
            continue;
        }
        const std::int64_t expected = parts.part[i].mantissa;
        if (whole.at[i] == 0 || (whole.at[i] < 0) != (expected < 0) || whole.at[i] % expected != 0) return false;
        const std::int64_t factor = whole.at[i] / expected;
        if ((factor & (factor - 1)) != 0) return false;
        const int exponent = parts.part[i].exponent - detail::lowest_bit(factor);
        if (unit != 1 << 20 && exponent != unit) return false;
        unit = exponent;
    }
    return true;
}

/// Numbers at the ends of what `digits` digits hold, 0, and some in between.
std::int64_t extreme(test::draws& d, int digits) {
    const std::int64_t most = (std::int64_t{1} << digits) - 1;
    const int kind = d.below(8);
    const std::int64_t x = kind < 4    ? most
                           : kind == 4 ? most - d.below(3)
                           : kind == 5 ? 0
                                       : static_cast<std::int64_t>(d.bits() >> 1) & most;
    return d.below(2) == 0 ? -x : x;
}

/// `holds` in numbers of a type N, which all have so many digits, against wide integers: how often they differ, and how
/// often it holds.
struct outcome {
    std::uint64_t differing = 0, holding = 0;
};
template <class Predicate, class N, int V>
outcome compare(int digits, std::uint64_t count) {
    test::draws d(test::sample_seed, 900 + static_cast<std::uint64_t>(digits), V);
    outcome sum;
    for (std::uint64_t k = 0; k < count; ++k) {
        std::int64_t whole[V];
        N number[V];
        wide_int<1> limb[V];
        for (std::int64_t& x : whole) x = extreme(d, digits);
        // Lengths, which come last, are not negative; and some points are one point, so that there are ties.
        for (int i = 3 * Predicate::points; i < V && Predicate::points > 0; ++i) whole[i] = std::abs(whole[i]);
        if (k % 4 == 0 && Predicate::points > 0) {
            for (int i = 0; i < 3; ++i) whole[i] = whole[i + 3];
        }
        for (int i = 0; i < V; ++i) {
            number[i] = static_cast<N>(whole[i]);
            limb[i] = wide_int<1>::shifted(whole[i], 0);
        }
        const bool truth = Predicate::holds(limb);
        sum.differing += Predicate::holds(number) != truth;
        sum.holding += truth;
    }
    return sum;
}

template <class Predicate, int V>
void check_words() {
    const std::uint64_t count = 4 * test::sample_count();
    const outcome o = compare<Predicate, std::int64_t, V>(detail::word_digits<Predicate>, count);
    CHECK(o.differing == 0);
    CHECK(o.holding * 100 > count);
    CHECK(o.holding * 100 < 99 * count);
}

}  // namespace

TEMPLATE_TEST_CASE("short_integers: the numbers, where they are integers of 59 digits of one unit", "", float, double) {
    using T = TestType;
    test::draws d(test::sample_seed, 901, sizeof(T));
    std::uint64_t wrong = 0, whole = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        T v[6];
        for (T& x : v) {
            x = test::construction::any_finite<T>(d);
            // All exponents; or few, so that some spans are short; or small integers, zeros and denormal numbers.
            if (k % 4 == 1) x = static_cast<T>(d.uniform(-1, 1));
            if (k % 4 == 2) x = static_cast<T>(std::ldexp(d.uniform(-1, 1), d.below(7)));
            if (k % 4 == 3) x = static_cast<T>(d.below(9) - 4) * (k % 8 == 3 ? T(1) : test::construction::least_denormal<T>);
        }
        wrong += !agree(v);
        whole += detail::short_integers<6>(v).exact;
    }
    CHECK(wrong == 0);
    CHECK(whole * 4 > test::sample_count());
    CHECK(whole * 8 < 7 * test::sample_count());
}

TEST_CASE("words do not overflow with as many digits as each predicate allows") {
    check_words<detail::triangle_meets_triangle, 18>();
    check_words<detail::box_meets_triangle, 15>();
    check_words<detail::box_meets_segment, 12>();
    check_words<detail::box_within_hull<2>, 14>();
    check_words<detail::box_within_hull<3>, 17>();
    check_words<detail::plane_meets_triangle, 14>();
    check_words<detail::plane_meets_corners<2, true>, 13>();
    check_words<detail::ball_meets_ball, 8>();
    check_words<detail::ball_meets_segment, 10>();
    check_words<detail::ball_meets_triangle, 13>();
    check_words<detail::capsule_meets_triangle, 16>();
    check_words<detail::corners_on_a_line, 9>();
}

TEST_CASE("triangles on a coarse grid: doubles round nothing") {
    const auto o = compare<detail::triangle_meets_triangle, double, 18>(detail::coarse_grid_bits, 20 * test::sample_count());
    CHECK(o.differing == 0);
}
