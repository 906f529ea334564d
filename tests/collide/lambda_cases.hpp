// SPDX-License-Identifier: MIT
#pragma once

// Lambdas as filters and visitors, as users write them: for tests on the host, and under nvcc with --extended-lambda.

#include <cstdint>
#include <vector>

#include "support/catch.hpp"

#include <abut/abut.hpp>

// Not `query_options{.filter = f}` with all compilers: clang before 17 does not deduce it.
#if defined(__clang__) && __clang_major__ < 17
#define ABUT_TEST_OPTIONS(options, f) options<decltype(f)>
#else
#define ABUT_TEST_OPTIONS(options, f) options
#endif

namespace lambda_cases {

struct seen {
    std::uint64_t count;
    std::vector<abut::index_pair> pairs, self_pairs;
    std::size_t contacts;
    std::vector<std::uint32_t> visited;
};

/// Spheres in a row, each touching its neighbours; asked with lambdas. (No member and no generic function: nvcc does not
/// take extended lambdas there.)
template <class Policy>
seen ask_in_row(const Policy& on, std::uint32_t n) {
    std::vector<abut::sphere<float>> row;
    for (std::uint32_t i = 0; i < n; ++i) row.push_back({{static_cast<float>(i), 0, 0}, 0.5f});
    const auto balls = abut::copy_to(on, abut::spheres<float>(row));
    const std::uint32_t odd = 1;
    const auto first_is_odd = [=] ABUT_HD(std::uint32_t a, std::uint32_t) { return a % 2 == odd; };
    abut::execution::buffer_of<Policy, std::uint32_t> times(on, n);
    const std::vector<std::uint32_t> zeros(n, 0);
    std::uint32_t* const there = times.data();
    upload(on, zeros.data(), n, there);
    // Each ball is visited as `a` once for itself and for its neighbours, by one pair at a time where it is the first of
    // two.
    const auto mark = [=] ABUT_HD(abut::index_pair pair) {
        if (pair.a < pair.b) there[pair.a] = pair.b;
        return abut::visit::proceed;
    };
    abut::for_each_pair(on, balls, balls, mark);
    seen found;
    found.visited.resize(n);
    download(on, there, n, found.visited.data());
    found.count =
        abut::count(on, balls, balls, ABUT_TEST_OPTIONS(abut::query_options, first_is_odd){.filter = first_is_odd});
    found.pairs = to_host(abut::pairs(
        on, balls, balls, ABUT_TEST_OPTIONS(abut::query_options, first_is_odd){.sorted = true, .filter = first_is_odd}));
    found.self_pairs =
        to_host(abut::self_pairs(on, balls, ABUT_TEST_OPTIONS(abut::self_options, first_is_odd){.filter = first_is_odd}));
    found.contacts =
        abut::contacts(on, balls, balls, ABUT_TEST_OPTIONS(abut::contact_options, first_is_odd){.filter = first_is_odd})
            .size();
    return found;
}

inline void check(const seen& found) {
    // Of 0 1 2 3 4: 1 touches 0 1 2, 3 touches 2 3 4.
    CHECK(found.count == 6);
    CHECK(found.pairs == std::vector<abut::index_pair>{{1, 0}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {3, 4}});
    CHECK(found.self_pairs == std::vector<abut::index_pair>{{1, 2}, {3, 4}});
    CHECK(found.contacts == 6);
    CHECK(found.visited == std::vector<std::uint32_t>{1, 2, 3, 4, 0});
}

}  // namespace lambda_cases
