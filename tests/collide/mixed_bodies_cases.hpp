// SPDX-License-Identifier: MIT
#pragma once

// What scenes of several kinds of bodies promise on every policy: all that a plain loop over single placed shapes says, in
// the order of the numbers that run through the scene. Not what bodies of one kind promise (body_cases.hpp).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <abut/abut.hpp>

#include "collide/body_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// Kinds of bodies, on the host and as the policy's lists, and all their shapes in the world, in order.
template <class Policy, class... Sets>
struct mixed_scene {
    using T = typename std::tuple_element_t<0, std::tuple<Sets...>>::scalar_type;
    using any_shape = std::variant<decltype(place(rigid<T>{}, std::declval<const Sets&>().view()[0]))...>;
    struct shape_of_body {
        std::uint32_t body, id;
        any_shape shape;
    };

    std::tuple<scene_of_bodies<Policy, Sets>...> kinds;

    mixed_scene(const Policy& on, std::vector<Sets>... sets)
        : kinds(scene_of_bodies<Policy, Sets>(on, std::move(sets))...) {}

    [[nodiscard]] auto made(const Policy& on) const {
        return std::apply([&](const auto&... kind) { return make_bodies(on, kind.bodies...); }, kinds);
    }
    [[nodiscard]] std::vector<shape_of_body> shapes() const {
        std::vector<shape_of_body> all;
        std::uint32_t body = 0;
        add_shapes(all, body, std::index_sequence_for<Sets...>());
        return all;
    }
    [[nodiscard]] std::vector<rigid<T>> poses() const {
        std::vector<rigid<T>> all;
        for_each_kind([&](const auto& kind) {
            for (const auto& body : kind.bodies) all.push_back(body.pose);
        });
        return all;
    }
    template <class F>
    void for_each_kind(const F& f) const {
        std::apply([&](const auto&... kind) { (f(kind), ...); }, kinds);
    }
    template <class F>
    void for_each_kind(const F& f) {
        std::apply([&](auto&... kind) { (f(kind), ...); }, kinds);
    }

private:
    template <std::size_t... K>
    void add_shapes(std::vector<shape_of_body>& all, std::uint32_t& body, std::index_sequence<K...>) const {
        const auto add = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
            const auto& kind = std::get<I>(kinds);
            for (std::size_t i = 0; i < kind.bodies.size(); ++i, ++body) {
                const auto& set = kind.sets[kind.kinds[i]];
                for (std::uint32_t id = 0; id < set.size(); ++id) {
                    all.push_back({body, id, any_shape(std::in_place_index<I>, place(kind.bodies[i].pose, set.view()[id]))});
                }
            }
        };
        (add(std::integral_constant<std::size_t, K>()), ...);
    }
};

/// f(x, y, shape of x, shape of y) of each two shapes of two bodies.
template <class Shape, class F>
void for_each_two_shapes(const std::vector<Shape>& all, const F& f) {
    for (const Shape& x : all) {
        for (const Shape& y : all) {
            if (x.body >= y.body) continue;
            std::visit([&](const auto& s, const auto& t) { f(x, y, s, t); }, x.shape, y.shape);
        }
    }
}

/// Bodies that are no neighbours by their numbers.
struct no_neighbours {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return a + 1 != b; }
};
/// Keeps bodies by their numbers, for rows.
struct no_body_of_three {
    ABUT_HD bool operator()(std::uint32_t row, std::uint32_t body, std::uint32_t id) const {
        return (row + body + id) % 3 != 0;
    }
};
/// Counts what it is given, until there is enough.
struct count_some {
    std::uint32_t* seen;
    std::uint32_t enough;
    ABUT_HD visit operator()(const body_pair& pair) const {
        (void)execution::atomic_add(seen, std::uint32_t{1});
        return pair.body_a < pair.body_b && enough == 0 ? visit::proceed : visit::stop;
    }
};

