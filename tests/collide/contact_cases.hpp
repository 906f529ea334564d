// SPDX-License-Identifier: MIT
#pragma once

// What `contacts` promises on every policy: one contact for each of `pairs`, bit for bit what `contact_of` says of the two
// shapes on the host, whatever the indices, the sides, the poses and the order of elements. What a contact has to be is
// tests/narrow's.

#include <algorithm>
#include <cstring>
#include <vector>

#include <abut/abut.hpp>

#include "query_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <class T>
using contact_list = std::vector<contact<T>>;

template <class T>
bool same_bits(const contact_list<T>& a, const contact_list<T>& b) {
    static_assert(sizeof(contact<T>) == 8 + 7 * sizeof(T), "no padding that could differ");
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(contact<T>)) == 0);
}

/// By a plain loop.
template <class A, class B>
auto true_contacts(const A& a, const B& b) {
    contact_list<typename A::scalar_type> all;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        const auto s = a[i];
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            const auto found = contact_of<exact>(s, b[j]);
            if (!found) continue;
            all.push_back(*found);
            all.back().a = i;
            all.back().b = j;
        }
    }
    return all;
}

template <class T>
pair_list ids_of(const contact_list<T>& contacts) {
    pair_list ids;
    for (const auto& c : contacts) ids.push_back({c.a, c.b});
    return ids;
}

