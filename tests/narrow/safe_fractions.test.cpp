// SPDX-License-Identifier: MIT
//
// How far the points of two features may go alone. Coordinates and fractions are multiples of powers of two, so that the
// places that are reached are exact, and exact decisions say that nothing meets there or on the way.

#include <abut/abut.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <abut/narrow/safe_fractions.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

using safe_points = detail::moving_points<double>;

motion<vec3<double>> safe_vertex(const safe_points& p) { return {p.t0[0], p.t1[0]}; }
motion<triangle<double>> safe_face(const safe_points& p) {
    return {{p.t0[1], p.t0[2], p.t0[3]}, {p.t1[1], p.t1[2], p.t1[3]}};
}
motion<segment<double>> safe_edge(const safe_points& p, int i) { return {{p.t0[i], p.t0[i + 1]}, {p.t1[i], p.t1[i + 1]}}; }

template <bool Edges>
double impact_of(const safe_points& p) {
    if constexpr (Edges) {
        return time_of_impact(safe_edge(p, 0), safe_edge(p, 2));
    } else {
        return time_of_impact(safe_vertex(p), safe_face(p));
    }
}
template <bool Edges>
bool ends_within(const safe_points& p, double separation) {
    if constexpr (Edges) {
        return within(safe_edge(p, 0).t1, safe_edge(p, 2).t1, separation);
    } else {
        return within(safe_vertex(p).t1, safe_face(p).t1, separation);
    }
}

/// Of a family, with coordinates that are multiples of 2^-20 and below 2.
safe_points drawn_points(draws& d, int family) {
    const auto on_grid = [](double x) { return std::floor(x * 0x1p20) * 0x1p-20; };
    safe_points p;
    for (int i = 0; i < 4; ++i) {
        for (vec3<double>* all : {p.t0, p.t1}) {
            for (double vec3<double>::*x : {&vec3<double>::x, &vec3<double>::y, &vec3<double>::z}) {
                all[i].*x = on_grid(d.uniform(-1, 1) * (family == 1 && all == p.t0 ? 0x1p-16 : 1));
            }
        }
        if (family == 2) p.t0[i].z *= 0x1p-8, p.t0[i].z = on_grid(p.t0[i].z);          // flat at the start
        if (family == 3 && i > 0) p.t0[i].y = p.t0[i].z = on_grid(0.001 * p.t0[i].y);  // needles along x
        if (family == 4 && i % 2 == 0) p.t1[i] = p.t0[i];                              // some rest
    }
    if (family == 5) p.t0[3] = p.t0[2];  // no area, or no length
    if (family == 6) p.t0[0] = p.t0[3];  // begins in contact
    return p;
}
/// Where points end that go parts of their ways, multiples of 2^-20, and at most these fractions.
safe_points shortened(const safe_points& p, const double (&fraction)[4]) {
    safe_points r = p;
    for (int i = 0; i < 4; ++i) {
        const double f = std::floor(fraction[i] * 0x1p20) * 0x1p-20;
        r.t1[i] = p.t0[i] + f * (p.t1[i] - p.t0[i]);
    }
    return r;
}

struct fractions_seen {
    std::size_t limited = 0, met_by_more = 0, met = 0, near = 0, below_spheres = 0, of_apart = 0, refused = 0;
};