/// All questions about pairs, or some, since each takes a compiler as long as there are two kinds. Returns how many touch.
template <bool All, class Policy, class Scene, class Made>
std::size_t check_mixed_pairs(const Policy& on, const Scene& scene, const Made& all) {
    using T = typename Scene::T;
    const auto shapes = scene.shapes();
    const double near = 0.25;
    std::vector<body_pair> touch, close;
    std::vector<body_contact<T>> how;
    for_each_two_shapes(shapes, [&](const auto& x, const auto& y, const auto& s, const auto& t) {
        const body_pair named{x.body, y.body, x.id, y.id};
        if (intersects<exact>(s, t)) touch.push_back(named);
        if (any_within<exact>(serial{}, s, t, near)) close.push_back(named);
        if (const auto c = contact_of(s, t)) how.push_back({x.body, y.body, x.id, y.id, c->point, c->normal, c->depth});
    });
    // Shapes ascend, but of two bodies the second's ids run within the first's: the order of (body, body, id, id) is
    // another.
    std::sort(touch.begin(), touch.end());
    std::sort(close.begin(), close.end());
    const auto by_numbers = [](const auto& x, const auto& y) {
        return body_pair{x.body_a, x.body_b, x.a, x.b} < body_pair{y.body_a, y.body_b, y.a, y.b};
    };
    std::sort(how.begin(), how.end(), by_numbers);
    CAPTURE(touch.size(), close.size());

    CHECK((to_host(pairs(on, all)) == touch));
    auto unsorted = to_host(pairs(on, all, {.sorted = false}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK((unsorted == touch));
    CHECK(any_within(on, all, near) == !close.empty());
    const auto of_bodies = [](const std::vector<body_pair>& pairs) {
        std::vector<index_pair> two;
        for (const body_pair& p : pairs) two.push_back({p.body_a, p.body_b});
        two.erase(std::unique(two.begin(), two.end()), two.end());
        return two;
    };
    CHECK((to_host(touching_bodies(on, all)) == of_bodies(touch)));
    if constexpr (All) {
        CHECK(count(on, all) == touch.size());
        CHECK(any(on, all) == !touch.empty());
        CHECK((to_host(contacts(on, all)) == how));
        CHECK((to_host(within(on, all, near)) == close));
        CHECK(count_within(on, all, near) == close.size());
        CHECK((to_host(bodies_within(on, all, near)) == of_bodies(close)));
    }

    // Filters are told of numbers in the scene.
    const body_options<some_bodies, schedule::shared_list, no_neighbours> wanted{};
    std::erase_if(touch, [](const body_pair& p) { return !some_bodies{}(p) || !no_neighbours{}(p.body_a, p.body_b); });
    CHECK(count(on, all, wanted) == touch.size());
    if constexpr (All) CHECK((to_host(pairs(on, all, wanted)) == touch));

    // Visitors see each once, and when one has stopped, other kinds are not looked at.
    execution::buffer_of<Policy, std::uint32_t> seen(on, 1);
    const auto visits = [&](std::uint32_t enough) {
        fill(on, seen.data(), 1, std::uint32_t{0});
        for_each_within(on, all, near, count_some{seen.data(), enough});
        std::uint32_t n = 0;
        download(on, seen.data(), 1, &n);
        return n;
    };
    CHECK(visits(0) == close.size());
    if constexpr (std::same_as<Policy, serial>) CHECK(visits(1) == std::min<std::size_t>(close.size(), 1));
    return how.size();
}

/// All questions of rays and points. Returns how many hits there are.
template <class Policy, class Scene, class Made>
std::size_t check_mixed_rows(const Policy& on, const Scene& scene, const Made& all, std::uint64_t seed) {
    using T = typename Scene::T;
    const auto shapes = scene.shapes();
    uniform random(seed);
    std::vector<ray<T>> lines;
    std::vector<vec3<T>> from;
    for (int i = 0; i < 40; ++i) {
        const vec3<T> p = random.point<T>(-3, 3), q = random.point<T>(-3, 3);
        lines.push_back({p, q - p});
        from.push_back(p);
    }
    const rays<T> rows(lines);
    const raycast_options<no_body_of_three> some{.filter = {}, .least_t = 0.125};
    std::size_t hits = 0;
    for (const bool filtered : {false, true}) {
        const auto first = to_host(filtered ? raycast(on, all, rows, some) : raycast(on, all, rows));
        const auto any = to_host(filtered ? raycast_any(on, all, rows, some) : raycast_any(on, all, rows));
        const auto every = to_host(filtered ? raycast_all(on, all, rows, some) : raycast_all(on, all, rows));
        std::vector<body_hit_of_ray<T>> true_hits;
        std::size_t wrong = 0;
        for (std::uint32_t k = 0; k < lines.size(); ++k) {
            std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> met;
            for (const auto& x : shapes) {
                const double t = std::visit([&](const auto& s) { return detail::hit_time<exact>(lines[k], s); }, x.shape);
                if (t < 0 || (filtered && (t < 0.125 || !no_body_of_three{}(k, x.body, x.id)))) continue;
                met.emplace_back(t, x.body, x.id);
            }
            std::sort(met.begin(), met.end());
            for (const auto& [t, body, id] : met) true_hits.push_back({k, body, id, detail::time_as<T>(t)});
            body_hit<T> expected{no_id, no_id, infinity<T>};
            if (!met.empty()) {
                expected = {std::get<1>(met[0]), std::get<2>(met[0]), detail::time_as<T>(std::get<0>(met[0]))};
            }
            wrong += first[k] != expected;
            wrong += any[k] != (met.empty() ? 0 : 1);
        }
        CHECK(wrong == 0);
        CHECK((every == true_hits));
        hits += true_hits.size();
    }
    // The distances of single shapes, rounded to T, and whose they are. Of those that are alike after rounding any is right
    // here.
    const std::size_t few = 4;
    const nearest_options<no_body_of_three> wanted{.count = few, .filter = {}};
    std::size_t wrong = 0;
    const auto one = to_host(nearest(on, all, from));
    const auto more = to_host(nearest(on, all, from, few));
    const auto some_near = to_host(nearest(on, all, from, wanted));
    for (std::uint32_t k = 0; k < from.size(); ++k) {
        const auto check = [&](const body_neighbor<T>* found, std::size_t n, bool filtered) {
            std::vector<std::pair<T, body_neighbor<T>>> truth;
            for (const auto& x : shapes) {
                if (filtered && !no_body_of_three{}(k, x.body, x.id)) continue;
                const auto near = std::visit([&](const auto& s) { return nearest(serial{}, s, from[k])[0]; }, x.shape);
                truth.push_back({near.distance, {x.body, x.id, near.point, near.distance}});
            }
            std::stable_sort(truth.begin(), truth.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
            for (std::size_t i = 0; i < n; ++i) {
                if (i >= truth.size()) {
                    wrong += found[i] != body_neighbor<T>{no_id, no_id, from[k], infinity<T>};
                    continue;
                }
                wrong += found[i].distance != truth[i].first;
                wrong += std::none_of(truth.begin(), truth.end(), [&](const auto& x) { return x.second == found[i]; });
                for (std::size_t j = 0; j < i; ++j) {
                    wrong += found[i].body == found[j].body && found[i].id == found[j].id;
                }
            }
        };
        check(&one[k], 1, false);
        check(&more[few * k], few, false);
        check(&some_near[few * k], few, true);
    }
    CHECK(wrong == 0);
    return hits;
}

/// How far the nearest two bodies are apart.
template <class Policy, class Scene, class Made>
double check_mixed_distance(const Policy& on, const Scene& scene, const Made& all) {
    using T = typename Scene::T;
    std::vector<body_separation<T>> nearest;
    for_each_two_shapes(scene.shapes(), [&](const auto& x, const auto& y, const auto& s, const auto& t) {
        const auto apart = *distance(serial{}, s, t);
        if (!nearest.empty() && nearest.front().distance < apart.distance) return;
        if (!nearest.empty() && apart.distance < nearest.front().distance) nearest.clear();
        nearest.push_back({x.body, y.body, x.id, y.id, apart.point_a, apart.point_b, apart.distance});
    });
    const auto found = distance(on, all);
    CHECK(found.has_value() == !nearest.empty());
    if (!found) return infinity<double>;
    CAPTURE(found->body_a, found->body_b, found->a, found->b, found->distance, nearest[0].body_a, nearest[0].body_b);
    CHECK(std::find(nearest.begin(), nearest.end(), *found) != nearest.end());
    const auto by_numbers = [](const auto& x, const auto& y) {
        return body_pair{x.body_a, x.body_b, x.a, x.b} < body_pair{y.body_a, y.body_b, y.a, y.b};
    };
    if (found->distance == 0) CHECK(*std::min_element(nearest.begin(), nearest.end(), by_numbers) == *found);
    const auto is = static_cast<double>(found->distance);
    CHECK(!distance(on, all, {.below = is}).has_value());
    CHECK(distance(on, all, {.below = 2 * is + 1}) == found);
    return is;
}

/// Meshes, boxes and capsules at random; some of the lists are empty, and some bodies have no shapes.
template <class T, class Policy>
mixed_scene<Policy, mesh<T>, boxes<T>, capsules<T>> random_mixed_scene(const Policy& on, std::uint64_t seed, double spread,
                                                                       std::array<std::size_t, 3> numbers) {
    const torus<T> ring(6, 5, T(0.7), T(0.3));
    const mesh<T> one(std::vector<vec3<T>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<face>{{0, 1, 2}});
    const aabb<T> box{{0, 0, 0}, {T(0.5), T(1), T(0.25)}}, plate{{-1, -1, 0}, {1, 1, 0}};
    const capsule<T> rod{{{0, 0, 0}, {1, 0, 0}}, T(0.25)}, ball{{{0, 0, 0}, {0, 0, 0}}, T(0.5)};
    mixed_scene<Policy, mesh<T>, boxes<T>, capsules<T>> scene(
        on, {mesh<T>(ring.vertices, ring.faces), one, mesh<T>()},
        {boxes<T>(std::vector{box}), boxes<T>(std::vector{box, plate})},
        {capsules<T>(std::vector{rod}), capsules<T>(), capsules<T>(std::vector{ball, rod, ball})});
    draws d(seed, 93, static_cast<std::uint64_t>(spread));
    std::size_t k = 0;
    scene.for_each_kind([&](auto& kind) {
        for (std::size_t i = 0; i < numbers[k]; ++i) {
            const auto pose = make_pose<T>(d, spread);
            kind.add(i % kind.sets.size(), i % 5 == 4 ? kind.bodies.back().pose : pose);
        }
        ++k;
    });
    return scene;
}

template <class T, bool All, class Policy>
void check_mixed_bodies(const Policy& on) {
    constexpr std::uint64_t seed = 20281128;
    std::size_t touch = 0, apart = 0, hits = 0;
    using three = std::array<std::size_t, 3>;
    for (const three numbers :
         {three{6, 7, 8}, three{0, 5, 5}, three{6, 0, 0}, three{0, 0, 5}, three{1, 1, 0}, three{0, 1, 0}, three{0, 0, 0}}) {
        for (const double spread : {1.5, 6.0}) {
            CAPTURE(numbers[0], numbers[1], numbers[2], spread);
            auto scene = random_mixed_scene<T>(on, seed, spread, numbers);
            auto all = scene.made(on);
            CHECK(all.size() == numbers[0] + numbers[1] + numbers[2]);
            touch += check_mixed_pairs<All>(on, scene, all);
            hits += check_mixed_rows(on, scene, all, seed);
            apart += check_mixed_distance(on, scene, all) > 0;
        }
    }
    CHECK((touch > 100 && apart > 4 && hits > 100));

    // After a move.
    auto scene = random_mixed_scene<T>(on, seed, 2.0, {4, 4, 4});
    const auto before = scene.made(on);
    scene.for_each_kind([&](auto& kind) {
        for (auto& body : kind.bodies) body.pose.translation.x *= T(0.5);
    });
    CHECK(check_mixed_pairs<All>(on, scene, refit(on, before, scene.poses())) > 5);
}

/// What is met, nearest and as far apart at once in several kinds: the least numbers win.
template <class T, class Policy>
void check_mixed_ties(const Policy& on) {
    const auto box = make_bvh(on, boxes<T>(std::vector<aabb<T>>{{{-1, -1, -1}, {1, 1, 1}}}));
    const auto ball = make_bvh(on, spheres<T>(std::vector<sphere<T>>{{{0, 0, 0}, 1}}));
    const auto at = [](T x) { return rigid<T>{.translation = {x, 0, 0}}; };
    using box_list = std::vector<posed_object<std::remove_const_t<decltype(box)>>>;
    using ball_list = std::vector<posed_object<std::remove_const_t<decltype(ball)>>>;
    const box_list some_boxes{posed(box, at(8)), posed(box, at(-4))};
    const ball_list some_balls{posed(ball, at(4)), posed(ball, at(-4)), posed(ball, at(16))};
    const auto check = [&](const auto& all, std::uint32_t nearest_body, std::uint32_t met, std::uint32_t a,
                           std::uint32_t b) {
        const auto near = to_host(nearest(on, all, std::vector<vec3<T>>{{0, 0, 0}}, 3));
        CHECK((near[0].body == nearest_body && near[0].distance == 3));
        CHECK(
            (near[1].distance == 3 && near[2].distance == 3 && near[0].body < near[1].body && near[1].body < near[2].body));
        const auto hit = to_host(raycast(on, all, ray<T>{{-8, 0, 0}, {1, 0, 0}}))[0];
        CHECK((hit.body == met && hit.t == 3));
        const auto apart = *distance(on, all);
        CHECK((apart.body_a == a && apart.body_b == b && apart.distance == 0));
    };
    check(make_bodies(on, some_boxes, some_balls), 1, 1, 1, 3);
    check(make_bodies(on, some_balls, some_boxes), 0, 1, 1, 4);
    // Two of one kind are 3 apart, and two of two kinds less.
    const auto between_kinds = *distance(on, make_bodies(on, box_list{posed(box, at(0)), posed(box, at(5))},
                                                         ball_list{posed(ball, rigid<T>{.translation = {0, T(4.5), 0}})}));
    CHECK((between_kinds.body_a == 0 && between_kinds.body_b == 2 && between_kinds.distance == 2.5));
    // All are 2 apart, of one kind and of two.
    const box_list two_boxes{posed(box, at(0)), posed(box, at(4))};
    const ball_list one_ball{posed(ball, at(-4))};
    for (const auto& found :
         {*distance(on, make_bodies(on, one_ball, two_boxes)), *distance(on, make_bodies(on, two_boxes, one_ball))}) {
        CHECK((found.body_a == 0 && found.body_b == 1 && found.distance == 2));
    }
    if constexpr (std::same_as<T, double>) {  // a unit for all kinds, so that no square overflows
        const T far = 0x1p700;
        const auto both = make_bodies(on, box_list{posed(box, at(far))}, one_ball);
        const auto near = to_host(nearest(on, both, std::vector<vec3<T>>{{0, 0, 0}}, 2));
        CHECK((near[0].body == 1 && near[1].body == 0 && near[1].distance == far));
    }
    // Each two neighbours are 2 apart: the first two are of two kinds.
    const box_list far_boxes{posed(box, at(0)), posed(box, at(8))};
    const ball_list far_balls{posed(ball, at(4)), posed(ball, at(12))};
    const auto apart = *distance(on, make_bodies(on, far_boxes, far_balls));
    CHECK((apart.body_a == 0 && apart.body_b == 2 && apart.distance == 2));
    const auto swapped = *distance(on, make_bodies(on, far_balls, far_boxes));
    CHECK((swapped.body_a == 0 && swapped.body_b == 2 && swapped.distance == 2));
}

/// A policy says what `serial` says, of two kinds and in few questions: nvcc takes long for each.
template <class Policy>
void check_mixed_alike(const Policy& on) {
    using T = float;
    const auto scene_on = [](const auto& policy) {
        mixed_scene<std::remove_cvref_t<decltype(policy)>, boxes<T>, capsules<T>> scene(
            policy, {boxes<T>(std::vector<aabb<T>>{{{0, 0, 0}, {0.5f, 1, 0.25f}}, {{-1, -1, 0}, {1, 1, 0}}}), boxes<T>()},
            {capsules<T>(std::vector<capsule<T>>{{{{0, 0, 0}, {1, 0, 0}}, 0.25f}})});
        draws d(20281129, 92, 0);
        scene.for_each_kind([&](auto& kind) {
            for (std::size_t i = 0; i < 40; ++i) kind.add(i % kind.sets.size(), make_pose<T>(d, 2.5));
        });
        return scene;
    };
    const serial host;
    const auto there = scene_on(on);
    const auto all = refit(on, there.made(on), there.poses());
    const auto expected = scene_on(host).made(host);
    const body_options<keep_all, schedule::shared_list, no_neighbours> wanted{};
    const auto found = to_host(pairs(on, all, wanted));
    CHECK(found.size() > 20);
    CHECK((found == to_host(pairs(host, expected, wanted))));
    execution::buffer_of<Policy, std::uint32_t> seen(on, 1);
    fill(on, seen.data(), 1, std::uint32_t{0});
    for_each_pair(on, all, count_some{seen.data(), 0}, wanted);
    std::uint32_t n = 0;
    download(on, seen.data(), 1, &n);
    CHECK(n == found.size());

    uniform random(5);
    std::vector<ray<T>> lines;
    std::vector<vec3<T>> from;
    for (int i = 0; i < 100; ++i) {
        from.push_back(random.point<T>(-5, 5));
        const vec3<T> p = from.back(), q = random.point<T>(-5, 5);
        lines.push_back({p, q - p});
    }
    const rays<T> rows(lines);
    const auto hits = to_host(raycast_all(host, expected, rows));
    CHECK(hits.size() > 20);
    CHECK((to_host(raycast_all(on, all, rows)) == hits));
    CHECK((to_host(raycast(on, all, rows)) == to_host(raycast(host, expected, rows))));
    CHECK((to_host(nearest(on, all, from)) == to_host(nearest(host, expected, from))));
    CHECK(distance(on, all, {.below = 1}) == distance(host, expected));
    // In a row: none touch.
    auto far = there.poses();
    for (std::size_t i = 0; i < far.size(); ++i) far[i].translation.x += T(i) * 8;
    const auto apart = distance(on, refit(on, all, far));
    CHECK((apart.has_value() && apart->distance > 0 && apart == distance(host, refit(host, expected, far))));
}

}  // namespace abut::test
