// SPDX-License-Identifier: MIT
#include <abut/collide/hausdorff.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/abut.hpp>

#include "collide/depth_cases.hpp"
#include "support/catch.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"
#include "support/shape_oracles.hpp"

namespace abut::test {

namespace {

using rational = boost::multiprecision::cpp_rational;

/// The square of the distance from a point to triangles, all in integers of one unit.
rational squared_to(const integer_point& p, const std::vector<std::array<integer_point, 3>>& faces) {
    rational least = -1;
    for (const auto& f : faces) {
        std::vector<integer_point> w;
        for (const integer_point& c : f) w.push_back({c.x - p.x, c.y - p.y, c.z - p.z});
        const squared_distance d = distance_to_hull(w);
        const rational square(d.numerator, d.denominator);
        if (least < 0 || square < least) least = square;
    }
    return least;
}
std::vector<std::array<integer_point, 3>> in_units(const grid_soup& s, int units) {
    std::vector<std::array<integer_point, 3>> all;
    for (const auto& f : s.faces) {
        std::array<integer_point, 3> t;
        for (std::size_t i = 0; i < 3; ++i) t[i] = {units * f[i][0], units * f[i][1], units * f[i][2]};
        all.push_back(t);
    }
    return all;
}

/// How many samples of the faces of a are farther from b than the bound says; the largest distance of one.
std::uint64_t count_beyond(const grid_soup& a, const grid_soup& b, double upper, double unit, int steps, double& most) {
    const auto of_b = in_units(b, steps);
    const rational bound = rational(upper) / rational(unit) * steps;
    std::uint64_t beyond = 0;
    rational largest = 0;
    for (const auto& f : a.faces) {
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; i + j <= steps; ++j) {
                const auto at = [&](std::size_t c) { return i * f[0][c] + j * f[1][c] + (steps - i - j) * f[2][c]; };
                const rational square = squared_to({at(0), at(1), at(2)}, of_b);
                beyond += square > bound * bound;
                largest = std::max(largest, square);
            }
        }
    }
    most = std::sqrt(largest.convert_to<double>()) / steps * unit;
    return beyond;
}
/// Whether the point is as far from b as is said.
bool is_so_far(const farthest_point& f, const grid_soup& b, double unit) {
    std::vector<double> all{f.point.x, f.point.y, f.point.z, f.lower};
    for (const auto& face : b.faces) {
        for (const auto& c : face) {
            for (const int x : c) all.push_back(unit * x);
        }
    }
    const std::vector<integer> n = to_integers(all);
    std::vector<std::array<integer_point, 3>> of_b;
    for (std::size_t k = 4; k + 8 < n.size(); k += 9) {
        of_b.push_back({integer_point{n[k], n[k + 1], n[k + 2]}, integer_point{n[k + 3], n[k + 4], n[k + 5]},
                        integer_point{n[k + 6], n[k + 7], n[k + 8]}});
    }
    return squared_to({n[0], n[1], n[2]}, of_b) >= rational(n[3]) * rational(n[3]);
}

