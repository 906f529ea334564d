// SPDX-License-Identifier: MIT
// long to compile
//
// Scenes under a limit of memory: what is too large for one device is an error there, and runs where it is divided.

#include <abut/cuda_devices.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"

using namespace abut;

namespace {

constexpr std::size_t n = std::size_t{1} << 19;

/// A small triangle in a cube of side 2; other ones for another stream.
struct make_triangle {
    std::uint64_t stream;
    ABUT_HD triangle<float> operator()(std::size_t i) const {
        test::draws d(20261124, stream, i);
        const auto corner = [&d](const vec3<float>& p) {
            const auto q = test::construction::cube(d, 0.008);
            return vec3<float>{p.x + static_cast<float>(q.x), p.y + static_cast<float>(q.y), p.z + static_cast<float>(q.z)};
        };
        const auto p = test::construction::cube(d, 1);
        const vec3<float> middle{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        const auto a = corner(middle), b = corner(middle);
        return {a, b, corner(middle)};
    }
};

/// All pairs of the whole scene, on one device.
std::vector<index_pair> whole_pairs(const abut::cuda& on) {
    using soup = triangle_soup<float, device_space>;
    return to_host(pairs(on, make_bvh(on, soup(on, n, make_triangle{1})), make_bvh(on, soup(on, n, make_triangle{2}))));
}

class limit_in_scope {
public:
    limit_in_scope(const abut::cuda& on, std::uint64_t more) : on_(on) {
        synchronize(on);
        limit_memory(on, memory_in_use(on).used + more);
    }
    limit_in_scope(const limit_in_scope&) = delete;
    ~limit_in_scope() { limit_memory(on_, no_memory_limit); }

private:
    abut::cuda on_;
};

}  // namespace

TEST_CASE("memory: a limit is capacity_error, nothing is left behind, and a divided scene runs under it") {
    const abut::cuda on;
    const auto expected = whole_pairs(on);
    CHECK(expected.size() > 10'000);
    // No query has run before, so this is what the whole scene takes at most.
    const std::uint64_t enough = memory_in_use(on).used_peak, limit = enough / 100 * 70;
    CHECK(memory_in_use(on).limit == no_memory_limit);
    synchronize(on);
    const std::uint64_t used = memory_in_use(on).used;
    {
        const limit_in_scope with_room(on, enough + (1 << 20));
        CHECK(whole_pairs(on) == expected);
    }
    {
        const limit_in_scope limited(on, limit);
        CHECK(memory_in_use(on).limit == used + limit);
        for (int i = 0; i < 3; ++i) CHECK_THROWS_AS(whole_pairs(on), capacity_error);
        CHECK_THROWS_WITH((execution::buffer<char, device_space>(on, limit + 1)),
                          "abut::limit_memory: device 0 may have " + std::to_string(used + limit) + " bytes in use; " +
                              std::to_string(used) + " are, and " + std::to_string(limit + 1) + " more are needed");
        synchronize(on);
        CHECK(memory_in_use(on).used == used);
        CHECK(count(on, triangle_soup<float>{{make_triangle{1}(5)}}, make_triangle{1}(5)) == 1);  // all is well after
    }
    CHECK(whole_pairs(on) == expected);

    const cuda_devices all;
    if (all.size() == 1) {
        std::printf("one device: a scene that is too large for it is not divided\n");
        return;
    }
    const triangle_soup<float> a(serial{}, n, make_triangle{1}), b(serial{}, n, make_triangle{2});
    for (int k = 0; k < all.size(); ++k) release_memory(all[k]);
    std::vector<std::unique_ptr<limit_in_scope>> limits;
    for (int k = 0; k < all.size(); ++k) limits.push_back(std::make_unique<limit_in_scope>(all[k], limit));
    for (int k = 0; k < all.size(); ++k) CHECK_THROWS_AS(whole_pairs(all[k]), capacity_error);
    CHECK(to_host(pairs(all, make_bvh(all, divide(all, a)), make_bvh(all, divide(all, b)))) == expected);
    for (int k = 0; k < all.size(); ++k)
        CHECK(memory_in_use(all[k]).used_peak <= std::max(enough, memory_in_use(all[k]).limit));
    CHECK_THROWS_AS((void)replicate(all, triangle_soup<float>(serial{}, 16 * n, make_triangle{3})), capacity_error);
    CHECK(count(all, make_bvh(all, divide(all, a)), make_bvh(all, divide(all, b))) == expected.size());
}
