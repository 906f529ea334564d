// SPDX-License-Identifier: MIT
#include <abut/index/lbvh.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include <abut/abut.hpp>
#include <abut/index/curve_order.hpp>

#include "index/tree_cases.hpp"
#include "support/catch.hpp"
#include "support/find_flaw.hpp"

using namespace abut;

namespace {

constexpr bvh_builder all_builders[] = {bvh_builder::linear, bvh_builder::mean_split, bvh_builder::sah, bvh_builder::ploc};
constexpr bvh_builder builders_by_cost[] = {bvh_builder::mean_split, bvh_builder::sah, bvh_builder::ploc};
constexpr bvh_builder top_down_builders[] = {bvh_builder::mean_split, bvh_builder::sah};

/// Well-formed, and the same tree, bit for bit, from any number of threads.
template <class Set>
void check_builder(const Set& set, bvh_builder builder) {
    const bvh_options options{.builder = builder};
    const auto tree = make_bvh(serial{}, set, options);
    CHECK(test::find_flaw(tree.view(), set.view()) == "");
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
    CHECK(test::find_flaw(nodes->view_of(set.size()), set.view()) == "");
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

/// What ploc.hpp describes, round by round, on plain vectors. `rounds` becomes their number.
template <class T>
standard_layout::storage<T, host_space> joined_by_hand(const std::vector<aabb<T>>& boxes, int bits, int& rounds) {
    struct item {
        aabb<T> box;
        bvh_child child;
        std::size_t seat;
    };
    const std::size_t n = boxes.size();
    standard_layout::storage<T, host_space> tree;
    tree.nodes = {serial{}, n - 1};
    tree.root = {serial{}, 1};
    auto scene = empty_box<T>();
    for (const auto& box : boxes) scene = merge(scene, box);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < n; ++i) {
        order.emplace_back(bits == 63 ? detail::morton_code<std::uint64_t>(boxes[i], scene)
                                      : detail::morton_code<std::uint32_t>(boxes[i], scene) >> (30 - bits),
                           i);
    }
    std::sort(order.begin(), order.end());
    std::vector<item> row;
    for (std::size_t k = 0; k < n; ++k) row.push_back({boxes[order[k].second], bvh_child::leaf(order[k].second), k});
    const detail::plain_area<T> area(scene);
    for (rounds = 0; row.size() > 1; ++rounds) {
        std::vector<std::size_t> choice(row.size());
        for (std::size_t i = 0; i < row.size(); ++i) {
            std::pair<T, std::size_t> least{infinity<T>, ~std::size_t{0}};
            for (std::size_t j = 0; j < row.size(); ++j) {
                const bool near = (i < j ? j - i : i - j) <= detail::ploc_radius;
                if (i != j && near) least = std::min(least, {area(merge(row[i].box, row[j].box)), i ^ j});
            }
            choice[i] = rounds + detail::least_depth(row.size()) < bvh_max_depth ? i ^ least.second : i ^ 1;
        }
        std::vector<item> next;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::size_t j = choice[i];
            const bool joins = j < row.size() && choice[j] == i;
            if (!joins) next.push_back(row[i]);
            if (!joins || j < i) continue;
            const item &a = row[i], &b = row[j];
            tree.nodes.data()[b.seat - 1] = {{a.box, b.box}, {a.child, b.child}};
            next.push_back({merge(a.box, b.box), bvh_child::inner(static_cast<std::uint32_t>(b.seat - 1)), a.seat});
        }
        row = std::move(next);
    }
    *tree.root.data() = {row[0].box, row[0].child};
    return tree;
}

}  // namespace

TEMPLATE_TEST_CASE("builders: ploc joins those that choose each other", "", float, double) {
    using T = TestType;
    auto sets = test::hard_sets<T>(700);
    test::uniform random(61);
    for (const std::size_t n : {2u, 3u, 9u, 255u, 256u, 257u, 2000u}) {
        sets.push_back({std::to_string(n) + " at random", triangle_soup<T>(test::random_triangles<T>(n, random))});
    }
    for (const auto& [name, set] : sets) {
        std::vector<aabb<T>> boxes;
        for (std::size_t i = 0; i < set.size(); ++i) boxes.push_back(bounds(set.view()[i]));
        for (const int bits : {30, 63}) {
            CAPTURE(name, bits);
            const auto tree = make_bvh(serial{}, set, {.morton_bits = bits, .builder = bvh_builder::ploc});
            int rounds = 0;
            CHECK(test::same_bits(tree.stored(), joined_by_hand(boxes, bits, rounds)));
            CHECK(quality(tree).greatest_depth <= rounds);
        }
    }
}