template <scalar T>
mesh<T> square(T x, T y, T z, T side) {
    return {{{x, y, z}, {x + side, y, z}, {x + side, y + side, z}, {x, y + side, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace

TEMPLATE_TEST_CASE("hausdorff: between bounds that hold, against samples in integers", "", float, double) {
    std::uint64_t wrong = 0, too_wide = 0, unlike = 0;
    const std::uint64_t count = some_samples(20);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270701, 1, k);
        const int size = 2 + d.below(12);
        const grid_soup a = draw_soup(d, 1 + d.below(6), size), b = k % 8 == 0 ? a : draw_soup(d, 1 + d.below(12), size);
        const TestType unit = k % 3 == 0 ? TestType(1) : k % 3 == 1 ? TestType(0x1p-60) : TestType(0x1p100);
        const double tolerance = static_cast<double>(unit) * (k % 2 == 0 ? 0.1 : 0.001);
        const auto x = a.soup(unit), y = b.soup(unit);
        const serial on;
        const hausdorff_distance found = hausdorff(on, x, y, {.tolerance = tolerance});
        const auto check = [&](const farthest_point& f, const grid_soup& from, const grid_soup& to) {
            double most = 0;
            wrong += count_beyond(from, to, f.upper, static_cast<double>(unit), 8, most);
            if (!is_so_far(f, to, static_cast<double>(unit))) ++wrong;
            if (f.lower > 0 && f.face >= from.faces.size()) ++wrong;
            if (f.upper - f.lower > tolerance * (1 + 1e-9) || f.upper < f.lower || most > f.upper) ++too_wide;
        };
        check(found.a_from_b, a, b);
        check(found.b_from_a, b, a);
        const hausdorff_distance again =
            hausdorff(openmp{.threads = 3}, make_bvh(on, x), wide(on, make_bvh(on, y)), {.tolerance = tolerance});
        if (!(again.a_from_b == found.a_from_b && again.b_from_a == found.b_from_a)) ++unlike;
        // With few pieces bounds are wide, and hold.
        const hausdorff_distance few = hausdorff(on, x, y, {.tolerance = tolerance, .most_pieces = 1});
        double most = 0;
        wrong += count_beyond(a, b, few.a_from_b.upper, static_cast<double>(unit), 4, most);
        if (few.a_from_b.upper < found.a_from_b.lower || few.a_from_b.lower > found.a_from_b.upper) ++wrong;
    }
    CHECK(wrong == 0);
    CHECK(too_wide == 0);
    CHECK(unlike == 0);
}

TEMPLATE_TEST_CASE("hausdorff: what is known in closed form", "", float, double) {
    const serial on;
    using T = TestType;
    // Parallel squares, and one that is larger.
    const auto near = hausdorff(on, square<T>(0, 0, 0, 4), square<T>(0, 0, 3, 4));
    CHECK(near.lower() <= 3);
    CHECK(near.upper() >= 3);
    CHECK(near.upper() - near.lower() < 0.01);
    const auto larger = hausdorff(on, square<T>(0, 0, 0, 4), square<T>(0, 0, 0, 7), {.tolerance = 1e-6});
    CHECK(larger.a_from_b.lower == 0);
    CHECK(larger.a_from_b.upper < 1e-12);
    CHECK(larger.b_from_a.lower == Approx(std::sqrt(18.0)).epsilon(1e-9));
    CHECK(larger.b_from_a.point == vec3<double>{7, 7, 0});
    CHECK(larger.b_from_a.nearest == vec3<double>{4, 4, 0});
    // A cube in the corner of another one; the middle of no face and no corner of the larger one is the answer for the first.
    const auto cubes = hausdorff(on, boundary(aabb<T>{{0, 0, 0}, {1, 1, 1}}), boundary(aabb<T>{{0, 0, 0}, {2, 2, 2}}), {.tolerance = 1e-5});
    CHECK(cubes.a_from_b.lower == Approx(1).epsilon(1e-9));
    CHECK(cubes.b_from_a.lower == Approx(std::sqrt(3.0)).epsilon(1e-9));
    // In the middle of a face: a point above it, a roof of one edge.
    const mesh<T> roof{{{0, 0, 0}, {8, 0, 0}, {4, 4, 2}}, {{0, 1, 2}}};
    const auto over = hausdorff(on, mesh<T>{{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}}, {{0, 1, 2}, {0, 2, 3}}}, roof, {.tolerance = 1e-4});
    CHECK(over.b_from_a.lower == Approx(2).epsilon(1e-9));
    CHECK(over.a_from_b.upper >= over.a_from_b.lower);
    // From its border a triangle is farthest in the middle of the inscribed circle.
    const mesh<T> whole{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 2}}}, border{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 1}, {1, 2, 2}, {2, 0, 0}}};
    const auto inner = hausdorff(on, whole, border, {.tolerance = 1e-4});
    const double radius = 8 - 4 * std::sqrt(2.0);
    CHECK(inner.a_from_b.lower == Approx(radius).margin(1e-4));
    CHECK(inner.a_from_b.upper >= radius);
    CHECK(inner.b_from_a.upper < 1e-4);
    // Under a pose.
    const rigid<T> up{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 5}};
    const auto moved = hausdorff(on, make_bvh(on, square<T>(0, 0, 0, 4)), posed(make_bvh(on, square<T>(0, 0, 0, 4)), up), {.tolerance = 1e-6});
    CHECK(moved.lower() == Approx(5).epsilon(1e-9));
    CHECK(moved.upper() == Approx(5).epsilon(1e-6));
}

TEMPLATE_TEST_CASE("hausdorff: nothing, all sizes, and what is refused", "", float, double) {
    const serial on;
    using T = TestType;
    const mesh<T> none;
    const auto one = square<T>(0, 0, 0, 1);
    CHECK(hausdorff(on, none, none).upper() == 0);
    CHECK(hausdorff(on, one, none).a_from_b.lower == infinity<double>);
    CHECK(hausdorff(on, one, none).b_from_a.upper == 0);
    CHECK(hausdorff(on, none, one).b_from_a.upper == infinity<double>);
    for (const T size : {std::numeric_limits<T>::max() / 4, std::numeric_limits<T>::denorm_min() * 64}) {
        const auto d = hausdorff(on, square<T>(0, 0, 0, size), square<T>(0, 0, size, size));
        CHECK(d.lower() == Approx(static_cast<double>(size)).epsilon(1e-9));
        CHECK(d.upper() >= static_cast<double>(size));
        CHECK(d.upper() <= 1.01 * static_cast<double>(size));
    }
    for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), infinity<double>}) {
        try {
            (void)hausdorff(on, one, one, {.tolerance = bad});
            FAIL("nothing was thrown");
        } catch (const error& e) {
            CHECK(std::string(e.what()).find("abut::hausdorff: tolerance is ") == 0);
        }
    }
}

}  // namespace abut::test
