// SPDX-License-Identifier: MIT
#pragma once

// Solids whose relation is known otherwise than by their surfaces: sets of cells of a grid, and tetrahedra.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <abut/collide/relation.hpp>
#include <abut/shape/set.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"

namespace abut::test {

using grid_place = std::array<int, 3>;

/// What is made of the integer coordinates of a solid: a linear map of integers, and a unit.
struct frame_of_grid {
    int map[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double unit = 1;

    [[nodiscard]] int determinant() const {
        const auto& m = map;
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    }
    /// The side of a cube as large as the image of a unit cell.
    [[nodiscard]] double side() const { return std::cbrt(std::abs(determinant())) * unit; }

    template <scalar T>
    [[nodiscard]] vec3<T> operator()(const grid_place& p) const {
        const auto row = [&](int i) {
            const auto sum = map[i][0] * p[0] + map[i][1] * p[1] + map[i][2] * p[2];
            return static_cast<T>(sum * unit);
        };
        return {row(0), row(1), row(2)};
    }
};

/// A union of cubes of a grid: cells by their lower corners, in units of `side`.
struct cells {
    std::set<grid_place> in;
    int side = 1;
    grid_place offset{0, 0, 0};

    [[nodiscard]] grid_place corner(const grid_place& cell, int dx, int dy, int dz) const {
        return {offset[0] + side * (cell[0] + dx), offset[1] + side * (cell[1] + dy), offset[2] + side * (cell[2] + dz)};
    }
    /// The unit cells of which it consists.
    [[nodiscard]] std::set<grid_place> units() const {
        std::set<grid_place> all;
        for (const grid_place& c : in) {
            const grid_place from = corner(c, 0, 0, 0);
            for (int x = 0; x < side; ++x) {
                for (int y = 0; y < side; ++y) {
                    for (int z = 0; z < side; ++z) all.insert({from[0] + x, from[1] + y, from[2] + z});
                }
            }
        }
        return all;
    }
};

/// The faces of a set of cells, each side of a cell in two triangles by a diagonal that is drawn; all turned outwards, or those
/// of all turned inwards.
template <scalar T>
mesh<T> surface_of(const cells& of, const frame_of_grid& frame, draws& d, bool inwards = false) {
    std::map<grid_place, std::uint32_t> number;
    std::vector<vec3<T>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    const auto vertex = [&](const grid_place& p) {
        const auto [at, fresh] = number.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
        if (fresh) vertices.push_back(frame.operator()<T>(p));
        return at->second;
    };
    const int determinant = frame.determinant();
    for (const grid_place& c : of.in) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int up : {0, 1}) {
                grid_place beyond = c;
                beyond[static_cast<std::size_t>(axis)] += up == 1 ? 1 : -1;
                if (of.in.contains(beyond)) continue;
                std::array<std::uint32_t, 4> ring{};
                for (int k = 0; k < 4; ++k) {
                    int at[3] = {0, 0, 0};
                    at[axis] = up;
                    at[(axis + 1) % 3] = k == 1 || k == 2;
                    at[(axis + 2) % 3] = k >= 2;
                    ring[static_cast<std::size_t>(k)] = vertex(of.corner(c, at[0], at[1], at[2]));
                }
                if ((up == 0) != inwards != (determinant < 0)) std::swap(ring[1], ring[3]);
                if (d.below(2) == 0) std::rotate(ring.begin(), ring.begin() + 1, ring.end());
                faces.push_back({ring[0], ring[1], ring[2]});
                faces.push_back({ring[0], ring[2], ring[3]});
            }
        }
    }
    return {std::move(vertices), std::move(faces)};
}

/// Whether the surface has two faces at each edge: of the four cells around an edge never are two opposite ones in and the
/// others out. Cells that meet in a corner alone share a vertex, which then has several fans.
inline bool has_two_faces_at_each_edge(const cells& of) {
    for (const grid_place& c : of.in) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
            for (const int dv : {-1, 1}) {
                grid_place side = c, other = c, opposite = c;
                side[u] += 1;
                other[v] += dv;
                opposite[u] += 1;
                opposite[v] += dv;
                if (of.in.contains(opposite) && !of.in.contains(side) && !of.in.contains(other)) return false;
            }
        }
    }
    return true;
}