template <bool Edges>
void check_fractions(std::uint64_t i, fractions_seen& seen) {
    draws d(sample_seed, Edges ? 11 : 10, i);
    const int family = static_cast<int>(i % 7);
    const safe_points p = drawn_points(d, family);
    const bool touches = impact_of<Edges>({{p.t0[0], p.t0[1], p.t0[2], p.t0[3]}, {p.t0[0], p.t0[1], p.t0[2], p.t0[3]}}) >= 0;
    const double separation = d.below(2) == 0 ? 0 : 0x1p-5 * d.uniform(0, 1);
    const auto found = detail::parting_plane<Edges, double>(p).fractions(separation);
    CAPTURE(i, Edges, family, separation, found.of[0], found.of[1], found.of[2], found.of[3]);
    bool all_moving_stay = true, in_range = true;
    for (int k = 0; k < 4; ++k) {
        in_range &= found.of[k] >= 0 && found.of[k] <= 1 && (!(p.t0[k] == p.t1[k]) || found.of[k] == 1);
        all_moving_stay &= found.of[k] == 0 || p.t0[k] == p.t1[k];
    }
    if (!in_range) FAIL_CHECK("a fraction that is none");
    if (touches && !all_moving_stay) FAIL_CHECK("what begins in contact moves");
    if (touches) return;
    ++seen.of_apart;
    seen.refused += all_moving_stay;
    seen.limited += found.smallest() < 1;
    if (all_moving_stay) return;
    for (int tries = 0; tries < 4; ++tries) {
        double part[4], more[4];
        for (int k = 0; k < 4; ++k) {
            part[k] = found.of[k] * (d.below(2) == 0 ? 1 : d.uniform(0, 1));
            more[k] = std::min(1.0, 4 * part[k]);
        }
        const safe_points goes = shortened(p, part);
        seen.met += impact_of<Edges>(goes) >= 0;
        seen.near += ends_within<Edges>(goes, separation);
        seen.met_by_more += impact_of<Edges>(shortened(p, more)) >= 0;
    }
    if (separation > 0) return;
    // The bound of spheres, of half the distance at the start, to some digits.
    double apart = 0;
    if constexpr (Edges) {
        apart = distance(safe_edge(p, 0).t0, safe_edge(p, 2).t0).distance;
    } else {
        apart = distance(safe_vertex(p).t0, safe_face(p).t0).distance;
    }
    for (int k = 0; k < 4; ++k) {
        const vec3<double> way = p.t1[k] - p.t0[k];
        seen.below_spheres += found.of[k] < std::min(1.0, (1 - 0x1p-20) * 0.5 * apart / std::sqrt(dot(way, way)));
    }
}

}  // namespace

TEST_CASE("safe fractions: whatever part each point takes, the features stay apart") {
    fractions_seen seen;
    for (std::uint64_t i = 0; i < sample_count(); ++i) {
        check_fractions<false>(i, seen);
        check_fractions<true>(i, seen);
    }
    CHECK(seen.met == 0);
    CHECK(seen.near == 0);
    CHECK(seen.below_spheres == 0);
    CHECK(seen.of_apart > sample_count());
    CHECK(seen.limited > sample_count());
    CHECK(seen.refused < seen.of_apart / 4);  // those that begin nearer than the separation
    CHECK(seen.met_by_more > sample_count() / 20);
}

TEST_CASE("safe fractions: a side that rests leaves the gap to the other") {
    const safe_points falls{{{0, 0, 1}, {-9, -9, 0}, {9, -9, 0}, {0, 9, 0}},
                            {{0, 0, -3}, {-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}};
    const auto at = detail::parting_plane<false, double>(falls).fractions(0);
    CHECK((at.of[0] > 0.2497 && at.of[0] < 0.25 && at.of[1] == 1 && at.of[2] == 1 && at.of[3] == 1));
    const auto kept = detail::parting_plane<false, double>(falls).fractions(0.5);
    CHECK((kept.of[0] > 0.1248 && kept.of[0] < 0.125));
    CHECK(detail::parting_plane<false, double>(falls).fractions(1).of[0] == 0);  // no farther apart than that
    // The same in float, and where the two come halfway each.
    const detail::moving_points<float> both{{{0, 0, 1}, {-9, -9, 0}, {9, -9, 0}, {0, 9, 0}},
                                            {{0, 0, -3}, {-9, -9, 4}, {9, -9, 4}, {0, 9, 4}}};
    for (const double f : detail::parting_plane<false, float>(both).fractions(0).of) CHECK((f > 0.12499 && f < 0.125));
    // Numbers that double cannot bound.
    for (const double huge : {0x1p300, std::numeric_limits<double>::max()}) {
        safe_points p = falls;
        p.t0[0].z = huge;
        p.t1[0].z = -huge;
        CHECK(detail::parting_plane<false, double>(p).fractions(0).of[0] == 0);
    }
}

}  // namespace abut::test
