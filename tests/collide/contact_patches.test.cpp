// SPDX-License-Identifier: MIT
//
// Patches of contact: of solids whose patch is known in closed form, and of sets of cells of two grids against what their unit
// squares say of regions, areas and depths.

#include <abut/collide/contact_patches.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <abut/index/quantised.hpp>
#include <abut/index/wide.hpp>

#include "patch_cases.hpp"
#include "solid_cases.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"

namespace abut::test {

namespace {

using faces_list = std::vector<std::array<std::uint32_t, 3>>;

template <scalar T>
struct surface_lists {
    std::vector<vec3<T>> vertices;
    faces_list faces;
    void add_box(const vec3<double>& l, const vec3<double>& u) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        for (int i = 0; i < 8; ++i) {
            vertices.push_back({static_cast<T>((i & 1) != 0 ? u.x : l.x), static_cast<T>((i & 2) != 0 ? u.y : l.y), static_cast<T>((i & 4) != 0 ? u.z : l.z)});
        }
        for (const auto& f : faces_list{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                        {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}}) {
            faces.push_back({first + f[0], first + f[1], first + f[2]});
        }
    }
    [[nodiscard]] mesh<T> made() const { return {vertices, faces}; }
};

template <scalar T>
mesh<T> box_of(const vec3<double>& l, const vec3<double>& u) {
    surface_lists<T> s;
    s.add_box(l, u);
    return s.made();
}

template <scalar T>
bool near(const vec3<T>& p, const vec3<double>& q, double within = 1e-5) {
    return std::abs(static_cast<double>(p.x) - q.x) <= within && std::abs(static_cast<double>(p.y) - q.y) <= within &&
           std::abs(static_cast<double>(p.z) - q.z) <= within;
}

/// A ball of radius 1 in rings.
template <scalar T>
mesh<T> ball(int rings, int around) {
    constexpr double pi = 3.14159265358979323846;
    std::vector<vec3<T>> v{{0, 0, 1}};
    faces_list f;
    for (int i = 1; i < rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const double a = pi * i / rings, b = 2 * pi * k / around;
            v.push_back({static_cast<T>(std::sin(a) * std::cos(b)), static_cast<T>(std::sin(a) * std::sin(b)), static_cast<T>(std::cos(a))});
        }
    }
    v.push_back({0, 0, -1});
    const auto last = static_cast<std::uint32_t>(v.size() - 1);
    const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(1 + (i - 1) * around + k % around); };
    for (int k = 0; k < around; ++k) {
        f.push_back({0, at(1, k), at(1, k + 1)});
        f.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
        for (int i = 1; i + 1 < rings; ++i) {
            f.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            f.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return {std::move(v), std::move(f)};
}

}  // namespace

