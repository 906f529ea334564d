// SPDX-License-Identifier: MIT
//
// Spheres and capsules as solids. Two of them and one with a tetrahedron: distances are those of the oracle for hulls
// (support/rational.hpp), in integers. With cells of a grid: by the distances of boxes from each cell that is in the solid and
// each that is not.

#include <abut/collide/relation.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

#include <abut/abut.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

namespace abut::test::round_solids {

namespace {

/// A capsule of integers; a sphere if both ends are one.
struct round_of_grid {
    grid_place p, q;
    int r;
    [[nodiscard]] bool is_sphere() const { return p == q; }
    template <scalar T>
    [[nodiscard]] capsule<T> made(const frame_of_grid& f) const {
        return {{f.operator()<T>(p), f.operator()<T>(q)}, static_cast<T>(r * f.unit)};
    }
};
round_of_grid draw_round(draws& d, int size, int most) {
    const auto place = [&] { return grid_place{d.below(size), d.below(size), d.below(size)}; };
    round_of_grid s{place(), place(), 1 + d.below(most)};
    if (d.below(2) == 0) s.q = s.p;
    return s;
}

/// Whether the hull of some points has one within sqrt(squared_radius) of the origin: a triangle of three of them has, or a
/// tetrahedron of four has the origin inside.
bool any_hull_reaches(const std::vector<integer_point>& w, const integer& squared_radius) {
    if (w.size() <= 3) return hull_reaches(w, squared_radius);
    const auto volume = [](const integer_point& p, const integer_point& q, const integer_point& r) -> integer {
        return p.x * (q.y * r.z - q.z * r.y) - p.y * (q.x * r.z - q.z * r.x) + p.z * (q.x * r.y - q.y * r.x);
    };
    const std::size_t n = w.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (std::size_t k = j + 1; k < n; ++k) {
                if (hull_reaches({w[i], w[j], w[k]}, squared_radius)) return true;
                for (std::size_t l = k + 1; l < n; ++l) {
                    const int of[4] = {volume(w[i], w[j], w[k]).sign(), volume(w[i], w[k], w[l]).sign(),
                                       volume(w[i], w[l], w[j]).sign(), volume(w[j], w[l], w[k]).sign()};
                    if (of[0] != 0 && of[0] == of[1] && of[1] == of[2] && of[2] == of[3]) return true;
                }
            }
        }
    }
    return false;
}

/// The distance of two hulls less a length: -1, 0 or 1. Squared distances here are ratios with denominators below 2^40.
int distance_less(const std::vector<grid_place>& a, const std::vector<grid_place>& b, const integer& length) {
    if (length < 0) return 1;
    std::vector<integer_point> w;
    const integer scale = integer(1) << 20;
    for (const grid_place& p : a) {
        for (const grid_place& q : b) w.push_back({scale * (p[0] - q[0]), scale * (p[1] - q[1]), scale * (p[2] - q[2])});
    }
    const integer squared = length * length * scale * scale;
    if (!any_hull_reaches(w, squared)) return 1;
    return any_hull_reaches(w, squared - 1) ? -1 : 0;
}

solid_relation relation_by(bool both, bool a_alone, bool b_alone, bool touch) {
    if (!both) return touch ? solid_relation::externally_connected : solid_relation::disconnected;
    if (a_alone && b_alone) return solid_relation::partially_overlapping;
    if (b_alone) return touch ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (a_alone) return touch ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    return solid_relation::equal;
}

solid_relation truth_of(const round_of_grid& a, const round_of_grid& b) {
    const int apart = distance_less({a.p, a.q}, {b.p, b.q}, a.r + b.r);
    if (apart >= 0) return relation_by(false, true, true, apart == 0);
    const auto out = [](const round_of_grid& x, const round_of_grid& y) {
        return std::max(distance_less({x.p}, {y.p, y.q}, y.r - x.r), distance_less({x.q}, {y.p, y.q}, y.r - x.r));
    };
    const int first = out(a, b), second = out(b, a);
    return relation_by(true, first > 0, second > 0, first == 0 || second == 0);
}

