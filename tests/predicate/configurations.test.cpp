// SPDX-License-Identifier: MIT
#include <abut/predicate/triangle_triangle.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <abut/predicate/intersects.hpp>

#include "predicate/common_part.hpp"
#include "predicate/configuration_pairs.hpp"
#include "predicate/configurations.hpp"
#include "predicate/configurations_picture.hpp"
#include "support/catch.hpp"
#include "support/hulls.hpp"
#include "support/triangle_families.hpp"

// The configurations by every arithmetic, in every order and in other positions; whether none is missing; and their picture.

namespace {

using namespace abut;
using test::all_pairs;
using test::common;
using test::integer_triangle;
using test::mapped;
using test::named_pair;

template <scalar T>
triangle<T> to(const integer_triangle& t) {
    const auto point = [](const vec3<int>& p) {
        return vec3<T>{static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)};
    };
    return {point(t.a), point(t.b), point(t.c)};
}

/// Affine maps with small integers. They keep what touches what, and leave next to nothing along the axes.
struct affine_map {
    int m[3][3];
    vec3<int> move;

    vec3<int> operator()(const vec3<int>& p) const {
        const auto row = [&](int i) { return m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z; };
        return vec3<int>{row(0), row(1), row(2)} + move;
    }
    [[nodiscard]] int determinant() const {
        const auto row = [&](int i) { return vec3<int>{m[i][0], m[i][1], m[i][2]}; };
        return dot(row(0), cross(row(1), row(2)));
    }
};

constexpr affine_map maps[] = {
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}},      // where they are
    {{{1, 1, 0}, {0, 1, 1}, {0, 0, 1}}, {5, -7, 3}},     // shears
    {{{1, 0, -1}, {2, 1, 0}, {0, 1, 1}}, {-9, 2, 11}},   // tilts all planes
    {{{2, 1, 1}, {-1, 2, 1}, {1, -1, 2}}, {-8, 6, 1}},   // turns and shears
    {{{0, 1, -2}, {1, 0, 1}, {-1, 2, 1}}, {13, -4, -6}}  // mirrors as well
};

using signs = std::array<int, 3>;

/// On which side of the plane of t the corners of s lie
signs signs_of(const integer_triangle& s, const integer_triangle& t) {
    const vec3<int> normal = cross(t.b - t.a, t.c - t.a);
    const auto side = [&](const vec3<int>& p) {
        const int d = dot(normal, p - t.a);
        return (d > 0) - (d < 0);
    };
    return {side(s.a), side(s.b), side(s.c)};
}

bool is_flat(const signs& s) { return s == signs{0, 0, 0}; }

integer_triangle in_order(const integer_triangle& t, int order) {
    const vec3<int> v[3] = {t.a, t.b, t.c};
    const int i = order % 3, j = (i + (order < 3 ? 1 : 2)) % 3;
    return {v[i], v[j], v[3 - i - j]};
}

// --- parts of the line in which the planes cross ------------------------------------------------------------------------

/// By what a triangle meets the plane: nothing; a corner; an edge; a segment that ends inside two edges; or in a corner and
/// inside an edge.
enum class meets { nothing, corner, edge, cut, corner_and_cut };

meets kind_of(const signs& s) {
    const auto on = std::count(s.begin(), s.end(), 0);
    const bool above = std::count(s.begin(), s.end(), 1) > 0, below = std::count(s.begin(), s.end(), -1) > 0;
    if (on == 2) return meets::edge;
    if (above && below) return on == 1 ? meets::corner_and_cut : meets::cut;
    return on == 1 ? meets::corner : meets::nothing;
}

struct line_part {
    meets kind;
    test::rational low, high;
    int corner_end;  // of corner_and_cut: -1 if the corner is the low end, 1 if it is the high one; else 0
};

/// How two parts lie, whichever way the line runs: kinds, comparisons of their ends, and which ends are corners
std::array<int, 8> arrangement(const line_part& a, const line_part& b) {
    const auto compared = [](const test::rational& x, const test::rational& y) { return (x > y) - (x < y); };
    const auto key = [&](const line_part& p, const line_part& q) {
        return std::array<int, 8>{
            static_cast<int>(p.kind), static_cast<int>(q.kind), compared(p.low, q.low), compared(p.low, q.high),
            compared(p.high, q.low),  compared(p.high, q.high), p.corner_end,           q.corner_end};
    };
    const auto turned = [](const line_part& p) { return line_part{p.kind, -p.high, -p.low, -p.corner_end}; };
    return std::min(key(a, b), key(turned(a), turned(b)));
}

