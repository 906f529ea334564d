// SPDX-License-Identifier: MIT
#include <abut/collide/penetration.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

/// The least move that separates two tetrahedra: the least depth along normals of faces and of pairs of edges (the faces of
/// their Minkowski difference). In long double of integers.
double least_move(const tetrahedron& a, const tetrahedron& b) {
    using normal = std::array<std::int64_t, 3>;
    const auto across = [](const grid_place& p, const grid_place& q, const grid_place& r, const grid_place& s) {
        const std::int64_t u[] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v[] = {s[0] - r[0], s[1] - r[1], s[2] - r[2]};
        return normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    std::vector<normal> all;
    for (const tetrahedron* t : {&a, &b}) {
        for (std::size_t i = 0; i < 4; ++i) all.push_back(across((*t)[i], (*t)[(i + 1) % 4], (*t)[i], (*t)[(i + 2) % 4]));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::size_t l = k + 1; l < 4; ++l) all.push_back(across(a[i], a[j], b[k], b[l]));
            }
        }
    }
    long double least = std::numeric_limits<long double>::max();
    for (const normal& n : all) {
        if (n == normal{0, 0, 0}) continue;
        const auto height = [&](const grid_place& p) { return n[0] * p[0] + n[1] * p[1] + n[2] * p[2]; };
        std::int64_t low_a = height(a[0]), high_a = low_a, low_b = height(b[0]), high_b = low_b;
        for (const grid_place& p : a) low_a = std::min(low_a, height(p)), high_a = std::max(high_a, height(p));
        for (const grid_place& p : b) low_b = std::min(low_b, height(p)), high_b = std::max(high_b, height(p));
        const auto length = std::sqrt(static_cast<long double>(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
        least = std::min(least, static_cast<long double>(std::min(high_a - low_b, high_b - low_a)) / length);
    }
    return static_cast<double>(least);
}

/// The same triangles, moved, each coordinate rounded once.
template <scalar T>
mesh<T> moved(const mesh<T>& m, const vec3<T>& by) {
    std::vector<vec3<T>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    rigid<T> pose;
    pose.translation = by;
    for (std::size_t i = 0; i < m.view().vertices.count; ++i) vertices.push_back(place(pose, m.view().vertices[i]));
    for (std::size_t f = 0; f < m.size(); ++f) faces.push_back(m.view().faces[f]);
    return {vertices, faces};
}

}  // namespace

TEMPLATE_TEST_CASE("penetration: of tetrahedra, against their Minkowski differences", "", float, double) {
    std::uint64_t wrong = 0, too_wide = 0, unlike = 0, deep = 0, much_longer = 0;
    const std::uint64_t count = some_samples(20);
    const serial on;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270801, 1, k);
        const int size = 3 + d.below(5);
        const tetrahedron a = draw_tetrahedron(d, size), b = k % 16 == 0 ? a : draw_tetrahedron(d, size);
        frame_of_grid f;
        f.unit = k % 2 == 0 ? 1 : 0x1p-40;
        const mesh<TestType> x = surface_of<TestType>(a, f), y = surface_of<TestType>(b, f);
        const double tolerance = 0.01 * f.unit;
        const auto found = penetration(on, x, y, {.known_solid = k % 4 != 0, .tolerance = tolerance});
        const solid_relation truth = truth_of(a, b);
        const bool meet = truth != solid_relation::disconnected && truth != solid_relation::externally_connected;
        if (found.overlap != meet) ++wrong;
        if (!meet) {
            if (!(found == penetration_bounds<TestType>{})) ++wrong;
            continue;
        }
        ++deep;
        const double exact = f.unit * least_move(a, b);
        if (found.least > exact * (1 + 1e-12) || found.most < exact * (1 - 1e-12)) ++wrong;
        if (found.most > 1.1 * exact + tolerance) ++much_longer;
        for (const farthest_point& p : {found.a_in_b, found.b_in_a}) {
            if (p.upper - p.lower > tolerance * (1 + 1e-9) || p.lower > exact * (1 + 1e-12)) ++too_wide;
        }
        const mesh<TestType> free = moved(x, found.move);
        if (any(on, free, y) || relation(on, free, y) != solid_relation::disconnected) ++wrong;
        const vec3<double> m{found.move.x, found.move.y, found.move.z};
        if (std::sqrt(dot(m, m)) > found.most || std::sqrt(dot(m, m)) < found.most * (1 - 1e-12)) ++wrong;
        if (!(penetration(openmp{.threads = 3}, make_bvh(on, x), wide(on, make_bvh(on, y)), {.known_solid = true, .tolerance = tolerance}) == found)) {
            ++unlike;
        }
    }
    CHECK(wrong == 0);
    CHECK(too_wide == 0);
    CHECK(unlike == 0);
    CHECK(deep > count / 8);
    CHECK(much_longer <= deep / 10);  // what is tried finds the least move of most convex pairs
}

