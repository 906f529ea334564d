// SPDX-License-Identifier: MIT
#pragma once

// What every policy's queries promise: complete, sorted, each pair once, the same whatever the index, the order of the
// arguments and the policy. The truth is a plain loop over `intersects<exact>`, whose own truth is tests/predicate.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

using pair_list = std::vector<index_pair>;

template <class Triangles, class Spheres>
pair_list truth(const Triangles& triangles, const Spheres& spheres) {
    pair_list touching;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto t = triangles[i];
        for (std::uint32_t j = 0; j < spheres.size(); ++j) {
            if (intersects<exact>(spheres[j], t)) touching.push_back({i, j});
        }
    }
    return touching;
}

inline pair_list mirrored(pair_list pairs) {
    for (index_pair& p : pairs) std::swap(p.a, p.b);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

struct id_filter {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return (a + 2 * b) % 3 != 0; }
};

/// Counts the visits to each pair, at a * stride + b.
struct visit_counter {
    std::uint32_t* visits;
    std::uint32_t stride;
    ABUT_HD visit operator()(index_pair p) const {
        execution::atomic_add(visits + std::size_t{p.a} * stride + p.b, 1u);
        return visit::proceed;
    }
};

struct stop_at_once {
    std::uint32_t* visits;
    ABUT_HD visit operator()(index_pair) const {
        execution::atomic_add(visits, 1u);
        return visit::stop;
    }
};

/// for_each_pair visits each pair that is expected once, and no other.
template <class Policy, class X, class Y, class Options>
void check_each_visited(const Policy& on, const X& a, const Y& b, std::size_t a_size, std::size_t b_size,
                        const pair_list& expected, const Options& options) {
    execution::buffer_of<Policy, std::uint32_t> visits(on, a_size * b_size + 1);
    fill(on, visits.data(), visits.size(), std::uint32_t{0});
    for_each_pair(on, a, b, visit_counter{visits.data(), static_cast<std::uint32_t>(b_size)}, options);
    std::vector<std::uint32_t> counts(visits.size()), once(visits.size(), 0);
    visits.read(counts.data());
    for (const index_pair& p : expected) once[std::size_t{p.a} * b_size + p.b] = 1;
    CHECK(counts == once);
}

template <class Policy, class X, class Y>
void check_visits(const Policy& on, const X& a, const Y& b, std::size_t a_size, std::size_t b_size,
                  const pair_list& expected) {
    for (const std::uint64_t most : {std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{1} << 24}) {
        CAPTURE(most);
        check_each_visited(on, a, b, a_size, b_size, expected, query_options<>{.most_pairs = most});
    }
    execution::buffer_of<Policy, std::uint32_t> visits(on, 1);
    fill(on, visits.data(), 1, std::uint32_t{0});
    for_each_pair(on, a, b, stop_at_once{visits.data()});
    std::uint32_t count = 0;
    visits.read(&count);
    CHECK((count > 0) == !expected.empty());
}

