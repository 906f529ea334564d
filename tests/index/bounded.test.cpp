// SPDX-License-Identifier: MIT
#include <abut/index/bounded.hpp>

#include <cstring>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/encloses.hpp"
#include "support/find_flaw.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

using namespace abut;

static_assert(bvh_layout_kind<bounded_layout<obb<float>>> && bvh_layout_kind<bounded_layout<kdop<double, 26>>>);
static_assert(bvh_layout<bounded_view<sphere<double>, host_space>> && bvh_layout<bounded_view<aabb<float>, host_space>>);
static_assert(sizeof(bounded_node<sphere<float>>) == 64 && sizeof(bounded_node<sphere<double>>) == 80);
static_assert(sizeof(bounded_node<obb<float>>) == 128 && sizeof(bounded_node<obb<double>>) == 256);
static_assert(sizeof(bounded_node<kdop<float, 14>>) == 128 && sizeof(bounded_node<kdop<double, 14>>) == 240);
static_assert(sizeof(bounded_node<kdop<float, 18>>) == 192 && sizeof(bounded_node<kdop<double, 18>>) == 304);
static_assert(sizeof(bounded_node<kdop<float, 26>>) == 256 && sizeof(bounded_node<kdop<double, 26>>) == 432);
static_assert(detail::bvh_layouts_of_one_volume<bounded_layout<obb<float>>::view<double, host_space>,
                                                bounded_view<obb<double>, host_space>>);
static_assert(!detail::bvh_layouts_of_one_volume<bounded_view<kdop<float, 14>, host_space>,
                                                 bounded_view<kdop<float, 18>, host_space>>);
static_assert(!detail::volume_bvh_layout<bvh_view<float, host_space>>);

namespace {

template <class V>
using scalar_of = typename detail::volume_scalar<V>::type;
template <class V>
using bounded_soup = bvh<triangle_soup<scalar_of<V>>, host_space, bounded_layout<V>>;

/// Whether each volume encloses all triangles below it, exactly, and the root's box the boxes of all volumes.
template <class V>
bool holds_all(const bounded_soup<V>& tree) {
    const auto view = tree.view();
    const auto shapes = tree.set().view();
    bool all = true;
    const auto check_below = [&](const auto& self, bvh_child child, const std::vector<V>& above) -> void {
        if (child.is_leaf()) {
            for (const V& volume : above) all = all && test::encloses(volume, triangle<scalar_of<V>>(shapes[child.index()]));
            return;
        }
        const auto& node = view.fetch(child.index());
        for (const int side : {0, 1}) {
            all = all && contains(view.root_bounds(), view.bounds(node, side));
            auto with = above;
            with.push_back(view.volume(node, side));
            self(self, view.child(node, side), with);
        }
    };
    if (tree.size() > 0) check_below(check_below, view.root(), {});
    return all;
}

template <class V>
bool same_nodes(const bounded_soup<V>& a, const bounded_soup<V>& b) {
    bool same = a.size() == b.size();
    const auto nodes_a = a.view(), nodes_b = b.view();
    for (std::uint32_t i = 0; i + 1 < a.size() && same; ++i) {
        const auto &x = nodes_a.fetch(i), &y = nodes_b.fetch(i);
        same = std::memcmp(x.volume, y.volume, sizeof x.volume) == 0 && x.child[0] == y.child[0] && x.child[1] == y.child[1];
    }
    return same;
}

template <class T>
triangle_soup<T> ball_of_triangles(double radius) {
    const auto ball = test::icosphere<T>(3, radius);
    std::vector<triangle<T>> triangles;
    for (const face& f : ball.faces) triangles.push_back({ball.vertices[f[0]], ball.vertices[f[1]], ball.vertices[f[2]]});
    return triangle_soup<T>(triangles);
}

}  // namespace

TEMPLATE_TEST_CASE("bounded: well-formed, of any builder", "", sphere<float>, sphere<double>, aabb<float>, aabb<double>,
                   obb<float>, obb<double>, (kdop<float, 14>), (kdop<double, 14>), (kdop<float, 18>), (kdop<double, 18>),
                   (kdop<float, 26>), (kdop<double, 26>)) {
    using T = scalar_of<TestType>;
    test::uniform random(85);
    for (const auto builder : {bvh_builder::linear, bvh_builder::sah, bvh_builder::ploc}) {
        for (const std::size_t n : {0u, 1u, 2u, 3u, 7u, 100u, 1000u}) {
            const triangle_soup<T> soup(test::random_triangles<T>(n, random));
            const auto tree = make_bvh(serial{}, soup, {.builder = builder});
            const auto result = bounded_by<TestType>(serial{}, tree);
            CAPTURE(n);
            CHECK(test::find_flaw(result.view(), soup.view()) == "");
            CHECK(same_nodes<TestType>(result, bounded_by<TestType>(openmp{3}, tree)));
            if (n <= 100) CHECK(holds_all<TestType>(result));
        }
    }
    for (const std::size_t n : {30u, 200u}) {
        for (const auto& [name, soup] : test::hard_sets<T>(n)) {
            CAPTURE(name, n);
            const auto result = bounded_by<TestType>(serial{}, make_bvh(serial{}, soup));
            CHECK(test::find_flaw(result.view(), soup.view()) == "");
            if (n <= 100) CHECK(holds_all<TestType>(result));
        }
    }
}

