// SPDX-License-Identifier: MIT
#include <abut/collide/boundary.hpp>

#include <array>
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

template <scalar T>
hull<T> hull_of(const std::vector<vec3<T>>& points) {
    return {points.data(), points.size()};
}

/// The surface of points of a grid is closed, turned outwards, and no point is beyond a face; all in integers.
template <scalar T>
bool is_boundary(const mesh<T>& surface, const std::vector<grid_place>& of, T unit) {
    const serial on;
    const mesh_report report = validate(on, surface);
    if (!report.closed() || !report.manifold() || !report.oriented() || !report.unused_vertices.empty()) return false;
    if (report.euler_characteristic != 2 || !report.coincident_vertices.empty()) return false;
    const auto view = surface.view();
    const auto at = [&](std::uint32_t v) {
        const vec3<T> p = view.vertices[v];
        return grid_place{static_cast<int>(p.x / unit), static_cast<int>(p.y / unit), static_cast<int>(p.z / unit)};
    };
    for (std::size_t f = 0; f < view.size(); ++f) {
        bool has_behind = false;
        for (const grid_place& p : of) {
            const std::int64_t beyond = volume_of(at(view.faces[f][0]), at(view.faces[f][1]), at(view.faces[f][2]), p);
            if (beyond > 0) return false;
            has_behind |= beyond < 0;
        }
        if (!has_behind) return false;  // a face without area
    }
    return true;
}

}  // namespace

TEMPLATE_TEST_CASE("boundary: of hulls of points of a grid, closed, convex, and of all of them", "", float, double) {
    std::uint64_t wrong = 0, flat = 0;
    const std::uint64_t count = some_samples(2);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270601, 1, k);
        const int size = 2 + d.below(5);
        const TestType unit = k % 2 == 0 ? TestType(1) : TestType(0x1p-30);
        std::vector<grid_place> grid;
        std::vector<vec3<TestType>> points;
        bool has_volume = false;
        for (int n = 4 + d.below(k % 8 == 0 ? 200 : 12); n > 0; --n) {
            grid.push_back({d.below(size), d.below(size), d.below(size)});
            const grid_place& p = grid.back();
            points.push_back({unit * static_cast<TestType>(p[0]), unit * static_cast<TestType>(p[1]), unit * static_cast<TestType>(p[2])});
        }
        for (std::size_t i = 1; i < grid.size() && !has_volume; ++i) {
            for (std::size_t j = 1; j < i && !has_volume; ++j) {
                for (std::size_t l = 1; l < j; ++l) has_volume |= volume_of(grid[0], grid[l], grid[j], grid[i]) != 0;
            }
        }
        if (!has_volume) {
            // All determinants with the first point vanish: all are in one plane.
            ++flat;
            try {
                (void)boundary(hull_of(points));
                ++wrong;
            } catch (const invalid_geometry& e) {
                if (std::string(e.what()).find("abut::boundary: shape 0: a solid has a volume") != 0) ++wrong;
            }
            continue;
        }
        if (!is_boundary(boundary(hull_of(points)), grid, unit)) ++wrong;
    }
    CHECK(wrong == 0);
    CHECK((flat > 0 || count < 500));
}

TEMPLATE_TEST_CASE("boundary: of boxes, along axes and turned, at all sizes", "", float, double) {
    const serial on;
    for (const TestType size : {TestType(1), std::numeric_limits<TestType>::denorm_min() * 8, std::numeric_limits<TestType>::max() / 4}) {
        const aabb<TestType> box{{-size, 0, size / 2}, {size, size, size}};
        const auto surface = boundary(box);
        CHECK(surface.size() == 12);
        CHECK(surface.view().vertices.count == 8);
        const mesh_report report = validate(on, surface);
        CHECK(report.closed());
        CHECK(report.oriented());
        CHECK(relation(on, box, surface) == solid_relation::equal);
    }
    const rigid<TestType> quarter{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {8, 0, 0}};
    const aabb<TestType> box{{0, 0, 0}, {1, 2, 3}};
    CHECK(relation(on, posed(box, quarter), aabb<TestType>{{6, 0, 0}, {8, 1, 3}}) == solid_relation::equal);
    oriented_box<TestType> turned;
    turned.center = {TestType(0.5), 1, TestType(1.5)};
    turned.half = {1, TestType(0.5), TestType(1.5)};
    for (std::size_t i = 0; i < 9; ++i) turned.rotation[i] = quarter.rotation[i];
    CHECK(relation(on, turned, box) == solid_relation::equal);
    CHECK(overlaps(on, turned, posed(turned, rigid<TestType>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0}})) == false);
    CHECK(relation(on, turned, posed(turned, rigid<TestType>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0}})) ==
          solid_relation::externally_connected);
    CHECK_THROWS_AS(boundary(aabb<TestType>{{0, 0, 0}, {1, 1, 0}}), invalid_geometry);
    CHECK_THROWS_AS(boundary(aabb<TestType>{{0, 0, 0}, {1, 1, -1}}), invalid_geometry);
    CHECK_THROWS_AS(overlaps(on, box, aabb<TestType>{{0, 0, 0}, {1, 1, 0}}), invalid_geometry);
}

