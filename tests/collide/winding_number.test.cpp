// SPDX-License-Identifier: MIT
#include <abut/collide/winding_number.hpp>
#include <abut/experimental/leafless.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "collide/winding_cases.hpp"
#include "support/catch.hpp"
#include "support/seen_triangle.hpp"

using namespace abut;

namespace {

template <class T>
std::vector<T> wound(const result<T, host_space>& found) {
    return found.to_host();
}

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = std::abs(a[i] - b[i]);
        if (!(off <= most)) most = off;
    }
    return most;
}

/// What an index says of some triangles from afar, in floats or in doubles, and by how much it may be off.
struct seen_from_afar {
    double value, error;
};
template <class F>
seen_from_afar see_from_afar(const detail::winding_moments& of, const vec3<double>& p) {
    detail::far_terms terms{};
    const detail::far_bounds bounds = detail::write_far_terms(of, terms, 2);
    using number = detail::one_rounded<F>;
    using single = detail::one_rounded<float>;
    const vec3<double> v = of.center - p;
    const vec3<single> w{{float(v.x)}, {float(v.y)}, {float(v.z)}};
    number term[detail::far_terms::count];
    for (int k = 0; k < detail::far_terms::count; ++k) term[k] = {sizeof(F) == 4 ? F(terms.high[k][2]) : F(terms.high[k][2]) + F(terms.low[k][2])};
    const float error = detail::far_error(dot(w, w), single{bounds.radius}, single{bounds.weight},
                                          single{sizeof(F) == 4 ? bounds.noise : 0.0f},
                                          single{sizeof(F) == 4 ? bounds.noise_of_high : 0.0f})
                            .value;
    return {double(detail::far_value(vec3<number>{{F(v.x)}, {F(v.y)}, {F(v.z)}}, number{bounds.radius}, term).value), double(error)};
}

/// A cube from 0 to 1, facing outward.
template <class T>
test::surface_data<T> cube_facing_outward() {
    const test::cube_surface cube(1);
    std::vector<vec3<T>> corners;
    for (const auto& v : cube.vertices) corners.push_back({T(v[0]) / 2, T(v[1]) / 2, T(v[2]) / 2});
    return {corners, cube.faces};
}

}  // namespace

TEMPLATE_TEST_CASE("winding number: serial", "", float, double) { test::check_winding<TestType>(serial{}); }

TEST_CASE("winding number: openmp on 1 and 3 threads") {
    for (const int threads : {1, 3}) {
        CAPTURE(threads);
        test::check_winding<float>(openmp{threads});
        test::check_winding_bits<double>(openmp{threads});
    }
}

TEMPLATE_TEST_CASE("winding number: against angles between planes in a hundred digits", "", float, double) {
    using T = TestType;
    test::uniform random(473);
    const auto triangles = test::random_triangles<T>(60, random);
    const auto points = test::points_to_wind(triangles, random, 40);
    std::vector<double> truth;
    for (const vec3<T>& p : points) {
        test::angle_number sum = 0;
        bool is_off_edges = true;
        for (const triangle<T>& t : triangles) {
            const test::seen_triangle seen(t, p);
            sum += seen.share;
            is_off_edges = is_off_edges && seen.is_off_edges;
        }
        truth.push_back(is_off_edges ? static_cast<double>(sum) : 9);
    }
    const auto found = wound(winding_number(serial{}, triangle_soup<T>(triangles), points));
    std::size_t compared = 0;
    double worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (truth[i] > 8) continue;
        ++compared;
        worst = std::max(worst, std::abs(found[i] - truth[i]));
    }
    CHECK(worst < 60 * 0x1p-45);
    CHECK(compared > 40);
}

