// SPDX-License-Identifier: MIT
#include <abut/narrow/hit_time.hpp>

#include <cstdint>

#include <abut/shape/shape.hpp>

#include "support/catch.hpp"
#include "support/ray_oracle.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using detail::hit_time;

struct time_tally {
    std::uint64_t pairs = 0, hits = 0, in_pairs = 0, in_doubles = 0, wrong = 0;
    time_tally& operator+=(const time_tally& o) {
        pairs += o.pairs, hits += o.hits, in_pairs += o.in_pairs, in_doubles += o.in_doubles, wrong += o.wrong;
        return *this;
    }
};

template <class Line, scalar T>
void examine(const Line& line, const triangle<T>& t, time_tally& sum) {
    const auto truth = test::first_time(line, t);
    const double by_filter = hit_time<filtered>(line, t), by_integers = hit_time<exact>(line, t);
    const detail::time_bounds bounds = detail::hit_time_bounds<filtered>(line, t);
    ++sum.pairs;
    sum.hits += truth.has_value();
    sum.wrong += by_filter != by_integers || (by_filter >= 0) != truth.has_value();
    sum.wrong += !(bounds.first <= by_filter && by_filter <= bounds.last) || (bounds.first >= 0) != truth.has_value();
    if (!truth) return;
    // A time may be above the largest number.
    const bool is_right =
        by_filter == largest_finite<double> ? *truth * 2 > test::exactly(by_filter) : test::is_rounded(by_filter, *truth);
    sum.wrong += !is_right;
    const bool crosses = decide<filtered>(line, t) == verdict::yes;
    if (!bounds.is_one()) {
        ++sum.in_doubles;
        sum.wrong += !(test::exactly(bounds.first) <= *truth && *truth <= test::exactly(bounds.last));
    }
    sum.in_pairs += crosses && detail::crossing_in_pairs(detail::line_of<T>(line), t) >= 0;
}

}  // namespace

TEMPLATE_TEST_CASE("hit time: rounded to nearest in every family", "", float, double) {
    using T = TestType;
    const std::uint64_t samples = (test::sample_count() + 49) / 50;
    std::uint64_t in_pairs = 0, in_doubles = 0, hits = 0;
    for (int i = 0; i < test::triangle_family_count; ++i) {
        const auto f = static_cast<test::triangle_family>(i);
        const auto sum =
            test::in_threads<time_tally>(samples, [&](std::uint64_t first, std::uint64_t last, time_tally& all) {
                for (std::uint64_t k = first; k < last; ++k) {
                    const auto p = test::make_ray_pair<T>(test::sample_seed + 1, f, k);
                    examine(p.r, p.t, all);
                    const vec3<T> far =
                        p.r.origin + T(k % 3) * p.r.direction;  // as a segment, which may end at the triangle
                    if (is_valid(far)) examine(segment<T>{p.r.origin, far}, p.t, all);
                }
            });
        INFO(test::name_of(f));
        CHECK(sum.wrong == 0);
        CHECK(sum.hits * 40 > sum.pairs);
        in_pairs += sum.in_pairs, in_doubles += sum.in_doubles, hits += sum.hits;
    }
    CHECK(in_pairs * 10 > hits);
    CHECK(in_pairs * 2 < hits);
    CHECK(in_doubles * 10 > hits);
    CHECK(in_doubles * 2 < hits);
}

TEST_CASE("hit time: where pairs of doubles tell, and where they do not") {
    const triangle<float> floor{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
    const auto time = [&](const vec3<float>& origin, const vec3<float>& direction) {
        return hit_time<filtered>(ray<float>{origin, direction}, floor);
    };
    CHECK(time({1, 1, 3}, {0, 0, -2}) == 1.5);
    CHECK(time({1, 1, 3}, {0, 0, 2}) == -1);
    CHECK(time({1, 1, 1}, {0, 0, -3}) == 1.0 / 3);
    CHECK(time({1, 1, 0}, {1, 1, 1}) == 0);         // begins on it
    CHECK(time({-2, 1, 0}, {3, 0, 0}) == 2.0 / 3);  // in its plane, through a side
    CHECK(time({-2, 0, 0}, {3, 0, 0}) == 2.0 / 3);  // along a side
    CHECK(time({5, 0, 0}, {-3, 0, 0}) == 2.0 / 3);
    CHECK(time({1, 1, 1}, {0, 0, -0x1p-149f}) == 0x1p149);
    CHECK(hit_time<filtered>(segment<float>{{1, 1, 1}, {1, 1, -1}}, floor) == 0.5);
    CHECK(hit_time<filtered>(segment<float>{{1, 1, 1}, {1, 1, 0.5f}}, floor) == -1);
    CHECK(hit_time<fast>(ray<float>{{1, 1, 3}, {0, 0, -2}}, floor) == 1.5);
    // A segment of one point, by a side that it would meet at a time of some 2^-1270 if it went to a corner.
    const triangle<double> thin{{0x1p-742, 0x1p366, 0}, {0x1p-7, -0x1p-693, 0}, {-0x1p-226, 0x1p-904, 0}};
    CHECK(hit_time<filtered>(segment<double>{{0, 0, 0}, {0, 0, 0}}, thin) == -1);
    CHECK(hit_time<filtered>(ray<double>{{0, 0, 0}, thin.a}, thin) == 0);  // the true time, rounded
    // Above the largest number it is that.
    const triangle<double> far{{-1, -1, 0x1p1000}, {1, -1, 0x1p1000}, {0, 3, 0x1p1000}};
    CHECK(hit_time<filtered>(ray<double>{{0, 0, 0}, {0, 0, 0x1p-1000}}, far) == largest_finite<double>);
}
