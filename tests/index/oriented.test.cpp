// SPDX-License-Identifier: MIT
#include <abut/index/oriented.hpp>

#include <cmath>
#include <concepts>
#include <cstring>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

using namespace abut;

static_assert(bvh_layout_kind<oriented_layout> && bvh_layout<oriented_view<double, host_space>>);
static_assert(sizeof(oriented_node<float>) == 128 && sizeof(oriented_node<double>) == 256);

namespace {

/// Whether each child's box holds all corners below it: floats, measured in double. tests/shape proves it in exact
/// arithmetic.
bool holds_all(const bvh<triangle_soup<float>, host_space, oriented_layout>& tree) {
    const auto view = tree.view();
    const auto shapes = tree.set().view();
    bool all = true;
    const auto holds = [](const obb<float>& box, const vec3<float>& p) {
        const double most[] = {box.half_widths.x, box.half_widths.y, box.half_widths.z};
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
            const vec3<float> axis = box.axes[i];
            const double along = double(axis.x) * (double(p.x) - double(box.center.x)) +
                                 double(axis.y) * (double(p.y) - double(box.center.y)) +
                                 double(axis.z) * (double(p.z) - double(box.center.z));
            inside = inside && (std::fabs(along) <= most[i] * (1 + 1e-14) || !std::isfinite(most[i]));
        }
        return inside;
    };
    const auto check_below = [&](const auto& self, bvh_child child, const std::vector<obb<float>>& above) -> void {
        if (child.is_leaf()) {
            const auto t = shapes[child.index()];
            for (const auto& box : above) all = all && holds(box, t.a) && holds(box, t.b) && holds(box, t.c);
            return;
        }
        for (const int side : {0, 1}) {
            auto with = above;
            with.push_back(view.volume(view.fetch(child.index()), side));
            self(self, view.child(view.fetch(child.index()), side), with);
        }
    };
    if (tree.size() > 0) check_below(check_below, view.root(), {});
    return all;
}

}  // namespace

TEMPLATE_TEST_CASE("oriented: well-formed, of any builder", "", float, double) {
    using T = TestType;
    test::uniform random(85);
    for (const auto builder : {bvh_builder::linear, bvh_builder::sah, bvh_builder::ploc}) {
        for (const std::size_t n : {0u, 1u, 2u, 3u, 7u, 100u, 1000u}) {
            const triangle_soup<T> soup(test::random_triangles<T>(n, random));
            const auto tree = make_bvh(serial{}, soup, {.builder = builder});
            const auto result = oriented(serial{}, tree), threads = oriented(openmp{3}, tree);
            CAPTURE(n);
            CHECK(find_flaw(result.view(), soup.view()) == "");
            if constexpr (std::same_as<T, float>) CHECK(holds_all(result));
            bool same = true;
            for (std::size_t i = 0; i + 1 < n; ++i) {
                const auto& a = result.view().fetch(static_cast<std::uint32_t>(i));
                const auto& b = threads.view().fetch(static_cast<std::uint32_t>(i));
                same = same && std::memcmp(a.volume, b.volume, sizeof a.volume) == 0 && a.child[0] == b.child[0] &&
                       a.child[1] == b.child[1];
            }
            CHECK(same);
        }
    }
    for (const auto& [name, soup] : test::hard_sets<T>(200)) {
        CAPTURE(name);
        CHECK(find_flaw(oriented(serial{}, make_bvh(serial{}, soup)).view(), soup.view()) == "");
    }
}

TEMPLATE_TEST_CASE("oriented: queries do not depend on it", "", float, double) {
    using T = TestType;
    test::uniform random(86);
    const triangle_soup<T> a(test::random_triangles<T>(700, random)), b(test::random_triangles<T>(900, random));
    const spheres<T> balls(test::random_spheres<T>(300, random));
    const auto check_on = [&](const auto& on) {
        const auto tree = make_bvh(on, a), tree_b = make_bvh(on, b, {.builder = bvh_builder::sah});
        const auto index = oriented(on, tree), other = oriented(on, tree_b);
        const auto expected = to_host(pairs(on, a, b));
        CHECK(expected.size() > 500);
        CHECK(to_host(pairs(on, index, other)) == expected);
        CHECK(count(on, index, other) == expected.size());
        CHECK(any(on, index, other));
        CHECK(!any(on, index, posed(other, rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {100, 0, 0}})));
        CHECK(to_host(pairs(on, index, tree_b)) == expected);
        CHECK(to_host(pairs(on, wide(on, tree), other)) == expected);
        CHECK(to_host(pairs(on, index, make_grid(on, b))) == expected);
        CHECK(to_host(pairs(on, balls, index)) == to_host(pairs(on, balls, a)));
        std::vector<posed_pair<std::remove_const_t<decltype(index)>>> list;
        std::vector<tagged_pair> tagged;
        test::draws d(87, 0, 0);
        for (std::uint32_t k = 0; k < 20; ++k) {
            const rigid<T> pose = test::make_pose<T>(d, 0.5), second = test::make_pose<T>(d, 0.5);
            const auto moved = to_host(pairs(on, posed(a, pose), posed(b, second)));
            CHECK(to_host(pairs(on, posed(index, pose), posed(other, second))) == moved);
            list.push_back({posed(index, pose), posed(other, second)});
            for (const auto& [i, j] : moved) tagged.push_back({k, i, j});
        }
        CHECK(tagged.size() > 2000);
        CHECK((to_host(pairs(on, list)) == tagged));
    };
    check_on(openmp{3});
    if constexpr (std::same_as<T, float>) check_on(serial{});  // the same walks: compiling them takes long
    for (const auto& [name, soup] : test::hard_sets<T>(150)) {
        CAPTURE(name);
        const auto index = oriented(serial{}, make_bvh(serial{}, soup));
        CHECK(to_host(pairs(serial{}, index, index)) == to_host(pairs(serial{}, soup, soup)));
    }
}

TEST_CASE("oriented: shells that nest and planes that touch") {
    const auto outer = test::icosphere<float>(4, 1.0), inner = test::icosphere<float>(4, 0.98);
    const mesh<float> a(outer.vertices, outer.faces), b(inner.vertices, inner.faces);
    const auto index = oriented(serial{}, make_bvh(serial{}, a)), other = oriented(serial{}, make_bvh(serial{}, b));
    CHECK(!any(serial{}, index, other));
    // Onto itself, under the identity and baked: each triangle touches its neighbours, in one point at least.
    const auto expected = to_host(pairs(serial{}, make_bvh(serial{}, a), make_bvh(serial{}, a)));
    CHECK(expected.size() > 10 * a.size());
    CHECK(to_host(pairs(serial{}, index, index)) == expected);
    CHECK(to_host(pairs(serial{}, index, posed(index, rigid<float>{}))) == expected);
}