TEST_CASE("winding number: an open hemisphere") {
    auto data = test::ball_surface<double>(4, 1);
    std::vector<face> upper, lid;
    std::vector<std::uint32_t> equator;
    for (const face& f : data.faces) {
        if (data.vertices[f[0]].z + data.vertices[f[1]].z + data.vertices[f[2]].z > 0) upper.push_back(f);
    }
    for (std::uint32_t v = 0; v < data.vertices.size(); ++v) {
        if (data.vertices[v].z == 0) equator.push_back(v);
    }
    const auto angle = [&](std::uint32_t v) { return std::atan2(data.vertices[v].y, data.vertices[v].x); };
    std::sort(equator.begin(), equator.end(), [&](auto a, auto b) { return angle(a) < angle(b); });
    const auto n = static_cast<double>(equator.size());
    REQUIRE(n == 64);
    const auto tree = make_bvh(serial{}, mesh<double>(data.vertices, upper));
    // On the axis: a pyramid over a regular polygon, by Napier's rules for half of a side.
    std::vector<vec3<double>> points;
    std::vector<double> truth;
    const double pi = std::acos(-1.0);
    for (const double h : {0.01, 0.1, 0.5, 0.9, 1.5, 7.0}) {
        const double half = std::atan(1 / (h / std::sqrt(1 + h * h) * std::tan(pi / n)));
        const double polygon = (2 * n * half - (n - 2) * pi) / (4 * pi);
        points.push_back({0, 0, -h}), truth.push_back(polygon);
        points.push_back({0, 0, h}), truth.push_back(h < 1 ? 1 - polygon : -polygon);
    }
    points.push_back({0, 0, 0}), truth.push_back(0.5);
    CHECK(greatest_difference(wound(winding_number(serial{}, tree, points, {.tolerance = 0})), truth) < 1e-13);
    CHECK(greatest_difference(wound(winding_number(serial{}, tree, points)), truth) < 1e-3);
    // Anywhere: another surface with the same rim differs by a whole number.
    for (std::size_t k = 1; k + 1 < equator.size(); ++k) lid.push_back({equator[0], equator[k], equator[k + 1]});
    test::uniform random(474);
    std::vector<vec3<double>> around;
    std::vector<double> difference;
    for (int i = 0; i < 300; ++i) {
        around.push_back(random.point<double>(-1.2, 1.2));
        const vec3<double>& p = around.back();
        const double square = dot(p, p);
        if (square > 0.98 && square < 1.02)
            around.pop_back();
        else
            difference.push_back(square < 1 && p.z > 0 ? 1 : 0);
    }
    auto of_both = wound(winding_number(serial{}, mesh<double>(data.vertices, upper), around));
    const auto of_lid = wound(winding_number(serial{}, mesh<double>(data.vertices, lid), around));
    for (std::size_t i = 0; i < around.size(); ++i) of_both[i] -= of_lid[i];
    CHECK(greatest_difference(of_both, difference) < 1e-12);
}

