// SPDX-License-Identifier: MIT
#include <abut/execution/host.hpp>

#include <algorithm>
#include <atomic>
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

namespace {

/// Items that all make sixteen others, down to the greatest depth, until so many have: what a walk of two trees with four
/// children a node has room for, and far more than it meets.
struct flood {
    struct item {
        unsigned depth;
    };
    using candidate = unsigned;
    static constexpr unsigned most_children = 16, most_depth = 96;
    std::atomic<long>* left;

    [[nodiscard]] static std::size_t seeds() { return 1; }
    [[nodiscard]] static item seed(std::size_t) { return {0}; }
    void prefetch(const item&) const {}
    template <class Emitter>
    void operator()(const item& at, Emitter& emitter) const {
        const bool ends = at.depth == most_depth || left->fetch_sub(1) <= 0;
        for (unsigned k = 0; k < most_children && !ends; ++k) emitter.add(k, true, item{at.depth + 1});
        emitter.push(0u, ends, at.depth);
    }
};
struct keep_depth {
    std::atomic<int>* hints;
    void operator()(unsigned depth, auto&, auto& hits) const { hits.push(depth); }
    void prefetch(unsigned, int step) const { *hints += step == 0 ? 1 : -1; }
};

}  // namespace

TEST_CASE("verbs: a descent has room for as many items as there may be, and hints at each candidate twice") {
    const auto check_on = [](const auto& on) {
        constexpr long most = 200'000;
        std::atomic<long> left{most};
        std::atomic<int> hints{0};
        execution::work_queue<unsigned, host_space> late(on), hits(on);
        for_each_descendant(
            on, flood{&left}, keep_depth{&hints}, [](unsigned, auto&) { FAIL(); }, late, hits);
        CHECK(hits.size() == 1 + 15 * most);
        CHECK(*std::max_element(hits.data(), hits.data() + hits.size()) == 96);
        CHECK(hints == 0);
    };
    check_on(serial{});
    check_on(openmp{3});
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