TEMPLATE_TEST_CASE("penetration: of cells with holes and dents: no sample of a surface is deeper than the bound", "", float, double) {
    std::uint64_t wrong = 0, deep = 0;
    const std::uint64_t count = some_samples(50);
    const serial on;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270801, 2, k);
        const auto [a, b] = draw_two_sets(d, k);
        const mesh<TestType> x = surface_of<TestType>(a, {}, d), y = surface_of<TestType>(b, {}, d, true);
        const auto found = penetration(on, x, y, {.tolerance = 0.02});
        const solid_relation truth = truth_of(a, b);
        if (found.overlap != (truth != solid_relation::disconnected && truth != solid_relation::externally_connected)) ++wrong;
        if (!found.overlap) continue;
        ++deep;
        const mesh<TestType> free = moved(x, found.move);
        if (any(on, free, y) || relation(on, free, y) != solid_relation::disconnected) ++wrong;
        // Points of a's faces on a lattice of quarters, which are exact.
        const auto check = [&](const mesh<TestType>& of, const mesh<TestType>& in, const farthest_point& f) {
            std::vector<vec3<double>> points;
            const auto view = of.view();
            for (std::size_t i = 0; i < view.size(); ++i) {
                const triangle<TestType> t = view[i];
                for (int u = 0; u <= 4; ++u) {
                    for (int v = 0; u + v <= 4; ++v) {
                        const auto at = [&](TestType p, TestType q, TestType r) {
                            return 0.25 * (u * static_cast<double>(p) + v * static_cast<double>(q) + (4 - u - v) * static_cast<double>(r));
                        };
                        points.push_back({at(t.a.x, t.b.x, t.c.x), at(t.a.y, t.b.y, t.c.y), at(t.a.z, t.b.z, t.c.z)});
                    }
                }
            }
            std::vector<vec3<double>> vertices;
            std::vector<std::array<std::uint32_t, 3>> faces;
            for (std::size_t i = 0; i < in.view().vertices.count; ++i) {
                const vec3<TestType> p = in.view().vertices[i];
                vertices.push_back({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
            }
            for (std::size_t i = 0; i < in.size(); ++i) faces.push_back(in.view().faces[i]);
            const mesh<double> solid(vertices, faces);
            const auto where = to_host(inside(on, solid, points));
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (where[i] != containment::inside) continue;
                double least = infinity<double>;
                for (std::size_t j = 0; j < solid.size(); ++j) {
                    const auto way = nearest_point(solid.view()[j], points[i]) - points[i];
                    least = std::min(least, std::sqrt(dot(way, way)));
                }
                if (least > f.upper + 1e-12) ++wrong;
            }
            if (f.face != no_id) {
                const std::vector<vec3<double>> one{f.point};
                if (f.lower > 1e-9 && to_host(inside(on, solid, one))[0] != containment::inside) ++wrong;
            }
            if (f.upper - f.lower > 0.0201) ++wrong;
        };
        check(x, y, found.a_in_b);
        check(y, x, found.b_in_a);
        if (found.least > found.most) ++wrong;
    }
    CHECK(wrong == 0);
    CHECK(deep > count / 8);
}

TEMPLATE_TEST_CASE("penetration: a needle through a cube is deepest far from all of its corners", "", float, double) {
    using T = TestType;
    const mesh<T> needle{{{-20, 0, 0}, {2, T(0.125), 0}, {2, T(-0.125), 0}, {2, 0, T(0.125)}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    const auto found = penetration(serial{}, needle, aabb<T>{{-1, -1, -1}, {1, 1, 1}}, {.tolerance = 0.01});
    // One of its faces goes through the middle of the cube.
    CHECK(found.a_in_b.lower > 0.985);
    CHECK(found.a_in_b.upper >= 1);
    CHECK(found.a_in_b.upper < 1.015);
    CHECK(std::abs(found.a_in_b.point.x) < 0.02);
}

TEMPLATE_TEST_CASE("penetration: walls, boxes in boxes, and what is refused", "", float, double) {
    const serial on;
    using T = TestType;
    const aabb<T> wall{{0, 0, 0}, {3, 1, 1}};
    const auto clash = penetration(on, wall, aabb<T>{{T(2.9375), 0, 0}, {5, 1, 1}});
    CHECK(clash.overlap);
    CHECK(clash.least == Approx(0.0625).epsilon(1e-6));
    CHECK(clash.most == Approx(0.0625).epsilon(1e-3));
    CHECK(clash.most >= 0.0625);
    CHECK(static_cast<double>(clash.move.x) == Approx(-clash.most));
    CHECK_FALSE(penetration(on, wall, aabb<T>{{3, 0, 0}, {5, 1, 1}}).overlap);
    const auto nested = penetration(on, aabb<T>{{0, 0, 0}, {3, 3, 3}}, aabb<T>{{1, 1, 1}, {2, 2, 2}}, {.tolerance = 1e-4});
    CHECK(nested.a_in_b.face == no_id);
    CHECK(nested.a_in_b.upper <= 1e-4);
    CHECK(nested.b_in_a.lower == Approx(1));
    CHECK(nested.most == Approx(2).epsilon(1e-3));
    const rigid<T> away{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {T(2.5), 0, 0}};
    const auto of_mesh = boundary(wall);
    CHECK(penetration(on, make_bvh(on, of_mesh), posed(make_bvh(on, of_mesh), away)).least == Approx(0.5).epsilon(1e-6));
    const mesh<T> open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    CHECK_THROWS_AS(penetration(on, of_mesh, open), invalid_geometry);
    try {
        (void)penetration(on, of_mesh, of_mesh, {.tolerance = -1});
        FAIL("nothing was thrown");
    } catch (const error& e) {
        CHECK(std::string(e.what()).find("abut::penetration: tolerance is -1") == 0);
    }
    CHECK_FALSE(penetration(on, of_mesh, mesh<T>{}).overlap);
}

}  // namespace abut::test
