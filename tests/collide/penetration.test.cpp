// SPDX-License-Identifier: MIT
#include <abut/collide/penetration.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/abut.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

/// The least move that separates two tetrahedra: the least depth along normals of faces and of pairs of edges (the faces of
/// their Minkowski difference). In long double of integers.
double least_move(const tetrahedron_of_grid& a, const tetrahedron_of_grid& b) {
    using normal = std::array<std::int64_t, 3>;
    const auto across = [](const grid_place& p, const grid_place& q, const grid_place& r, const grid_place& s) {
        const std::int64_t u[] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v[] = {s[0] - r[0], s[1] - r[1], s[2] - r[2]};
        return normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    std::vector<normal> all;
    for (const tetrahedron_of_grid* t : {&a, &b}) {
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

using rational = boost::multiprecision::cpp_rational;

/// A unit square of a surface of cells: its least corner, and the axis across it.
struct unit_square {
    grid_place at;
    std::size_t across;
};
std::vector<unit_square> squares_of(const std::set<grid_place>& units) {
    std::vector<unit_square> all;
    for (const grid_place& c : units) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            grid_place below = c, above = c;
            below[axis] -= 1;
            above[axis] += 1;
            if (!units.contains(below)) all.push_back({c, axis});
            if (!units.contains(above)) all.push_back({above, axis});
        }
    }
    return all;
}
/// The square of the distance from a point to a square, both in units of one part of a cell's side.
template <class N>
N squared_to(const std::array<N, 3>& p, const unit_square& q, int parts = 1) {
    N sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const N low = q.at[c] * parts, high = (q.at[c] + (c == q.across ? 0 : 1)) * parts;
        const N way = p[c] < low ? N(low - p[c]) : p[c] > high ? N(p[c] - high) : N(0);
        sum += way * way;
    }
    return sum;
}
/// Whether all cells around a place are in the solid, by its lower neighbours where it lies between cells.
bool is_within(const grid_place& cell, const std::array<bool, 3>& is_between, const std::set<grid_place>& solid) {
    for (int k = 0; k < 8; ++k) {
        grid_place c = cell;
        for (std::size_t i = 0; i < 3; ++i) c[i] -= is_between[i] && (k >> i & 1) != 0 ? 1 : 0;
        if (!solid.contains(c)) return false;
    }
    return true;
}
bool is_within(const std::array<rational, 3>& p, const std::set<grid_place>& solid) {
    grid_place cell{0, 0, 0};
    std::array<bool, 3> is_between{};
    for (std::size_t c = 0; c < 3; ++c) {
        cell[c] = static_cast<int>(std::floor(p[c].convert_to<double>()));  // p is a double
        is_between[c] = p[c] == cell[c];
    }
    return is_within(cell, is_between, solid);
}
/// The square of the largest depth of a point of some squares within a solid, among those of a lattice of eighths; in eighths.
int deepest_sample(const std::vector<unit_square>& of, const std::set<grid_place>& solid, const std::vector<unit_square>& surface) {
    int most = 0;
    for (const unit_square& q : of) {
        const std::size_t u = (q.across + 1) % 3, v = (q.across + 2) % 3;
        for (int i = 0; i <= 8; ++i) {
            for (int j = 0; j <= 8; ++j) {
                std::array<int, 3> p{8 * q.at[0], 8 * q.at[1], 8 * q.at[2]};
                p[u] += i;
                p[v] += j;
                grid_place cell = q.at;
                cell[u] += i / 8;
                cell[v] += j / 8;
                if (!is_within(cell, {p[0] % 8 == 0, p[1] % 8 == 0, p[2] % 8 == 0}, solid)) continue;
                int least = std::numeric_limits<int>::max();
                for (const unit_square& s : surface) {
                    least = std::min(least, squared_to(p, s, 8));
                    if (least <= most) break;
                }
                most = std::max(most, least);
            }
        }
    }
    return most;
}
/// No sample is deeper, and the point that was found is in the solid and as deep as is said: in whole eighths, and in rationals of
/// what the doubles are.
std::uint64_t wrongs_of_depth(const std::vector<unit_square>& of, const std::set<grid_place>& solid, const std::vector<unit_square>& to,
                              const farthest_point& f) {
    std::uint64_t wrong = 0;
    const rational upper = rational(f.upper) * 8;
    if (rational(deepest_sample(of, solid, to)) > upper * upper) ++wrong;
    if (f.face == no_id) {
        if (f.lower > 0) ++wrong;
    } else {
        const std::array<rational, 3> p{rational(f.point.x), rational(f.point.y), rational(f.point.z)};
        const rational lower(f.lower);
        for (const unit_square& q : to) wrong += squared_to(p, q) < lower * lower;
        if (!is_within(p, solid)) ++wrong;
    }
    if (f.upper - f.lower > 0.0201) ++wrong;
    return wrong;
}

