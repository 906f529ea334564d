// SPDX-License-Identifier: MIT
#pragma once

// Pairs of points, segments, boxes, spheres, capsules and planes, families of them each built to break something, and the
// oracle that says whether they touch, in unbounded integers. A pair is a pure function of (seed, family, index).
//
// The oracle shares no formula with the library. Hulls of up to two points around which there is a radius are for
// within_pairs.hpp. The squared distance of a box from a point that moves along an axis is convex and piecewise quadratic:
// it is evaluated where each choice of active faces has its least, and where pieces end. Heights over planes are fractions.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"
#include "rational.hpp"
#include "shape_families.hpp"
#include "within_pairs.hpp"

namespace abut::test {

// --- the oracle
// ------------------------------------------------------------------------------------------------------------

namespace oracle {

/// The square of the distance of a box from an axis, which may be a point: whether it is at most that of r.
class box_and_axis {
public:
    template <scalar T>
    box_and_axis(const aabb<T>& box, const segment<T>& axis, const std::vector<double>& radii) {
        std::vector<double> values;
        const vec3<T> points[] = {box.lower, box.upper, axis.a, axis.b};  // nvcc takes no list in a loop of a template
        for (const vec3<T>& p : points) values.insert(values.end(), {p.x, p.y, p.z});
        values.insert(values.end(), radii.begin(), radii.end());
        const std::vector<integer> v = to_integers(values);
        for (std::size_t k = 0; k < 3; ++k) {
            lower_[k] = v[k], upper_[k] = v[3 + k], from_[k] = v[6 + k], along_[k] = v[9 + k] - v[6 + k];
        }
        for (std::size_t i = 12; i < v.size(); ++i) radius_ += v[i];
    }

    [[nodiscard]] bool near() const {
        if (near_at(0, 1) || near_at(1, 1)) return true;
        for (std::size_t k = 0; k < 3; ++k) {
            if (near_at(lower_[k] - from_[k], along_[k]) || near_at(upper_[k] - from_[k], along_[k])) return true;
        }
        for (int choice = 1; choice < 27; ++choice) {
            integer numerator = 0, denominator = 0;
            int digits = choice;
            for (std::size_t k = 0; k < 3; ++k, digits /= 3) {
                if (digits % 3 == 0) continue;
                const integer& face = digits % 3 == 1 ? lower_[k] : upper_[k];
                numerator += along_[k] * (face - from_[k]);
                denominator += along_[k] * along_[k];
            }
            if (near_at(numerator, denominator)) return true;
        }
        return false;
    }

private:
    /// Whether the axis has a point at this part of its length, and that is near.
    [[nodiscard]] bool near_at(integer part, integer whole) const {
        if (whole < 0) part = -part, whole = -whole;
        if (whole == 0 || part < 0 || part > whole) return false;
        integer square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const integer x = whole * from_[k] + part * along_[k], below = whole * lower_[k] - x,
                          above = x - whole * upper_[k];
            const integer& off = below > 0 ? below : above;
            if (off > 0) square += off * off;
        }
        return square <= radius_ * radius_ * whole * whole;
    }

    integer lower_[3], upper_[3], from_[3], along_[3], radius_ = 0;
};

/// A plane and points, around which there are radii that add up.
template <scalar T>
bool plane_and_points(const plane<T>& p, const std::vector<vec3<T>>& points, const std::vector<double>& radii) {
    std::vector<double> values;
    const auto add = [&](const vec3<T>& q) { values.insert(values.end(), {q.x, q.y, q.z}); };
    add(p.normal);
    values.push_back(static_cast<double>(p.offset));
    values.push_back(1);
    for (const vec3<T>& q : points) add(q);
    values.insert(values.end(), radii.begin(), radii.end());
    const std::vector<integer> v = to_integers(values);
    const integer offset = v[3] * v[4], square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    integer radius = 0;
    for (std::size_t i = 5 + 3 * points.size(); i < v.size(); ++i) radius += v[i];
    bool below = false, above = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t at = 5 + 3 * i;
        const integer height = v[at] * v[0] + v[at + 1] * v[1] + v[at + 2] * v[2] - offset;
        if (height * height <= radius * radius * square) return true;
        (height < 0 ? below : above) = true;
    }
    return below && above;
}

