// SPDX-License-Identifier: MIT

// A shape from outside that supplies all that a shape can: the tree of docs/examples, a trunk and a crown. Each query of
// trees has to say what it says of all trunks and of all crowns together.

#include "../../docs/examples/tree.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace {

using namespace abut;

static_assert(placeable<plant::tree<float>> && approachable<plant::tree<double>>);
static_assert(decidable_pair<plant::tree<float>, triangle<float>> && distance_decidable<plant::tree<float>, aabb<float>>);
static_assert(intersects(sphere<float>{{0, 0, 9}, 1}, plant::tree<float>{{{{0, 0, 0}, {0, 0, 4}}, 1}, {{0, 0, 6}, 2}}));
static_assert(
    contact_of(plane<float>{{0, 0, 1}, 7}, plant::tree<float>{{{{0, 0, 0}, {0, 0, 4}}, 1}, {{0, 0, 6}, 2}})->depth == 1);

template <class T>
std::vector<plant::tree<T>> random_trees(std::size_t n, test::uniform& random) {
    std::vector<plant::tree<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> foot = random.point<T>(-1, 1), top = foot + random.point<T>(-0.4, 0.4);
        all.push_back({{{foot, top}, static_cast<T>(random(0, 0.1))}, {top, static_cast<T>(random(0, 0.25))}});
    }
    return all;
}

