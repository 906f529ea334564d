// SPDX-License-Identifier: MIT
//
// What is known of an impact, against rational numbers: where features are at the reported time, which way their exact
// normal goes, how fast their points come together. Each within the bound that is reported with it.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <abut/narrow/impact_detail.hpp>
#include <abut/narrow/time_of_impact.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

using detail_fraction = boost::multiprecision::cpp_rational;
using detail_float = boost::multiprecision::cpp_bin_float_100;

struct exact_vector {
    detail_fraction x, y, z;

    template <class T>
    static exact_vector of(const vec3<T>& v) {
        return {detail_fraction(v.x), detail_fraction(v.y), detail_fraction(v.z)};
    }
    friend exact_vector operator+(const exact_vector& a, const exact_vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend exact_vector operator-(const exact_vector& a, const exact_vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend exact_vector operator*(const detail_fraction& s, const exact_vector& v) { return {s * v.x, s * v.y, s * v.z}; }
    [[nodiscard]] detail_fraction times(const exact_vector& b) const { return x * b.x + y * b.y + z * b.z; }
    [[nodiscard]] exact_vector cross_with(const exact_vector& b) const {
        return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
    }
    [[nodiscard]] bool is_below(const detail_fraction& length) const { return times(*this) <= length * length; }
};

/// In units of 2^-700; what is drawn here are multiples of that.
integer in_small_units(const detail_fraction& x) {
    const detail_fraction scaled = x * (integer(1) << 700);
    REQUIRE(denominator(scaled) == 1);
    return numerator(scaled);
}
/// Whether the hull of points comes within a distance of another.
bool hull_is_near(const std::vector<exact_vector>& hull, const exact_vector& at, double distance) {
    std::vector<integer_point> w;
    for (const exact_vector& p : hull) {
        const exact_vector from = p - at;
        w.push_back({in_small_units(from.x), in_small_units(from.y), in_small_units(from.z)});
    }
    const integer r = in_small_units(detail_fraction(distance));
    return hull_reaches(w, r * r);
}

struct details_seen {
    std::size_t hits = 0, far_points = 0, far_features = 0, far_normals = 0, wrong_speeds = 0, coming_apart = 0, no_unit = 0;
    std::size_t small_gaps = 0, known_normals = 0;
};

template <bool Edges, scalar T>
void check_detail(const detail::moving_points<T>& p, details_seen& seen) {
    const auto features = [&] {
        if constexpr (Edges) {
            return std::pair(motion<segment<T>>{{p.t0[0], p.t0[1]}, {p.t1[0], p.t1[1]}},
                             motion<segment<T>>{{p.t0[2], p.t0[3]}, {p.t1[2], p.t1[3]}});
        } else {
            return std::pair(motion<vec3<T>>{p.t0[0], p.t1[0]},
                             motion<triangle<T>>{{p.t0[1], p.t0[2], p.t0[3]}, {p.t1[1], p.t1[2], p.t1[3]}});
        }
    }();
    const double time = time_of_impact(features.first, features.second);
    if (time < 0) return;
    ++seen.hits;
    const impact_detail found = details_at(features.first, features.second, time);

    const detail_fraction t(time);
    std::vector<exact_vector> at, way;
    detail_fraction size = 0, fastest = 0;
    const auto grow = [](detail_fraction& most, const exact_vector& v) {
        for (const detail_fraction& x : {v.x, v.y, v.z}) most = std::max(most, detail_fraction(abs(x)));
    };
    for (int i = 0; i < 4; ++i) {
        const auto from = exact_vector::of(p.t0[i]), to = exact_vector::of(p.t1[i]);
        way.push_back(to - from);
        at.push_back(from + t * way.back());
        grow(size, from), grow(size, to), grow(fastest, way.back());
    }
    std::vector<detail_fraction> w;
    for (const double weight : found.weights.of) w.emplace_back(weight);

    const auto point = exact_vector::of(found.point), normal = exact_vector::of(found.normal);
    const exact_vector named = Edges ? w[0] * at[0] + w[1] * at[1] : at[0];
    seen.far_points += !(point - named).is_below(size / (integer(1) << 46));
    if constexpr (Edges) {
        seen.far_features +=
            !hull_is_near({at[0], at[1]}, point, found.gap) || !hull_is_near({at[2], at[3]}, point, found.gap);
    } else {
        seen.far_features +=
            !hull_is_near({at[0]}, point, found.gap) || !hull_is_near({at[1], at[2], at[3]}, point, found.gap);
    }
    seen.small_gaps += detail_fraction(found.gap) < (size + fastest) / (integer(1) << 34);

    seen.no_unit += std::abs(std::sqrt(dot(found.normal, found.normal)) - 1) > 1e-15;
    const exact_vector across =
        Edges ? (at[1] - at[0]).cross_with(at[3] - at[2]) : (at[2] - at[1]).cross_with(at[3] - at[1]);
    if (found.normal_error < 2) {
        ++seen.known_normals;
        const detail_float length = sqrt(detail_float(across.times(across)));
        const int sign = across.times(normal) < 0 ? -1 : 1;
        const auto off = [&](const detail_fraction& x, const detail_fraction& n) {
            return detail_float(sign * detail_float(x) / length - detail_float(n));
        };
        const detail_float x = off(across.x, normal.x), y = off(across.y, normal.y), z = off(across.z, normal.z);
        seen.far_normals += length == 0 || sqrt(detail_float(x * x + y * y + z * z)) > detail_float(found.normal_error);
    }
    exact_vector coming{0, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) coming = coming + (i < (Edges ? 2u : 1u) ? w[i] : detail_fraction(-w[i])) * way[i];
    seen.wrong_speeds += abs(-coming.times(normal) - detail_fraction(found.speed)) > fastest / (integer(1) << 46);
    seen.coming_apart += found.speed < 0;
}

/// Features of a family; most of those that are drawn at random meet by chance, the others by the way of the first.
template <bool Edges, scalar T>
detail::moving_points<T> points_that_meet(draws& d, int family) {
    const auto number = [&](double scale) {
        return static_cast<T>(family == 7 ? d.below(3) - 1 : scale * d.uniform(-1, 1));  // of which many are parallel
    };
    const double scale = family == 1 ? d.power_of_ten(-12, 12) : 1, offset = family == 2 ? 1000 : 0;
    detail::moving_points<T> p;
    for (int i = 0; i < 4; ++i) {
        for (vec3<T>* all : {p.t0, p.t1}) {
            const T x = number(scale), y = number(scale * (family == 3 && i > 0 ? 1e-4 : 1)), z = number(scale);
            all[i] = {static_cast<T>(x + offset), y, z};
        }
        if (family == 4) p.t0[i].z = p.t1[i].z = 0;   // in one plane
        if (family == 5 && i > 0) p.t1[i] = p.t0[i];  // at rest
    }
    if (family == 6) p.t0[3] = p.t0[2], p.t1[3] = p.t1[2];  // no area, or no length
    if (family > 3 && family != 6) return p;
    // At the middle of the step about the middle of the other's: by where the first one's points go.
    const auto middle = [&](const vec3<T>* all) {
        const vec3<T> q = Edges ? T(0.5) * (all[2] + all[3]) : T(1) / 3 * (all[1] + all[2] + all[3]);
        return q - (Edges ? T(0.5) * (all[0] + all[1]) : all[0]);
    };
    const vec3<T> from = middle(p.t0), to = middle(p.t1);
    for (int i = 0; i < (Edges ? 2 : 1); ++i) p.t1[i] = p.t1[i] + to + T(0.5) * from;
    return p;
}

}  // namespace

TEMPLATE_TEST_CASE("impact details: within their bounds", "", float, double) {
    details_seen seen;
    const std::uint64_t samples = some_samples(2);
    for (std::uint64_t i = 0; i < samples; ++i) {
        draws d(sample_seed, 40 + sizeof(TestType), i);
        const int family = static_cast<int>(i % 8);
        check_detail<false>(points_that_meet<false, TestType>(d, family), seen);
        check_detail<true>(points_that_meet<true, TestType>(d, family), seen);
    }
    CHECK(seen.far_points == 0);
    CHECK(seen.far_features == 0);
    CHECK(seen.far_normals == 0);
    CHECK(seen.wrong_speeds == 0);
    CHECK(seen.coming_apart == 0);
    CHECK(seen.no_unit == 0);
    CHECK(seen.hits > samples / 3);
    CHECK(seen.known_normals > seen.hits / 2);
    CHECK(seen.small_gaps > seen.hits - seen.hits / 50);
    CHECK(seen.known_normals < seen.hits);  // parallel edges and faces without an area have none
}

TEST_CASE("impact details: a vertex that falls on a face") {
    const motion<vec3<double>> falls{{0.25, 0.25, 1}, {0.75, 0.25, -3}};
    const triangle<double> floor{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    const auto d = details_at(falls, motion<triangle<double>>{floor, floor}, 0.25);
    CHECK(d.point == vec3<double>{0.375, 0.25, 0});
    CHECK(d.normal == vec3<double>{0, 0, 1});
    CHECK(d.speed == 4);
    CHECK((d.gap > 0 && d.gap < 1e-12 && d.normal_error < 1e-12));
    CHECK((d.weights.of[0] == 1 && d.weights.of[2] == 0.1875 && d.weights.of[3] == 0.125));
    // From below, and along the face, where no normal is known.
    const motion<vec3<double>> rises{{0.25, 0.25, -1}, {0.25, 0.25, 1}};
    CHECK(details_at(rises, motion<triangle<double>>{floor, floor}, 0.5).normal == vec3<double>{0, 0, -1});
    const triangle<double> flat{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}};
    const auto unknown = details_at(rises, motion<triangle<double>>{flat, flat}, 0.5);
    CHECK((unknown.normal == vec3<double>{0, 0, -1} && unknown.normal_error == 2 && unknown.speed == 2));
    const motion<vec3<double>> rests{{1, 0, 0}, {1, 0, 0}};
    CHECK(details_at(rests, motion<triangle<double>>{flat, flat}, 0).normal == vec3<double>{0, 0, 1});
}

}  // namespace abut::test
