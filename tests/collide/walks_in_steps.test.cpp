// SPDX-License-Identifier: MIT
//
// On hosts, walks through a wide tree go in steps, several at a time, if the tree is large (traverse/ordered_walk.hpp). They
// find what each walk by itself finds.
#include <abut/collide/inside.hpp>
#include <abut/collide/raycast_all.hpp>

#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/index/wide.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

/// Both ways through a tree that is too small for steps.
template <class Index, class Lines, class T>
void check_steps(const Index& index, const Lines& lines, const shapes<vec3<T>>& from) {
    const auto both = detail::bring_lines_and_shapes(serial{}, index, lines, "test");
    const std::size_t n = both.size();
    const auto in_both_ways = [n](const auto& all, auto& best, const auto& read) {
        const detail::from_each walk{all};
        static_assert(requires { walk.in_steps(); });
        CHECK(!walk.pays_in_steps());
        best.begin(serial{}, 1);
        execution::detail::walk_in_order(walk, best.make_sink(0), 0, n);
        const auto expected = read();
        CHECK(expected.size() == n);
        best.begin(serial{}, 1);
        execution::detail::walk_in_turns(walk, best.make_sink(0), 0, n);
        CHECK((read() == expected));
    };
    execution::best_of_each<host_space> best(serial{}, n);
    in_both_ways(both.template walk<detail::walk_along_lines, filtered>(false), best,
                 [&] { return std::vector<execution::least_value>(best.data(), best.data() + n); });
    execution::until_stopped until;
    std::vector<std::uint8_t> met(n);
    in_both_ways(both.template walk<detail::walk_to_any, filtered>(met.data()), until, [&] {
        auto found = met;
        met.assign(n, 2);
        return found;
    });
    std::vector<std::uint64_t> counts(n);
    std::vector<execution::least_value> few(n * detail::kept_hits);
    in_both_ways(both.template walk<detail::count_along_lines, filtered>(counts.data(), few.data()), until, [&] {
        auto found = counts;
        counts.assign(n, 99);
        return found;
    });

    const auto x = detail::make_operand(serial{}, index, "test");
    const auto there = x.shapes();
    const auto walk = detail::ordered_walk_of(x);
    const auto frame = detail::frame_of(x, detail::length_unit<T>{});
    const auto points = from.view();
    std::vector<containment> where(n);
    const detail::walk_upward<filtered, containment, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                              std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(points)>>
        upward{walk, frame, there, points, inside_rule::parity, where.data()};
    in_both_ways(upward, until, [&] {
        auto found = where;
        where.assign(n, containment::on_surface);
        return found;
    });
}

template <class T>
std::vector<ray<T>> rays_at_torus(std::size_t n, test::uniform& random) {
    std::vector<ray<T>> lines;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> origin = random.point<T>(-2, 2);
        lines.push_back({origin, random.point<T>(-1, 1) - origin});
        if (i % 7 == 0) lines.back().direction = {0, 0, T(i % 2 == 0 ? 1 : -1)};
    }
    return lines;
}

}  // namespace

TEMPLATE_TEST_CASE("walks in steps: as one after another", "", float, double) {
    using T = TestType;
    test::uniform random(501);
    const test::torus<T> around(24, 12, 1, 0.4);
    const mesh<T> many(around.vertices, around.faces);
    const mesh<T> three(around.vertices, {around.faces[0], around.faces[1], around.faces[2]});
    const mesh<T> one(around.vertices, {around.faces[5]});
    rigid<T> pose{};
    test::construction::set_rotation(pose, 0.8L, 0.3L, -0.2L, 0.4L);
    pose.translation = {T(0.25), T(-0.5), T(0.125)};
    for (const mesh<T>& m : {many, three, one}) {
        const auto tree = wide(serial{}, make_bvh(serial{}, m, {.builder = bvh_builder::sah}));
        for (const std::size_t n : {0u, 1u, 7u, 8u, 9u, 600u}) {
            CAPTURE(m.size(), n);
            const auto lines = rays_at_torus<T>(n, random);
            std::vector<vec3<T>> points;
            std::vector<segment<T>> ends;
            for (const auto& l : lines) {
                points.push_back(T(0.75) * l.origin);
                ends.push_back({l.origin, l.origin + l.direction});
            }
            const shapes<vec3<T>> from(points);
            check_steps(tree, shapes<ray<T>>(lines), from);
            check_steps(tree, shapes<segment<T>>(ends), from);
            check_steps(posed(tree, pose), shapes<ray<T>>(lines), from);
        }
    }
}

TEMPLATE_TEST_CASE("walks in steps: of a large mesh, as through a binary tree", "", float, double) {
    using T = TestType;
    test::uniform random(502);
    const test::torus<T> around(256, 129, 1, 0.4);
    const mesh<T> m(around.vertices, around.faces);
    REQUIRE(m.size() > std::size_t{1} << 16);
    const auto tree = make_bvh(serial{}, m);
    const auto fine = wide(serial{}, tree);
    const auto lines = rays_at_torus<T>(3000, random);
    std::vector<vec3<T>> points;
    for (const auto& l : lines) points.push_back(T(0.75) * l.origin);
    const shapes<ray<T>> rays(lines);
    const auto first = raycast(serial{}, tree, rays).to_host();
    const auto any = raycast_any(serial{}, tree, rays).to_host();
    const auto all = raycast_all(serial{}, tree, rays).to_host();
    const auto where = inside(serial{}, tree, points).to_host();
    std::size_t met = 0, within = 0;
    for (const auto& hit : first) met += hit.id != no_id;
    for (const auto at : where) within += at == containment::inside;
    CHECK(met > 500);
    CHECK(within > 100);
    const auto check = [&](const auto& on) {
        CHECK((raycast(on, fine, rays).to_host() == first));
        CHECK((raycast_any(on, fine, rays).to_host() == any));
        CHECK((raycast_all(on, fine, rays).to_host() == all));
        CHECK((inside(on, fine, points).to_host() == where));
    };
    check(serial{});
    check(openmp{.threads = 3});
}
