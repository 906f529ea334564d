// SPDX-License-Identifier: MIT
#pragma once

// Four doubles at a time, each of whose operations is rounded, as those of one_double are (numbers.hpp): four triangles, or
// four nodes of a tree, of which each gets the bits that it gets alone. On a device four one after another.

#include <cmath>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/config.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut::detail::contact_math {

/// The register is a parameter as it is of lanes.
template <class Register>
struct four_rounded {
    using row = lanes<double, Register>;
    using mask = row::mask;
    row high;

    ABUT_INLINE ABUT_HD static four_rounded of(double x) { return {row::all(x)}; }
    ABUT_INLINE ABUT_HD static four_rounded load(const double* from) { return {row::load(from)}; }

#if ABUT_VECTORS
    ABUT_INLINE friend four_rounded operator+(const four_rounded& a, const four_rounded& b) { return {a.high + b.high}; }
    ABUT_INLINE friend four_rounded operator-(const four_rounded& a, const four_rounded& b) { return {a.high - b.high}; }
    ABUT_INLINE friend four_rounded operator*(const four_rounded& a, const four_rounded& b) {
        return {rounded(a.high * b.high)};
    }
#else
    ABUT_INLINE ABUT_HD friend four_rounded operator+(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.high.at[k] = plain_sum(a.high.at[k], b.high.at[k]);
        return a;
    }
    ABUT_INLINE ABUT_HD friend four_rounded operator-(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.high.at[k] = plain_sum(a.high.at[k], -b.high.at[k]);
        return a;
    }
    ABUT_INLINE ABUT_HD friend four_rounded operator*(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.high.at[k] = plain_product(a.high.at[k], b.high.at[k]);
        return a;
    }
#endif
    ABUT_INLINE ABUT_HD friend four_rounded operator/(const four_rounded& a, const four_rounded& b) { return {a.high / b.high}; }
    ABUT_INLINE ABUT_HD friend mask operator<(const four_rounded& a, const four_rounded& b) { return b.high > a.high; }
    ABUT_INLINE ABUT_HD friend mask operator<=(const four_rounded& a, const four_rounded& b) { return a.high <= b.high; }
    ABUT_INLINE ABUT_HD friend mask operator>(const four_rounded& a, const four_rounded& b) { return a.high > b.high; }
};
using four_doubles = four_rounded<typename register_of<double>::type>;

template <class R>
ABUT_INLINE ABUT_HD four_rounded<R> absolute(const four_rounded<R>& x) { return {abut::detail::absolute(x.high)}; }
/// The first where the answer is yes.
ABUT_INLINE ABUT_HD one_double select(bool answer, one_double yes, one_double no) { return answer ? yes : no; }
template <class R>
ABUT_INLINE ABUT_HD four_rounded<R> select(const typename four_rounded<R>::mask& answer, const four_rounded<R>& yes,
                                           const four_rounded<R>& no) {
    return {abut::detail::select(answer, yes.high, no.high)};
}
template <class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<R>> select(const typename four_rounded<R>::mask& answer, const vec3<four_rounded<R>>& yes,
                                                 const vec3<four_rounded<R>>& no) {
    return {select(answer, yes.x, no.x), select(answer, yes.y, no.y), select(answer, yes.z, no.z)};
}

/// As of other vectors (arithmetic/vec.hpp), and where they stand: calls would keep registers in memory.
///@{
template <class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<R>> operator-(const vec3<four_rounded<R>>& a, const vec3<four_rounded<R>>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
ABUT_INLINE ABUT_HD four_rounded<R> dot(const vec3<four_rounded<R>>& a, const vec3<four_rounded<R>>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<R>> cross(const vec3<four_rounded<R>>& a, const vec3<four_rounded<R>>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
///@}
/// Of what is not negative.
template <class R>
ABUT_INLINE ABUT_HD four_rounded<R> root(four_rounded<R> x) {
#if ABUT_VECTORS && defined(__SSE2__)
    for (auto& two : x.high.at) two = __builtin_ia32_sqrtpd(two);
#else
    double four[4];
    x.high.store(four);
    for (double& one : four) one = std::sqrt(one);
    x.high = four_rounded<R>::row::load(four);
#endif
    return x;
}

}  // namespace abut::detail::contact_math
