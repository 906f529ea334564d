// SPDX-License-Identifier: MIT
#include <abut/collide/scene_meetings.hpp>

// Scenes of bodies that move and turn. The truth is the list form of all bodies with all: that boxes around whole ways leave nothing
// out is what is tested here.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/index/lbvh.hpp>
#include <abut/shape/set.hpp>

#include "collide/turning_cases.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

using namespace abut;

namespace {

template <class T>
std::vector<rigid<T>> scene_poses(std::uint64_t seed, std::size_t n, double reach, const std::vector<rigid<T>>& from = {}) {
    std::vector<rigid<T>> poses;
    for (std::size_t i = 0; i < n; ++i) {
        test::draws d(test::sample_seed, seed, i);
        rigid<T> pose = test::pose_that_turns<T>(d, reach);
        if (!from.empty()) {
            const vec3<T> way = test::point_that_turns<T>(d, 3);
                        if (i % 5 == 0) pose = from[i];  // no turn
            pose.translation = i % 7 == 0 ? from[i].translation : from[i].translation + way;
            if (i % 11 == 0) pose = from[i];
        }
        poses.push_back(pose);
    }
    return poses;
}

struct odd_bodies_only {
    bool operator()(std::uint32_t a, std::uint32_t b) const { return (a + b) % 2 == 1; }
};

template <class T, class Policy>
void check_scene_meetings(const Policy& on, std::size_t n, double reach) {
    const auto thin = make_bvh(on, triangle_soup<T>(test::triangles_that_turn<T>(9, 1e-3)));
    const auto long_ones = make_bvh(on, triangle_soup<T>(std::vector<triangle<T>>{{{2, 0, 0}, {7, 0, 0}, {7, T(0.1), 0}}}));
    const auto none = make_bvh(on, triangle_soup<T>());
    using index = std::remove_const_t<decltype(thin)>;
    const std::vector<index> indices{thin, long_ones, none};
    std::vector<std::uint32_t> index_of;
    for (std::size_t i = 0; i < n; ++i) index_of.push_back(i % 10 == 9 ? 2 : static_cast<std::uint32_t>(i % 2));
    const auto from = scene_poses<T>(301, n, reach);
    const auto to = scene_poses<T>(302, n, reach, from);
    const auto scene = make_bodies(on, indices, index_of, from);
    const auto frame = moving(scene, refit(on, scene, to));
    const double tolerance = 1e-3;

    std::vector<moving_pair<index>> list;
    std::vector<index_pair> bodies;
    for (std::uint32_t a = 0; a < n; ++a) {
        for (std::uint32_t b = a + 1; b < n; ++b) {
            bodies.push_back({a, b});
            list.push_back({moving(posed(indices[index_of[a]], from[a]), posed(indices[index_of[a]], to[a])),
                            moving(posed(indices[index_of[b]], from[b]), posed(indices[index_of[b]], to[b]))});
        }
    }
    const auto all = to_host(first_meetings(on, list, {tolerance}));
    std::vector<body_meeting> expected, odd;
    std::vector<index_pair> touching;
    std::size_t late = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].a == no_id) continue;
        expected.push_back({bodies[i].a, bodies[i].b, all[i]});
        touching.push_back(bodies[i]);
        if ((bodies[i].a + bodies[i].b) % 2 == 1) odd.push_back(expected.back());
        late += all[i].time > 0;
    }
    CAPTURE(n, expected.size(), late);
    CHECK(late > n / 8);
    CHECK(expected.size() < all.size());
    CHECK(to_host(first_meetings(on, frame, {.tolerance = tolerance})) == expected);
    CHECK(to_host(first_meetings(on, frame, scene_meeting_options<odd_bodies_only>{tolerance, {}})) == odd);
    CHECK(to_host(touching_bodies(on, frame, {.tolerance = tolerance})) == touching);

    // Against a scene at rest, on either side.
    const auto room_at = scene_poses<T>(303, 12, reach);
    const std::vector<std::uint32_t> room_of(12, 1);
    const auto room = make_bodies(on, indices, room_of, room_at);
    std::vector<moving_pair<index>> against;
    for (std::uint32_t a = 0; a < n; ++a) {
        for (const auto& at : room_at) {
            against.push_back({moving(posed(indices[index_of[a]], from[a]), posed(indices[index_of[a]], to[a])), posed(long_ones, at)});
        }
    }
    const auto met = to_host(first_meetings(on, against, {tolerance}));
    std::vector<body_meeting> of_room;
    std::vector<index_pair> reversed;
    for (std::uint32_t i = 0; i < met.size(); ++i) {
        if (met[i].a != no_id) of_room.push_back({i / 12, i % 12, met[i]});
    }
    for (std::uint32_t k = 0; k < 12; ++k) {
        for (std::uint32_t a = 0; a < n; ++a) {
            if (met[12 * a + k].a != no_id) reversed.push_back({k, a});
        }
    }
    CHECK(!of_room.empty());
    CHECK(to_host(first_meetings(on, frame, room, {.tolerance = tolerance})) == of_room);
    CHECK(to_host(touching_bodies(on, room, frame, {.tolerance = tolerance})) == reversed);
}

}  // namespace

