// SPDX-License-Identifier: MIT
#pragma once

// When two vertices lie in one place: by the bits of their coordinates, with one zero, since a processor may be told to take
// denormals for zero.

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

/// A coordinate's bits; those of 0.0 also for -0.0.
template <scalar T>
ABUT_HD constexpr auto place_word(T x) {
    using word = typename float_format<T>::word;
    const auto w = ABUT_BIT_CAST(word, x);
    return static_cast<word>(w << 1) == 0 ? word{0} : w;
}

/// Whether all coordinates are equal numbers; of NaN, equal bits.
template <scalar T>
ABUT_HD constexpr bool in_one_place(const vec3<T>& p, const vec3<T>& q) {
    return place_word(p.x) == place_word(q.x) && place_word(p.y) == place_word(q.y) && place_word(p.z) == place_word(q.z);
}

}  // namespace abut::detail
