// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cmath>
#include <string>
#include <utility>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"
#include "support/poses.hpp"

namespace abut::test {

using construction::along;
using construction::cross_product;
using construction::cube;
using construction::round_to;
using construction::unit;

constexpr std::uint64_t ill_seed = 20261201;

/// 2^-k with k from `low` to `high`, of either sign.
double tiny(draws& d, int low, int high) {
    const double size = std::ldexp(1.0, -low - d.below(high - low + 1));
    return d.below(2) == 0 ? size : -size;
}

template <scalar T>
triangle<T> permuted(const triangle<T>& t, int which) {
    const vec3<T> p[3] = {t.a, t.b, t.c};
    const int first = which % 3, second = (first + 1 + which / 3 % 2) % 3;
    return {p[first], p[second], p[3 - first - second]};
}

/// A place on the border between the regions of two features of a triangle: at `foot` the nearest feature changes, to points
/// on the way `out` of it, when they are shifted along `aside`.
template <scalar T>
struct border {
    triangle<T> t;
    construction::point foot, out, aside;
};

/// Distances of all sizes; also where doubles know a direction less well than floats are.
double draw_height(draws& d) {
    const int kind = d.below(3);
    if (kind == 0) return d.uniform(0.1, 2);
    return kind == 1 ? std::abs(tiny(d, 0, 45)) : std::ldexp(d.uniform(1, 2), -6 - d.below(8));
}

/// With the foot at the origin, where coordinates are fine, or anywhere.
template <scalar T>
border<T> draw_border(draws& d) {
    using point = construction::point;
    point v{0, 0, 0}, w{1, 0, 0}, x{0, 1, 0};
    const int place = d.below(3);
    if (place == 1) {
        w = cube(d, 1);
        x = cube(d, 1);
    } else if (place == 2) {
        const T size = static_cast<T>(std::ldexp(1.0, d.below(12)));
        v = cube(d, static_cast<double>(size));
        w = cube(d, 1);
        x = cube(d, 1);
    }
    border<T> b;
    b.t = {round_to<T>(v), round_to<T>(along(v, 1, w)), round_to<T>(along(v, 1, x))};
    const point e = unit(w), n = unit(cross_product(w, x)), outwards = unit(cross_product(w, n));
    const double angle = d.below(3) == 0 ? d.below(3) * 0.5 : d.uniform(0, 1), lean = angle * 1.5707963267948966;
    const point between{std::fma(std::cos(lean), outwards.x, std::sin(lean) * n.x),
                        std::fma(std::cos(lean), outwards.y, std::sin(lean) * n.y),
                        std::fma(std::cos(lean), outwards.z, std::sin(lean) * n.z)};
    const int kind = d.below(3);  // corner and edge; edge and face; corner and face
    b.foot = kind == 1 ? along(v, d.below(2) == 0 ? 0.5 : d.uniform(0, 1), w) : v;
    b.out = kind == 0 ? between : n;
    b.aside = kind == 0 ? e : kind == 1 ? outwards : unit(along(e, d.uniform(-1, 1), outwards));
    return b;
}

TEMPLATE_TEST_CASE("contacts of spheres where the nearest feature changes", "", float, double) {
    using T = TestType;
    const contact_tally total = check_family("spheres at borders", 9000, [](std::uint64_t i) {
        draws d(ill_seed, 1, i / 6);
        const border<T> b = draw_border<T>(d);
        const double height = draw_height(d);
        const auto center = along(along(b.foot, height, b.out), tiny(d, 20, 52), b.aside);
        const T radius = static_cast<T>(height * d.uniform(1, 1.5) + (d.below(2) == 0 ? 0 : d.uniform(0, 2)));
        return std::pair(sphere<T>{round_to<T>(center), radius}, permuted(b.t, static_cast<int>(i % 6)));
    });
    check_total("spheres at borders", total, 8000);
}

/// Two that were wrong: a shift that squares of distances do not show, and a direction that doubles know too little of.
TEST_CASE("contacts of spheres at borders, one by one") {
    contact_tally tally;
    for (int i = 0; i < 6; ++i) {
        const char* wrong = check_contact(sphere<double>{{0x1p-28, -0.5, 1}, 2},
                                          permuted(triangle<double>{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}}, i), tally);
        CHECK(wrong == nullptr);
        const triangle<float> t{{0, 0, 0},
                                {0x1.ae7fccp-2f, -0x1.7e869cp-1f, -0x1.3686b8p-1f},
                                {-0x1.d53a62p-1f, -0x1.13f12ep-1f, -0x1.fedee4p-1f}};
        const sphere<float> s{{-0x1.d34c4ep-18f, 0x1.8d0ba8p-23f, 0x1.a680fep-18f}, 0x1.0aba1cp+0f};
        wrong = check_contact(s, permuted(t, i), tally);
        CHECK(wrong == nullptr);
    }
    CHECK(tally.touching == 12);
}

