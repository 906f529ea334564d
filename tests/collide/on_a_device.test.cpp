// SPDX-License-Identifier: MIT
// What devices do in another way than hosts, on a host: sweeps in stages, and motions by groups of threads. The answers are
// those of the way of hosts, which have tests of their own.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

/// As sweeps_in_parts::find calls it on a device.
template <arithmetic A = filtered, class Index, class S>
auto sweep_in_stages(const Index& index, const std::vector<swept<S>>& movers) {
    using namespace detail;
    using T = scalar_type_of<S>;
    const serial on;
    const abut::shapes<swept<S>> set(movers);
    const auto x = make_operand(on, index, "test");
    const auto walk = ordered_walk_of(x);
    const auto frame = frame_of(x, length_unit<T>{});
    const auto shapes = x.shapes();
    const auto rows = set.view();
    using along =
        walk_along_ways<A, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                        std::remove_const_t<decltype(shapes)>, std::remove_const_t<decltype(rows)>, all_shapes_wanted>;
    static_assert(along::can_gather);
    using best_type = execution::best_of_each<host_space>;
    best_type best(on, movers.size(), 1.0);
    const from_each each{along{walk, frame, shapes, rows, {}, true}};
    staged_sweep<serial, along, best_type>(on, movers.size(), each, best);
    std::vector<execution::least_value> found(best.data(), best.data() + movers.size());
    return found;
}

template <class Index, class S>
void check_stages(const Index& index, const std::vector<swept<S>>& movers, std::size_t least_touched) {
    const auto expected = to_host(sweep(serial{}, index, abut::shapes<swept<S>>(movers)));
    const auto found = sweep_in_stages(index, movers);
    using T = scalar_type_of<S>;
    std::size_t wrong = 0, touched = 0;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const bool meets = found[i].key != static_cast<std::uint64_t>(-1);
        touched += meets;
        wrong += meets != (expected[i].id != no_id);
        wrong += meets && (found[i].key != expected[i].id || detail::time_as<T>(found[i].value) != expected[i].t);
    }
    CHECK(wrong == 0);
    CHECK(touched >= least_touched);
}

/// Capsules and balls that go through a torus, of which some begin in it.
template <class T>
mesh<T> torus() {
    const test::torus<T> surface(96, 32, 2, 1);
    return {surface.vertices, surface.faces};
}

/// Turned about z.
template <class T>
rigid<T> some_pose(std::uint64_t seed) {
    test::uniform random(test::sample_seed * 1000 + seed);
    const double angle = random(-1.5, 1.5);
    const auto c = static_cast<T>(std::cos(angle)), s = static_cast<T>(std::sin(angle));
    return {{c, -s, 0, s, c, 0, 0, 0, 1}, random.point<T>(-4, 4)};
}

}  // namespace

TEMPLATE_TEST_CASE("sweep in stages: what is met first of a torus", "", float, double) {
    using T = TestType;
    const auto index = make_bvh(serial{}, torus<T>());
    std::vector<swept<capsule<T>>> capsules;
    std::vector<swept<sphere<T>>> balls;
    for (std::uint64_t i = 0; i < test::some_samples(400); ++i) {
        test::uniform random(test::sample_seed + i);
        const auto a = random.point<T>(-4, 4), b = random.point<T>(-4, 4), way = random.point<T>(-6, 6);
        // From thin ones, that meet an edge or two, to some beside which hundreds of faces lie.
        const T radius = static_cast<T>(std::ldexp(1.0, -static_cast<int>(i % 12)));
        capsules.push_back({{{a, a + T(0.2) * b}, radius}, way});
        balls.push_back({{b, radius}, way});
    }
    check_stages(index, capsules, capsules.size() / 4);
    check_stages(index, balls, balls.size() / 4);
    const auto pose = some_pose<T>(3);
    check_stages(posed(index, pose), capsules, 1);
}

