// SPDX-License-Identifier: MIT
#include <abut/predicate/ray_triangle.hpp>

#include <cstdint>

#include "support/modes.hpp"
#include "support/ray_oracle.hpp"
#include "support/stages.hpp"

namespace {

using namespace abut;

constexpr triangle<float> ramp{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

// Constant expressions, in either order: through the inside, a side and a corner, from it, away from it, beside it.
static_assert(intersects(ray<float>{{0, 0, 0}, {1, 1, 1}}, ramp) && intersects(ramp, ray<float>{{9, 9, 9}, {-1, -1, -1}}));
static_assert(intersects(ray<float>{{0, 0, -1}, {1, 1, 1}}, ramp) && intersects<exact>(ray<float>{{0, 0, 9}, {0, 0, -1}}, ramp));
static_assert(intersects(ray<float>{{1, 1, 1}, {1, 1, 1}}, ramp) && !intersects(ray<float>{{2, 1, 1}, {1, 1, 1}}, ramp));
static_assert(!intersects(ray<float>{{0, 0, 0}, {-1, 1, 1}}, ramp));
// In its plane: towards a side, along one, away from one, and past a corner.
static_assert(intersects(ray<float>{{6, -3, 0}, {-1, 1, 0}}, ramp) && intersects(ray<float>{{1, 1, 1}, {-1, 1, 0}}, ramp));
static_assert(!intersects(ray<float>{{6, -3, 0}, {1, -1, 0}}, ramp) && !intersects(ray<float>{{4, 0, -1}, {1, -1, 0}}, ramp));
// A direction of 0 is a point; triangles without area are segments and points.
static_assert(intersects(ray<float>{{1, 1, 1}, {0, 0, 0}}, ramp) && !intersects(ray<float>{{1, 1, 2}, {0, 0, 0}}, ramp));
static_assert(intersects(ray<double>{{0, 0, 0}, {1, 0, 0}}, triangle<double>{{2, -1, 0}, {2, 1, 0}, {2, 0, 0}}));
static_assert(!intersects(ray<double>{{0, 0, 0}, {1, 0, 0}}, triangle<double>{{2, -1, 1}, {2, 1, 1}, {2, 0, 1}}));
static_assert(intersects(ray<double>{{0, 0, 0}, {1, 0, 0}}, triangle<double>{{2, 0, 0}, {-2, 0, 0}, {-1, 0, 0}}));
static_assert(!intersects(ray<double>{{0, 0, 0}, {1, 0, 0}}, triangle<double>{{-1, 0, 0}, {-2, 0, 0}, {-1, 0, 0}}));

static_assert(decidable_pair<ray<float>, triangle<float>> && !decidable_pair<ray<double>, triangle<float>>);

template <scalar T>
void examine(const ray<T>& r, const triangle<T>& t, std::uint64_t index, test::stage_tally& sum) {
    const auto all = detail::values_of(r, t);
    test::examine_stages<detail::ray_meets_triangle>(r, t, all.value, test::first_time(r, t).has_value(), index, sum);
}

}  // namespace

TEST_CASE("ray and triangle: every stage is right in every family") {
    test::check_every_family<test::triangle_family>(
        "Ray against triangle", "ray-triangle.md", false, test::triangle_family_count,
        [](test::triangle_family f) { return test::name_of(f); },
        []<class T>(T, test::triangle_family f, std::uint64_t k, test::stage_tally& sum) {
            const auto p = test::make_ray_pair<T>(test::sample_seed, f, k);
            examine(p.r, p.t, k, sum);
        },
        20);
}

TEMPLATE_TEST_CASE("ray and triangle: right in every rounding mode, and where denormals are flushed", "", float, double) {
    for (const test::floating_mode& mode : test::floating_modes()) {
        INFO(mode.name);
        int wrong = 0, hits = 0;
        for (int f = 0; f < test::triangle_family_count; ++f) {
            for (std::uint64_t k = 0; k < 60; ++k) {
                const auto p = test::make_ray_pair<TestType>(test::sample_seed, static_cast<test::triangle_family>(f), k);
                const bool truth = intersects<exact>(p.r, p.t);
                bool filtered_here = !truth, exact_here = !truth;
                test::in_mode(mode, [&] {
                    filtered_here = intersects(p.r, p.t);
                    exact_here = intersects<exact>(p.r, p.t);
                });
                wrong += filtered_here != truth || exact_here != truth;
                hits += truth;
            }
        }
        CHECK(wrong == 0);
        CHECK(hits > 500);
    }
}