/// All forms of one query between two sides, indexed or not.
template <arithmetic A, class Policy, class X, class Y>
void check_query(const Policy& on, const X& a, const Y& b, const pair_list& expected) {
    CHECK(to_host(pairs<A>(on, a, b)) == expected);
    pair_list unsorted = to_host(pairs<A>(on, a, b, {.sorted = false}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);
    CHECK(count<A>(on, a, b) == expected.size());
    CHECK(any<A>(on, a, b) == !expected.empty());
}

/// All forms that have options, with options that leave no pair out. `b` touches `a`, and `away` does not.
template <class Policy, class X, class Y, class Options>
void check_forms(const Policy& on, const X& a, const Y& b, const Y& away, const pair_list& expected,
                 const Options& options) {
    CHECK(count(on, a, b, options) == expected.size());
    CHECK(count(on, a, away, options) == 0);
    CHECK(any(on, a, b, options));
    CHECK_FALSE(any(on, a, away, options));
    check_each_visited(on, a, b, a.size(), b.size(), expected, options);
}

template <class Policy, class X, class Y>
void check_filter(const Policy& on, const X& a, const Y& b, const pair_list& expected) {
    pair_list kept;
    for (const index_pair& p : expected) {
        if (id_filter{}(p.a, p.b)) kept.push_back(p);
    }
    const query_options<id_filter> options{};
    CHECK(to_host(pairs(on, a, b, options)) == kept);
    CHECK(count(on, a, b, options) == kept.size());
    CHECK(any(on, a, b, options) == !kept.empty());
}

/// Two sets against each other, in the policy's memory: all pairs by brute force and by each index on each side.
template <class Policy, class Triangles, class Spheres>
void check_sets(const Policy& on, const Triangles& triangles, const Spheres& balls) {
    const pair_list expected = truth(triangles.view(), balls.view());
    const auto t = copy_to(on, triangles);
    const auto s = copy_to(on, balls);
    CAPTURE(triangles.size(), balls.size(), expected.size());
    CHECK(to_host(pairs(on, t, s)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, t), s)) == expected);
    CHECK(to_host(pairs(on, s, make_bvh(on, t))) == mirrored(expected));
    CHECK(to_host(pairs(on, t, make_bvh(on, s))) == expected);
    for (const double width : {0.0, 1e-4, 0.1, 1e9}) {
        CAPTURE(width);
        CHECK(to_host(pairs(on, make_grid(on, t, width), s)) == expected);
        CHECK(to_host(pairs(on, t, make_grid(on, s, width))) == expected);
    }
}

/// The other forms of a query, on one kind of scene.
template <class Policy, class Triangles, class Spheres>
void check_forms(const Policy& on, const Triangles& triangles, const Spheres& balls) {
    const pair_list expected = truth(triangles.view(), balls.view());
    const auto t = copy_to(on, triangles);
    const auto s = copy_to(on, balls);
    CAPTURE(triangles.size(), balls.size(), expected.size());
    const auto tree = make_bvh(on, t);
    check_query<filtered>(on, tree, s, expected);
    check_query<exact>(on, tree, s, expected);
    check_query<filtered>(on, t, s, expected);
    CHECK(to_host(pairs<exact>(on, t, s)) == expected);
    CHECK(to_host(pairs(on, tree, make_bvh(on, s))) == expected);
    const auto cells = make_grid(on, t);
    CHECK(count(on, cells, s) == expected.size());
    CHECK(any(on, cells, s) == !expected.empty());
    check_filter(on, tree, s, expected);
    if (triangles.size() * balls.size() < 1'000'000) {
        check_visits(on, tree, s, triangles.size(), balls.size(), expected);
    }
}

