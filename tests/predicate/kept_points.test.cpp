// SPDX-License-Identifier: MIT
#include <abut/predicate/kept_points.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// The points that a search keeps against the hull's own, one after another: of every number of points around those that a
// block has and that there is room for, dense and far apart in memory, posed and not.

namespace {

using namespace abut;

template <scalar T>
struct padded_point {
    vec3<T> at;
    T unused[2];
};

/// Small integers have many equal heights.
template <scalar T>
vec3<T> some_point(test::draws& d, bool lattice) {
    const auto number = [&] { return static_cast<T>(lattice ? d.below(5) - 2 : d.uniform(-1, 1)); };
    const T x = number(), y = number();
    return {x, y, number()};
}

template <scalar F, scalar T>
vec3<F> converted(const vec3<T>& p) {
    return {static_cast<F>(p.x), static_cast<F>(p.y), static_cast<F>(p.z)};
}

template <scalar T>
constexpr rigid<T> some_pose{{0, T(-0.6), T(0.8), 1, 0, 0, 0, T(0.8), T(0.6)}, {T(0.1), 3, T(-0.7)}};

/// What differs, or null.
template <scalar F, scalar T>
const char* wrong_with_kept(const hull<T>& h, const vec3<T>& origin, test::draws& d) {
    detail::kept_points<F, T> kept(h);
    const std::size_t n = kept.size();
    if (n > h.count || (h.count >= 4 && n != (h.count < kept.room ? h.count : kept.room))) return "their number";
    aabb<F> box = empty_box<F>();
    vec3<F> sum{0, 0, 0};
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<F> p = converted<F>(h[i]);
        if (kept[i] != p) return "a point";
        box = merge(box, bounds(p));
        sum = sum + p;
    }
    if (kept.box().lower != box.lower || kept.box().upper != box.upper) return "the box";
    const vec3<F> off = kept.sum() - sum;
    if (!(detail::magnitudes(off) <= static_cast<F>(n * n) * 8 * unit_roundoff<F>)) return "the sum";
    const vec3<F> from = converted<F>(origin);
    kept.see_from(from);
    for (std::size_t i = 0; i < n; ++i) {
        if (kept[i] != converted<F>(h[i]) - from) return "a difference";
    }
    for (int k = 0; k < 8; ++k) {
        const vec3<F> way = some_point<F>(d, k % 2 == 0);
        F least = infinity<F>, found = least;
        std::uint32_t first = 0, at = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const F height = detail::plain_sum(
                detail::plain_sum(detail::plain_product(way.x, kept[i].x), detail::plain_product(way.y, kept[i].y)),
                detail::plain_product(way.z, kept[i].z));
            if (height < least) least = height, first = static_cast<std::uint32_t>(i);
        }
        kept.look_back(way, found, at);
        if (found != least || at != first) return "the farthest point";
        at = 7;
        kept.look_back(way, found, at);
        if (found != least || at != 7) return "none is farther than the farthest";
    }
    kept.replace([](const vec3<F>& p) { return F(2) * p; });
    for (std::size_t i = 0; i < n; ++i) {
        if (kept[i] != F(2) * (converted<F>(h[i]) - from)) return "a replaced point";
    }
    return nullptr;
}

}  // namespace

TEMPLATE_TEST_CASE("kept points of a hull: as read one by one", "", float, double) {
    using T = TestType;
    std::vector<std::size_t> counts{63, 64, 65, 66, 510, 511, 512, 513, 900};
    for (std::size_t n = 1; n <= 26; ++n) counts.push_back(n);
    for (const std::size_t n : counts) {
        for (const bool lattice : {false, true}) {
            test::draws d(test::sample_seed, 4711 + (lattice ? 1 : 0), n);
            std::vector<padded_point<T>> far(n);
            std::vector<vec3<T>> dense(n);
            for (std::size_t i = 0; i < n; ++i) far[i].at = dense[i] = some_point<T>(d, lattice);
            const vec3<T> origin = some_point<T>(d, lattice);
            const hull<T> hulls[] = {{dense.data(), n}, {&far[0].at, n, sizeof far[0]}};
            for (const hull<T>& h : hulls) {
                for (const hull<T>& placed : {h, place(some_pose<T>, h)}) {
                    INFO(n << (lattice ? " of a lattice" : "") << (placed.is_placed ? " placed" : ""));
                    const char* const wrong = wrong_with_kept<double>(placed, origin, d);
                    CHECK(wrong == nullptr);
                    if (wrong != nullptr) WARN(wrong);
                    const char* const as_given = wrong_with_kept<T>(placed, origin, d);
                    CHECK(as_given == nullptr);
                    if (as_given != nullptr) WARN(as_given);
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("intersects of hulls: however many points and however they lie in memory", "", float, double) {
    using T = TestType;
    int meet = 0, asked = 0;
    for (const std::size_t n : {3u, 4u, 5u, 8u, 9u, 40u, 512u, 515u}) {
        for (std::uint64_t k = 0; k < 40; ++k) {
            test::draws d(test::sample_seed, 4713 + n, k);
            std::vector<padded_point<T>> far(n);
            std::vector<vec3<T>> moved(n);
            for (std::size_t i = 0; i < n; ++i) {
                far[i].at = some_point<T>(d, k % 2 == 0);
                moved[i] = place(some_pose<T>, far[i].at);
            }
            // The last points are the farthest: those for which there was no room, if there was none for all.
            std::vector<vec3<T>> other(n / 2 + 1);
            for (vec3<T>& p : other) p = some_point<T>(d, k % 2 == 0) + vec3<T>{0, T(3 + d.below(5)), 0};
            far.back().at = vec3<T>{T(d.below(5)), 0, 0};
            moved.back() = place(some_pose<T>, far.back().at);
            const hull<T> a = place(some_pose<T>, hull<T>(&far[0].at, n, sizeof far[0])), b(other.data(), other.size());
            const hull<T> copy(moved.data(), n);
            const bool expected = intersects<exact>(copy, b);
            INFO(n << " " << k);
            CHECK(intersects<exact>(a, b) == expected);
            CHECK(intersects<filtered>(a, b) == expected);
            CHECK(intersects<filtered>(b, a) == expected);
            CHECK(intersects<fast>(a, b) == intersects<fast>(copy, b));
            meet += expected;
            ++asked;
        }
    }
    CHECK(meet > asked / 8);
    CHECK(meet < asked - asked / 8);
}
