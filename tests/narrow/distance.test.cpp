// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/families.hpp"
#include "support/other_shapes.hpp"
#include "support/plain_pairs.hpp"
#include "support/samples.hpp"
#include "support/solid_pairs.hpp"
#include "support/triangle_families.hpp"

// The oracle: the least squared distance of two hulls, in 300 bits, by the supports of the weights. For each set of corners
// of one and of the other it solves the normal equations of the free weights, and keeps those that are positive. Hulls that
// do not meet need four corners at most. It shares no formula with the library.

namespace abut::test {

template <scalar T>
wide distance_from(const wide_point& x, const plane<T>& s) {
    return abs(dot(widest(s.normal), x) - wide(s.offset)) / length_of(widest(s.normal));
}

namespace {

constexpr std::uint64_t distance_seed = 20261124;

wide squared_distance(const wide_hull& a, const wide_hull& b) {
    wide least = -1;
    const auto offer = [&](const wide_point& way) {
        const wide square = dot(way, way);
        if (least < 0 || square < least) least = square;
    };
    // The way from x to y, free along one or two edges.
    const auto along_one = [&](const wide_point& way, const wide_point& e) {
        const wide ee = dot(e, e), s = -dot(way, e);
        if (s > 0 && s < ee) offer(way + (s / ee) * e);
    };
    const auto along_two = [&](const wide_point& way, const wide_point& e, const wide_point& f, bool one_face) {
        const wide ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), we = -dot(way, e), wf = -dot(way, f);
        const wide d = ee * ff - ef * ef, s = we * ff - wf * ef, t = wf * ee - we * ef;
        if (!(d > 0) || !(s > 0) || !(t > 0) || (one_face ? s + t > d : s > d || t > d)) return;
        offer(way + (s / d) * e + (t / d) * f);
    };
    const std::size_t n = a.corners.size(), m = b.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < m; ++j) {
            const wide_point way = b.corners[j] - a.corners[i];
            offer(way);
            for (std::size_t k = i + 1; k < n; ++k) {
                const wide_point e = a.corners[i] - a.corners[k];
                along_one(way, e);
                for (std::size_t l = k + 1; l < n; ++l) along_two(way, e, a.corners[i] - a.corners[l], true);
                for (std::size_t l = j + 1; l < m; ++l) along_two(way, e, b.corners[l] - b.corners[j], false);
            }
            for (std::size_t k = j + 1; k < m; ++k) {
                const wide_point e = b.corners[k] - b.corners[j];
                along_one(way, e);
                for (std::size_t l = k + 1; l < m; ++l) along_two(way, e, b.corners[l] - b.corners[j], true);
            }
        }
    }
    return least;
}

/// What is known of two shapes: their distance if they do not touch, and that of their farthest points.
struct wide_gap {
    wide distance, farthest;
};
template <class S, class U>
wide_gap exact_gap(const S& s, const U& t) {
    const wide_hull a = hull_of(s), b = hull_of(t);
    wide far = 0;
    for (const auto& p : a.corners) {
        for (const auto& q : b.corners) far = std::max(far, length_of(p - q));
    }
    return {sqrt(squared_distance(a, b)) - a.radius - b.radius, far + a.radius + b.radius};
}
template <scalar T, class U>
wide_gap exact_gap(const plane<T>& s, const U& t) {
    const wide_point n = widest(s.normal);
    const wide_hull h = hull_of(t);
    wide least = -1, far = 0;
    for (const wide_point& p : h.corners) {
        const wide height = abs(dot(n, p) - wide(s.offset)) / length_of(n) - h.radius;
        if (least < 0 || height < least) least = height;
        far = std::max(far, length_of(p) + h.radius);
    }
    return {least, far + least};
}
template <scalar T>
wide_gap exact_gap(const aabb<T>& s, const aabb<T>& t) {
    const wide_point a = widest(s.lower) - widest(t.upper), b = widest(t.lower) - widest(s.upper);
    const auto beyond = [](const wide& x, const wide& y) -> wide { return std::max<wide>({x, y, wide(0)}); };
    const auto extent = [](const wide& x, const wide& y) -> wide { return std::max<wide>(abs(x), abs(y)); };
    return {length_of({beyond(a.x, b.x), beyond(a.y, b.y), beyond(a.z, b.z)}),
            length_of({extent(a.x, b.x), extent(a.y, b.y), extent(a.z, b.z)})};
}