TEMPLATE_TEST_CASE("winding number: on the surface, of surfaces turned inside out, twice there, and of none", "", float,
                   double) {
    using T = TestType;
    const auto cube = cube_facing_outward<T>();
    const T tiny = std::numeric_limits<T>::denorm_min();
    const std::vector<vec3<T>> points{
        {T(0.5), T(0.25), 0},    {T(0.5), T(0.5), 1},      {T(0.5), 0, 0}, {1, 1, T(0.25)}, {0, 0, 0}, {1, 1, 1},
        {T(0.5), T(0.25), tiny}, {T(0.5), T(0.25), -tiny}, {2, T(0.5), 1}};
    const std::vector<double> expected{0.5, 0.5, 0.25, 0.25, 0.125, 0.125, 1, 0, 0};
    const auto tree = make_bvh(serial{}, mesh<T>(cube.vertices, cube.faces));
    for (const double tolerance : {0.0, 1e-9}) {
        CHECK(greatest_difference(wound(winding_number(serial{}, tree, points, {.tolerance = tolerance})), expected) < 1e-8);
    }
    auto triangles = test::triangles_of(cube.vertices, cube.faces);
    const std::vector<vec3<T>> middle{{T(0.5), T(0.375), T(0.25)}};
    for (triangle<T>& t : triangles) t = {t.a, t.c, t.b};
    CHECK(winding_number(serial{}, triangle_soup<T>(triangles), middle).to_host()[0] == Approx(-1));
    const auto once = triangles;
    triangles.insert(triangles.end(), once.begin(), once.end());
    CHECK(winding_number(serial{}, triangle_soup<T>(triangles), middle[0]).to_host()[0] == Approx(-2));
    // One triangle, one without area, none; no points.
    const auto one = make_bvh(serial{}, triangle_soup<T>(std::vector{once[0]}));
    CHECK(wound(winding_number(serial{}, one, middle)) == wound(winding_number(serial{}, once[0], middle)));
    const std::vector<triangle<T>> none{{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
    const auto flat = make_bvh(serial{}, triangle_soup<T>(none));
    CHECK(wound(winding_number(serial{}, flat, middle)) == std::vector<double>{0});
    CHECK(wound(winding_number(serial{}, make_bvh(serial{}, triangle_soup<T>{}), middle)) == std::vector<double>{0});
    CHECK(wound(winding_number(serial{}, triangle_soup<T>{}, middle)) == std::vector<double>{0});
    CHECK(winding_number(serial{}, one, std::vector<vec3<T>>{}).size() == 0);
    for (const double wrong : {-1e-300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_AS(winding_number(serial{}, one, middle, {.tolerance = wrong}), error);
    }
}

TEMPLATE_TEST_CASE("winding number: no answer is off by more than the tolerance, in every layout", "", float, double) {
    using T = TestType;
    test::uniform random(475);
    const test::torus<T> ring(60, 30, 1.2, 0.5);
    auto soup = test::random_triangles<T>(3000, random);
    // And triangles that all face the origin.
    auto facing = soup;
    for (triangle<T>& t : facing) {
        if (dot(t.a, cross(t.b - t.a, t.c - t.a)) < 0) t = {t.a, t.c, t.b};
    }
    const rigid<T> pose{{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(0.25), T(-0.5), T(0.125)}};
    for (const auto& triangles : {test::triangles_of(ring.vertices, ring.faces), soup, facing}) {
        auto points = test::points_to_wind(triangles, random, 60);
        points.push_back({0, 0, 0});
        points.push_back({1000, 1000, -3000});
        const triangle_soup<T> set(triangles);
        const auto exact = wound(winding_number(serial{}, set, points));
        const auto exact_posed = wound(winding_number(serial{}, posed(set, pose), points));
        const auto tree = make_bvh(serial{}, set, {.builder = bvh_builder::ploc});
        CHECK(greatest_difference(wound(winding_number(serial{}, tree, points, {.tolerance = 0})), exact) == 0);
        CHECK(greatest_difference(wound(winding_number(serial{}, make_grid(serial{}, set), points)), exact) == 0);
        for (const double tolerance : {1e-9, 1e-5, 1e-3, 1e-1, 10.0}) {
            CAPTURE(tolerance);
            const winding_options options{.tolerance = tolerance};
            const auto check = [&](const auto& index) {
                const double off = greatest_difference(wound(winding_number(serial{}, index, points, options)), exact);
                CHECK(off <= tolerance + 1e-12);
                if (tolerance >= 1e-3) CHECK(off > tolerance * 1e-6);  // something was far
                CHECK(greatest_difference(wound(winding_number(openmp{3}, index, points, options)),
                                          wound(winding_number(serial{}, index, points, options))) == 0);
                CHECK(greatest_difference(wound(winding_number(serial{}, posed(index, pose), points, options)),
                                          exact_posed) <= tolerance + 1e-12);
            };
            check(tree);
            check(wide(serial{}, tree));
            if (tolerance != 1e-3) continue;
            check(make_bvh(serial{}, set));
            check(leafless(serial{}, tree));
            check(quantised(serial{}, tree));
            check(oriented(serial{}, tree));
        }
    }
}

TEMPLATE_TEST_CASE("winding number: of an index, few points and a mesh of many nodes", "", float, double) {
    using T = TestType;
    test::uniform random(479);
    const test::torus<T> ring(120, 60, 1.2, 0.5);
    auto triangles = test::triangles_of(ring.vertices, ring.faces);
    // And a floor that is larger than all, which costs none of the tolerance.
    triangles.push_back({{-900, -900, -1}, {900, -900, -1}, {900, 900, -1}});
    triangles.push_back({{-900, -900, -1}, {900, 900, -1}, {-900, 900, -1}});
    const triangle_soup<T> set(triangles);
    auto points = test::points_to_wind(triangles, random, 24);
    points.push_back({T(1e6), T(-1e6), T(1e6)});
    const auto exact = wound(winding_number(serial{}, set, points));
    const auto tree = make_bvh(serial{}, set, {.builder = bvh_builder::sah});
    const rigid<T> pose{{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(0.25), T(-0.5), T(0.125)}};
    const auto index = make_winding_index(serial{}, tree), of_set = make_winding_index(serial{}, set);
    const auto placed = make_winding_index(serial{}, posed(set, pose));
    const auto exactly_placed = wound(winding_number(serial{}, posed(set, pose), points));
    CHECK(index.size() == triangles.size());
    CHECK(index.bytes() > 36 * triangles.size());
    CHECK(index.bytes() < 500 * triangles.size());
    CHECK(index.device() == -1);
    for (const double tolerance : {0.0, 1e-16, 1e-9, 1e-7, 1e-5, 2e-4, 1e-3, 1e-2, 0.3}) {
        CAPTURE(tolerance);
        const winding_options options{.tolerance = tolerance};
        const auto found = wound(winding_number(serial{}, index, points, options));
        CHECK(greatest_difference(found, exact) <= tolerance + 1e-11);
        if (tolerance >= 1e-7) CHECK(greatest_difference(found, exact) > tolerance * 1e-6);  // something was far
        CHECK(greatest_difference(wound(winding_number(serial{}, of_set, points, options)), exact) <= tolerance + 1e-11);
        CHECK(wound(winding_number(openmp{3}, index, points, options)) == found);
        if (tolerance > 0) CHECK(wound(winding_number(serial{}, tree, points, options)) == found);
        for (std::size_t i = 0; i < 5; ++i) {
            CHECK(wound(winding_number(serial{}, index, points[i], options)) == std::vector<double>{found[i]});
        }
        CHECK(greatest_difference(wound(winding_number(serial{}, placed, points, options)), exactly_placed) <= tolerance + 1e-11);
    }
    const auto none = make_winding_index(serial{}, triangle_soup<T>{});
    CHECK(none.size() == 0);
    CHECK(wound(winding_number(serial{}, none, points)) == std::vector<double>(points.size()));
    for (std::size_t n = 1; n < 12; ++n) {
        const triangle_soup<T> some(std::vector(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(n)));
        const auto of_some = wound(winding_number(serial{}, make_winding_index(openmp{2}, some), points, {.tolerance = 1e-2}));
        CHECK(greatest_difference(of_some, wound(winding_number(serial{}, some, points))) <= 1e-2);
    }
    CHECK_THROWS_AS(winding_number(serial{}, index, points, {.tolerance = -1}), error);
}

TEST_CASE("winding number: a small body on a floor that is larger by all digits of a float") {
    test::uniform random(480);
    const test::torus<float> ring(60, 30, 1.2, 0.5);
    const auto of_ring = test::triangles_of(ring.vertices, ring.faces);
    for (const float half : {3e4f, 1e7f, 1e12f}) {
        auto triangles = of_ring;
        triangles.push_back({{-half, -half, -1}, {half, -half, -1}, {half, half, -1}});
        triangles.push_back({{-half, -half, -1}, {half, half, -1}, {-half, half, -1}});
        const triangle_soup<float> set(triangles);
        const auto points = test::points_to_wind(of_ring, random, 60);
        const auto exact = wound(winding_number(serial{}, set, points));
        for (const auto& tree : {make_bvh(serial{}, set), make_bvh(serial{}, set, {.builder = bvh_builder::sah})}) {
            const auto index = make_winding_index(serial{}, tree);
            for (const double tolerance : {1e-6, 1e-4, 1e-3, 1e-1, 10.0}) {
                CAPTURE(half, tolerance);
                const auto found = wound(winding_number(serial{}, index, points, {.tolerance = tolerance}));
                CHECK(greatest_difference(found, exact) <= tolerance + 1e-11);
                CHECK(greatest_difference(found, exact) <= 0.5);
            }
        }
    }
}

TEST_CASE("winding number: the bound of the far field is kept, and nearly reached") {
    test::uniform random(476);
    const detail::winding_frame unit{};
    std::size_t beyond = 0, seen_far = 0;
    double most = 0;
    const auto look = [&](const std::vector<triangle<double>>& triangles, const vec3<double>& p) {
        // Joined in pairs, and so on, as a tree does.
        std::vector<detail::winding_moments> parts;
        double truth = 0;
        for (const auto& t : triangles) {
            parts.push_back(detail::moments_of(t, unit));
            truth += detail::solid_angle_share(t, p);
        }
        while (parts.size() > 1) {
            std::vector<detail::winding_moments> fewer;
            for (std::size_t k = 0; k < parts.size(); k += 2) {
                const int count = k + 1 < parts.size() ? 2 : 1;
                fewer.push_back(count == 1 ? parts[k] : detail::joined_moments(&parts[k], count, 0x1p-44));
            }
            parts = fewer;
        }
        const seen_from_afar seen = see_from_afar<double>(parts[0], p), in_floats = see_from_afar<float>(parts[0], p);
        if (!(seen.error < 1e300)) return 0.0;
        ++seen_far;
        const double ratio = std::abs(seen.value - truth) / (seen.error + 0x1p-46 * parts[0].area);
        beyond += !(ratio <= 1 + 1e-6);
        beyond += !(std::abs(in_floats.value - truth) <= in_floats.error);
        return ratio;
    };
    for (int i = 0; i < 4000; ++i) {
        const double size = std::ldexp(1.0, -i % 12);
        std::vector<triangle<double>> cluster;
        const vec3<double> at = random.point<double>(-1, 1);
        for (std::size_t k = 2 + random.below(7); k > 0; --k) {
            const auto corner = [&] { return at + 0.1 * random.point<double>(-1, 1); };
            const vec3<double> a = corner(), ab = size * (corner() - a), ac = size * (corner() - a);
            cluster.push_back({a, a + ab, a + ac});
        }
        const vec3<double> away = random.point<double>(-1, 1);
        most = std::max(most, look(cluster, at + std::ldexp(1.0, -i % 4) * away));
    }
    CHECK(seen_far > 2000);
    CHECK(most > 0.02);
    // The worst case: small triangles at both ends of a line through the point, across it, which face away from each other: the
    // first term that is left out is of an odd degree in their places.
    double worst = 0;
    for (const double theta : {0.5, 0.2, 0.1, 0.02}) {
        const double s = 1e-3;
        const triangle<double> front{{s, 0, 1}, {-s, s, 1}, {-s, -s, 1}}, back{{s, 0, -1}, {-s, -s, -1}, {-s, s, -1}};
        worst = std::max(worst, look({front, back}, {0, 0, 1 / theta}));
    }
    CHECK(worst > 0.95);
    CHECK(beyond == 0);
}

TEST_CASE("winding number: errors that add up to the tolerance, nearly") {
    // Around the origin many of the worst case above: on a spiral around the sphere each is a node of the tree, and what is
    // left of one node's share is seen where they lie as it comes.
    test::uniform random(478);
    for (const bool is_even : {true, false}) {
        std::vector<triangle<double>> triangles;
        double bound = 0;
        for (int i = 0; i < (is_even ? 40 : 100); ++i) {
            const double z = is_even ? (2 * i + 1) / 40.0 - 1 : random(-1, 1), rho = std::sqrt(1 - z * z);
            const double around = is_even ? 2.39996 * i : random(0, 7);
            const vec3<double> out{rho * std::cos(around), rho * std::sin(around), z};
            const vec3<double> aside{-std::sin(around), std::cos(around), 0}, across = cross(out, aside);
            const double size = 1e-3;
            std::vector<detail::winding_moments> four;  // which is a block of the index
            for (const double at : {0.95, 1.05, 0.95, 1.05}) {
                const auto corner = [&](double u, double v) {
                    return at * out + size * u * aside + size * v * across;
                };
                const double side = at < 1 ? -1 : 1;  // they face away from each other
                triangles.push_back({corner(1, 0), corner(-1, -side), corner(-1, side)});
                four.push_back(detail::moments_of(triangles.back(), {}));
            }
            bound += see_from_afar<double>(detail::joined_moments(four.data(), 4, 0x1p-38), {0, 0, 0}).error;
        }
        const triangle_soup<double> set(triangles);
        const auto tree = make_bvh(serial{}, set, {.builder = bvh_builder::ploc});
        const std::vector<vec3<double>> origin{{0, 0, 0}};
        const double exact = winding_number(serial{}, set, origin).to_host()[0];
        double most = 0;
        for (const double part : {0.2, 0.4, 0.6, 0.8, 0.95, 1.05, 1.5, 3.0, 10.0}) {
            const double found = winding_number(serial{}, tree, origin, {.tolerance = part * bound}).to_host()[0];
            const double share = std::abs(found - exact) / (part * bound);
            CAPTURE(is_even, part, share);
            CHECK(share <= 1 + 1e-4);
            most = std::max(most, share);
        }
        CHECK(most > (is_even ? 0.8 : 0.1));
    }
}

TEMPLATE_TEST_CASE("winding number: both ends of the range", "", float, double) {
    using T = TestType;
    const auto ball = test::ball_surface<double>(2, 1);
    test::uniform random(477);
    std::vector<vec3<double>> places{{0, 0, 0}, {0.5, 0.25, 0.125}};
    for (int i = 0; i < 60; ++i) places.push_back(random.point<double>(-1, 1));
    constexpr int max = std::numeric_limits<T>::max_exponent - 1, min = std::numeric_limits<T>::min_exponent - 1;
    for (const int e : {max, max - 30, max / 2, min / 2, min, min - 8}) {
        CAPTURE(e);
        // Coarse enough to be exact also where digits are lost.
        const auto at_scale = [&](const vec3<double>& v, int more = 0) {
            const auto one = [&](double x) { return std::ldexp(static_cast<T>(std::round(x * 128)), e - 7 + more); };
            return vec3<T>{one(v.x), one(v.y), one(v.z)};
        };
        std::vector<vec3<T>> vertices, points;
        for (const auto& v : ball.vertices) vertices.push_back(at_scale(v));
        for (const auto& p : places) points.push_back(at_scale(p));
        const mesh<T> surface(vertices, ball.faces);
        const auto tree = make_bvh(serial{}, surface);
        const auto where = inside(serial{}, tree, points).to_host();
        std::vector<double> truth;
        for (const containment c : where) truth.push_back(c == containment::inside ? 1 : 0);
        std::size_t within = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) within += truth[i] > 0;
        CHECK(within > 20);
        for (const double tolerance : {0.0, 1e-3, 1e-1}) {
            CAPTURE(tolerance);
            const auto found = wound(winding_number(serial{}, tree, points, {.tolerance = tolerance}));
            double worst = 0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                REQUIRE(std::isfinite(found[i]));
                if (where[i] != containment::on_surface) worst = std::max(worst, std::abs(found[i] - truth[i]));
            }
            CHECK(worst <= tolerance + 1e-9);
        }
        // Far away from all, as far as numbers go.
        const T largest = std::numeric_limits<T>::max();
        const auto far =
            wound(winding_number(serial{}, tree, std::vector<vec3<T>>{{largest, -largest, largest}, {0, largest, 0}}));
        for (const double w : far) CHECK(std::abs(w) <= 1e-3);
    }
}
