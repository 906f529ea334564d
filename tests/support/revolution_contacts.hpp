// SPDX-License-Identifier: MIT
#pragma once

// What a contact of a cylinder or a cone says is computed anew in 300 bits by farthest points along directions. That no
// shorter move separates is tried: by many directions, from the best of which a search goes down. It knows nothing of which
// directions matter.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include <abut/narrow/contact.hpp>

#include "catch.hpp"
#include "contact_oracles.hpp"
#include "revolution_solid.hpp"

namespace abut::test {

// --- overlaps in double, in a unit, for many directions -------------------------------------------------------------------

using plain_point = vec3<double>;

/// A solid of revolution, whose axis `d` is of length 1, or corners and what is around them.
struct plain_body {
    plain_point first{}, d{};
    double height = 0, radius = 0;
    bool is_cone = false, is_ball = false;
    std::vector<plain_point> corners{};  ///< if there are any
    double around = 0;

    /// How far it reaches along n, of length 1.
    [[nodiscard]] double reach(const plain_point& n) const {
        if (!corners.empty()) {
            double upper = -1e300;
            for (const plain_point& p : corners) upper = std::max(upper, dot(n, p));
            return upper + around;
        }
        const plain_point sine = cross(n, d);
        const double rim = radius * (is_ball ? 1 : std::sqrt(dot(sine, sine))), last = dot(n, d) * height + rim;
        return dot(n, first) + std::max(is_cone && !is_ball ? 0 : rim, last);
    }
};

/// How far the first has to go.
struct plain_overlap {
    plain_body goes, stays;
    [[nodiscard]] double operator()(const plain_point& n) const { return stays.reach(n) + goes.reach({-n.x, -n.y, -n.z}); }
};

inline plain_point unit_of(const plain_point& v) {
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

/// The least that a search finds.
inline double least_overlap_found(const plain_overlap& of, const std::vector<plain_point>& more) {
    std::vector<std::pair<double, plain_point>> all;
    constexpr int count = 600;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), turn = i * 2.399963229728653;
        const plain_point n{r * std::cos(turn), r * std::sin(turn), z};
        all.emplace_back(of(n), n);
    }
    for (const plain_point& v : more) {
        if (!(dot(v, v) > 0)) continue;
        const plain_point n = unit_of(v), back{-n.x, -n.y, -n.z};
        all.emplace_back(of(n), n);
        all.emplace_back(of(back), back);
    }
    const std::size_t starts = std::min<std::size_t>(12, all.size());
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(starts), all.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    double least = all[0].first;
    for (std::size_t k = 0; k < starts; ++k) {
        auto [value, n] = all[k];
        double turn = 0.7;
        double step = 0.1;
        for (int tries = 0; tries < 2000 && step > 1e-10; ++tries) {
            const plain_point u = unit_of(cross(n, std::abs(n.x) < 0.6 ? plain_point{1, 0, 0} : plain_point{0, 1, 0})),
                              v = cross(n, u);
            bool better = false;
            turn += 0.37;
            for (int i = 0; i < 8; ++i) {
                const double c = step * std::cos(turn + i * 0.785398), s = step * std::sin(turn + i * 0.785398);
                const plain_point m = unit_of({n.x + c * u.x + s * v.x, n.y + c * u.y + s * v.y, n.z + c * u.z + s * v.z});
                const double there = of(m);
                if (there < value) value = there, n = m, better = true;
            }
            step *= better ? 1.2 : 0.5;
        }
        least = std::min(least, value);
    }
    return least;
}

// --- what has to hold -----------------------------------------------------------------------------------------------------

template <class S>
auto wide_of(const S& s) {
    if constexpr (detail::solid_of_revolution<S>) {
        return in_bits(s);
    } else {
        return hull_of(s);
    }
}
inline wide reach_of(const wide_solid& s, const wide_point& n) { return dot(n, s.farthest(n)); }
inline wide reach_of(const wide_hull& h, const wide_point& n) { return h.upper(n); }
/// From x to the farthest point, or to the farthest of a core and its radius.
inline wide size_from(const wide_point& x, const wide_solid& s) { return s.farthest_from(x) + s.radius; }
inline wide size_from(const wide_point& x, const wide_hull& h) {
    wide size = 0;
    for (const wide_point& p : h.corners) size = std::max<wide>(size, length_of(p - x));
    return size + h.radius;
}
template <class S>
wide gap_from(const wide_point& x, const S& s) {
    if constexpr (detail::solid_of_revolution<S>) {
        return distance_from_solid(x, in_bits(s));
    } else {
        return distance_from(x, s);
    }
}

