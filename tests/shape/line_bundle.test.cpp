// SPDX-License-Identifier: MIT
//
// A line, by itself and by fours, and a bundle of lines reach every box that they pass through, in every mode of the processor,
// and at the ends of the range. Which these are, integers say.
#include <abut/shape/line_bundle.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/rational.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

template <class T>
struct some_lines {
    std::vector<ray<T>> rays;
    double last;
};

/// A bundle of a kind: nearly parallel, from one point, along an axis or in a plane, and with signs that differ.
template <class T>
some_lines<T> bundle_of(std::size_t kind, T scale, test::uniform& random) {
    const vec3<T> origin = random.point<T>(-2, 2), way = random.point<T>(-1, 1);
    const double spread = std::pow(10.0, random(-6, 0)), apart = kind % 2 == 0 ? 0 : spread;
    const T length = kind % 3 == 0 ? T(1) : kind % 3 == 1 ? T(1e-3) : T(1) / scale;
    some_lines<T> made{{}, random.below(3) == 0 ? 1 : std::numeric_limits<double>::infinity()};
    for (int i = 0; i < 12; ++i) {
        vec3<T> o = origin + random.point<T>(-apart, apart), d = way + random.point<T>(-spread, spread);
        if (kind % 5 == 1) d.x = 0;
        if (kind % 5 == 2) d = {0, 0, i % 3 == 0 ? T(1) : T(2)};
        if (kind % 5 == 3 && i % 4 == 0) d.y = std::numeric_limits<T>::denorm_min();
        if (kind % 7 == 4) o.z = T(i % 2 == 0 ? 0 : -0.0);
        const vec3<T> longer = length * d;
        const bool fits = std::isfinite(longer.x) && std::isfinite(longer.y) && std::isfinite(longer.z);
        made.rays.push_back({scale * o, fits ? longer : d});
    }
    return made;
}

template <class T>
detail::line_in_frame<T> as_line(const ray<T>& r, double last) {
    return {r.origin, r.direction, last, 0};
}

/// Whether a line passes through a box.
template <class T>
bool passes(const ray<T>& r, double last, const aabb<T>& box) {
    const vec3<T>&o = r.origin, &d = r.direction, &l = box.lower, &u = box.upper;
    const auto n = test::to_integers<T>({o.x, o.y, o.z, d.x, d.y, d.z, l.x, l.y, l.z, u.x, u.y, u.z});
    test::integer in = 0, in_of = 1, out = 1, out_of = last == 1 ? 1 : 0;  // numerators and denominators
    for (std::size_t k = 0; k < 3; ++k) {
        test::integer to_lower = n[6 + k] - n[k], to_upper = n[9 + k] - n[k], along = n[3 + k];
        if (along == 0) {
            if (to_lower > 0 || to_upper < 0) return false;
            continue;
        }
        if (along < 0) {
            const test::integer before = to_lower;
            to_lower = -to_upper, to_upper = -before, along = -along;
        }
        if (to_lower * in_of > in * along) in = to_lower, in_of = along;
        if (to_upper * out_of < out * along) out = to_upper, out_of = along;
    }
    return in * out_of <= out * in_of;
}

}  // namespace

