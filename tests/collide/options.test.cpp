// SPDX-License-Identifier: MIT
//
// Options that change no answer are not ignored: what they change is how much is looked at. Here that is counted, by a
// filter, a visitor, and a bounding volume of the caller's own.

#include <concepts>
#include <type_traits>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

#include "collide/stop_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

namespace {

std::uint64_t comparisons = 0;

/// A box that counts how often it is compared with another.
template <class T>
struct counted_box {
    aabb<T> box;
};
template <scalar T, class Triangles>
counted_box<T> around_all(std::type_identity<counted_box<T>>, const Triangles& triangles) {
    return {around_all(std::type_identity<aabb<T>>{}, triangles)};
}
template <scalar T>
counted_box<T> merge(const counted_box<T>& a, const counted_box<T>& b) {
    return {merge(a.box, b.box)};
}
template <scalar T>
bool overlaps(const counted_box<T>& a, const counted_box<T>& b) {
    ++comparisons;
    return overlaps(a.box, b.box);
}
template <scalar T>
bool overlaps(const counted_box<T>& a, const relative_pose<T>& pose, const counted_box<T>& b) {
    ++comparisons;
    return overlaps(a.box, pose, b.box);
}
template <scalar T>
aabb<T> bounds(const counted_box<T>& a) {
    return a.box;
}
static_assert(bounding_volume<counted_box<float>>);

/// n small triangles in a row along x, over a length of 1.
triangle_soup<float> row(std::size_t n, float from, float length) {
    std::vector<triangle<float>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
        const float x = from + length * static_cast<float>(i) / static_cast<float>(n),
                    size = length / static_cast<float>(2 * n);
        triangles.push_back({{x, 0, 0}, {x + size, size, 0}, {x, 0, size}});
    }
    return triangle_soup<float>(triangles);
}

auto counted_tree(const triangle_soup<float>& set) {
    return bounded_by<counted_box<float>>(serial{}, make_bvh(serial{}, set, {.builder = bvh_builder::mean_split}));
}

template <traversal Traversal, class X, class Y>
std::uint64_t comparisons_of(const X& a, const Y& b, int start_depth = 0) {
    comparisons = 0;
    (void)count(serial{}, a, b, query_options<keep_all, Traversal>{.start_depth = start_depth});
    return comparisons;
}

// A filter that captures nothing becomes a pointer and that a bool, so no option is a bool (filter_in_braces.fail.cpp).
static_assert(std::same_as<decltype(query_options<>::sorted), flag> && std::same_as<decltype(self_options<>::sorted), flag> &&
              std::same_as<decltype(contact_options<>::sorted), flag> &&
              std::same_as<decltype(contact_options<>::discard_sideways), flag> &&
              std::same_as<decltype(list_options<>::sorted), flag> &&
              std::same_as<decltype(list_options<>::discard_sideways), flag> &&
              std::same_as<decltype(body_options<>::sorted), flag> &&
              std::same_as<decltype(body_options<>::discard_sideways), flag> &&
              std::same_as<decltype(impact_options::sorted), flag> &&
              std::same_as<decltype(inside_options::known_closed), flag>);
static_assert(flag(true) && flag(2) && flag(std::true_type{}) && !flag(false) && !flag(0u) && !flag());
static_assert(std::is_trivially_copyable_v<query_options<>>);

}  // namespace

TEST_CASE("options: any and visit::stop end a query, serial") { check_stops(serial{}, 300, 3000, 5000); }

TEST_CASE("options: any and visit::stop end a query, openmp") { check_stops(openmp{.threads = 2}, 300, 3000, 50'000); }

TEST_CASE("options: one_first opens the first tree alone as long as it has children") {
    // All of the short row lies within one triangle's box of the long one. Down the long row goes one path, down the short
    // one all. Opened first, the short one has 64 leaves, each of which then goes down the long one.
    const auto longer = counted_tree(row(64, 0, 1));
    const auto shorter = counted_tree(row(64, 0.0005f, 0.005f));
    const auto good = comparisons_of<traversal::one_first>(longer, shorter);
    const auto bad = comparisons_of<traversal::one_first>(shorter, longer);
    CAPTURE(good, bad);
    CHECK(good > 0);
    CHECK(4 * good < bad);
    // The others look which is larger, or open both.
    CHECK(comparisons_of<traversal::larger_first>(longer, shorter) < 2 * good);
    CHECK(comparisons_of<traversal::larger_first>(shorter, longer) < 2 * good);
}

TEST_CASE("options: breadth_first begins at start_depth") {
    // Two balanced trees that are far apart: all that is compared are the nodes at the start, all of one with all of the
    // other, once to count what they make and once to write it.
    const auto here = counted_tree(row(1024, 0, 1)), there = counted_tree(row(1024, 10, 1));
    for (const int depth : {1, 2, 5, 8}) {
        CAPTURE(depth);
        CHECK(comparisons_of<traversal::breadth_first>(here, there, depth) == std::uint64_t{2} << (2 * depth));
    }
    CHECK(comparisons_of<traversal::breadth_first>(here, there, 0) == 8);  // the roots' children, as for 1
}

}  // namespace abut::test
