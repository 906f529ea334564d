// SPDX-License-Identifier: MIT
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/traversal_cases.hpp"

namespace abut::test {

namespace {

template <class T, class Policy>
void check_all(const Policy& on) {
    check_traversal<T, traversal::one_first>(on);
    check_traversal<T, traversal::larger_first>(on);
    check_traversal<T, traversal::alternate>(on);
    check_traversal<T, traversal::breadth_first>(on);
}

/// Trees of two layouts, on the host: it has all layouts, and the walks are the same elsewhere.
template <traversal... Traversals, class Layout, class OtherLayout>
void check_layouts(const Layout& lay, const OtherLayout& lay_other) {
    constexpr openmp on{.threads = 2};
    uniform random(20261205);
    for (const auto& [n, m] : {std::pair(2, 2), std::pair(2, 90), std::pair(5, 300), std::pair(250, 170)}) {
        const auto a = random_soup<float>(static_cast<std::size_t>(n), random);
        const auto b = random_soup<float>(static_cast<std::size_t>(m), random);
        const pair_list expected = placed_truth(a.view(), b.view());
        const auto x = lay(make_bvh(on, a));
        const auto y = lay_other(make_bvh(on, b));
        (check_walked<Traversals>(on, x, y, expected), ...);
    }
    for (const auto& [name, set] : hard_sets<float>(40)) {
        CAPTURE(name);
        const auto x = lay(make_bvh(on, set));
        const auto y = lay_other(make_bvh(on, set));
        (check_walked<Traversals>(on, x, y, placed_truth(set.view(), set.view())), ...);
    }
}
template <traversal... Traversals, class Layout>
void check_layouts(const Layout& lay) {
    check_layouts<Traversals...>(lay, lay);
}

/// A tree of a layout, and another under a pose.
template <traversal Traversal, class Layout>
void check_posed_layout(const Layout& lay) {
    constexpr openmp on{.threads = 2};
    uniform random(20261206);
    draws d(20261206, 91, 0);
    const rigid<float> pose = make_pose<float>(d, 1);
    const auto a = random_soup<float>(400, random);
    const auto b = brought_back(random_triangles<float>(300, random), pose, {0, 0, 0});
    using view = posed_view<triangle_soup<float>::view_type>;
    const pair_list expected = placed_truth(a.view(), view{b.view(), pose});
    CHECK(expected.size() > 50);
    check_walked<Traversal>(on, lay(make_bvh(on, a)), posed(lay(make_bvh(on, b)), pose), expected);
}

// All give the same pairs; these are different walks.
using tree_view = bvh_view<float, host_space>;
template <traversal Traversal, class Rule>
inline constexpr bool has_rule =
    std::same_as<typename detail::way_down<Traversal>::template walk<tree_view, tree_view, detail::same_frame>,
                 detail::rule_walk<tree_view, tree_view, detail::same_frame, Rule>>;
static_assert(has_rule<traversal::one_first, detail::opens_one_first> &&
              has_rule<traversal::larger_first, detail::opens_larger> &&
              has_rule<traversal::alternate, detail::opens_in_turn>);

/// Counts its calls.
struct calls_of {
    std::uint32_t* calls;
    bool operator()(std::uint32_t, std::uint32_t) const {
        execution::atomic_add(calls, 1u);
        return true;
    }
};

/// Of two soups all pairs of which cross.
template <traversal Traversal>
std::uint32_t calls_of_any() {
    const triangle_soup<float> a(std::vector<triangle<float>>(500, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
    const triangle_soup<float> b(std::vector<triangle<float>>(500, {{1, 1, -1}, {2, 1, 1}, {1, 2, 1}}));
    std::uint32_t calls = 0;
    CHECK(any(serial{}, make_bvh(serial{}, a), make_bvh(serial{}, b),
              walked<Traversal, calls_of>{.filter = {&calls}, .start_depth = 3}));
    return calls;
}

/// Keeps few pairs.
struct keep_few {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return (7 * a + b) % 1009 == 0; }
};

}  // namespace

TEST_CASE("traversals: serial") {
    check_all<float>(serial{});
    check_walked_forms<float, traversal::larger_first>(serial{});
    check_walked_forms<float, traversal::breadth_first>(serial{});
}

TEST_CASE("traversals: openmp") {
    constexpr openmp on{.threads = 3};
    check_all<double>(on);
    check_walked_forms<double, traversal::one_first>(on);
    check_walked_forms<double, traversal::alternate>(on);
    check_walked_forms<double, traversal::breadth_first>(on);
}

TEST_CASE("traversals: layouts") {
    using enum traversal;
    constexpr openmp on{.threads = 2};
    const auto plain = [](const auto& tree) { return tree; };
    const auto in_16_bits = [&](const auto& tree) { return quantised(on, tree); };
    const auto without_leaves = [&](const auto& tree) { return leafless(on, tree); };
    const auto of_four = [&](const auto& tree) { return wide(on, tree); };
    const auto turned = [&](const auto& tree) { return oriented(on, tree); };
    SECTION("leafless") { check_layouts<one_first, larger_first, alternate, breadth_first>(without_leaves); }
    SECTION("wide") { check_layouts<one_first, larger_first, alternate, breadth_first>(of_four); }
    SECTION("oriented") { check_layouts<one_first, larger_first, alternate, breadth_first>(turned); }
    SECTION("18-DOPs") {
        check_layouts<larger_first>([&](const auto& tree) { return bounded_by<kdop<float, 18>>(on, tree); });
    }
    SECTION("posed") {
        check_posed_layout<larger_first>(turned);
        check_posed_layout<alternate>(of_four);
    }
    SECTION("quantised") { check_layouts<alternate>(in_16_bits); }
    SECTION("mixed") {
        check_layouts<one_first, larger_first>(in_16_bits, without_leaves);
        check_layouts<larger_first, breadth_first>(of_four, plain);
        check_layouts<alternate>(plain, of_four);
        check_layouts<larger_first>(turned, plain);
    }
}

TEST_CASE("traversals: start depths") {
    check_start_depths(serial{});
    check_start_depths(openmp{.threads = 2});
}

TEST_CASE("traversals: any stops early") {
    CHECK(calls_of_any<traversal::one_first>() < 100);
    CHECK(calls_of_any<traversal::larger_first>() < 100);
    CHECK(calls_of_any<traversal::alternate>() < 100);
    CHECK(calls_of_any<traversal::breadth_first>() < 100);
}

TEST_CASE("traversals: levels that are taken in parts") {
    // Each level is all pairs of its nodes, and the last ones are more than are taken at a time.
    constexpr std::uint32_t n = 5000;
    const triangle_soup<float> soup(std::vector<triangle<float>>(n, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    std::uint64_t expected = 0;
    for (std::uint32_t a = 0; a < n; ++a) {
        for (std::uint32_t b = 0; b < n; ++b) expected += keep_few{}(a, b) ? 1 : 0;
    }
    const auto tree = make_bvh(openmp{.threads = 2}, soup);
    CHECK(count(openmp{.threads = 2}, tree, tree, walked<traversal::breadth_first, keep_few>{}) == expected);
}

}  // namespace abut::test