/// Boxes of a grid in one mesh, which overlap: the cells that a rule says to be in, and the squares of all.
struct boxes_in_one {
    std::vector<cells> boxes;

    static boxes_in_one drawn(draws& d) {
        boxes_in_one all;
        for (int k = 1 + d.below(3); k > 0; --k) {
            cells c;
            const grid_place size{1 + d.below(3), 1 + d.below(3), 1 + d.below(3)};
            for (int i = 0; i < size[0] * size[1] * size[2]; ++i) {
                c.in.insert({i % size[0], i / size[0] % size[1], i / size[0] / size[1]});
            }
            for (int& x : c.offset) x = d.below(4);
            all.boxes.push_back(c);
        }
        return all;
    }
    [[nodiscard]] std::set<grid_place> solid(inside_rule rule) const {
        std::map<grid_place, int> turns;
        for (const cells& c : boxes) {
            for (const grid_place& u : c.units()) ++turns[u];
        }
        std::set<grid_place> all;
        for (const auto& [u, n] : turns) {
            if (rule != inside_rule::parity || n % 2 == 1) all.insert(u);
        }
        return all;
    }
    [[nodiscard]] std::vector<unit_square> squares() const {
        std::vector<unit_square> all;
        for (const cells& c : boxes) {
            for (const unit_square& q : squares_of(c.units())) all.push_back(q);
        }
        return all;
    }
    template <scalar T>
    [[nodiscard]] mesh<T> surface(draws& d) const {
        std::vector<vec3<T>> vertices;
        std::vector<std::array<std::uint32_t, 3>> faces;
        for (const cells& c : boxes) {
            const mesh<T> one = surface_of<T>(c, {}, d);
            const auto first = static_cast<std::uint32_t>(vertices.size());
            for (std::size_t v = 0; v < one.view().vertices.count; ++v) vertices.push_back(one.view().vertices[v]);
            for (std::size_t f = 0; f < one.size(); ++f) {
                const auto face = one.view().faces[f];
                faces.push_back({face[0] + first, face[1] + first, face[2] + first});
            }
        }
        return {vertices, faces};
    }
};
/// Whether the interiors of two sets of cells meet, of which the first is moved.
bool meet_after(const std::set<grid_place>& a, const std::set<grid_place>& b, const std::array<rational, 3>& move) {
    for (const grid_place& p : a) {
        for (const grid_place& q : b) {
            bool meet = true;
            for (std::size_t c = 0; c < 3; ++c) meet &= abs(rational(p[c] - q[c]) + move[c]) < 1;
            if (meet) return true;
        }
    }
    return false;
}

}  // namespace

TEMPLATE_TEST_CASE("penetration: of tetrahedra, against their Minkowski differences", "", float, double) {
    std::uint64_t wrong = 0, too_wide = 0, unlike = 0, deep = 0, much_longer = 0;
    const std::uint64_t count = some_samples(20);
    const serial on;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270801, 1, k);
        const int size = 3 + d.below(5);
        const tetrahedron_of_grid a = draw_tetrahedron(d, size), b = k % 16 == 0 ? a : draw_tetrahedron(d, size);
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
        const auto check = [&](const cells& of, const cells& in, const farthest_point& f) {
            const std::set<grid_place> solid = in.units();
            wrong += wrongs_of_depth(squares_of(of.units()), solid, squares_of(solid), f);
        };
        check(a, b, found.a_in_b);
        check(b, a, found.b_in_a);
        if (found.least > found.most || found.least > std::max(found.a_in_b.upper, found.b_in_a.upper)) ++wrong;
    }
    std::printf("cells: %llu deep of %llu\n", static_cast<unsigned long long>(deep), static_cast<unsigned long long>(count));
    CHECK(wrong == 0);
    CHECK(deep > count / 8);
}