/// Worst figures, in units of 2^-53 of the distance of the farthest points.
struct distance_tally {
    std::uint64_t pairs = 0, touching = 0;
    double distance = 0, point = 0;

    distance_tally& operator+=(const distance_tally& t) {
        pairs += t.pairs;
        touching += t.touching;
        distance = std::max(distance, t.distance);
        point = std::max(point, t.point);
        return *this;
    }
};

constexpr double most_steps = 16;

template <class S, class U>
const char* wrong_with_distance(const S& s, const U& t, distance_tally& tally) {
    using T = scalar_type_of<S>;
    const separation<T> found = distance(s, t);
    ++tally.pairs;
    if (found.a != 0 || found.b != 0) return "ids are not 0";
    const separation<T> other = distance(t, s);
    if constexpr (!std::same_as<S, U>) {
        const separation<T> swapped{0, 0, found.point_b, found.point_a, found.distance};
        if (!(other == swapped)) return "the other order has another answer";
    }
    if (intersects<exact>(s, t)) {
        ++tally.touching;
        if (found.distance != 0 || other.distance != 0) return "what touches is apart";
        if (!(found.point_a == found.point_b)) return "what touches has two points";
        const wide off = std::max(distance_from(widest(found.point_a), s), distance_from(widest(found.point_a), t));
        // The foot of a round shape on a plane may lie where T has no number.
        const bool is_at_end = detail::contact_math::magnitude_of(found.point_a) == largest_finite<T>;
        if (std::same_as<S, plane<T>> && is_at_end) return nullptr;
        return off > wide(contact_bound(s, t)) ? "the shared point is off the shapes" : nullptr;
    }
    if (!(found.distance > 0) || !(other.distance > 0)) return "what does not touch is at no distance";
    if constexpr (std::same_as<S, plane<T>>) {
        if (s.normal == vec3<T>{0, 0, 0}) return found.distance == infinity<T> ? nullptr : "a plane that is nothing is near";
    }
    const wide_gap gap = exact_gap(s, t);
    const wide step = wide(0x1p-53) * gap.farthest;
    if (gap.distance > wide(largest_finite<T>) + step) return nullptr;  // T may have no number for it
    const auto within = [&](const wide& off, const wide& allowed, double& worst) {
        if (off > allowed && step > 0) worst = std::max(worst, static_cast<double>((off - allowed) / step));
        return off <= allowed + most_steps * step;
    };
    for (const separation<T>& one : {found, other}) {
        const wide rounded = wide(unit_roundoff<T>) * gap.distance + wide(std::numeric_limits<T>::denorm_min());
        if (!within(abs(wide(one.distance) - gap.distance), rounded, tally.distance)) return "the distance is off";
    }
    // The foot on a plane may lie where T has no number.
    const vec3<T> far = detail::absolute(found.point_a);
    if (std::same_as<S, plane<T>> && detail::greatest(far.x, far.y, far.z) == largest_finite<T>) return nullptr;
    const wide on_a = rounding_of(found.point_a), on_b = rounding_of(found.point_b);
    if (!within(distance_from(widest(found.point_a), s), on_a, tally.point)) return "the first point is off its shape";
    if (!within(distance_from(widest(found.point_b), t), on_b, tally.point)) return "the second point is off its shape";
    const wide between = length_of(widest(found.point_b) - widest(found.point_a));
    if (!within(abs(between - gap.distance), on_a + on_b, tally.point)) return "the points are not so far apart";
    return nullptr;
}