/// As seen from a point, in a unit.
struct plain_frame {
    wide_point origin;
    wide unit;

    [[nodiscard]] double of(const wide& x) const { return static_cast<double>(x / unit); }
    [[nodiscard]] plain_point of(const wide_point& p) const {
        return {of(p.x - origin.x), of(p.y - origin.y), of(p.z - origin.z)};
    }
    [[nodiscard]] plain_body of(const wide_solid& s) const {
        plain_body b{of(s.first), {0, 0, 1}, 0, of(s.radius), s.is_cone, s.dd == 0};
        if (s.dd == 0) return b;
        const wide height = sqrt(s.dd);
        b.height = of(height);
        b.d = {static_cast<double>(s.d.x / height), static_cast<double>(s.d.y / height),
               static_cast<double>(s.d.z / height)};
        return b;
    }
    [[nodiscard]] plain_body of(const wide_hull& h) const {
        plain_body b{};
        for (const wide_point& p : h.corners) b.corners.push_back(of(p));
        b.around = of(h.radius);
        return b;
    }
};

template <scalar T>
cylinder<T> moved_by(const cylinder<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.axis, n, by), s.radius};
}
template <scalar T>
cone<T> moved_by(const cone<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.apex, n, by), moved_by(s.base_center, n, by), s.radius};
}

struct contact_figures {
    std::uint64_t touching = 0, moved = 0, searched = 0;
    double gap = 0, overlap = 0, excess = 0;

    contact_figures& operator+=(const contact_figures& t) {
        touching += t.touching, moved += t.moved, searched += t.searched;
        gap = std::max(gap, t.gap), overlap = std::max(overlap, t.overlap), excess = std::max(excess, t.excess);
        return *this;
    }
};

