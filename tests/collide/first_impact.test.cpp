// SPDX-License-Identifier: MIT
//
// The boxes around a part of a step, by which first_impact prunes. What it answers is compared with all impacts where those
// are tested (impact_cases.hpp).

#include <abut/abut.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("first_impact: a coordinate stays within its bounds until a time", "", float, double) {
    using T = TestType;
    using fraction = boost::multiprecision::cpp_rational;
    constexpr double largest = static_cast<double>(largest_finite<T>);
    std::size_t narrower = 0;
    for (std::uint64_t i = 0; i < sample_count(); ++i) {
        draws d(sample_seed, sizeof(T), i);
        const int family = d.below(6);
        double from = d.uniform(-1, 1), to = d.uniform(-1, 1);
        if (family == 1) to = from + d.uniform(-1, 1) * d.power_of_ten(-16, -4);
        if (family == 2) from *= largest, to *= largest;
        if (family == 3) from *= d.power_of_ten(-30, 30), to *= d.power_of_ten(-30, 30);
        if (family == 4) from *= 0x1p-1040, to *= 0x1p-1040;
        if (family == 5) to = from;
        const T a = static_cast<T>(from), b = static_cast<T>(to);
        const int shift = d.below(41);
        const double time = std::ceil(d.uniform(0, 1) * std::ldexp(1.0, shift)) / std::ldexp(1.0, shift);
        const detail::coordinate_until<T> in(a, b, time);
        CAPTURE(i, a, b, time, in.lower, in.upper);
        const fraction p(a), q(b), t(time);
        bool inside = true;
        for (const fraction& part : {fraction(0), fraction(1) / 3, fraction(1)}) {
            const fraction then = p + t * part * (q - p);
            inside &= fraction(in.lower) <= then && then <= fraction(in.upper);
        }
        if (!inside) FAIL_CHECK("a coordinate leaves its bounds");
        if (in.lower < std::min(a, b) || in.upper > std::max(a, b)) FAIL_CHECK("bounds outside of the whole step's");
        if (family != 0) continue;
        const double width = static_cast<double>(in.upper) - static_cast<double>(in.lower);
        const double way = time * std::abs(static_cast<double>(b) - static_cast<double>(a));
        const double lost = sizeof(T) == 4 ? 0x1p-22 : 0x1p-48;
        if (width > way + lost) FAIL_CHECK("bounds wider than the way");
        narrower += width < 0.75 * std::abs(static_cast<double>(b) - static_cast<double>(a));
    }
    CHECK(narrower > sample_count() / 60);
}

TEST_CASE("first_impact: the first part is left out where boxes are hardly smaller in it") {
    const serial on;
    const torus<float> ring(12, 8, 1, 0.4f);
    const auto small_after = [&](float way, float scale = 1) {
        auto t0 = ring.vertices, t1 = ring.vertices;
        for (auto& v : t0) v = scale * v;
        for (auto& v : t1) v = scale * vec3<float>{v.x + way, v.y + way, v.z};
        const mesh<float> at_t0(t0, ring.faces);
        const auto index = make_impact_index(on, moving(at_t0, at_t0.with_vertices(on, t1)));
        const bool is = detail::is_first_part_small<true>(on, index, index);
        CHECK(is == detail::is_first_part_small<false>(on, index, index));
        CHECK(first_self_impact(on, index).has_value() == !to_host(self_impacts(on, index)).empty());
        return is;
    };
    CHECK(!small_after(0));
    CHECK(!small_after(0.01f));
    CHECK(small_after(10));
    CHECK(small_after(10, 1e30f));
    // Vertices of no face, and nothing.
    const std::vector<vec3<float>> from{{0, 0, 0}}, to{{1, 2, 3}};
    const mesh<float> dust(from, std::vector<face>{}), none;
    const auto flight = make_impact_index(on, moving(dust, dust.with_vertices(on, to))), rest = make_impact_index(on, dust);
    CHECK(detail::is_first_part_small<true>(on, flight, flight));
    CHECK(detail::is_first_part_small<false>(on, rest, flight));
    const auto empty = make_impact_index(on, none);
    CHECK(!first_self_impact(on, empty).has_value());
    CHECK(detail::is_first_part_small<true>(on, empty, empty));
}

TEST_CASE("first_impact: boxes of a part of the step are in those of the whole") {
    const large_scene<double> s(7, 0.07);
    const serial on;
    const auto index = make_impact_index(on, s.a.as_set());
    const auto part = detail::until(on, index, 0.25);
    const auto check_inside = [&on](const auto& tree, const auto& of_whole) {
        CHECK(contains(of_whole.bounds(), tree.bounds()));
        CHECK(quality(on, tree).sah_cost < 0.9 * quality(on, of_whole).sah_cost);
    };
    check_inside(part.faces(), index.faces());
    check_inside(part.edges(), index.edges());
    check_inside(part.vertices(), index.vertices());
}

}  // namespace abut::test
