// SPDX-License-Identifier: MIT
#include <abut/arithmetic/sparse_sum.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using test::integer;

/// Any finite numbers, or such as are few bits apart, where terms become one; half of the time such that the scalar product
/// of the first three and the last three cancels, exactly or but for little.
template <scalar T>
void draw(test::draws& d, T (&x)[6]) {
    namespace make = test::construction;
    const int bits_apart = d.below(80);
    const bool any = d.below(2) == 0;
    for (T& e : x) {
        e = any ? make::any_finite<T>(d)
                : static_cast<T>(d.uniform(-1, 1) * static_cast<double>(std::uint64_t{1} << d.below(bits_apart / 2 + 1)));
    }
    if (d.below(2) == 0) {
        x[3] = x[1];
        x[4] = -x[0];
        x[5] = d.below(2) == 0 ? T(0) : make::least_denormal<T>;
    }
}

template <class N>
vec3<N> three(const N& x) {
    return {x, x, x};
}

template <scalar T>
void check_signs() {
    test::draws d(test::sample_seed, 2, sizeof(T));
    std::uint64_t wrong = 0, zero = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        T x[6];
        draw(d, x);
        const aligned<6> a(x);
        sparse_sum<T, 1, 1> n[6];
        for (int k = 0; k < 6; ++k) {
            n[k] = sparse_number<T>(a, k);
        }
        const auto z = test::to_integers(std::vector<T>(x, x + 6));
        const auto sign_of = [](const integer& v) { return v.sign(); };

        // Degree 2: a sum of products; degree 6: squares of triple products of sums.
        const vec3<sparse_sum<T, 1, 1>> p{n[0], n[1], n[2]}, q{n[3], n[4], n[5]};
        const integer pq = z[0] * z[3] + z[1] * z[4] + z[2] * z[5];
        wrong += sign_of_dot(p, q) != sign_of(pq);
        const auto s = dot(cross(p, q), q - p);
        wrong += sign_of_dot(cross(p, q), q - p) != 0;  // always
        const auto u = (n[0] - n[3]) * (n[1] + n[4]) * n[2];
        const auto v = n[5] * n[4] * n[3];
        const integer iu = (z[0] - z[3]) * (z[1] + z[4]) * z[2], iv = z[5] * z[4] * z[3];
        wrong += squares_at_most(three(u), v) != (3 * iu * iu <= iv * iv);
        wrong += squares_at_most(v, three(v)) != true;
        wrong += squares_at_most(s, three(s)) != true;
        zero += pq == 0;
    }
    CHECK(wrong == 0);
    CHECK(zero > 0);
}

}  // namespace

TEST_CASE("sparse_sum: signs agree with unbounded integers over all exponents") {
    check_signs<float>();
    check_signs<double>();
}
