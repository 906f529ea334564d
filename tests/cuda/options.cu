// SPDX-License-Identifier: MIT
//
// Options that change no answer are not ignored on a device either.

#include <abut/cuda.hpp>
#include <abut/experimental/cuda_work_stealing.hpp>

#include <cmath>
#include <vector>

#include "collide/stop_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

// A quarter of the 40 million pairs: what blocks that run at once have begun when they learn of a hit is far less.
TEST_CASE("options: any and visit::stop end a query, cuda") { check_stops(cuda{}, 2000, 20'000, 10'000'000); }

namespace {

/// The most that is in use of the library's pool while `work` runs, beyond what was in use before, in bytes.
template <class Work>
std::uint64_t peak_of(const cuda& on, const Work& work) {
    synchronize(on);
    std::uint64_t none = 0;
    REQUIRE(cudaMemPoolSetAttribute(execution::detail::pool_of(device_of(on)).handle(), cudaMemPoolAttrUsedMemHigh, &none) ==
            cudaSuccess);
    const std::uint64_t before = memory_in_use(on).used;
    work();
    return memory_in_use(on).used_peak - before;
}

}  // namespace

TEST_CASE("options: most_pairs bounds what waits for the host, cuda") {
    // Balls of radius 2^-140 that touch the plane of a triangle of size 1: no filter can tell, nor 124 bits.
    const float tiny = std::ldexp(1.0f, -140);
    const triangle<float> floor{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const sphere<float> ball{{0, 0, tiny}, tiny};
    REQUIRE(decide<filtered>(ball, floor) == verdict::unknown);
    REQUIRE(decide<exact>(ball, floor) == verdict::unknown);
    constexpr std::size_t n = 512;
    const cuda on;
    const auto triangles = copy_to(on, triangle_soup<float>(std::vector<triangle<float>>(n, floor)));
    const auto balls = copy_to(on, spheres<float>(std::vector<sphere<float>>(n, ball)));
    const auto ask = [&](std::uint64_t most) { CHECK(count(on, triangles, balls, {.most_pairs = most}) == n * n); };
    ask(n * n);  // what a thread of the host keeps is there now
    const auto all_at_once = peak_of(on, [&] { ask(n * n); }), some_at_a_time = peak_of(on, [&] { ask(1000); });
    CAPTURE(all_at_once, some_at_a_time);
    CHECK(all_at_once > some_at_a_time + n * n * sizeof(triangle<float>));
}

}  // namespace abut::test
