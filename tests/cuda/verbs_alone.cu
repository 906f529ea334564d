// SPDX-License-Identifier: MIT
//
// What the target abut::cuda_verbs has compiled, compiled here instead, and for types that it has not.
#include <abut/execution/cuda_cub.hpp>
#include <abut/execution/cuda_verbs.hpp>

#include <cstdint>
#include <numeric>
#include <vector>

#include "execution/verb_cases.hpp"
#include "support/catch.hpp"

using namespace abut;
using execution::buffer;

namespace {

/// Without padding, so that CUB may copy it as it is.
struct thrice {
    std::uint32_t a, b, c;
    bool operator==(const thrice&) const = default;
};

}  // namespace

TEST_CASE("verbs: cuda, compiled with CUB in the same source") {
    test::check_reductions(abut::cuda{});
    test::check_sorts<std::uint32_t>(abut::cuda{});
    test::check_sorts<std::uint64_t>(abut::cuda{});
}

TEST_CASE("verbs: cuda sorts and adds up types that abut::cuda_verbs has not compiled") {
    const abut::cuda on;
    for (const std::size_t n : {std::size_t{2}, std::size_t{1000}, std::size_t{100'000}}) {
        CAPTURE(n);
        std::vector<std::uint16_t> keys(n);
        std::vector<thrice> values(n);
        for (std::size_t i = 0; i < n; ++i) {
            const auto key = static_cast<std::uint16_t>(i * 40503u);
            keys[i] = key;
            values[i] = {key, static_cast<std::uint32_t>(i), 7};
        }
        buffer<std::uint16_t, device_space> keys_there(on, n), alone(on, n), sums(on, n + 1);
        buffer<thrice, device_space> values_there(on, n);
        upload(on, keys.data(), n, keys_there.data());
        upload(on, keys.data(), n, alone.data());
        upload(on, keys.data(), n, sums.data());
        upload(on, values.data(), n, values_there.data());
        sort_by_key(on, keys_there, values_there, 16);
        sort_keys(on, alone, 16);
        exclusive_scan(on, sums.data(), n);
        std::vector<std::uint16_t> expected(n + 1);
        for (std::size_t i = 0; i < n; ++i) expected[i + 1] = static_cast<std::uint16_t>(expected[i] + keys[i]);
        CHECK(test::on_host(on, sums.data(), n + 1) == expected);
        std::stable_sort(values.begin(), values.end(), [](const thrice& x, const thrice& y) { return x.a < y.a; });
        std::sort(keys.begin(), keys.end());
        CHECK(test::on_host(on, keys_there.data(), n) == keys);
        CHECK(test::on_host(on, alone.data(), n) == keys);
        CHECK(test::on_host(on, values_there.data(), n) == values);
    }
}
