// SPDX-License-Identifier: MIT
#pragma once

// Options of rays and points on every policy and executor: what is left of all hits when a plain loop drops what a filter,
// an interval of times or a side leaves out. On a lattice of small integers times and sides are quotients and signs of
// integers.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"

namespace abut::test {

/// Keeps two of three, by both numbers.
struct some_rows {
    ABUT_HD bool operator()(std::uint32_t row, std::uint32_t id) const { return (row + 2 * id) % 3 != 0; }
};
struct some_rows_of_bodies {
    ABUT_HD bool operator()(std::uint32_t row, std::uint32_t body, std::uint32_t id) const {
        return (row + body + 2 * id) % 3 != 0;
    }
};

template <scalar T>
struct lattice_scene {
    std::vector<triangle<T>> triangles;
    std::vector<ray<T>> rays;
    std::vector<segment<T>> ends;

    lattice_scene(std::size_t triangle_count, std::size_t ray_count, unsigned seed) {
        draws d(seed, 7, 0);
        const auto point = [&](int n) {
            const int x = d.below(n), y = d.below(n);
            return vec3<T>{T(x), T(y), T(d.below(n))};
        };
        for (std::size_t i = 0; i < triangle_count; ++i) {
            const auto a = point(12), b = point(4), c = point(4);
            triangles.push_back({a, {a.x + b.x, a.y + b.y - 1, a.z + b.z}, {a.x + c.x - 1, a.y + c.y, a.z + c.z}});
        }
        for (std::size_t i = 0; i < ray_count; ++i) {
            const auto p = point(15), q = point(15);
            rays.push_back({p, {q.x - p.x, q.y - p.y, q.z - p.z}});
            ends.push_back({p, q});
        }
    }
};

/// Small integers: the sign of the direction along the normal, and the time at which the plane is met, over / under.
struct lattice_hit {
    std::int64_t along, over;
    template <scalar T>
    lattice_hit(const vec3<T>& origin, const vec3<T>& direction, const triangle<T>& t) : along(0), over(0) {
        const auto minus = [](const vec3<T>& p, const vec3<T>& q, std::int64_t(&to)[3]) {
            to[0] = static_cast<std::int64_t>(p.x - q.x), to[1] = static_cast<std::int64_t>(p.y - q.y),
            to[2] = static_cast<std::int64_t>(p.z - q.z);
        };
        std::int64_t f[3], g[3], away[3], d[3];
        minus(t.b, t.a, f), minus(t.c, t.a, g), minus(t.a, origin, away), minus(direction, {0, 0, 0}, d);
        const std::int64_t n[3] = {f[1] * g[2] - f[2] * g[1], f[2] * g[0] - f[0] * g[2], f[0] * g[1] - f[1] * g[0]};
        for (int k = 0; k < 3; ++k) along += n[k] * d[k], over += n[k] * away[k];
    }
    /// Whether the time is not before, or not after, a bound that is a multiple of 1/8.
    [[nodiscard]] bool is_from(double bound) const { return sign() * 8 * over >= sign() * along * eighths(bound); }
    [[nodiscard]] bool is_until(double bound) const { return sign() * 8 * over <= sign() * along * eighths(bound); }

private:
    [[nodiscard]] std::int64_t sign() const { return along < 0 ? -1 : 1; }
    static std::int64_t eighths(double bound) { return static_cast<std::int64_t>(std::min(8 * bound, 1e9)); }
};

/// What options keep of a hit at a time that is known to be one.
template <scalar T, class Filter>
bool is_kept(const vec3<T>& origin, const vec3<T>& direction, const triangle<T>& t, double time, std::uint32_t row,
             std::uint32_t id, const raycast_options<Filter>& options) {
    const lattice_hit h(origin, direction, t);
    if (!options.filter(row, id)) return false;
    if (options.side != ray_side::any && (h.along == 0 || (h.along < 0) != (options.side == ray_side::front))) return false;
    if (h.along == 0) return time >= options.least_t && time <= options.most_t;
    return h.is_from(options.least_t) && h.is_until(options.most_t);
}

/// All three queries, and the detailed one, of one line set. `at(ray)` is its origin and direction.
template <class On, class X, class Lines, scalar T, class Filter>
void check_options(const On& on, const X& x, const Lines& lines, const std::vector<triangle<T>>& triangles,
                   const raycast_options<Filter>& options, std::size_t& kept, std::size_t& dropped) {
    const auto all = to_host(raycast_all(serial{}, triangle_soup<T>(triangles), lines));
    std::vector<hit_of_ray<T>> expected;
    for (const auto& hit : all) {
        const auto line = lines.view()[hit.ray];
        const detail::line_of<T> l(line);
        const double time = detail::hit_time<exact>(line, triangles[hit.id]);
        const bool is = is_kept(l.origin, l.direction(), triangles[hit.id], time, hit.ray, hit.id, options);
        if (is) expected.push_back(hit);
        ++(is ? kept : dropped);
    }
    CHECK((to_host(raycast_all(on, x, lines, options)) == expected));
    const auto first = to_host(raycast(on, x, lines, options));
    const auto exactly = to_host(raycast<exact>(on, x, lines, options));
    const auto any = to_host(raycast_any(on, x, lines, options));
    const auto detailed = to_host(raycast_detailed(on, x, lines, options));
    REQUIRE((first.size() == lines.size() && any.size() == lines.size() && detailed.size() == lines.size()));
    CHECK(first == exactly);
    std::size_t wrong = 0, at = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const bool is = at < expected.size() && expected[at].ray == k;
        const ray_hit<T> hit = is ? ray_hit<T>{expected[at].id, expected[at].t} : ray_hit<T>{no_id, infinity<T>};
        wrong += first[k] != hit || any[k] != (is ? 1 : 0) || detailed[k].hit != hit;
        while (at < expected.size() && expected[at].ray == k) ++at;
        const auto& [of, side, w] = detailed[k];
        if (!is) {
            wrong += side != ray_side::any || w != vec3<T>{0, 0, 0};
            continue;
        }
        const detail::line_of<T> l(lines.view()[k]);
        const triangle<T>& t = triangles[hit.id];
        const std::int64_t along = lattice_hit(l.origin, l.direction(), t).along;
        wrong += side != (along < 0 ? ray_side::front : along > 0 ? ray_side::back : ray_side::any);
        wrong += !(w.x >= 0 && w.y >= 0 && w.z >= 0) || std::abs(static_cast<double>(w.x + w.y + w.z) - 1) > 1e-6;
        const auto apart = [&, w = w, hit = hit](T vec3<T>::*c) {
            return std::abs(
                static_cast<double>(w.x * t.a.*c + w.y * t.b.*c + w.z * t.c.*c - (l.origin.*c + hit.t * l.direction().*c)));
        };
        wrong += apart(&vec3<T>::x) + apart(&vec3<T>::y) + apart(&vec3<T>::z) > (std::same_as<T, float> ? 1e-4 : 1e-12);
    }
    CHECK(wrong == 0);
}

