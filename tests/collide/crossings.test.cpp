// SPDX-License-Identifier: MIT
#include <abut/collide/curves.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <abut/io/read.hpp>

#include "collide/crossing_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"
#include "support/needs.hpp"
#include "support/samples.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("crossings: serial and openmp", "", float, double) {
    check_crossings<TestType>(serial{});
    check_crossings<TestType>(openmp{.threads = 3});
    check_self_crossings<TestType>(serial{});
    check_self_crossings<TestType>(openmp{.threads = 3});
}

namespace {

template <scalar T>
double length_of(const curve<T>& c) {
    double sum = 0;
    for (std::size_t i = 0; i < c.segments(); ++i) {
        const auto p = detail::widened(c.points[i]), q = detail::widened(c.points[i + 1 == c.points.size() ? 0 : i + 1]);
        sum += std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z));
    }
    return sum;
}

/// Whether each segment of crossings in general position is in one curve once, the way that it runs.
template <scalar T>
bool take_each_segment_once(const std::vector<curve<T>>& all, const std::vector<crossing<T>>& of) {
    std::vector<std::array<vec3<double>, 2>> expected, found;
    for (const auto& c : of) {
        if (c.count == 2) expected.push_back({detail::widened(c.points[0]), detail::widened(c.points[1])});
    }
    for (const auto& c : all) {
        for (std::size_t i = 0; i < c.segments(); ++i) {
            if (c.pairs_of(i).size() != 1) return false;
            const index_pair ids = c.pairs_of(i)[0];
            const auto in = std::lower_bound(of.begin(), of.end(), ids, [](const auto& x, const index_pair& y) {
                return x.a != y.a ? x.a < y.a : x.b < y.b;
            });
            const vec3<T>&p = c.points[i], &q = c.points[i + 1 == c.points.size() ? 0 : i + 1];
            if (in == of.end() || in->a != ids.a || in->b != ids.b || in->points[0] != p || in->points[1] != q) return false;
            found.push_back({detail::widened(p), detail::widened(q)});
        }
    }
    const auto less = [](const auto& x, const auto& y) {
        const auto key = [](const auto& s) { return std::array{s[0].x, s[0].y, s[0].z, s[1].x, s[1].y, s[1].z}; };
        return key(x) < key(y);
    };
    std::sort(expected.begin(), expected.end(), less);
    std::sort(found.begin(), found.end(), less);
    return expected.size() == found.size() && std::equal(expected.begin(), expected.end(), found.begin());
}

/// A box whose sides are cut into squares, by one diagonal or the other.
template <scalar T>
mesh<T> box_of_squares(const vec3<T>& from, const vec3<T>& size, int n, int diagonal) {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    const auto at = [&](const std::array<int, 3>& p) {
        const auto coordinate = [&](T start, T length, int i) { return start + length * static_cast<T>(i) / static_cast<T>(n); };
        const vec3<T> v{coordinate(from.x, size.x, p[0]), coordinate(from.y, size.y, p[1]), coordinate(from.z, size.z, p[2])};
        const auto known = std::find(vertices.begin(), vertices.end(), v);
        if (known == vertices.end()) vertices.push_back(v);
        return static_cast<std::uint32_t>(std::find(vertices.begin(), vertices.end(), v) - vertices.begin());
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int up : {0, 1}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    std::array<std::uint32_t, 4> ring{};
                    for (int k = 0; k < 4; ++k) {
                        std::array<int, 3> p{};
                        p[axis] = up * n;
                        p[(axis + 1) % 3] = i + (k == 1 || k == 2);
                        p[(axis + 2) % 3] = j + (k >= 2);
                        ring[static_cast<std::size_t>(k)] = at(p);
                    }
                    if (up == 0) std::swap(ring[1], ring[3]);
                    if (diagonal != 0) std::rotate(ring.begin(), ring.begin() + 1, ring.end());
                    faces.push_back({ring[0], ring[1], ring[2]});
                    faces.push_back({ring[0], ring[2], ring[3]});
                }
            }
        }
    }
    return {vertices, faces};
}

}  // namespace

TEMPLATE_TEST_CASE("curves: two balls cross in closed curves", "", float, double) {
    using T = TestType;
    const serial on;
    const mesh<T> ball = mesh_of(ball_surface<T>(3, 1));
    std::size_t closed = 0;
    for (std::uint64_t k = 0; k < 30; ++k) {
        draws d(20270515, 2, k);
        const auto pose = make_loose_pose<T>(d, 0.8);
        const auto found = to_host(crossings(on, ball, posed(ball, pose)));
        const auto all = curves(on, std::span<const crossing<T>>(found));
        for (const auto& c : all) {
            CHECK(c.closed);
            CHECK(c.points.size() == c.segments());
            ++closed;
        }
        CHECK(take_each_segment_once(all, found));
        // The same of the policy's result, and of openmp.
        const auto again = curves(openmp{}, crossings(openmp{.threads = 3}, make_bvh(openmp{}, ball), posed(ball, pose)));
        REQUIRE(again.size() == all.size());
        for (std::size_t i = 0; i < all.size(); ++i) CHECK((again[i].points == all[i].points && again[i].faces == all[i].faces));
    }
    CHECK(closed >= 20);
}