inline cells draw_cells(draws& d, int size, int side, int spread) {
    for (;;) {
        cells of;
        of.side = side;
        const int share = 1 + d.below(9);
        for (int x = 0; x < size; ++x) {
            for (int y = 0; y < size; ++y) {
                for (int z = 0; z < size; ++z) {
                    if (d.below(10) < share) of.in.insert({x, y, z});
                }
            }
        }
        if (of.in.empty() || !has_two_faces_at_each_edge(of)) continue;
        for (int& x : of.offset) x = d.below(2 * spread + 1) - spread;
        return of;
    }
}

/// What relation says, of the two sets alone.
inline solid_relation truth_of(const cells& first, const cells& second) {
    const std::set<grid_place> a = first.units(), b = second.units();
    const auto count = [](const std::set<grid_place>& x, const std::set<grid_place>& y) {
        return std::count_if(x.begin(), x.end(), [&](const grid_place& c) { return y.contains(c); });
    };
    const auto common = static_cast<std::size_t>(count(a, b));
    // Surfaces touch in a corner of a unit cell: one at which some unit cell is in a and some is not, and the same of b; or
    // they cross, which only overlapping solids do.
    bool touches = false;
    const auto mixed = [](const std::set<grid_place>& of, const grid_place& p) {
        int in = 0;
        for (int k = 0; k < 8; ++k) in += of.contains({p[0] - (k & 1), p[1] - (k >> 1 & 1), p[2] - (k >> 2)});
        return in > 0 && in < 8;
    };
    for (const grid_place& c : a) {
        for (int k = 0; k < 8 && !touches; ++k) {
            const grid_place p{c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)};
            touches = mixed(a, p) && mixed(b, p);
        }
    }
    if (common == 0) return touches ? solid_relation::externally_connected : solid_relation::disconnected;
    if (common < a.size() && common < b.size()) return solid_relation::partially_overlapping;
    if (common < b.size()) return touches ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (common < a.size()) {
        return touches ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    }
    return solid_relation::equal;
}

/// A rotation by a quaternion of small integers, times the square of its length: it moves no axis into an axis, most often.
inline std::array<grid_place, 3> draw_rotation(draws& d) {
    int q[4] = {0, 0, 0, 0};
    while (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        for (int& part : q) part = d.below(5) - 2;
    }
    const auto [w, x, y, z] = q;
    return {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
}

/// A map by a few shears and swaps, and half of them by a rotation too.
inline frame_of_grid draw_frame(draws& d) {
    frame_of_grid f;
    for (int k = 0; k < 4; ++k) {
        const int i = d.below(3), j = (i + 1 + d.below(2)) % 3, by = d.below(3) - 1;
        for (int c = 0; c < 3; ++c) f.map[i][c] += by * f.map[j][c];
    }
    if (d.below(2) == 0) {
        for (int c = 0; c < 3; ++c) std::swap(f.map[0][c], f.map[1][c]);
    }
    f.unit = d.below(2) == 0 ? 1 : 0x1p-20;
    if (d.below(2) == 0) return f;
    const auto by = draw_rotation(d);
    const frame_of_grid sheared = f;
    for (std::size_t r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            f.map[r][c] = by[r][0] * sheared.map[0][c] + by[r][1] * sheared.map[1][c] + by[r][2] * sheared.map[2][c];
        }
    }
    return f;
}

// --- tetrahedra

using tetrahedron_of_grid = std::array<grid_place, 4>;

