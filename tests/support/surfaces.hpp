// SPDX-License-Identifier: MIT
#pragma once

// Closed surfaces of many triangles whose contacts are known without any predicate: spheres and cubes.

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <abut/shape/set.hpp>

namespace abut::test {

template <scalar T>
struct surface_data {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
};

/// Faces as triangles.
template <scalar T>
std::vector<triangle<T>> triangles_of(const std::vector<vec3<T>>& vertices, const std::vector<face>& faces) {
    std::vector<triangle<T>> all;
    for (const face& f : faces) all.push_back({vertices[f[0]], vertices[f[1]], vertices[f[2]]});
    return all;
}

/// A sphere from a solid with corners on the unit sphere, each of whose triangles is cut in four `levels` times.
template <scalar T>
surface_data<T> refined_ball(std::vector<vec3<double>> points, std::vector<face> faces, int levels, double radius) {
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, is_new] =
                middles.try_emplace(a < b ? std::pair(a, b) : std::pair(b, a), static_cast<std::uint32_t>(points.size()));
            if (is_new) {
                const vec3<double> m = points[a] + points[b];
                const double l = std::sqrt(m.x * m.x + m.y * m.y + m.z * m.z);
                points.push_back({m.x / l, m.y / l, m.z / l});
            }
            return at->second;
        };
        std::vector<face> finer;
        for (const auto& [a, b, c] : faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    surface_data<T> made{{}, faces};
    for (const auto& p : points) {
        made.vertices.push_back({static_cast<T>(radius * p.x), static_cast<T>(radius * p.y), static_cast<T>(radius * p.z)});
    }
    return made;
}

/// From the octahedron: 8 * 4^levels triangles, facing outwards.
template <scalar T>
surface_data<T> ball_surface(int levels, double radius) {
    return refined_ball<T>({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                           {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}, levels,
                           radius);
}

/// From the icosahedron: 20 * 4^levels triangles of nearly one size, facing outwards.
template <scalar T>
surface_data<T> icosphere(int levels, double radius) {
    const double golden = (1 + std::sqrt(5.0)) / 2, l = std::sqrt(1 + golden * golden), s = 1 / l, g = golden / l;
    return refined_ball<T>({{-s, g, 0},
                            {s, g, 0},
                            {-s, -g, 0},
                            {s, -g, 0},
                            {0, -s, g},
                            {0, s, g},
                            {0, -s, -g},
                            {0, s, -g},
                            {g, 0, -s},
                            {g, 0, s},
                            {-g, 0, -s},
                            {-g, 0, s}},
                           {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                            {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                            {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}},
                           levels, radius);
}

using lattice_point = std::array<std::int64_t, 3>;

/// The surface of the cube [0, 2n]^3 as 6 n^2 squares of side 2, two triangles each, facing outwards; in integers, even
/// ones, so that a cube can be moved by half a square.
struct cube_surface {
    std::vector<lattice_point> vertices;
    std::vector<face> faces;

    explicit cube_surface(int n) {
        std::map<lattice_point, std::uint32_t> ids;
        const auto id = [&](const lattice_point& p) {
            const auto [at, is_new] = ids.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(p);
            return at->second;
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 2 * n}) {
                for (int i = 0; i < 2 * n; i += 2) {
                    for (int j = 0; j < 2 * n; j += 2) {
                        const auto corner = [&](int u, int v) {
                            lattice_point p;
                            p[axis] = side;
                            p[(axis + 1) % 3] = i + u;
                            p[(axis + 2) % 3] = j + v;
                            return id(p);
                        };
                        const std::uint32_t a = corner(0, 0), b = corner(2, 0), c = corner(2, 2), d = corner(0, 2);
                        if (side > 0) {
                            faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
                        } else {
                            faces.insert(faces.end(), {{a, c, b}, {a, d, c}});
                        }
                    }
                }
            }
        }
    }

    template <scalar T>
    [[nodiscard]] mesh<T> as_mesh(const lattice_point& shift) const {
        std::vector<vec3<T>> points;
        for (const lattice_point& v : vertices) {
            points.push_back(
                {static_cast<T>(v[0] + shift[0]), static_cast<T>(v[1] + shift[1]), static_cast<T>(v[2] + shift[2])});
        }
        return {points, faces};
    }
};

/// Whether two convex hulls of up to three points of a plane have a point in common; exact for coordinates below 2^29.
/// They do if the differences of their points have the origin in their hull, that is, in a triangle of three of these.
inline bool flat_hulls_touch(const std::vector<std::array<std::int64_t, 2>>& a,
                             const std::vector<std::array<std::int64_t, 2>>& b) {
    std::vector<std::array<std::int64_t, 2>> differences;
    for (const auto& p : a) {
        for (const auto& q : b) differences.push_back({p[0] - q[0], p[1] - q[1]});
    }
    const auto holds_origin = [](const auto& p, const auto& q, const auto& r) {
        const auto cross = [](const auto& u, const auto& v) { return u[0] * v[1] - u[1] * v[0]; };
        const auto dot = [](const auto& u, const auto& v) { return u[0] * v[0] + u[1] * v[1]; };
        const std::int64_t pq = cross(p, q), qr = cross(q, r), rp = cross(r, p);
        if (pq == 0 && qr == 0 && rp == 0) return dot(p, q) <= 0 || dot(q, r) <= 0 || dot(r, p) <= 0;
        return (pq >= 0 && qr >= 0 && rp >= 0) || (pq <= 0 && qr <= 0 && rp <= 0);
    };
    for (std::size_t i = 0; i < differences.size(); ++i) {
        for (std::size_t j = i; j < differences.size(); ++j) {
            for (std::size_t k = j; k < differences.size(); ++k) {
                if (holds_origin(differences[i], differences[j], differences[k])) return true;
            }
        }
    }
    return false;
}

}  // namespace abut::test