TEMPLATE_TEST_CASE("lines: what they pass through they reach, alone and in bundles", "", float, double) {
    using T = TestType;
    const T smallest = std::numeric_limits<T>::min(), largest = std::numeric_limits<T>::max();
    test::uniform random(521);
    std::size_t lost = 0, reached = 0, left_out = 0, kept_alone = 0, kept_by_fours = 0, left_out_alone = 0;
    for (const T scale : {T(1), T(1e-20), T(1e20), smallest * 64, smallest, smallest / 64, largest / 16}) {
        const bool is_ordinary = scale > T(1e-25) && scale < T(1e25);
        for (std::size_t kind = 0; kind < 210; ++kind) {
            const auto lines = bundle_of<T>(kind, scale, random);
            alignas(16) T planes[6][4];
            aabb<T> boxes[4];
            for (int k = 0; k < 4; ++k) {
                // Boxes around points of a line, and of no width in some coordinates; and boxes anywhere.
                const auto& r = lines.rays[random.below(lines.rays.size())];
                const vec3<T> width = scale * random.point<T>(0, std::pow(10.0, random(-5, 0)));
                const T time = static_cast<T>(random(0, 2));
                vec3<T> at = r.origin + time * (lines.last == 1 ? r.direction : scale * r.direction);
                const bool fits = std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z);
                if (k == 3 || !fits) at = scale * random.point<T>(-3, 3);
                boxes[k] = {at - width, at + width};
                if (kind % 4 == 0) boxes[k].upper.y = boxes[k].lower.y;
                const vec3<T>&lower = boxes[k].lower, &upper = boxes[k].upper;
                const T box[] = {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
                for (int plane = 0; plane < 6; ++plane) planes[plane][k] = box[plane];
            }
            // By definition, in the default mode: which boxes a line passes through.
            std::vector<unsigned> met(lines.rays.size(), 0);
            for (unsigned k = 0; k < 4; ++k) {
                const vec3<T>&l = boxes[k].lower, &u = boxes[k].upper;
                if (!detail::is_finite(detail::magnitudes(l) + detail::magnitudes(u))) continue;
                for (std::size_t i = 0; i < met.size(); ++i) {
                    met[i] |= static_cast<unsigned>(passes(lines.rays[i], lines.last, boxes[k])) << k;
                }
            }
            for (const auto& mode : test::floating_modes()) {
                test::in_mode(mode, [&] {
                    detail::line_bounds<T> between(as_line(lines.rays[0], lines.last));
                    for (const auto& r : lines.rays) between.add(as_line(r, lines.last));
                    T soonest[4];
                    const unsigned together = detail::bundle_reach<T>(between).reached(planes, soonest);
                    for (std::size_t i = 0; i < lines.rays.size(); ++i) {
                        const ray<T>& r = lines.rays[i];
                        const detail::ray_reach<T> alone(as_line(r, lines.last));
                        const detail::ray_reach_of_four<T> alone_by_fours(as_line(r, lines.last));
                        T entries[4];
                        const unsigned by_fours = alone_by_fours.least_in_four(planes, entries);
                        lost += (met[i] & ~by_fours) != 0 || (met[i] & ~together) != 0;
                        for (unsigned k = 0; k < 4; ++k) {
                            const bool is_kept = alone(boxes[k]), is_met = (met[i] >> k & 1) != 0;
                            lost += is_met && (!is_kept || !alone_by_fours.keeps(entries[k]));
                            reached += is_met;
                            kept_alone += is_kept && !is_met && is_ordinary;
                            kept_by_fours += (by_fours >> k & 1) != 0 && !is_met && is_ordinary;
                            left_out_alone += !is_kept && is_ordinary;
                            left_out += (together >> k & 1) == 0;
                        }
                    }
                });
            }
        }
    }
    CHECK(lost == 0);
    CHECK(reached > 10000);
    CHECK(left_out > 10000);
    // Little is kept besides, but near the ends of the range.
    CHECK(kept_alone * 20 < left_out_alone);
    CHECK(kept_by_fours * 20 < left_out_alone);
}

TEMPLATE_TEST_CASE("bundles of lines: in how many coordinates planes say anything", "", float, double) {
    using T = TestType;
    const auto told = [](const std::vector<vec3<T>>& directions) {
        detail::line_bounds<T> between({{0, 0, 0}, directions[0], 1, 0});
        for (const auto& d : directions) between.add({{0, 0, 0}, d, 1, 0});
        return detail::bundle_reach<T>(between).coordinates_told();
    };
    CHECK(told({{1, 2, 3}, {2, 1, 1}}) == 3);
    CHECK(told({{1, 2, -3}, {2, 1, -1}}) == 3);
    CHECK(told({{1, 2, 3}, {-2, 1, 1}}) == 2);
    CHECK(told({{1, 2, 3}, {-2, -1, -1}}) == 0);
    CHECK(told({{0, 0, 3}, {0, 0, 1}}) == 3);
    CHECK(told({{0, 0, 3}, {0, 1, 1}}) == 2);
    CHECK(told({{0, 0, 0}, {0, 0, 0}}) == 3);
    CHECK(told({{std::numeric_limits<T>::denorm_min(), 0, 0}}) == 2);
    CHECK(told({{std::numeric_limits<T>::infinity(), 1, 1}, {1, 1, 1}}) == 0);
}