TEST_CASE("bounded: polytopes are merged to what is made around all") {
    test::uniform random(89);
    const triangle_soup<float> soup(test::random_triangles<float>(300, random));
    const auto index = bounded_by<kdop<float, 26>>(serial{}, make_bvh(serial{}, soup));
    const auto nodes = index.view();
    const auto& root = nodes.fetch(nodes.root().index());
    const auto merged = merge(root.volume[0], root.volume[1]), expected = around<kdop<float, 26>>(soup.view());
    CHECK(std::memcmp(&merged, &expected, sizeof merged) == 0);
}

// One kind of query for each kind of volume: each is compiled anew.
TEMPLATE_TEST_CASE("bounded: pairs, posed or not, do not depend on the volume", "", sphere<float>, aabb<double>, obb<float>,
                   obb<double>, (kdop<float, 14>), (kdop<double, 18>), (kdop<float, 26>)) {
    using T = scalar_of<TestType>;
    const openmp on{3};
    const auto index_of = [&](const triangle_soup<T>& soup, const bvh_options& options = {}) {
        return bounded_by<TestType>(on, make_bvh(on, soup, options));
    };
    test::uniform random(86);
    const triangle_soup<T> a(test::random_triangles<T>(700, random)), b(test::random_triangles<T>(900, random));
    const auto index = index_of(a), other = index_of(b, {.builder = bvh_builder::sah});
    const auto expected = to_host(pairs(on, a, b));
    CHECK(expected.size() > 500);
    CHECK(to_host(pairs(on, index, other)) == expected);
    std::size_t meet = 0;
    test::draws d(87, 0, 0);
    for (int k = 0; k < 20; ++k) {
        const rigid<T> pose = test::make_pose<T>(d, 0.5), second = test::make_pose<T>(d, 0.5);
        const auto moved = to_host(pairs(on, posed(a, pose), posed(b, second)));
        CHECK(to_host(pairs(on, posed(index, pose), posed(other, second))) == moved);
        meet += moved.size();
    }
    CHECK(meet > 2000);

    for (const auto& [name, soup] : test::hard_sets<T>(150)) {
        CAPTURE(name);
        const auto hard = index_of(soup);
        CHECK(to_host(pairs(on, hard, hard)) == to_host(pairs(on, soup, soup)));
    }

    // Shells that nest, and one onto itself, in one frame and under the identity: each triangle touches its neighbours.
    const triangle_soup<T> outer = ball_of_triangles<T>(1), inner = ball_of_triangles<T>(0.96);
    const auto shell = index_of(outer);
    const auto touching = to_host(pairs(on, outer, outer));
    CHECK(touching.size() > 10 * outer.size());
    CHECK(to_host(pairs(on, shell, shell)) == touching);
    CHECK(to_host(pairs(on, posed(shell, rigid<T>{}), posed(shell, rigid<T>{}))) == touching);
    CHECK(pairs(on, shell, index_of(inner)).size() == 0);
}

TEST_CASE("bounded: any query, beside any other layout") {
    using T = float;
    test::uniform random(86);
    const triangle_soup<T> a(test::random_triangles<T>(700, random)), b(test::random_triangles<T>(900, random));
    const spheres<T> balls(test::random_spheres<T>(300, random));
    const openmp on{3};
    const auto tree = make_bvh(on, a), tree_b = make_bvh(on, b, {.builder = bvh_builder::sah});
    const auto boxes = oriented(on, tree), boxes_b = oriented(on, tree_b);
    const auto index = bounded_by<kdop<T, 18>>(on, tree);
    const auto expected = to_host(pairs(on, a, b));
    CHECK(expected.size() > 500);
    CHECK(to_host(pairs(serial{}, boxes, boxes_b)) == expected);
    CHECK(count(on, boxes, boxes_b) == expected.size());
    CHECK(any(on, boxes, boxes_b));
    CHECK(!any(on, boxes, posed(boxes_b, rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {100, 0, 0}})));
    CHECK(to_host(pairs(on, index, boxes_b)) == expected);
    CHECK(to_host(pairs(on, bounded_by<sphere<T>>(on, tree), tree_b)) == expected);
    CHECK(to_host(pairs(on, wide(on, tree), boxes_b)) == expected);
    CHECK(to_host(pairs(on, index, make_grid(on, b))) == expected);
    CHECK(to_host(pairs(on, balls, index)) == to_host(pairs(on, balls, a)));
}

TEMPLATE_TEST_CASE("bounded: lists of pairs", "", sphere<double>, obb<float>, (kdop<float, 18>)) {
    using T = scalar_of<TestType>;
    const openmp on{3};
    test::uniform random(88);
    const triangle_soup<T> a(test::random_triangles<T>(700, random)), b(test::random_triangles<T>(900, random));
    const auto index = bounded_by<TestType>(on, make_bvh(on, a)), other = bounded_by<TestType>(on, make_bvh(on, b));
    std::vector<posed_pair<bounded_soup<TestType>>> list;
    std::vector<tagged_pair> tagged;
    test::draws d(87, 0, 0);
    for (std::uint32_t k = 0; k < 20; ++k) {
        const rigid<T> pose = test::make_pose<T>(d, 0.5), second = test::make_pose<T>(d, 0.5);
        list.push_back({posed(index, pose), posed(other, second)});
        for (const auto& [i, j] : to_host(pairs(on, posed(a, pose), posed(b, second)))) tagged.push_back({k, i, j});
    }
    CHECK(tagged.size() > 2000);
    CHECK((to_host(pairs(on, list)) == tagged));
}