TEMPLATE_TEST_CASE("contacts of capsules where the nearest features change", "", float, double) {
    using T = TestType;
    const contact_tally total = check_family("capsules at borders", 9000, [](std::uint64_t i) {
        draws d(ill_seed, 2, i / 12);
        const border<T> b = draw_border<T>(d);
        const double height = draw_height(d);
        const double shift = tiny(d, 20, 52), tilt = d.below(2) == 0 ? 0 : tiny(d, 20, 52);
        const auto near = along(along(b.foot, height, b.out), shift, b.aside);
        // The axis begins there and leads away, or passes there level, or nearly so, or crosses the triangle beside the
        // foot.
        const int kind = d.below(3);
        auto way = d.below(2) == 0 ? b.aside : unit(cross_product(b.out, cube(d, 1)));
        way = along(way, kind == 0 ? d.uniform(0, 1) : kind == 1 ? tilt : d.uniform(-1, 1), b.out);
        const double length = d.uniform(0.2, 2), back = kind == 0 ? 0 : d.uniform(0.2, 2);
        const auto from = kind == 2 ? along(b.foot, shift, b.aside) : near;
        segment<T> axis{round_to<T>(along(from, length, way)), round_to<T>(along(from, -back, way))};
        if (i % 12 >= 6) std::swap(axis.a, axis.b);
        const T radius = static_cast<T>(height * d.uniform(1, 1.5) + (d.below(2) == 0 ? 0 : d.uniform(0, 2)));
        return std::pair(capsule<T>{axis, radius}, permuted(b.t, static_cast<int>(i % 6)));
    });
    check_total("capsules at borders", total, 8000);
}

/// A needle about the origin with a corner of sine 2^-k, and a point of it.
template <scalar T>
std::pair<triangle<T>, construction::point> draw_needle(draws& d, int k) {
    using point = construction::point;
    const double width = std::ldexp(1.0, -k);
    const int kind = d.below(3);
    if (kind == 0) {  // the short edge is at the origin
        const point far = cube(d, 1), b = cube(d, width), c = cube(d, width);
        return {{round_to<T>(far), round_to<T>(b), round_to<T>(c)}, along({0, 0, 0}, d.uniform(0.1, 0.9), far)};
    }
    if (kind == 1) {  // the sharp corner is
        const double far = d.uniform(0.5, 1);
        const T x = static_cast<T>(far);
        const auto y = static_cast<T>(d.uniform(-1, 1) * width), z = static_cast<T>(d.uniform(-1, 1) * width);
        const auto other = static_cast<T>(d.uniform(-1, 1) * width);
        return {{{0, 0, 0}, {x, y, z}, {x, other, 0}}, point{d.uniform(0.1, 0.9) * far, 0, 0}};
    }
    const point far = cube(d, 1), b = cube(d, width);  // no edge is short
    const vec3<T> end = round_to<T>(far);
    return {{end, round_to<T>(b), {-end.x, -end.y, -end.z}}, along({0, 0, 0}, d.uniform(-0.9, 0.9), far)};
}

