// SPDX-License-Identifier: MIT
#pragma once

// What queries of many bodies promise on every policy: of each two bodies what a plain loop over their placed shapes says of
// them, named and sorted; also after the bodies have moved.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "posed_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"
#include "support/touching.hpp"

namespace abut::test {

/// Keeps some pairs, by all four numbers.
struct some_bodies {
    ABUT_HD bool operator()(body_pair p) const { return (p.body_a + 2 * p.body_b + p.a + 3 * p.b) % 5 != 0; }
};

/// A scene of bodies: sets on the host, the policy's trees over them, and which set each body has.
template <class Policy, class Set>
struct scene_of_bodies {
    using T = typename Set::scalar_type;
    using tree = decltype(make_bvh(std::declval<const Policy&>(), std::declval<const Set&>()));

    std::vector<Set> sets;
    std::vector<tree> trees;
    std::vector<std::size_t> kinds;
    std::vector<posed_object<tree>> bodies;

    scene_of_bodies(const Policy& on, std::vector<Set> of) : sets(std::move(of)) {
        for (const Set& set : sets) trees.push_back(make_bvh(on, set));
    }
    void add(std::size_t kind, const rigid<T>& pose) {
        kinds.push_back(kind);
        bodies.push_back(posed(trees[kind], pose));
    }
    /// f(i, j, a, b) for each two bodies and their posed sets.
    template <class F>
    void for_each_two(const F& f) const {
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
                f(i, j, posed(sets[kinds[i]], bodies[i].pose), posed(sets[kinds[j]], bodies[j].pose));
            }
        }
    }
    [[nodiscard]] std::vector<body_pair> truth() const {
        std::vector<body_pair> all;
        for_each_two([&](std::uint32_t i, std::uint32_t j, const auto& a, const auto& b) {
            for (const index_pair& p : pairs<exact>(serial{}, a, b)) all.push_back({i, j, p.a, p.b});
        });
        return all;
    }
    [[nodiscard]] std::vector<body_contact<T>> true_contacts() const {
        std::vector<body_contact<T>> all;
        for_each_two([&](std::uint32_t i, std::uint32_t j, const auto& a, const auto& b) {
            for (const contact<T>& c : contacts(serial{}, a, b)) all.push_back({i, j, c.a, c.b, c.point, c.normal, c.depth});
        });
        return all;
    }
    [[nodiscard]] std::vector<rigid<T>> poses() const {
        std::vector<rigid<T>> all;
        for (const auto& body : bodies) all.push_back(body.pose);
        return all;
    }
    void move_to(const std::vector<rigid<T>>& poses) {
        for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].pose = poses[i];
    }
};

