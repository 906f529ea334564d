// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <cstdint>
#include <vector>

#include "cuda/measured_pairs.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/within_pairs.hpp"

using namespace abut;

namespace {

/// Of all families of triangles, and pairs at whole distances.
template <scalar T, class Make>
void check_made(const Make& make) {
    using pair = decltype(make(test::round_pair<T>{}));
    std::vector<pair> pairs;
    for (int f = 0; f < test::within_family_count; ++f) {
        for (std::uint64_t k = 0; k < (test::sample_count() + 9) / 10; ++k) {
            const pair p = make(test::make_round_pair<T>(test::sample_seed + 7, f, k));
            if (is_valid(p.s) && is_valid(p.t)) pairs.push_back(p);
        }
    }
    test::check_same_measures(abut::cuda{}, pairs);
}
template <class S, class U>
test::copied_pair<S, U> both(const S& s, const U& t) {
    return {s, t, 0};
}
template <scalar T>
segment<T> edge_of(const triangle<T>& t) {
    return {t.a, t.b};
}

}  // namespace

TEMPLATE_TEST_CASE("distances and contacts of points, segments, spheres, capsules, boxes: cuda measures as the host does", "",
                   float, double) {
    using T = TestType;
    using pair = test::round_pair<T>;
    check_made<T>([](const pair& p) { return both(p.a.ball, p.b.ball); });
    check_made<T>([](const pair& p) { return both(p.a.ball, p.b.rod); });
    check_made<T>([](const pair& p) { return both(p.a.rod, p.b.rod); });
    check_made<T>([](const pair& p) { return both(p.a.rod, edge_of(p.b.flat)); });
    check_made<T>([](const pair& p) { return both(p.a.flat.a, p.b.rod); });
    check_made<T>([](const pair& p) { return both(p.a.rod, p.b.flat); });
    check_made<T>([](const pair& p) { return both(p.a.ball, p.b.flat); });
    check_made<T>([](const pair& p) { return both(p.a.ball, bounds(p.b.flat)); });
    check_made<T>([](const pair& p) { return both(p.a.rod, bounds(p.b.flat)); });
    check_made<T>([](const pair& p) { return both(bounds(p.a.rod), bounds(p.b.flat)); });
    check_made<T>([](const pair& p) { return both(p.a.flat, p.b.flat); });
}