solid_relation truth_of(const round_of_grid& s, const tetrahedron_of_grid& t) {
    const int from_solid = distance_less({s.p, s.q}, {t.begin(), t.end()}, s.r);
    int nearest = 1, farthest = -1;
    for (std::size_t i = 0; i < 4; ++i) {
        nearest = std::min(nearest, distance_less({s.p, s.q}, {t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]}, s.r));
        farthest = std::max(farthest, distance_less({s.p, s.q}, {t[i]}, s.r));
    }
    if (from_solid >= 0) return relation_by(false, true, true, from_solid == 0);
    if (nearest >= 0) return relation_by(true, false, true, nearest == 0);
    return relation_by(true, true, farthest > 0, farthest == 0);
}

/// Of cells with sides of 2, and a sphere, or a capsule along an axis: squared distances of boxes.
solid_relation truth_of(const round_of_grid& s, const cells& of) {
    const std::set<grid_place> units = of.units();
    bool both = false, alone = false, touch = false, other_alone = false;
    const auto squared = [&](const grid_place& low, const grid_place& high) {
        int sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const int l = std::min(s.p[k], s.q[k]), u = std::max(s.p[k], s.q[k]), gap = std::max({0, low[k] - u, l - high[k]});
            sum += gap * gap;
        }
        return sum;
    };
    const int most = s.r * s.r;
    bool meets_outside = false, vertex_on = false;
    for (int x = -16; x < 20; ++x) {
        for (int y = -16; y < 20; ++y) {
            for (int z = -16; z < 20; ++z) {
                const grid_place at{x, y, z};
                const int away = squared(at, {x + 1, y + 1, z + 1});
                const bool is_in = units.contains(at);
                (is_in ? both : alone) |= away < most;
                (is_in ? touch : meets_outside) |= away == most;
                if (!is_in) continue;
                for (int k = 0; k < 8; ++k) {
                    const grid_place corner{x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)};
                    other_alone |= squared(corner, corner) > most;
                    vertex_on |= squared(corner, corner) == most;
                }
            }
        }
    }
    if (!both) return relation_by(false, true, true, touch);
    return relation_by(true, alone, other_alone, alone ? vertex_on : meets_outside);
}

solid_relation inverse(solid_relation r) {
    switch (r) {
        case solid_relation::tangential_part: return solid_relation::tangential_part_inverse;
        case solid_relation::nontangential_part: return solid_relation::nontangential_part_inverse;
        case solid_relation::tangential_part_inverse: return solid_relation::tangential_part;
        case solid_relation::nontangential_part_inverse: return solid_relation::nontangential_part;
        default: return r;
    }
}

struct tally_of_round {
    std::uint64_t wrong = 0, of[8] = {};
    template <class X, class Y>
    void ask(const X& x, const Y& y, solid_relation truth, bool known = true) {
        const serial on;
        ++of[static_cast<int>(truth)];
        const solid_relation said = relation(on, x, y, {.known_solid = known});
        if (said != truth && wrong++ < 3) std::printf("said %s, is %s\n", name_of(said), name_of(truth));
        wrong += relation<exact>(on, y, x, {.known_solid = true}) != inverse(truth);
        wrong += overlaps(on, x, y, {.known_solid = true}) != (truth > solid_relation::externally_connected);
    }
    template <scalar T, class Y>
    void ask_either(const round_of_grid& s, const frame_of_grid& f, const Y& y, solid_relation truth, bool known = true) {
        const capsule<T> made = s.made<T>(f);
        ask(made, y, truth, known);
        if (s.is_sphere()) ask(sphere<T>{made.axis.a, made.radius}, y, truth, known);
    }
    void check_all(bool can_be_equal) const {
        CHECK(wrong == 0);
        CAPTURE(of[0], of[1], of[2], of[3], of[4], of[5], of[6], of[7]);
        for (int i = 0; i < 8; ++i) {
            CHECK((of[i] > 0 || (i == 3 && !can_be_equal)));
        }
    }
};

frame_of_grid draw_unit(draws& d) {
    frame_of_grid f;
    f.unit = d.below(3) == 0 ? 0x1p-20 : d.below(2) == 0 ? 0x1p30 : 1;
    return f;
}

}  // namespace