inline std::int64_t volume_of(const grid_place& a, const grid_place& b, const grid_place& c, const grid_place& d) {
    const auto x = [&](const grid_place& p) { return std::int64_t{p[0]} - a[0]; };
    const auto y = [&](const grid_place& p) { return std::int64_t{p[1]} - a[1]; };
    const auto z = [&](const grid_place& p) { return std::int64_t{p[2]} - a[2]; };
    return x(b) * (y(c) * z(d) - z(c) * y(d)) - y(b) * (x(c) * z(d) - z(c) * x(d)) + z(b) * (x(c) * y(d) - y(c) * x(d));
}
inline tetrahedron_of_grid draw_tetrahedron(draws& d, int size) {
    for (;;) {
        tetrahedron_of_grid t;
        for (grid_place& p : t) {
            for (int& x : p) x = d.below(size);
        }
        const std::int64_t volume = volume_of(t[0], t[1], t[2], t[3]);
        if (volume == 0) continue;
        if (volume < 0) std::swap(t[0], t[1]);
        return t;
    }
}
template <scalar T>
mesh<T> surface_of(const tetrahedron_of_grid& t, const frame_of_grid& frame) {
    std::vector<vec3<T>> vertices;
    for (const grid_place& p : t) vertices.push_back(frame.operator()<T>(p));
    return {std::move(vertices), {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

// --- convex polyhedra

/// A convex body of a grid: its corners, and its sides, each an outward normal and the corners around it, turning left.
struct polyhedron {
    using normal = std::array<std::int64_t, 3>;
    struct side {
        normal outward;
        std::vector<std::uint32_t> corners;
    };
    std::vector<grid_place> at;
    std::vector<side> sides;

    static std::int64_t height(const normal& n, const grid_place& p) { return n[0] * p[0] + n[1] * p[1] + n[2] * p[2]; }
    static normal minus(const grid_place& p, const grid_place& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
    static normal across(const normal& u, const normal& v) {
        return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    }
    static std::int64_t along(const normal& u, const normal& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

    /// The hull of points, by all planes through three of them. No sides where the points lie in one plane.
    explicit polyhedron(std::vector<grid_place> points) : at(std::move(points)) {
        const auto n = static_cast<std::uint32_t>(at.size());
        std::set<std::vector<std::uint32_t>> known;
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = i + 1; j < n; ++j) {
                for (std::uint32_t k = j + 1; k < n; ++k) add_side(i, j, k, known);
            }
        }
    }

private:
    void add_side(std::uint32_t i, std::uint32_t j, std::uint32_t k, std::set<std::vector<std::uint32_t>>& known) {
        normal outward = across(minus(at[j], at[i]), minus(at[k], at[i]));
        if (outward == normal{0, 0, 0}) return;
        bool above = false, below = false;
        std::vector<std::uint32_t> on;
        for (std::uint32_t p = 0; p < at.size(); ++p) {
            const std::int64_t h = height(outward, at[p]) - height(outward, at[i]);
            above |= h > 0;
            below |= h < 0;
            if (h == 0) on.push_back(p);
        }
        if (above == below || !known.insert(on).second) return;
        if (above) outward = {-outward[0], -outward[1], -outward[2]};
        // Around the side: from each corner to the one that has all others to its left, the farthest of these.
        std::vector<std::uint32_t> corners{*std::min_element(on.begin(), on.end(), [&](auto p, auto q) { return at[p] < at[q]; })};
        for (;;) {
            const grid_place& from = at[corners.back()];
            std::uint32_t next = corners.back();
            for (const std::uint32_t p : on) {
                const normal to = minus(at[p], from), best = minus(at[next], from);
                if (to == normal{0, 0, 0}) continue;
                const std::int64_t turn = along(outward, across(best, to));
                if (best == normal{0, 0, 0} || turn < 0 || (turn == 0 && along(to, to) > along(best, best))) next = p;
            }
            if (next == corners.front()) break;
            corners.push_back(next);
        }
        sides.push_back({outward, corners});
    }
};

/// A prism, a box without some of its corners, or the hull of a few points.
inline polyhedron draw_polyhedron(draws& d, int size) {
    for (;;) {
        std::vector<grid_place> points;
        const int kind = d.below(3);
        const auto place = [&] {
            grid_place p{0, 0, 0};
            for (int& x : p) x = d.below(size);
            return p;
        };
        if (kind == 0) {
            grid_place up{d.below(3) - 1, d.below(3) - 1, 1 + d.below(size)};
            for (int k = 3 + d.below(3); k > 0; --k) {
                grid_place p = place();
                p[2] = 0;
                points.push_back(p);
                points.push_back({p[0] + up[0], p[1] + up[1], up[2]});
            }
        } else if (kind == 1) {
            const grid_place from = place(), to{2 + d.below(size), 2 + d.below(size), 2 + d.below(size)};
            const int share = d.below(4);
            for (int k = 0; k < 8; ++k) {
                const grid_place corner{k & 1, k >> 1 & 1, k >> 2};
                grid_place p = from;
                for (std::size_t c = 0; c < 3; ++c) p[c] += corner[c] * to[c];
                if (d.below(4) >= share) {
                    points.push_back(p);
                    continue;
                }
                for (std::size_t c = 0; c < 3; ++c) {
                    grid_place q = p;
                    q[c] += corner[c] == 0 ? 1 : -1;
                    points.push_back(q);
                }
            }
        } else {
            for (int k = 4 + d.below(5); k > 0; --k) points.push_back(place());
        }
        // One axis for another, so that prisms stand in all directions.
        const auto turn = static_cast<std::size_t>(d.below(3));
        for (grid_place& p : points) std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(turn), p.end());
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        polyhedron body(std::move(points));
        if (!body.sides.empty()) return body;
    }
}
/// The same, turned and as many times as large.
inline polyhedron turned(const polyhedron& of, const std::array<grid_place, 3>& by) {
    std::vector<grid_place> at;
    for (const grid_place& p : of.at) {
        grid_place q{0, 0, 0};
        for (std::size_t r = 0; r < 3; ++r) q[r] = by[r][0] * p[0] + by[r][1] * p[1] + by[r][2] * p[2];
        at.push_back(q);
    }
    return polyhedron(std::move(at));
}
template <scalar T>
mesh<T> surface_of(const polyhedron& of, const frame_of_grid& frame, draws& d) {
    std::vector<vec3<T>> vertices;
    for (const grid_place& p : of.at) vertices.push_back(frame.operator()<T>(p));
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (const auto& side : of.sides) {
        std::vector<std::uint32_t> c = side.corners;
        std::rotate(c.begin(), c.begin() + d.below(static_cast<int>(c.size())), c.end());
        for (std::size_t k = 2; k < c.size(); ++k) faces.push_back({c[0], c[k - 1], c[k]});
    }
    return {std::move(vertices), std::move(faces)};
}

/// By planes: two convex bodies have no interior point in common if a plane along a side of one, or along an edge of each,
/// has them on different sides; and no point at all if it is between them.
inline solid_relation truth_of(const polyhedron& a, const polyhedron& b) {
    using normal = polyhedron::normal;
    const auto edges_of = [](const polyhedron& x) {
        std::set<normal> edges;
        for (const auto& side : x.sides) {
            for (std::size_t k = 0; k < side.corners.size(); ++k) {
                normal e = polyhedron::minus(x.at[side.corners[(k + 1) % side.corners.size()]], x.at[side.corners[k]]);
                if (e < normal{0, 0, 0}) e = {-e[0], -e[1], -e[2]};
                edges.insert(e);
            }
        }
        return edges;
    };
    std::vector<normal> all;
    for (const polyhedron* x : {&a, &b}) {
        for (const auto& side : x->sides) all.push_back(side.outward);
    }
    const std::set<normal> of_a = edges_of(a), of_b = edges_of(b);
    for (const normal& u : of_a) {
        for (const normal& v : of_b) {
            const normal n = polyhedron::across(u, v);
            if (n != normal{0, 0, 0}) all.push_back(n);
        }
    }
    const auto heights = [](const polyhedron& x, const normal& n) {
        std::pair<std::int64_t, std::int64_t> found(polyhedron::height(n, x.at[0]), polyhedron::height(n, x.at[0]));
        for (const grid_place& p : x.at) {
            found.first = std::min(found.first, polyhedron::height(n, p));
            found.second = std::max(found.second, polyhedron::height(n, p));
        }
        return found;
    };
    bool both = true;
    for (const normal& n : all) {
        const auto [low_a, high_a] = heights(a, n);
        const auto [low_b, high_b] = heights(b, n);
        if (high_a < low_b || high_b < low_a) return solid_relation::disconnected;
        if (high_a <= low_b || high_b <= low_a) both = false;
    }
    const auto is_in = [&](const polyhedron& x, const polyhedron& y, bool& touches) {
        bool in = true;
        for (const auto& side : y.sides) {
            const std::int64_t above = heights(x, side.outward).second - polyhedron::height(side.outward, y.at[side.corners[0]]);
            in &= above <= 0;
            touches |= above == 0;
        }
        return in;
    };
    bool touches_a = false, touches_b = false;
    const bool a_in_b = is_in(a, b, touches_a), b_in_a = is_in(b, a, touches_b);
    if (a_in_b && b_in_a) return solid_relation::equal;
    if (a_in_b) return touches_a ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (b_in_a) return touches_b ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    return both ? solid_relation::partially_overlapping : solid_relation::externally_connected;
}
inline solid_relation truth_of(const tetrahedron_of_grid& a, const tetrahedron_of_grid& b) {
    const auto body = [](const tetrahedron_of_grid& t) { return polyhedron({t.begin(), t.end()}); };
    return truth_of(body(a), body(b));
}

/// Which bodies are looked at.
struct only_below {
    std::uint32_t end;
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return a < end && b < end; }
};

/// Two sets of cells of many kinds.
inline std::pair<cells, cells> draw_two_sets(draws& d, std::uint64_t k) {
    cells a = draw_cells(d, 3, 2, 0), b = draw_cells(d, 1 + d.below(3), 1 + d.below(2), 3);
    if (k % 8 == 3) std::swap(a, b);
    if (k % 8 == 5) {  // a shell, and something in it or in its wall
        a.in.clear();
        a.side = 1 + d.below(2);
        for (int x = 0; x < 5; ++x) {
            for (int y = 0; y < 5; ++y) {
                for (int z = 0; z < 5; ++z) {
                    if (x % 4 == 0 || y % 4 == 0 || z % 4 == 0) a.in.insert({x, y, z});
                }
            }
        }
        b = draw_cells(d, 1 + d.below(2), 1, 4);
    }
    if (k % 8 == 7) {  // a block, and something in it
        a.in.clear();
        for (int i = 0; i < 125; ++i) a.in.insert({i % 5, i / 5 % 5, i / 25});
        b = draw_cells(d, 1 + d.below(3), 1, 3);
    }
    if (k % 4 == 0) {  // a itself, or one cell more or less of it
        cells other = a;
        const grid_place c{d.below(3), d.below(3), d.below(3)};
        if (k % 8 == 0 && !other.in.insert(c).second && other.in.size() > 1) other.in.erase(c);
        if (has_two_faces_at_each_edge(other)) b = other;
    }
    return {a, b};
}

/// The same, with one of them in the interior of the other now and then, and in either order.
inline std::pair<cells, cells> draw_two_of_all_kinds(draws& d, std::uint64_t k) {
    auto [a, b] = draw_two_sets(d, k);
    if (k % 8 == 6) {
        a = b = {};
        for (int i = 0; i < 125; ++i) a.in.insert({i % 5, i / 5 % 5, i / 25});
        b.in.insert({1 + d.below(3), 1 + d.below(3), 1 + d.below(3)});
    }
    if (k % 16 > 7) std::swap(a, b);
    return {a, b};
}

/// Rays among them, many through vertices, along edges and in faces.
template <scalar T>
std::vector<ray<T>> draw_rays_of_grid(draws& d, std::size_t n) {
    std::vector<ray<T>> all;
    while (all.size() < n) {
        const auto half = [&] { return static_cast<T>(d.below(17) - 4) / 2; };
        const auto way = [&] { return static_cast<T>(d.below(5) - 2); };
        const T x = half(), y = half(), z = half(), dx = way(), dy = way(), dz = way();
        all.push_back({{x, y, z}, {dx, dy, dz}});
    }
    return all;
}

/// A few of them on a policy, as meshes, trees and under poses.
template <scalar T, class Policy>
void check_relations(const Policy& on) {
    for (std::uint64_t k = 0; k < 24; ++k) {
        draws d(20270514, 4, k);
        const auto [a, b] = draw_two_sets(d, k);
        const frame_of_grid f = draw_frame(d);
        const auto x = copy_to(on, surface_of<T>(a, f, d)), y = copy_to(on, surface_of<T>(b, f, d));
        const auto tree = make_bvh(on, y);
        const solid_relation truth = truth_of(a, b);
        const rigid<T> there{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {2, 0, -1}};
        CAPTURE(k);
        CHECK(relation(on, x, tree) == truth);
        CHECK(relation<exact>(on, posed(x, there), posed(tree, there), {.known_solid = true}) == truth);
        CHECK(overlaps(on, tree, x) == (truth > solid_relation::externally_connected));
    }
}

/// Scenes of bodies and lists of them.
template <scalar T, class Policy>
void check_scenes_of_solids(const Policy& on, std::uint64_t scenes) {
    using tree = decltype(make_bvh(on, copy_to(on, mesh<T>())));
    std::uint64_t of[8] = {}, wrong = 0;
    for (std::uint64_t k = 0; k < scenes; ++k) {
        draws d(20270514, 5, k);
        const frame_of_grid f = draw_frame(d);
        std::vector<cells> all;
        std::vector<posed_object<tree>> scene;
        for (int i = 0; i < 8; ++i) {
            const int size = 1 + d.below(4), side = 1 + d.below(2);  // in two steps: the order of arguments is the compiler's
            cells c = draw_cells(d, size, side, 4);
            if (i == 6) {  // a unit cell in the last one
                c = {};
                c.in.insert({0, 0, 0});
                for (int& x : c.offset) x = d.below(5) - 1;
            }
            if (i == 7) {
                c = {};
                for (int p = 0; p < 125; ++p) c.in.insert({p % 5, p / 5 % 5, p / 25});
                c.offset = {-1, -1, -1};
            }
            const rigid<T> there{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {2, 0, -1}};
            all.push_back(c);
            scene.push_back(posed(make_bvh(on, copy_to(on, surface_of<T>(c, f, d))), there));
        }
        std::vector<posed_pair<tree>> list;
        for (const auto& a : scene) {
            for (const auto& b : scene) list.push_back({a, b});
        }
        const auto each = relation(on, list, {.known_solid = k % 2 == 0});
        auto found = relation(on, scene, {.known_solid = k % 2 == 1});
        CHECK(found == relation(on, make_bodies(on, scene)));
        const auto meet = overlaps(on, list, {.known_solid = k % 2 == 0});
        const auto two_that_meet = overlaps(on, make_bodies(on, scene), {.known_solid = k % 2 == 1});
        std::vector<index_pair> true_ones;
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < 8; ++i) {
            for (std::uint32_t j = 0; j < 8; ++j) {
                const solid_relation truth = truth_of(all[i], all[j]);
                ++of[static_cast<int>(truth)];
                wrong += each[8 * i + j] != truth;
                const bool is = truth > solid_relation::externally_connected;
                wrong += meet[8 * i + j] != (is ? 1 : 0);
                if (is && i < j) true_ones.push_back({i, j});
                if (i >= j || truth == solid_relation::disconnected) continue;
                wrong += next >= found.size() || found[next] != body_relation{i, j, truth};
                ++next;
            }
        }
        CHECK(found.size() == next);
        CHECK(two_that_meet == true_ones);
        const auto without_last = relation(on, scene, {}, body_options<keep_all, schedule::shared_list, only_below>{.bodies = only_below{7}});
        std::erase_if(found, [](const body_relation& r) { return r.body_b == 7; });
        CHECK(without_last == found);
    }
    CHECK(wrong == 0);
    for (int i = 0; i < 8; ++i) CHECK((of[i] > 0 || scenes < 20));
}

inline const char* name_of(solid_relation r) {
    constexpr const char* names[] = {"disconnected", "externally connected", "partially overlapping", "equal", "tangential part",
                                     "nontangential part", "tangential part, inverse", "nontangential part, inverse"};
    return names[static_cast<int>(r)];
}

}  // namespace abut::test