line_part part_of(const integer_triangle& s, const integer_triangle& t, const vec3<int>& along) {
    const test::rational_point direction{along.x, along.y, along.z};
    const test::hull part = test::clipped_to_plane(test::hull_of(s), test::hull_of(t));
    const test::rational p = dot(direction, part.front()), q = dot(direction, part.back());
    const signs at = signs_of(s, t);
    line_part found{kind_of(at), std::min(p, q), std::max(p, q), 0};
    if (found.kind == meets::corner_and_cut) {
        const vec3<int> corner = at[0] == 0 ? s.a : at[1] == 0 ? s.b : s.c;
        found.corner_end = dot(along, corner) == found.low ? -1 : 1;
    }
    return found;
}

/// All parts of a line of one kind with ends in 0 to 3, which is enough for every order of the ends of two
std::vector<line_part> parts_of_kind(meets kind) {
    std::vector<line_part> parts;
    for (int low = 0; low < 4; ++low) {
        if (kind == meets::corner) parts.push_back({kind, low, low, 0});
        for (int high = low + 1; kind != meets::corner && high < 4; ++high) {
            if (kind != meets::corner_and_cut) parts.push_back({kind, low, high, 0});
            if (kind == meets::corner_and_cut) parts.insert(parts.end(), {{kind, low, high, -1}, {kind, low, high, 1}});
        }
    }
    return parts;
}

template <class Values>
std::size_t missing(const Values& expected, const Values& found) {
    std::vector<typename Values::value_type> rest;
    std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(), std::back_inserter(rest));
    return rest.size();
}

}  // namespace

TEST_CASE("configurations: what two triangles have in common is what is written down") {
    std::set<std::string> names;
    for (const auto& group : test::configuration_groups) {
        for (const auto& c : group.members) {
            INFO(group.title << " / " << c.name);
            const test::hull s = test::hull_of(c.reference), t = test::hull_of(c.other);
            CHECK(test::kind_of(test::common_part(s, t)) == c.part);
            CHECK(test::kind_of(test::common_part(t, s)) == c.part);
            CHECK(names.insert(group.title + c.name).second);
            // The title says how many corners lie where, of the reference first.
            const std::string placed = test::placement(c.reference, c.other), others = test::placement(c.other, c.reference);
            std::string in_title;
            for (const char* const p : {"+++", "++0", "+00", "++-", "+0-", "000"}) {
                if (group.title.find(std::string("(") + p + ")") != std::string::npos) in_title += p;
            }
            const bool both = group.title.rfind("Both", 0) == 0, reference = group.title.rfind("Reference", 0) == 0;
            if (both) CHECK((placed == in_title && others == in_title));
            if (reference)
                CHECK((placed == in_title.substr(0, 3) ||
                       placed == in_title.substr(std::min<std::size_t>(3, in_title.size()))));
            if (!both && !reference && !in_title.empty()) CHECK(others == in_title);
        }
    }
}

TEMPLATE_TEST_CASE("configurations: every arithmetic, in all 72 orders, moved and sheared", "", float, double) {
    using T = TestType;
    const std::vector<named_pair> pairs = all_pairs();
    std::uint64_t asked = 0, hits = 0;
    for (const affine_map& map : maps) {
        CHECK(map.determinant() != 0);
        for (const named_pair& pair : pairs) {
            INFO(pair.name << ", map " << &map - maps);
            const integer_triangle a = mapped(pair.a, map), b = mapped(pair.b, map);
            // `fast` rounds nothing where determinants of three differences stay below 2^24.
            for (const vec3<int>& p : {a.a, a.b, a.c, b.a, b.b, b.c}) {
                const vec3<int> d = p - a.a;
                REQUIRE((std::abs(d.x) <= 64 && std::abs(d.y) <= 64 && std::abs(d.z) <= 64));
            }
            CHECK(test::oracle::intersects(to<T>(a), to<T>(b)) == pair.hit);
            CHECK(resolve(to<T>(a), to<T>(b)) == pair.hit);
            int wrong = 0;
            for (int k = 0; k < 36; ++k) {
                const triangle<T> s = test::reordered(to<T>(a), k % 6), t = test::reordered(to<T>(b), k / 6);
                wrong += intersects<fast>(s, t) != pair.hit || intersects<fast>(t, s) != pair.hit;
                wrong += intersects<filtered>(s, t) != pair.hit || intersects<filtered>(t, s) != pair.hit;
                wrong += intersects<exact>(s, t) != pair.hit || intersects<exact>(t, s) != pair.hit;
            }
            CHECK(wrong == 0);
            asked += 72;
            hits += pair.hit ? 72 : 0;
        }
    }
    std::printf("configurations, %s: %zu pairs, asked %llu times with each arithmetic, hits %.1f %%\n",
                sizeof(T) == 4 ? "float" : "double", pairs.size(), static_cast<unsigned long long>(asked),
                100.0 * static_cast<double>(hits) / static_cast<double>(asked));
}

