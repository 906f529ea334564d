// SPDX-License-Identifier: MIT
#pragma once

// What safe_step and safe_steps promise on every policy. Coordinates are multiples of 2^-6, so that vertices which go parts
// of their ways are where they are exactly, and exact queries of that motion say that nothing is met.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace abut::test {

/// A bumpy sheet of `side` times `side` vertices, `cell` apart, and where it goes.
struct moving_sheet {
    std::vector<vec3<double>> t0, t1;
    std::vector<face> faces;

    /// Of heights around z, that goes down by about `way`, each vertex by its own.
    moving_sheet(draws& d, std::uint32_t side, double cell, double z, double way) {
        const auto on_grid = [](double x) { return std::floor(x * 64) / 64; };
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const double x = cell * (i % side + d.uniform(-0.3, 0.3)), y = cell * (i / side + d.uniform(-0.3, 0.3));
            const vec3<double> from{on_grid(x), on_grid(y), on_grid(z + d.uniform(-0.2, 0.2))};
            const double across = d.uniform(-0.5, 0.5), along = d.uniform(-0.5, 0.5), down = way * d.uniform(0.5, 1);
            t0.push_back(from);
            t1.push_back({from.x + on_grid(across), from.y + on_grid(along), from.z - on_grid(down)});
        }
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            for (std::uint32_t j = 0; j + 1 < side; ++j) {
                const std::uint32_t at = i * side + j;
                faces.push_back({at, at + 1, at + side});
                faces.push_back({at + 1, at + side + 1, at + side});
            }
        }
    }
    /// Both as one mesh.
    void add(const moving_sheet& other) {
        const auto n = static_cast<std::uint32_t>(t0.size());
        t0.insert(t0.end(), other.t0.begin(), other.t0.end());
        t1.insert(t1.end(), other.t1.begin(), other.t1.end());
        for (const face& f : other.faces) faces.push_back({f[0] + n, f[1] + n, f[2] + n});
    }
    /// Where vertices are that have gone parts of their ways.
    template <class Part>
    [[nodiscard]] mesh<double> after(const Part& part) const {
        std::vector<vec3<double>> there;
        for (std::size_t i = 0; i < t0.size(); ++i) there.push_back(t0[i] + part(i) * (t1[i] - t0[i]));
        return mesh<double>(t0, faces).with_vertices(serial{}, there);
    }
    [[nodiscard]] mesh<double> after_all(double part) const {
        return after([part](std::size_t) { return part; });
    }
    [[nodiscard]] moving_set<mesh<double>> as_set() const { return moving(mesh<double>(t0, faces), after_all(1)); }
    /// The first part of the step.
    template <class Part>
    [[nodiscard]] moving_set<mesh<double>> until(const Part& part) const {
        return moving(mesh<double>(t0, faces), after(part));
    }
};

struct safe_scene {
    moving_sheet upper, lower;

    explicit safe_scene(std::uint64_t i) : safe_scene(draws(sample_seed, 31, i), static_cast<int>(i % 5)) {}

private:
    safe_scene(draws d, int kind)
        : upper(d, 9, 1, 1,
                kind == 0   ? 0.2
                : kind == 1 ? 8
                            : 2),
          lower(d, kind < 2 ? 9 : 3, kind < 2 ? 1 : 4, 0,
                kind == 2   ? -2
                : kind == 3 ? 1.5
                            : 0) {}
};