/// Asks in all ways, and on a device in some, since each takes nvcc half a minute. Returns the number of pairs.
template <class Policy, class Set>
std::size_t check_bodies(const Policy& on, const scene_of_bodies<Policy, Set>& scene) {
    const auto& bodies = scene.bodies;
    const std::vector<body_pair> expected = scene.truth();
    CAPTURE(bodies.size(), expected.size());
    CHECK((to_host(pairs(on, bodies)) == expected));
    auto unsorted = to_host(pairs(on, bodies, {.sorted = false, .most_pairs = 3}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK((unsorted == expected));
    CHECK(count(on, bodies) == expected.size());
    CHECK(any(on, bodies) == !expected.empty());

    const body_options<some_bodies> with_filter{.filter = {}};
    auto some = expected;
    std::erase_if(some, [](const body_pair& p) { return !some_bodies{}(p); });
    CHECK((to_host(pairs(on, bodies, with_filter)) == some));
    if constexpr (host_policy<Policy>) {
        CHECK(count(on, bodies, with_filter) == some.size());
        CHECK(any(on, bodies, with_filter) == !some.empty());
        CHECK((to_host(pairs<exact>(on, bodies)) == expected));
    }
    return expected.size();
}

/// Bodies of none to some hundred faces, near each other and far, some in one place.
template <class T, class Policy>
void check_random_bodies(const Policy& on) {
    constexpr std::uint64_t seed = 20270401;
    std::printf("many bodies: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::vector<triangle_soup<T>> sets;
    for (const std::size_t n : {0u, 1u, 2u, 3u, 100u}) sets.emplace_back(random_triangles<T>(n, random));
    const torus<T> shape(12, 8, T(0.7), T(0.3));
    sets.emplace_back(triangles_of(shape.vertices, shape.faces));
    for (const std::size_t n : {0u, 1u, 2u, 60u}) {
        for (const double far : {0.5, 2.0, 1e3}) {
            scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
            draws d(seed, 94, n);
            for (std::size_t i = 0; i < n; ++i) {
                const auto pose = i % 2 == 0 ? make_pose<T>(d, far) : make_loose_pose<T>(d, far);
                scene.add(random.below(sets.size()), i % 7 == 6 ? scene.bodies.back().pose : pose);
            }
            CAPTURE(n, far);
            const std::size_t hits = check_bodies(on, scene);
            CHECK((n < 60 || hits > (far < 1 ? 3000u : far < 3 ? 300u : 0u)));
        }
    }
}

/// Cubes of a lattice meet in faces, edges and corners, and in nothing where they are one unit in the last place apart.
template <class T, class Policy>
void check_cube_lattice(const Policy& on) {
    const std::vector<vec3<T>> vertices{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                        {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
    const std::vector<face> faces{{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                  {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    draws d(20270402, 95, 0);
    for (const bool apart : {false, true}) {
        scene_of_bodies<Policy, triangle_soup<T>> scene(on, {triangle_soup<T>(triangles_of(vertices, faces))});
        std::size_t neighbours = 0;
        for (int k = 0; k < 27; ++k) {
            rigid<T> pose;
            construction::set_quarter_turns(pose, d);
            const auto along = [&](int step) {
                const T x = static_cast<T>(2 * step);
                return apart && step == 2 ? detail::next_up(x) : x;
            };
            pose.translation = {along(k % 3), along(k / 3 % 3), along(k / 9)};
            scene.add(0, pose);
            const auto near = [&](int j, int by) {
                return std::abs(k / by % 3 - j / by % 3) <= 1 && !(apart && (k / by % 3 == 2) != (j / by % 3 == 2));
            };
            for (int j = 0; j < k; ++j) neighbours += near(j, 1) && near(j, 3) && near(j, 9) ? 1 : 0;
        }
        CAPTURE(apart);
        check_bodies(on, scene);
        std::set<std::pair<std::uint32_t, std::uint32_t>> met;
        for (const body_pair& p : to_host(pairs(on, scene.bodies))) met.emplace(p.body_a, p.body_b);
        CHECK(met.size() == neighbours);
        CHECK(neighbours == (apart ? 49u : 158u));
    }
}

/// Two triangles under two poses that meet in a point, or miss it by little, wherever and as large as numbers allow.
template <class T, class Policy>
void check_touching_bodies(const Policy& on) {
    std::vector<triangle_soup<T>> sets;
    std::vector<rigid<T>> poses;
    const auto is_finite = [](const triangle<T>& t) {
        return detail::is_finite(detail::magnitudes(t.a) + detail::magnitudes(t.b) + detail::magnitudes(t.c));
    };
    std::size_t meet = 0;
    for (std::uint64_t i = 0; i < 150; ++i) {
        draws d(20270403, 96, i);
        const auto c = make_posed_contact<T>(d, i % 2 == 1);
        if (!is_finite(place(c.pose_a, c.a)) || !is_finite(place(c.pose_b, c.b))) continue;
        // The one whose box is smaller has the later number every other time.
        const std::vector<triangle<T>> two_a{c.a, c.a}, some_b(i % 3 + 1, c.b);
        sets.emplace_back(i % 2 == 0 ? two_a : some_b);
        sets.emplace_back(i % 2 == 0 ? some_b : two_a);
        poses.push_back(i % 2 == 0 ? c.pose_a : c.pose_b);
        poses.push_back(i % 2 == 0 ? c.pose_b : c.pose_a);
        meet += intersects<exact>(place(c.pose_a, c.a), place(c.pose_b, c.b)) ? 1 : 0;
    }
    CHECK(meet > 40);
    scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
    for (std::size_t i = 0; i < sets.size(); ++i) scene.add(i, poses[i]);
    CHECK(check_bodies(on, scene) >= meet);
}

/// Balls that touch in one point, under poses that shrink all but their radii; some bodies are one ball.
template <class T, class Policy>
void check_ball_bodies(const Policy& on) {
    const spheres<T> one({{{0, 0, 0}, 1}}), two({{{0, 0, 0}, 1}, {{0, 0, 0}, T(0.5)}});
    scene_of_bodies<Policy, spheres<T>> scene(on, {one, two, spheres<T>()});
    const T s = T(1) - T(0x1p-12);
    for (int i = 0; i < 12; ++i) {
        scene.add(static_cast<std::size_t>(i % 5 == 4 ? 2 : i % 2),
                  {{s, 0, 0, 0, s, 0, 0, 0, s}, {static_cast<T>(2 * i), 0, 0}});
    }
    CHECK(check_bodies(on, scene) == 7);
}

/// What a call throws has to name the function and the body.
template <class Policy, class Bodies>
void check_refused(const Policy& on, const Bodies& bodies, const std::string& words) {
    const auto check_one = [&](const auto& call, const std::string& name) {
        try {
            call();
            FAIL("not refused: " << words);
        } catch (const invalid_geometry& problem) {
            CAPTURE(problem.what());
            CHECK(std::string(problem.what()).find(name + ": " + words) == 0);
        }
    };
    check_one([&] { (void)pairs(on, bodies); }, "abut::pairs");
    check_one([&] { (void)count(on, bodies); }, "abut::count");
    check_one([&] { (void)any(on, bodies); }, "abut::any");
}

template <class T, class Policy>
void check_body_errors(const Policy& on) {
    constexpr T far = largest_finite<T> / 2;
    const triangle<T> small{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, large{{0, 0, 0}, {far, 0, 0}, {0, far, 0}};
    const std::vector<triangle<T>> none, one{small}, two{small, large};
    scene_of_bodies<Policy, triangle_soup<T>> scene(on,
                                                    {triangle_soup<T>(none), triangle_soup<T>(one), triangle_soup<T>(two)});
    rigid<T> bent, shifted;
    bent.rotation[0] = T(1.01);
    shifted.translation = {far, 0, 0};
    for (const std::size_t kind : {1u, 2u, 0u}) scene.add(kind, {});
    auto bad = scene;
    bad.add(1, bent);
    check_refused(on, bad.bodies, "body 3: rotation row 0");
    bad.bodies.back() = posed(scene.trees[0], bent);  // also where there is nothing to place
    check_refused(on, bad.bodies, "body 3: rotation row 0");
    rigid<T> infinite;
    infinite.translation.x = infinity<T>;
    bad.bodies.back() = posed(scene.trees[0], infinite);
    check_refused(on, bad.bodies, "body 3: translation coordinate 0");
    bad.bodies.back() = scene.bodies[0];
    rigid<T> farther = shifted;
    farther.translation.x = T(1.5) * far;
    bad.bodies[1] = posed(scene.trees[2], farther);
    check_refused(on, bad.bodies, "body 1: posed shape 1");
    // Huge, and yet finite: their boxes are all of space.
    scene.add(2, {});
    scene.add(1, shifted);
    rigid<T> elsewhere = shifted;
    elsewhere.translation.y = -far;
    scene.add(2, elsewhere);
    scene.add(1, elsewhere);
    CHECK(check_bodies(on, scene) > 5);
}

/// Sums up what it is shown, by all four numbers.
struct sum_of_bodies {
    std::uint64_t* sum;
    ABUT_HD static std::uint64_t of(body_pair p) {
        return ((p.body_a * 31 + p.body_b) * std::uint64_t{1009} + p.a) * 10007 + p.b + 1;
    }
    ABUT_HD visit operator()(body_pair p) const {
        execution::atomic_add(sum, of(p));
        return visit::proceed;
    }
};

/// Whether two scenes have one topology: then the later one was refitted, and not built.
template <class Bodies>
bool have_one_topology(const Bodies& a, const Bodies& b) {
    return a.tree().stored().plan == b.tree().stored().plan;
}

/// Bodies that go a little from frame to frame keep their tree, those that change places get a new one, and answers are
/// right either way.
template <class T, class Policy>
void check_moving_bodies(const Policy& on) {
    constexpr std::uint64_t seed = 20270405;
    std::printf("moving bodies: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::vector<triangle_soup<T>> sets;
    for (const std::size_t n : {0u, 1u, 2u, 20u}) sets.emplace_back(random_triangles<T>(n, random));
    const torus<T> shape(6, 5, T(0.7), T(0.3));
    sets.emplace_back(triangles_of(shape.vertices, shape.faces));
    scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
    std::vector<std::uint32_t> kinds;
    draws d(seed, 98, 0);
    constexpr std::size_t n = 60;
    for (std::size_t i = 0; i < n; ++i) {
        kinds.push_back(static_cast<std::uint32_t>(i < 40 ? 4 : random.below(sets.size())));
        scene.add(kinds.back(), make_pose<T>(d, 3));
    }
    const auto first = make_bodies(on, scene.trees, kinds, scene.poses());
    REQUIRE(first.size() == n);
    CHECK(first.indices().size() == sets.size());
    CHECK(first.tree().size() < n);  // some are empty
    auto all = first;
    std::size_t hits = 0;
    for (int frame = 0; frame < 6; ++frame) {
        CAPTURE(frame);
        if (frame > 0) {
            auto poses = scene.poses();
            if (frame == 3) {
                for (std::size_t i = n; i-- > 1;) std::swap(poses[i].translation, poses[random.below(i + 1)].translation);
            } else {
                const auto by = [&] { return static_cast<T>(0.1 * random()); };
                for (auto& pose : poses) pose.translation = pose.translation + vec3<T>{by(), by(), by()};
            }
            scene.move_to(poses);
            const auto before = all;
            if (frame % 2 == 0) {
                all = refit(on, all, poses);
            } else {
                execution::buffer_of<Policy, rigid<T>> there(on, n);
                upload(on, poses.data(), n, there.data());
                synchronize(on);
                all = refit(on, all, poses_view<T, space_of<Policy>>{there.data(), n});
            }
            CHECK(have_one_topology(before, all) == (frame != 3));
        }
        const auto expected = scene.truth();
        hits += expected.size();
        CHECK((to_host(pairs(on, all)) == expected));
        CHECK(count(on, all) == expected.size());
        if (frame != 4) continue;
        CHECK((to_host(contacts(on, all)) == scene.true_contacts()));
        std::uint64_t sum = 0, expected_sum = 0;
        execution::buffer_of<Policy, std::uint64_t> there(on, 1);
        fill(on, there.data(), 1, std::uint64_t{0});
        for_each_pair(on, all, sum_of_bodies{there.data()});
        download(on, there.data(), 1, &sum);
        for (const body_pair& p : expected) expected_sum += sum_of_bodies::of(p);
        CHECK(sum == expected_sum);
    }
    CHECK(hits > 500);
    CHECK((to_host(pairs(on, first)) != to_host(pairs(on, all))));  // what was made stays as it is
}

/// What making and refitting refuse.
template <class T, class Policy>
void check_refused_bodies(const Policy& on) {
    const std::vector<triangle<T>> some{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    const std::vector trees{make_bvh(on, triangle_soup<T>(some))};
    const auto message_of = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const error& problem) {
            return problem.what();
        }
        return "";
    };
    const std::vector<std::uint32_t> kinds{0, 0, 0};
    std::vector<rigid<T>> poses(3);
    const auto all = make_bodies(on, trees, kinds, poses);
    CHECK(message_of([&] {
              (void)make_bodies(on, trees, std::vector<std::uint32_t>{0, 0}, poses);
          }) == "abut::make_bodies: there are 2 numbers of indices and 3 poses");
    CHECK(message_of([&] {
              (void)make_bodies(on, trees, std::vector<std::uint32_t>{0, 1, 0}, poses);
          }).find("abut::make_bodies: body 1: its index is out of range, there are 1") == 0);
    CHECK(message_of([&] { (void)refit(on, all, std::vector<rigid<T>>(2)); }) ==
          "abut::refit: there are 3 bodies and 2 poses");
    constexpr T largest = largest_finite<T>;
    for (int k = 0; k < 6; ++k) {
        auto bad = poses;
        rigid<T>& pose = bad[2];
        if (k == 0) pose.rotation[4] = T(1.01);
        if (k == 1) pose.rotation[1] = T(0.01);
        if (k == 2) pose.rotation[8] = -1;
        if (k == 3) pose.translation.y = infinity<T>;
        if (k == 4) pose.rotation[0] = std::numeric_limits<T>::quiet_NaN();
        if (k == 5) pose.translation = {largest, largest, largest};  // refused by nothing: all shapes stay finite
        const std::string words[] = {"rotation row 1", "rotation row 1", "rotation 0", "translation coordinate 1",
                                     "rotation entry 0"};
        CAPTURE(k);
        const auto said = message_of([&] { (void)refit(on, all, bad); });
        const auto made = message_of([&] { (void)make_bodies(on, trees, kinds, bad); });
        CHECK(said.find(k < 5 ? "abut::refit: body 2: " + words[k] : "") == 0);
        CHECK(made.find(k < 5 ? "abut::make_bodies: body 2: " + words[k] : "") == 0);
        CHECK(said.empty() == (k == 5));
        CHECK(made.empty() == (k == 5));
    }
    // Of no bodies.
    const auto none = refit(on, make_bodies(on, trees, {}, {}), {});
    CHECK(none.size() == 0);
    CHECK(pairs(on, none).empty());
}

/// Equal bodies in one place: each two have in common what one has with itself.
template <class T, class Policy>
void check_equal_bodies(const Policy& on) {
    const torus<T> shape(6, 5, T(0.7), T(0.3));
    const std::vector trees{make_bvh(on, triangle_soup<T>(triangles_of(shape.vertices, shape.faces)))};
    draws d(20270406, 99, 0);
    constexpr std::size_t n = 60;
    const auto all = make_bodies(on, trees, std::vector<std::uint32_t>(n), std::vector<rigid<T>>(n, make_pose<T>(d, 4)));
    const auto of_two = count(on, trees[0], trees[0]);
    CHECK(of_two > 60);
    const auto found = to_host(pairs(on, all));
    CHECK(found.size() == n * (n - 1) / 2 * of_two);
    CHECK(std::is_sorted(found.begin(), found.end()));
    CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
}

template <class T, class Policy>
void check_all_bodies(const Policy& on) {
    check_random_bodies<T>(on);
    check_cube_lattice<T>(on);
    check_touching_bodies<T>(on);
    check_ball_bodies<T>(on);
    check_body_errors<T>(on);
    check_moving_bodies<T>(on);
    check_refused_bodies<T>(on);
    check_equal_bodies<T>(on);
}

}  // namespace abut::test