/// `make(i)` gives pair i.
template <class Make>
distance_tally check_distances(const std::string& name, std::uint64_t pairs, const Make& make) {
    distance_tally tally;
    for (std::uint64_t i = 0; i < pairs; ++i) {
        const auto [s, t] = make(i);
        if (const char* const wrong = wrong_with_distance(s, t, tally)) {
            CAPTURE(name, i);
            FAIL_CHECK(wrong);
        }
    }
    return tally;
}

void check_total(const char* name, const distance_tally& tally) {
    std::printf("distance, %s: %llu pairs, %llu touch; off by %.2f, points by %.2f\n", name,
                static_cast<unsigned long long>(tally.pairs), static_cast<unsigned long long>(tally.touching),
                tally.distance, tally.point);
    CHECK(tally.touching > tally.pairs / 10);
    CHECK(tally.touching < tally.pairs * 9 / 10);
}

}  // namespace

TEMPLATE_TEST_CASE("distance: of triangles, segments and points with triangles, in each family, against 300 bits", "", float,
                   double) {
    using T = TestType;
    std::printf("distance: seed %llu\n", static_cast<unsigned long long>(distance_seed));
    distance_tally total, flat;
    for (int f = 0; f < triangle_family_count; ++f) {
        const auto of = static_cast<triangle_family>(f);
        total += check_distances(name_of(of), some_samples(80), [&](std::uint64_t i) {
            const auto p = make_triangle_pair<T>(distance_seed, of, i);
            return std::pair(p.a, p.b);
        });
        flat += check_distances(name_of(of), some_samples(250), [&](std::uint64_t i) {
            const auto p = make_triangle_pair<T>(distance_seed + 1, of, i);
            return std::pair(segment<T>{p.a.a, p.a.b}, p.b);
        });
        flat += check_distances(name_of(of), some_samples(250), [&](std::uint64_t i) {
            const auto p = make_triangle_pair<T>(distance_seed + 2, of, i);
            return std::pair(p.a.c, p.b);
        });
    }
    check_total("triangles", total);
    check_total("segments and points", flat);
}

TEMPLATE_TEST_CASE("distance: of round and flat shapes, in each family, against 300 bits", "", float, double) {
    using T = TestType;
    distance_tally spheres_total, capsules, boxes, planes;
    for (int f = 0; f < family_count; ++f) {
        const auto of = static_cast<family>(f);
        spheres_total += check_distances(name_of(of), some_samples(120), [&](std::uint64_t i) {
            const auto p = make_pair<T>(distance_seed, of, i);
            return std::pair(p.s, p.t);
        });
        spheres_total += check_distances(name_of(of), some_samples(250), [&](std::uint64_t i) {
            const auto p = make_pair<T>(distance_seed + 1, of, i);
            return std::pair(p.s, segment<T>{p.t.a, p.t.b});
        });
        spheres_total += check_distances(name_of(of), some_samples(250), [&](std::uint64_t i) {
            const auto p = make_pair<T>(distance_seed + 2, of, i), q = make_pair<T>(distance_seed + 3, of, i);
            return std::pair(p.s, sphere<T>{p.t.a, i % 3 == 0 ? T(0) : q.s.radius});
        });
    }
    for (int f = 0; f < shape_family_count; ++f) {
        const auto of = static_cast<shape_family>(f);
        const auto make = [&]<template <class> class Shape>(std::uint64_t i) {
            const auto p = make_shape_pair<Shape, T>(distance_seed, of, i);
            return std::pair(p.s, p.t);
        };
        const std::string name = "family " + std::to_string(f);
        capsules += check_distances(name, some_samples(120), [&](auto i) { return make.template operator()<capsule>(i); });
        boxes += check_distances(name, some_samples(250), [&](auto i) { return make.template operator()<aabb>(i); });
        planes += check_distances(name, some_samples(120), [&](auto i) { return make.template operator()<plane>(i); });
    }
    check_total("spheres", spheres_total);
    check_total("capsules", capsules);
    check_total("boxes", boxes);
    check_total("planes", planes);
}

