// SPDX-License-Identifier: MIT
// Of calls that do not wait, what a host can try. What they answer is tests/cuda.

#include <abut/collide/async_motion.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

using fraction = boost::multiprecision::cpp_rational;

/// The gap between two features along an axis at a time; less than 0 where they overlap.
template <class T>
fraction gap_along(const detail::moving_points<T>& p, int first, T vec3<T>::*axis, const fraction& t) {
    fraction low[2], high[2];
    for (int k = 0; k < 4; ++k) {
        const int of = k < first ? 0 : 1;
        const fraction from(static_cast<double>(p.t0[k].*axis)), to(static_cast<double>(p.t1[k].*axis));
        const fraction at = from + t * (to - from);
        if (k == 0 || k == first || at < low[of]) low[of] = at;
        if (k == 0 || k == first || at > high[of]) high[of] = at;
    }
    return std::max<fraction>(low[0] - high[1], low[1] - high[0]);
}

/// A gap is concave in time: what is apart along one axis, on one side, at both ends of a while, is so in between.
template <class T, bool Edges>
int check_apart(std::uint64_t stream) {
    int counted = 0;
    for (std::uint64_t i = 0; i < some_samples(5); ++i) {
        draws d(sample_seed, stream, i);
        const bool has_grid = d.below(2) == 0;
        const double far = d.below(4) == 0 ? d.power_of_ten(2, 6) : 0, separation = d.below(2) == 0 ? 0 : d.uniform(0, 0.5);
        const auto number = [&] {
            const double x = d.uniform(-1, 1);
            return static_cast<T>(far + (has_grid ? static_cast<double>(static_cast<int>(x * 4)) / 4 : x));
        };
        detail::moving_points<T> p{};
        for (int k = 0; k < 4; ++k) {
            for (auto* at : {&p.t0[k], &p.t1[k]}) {
                const T x = number(), y = number(), z = number();
                *at = {x, y, z};
            }
            if (k < (Edges ? 2 : 1)) p.t0[k].x += static_cast<T>(d.uniform(0.5, 3));
        }
        const double until = detail::apart_until<Edges>(p, separation);
        REQUIRE((until >= 0 && until <= 2));
        if (until == 0) continue;
        const fraction last(std::min(until, 1.0)), least(separation);
        bool is_apart = false;
        for (auto axis : {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z}) {
            constexpr int first = Edges ? 2 : 1;
            is_apart |= gap_along(p, first, axis, fraction(0)) > least && gap_along(p, first, axis, last) > least &&
                        gap_along(p, first, axis, fraction(last / 2)) > least;
        }
        CHECK(is_apart);
        ++counted;
    }
    return counted;
}

}  // namespace

TEST_CASE("apart_until: in rationals, features are apart up to there") {
    CHECK(check_apart<float, false>(1) > 50);
    CHECK(check_apart<float, true>(2) > 50);
    CHECK(check_apart<double, false>(3) > 50);
    CHECK(check_apart<double, true>(4) > 50);
}

TEST_CASE("apart_until: as far as it goes, and no farther") {
    // A vertex that falls on a face, and one that never comes.
    detail::moving_points<double> p{{{0.25, 0.25, 3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0.25, 0.25, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const double met = detail::apart_until<false>(p, 0), near = detail::apart_until<false>(p, 1);
    CHECK((met <= 0.75 && met > 0.75 - 0x1p-38));
    CHECK((near <= 0.5 && near > 0.5 - 0x1p-38));
    p.t1[0].z = 3;
    CHECK(detail::apart_until<false>(p, 2.5) > 1);
    CHECK(detail::apart_until<false>(p, 3) == 0);
    const detail::moving_points<double> huge{{{1e308, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                             {{-1e308, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    CHECK(detail::apart_until<false>(huge, 0) <= 0.5);
}

TEST_CASE("refit_boxes: a tree is refitted in place") {
    const serial on;
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{700}}) {
        std::vector<sphere<float>> from, to;
        draws d(sample_seed, 5, n);
        for (std::size_t i = 0; i < n; ++i) {
            const auto at = construction::cube(d, 9), next = construction::cube(d, 9);
            from.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)}, 0.5f});
            to.push_back({{static_cast<float>(next.x), static_cast<float>(next.y), static_cast<float>(next.z)}, 0.25f});
        }
        const auto tree = make_bvh(on, spheres<float>(from));
        const spheres<float> there(to);
        const auto own = detail::refit_storage(on, tree.stored(), tree.set().view());
        detail::refit_boxes(on, *own, there.view(), *own);
        const auto fresh = refit(on, tree, there);
        REQUIRE(own->nodes.size() == fresh.stored().nodes.size());
        CHECK(own->root.data()->bounds.upper == fresh.bounds().upper);
        for (std::size_t k = 0; k < own->nodes.size(); ++k) {
            const auto &a = own->nodes.data()[k], &b = fresh.stored().nodes.data()[k];
            for (int slot = 0; slot < 2; ++slot) {
                REQUIRE(a.bounds[slot].lower == b.bounds[slot].lower);
                REQUIRE(a.bounds[slot].upper == b.bounds[slot].upper);
                REQUIRE(a.child[slot].bits == b.child[slot].bits);
            }
        }
        CHECK(!fresh.stored().is_refitted_in_place);
    }
}

}  // namespace abut::test