TEMPLATE_TEST_CASE("contacts of needles, by their sine", "", float, double) {
    using T = TestType;
    contact_tally total;
    for (int k = 4; k <= 100; k += 4) {
        const std::string sine = " of sine 2^-" + std::to_string(k);
        const auto needle = [k](draws& d, std::uint64_t i) {
            auto n = draw_needle<T>(d, k);
            n.first = permuted(n.first, static_cast<int>(i % 6));
            return n;
        };
        total += check_family("triangle, needle" + sine, 60, [&](std::uint64_t i) {
            draws d(ill_seed, 3, i);
            const auto [t, o] = needle(d, i);
            const auto u = cube(d, 1), v = cube(d, 1);
            const triangle<T> other{round_to<T>(along(o, 1, u)), round_to<T>(along(o, 1, v)),
                                    round_to<T>(along(along(o, -1, u), -1, v))};
            return i % 2 == 0 ? std::pair(t, other) : std::pair(other, t);
        });
        total += check_family("sphere, needle" + sine, 30, [&](std::uint64_t i) {
            draws d(ill_seed, 4, i);
            const auto [t, o] = needle(d, i);
            const auto aside = cube(d, 1);
            const double off = i % 3 == 0 ? 0 : tiny(d, 2, k);
            return std::pair(sphere<T>{round_to<T>(along(o, off, aside)), static_cast<T>(d.uniform(0.1, 1))}, t);
        });
        total += check_family("capsule, needle" + sine, 30, [&](std::uint64_t i) {
            draws d(ill_seed, 5, i);
            const auto [t, o] = needle(d, i);
            const auto way = cube(d, 1), aside = cube(d, 1);
            const auto by = along(o, i % 3 == 0 ? 0 : tiny(d, 2, k), aside);
            const segment<T> axis{round_to<T>(along(by, 1, way)), round_to<T>(along(by, -1, way))};
            return std::pair(capsule<T>{axis, static_cast<T>(d.uniform(0.1, 1))}, t);
        });
        total += check_family("box, needle" + sine, 30, [&](std::uint64_t i) {
            draws d(ill_seed, 6, i);
            const auto [t, o] = needle(d, i);
            const auto size = detail::absolute(cube(d, 1));
            return std::pair(aabb<T>{round_to<T>(along(o, -0.5, size)), round_to<T>(along(o, 0.75, size))}, t);
        });
    }
    check_total("needles by sine", total, 3000);
}

/// Normals, coordinates and offsets at both ends of the exponents, as long as the offset is a number.
TEMPLATE_TEST_CASE("contacts of planes with numbers of extreme sizes", "", float, double) {
    using T = TestType;
    constexpr int highest = std::numeric_limits<T>::max_exponent - 1;  // of 2^e
    constexpr int lowest = std::numeric_limits<T>::min_exponent - std::numeric_limits<T>::digits;
    contact_tally total;
    const auto sized = [](const construction::point& p, int e) {
        return vec3<T>{static_cast<T>(std::ldexp(p.x, e)), static_cast<T>(std::ldexp(p.y, e)),
                       static_cast<T>(std::ldexp(p.z, e))};
    };
    for (int kind = 0; kind < 4; ++kind) {
        total += check_family("plane of extreme size, kind " + std::to_string(kind), 500, [&](std::uint64_t i) {
            draws d(ill_seed, 7 + static_cast<std::uint64_t>(kind), i);
            // Where both are as large, or as small, as the offset lets them be; or their sizes make up for each other.
            const int of_points = kind == 0   ? highest - d.below(6)
                                  : kind == 1 ? lowest + d.below(20)
                                  : kind == 2 ? highest - d.below(-lowest)
                                              : lowest + d.below(highest - lowest);
            int of_normal =
                kind < 2 ? d.below(12) - 6 : (d.below(2) == 0 ? highest - 1 : lowest + 8) - of_points + d.below(8);
            of_normal = std::min(std::max(of_normal, lowest), highest);
            // Every other time nearly along (1, 1, 1), where products add up.
            const auto drawn = [&] {
                const construction::point p = cube(d, 0.99);
                return i % 2 == 0 ? p : construction::point{(8 + p.x) / 9, (8 + p.y) / 9, (8 + p.z) / 9};
            };
            const vec3<T> normal = sized(drawn(), of_normal), a = sized(drawn(), of_points);
            const vec3<T> b = sized(drawn(), of_points), c = sized(drawn(), of_points);
            const triangle<T> t{a, b, c};
            const wide_point x = wide(0.3) * (widest(t.a) + widest(t.b)) + wide(0.4) * widest(t.c);
            const wide offset = dot(widest(normal), x);
            const bool fits = abs(offset) < wide(largest_finite<T>);
            return std::pair(plane<T>{normal, fits ? static_cast<T>(offset) : T(0)}, t);
        });
    }
    check_total("planes of extreme sizes", total, 1500);
}