namespace {

/// Two triangles with edges that are parallel but for an angle down to 2^-60, or needles, at a distance down to 2^-40.
template <scalar T>
std::pair<triangle<T>, triangle<T>> nearly_parallel(std::uint64_t i) {
    using namespace construction;
    draws d(distance_seed, 77, i);
    const point a = cube(d, 1), b = cube(d, 1), across = unit(cross_product(between(a, b), cube(d, 1)));
    const auto aside = [&](const point& p, double by) { return along(p, by, across); };
    const double gap = std::ldexp(1.0, -d.below(40)), angle = std::ldexp(1.0, -d.below(61)), shift = d.uniform(-1, 1);
    const point p = along(a, shift, between(a, b)), q = along(along(b, shift, between(a, b)), angle, cube(d, 1));
    const double width_a = std::ldexp(1.0, -d.below(50)), width_b = std::ldexp(1.0, -d.below(50));
    const triangle<T> s{round_to<T>(a), round_to<T>(b), round_to<T>(aside(a, -width_a))};
    const triangle<T> t{round_to<T>(aside(p, gap)), round_to<T>(aside(q, gap)), round_to<T>(aside(q, gap + width_b))};
    return {reordered(s, d.below(6)), reordered(t, d.below(6))};
}

}  // namespace

namespace {

template <class S, class U>
distance_tally check_solid_distances(std::uint64_t part) {
    distance_tally total;
    for (int f = 0; f < solid_family_count; ++f) {
        const auto of = static_cast<solid_family>(f);
        total += check_distances(name_of(of), some_samples(part), [&](std::uint64_t i) {
            const auto p = make_solid_pair<S, U>(distance_seed + 7, of, i);
            return std::pair(p.s, p.t);
        });
    }
    return total;
}

}  // namespace

TEMPLATE_TEST_CASE("distance: of pairs without a triangle, in each family, against 300 bits", "", float, double) {
    using T = TestType;
    using point = vec3<T>;
    distance_tally round, boxes, planes;
    round += check_solid_distances<point, segment<T>>(250);
    round += check_solid_distances<point, capsule<T>>(250);
    round += check_solid_distances<segment<T>, segment<T>>(250);
    round += check_solid_distances<sphere<T>, capsule<T>>(100);
    round += check_solid_distances<capsule<T>, capsule<T>>(100);
    boxes += check_solid_distances<aabb<T>, segment<T>>(250);
    boxes += check_solid_distances<aabb<T>, aabb<T>>(100);
    boxes += check_solid_distances<aabb<T>, sphere<T>>(250);
    boxes += check_solid_distances<aabb<T>, capsule<T>>(100);
    planes += check_solid_distances<plane<T>, sphere<T>>(100);
    planes += check_solid_distances<plane<T>, capsule<T>>(100);
    planes += check_solid_distances<plane<T>, aabb<T>>(100);
    check_total("round shapes", round);
    check_total("boxes with boxes and segments", boxes);
    check_total("planes with solids", planes);
}

TEMPLATE_TEST_CASE("distance: edges that are nearly parallel, and needles, against 300 bits", "", float, double) {
    const distance_tally total = check_distances("nearly parallel", some_samples(2), nearly_parallel<TestType>);
    std::printf("distance, nearly parallel: off by %.2f, points by %.2f\n", total.distance, total.point);
    CHECK(total.touching < total.pairs / 2);
}

