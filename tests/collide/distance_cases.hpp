// SPDX-License-Identifier: MIT
#pragma once

// What `distance` promises on every policy: 0 exactly where shapes touch, and else the pair with the least distance, as it
// is computed for one pair, and of equal ones the least ids; the same bits whatever the indices, their layouts and the
// poses. The truth is a plain loop over all pairs; that one pair is right is tests/narrow's matter.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <class T>
using maybe_apart = std::optional<separation<T>>;

template <shape_view A, shape_view B>
auto distance_by_definition(const A& a, const B& b) {
    using T = typename A::scalar_type;
    maybe_apart<T> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            const auto s = a[i];
            const auto t = b[j];
            const bool touch = intersects<exact>(s, t);
            const double d = touch ? 0 : detail::measure_apart{}.measure(s, t, std::numeric_limits<double>::infinity());
            if (best && !(d < least)) continue;
            least = d;
            best = detail::separation_of(s, t, touch);
            best->a = i, best->b = j;
        }
    }
    return best;
}

/// What f throws.
template <class F>
std::string message_of(const F& f) {
    try {
        f();
    } catch (const error& e) {
        return e.what();
    }
    return "nothing was thrown";
}

/// What has been asked, for hit rates.
struct distance_counts {
    int asked = 0, touching = 0;
};

template <class T>
void check_same(const maybe_apart<T>& found, const maybe_apart<T>& expected) {
    if (found == expected) {
        SUCCEED();
        return;
    }
    REQUIRE(found.has_value() == expected.has_value());
    CAPTURE(found->a, expected->a, found->b, expected->b, found->distance, expected->distance, found->point_a.x,
            expected->point_a.x, found->point_b.x, expected->point_b.x);
    FAIL_CHECK("another answer than by definition");
}

/// Two sets without an index, and with one on one side and on both.
template <class Policy, class SetA, class SetB>
void check_distance(const Policy& on, const SetA& a, const SetB& b, distance_counts& counts) {
    const auto expected = distance_by_definition(a.view(), b.view());
    counts.asked += 1;
    counts.touching += expected && expected->distance == 0;
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    check_same(distance(on, there_a, there_b), expected);
    check_same(distance(on, make_bvh(on, there_a), there_b), expected);
    check_same(distance(on, make_bvh(on, there_a), make_bvh(on, there_b)), expected);
    CHECK((expected && expected->distance == 0) == any(on, there_a, there_b));
}

/// Shapes in two boxes of side 2 whose middles are so far apart.
template <class A, class B, class Policy>
void check_distance_of(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<A>;
    CAPTURE(seed);
    uniform random(seed);
    distance_counts counts;
    for (const double apart : {0.0, 2.0, 3.0, 30.0}) {
        for (const bool on_lattice : {false, true}) {
            CAPTURE(apart, on_lattice);
            auto shapes_a = shape_maker<A>(random, on_lattice)(30);
            const auto shapes_b = shape_maker<B>(random, on_lattice)(40);
            if constexpr (placeable<A>) {
                for (A& s : shapes_a) s = place(rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {T(apart), 0, 0}}, s);
            }
            check_distance(on, shapes<A>(shapes_a), shapes<B>(shapes_b), counts);
        }
    }
    CHECK(counts.touching > 0);
    if constexpr (placeable<A>) CHECK(counts.touching < counts.asked);
}

template <class T>
std::vector<rigid<T>> poses_of_distances() {
    const double c = 0.6, s = 0.8;
    const rigid<T> turned{{T(c), T(-s), 0, T(s), T(c), 0, 0, 0, 1}, {T(3.5), T(0.25), T(0.5)}};
    std::vector<rigid<T>> all{rigid<T>{}, turned, turned, turned, turned};
    all[2].translation = {T(1.5), 0, 0};  // where they touch
    all[3].rotation[0] *= T(1 + 0x1p-12);
    all[3].rotation[4] *= T(1 - 0x1p-12);
    all[3].rotation[8] *= T(1 - 0x1p-12);
    all[4].translation = {T(1e5), T(1e5), T(-1e5)};
    return all;
}