/// Whether two shapes are no farther apart than a distance.
///@{
template <class S, class U>
bool within_distance(const S& s, const U& t, double distance) {
    return exact_gap(s, t).compared_with(distance) <= 0;
}
template <scalar T, class S>
bool within_distance(const aabb<T>& box, const S& s, double distance) {
    const auto corners = corners_of(s);
    return box_and_axis(box, segment<T>{corners.front(), corners.back()},
                        {static_cast<double>(detail::radius_around_core(s)), distance})
        .near();
}
template <scalar T>
bool within_distance(const aabb<T>& a, const aabb<T>& b, double distance) {
    // A point against their difference.
    std::vector<double> values;
    const vec3<T> points[] = {a.lower, a.upper, b.lower, b.upper};
    for (const vec3<T>& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    values.push_back(distance);
    const std::vector<integer> v = to_integers(values);
    integer square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const integer above = v[6 + k] - v[3 + k], below = v[k] - v[9 + k];
        if (above > 0) square += above * above;
        if (below > 0) square += below * below;
    }
    return square <= v[12] * v[12];
}
template <scalar T>
bool within_distance(const aabb<T>& box, const triangle<T>& t, double distance) {
    return intersects(box, t) || exact_gap(box, t).compared_with(distance) <= 0;
}
template <scalar T, class S>
bool within_distance(const plane<T>& p, const S& s, double distance) {
    return plane_and_points(p, corners_of(s), {static_cast<double>(detail::radius_around_core(s)), distance});
}
template <scalar T>
bool within_distance(const plane<T>& p, const aabb<T>& box, double distance) {
    return plane_and_points(p, corners_of(box), {distance});
}
///@}

/// The least double that is enough, or infinity.
///@{
template <class S, class U>
double least_distance(const S& s, const U& t) {
    std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (within_distance(s, t, std::bit_cast<double>(middle))) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return std::bit_cast<double>(low);
}
template <class T>
double least_distance(const aabb<T>& s, const triangle<T>& t) {
    return intersects(s, t) ? 0 : exact_gap(s, t).least_double();
}
///@}

/// Two planes: some multiple of the one equation is the other, or normals are not parallel.
template <scalar T>
bool planes_meet(const plane<T>& p, const plane<T>& q) {
    std::vector<integer> v =
        to_integers<T>({p.normal.x, p.normal.y, p.normal.z, p.offset, q.normal.x, q.normal.y, q.normal.z, q.offset});
    const auto rank = [&](std::size_t columns) {
        int r = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            r = (v[i] != 0 || v[4 + i] != 0) && r == 0 ? 1 : r;
            for (std::size_t j = 0; j < i; ++j) r = v[i] * v[4 + j] != v[j] * v[4 + i] ? 2 : r;
        }
        return r;
    };
    return rank(3) == rank(4);
}

}  // namespace oracle

// --- the families
// ----------------------------------------------------------------------------------------------------------

/// What breaks what: as in shape_families.hpp. Near contact: in general position, with the least radius that lets the shapes
/// touch, or a step more or less; without a radius, planes and boxes that just reach the other shape. In the families of
/// contact both shapes have one point in common, on a lattice, and a plane between them; one number of one of them may then
/// be moved by a step.
enum class solid_family : int {
    random,
    offset_1e6,
    any_size,
    lattice_4,
    lattice_16,
    tenths_4,
    denormal,
    largest,
    mixed_exponents,
    all_bit_patterns,
    degenerate,
    contact,
    contact_far_off,
    contact_any_scale,
    near_contact,
};
inline constexpr int solid_family_count = 15;

