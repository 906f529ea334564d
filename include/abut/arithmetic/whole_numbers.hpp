// SPDX-License-Identifier: MIT
#pragma once

// Finite numbers as integers of one unit, a power of two that divides all of them: for the last word on hosts, in integers of
// any length.

#include <algorithm>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/big_int.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

// Of vectors of such integers: those of arithmetic/vec.hpp are for devices too, where these are not.

inline vec3<big_int> operator-(const vec3<big_int>& a, const vec3<big_int>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline big_int dot(const vec3<big_int>& a, const vec3<big_int>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline vec3<big_int> cross(const vec3<big_int>& a, const vec3<big_int>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A unit of all numbers that were looked at.
template <scalar T>
class whole_numbers {
public:
    void look_at(T x) {
        if (!is_zero(x)) exponent_ = std::min(exponent_, take_apart(x).exponent);
    }
    void look_at(const vec3<T>& p) {
        look_at(p.x);
        look_at(p.y);
        look_at(p.z);
    }
    /// How often the unit is in a number that was looked at.
    [[nodiscard]] big_int operator()(T x) const {
        if (is_zero(x)) return big_int();
        const auto parts = take_apart(x);
        return big_int(parts.mantissa, parts.exponent - exponent_);
    }
    [[nodiscard]] vec3<big_int> operator()(const vec3<T>& p) const { return {(*this)(p.x), (*this)(p.y), (*this)(p.z)}; }

private:
    int exponent_ = 1 << 20;
};

}  // namespace abut::detail