/// Two meshes, of which the second is posed, and the first where the caller says so.
template <class T, class Policy>
struct two_meshes {
    torus<T> ring{14, 8, 2, T(0.5)}, small{9, 7, T(0.75), T(0.25)};
    mesh<T> a{ring.vertices, ring.faces}, b{small.vertices, small.faces};
    decltype(copy_to(std::declval<const Policy&>(), a)) there_a, there_b;

    explicit two_meshes(const Policy& on) : there_a(copy_to(on, a)), there_b(copy_to(on, b)) {}
    [[nodiscard]] maybe_apart<T> expected(const rigid<T>& pose_a, const rigid<T>& pose_b) const {
        return distance_by_definition(posed_view<mesh_view<T>>{a.view(), pose_a},
                                      posed_view<mesh_view<T>>{b.view(), pose_b});
    }
};

/// Trees and plain sets, under poses.
template <class T, class Policy>
void check_distance_of_meshes(const Policy& on) {
    const two_meshes<T, Policy> of(on);
    const auto tree_a = make_bvh(on, of.there_a), tree_b = make_bvh(on, of.there_b);
    const rigid<T> pose_a{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {T(0.1), T(-0.2), T(0.3)}};
    int touching = 0, asked = 0;
    for (const rigid<T>& pose : poses_of_distances<T>()) {
        CAPTURE(asked);
        const auto expected = of.expected({}, pose);
        touching += expected->distance == 0;
        ++asked;
        check_same(distance(on, tree_a, posed(tree_b, pose)), expected);
        check_same(distance(on, tree_a, posed(of.there_b, pose)), expected);
        check_same(distance(on, posed(tree_a, pose_a), posed(tree_b, pose)), of.expected(pose_a, pose));
    }
    CHECK(touching > 0);
    CHECK(touching < asked);
    check_same(distance(on, of.there_a, of.there_b), of.expected({}, {}));
    check_same(distance(on, tree_a, tree_b), of.expected({}, {}));
}

/// Two parallel sheets far from the origin: nearly all pairs of triangles are as far apart as each other, but for the
/// rounding of placed corners, which alone says which is the nearest.
template <class T, class Policy>
void check_distance_of_sheets(const Policy& on) {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    constexpr std::uint32_t n = 9;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) vertices.push_back({T(i) / 7, T(j) / 7, 0});
    }
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t at = i / n * (n + 1) + i % n;
        faces.push_back({at, at + 1, at + n + 1});
        faces.push_back({at + 1, at + n + 2, at + n + 1});
    }
    const mesh<T> sheet(vertices, faces);
    const auto tree = make_bvh(on, copy_to(on, sheet));
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        draws d(91, 5, static_cast<std::uint64_t>(i));
        rigid<T> a;
        const long double w = d.uniform(-1, 1), x = d.uniform(-1, 1), y = d.uniform(-1, 1), z = d.uniform(-1, 1);
        construction::set_rotation(a, w, x, y, z);
        rigid<T> b = a;
        a.translation = {T(1000), T(-3000), T(2000) + T(i)};
        const vec3<T> up = detail::column(a.rotation, 2);
        b.translation = a.translation + T(2) * up;
        const posed_view<mesh_view<T>> placed_a{sheet.view(), a}, placed_b{sheet.view(), b};
        check_same(distance(on, posed(tree, a), posed(tree, b)), distance_by_definition(placed_a, placed_b));
    }
}

/// Indices of other kinds.
template <class T, class Policy>
void check_distance_by_indices(const Policy& on) {
    const two_meshes<T, Policy> of(on);
    const auto tree_a = make_bvh(on, of.there_a), tree_b = make_bvh(on, of.there_b);
    for (const rigid<T>& pose : poses_of_distances<T>()) {
        const auto expected = of.expected({}, pose);
        check_same(distance(on, of.there_a, posed(tree_b, pose)), expected);
        check_same(distance(on, make_grid(on, of.there_a), posed(of.there_b, pose)), expected);
        check_same(distance(on, of.there_a, posed(make_grid(on, of.there_b), pose)), expected);
        check_same(distance(on, quantised(on, tree_a), posed(leafless(on, tree_b), pose)), expected);
        check_same(distance(on, oriented(on, tree_a), posed(oriented(on, tree_b), pose)), expected);
        check_same(
            distance(on, make_bvh(on, of.there_a, {.builder = bvh_builder::ploc}), posed(make_grid(on, of.there_b), pose)),
            expected);
    }
}