/// On the host only.
inline const char* name_of(solid_family f) {
    constexpr const char* names[solid_family_count] = {"random",           "offset 1e6",         "any size",    "lattice 4",
                                                       "lattice 16",       "0.1 lattice 4",      "denormal",    "largest",
                                                       "mixed exponents",  "all bit patterns",   "degenerate",  "contact",
                                                       "contact, far off", "contact, any scale", "near contact"};
    return names[static_cast<int>(f)];
}

namespace construction {

/// A shape as its numbers, in the order of its members.
template <class S>
using numbers_of = std::array<scalar_type_of<S>, sizeof(S) / sizeof(scalar_type_of<S>)>;

/// Radii not negative, boxes not inside out.
template <class S>
S made_valid(const S& s) {
    using T = scalar_type_of<S>;
    S r = s;
    if constexpr (std::same_as<S, aabb<T>>) r = box_of(s.lower, s.upper);
    if constexpr (requires { r.radius; }) r.radius = s.radius < 0 ? -s.radius : s.radius;
    return r;
}

/// Of six coordinates, and one more number.
template <class S, scalar T>
S of_numbers(draws& d, const T (&v)[8]) {
    const vec3<T> p{v[0], v[1], v[2]}, q{v[3], v[4], v[5]};
    const int kind = d.below(4);
    const T r = kind == 0 ? T(0) : kind == 1 ? v[6] : kind == 2 ? v[6] / 4 : v[6] / 1024;
    if constexpr (std::same_as<S, vec3<T>>) {
        return p;
    } else if constexpr (std::same_as<S, segment<T>>) {
        return {p, q};
    } else if constexpr (std::same_as<S, triangle<T>>) {
        return {p, q, {v[6], v[7], v[kind]}};
    } else if constexpr (std::same_as<S, aabb<T>>) {
        return box_of(p, q);
    } else if constexpr (std::same_as<S, sphere<T>>) {
        return made_valid(S{p, r});
    } else if constexpr (std::same_as<S, capsule<T>>) {
        return made_valid(S{{p, q}, r});
    } else {
        // Through q, or nearly; or anywhere.
        const T through = rounded_to<T>(product(widened(p), widened(q)));
        return {p, kind > 1 && through - through == 0 ? through : v[7]};
    }
}

template <class S>
S any_solid(draws& d, solid_family f) {
    using T = scalar_type_of<S>;
    T v[8];
    const auto numbers = [&](shape_family same) { draw_numbers(d, same, v); };
    switch (f) {
        case solid_family::degenerate:
        case solid_family::lattice_4:
            numbers(shape_family::lattice_4);
            break;
        case solid_family::lattice_16:
            numbers(shape_family::lattice_16);
            break;
        case solid_family::tenths_4:
            numbers(shape_family::tenths_4);
            break;
        case solid_family::denormal:
            numbers(shape_family::denormal);
            break;
        case solid_family::largest:
            numbers(shape_family::largest);
            break;
        case solid_family::mixed_exponents:
            draw_mixed(d, v);
            break;
        case solid_family::all_bit_patterns:
            numbers(shape_family::all_bit_patterns);
            break;
        default:
            for (T& x : v) x = rounded_to<T>(d.uniform(-1, 1));
    }
    S s = of_numbers<S>(d, v);
    if (f == solid_family::degenerate) {
        // Without a length, a radius, an extent in some directions, or a normal.
        const int kind = d.below(4);
        if constexpr (std::same_as<S, segment<T>>) s.b = kind < 3 ? s.a : s.b;
        if constexpr (std::same_as<S, triangle<T>>) collapse(d, s);
        if constexpr (std::same_as<S, capsule<T>>) s.axis.b = kind < 2 ? s.axis.a : s.axis.b;
        if constexpr (requires { s.radius; }) s.radius = kind == 1 || kind == 2 ? T(0) : s.radius;
        if constexpr (std::same_as<S, aabb<T>>) {
            if (kind != 0) s.upper.x = s.lower.x;
            if (kind == 2) s.upper.y = s.lower.y;
            if (kind == 3) s.upper = s.lower;
        }
        if constexpr (std::same_as<S, plane<T>>) {
            if (kind < 3) s.normal = {T(0), T(0), T(0)};
            if (kind < 2) s.offset = T(0);
        }
    }
    return s;
}

/// One of the numbers moves by one step at most.
template <class S>
void nudge_number(draws& d, S& s) {
    auto numbers = std::bit_cast<numbers_of<S>>(s);
    auto& x = numbers[static_cast<std::size_t>(d.below(static_cast<int>(numbers.size())))];
    x = moved(x, d.below(3) - 1);
    s = made_valid(std::bit_cast<S>(numbers));
}

/// All lengths by a power of two; a plane's normal by none.
template <class S, scalar T>
S scaled_shape(const S& s, T by) {
    auto numbers = std::bit_cast<numbers_of<S>>(s);
    for (T& x : numbers) x = x * by;
    S r = std::bit_cast<S>(numbers);
    if constexpr (std::same_as<S, plane<T>>) r.normal = s.normal;
    return r;
}

/// The least number from 0 on at which it holds, or 8; it holds for all greater ones.
template <scalar T, class Holds>
T least_number(const Holds& holds) {
    using word = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    word low = 0, high = std::bit_cast<word>(T(8));
    while (low < high) {
        const word middle = low + (high - low) / 2;
        if (holds(std::bit_cast<T>(middle))) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return std::bit_cast<T>(low);
}

/// Changes the number of one of the shapes that decides.
template <class S, class U>
void bring_to_contact(draws& d, S& s, U& t) {
    using T = scalar_type_of<S>;
    [[maybe_unused]] const auto grow = [&](auto& number, T from) {
        number = least_number<T>([&](T x) {
            number = from + x;
            return oracle::within_distance(s, t, 0);
        });
        number = moved(from + number, d.below(3) - 1);
    };
    if constexpr (requires { t.radius; }) {
        grow(t.radius, T(0));
        t = made_valid(t);
    } else if constexpr (requires { t.offset; }) {
        t.offset = d.below(2) == 0 ? s.offset : t.offset;
    } else if constexpr (requires { s.offset; }) {
        const auto corners = corners_of(t);
        double least = 1e9;
        for (const auto& c : corners) least = std::fmin(least, product(widened(c), widened(s.normal)));
        s.offset = moved(rounded_to<T>(least), d.below(3) - 1);
    } else if constexpr (std::same_as<S, aabb<T>>) {
        grow(s.upper.x, s.lower.x);
        s = made_valid(s);
    }
}

}  // namespace construction

template <class S, class U>
struct solid_pair {
    S s;
    U t;
};

template <class S, class U>
solid_pair<S, U> make_solid_pair(std::uint64_t seed, solid_family f, std::uint64_t index) {
    namespace make = construction;
    using T = scalar_type_of<S>;
    draws d(seed, 8800 + static_cast<std::uint64_t>(f), index);
    if (f < solid_family::contact || f == solid_family::near_contact) {
        solid_pair<S, U> p{make::any_solid<S>(d, f), make::any_solid<U>(d, f)};
        const double size = f == solid_family::any_size ? d.power_of_ten(-30, 30) : 1;
        if (f == solid_family::any_size) {
            p = {make::scaled_shape(p.s, make::rounded_to<T>(size)), make::scaled_shape(p.t, make::rounded_to<T>(size))};
        }
        if (f == solid_family::offset_1e6) {
            const auto far_off = [](const auto& s) {
                auto numbers = std::bit_cast<make::numbers_of<std::remove_cvref_t<decltype(s)>>>(s);
                for (std::size_t i = 0; i < numbers.size() - numbers.size() % 3; ++i) {
                    numbers[i] = numbers[i] + static_cast<T>(i % 3 == 1 ? -1e6 : 1e6);
                }
                auto r = std::bit_cast<std::remove_cvref_t<decltype(s)>>(numbers);
                if constexpr (requires { r.offset; })
                    r = {s.normal, make::rounded_to<T>(1e6 * static_cast<double>(s.normal.x - s.normal.y + s.normal.z))};
                return r;
            };
            p = {far_off(p.s), far_off(p.t)};
        }
        if (f == solid_family::near_contact) make::bring_to_contact(d, p.s, p.t);
        return p;
    }
    const make::contact_frame frame = make::any_contact_frame(d, f == solid_family::contact_far_off ? 1 << 14 : 0);
    const auto above = make::touching_from<S>(d, frame, 1, 1 + d.below(3));
    solid_pair<S, U> p{above, make::touching_from<U>(d, frame, -1, 1 + d.below(3))};
    const int which = d.below(4);
    if (which == 1) make::nudge_number(d, p.s);
    if (which >= 2) make::nudge_number(d, p.t);
    if (f == solid_family::contact_any_scale) {
        const T by = make::any_power_of_two<T>(d);
        p = {make::scaled_shape(p.s, by), make::scaled_shape(p.t, by)};
    }
    return p;
}

/// Calls f(shape, shape) for the pair of two kinds of shapes.
template <class F>
struct solid_pair_caller {
    std::uint64_t seed;
    solid_family family;
    std::uint64_t index;
    const F& f;