TEMPLATE_TEST_CASE("contact patches of boxes are known", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    const auto plate = box_of<T>({-5, -5, -1}, {5, 5, 0});
    const auto only = [&](const auto& a, const auto& b) {
        auto all = contact_patches(on, a, b);
        REQUIRE(all.size() == 1);
        return all.front();
    };
    SECTION("pressed into a plate") {
        const auto cube = box_of<T>({0, 0, -0.125}, {1, 1, 1});
        for (const bool turned : {false, true}) {
            const auto p = turned ? only(plate, cube) : only(cube, plate);
            CHECK(near(p.normal, {0, 0, turned ? -1.0 : 1.0}));
            CHECK(p.area == Approx(1));
            CHECK(p.depth == Approx(0.125));
            CHECK(near(p.center, {0.5, 0.5, 0}));
            CHECK(near(turned ? p.deepest_b : p.deepest_a, {0.5, 0.5, -0.125}));
            CHECK(std::abs((turned ? p.deepest_a : p.deepest_b).z) < 1e-6);
            CHECK(p.curves.size() == 1);
            CHECK(p.curves.front().closed);
            REQUIRE(p.points.size() == 4);
            for (const auto& q : p.points) {
                CHECK(q.depth == Approx(0.125));
                CHECK(std::abs(q.point.z) < 1e-6);
                CHECK(std::abs(std::abs(q.point.x - T(0.5)) - T(0.5)) + std::abs(std::abs(q.point.y - T(0.5)) - T(0.5)) < 1e-5);
            }
        }
    }
    SECTION("at rest, and over an edge") {
        const auto rest = only(box_of<T>({0, 0, 0}, {1, 1, 1}), plate);
        CHECK(near(rest.normal, {0, 0, 1}));
        CHECK(rest.area == Approx(1));
        CHECK(rest.depth == 0);
        CHECK(near(rest.center, {0.5, 0.5, 0}));
        CHECK(rest.points.size() == 4);
        const auto over = only(plate, box_of<T>({4.5, 0, 0}, {5.5, 1, 1}));
        CHECK(near(over.normal, {0, 0, -1}));
        CHECK(over.area == Approx(0.5));
        CHECK(over.depth == 0);
        CHECK(near(over.center, {4.75, 0.5, 0}));
    }
    SECTION("a corner in a corner") {
        const auto p = only(box_of<T>({0, 0, 0}, {2, 2, 2}), box_of<T>({1, 1, 1}, {3, 3, 3}));
        const double third = -1 / std::sqrt(3.0);
        CHECK(near(p.normal, {third, third, third}));
        CHECK(p.area == Approx(std::sqrt(3.0)));
        CHECK(p.depth == Approx(std::sqrt(3.0)));
        CHECK(near(p.center, {1.5, 1.5, 1.5}));
    }
    SECTION("sides in one plane count by half") {
        const auto p = only(box_of<T>({1, 0.5, 1}, {3, 1.5, 2}), box_of<T>({0, 0, 0}, {2, 2, 2}));
        CHECK(near(p.normal, {2 / std::sqrt(5.0), 0, 1 / std::sqrt(5.0)}));
        CHECK(p.area == Approx(std::sqrt(1.25)));
    }
    SECTION("points and lines") {
        const auto edge = only(box_of<T>({5, 0, 0}, {6, 1, 1}), plate);
        CHECK(near(edge.normal, {std::sqrt(0.5), 0, std::sqrt(0.5)}));
        CHECK(edge.area == 0);
        CHECK(edge.depth == 0);
        CHECK(near(edge.center, {5, 0.5, 0}));
        CHECK(edge.points.size() == 2);
        // A tip on a face.
        const mesh<T> tip{{{0, 0, 0}, {1, 0, 2}, {0, 1, 2}, {-1, -1, 2}}, {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
        const auto point = only(tip, plate);
        CHECK(point.normal.z > 0.9);
        CHECK(point.curves.empty());
        CHECK(point.points.size() == 1);
        CHECK(point.depth == 0);
        CHECK(near(point.center, {0, 0, 0}));
    }
    SECTION("nothing to say, or no side") {
        CHECK(contact_patches(on, box_of<T>({0, 0, -0.5}, {1, 1, -0.25}), plate).empty());
        CHECK(contact_patches(on, box_of<T>({0, 0, 1}, {1, 1, 2}), plate).empty());
        CHECK(contact_patches(on, mesh<T>(), plate).empty());
        const auto rod = only(box_of<T>({0, 0, -3}, {1, 1, 3}), plate);
        CHECK(rod.curves.size() == 2);
        CHECK(rod.normal == vec3<T>{0, 0, 0});
        CHECK(rod.points.empty());
        const auto same = only(plate, plate);
        CHECK(same.normal == vec3<T>{0, 0, 0});
        CHECK(same.area < 1e-5);
        CHECK(same.depth == 0);
    }
}

TEST_CASE("patches of huge and tiny solids are those of others", "[patches]") {
    const serial on;
    for (const double unit : {0x1p1020, 0x1p300, 0x1p-300, 0x1p-1000}) {
        const auto of = [&](const vec3<double>& l, const vec3<double>& u) { return box_of<double>(scale(unit, l), scale(unit, u)); };
        const auto all = contact_patches(on, of({0, 0, -0.125}, {1, 1, 1}), of({-5, -5, -1}, {5, 5, 0}));
        CAPTURE(unit);
        REQUIRE(all.size() == 1);
        CHECK(near(all[0].normal, {0, 0, 1}));
        CHECK(all[0].depth == Approx(0.125 * unit).epsilon(1e-12));
        CHECK(near(scale(1 / unit, all[0].center), {0.5, 0.5, 0}));
        CHECK(all[0].points.size() == 4);
    }
}

TEMPLATE_TEST_CASE("a table has a patch for each foot, and a ring one for its rod", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    // A bow of two feet, of cells.
    cells bow;
    bow.in = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}};
    draws d(20280101, 1, 0);
    const auto feet = contact_patches(on, surface_of<T>(bow, {}, d), box_of<T>({-5, -5, -1}, {5, 5, 0.25}));
    REQUIRE(feet.size() == 2);
    std::set<double> at;
    for (const auto& p : feet) {
        CHECK(p.area == Approx(1));
        CHECK(p.depth == Approx(0.25));
        CHECK(near(p.normal, {0, 0, 1}));
        at.insert(std::round(100 * static_cast<double>(p.center.x)) / 100);
    }
    CHECK(at == std::set<double>{0.5, 2.5});
    // A rod that sticks in a ring's side, from outside, and does not reach its hole; and one that does, in the first side alone.
    cells ring;
    for (int i = 0; i < 9; ++i) {
        if (i != 4) ring.in.insert({i % 3, i / 3, 0});
    }
    const auto around = surface_of<T>(ring, {}, d);
    CHECK(contact_patches(on, box_of<T>({-3, 1.25, 0.25}, {0.5, 1.75, 0.75}), around).size() == 1);
    CHECK(contact_patches(on, box_of<T>({-3, 1.25, 0.25}, {1.5, 1.75, 0.75}), around).size() == 1);
    // One through both sides has two regions.
    CHECK(contact_patches(on, box_of<T>({-3, 1.25, 0.25}, {6, 1.75, 0.75}), around).size() == 2);
}