TEST_CASE("builders: ploc halves a row of equals, and one that joins a pair at a time after a while") {
    for (const std::size_t n : {2u, 64u, 4096u}) {
        const equal_spheres<float> same(std::vector<vec3<float>>(n, {1, 2, 3}), 0.5f);
        const auto q = quality(make_bvh(serial{}, same, {.builder = bvh_builder::ploc}));
        CHECK(q.greatest_depth == detail::least_depth(n));
    }
    // Each has all before it inside: the least surface that one can have with another is its own, and with the next more.
    for (const std::size_t n : {10u, 92u, 93u, 94u, 97u, 98u, 300u, 20'000u}) {
        CAPTURE(n);
        std::vector<sphere<float>> nested;
        for (std::size_t i = 0; i < n; ++i) nested.push_back({{0, 0, 0}, 1 + static_cast<float>(i) / 64});
        check_builder(spheres<float>(nested), bvh_builder::ploc);
        int depth = 0;
        for (std::size_t left = n; left > 1; ++depth) {
            left = depth + detail::least_depth(left) < bvh_max_depth ? left - 1 : (left + 1) / 2;
        }
        const auto q = quality(make_bvh(serial{}, spheres<float>(nested), {.builder = bvh_builder::ploc}));
        CHECK(q.greatest_depth == depth);
        CHECK((n < 97 || depth == bvh_max_depth));
    }
}

TEST_CASE("builders: ploc takes Morton codes of any length") {
    test::uniform random(67);
    std::vector<vec3<float>> clusters;
    for (int i = 0; i < 4000; ++i) {
        const float far = i % 2 ? 1e6f : 0.0f;
        clusters.push_back(vec3<float>{far, far, far} + random.point<float>(-1, 1));
    }
    const equal_spheres<float> set(clusters, 0.01f);
    const auto built = [&](int bits) {
        const auto tree = make_bvh(serial{}, set, {.morton_bits = bits, .builder = bvh_builder::ploc});
        CHECK(test::find_flaw(tree.view(), set.view()) == "");
        return tree;
    };
    const auto of_choice = built(0), coarse = built(30), fine = built(63);
    CHECK(test::same_bits(of_choice.stored(), fine.stored()));  // few bits leave crowds here
    CHECK(quality(fine).sah_cost < quality(coarse).sah_cost);
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
    return ids_below(tree.view(), tree.view().child(tree.view().fetch(tree.view().root().index()), 0));
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
    // Two that are close, then the third that is closer to them than the last.
    CHECK(left_of_root({{30, 0, 0}, {11, 0, 0}, {0, 0, 0}, {10, 0, 0}}, bvh_builder::ploc) == ids{1, 2, 3});
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
            const auto surface = [](const aabb<float>& box) {
                return detail::half_surface(detail::half_sides<double>(box));
            };
            return left_count * surface(left) + right_count * surface(right);
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
    for (const bvh_builder builder : builders_by_cost) {
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
        CHECK(test::find_flaw(tree.view_of(boxes.size()), shapes) == "");
    };
    check(detail::sah_splitter<float>{});
    check(detail::mean_splitter<float>{});
    standard_layout::storage<float, host_space> tree;
    tree.nodes = {serial{}, boxes.size() - 1};
    tree.root = {serial{}, 1};
    for (const aabb<float>& scene : {aabb<float>{{-far, -1, -1}, {far, 1, 1}}, aabb<float>{{-1, -1, -1}, {1, 1, 1}}}) {
        *tree.root.data() = {scene, {}};
        execution::buffer<aabb<float>, host_space> copy(serial{}, boxes.size());
        std::copy(boxes.begin(), boxes.end(), copy.data());
        detail::build_ploc<serial, float>(serial{}, copy, tree, 0);
        CHECK(test::find_flaw(tree.view_of(boxes.size()), shapes) == "");
    }
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

TEST_CASE("builders: a tree by surfaces costs less than one by means, and each less than a linear one") {
    const test::torus<float> shape(200, 80, 1, 0.4);
    const mesh<float> torus(shape.vertices, shape.faces);
    double cost[4];
    for (const bvh_builder builder : all_builders) {
        cost[static_cast<int>(builder)] = quality(make_bvh(serial{}, torus, {.builder = builder})).sah_cost;
    }
    CHECK(cost[1] < cost[0]);
    CHECK(cost[2] < cost[1]);
    CHECK(cost[3] < cost[0]);
}

TEST_CASE("builders: options that there are not") {
    const auto set = triangle_soup<float>(std::vector<triangle<float>>(3));
    CHECK_THROWS_WITH(make_bvh(serial{}, set, {.builder = static_cast<bvh_builder>(4)}),
                      "abut::make_bvh: the builder is none of bvh_builder");
}

TEST_CASE("curve_order: cells that follow each other are neighbours, and no cell comes twice") {
    // A cube of 8 cells a side, which begins at a multiple of 8, is a run of 512 cells that begins at a multiple of 512.
    const std::array<std::uint32_t, 3> corners[] = {{0, 0, 0}, {1016, 1016, 1016}, {512, 8, 256}, {40, 1000, 504}};
    for (const auto& corner : corners) {
        CAPTURE(corner[0], corner[1], corner[2]);
        std::vector<std::array<std::uint32_t, 4>> cells;
        for (std::uint32_t i = 0; i < 512; ++i) {
            const std::uint32_t x = corner[0] + i % 8, y = corner[1] + i / 8 % 8, z = corner[2] + i / 64;
            cells.push_back({detail::hilbert_code(x, y, z), x, y, z});
        }
        std::sort(cells.begin(), cells.end());
        CHECK(cells[0][0] % 512 == 0);
        std::size_t jumps = 0, out_of_step = 0;
        for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
            const auto apart = [&](std::size_t k) { return std::abs(int(cells[i][k]) - int(cells[i + 1][k])); };
            jumps += apart(1) + apart(2) + apart(3) != 1;
            out_of_step += cells[i][0] + 1 != cells[i + 1][0];
        }
        CHECK(jumps == 0);
        CHECK(out_of_step == 0);
    }
}