/// One call for many pairs of bodies; among them trees of one shape and of none.
template <class T, class Policy>
void check_distance_of_lists(const Policy& on) {
    uniform random(91);
    const torus<T> ring(10, 6, 2, T(0.5));
    const mesh<T> meshes[] = {{ring.vertices, ring.faces},
                              {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
                              {std::vector<vec3<T>>{}, std::vector<face>{}},
                              {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}}}};
    using tree = decltype(make_bvh(on, copy_to(on, meshes[0])));
    std::vector<tree> trees;
    for (const auto& m : meshes) trees.push_back(make_bvh(on, copy_to(on, m)));
    std::vector<posed_pair<tree>> list;
    std::vector<maybe_apart<T>> expected;
    std::size_t touching = 0;
    for (int i = 0; i < 60; ++i) {
        const std::size_t k = i < 16 ? static_cast<std::size_t>(i) / 4 : 0, l = i < 16 ? static_cast<std::size_t>(i) % 4 : 3;
        rigid<T> pose_a, pose_b{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0}};
        pose_a.translation = random.point<T>(-1, 1);
        pose_b.translation = random.point<T>(-3, 3);
        list.push_back({posed(trees[k], pose_a), posed(trees[l], pose_b)});
        const posed_view<mesh_view<T>> a{meshes[k].view(), pose_a}, b{meshes[l].view(), pose_b};
        expected.push_back(distance_by_definition(a, b));
        touching += expected.back() && expected.back()->distance == 0;
    }
    CHECK(touching > 3);
    CHECK(touching < 50);
    const separation<T> none{no_id, no_id, {0, 0, 0}, {0, 0, 0}, std::numeric_limits<T>::infinity()};
    for (const double below : {std::numeric_limits<double>::infinity(), 1.0, 0.0}) {
        CAPTURE(below);
        const auto found = to_host(distance(on, list, {.below = below}));
        REQUIRE(found.size() == list.size());
        for (std::size_t i = 0; i < list.size(); ++i) {
            CAPTURE(i);
            const bool is = expected[i] && static_cast<double>(expected[i]->distance) < below;
            check_same<T>(found[i], is ? *expected[i] : none);
        }
    }
    for (std::size_t i = 0; i < 24; ++i) check_same(distance(on, list[i].a, list[i].b), expected[i]);
    CHECK(distance(on, std::vector<posed_pair<tree>>{}).empty());
    list[3].a.pose.rotation[0] = 2;
    CHECK(message_of([&] { (void)distance(on, list); }).rfind("abut::distance: entry 3 of the list: rotation row 0", 0) ==
          0);
}

template <class T, class Policy>
void check_distance_below(const Policy& on) {
    using limits = std::numeric_limits<T>;
    const torus<T> ring(10, 6, 2, T(0.5));
    const auto tree = make_bvh(on, copy_to(on, mesh<T>(ring.vertices, ring.faces)));
    for (const T away : {T(0.1), T(7), T(1000) / 3}) {
        const auto other = posed(tree, rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {T(5) + away, T(0.25), 0}});
        const auto found = distance(on, tree, other);
        REQUIRE(found);
        REQUIRE(found->distance > 0);
        const auto d = static_cast<double>(found->distance);
        check_same<T>(distance(on, tree, other, {.below = d}), {});
        check_same(distance(on, tree, other, {.below = std::nextafter(d, 2 * d)}), found);
        check_same(distance(on, tree, other, {.below = 2 * d}), found);
        check_same<T>(distance(on, tree, other, {.below = d / 2}), {});
        check_same<T>(distance(on, tree, other, {.below = 0}), {});
        check_same<T>(distance(on, tree, tree, {.below = 0}), {});
        CHECK(distance(on, tree, tree, {.below = static_cast<double>(limits::denorm_min())})->distance == 0);
        CHECK(message_of([&] { (void)distance(on, tree, other, {.below = limits::quiet_NaN()}); }) ==
              "abut::distance: below is NaN; expected a distance");
        CHECK(message_of([&] { (void)distance(on, tree, other, {.below = -1}); }) ==
              "abut::distance: below is -1; expected a distance, 0 or more");
    }
}

