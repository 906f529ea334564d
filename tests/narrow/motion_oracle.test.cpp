// SPDX-License-Identifier: MIT
#include "support/motion_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/ccd_scene.hpp"
#include "support/hulls.hpp"
#include "support/motion_families.hpp"
#include "support/samples.hpp"

// The oracle of continuous collision detection, held against what is known otherwise: answers worked out by hand, the truth
// files, symmetries, contacts at fixed times decided by a linear program, and proofs of no contact by cutting boxes.

namespace abut::test {

namespace {

constexpr motion_kind both_kinds[] = {motion_kind::vertex_face, motion_kind::edge_edge};

using four = std::array<vec3<double>, 4>;

motion<double> pair_of(const four& t0, const four& t1) {
    motion<double> m;
    for (std::size_t i = 0; i < 4; ++i) {
        m.t0[i] = t0[i];
        m.t1[i] = t1[i];
    }
    return m;
}

/// A known answer: t is numerator / denominator; there is no contact if the denominator is 0.
struct known_case {
    const char* what;
    motion_kind kind;
    four t0, t1;
    int numerator, denominator;
};

/// Corners fixed, the vertex moves.
known_case vertex(const char* what, const vec3<double>& from, const vec3<double>& to,
                  const std::array<vec3<double>, 3>& face, int numerator, int denominator) {
    return {
        what,       motion_kind::vertex_face, {from, face[0], face[1], face[2]}, {to, face[0], face[1], face[2]}, numerator,
        denominator};
}

/// The second edge fixed, the first moves by `by`.
known_case edge(const char* what, const std::array<vec3<double>, 2>& first, const vec3<double>& by,
                const std::array<vec3<double>, 2>& second, int numerator, int denominator) {
    return {what,
            motion_kind::edge_edge,
            {first[0], first[1], second[0], second[1]},
            {first[0] + by, first[1] + by, second[0], second[1]},
            numerator,
            denominator};
}

void check_known(const known_case& c) {
    CAPTURE(c.what);
    motion_answer a = oracle::first_contact(c.kind, pair_of(c.t0, c.t1));
    if (c.denominator == 0) {
        CHECK_FALSE(a.hit);
        CHECK(a.cell == -1);
        CHECK(a.time == -1);
        return;
    }
    REQUIRE(a.hit);
    CHECK(a.exact->sign(polynomial({-c.numerator, c.denominator})) == 0);
    CHECK(a.time == static_cast<double>(c.numerator) / c.denominator);
    CHECK(a.cell == (static_cast<std::int64_t>(c.numerator) << 40) / c.denominator);
}

}  // namespace

TEST_CASE("motion oracle: vertex-face, worked out by hand") {
    const std::array<vec3<double>, 3> face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, segment{{{0, 0, 0}, {4, 0, 0}, {2, 0, 0}}},
        again{{{0, 0, 0}, {4, 0, 0}, {4, 0, 0}}}, point{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
    const known_case cases[] = {
        vertex("through the face", {1, 1, 1}, {1, 1, -1}, face, 1, 2),
        vertex("a third", {1, 1, 1}, {1, 1, -2}, face, 1, 3),
        vertex("two sevenths, obliquely", {0, 0, 2}, {3.5, 3.5, -5}, face, 2, 7),
        vertex("at the end", {1, 1, 1}, {1, 1, 0}, face, 1, 1),
        vertex("at the beginning", {1, 1, 0}, {1, 1, 5}, face, 0, 1),
        vertex("never quite", {1, 1, 1}, {1, 1, 0x1p-1074}, face, 0, 0),
        vertex("at a corner", {4, 0, 3}, {4, 0, -1}, face, 3, 4),
        vertex("at an edge", {2, 2, 1}, {2, 2, -1}, face, 1, 2),
        vertex("beside the edge", {2, 2 + 0x1p-51, 1}, {2, 2 + 0x1p-51, -1}, face, 0, 0),
        vertex("beside it", {5, 5, 1}, {5, 5, -1}, face, 0, 0),
        vertex("in its plane, from outside", {-1, 1, 0}, {3, 1, 0}, face, 1, 4),
        vertex("in its plane, from inside", {1, 1, 0}, {9, 1, 0}, face, 0, 1),
        vertex("in its plane, past a corner", {-1, 1, 0}, {1, -1, 0}, face, 1, 2),
        vertex("in its plane, onto an edge", {-1, 2, 0}, {2, -2, 0}, face, 1, 3),
        vertex("in its plane, outside", {-1, 0.5, 0}, {0.5, -1, 0}, face, 0, 0),
        vertex("in its plane, at rest", {1, 2, 0}, {1, 2, 0}, face, 0, 1),
        vertex("in its plane, at rest, outside", {3, 3, 0}, {3, 3, 0}, face, 0, 0),
        vertex("parallel to its plane", {1, 1, 1}, {2, 1, 1}, face, 0, 0),
        vertex("at rest", {1, 1, 1}, {1, 1, 1}, face, 0, 0),
        vertex("a segment", {1, 1, 1}, {1, -1, -1}, segment, 1, 2),
        vertex("a segment, at its end", {4, 1, 1}, {4, -3, -3}, segment, 1, 4),
        vertex("a segment, past its end", {5, 1, 1}, {5, -1, -1}, segment, 0, 0),
        vertex("a segment, past it", {1, 1, 1}, {1, -1, -2}, segment, 0, 0),
        vertex("along a segment", {-2, 0, 0}, {2, 0, 0}, segment, 1, 2),
        vertex("along a segment, away", {-2, 0, 0}, {-1, 0, 0}, segment, 0, 0),
        vertex("along a segment, beside it", {-2, 0, 1}, {2, 0, 1}, segment, 0, 0),
        vertex("along a segment of two equal corners", {-2, 0, 0}, {4, 0, 0}, again, 1, 3),
        vertex("on a segment", {3, 0, 0}, {3, 0, 0}, segment, 0, 1),
        vertex("a point", {0, 0, 0}, {3, 3, 3}, point, 1, 3),
        vertex("past a point", {0, 0, 0}, {2, 2, 3}, point, 0, 0),
        vertex("up to before a point", {0, 0, 0}, {0.5, 0.5, 0.5}, point, 0, 0),
        vertex("on a point", {1, 1, 1}, {1, 1, 1}, point, 0, 1),
        vertex("beside a point", {1, 1, 2}, {1, 1, 2}, point, 0, 0),
        {"all along together",
         motion_kind::vertex_face,
         {{{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
         {{{8, 1, 5}, {7, 0, 5}, {11, 0, 5}, {7, 4, 5}}},
         0,
         1},
        {"apart, together",
         motion_kind::vertex_face,
         {{{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
         {{{8, 1, 6}, {7, 0, 5}, {11, 0, 5}, {7, 4, 5}}},
         0,
         0},
        {"the face comes",
         motion_kind::vertex_face,
         {{{1, 1, 0}, {0, 0, 2}, {4, 0, 2}, {0, 4, 2}}},
         {{{1, 1, 0}, {0, 0, -3}, {4, 0, -3}, {0, 4, -3}}},
         2,
         5},
        // The face grows from the point (0, 0, 0); the vertex waits in its plane.
        {"a face grows",
         motion_kind::vertex_face,
         {{{1, 1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
         {{{1, 1, 0}, {0, 0, 0}, {6, 0, 0}, {0, 6, 0}}},
         1,
         3},
        // It turns over, and is a segment at the moment of contact.
        {"a face turns over",
         motion_kind::vertex_face,
         {{{0, 0, 0}, {-1, 0, 1}, {1, 0, 1}, {0, 2, 1}}},
         {{{0, 0, 0}, {-1, 0, -1}, {1, 0, -1}, {0, -2, -1}}},
         1,
         2},
        // It turns about the y axis, z = (1 - 2 t) x, and the vertex crosses that axis with x = 2 t - 1: a double root.
        {"touches and goes",
         motion_kind::vertex_face,
         {{{-1, 0, 0}, {-4, -4, -4}, {4, -4, 4}, {0, 8, 0}}},
         {{{1, 0, 0}, {-4, -4, 4}, {4, -4, -4}, {0, 8, 0}}},
         1,
         2},
        {"all but touches",
         motion_kind::vertex_face,
         {{{-1, 0, 0x1p-1074}, {-4, -4, -4}, {4, -4, 4}, {0, 8, 0}}},
         {{{1, 0, 0x1p-1074}, {-4, -4, 4}, {4, -4, -4}, {0, 8, 0}}},
         0,
         0},
        // In the plane at 1/4, far outside, and at 3/4: z = x (1 - 4 t) against z = 0 with x = 8 (3/4 - t).
        {"the second root",
         motion_kind::vertex_face,
         {{{6, 0, 0}, {-1, -1, -1}, {1, -1, 1}, {0, 2, 0}}},
         {{{-2, 0, 0}, {-1, -1, 3}, {1, -1, -3}, {0, 2, 0}}},
         3,
         4},
    };
    for (const known_case& c : cases) check_known(c);
}

TEST_CASE("motion oracle: edge-edge, worked out by hand") {
    const std::array<vec3<double>, 2> x{{{-1, 0, 1}, {1, 0, 1}}}, y{{{0, -1, 0}, {0, 1, 0}}},
        along_x{{{0, 0, 0}, {1, 0, 0}}}, far_x{{{3, 0, 0}, {4, 0, 0}}}, above_x{{{0, 0, 1}, {2, 0, 1}}},
        half_x{{{1, 0, 0}, {3, 0, 0}}}, point{{{0, 0, 0}, {0, 0, 0}}};
    const known_case cases[] = {
        edge("crossing", x, {0, 0, -2}, y, 1, 2),
        edge("crossing at a third", x, {0, 0, -3}, y, 1, 3),
        edge("at the end", x, {0, 0, -1}, y, 1, 1),
        edge("at the beginning", {{{-1, 0, 0}, {1, 0, 0}}}, {0, 0, 1}, y, 0, 1),
        edge("not yet", x, {0, 0, -1 + 0x1p-53}, y, 0, 0),
        edge("ends", {{{0, 1, 1}, {1, 1, 1}}}, {0, 0, -4}, y, 1, 4),
        edge("past the end", {{{0x1p-1074, 1, 1}, {1, 1, 1}}}, {0, 0, -4}, y, 0, 0),
        edge("an end on the inside", {{{0, 0, 1}, {1, 0, 1}}}, {0, 0, -8}, y, 1, 8),
        edge("parallel, falling on it", above_x, {0, 0, -2}, half_x, 1, 2),
        edge("parallel, falling beside it", above_x, {0, 0, -2}, far_x, 0, 0),
        edge("parallel, in a plane, end to end", above_x, {1, 0, -1}, far_x, 1, 1),
        edge("parallel, past it", above_x, {3, 0.5, -3}, half_x, 0, 0),
        edge("on one line", along_x, {4, 0, 0}, far_x, 1, 2),
        edge("on one line, too slow", along_x, {1.5, 0, 0}, far_x, 0, 0),
        edge("on one line, away", along_x, {-9, 0, 0}, far_x, 0, 0),
        edge("on one line, at rest, overlapping", {{{0, 0, 0}, {2, 0, 0}}}, {0, 0, 0}, half_x, 0, 1),
        edge("on one line, at rest, apart", along_x, {0, 0, 0}, far_x, 0, 0),
        edge("in one plane, an end first", {{{-3, 0, 0}, {-1, 0.5, 0}}}, {4, 0, 0}, y, 1, 4),
        edge("in one plane, past it", {{{-3, 5, 0}, {-1, 5.5, 0}}}, {4, 0, 0}, y, 0, 0),
        edge("in one plane, at rest, crossing", {{{-1, 0, 0}, {1, 0, 0}}}, {0, 0, 0}, y, 0, 1),
        edge("in one plane, at rest, apart", along_x, {0, 0, 0}, {{{2, -1, 0}, {2, 1, 0}}}, 0, 0),
        edge("skew, at rest", x, {0, 0, 0}, y, 0, 0),
        edge("the same", y, {0, 0, 0}, y, 0, 1),
        edge("a point through an edge", {{{1, 0, 1}, {1, 0, 1}}}, {-2, 0, -2}, y, 1, 2),
        edge("a point past an edge", {{{1, 0, 1}, {1, 0, 1}}}, {-2, 0, -3}, y, 0, 0),
        edge("a point along an edge", {{{0, 5, 0}, {0, 5, 0}}}, {0, -12, 0}, y, 1, 3),
        edge("a point on an edge", {{{0, 0.5, 0}, {0, 0.5, 0}}}, {0, 0, 0}, y, 0, 1),
        edge("a point on a point", {{{3, 3, 3}, {3, 3, 3}}}, {-9, -9, -9}, point, 1, 3),
        edge("a point past a point", {{{3, 3, 3}, {3, 3, 3}}}, {-9, -9, -8}, point, 0, 0),
        edge("a point at rest on a point", point, {0, 0, 0}, point, 0, 1),
        edge("a point at rest beside a point", {{{0, 0, 1}, {0, 0, 1}}}, {0, 0, 0}, point, 0, 0),
        // Each turns in a plane of its own; they lie in one line as they meet, at the ends.
        {"collinear at the contact only",
         motion_kind::edge_edge,
         {{{0, 0, -1}, {-1, 1, -1}, {0, 0, 1}, {1, 1, 1}}},
         {{{0, 0, 1}, {-1, -1, 1}, {0, 0, -1}, {1, -1, -1}}},
         1,
         2},
        // Two points that become edges.
        {"edges grow",
         motion_kind::edge_edge,
         {{{0, 0, 0}, {0, 0, 0}, {3, -1, 0}, {3, 1, 0}}},
         {{{0, 0, 0}, {4, 0, 0}, {3, -1, 0}, {3, 1, 0}}},
         3,
         4},
        // As for vertex-face: a line z = (1 - 2 t) x, and a line along y with x = 2 t - 1, z = 0.
        {"touch and go",
         motion_kind::edge_edge,
         {{{-4, 0, -4}, {4, 0, 4}, {-1, -1, 0}, {-1, 1, 0}}},
         {{{-4, 0, 4}, {4, 0, -4}, {1, -1, 0}, {1, 1, 0}}},
         1,
         2},
        {"all but touch",
         motion_kind::edge_edge,
         {{{-4, 0, -4}, {4, 0, 4}, {-1, -1, 0x1p-1074}, {-1, 1, 0x1p-1074}}},
         {{{-4, 0, 4}, {4, 0, -4}, {1, -1, 0x1p-1074}, {1, 1, 0x1p-1074}}},
         0,
         0},
    };
    for (const known_case& c : cases) check_known(c);
}

TEST_CASE("motion oracle: irrational times") {
    // A face that turns, z = 2 t x, and a vertex at (t, 0, 1): 2 t^2 = 1. Alike an edge along y through that vertex.
    const vec3<double> p0{0, 0, 1}, p1{1, 0, 1}, y{0, 1, 0};
    const motion<double> pairs[] = {
        pair_of({p0, {-4, -4, 0}, {4, -4, 0}, {0, 8, 0}}, {p1, {-4, -4, -8}, {4, -4, 8}, {0, 8, 0}}),
        pair_of({p0 - y, p0 + y, {-4, 0, 0}, {4, 0, 0}}, {p1 - y, p1 + y, {-4, 0, -8}, {4, 0, 8}})};
    for (const motion_kind kind : both_kinds) {
        motion_answer a = oracle::first_contact(kind, pairs[static_cast<int>(kind)]);
        REQUIRE(a.hit);
        CHECK(a.exact->sign(polynomial({-1, 0, 2})) == 0);
        CHECK(a.exact->sign(polynomial({1, 0, -3})) == -1);
        CHECK(a.time == std::sqrt(0.5));
        CHECK(a.cell == static_cast<std::int64_t>(std::floor(std::ldexp(std::sqrt(0.5), 40))));
        CHECK(a.exact->compared_to(0x1.6a09e667f3bccp-1) == 1);
        CHECK(a.exact->compared_to(0x1.6a09e667f3bcdp-1) == -1);
        CHECK(a.exact->compared_to(-0.5) == 1);
        CHECK(a.exact->compared_to(1.5) == -1);
    }
}

TEST_CASE("motion oracle: numbers") {
    // (8 x - 1) (3 x - 1) (x^2 - 1/2) (x - 1)^2, in integers
    const polynomial x({0, 1});
    const auto number = [](int n) { return polynomial({n}); };
    const polynomial p = (number(8) * x - number(1)) * (number(3) * x - number(1)) * (number(2) * x * x - number(1)) *
                         (x - number(1)) * (x - number(1));
    std::vector<algebraic_number> roots;
    root_finder(p).visit_roots([&](const algebraic_number& r) {
        roots.push_back(r);
        return false;
    });
    REQUIRE(roots.size() == 4);
    const double values[] = {0.125, 1.0 / 3, std::sqrt(0.5), 1};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(roots[i].nearest_double() == values[i]);
        for (std::size_t j = 0; j < 4; ++j) {
            const int order = i < j ? -1 : i > j ? 1 : 0;
            CHECK(roots[i].compared_to(roots[j]) == order);
        }
    }
    // Equal numbers of two polynomials, and one that differs by little.
    std::optional<algebraic_number> third, other;
    root_finder(number(3) * x - number(1)).visit_roots([&](const algebraic_number& r) { return third = r, true; });
    CHECK(third->compared_to(roots[1]) == 0);
    CHECK(roots[1].compared_to(*third) == 0);
    const integer large = integer(1) << 300;
    root_finder(polynomial({-large, 3 * large + 1})).visit_roots([&](const algebraic_number& r) { return other = r, true; });
    CHECK(other->compared_to(roots[1]) == -1);
    CHECK(roots[1].compared_to(*other) == 1);
    // Roots 2^-900 and 2^-900 + 2^-1000, and one at 0: intervals of lengths far apart.
    const polynomial near =
        x * (polynomial({-1, integer(1) << 900})) * polynomial({-(integer(1) << 100) - 1, integer(1) << 1000});
    roots.clear();
    root_finder(near).visit_roots([&](const algebraic_number& r) {
        roots.push_back(r);
        return false;
    });
    REQUIRE(roots.size() == 3);
    CHECK(roots[0].nearest_double() == 0);
    CHECK(roots[1].nearest_double() == 0x1p-900);
    CHECK(roots[2].nearest_double() == 0x1p-900);
    CHECK(roots[1].compared_to(roots[2]) == -1);
    CHECK(roots[2].compared_to(0x1p-900) == 1);
    // Ties of rounding go to even.
    CHECK(to_double((integer(1) << 53) + 1, 53) == 1);
    CHECK(to_double((integer(1) << 53) + 3, 53) == 1 + 0x1p-51);
    CHECK(to_double((integer(1) << 60) - 1, 60) == 1);
    CHECK(to_double(3, 1075) == 0x1p-1073);
    CHECK(to_double(1, 1075) == 0);
    CHECK(to_double(3, 1076) == 0x1p-1074);
}

TEST_CASE("motion oracle: the truth of the scenes") {
    if (!ccd_folder("cloth-funnel")) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    for (const char* name : {"cloth-funnel", "cloth-ball", "armadillo-rollers"}) {
        const auto folder = ccd_folder(name);
        REQUIRE(folder);
        REQUIRE(has_ccd_truth(*folder));
        const ccd_scene scene = read_ccd_scene(*folder);
        for (const motion_kind kind : both_kinds) {
            const std::vector<ccd_truth_row> rows = read_ccd_truth(*folder, kind);
            const std::size_t wanted = std::max<std::size_t>(sample_count() * 2 / 5, 1), step = rows.size() / wanted + 1;
            std::size_t asked = 0, wrong = 0, late = 0;
            for (std::size_t i = 0; i < rows.size(); ++i) {
                const ccd_truth_row& row = rows[i];
                if (row.hit && rows.size() > 1000 && i % step != 0) continue;
                const motion_answer a = oracle::first_contact(kind, scene.pair(row.vertices));
                ++asked;
                if (a.hit != row.hit) ++wrong;
                // The files' times are good to 2^-60, and then rounded, most of them down.
                const double last_place = std::nextafter(row.time, 2) - row.time;
                if (a.hit && row.hit && std::abs(a.time - row.time) > 0x1p-60 + last_place) ++late;
            }
            CAPTURE(name, name_of(kind));
            CHECK(asked >= std::min(rows.size(), wanted) / 2);
            CHECK(wrong == 0);
            CHECK(late == 0);
        }
    }
}

namespace {

/// The integers of a motion, each axis in a unit of its own.
template <scalar T>
std::array<std::array<integer_point, 4>, 2> corners_in_integers(const motion<T>& m) {
    std::array<std::array<integer_point, 4>, 2> r;
    constexpr T vec3<T>::*from[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    constexpr integer integer_point::*to[3] = {&integer_point::x, &integer_point::y, &integer_point::z};
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<T> values;
        for (std::size_t i = 0; i < 8; ++i) values.push_back((i < 4 ? m.t0[i] : m.t1[i - 4]).*from[k]);
        const std::vector<integer> x = to_integers(values);
        for (std::size_t i = 0; i < 8; ++i) r[i / 4][i % 4].*to[k] = x[i];
    }
    return r;
}

/// Whether the features meet at the time n / d, by the linear program.
bool meet_at(motion_kind kind, const std::array<std::array<integer_point, 4>, 2>& p, int n, int d) {
    std::vector<integer_point> points;
    for (std::size_t i = 0; i < 4; ++i) {
        const integer_point &a = p[0][i], &b = p[1][i];
        points.push_back({(d - n) * a.x + n * b.x, (d - n) * a.y + n * b.y, (d - n) * a.z + n * b.z});
    }
    const auto middle = points.begin() + (kind == motion_kind::vertex_face ? 1 : 2);
    return hulls_meet({points.begin(), middle}, {middle, points.end()});
}

/// All that is exact and small enough for many questions.
constexpr motion_family exact_families[] = {motion_family::touch_inside,
                                            motion_family::touch_edge,
                                            motion_family::touch_corner,
                                            motion_family::touch_first,
                                            motion_family::touch_last,
                                            motion_family::touch_far,
                                            motion_family::translating,
                                            motion_family::double_root,
                                            motion_family::two_roots,
                                            motion_family::three_roots,
                                            motion_family::degenerate,
                                            motion_family::collapsing,
                                            motion_family::coplanar_sliding,
                                            motion_family::collinear_sliding,
                                            motion_family::nudged,
                                            motion_family::parallel,
                                            motion_family::rigid,
                                            motion_family::at_rest,
                                            motion_family::at_rest_coplanar,
                                            motion_family::shared,
                                            motion_family::lattice_2,
                                            motion_family::lattice_4,
                                            motion_family::lattice_16,
                                            motion_family::steps,
                                            motion_family::crossing,
                                            motion_family::crossing_border,
                                            motion_family::flat,
                                            motion_family::needles};

/// Pairs of the other families cost milliseconds each in double.
template <scalar T>
std::uint64_t count_of(motion_family f, std::uint64_t n) {
    const bool slow = f == motion_family::wide_lattice || f == motion_family::all_bit_patterns;
    return slow && sizeof(T) == 8 ? n / 20 + 1 : n;
}

}  // namespace

TEMPLATE_TEST_CASE("motion oracle: contacts at fixed times", "", float, double) {
    const std::uint64_t n = sample_count() / 50 + 1;
    constexpr int parts = 16;  // the exact families place contacts at sixteenths
    std::uint64_t decided_there = 0, between = 0;
    for (const motion_kind kind : both_kinds) {
        for (const motion_family f : exact_families) {
            CAPTURE(name_of(kind), name_of(f));
            for (std::uint64_t i = 0; i < n; ++i) {
                const motion<TestType> m = make_motion<TestType>(sample_seed, kind, f, i);
                const motion_answer a = oracle::first_contact(kind, m);
                const auto p = corners_in_integers(m);
                int first = 0;
                while (first <= parts && !meet_at(kind, p, first, parts)) ++first;
                // Up to the first sixteenth with a contact there is one; and it is not at an earlier sixteenth.
                bool right = true;
                if (first <= parts) right = a.hit && a.exact->compared_to(static_cast<double>(first) / parts) <= 0;
                if (a.hit && std::ldexp(a.time, 4) == std::floor(std::ldexp(a.time, 4))) {
                    if (a.exact->compared_to(a.time) == 0) right = right && a.time == static_cast<double>(first) / parts;
                }
                if (!right || (always_hits(f) && !a.hit)) {
                    CAPTURE(i, a.hit, a.time, first);
                    FAIL_CHECK("the oracle and the linear program disagree");
                }
                (a.hit && a.time == static_cast<double>(first) / parts ? decided_there : between) += 1;
            }
        }
    }
    CHECK(decided_there > n * 10);
    CHECK(between > n * 5);
}

namespace {

/// A lower bound of the first time of contact, by a method that knows nothing of roots: boxes of the three parameters (time
/// and two weights) in which a combination of coordinates has one sign at all corners hold no contact, since it is linear in
/// each parameter. The others are cut, in the order of time, until one is left of width 2^-depth. For coordinates of
/// integers below 2^4 all is exact in double up to depth 14.
class box_cutter {
public:
    box_cutter(motion_kind kind, const motion<double>& m, int depth) : kind_(kind), m_(m), depth_(depth) {}

    /// The beginning of the first box that cannot be excluded; above 1 if there is none.
    double first_time() { return search(0, 0, 0, 0); }

private:
    /// Difference of the features' points of weights u and v, at t.
    [[nodiscard]] vec3<double> at(double t, double u, double v) const {
        vec3<double> p[4];
        for (int i = 0; i < 4; ++i) p[i] = m_.t0[i] + t * (m_.t1[i] - m_.t0[i]);
        if (kind_ == motion_kind::edge_edge) return (p[0] + u * (p[1] - p[0])) - (p[2] + v * (p[3] - p[2]));
        // The triangle as an image of the square: a + u (b - a) + u v (c - b)
        return (p[1] + u * (p[2] - p[1]) + (u * v) * (p[3] - p[2])) - p[0];
    }

    [[nodiscard]] bool excluded(double t, double u, double v, double width) const {
        vec3<double> corner[8];
        for (int i = 0; i < 8; ++i) corner[i] = at(t + (i & 1) * width, u + (i >> 1 & 1) * width, v + (i >> 2) * width);
        constexpr vec3<double> directions[] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                               {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                                               {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}, {2, 1, 0},  {0, 2, 1},
                                               {1, 0, 2},  {2, -1, 0}, {0, 2, -1}, {-1, 0, 2}};
        for (const vec3<double>& n : directions) {
            bool positive = true, negative = true;
            for (const vec3<double>& c : corner) {
                const double x = dot(n, c);
                positive = positive && x > 0;
                negative = negative && x < 0;
            }
            if (positive || negative) return true;
        }
        return false;
    }

    double search(double t, double u, double v, int level) {
        const double width = std::ldexp(1.0, -level);
        if (t >= best_ || excluded(t, u, v, width)) return best_;
        if (level == depth_) return best_ = t;
        const double half = width / 2;
        for (int i = 0; i < 8; ++i) search(t + (i >> 2) * half, u + (i >> 1 & 1) * half, v + (i & 1) * half, level + 1);
        return best_;
    }

    motion_kind kind_;
    motion<double> m_;
    int depth_;
    double best_ = 2;
};

}  // namespace

TEST_CASE("motion oracle: no contact where boxes show that there is none") {
    const std::uint64_t n = sample_count() / 10 + 1;
    std::uint64_t hits = 0, misses = 0, early = 0, open = 0;
    std::string last_open;
    for (const motion_kind kind : both_kinds) {
        for (const motion_family f : {motion_family::lattice_2, motion_family::lattice_4, motion_family::lattice_16}) {
            for (std::uint64_t i = 0; i < n; ++i) {
                motion<double> m = make_motion<double>(sample_seed + 1, kind, f, i);
                if (i % 4 == 0) {  // always in one plane, which may move
                    for (int v = 0; v < 4; ++v) {
                        m.t0[v].z = m.t0[v].x + m.t0[0].z - m.t0[0].x;
                        m.t1[v].z = m.t1[v].x + m.t1[0].z - m.t1[0].x;
                    }
                }
                const motion_answer a = oracle::first_contact(kind, m);
                // A contact is never before what the boxes leave; and as these get smaller they leave little more.
                const double time = a.hit ? a.time : 2;
                bool closed = false;
                for (int depth = 6; depth <= 13 && !closed; ++depth) {
                    const double bound = box_cutter(kind, m, depth).first_time();
                    if (time < bound) ++early;
                    closed = time - bound < 0x1p-5;
                }
                if (!closed) {
                    ++open;
                    last_open = std::string(name_of(kind)) + ", " + name_of(f) + ", number " + std::to_string(i);
                }
                ++(a.hit ? hits : misses);
            }
        }
    }
    CHECK(early == 0);
    CAPTURE(last_open);
    CHECK(open * 5000 <= hits + misses);  // near misses: one in 60,000, by 1e-4 of 16
    CHECK(hits > n);
    CHECK(misses > n);
}

namespace {

/// All points of both times moved, where that is exact.
template <scalar T>
std::optional<motion<T>> moved_by(const motion<T>& m, const vec3<T>& by_t0, const vec3<T>& by_t1) {
    motion<T> r = m;
    constexpr T vec3<T>::*axes[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    for (std::size_t i = 0; i < 8; ++i) {
        for (T vec3<T>::*const axis : axes) {
            const T by = (i < 4 ? by_t0 : by_t1).*axis, from = (i < 4 ? m.t0[i] : m.t1[i - 4]).*axis;
            const volatile T sum = from + by;
            const std::vector<integer> x = to_integers<T>({from, by, sum});
            if (x[0] + x[1] != x[2]) return {};
            (i < 4 ? r.t0[i] : r.t1[i - 4]).*axis = sum;
        }
    }
    return r;
}

/// Times a power of two, where that is exact.
template <scalar T>
std::optional<motion<T>> scaled_by(const motion<T>& m, int exponent) {
    motion<T> r = m;
    constexpr T vec3<T>::*axes[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    for (std::size_t i = 0; i < 8; ++i) {
        for (T vec3<T>::*const axis : axes) {
            T& x = (i < 4 ? r.t0[i] : r.t1[i - 4]).*axis;
            const T from = x;
            x = std::ldexp(from, exponent);
            if (!std::isfinite(x) || std::ldexp(x, -exponent) != from) return {};
        }
    }
    return r;
}

}  // namespace

TEMPLATE_TEST_CASE("motion oracle: symmetries", "", float, double) {
    const std::uint64_t n = sample_count() / 500 + 1;
    std::uint64_t translated = 0, scaled = 0, wrong = 0, hits = 0, pairs = 0;
    std::string last_wrong;
    const auto expect = [&](bool right, const char* what, motion_kind kind, motion_family f, std::uint64_t i) {
        if (right) return;
        ++wrong;
        last_wrong = std::string(what) + ": " + name_of(kind) + ", " + name_of(f) + ", number " + std::to_string(i);
    };
    for (const motion_kind kind : both_kinds) {
        for (int k = 0; k < motion_family_count; ++k) {
            const auto f = static_cast<motion_family>(k);
            for (std::uint64_t i = 0; i < count_of<TestType>(f, n); ++i) {
                const motion<TestType> m = make_motion<TestType>(sample_seed + 2, kind, f, i);
                const motion_answer a = oracle::first_contact(kind, m);
                ++pairs;
                if (a.hit) ++hits;
                draws d(sample_seed, 77, i);
                for (int order = 0; order < 3; ++order) {
                    const motion_answer b = oracle::first_contact(kind, construction::motions::shuffled(d, kind, m));
                    expect(a == b, "another order", kind, f, i);
                    if (a.hit && b.hit) {
                        algebraic_number t = *a.exact, u = *b.exact;
                        expect(t.compared_to(u) == 0, "another order, exactly", kind, f, i);
                    }
                }
                motion<TestType> back = m;
                for (int v = 0; v < 4; ++v) construction::motions::exchange(back.t0[v], back.t1[v]);
                const motion_answer c = oracle::first_contact(kind, back);
                expect(a.hit == c.hit && (!a.hit || a.time + c.time <= 1 + 0x1p-52), "backwards", kind, f, i);
                if (const auto larger = scaled_by(m, d.below(41) - 20)) {
                    ++scaled;
                    expect(a == oracle::first_contact(kind, *larger), "scaled", kind, f, i);
                }
                vec3<TestType> by[2];
                for (vec3<TestType>& v : by) {
                    const int x = d.below(65) - 32, y = d.below(65) - 32, z = d.below(65) - 32;
                    v = {static_cast<TestType>(x), static_cast<TestType>(y), static_cast<TestType>(z)};
                }
                if (const auto there = moved_by(m, by[0], by[1])) {
                    ++translated;
                    expect(a == oracle::first_contact(kind, *there), "translated", kind, f, i);
                }
            }
        }
    }
    CAPTURE(last_wrong);
    CHECK(wrong == 0);
    CHECK(translated * 3 > pairs);
    CHECK(scaled * 3 > pairs * 2);
    CHECK(hits * 3 > pairs);
    CHECK((pairs - hits) * 10 > pairs);
}

TEMPLATE_TEST_CASE("motion families: contacts and none in each", "", float, double) {
    const std::uint64_t n = sample_count() / 50;
    for (const motion_kind kind : both_kinds) {
        for (int k = 0; k < motion_family_count; ++k) {
            const auto f = static_cast<motion_family>(k);
            const std::uint64_t count = count_of<TestType>(f, n);
            std::uint64_t hits = 0;
            for (std::uint64_t i = 0; i < count; ++i) {
                const motion<TestType> m = make_motion<TestType>(sample_seed, kind, f, i);
                if (oracle::first_contact(kind, m).hit) ++hits;
            }
            CAPTURE(name_of(kind), name_of(f), hits, count);
            if (always_hits(f)) CHECK(hits == count);
            if (count < 100) continue;
            CHECK(hits * 50 > count);
            if (!always_hits(f) && f != motion_family::crossing) CHECK(hits * 100 < count * 98);
        }
    }
}

}  // namespace abut::test