TEMPLATE_TEST_CASE("a ball in a plate has the patch of a circle", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    const auto shape = ball<T>(24, 48);
    for (const double depth : {0.05, 0.3, 0.7}) {
        const rigid<T> up{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, static_cast<T>(1 - depth)}};
        const auto all = contact_patches(on, posed(make_bvh(on, shape), up), box_of<T>({-5, -4, -2}, {5, 6, 0}), {.most_points = 16});
        REQUIRE(all.size() == 1);
        const auto& p = all.front();
        const double circle = 3.14159265358979 * (1 - (1 - depth) * (1 - depth));
        CHECK(p.area < circle);
        CHECK(p.area > 0.85 * circle);
        CHECK(p.depth == Approx(depth).epsilon(1e-5));
        CHECK(near(p.normal, {0, 0, 1}, 1e-4));
        CHECK(near(p.center, {0, 0, 0}, 1e-4));
        CHECK(near(p.deepest_a, {0, 0, -depth}, 1e-5));
        CHECK(p.points.size() >= 8);
        CHECK(p.points.size() <= 16);
        double hull = 0;
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            const auto &q = p.points[i].point, &r = p.points[(i + 1) % p.points.size()].point;
            hull += (static_cast<double>(q.x) * static_cast<double>(r.y) - static_cast<double>(q.y) * static_cast<double>(r.x)) / 2;
        }
        CHECK(hull > 0.85 * p.area);
        CHECK(hull < 1.02 * p.area);
    }
}

