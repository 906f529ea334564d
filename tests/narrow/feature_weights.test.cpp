// SPDX-License-Identifier: MIT
//
// Where features in motion touch: the two points that the weights name come together at the time of impact.

#include <cmath>
#include <cstdint>
#include <random>

#include <abut/narrow/feature_weights.hpp>
#include <abut/narrow/time_of_impact.hpp>

#include <support/catch.hpp>

namespace {

using abut::motion;
using abut::segment;
using abut::triangle;
using abut::vec3;
using point = vec3<double>;

point at(const point& a, const point& b, double t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}
double apart(const point& a, const point& b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

struct dice {
    std::mt19937_64 random;
    double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
    point place() { return {number(), number(), number()}; }
};

void check_sums(const abut::feature_weights& w, bool edges) {
    for (const double x : w.of) CHECK(x >= 0);
    if (edges) {
        CHECK(std::abs(w.of[0] + w.of[1] - 1) < 1e-12);
        CHECK(std::abs(w.of[2] + w.of[3] - 1) < 1e-12);
    } else {
        CHECK(w.of[0] == 1);
        CHECK(std::abs(w.of[1] + w.of[2] + w.of[3] - 1) < 1e-12);
    }
}

}  // namespace

TEST_CASE("weights: vertex and face come together", "[narrow]") {
    dice d{std::mt19937_64(7)};
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const motion<point> p{d.place(), d.place()};
        const motion<triangle<double>> f{{d.place(), d.place(), d.place()}, {d.place(), d.place(), d.place()}};
        const double t = abut::time_of_impact(p, f);
        if (t < 0) continue;
        ++hits;
        const auto w = abut::weights_at(p, f, t);
        check_sums(w, false);
        const point a = at(f.t0.a, f.t1.a, t), b = at(f.t0.b, f.t1.b, t), c = at(f.t0.c, f.t1.c, t);
        const point q{w.of[1] * a.x + w.of[2] * b.x + w.of[3] * c.x, w.of[1] * a.y + w.of[2] * b.y + w.of[3] * c.y,
                      w.of[1] * a.z + w.of[2] * b.z + w.of[3] * c.z};
        CHECK(apart(q, at(p.t0, p.t1, t)) < 1e-10);
    }
    CHECK(hits > 500);
}

TEST_CASE("weights: two edges come together", "[narrow]") {
    dice d{std::mt19937_64(8)};
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const motion<segment<double>> s{{d.place(), d.place()}, {d.place(), d.place()}};
        const motion<segment<double>> u{{d.place(), d.place()}, {d.place(), d.place()}};
        const double t = abut::time_of_impact(s, u);
        if (t < 0) continue;
        ++hits;
        const auto w = abut::weights_at(s, u, t);
        check_sums(w, true);
        const point first = at(at(s.t0.a, s.t1.a, t), at(s.t0.b, s.t1.b, t), w.of[1]);
        const point second = at(at(u.t0.a, u.t1.a, t), at(u.t0.b, u.t1.b, t), w.of[3]);
        CHECK(apart(first, second) < 1e-8);
    }
    CHECK(hits > 500);
}

TEST_CASE("weights: features without an extent, and touches at corners", "[narrow]") {
    const point o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
    const auto falls = [&](const point& to) { return motion<point>{{to.x, to.y, 1}, {to.x, to.y, -1}}; };
    const auto rests = [](const point& a, const point& b, const point& c) {
        return motion<triangle<double>>{{a, b, c}, {a, b, c}};
    };
    const auto in = [&](const motion<point>& p, const motion<triangle<double>>& f) {
        const double t = abut::time_of_impact(p, f);
        REQUIRE(t == 0.5);
        return abut::weights_at(p, f, t);
    };
    CHECK(in(falls({0.25, 0.25, 0}), rests(o, x, y)).of[1] == 0.5);
    CHECK(in(falls(x), rests(o, x, y)).of[2] == 1);
    CHECK(in(falls({0.5, 0.5, 0}), rests(o, x, y)).of[3] == 0.5);
    CHECK(in(falls({0.25, 0, 0}), rests(o, x, o)).of[2] == 0.25);  // a segment
    CHECK(in(falls(o), rests(o, o, o)).of[1] == 1);                // a point
    const motion<segment<double>> still{{o, o}, {o, o}};
    const motion<segment<double>> falling{{{-1, 0, 1}, {3, 0, 1}}, {{-1, 0, -1}, {3, 0, -1}}};
    const auto w = abut::weights_at(still, falling, abut::time_of_impact(still, falling));
    CHECK(w.of[0] == 1);
    CHECK(w.of[3] == 0.25);
    const auto turned = abut::weights_at(falling, still, abut::time_of_impact(falling, still));
    CHECK(turned.of[1] == 0.25);
    CHECK(turned.of[2] == 1);
}