/// Shorter moves than the depth, as a share of the bound.
template <class S, class U, scalar T>
const char* wrong_with_least(const S& s, const U& t, const contact<T>& c, const wide& bound, contact_figures& sum) {
    const wide_solid solid = in_bits(s);
    const auto other = wide_of(t);
    const wide size = solid.radius + sqrt(solid.dd) + size_from(solid.first, other);
    if (!(size > 0)) return c.depth == 0 ? nullptr : "points are deep in each other";
    const plain_frame frame{solid.first, size};
    const plain_overlap of{frame.of(solid), frame.of(other)};
    std::vector<plain_point> more{of.goes.d};
    if (of.stays.corners.empty()) more.insert(more.end(), {of.stays.d, cross(of.goes.d, of.stays.d)});
    const std::vector<plain_point>& corners = of.stays.corners;
    for (const plain_point& p : corners) {
        for (const plain_point& q : corners) {
            const plain_point e = q - p;
            more.push_back(cross(e, of.goes.d));
            for (const plain_point& r : corners) more.push_back(cross(e, r - p));
            if (corners.size() > 4) break;
        }
    }
    if (corners.size() > 4) more.insert(more.end(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    ++sum.searched;
    const wide least = size * wide(least_overlap_found(of, more));
    const wide shorter = wide(c.depth) - std::max<wide>(least, wide(0));
    const wide allowed = bound + size * wide(0x1p-50);
    if (c.depth < largest_finite<T>) sum.excess = std::max(sum.excess, static_cast<double>(shorter / allowed));
    return shorter > allowed && c.depth < largest_finite<T> ? "a shorter move separates them" : nullptr;
}

/// Whether rounding of the ends turns a solid by so little that its rims hardly move.
template <class S>
bool keeps_its_axis(const S& s) {
    if constexpr (detail::solid_of_revolution<S>) {
        const wide_solid solid = in_bits(s);
        return solid.dd == 0 || solid.radius * solid.radius <= 64 * solid.dd;
    } else {
        return true;
    }
}

template <class S, class U>
const char* wrong_with_contact(const S& s, const U& t, bool search, contact_figures& sum) {
    using T = scalar_type_of<S>;
    const auto found = contact_of(s, t);
    const auto back = contact_of(t, s);
    const bool touch = intersects<exact>(s, t);
    if (found.has_value() != touch || back.has_value() != touch) return "found is not what touches";
    if (!touch) return nullptr;
    const contact<T>& c = *found;
    if (back.value() != detail::reversed(c)) return "the other order is not the reverse";
    if (contact_of<exact>(s, t) != found) return "it is another one where it was asked first whether they touch";
    ++sum.touching;
    for (const T x : {c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z, c.depth}) {
        if (!detail::is_finite(x)) return "a number is not finite";
    }
    if (c.a != 0 || c.b != 0) return "ids are not 0";
    if (c.depth < 0) return "depth is negative";
    const wide bound = wide(contact_bound(s, t));
    const wide_point x = widest(c.point), n = widest(c.normal), opposite{-n.x, -n.y, -n.z};
    if (abs(length_of(n) - 1) > 2 * wide(unit_roundoff<T>)) return "the normal is no unit vector";
    const wide_solid solid = in_bits(s);
    wide gap = distance_from_solid(x, solid);
    if constexpr (std::same_as<U, plane<T>>) {
        const wide_point given = widest(t.normal);
        if (length_of(given) == 0) return c.depth == largest_finite<T> ? nullptr : "not what is said of a plane of normal 0";
        const auto height = [&](const wide_point& p) -> wide { return (dot(given, p) - wide(t.offset)) / length_of(given); };
        gap = std::max<wide>(gap, abs(height(x)));
        const wide_point down{-given.x, -given.y, -given.z};
        const wide least = std::min<wide>(height(solid.farthest(given)), -height(solid.farthest(down)));
        const wide off = abs(wide(c.depth) - std::min<wide>(least, wide(largest_finite<T>)));
        sum.overlap = std::max(sum.overlap, static_cast<double>(off / bound));
        if (off > bound) return "depth is not that of the shorter move";
        ++sum.moved;
    } else {
        gap = std::max(gap, gap_from(x, t));
        const wide overlap = (reach_of(wide_of(t), n) + reach_of(solid, opposite)) / length_of(n);
        const wide off = abs(wide(c.depth) - std::max<wide>(0, std::min<wide>(overlap, wide(largest_finite<T>))));
        sum.overlap = std::max(sum.overlap, static_cast<double>(off / bound));
        if (off > bound) return "depth is not the overlap along the normal";
        // The other is moved: where an axis's ends are rounded, it may turn.
        const U moved =
            moved_by(t, vec3<T>{-c.normal.x, -c.normal.y, -c.normal.z}, static_cast<T>(c.depth + contact_bound(s, t)));
        if (c.depth < largest_finite<T> && is_finite_shape(moved) && keeps_its_axis(t)) {
            ++sum.moved;
            if (intersects<exact>(s, moved)) return "the moved pair is not disjoint";
        }
        if (search) {
            if (const char* const wrong = wrong_with_least(s, t, c, bound, sum)) return wrong;
        }
    }
    if (detail::contact_math::magnitude_of(c.point) == largest_finite<T>)
        return nullptr;  // it may lie where T has no number
    sum.gap = std::max(sum.gap, static_cast<double>(gap / bound));
    return gap > bound ? "the point is off the shapes" : nullptr;
}

template <class S, class U>
void check_contact(const std::string& name, std::uint64_t i, const S& s, const U& t, contact_figures& sum) {
    if (!is_valid(s) || !is_valid(t)) return;
    if (const char* const wrong = wrong_with_contact(s, t, i % 4 == 0, sum)) {
        CAPTURE(name, i);
        FAIL_CHECK(wrong);
    }
}

inline void check_figures(const char* name, const contact_figures& sum) {
    std::printf("contacts, %s: %llu, %llu searched; of contact_bound, gaps take %.3f, overlaps %.3f, depths %.3f\n", name,
                static_cast<unsigned long long>(sum.touching), static_cast<unsigned long long>(sum.searched), sum.gap,
                sum.overlap, sum.excess);
}

}  // namespace abut::test