/// Edges of denormal length beside large ones: no scale has room for both.
TEMPLATE_TEST_CASE("contacts of triangles with an edge of denormal length", "", float, double) {
    using T = TestType;
    constexpr T least = std::numeric_limits<T>::denorm_min();
    contact_tally total;
    const auto draw = [](draws& d, std::uint64_t i) {
        const auto step = [&] { return least * static_cast<T>(d.below(9) - 4); };
        vec3<T> b = {step(), step(), step()};
        if (d.below(3) == 0) b = {step(), 0, 0};
        const auto far = cube(d, std::ldexp(1.0, d.below(2) == 0 ? 10 : d.below(100) - 20));
        return std::pair(permuted(triangle<T>{{0, 0, 0}, b, round_to<T>(far)}, static_cast<int>(i % 6)), far);
    };
    total += check_family("triangle, denormal edge", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 11, i);
        const auto [t, far] = draw(d, i);
        const auto u = cube(d, 1024), v = cube(d, 1024), o = along({0, 0, 0}, d.uniform(0.1, 0.9), far);
        const triangle<T> other{round_to<T>(along(o, 1, u)), round_to<T>(along(o, 1, v)),
                                round_to<T>(along(along(o, -1, u), -1, v))};
        return i % 2 == 0 ? std::pair(t, other) : std::pair(other, t);
    });
    total += check_family("sphere, denormal edge", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 12, i);
        const auto [t, far] = draw(d, i);
        const auto o = along({0, 0, 0}, d.uniform(0.1, 0.9), far);
        return std::pair(sphere<T>{round_to<T>(o), static_cast<T>(d.uniform(0.1, 1024))}, t);
    });
    total += check_family("capsule, denormal edge", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 13, i);
        const auto [t, far] = draw(d, i);
        const auto o = along({0, 0, 0}, d.uniform(0.1, 0.9), far), u = cube(d, 1024);
        const segment<T> axis{round_to<T>(along(o, 1, u)), round_to<T>(along(o, -1, u))};
        return std::pair(capsule<T>{axis, static_cast<T>(d.uniform(0.1, 1024))}, t);
    });
    total += check_family("box, denormal edge", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 14, i);
        const auto [t, far] = draw(d, i);
        const auto o = along({0, 0, 0}, d.uniform(0.1, 0.9), far), u = detail::absolute(cube(d, 1024));
        return std::pair(aabb<T>{round_to<T>(along(o, -1, u)), round_to<T>(along(o, 1, u))}, t);
    });
    check_total("denormal edges", total, 1200);
}

/// Contacts are those of placed shapes, so that nothing of a rotation is left in them: not how far it is from one.
TEMPLATE_TEST_CASE("contacts of shapes placed by rotations that are askew", "", float, double) {
    using T = TestType;
    const auto askew = [](draws& d) {
        rigid<T> pose = make_pose<T>(d, 1);
        for (T& r : pose.rotation) r += static_cast<T>(d.uniform(-0x1p-11, 0x1p-11));
        return pose;
    };
    const auto corners = [](draws& d) {
        const auto a = cube(d, 1), b = cube(d, 1), c = cube(d, 1);
        return triangle<T>{round_to<T>(a), round_to<T>(b), round_to<T>(c)};
    };
    contact_tally total = check_family("triangles, askew", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 15, i);
        const rigid<T> pose = askew(d);
        triangle<T> s = corners(d), t = corners(d);
        if (i % 3 == 0) s.a = t.a;
        if (i % 3 == 1) s.a.z = s.b.z = s.c.z = t.a.z = t.b.z = t.c.z = 0;
        const triangle<T> placed = place(pose, s);
        return std::pair(placed, place(pose, t));
    });
    total += check_family("spheres, askew", 400, [&](std::uint64_t i) {
        draws d(ill_seed, 16, i);
        const rigid<T> pose_s = askew(d), pose_t = askew(d);
        const sphere<T> s{round_to<T>(cube(d, 1)), static_cast<T>(d.uniform(0, 1))};
        return std::pair(place(pose_s, s), place(pose_t, corners(d)));
    });
    check_total("askew rotations", total, 700);
}

}  // namespace abut::test