/// Empty sets, single shapes, copies, and what is refused.
template <class T, class Policy>
void check_distance_by_hand(const Policy& on) {
    using limits = std::numeric_limits<T>;
    const triangle<T> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, over{{1, 1, 3}, {2, 1, 3}, {1, 2, 4}};
    const auto none = copy_to(on, triangle_soup<T>()), one = copy_to(on, triangle_soup<T>({t}));
    CHECK_FALSE(distance(on, none, one));
    CHECK_FALSE(distance(on, make_bvh(on, none), make_bvh(on, one)));
    CHECK_FALSE(distance(on, make_bvh(on, one), none));
    CHECK(distance(on, t, over)->distance == 3);
    CHECK(distance(on, make_bvh(on, one), over) == distance(on, one, over));
    check_same<T>(distance(on, make_bvh(on, one), make_bvh(on, one)),
                  separation<T>{0, 0, distance(t, t).point_a, distance(t, t).point_a, 0});
    // Of copies the first, apart and touching.
    const auto copies = make_bvh(on, copy_to(on, triangle_soup<T>(std::vector<triangle<T>>(300, t))));
    const auto up = make_bvh(on, copy_to(on, triangle_soup<T>(std::vector<triangle<T>>(300, over))));
    for (const auto& found : {distance(on, copies, up), distance(on, copies, copies)}) {
        REQUIRE(found);
        CHECK((found->a == 0 && found->b == 0));
    }
    // The least distance that there is is none of 0.
    const T least = limits::denorm_min();
    const triangle<T> hair{{0, 0, least}, {4, 0, least}, {0, 4, least}};
    CHECK(distance(on, make_bvh(on, one), hair)->distance == least);
    const triangle<T> bad{{0, 0, 0}, {1, limits::quiet_NaN(), 0}, {0, 1, 0}};
    CHECK_THROWS_AS(distance(on, one, bad), invalid_geometry);
}

/// From the least numbers to the largest; and all in one scene.
template <class T, class Policy>
void check_distance_scales(const Policy& on) {
    uniform random(92);
    const auto some = random_triangles<T>(25, random), others = random_triangles<T>(20, random);
    const int most = std::numeric_limits<T>::max_exponent - 9, least = std::numeric_limits<T>::min_exponent - 8;
    std::vector<triangle<T>> mixed, mixed_others;
    distance_counts counts;
    for (const int e : {most, least, most / 2, least / 2, most / 4 + 2, 40, -40}) {
        CAPTURE(e);
        const T s = std::ldexp(T(1), e);
        const auto scaled = [&](const std::vector<triangle<T>>& from, T away) {
            std::vector<triangle<T>> to;
            const vec3<T> by{s * away, 0, 0};
            for (const triangle<T>& t : from) to.push_back({s * t.a + by, s * t.b + by, s * t.c + by});
            return to;
        };
        for (const T away : {T(0), T(3)}) {
            const auto a = scaled(some, 0);
            auto b = scaled(others, away);
            if (away == 0) b.push_back(a[7]);
            check_distance(on, triangle_soup<T>(a), triangle_soup<T>(b), counts);
            mixed.insert(mixed.end(), a.begin(), a.begin() + 5);
            if (away > 0) mixed_others.insert(mixed_others.end(), b.begin(), b.begin() + 5);
        }
    }
    check_distance(on, triangle_soup<T>(mixed), triangle_soup<T>(mixed_others), counts);
    CHECK(counts.touching > 2);
    CHECK(counts.touching < counts.asked - 2);
}

