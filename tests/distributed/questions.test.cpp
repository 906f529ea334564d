// SPDX-License-Identifier: MIT
//
// What points and rays ask of all parts, how far sets are apart, and which shapes come within a distance: the answers of one
// machine, bit for bit, however the sets are divided. Many shapes come twice, on different ranks, so that their ids decide.

#include <abut/mpi.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "collide/sweep_cases.hpp"
#include "distributed/world.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace {

/// Small triangles on a lattice, each twice, the second far behind the first.
template <scalar T>
std::vector<triangle<T>> twice_on_lattice(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(0, 20), side(0, 2);
    std::vector<triangle<T>> all;
    const auto place = [](int x, int y, int z) { return vec3<T>{T(x) / 4, T(y) / 4, T(z) / 4}; };
    for (std::size_t i = 0; i < n; ++i) {
        const int x = cell(random), y = cell(random), z = cell(random), w = side(random);
        all.push_back({place(x, y, z), place(x + 4, y + 2 * w, z), place(x, y + 4, z + 2 * side(random))});
    }
    // Along one axis, so that parts lie side by side.
    std::stable_sort(all.begin(), all.end(), [](const auto& s, const auto& t) { return s.a.x < t.a.x; });
    const auto first = all;
    all.insert(all.end(), first.begin(), first.end());
    return all;
}
template <scalar T>
std::vector<vec3<T>> places_around(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(-8, 48);
    std::vector<vec3<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        const T x = T(cell(random)), y = T(cell(random)), z = T(cell(random));
        all.push_back({x / 8, y / 8, z / 8});
    }
    return all;
}
template <scalar T>
std::vector<ray<T>> rays_around(std::size_t n, unsigned seed) {
    const auto from = places_around<T>(n, seed), to = places_around<T>(n, seed + 1);
    std::vector<ray<T>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back({from[i], to[i] - from[i]});
    return all;
}
template <scalar T>
std::vector<sphere<T>> balls_around(std::size_t n, T away, unsigned seed) {
    std::vector<sphere<T>> all;
    for (const vec3<T>& p : places_around<T>(n, seed)) all.push_back({{p.x + away, p.y, p.z}, T(0.375)});
    const auto first = all;
    all.insert(all.end(), first.begin(), first.end());
    return all;
}

/// This rank's part of a set that all ranks know, and the set.
template <class Shape>
struct divided_set {
    shapes<Shape> whole, part;
    divided_set(const std::vector<Shape>& all, division how, const detail::own_communicator& ranks)
        : whole(all), part(part_of(all, how, ranks.rank(), ranks.size())) {}
};

template <class Local, class X, class Whole, class Rays, class AllRays>
void check_all_ray_queries(const distributed<Local>& on, const X& x, const Whole& whole, const Rays& rays,
                           const AllRays& all) {
    const auto& ranks = on.ranks();
    const auto hits = to_host(raycast_all(serial{}, whole, all));
    CHECK(hits.size() > all.size() / 8);
    CHECK((lists_of_all(ranks, to_host(raycast_all(on, x, rays))) == in_all_parts(hits)));
    CHECK((lists_of_all(ranks, to_host(raycast(on, x, rays))) == in_all_parts(to_host(raycast(serial{}, whole, all)))));
    CHECK((lists_of_all(ranks, to_host(raycast_any(on, x, rays))) == to_host(raycast_any(serial{}, whole, all))));
}

}  // namespace

TEST_CASE("distributed: rows meet spheres and points of all parts") {
    const distributed on(world(), serial{});
    std::vector<sphere<float>> looking = balls_around<float>(100, 0, 83);
    const divided_set<sphere<float>> rows(looking, division::even, on.ranks());
    const auto check = [&]<class S>(const std::vector<S>& all) {
        const divided_set<S> set(all, division::even, on.ranks());
        const auto expected = to_host(any_each(serial{}, set.whole, rows.whole));
        CHECK(std::count(expected.begin(), expected.end(), 1) > 10);
        CHECK(std::count(expected.begin(), expected.end(), 0) > 10);
        CHECK((lists_of_all(on.ranks(), to_host(any_each(on, set.part, rows.part))) == expected));
        CHECK((lists_of_all(on.ranks(), to_host(any_within_each(on, make_bvh(serial{}, set.part), rows.part, 0.25))) ==
               to_host(any_within_each(serial{}, set.whole, rows.whole, 0.25))));
    };
    check(balls_around<float>(80, 0, 84));
    check(places_around<float>(1500, 85));
}

