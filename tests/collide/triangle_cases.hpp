// SPDX-License-Identifier: MIT
#pragma once

// Queries of triangles against triangles on every policy: one against many, many against many, by brute force and through
// indices. The truth is a plain loop over `intersects<exact>`, whose own truth is tests/predicate.

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "collide/query_cases.hpp"
#include "support/triangle_families.hpp"

namespace abut::test {

/// A soup's triangles as a mesh that shares no vertices.
template <class T>
mesh<T> as_mesh(const std::vector<triangle<T>>& triangles) {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    for (const triangle<T>& t : triangles) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        vertices.insert(vertices.end(), {t.a, t.b, t.c});
        faces.push_back({first, first + 1, first + 2});
    }
    return {vertices, faces};
}

/// Brute force, with either side resident; the answers are sorted pairs, so nothing else can show.
template <class Policy, class X, class Y>
void check_resident(const Policy& on, const X& a, const Y& b, const pair_list& expected) {
    for (const argument side : {argument::a, argument::b}) {
        CHECK(to_host(pairs(on, a, b, query_options<>{.resident = side})) == expected);
        CHECK(any(on, a, b, query_options<>{.resident = side}) == !expected.empty());
    }
}

/// Every family as two soups, all against all: touching, coplanar, degenerate and extreme pairs, most of them late.
template <class T, class Policy>
void check_triangle_families(const Policy& on) {
    std::size_t hits = 0;
    for (int f = 0; f < triangle_family_count; ++f) {
        CAPTURE(name_of(static_cast<triangle_family>(f)));
        std::vector<triangle<T>> a, b;
        for (std::uint64_t i = 0; i < 40; ++i) {
            const auto pair = make_triangle_pair<T>(11, static_cast<triangle_family>(f), i);
            a.push_back(pair.a);
            b.push_back(pair.b);
        }
        const triangle_soup<T> x(a), y(b);
        const pair_list expected = truth(x.view(), y.view());
        hits += expected.size();
        check_query<filtered>(on, copy_to(on, x), copy_to(on, y), expected);
    }
    std::printf("triangles against triangles: %d families, %zu hits\n", triangle_family_count, hits);
    CHECK(hits > 40u * triangle_family_count / 10);
}

/// Soups of many sizes, so that rows and columns fill tiles, warps and blocks in part.
template <class T, class Policy>
void check_triangle_soups(const Policy& on) {
    uniform random(77);
    std::size_t hits = 0;
    const std::pair<std::size_t, std::size_t> sizes[] = {{0, 9}, {9, 0}, {1, 1}, {1, 3000}, {700, 2}, {300, 1000}};
    for (const auto& [n, m] : sizes) {
        CAPTURE(n, m);
        const triangle_soup<T> a(random_triangles<T>(n, random));
        const auto others = random_triangles<T>(m, random);
        const triangle_soup<T> b(others);
        const pair_list expected = truth(a.view(), b.view());
        hits += expected.size();
        const auto x = copy_to(on, a);
        const auto y = copy_to(on, b);
        check_query<filtered>(on, x, y, expected);
        check_resident(on, x, y, expected);
        CHECK(to_host(pairs(on, x, copy_to(on, as_mesh(others)))) == expected);
        CHECK(to_host(pairs(on, make_bvh(on, x), y)) == expected);
        CHECK(to_host(pairs(on, x, make_grid(on, y))) == expected);
        CHECK(count<exact>(on, x, y) == expected.size());
        if (n > 0) {
            pair_list of_first;
            for (const index_pair& p : expected) {
                if (p.a == 0) of_first.push_back(p);
            }
            const triangle<T> first = a.view()[0];
            check_query<filtered>(on, first, y, of_first);
            CHECK(to_host(pairs(on, y, first)) == mirrored(of_first));
        }
        if (n == 300) {
            check_filter(on, x, y, expected);
            check_visits(on, x, y, n, m, expected);
        }
    }
    CHECK(hits > 100);
}

/// A sheet of a lattice against itself: every triangle touches its neighbours in corners, edges and faces, so the filter
/// decides next to nothing.
template <class T, class Policy>
void check_triangle_sheet(const Policy& on) {
    std::vector<triangle<T>> sheet;
    for (int x = 0; x < 12; ++x) {
        for (int y = 0; y < 12; ++y) {
            const T u = static_cast<T>(x), v = static_cast<T>(y);
            sheet.push_back({{u, v, 0}, {u + 1, v, 0}, {u, v + 1, 0}});
            sheet.push_back({{u + 1, v, 0}, {u + 1, v + 1, 0}, {u, v + 1, 0}});
        }
    }
    const triangle_soup<T> soup(sheet);
    const pair_list expected = truth(soup.view(), soup.view());
    const auto x = copy_to(on, soup);
    check_query<filtered>(on, x, x, expected);
    CHECK(to_host(pairs(on, make_bvh(on, x), x)) == expected);
    CHECK(expected.size() > 10 * sheet.size());
}

/// One triangle in a million touches, the last, the first, or none: `any` finds it, and so do the others.
template <class T, class Policy>
void check_one_in_many(const Policy& on) {
    const std::size_t n = 200'000;
    const triangle<T> reference{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const std::size_t hit : {std::size_t{0}, n / 2, n - 1, n}) {
        std::vector<triangle<T>> many;
        for (std::size_t i = 0; i < n; ++i) {
            const T far = static_cast<T>(5 + i % 100), up = i == hit ? T(0) : far;
            many.push_back({{0, 0, up}, {1, 0, up + T(0.5)}, {0, 1, up + T(0.5)}});
        }
        const auto soup = copy_to(on, triangle_soup<T>(many));
        CHECK(any(on, reference, soup) == (hit < n));
        CHECK(count(on, soup, reference) == (hit < n ? 1 : 0));
        const pair_list expected =
            hit < n ? pair_list{{0, static_cast<std::uint32_t>(hit)}} : pair_list{};
        CHECK(to_host(pairs(on, reference, soup)) == expected);
    }
}

template <class T, class Policy>
void check_triangle_queries(const Policy& on) {
    check_triangle_soups<T>(on);
    check_triangle_families<T>(on);
    check_triangle_sheet<T>(on);
    check_one_in_many<T>(on);
}

}  // namespace abut::test
