// SPDX-License-Identifier: MIT
#pragma once

// Pairs that closed forms in plain doubles know, or just do not: axes that are parallel but for an angle down to 2^-60, that
// cross, are longer or shorter than each other by powers of two, or have no length; boxes under a pose, flat or sheared by
// what a rotation may be off, and balls beside their faces, edges and corners and inside; all as near to contact as numbers
// allow, or apart, or deep, and far from the origin. A pair is a pure function of its number.

#include <cmath>
#include <cstdint>
#include <utility>

#include <abut/arithmetic/vec.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"
#include "families.hpp"
#include "poses.hpp"

namespace abut::test {

inline constexpr std::uint64_t plain_seed = 20261128;

namespace construction {

/// What two radii sum up to of shapes whose cores are that far apart: less, much less, more, or that but for some digits.
inline double radii_for(draws& d, double gap) {
    const int kind = d.below(6);
    return kind == 0   ? 0
           : kind == 1 ? gap * d.uniform(0, 1)
           : kind == 2 ? gap * d.uniform(1, 3)
           : kind == 3 ? gap / 1024
                       : gap * (1 + d.uniform(-1, 1) * std::ldexp(1.0, -d.below(54)));
}

}  // namespace construction

template <scalar T>
std::pair<capsule<T>, capsule<T>> make_plain_capsules(std::uint64_t i) {
    using namespace construction;
    draws d(plain_seed, 1, i);
    const int kind = static_cast<int>(i % 8);
    const point away = kind == 6 ? cube(d, 0x1p20) : cube(d, 1), u = unit(cube(d, 1));
    const double angle = kind < 3 ? std::ldexp(1.0, -d.below(61)) : 1,
                 gap = std::ldexp(d.uniform(0.5, 1), -d.below(kind < 5 ? 25 : 3));
    const point v = along(u, angle, cube(d, 1)), n = unit(cross_product(u, cube(d, 1)));
    const double of_a = std::ldexp(1.0, kind == 4 ? -d.below(20) : 0), of_b = std::ldexp(1.0, kind == 4 ? -d.below(20) : 0);
    const auto piece = [&](const point& at, const point& along_it, double length) {
        const double from = d.uniform(-2, 1) * length, to = from + d.uniform(0.1, 2) * length;
        return std::pair(along(at, from, along_it), along(at, to, along_it));
    };
    const auto a = piece(away, u, of_a), b = piece(along(away, gap, n), v, of_b);
    const auto rounding = [&](const point& p) {  // on a lattice things are parallel, or meet, exactly
        const auto coarse = [](double x) { return std::floor(x * 4 + 0.5) / 4; };
        return kind == 7 ? round_to<T>(point{coarse(p.x), coarse(p.y), coarse(p.z)}) : round_to<T>(p);
    };
    const double radii = radii_for(d, gap), share = d.below(3) == 0 ? 0 : d.uniform(0, 1);
    capsule<T> s{{rounding(a.first), rounding(a.second)}, static_cast<T>(radii * share)};
    capsule<T> t{{rounding(b.first), rounding(b.second)}, static_cast<T>(radii * (1 - share))};
    if (kind == 5 && d.below(2) == 0) s.axis.b = s.axis.a;
    return {s, t};
}

template <scalar T>
std::pair<oriented_box<T>, sphere<T>> make_plain_box_and_ball(std::uint64_t i) {
    using namespace construction;
    draws d(plain_seed, 2, i);
    const int kind = static_cast<int>(i % 8);
    const auto half = [&] { return std::ldexp(d.uniform(0.5, 1), kind == 3 ? -d.below(24) : 0); };
    const point size{half(), half(), half()}, at = kind == 2 ? cube(d, 0x1p10) : cube(d, 1);
    rigid<T> pose;
    if (kind == 1) {
        set_quarter_turns(pose, d);
    } else {
        set_rotation(pose, d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1));
    }
    if (kind == 4) pose.rotation[d.below(9)] += static_cast<T>(std::ldexp(1.0, -11 - d.below(20)));
    pose.translation = round_to<T>(at);
    const vec3<T> h = round_to<T>(point{kind == 5 ? 0 : size.x, size.y, size.z});
    oriented_box<T> box{pose.translation, h};
    for (int k = 0; k < 9; ++k) box.rotation[k] = pose.rotation[k];
    // In the frame of the box: beyond a face or more by the same gap, or inside.
    const double gap = std::ldexp(d.uniform(0.5, 1), -d.below(25));
    int beyond = 0;
    const auto coordinate = [&](double side) {
        const bool is_beyond = d.below(2) == 0;
        beyond += is_beyond ? 1 : 0;
        return is_beyond ? (d.below(2) == 0 ? side + gap : -side - gap) : side * d.uniform(-1, 1);
    };
    const point local{coordinate(static_cast<double>(h.x)), coordinate(static_cast<double>(h.y)),
                      coordinate(static_cast<double>(h.z))};
    const double radius = beyond == 0 ? d.uniform(0, 1) : radii_for(d, gap * std::sqrt(beyond));
    return {box, {place(pose, round_to<T>(local)), static_cast<T>(radius)}};
}

/// A box along the axes, and a capsule whose axis passes a point beyond a face, an edge or a corner of it, along an edge or
/// a face but for an angle down to 2^-60, or across; or one that begins inside.
template <scalar T>
std::pair<aabb<T>, capsule<T>> make_plain_box_and_capsule(std::uint64_t i) {
    using namespace construction;
    draws d(plain_seed, 3, i);
    const int kind = static_cast<int>(i % 8);
    const auto half = [&] { return std::ldexp(d.uniform(0.5, 1), kind == 3 ? -d.below(24) : 0); };
    const point size{kind == 5 ? 0 : half(), half(), half()}, at = kind == 2 ? cube(d, 0x1p20) : cube(d, 1);
    const double gap = std::ldexp(d.uniform(0.5, 1), -d.below(25));
    point away{0, 0, 0}, foot{0, 0, 0}, line = cube(d, 1);
    const auto turn = [&](double side, double& out, double& on, double& along_it) {
        const int where = d.below(3);
        out = where == 0 ? 0 : where == 1 ? 1 : -1;
        on = where == 0 ? side * d.uniform(-1, 1) : out * side;
        if (where != 0 && kind < 6) along_it *= std::ldexp(1.0, -d.below(61));  // it hardly leaves the face
    };
    turn(size.x, away.x, foot.x, line.x), turn(size.y, away.y, foot.y, line.y), turn(size.z, away.z, foot.z, line.z);
    const double beyond = length(away);
    const point passes = along(along(at, 1, foot), gap, away);
    const double from = d.uniform(-2, 0.5), to = from + d.uniform(0.1, 2);
    const vec3<T> center = round_to<T>(at), h = round_to<T>(size);
    const double radius = beyond == 0 ? d.uniform(0, 1) : radii_for(d, gap * beyond);
    return {{center - h, center + h},
            {{round_to<T>(along(passes, from, line)), round_to<T>(along(passes, to, line))}, static_cast<T>(radius)}};
}

}  // namespace abut::test