TEST_CASE("distributed: rays meet the triangles of all parts") {
    const distributed on(world(), serial{});
    const auto triangles = twice_on_lattice<float>(300, 81);
    const auto lines = rays_around<float>(700, 82);
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        const divided_set a(triangles, how, on.ranks());
        const divided_set from(lines, how == division::uneven ? division::even : division::uneven, on.ranks());
        const auto tree = make_bvh(on.local(), a.part);
        check_all_ray_queries(on, tree, make_bvh(serial{}, a.whole), from.part, from.whole);
        rigid<float> pose{};
        construction::set_rotation(pose, 0.8L, 0.1L, -0.5L, 0.2L);
        pose.translation = {0.5f, -0.25f, 1};
        check_all_ray_queries(on, posed(tree, pose), posed(make_bvh(serial{}, a.whole), pose), from.part, from.whole);
    }
}

TEST_CASE("distributed: segments in double, and more rays than a message takes") {
    const distributed on(world(), openmp{2});
    const divided_set a(twice_on_lattice<double>(200, 83), division::even, on.ranks());
    std::vector<segment<double>> ends;
    for (const auto& r : rays_around<double>(300, 84)) ends.push_back({r.origin, r.origin + 0.5 * r.direction});
    const divided_set from(ends, division::all_on_last, on.ranks());
    check_all_ray_queries(on, a.part, make_bvh(serial{}, a.whole), from.part, from.whole);

    const distributed alone(world(), serial{});
    const divided_set few(twice_on_lattice<float>(20, 85), division::even, on.ranks());
    const divided_set many(rays_around<float>(70'000, 86), division::all_on_first, on.ranks());
    const auto expected = to_host(raycast(serial{}, make_bvh(serial{}, few.whole), many.whole));
    CHECK((lists_of_all(on.ranks(), to_host(raycast(alone, few.part, many.part))) == in_all_parts(expected)));
}

TEST_CASE("distributed: balls touch on their ways what is first of all parts") {
    const distributed on(world(), serial{});
    const sweep_scene scene(150, 300);
    std::vector<global_sweep_hit<float>> expected;
    for (const auto& hit : to_host(sweep(serial{}, triangle_soup<float>(scene.triangles), shapes<swept<sphere<float>>>(scene.balls)))) {
        expected.push_back({hit.id == no_id ? no_global_id : hit.id, hit.t, hit.point, hit.normal});
    }
    for (const division how : {division::even, division::uneven}) {
        const triangle_soup<float> part(part_of(scene.triangles, how, on.rank(), on.size()));
        const shapes<swept<sphere<float>>> mine(part_of(scene.balls, how, on.rank(), on.size()));
        CHECK((lists_of_all(on.ranks(), to_host(sweep(on, part, mine))) == expected));
        CHECK((lists_of_all(on.ranks(), to_host(sweep<exact>(on, make_bvh(on.local(), part), mine))) == expected));
    }
}

TEST_CASE("distributed: options of rays") {
    const distributed on(world(), serial{});
    const auto triangles = twice_on_lattice<float>(150, 181);
    const auto lines = rays_around<float>(300, 182);
    for (const division how : divisions) {
        const divided_set a(triangles, how, on.ranks());
        const divided_set from(lines, division::uneven, on.ranks());
        const auto tree = make_bvh(on.local(), a.part);
        for (const auto& options :
             {raycast_options<>{.least_t = 0.25, .most_t = 0.75}, raycast_options<>{.side = ray_side::back}}) {
            const auto hits = to_host(raycast_all(serial{}, a.whole, from.whole, options));
            CHECK(hits.size() > 30);
            CHECK((lists_of_all(on.ranks(), to_host(raycast_all(on, tree, from.part, options))) == in_all_parts(hits)));
            CHECK((lists_of_all(on.ranks(), to_host(raycast(on, tree, from.part, options))) ==
                   in_all_parts(to_host(raycast(serial{}, a.whole, from.whole, options)))));
            CHECK((lists_of_all(on.ranks(), to_host(raycast_any(on, tree, from.part, options))) ==
                   to_host(raycast_any(serial{}, a.whole, from.whole, options))));
            const auto found = lists_of_all(on.ranks(), to_host(raycast_detailed(on, tree, from.part, options)));
            const auto expected = to_host(raycast_detailed(serial{}, a.whole, from.whole, options));
            REQUIRE(found.size() == expected.size());
            std::size_t wrong = 0;
            for (std::size_t k = 0; k < found.size(); ++k) {
                const auto& [hit, side, weights] = expected[k];
                wrong += found[k].hit != in_all_parts(std::vector{hit})[0] || found[k].side != side ||
                         found[k].weights != weights;
            }
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("distributed: the few nearest of all parts") {
    const distributed on(world(), serial{});
    const auto triangles = twice_on_lattice<float>(150, 87);
    const auto places = places_around<float>(400, 88);
    for (const division how : divisions) {
        const divided_set a(triangles, how, on.ranks());
        const auto mine = part_of(places, division::uneven, on.rank(), on.size());
        for (const std::size_t count : {std::size_t{1}, std::size_t{5}, std::size_t{40}}) {
            CAPTURE(static_cast<int>(how), count, on.size());
            const auto expected = in_all_parts(to_host(nearest(serial{}, make_bvh(serial{}, a.whole), places, count)));
            const auto found = to_host(nearest(on, make_bvh(on.local(), a.part), mine, count));
            CHECK((lists_of_all(on.ranks(), found) == expected));
        }
    }
    const divided_set few(std::vector<sphere<float>>{{{0, 0, 0}, 1}, {{5, 0, 0}, 1}}, division::even, on.ranks());
    const auto expected = in_all_parts(to_host(nearest(serial{}, few.whole, places, 3)));
    CHECK((expected[1].id != no_global_id && expected[2].id == no_global_id));
    const auto mine = part_of(places, division::even, on.rank(), on.size());
    CHECK((lists_of_all(on.ranks(), to_host(nearest(on, few.part, mine, 3))) == expected));
}

TEST_CASE("distributed: inside of a mesh whose parts lie on many ranks") {
    const distributed on(world(), serial{});
    const auto data = ball_surface<float>(3, 2.0);
    const mesh<float> whole(data.vertices, data.faces);
    auto from = places_around<float>(1'000, 89);
    for (auto& p : from) p = {p.x - 2, p.y - 2, p.z - 2};
    from.insert(from.end(), data.vertices.begin(), data.vertices.end());
    const auto expected = to_host(inside(serial{}, whole, from));
    for (const containment at : {containment::outside, containment::inside, containment::on_surface}) {
        CHECK(std::count(expected.begin(), expected.end(), at) > 50);
    }
    const auto signs = in_all_parts(to_host(signed_distance(serial{}, whole, from)));
    const inside_options closed{.known_closed = true};
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        const mesh<float> part(data.vertices, part_of(data.faces, how, on.rank(), on.size()));
        const auto mine = part_of(from, division::even, on.rank(), on.size());
        CHECK((lists_of_all(on.ranks(), to_host(inside(on, make_bvh(on.local(), part), mine, closed))) == expected));
        CHECK((lists_of_all(on.ranks(), to_host(signed_distance(on, make_bvh(on.local(), part), mine, closed))) == signs));
    }
    CHECK_THROWS_AS((void)inside(on, whole, from), error);
}

namespace {

struct keep_some_within {
    bool operator()(std::uint64_t a, std::uint64_t b) const { return (a + 3 * b) % 5 != 0; }
};

}  // namespace

TEST_CASE("distributed: shapes of all parts within a distance") {
    const distributed on(world(), serial{});
    const auto triangles = twice_on_lattice<float>(150, 90);
    const auto balls = balls_around<float>(120, 1.0f, 91);
    for (const division how : divisions) {
        const divided_set a(triangles, how, on.ranks());
        const divided_set b(balls, how == division::even ? division::uneven : division::even, on.ranks());
        const auto tree = make_bvh(on.local(), a.part);
        const auto tree_b = make_bvh(on.local(), b.part);
        for (const double distance : {0.0, 0.375}) {
            CAPTURE(static_cast<int>(how), distance, on.size());
            const auto expected = in_all_parts(to_host(within(serial{}, a.whole, b.whole, distance)));
            CHECK(expected.size() > (distance > 0 ? 500u : 50u));
            CHECK(lists_of_all(on.ranks(), to_host(within(on, tree, tree_b, distance))) == expected);
            CHECK(count_within(on, tree, b.part, distance) == expected.size());
            CHECK(any_within(on, a.part, tree_b, distance));
            std::uint64_t visits = 0;
            for_each_within(on, tree, b.part, distance, [&](global_pair) { return ++visits, visit::proceed; });
            CHECK(detail::sum_of_ranks(on.ranks(), visits) == expected.size());
            const auto themselves = in_all_parts(to_host(self_within(serial{}, b.whole, distance)));
            CHECK(lists_of_all(on.ranks(), to_host(self_within(on, tree_b, distance))) == themselves);
            CHECK(count_self_within(on, b.part, distance) == themselves.size());
            std::vector<global_pair> some;
            std::copy_if(themselves.begin(), themselves.end(), std::back_inserter(some),
                         [](const global_pair& p) { return keep_some_within{}(p.a, p.b); });
            const query_options<keep_some_within> options{.filter = {}};
            CHECK(lists_of_all(on.ranks(), to_host(self_within(on, tree_b, distance, options))) == some);
        }
    }
    const divided_set a(triangles, division::even, on.ranks());
    CHECK(!any_within(on, a.part, sphere<float>{{-9, 0, 0}, 1}, 0.5));
}

namespace {

template <scalar T>
void check_distance_of_parts(division how, division how_b) {
    const distributed on(world(), serial{});
    const divided_set a(twice_on_lattice<T>(150, 92), how, on.ranks());
    const auto tree = make_bvh(on.local(), a.part);
    const auto whole_a = make_bvh(serial{}, a.whole);
    rigid<T> pose{};
    construction::set_rotation(pose, 0.8L, 0.1L, -0.5L, 0.2L);
    bool seen[2] = {false, false};  // sets that touch, and that do not
    for (const T away : {T(1), T(12), T(90)}) {
        CAPTURE(static_cast<int>(how), static_cast<int>(how_b), away, on.size());
        const divided_set b(balls_around<T>(100, away, 93), how_b, on.ranks());
        const auto whole_b = make_bvh(serial{}, b.whole);
        const auto check = [&](const auto& x, const auto& y, const auto& whole) {
            const auto expected = distance(serial{}, whole, whole_b);
            const global_separation<T> named{expected->a, expected->b, expected->point_a, expected->point_b,
                                             expected->distance};
            seen[expected->distance > 0 ? 1 : 0] = true;
            CHECK(on_all(on.ranks(), distance(on, x, y) == named));
            const double far = static_cast<double>(expected->distance);
            CHECK(on_all(on.ranks(), distance(on, x, y, {.below = far + 1}) == named));
            CHECK(on_all(on.ranks(), !distance(on, x, y, {.below = far})));
        };
        check(tree, make_bvh(on.local(), b.part), whole_a);
        check(posed(tree, pose), b.part, posed(whole_a, pose));
    }
    CHECK((seen[0] && seen[1]));
}

}  // namespace

TEST_CASE("distributed: how far sets of many parts are apart") {
    for (const division how : divisions) check_distance_of_parts<float>(how, division::even);
    check_distance_of_parts<double>(division::even, division::uneven);
    check_distance_of_parts<float>(division::all_on_first, division::all_on_last);  // no rank has both
    const distributed on(world(), serial{});
    CHECK(!distance(on, spheres<float>(), sphere<float>{{0, 0, 0}, 1}));
}

namespace {

struct keep_some_entries {
    bool operator()(const global_tagged_pair& of) const { return (of.pair + of.a + of.b) % 3 != 0; }
};

/// Entries of two balls, one ball and of an empty set, some of which touch.
template <scalar T>
auto list_of_balls(std::size_t entries) {
    using tree = bvh<mesh<T>, host_space>;
    const auto large = ball_surface<T>(2, 1.0), small = ball_surface<T>(1, 0.5);
    const std::vector<tree> trees{make_bvh(serial{}, mesh<T>(large.vertices, large.faces)),
                                  make_bvh(serial{}, mesh<T>(small.vertices, small.faces)), make_bvh(serial{}, mesh<T>())};
    std::vector<posed_pair<tree>> list;
    std::mt19937 random(96);
    std::uniform_int_distribution<int> eighth(0, 20);
    for (std::size_t i = 0; i < entries; ++i) {
        rigid<T> here{}, other{};
        construction::set_rotation(here, 0.8L, 0.1L, -0.5L, 0.2L);
        other.translation = {T(eighth(random)) / 8, T(eighth(random)) / 16, T(0.03125)};
        list.push_back({posed(trees[i % 2], here), posed(trees[i % 7 == 3 ? 2 : i % 3 == 0 ? 0 : 1], other)});
    }
    return list;
}

template <scalar T>
void check_lists_of_parts(std::size_t entries, division how) {
    const distributed on(world(), serial{});
    CAPTURE(static_cast<int>(how), entries, on.size());
    const auto list = list_of_balls<T>(entries);
    const auto mine = part_of(list, how, on.rank(), on.size());
    const auto expected = in_all_parts(to_host(pairs(serial{}, list)));
    CHECK((entries < 40 || expected.size() > 400));
    CHECK(lists_of_all(on.ranks(), to_host(pairs(on, mine))) == expected);
    CHECK(lists_of_all(on.ranks(), to_host(pairs<exact>(on, mine))) == expected);
    CHECK(count(on, mine) == expected.size());
    CHECK(on_all(on.ranks(), any(on, mine) == !expected.empty()));
    CHECK((lists_of_all(on.ranks(), to_host(contacts(on, mine))) == in_all_parts(to_host(contacts(serial{}, list)))));
    CHECK((lists_of_all(on.ranks(), to_host(distance(on, mine))) == to_host(distance(serial{}, list))));
    CHECK((lists_of_all(on.ranks(), to_host(distance(on, mine, {.below = 0.25}))) ==
           to_host(distance(serial{}, list, {.below = 0.25}))));

    std::vector<global_tagged_pair> some;
    std::copy_if(expected.begin(), expected.end(), std::back_inserter(some), keep_some_entries{});
    const list_options<keep_some_entries> options{.filter = {}};
    CHECK(lists_of_all(on.ranks(), to_host(pairs(on, mine, options))) == some);
    CHECK(count(on, mine, options) == some.size());
    auto unsorted = lists_of_all(on.ranks(), to_host(pairs(on, mine, {.sorted = false})));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);
    std::vector<global_tagged_pair> visited;
    for_each_pair(on, mine, [&](const global_tagged_pair& of) { return visited.push_back(of), visit::proceed; });
    std::sort(visited.begin(), visited.end());
    CHECK(lists_of_all(on.ranks(), visited) == expected);
    std::size_t visits = 0;
    for_each_pair(on, mine, [&](const global_tagged_pair&) { return ++visits, visit::stop; });
    CHECK(on_all(on.ranks(), visits <= 1));

    constexpr double near = 0.0625;
    const auto expected_within = in_all_parts(to_host(within(serial{}, list, near)));
    CHECK((entries < 40 || expected_within.size() > expected.size() + 200));
    CHECK(lists_of_all(on.ranks(), to_host(within(on, mine, near))) == expected_within);
    CHECK(count_within(on, mine, near) == expected_within.size());
    CHECK(on_all(on.ranks(), any_within(on, mine, near) == !expected_within.empty()));
    some.clear();
    std::copy_if(expected_within.begin(), expected_within.end(), std::back_inserter(some), keep_some_entries{});
    CHECK(lists_of_all(on.ranks(), to_host(within(on, mine, near, options))) == some);
    visited.clear();
    for_each_within(on, mine, near, [&](const global_tagged_pair& of) { return visited.push_back(of), visit::proceed; });
    std::sort(visited.begin(), visited.end());
    CHECK(lists_of_all(on.ranks(), visited) == expected_within);
}

}  // namespace

TEST_CASE("distributed: lists of posed pairs whose entries many ranks have") {
    for (const division how : divisions) check_lists_of_parts<float>(50, how);
    for (const std::size_t entries : {0u, 1u, 5u}) check_lists_of_parts<float>(entries, division::even);
    check_lists_of_parts<double>(50, division::uneven);
    const distributed on(world(), serial{});
    CHECK(detail::entries_of_rank{std::uint64_t{1} << 33}.named(tagged_pair{1, 2, 3}).pair == (std::uint64_t{1} << 33) + 1);

    // A pose that is none, on one rank, is named by its position in the list of all.
    for (int bad = 0; bad < on.size(); ++bad) {
        auto mine = part_of(list_of_balls<float>(20), division::even, on.rank(), on.size());
        if (on.rank() == bad) mine[1].b.pose.rotation[0] = -2;
        const std::string entry = "entry " + std::to_string(cut(division::even, 20, bad, on.size()) + 1) + " of the list";
        const auto is_as_expected = [&](const auto& call) {
            try {
                call();
            } catch (const distributed_error& e) {
                return on.rank() != bad && e.rank() == bad && std::string(e.what()).find(entry) != std::string::npos;
            } catch (const error& e) {
                return on.rank() == bad && std::string(e.what()).find(entry) != std::string::npos;
            }
            return false;
        };
        CHECK(on_all(on.ranks(), is_as_expected([&] { (void)pairs(on, mine); })));
        CHECK(on_all(on.ranks(), is_as_expected([&] { (void)any(on, mine); })));
        CHECK(on_all(on.ranks(), is_as_expected([&] { (void)distance(on, mine); })));
        const auto fails = [&](const global_tagged_pair&) -> bool {
            if (on.rank() == bad) throw error(entry);
            return true;
        };
        auto whole = list_of_balls<float>(20);
        for (auto& one : whole) one.b = one.a;  // they touch
        const auto good = part_of(whole, division::even, on.rank(), on.size());
        const list_options<decltype(fails)> options{.filter = fails};
        CHECK(on_all(on.ranks(), is_as_expected([&] { (void)count(on, good, options); })));
        CHECK(count(on, good) == count(serial{}, whole));  // the next call works
    }
}

TEST_CASE("distributed: a failure of one rank that asks reaches all") {
    const distributed on(world(), serial{});
    const divided_set a(twice_on_lattice<float>(150, 94), division::even, on.ranks());
    const divided_set lines(rays_around<float>(60, 95), division::even, on.ranks());
    const int bad = on.size() - 1;
    const auto outcome_of = [&](const auto& call) {
        try {
            call();
        } catch (const distributed_error& e) {
            return e.rank() == bad ? 2 : 3;
        } catch (const error&) {
            return 1;
        }
        return 0;
    };
    const int expected = on.rank() == bad ? 1 : 2;
    auto broken = part_of(rays_around<float>(60, 95), division::even, on.rank(), on.size());
    if (on.rank() == bad) broken[0].origin.x = std::numeric_limits<float>::quiet_NaN();
    const shapes_view<ray<float>> view(broken.data(), broken.size());
    const std::vector<vec3<float>> points(3);
    const bool mine = on.rank() == bad;
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)raycast(on, a.part, view); }) == expected));
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)raycast_all(on, a.part, view); }) == expected));
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)nearest(on, a.part, points, mine ? 0 : 2); }) == expected));
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)inside(on, a.part, points, {.known_closed = !mine}); }) == expected));
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)within(on, a.part, a.part, mine ? -1 : 1); }) == expected));
    const auto list = part_of(list_of_balls<float>(20), division::even, on.rank(), on.size());
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)within(on, list, mine ? -1 : 1); }) == expected));
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)count_within(on, list, mine ? -1 : 1); }) == expected));
    const double below = mine ? std::numeric_limits<double>::quiet_NaN() : 1;
    CHECK(on_all(on.ranks(), outcome_of([&] { (void)distance(on, a.part, a.part, {.below = below}); }) == expected));
    CHECK_THROWS_AS((void)within(on, a.part, a.part, 1 + (mine && bad > 0 ? 1 : 0) + (bad > 0 ? 0 : -2)), error);
    check_all_ray_queries(on, a.part, a.whole, lines.part, lines.whole);  // the next call works
}

}  // namespace abut::test
