// SPDX-License-Identifier: MIT
//
// What queries hold beside their input and their result is bounded, also where no pair is decided by the first try; and
// where memory ends in the middle of a call, nothing is lost. Here all memory of the program is counted, and the n-th
// request may fail.

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/front.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"

namespace {

std::atomic<long> held{0}, most{0};
std::atomic<long> requests_left{-1};  // 0: the next one fails, once; less: none does

void may_fail() {
    if (requests_left >= 0 && requests_left-- == 0) throw std::bad_alloc();
}

void* counted(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    const long now = held += static_cast<long>(malloc_usable_size(p));
    for (long before = most; before < now && !most.compare_exchange_weak(before, now);) {
    }
    return p;
}
void give_back(void* p) noexcept {
    if (p != nullptr) held -= static_cast<long>(malloc_usable_size(p));
    std::free(p);
}

}  // namespace

void* operator new(std::size_t n) {
    may_fail();
    return counted(std::malloc(n == 0 ? 1 : n));
}
void* operator new(std::size_t n, std::align_val_t align) {
    may_fail();
    const auto a = static_cast<std::size_t>(align);
    return counted(std::aligned_alloc(a, (n + a) / a * a));
}
// The sanitizers have one of their own, which would not be given back by what follows.
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
    try {
        return operator new(n);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t) noexcept { give_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { give_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { give_back(p); }

namespace abut::test {

struct count_visits {
    std::uint64_t* visits;
    visit operator()(index_pair) const {
        execution::atomic_add(visits, std::uint64_t{1});
        return visit::proceed;
    }
};

/// Bytes that `work` holds at most.
template <class Work>
long bytes_of(const Work& work) {
    const long before = held;
    most = before;
    work();
    return most - before;
}

template <class X, class Y>
void check_memory(const X& a, const Y& b, std::uint64_t expected) {
    constexpr long limit = 2'000'000;  // a queue of all pairs would take 8 bytes for each
    const auto on_policy = [&](const auto& on) {
        CHECK(bytes_of([&] { CHECK(count(on, a, b) == expected); }) < limit);
        CHECK(bytes_of([&] { CHECK(any(on, a, b)); }) < limit);
        std::uint64_t visits = 0;
        CHECK(bytes_of([&] { for_each_pair(on, a, b, count_visits{&visits}); }) < limit);
        CHECK(visits == expected);
    };
    on_policy(serial{});
    on_policy(openmp{.threads = 2});
}

TEST_CASE("queries: what waits to be decided takes no memory that grows with the number of pairs") {
    const triangle_soup<float> same(std::vector<triangle<float>>(2000, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    check_memory(same, same, 4'000'000);
    check_memory(make_bvh(serial{}, same), make_bvh(serial{}, same), 4'000'000);
    const auto flat = coplanar_triangles<float>(1000);
    const std::uint64_t expected = count<exact>(serial{}, flat, flat);
    CHECK(expected > 500'000);
    check_memory(flat, flat, expected);
    check_memory(make_bvh(serial{}, flat), flat, expected);
}

/// Runs `work`, whose answers are equal, with each of its requests for memory failing in turn. Each time it is
/// std::bad_alloc, all memory is given back, and afterwards the work succeeds.
template <class Work>
void check_out_of_memory(const char* what, const Work& work) {
    const auto expected = work();
    (void)work();  // threads keep some memory from the first call on
    long failures = 0, other_errors = 0, leaks = 0, wrong = 0;
    for (long n = 0;; n += 1 + n / 64) {
        const long before = held;
        bool failed = false;
        requests_left = n;
        try {
            wrong += work() != expected;
        } catch (const std::bad_alloc&) {
            failed = true;
        } catch (...) {
            ++other_errors;
        }
        const bool was_used_up = requests_left.exchange(-1) < 0;
        leaks += held != before;
        failures += failed;
        // An exception in the last request means that no later one is made.
        if (!was_used_up || n > 100'000) break;
        if (failed && n % 7 == 0) wrong += work() != expected;
    }
    INFO(what << ": " << failures << " requests");
    CHECK(failures > 0);
    CHECK(other_errors == 0);
    CHECK(leaks == 0);
    CHECK(wrong == 0);
    CHECK(work() == expected);
}

template <class Policy>
void check_calls_out_of_memory(const Policy& on) {
    uniform random(20270101);
    const triangle_soup<float> soup(random_triangles<float>(300, random)), other(random_triangles<float>(300, random));
    const spheres<float> balls(random_spheres<float>(300, random));
    std::vector<vec3<float>> places;
    for (int i = 0; i < 200; ++i) places.push_back(random.point<float>(-1, 1));
    const points<float> some(places);
    const torus<float> surface(6, 4, 1, 0.4);
    const mesh<float> ring(surface.vertices, surface.faces);
    const auto tree = make_bvh(on, soup), other_tree = make_bvh(on, other);
    const auto ring_tree = make_bvh(on, ring);
    const auto ball_tree = make_bvh(on, balls);
    const rigid<float> aside{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.1f, 0, 0}};
    const rigid<float> far{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {3, 0.5f, 0.25f}};
    std::vector<ray<float>> lines;
    for (const auto& p : places) lines.push_back({p, {0.25f, 0.5f, 1}});
    const rays<float> rays(lines);
    const auto grid = make_grid(on, soup);

    const auto built = [&](const auto& make) {
        return [&on, make, &other_tree] { return to_host(pairs(on, make(), other_tree)).size(); };
    };
    check_out_of_memory("soup", [&] { return triangle_soup<float>(random_triangles<float>(50, random)).size(); });
    check_out_of_memory("linear", built([&] { return make_bvh(on, soup); }));
    check_out_of_memory("ploc", built([&] { return make_bvh(on, soup, {.builder = bvh_builder::ploc}); }));
    check_out_of_memory("mean_split", built([&] { return make_bvh(on, soup, {.builder = bvh_builder::mean_split}); }));
    check_out_of_memory("sah", built([&] { return make_bvh(on, soup, {.builder = bvh_builder::sah}); }));
    check_out_of_memory("grid", built([&] { return make_grid(on, soup); }));
    check_out_of_memory("quantised", built([&] { return quantised(on, make_bvh(on, soup)); }));
    check_out_of_memory("leafless", built([&] { return leafless(on, make_bvh(on, soup)); }));
    check_out_of_memory("wide", built([&] { return wide(on, make_bvh(on, soup)); }));
    check_out_of_memory("refit", built([&] { return refit(on, make_bvh(on, soup), soup); }));

    check_out_of_memory("any", [&] { return any(on, tree, other_tree); });
    check_out_of_memory("count", [&] { return count(on, soup, other); });
    check_out_of_memory("pairs of trees", [&] { return to_host(pairs(on, tree, other_tree)); });
    check_out_of_memory("pairs of a tree and balls", [&] { return to_host(pairs(on, tree, balls)); });
    check_out_of_memory("pairs of a grid and balls", [&] { return to_host(pairs(on, grid, balls)); });
    check_out_of_memory("breadth_first", [&] {
        return to_host(pairs(on, tree, other_tree, query_options<keep_all, traversal::breadth_first>{}));
    });
    check_out_of_memory("a front", [&] {
        front kept;
        using options = query_options<keep_all, traversal::from_front>;
        const auto first = count(on, tree, other_tree, options{.front = &kept});
        return first + count(on, tree, other_tree, options{.front = &kept});
    });
    check_out_of_memory("for_each_pair", [&] {
        std::uint64_t visits = 0;
        for_each_pair(on, tree, other_tree, count_visits{&visits});
        return visits;
    });
    check_out_of_memory("contacts", [&] { return to_host(contacts(on, tree, other_tree)); });
    check_out_of_memory("reduce_contacts",
                        [&] { return to_host(reduce_contacts(on, contacts(on, tree, other_tree))).size(); });
    check_out_of_memory("self_pairs", [&] { return to_host(self_pairs(on, ring_tree)); });
    check_out_of_memory("a list", [&] {
        using entry = posed_pair<decltype(make_bvh(on, soup)), decltype(make_bvh(on, soup))>;
        return to_host(pairs(on, std::vector<entry>(5, entry{posed(tree, {}), posed(other_tree, {})})));
    });
    check_out_of_memory("bodies", [&] {
        const std::vector<posed_object<decltype(make_bvh(on, ring))>> bodies{posed(ring_tree, {}), posed(ring_tree, aside)};
        return count(on, bodies);
    });
    check_out_of_memory("nearest", [&] { return to_host(nearest(on, tree, some)).size(); });
    check_out_of_memory("the three nearest", [&] { return to_host(nearest(on, tree, some, 3)); });
    check_out_of_memory("distance", [&] { return distance(on, ring_tree, ball_tree)->distance; });
    check_out_of_memory("distance of oriented trees", [&] {
        return distance(on, oriented(on, ring_tree), posed(oriented(on, ring_tree), far))->distance;
    });
    check_out_of_memory("within", [&] { return to_host(within(on, tree, other_tree, 0.1)); });
    check_out_of_memory("raycast", [&] { return to_host(raycast(on, ring_tree, rays)); });
    check_out_of_memory("raycast_any", [&] { return to_host(raycast_any(on, ring_tree, rays)); });
    check_out_of_memory("raycast_all", [&] { return to_host(raycast_all(on, ring_tree, rays)).size(); });
    check_out_of_memory("inside", [&] { return to_host(inside(on, ring_tree, some)); });
    check_out_of_memory("signed_distance", [&] { return to_host(signed_distance(on, ring_tree, some)); });
    check_out_of_memory("winding_number", [&] { return to_host(winding_number(on, ring_tree, some)); });
    check_out_of_memory("hulls", [&] {
        const hulls<float> parts(places, std::vector<std::uint32_t>{0, 40, 80, 120, 200});
        return to_host(pairs(on, make_bvh(on, parts), tree));
    });
    check_out_of_memory("validate", [&] { return validate(on, ring).edges; });
    check_out_of_memory("edges", [&] { return edges(on, ring).size(); });
    auto moved = surface.vertices;
    for (auto& v : moved) v.x = -v.x;
    const auto step = moving(ring, ring.with_vertices(on, moved));
    check_out_of_memory("self_impacts", [&] { return to_host(self_impacts(on, step)).size(); });
    check_out_of_memory("first_self_impact", [&] { return first_self_impact(on, step).has_value(); });
    check_out_of_memory("make_impact_index", [&] { return to_host(self_impacts(on, make_impact_index(on, step))).size(); });
}

TEST_CASE("memory: a call that runs out of it throws std::bad_alloc, gives all back, and leaves the library usable") {
    SECTION("serial") { check_calls_out_of_memory(serial{}); }
    SECTION("openmp") { check_calls_out_of_memory(openmp{.threads = 2}); }
}

}  // namespace abut::test