    template <class S, class U>
    void call() const {
        const auto p = make_solid_pair<S, U>(seed, family, index);
        f(p.s, p.t);
    }
};

inline constexpr int solid_pair_kinds = 19;

/// Of all kinds of pairs that have no triangle, and no test of their own. On the host only.
template <scalar T, class F>
void with_solid_pair(int kind, std::uint64_t seed, solid_family family, std::uint64_t index, const F& f) {
    using point = vec3<T>;
    const solid_pair_caller<F> with{seed, family, index, f};
    switch (kind) {
        case 0: return with.template call<point, point>();
        case 1: return with.template call<point, segment<T>>();
        case 2: return with.template call<point, sphere<T>>();
        case 3: return with.template call<point, capsule<T>>();
        case 4: return with.template call<aabb<T>, point>();
        case 5: return with.template call<plane<T>, point>();
        case 6: return with.template call<segment<T>, segment<T>>();
        case 7: return with.template call<segment<T>, capsule<T>>();
        case 8: return with.template call<aabb<T>, segment<T>>();
        case 9: return with.template call<plane<T>, segment<T>>();
        case 10: return with.template call<sphere<T>, capsule<T>>();
        case 11: return with.template call<aabb<T>, sphere<T>>();
        case 12: return with.template call<plane<T>, sphere<T>>();
        case 13: return with.template call<capsule<T>, capsule<T>>();
        case 14: return with.template call<aabb<T>, capsule<T>>();
        case 15: return with.template call<plane<T>, capsule<T>>();
        case 16: return with.template call<aabb<T>, aabb<T>>();
        case 17: return with.template call<plane<T>, aabb<T>>();
        default: return with.template call<plane<T>, plane<T>>();
    }
}

inline constexpr int within_pair_kinds = 12;

/// Of all kinds of pairs that have a box or a plane, and a distance.
template <scalar T, class F>
void with_within_pair(int kind, std::uint64_t seed, solid_family family, std::uint64_t index, const F& f) {
    using point = vec3<T>;
    const solid_pair_caller<F> with{seed, family, index, f};
    switch (kind) {
        case 0: return with.template call<aabb<T>, triangle<T>>();
        case 1: return with.template call<plane<T>, triangle<T>>();
        case 2: return with.template call<aabb<T>, point>();
        case 3: return with.template call<plane<T>, point>();
        case 4: return with.template call<aabb<T>, segment<T>>();
        case 5: return with.template call<plane<T>, segment<T>>();
        case 6: return with.template call<aabb<T>, sphere<T>>();
        case 7: return with.template call<plane<T>, sphere<T>>();
        case 8: return with.template call<aabb<T>, capsule<T>>();
        case 9: return with.template call<plane<T>, capsule<T>>();
        case 10: return with.template call<aabb<T>, aabb<T>>();
        default: return with.template call<plane<T>, aabb<T>>();
    }
}

}  // namespace abut::test