template <class T, class Policy>
void check_random_scenes(const Policy& on) {
    constexpr std::uint64_t seed = 20260101;
    std::printf("random scenes: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::size_t hits = 0;
    const std::pair<std::size_t, std::size_t> sizes[] = {{0, 0}, {0, 3}, {3, 0}, {1, 1}, {1, 500}, {500, 1}, {700, 900}};
    for (const auto& [n, m] : sizes) {
        const triangle_soup<T> soup(random_triangles<T>(n, random));
        const spheres<T> balls(random_spheres<T>(m, random));
        hits += truth(soup.view(), balls.view()).size();
        check_sets(on, soup, balls);
        if constexpr (std::same_as<T, float>) check_forms(on, soup, balls);
    }
    CHECK(hits > 1000);
    const torus<T> shape(24, 12, 2, 1);
    std::vector<vec3<T>> centers;
    for (int i = 0; i < 600; ++i) centers.push_back(random.point<T>(-3, 3));
    check_sets(on, mesh<T>(shape.vertices, shape.faces), equal_spheres<T>(centers, T(0.25)));
}

/// A lattice where most pairs touch exactly: every triangle shares its vertices with spheres of integer radius, so that the
/// filter leaves much undecided, and a hit may be of several features at once.
template <class T, class Policy>
void check_lattice(const Policy& on) {
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> balls;
    for (int x = 0; x < 6; ++x) {
        for (int y = 0; y < 6; ++y) {
            const T u = static_cast<T>(x), v = static_cast<T>(y);
            triangles.push_back({{u, v, 0}, {u + 1, v, 0}, {u, v + 1, 0}});
            triangles.push_back({{u, v, 0}, {u, v, 0}, {u, v + 1, 0}});  // a segment
            triangles.push_back({{u, v, 0}, {u, v, 0}, {u, v, 0}});      // a point
            for (const int r : {0, 1, 2, 5}) balls.push_back({{u, v, static_cast<T>(r)}, static_cast<T>(r)});
        }
    }
    check_sets(on, triangle_soup<T>(triangles), spheres<T>(balls));
    if constexpr (std::same_as<T, float>) check_forms(on, triangle_soup<T>(triangles), spheres<T>(balls));
}

/// Coordinates whose exponents lie too far apart for integers in registers: stage 3 decides.
template <class T, class Policy>
void check_wide_spans(const Policy& on) {
    constexpr T huge = std::numeric_limits<T>::max() / 4, tiny = std::numeric_limits<T>::denorm_min();
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> balls;
    for (int i = 0; i < 40; ++i) {
        const T k = static_cast<T>(i);
        triangles.push_back({{huge, k * tiny, 0}, {-huge, k * tiny, 0}, {0, huge, 0}});
        balls.push_back({{0, 0, k * tiny}, static_cast<T>(i % 7) * tiny});
        balls.push_back({{huge, 0, tiny}, 0});
    }
    check_sets(on, triangle_soup<T>(triangles), spheres<T>(balls));
    if constexpr (std::same_as<T, float>) check_forms(on, triangle_soup<T>(triangles), spheres<T>(balls));
}

/// Two clusters a million radii apart, of shapes of very mixed sizes, in a grid: cells are kept for what is there.
template <class T, class Policy>
void check_far_clusters(const Policy& on) {
    uniform random(99);
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> balls;
    for (int i = 0; i < 400; ++i) {
        const T far = i % 2 ? T(1e6) : T(0);
        const vec3<T> shift{far, -far, far};
        const vec3<T> at = shift + random.point<T>(-8, 8);
        triangles.push_back({at, at + random.point<T>(-2, 2), at + random.point<T>(-2, 2)});
        balls.push_back({shift + random.point<T>(-8, 8), T(1)});
    }
    triangles.push_back({{-2e6f, -2e6f, 0}, {2e6f, -2e6f, 0}, {0, 2e6f, 0}});  // spans everything
    balls.push_back({{0, 0, 0}, T(1e5)});
    check_sets(on, triangle_soup<T>(triangles), spheres<T>(balls));
    const auto cells = make_grid(on, triangle_soup<T>(triangles), 4.0);
    CHECK(cells.bytes() < 100'000);
}

/// Shuffling either side changes the ids and nothing else.
template <class T, class Policy>
void check_permutation(const Policy& on) {
    uniform random(5);
    const auto triangles = random_triangles<T>(300, random);
    const auto balls = random_spheres<T>(400, random);
    std::vector<std::uint32_t> order(triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    order = shuffled(order, random);
    std::vector<triangle<T>> moved;
    for (const std::uint32_t i : order) moved.push_back(triangles[i]);
    const pair_list before = to_host(pairs(on, make_bvh(on, triangle_soup<T>(triangles)), spheres<T>(balls)));
    pair_list after = to_host(pairs(on, make_bvh(on, triangle_soup<T>(moved)), spheres<T>(balls)));
    for (index_pair& p : after) p.a = order[p.a];
    std::sort(after.begin(), after.end());
    CHECK(before == after);
    CHECK(before.size() > 100);
}

/// Triangles in one plane, which no filter decides, and where nearly all boxes meet.
template <class T>
triangle_soup<T> coplanar_triangles(std::size_t n) {
    uniform random(20261122);
    std::vector<triangle<T>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
        const auto corner = [&] {
            const vec3<T> p = random.point<T>(-1, 1);
            return vec3<T>{p.x, p.y, T(0.1)};
        };
        triangles.push_back({corner(), corner(), corner()});
    }
    return triangle_soup<T>(triangles);
}

/// Adds up the visits, and their ids.
struct visit_sum {
    std::uint64_t *visits, *ids;
    ABUT_HD visit operator()(index_pair p) const {
        execution::atomic_add(visits, std::uint64_t{1});
        execution::atomic_add(ids, std::uint64_t{p.a} << 20 | p.b);
        return visit::proceed;
    }
};

/// A soup against itself where all pairs are left open by the first try: complete and each pair once, in every form of a
/// query, and whatever finds no room to wait. `expected` pairs, of which `sum` adds up the ids as visit_sum does.
template <class Policy, class X, class Y>
void check_open_pairs(const Policy& on, const X& a, const Y& b, std::uint64_t expected, std::uint64_t sum) {
    CHECK(any(on, a, b));
    CHECK(count(on, a, b) == expected);
    CHECK(pairs(on, a, b, {.sorted = false}).size() == expected);
    execution::buffer_of<Policy, std::uint64_t> sums(on, 2);
    fill(on, sums.data(), 2, std::uint64_t{0});
    for_each_pair(on, a, b, visit_sum{sums.data(), sums.data() + 1});
    std::uint64_t seen[2];
    sums.read(seen);
    CHECK(seen[0] == expected);
    CHECK(seen[1] == sum);
}

template <class T, class Policy>
void check_dense(const Policy& on, std::size_t n) {
    const triangle_soup<T> soup = coplanar_triangles<T>(n);
    std::uint64_t expected = 0, sum = 0;
    for (const index_pair& p : to_host(pairs(openmp{}, soup, soup))) {
        ++expected;
        sum += std::uint64_t{p.a} << 20 | p.b;
    }
    CHECK(expected > n * n / 2);
    const auto there = copy_to(on, soup);
    const auto tree = make_bvh(on, there);
    CAPTURE(n, expected);
    check_open_pairs(on, there, there, expected, sum);
    check_open_pairs(on, tree, there, expected, sum);
    check_open_pairs(on, tree, tree, expected, sum);
    check_open_pairs(on, make_grid(on, there), there, expected, sum);
}

template <class T, class Policy>
void check_single_shapes(const Policy& on) {
    const triangle<T> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const sphere<T> touching{{1, 1, 2}, 2}, apart{{1, 1, 3}, 2};
    CHECK(any(on, t, touching));
    CHECK_FALSE(any(on, apart, t));
    CHECK(count(on, touching, t) == 1);
    CHECK(to_host(pairs(on, t, spheres<T>({apart, touching, apart, touching}))) == pair_list{{0, 1}, {0, 3}});
    CHECK(to_host(pairs(on, make_bvh(on, spheres<T>({apart, touching})), t)) == pair_list{{1, 0}});
    CHECK_THROWS_WITH(any(on, t, sphere<T>{{0, 0, 0}, -1}), "abut::any: shape 0: radius is negative (-1)");
    CHECK_THROWS_WITH(make_grid(on, t, -1.0), "abut::make_grid: cell_width is -1; expected 0 or more");
}

template <class T, class Policy>
void check_all_queries(const Policy& on) {
    check_random_scenes<T>(on);
    check_lattice<T>(on);
    check_wide_spans<T>(on);
    check_far_clusters<T>(on);
    check_permutation<T>(on);
    check_single_shapes<T>(on);
}

}  // namespace abut::test
