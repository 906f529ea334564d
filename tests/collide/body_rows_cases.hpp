// SPDX-License-Identifier: MIT
#pragma once

// What points and lines find among bodies, and how far bodies are apart, on every policy: the best of what each body says
// alone, by a plain loop over its placed shapes. Bodies come twice, so that their numbers decide.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <abut/abut.hpp>

#include "collide/body_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// All that a ray meets of bodies, in order: time in double, body, id.
struct true_hit {
    double time;
    std::uint32_t body, id;
    friend bool operator<(const true_hit& x, const true_hit& y) {
        if (x.time != y.time) return x.time < y.time;
        return x.body != y.body ? x.body < y.body : x.id < y.id;
    }
};
template <class Policy, class Set, class Line>
std::vector<true_hit> true_hits(const scene_of_bodies<Policy, Set>& scene, const Line& line) {
    std::vector<true_hit> all;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const auto shapes = posed(scene.sets[scene.kinds[b]], scene.bodies[b].pose);
        for (std::size_t i = 0; i < shapes.object.size(); ++i) {
            const double time = detail::hit_time<exact>(line, place(shapes.pose, shapes.object.view()[i]));
            if (time >= 0) all.push_back({time, static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(i)});
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

template <class Policy, class Set, class Lines, class Bodies>
void check_rays_among(const Policy& on, const scene_of_bodies<Policy, Set>& scene, const Lines& lines, const Bodies& all,
                      std::size_t& hits) {
    using T = typename Set::scalar_type;
    const auto first = to_host(raycast(on, all, lines));
    const auto exactly = to_host(raycast<exact>(on, all, lines));
    const auto any = to_host(raycast_any(on, all, lines));
    const auto every = to_host(raycast_all(on, all, lines));
    REQUIRE((first.size() == lines.size() && any.size() == lines.size()));
    CHECK(first == exactly);
    std::size_t wrong = 0, at = 0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const auto truth = true_hits(scene, lines.view()[k]);
        hits += truth.size();
        wrong += any[k] != (truth.empty() ? 0 : 1);
        const body_hit<T> none{no_id, no_id, infinity<T>};
        wrong +=
            first[k] != (truth.empty() ? none : body_hit<T>{truth[0].body, truth[0].id, detail::time_as<T>(truth[0].time)});
        for (const true_hit& h : truth) {
            const body_hit_of_ray<T> expected{static_cast<std::uint32_t>(k), h.body, h.id, detail::time_as<T>(h.time)};
            wrong += at >= every.size() || every[at] != expected;
            ++at;
        }
    }
    CHECK(wrong == 0);
    CHECK(at == every.size());
}

/// The few nearest of all bodies' shapes: by squared distance, body and id; the point and distance are those that `nearest`
/// of the body alone gives.
template <class Policy, class Set, class Bodies>
void check_nearest_among(const Policy& on, const scene_of_bodies<Policy, Set>& scene,
                         const std::vector<vec3<typename Set::scalar_type>>& from, const Bodies& all) {
    using T = typename Set::scalar_type;
    const std::size_t count = 5;
    const auto one = to_host(nearest(on, all, from));
    const auto few = to_host(nearest(on, all, from, count));
    REQUIRE((one.size() == from.size() && few.size() == count * from.size()));
    std::size_t wrong = 0, ties = 0;
    for (std::size_t k = 0; k < from.size(); ++k) {
        std::vector<true_hit> truth;
        for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
            const auto& set = scene.sets[scene.kinds[b]];
            for (std::size_t i = 0; i < set.size(); ++i) {
                const double square =
                    detail::squared_distance(from[k], place(scene.bodies[b].pose, set.view()[i]), detail::length_unit<T>{});
                truth.push_back({square, static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(i)});
            }
        }
        std::sort(truth.begin(), truth.end());
        ties += truth.size() > 1 && truth[0].time == truth[1].time;
        for (std::size_t j = 0; j < count; ++j) {
            body_neighbor<T> expected{no_id, no_id, from[k], infinity<T>};
            if (j < truth.size()) {
                const std::uint32_t b = truth[j].body, i = truth[j].id;
                const auto shape = place(scene.bodies[b].pose, scene.sets[scene.kinds[b]].view()[i]);
                const auto alone = to_host(nearest(serial{}, shape, from[k]))[0];
                expected = {b, i, alone.point, alone.distance};
            }
            wrong += few[count * k + j] != expected;
            if (j == 0) wrong += one[k] != expected;
        }
    }
    CHECK(wrong == 0);
    CHECK((from.empty() || ties > 0));
}