TEMPLATE_TEST_CASE("relation: spheres and capsules with each other", "", float, double) {
    tally_of_round spheres, all;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 2, 100000);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270515, 1, k);
        const frame_of_grid f = draw_unit(d);
        round_of_grid a = draw_round(d, 5, 6), b = draw_round(d, 5, 6);
        if (k % 16 == 0) b = {a.q, a.p, a.r};
        if (k % 4 == 1) {  // beside each other, or one in the other, just so
            const auto axis = static_cast<std::size_t>(d.below(3));
            const int way = d.below(9) - 4, sum = std::abs(way) - a.r, more = std::abs(way) + a.r;
            b = a;
            b.p[axis] += way;
            b.q[axis] += way;
            b.r = sum > 0 ? sum : d.below(2) == 0 ? more : std::max(1, a.r - std::abs(way));
        }
        if (k % 3 == 0) a.q = a.p, b.q = b.p;
        const capsule<TestType> y = b.made<TestType>(f);
        (a.is_sphere() && b.is_sphere() ? spheres : all).ask_either<TestType>(a, f, y, truth_of(a, b));
        if (b.is_sphere()) spheres.ask_either<TestType>(a, f, sphere<TestType>{y.axis.a, y.radius}, truth_of(a, b));
    }
    spheres.check_all(true);
    all.check_all(true);
}

TEMPLATE_TEST_CASE("relation: spheres and capsules with tetrahedra", "", float, double) {
    tally_of_round all;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 8, 20000);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270515, 2, k);
        const frame_of_grid f = draw_unit(d);
        const tetrahedron_of_grid t = draw_tetrahedron(d, k % 4 == 0 ? 12 : 5);
        const round_of_grid s = draw_round(d, k % 4 == 0 ? 12 : 5, k % 4 == 0 ? 2 : 6);
        all.ask_either<TestType>(s, f, surface_of<TestType>(t, f), truth_of(s, t), k % 4 != 0);
    }
    CHECK(all.wrong == 0);
    for (const int i : {0, 1, 2, 6, 7}) CHECK(all.of[i] > 0);
}

TEMPLATE_TEST_CASE("relation: spheres and capsules with cells of a grid", "", float, double) {
    tally_of_round all;
    for (std::uint64_t k = 0; k < 250; ++k) {
        draws d(20270515, 3, k);
        const frame_of_grid f = draw_unit(d);
        cells c = draw_two_sets(d, k % 8 == 7 || k % 8 == 5 ? k : k % 3).first;
        c.side = 2;
        round_of_grid s = draw_round(d, 9, k % 5 == 0 ? 9 : 3);
        if (k % 5 == 1) {
            c = {};
            c.in.insert({0, 0, 0});
            c.side = 2;
            s = {{d.below(3), d.below(3), d.below(3)}, {0, 0, 0}, 3};
            s.q = s.p;
        }
        const int axis = d.below(3);
        for (int i = 0; i < 3; ++i) {
            if (i != axis) s.q[static_cast<std::size_t>(i)] = s.p[static_cast<std::size_t>(i)];
        }
        all.ask_either<TestType>(s, f, make_bvh(serial{}, surface_of<TestType>(c, f, d)), truth_of(s, c), k % 4 != 0);
    }
    all.check_all(false);
}

TEST_CASE("relation: a round solid that is none, one in a room, and one under a pose") {
    const serial on;
    const sphere<float> ball{{2, 2, 2}, 1};
    CHECK_THROWS_AS(relation(on, sphere<float>{{0, 0, 0}, 0}, ball), invalid_geometry);
    CHECK_THROWS_AS(relation(on, ball, capsule<float>{{{0, 0, 0}, {1, 0, 0}}, -1}), invalid_geometry);
    const aabb<float> room{{0, 0, 0}, {4, 3, 3}};
    CHECK(relation(on, ball, room) == solid_relation::tangential_part);
    CHECK(relation(on, room, ball) == solid_relation::tangential_part_inverse);
    CHECK(relation(on, posed(ball, rigid<float>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {3, 0, 0}}), room) == solid_relation::externally_connected);
    CHECK(relation(openmp{}, posed(ball, rigid<float>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -0.5f, -0.5f}}), room) == solid_relation::nontangential_part);
    CHECK(relation(on, mesh<float>(), ball) == solid_relation::disconnected);
    const mesh<float> open({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
    CHECK_THROWS_AS(relation(on, open, ball), invalid_geometry);
}

}  // namespace abut::test::round_solids