TEMPLATE_TEST_CASE("curves: the border of what faces share in one plane", "", float, double) {
    using T = TestType;
    const serial on;
    for (const int n : {1, 2, 3}) {
        for (const int diagonals : {0, 1, 2, 3}) {
            for (const T shift : {T(0), T(0.5), T(1.0 / 3), T(0.25)}) {
                CAPTURE(n, diagonals, shift);
                // One on the other.
                const mesh<T> below = box_of_squares<T>({0, 0, 0}, {3, 3, 1}, n, diagonals & 1);
                const mesh<T> above = box_of_squares<T>({shift, shift, 1}, {3, 3, 1}, n, diagonals >> 1);
                const auto all = curves(on, crossings(on, below, above));
                REQUIRE(all.size() == 1);
                CHECK(all[0].closed);
                CHECK(std::abs(length_of(all[0]) - 4 * (3 - static_cast<double>(shift))) < 1e-5);
                for (const auto& p : all[0].points) CHECK(p.z == 1);
            }
            // A small one within a side.
            const auto inner = curves(on, crossings(on, box_of_squares<T>({0, 0, 0}, {4, 4, 1}, n, diagonals & 1),
                                                    box_of_squares<T>({1, 1, 1}, {1, 2, 1}, n, diagonals >> 1)));
            REQUIRE(inner.size() == 1);
            CHECK(inner[0].closed);
            CHECK(std::abs(length_of(inner[0]) - 6) < 1e-5);
        }
    }
}

TEST_CASE("curves: open ones, and where they end") {
    const serial on;
    // A square through a box: closed. A square whose border is within the box: open.
    const mesh<double> box = box_of_squares<double>({0, 0, 0}, {2, 2, 2}, 2, 0);
    const auto square = [](double half) {
        return mesh<double>({{1 - half, 1.1 - half, 0.7}, {1 + half, 1.1 - half, 0.8}, {1 + half, 1.1 + half, 0.75}, {1 - half, 1.1 + half, 0.65}},
                            {{0, 1, 2}, {0, 2, 3}});
    };
    const auto through = curves(on, crossings(on, box, square(5)));
    REQUIRE(through.size() == 1);
    CHECK(through[0].closed);
    const auto within = curves(on, crossings(on, box, square(0.95)));
    REQUIRE(within.size() == 1);
    CHECK_FALSE(within[0].closed);
    CHECK(within[0].features_b.front().part == mesh_part::on_edge);
    CHECK(within[0].features_b.back().part == mesh_part::on_edge);
    // Soups do not know their neighbours.
    std::vector<triangle<double>> corners;
    for (std::size_t i = 0; i < box.size(); ++i) corners.push_back(box.view()[i]);
    const auto torn = curves(on, crossings(on, triangle_soup<double>(corners), square(5)));
    CHECK(torn.size() > 1);
    // An edge along a side touches: one open line.
    const mesh<double> roof({{0.5, 0.5, 2}, {1.5, 0.5, 2}, {1, 0.5, 3}, {1, 1.5, 3}}, {{0, 1, 2}, {1, 0, 3}});
    const auto touching = curves(on, crossings(on, box, roof));
    REQUIRE(touching.size() == 1);
    CHECK_FALSE(touching[0].closed);
    CHECK(std::abs(length_of(touching[0]) - 1) < 1e-12);
    for (std::size_t i = 0; i < touching[0].segments(); ++i) CHECK(touching[0].pairs_of(i).size() >= 2);
    CHECK(curves(on, crossings(on, box, mesh<double>())).empty());
}

TEMPLATE_TEST_CASE("curves: a mesh that crosses itself", "", float, double) {
    using T = TestType;
    const serial on;
    const auto ball = ball_surface<T>(3, 1);
    auto two = ball;
    const auto n = static_cast<std::uint32_t>(ball.vertices.size());
    for (const auto& v : ball.vertices) two.vertices.push_back({v.x + T(0.31), v.y + T(0.22), v.z - T(0.17)});
    for (auto f : ball.faces) {
        for (auto& v : f) v += n;
        two.faces.push_back(f);
    }
    const auto all = curves(on, self_crossings(on, mesh_of(two)));
    REQUIRE(all.size() == 1);
    CHECK(all[0].closed);
    CHECK(all[0].points.size() > 20);
}

TEST_CASE("curves: of real meshes that are closed, all are closed") {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const serial on;
    std::size_t broken = 0, all_curves = 0;
    for (const char* name : {"armadillo_2766.ply", "armadillo_27674.ply", "spot.obj"}) {
        const auto mesh = io::read_mesh<float>(*folder / name);
        float reach = 0;
        for (std::size_t i = 0; i < mesh.view().vertices.count; ++i) reach = std::max(reach, std::abs(mesh.view().vertices[i].x));
        const auto tree = make_bvh(on, mesh);
        const std::uint64_t poses = sample_count() > 100000 ? 50 : 5;
        for (std::uint64_t k = 0; k < poses; ++k) {
            draws d(20270515, 3, k);
            const auto pose = make_loose_pose<float>(d, static_cast<double>(reach) / 4);
            const auto found = to_host(crossings(on, tree, posed(tree, pose)));
            const auto all = curves(on, std::span<const crossing<float>>(found));
            for (const auto& c : all) broken += !c.closed;
            CHECK(take_each_segment_once(all, found));
            all_curves += all.size();
        }
    }
    CHECK(all_curves > 30);
    CHECK(broken == 0);
}

}  // namespace abut::test