/// safe_step of scenes that meet early, late, and not at all.
template <class Policy>
void check_safe_step(const Policy& on, std::uint64_t scenes) {
    std::size_t free_to_the_end = 0, limited = 0, nearer_after = 0, separated = 0;
    for (std::uint64_t i = 0; i < scenes; ++i) {
        const safe_scene s(i);
        moving_sheet whole = s.upper;
        whole.add(s.lower);
        const auto a = s.upper.as_set(), b = s.lower.as_set(), both = whole.as_set();
        CAPTURE(i);
        const serial host;
        const auto always = [](double part) { return [part](std::size_t) { return part; }; };
        const auto between = [&](double t) {
            return impacts(host, s.upper.until(always(t)), s.lower.until(always(t))).size();
        };
        const auto within_one = [&](double t) { return self_impacts(host, whole.until(always(t))).size(); };

        const double t = safe_step(on, a, b), self = safe_self_step(on, make_impact_index(on, both));
        CHECK((t >= 0 && t <= 1 && self >= 0 && self <= 1));
        CHECK(between(t) == 0);
        CHECK(within_one(self) == 0);
        if (t < 1) CHECK(between(std::min(t + 0x1p-39, 1.0)) > 0);
        if (self < 1) CHECK(within_one(std::min(self + 0x1p-39, 1.0)) > 0);
        (t < 1 ? limited : free_to_the_end) += 1;

        const double kept = 0.1, tolerance = 1e-3;
        const double far = safe_step(on, a, b, {.tolerance = tolerance, .separation = kept});
        CHECK(far <= t);
        for (int k = 0; k <= 8; ++k) {
            const double at = far * (k / 8.0);
            const bool is_near = any_within(host, make_bvh(host, s.upper.after_all(at)), s.lower.after_all(at), kept);
            if (is_near && far > 0) FAIL_CHECK("nearer than the separation at " << at << " of " << far);
        }
        if (far == 0 || far == 1) continue;
        ++separated;
        const double later = std::min(far + 2 * tolerance, 1.0);
        nearer_after += any_within(host, make_bvh(host, s.upper.after_all(later)), s.lower.after_all(later), kept * 1.02);
    }
    CHECK((limited >= scenes / 3 && free_to_the_end >= scenes / 10));
    CHECK((separated >= scenes / 3 && nearer_after == separated));
}

/// safe_steps and safe_self_steps: random parts of the ways, up to what each vertex may go.
template <class Policy>
void check_safe_steps(const Policy& on, std::uint64_t scenes) {
    std::size_t limited = 0, farther_meets = 0, vertices = 0;
    for (std::uint64_t i = 0; i < scenes; ++i) {
        const safe_scene s(i);
        moving_sheet whole = s.upper;
        whole.add(s.lower);
        CAPTURE(i);
        draws d(sample_seed, 32, i);
        const serial host;
        const double separation = i % 2 == 0 ? 0 : 0.0625;
        const conservative_bounds kept{.separation = separation};
        const auto of_both = safe_steps(on, s.upper.as_set(), make_impact_index(on, s.lower.as_set()), kept);
        const auto of_upper = to_host(of_both.first), of_lower = to_host(of_both.second);
        const auto of_whole = to_host(safe_self_steps(on, whole.as_set(), kept));
        REQUIRE((of_upper.size() == s.upper.t0.size() && of_lower.size() == s.lower.t0.size()));
        REQUIRE(of_whole.size() == whole.t0.size());
        const auto drawn = [&d](const auto& limits, double times) {
            std::vector<double> part;
            for (const double f : limits) {
                const double some = times * f * (d.below(2) == 0 ? 1 : d.uniform(0, 1));
                part.push_back(std::floor(std::min(some, 1.0) * 0x1p20) * 0x1p-20);
            }
            return part;
        };
        const auto of = [](const std::vector<double>& part) { return [&part](std::size_t k) { return part[k]; }; };
        for (int tries = 0; tries < 4; ++tries) {
            const auto upper = drawn(of_upper, 1), lower = drawn(of_lower, 1), all = drawn(of_whole, 1);
            CHECK(impacts(host, s.upper.until(of(upper)), s.lower.until(of(lower))).size() == 0);
            CHECK(self_impacts(host, whole.until(of(all))).size() == 0);
            const auto tree = make_bvh(host, s.upper.after(of(upper)));
            CHECK(!any(host, tree, s.lower.after(of(lower))));
            if (!any_within(host, make_bvh(host, s.upper.after_all(0)), s.lower.after_all(0), separation)) {
                CHECK(!any_within(host, tree, s.lower.after(of(lower)), separation));
            }
            CHECK(self_pairs(host, whole.after(of(all))).size() == 0);
            const auto far_upper = drawn(of_upper, 4), far_lower = drawn(of_lower, 4);
            farther_meets += impacts(host, s.upper.until(of(far_upper)), s.lower.until(of(far_lower))).size() > 0;
        }
        vertices += of_upper.size();
        limited += static_cast<std::size_t>(std::count_if(of_upper.begin(), of_upper.end(), [](double f) { return f < 1; }));
        // The same bits as on a core, whoever finds the pairs first.
        const auto there = safe_steps(host, s.upper.as_set(), s.lower.as_set(), kept);
        CHECK(to_host(there.first) == of_upper);
        CHECK(to_host(there.second) == of_lower);
    }
    CHECK(limited > vertices / 4);
    CHECK(limited < vertices);
    CHECK(farther_meets > scenes);
}

}  // namespace abut::test