TEST_CASE("scenes of bodies that move: serial") {
    check_scene_meetings<float>(serial{}, 60, 9);
    check_scene_meetings<double>(serial{}, 40, 6);
}
TEST_CASE("scenes of bodies that move: openmp on 3 threads") { check_scene_meetings<float>(openmp{3}, 60, 9); }

TEST_CASE("scenes of bodies that move: boxes hold all points at all times") {
    std::size_t outside = 0, wide = 0;
    for (std::uint64_t i = 0; i < test::some_samples(10); ++i) {
        test::draws d(test::sample_seed, 304, i);
        const rigid<float> from = test::pose_that_turns<float>(d, 9), to = test::pose_that_turns<float>(d, 9);
        const auto at = test::point_that_turns<float>(d, 4), size = test::point_that_turns<float>(d, 2);
        const aabb<float> box = bounds(segment<float>{at, at + size});
        detail::rigid_motion m{};
        try {
            m = detail::make_rigid_motion(from, to, turning<float>{}, "test");
        } catch (const error&) {
            continue;  // a half turn
        }
        const aabb<float> way = detail::box_on_way(m, box, 0);
        for (int k = 0; k <= 40; ++k) {
            const auto frame = m.frame(k / 40.0);
            for (int corner = 0; corner < 8; ++corner) {
                const vec3<double> p{static_cast<double>(corner & 1 ? box.upper.x : box.lower.x), static_cast<double>(corner & 2 ? box.upper.y : box.lower.y),
                                     static_cast<double>(corner & 4 ? box.upper.z : box.lower.z)};
                const vec3<double> x = frame.place(detail::plain_step(p, -1.0, m.centre));
                const auto l = detail::widened(way.lower), u = detail::widened(way.upper);
                outside += !(x.x >= l.x && x.y >= l.y && x.z >= l.z && x.x <= u.x && x.y <= u.y && x.z <= u.z);
            }
        }
        wide += way.upper.x - way.lower.x > 60;
    }
    CHECK(outside == 0);
    CHECK(wide == 0);
}

TEST_CASE("scenes of bodies that move: what is refused") {
    const serial on;
    const auto ball = make_bvh(on, spheres<float>{{{0, 0, 0}, 1}});
    const rigid<float> here, half{{-1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 0, 0}};
    const auto scene = make_bodies(on, std::vector{posed(ball, here)});
    const auto says = [](const auto& ask, const char* what) {
        try {
            ask();
            FAIL_CHECK("was taken");
        } catch (const error& e) {
            CHECK(std::string(e.what()).find(what) != std::string::npos);
        }
    };
    says([&] { (void)moving(scene, make_bodies(on, std::vector{posed(ball, here)})); }, "abut::moving: another scene at t = 1");
    const std::vector<rigid<float>> turned{half};
    const auto frame = moving(scene, refit(on, scene, turned));
    says([&] { (void)first_meetings(on, frame, {.tolerance = 1e-3}); }, "abut::first_meetings: body 0");
    says([&] { (void)first_meetings(on, moving(scene, scene), {.tolerance = 0}); }, "the tolerance is 0");
    CHECK(first_meetings(on, moving(scene, scene), {.tolerance = 1e-3}).size() == 0);
    says([&] { (void)first_meetings(on, moving(scene, scene), scene, {.tolerance = 1e-30}); }, "bodies 0 and 0: the tolerance");
}
