// SPDX-License-Identifier: MIT
#include <abut/execution/generic.hpp>

#include <vector>

#include <abut/abut.hpp>

#include "execution/verb_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

// Policies outside of the library.
namespace elsewhere {

/// Supplies what a policy in host memory has to, and no more: the two loops, from the last index to the first.
struct backwards : execution::policy_base {
    using memory_space = host_space;
};

template <class F>
void for_each_index(const backwards&, std::size_t n, const F& f) {
    for (std::size_t i = n; i-- > 0;) f(i);
}
template <class F, class Queue, class... Queues>
void for_each_index(const backwards& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    const auto loop = [&](execution::sink_of<Queue> sink, execution::sink_of<Queues>... sinks) {
        for (std::size_t i = n; i-- > 0 && !execution::is_over(sink, sinks...);) f(i, sink, sinks...);
        const auto merge = [&](auto& to, auto& from) {
            std::vector<std::remove_reference_t<decltype(from)>*> all{&from};
            to.merge(on, all);
        };
        merge(queue, sink);
        (merge(queues, sinks), ...);
    };
    loop(queue.make_sink(), queues.make_sink()...);
}

/// Threads of one's own: for_each_range and concurrency alone. Here they are OpenMP's.
struct ranges : execution::policy_base {
    using memory_space = host_space;
};
inline int concurrency(const ranges&) { return 2; }
template <class F>
void for_each_range(const ranges&, std::size_t n, std::size_t grain, const F& f) {
    execution::for_each_range(openmp{.threads = 2}, n, grain, f);
}

/// What used to pass for a policy.
struct stub {
    using memory_space = host_space;
};
inline void synchronize(const stub&) {}
inline void release_memory(const stub&) {}

/// Has one loop of two.
struct half : execution::policy_base {
    using memory_space = host_space;
};
template <class F>
void for_each_index(const half&, std::size_t, const F&) {}

/// Works on a device, and supplies nothing of its memory.
struct far : execution::policy_base {
    using memory_space = device_space;
};
template <class F, class... Queues>
void for_each_index(const far&, std::size_t, const F&, Queues&...) {}

}  // namespace elsewhere

static_assert(execution_policy<elsewhere::backwards>);
static_assert(execution_policy<elsewhere::ranges>);
static_assert(execution::range_policy<elsewhere::ranges> && !execution::range_policy<elsewhere::backwards>);
static_assert(!execution_policy<elsewhere::stub>);
static_assert(!execution::has_verbs<elsewhere::half>);
static_assert(!execution::has_verbs<elsewhere::far>);
static_assert(!execution_policy<int>);
static_assert(!execution_policy<mesh<float>>);  // has a memory_space

// --- roles: the least that plays each, and what lacks one thing
// -------------------------------------------------------------

