// SPDX-License-Identifier: MIT
#include <abut/collide/validate.hpp>

#include "collide/validate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("validate: serial", "", float, double) { test::check_validate<TestType>(serial{}); }

TEMPLATE_TEST_CASE("validate: openmp on 1, 2 and 7 threads", "", float, double) {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        test::check_validate<TestType>(openmp{.threads = threads}, 50);
    }
}

TEST_CASE("validate: what is too large to be numbered is refused before it is read") {
    const auto of_size = [](std::size_t vertices, std::size_t faces) {
        return mesh_view<float>(nullptr, vertices, nullptr, faces);
    };
    CHECK_THROWS_AS(validate(serial{}, of_size(3, std::size_t{1} << 31)), capacity_error);
    CHECK_THROWS_AS(validate(serial{}, of_size(std::size_t{1} << 31, 3)), capacity_error);
    CHECK_THROWS_WITH(
        validate(serial{}, of_size(3, 1'431'655'766)),
        "abut::validate: 1431655766 faces; their sides are numbered in 32 bits, which is enough for 1431655765");
}

TEST_CASE("validate: half-edges are packed without loss up to the largest meshes") {
    for (const int bits : {0, 1, 7, 23, 31}) {
        CAPTURE(bits);
        const detail::half_edge_key key{bits};
        const std::uint64_t most = (std::uint64_t{1} << bits) - 1;
        for (const std::uint64_t lower : {std::uint64_t{0}, most / 2, most}) {
            for (const std::uint64_t upper : {std::uint64_t{0}, most / 2 + 1, most}) {
                if (lower >= upper || upper > most) continue;
                for (const bool backward : {false, true}) {
                    const std::uint64_t packed[1] = {backward ? key.pack(upper, lower, most) : key.pack(lower, upper, most)};
                    const detail::sorted_half_edges one{{}, packed, nullptr, 1, key};
                    CHECK(one.lower(0) == lower);
                    CHECK(one.upper(0) == upper);
                    CHECK(one.backward(0) == backward);
                    CHECK(one.edge(0) < key.no_edge());
                    CHECK(one.is_edge(0));
                }
            }
        }
        const std::uint64_t none[1] = {key.no_edge()};
        CHECK_FALSE(detail::sorted_half_edges{{}, none, nullptr, 1, key}.is_edge(0));
    }
}