namespace {

/// What the unit squares of two sets of cells say.
struct region_of_squares {
    double sum[3] = {0, 0, 0};  ///< of the area vectors of a's squares in b, outwards of a; half of those that both have
    std::vector<grid_place> corners_a, corners_b;
    bool has_curve = false;
};

struct unit_square {
    grid_place cell;  ///< inside of the solid
    int axis, way;
    bool of_a;
    double weight;
    [[nodiscard]] grid_place corner(int k) const {
        grid_place p = cell;
        p[static_cast<std::size_t>(axis)] += way > 0;
        p[static_cast<std::size_t>((axis + 1) % 3)] += k == 1 || k == 2;
        p[static_cast<std::size_t>((axis + 2) % 3)] += k >= 2;
        return p;
    }
};

void squares_in(const std::set<grid_place>& of, const std::set<grid_place>& other, bool of_a, std::vector<unit_square>& out) {
    for (const grid_place& c : of) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int way : {-1, 1}) {
                grid_place beyond = c;
                beyond[static_cast<std::size_t>(axis)] += way;
                if (of.contains(beyond)) continue;
                const bool here = other.contains(c), there = other.contains(beyond);
                if (here || there) out.push_back({c, axis, way, of_a, here && !there ? 0.5 : 1});
            }
        }
    }
}

std::vector<region_of_squares> regions_of_squares(const cells& a, const cells& b) {
    const std::set<grid_place> in_a = a.units(), in_b = b.units();
    std::vector<unit_square> all;
    squares_in(in_a, in_b, true, all);
    squares_in(in_b, in_a, false, all);
    std::vector<std::size_t> root(all.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i];
        return i;
    };
    std::map<std::pair<grid_place, grid_place>, std::vector<std::size_t>> at_edge;  // an edge; or a corner of one solid
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            const grid_place p = all[i].corner(k), q = all[i].corner((k + 1) % 4);
            at_edge[{std::min(p, q), std::max(p, q)}].push_back(i);
            const grid_place mark{all[i].of_a ? 1 : 2, -1000, 0};
            at_edge[{p, mark}].push_back(i);
        }
    }
    std::vector<char> is_on_curve(all.size(), 0);
    for (const auto& [edge, squares] : at_edge) {
        bool of_a = false, of_b = false;
        for (const std::size_t i : squares) {
            root[find(i)] = find(squares.front());
            (all[i].of_a ? of_a : of_b) = true;
        }
        if (of_a && of_b) is_on_curve[squares.front()] = 1;
    }
    std::map<std::size_t, region_of_squares> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
        region_of_squares& r = found[find(i)];
        r.has_curve |= is_on_curve[i] != 0;
        if (all[i].of_a) r.sum[all[i].axis] += all[i].way * all[i].weight;
        for (int k = 0; k < 4; ++k) (all[i].of_a ? r.corners_a : r.corners_b).push_back(all[i].corner(k));
    }
    std::vector<region_of_squares> regions;
    for (const auto& [i, r] : found) {
        if (r.has_curve) regions.push_back(r);
    }
    return regions;
}

/// An area vector of unit squares under the map of a frame.
std::array<double, 3> mapped(const double (&sum)[3], const frame_of_grid& f) {
    const auto& m = f.map;
    std::array<double, 3> out{};
    const int way = f.determinant() < 0 ? -1 : 1;
    for (int c = 0; c < 3; ++c) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        double across[3];
        for (int r = 0; r < 3; ++r) {
            const int s = (r + 1) % 3, t = (r + 2) % 3;
            across[r] = m[s][d] * m[t][e] - m[t][d] * m[s][e];
        }
        for (int r = 0; r < 3; ++r) out[static_cast<std::size_t>(r)] += sum[c] * across[r];
    }
    for (double& x : out) x *= way * f.unit * f.unit;
    return out;
}