TEST_CASE("configurations: every pattern of the corners' sides is there") {
    // The three sides of either triangle's corners. That one lies in the other's plane is mutual; all else exists.
    using pattern = std::array<signs, 2>;
    std::set<pattern> expected, found;
    for (int i = 0; i < 729; ++i) {
        const signs s{i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1}, t{i / 27 % 3 - 1, i / 81 % 3 - 1, i / 243 - 1};
        if (is_flat(s) == is_flat(t)) expected.insert({s, t});
    }
    CHECK(expected.size() == 26 * 26 + 1);
    for (const named_pair& pair : all_pairs()) {
        if (test::hull_of(pair.a).size() < 3 || test::hull_of(pair.b).size() < 3) continue;
        for (int k = 0; k < 36; ++k) {
            const integer_triangle s = in_order(pair.a, k % 6), t = in_order(pair.b, k / 6);
            found.insert({signs_of(s, t), signs_of(t, s)});
            found.insert({signs_of(t, s), signs_of(s, t)});
        }
    }
    std::printf("configurations: %zu of %zu patterns of sides\n", found.size(), expected.size());
    CHECK(missing(expected, found) == 0);
    CHECK(missing(found, expected) == 0);
}

TEST_CASE("configurations: every arrangement on the line in which the planes cross is there") {
    std::set<std::array<int, 8>> expected, found;
    const meets kinds[] = {meets::corner, meets::edge, meets::cut, meets::corner_and_cut};
    for (const meets k : kinds) {
        for (const meets l : kinds) {
            for (const line_part& a : parts_of_kind(k)) {
                for (const line_part& b : parts_of_kind(l)) expected.insert(arrangement(a, b));
            }
        }
    }
    for (const named_pair& pair : all_pairs()) {
        const signs s = signs_of(pair.a, pair.b), t = signs_of(pair.b, pair.a);
        if (is_flat(s) || is_flat(t) || kind_of(s) == meets::nothing || kind_of(t) == meets::nothing) continue;
        const vec3<int> along =
            cross(cross(pair.a.b - pair.a.a, pair.a.c - pair.a.a), cross(pair.b.b - pair.b.a, pair.b.c - pair.b.a));
        const line_part a = part_of(pair.a, pair.b, along), b = part_of(pair.b, pair.a, along);
        found.insert(arrangement(a, b));
        found.insert(arrangement(b, a));
    }
    std::printf("configurations: %zu of %zu arrangements on the line\n", found.size(), expected.size());
    CHECK(missing(expected, found) == 0);
    CHECK(missing(found, expected) == 0);
}

TEST_CASE("configurations: one plane, segments and points, each with all that they can have in common") {
    // By the number of corners that the hulls have
    std::set<std::array<int, 3>> expected, found;
    const auto add = [&expected](int s, int t, std::initializer_list<common> parts) {
        for (const common part : parts) expected.insert({s, t, static_cast<int>(part)});
    };
    add(3, 3, {common::nothing, common::point, common::segment, common::area});
    add(3, 2, {common::nothing, common::point, common::segment});
    add(2, 2, {common::nothing, common::point, common::segment});
    add(3, 1, {common::nothing, common::point});
    add(2, 1, {common::nothing, common::point});
    add(1, 1, {common::nothing, common::point});
    for (const auto& group : test::configuration_groups) {
        for (const auto& c : group.members) {
            const test::hull s = test::hull_of(c.reference), t = test::hull_of(c.other);
            const bool in_one_plane = t.size() < 3 || is_flat(signs_of(c.reference, c.other));
            if (in_one_plane)
                found.insert({static_cast<int>(s.size()), static_cast<int>(t.size()), static_cast<int>(c.part)});
        }
    }
    CHECK(found == expected);
}

TEST_CASE("configurations: the picture in docs is of these") {
    // It is written among temporary files, or into the folder that ABUT_RESULTS names: with ABUT_RESULTS=docs it is made
    // anew.
    const char* const named = std::getenv("ABUT_RESULTS");
    const std::string name = "triangle-configurations.svg", drawn = test::picture::render(test::configuration_groups);
    const auto written = (named != nullptr ? std::filesystem::path(named) : std::filesystem::temp_directory_path()) / name;
    const auto kept = std::filesystem::path(__FILE__).parent_path() / "../../docs" / name;
    {
        std::ofstream file(written, std::ios::binary);
        file << drawn;
        REQUIRE(file.flush());
    }
    std::ifstream file(kept, std::ios::binary);
    std::stringstream in_docs;
    in_docs << file.rdbuf();
    INFO("compare " << std::filesystem::absolute(written).string() << " with docs/" << name);
    const bool same = in_docs.str() == drawn;
    CHECK(same);
}
