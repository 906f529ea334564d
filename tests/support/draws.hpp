// SPDX-License-Identifier: MIT
#pragma once

// What the families of pairs are made of: numbers from a seed, and a few constructions of points. All give the same bits on
// hosts and devices and under each compiler: the generator counts instead of keeping a state, every sum of products is an
// explicit fma, and nothing but + - * / sqrt fma is used. Draws are statements of their own: the order in which arguments
// are evaluated is the compiler's.

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut::test {

/// Numbers drawn in order from one counter: splitmix64's finaliser of seed, stream and position.
class draws {
public:
    ABUT_HD draws(std::uint64_t seed_value, std::uint64_t stream, std::uint64_t index)
        : key_(mixed(mixed(seed_value + 0x9e3779b97f4a7c15u) ^ mixed(stream) ^ mixed(~index))) {}

    ABUT_HD std::uint64_t bits() { return mixed(key_ + 0x9e3779b97f4a7c15u * ++position_); }

    /// An integer in [0, n).
    ABUT_HD int below(int n) { return static_cast<int>((bits() >> 33) % static_cast<std::uint64_t>(n)); }

    /// A double in [low, high], with a full mantissa also where it is small.
    ABUT_HD double uniform(double low, double high) {
        return std::fma(static_cast<double>(bits()) * 0x1p-64, high - low, low);
    }

    /// 10^e with e uniform in steps of 1/8, by multiplication alone.
    ABUT_HD double power_of_ten(int low, int high) {
        double r = 1;
        const int e = below(8 * (high - low) + 1) + 8 * low;
        for (int i = 0; i < (e < 0 ? -e : e); ++i) r *= e < 0 ? 0.74989420933245582 : 1.3335214321633240;
        return r;
    }

private:
    ABUT_HD static std::uint64_t mixed(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }

    std::uint64_t key_;
    std::uint64_t position_ = 0;
};

namespace construction {

using point = vec3<double>;

ABUT_HD inline point cube(draws& d, double half) {
    const double x = d.uniform(-half, half), y = d.uniform(-half, half);
    return {x, y, d.uniform(-half, half)};
}

/// p + t v
ABUT_HD inline point along(const point& p, double t, const point& v) {
    return {std::fma(t, v.x, p.x), std::fma(t, v.y, p.y), std::fma(t, v.z, p.z)};
}

ABUT_HD inline double product(const point& a, const point& b) { return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z)); }

ABUT_HD inline point cross_product(const point& a, const point& b) {
    return {std::fma(a.y, b.z, -(a.z * b.y)), std::fma(a.z, b.x, -(a.x * b.z)), std::fma(a.x, b.y, -(a.y * b.x))};
}

ABUT_HD inline double length(const point& a) { return std::sqrt(product(a, a)); }

ABUT_HD inline point unit(const point& a) {
    const double l = length(a);
    return {a.x / l, a.y / l, a.z / l};
}

/// Through memory: g++ 12, when it vectorises, drops the rounding where the number is widened again.
template <scalar T>
ABUT_HD T rounded_to(double x) {
    const volatile T rounded = static_cast<T>(x);
    return rounded;
}

template <scalar T>
ABUT_HD vec3<T> round_to(const point& p) {
    return {rounded_to<T>(p.x), rounded_to<T>(p.y), rounded_to<T>(p.z)};
}

template <scalar T>
ABUT_HD point widened(const vec3<T>& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

ABUT_HD inline float from_bits(std::uint32_t w) { return __builtin_bit_cast(float, w); }
ABUT_HD inline double from_bits(std::uint64_t w) { return __builtin_bit_cast(double, w); }

/// A positive number `steps` representable numbers away.
ABUT_HD inline float stepped(float x, int steps) {
    return from_bits(__builtin_bit_cast(std::uint32_t, x) + static_cast<std::uint32_t>(steps));
}
ABUT_HD inline double stepped(double x, int steps) {
    return from_bits(__builtin_bit_cast(std::uint64_t, x) + static_cast<std::uint64_t>(steps));
}

/// The representable number `steps` above x, or below where negative: through zero, and from one binade to the next.
ABUT_HD inline float moved(float x, int steps) {
    const auto w = __builtin_bit_cast(std::int32_t, x), sign = INT32_MIN, k = (w < 0 ? sign - w : w) + steps;
    return __builtin_bit_cast(float, k < 0 ? sign - k : k);
}
ABUT_HD inline double moved(double x, int steps) {
    const auto w = __builtin_bit_cast(std::int64_t, x), sign = INT64_MIN, k = (w < 0 ? sign - w : w) + steps;
    return __builtin_bit_cast(double, k < 0 ? sign - k : k);
}

template <scalar T>
ABUT_HD T any_finite(draws& d) {
    for (;;) {
        const T x = sizeof(T) == 4 ? static_cast<T>(from_bits(static_cast<std::uint32_t>(d.bits() >> 32)))
                                   : static_cast<T>(from_bits(d.bits()));
        if (x - x == 0) return x;
    }
}

template <scalar T>
inline constexpr T least_denormal = sizeof(T) == 4 ? T(0x1p-149) : T(0x1p-1074);
template <scalar T>
inline constexpr T largest_number = sizeof(T) == 4 ? T(0x1.fffffep127) : T(0x1.fffffffffffffp1023);

}  // namespace construction

}  // namespace abut::test
