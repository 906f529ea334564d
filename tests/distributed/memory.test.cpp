// SPDX-License-Identifier: MIT
//
// Where one rank runs out of memory in the middle of a call, all ranks throw, none waits, and the next call is right. Here
// each request for memory of one rank fails in turn.

#include <atomic>
#include <cstdlib>
#include <new>
#include <optional>
#include <random>
#include <vector>

#include <abut/mpi.hpp>

#include "distributed/world.hpp"

namespace {

std::atomic<long> requests_left{-1};  // 0: the next one fails, once; less: none does

// Not inlined: g++ 12 would take free for a mistake in operator delete.
[[gnu::noinline]] void* requested(std::size_t n, std::size_t align) {
    if (requests_left >= 0 && requests_left-- == 0) throw std::bad_alloc();
    void* const p = align > 0 ? std::aligned_alloc(align, (n + align) / align * align) : std::malloc(n == 0 ? 1 : n);
    if (p == nullptr) throw std::bad_alloc();
    return p;
}
[[gnu::noinline]] void given_back(void* p) noexcept { std::free(p); }

}  // namespace

void* operator new(std::size_t n) { return requested(n, 0); }
void* operator new(std::size_t n, std::align_val_t align) { return requested(n, static_cast<std::size_t>(align)); }
// The sanitizers have one of their own, which would not be given back by what follows.
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
    try {
        return operator new(n);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* p) noexcept { given_back(p); }
void operator delete(void* p, std::size_t) noexcept { given_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { given_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { given_back(p); }

namespace abut::test {

namespace {

/// Fails each request of `bad` in turn until the call succeeds. Returns how many failed.
template <class Call>
long fail_each_request(const distributed<serial>& on, int bad, const Call& call) {
    for (long k = 0;; ++k) {
        int outcome =
            0;  // what the call threw: 0 nothing, 1 bad_alloc, 2 distributed_error of the bad rank, 3 anything else
        if (on.rank() == bad) requests_left = k;
        try {
            call();
        } catch (const std::bad_alloc&) {
            outcome = 1;
        } catch (const distributed_error& e) {
            outcome = e.rank() == bad ? 2 : 3;
        } catch (...) {
            outcome = 3;
        }
        requests_left = -1;
        if (on_all(on.ranks(), outcome == 0)) return k;
        const bool as_expected = outcome == (on.rank() == bad ? 1 : 2);
        if (!on_all(on.ranks(), as_expected)) return -1;
    }
}

}  // namespace

TEST_CASE("distributed: memory that ends on one rank") {
    const distributed on(world(), serial{});
    std::mt19937 random(21);
    std::uniform_real_distribution<float> place(0, 3);
    std::vector<vec3<float>> vertices, moved;
    std::vector<face> faces;
    std::vector<sphere<float>> balls;
    std::vector<std::vector<vec3<float>>> lists;
    for (std::uint32_t i = 0; i < 60; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        for (const vec3<float>& v :
             {vec3<float>{x, y, z}, vec3<float>{x + 0.5f, y, z}, vec3<float>{x, y + 0.5f, z + 0.5f}}) {
            vertices.push_back(v);
            moved.push_back({v.x + 1, v.y, v.z});
        }
        faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        balls.push_back({{z, x, y}, 0.3f});
        lists.push_back(std::vector<vec3<float>>(i % 5 + 1, {y, z, x}));
        lists.back().front().x += 0.5f;
    }
    const mesh<float> mine(vertices, part_of(faces, division::even, on.rank(), on.size()));
    const spheres<float> my_balls(part_of(balls, division::even, on.rank(), on.size()));
    const hulls<float> my_hulls(part_of(lists, division::even, on.rank(), on.size()));
    const auto step = moving(mine, mine.with_vertices(serial{}, moved));
    std::vector<vec3<float>> points;
    for (const auto& ball : part_of(balls, division::even, on.rank(), on.size())) points.push_back(ball.center);

    std::vector<ray<float>> lines;
    for (const vec3<float>& p : points) lines.push_back({p, {0, 0, 1}});
    const rays<float> up(lines);
    const sphere<float> ball_far_away{{9, 9, 9}, 1};

    const auto tree = make_bvh(serial{}, mine);
    const auto tree_of_balls = make_bvh(serial{}, my_balls);
    using tree_type = std::remove_const_t<decltype(tree)>;
    const std::vector list(2, posed_pair<tree_type>{posed(tree, rigid<float>{}), posed(tree, rigid<float>{})});
    for (const int bad : {0, on.size() - 1}) {
        CAPTURE(bad);
        const auto check = [&](const auto& call) {
            const auto list_of = [](const auto& found) {
                if constexpr (requires { found.to_host(); }) {
                    return found.to_host();
                } else {
                    return found;
                }
            };
            const auto expected = list_of(call());
            std::optional<decltype(call())> found;
            CHECK(fail_each_request(on, bad, [&] { found.emplace(call()); }) > 5);
            CHECK(on_all(on.ranks(), found.has_value() && list_of(*found) == expected));
        };
        check([&] { return count(on, mine, my_balls); });
        check([&] { return pairs(on, mine, tree_of_balls); });
        check([&] { return contacts(on, tree, my_balls); });
        check([&] { return nearest(on, tree, points); });
        check([&] { return nearest(on, tree, points, 3); });
        check([&] { return inside(on, tree, points, {.known_closed = true}); });
        check([&] { return raycast(on, tree, up); });
        check([&] { return raycast_all(on, tree, up); });
        check([&] { return within(on, tree, tree_of_balls, 0.25); });
        check([&] { return self_pairs(on, tree); });
        check([&] { return pairs(on, list); });
        check([&] { return distance(on, tree, tree_of_balls); });
        check([&] { return distance(on, tree, ball_far_away); });
        check([&] { return impacts(on, step, mine); });
        check([&] { return redistribute(on, my_balls).ids; });
        check([&] { return pairs(on, mine, my_hulls); });
        check([&] { return redistribute(on, my_hulls).ids; });
    }
}

}  // namespace abut::test
