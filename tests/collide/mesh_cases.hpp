// SPDX-License-Identifier: MIT
#pragma once

// Meshes against meshes on every policy: through each index with each other, under poses, at extreme scales, in places
// where everything touches. The truth is known from how a scene was made, where it can be; elsewhere it is a plain loop over
// `intersects<exact>`, whose own truth is tests/predicate.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include <abut/abut.hpp>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

template <scalar T>
struct placed_mesh {
    mesh<T> shape;
    rigid<T> pose;

    [[nodiscard]] std::vector<triangle<T>> triangles() const {
        std::vector<triangle<T>> all(shape.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = place(pose, shape.view()[i]);
        return all;
    }
};

template <scalar T>
mesh<T> as_mesh(const surface_data<T>& s) {
    return {s.vertices, s.faces};
}

/// The plain loop. Boxes come first, or else it would be what a test spends its time on.
template <scalar T>
pair_list exact_pairs(const placed_mesh<T>& a, const placed_mesh<T>& b) {
    const auto of_a = a.triangles(), of_b = b.triangles();
    std::vector<aabb<T>> boxes;
    for (const triangle<T>& t : of_b) boxes.push_back(bounds(t));
    pair_list touching;
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
        const aabb<T> box = bounds(of_a[i]);
        for (std::uint32_t j = 0; j < of_b.size(); ++j) {
            const aabb<T>& other = boxes[j];
            if (box.lower.x > other.upper.x || box.upper.x < other.lower.x || box.lower.y > other.upper.y ||
                box.upper.y < other.lower.y || box.lower.z > other.upper.z || box.upper.z < other.lower.z) {
                continue;
            }
            if (intersects<exact>(of_a[i], of_b[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Pairs of faces of one mesh that have a vertex in common, each face with itself too: all that touch, where a surface does
/// not meet itself elsewhere.
template <scalar T>
pair_list neighbours(const mesh<T>& shape) {
    const auto view = shape.view();
    std::vector<std::vector<std::uint32_t>> faces_of(view.vertices.count);
    for (std::uint32_t f = 0; f < view.size(); ++f) {
        for (const std::uint32_t v : view.faces[f]) faces_of[v].push_back(f);
    }
    pair_list all;
    for (std::uint32_t f = 0; f < view.size(); ++f) {
        for (const std::uint32_t v : view.faces[f]) {
            for (const std::uint32_t g : faces_of[v]) all.push_back({f, g});
        }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

// --- how a query is asked
// ---------------------------------------------------------------------------------------------------

/// Two trees, the way that large scenes are asked.
template <scalar T, class Policy>
void check_trees(const Policy& on, const placed_mesh<T>& a, const placed_mesh<T>& b, const pair_list& expected) {
    CAPTURE(a.shape.size(), b.shape.size(), expected.size());
    const auto x = posed(make_bvh(on, copy_to(on, a.shape)), a.pose), y = posed(make_bvh(on, copy_to(on, b.shape)), b.pose);
    CHECK(to_host(pairs(on, x, y)) == expected);
    CHECK(to_host(pairs(on, y, x)) == mirrored(expected));
    CHECK(count(on, x, y) == expected.size());
    CHECK(any(on, x, y) == !expected.empty());
}

/// Every kind of side meets every other once: sets, trees of each length of code, grids of each width, in either order; the
/// query and its arithmetic change from meeting to meeting, and `turn` shifts which meets which.
template <scalar T, class Policy>
void check_ways(const Policy& on, const placed_mesh<T>& a, const placed_mesh<T>& b, const pair_list& expected,
                std::size_t turn) {
    const auto set_a = copy_to(on, a.shape), set_b = copy_to(on, b.shape);
    const int bits[] = {0, 30, 63};
    const double widths[] = {0, 0.05, 1e6};
    const std::size_t i = turn % 3, j = (turn / 3) % 3;
    CAPTURE(a.shape.size(), b.shape.size(), expected.size(), bits[i], bits[j], widths[i], widths[j]);
    const auto plain_a = posed(set_a, a.pose), plain_b = posed(set_b, b.pose);
    const auto tree_a = posed(make_bvh(on, set_a, {.morton_bits = bits[i]}), a.pose);
    const auto tree_b = posed(make_bvh(on, set_b, {.morton_bits = bits[j]}), b.pose);
    const auto grid_a = posed(make_grid(on, set_a, widths[i]), a.pose);
    const auto grid_b = posed(make_grid(on, set_b, widths[j]), b.pose);
    const pair_list back = mirrored(expected);
    CHECK(to_host(pairs<exact>(on, tree_a, tree_b)) == expected);
    CHECK(to_host(pairs(on, tree_b, tree_a)) == back);
    CHECK(to_host(pairs(on, tree_a, plain_b)) == expected);
    CHECK(to_host(pairs(on, plain_a, tree_b)) == expected);
    CHECK(to_host(pairs(on, grid_a, tree_b)) == expected);
    CHECK(to_host(pairs(on, grid_b, tree_a)) == back);
    CHECK(to_host(pairs(on, grid_a, plain_b)) == expected);
    CHECK(to_host(pairs(on, plain_a, plain_b, query_options<>{.resident = turn % 2 == 0 ? argument::a : argument::b})) ==
          expected);
    CHECK(count(on, plain_a, grid_b) == expected.size());
    CHECK(count(on, tree_a, grid_b) == expected.size());
    CHECK(any(on, plain_a, tree_b) == !expected.empty());
    CHECK(any(on, grid_a, grid_b) == !expected.empty());
}

// --- scenes
// -----------------------------------------------------------------------------------------------------------------

/// Two surfaces under random poses, which cross, graze or miss.
template <scalar T, class Policy>
void check_random_poses(const Policy& on, int scenes) {
    constexpr std::uint64_t seed = 20261125;
    const torus<T> ring(20, 10, 2, 0.7);
    const mesh<T> first(ring.vertices, ring.faces), second = as_mesh(ball_surface<T>(3, 1.5));
    int meet = 0;
    std::size_t hits = 0;
    for (int k = 0; k < scenes; ++k) {
        draws d(seed, 81, static_cast<std::uint64_t>(k));
        const double far = k % 4 == 3 ? 100 : 0;  // both moved away together
        placed_mesh<T> a{first, make_pose<T>(d, 0)}, b{second, make_pose<T>(d, 2.6)};
        const vec3<T> away{static_cast<T>(far), static_cast<T>(-far), static_cast<T>(far / 3)};
        a.pose.translation = away;
        b.pose.translation = b.pose.translation + away;
        const pair_list expected = exact_pairs(a, b);
        CAPTURE(k);
        check_ways(on, a, b, expected, static_cast<std::size_t>(k));
        meet += expected.empty() ? 0 : 1;
        hits += expected.size();
    }
    std::printf("meshes under random poses: seed %llu, %d of %d pairs meet, %zu hits\n",
                static_cast<unsigned long long>(seed), meet, scenes, hits);
    CHECK(meet > scenes / 2);
    CHECK(meet < scenes);
    CHECK(hits > 20u * static_cast<std::size_t>(scenes));
}

/// A surface onto itself, under one pose and without: all that share a vertex touch, and nothing else.
template <scalar T, class Policy>
void check_onto_itself(const Policy& on) {
    const torus<T> ring(60, 30, 2, 0.7);
    const std::vector<mesh<T>> shapes{{ring.vertices, ring.faces}, as_mesh(ball_surface<T>(4, 1.5))};
    for (const mesh<T>& shape : shapes) {
        const pair_list expected = neighbours(shape);
        CHECK(expected.size() > 12 * shape.size());  // all but a few vertices have six faces
        for (std::uint64_t k = 0; k < 3; ++k) {
            draws d(20261126, 82, k);
            const rigid<T> pose = k == 0 ? rigid<T>{} : make_pose<T>(d, 3);
            CAPTURE(k);
            check_trees(on, placed_mesh<T>{shape, pose}, placed_mesh<T>{shape, pose}, expected);
        }
        // Not posed: the same index on both sides, and the same arrays.
        const auto set = copy_to(on, shape);
        const auto tree = make_bvh(on, set);
        CHECK(to_host(pairs(on, tree, tree)) == expected);
        CHECK(to_host(pairs<exact>(on, set, tree)) == expected);
        CHECK(count(on, make_grid(on, set), set) == expected.size());
    }
}

/// A surface in another that it does not reach: surfaces are not solid.
template <scalar T, class Policy>
void check_nested(const Policy& on) {
    const placed_mesh<T> outer{as_mesh(ball_surface<T>(4, 1)), {}};
    for (const double radius : {0.99, 0.5, 1e-3}) {
        CAPTURE(radius);
        check_trees(on, outer, placed_mesh<T>{as_mesh(ball_surface<T>(4, radius)), {}}, {});
    }
}

/// What touches of two cubes of side 2n, the second of which stands on the first, in plane z = 2n: from each face the
/// corners that lie there, and of these the hulls, in integers.
inline pair_list stacked_truth(const cube_surface& cube, int n, const lattice_point& shift) {
    using corners = std::vector<std::array<std::int64_t, 2>>;
    const auto in_plane = [&](const face& f, std::int64_t height, std::int64_t x, std::int64_t y) {
        corners found;
        for (const std::uint32_t v : f) {
            const lattice_point& p = cube.vertices[v];
            if (p[2] == height) found.push_back({p[0] + x, p[1] + y});
        }
        return found;
    };
    pair_list touching;
    if (shift[2] != 2 * n) return touching;
    for (std::uint32_t i = 0; i < cube.faces.size(); ++i) {
        const corners a = in_plane(cube.faces[i], 2 * n, 0, 0);
        for (std::uint32_t j = 0; !a.empty() && j < cube.faces.size(); ++j) {
            const corners b = in_plane(cube.faces[j], 0, shift[0], shift[1]);
            if (!b.empty() && flat_hulls_touch(a, b)) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Two shells that touch along a plane, a line or in a point: everything that is decided there is a tie. Also turned by
/// quarters, where nothing is rounded.
template <scalar T, class Policy>
void check_stacked(const Policy& on) {
    constexpr int n = 5;
    const cube_surface cube(n);
    const mesh<T> lower = cube.as_mesh<T>({0, 0, 0});
    const struct {
        lattice_point shift;
        std::size_t least;  // each square in the plane that both cubes share is two faces of each, which meet in an area
    } cases[] = {{{0, 0, 2 * n}, 2 * n * n}, {{2, 4, 2 * n}, 4 * (n - 1) * (n - 2)},
                 {{1, 0, 2 * n}, 2 * n * n}, {{3, -5, 2 * n}, 2 * (n - 2)},
                 {{2 * n, 0, 2 * n}, 2 * n}, {{2 * n, 3, 2 * n}, 2},
                 {{2 * n, 2 * n, 2 * n}, 1}, {{2 * n + 1, 0, 2 * n}, 0},
                 {{0, 0, 2 * n + 1}, 0},     {{-2 * n, -2 * n, 2 * n}, 1}};
    std::size_t turn = 0, hits = 0;
    for (const auto& c : cases) {
        CAPTURE(c.shift[0], c.shift[1], c.shift[2]);
        const mesh<T> upper = cube.as_mesh<T>(c.shift);
        const pair_list expected = stacked_truth(cube, n, c.shift);
        CHECK(expected.size() >= c.least);
        CHECK(expected.empty() == (c.least == 0));
        hits += expected.size();
        draws d(20261127, 83, turn);
        rigid<T> pose;
        if (turn % 2 == 1) {
            construction::set_quarter_turns(pose, d);
            pose.translation = {T(3), T(-7), T(100)};
        }
        check_ways(on, placed_mesh<T>{lower, pose}, placed_mesh<T>{upper, pose}, expected, turn);
        if (turn % 2 == 0) {  // in one frame
            const auto x = make_bvh(on, copy_to(on, lower)), y = make_bvh(on, copy_to(on, upper));
            CHECK(to_host(pairs(on, x, y)) == expected);
            CHECK(count(on, y, x) == expected.size());
        }
        // By the translation alone, which is exact here as well.
        const auto shift = [&](int i) { return static_cast<T>(c.shift[static_cast<std::size_t>(i)]); };
        rigid<T> raised;
        raised.translation = {shift(0), shift(1), shift(2)};
        check_trees(on, placed_mesh<T>{lower, {}}, placed_mesh<T>{lower, raised}, expected);
        ++turn;
    }
    std::printf("stacked shells: %zu hits\n", hits);
    // One unit in the last place above, and nothing touches; below, and the two cross.
    rigid<T> above, below;
    above.translation.z = std::nextafter(T(2 * n), T(100));
    below.translation.z = std::nextafter(T(2 * n), T(0));
    check_trees(on, placed_mesh<T>{lower, {}}, placed_mesh<T>{lower, above}, {});
    const pair_list crossing = exact_pairs(placed_mesh<T>{lower, {}}, placed_mesh<T>{lower, below});
    CHECK(!crossing.empty());
    check_trees(on, placed_mesh<T>{lower, {}}, placed_mesh<T>{lower, below}, crossing);
}

template <scalar T>
mesh<T> scaled(const mesh<T>& shape, T factor) {
    const auto view = shape.view();
    surface_data<T> made;
    for (std::size_t v = 0; v < view.vertices.count; ++v) {
        const vec3<T> p = view.vertices[v];
        made.vertices.push_back({p.x * factor, p.y * factor, p.z * factor});
    }
    for (std::size_t f = 0; f < view.size(); ++f) made.faces.push_back(view.faces[f]);
    return as_mesh(made);
}

/// Scenes of any size in units. A power of two changes no answer; other factors round, and the truth is the loop's.
template <scalar T, class Policy>
void check_scales(const Policy& on) {
    const torus<T> ring(20, 10, 2, 0.7);
    const mesh<T> first(ring.vertices, ring.faces), second = as_mesh(ball_surface<T>(3, 1.5));
    const T factors[] = {T(1e-10), T(1e10), T(0x1p-33), T(0x1p33)};
    std::size_t turn = 0, hits = 0;
    for (std::uint64_t k = 0; k < 3; ++k) {
        draws d(20261128, 84, k);
        rigid<T> pose = k == 0 ? rigid<T>{} : make_pose<T>(d, 0);
        pose.translation = {T(1.5), T(0.25), T(-0.5)};
        const placed_mesh<T> a{first, {}}, b{second, pose};
        const pair_list unscaled = exact_pairs(a, b);
        CHECK(unscaled.size() > 100);
        for (const T factor : factors) {
            rigid<T> moved = pose;
            moved.translation = {factor * pose.translation.x, factor * pose.translation.y, factor * pose.translation.z};
            const placed_mesh<T> c{scaled(first, factor), {}}, e{scaled(second, factor), moved};
            int exponent = 0;
            const bool is_power = std::frexp(factor, &exponent) == T(0.5);
            const pair_list expected = is_power ? unscaled : exact_pairs(c, e);
            CAPTURE(k, static_cast<double>(factor));
            // Rounding moves vertices by 1e-7 of the scene at most: few pairs can change.
            CHECK(expected.size() * 100 > unscaled.size() * 95);
            CHECK(expected.size() * 95 < unscaled.size() * 100);
            check_ways(on, c, e, expected, turn++);
            hits += expected.size();
        }
    }
    std::printf("scaled meshes: %zu hits\n", hits);
    CHECK(hits > 1200);
}

/// What `validate` says of these scenes: of each surface, and of two shells as one mesh.
template <scalar T, class Policy>
void check_reports(const Policy& on) {
    const auto is_sound = [&](const mesh<T>& shape, std::uint64_t pieces, std::int64_t euler) {
        const mesh_report r = validate(on, copy_to(on, shape));
        CHECK(r.closed());
        CHECK(r.manifold());
        CHECK(r.oriented());
        CHECK(2 * r.edges == 3 * r.faces);
        CHECK(r.components == pieces);
        CHECK(r.euler_characteristic == euler);
        CHECK(r.zero_area_faces.empty());
        return r.coincident_vertices.size();
    };
    const torus<T> ring(20, 10, 2, 0.7);
    CHECK(is_sound(mesh<T>(ring.vertices, ring.faces), 1, 0) == 0);
    CHECK(is_sound(as_mesh(ball_surface<T>(3, 1.5)), 1, 2) == 0);
    CHECK(is_sound(scaled(as_mesh(ball_surface<T>(3, 1.5)), T(1e-10)), 1, 2) == 0);
    constexpr int n = 5;
    const cube_surface cube(n);
    const struct {
        lattice_point shift;
        std::size_t coincident;  // lattice points that both cubes have
    } cases[] = {
        {{0, 0, 2 * n}, (n + 1) * (n + 1)}, {{2, 4, 2 * n}, n * (n - 1)}, {{1, 0, 2 * n}, 0}, {{2 * n, 2 * n, 2 * n}, 1}};
    for (const auto& c : cases) {
        CAPTURE(c.shift[0], c.shift[1]);
        surface_data<T> both;
        for (const lattice_point& shift : std::vector<lattice_point>{{0, 0, 0}, c.shift}) {
            const auto first = static_cast<std::uint32_t>(both.vertices.size());
            const mesh<T> one = cube.as_mesh<T>(shift);
            for (std::size_t v = 0; v < cube.vertices.size(); ++v) both.vertices.push_back(one.view().vertices[v]);
            for (const face& f : cube.faces) both.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
        }
        CHECK(is_sound(as_mesh(both), 2, 4) == c.coincident);
    }
}

template <scalar T, class Policy>
void check_all_meshes(const Policy& on) {
    check_random_poses<T>(on, 60);
    check_onto_itself<T>(on);
    check_nested<T>(on);
    check_stacked<T>(on);
    check_scales<T>(on);
    check_reports<T>(on);
}

// --- real meshes
// ------------------------------------------------------------------------------------------------------------

/// The pose of number `k`: a rotation as tests/support/poses.hpp draws them, and a translation in a box.
template <scalar T>
rigid<T> pose_within(std::uint64_t seed, std::uint64_t k, const vec3<double>& lower, const vec3<double>& upper) {
    draws d(seed, 85, k);
    rigid<T> pose = make_rotation<T>(d);
    const double x = d.uniform(lower.x, upper.x), y = d.uniform(lower.y, upper.y), z = d.uniform(lower.z, upper.z);
    pose.translation = construction::round_to<T>({x, y, z});
    return pose;
}

/// The scene of FCL's own tests: a robot in a room, both soups of triangles. Every other pose lies on a lattice without a
/// turn, where faces may meet in planes.
template <scalar T, class Policy>
void check_env_and_rob(const Policy& on, const mesh<T>& env, const mesh<T>& rob, int poses) {
    constexpr std::uint64_t seed = 20261129;
    int meet = 0;
    std::size_t hits = 0;
    for (int k = 0; k < poses; ++k) {
        rigid<T> pose = pose_within<T>(seed, static_cast<std::uint64_t>(k), {-3000, -3000, 0}, {3000, 3000, 3000});
        if (k % 2 == 1) {
            const auto to_lattice = [](T x) { return std::round(x / 50) * 50 + T(0.5); };
            const vec3<T> at = pose.translation;
            draws d(seed, 86, static_cast<std::uint64_t>(k));
            construction::set_quarter_turns(pose, d);
            pose.translation = {to_lattice(at.x), to_lattice(at.y), to_lattice(at.z)};
        }
        const placed_mesh<T> a{env, {}}, b{rob, pose};
        const pair_list expected = exact_pairs(a, b);
        meet += expected.empty() ? 0 : 1;
        hits += expected.size();
        CAPTURE(k);
        if (k < 8) {
            check_ways(on, a, b, expected, static_cast<std::size_t>(k));
        } else {
            check_trees(on, a, b, expected);
        }
    }
    std::printf("env.obj and rob.obj: seed %llu, %d of %d poses meet, %zu hits\n", static_cast<unsigned long long>(seed),
                meet, poses, hits);
    CHECK(meet > poses / 4);
    CHECK(meet < poses);
    CHECK(hits > 20u * static_cast<std::size_t>(poses));
}

/// A scanned mesh against itself: where it is, under one pose on both sides, and moved a little or a lot.
template <scalar T, class Policy>
void check_scan(const Policy& on, const mesh<T>& scan, int poses) {
    constexpr std::uint64_t seed = 20261130;
    std::size_t hits = 0;
    const pair_list near = neighbours(scan);
    for (int k = 0; k < poses; ++k) {
        const double reach = k % 3 == 0 ? 1e-3 : 0.4;
        const rigid<T> pose =
            pose_within<T>(seed, static_cast<std::uint64_t>(k), {-reach, -reach, -reach}, {reach, reach, reach});
        const placed_mesh<T> a{scan, k % 3 == 1 ? pose : rigid<T>{}}, b{scan, k == 0 ? rigid<T>{} : pose};
        const pair_list expected = exact_pairs(a, b);
        CAPTURE(k);
        if (a.pose == b.pose) CHECK(std::includes(expected.begin(), expected.end(), near.begin(), near.end()));
        check_trees(on, a, b, expected);
        hits += expected.size();
    }
    std::printf("a scan against itself: seed %llu, %d poses, %zu hits\n", static_cast<unsigned long long>(seed), poses,
                hits);
    CHECK(hits > 200u * static_cast<std::size_t>(poses));
}

}  // namespace abut::test
