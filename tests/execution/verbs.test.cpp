// SPDX-License-Identifier: MIT
#include <abut/execution/host.hpp>

#include <stdexcept>

#include "execution/verb_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

static_assert(execution_policy<serial>);
static_assert(execution_policy<openmp>);
static_assert(!execution_policy<int>);
static_assert(host_policy<serial> && host_policy<openmp>);

TEST_CASE("verbs: serial") { test::check_verbs(serial{}); }

TEST_CASE("verbs: openmp on 1, 2, 7 and all threads") {
    for (const int threads : {1, 2, 7, 0}) {
        CAPTURE(threads);
        test::check_verbs(openmp{.threads = threads});
    }
}

TEST_CASE("verbs: what a functor throws on any thread arrives at the caller") {
    const auto thrower = [](std::size_t i) {
        if (i == 50'000) throw std::runtime_error("from within");
    };
    CHECK_THROWS_WITH(for_each_index(serial{}, 100'000, thrower), "from within");
    CHECK_THROWS_WITH(for_each_index(openmp{.threads = 3}, 100'000, thrower), "from within");
    const auto first = [](std::size_t a, std::size_t) { return a; };
    const auto worse = [](std::size_t i) {
        if (i == 99'999) throw std::bad_alloc();
        return i;
    };
    CHECK_THROWS_AS(reduce(openmp{.threads = 3}, 100'000, std::size_t{0}, first, worse), std::bad_alloc);
}

TEST_CASE("buffers: memory for more elements than can be addressed is refused") {
    using buffer = execution::buffer<std::uint64_t, host_space>;
    CHECK_THROWS_AS(buffer(serial{}, static_cast<std::size_t>(-1) / 4), std::bad_alloc);
    buffer none(serial{}, 0);
    CHECK(none.data() == nullptr);
    buffer a(serial{}, 3), b(std::move(a));
    CHECK(a.data() == nullptr);
    CHECK(b.size() == 3);
}
