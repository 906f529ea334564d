// SPDX-License-Identifier: MIT
#pragma once

// Shapes that are the same bits on every platform. Points are drawn as integers, and become numbers by a conversion, a
// product with a power of two, and a step of the last bit: no sum is rounded, so that nothing can be contracted. Shapes of
// one sample share points, lines and distances of whole length, so that many of them touch, and a step of the last bit parts
// them.

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace platform {

/// What is drawn; a sample's number says which.
enum class family : unsigned char {
    general,   ///< full mantissas in a cube
    far_away,  ///< the same, far from the origin: differences cancel
    coarse,    ///< -2 to 2: most touch, and most are degenerate
    touching,  ///< a lattice; points, lines and whole lengths are shared
    fine,      ///< the same of larger numbers, in any common scale
    nudged,    ///< touching, some coordinates one step of the last bit off
    flat,      ///< touching, in a plane along the axes, some nudged out of it
    needles,   ///< points near one line
    scaled,    ///< touching, scaled by any power of two
    general_scaled,
    denormal,      ///< multiples of the least number
    mixed,         ///< coordinates of different exponents, 2^-20 to 2^20
    all_exponents  ///< of any
};

/// Numbers of one sample.
template <abut::scalar T>
class inputs {
public:
    inputs(std::uint64_t stream, std::uint64_t index) : key_(finished(finished(stream + 1) ^ finished(~index))) {
        constexpr family of_16[] = {family::general,  family::far_away, family::coarse,         family::touching,
                                    family::touching, family::fine,     family::nudged,         family::nudged,
                                    family::nudged,   family::flat,     family::needles,        family::scaled,
                                    family::general,  family::denormal, family::general_scaled, family::mixed};
        family_ = index % 256 == 0 ? family::all_exponents : of_16[index % 16];
        if (family_ == family::fine) scale_ = below(41) - 20;
        if (family_ == family::scaled || family_ == family::general_scaled) {
            scale_ = is_float ? below(220) - 130 : below(1900) - 1000;
        }
        if (family_ == family::denormal) scale_ = is_float ? -149 : -1074;
        if (is_wide()) scale_ -= mantissa;
        flat_axis_ = below(3);
    }

    /// An integer in [0, n).
    int below(int n) { return static_cast<int>((bits() >> 33) % static_cast<std::uint64_t>(n)); }

    abut::vec3<T> point() {
        const site s = next_site();
        return {number(s.x), number(s.y), number(s.z)};
    }
    /// Not negative; often the length between two sites, or what is left of it.
    T radius() {
        std::int64_t r = below(4);
        if (is_wide()) {
            r = static_cast<std::int64_t>(bits() >> (64 - mantissa + 2));
        } else {
            const int way = below(5);
            if (way <= 1) r = length_;
            if (way == 2) r = length_ > radius_ ? length_ - radius_ : radius_ - length_;
            if (way == 3) r = 2 * below(5);
        }
        if (below(16) == 0) r = 0;
        radius_ = r;
        return number(r);
    }
    /// A distance to be within.
    double reach() { return static_cast<double>(radius()); }

    abut::segment<T> segment() {
        const abut::vec3<T> a = point();
        return {a, point()};
    }
    abut::triangle<T> triangle() {
        const abut::vec3<T> a = point(), b = point();
        return {a, b, point()};
    }

    /// A shape of the type. Hulls refer to points that are kept here, of two hulls.
    template <class S>
    S shape() {
        if constexpr (std::same_as<S, abut::vec3<T>>) {
            return point();
        } else if constexpr (std::same_as<S, abut::segment<T>>) {
            return segment();
        } else if constexpr (std::same_as<S, abut::triangle<T>>) {
            return triangle();
        } else if constexpr (std::same_as<S, abut::sphere<T>>) {
            const abut::vec3<T> center = point();
            return {center, radius()};
        } else if constexpr (std::same_as<S, abut::capsule<T>> || std::same_as<S, abut::cylinder<T>>) {
            const abut::segment<T> axis = segment();
            return {axis, radius()};
        } else if constexpr (std::same_as<S, abut::cone<T>>) {
            const abut::segment<T> axis = segment();
            return {axis.a, axis.b, radius()};
        } else if constexpr (std::same_as<S, abut::aabb<T>>) {
            const abut::segment<T> d = segment();
            const auto low = [](T x, T y) { return y < x ? y : x; };
            const auto high = [](T x, T y) { return y < x ? x : y; };
            return {{low(d.a.x, d.b.x), low(d.a.y, d.b.y), low(d.a.z, d.b.z)},
                    {high(d.a.x, d.b.x), high(d.a.y, d.b.y), high(d.a.z, d.b.z)}};
        } else if constexpr (std::same_as<S, abut::plane<T>>) {
            return plane();
        } else if constexpr (std::same_as<S, abut::ray<T>>) {
            return ray();
        } else {
            static_assert(std::same_as<S, abut::hull<T>>);
            abut::vec3<T>* const first = kept_[kept_count_++ % 2];
            const int n = 1 + below(most_points);
            for (int i = 0; i < n; ++i) first[i] = point();
            return {first, static_cast<std::size_t>(n)};
        }
    }

private:
    static constexpr bool is_float = std::same_as<T, float>;
    static constexpr int mantissa = is_float ? 24 : 53, most_points = 12, most_sites = 32;
    using word = std::conditional_t<is_float, std::uint32_t, std::uint64_t>;

    struct site {
        std::int64_t x, y, z;
    };

    static std::uint64_t finished(std::uint64_t x) {  // splitmix64
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    std::uint64_t bits() { return finished(key_ + 0x9e3779b97f4a7c15u * ++position_); }

    [[nodiscard]] bool is_wide() const {
        return family_ == family::general || family_ == family::far_away || family_ == family::general_scaled ||
               family_ == family::all_exponents || family_ == family::mixed;
    }

    /// 2^e, of e that a normal number has.
    static T power_of_two(int e) {
        return std::bit_cast<T>(static_cast<word>(static_cast<word>(e + (is_float ? 127 : 1023)) << (mantissa - 1)));
    }
    /// m 2^e
    static T times_power_of_two(std::int64_t m, int e) {
        constexpr int least = is_float ? -126 : -1022;
        T x = static_cast<T>(m);
        for (; e < least; e -= least) x *= power_of_two(least);
        return x * power_of_two(e);
    }
    T number(std::int64_t m) {
        int e = scale_;
        if (family_ == family::mixed) e += below(41) - 20;
        if (family_ == family::all_exponents) e += is_float ? below(240) - 140 : below(2000) - 1060;
        const T x = times_power_of_two(m, e);
        const bool nudge = (family_ == family::nudged && below(6) == 0) || (family_ == family::flat && below(24) == 0);
        if (!nudge) return x;
        if (x == 0) return family_ == family::flat ? times_power_of_two(1, -mantissa) : x;
        return std::bit_cast<T>(static_cast<word>(std::bit_cast<word>(x) + (below(2) == 0 ? word{1} : ~word{0})));
    }

    std::int64_t wide() {
        const auto m = static_cast<std::int64_t>(bits() >> (64 - mantissa));
        return below(2) == 0 ? m : -m;
    }
    site remember(const site& s) {
        sites_[count_ % most_sites] = s;
        ++count_;
        return s;
    }
    const site& one_of_sites() { return sites_[below(count_ < most_sites ? count_ : most_sites)]; }

    /// A vector of whole length, which becomes `length_`.
    site whole_way() {
        constexpr int ways[][4] = {{0, 0, 1, 1}, {1, 2, 2, 3}, {0, 3, 4, 5}, {2, 3, 6, 7}, {1, 4, 8, 9}, {2, 6, 9, 11}};
        const int* const way = ways[below(6)];
        const int turn = below(3), times = 1 + below(2), signs = below(8);
        length_ = times * way[3];
        const auto at = [&](int i) {
            return static_cast<std::int64_t>(times * way[(i + turn) % 3] * ((signs >> i & 1) == 0 ? 1 : -1));
        };
        return {at(0), at(1), at(2)};
    }
    static bool is_small(const site& s) {
        const auto is = [](std::int64_t x) { return x * x < std::int64_t{1} << 32; };
        return is(s.x) && is(s.y) && is(s.z);
    }
    site next_site() {
        if (family_ == family::far_away) {
            constexpr std::int64_t far = std::int64_t{1} << (mantissa - 1);
            const auto near = [&](std::int64_t m) { return far + (m >> 12); };
            return remember({near(wide()), near(wide()), near(wide())});
        }
        if (is_wide()) {
            // Now and then a point that was there: even in general position shapes share corners.
            if (count_ > 0 && below(24) == 0) return one_of_sites();
            const std::int64_t x = wide(), y = wide();
            return remember({x, y, wide()});
        }
        if (family_ == family::coarse) {
            const std::int64_t x = below(5) - 2, y = below(5) - 2;
            return remember({x, y, below(5) - 2});
        }
        if (family_ == family::needles) {
            const std::int64_t along = below(2001) - 1000, off = below(3) - 1;
            return remember({3 * along + off, 2 * along, along - (below(8) == 0 ? off : 0)});
        }
        const int half = family_ == family::fine || family_ == family::denormal ? 60 : 8;
        const auto even = [&] { return static_cast<std::int64_t>(2 * (below(half + 1) - half / 2)); };
        const std::int64_t x = even(), y = even();
        site s{x, y, even()};
        const int way = count_ == 0 ? 0 : below(8);
        if (way == 1 || way == 2 || way == 3) {  // in a whole distance from another one
            const site from = one_of_sites(), by = whole_way();
            s = {from.x + by.x, from.y + by.y, from.z + by.z};
        } else if (way >= 4 && way <= 6) {  // the same as another one, between two, or on their line
            const site a = one_of_sites(), b = one_of_sites();
            const int k = way == 4 ? 0 : below(5) - 1;
            if (way == 6 && (a.x + b.x) % 2 == 0 && (a.y + b.y) % 2 == 0 && (a.z + b.z) % 2 == 0) {
                s = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
            } else {
                s = {a.x + k * (b.x - a.x), a.y + k * (b.y - a.y), a.z + k * (b.z - a.z)};
            }
            if (!is_small(s)) s = a;
        }
        if (family_ == family::flat) (flat_axis_ == 0 ? s.x : flat_axis_ == 1 ? s.y : s.z) = 0;
        return remember(s);
    }

    /// Through a point that is there, where numbers are small enough for a whole offset.
    abut::plane<T> plane() {
        const int scale = scale_;
        if (is_wide()) {
            scale_ = -mantissa;
            const std::int64_t x = wide(), y = wide();
            const T nx = number(x), ny = number(y), nz = number(wide());
            scale_ = scale;
            return {{nx, ny, nz}, number(wide())};
        }
        const site at = count_ > 0 ? one_of_sites() : next_site();
        site n = whole_way();
        if (below(16) == 0) n = {0, 0, 0};
        scale_ = 0;
        const T nx = number(n.x), ny = number(n.y), nz = number(n.z);
        scale_ = scale;
        std::int64_t offset = n.x * at.x + n.y * at.y + n.z * at.z;
        if (below(4) == 0) offset += length_ * below(4);
        return {{nx, ny, nz}, number(offset)};
    }
    /// Often towards a point that is there.
    abut::ray<T> ray() {
        const abut::vec3<T> origin = point();
        if (is_wide() || below(2) == 0) return {origin, point()};
        const site& from = sites_[(count_ - 1) % most_sites];
        const site to = one_of_sites();
        const T x = number(to.x - from.x), y = number(to.y - from.y);
        return {origin, {x, y, number(to.z - from.z)}};
    }

    std::uint64_t key_, position_ = 0;
    family family_;
    int scale_ = 0, flat_axis_, count_ = 0, kept_count_ = 0;
    std::int64_t length_ = 3, radius_ = 0;
    site sites_[most_sites];
    abut::vec3<T> kept_[2][most_points];
};

/// One of three rotations, and a translation by quarters.
template <abut::scalar T>
abut::rigid<T> any_pose(std::uint64_t index) {
    inputs<T> in(1000, 16 * index + 2);
    const auto quarters = [&] { return static_cast<T>(in.below(33) - 16) * T(0.25); };
    const int turn = in.below(3);
    const T x = quarters(), y = quarters(), z = quarters();
    if (turn == 0) return {.translation = {x, y, z}};
    if (turn == 1) return {.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}, .translation = {x, y, z}};
    return {.rotation = {T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, .translation = {x, y, z}};
}

}  // namespace platform