template <class T>
contact_list<T> sorted(contact_list<T> contacts) {
    std::sort(contacts.begin(), contacts.end(),
              [](const auto& x, const auto& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    return contacts;
}

/// Triangles of a size at which one in ten pairs touches.
template <class T>
triangle_soup<T> dense_triangles(std::size_t n, uniform& random) {
    std::vector<triangle<T>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> at = random.point<T>(-1, 1);
        const vec3<T> a = at + random.point<T>(-1, 1), b = at + random.point<T>(-1, 1), c = at + random.point<T>(-1, 1);
        triangles.push_back({a, b, c});
    }
    return triangle_soup<T>(triangles);
}

/// Two sets under two poses, in the ways that they may be asked about. Each is a query of its own to compile, so not in all.
/// Returns the number of contacts.
template <class Policy, class A, class B, class T>
std::size_t check_contacts(const Policy& on, const A& set_a, const rigid<T>& pose_a, const B& set_b,
                           const rigid<T>& pose_b) {
    const posed_view<typename A::view_type> view_a{set_a.view(), pose_a};
    const posed_view<typename B::view_type> view_b{set_b.view(), pose_b};
    const auto expected = true_contacts(view_a, view_b), mirrored = true_contacts(view_b, view_a);
    CAPTURE(set_a.size(), set_b.size(), expected.size());
    CHECK(expected.size() == mirrored.size());
    const auto a = copy_to(on, set_a);
    const auto b = copy_to(on, set_b);
    const auto pa = posed(a, pose_a);
    const auto tree_b = posed(make_bvh(on, b), pose_b);
    const auto found = to_host(contacts(on, pa, tree_b));
    CHECK(ids_of(found) == to_host(pairs(on, pa, tree_b)));
    CHECK(same_bits(found, expected));
    CHECK(same_bits(to_host(contacts(on, tree_b, pa)), mirrored));
    CHECK(same_bits(to_host(contacts(on, pa, posed(b, pose_b))), expected));
    return expected.size();
}

/// All options, of a side and of the query.
template <class T, class Policy>
void check_contact_options(const Policy& on) {
    uniform random(20261130);
    const auto set_a = dense_triangles<T>(30, random), set_b = dense_triangles<T>(40, random);
    const auto expected = true_contacts(set_a.view(), set_b.view());
    CHECK(expected.size() > 50);
    const auto a = copy_to(on, set_a), b = copy_to(on, set_b);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    CHECK(same_bits(to_host(contacts(on, a, b)), expected));
    CHECK(same_bits(to_host(contacts(on, tree_a, tree_b)), expected));
    CHECK(same_bits(to_host(contacts(on, make_grid(on, a), b)), expected));
    CHECK(same_bits(to_host(contacts<exact>(on, a, tree_b)), expected));
    const contact_options<> unsorted{.sorted = false}, a_stays{.resident = argument::a},
        b_stays{.resident = argument::b};
    CHECK(same_bits(sorted(to_host(contacts(on, a, b, unsorted))), expected));
    CHECK(same_bits(to_host(contacts(on, a, b, a_stays)), expected));
    CHECK(same_bits(to_host(contacts(on, a, b, b_stays)), expected));
    contact_list<T> kept;
    for (const auto& c : expected) {
        if (id_filter{}(c.a, c.b)) kept.push_back(c);
    }
    CHECK(same_bits(to_host(contacts(on, tree_a, b, contact_options<id_filter>{})), kept));
}

template <class T, class Policy>
void check_contact_scenes(const Policy& on) {
    constexpr std::uint64_t seed = 20261126;
    std::printf("contact scenes: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::size_t found = 0;
    for (std::uint64_t k = 0; k < 6; ++k) {
        draws d(seed, 81, k);
        const rigid<T> pose_a = k % 2 == 0 ? rigid<T>{} : make_pose<T>(d, 0.1), pose_b = make_pose<T>(d, 0.1);
        const auto a = dense_triangles<T>(k == 0 ? 1 : 60, random), b = dense_triangles<T>(70, random);
        const spheres<T> balls(random_spheres<T>(60, random));
        CAPTURE(k);
        found += check_contacts(on, a, pose_a, b, pose_b);
        found += check_contacts(on, a, pose_a, balls, pose_b);
    }
    CHECK(found > 1000);
    const triangle_soup<T> none, some(random_triangles<T>(3, random));
    CHECK(check_contacts(on, none, rigid<T>{}, some, rigid<T>{}) == 0);
    CHECK(check_contacts(on, some, rigid<T>{}, none, rigid<T>{}) == 0);
}

/// A closed mesh on itself: equal triangles, shared edges and corners, all decided by integers.
template <class T, class Policy>
void check_contacts_with_itself(const Policy& on) {
    const torus<T> shape(12, 8, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    draws d(20261127, 82, 0);
    const rigid<T> pose = make_pose<T>(d, 10);
    CHECK(check_contacts(on, surface, rigid<T>{}, surface, rigid<T>{}) >= 13 * surface.size());
    CHECK(check_contacts(on, surface, pose, surface, pose) >= surface.size());
}

/// Two trees under poses, spheres, and the shapes that are alone, one query each: all that a policy may get wrong, for
/// compilers that take long for a query.
template <class T, class Policy>
void check_few_contacts(const Policy& on) {
    uniform random(20261131);
    draws d(20261131, 83, 0);
    const rigid<T> pose_a = make_pose<T>(d, 0.1), pose_b = make_pose<T>(d, 0.1);
    const auto set_a = dense_triangles<T>(300, random), set_b = dense_triangles<T>(400, random);
    const auto tree_a = posed(make_bvh(on, copy_to(on, set_a)), pose_a);
    const auto tree_b = posed(make_bvh(on, copy_to(on, set_b)), pose_b);
    const posed_view<typename triangle_soup<T>::view_type> view_a{set_a.view(), pose_a}, view_b{set_b.view(), pose_b};
    const auto expected = true_contacts(view_a, view_b);
    CHECK(expected.size() > 5000);
    CHECK(same_bits(to_host(contacts(on, tree_a, tree_b)), expected));
    contact_list<T> kept;
    for (const auto& c : expected) {
        const T along = detail::overlap_along_shared_line(view_a[c.a], view_b[c.b]);
        if (along < 0 || along >= c.depth) kept.push_back(c);
    }
    CHECK(kept.size() < expected.size());
    CHECK(same_bits(to_host(contacts(on, tree_a, tree_b, {.discard_sideways = true})), kept));
    const auto check = [&](const auto& one) {
        const single_view<std::remove_cvref_t<decltype(one)>> single{one};
        const auto all = true_contacts(single, view_b);
        CHECK(all.size() > 0);
        CHECK(same_bits(to_host(contacts(on, one, tree_b)), all));
    };
    check(sphere<T>{{0, 0, 0}, T(0.5)});
    check(capsule<T>{{{0, 0, 0}, {1, 0, 0}}, T(0.5)});
    if constexpr (sizeof(T) == 4) {
        check(segment<T>{{-4, T(0.1), T(0.1)}, {4, T(0.2), T(0.3)}});
        check(aabb<T>{{-1, -1, -1}, {0, 1, 1}});
        check(plane<T>{{1, 2, 3}, T(0.1)});
    }
}

/// Single shapes on either side.
template <class T, class Policy>
void check_contacts_of_single_shapes(const Policy& on) {
    const torus<T> shape(24, 16, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    const auto here = copy_to(on, surface);
    const auto tree = make_bvh(on, here);
    std::size_t found = 0;
    const auto check = [&](const auto& single) {
        using shape_type = std::remove_cvref_t<decltype(single)>;
        const single_view<shape_type> one{single};
        const auto first = true_contacts(one, surface.view()), second = true_contacts(surface.view(), one);
        CHECK(same_bits(to_host(contacts(on, single, tree)), first));
        CHECK(same_bits(to_host(contacts(on, here, single)), second));
        CHECK(first.size() > 0);
        found += first.size();
    };
    check(triangle<T>{{0, 0, 0}, {3, 0, 0}, {3, 3, 1}});
    check(sphere<T>{{2, 0, 0}, T(1.25)});
    check(segment<T>{{-4, T(0.1), T(0.1)}, {4, T(0.2), T(0.3)}});
    check(aabb<T>{{1, 1, -1}, {3, 2, 1}});
    check(plane<T>{{1, 2, 3}, T(0.5)});
    check(capsule<T>{{{0, 0, 0}, {3, 0, 0}}, T(0.5)});
    CHECK(found > 300);
}

/// The rule that discards, by its definition.
template <class T, class Policy>
void check_discarding(const Policy& on) {
    uniform random(20261128);
    const auto a = dense_triangles<T>(50, random), b = dense_triangles<T>(60, random);
    const auto all = true_contacts(a.view(), b.view());
    contact_list<T> kept;
    for (const auto& c : all) {
        const T along = detail::overlap_along_shared_line(a.view()[c.a], b.view()[c.b]);
        if (along < 0 || along >= c.depth) kept.push_back(c);
    }
    CHECK(kept.size() > 20);
    CHECK(kept.size() + 3 < all.size());
    const contact_options<> options{.discard_sideways = true};
    CHECK(same_bits(to_host(contacts(on, copy_to(on, a), copy_to(on, b), options)), kept));
    // Ties, by symmetry, which rounding decides: the same way, whoever looks.
    std::vector<triangle<T>> first, second;
    for (std::uint64_t i = 0; i < 300; ++i) {
        draws d(20261202, 86, i);
        rigid<T> turn = make_pose<T>(d, 0);
        turn.translation = {static_cast<T>(10 * i), 0, 0};
        first.push_back(place(turn, triangle<T>{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 0}}));
        second.push_back(place(turn, triangle<T>{{2, -1, 0}, {2, 1, 0}, {0, 0, 0}}));
    }
    const auto ties_a = copy_to(on, triangle_soup<T>(first)), ties_b = copy_to(on, triangle_soup<T>(second));
    const auto by_b = to_host(contacts(on, make_bvh(on, ties_a), ties_b, options));
    CHECK(by_b.size() < 300);
    CHECK(same_bits(to_host(contacts(on, ties_a, make_bvh(on, ties_b), options)), by_b));
    // Nothing to discard among spheres, and none of a set of none.
    const spheres<T> balls(random_spheres<T>(50, random));
    CHECK(same_bits(to_host(contacts(on, copy_to(on, balls), copy_to(on, b), options)),
                    true_contacts(balls.view(), b.view())));
    CHECK(contacts(on, copy_to(on, triangle_soup<T>()), copy_to(on, b), options).empty());
}

/// The same contacts when elements come in another order.
template <class T, class Policy>
void check_permuted(const Policy& on) {
    uniform random(20261129);
    const auto a = copy_to(on, dense_triangles<T>(50, random));
    const auto b = dense_triangles<T>(60, random);
    std::vector<std::uint32_t> order(b.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    order = shuffled(order, random);
    std::vector<triangle<T>> permuted;
    for (const std::uint32_t i : order) permuted.push_back(b.view()[i]);
    const auto expected = to_host(contacts(on, a, copy_to(on, b)));
    auto found = to_host(contacts(on, a, copy_to(on, triangle_soup<T>(permuted))));
    for (auto& c : found) c.b = order[c.b];
    CHECK(expected.size() > 50);
    CHECK(same_bits(sorted(found), expected));
}

template <class T, class Policy>
void check_contact_errors(const Policy& on) {
    const auto soup = copy_to(on, triangle_soup<T>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{9, 9, 9}, {8, 8, 8}, {7, 7, 7}}}));
    rigid<T> bent;
    bent.rotation[4] = T(1.001);
    CHECK_THROWS_AS(contacts(on, posed(soup, bent), soup), invalid_geometry);
    CHECK_THROWS_AS(contacts(on, soup, sphere<T>{{0, 0, 0}, T(-1)}), invalid_geometry);
    const auto quick = to_host(contacts<fast>(on, soup, soup));
    CHECK(ids_of(quick) == to_host(pairs<fast>(on, soup, soup)));
}

template <class T, class Policy>
void check_all_contacts(const Policy& on) {
    check_few_contacts<T>(on);
    check_contact_scenes<T>(on);
    check_contact_options<T>(on);
    check_contacts_with_itself<T>(on);
    check_contacts_of_single_shapes<T>(on);
    check_discarding<T>(on);
    check_permuted<T>(on);
    check_contact_errors<T>(on);
}

}  // namespace abut::test
