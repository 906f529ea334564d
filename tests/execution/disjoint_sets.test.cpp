// SPDX-License-Identifier: MIT
#include <abut/execution/disjoint_sets.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <abut/execution/host.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

using links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// The least member of each number's set, by carrying the lesser label over the links until nothing changes.
std::vector<std::uint32_t> naive_roots(std::size_t n, const links& all) {
    std::vector<std::uint32_t> label(n);
    for (std::size_t i = 0; i < n; ++i) label[i] = static_cast<std::uint32_t>(i);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [x, y] : all) {
            const std::uint32_t least = std::min(label[x], label[y]);
            changed = changed || label[x] != least || label[y] != least;
            label[x] = label[y] = least;
        }
    }
    return label;
}

template <class Policy>
void check_roots(const Policy& on, std::size_t n, const links& all) {
    execution::buffer_of<Policy, std::uint32_t> parents(on, n);
    const execution::disjoint_sets sets = make_disjoint_sets(on, parents);
    for_each_index(on, all.size(), [&](std::size_t i) { sets.unite(all[i].first, all[i].second); });
    std::vector<std::uint32_t> roots(n);
    for (std::size_t i = 0; i < n; ++i) roots[i] = sets.root(static_cast<std::uint32_t>(i));
    CHECK(roots == naive_roots(n, all));
    std::size_t stand_for_themselves = 0;
    for (std::size_t i = 0; i < n; ++i) stand_for_themselves += sets.is_root(i) == (roots[i] == i);
    CHECK(stand_for_themselves == n);
}

}  // namespace

TEST_CASE("disjoint sets: the least member is the root, whatever the order and the threads") {
    test::uniform random(5);
    for (const std::size_t n : {1u, 2u, 10u, 1000u, 20'000u}) {
        links sparse, chain, star;
        for (std::size_t k = 0; k < n / 2; ++k) {
            sparse.emplace_back(random.below(n), random.below(n));
            chain.emplace_back(n - 1 - k, k + n / 2 < n ? k + n / 2 : k);
            star.emplace_back(n - 1, random.below(n));
        }
        for (std::size_t k = 1; k < n && n < 5000; ++k) chain.emplace_back(n - k, n - k - 1);
        for (const links& all : {links{}, sparse, chain, test::shuffled(chain, random), star}) {
            CAPTURE(n, all.size());
            check_roots(serial{}, n, all);
            for (const int threads : {2, 7}) check_roots(openmp{.threads = threads}, n, all);
        }
    }
}