template <class Policy, class Set>
auto lines_among(const scene_of_bodies<Policy, Set>& scene, std::size_t n, uniform& random) {
    using T = typename Set::scalar_type;
    const auto point = [&] {
        const auto& pose =
            scene.bodies[static_cast<std::size_t>(random(0, static_cast<double>(scene.bodies.size()) - 0.01))].pose;
        return vec3<T>{pose.translation.x + T(random(-2, 2)), pose.translation.y + T(random(-2, 2)),
                       pose.translation.z + T(random(-2, 2))};
    };
    std::vector<ray<T>> lines;
    std::vector<segment<T>> ends;
    std::vector<vec3<T>> points;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> p = point(), q = point();
        lines.push_back({p, i % 7 == 0 ? vec3<T>{0, 0, T(1)} : q - p});
        ends.push_back({q, p});
        points.push_back(i % 5 == 0 ? q : p);
    }
    struct made {
        rays<T> lines;
        segments<T> ends;
        std::vector<vec3<T>> points;
    };
    return made{rays<T>(lines), segments<T>(ends), points};
}

/// Bodies of some sets, each pose twice, spread over `spread`.
template <class Policy, class Set>
void check_body_rows(const Policy& on, std::vector<Set> sets, int count, double spread, unsigned seed) {
    using T = typename Set::scalar_type;
    uniform random(seed);
    draws d(seed, 97, 0);
    scene_of_bodies<Policy, Set> scene(on, std::move(sets));
    for (int i = 0; i < count; ++i) {
        auto pose = make_rotation<T>(d);
        pose.translation = {T(random(-spread, spread)), T(random(-spread, spread)), T(random(-spread, spread))};
        scene.add(static_cast<std::size_t>(i) % scene.sets.size(), pose);
    }
    for (int i = 0; i < count; i += 2) {
        scene.add(scene.kinds[static_cast<std::size_t>(i)], scene.bodies[static_cast<std::size_t>(i)].pose);
    }
    const auto all = make_bodies(on, scene.bodies);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{60}}) {
        CAPTURE(n);
        const auto from = lines_among(scene, n, random);
        std::size_t hits = 0;
        check_rays_among(on, scene, from.lines, all, hits);
        check_rays_among(on, scene, from.ends, scene.bodies, hits);
        CHECK((n < 60 || hits > 20));
        if (n != 1) check_nearest_among(on, scene, from.points, all);
    }
    // After a move.
    for (auto& body : scene.bodies) body.pose.translation.x += T(0.25);
    const auto moved = refit(on, all, scene.poses());
    const auto from = lines_among(scene, 30, random);
    std::size_t hits = 0;
    check_rays_among(on, scene, from.lines, moved, hits);
    CHECK(hits > 10);
}

