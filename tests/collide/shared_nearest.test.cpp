// SPDX-License-Identifier: MIT
//
// What a device does for `distance` (collide/shared_nearest.hpp), by the verbs of a host: the same pair as a host's own way finds, also
// where more pairs are equally near than are kept. A device is asked in tests/cuda/distance.cu.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// Of two trees, with so much room for pairs.
template <class Policy, class X, class Y>
execution::least_value shared_way(const Policy& on, const X& x, const Y& y, double bound, std::size_t room) {
    using namespace detail;
    using T = float;
    const auto pairing = pair_up(on, x, y, query_options<before_first_touch<pair_key>>{}, "test");
    using walk = ordered_pair_walk<decltype(pairing.a.tree()), decltype(pairing.b.tree())>;
    const auto at_a = placement_of(pairing.a), at_b = placement_of(pairing.b);
    const near_posed_boxes<T> reach(at_a.pose, at_a.around, at_b.pose, at_b.around);
    const walk both{pairing.a.tree(), pairing.b.tree()};
    const auto view = pairing.view();
    using trees = two_trees<walk, near_posed_boxes<T>, std::remove_const_t<decltype(view)>, whole_search>;
    const trees first{both, reach, view, seeds_below<walk>(both, 4), {}}, all{both, reach, view, seeds_below<walk>(both, 5), {}};
    return shared_nearest<Policy>(on, 1, bound, first, all, room).of_one();
}

/// The same by the host's own way.
template <class Policy, class X, class Y>
execution::least_value own_way(const Policy& on, const X& x, const Y& y, double bound) {
    using namespace detail;
    const auto pairing = pair_up(on, x, y, query_options<before_first_touch<pair_key>>{}, "test");
    return nearest_pair(on, pairing, bound);
}

template <class X, class Y>
int check_both_ways(const X& x, const Y& y, double bound = none) {
    const execution::least_value expected = own_way(serial{}, x, y, bound);
    for (const std::size_t room : {std::size_t{1} << 16, std::size_t{1}}) {
        CAPTURE(room, expected.value, expected.key);
        CHECK(shared_way(serial{}, x, y, bound, room) == (expected.value <= bound ? expected : execution::least_value{}));
        CHECK(shared_way(openmp{3}, x, y, bound, room) == (expected.value <= bound ? expected : execution::least_value{}));
    }
    return expected.key != detail::no_pair;
}

/// Of a slot.
execution::least_value of(const detail::shared_nearest<serial>& all, std::size_t slot) {
    if (all.keys()[slot] == detail::no_pair) return {};
    return {std::bit_cast<double>(all.least()[slot]), all.keys()[slot]};
}

rigid<float> aside(float x, float y = 0.25f) { return {{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {x, y, 0.125f}}; }

}  // namespace

TEST_CASE("shared nearest: two trees, of every layout of two children") {
    const serial on;
    const test::torus<float> ring(24, 12, 2, 0.5f), small(15, 10, 1.5f, 0.75f);
    const mesh<float> a(ring.vertices, ring.faces), b(small.vertices, small.faces);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b, {.builder = bvh_builder::sah});
    int found = 0;
    for (const float away : {4.9f, 5.0f, 5.5f, 9.0f, 1e6f}) {
        found += check_both_ways(tree_a, posed(tree_b, aside(away)));
        found += check_both_ways(posed(tree_a, aside(-0.5f)), posed(tree_b, aside(away, -3)));
        check_both_ways(oriented(on, tree_a), posed(oriented(on, tree_b), aside(away)));
        check_both_ways(quantised(on, tree_a), posed(tree_b, aside(away)));
    }
    CHECK(found == 10);
    const double distance = own_way(on, tree_a, posed(tree_b, aside(5)), none).value;
    CHECK(check_both_ways(tree_a, posed(tree_b, aside(5)), distance) == 1);
    check_both_ways(tree_a, posed(tree_b, aside(5)), std::nextafter(distance, 0.0));
    check_both_ways(tree_a, posed(tree_b, aside(5)), 0.5 * distance);
}

TEST_CASE("shared nearest: many pairs are equally near") {
    const serial on;
    const points<float> many(std::vector<vec3<float>>(300, {1, 2, 3})), others(std::vector<vec3<float>>(200, {1, 2, 8}));
    CHECK(shared_way(on, make_bvh(on, many), make_bvh(on, others), none, 100) == execution::least_value{5, 0});
    std::vector<vec3<float>> corners;
    std::vector<face> faces;
    for (std::uint32_t i = 0; i < 12; ++i) {
        for (std::uint32_t j = 0; j < 12; ++j) corners.push_back({static_cast<float>(i), static_cast<float>(j), 0});
    }
    for (std::uint32_t i = 0; i + 1 < 12; ++i) {
        for (std::uint32_t j = 0; j + 1 < 12; ++j) {
            faces.push_back({12 * i + j, 12 * i + j + 1, 12 * i + j + 12});
            faces.push_back({12 * i + j + 1, 12 * i + j + 13, 12 * i + j + 12});
        }
    }
    const mesh<float> plate(corners, faces);
    const rigid<float> above{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.5f, 0.5f, 2}};
    CHECK(check_both_ways(make_bvh(on, plate), posed(make_bvh(on, plate), above)) == 1);
}

TEST_CASE("shared nearest: the trees of a list, of each entry and of all") {
    const serial on;
    const test::torus<float> ring(24, 12, 2, 0.5f), small(15, 10, 1.5f, 0.75f);
    const auto a = make_bvh(on, mesh<float>(ring.vertices, ring.faces)), b = make_bvh(on, mesh<float>(small.vertices, small.faces));
    const auto one = make_bvh(on, mesh<float>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    using index = std::remove_const_t<decltype(a)>;
    std::vector<posed_pair<index>> list;
    for (int k = 0; k < 40; ++k) list.push_back({posed(a, aside(-0.25f)), posed(b, aside(3 + 0.25f * static_cast<float>(k)))});
    list.push_back({posed(one, aside(2)), posed(b, aside(9))});  // has no nodes: passed over
    auto pairing = detail::pair_up(on, list, list_options<detail::before_first_touch<detail::list_key>>{}, "test", {});
    const auto touches = detail::first_touches(on, pairing, list.size());
    const auto expected = to_host(distance(on, list));
    for (const std::size_t room : {std::size_t{1} << 16, std::size_t{1}}) {
        CAPTURE(room);
        const auto each = detail::nearest_in_trees(on, pairing, touches.data(), none, false, room);
        execution::least_value least;
        int apart = 0;
        for (std::size_t k = 0; k + 1 < list.size(); ++k) {
            CAPTURE(k);
            const execution::least_value found = of(each, k);
            CHECK((found.key == detail::no_pair) == (expected[k].distance == 0));
            if (found.key == detail::no_pair) continue;
            ++apart;
            const detail::entry_pair at = pairing.key.unpack(found.key);
            CHECK(at.entry == k);
            CHECK((at.a == expected[k].a && at.b == expected[k].b));
            CHECK(static_cast<float>(found.value) == expected[k].distance);
            least.offer(found.value, found.key);
        }
        CHECK(apart > 20);
        CHECK(apart < 40);
        CHECK(of(each, list.size() - 1) == execution::least_value{});
        CHECK(detail::nearest_in_trees(on, pairing, touches.data(), none, true, room).of_one() == least);
        CHECK(detail::nearest_in_trees(on, pairing, touches.data(), 0.5 * least.value, true, room).of_one() == execution::least_value{});
    }
}