namespace {

namespace least = execution::archetype;
using count_sink = execution::sink_of<execution::work_count<host_space>>;
using flag_sink = execution::sink_of<execution::work_flag<host_space>>;
using queue_sink = execution::sink_of<execution::work_queue<unsigned, host_space>>;
struct yes {
    bool operator()(unsigned) const { return true; }
};
using visit_sink = execution::sink_of<execution::work_visit<yes, host_space>>;

static_assert(execution::value_sink<queue_sink, unsigned> && execution::value_sink<visit_sink, unsigned>);
static_assert(!execution::value_sink<count_sink, unsigned> && !execution::value_sink<queue_sink, std::vector<int>>);
static_assert(execution::sum_sink<count_sink> && !execution::sum_sink<queue_sink>);
static_assert(execution::is_flag<flag_sink> && !execution::is_flag<visit_sink>);
static_assert(execution::may_stop<flag_sink> && execution::may_stop<visit_sink> && !execution::may_stop<queue_sink>);
static_assert(execution::loop_queue<execution::work_count<host_space>> && !execution::loop_queue<int>);

struct counts {
    void operator()(std::size_t, count_sink& count) const { count.add(1); }
};
static_assert(execution::index_functor<least::functor> && execution::index_functor<least::functor, queue_sink, flag_sink>);
static_assert(execution::index_functor<counts, count_sink> && !execution::index_functor<counts>);
static_assert(!execution::index_functor<counts, flag_sink> && !execution::index_functor<yes, flag_sink>);
struct changes {
    void operator()(std::size_t) {}
};
static_assert(!execution::index_functor<changes>);  // functors are called through a const object

static_assert(execution::index_test<least::test> && !execution::index_test<least::functor>);
static_assert(execution::index_value<least::value, unsigned> && !execution::index_value<least::functor, unsigned>);
static_assert(execution::combiner<least::combine, unsigned> && !execution::combiner<least::combine, std::vector<int>>);

struct not_of_groups {
    struct shared {};
    void operator()(std::size_t) const {}
};
static_assert(execution::group_functor<least::group_functor> && !execution::group_functor<not_of_groups>);
static_assert(!execution::group_functor<least::functor>);  // names no shared memory

struct no_cursor {
    using candidate = unsigned;
    bool may_find(std::size_t) const;
    bool operator()(std::size_t, int&, const auto&, auto&...) const;
};
struct no_may_find {
    using candidate = unsigned;
    struct cursor {};
    bool operator()(std::size_t, cursor&, const auto&, auto&...) const;
};
struct never_rests {
    using candidate = unsigned;
    struct cursor {};
    bool may_find(std::size_t) const;
    void operator()(std::size_t, cursor&, const auto&, auto&...) const;
};
static_assert(execution::candidate_walk<least::walk> && execution::candidate_walk<least::walk, count_sink, flag_sink>);
static_assert(!execution::candidate_walk<no_cursor> && !execution::candidate_walk<no_may_find>);
static_assert(!execution::candidate_walk<never_rests>);

struct no_finish {
    bool operator()(unsigned, auto&...) const;
};
struct undecided {
    void operator()(unsigned, auto&...) const;
    void finish(unsigned, auto&...) const;
};
static_assert(execution::candidate_judge<least::judge, unsigned> &&
              execution::candidate_judge<least::judge, unsigned, flag_sink>);
static_assert(!execution::candidate_judge<least::judge, std::vector<int>>);
static_assert(!execution::candidate_judge<no_finish, unsigned> && !execution::candidate_judge<undecided, unsigned>);

struct bottomless {
    using item = unsigned;
    using candidate = unsigned;
    static constexpr unsigned most_children = 1;
    std::size_t seeds() const;
    item seed(std::size_t) const;
    void prefetch(item) const;
    void operator()(item, auto&) const;
};
static_assert(execution::expander<least::expander> && !execution::expander<bottomless> && !execution::expander<least::walk>);

struct no_reach : least::tile {
    void reach_of(row) const;
};
static_assert(execution::tile_functor<least::tile> && execution::tile_functor<least::tile, queue_sink>);
static_assert(!execution::tile_functor<no_reach> && !execution::tile_functor<least::walk>);

}  // namespace

// --- policies that supply little
// ----------------------------------------------------------------------------------------------

TEST_CASE("verbs: all defaults, of a policy that supplies two loops") { test::check_verbs(elsewhere::backwards{}); }

TEST_CASE("verbs: loops over ranges, of a policy that supplies ranges") {
    test::check_loops(elsewhere::ranges{});
    test::check_reductions(elsewhere::ranges{});
}

TEST_CASE("queries: a policy from elsewhere answers as serial does") {
    const elsewhere::backwards on;
    test::uniform random(5);
    const triangle_soup<float> soup(test::random_triangles<float>(2'000, random));
    const spheres<float> balls(test::random_spheres<float>(1'000, random));
    const auto expected = to_host(pairs(serial{}, soup, balls));
    CHECK(expected.size() > 100);
    const auto tree = make_bvh(on, soup);
    const auto other = make_bvh(on, balls);
    CHECK(to_host(pairs(on, soup, balls)) == expected);
    CHECK(to_host(pairs(on, tree, balls)) == expected);
    CHECK(to_host(pairs(on, make_grid(on, soup), balls)) == expected);
    CHECK(to_host(pairs(on, tree, other)) == expected);
    CHECK(to_host(pairs(on, refit(on, tree, soup), other)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, soup, {.builder = bvh_builder::sah}), other)) == expected);
    CHECK(count(on, tree, other) == expected.size());
    CHECK(any(on, tree, other));
    const spheres<float> away({{{100, 100, 100}, 1}, {{101, 100, 100}, 1}});
    CHECK_FALSE(any(on, tree, make_bvh(on, away)));
}