TEMPLATE_TEST_CASE("penetration: by a rule, of boxes that overlap in one mesh, against cells", "", float, double) {
    std::uint64_t wrong = 0, deep = 0, proven = 0;
    const std::uint64_t count = some_samples(160);
    const serial on;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20271129, 5, k);
        const inside_rule rule = std::array{inside_rule::nonzero, inside_rule::positive, inside_rule::parity}[k % 3];
        boxes_in_one a = boxes_in_one::drawn(d), b = boxes_in_one::drawn(d);
        if (k % 8 == 0) a.boxes.push_back(a.boxes.front());  // twice there: by parity it is not
        const mesh<TestType> x = a.surface<TestType>(d), y = b.surface<TestType>(d);
        const std::set<grid_place> in_a = a.solid(rule), in_b = b.solid(rule);
        const auto found = penetration(on, x, y, {.tolerance = 0.02, .rule = rule});
        if (found.overlap != meet_after(in_a, in_b, {0, 0, 0})) ++wrong;
        if (!found.overlap) continue;
        ++deep;
        wrong += wrongs_of_depth(a.squares(), in_b, b.squares(), found.a_in_b);
        wrong += wrongs_of_depth(b.squares(), in_a, a.squares(), found.b_in_a);
        const vec3<double> m{found.move.x, found.move.y, found.move.z};
        if (meet_after(in_a, in_b, {rational(m.x), rational(m.y), rational(m.z)})) ++wrong;
        if (std::sqrt(dot(m, m)) > found.most || found.least > found.most) ++wrong;
        // Shorter moves than `least` do not separate them.
        proven += found.least > 0.1;
        for (int i = 0; i < 26; ++i) {
            const vec3<double> way{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
            const double size = std::sqrt(dot(way, way)), by = size > 0 ? found.least * (1 - 0x1p-20) / size : 0;
            if (!meet_after(in_a, in_b, {rational(by * way.x), rational(by * way.y), rational(by * way.z)})) ++wrong;
        }
    }
    std::printf("by a rule: %llu deep of %llu\n", static_cast<unsigned long long>(deep), static_cast<unsigned long long>(count));
    CHECK(wrong == 0);
    CHECK(deep > count / 4);
    CHECK(proven > deep / 2);
}

TEMPLATE_TEST_CASE("penetration: by parity, a box that is there twice bounds nothing, however deep it is", "", float, double) {
    draws d(20271129, 6, 0);
    const auto box = [](const grid_place& at, int side) {
        cells c;
        c.in.insert({0, 0, 0});
        c.offset = at;
        c.side = side;
        return c;
    };
    const boxes_in_one a{{box({-1, 2, 2}, 2), box({2, 2, 2}, 2), box({2, 2, 2}, 2)}}, b{{box({0, 0, 0}, 6)}};
    const auto found = penetration(serial{}, a.surface<TestType>(d), b.surface<TestType>(d), {.tolerance = 0.01, .rule = inside_rule::parity});
    CHECK(found.overlap);
    CHECK(found.a_in_b.lower > 1.9);
    CHECK(found.least <= 1);
    CHECK(found.most > 4);
    CHECK(penetration(serial{}, a.surface<TestType>(d), b.surface<TestType>(d), {.tolerance = 0.01, .rule = inside_rule::nonzero}).least > 1.99);
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
    CHECK_THROWS_AS(penetration(on, of_mesh, open, {.rule = inside_rule::nonzero}), invalid_geometry);
    const auto tree = make_bvh(on, of_mesh);
    const std::vector list{posed_pair<std::remove_const_t<decltype(tree)>>{posed(tree, rigid<T>{}), posed(tree, away)}};
    const penetration_options by{.tolerance = 1e-3, .rule = inside_rule::nonzero};
    CHECK(penetration(on, list, by).front() == penetration(on, tree, posed(tree, away), by));
}

}  // namespace abut::test