/// Where much touches, the least ids of all pairs that do, of trees that keep them and of those that do
/// not, of trees made of others, and in lists. Ids lie anywhere along the surfaces.
template <class T, bool EveryLayout = false, class Policy>
void check_first_of_many_touches(const Policy& on) {
    uniform random(96);
    torus<T> ring(40, 24, 2, T(0.5)), small(30, 20, T(1.5), T(0.75));
    for (auto* faces : {&ring.faces, &small.faces}) {
        for (std::size_t i = faces->size() - 1; i > 0; --i) {
            std::swap((*faces)[i], (*faces)[static_cast<std::size_t>(random(0, 1) * static_cast<double>(i))]);
        }
    }
    const mesh<T> host_a(ring.vertices, ring.faces), host_b(small.vertices, small.faces);
    const auto a = copy_to(on, host_a), b = copy_to(on, host_b);
    std::vector<rigid<T>> poses(4, rigid<T>{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0}});
    poses[1].translation = {T(1.5), T(0.25), T(0.125)};
    poses[2].translation = {T(3.25), 0, T(0.5)};
    poses[3].translation = {9, 0, 0};
    std::vector<index_pair> expected;
    for (const rigid<T>& pose : poses) {
        const auto all = to_host(pairs(serial{}, make_bvh(serial{}, host_a), posed(make_bvh(serial{}, host_b), pose)));
        expected.push_back(all.empty() ? index_pair{no_id, no_id} : *all.begin());
    }
    CHECK(expected[1] != expected[2]);
    CHECK(expected[3].a == no_id);
    const auto check = [&](const auto& tree_a, const auto& tree_b) {
        for (const std::size_t k : {3u, 0u, 1u, 2u, 0u, 3u}) {
            CAPTURE(k);
            const auto found = distance(on, tree_a, posed(tree_b, poses[k]));
            REQUIRE(found);
            CHECK((found->distance == 0) == (expected[k].a != no_id));
            if (found->distance == 0) CHECK((index_pair{found->a, found->b} == expected[k]));
        }
        using index_a = std::remove_cvref_t<decltype(tree_a)>;
        using index_b = std::remove_cvref_t<decltype(tree_b)>;
        std::vector<posed_pair<index_a, index_b>> list;
        for (const rigid<T>& pose : poses) list.push_back({posed(tree_a, rigid<T>{}), posed(tree_b, pose)});
        const auto found = to_host(distance(on, list));
        for (std::size_t k = 0; k < poses.size(); ++k) {
            CAPTURE(k);
            CHECK((found[k].distance == 0) == (expected[k].a != no_id));
            if (found[k].distance == 0) CHECK((index_pair{found[k].a, found[k].b} == expected[k]));
        }
    };
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto keeping_a = make_bvh(on, a, {.least_ids = true}), keeping_b = make_bvh(on, b, {.least_ids = true});
    check(tree_a, tree_b);
    check(keeping_a, keeping_b);
    check(keeping_a, tree_b);
    // Queries leave nothing in a tree, and trees of one topology share what was made with the first.
    const auto ids = [](const auto& tree) { return tree.stored().least_ids.get(); };
    CHECK(ids(tree_a) == nullptr);
    CHECK((ids(keeping_a) != nullptr) == host_policy<Policy>);
    CHECK(ids(refit(on, keeping_a, a)) == ids(keeping_a));
    CHECK(ids(quantised(on, keeping_a)) == ids(keeping_a));
    if constexpr (EveryLayout) {
        CHECK(ids(leafless(on, keeping_a)) == ids(keeping_a));
        CHECK(ids(oriented(on, keeping_a)) == ids(keeping_a));
        check(refit(on, keeping_a, a), quantised(on, keeping_b));
        check(leafless(on, keeping_a), oriented(on, keeping_b));
        check(make_bvh(on, a, {.builder = bvh_builder::sah, .least_ids = true}),
              make_bvh(on, b, {.builder = bvh_builder::ploc, .least_ids = true}));
        check(make_bvh(on, a, {.builder = bvh_builder::sah}), refit(on, tree_b, b));
        check(refit(on, make_bvh(on, a), a), quantised(on, tree_b));
        check(leafless(on, tree_a), leafless(on, tree_b));
        check(oriented(on, tree_a), oriented(on, tree_b));
        check(wide(on, tree_a), tree_b);
    }
}

template <class T, class Policy>
void check_all_distances(const Policy& on) {
    std::printf("distance: seeds 91 to 96\n");
    check_first_of_many_touches<T>(on);
    check_distance_by_hand<T>(on);
    check_distance_below<T>(on);
    check_distance_of_lists<T>(on);
    check_distance_of_meshes<T>(on);
    check_distance_of_sheets<T>(on);
    check_distance_by_indices<T>(on);
    check_distance_scales<T>(on);
    check_distance_of<sphere<T>, triangle<T>>(on, 93);
}

}  // namespace abut::test
