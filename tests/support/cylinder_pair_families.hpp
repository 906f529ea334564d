// SPDX-License-Identifier: MIT
#pragma once

// Pairs of a cylinder and another one or a capsule: in general position, at the last radius without contact and at the first
// one with it, on lattices, touching exactly by construction, of every size, degenerate. All deterministic by seed, family
// and number. Where the construction says whether they meet, the pair does too.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

#include "cylinder_pair_oracle.hpp"
#include "draws.hpp"
#include "revolution_pairs.hpp"

namespace abut::test {

/// `touching`: whole numbers of which the construction says whether they touch; `nudged`: one of its numbers is a step off.
/// `aligned`: numbers of all digits, but along axes of the coordinates, and as far apart as the rounded sum of two numbers.
/// `near_contact`: a radius is the least with which they meet. `side_by_side`: the second is moved away until
/// balls around the nearest points of the axes touch about. `huge_and_small`: the surface of one, up to 2^60 times as
/// large, goes through where the other is.
enum class round_family : int {
    random,
    side_by_side,
    offset,
    any_scale,
    lattice_2,
    lattice_5,
    upright_lattice,
    touching,
    nudged,
    aligned,
    near_contact,
    perpendicular,
    nearly_parallel,
    nested,
    end_inside,
    discs_and_needles,
    huge_and_small,
    no_radius,
    no_length,
    denormal,
    largest,
    mixed_exponents,
    all_bit_patterns,
};
inline constexpr int round_family_count = 23;

inline const char* name_of(round_family f) {
    constexpr const char* names[round_family_count] = {
        "random",          "side by side", "offset",     "any scale",       "lattice 2",       "lattice 5",
        "upright",         "touching",     "nudged",     "aligned",         "near contact",    "perpendicular",
        "nearly parallel", "nested",       "end inside", "discs, needles",  "huge and small",  "no radius",
        "no length",       "denormal",     "largest",    "mixed exponents", "all bit patterns"};
    return names[static_cast<int>(f)];
}

/// What a construction says of a pair.
enum class known : int { no, yes, nothing };

template <scalar T>
struct pair_of_rounds {
    segment<T> first;
    T first_radius;
    segment<T> second;
    T second_radius;
    known truth = known::nothing;
    bool is_first_least = false;  ///< in `near_contact`, whose radius it is
};

template <scalar T>
cylinder<T> first_of(const pair_of_rounds<T>& p) {
    return {p.first, p.first_radius};
}
template <class Other, scalar T>
Other second_of(const pair_of_rounds<T>& p) {
    return {p.second, p.second_radius};
}

namespace construction {

template <scalar T>
T* number_of(pair_of_rounds<T>& c, int i) {
    vec3<T>* const points[] = {&c.first.a, &c.first.b, &c.second.a, &c.second.b};
    if (i == 12) return &c.first_radius;
    if (i == 13) return &c.second_radius;
    vec3<T>& p = *points[i / 3];
    return i % 3 == 0 ? &p.x : i % 3 == 1 ? &p.y : &p.z;
}

struct whole_point {
    int x, y, z;
    friend whole_point operator+(const whole_point& a, const whole_point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend whole_point operator*(int s, const whole_point& a) { return {s * a.x, s * a.y, s * a.z}; }
};

/// Whether segments of a plane meet, by the signs of areas.
inline bool plane_segments_meet(const int (&a)[2], const int (&b)[2], const int (&c)[2], const int (&d)[2]) {
    const auto area = [](const int(&p)[2], const int(&q)[2], const int(&r)[2]) {
        const int s = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        return (s > 0) - (s < 0);
    };
    const int u = area(a, b, c), v = area(a, b, d), w = area(c, d, a), x = area(c, d, b);
    if (u == 0 && v == 0 && w == 0 && x == 0) {
        for (int k = 0; k < 2; ++k) {
            if (std::max(a[k], b[k]) < std::min(c[k], d[k]) || std::max(c[k], d[k]) < std::min(a[k], b[k])) return false;
        }
        return true;
    }
    return u * v <= 0 && w * x <= 0;
}

/// In whole coordinates of a frame: the first stands on the z axis, and the second touches it in a plane that separates
/// their insides, or is one step before or behind where it would.
template <scalar T>
void touching(draws& d, bool is_capsule, pair_of_rounds<T>& pair) {
    constexpr int circle[12][2] = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                   {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
    const lattice_frame f(d);
    const int* const u = circle[d.below(12)];
    const int kind = d.below(8);
    whole_point a{0, 0, 0}, b{0, 0, 1 + d.below(9)}, c{}, e{}, apart{};
    int r = 1 + d.below(4), s = 1 + d.below(4);
    bool is_met = true;
    const auto ordered = [&](int low, int high, int& x, int& y) {
        x = low + d.below(high - low + 1);
        y = low + d.below(high - low + 1);
        if (x > y) std::swap(x, y);
    };
    int x = 0, y = 0;
    // Of no length, where x and y are one: a ball, that touches where the side would.
    if (kind == 0) {  // side by side
        r *= 5, s *= 5;
        const int distance = (r + s) / 5;
        ordered(-4, b.z + 4, x, y);
        c = {distance * u[0], distance * u[1], x}, e = {c.x, c.y, y};
        is_met = y >= 0 && x <= b.z;
        apart = {u[0], u[1], 0};
    } else if (kind == 1) {  // end on end, or the capsule's end on it
        const int distance = d.below(r + s + 2), up = 1 + d.below(5);
        r *= 5, s *= 5;
        const int lift = is_capsule ? s : 0;
        c = {distance * u[0], distance * u[1], b.z + lift}, e = {c.x, c.y, c.z + up};
        is_met = is_capsule ? distance * 5 <= r : distance * 5 <= r + s;
        apart = {0, 0, 1};
    } else if (kind == 2) {  // side on end
        r *= 5;
        ordered(-15, 15, x, y);
        if (x == y) ++y;
        const int side = d.below(2 * r + 5) - r - 2;
        c = {x, side, b.z + s}, e = {y, side, b.z + s};
        const int least = x > 0 ? x : y < 0 ? -y : 0;
        is_met = least * least + side * side <= r * r;
        apart = {0, 0, 1};
    } else if (kind == 3) {  // sides that cross at y = r
        const int from[2] = {d.below(13) - 6, d.below(13) - 6}, to[2] = {d.below(13) - 6, d.below(13) - 6};
        const int low[2] = {0, 0}, high[2] = {0, b.z};
        c = {from[0], r + s, from[1]}, e = {to[0], r + s, to[1]};
        is_met = plane_segments_meet(low, high, from, to);
        apart = {0, 1, 0};
    } else {
        // On the upper rim, in units of 1 / 5 of its direction u: a normal of length 25, and two more at right angles.
        const bool is_steep = d.below(2) == 0;
        const int out = is_steep ? 3 : 4, up = is_steep ? 4 : 3;
        const whole_point n{out * u[0], out * u[1], up * 5}, t{-5 * u[1], 5 * u[0], 0}, m{-up * u[0], -up * u[1], out * 5};
        const whole_point p{25 * r * u[0], 25 * r * u[1], 25 * b.z};
        r *= 125, b.z *= 25;
        apart = n;
        if (kind == 4 || (is_capsule && kind == 6)) {  // the side on the rim
            ordered(-3, 3, x, y);
            const int i = d.below(5) - 2, j = i == 0 ? 1 : d.below(5) - 2;
            const whole_point along = i * t + j * m;
            if (x == y) ++y;
            c = p + s * n + x * along, e = p + s * n + y * along;
            is_met = x <= 0 && y >= 0;
            s *= 25;
        } else if (kind == 5 || is_capsule) {  // a ball on the rim, or a capsule's end
            c = p + s * n;
            e = is_capsule ? c + d.below(3) * n + (d.below(5) - 2) * t + (d.below(5) - 2) * m : c;
            s *= 25;
        } else if (kind == 6) {  // rim on rim: w is along the radius of the second, q points out of its end
            const whole_point& side = d.below(2) == 0 ? t : m;
            const int g = d.below(2) == 0 ? 3 : 4, h = 7 - g;
            const whole_point w = -g * n + h * side, q = -h * n + -g * side;
            c = p + -s * w, e = c + -(1 + d.below(3)) * q;
            s *= 125;
        } else {  // rim on end
            const int i = d.below(9) - 4, j = d.below(9) - 4;
            c = p + i * t + j * m, e = c + (1 + d.below(3)) * n;
            is_met = i * i + j * j <= s * s;
            s *= 25;
        }
    }
    const int step = d.below(6);
    if (step == 0) {
        c = c + apart, e = e + apart;
        is_met = false;
    }
    // On a rim, inwards is into both.
    if (step == 1 && kind > 3 && is_met) c = c + -1 * apart, e = e + -1 * apart;
    const auto place = [&](const whole_point& w) { return f.at<T>(w.x, w.y, w.z); };
    pair.first = {place(a), place(b)}, pair.second = {place(c), place(e)};
    pair.first_radius = static_cast<T>(r * f.unit()), pair.second_radius = static_cast<T>(s * f.unit());
    pair.truth = is_met ? known::yes : known::no;
    if (d.below(2) == 0) std::swap(pair.first.a, pair.first.b);
    if (d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
    if (!is_capsule && d.below(2) == 0) {
        std::swap(pair.first, pair.second), std::swap(pair.first_radius, pair.second_radius);
    }
    const T scale = rounded_to<T>(std::ldexp(1.0, d.below(3) == 0 ? d.below(41) - 20 : 0));
    for (int i = 0; i < 14; ++i) *number_of(pair, i) *= scale;
}

/// Whether the sum is x exactly, or more, where x is the rounded one or a step from that.
template <scalar T>
bool is_sum_at_least(T a, T b, T x) {
    return fraction(static_cast<double>(a)) + fraction(static_cast<double>(b)) >= fraction(static_cast<double>(x));
}

/// The first along z, and the second along z or x, as far from it along one axis as two numbers together, rounded.
template <scalar T>
void aligned(draws& d, bool is_capsule, pair_of_rounds<T>& pair) {
    const auto draw = [&](double low, double high) { return rounded_to<T>(d.uniform(low, high)); };
    const auto rounded_sum = [&](T a, T b) {
        const volatile T sum = a + b;
        const int step = d.below(4) - 2;
        return moved(T(sum), step < -1 ? 0 : step);
    };
    const int kind = d.below(4), turn = d.below(3);
    const T r = draw(0.01, 1), s = draw(0.01, 1), low = draw(-1, 0.2), high = draw(0.3, 1);
    pair.first_radius = r, pair.second_radius = s;
    pair.first = {{T(0), T(0), low}, {T(0), T(0), high}};
    if (kind < 2) {
        const T out = rounded_sum(r, s);
        const T from = draw(-1.5, 0.5), to = draw(-0.5, 1.5), at = draw(-1, 1);
        if (kind == 0) {  // side by side
            pair.second = {{out, T(0), from}, {out, T(0), to}};
        } else {  // crossing
            pair.second = {{from, out, at}, {to, out, at}};
        }
        const T least = from < to ? from : to, most = from < to ? to : from;
        const bool faces = kind == 0 ? least <= high && most >= low : least <= 0 && most >= 0 && at >= low && at <= high;
        if (faces) pair.truth = is_sum_at_least(r, s, out) ? known::yes : known::no;
    } else {
        const bool is_side = kind == 3;
        const T lift = is_side || is_capsule ? s : T(0), up = rounded_sum(high, lift), x = draw(-1, 1) * r, y = draw(-1, 1);
        if (is_side) {
            pair.second = {{-y * y, x, up}, {T(1), x, up}};
        } else {
            pair.second = {{x, T(0), up}, {x, T(0), up + T(1)}};
        }
        pair.truth = is_sum_at_least(high, lift, up) ? known::yes : known::no;
    }
    for (int i = 0; i < turn; ++i) {
        for (vec3<T>* p : {&pair.first.a, &pair.first.b, &pair.second.a, &pair.second.b}) *p = {p->z, p->x, p->y};
    }
    if (d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
}

}  // namespace construction

/// The least radius with which they meet, of the one or the other; false where there is none, or 0. `meet()` finds out.
template <scalar T, class Meet>
bool set_least_radius(pair_of_rounds<T>& c, const Meet& meet) {
    T& which = c.is_first_least ? c.first_radius : c.second_radius;
    const auto meet_with = [&](T radius) {
        which = radius;
        return meet();
    };
    T low = 0, high = 16;
    if (meet_with(low) != finding::no || meet_with(high) != finding::yes) return false;
    for (;;) {
        const T middle = construction::rounded_to<T>(static_cast<double>(low) / 2 + static_cast<double>(high) / 2);
        if (middle == low || middle == high) break;
        const finding found = meet_with(middle);
        if (found == finding::failed) return false;
        (found == finding::no ? low : high) = middle;
    }
    which = high;
    c.truth = known::yes;
    return true;
}

template <class Other, scalar T = scalar_type_of<Other>>
pair_of_rounds<T> make_round_pair(std::uint64_t seed, round_family f, std::uint64_t k) {
    using namespace construction;
    constexpr bool is_capsule = !std::same_as<Other, cylinder<T>>;
    draws d(seed, 1000 + static_cast<std::uint64_t>(f) * 2 + (is_capsule ? 1 : 0), k);
    pair_of_rounds<T> c{};
    const auto general = [&](double scale, const point& offset) {
        for (segment<T>* s : {&c.first, &c.second}) {
            s->a = round_to<T>(along(offset, scale, cube(d, 1)));
            s->b = round_to<T>(along(offset, scale, cube(d, 1)));
        }
        c.first_radius = rounded_to<T>(scale * d.power_of_ten(-2, 0));
        c.second_radius = rounded_to<T>(scale * d.power_of_ten(-2, 0));
    };
    const auto lattice = [&](int n) {
        for (int i = 0; i < 12; ++i) *number_of(c, i) = static_cast<T>(d.below(2 * n + 1) - n);
        c.first_radius = static_cast<T>(d.below(2 * n)) / 2;
        c.second_radius = static_cast<T>(d.below(2 * n)) / 2;
    };
    // The first along an axis of the coordinates, and the second half the time.
    const auto upright = [&](int n) {
        lattice(n);
        c.first.b = c.first.a;
        *number_of(c, 3 + d.below(3)) += static_cast<T>(d.below(7) - 3);
        if (d.below(2) == 0) {
            c.second.b = c.second.a;
            *number_of(c, 9 + d.below(3)) += static_cast<T>(d.below(7) - 3);
        }
    };
    // Away from the first along some normal of it, by about what both reach.
    const auto move_beside = [&](double most) {
        const point axis = along(widened(c.first.b), -1, widened(c.first.a)),
                    other = along(widened(c.second.b), -1, widened(c.second.a));
        const int kind = d.below(3);
        point n = kind == 0 ? cross_product(axis, other) : kind == 1 ? axis : cube(d, 1);
        if (!(length(n) > 0)) n = {1, 0, 0};
        n = unit(n);
        const auto reach = [&](const point& e, T radius, bool is_round) {
            const double l = length(e), h = product(e, n), r = static_cast<double>(radius);
            const double across = is_round || l == 0 ? 1 : std::sqrt(std::max(0.0, 1 - h * h / (l * l)));
            return std::fabs(h) / 2 + r * across;
        };
        const double far = reach(axis, c.first_radius, false) + reach(other, c.second_radius, is_capsule);
        const point half = along({0, 0, 0}, 0.5, other), at = along(widened(c.first.a), 0.5, axis);
        const point center = along(along(at, far * (1 + d.uniform(-most, most)), n), d.uniform(-0.3, 0.3), axis);
        c.second = {round_to<T>(along(center, -1, half)), round_to<T>(along(center, 1, half))};
    };
    const auto perpendicular = [&] {
        const point first = cube(d, 1), axis = cube(d, 1), at = cube(d, 1), across = unit(cross_product(axis, cube(d, 1)));
        c.first = {round_to<T>(first), round_to<T>(along(first, 1, axis))};
        c.second = {round_to<T>(along(at, -d.uniform(0, 1), across)), round_to<T>(along(at, d.uniform(0, 1), across))};
        c.first_radius = rounded_to<T>(d.power_of_ten(-2, 0));
        c.second_radius = rounded_to<T>(d.power_of_ten(-2, 0));
        if (d.below(2) == 0) {  // along axes of the coordinates
            const int i = d.below(3), j = (i + 1 + d.below(2)) % 3;
            for (int l = 0; l < 3; ++l) {
                if (l != i) *number_of(c, 3 + l) = *number_of(c, l);
                if (l != j) *number_of(c, 9 + l) = *number_of(c, 6 + l);
            }
        }
    };
    const auto nearly_parallel = [&] {
        const point first = cube(d, 1), axis = cube(d, 1), at = cube(d, 1);
        const double angle = d.below(4) == 0 ? 0 : std::ldexp(d.uniform(0.5, 1), -d.below(61)), size = d.uniform(-2, 2);
        c.first = {round_to<T>(first), round_to<T>(along(first, 1, axis))};
        c.second = {round_to<T>(at), round_to<T>(along(along(at, size, axis), angle, cube(d, 1)))};
        c.first_radius = rounded_to<T>(d.power_of_ten(-2, 0));
        c.second_radius = rounded_to<T>(d.power_of_ten(-2, 0));
    };
    const auto discs_and_needles = [&] {
        general(1, {0, 0, 0});
        for (int i = 0; i < 2; ++i) {
            segment<T>& s = i == 0 ? c.first : c.second;
            T& radius = i == 0 ? c.first_radius : c.second_radius;
            const double thin = std::ldexp(d.uniform(0.5, 1), -d.below(50));
            if (d.below(2) == 0) {
                radius = rounded_to<T>(thin);
            } else {
                const point e = along(widened(s.b), -1, widened(s.a));
                // Where the first end is small, a disc may be as thin as wanted.
                if (d.below(2) == 0) s.a = {T(0), T(0), T(0)};
                s.b = round_to<T>(along(widened(s.a), thin, e));
                radius = rounded_to<T>(d.uniform(0.2, 1.5));
            }
        }
    };
    switch (f) {
        case round_family::random:
            general(1, {0, 0, 0});
            break;
        case round_family::side_by_side:
            general(1, {0, 0, 0});
            move_beside(d.below(2) == 0 ? 0.2 : std::ldexp(1, -d.below(30)));
            break;
        case round_family::offset:
            general(1, cube(d, d.power_of_ten(1, 6)));
            if (d.below(2) == 0) move_beside(0.2);
            break;
        case round_family::any_scale:
            general(std::same_as<T, float> ? d.power_of_ten(-36, 36) : d.power_of_ten(-36, 36) * d.power_of_ten(-36, 36),
                    {0, 0, 0});
            break;
        case round_family::lattice_2:
            lattice(2);
            break;
        case round_family::lattice_5:
            lattice(5);
            break;
        case round_family::upright_lattice:
            upright(3);
            break;
        case round_family::touching:
            touching(d, is_capsule, c);
            break;
        case round_family::nudged: {
            if (d.below(2) == 0) {
                touching(d, is_capsule, c);
            } else {
                upright(2);
            }
            c.truth = known::nothing;
            const int count = 1 + d.below(2) * d.below(3);
            for (int i = 0; i < count; ++i) {
                T& x = *number_of(c, d.below(14));
                const int way = d.below(2) == 0 ? -1 : 1;
                // The step from 0 is as small as numbers are where that is not many digits.
                x = x != 0 || (sizeof(T) == 4 && d.below(4) == 0)
                        ? moved(x, way)
                        : rounded_to<T>(std::ldexp(double(way), -1 - d.below(100)));
                if (c.first_radius < 0 || c.second_radius < 0) x = 0;
            }
            break;
        }
        case round_family::near_contact:
            for (int tries = 0; tries < 40; ++tries) {
                const int kind = d.below(6);
                if (kind == 0) general(1, {0, 0, 0});
                if (kind == 1) perpendicular();
                if (kind == 2) nearly_parallel();
                if (kind == 3) discs_and_needles();
                if (kind == 4) general(1, cube(d, d.power_of_ten(1, 3)));
                if (kind == 5) lattice(4);
                if (c.first.a == c.first.b) continue;
                c.is_first_least = d.below(2) == 0;
                if (set_least_radius(c, [&] { return oracle::examine_round(first_of(c), second_of<Other>(c)); })) return c;
            }
            general(1, {0, 0, 0});
            break;
        case round_family::aligned:
            aligned(d, is_capsule, c);
            break;
        case round_family::perpendicular:
            perpendicular();
            if (d.below(2) == 0) move_beside(std::ldexp(1, -d.below(50)));
            break;
        case round_family::nearly_parallel:
            nearly_parallel();
            if (d.below(2) == 0) move_beside(std::ldexp(1, -d.below(50)));
            break;
        case round_family::nested: {
            // A part of the axis is inside, and about all of the solid, or a little less.
            general(1, {0, 0, 0});
            const point a = widened(c.first.a), e = along(widened(c.first.b), -1, a);
            const double size = d.power_of_ten(-6, 0);
            const point at = along(along(a, d.uniform(-0.2, 1.2), e), 0.7 * static_cast<double>(c.first_radius), cube(d, 1));
            c.second = {round_to<T>(at), round_to<T>(along(at, size, cube(d, 1)))};
            c.second_radius = rounded_to<T>(size * d.power_of_ten(-2, 0));
            break;
        }
        case round_family::end_inside: {
            // An end of the second is about at the side of the first, or at an end's rim.
            general(1, {0, 0, 0});
            const point a = widened(c.first.a), e = along(widened(c.first.b), -1, a);
            const point out = unit(cross_product(e, cube(d, 1)));
            const double t = d.below(2) == 0 ? d.below(2) : d.uniform(0, 1), r = static_cast<double>(c.first_radius);
            const double step = std::ldexp(d.uniform(-1, 1), -d.below(30)), size = d.power_of_ten(-3, 0);
            const point at = along(along(along(a, t, e), r * (1 + step), out), t == 0 ? -step : t == 1 ? step : 0, e);
            c.second_radius = rounded_to<T>(size * d.power_of_ten(-3, 0));
            point way = cube(d, 1);
            if (product(way, out) < 0 && d.below(4) != 0) way = along({0, 0, 0}, -1, way);
            c.second = {round_to<T>(along(at, static_cast<double>(c.second_radius) * d.uniform(0, 1.2), out)), {}};
            c.second.b = round_to<T>(along(widened(c.second.a), size, way));
            break;
        }
        case round_family::discs_and_needles:
            discs_and_needles();
            if (d.below(2) == 0) move_beside(std::ldexp(1, -d.below(50)));
            break;
        case round_family::huge_and_small: {
            const double size = std::ldexp(1 + d.below(4), d.below(61)), height = std::ldexp(1 + d.below(4), d.below(61));
            const int kind = d.below(3), axis = d.below(3);
            const double z = kind == 1 ? 0 : -std::ldexp(height, -1), out = kind == 1 ? size * d.uniform(-1, 1) : size;
            point a{out, 0, kind == 2 ? 0 : z}, b{out, 0, (kind == 2 ? 0 : z) + height};
            const auto turned = [axis](const point& p) {
                return axis == 0 ? p : axis == 1 ? point{p.z, p.x, p.y} : point{p.y, p.z, p.x};
            };
            c.first = {round_to<T>(turned(a)), round_to<T>(turned(b))};
            c.first_radius = rounded_to<T>(size);
            const point at = cube(d, 1);
            c.second = {round_to<T>(at), round_to<T>(along(at, 1, cube(d, 1)))};
            c.second_radius = rounded_to<T>(d.power_of_ten(-2, 0));
            if (!is_capsule && d.below(2) == 0) {
                std::swap(c.first, c.second), std::swap(c.first_radius, c.second_radius);
            }
            break;
        }
        case round_family::no_radius:
            if (d.below(2) == 0) {
                general(1, {0, 0, 0});
                if (d.below(2) == 0) move_beside(0.1);
            } else {
                lattice(3);
            }
            if (const int which = d.below(3); which < 2)
                *number_of(c, 12 + which) = 0;
            else
                c.first_radius = c.second_radius = 0;
            break;
        case round_family::no_length:
            if (d.below(2) == 0) {
                general(1, {0, 0, 0});
                if (d.below(2) == 0) move_beside(0.1);
            } else {
                lattice(3);
            }
            if (const int which = d.below(3); which != 1)
                c.first.b = c.first.a;
            else
                c.second.b = c.second.a;
            if (d.below(8) == 0) c.second.b = c.second.a;
            break;
        case round_family::denormal:
            lattice(4);
            for (int i = 0; i < 14; ++i) *number_of(c, i) *= std::numeric_limits<T>::denorm_min();
            break;
        case round_family::largest:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = largest_finite<T> / 4 * static_cast<T>(d.below(9) - 4);
            c.first_radius = std::fabs(c.first_radius) / 4, c.second_radius = std::fabs(c.second_radius) / 4;
            break;
        case round_family::mixed_exponents:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = any_number<T>(d, 1 + d.below(60));
            c.first_radius = std::fabs(c.first_radius), c.second_radius = std::fabs(c.second_radius);
            break;
        case round_family::all_bit_patterns:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = any_pattern<T>(d);
            c.first_radius = std::fabs(c.first_radius), c.second_radius = std::fabs(c.second_radius);
            break;
    }
    return c;
}

}  // namespace abut::test