TEMPLATE_TEST_CASE("distance: pairs that a closed form just knows, or not, against 300 bits", "", float, double) {
    using T = TestType;
    std::uint64_t known = 0, pairs = 0;
    const auto note = [&](const auto& s, const auto& t) {
        ++pairs;
        known += detail::plain_pair<std::remove_cvref_t<decltype(s)>, std::remove_cvref_t<decltype(t)>>(s, t).touch() != verdict::unknown;
    };
    const auto axes = check_distances("capsules", sample_count() / 2, [&](std::uint64_t i) {
        const auto p = make_plain_capsules<T>(i);
        note(p.first, p.second);
        return p;
    });
    const auto mixed = check_distances("spheres and segments", sample_count() / 2, [&](std::uint64_t i) {
        const auto p = make_plain_capsules<T>(8 * i + 3);
        const sphere<T> ball{p.first.axis.a, p.first.radius};
        note(ball, p.second);
        return std::pair(ball, p.second);
    });
    check_total("axes beside each other", axes);
    CHECK(mixed.touching > mixed.pairs / 200);
    CHECK(known > pairs / 2);
    CHECK(known < pairs * 99 / 100);
    known = pairs = 0;
    distance_tally beside = check_distances("boxes and capsules", sample_count() / 8, [&](std::uint64_t i) {
        const auto p = make_plain_box_and_capsule<T>(i);
        note(p.first, p.second);
        return p;
    });
    beside += check_distances("boxes and segments", sample_count() / 8, [&](std::uint64_t i) {
        const auto p = make_plain_box_and_capsule<T>(i);
        return std::pair(p.first, p.second.axis);
    });
    check_total("capsules and segments beside boxes", beside);
    CHECK(known > pairs / 4);
    CHECK(known < pairs * 99 / 100);
    known = pairs = 0;
    distance_tally boxes;
    for (std::uint64_t i = 0; i < sample_count() / 8; ++i) {
        const auto [box, ball] = make_plain_box_and_ball<T>(i);
        const auto corners = detail::points_of(box);
        note(corners.as_hull(), ball);
        if (const char* const wrong = wrong_with_distance(corners.as_hull(), ball, boxes)) {
            CAPTURE(i);
            FAIL_CHECK(wrong);
        }
        CHECK(distance(box, ball) == distance(corners.as_hull(), ball));
    }
    check_total("balls beside boxes under a pose", boxes);
    CHECK(known > pairs / 4);
    CHECK(known < pairs * 99 / 100);
}

