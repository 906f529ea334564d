// SPDX-License-Identifier: MIT
#pragma once

// What `raycast` promises of solids on every policy: spheres, boxes, capsules, cylinders and cones, in general position and
// on lattices, where rays touch, begin on surfaces and meet several shapes at one time. The truth is a plain loop, as for
// triangles; that one pair is right is tests/narrow's matter.

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/abut.hpp>

#include "collide/raycast_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"

namespace abut::test {

/// Some solids, of which every second one is a copy of the one before, or another one around the same place.
template <class S, scalar T = scalar_type_of<S>>
std::vector<S> some_solids(std::size_t n, bool on_lattice, uniform& random) {
    const auto point = [&](double half) {
        const vec3<T> p = random.point<T>(-half, half);
        return on_lattice ? vec3<T>{std::round(p.x), std::round(p.y), std::round(p.z)} : p;
    };
    std::vector<S> all;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> a = point(3), e = point(1);
        const T radius = on_lattice ? T(random.below(3)) / 2 : T(0.05) + T(random.below(100)) / 200;
        if (i % 4 == 3) {
            all.push_back(all.back());
        } else if constexpr (std::same_as<S, sphere<T>>) {
            all.push_back({a, radius});
        } else if constexpr (std::same_as<S, aabb<T>>) {
            all.push_back(bounds(segment<T>{a, a + e}));
        } else {
            all.push_back(solid_of<S>({a, a + e}, radius));
        }
    }
    return all;
}

/// Rays at places of solids, along axes, of no length, and from inside.
template <class S, scalar T = scalar_type_of<S>>
std::vector<ray<T>> rays_at_solids(const std::vector<S>& solids, std::size_t n, bool on_lattice, uniform& random) {
    std::vector<ray<T>> lines;
    const auto snapped = [&](const vec3<T>& p) {
        return on_lattice ? vec3<T>{std::round(p.x), std::round(p.y), std::round(p.z)} : p;
    };
    for (std::size_t i = 0; i < n; ++i) {
        const aabb<T> box = bounds(solids[random.below(solids.size())]);
        const vec3<T> origin = snapped(random.point<T>(-4, 4)), middle = snapped(T(0.5) * box.lower + T(0.5) * box.upper);
        const vec3<T> target = i % 4 == 0 ? snapped(box.upper) : i % 4 == 3 ? snapped(random.point<T>(-4, 4)) : middle;
        lines.push_back({origin, target - origin});
        if (i % 7 == 0) lines.back() = {middle, snapped(random.point<T>(-2, 2))};
        if (i % 9 == 0) lines.back().direction.x = 0;
        if (i % 11 == 0) lines.back().direction.y = lines.back().direction.z = 0;
        if (i % 31 == 0) lines.back().direction = {0, 0, 0};
    }
    return lines;
}

template <class S, class Policy>
void check_raycast_of(const Policy& on) {
    using T = scalar_type_of<S>;
    uniform random(191);
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const auto solids = some_solids<S>(60, on_lattice, random);
        const auto rays = rays_at_solids(solids, 120, on_lattice, random);
        const shapes<S> set(solids);
        check_indices(on, set, rays);
        check_indices(on, set, as_segments(rays));
        if constexpr (placeable<S>) {
            const auto tree = make_bvh(on, copy_to(on, set));
            for (std::uint64_t k = 0; k < 4; ++k) {
                CAPTURE(k);
                draws d(sample_seed, 195, k);
                const rigid<T> pose = k % 2 == 0 ? make_pose<T>(d, 10) : make_loose_pose<T>(d, 1000);
                const posed_view<typename shapes<S>::view_type> placed{set.view(), pose};
                rigid<T> turn = pose;
                turn.translation = {0, 0, 0};
                std::vector<ray<T>> moved;
                for (const auto& r : rays) moved.push_back({place(pose, r.origin), place(turn, r.direction)});
                const auto expected = hits_by_definition(placed, moved);
                check_hits(on, posed(tree, pose), moved, expected);
                check_hits(on, posed(copy_to(on, set), pose), moved, expected);
                if (k < 2) check_all_hits(on, posed(tree, pose), placed, moved);
            }
        }
    }
}

/// The same in every size that the type has, and of pairs what rays meet at all.
template <class S, class Policy>
void check_raycast_scales_of(const Policy& on) {
    using T = scalar_type_of<S>;
    uniform random(193);
    const T largest = std::numeric_limits<T>::max(), smallest = std::numeric_limits<T>::min();
    for (const T scale : {largest / 16, smallest * 64, smallest / 1024, T(1e-20), T(1e20)}) {
        CAPTURE(scale);
        const auto unit = some_solids<S>(30, true, random);
        auto rays = rays_at_solids(unit, 40, true, random);
        std::vector<S> solids;
        for (const S& s : unit) {
            if constexpr (std::same_as<S, sphere<T>>) {
                solids.push_back({scale * s.center, scale * s.radius});
            } else if constexpr (std::same_as<S, aabb<T>>) {
                solids.push_back({scale * s.lower, scale * s.upper});
            } else if constexpr (std::same_as<S, cone<T>>) {
                solids.push_back({scale * s.apex, scale * s.base_center, scale * s.radius});
            } else {
                solids.push_back({{scale * s.axis.a, scale * s.axis.b}, scale * s.radius});
            }
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
            rays[i] = {scale * rays[i].origin, i % 2 == 0 ? rays[i].direction : scale * rays[i].direction};
        }
        const shapes<S> set(solids);
        const auto expected = hits_by_definition(set.view(), rays);
        CHECK(share_of_hits(expected) > 0.2);
        const auto tree = make_bvh(on, copy_to(on, set));
        check_hits(on, tree, rays, expected);
        check_hits(on, quantised(on, tree), rays, expected);
        std::vector<index_pair> met;
        for (std::uint32_t i = 0; i < solids.size(); ++i) {
            for (std::uint32_t k = 0; k < rays.size(); ++k) {
                if (detail::hit_time<exact>(rays[k], solids[i]) >= 0) met.push_back({i, k});
            }
        }
        CHECK(to_host(pairs(on, tree, shapes<ray<T>>(rays))) == met);
        CHECK(count(on, copy_to(on, set), copy_to(on, shapes<ray<T>>(rays))) == met.size());
    }
}

}  // namespace abut::test