template <scalar T, class Policy>
void check_all_body_rows(const Policy& on) {
    const torus<T> ring(10, 6, 0.7, 0.3);
    const torus<T> small(5, 4, 0.4, 0.2);
    const mesh<T> one(std::vector<vec3<T>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<face>{{0, 1, 2}});
    check_body_rows(on,
                    std::vector{mesh<T>(ring.vertices, ring.faces), one, mesh<T>(), mesh<T>(small.vertices, small.faces)},
                    14, 3.0, 31);
    std::vector<sphere<T>> balls;
    for (int i = 0; i < 9; ++i) balls.push_back({{T(i % 3), T(i / 3), T(i % 2)}, T(0.75)});
    check_body_rows(on, std::vector{spheres<T>(balls), spheres<T>(std::vector{balls[0]})}, 10, 2.0, 32);

    const std::vector<posed_object<decltype(make_bvh(on, one))>> nothing;
    const auto none = make_bodies(on, nothing);
    const vec3<T> p{1, 2, 3};
    CHECK((to_host(nearest(on, none, p))[0] == body_neighbor<T>{no_id, no_id, p, infinity<T>}));
    CHECK((to_host(raycast(on, none, ray<T>{p, {0, 0, 1}}))[0] == body_hit<T>{no_id, no_id, infinity<T>}));
    CHECK(to_host(raycast_any(on, none, ray<T>{p, {0, 0, 1}}))[0] == 0);
    CHECK(raycast_all(on, none, ray<T>{p, {0, 0, 1}}).size() == 0);
    CHECK(!distance(on, none).has_value());
}

/// The least of all pairs of bodies, each asked alone.
template <class Policy, class Set>
auto true_distance(const scene_of_bodies<Policy, Set>& scene) {
    using T = typename Set::scalar_type;
    std::optional<body_separation<T>> best;
    double least_apart = infinity<double>;
    scene.for_each_two([&](std::uint32_t i, std::uint32_t j, const auto& a, const auto& b) {
        const auto one = distance(serial{}, a, b);
        if (!one) return;
        const auto shape_a = place(a.pose, a.object.view()[one->a]);
        const auto shape_b = place(b.pose, b.object.view()[one->b]);
        const double apart =
            one->distance == 0 ? 0 : detail::measure_apart{}.look(shape_a, shape_b, infinity<double>, {0, 0, 0}).distance;
        if (best && !(apart < least_apart)) return;
        least_apart = apart;
        best = body_separation<T>{i, j, one->a, one->b, one->point_a, one->point_b, one->distance};
    });
    return best;
}

template <scalar T, class Policy>
void check_body_distance(const Policy& on) {
    const torus<T> ring(8, 5, 0.7, 0.3);
    const mesh<T> one(std::vector<vec3<T>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<face>{{0, 1, 2}});
    int touch = 0, apart = 0;
    for (const double spread : {1.5, 4.0, 40.0}) {
        for (unsigned seed = 1; seed <= 6; ++seed) {
            CAPTURE(spread, seed);
            uniform random(seed);
            draws d(seed, 98, 0);
            using scene_type = scene_of_bodies<Policy, mesh<T>>;
            scene_type scene(on, {mesh<T>(ring.vertices, ring.faces), one, mesh<T>()});
            const int n = seed == 1 ? 2 : 9;
            for (int i = 0; i < n; ++i) {
                auto pose = make_rotation<T>(d);
                pose.translation = {T(random(-spread, spread)), T(random(-spread, spread)), T(random(-spread, spread))};
                scene.add(static_cast<std::size_t>(i) % 3, pose);
            }
            const auto expected = true_distance(scene);
            const auto all = make_bodies(on, scene.bodies);
            REQUIRE(expected.has_value());
            (expected->distance == 0 ? touch : apart) += 1;
            CHECK(distance(on, all) == expected);
            CHECK(distance(on, scene.bodies) == expected);
            const auto is = static_cast<double>(expected->distance);
            CHECK(distance(on, all, {.below = is * 1.5 + 1}) == expected);
            CHECK(!distance(on, all, {.below = is}).has_value());
            // A copy of all, far away, so that the same distances come again.
            const std::size_t before = scene.bodies.size();
            for (std::size_t i = 0; i < before; ++i) {
                auto pose = scene.bodies[i].pose;
                pose.translation.x += T(1024);
                scene.add(scene.kinds[i], pose);
            }
            CHECK(distance(on, make_bodies(on, scene.bodies)) == true_distance(scene));
        }
    }
    CHECK((touch > 2 && apart > 2));
    CHECK_THROWS_AS((void)distance(on, make_bodies(on, std::vector{posed(make_bvh(on, one), rigid<T>{})}), {.below = -1}),
                    error);
}

}  // namespace abut::test