namespace {

/// Bounds in long double, for millions of pairs. A way between a point of each core bounds their distance from above, and how far the
/// cores are apart along it from below, whatever the way is. All is seen from the first shape's first corner.
struct bracket {
    using real = long double;
    using place = vec3<double>;
    struct real_point {
        real x, y, z;
        friend real_point operator-(const real_point& p, const real_point& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
        friend real dot(const real_point& p, const real_point& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
        friend real length(const real_point& p) { return std::sqrt(dot(p, p)); }
    };
    static constexpr real lost = 64 * std::numeric_limits<real>::epsilon();  ///< in parts of the farthest distance

    /// A core of 1, 2 or 8 corners, these in the order of a box's.
    struct core {
        real_point at[8];
        int count;
        real radius;

        template <class S>
        core(const S& s, const place& from) : count(0), radius(0) {
            const auto add = [&](const auto& corners) {
                for (const auto& p : corners) {
                    at[count++] = {real(p.x) - real(from.x), real(p.y) - real(from.y), real(p.z) - real(from.z)};
                }
            };
            if constexpr (requires { detail::points_of(s); }) {
                add(detail::points_of(s).at);
            } else {
                radius = detail::radius_around_core(s);
                add(detail::core_of(s).at);
            }
        }
        /// A point of it, the nearest of a segment or of a box without shear.
        [[nodiscard]] real_point near(const real_point& p) const {
            real_point q = at[0];
            real_point corners[8];
            for (int i = 0; i < count; ++i) corners[i] = at[i];
            for (int k = count / 2; k > 0; k /= 2) {  // from corners that differ in this bit to one each
                const real_point e = at[k] - at[0];
                const real square = dot(e, e), part = square > 0 ? std::clamp<real>(dot(p - at[0], e) / square, 0, 1) : 0;
                for (int i = 0; i < k; ++i) {
                    const real_point& a = corners[i];
                    const real_point f = corners[i + k] - a;
                    corners[i] = {a.x + part * f.x, a.y + part * f.y, a.z + part * f.z};
                }
                q = corners[0];
            }
            return q;
        }
        [[nodiscard]] real upper(const real_point& n) const {
            real most = dot(n, at[0]);
            for (int i = 1; i < count; ++i) most = std::max(most, dot(n, at[i]));
            return most;
        }
        [[nodiscard]] real lower(const real_point& n) const { return -upper({-n.x, -n.y, -n.z}); }
        [[nodiscard]] bool has(const real_point& p, real off) const { return length(p - near(p)) <= radius + off; }
    };

    /// Whether that tells that an answer is right. If not, nothing is known.
    template <class S, class U>
    static bool shows(const S& s, const U& t, const separation<scalar_type_of<S>>& found) {
        using T = scalar_type_of<S>;
        const vec3<T> first = first_corner(s);
        const place from{double(first.x), double(first.y), double(first.z)};
        const core a(s, from), b(t, from);
        const auto seen = [&](const vec3<T>& p) { return real_point{real(p.x) - real(from.x), real(p.y) - real(from.y), real(p.z) - real(from.z)}; };
        const real_point pa = seen(found.point_a), pb = seen(found.point_b), qa = a.near(pa), qb = b.near(pb), way = qb - qa;
        real far = 0;
        for (int i = 0; i < a.count; ++i) {
            for (int j = 0; j < b.count; ++j) far = std::max(far, length(b.at[j] - a.at[i]));
        }
        far += a.radius + b.radius;
        const real radii = a.radius + b.radius, slack = lost * far, step = 0x1p-53L * far;
        const real off_a = rounded_off(found.point_a), off_b = rounded_off(found.point_b);
        if (found.distance == 0) {  // the bound on a shared point alone: that they touch is left to who asks
            const real bound = real(contact_bound(s, t)) - slack;
            return found.point_a == found.point_b && bound > 0 && a.has(pa, bound) && b.has(pb, bound);
        }
        const real long_way = length(way), distance = found.distance;
        if (!(long_way > 0x1p-30L * far)) return false;
        const real above = long_way - radii + slack, below = (b.lower(way) - a.upper(way)) / long_way - radii - slack;
        const real allowed = real(unit_roundoff<T>) * below + most_steps / 2 * step;
        if (!(below > 0 && distance - below <= allowed && above - distance <= allowed)) return false;
        const real most = most_steps * step - slack, between = length(pb - pa);
        return a.has(pa, off_a + most) && b.has(pb, off_b + most) && between - below <= off_a + off_b + most &&
               above - between <= off_a + off_b + most;
    }

private:
    template <scalar T>
    static real rounded_off(const vec3<T>& p) {
        return real(unit_roundoff<T>) * (std::abs(real(p.x)) + std::abs(real(p.y)) + std::abs(real(p.z)));
    }
    template <class S>
    static auto first_corner(const S& s) {
        if constexpr (requires { detail::points_of(s); }) {
            return detail::points_of(s).at[0];
        } else {
            return detail::core_of(s).at[0];
        }
    }
};

struct bracketed {
    distance_tally left;
    std::uint64_t pairs = 0, touching = 0;
};

/// In every family: what the bracket does not show is asked of 300 bits.
template <class S, class U>
void check_bracketed(const char* name, bracketed& all, std::uint64_t pairs) {
    for (std::uint64_t i = 0; i < pairs; ++i) {
        const auto p = make_solid_pair<S, U>(distance_seed + 8, static_cast<solid_family>(i % solid_family_count), i);
        ++all.pairs;
        const auto found = distance(p.s, p.t);
        const bool touch = found.distance == 0;
        all.touching += touch;
        if (touch == intersects<exact>(p.s, p.t) && bracket::shows(p.s, p.t, found)) continue;
        if (const char* const wrong = wrong_with_distance(p.s, p.t, all.left)) {
            CAPTURE(name, i);
            FAIL_CHECK(wrong);
        }
    }
}

}  // namespace

TEMPLATE_TEST_CASE("distance: of closed forms, in each family, between bounds", "", float, double) {
    using T = TestType;
    using point = vec3<T>;
    const std::uint64_t pairs = some_samples(10);
    bracketed all;
    check_bracketed<point, point>("point, point", all, pairs);
    check_bracketed<point, segment<T>>("point, segment", all, pairs);
    check_bracketed<point, sphere<T>>("point, sphere", all, pairs);
    check_bracketed<point, capsule<T>>("point, capsule", all, pairs);
    check_bracketed<segment<T>, segment<T>>("segment, segment", all, pairs);
    check_bracketed<segment<T>, capsule<T>>("segment, capsule", all, pairs);
    check_bracketed<sphere<T>, capsule<T>>("sphere, capsule", all, pairs);
    check_bracketed<capsule<T>, capsule<T>>("capsule, capsule", all, pairs);
    check_bracketed<aabb<T>, point>("box, point", all, pairs);
    check_bracketed<aabb<T>, segment<T>>("box, segment", all, pairs);
    check_bracketed<aabb<T>, sphere<T>>("box, sphere", all, pairs);
    check_bracketed<aabb<T>, capsule<T>>("box, capsule", all, pairs);
    check_bracketed<aabb<T>, aabb<T>>("box, box", all, pairs);
    std::printf("distance, closed forms: %llu pairs, %llu touch, %llu are left to 300 bits\n", static_cast<unsigned long long>(all.pairs),
                static_cast<unsigned long long>(all.touching), static_cast<unsigned long long>(all.left.pairs));
    CHECK(all.left.pairs < all.pairs * 3 / 4);
}

TEST_CASE("distance: by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr triangle<double> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    static_assert(distance(t, vec{1, 1, 3}) == separation<double>{0, 0, {1, 1, 0}, {1, 1, 3}, 3});
    static_assert(distance(vec{1, 1, -3}, t) == separation<double>{0, 0, {1, 1, -3}, {1, 1, 0}, 3});
    static_assert(distance(t, triangle<double>{{1, 1, 2}, {5, 5, 9}, {-4, 5, 9}}).distance == 2);
    static_assert(distance(t, segment<double>{{1, -2, -5}, {1, -2, 5}}) ==
                  separation<double>{0, 0, {1, 0, 0}, {1, -2, 0}, 2});
    static_assert(distance(sphere<double>{{0, 0, 0}, 1}, sphere<double>{{0, 5, 0}, 2}) ==
                  separation<double>{0, 0, {0, 1, 0}, {0, 3, 0}, 2});
    static_assert(distance(t, capsule<double>{{{1, 1, 3}, {1, 1, 5}}, 1}).distance == 2);
    static_assert(distance(aabb<double>{{1, 1, 2}, {2, 2, 3}}, t).distance == 2);
    static_assert(distance(plane<double>{{0, 0, 2}, -6}, t) == separation<double>{0, 0, {0, 0, -3}, {0, 0, 0}, 3});
    static_assert(distance(plane<double>{{0, 0, 0}, 1}, t).distance == infinity<double>);
    static_assert(distance(t, t).distance == 0);
    constexpr auto shared = distance(sphere<double>{{1, 1, 2}, 2}, t);
    static_assert(shared.distance == 0 && shared.point_a == vec{1, 1, 0} && shared.point_b == vec{1, 1, 0});

    constexpr double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    CHECK(distance(triangle<double>{{0, 0, 0}, {most, 0, 0}, {0, most, 0}}, vec{0, 0, least}).distance == least);
    CHECK(distance(triangle<double>{{0, 0, -most}, {most, 0, -most}, {0, most, -most}}, vec{0, 0, most}).distance ==
          infinity<double>);
    // A plane that is far beyond all numbers, and one with the least of them.
    CHECK(distance(plane<double>{{0, 0, least}, most}, t).distance == infinity<double>);
    CHECK(distance(plane<double>{{0, 0, least}, 8 * least}, triangle<double>{{0, 0, 0}, {least, 0, 0}, {0, least, 0}})
              .distance == 8);
}

}  // namespace abut::test