template <scalar T>
double height(const contact_patch<T>& p, const vec3<double>& q) {
    return static_cast<double>(p.normal.x) * q.x + static_cast<double>(p.normal.y) * q.y + static_cast<double>(p.normal.z) * q.z;
}
template <scalar T>
double area_along(const contact_patch<T>& p, std::size_t axis) {
    return -static_cast<double>(p.area) * static_cast<double>(axis == 0 ? p.normal.x : axis == 1 ? p.normal.y : p.normal.z);
}

}  // namespace

TEMPLATE_TEST_CASE("patches of cells are those of their squares", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    std::uint64_t regions = 0, without_side = 0, of_many = 0;
    for (std::uint64_t k = 0; k < 800; ++k) {
        draws d(20280102, 1, k);
        // Corners of one are at even places, and those of the other at odd ones, so that an edge passes up to two faces.
        cells a = draw_cells(d, 2 + d.below(2), 4, 0), b = draw_cells(d, 2 + d.below(3), 2, 0);
        for (int& x : a.offset) x = 0;
        for (int& x : b.offset) x = 2 * d.below(6) - 3;
        if (k % 8 == 0) {  // a rod
            b.in.clear();
            for (int i = 0; i < 9; ++i) b.in.insert({0, 0, i});
            b.offset[2] = -3;
        }
        const frame_of_grid f = draw_frame(d);
        const bool inwards_a = d.below(2) == 0, inwards_b = d.below(2) == 0;
        const auto x = surface_of<T>(a, f, d, inwards_a), y = surface_of<T>(b, f, d, inwards_b);
        const bool swapped = d.below(2) == 0;
        const auto expected = swapped ? regions_of_squares(b, a) : regions_of_squares(a, b);
        const auto found = swapped ? contact_patches(on, y, x) : contact_patches(on, x, y);
        CAPTURE(k, swapped, inwards_a, inwards_b);
        REQUIRE(found.size() == expected.size());
        of_many += found.size() > 1;
        std::vector<char> is_used(expected.size(), 0);
        for (const auto& p : found) {
            ++regions;
            // Which one it is: the one that has the first point of its curve among its corners' hulls. Areas and depths tell.
            bool is_one = false;
            for (std::size_t i = 0; i < expected.size() && !is_one; ++i) {
                if (is_used[i] != 0) continue;
                const auto sum = mapped(expected[i].sum, f);
                bool fits = true;
                const double reach = 0.02 * f.side() * f.side();
                double most = 0;
                for (std::size_t c = 0; c < 3; ++c) {
                    fits &= std::abs(sum[c] - area_along(p, c)) <= reach;
                    most = std::max(most, std::abs(sum[c]));
                }
                if (most == 0) fits &= static_cast<double>(p.area) <= reach;
                double lowest = 1e300, highest = -1e300;
                for (const grid_place& q : expected[i].corners_a) lowest = std::min(lowest, height(p, f.operator()<double>(q)));
                for (const grid_place& q : expected[i].corners_b) highest = std::max(highest, height(p, f.operator()<double>(q)));
                fits &= std::abs(std::max(0.0, highest - lowest) - static_cast<double>(p.depth)) <= 1e-3 * f.side();
                if (!fits) continue;
                is_used[i] = 1;
                is_one = true;
                without_side += most == 0;
            }
            CHECK(is_one);
        }
    }
    CHECK(regions > 400);
    CHECK(of_many > 40);
    CHECK(without_side > 5);
}

TEMPLATE_TEST_CASE("areas of touching cells are those of their squares", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    std::uint64_t touching = 0;
    for (std::uint64_t k = 0; k < 800; ++k) {
        draws d(20280103, 1, k);
        const auto [a, b] = draw_two_sets(d, k);
        const frame_of_grid f = draw_frame(d);
        const bool inwards_a = d.below(2) == 0, inwards_b = d.below(2) == 0;
        const auto x = surface_of<T>(a, f, d, inwards_a), y = surface_of<T>(b, f, d, inwards_b);
        std::array<double, 3> expected{}, found{};
        for (const auto& r : regions_of_squares(a, b)) {
            const auto sum = mapped(r.sum, f);
            for (std::size_t c = 0; c < 3; ++c) expected[c] += sum[c];
        }
        for (const auto& p : contact_patches(on, x, y)) {
            for (std::size_t c = 0; c < 3; ++c) found[c] += area_along(p, c);
            ++touching;
        }
        CAPTURE(k);
        for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(expected[c] - found[c]) <= 0.02 * f.side() * f.side());
    }
    CHECK(touching > 500);
}