/// By all options, of an index that make(triangles) makes.
template <scalar T, class On, class Make>
void check_ray_options(const On& on, const Make& make) {
    const lattice_scene<T> scene(300, 150, 11);
    const auto x = make(triangle_soup<T>(scene.triangles));
    const rays<T> rows(scene.rays);
    const segments<T> ends(scene.ends);
    std::size_t kept = 0, dropped = 0;
    const auto check = [&](const auto& options) {
        check_options(on, x, rows, scene.triangles, options, kept, dropped);
        check_options(on, x, ends, scene.triangles, options, kept, dropped);
    };
    check(raycast_options<>{});
    CHECK((kept > 500 && dropped == 0));
    for (const raycast_options<>& one :
         {raycast_options<>{.least_t = 0.5}, raycast_options<>{.most_t = 0.5},
          raycast_options<>{.least_t = 0.25, .most_t = 0.75}, raycast_options<>{.side = ray_side::front},
          raycast_options<>{.most_t = 1, .side = ray_side::back}, raycast_options<>{.least_t = 0.5, .most_t = 0.5},
          raycast_options<>{.least_t = 1, .most_t = 0.5}}) {
        CAPTURE(one.least_t, one.most_t, static_cast<int>(one.side));
        check(one);
    }
    CHECK((kept > 1'500 && dropped > 1'500));
    if constexpr (requires { to_host(raycast(on, x, rows, raycast_options<some_rows>{})); }) {
        check(raycast_options<some_rows>{.filter = {}});
        check(raycast_options<some_rows>{.filter = {}, .most_t = 0.75, .side = ray_side::front});
    }
}

/// A filter of points.
template <scalar T, class On, class Make>
void check_nearest_options(const On& on, const Make& make) {
    const lattice_scene<T> scene(120, 80, 13);
    const auto x = make(triangle_soup<T>(scene.triangles));
    std::vector<vec3<T>> from;
    for (const auto& r : scene.rays) from.push_back(r.origin);
    const std::size_t count = 4;
    const nearest_options<some_rows> options{.count = count, .filter = {}};
    const auto found = to_host(nearest(on, x, from, options));
    const auto one = to_host(nearest(on, x, from, nearest_options<some_rows>{}));
    REQUIRE((found.size() == count * from.size() && one.size() == from.size()));
    std::size_t wrong = 0, changed = 0;
    for (std::uint32_t k = 0; k < from.size(); ++k) {
        struct measured {
            double square;
            std::uint32_t id;
            bool operator<(const measured& other) const {
                return square < other.square || (square == other.square && id < other.id);
            }
        };
        std::vector<measured> all;
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const double square = detail::squared_distance(from[k], scene.triangles[i], detail::length_unit<T>{});
            if (some_rows{}(k, i)) all.push_back({square, i});
        }
        std::sort(all.begin(), all.end());
        for (std::size_t j = 0; j < count; ++j) wrong += found[count * k + j].id != all[j].id;
        wrong += one[k].id != all[0].id || one[k] != found[count * k];
        changed += to_host(nearest(serial{}, triangle_soup<T>(scene.triangles), from[k]))[0].id != one[k].id;
    }
    CHECK(wrong == 0);
    CHECK(changed > 5);
    CHECK((to_host(nearest(on, x, from, {.count = 3})) == to_host(nearest(on, x, from, std::size_t{3}))));
}

}  // namespace abut::test
