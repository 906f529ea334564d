// SPDX-License-Identifier: MIT
#pragma once

// What `inside` promises on every policy. The truth knows nothing of ways to infinity: a body is made of cells of a lattice,
// and of a point of the lattice, or in the middle of a cell, a face or an edge, the cells around it tell all. Every point is
// below a corner, an edge or a wall of the body, so nothing here is in general position.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// The surface of some cells of a lattice, each side of a cell as two triangles, with one vertex for each place.
struct cell_body {
    using place = std::array<int, 3>;
    static constexpr int cells = 3;

    bool filled[cells + 2][cells + 2][cells + 2] = {};  // with a rim of empty cells
    std::vector<place> vertices;                        // in half cells
    std::vector<face> faces;

    explicit cell_body(uniform& random) {
        std::map<place, std::uint32_t> numbers;
        for (int x = 1; x <= cells; ++x) {
            for (int y = 1; y <= cells; ++y) {
                for (int z = 1; z <= cells; ++z) filled[x][y][z] = random.below(5) < 2;
            }
        }
        const auto number = [&](const place& p) {
            const auto [at, is_new] = numbers.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(p);
            return at->second;
        };
        for (int axis = 0; axis < 3; ++axis) {
            for_each_cell([&](const place& cell) {
                place next = cell;
                ++next[std::size_t(axis)];
                if (next[std::size_t(axis)] >= cells + 2 || is_filled(cell) == is_filled(next)) return;
                std::array<std::uint32_t, 4> corner{};
                for (std::size_t k = 0; k < 4; ++k) {
                    place p{2 * next[0], 2 * next[1], 2 * next[2]};
                    p[std::size_t(axis + 1) % 3] += k == 1 || k == 2 ? 2 : 0;
                    p[std::size_t(axis + 2) % 3] += k >= 2 ? 2 : 0;
                    corner[k] = number(p);
                }
                // Turned as it comes: only that the surface is closed matters. And cut along one diagonal or the other.
                if (random.below(2) == 0) {
                    faces.push_back({corner[0], corner[1], corner[2]}), faces.push_back({corner[0], corner[3], corner[2]});
                } else {
                    faces.push_back({corner[1], corner[2], corner[3]}), faces.push_back({corner[3], corner[0], corner[1]});
                }
            });
        }
    }

    template <class F>
    static void for_each_cell(const F& f) {
        for (int x = 0; x < cells + 2; ++x) {
            for (int y = 0; y < cells + 2; ++y) {
                for (int z = 0; z < cells + 2; ++z) f(place{x, y, z});
            }
        }
    }
    [[nodiscard]] bool is_filled(const place& c) const { return filled[c[0]][c[1]][c[2]]; }

    /// Of a place in half cells, off the rim: a number that is odd is within a cell in this coordinate, and an even one is
    /// between two.
    [[nodiscard]] containment at(const place& p) const {
        bool any_filled = false, any_empty = false;
        for (int k = 0; k < 8; ++k) {
            place c{};
            for (int axis = 0; axis < 3; ++axis) {
                const int x = p[std::size_t(axis)];
                c[std::size_t(axis)] = x % 2 != 0 ? x / 2 : x / 2 - (k >> axis & 1);
            }
            (is_filled(c) ? any_filled : any_empty) = true;
        }
        return any_filled && any_empty ? containment::on_surface : any_filled ? containment::inside : containment::outside;
    }
};

/// A lattice to coordinates: a scale, and a map of integers that keeps bodies and what is inside, and turns and shears them.
template <class T>
struct lattice_map {
    int row[3][3];
    T scale;

    [[nodiscard]] vec3<T> operator()(const cell_body::place& p) const {
        const auto one = [&](const int (&r)[3]) { return scale * static_cast<T>(r[0] * p[0] + r[1] * p[1] + r[2] * p[2]); };
        return {one(row[0]), one(row[1]), one(row[2])};
    }
};
template <class T>
std::vector<lattice_map<T>> lattice_maps() {
    // Products are exact, but for those of 0.1, which keep the order of a coordinate, and walls in their planes.
    const T largest = std::ldexp(T(1), std::numeric_limits<T>::max_exponent - 8), least = std::numeric_limits<T>::denorm_min();
    return {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1},
            {{{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}, T(0.1)},
            {{{7, 3, 0}, {0, 11, 5}, {2, 0, 13}}, T(12345) / 4096},
            {{{1, 0, 0}, {0, 1, 0}, {5, -2, 1}}, largest},
            {{{2, 1, 0}, {0, 3, 1}, {1, 0, -2}}, least}};
}

struct inside_scene {
    std::vector<cell_body::place> places;
    std::vector<containment> truth;

    explicit inside_scene(const cell_body& body) {
        for (int x = 1; x < 2 * cell_body::cells + 4; ++x) {
            for (int y = 1; y < 2 * cell_body::cells + 4; ++y) {
                for (int z = 1; z < 2 * cell_body::cells + 4; ++z) {
                    places.push_back({x, y, z});
                    truth.push_back(body.at(places.back()));
                }
            }
        }
    }
};

template <class T>
mesh<T> mesh_of_cells(const cell_body& body, const lattice_map<T>& map) {
    std::vector<vec3<T>> vertices;
    for (const auto& p : body.vertices) vertices.push_back(map(p));
    return {vertices, body.faces};
}

/// `most`: maps that are tried.
template <class T, class Policy>
void check_inside(const Policy& on, std::size_t most = 5) {
    uniform random(191);
    std::size_t inside_of_all = 0, on_surface_of_all = 0;
    for (std::size_t k = 0; k < most; ++k) {
        const lattice_map<T> map = lattice_maps<T>()[k];
        CAPTURE(k, map.scale);
        const cell_body body(random);
        const inside_scene scene(body);
        std::vector<vec3<T>> points;
        for (const auto& p : scene.places) points.push_back(map(p));
        const auto there = copy_to(on, mesh_of_cells(body, map));
        const auto tree = make_bvh(on, there);
        CHECK(to_host(inside(on, tree, points)) == scene.truth);
        if (k == 0) {
            CHECK(to_host(inside<exact>(on, tree, points, {.known_closed = true})) == scene.truth);
            CHECK(to_host(inside(on, there, points)) == scene.truth);
            // A pose that is exact: a quarter turn and a shift by a multiple of the scale.
            const rigid<T> pose{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {64, -32, 8}};
            std::vector<vec3<T>> moved;
            for (const auto& p : points) moved.push_back(place(pose, p));
            CHECK(to_host(inside(on, posed(tree, pose), moved)) == scene.truth);
        }
        for (const containment c : scene.truth) {
            inside_of_all += c == containment::inside;
            on_surface_of_all += c == containment::on_surface;
        }
    }
    CHECK(inside_of_all > 10 * most);
    CHECK(on_surface_of_all > 100 * most);
}

}  // namespace abut::test