template <class Result>
auto in_order(Result all) {
    std::sort(all.begin(), all.end(), [](const auto& p, const auto& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}
std::vector<index_pair> both(std::vector<index_pair> p, const std::vector<index_pair>& q) {
    p.insert(p.end(), q.begin(), q.end());
    return in_order(std::move(p));
}

/// Trees and any other set, that may be trees too.
template <class T, class Policy, class Set, class Trunks, class Crowns>
void check_trees(const Policy& on, const std::vector<plant::tree<T>>& some, const Set& other, const Trunks& trunks,
                 const Crowns& crowns) {
    const auto forest = make_bvh(on, shapes<plant::tree<T>>(some));
    const auto there = make_bvh(on, other);
    test::draws d(871, 3, 1);
    const rigid<T> pose = test::make_pose<T>(d, 0.5);
    const auto expected =
        both(to_host(pairs(on, posed(trunks, pose), there)), to_host(pairs(on, posed(crowns, pose), there)));
    CHECK(expected.size() > 15);
    CHECK(to_host(pairs(on, posed(forest, pose), there)) == expected);
    CHECK(to_host(pairs<exact>(on, posed(forest, pose), other)) == expected);
    const auto near = both(to_host(within(on, trunks, there, 0.25)), to_host(within(on, crowns, there, 0.25)));
    CHECK(to_host(within(on, forest, there, 0.25)) == near);
    CHECK(count_within(on, there, forest, 0.25) == near.size());

    const auto how = to_host(contacts(on, there, forest));
    CHECK(how.size() > 30);
    for (const contact<T>& c : how) {
        const auto of_trunk = contact_of(other.view()[c.a], some[c.b].trunk),
                   of_crown = contact_of(other.view()[c.a], some[c.b].crown);
        const T deepest = std::max(of_trunk ? of_trunk->depth : T(0), of_crown ? of_crown->depth : T(0));
        CHECK(c.depth == deepest);
        CHECK(((of_trunk && of_trunk->normal == c.normal) || (of_crown && of_crown->normal == c.normal)));
    }
    for (const T beside : {T(0), T(4)}) {
        rigid<T> away;
        away.translation = {beside, 0, 0};
        const auto apart = distance(on, posed(forest, away), there);
        const auto of_trunks = distance(on, posed(trunks, away), there),
                   of_crowns = distance(on, posed(crowns, away), there);
        CHECK(apart->distance == std::min(of_trunks->distance, of_crowns->distance));
        CHECK((apart->distance == 0) == (beside == 0));
        CHECK(distance(on, there, posed(forest, away))->distance == apart->distance);
    }
}

template <class T, class Policy>
void check_all(const Policy& on) {
    std::printf("trees: seed 871\n");
    test::uniform random(871);
    const auto some = random_trees<T>(60, random);
    std::vector<capsule<T>> stems;
    std::vector<sphere<T>> balls;
    for (const plant::tree<T>& one : some) stems.push_back(one.trunk), balls.push_back(one.crown);
    const auto trunks = make_bvh(on, capsules<T>(stems));
    const auto crowns = make_bvh(on, spheres<T>(balls));
    check_trees(on, some, triangle_soup<T>(test::shape_maker<triangle<T>>(random, false)(60)), trunks, crowns);
    check_trees(on, some, boxes<T>(test::shape_maker<aabb<T>>(random, true)(60)), trunks, crowns);
    check_trees(on, some, spheres<T>(test::shape_maker<sphere<T>>(random, true)(60)), trunks, crowns);

    const auto forest = make_bvh(on, shapes<plant::tree<T>>(some));
    std::vector<ray<T>> lines;
    for (const plant::tree<T>& one : some) {
        const vec3<T> from = random.point<T>(-2, 2);
        lines.push_back({from, one.crown.center + random.point<T>(-0.2, 0.2) - from});
    }
    const rays<T> rows(lines);
    const auto found = to_host(raycast(on, forest, rows)), first = to_host(raycast(on, trunks, rows)),
               second = to_host(raycast(on, crowns, rows));
    std::size_t met = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        CHECK(found[i].t == std::min(first[i].t, second[i].t));
        met += found[i].id != no_id;
    }
    CHECK(met > 30);
    CHECK(met < 60);
    std::vector<segment<T>> parts;
    for (const ray<T>& r : lines) parts.push_back({r.origin, r.origin + T(0.5) * r.direction});
    const auto is_met = to_host(raycast_any(on, forest, segments<T>(parts)));
    for (std::size_t i = 0; i < parts.size(); ++i) CHECK((is_met[i] == 1) == any(on, forest, parts[i]));

    std::vector<vec3<T>> asking;
    for (int i = 0; i < 60; ++i) asking.push_back(random.point<T>(-2, 2));
    const auto nearest_of = to_host(nearest(on, forest, points<T>(asking)));
    const auto of_trunks = to_host(nearest(on, trunks, points<T>(asking))),
               of_crowns = to_host(nearest(on, crowns, points<T>(asking)));
    for (std::size_t i = 0; i < asking.size(); ++i) {
        CHECK(std::abs(nearest_of[i].distance - std::min(of_trunks[i].distance, of_crowns[i].distance)) <= T(1e-6));
    }

    std::vector<posed_object<std::remove_const_t<decltype(forest)>>> bodies;
    for (std::uint64_t k = 0; k < 4; ++k) {
        test::draws d(872, 3, k);
        bodies.push_back(posed(forest, test::make_pose<T>(d, 0.5)));
    }
    std::size_t pairs_of_bodies = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) pairs_of_bodies += count(on, bodies[i], bodies[j]);
    }
    CHECK(pairs_of_bodies > 100);
    CHECK(count(on, make_bodies(on, bodies)) == pairs_of_bodies);
}

}  // namespace

TEST_CASE("extending: a shape that has all, serial") { check_all<float>(serial{}); }
TEST_CASE("extending: one ray and a shape that has all") {
    const plant::tree<double> one{{{{0, 0, 0}, {0, 0, 4}}, 1}, {{0, 0, 6}, 2}};
    CHECK(hit_time_of(ray<double>{{9, 0, 6}, {-1, 0, 0}}, one) == 7);
    CHECK(hit_time_of<exact>(segment<double>{{9, 0, 1}, {1, 0, 1}}, one) == 1);
    CHECK(hit_time_of(segment<double>{{9, 0, 1}, {1.5, 0, 1}}, one) < 0);
}
TEST_CASE("extending: a shape that has all, openmp") { check_all<double>(openmp{3}); }