TEMPLATE_TEST_CASE("patches are the same bits on each policy and of each index", "[patches]", float, double) {
    using T = TestType;
    const serial on;
    const auto a = ball<T>(17, 32), b = ball<T>(13, 29);
    const rigid<T> there{{T(0.8), T(-0.6), 0, T(0.6), T(0.8), 0, 0, 0, 1}, {T(0.7), T(0.9), T(0.4)}};
    const auto first = contact_patches(on, a, posed(b, there));
    REQUIRE(first.size() == 1);
    CHECK(first.front().points.size() == 8);
    const openmp many{3};
    check_patches<T>(many);
    CHECK(are_same(first, contact_patches(many, a, posed(make_bvh(many, b), there))));
    CHECK(are_same(first, contact_patches(many, make_bvh(many, a), posed(wide(many, make_bvh(many, b)), there), {.known_solid = true})));
    CHECK(are_same(first, contact_patches(on, quantised(on, make_bvh(on, a)), posed(b, there))));
    // Other numbers of faces and vertices: the same but for the order of sums.
    std::vector<vec3<T>> vertices;
    faces_list faces;
    const auto view = a.view();
    const auto n = static_cast<std::uint32_t>(view.vertices.count);
    for (std::uint32_t i = 0; i < n; ++i) vertices.push_back(view.vertices[n - 1 - i]);
    for (std::size_t i = view.size(); i-- > 0;) faces.push_back({n - 1 - view.faces[i][1], n - 1 - view.faces[i][2], n - 1 - view.faces[i][0]});
    const auto other = contact_patches(on, mesh<T>(vertices, faces), posed(b, there));
    REQUIRE(other.size() == 1);
    const auto &p = first.front(), &q = other.front();
    const auto as_double = [](const vec3<T>& v) { return vec3<double>{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; };
    CHECK(near(p.normal, as_double(q.normal)));
    CHECK(near(p.center, as_double(q.center)));
    CHECK(p.area == Approx(q.area));
    CHECK(p.depth == Approx(q.depth));
    REQUIRE(p.points.size() == q.points.size());
    for (std::size_t i = 0; i < p.points.size(); ++i) CHECK(near(p.points[i].point, as_double(q.points[i].point)));
}

TEST_CASE("patches of what is no solid are refused, and boxes and hulls are taken", "[patches]") {
    const serial on;
    const auto plate = box_of<float>({-5, -5, -1}, {5, 5, 0});
    const mesh<float> open{{{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}};
    CHECK_THROWS_AS(contact_patches(on, open, plate), invalid_geometry);
    CHECK_THROWS_AS(contact_patches(on, plate, open), invalid_geometry);
    CHECK_THROWS_AS(contact_patches(on, plate, plate, {.most_points = 3}), invalid_geometry);
    surface_lists<float> crossed;
    crossed.add_box({0, 0, -0.5}, {1, 1, 1});
    crossed.add_box({0.5, 0.5, -0.25}, {1.5, 1.5, 2});
    CHECK_THROWS_AS(contact_patches(on, crossed.made(), plate), invalid_geometry);
    const auto all = contact_patches(on, aabb<float>{{0, 0, -0.5F}, {1, 1, 1}}, plate);
    REQUIRE(all.size() == 1);
    CHECK(all.front().area == Approx(1));
    CHECK(all.front().depth == Approx(0.5));
}

}  // namespace abut::test
