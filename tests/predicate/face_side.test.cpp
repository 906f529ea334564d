// SPDX-License-Identifier: MIT
#include <abut/predicate/face_side.hpp>

#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/rational.hpp"

namespace abut::test {

namespace {

/// The sign of the direction along the normal, in integers of any length, by the sum over all permutations.
template <class Line, scalar T>
int true_side(const Line& line, const triangle<T>& t) {
    const detail::line_of<T> l(line);
    const auto x = to_integers(std::vector<T>{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z, l.end.x,
                                              l.end.y, l.end.z, l.start.x, l.start.y, l.start.z});
    const auto less = [&](int i, int j, int k) {
        return integer(x[static_cast<std::size_t>(3 * i + k)] - x[static_cast<std::size_t>(3 * j + k)]);
    };
    integer sum = 0;
    const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int p = 0; p < 6; ++p) {
        const integer product = less(1, 0, order[p][0]) * less(2, 0, order[p][1]) * less(3, 4, order[p][2]);
        sum += p < 3 ? product : integer(-product);
    }
    return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

/// On a lattice, near a plane through it, or anywhere; of sizes from denormal numbers to the largest.
template <scalar T>
vec3<T> some_point(draws& d, int kind, double size) {
    const auto one = [&] {
        if (kind == 0) return static_cast<T>(size * d.below(4));
        if (kind == 1) return static_cast<T>(size * (d.below(3) + d.below(2) * 0x1p-22));
        return static_cast<T>(d.uniform(-size, size));
    };
    const T x = one(), y = one();
    return {x, y, one()};
}

}  // namespace

TEMPLATE_TEST_CASE("the side from which a triangle is met", "", float, double) {
    using T = TestType;
    const int most = std::same_as<T, float> ? 126 : 1000;
    int along[3] = {0, 0, 0};
    for (std::uint64_t i = 0; i < 60'000; ++i) {
        draws d(20261128, 1, i);
        const int kind = static_cast<int>(i % 3), exponents[] = {0, 0, 20, -20, most - 3, -most, most / 2};
        const double size = std::ldexp(1.0, exponents[i % 7]);
        const triangle<T> t{some_point<T>(d, kind, size), some_point<T>(d, kind, size), some_point<T>(d, kind, size)};
        const double other = i % 5 == 0 ? 1 : size;
        const ray<T> r{some_point<T>(d, kind, size), some_point<T>(d, kind, other)};
        const segment<T> s{some_point<T>(d, kind, other), some_point<T>(d, kind, size)};
        const int of_ray = true_side(r, t), of_segment = true_side(s, t);
        ++along[1 + of_ray];
        if (detail::side_of_face<filtered>(r, t) != of_ray || detail::side_of_face<exact>(r, t) != of_ray ||
            detail::side_of_face<filtered>(s, t) != of_segment || detail::side_of_face<exact>(s, t) != of_segment) {
            FAIL("case " << i);
        }
    }
    CHECK((along[0] > 10'000 && along[1] > 1'000 && along[2] > 10'000));
    CHECK(detail::side_of_face<fast>(ray<T>{{0, 0, 9}, {0, 0, -1}}, triangle<T>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) == -1);
}

}  // namespace abut::test
