// SPDX-License-Identifier: MIT
//
// What queries hold beside their input and their result is bounded, also where no pair is decided by the first try. Here all
// memory of the program is counted.

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include <abut/abut.hpp>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"

namespace {

std::atomic<long> held{0}, most{0};

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

void* operator new(std::size_t n) { return counted(std::malloc(n == 0 ? 1 : n)); }
void* operator new(std::size_t n, std::align_val_t align) {
    const auto a = static_cast<std::size_t>(align);
    return counted(std::aligned_alloc(a, (n + a) / a * a));
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

}  // namespace abut::test
