// SPDX-License-Identifier: MIT
#include <abut/index/lbvh.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <abut/abut.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

namespace {

constexpr bvh_builder all_builders[] = {bvh_builder::linear, bvh_builder::mean_split, bvh_builder::sah};
constexpr bvh_builder top_down_builders[] = {bvh_builder::mean_split, bvh_builder::sah};

/// Well-formed, and the same tree, bit for bit, from any number of threads.
template <class Set>
void check_builder(const Set& set, bvh_builder builder) {
    const bvh_options options{.builder = builder};
    const auto tree = make_bvh(serial{}, set, options);
    CHECK(find_flaw(tree.view(), set.view()) == "");
    if (builder == bvh_builder::linear) return;  // tests/index/bvh.test.cpp
    for (const int threads : {2, 3}) {
        CAPTURE(threads);
        CHECK(test::same_bits(tree.stored(), make_bvh(openmp{threads}, set, options).stored()));
    }
}

template <class T>
std::vector<index_pair> brute_force(const triangle_soup<T>& a, const triangle_soup<T>& b) {
    std::vector<index_pair> touching;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (intersects(a.view()[i], b.view()[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

}  // namespace

TEMPLATE_TEST_CASE("builders: well-formed for n = 0, 1, 2, ..., 100 and large", "", float, double) {
    using T = TestType;
    test::uniform random(31);
    for (const bvh_builder builder : all_builders) {
        CAPTURE(static_cast<int>(builder));
        for (std::size_t n = 0; n <= 100; ++n) {
            CAPTURE(n);
            check_builder(triangle_soup<T>(test::random_triangles<T>(n, random)), builder);
        }
        check_builder(spheres<T>(test::random_spheres<T>(30'000, random)), builder);
    }
}

TEMPLATE_TEST_CASE("builders: well-formed over sets that are hard to divide", "", float, double) {
    using T = TestType;
    for (const auto& [name, set] : test::hard_sets<T>(5000)) {
        for (const bvh_builder builder : all_builders) {
            CAPTURE(name, static_cast<int>(builder));
            check_builder(set, builder);
        }
    }
    for (const bvh_builder builder : all_builders) {
        CAPTURE(static_cast<int>(builder));
        check_builder(test::endless_spheres<T>(3000), builder);
        check_builder(equal_spheres<T>(std::vector<vec3<T>>(5000, {1, 2, 3}), T(0.5)), builder);
        check_builder(spheres<T>({{{0, 0, 0}, std::numeric_limits<T>::max()}}), builder);
    }
}

TEST_CASE("builders: sets without depth of their own are divided in halves") {
    for (const bvh_builder builder : top_down_builders) {
        const equal_spheres<float> same(std::vector<vec3<float>>(4096, {1, 2, 3}), 0.5f);
        CHECK(quality(make_bvh(serial{}, same, {.builder = builder})).greatest_depth == 12);
        std::vector<vec3<float>> line(4096, {0, 0, 0});
        for (std::size_t i = 0; i < line.size(); ++i) line[i].y = static_cast<float>(i);
        const auto q = quality(make_bvh(serial{}, equal_spheres<float>(line, 0), {.builder = builder}));
        CHECK(q.greatest_depth <= 20);
    }
}

namespace {

/// Splits off one shape at a time: the tree would be as deep as it has shapes.
struct miser {
    template <class T>
    struct rule {
        std::uint32_t first;
        bool operator()(const detail::shape_ref<T>& ref) const { return ref.id == first; }
    };
    template <class T>
    rule<T> operator()(const detail::shape_ref<T>* refs, const detail::subtree<T>&) const {
        return {refs[0].id};
    }
};
/// Finds no way to divide.
struct waverer {
    template <class T>
    miser::rule<T> operator()(const detail::shape_ref<T>*, const detail::subtree<T>&) const {
        return {~std::uint32_t{0}};
    }
};

template <class Splitter, class Set>
bvh_quality built_by(const Set& set) {
    using tree = bvh<Set, host_space>;
    auto nodes = std::make_shared<typename tree::storage>();
    nodes->nodes = {serial{}, set.size() - 1};
    nodes->root = {serial{}, 1};
    detail::build_top_down(serial{}, set.view(), *nodes, Splitter{});
    CHECK(find_flaw(nodes->view_of(set.size()), set.view()) == "");
    return quality(tree(set, nodes));
}

}  // namespace

TEST_CASE("builders: whatever a splitter chooses, no leaf is deeper than promised") {
    test::uniform random(41);
    for (const std::size_t n : {2u, 3u, 96u, 97u, 98u, 5000u, 70'000u}) {
        CAPTURE(n);
        const triangle_soup<float> set(test::random_triangles<float>(n, random));
        const int depth = built_by<miser>(set).greatest_depth;
        CHECK(depth == std::min(static_cast<int>(n) - 1, bvh_max_depth));
        CHECK(built_by<waverer>(set).greatest_depth == detail::least_depth(n));
    }
    CHECK(detail::least_depth(1) == 0);
    CHECK(detail::least_depth(2) == 1);
    CHECK(detail::least_depth(3) == 2);
    CHECK(detail::least_depth(4) == 2);
    CHECK(detail::least_depth(5) == 3);
}

namespace {

/// The ids below a child.
template <class Tree>
std::vector<std::uint32_t> ids_below(const Tree& tree, bvh_child child) {
    if (child.is_leaf()) return {child.index()};
    const auto node = tree.fetch(child.index());
    auto ids = ids_below(tree, tree.child(node, 0));
    for (const std::uint32_t id : ids_below(tree, tree.child(node, 1))) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    return ids;
}

std::vector<std::uint32_t> left_of_root(const std::vector<vec3<float>>& places, bvh_builder builder) {
    const auto tree = make_bvh(serial{}, equal_spheres<float>(places, 0.5f), {.builder = builder});
    return ids_below(tree.view(), tree.view().child(tree.view().fetch(0), 0));
}

/// Boxes, some of them of all of space, which no set has today.
struct box_list {
    using scalar_type = float;
    using shape_type = aabb<float>;
    using memory_space = host_space;
    const aabb<float>* boxes;
    std::size_t count;
    [[nodiscard]] std::size_t size() const { return count; }
    [[nodiscard]] aabb<float> operator[](std::size_t i) const { return boxes[i]; }
};

}  // namespace

TEST_CASE("builders: where they divide") {
    using ids = std::vector<std::uint32_t>;
    // The mean, 60, and not the middle, 50.
    CHECK(left_of_root({{0, 0, 0}, {55, 0, 0}, {55, 0, 0}, {100, 0, 0}, {55, 0, 0}, {55, 0, 0}, {100, 0, 0}},
                       bvh_builder::mean_split) == ids{0, 1, 2, 4, 5});
    // x varies most, although y reaches farther.
    CHECK(left_of_root({{0, 0, 0}, {8, 0, 0}, {0, 10, 0}, {8, 0, 0}, {0, 0, 0}, {8, 0, 0}, {0, 0, 0}, {8, 0, 0}},
                       bvh_builder::mean_split) == ids{0, 2, 4, 6});
    // Boxes of side 1: three apart from five costs least.
    CHECK(left_of_root({{0, 0, 0}, {0, 0, 40}, {0, 0, 2}, {0, 0, 42}, {0, 0, 4}, {0, 0, 44}, {0, 0, 46}, {0, 0, 48}},
                       bvh_builder::sah) == ids{0, 2, 4});
    // A plate and a few pieces above it: y, although x and z reach farther.
    std::vector<vec3<float>> plate;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) plate.push_back({static_cast<float>(i), 0, static_cast<float>(j)});
    }
    for (int i = 0; i < 10; ++i) plate.push_back({static_cast<float>(i), 8, static_cast<float>(i)});
    CHECK(left_of_root(plate, bvh_builder::sah).size() == 100);
}

TEST_CASE("builders: sah takes the cheapest of its divisions") {
    test::uniform random(49);
    for (const std::size_t n : {3u, 5u, 20u, 200u, 2000u}) {
        const auto triangles = test::random_triangles<float>(n, random);
        std::vector<detail::shape_ref<float>> refs;
        detail::subtree<float> all{0, n, empty_box<float>(), empty_box<float>(), 0, 0};
        for (std::size_t i = 0; i < n; ++i) {
            refs.push_back({bounds(triangles[i]), static_cast<std::uint32_t>(i)});
            all.box = merge(all.box, refs[i].box);
            all.keys = merge(all.keys, aabb<float>{refs[i].key(), refs[i].key()});
        }
        const auto cost = [&](const auto& rule) {
            auto left = empty_box<float>(), right = empty_box<float>();
            double left_count = 0, right_count = 0;
            for (const auto& ref : refs) {
                const bool goes_left = rule(ref);
                (goes_left ? left : right) = merge(goes_left ? left : right, ref.box);
                (goes_left ? left_count : right_count) += 1;
            }
            if (left_count == 0 || right_count == 0) return std::numeric_limits<double>::infinity();
            return left_count * detail::half_surface(left, 1) + right_count * detail::half_surface(right, 1);
        };
        const auto chosen = detail::sah_splitter<float>{}(refs.data(), all);
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            for (int bin = 1; bin < 16; ++bin) {
                auto other = chosen;
                other.axis = axis;
                other.bin = bin;
                least = std::min(least, cost(other));
            }
        }
        CAPTURE(n);
        CHECK(cost(chosen) <= 1.0001 * least);
    }
}

TEST_CASE("builders: the same tree at any scale") {
    test::uniform random(45);
    const auto at_scale = [](std::vector<triangle<float>> triangles, float scale, bvh_builder builder) {
        for (auto& t : triangles) t = {scale * t.a, scale * t.b, scale * t.c};
        const auto tree = make_bvh(serial{}, triangle_soup<float>(triangles), {.builder = builder});
        std::vector<bvh_child> children{tree.view().root()};
        for (std::uint32_t i = 0; i + 1 < triangles.size(); ++i) {
            for (const int side : {0, 1}) children.push_back(tree.view().child(tree.view().fetch(i), side));
        }
        return children;
    };
    const auto triangles = test::random_triangles<float>(500, random);
    for (const bvh_builder builder : top_down_builders) {
        const auto expected = at_scale(triangles, 1, builder);
        for (const float scale : {0x1p-100f, 0x1p-60f, 0x1p60f, 0x1p124f}) {
            CAPTURE(static_cast<int>(builder), scale);
            CHECK(at_scale(triangles, scale, builder) == expected);
        }
    }
}

TEST_CASE("builders: boxes without a middle") {
    constexpr float far = infinity<float>;
    test::uniform random(47);
    std::vector<aabb<float>> boxes;
    for (int i = 0; i < 2000; ++i) {
        const auto p = random.point<float>(-1, 1);
        boxes.push_back(i % 5 == 0 ? aabb<float>{{-far, p.y, p.z}, {far, p.y, p.z}} : aabb<float>{p, p});
    }
    const box_list shapes{boxes.data(), boxes.size()};
    const auto check = [&](const auto& splitter) {
        standard_layout::storage<float, host_space> tree;
        tree.nodes = {serial{}, boxes.size() - 1};
        tree.root = {serial{}, 1};
        detail::build_top_down(serial{}, shapes, tree, splitter);
        CHECK(find_flaw(tree.view_of(boxes.size()), shapes) == "");
    };
    check(detail::sah_splitter<float>{});
    check(detail::mean_splitter<float>{});
}

TEMPLATE_TEST_CASE("builders: queries do not depend on them", "", float, double) {
    using T = TestType;
    test::uniform random(43);
    const triangle_soup<T> a(test::random_triangles<T>(600, random)), b(test::random_triangles<T>(500, random));
    const auto expected = brute_force(a, b);
    CHECK(expected.size() > 200);
    for (const bvh_builder left : all_builders) {
        for (const bvh_builder right : all_builders) {
            CAPTURE(static_cast<int>(left), static_cast<int>(right));
            const auto tree_a = make_bvh(serial{}, a, {.builder = left}), tree_b = make_bvh(serial{}, b, {.builder = right});
            CHECK(to_host(pairs(serial{}, tree_a, tree_b)) == expected);
            CHECK(to_host(pairs(openmp{3}, tree_a, b)) == expected);
        }
    }
}

TEST_CASE("builders: a tree by surfaces costs less than one by means, and that less than a linear one") {
    const test::torus<float> shape(200, 80, 1, 0.4);
    const mesh<float> torus(shape.vertices, shape.faces);
    double cost[3];
    for (const bvh_builder builder : all_builders) {
        cost[static_cast<int>(builder)] = quality(make_bvh(serial{}, torus, {.builder = builder})).sah_cost;
    }
    CHECK(cost[1] < cost[0]);
    CHECK(cost[2] < cost[1]);
}

TEST_CASE("builders: options that there are not") {
    const auto set = triangle_soup<float>(std::vector<triangle<float>>(3));
    CHECK_THROWS_WITH(make_bvh(serial{}, set, {.builder = static_cast<bvh_builder>(3)}),
                      "abut::make_bvh: the builder is none of bvh_builder");
}