TEMPLATE_TEST_CASE("relation: boxes and hulls as shapes, against planes in integers", "", float, double) {
    std::uint64_t wrong = 0;
    std::array<std::uint64_t, 8> of{};
    const serial on;
    const std::uint64_t count = some_samples(1);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270601, 2, k);
        const int size = 3 + d.below(4);
        tetrahedron_of_grid a = draw_tetrahedron(d, size), b = k % 16 == 0 ? a : draw_tetrahedron(d, size);
        if (k % 16 == 1) {  // within the other one
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    int sum = 0;
                    for (std::size_t j = 0; j < 4; ++j) sum += a[j][c] * (k % 32 == 1 ? (i == j ? 5 : 1) : (i == j ? 8 : 0));
                    b[i][c] = sum;
                }
            }
            if (k % 32 != 1) b[0] = {4 * a[0][0] + 4 * a[1][0], 4 * a[0][1] + 4 * a[1][1], 4 * a[0][2] + 4 * a[1][2]};
            for (grid_place& p : a) {
                for (int& x : p) x *= 8;
            }
            if (volume_of(b[0], b[1], b[2], b[3]) < 0) std::swap(b[0], b[1]);
            if (k % 64 > 32) std::swap(a, b);
        }
        // Corners in any order, each perhaps twice, and points between them.
        const auto points_of_tetrahedron = [&](const tetrahedron_of_grid& t) {
            std::vector<vec3<TestType>> points;
            const auto at = [&](std::size_t i) {
                return vec3<TestType>{static_cast<TestType>(t[i][0]), static_cast<TestType>(t[i][1]), static_cast<TestType>(t[i][2])};
            };
            for (std::size_t i = 0; i < 4; ++i) points.push_back(at((i + k) % 4));
            for (int n = d.below(6); n > 0; --n) {
                const auto i = static_cast<std::size_t>(d.below(4)), j = static_cast<std::size_t>(d.below(4)),
                           l = static_cast<std::size_t>(d.below(4));
                const vec3<TestType> p = TestType(0.25) * (at(i) + at(j) + at(l) + at(l));
                points.insert(points.begin() + d.below(static_cast<int>(points.size())), p);
            }
            return points;
        };
        const auto x = points_of_tetrahedron(a), y = points_of_tetrahedron(b);
        const solid_relation truth = truth_of(a, b), said = relation(on, hull_of(x), hull_of(y));
        wrong += said != truth;
        ++of[static_cast<std::size_t>(truth)];
        const bool meet = truth != solid_relation::disconnected && truth != solid_relation::externally_connected;
        wrong += overlaps<exact>(openmp{.threads = 2}, hull_of(x), surface_of<TestType>(b, {})) != meet;
        wrong += relation(on, make_bvh(on, surface_of<TestType>(a, {})), hull_of(y)) != truth;
        // Boxes by their corners, which are cells.
        cells first, second;
        const auto box = [&](cells& c) {
            const grid_place s{1 + d.below(3), 1 + d.below(3), 1 + d.below(3)};
            for (int i = 0; i < s[0] * s[1] * s[2]; ++i) c.in.insert({i % s[0], i / s[0] % s[1], i / s[0] / s[1]});
            for (int& o : c.offset) o = d.below(4);
            const auto t = [](int v) { return static_cast<TestType>(v); };
            return aabb<TestType>{{t(c.offset[0]), t(c.offset[1]), t(c.offset[2])},
                                  {t(c.offset[0] + s[0]), t(c.offset[1] + s[1]), t(c.offset[2] + s[2])}};
        };
        const auto p = box(first), q = box(second);
        wrong += relation(on, p, q) != truth_of(first, second);
        ++of[static_cast<std::size_t>(truth_of(first, second))];
    }
    CHECK(wrong == 0);
    for (const std::uint64_t n : of) CHECK((n > 0 || count < 1000));
}

}  // namespace abut::test