// All faces of a fan meet at its tip, and all are touched there at one time. There are more of them than a row has room for
// in any stage.
TEMPLATE_TEST_CASE("sweep in stages: more ties than there is room for", "", float, double) {
    using T = TestType;
    const serial on;
    for (const std::uint32_t count : {12u, 40u, 900u, 3000u}) {
        std::vector<vec3<T>> vertices{{0, 0, 0}};
        std::vector<face> faces;
        for (std::uint32_t i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count;
            vertices.push_back({static_cast<T>(std::cos(angle)), static_cast<T>(std::sin(angle)), T(-2)});
            faces.push_back({0, 1 + i, 1 + (i + 1) % count});
        }
        const auto index = make_bvh(on, mesh<T>(vertices, faces));
        std::vector<swept<sphere<T>>> balls{
            {{{0, 0, 3}, 1}, {0, 0, -4}}, {{{0, 0, T(0.5)}, 1}, {0, 0, -1}}, {{{0, 0, 3}, 1}, {0, 0, 4}}};
        for (int i = 0; i < 20; ++i) balls.push_back({{{T(0.01) * static_cast<T>(i), 0, 3}, T(0.25)}, {0, 0, -4}});
        check_stages(index, balls, 20);
    }
}

// Points that are close to faces look alone, the others in groups, unless few of these are left.
TEMPLATE_TEST_CASE("nearest in groups: close to a torus, far from it, and nearly all close", "", float, double) {
    using namespace detail;
    using T = TestType;
    const serial on;
    const test::torus<T> surface(48, 24, 2, 1);
    const auto tree = make_bvh(on, mesh<T>(surface.vertices, surface.faces));
    const auto ask = [&](const auto& index, std::size_t one_in) {
        std::vector<vec3<T>> points;
        for (std::uint64_t i = 0; i < 2000; ++i) {
            test::uniform random(test::sample_seed + i);
            const auto far = random.point<T>(-4, 4), off = random.point<T>(-0.01, 0.01);
            // Groups are of neighbours.
            points.push_back(i / 32 % one_in == 0 ? far : surface.vertices[i * 7 % surface.vertices.size()] + off);
        }
        const abut::points<T> set(points);
        const auto expected = to_host(nearest(on, index, set));
        const auto x = make_operand(on, index, "test");
        const length_unit<T> unit{};
        const auto walk = ordered_walk_of(x);
        const auto frame = frame_of(x, unit);
        const auto there = x.shapes();
        const auto from = set.view();
        const measure_distance<T> judge{unit};
        const walk_from_points<std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                               std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(from)>,
                               measure_distance<T>, all_shapes_wanted>
            by_itself{walk, frame, there, from, judge, nullptr, {}};
        const auto found = nearest_in_groups(on, walk.tree, frame, there, from, judge, nullptr, by_itself);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i) wrong += found.data()[i].key != expected[i].id;
        CHECK(wrong == 0);
    };
    for (const std::size_t one_in : {1u, 3u, 20u, 100000u}) {
        ask(tree, one_in);
        ask(posed(tree, some_pose<T>(one_in)), one_in);
    }
}

TEST_CASE("meetings by groups of threads are those of one thread") {
    const serial on;
    const auto first = make_bvh(on, torus<float>());
    const test::torus<float> small(12, 8, 2, 1);
    const auto second = wide(on, make_bvh(on, mesh<float>(small.vertices, small.faces)));
    std::vector<moving_pair<std::remove_const_t<decltype(first)>, std::remove_const_t<decltype(second)>>> list;
    for (std::uint64_t i = 0; i < test::some_samples(60); ++i) {
        test::uniform random(test::sample_seed + i);
        auto from = some_pose<float>(2 * i), to = some_pose<float>(2 * i + 1);
        from.translation = random.point<float>(-8, 8);
        to.translation = random.point<float>(-8, 8);
        if (i % 3 == 0) to = from, to.translation = random.point<float>(-8, 8);
        list.push_back({moving(posed(first, from), posed(first, to)), posed(second, some_pose<float>(i))});
    }
    const auto name = [](std::size_t i) { return "entry " + std::to_string(i); };
    const meeting_options near{.tolerance = 1e-3};
    const auto expected = detail::meetings_of<meeting>(on, list, near, "test", name);
    const auto found = detail::meetings_of<meeting, true>(on, list, near, "test", name);
    const auto any = detail::meetings_of<std::uint8_t, true>(on, list, near, "test", name);
    std::size_t wrong = 0, met = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const bool meets = expected.data()[i].time <= 1;
        met += meets;
        wrong += !(found.data()[i] == expected.data()[i]);
        wrong += (any.data()[i] != 0) != meets;
    }
    CHECK(wrong == 0);
    CHECK(met > list.size() / 4);
    CHECK(met < list.size());
}
