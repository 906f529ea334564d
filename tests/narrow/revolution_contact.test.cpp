// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

// What a contact says is computed anew in 300 bits by farthest points along directions. That no shorter move separates is
// tried: by many directions, from the best of which a search goes down. It knows nothing of which directions matter.

namespace abut::test {

namespace {

constexpr std::uint64_t contact_seed = 20261127;

// --- overlaps in double, in a unit, for many directions
// ---------------------------------------------------------------------

using plain_point = vec3<double>;

struct plain_overlap {
    plain_point first, d;  ///< of the solid; d of length 1
    double height, radius;
    bool is_cone, is_ball;
    std::vector<plain_point> corners;
    double around;

    [[nodiscard]] double operator()(const plain_point& n) const {
        const plain_point sine = cross(n, d);
        const double along = dot(n, d), reach = radius * (is_ball ? 1 : std::sqrt(dot(sine, sine)));
        const double lowest = std::min(is_cone && !is_ball ? 0 : -reach, along * height - reach);
        double upper = -1e300;
        for (const plain_point& p : corners) upper = std::max(upper, dot(n, p));
        return upper + around - (dot(n, first) + lowest);
    }
};

plain_point unit_of(const plain_point& v) {
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

/// The least that a search finds.
double least_overlap_found(const plain_overlap& of, const std::vector<plain_point>& more) {
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
    const wide_hull h = hull_of(t);
    wide size = h.radius + solid.radius;
    for (const wide_point& p : h.corners) size = std::max(size, solid.farthest_from(p));
    if (!(size > 0)) return c.depth == 0 ? nullptr : "points are deep in each other";
    const auto plain = [&](const wide_point& p, const wide& unit) {
        return plain_point{static_cast<double>(p.x / unit), static_cast<double>(p.y / unit),
                           static_cast<double>(p.z / unit)};
    };
    const wide height = sqrt(solid.dd);
    plain_overlap of{{0, 0, 0},
                     {0, 0, 1},
                     static_cast<double>(height / size),
                     static_cast<double>(solid.radius / size),
                     solid.is_cone,
                     solid.dd == 0,
                     {},
                     static_cast<double>(h.radius / size)};
    if (solid.dd != 0) of.d = plain(solid.d, height);
    for (const wide_point& p : h.corners) of.corners.push_back(plain(p - solid.first, size));
    std::vector<plain_point> more{of.d};
    for (const plain_point& p : of.corners) {
        for (const plain_point& q : of.corners) {
            const plain_point e = q - p;
            more.push_back(cross(e, of.d));
            for (const plain_point& r : of.corners) more.push_back(cross(e, r - p));
            if (of.corners.size() > 4) break;
        }
    }
    if (of.corners.size() > 4) more.insert(more.end(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    ++sum.searched;
    const wide least = size * wide(least_overlap_found(of, more));
    const wide shorter = wide(c.depth) - std::max<wide>(least, wide(0));
    const wide allowed = bound + size * wide(0x1p-50);
    if (c.depth < largest_finite<T>) sum.excess = std::max(sum.excess, static_cast<double>(shorter / allowed));
    return shorter > allowed && c.depth < largest_finite<T> ? "a shorter move separates them" : nullptr;
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
        gap = std::max(gap, distance_from(x, t));
        const wide overlap = (hull_of(t).upper(n) - dot(n, solid.farthest(opposite))) / length_of(n);
        const wide off = abs(wide(c.depth) - std::max<wide>(0, std::min<wide>(overlap, wide(largest_finite<T>))));
        sum.overlap = std::max(sum.overlap, static_cast<double>(off / bound));
        if (off > bound) return "depth is not the overlap along the normal";
        // The other is moved: where the axis's ends are rounded, it may turn.
        const U moved =
            moved_by(t, vec3<T>{-c.normal.x, -c.normal.y, -c.normal.z}, static_cast<T>(c.depth + contact_bound(s, t)));
        if (c.depth < largest_finite<T> && is_finite_shape(moved)) {
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
void check(const std::string& name, std::uint64_t i, const S& s, const U& t, contact_figures& sum) {
    if (!is_valid(s) || !is_valid(t)) return;
    if (const char* const wrong = wrong_with_contact(s, t, i % 4 == 0, sum)) {
        CAPTURE(name, i);
        FAIL_CHECK(wrong);
    }
}

void check_figures(const char* name, const contact_figures& sum) {
    std::printf("contacts, %s: %llu, %llu searched; of contact_bound, gaps take %.3f, overlaps %.3f, depths %.3f\n", name,
                static_cast<unsigned long long>(sum.touching), static_cast<unsigned long long>(sum.searched), sum.gap,
                sum.overlap, sum.excess);
    CHECK(sum.moved * 10 > sum.touching * 8);
}

/// Deep in each other, or hardly.
template <class Solid>
revolution_case<scalar_type_of<Solid>> through(std::uint64_t i) {
    using namespace construction;
    using T = scalar_type_of<Solid>;
    draws d(contact_seed, std::same_as<Solid, cone<T>> ? 82 : 81, i);
    const point a = cube(d, 1), axis = unit(cube(d, 1));
    const double height = d.below(4) == 0 ? d.power_of_ten(-3, 0) : d.uniform(0.5, 2),
                 radius = d.below(4) == 0 ? d.power_of_ten(-3, 0) : d.uniform(0.2, 1), size = d.power_of_ten(-1, 1);
    const point at = along(along(a, d.uniform(-0.1, 1.1) * height, axis), 1.2 * radius, cube(d, 1));
    revolution_case<T> c{};
    c.axis = {round_to<T>(a), round_to<T>(along(a, height, axis))};
    c.radius = rounded_to<T>(radius);
    for (auto& p : c.corner) p = round_to<T>(along(at, size, cube(d, 1)));
    return c;
}

}  // namespace

TEMPLATE_TEST_CASE("contacts of cylinders and cones are what they say, in each family", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::printf("contacts: seed %llu\n", static_cast<unsigned long long>(contact_seed));
    std::array<contact_figures, kinds_beside.size()> sums;
    for (int i = 0; i < revolution_family_count + 3; ++i) {
        const bool is_thin = i == revolution_family_count, is_parallel = i == revolution_family_count + 1,
                   is_through = i == revolution_family_count + 2;
        const std::string name = is_thin       ? "thin"
                                 : is_parallel ? "nearly parallel"
                                 : is_through  ? "through"
                                               : name_of(static_cast<revolution_family>(i));
        for (std::uint64_t k = 0; k < some_samples(is_through ? 25 : 125); ++k) {
            const auto c = is_thin       ? over_needle<TestType>(k)
                           : is_parallel ? nearly_parallel<TestType>(k)
                           : is_through
                               ? through<TestType>(k)
                               : make_revolution_case<T>(contact_seed, static_cast<revolution_family>(i), k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            each_beside(c, k, is_cone, [&](std::size_t kind, const auto& t) { check(name, k, s, t, sums[kind]); });
        }
    }
    for (std::size_t kind = 0; kind < sums.size(); ++kind) {
        check_figures(kinds_beside[kind], sums[kind]);
        CHECK(sums[kind].touching > 20);
    }
}

TEST_CASE("contacts of cylinders and cones: by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr cone<double> tip{{0, 0, 4}, {0, 0, 0}, 3};
    static_assert(contact_of(rod, vec{0.5, 0, 1.75}) == contact<double>{0, 0, {0.5, 0, 1.75}, {0, 0, -1}, 0.25});
    static_assert(contact_of(vec{0.875, 0, 1}, rod) == contact<double>{0, 0, {0.875, 0, 1}, {1, 0, 0}, 0.125});
    static_assert(contact_of(rod, segment<double>{{0.75, -5, 1}, {0.75, 5, 1}})->depth == 0.25);
    static_assert(contact_of(rod, triangle<double>{{-5, -5, 1.75}, {5, -5, 1.75}, {0, 9, 1.75}})->depth == 0.25);
    static_assert(contact_of(aabb<double>{{-5, -5, -1}, {5, 5, 0.5}}, rod)->normal == vec{0, 0, -1});
    static_assert(contact_of(rod, sphere<double>{{2, 0, 1}, 1.5}) == contact<double>{0, 0, {1, 0, 1}, {-1, 0, 0}, 0.5});
    static_assert(contact_of(rod, sphere<double>{{0, 0, 1.75}, 1})->depth == 1.25);
    static_assert(contact_of(plane<double>{{0, 0, 2}, 3}, rod)->depth == 0.5);
    static_assert(contact_of(rod, plane<double>{{0, 0, 0}, 0}) ==
                  contact<double>{0, 0, {0, 0, 2}, {0, 0, 1}, std::numeric_limits<double>::max()});
    static_assert(contact_of(tip, vec{0, 0, 0.25})->depth == 0.25);
    static_assert(contact_of(tip, plane<double>{{0, 0, 1}, 3.5})->depth == 0.5);
    static_assert(!contact_of(tip, vec{3, 0, 1}));
    CHECK(contact_of(tip, vec{1, 0, 2.5})->depth == Approx(0.1));  // across the side
    // Without length they are balls.
    static_assert(contact_of(cylinder<double>{{{0, 0, 0}, {0, 0, 0}}, 2}, vec{0, 0, 1}) ==
                  contact<double>{0, 0, {0, 0, 1}, {0, 0, -1}, 1});
    static_assert(contact_of(aabb<double>{{1, -1, -1}, {4, 1, 1}}, cone<double>{{0, 0, 0}, {0, 0, 0}, 2})->depth == 1);
    static_assert(detail::contact_pair<cylinder<float>, triangle<float>> &&
                  detail::contact_pair<cone<double>, plane<double>>);
    static_assert(!detail::contact_pair<cylinder<float>, cone<float>> && !detail::contact_pair<cone<float>, capsule<float>>);
}

}  // namespace abut::test
