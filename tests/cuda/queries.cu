// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <algorithm>
#include <mutex>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"

static_assert(abut::execution_policy<abut::cuda>);
static_assert(!abut::host_policy<abut::cuda>);

TEMPLATE_TEST_CASE("queries: cuda", "", float, double) { abut::test::check_all_queries<TestType>(abut::cuda{}); }

namespace {

/// A function of the host: nvcc is not told that a device may call it, and cuda refuses it (unmarked_functor.fail.cu).
struct first_is_even {
    bool operator()(std::uint32_t a, std::uint32_t) const { return a % 2 == 0; }
};
struct marked_first_is_even {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t) const { return a % 2 == 0; }
};

template <class Policy>
void check_host_functors(const Policy& on, const abut::triangle_soup<float>& soup, const abut::test::pair_list& expected) {
    abut::test::pair_list even = expected, seen;
    std::erase_if(even, [](const abut::index_pair& p) { return p.a % 2 != 0; });
    CHECK(to_host(abut::pairs(on, soup, soup, abut::query_options<first_is_even>{})) == even);
    CHECK(even.size() < expected.size());
    std::mutex mutex;
    abut::for_each_pair(on, soup, soup, [&](abut::index_pair p) {
        const std::scoped_lock lock(mutex);
        seen.push_back(p);
        return abut::visit::proceed;
    });
    std::sort(seen.begin(), seen.end());
    CHECK(seen == expected);
}

}  // namespace

TEST_CASE("queries: in a .cu file host policies take functors of the host, and cuda calls those that are marked") {
    abut::test::uniform random(41);
    const abut::triangle_soup<float> soup(abut::test::random_triangles<float>(300, random));
    const abut::test::pair_list expected = to_host(abut::pairs(abut::serial{}, soup, soup));
    check_host_functors(abut::serial{}, soup, expected);
    check_host_functors(abut::openmp{.threads = 2}, soup, expected);

    abut::test::pair_list even = expected;
    std::erase_if(even, [](const abut::index_pair& p) { return p.a % 2 != 0; });
    const abut::cuda on;
    CHECK(to_host(abut::pairs(on, soup, soup, abut::query_options<marked_first_is_even>{})) == even);
    abut::test::check_visits(on, soup, soup, soup.size(), soup.size(), expected);
}

/// More pairs than there is room for at first, and than may wait on a device to be finished (execution::most_open).
TEST_CASE("queries: pairs that a first try leaves open, cuda") {
    static_assert(2100 * 2100 / 2 > abut::execution::most_open_at_first && 4200 * 4200 / 2 > abut::execution::most_open);
    abut::test::check_dense<float>(abut::cuda{}, 100);
    abut::test::check_dense<float>(abut::cuda{}, 2100);
    abut::test::check_dense<double>(abut::cuda{}, 2100);
    abut::test::check_dense<float>(abut::cuda{}, 4200);
}
