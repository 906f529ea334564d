// SPDX-License-Identifier: MIT
#pragma once

// Random runs: two random meshes of 1 to 200 triangles under random poses, a tree over each of any builder, built or
// refitted, in any layout, and a query of any kind and traversal, on every policy. No pair is lost and none is made up: the
// truth is a plain loop over `intersects<exact>`. Run k of a seed has the same scene everywhere.

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/mesh_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace random_runs {

// --- what a run draws --------------------------------------------------------------------------------------------------

enum class mesh_kind : int { soup, tangle, lattice, ball, ring, chain, copies };
inline constexpr const char* kind_names[] = {"soup", "tangle", "lattice", "ball", "ring", "chain", "copies"};
inline constexpr int kinds = 7;

/// The last two are not for devices.
inline constexpr std::pair<const char*, bvh_options> builders[] = {
    {"linear", {}},
    {"linear, 30 bits", {.morton_bits = 30}},
    {"linear, 63 bits", {.morton_bits = 63}},
    {"ploc", {.builder = bvh_builder::ploc}},
    {"mean_split", {.builder = bvh_builder::mean_split}},
    {"sah", {.builder = bvh_builder::sah}},
};
inline constexpr int device_builders = 4;
inline constexpr const char* layouts[] = {"standard", "quantised", "leafless", "wide", "oriented", "spheres", "18-DOPs"};
/// From here on layouts are for both sides of a query, and compiled for these alone.
inline constexpr int first_for_both = 3;
inline constexpr const char* questions[] = {"pairs",    "unsorted",  "exact",        "count",     "any",
                                            "one tree", "one first", "larger first", "alternate", "breadth first"};
inline constexpr int one_tree = 5;

template <auto& Names>
int draw_one_of(draws& d) {
    return d.below(static_cast<int>(std::size(Names)));
}

/// Triangles of a kind, in a box of side 2 or about that: apart from each other, of few vertices, on a lattice that makes
/// ties of most pairs, closed surfaces, in a line that doubles its steps, all in one place.
template <scalar T>
surface_data<T> random_surface(draws& d, mesh_kind kind) {
    using construction::round_to;
    if (kind == mesh_kind::ball) return ball_surface<T>(d.below(3), d.uniform(0.2, 1));
    if (kind == mesh_kind::ring) {
        const int around = 3 + d.below(8), across = 3 + d.below(8);
        const torus<T> ring(static_cast<std::uint32_t>(around), static_cast<std::uint32_t>(across), 0.7,
                            d.uniform(0.1, 0.4));
        return {ring.vertices, ring.faces};
    }
    surface_data<T> made;
    const int n = 1 + d.below(d.below(4) == 0 ? 4 : 200);
    const auto id = [](int i) { return static_cast<std::uint32_t>(i); };
    if (kind == mesh_kind::tangle || kind == mesh_kind::lattice) {
        const int points = 3 + d.below(60), half = 1 + d.below(4);
        const auto whole = [&] { return T(d.below(2 * half + 1) - half); };
        for (int i = 0; i < points; ++i) {
            if (kind == mesh_kind::tangle) {
                made.vertices.push_back(round_to<T>(construction::cube(d, 1)));
            } else {
                const T x = whole(), y = whole(), z = whole();
                made.vertices.push_back({x, y, z});
            }
        }
        for (int i = 0; i < n; ++i) {
            const int a = d.below(points), b = d.below(points), c = d.below(points);
            made.faces.push_back({id(a), id(b), id(c)});
        }
        return made;
    }
    construction::point at = construction::cube(d, 1);
    double step = 1e-6, size = d.power_of_ten(-3, 0);
    for (int i = 0; i < n; ++i) {
        if (kind == mesh_kind::soup) at = construction::cube(d, 1), size = d.power_of_ten(-3, 0);
        if (kind == mesh_kind::chain) at.x += step, size = step, step *= 1.1;
        for (int k = 0; k < 3; ++k) {
            // Copies are of one triangle, but for a few.
            const bool copy = kind == mesh_kind::copies && i > 0 && i % 16 != 0;
            made.vertices.push_back(copy ? made.vertices[static_cast<std::size_t>(k)]
                                         : round_to<T>(construction::along(at, size, construction::cube(d, 1))));
        }
        made.faces.push_back({id(3 * i), id(3 * i + 1), id(3 * i + 2)});
    }
    return made;
}

template <scalar T>
struct random_scene {
    mesh_kind kind_a, kind_b;
    placed_mesh<T> a, b;
};

/// Both at any scale, near each other, near the origin or not; some without poses, some turned by quarters, where lattices
/// meet in planes.
template <scalar T>
random_scene<T> make_scene(draws& d) {
    const auto kind_a = static_cast<mesh_kind>(d.below(kinds));
    const auto kind_b = d.below(3) == 0 ? kind_a : static_cast<mesh_kind>(d.below(kinds));
    const T scales[] = {1, T(0x1p-33), T(0x1p33), T(1e-3)};
    const T scale = scales[std::max(0, d.below(6) - 2)];
    const mesh<T> a = as_mesh(random_surface<T>(d, kind_a)), b = as_mesh(random_surface<T>(d, kind_b));
    random_scene<T> s{kind_a, kind_b, {scaled(a, scale), {}}, {scaled(b, scale), {}}};
    const int poses = d.below(4);
    if (poses == 0) return s;
    const bool on_lattice = kind_a == mesh_kind::lattice && kind_b == mesh_kind::lattice && d.below(2) == 0;
    const double reach = d.power_of_ten(-2, 0), far = d.below(4) == 0 ? 100 : 0;
    for (rigid<T>* const pose : {&s.a.pose, &s.b.pose}) {
        *pose = make_pose<T>(d, reach);
        vec3<T>& t = pose->translation;
        if (on_lattice) {
            construction::set_quarter_turns(*pose, d);
            t = {T(d.below(5) - 2), T(d.below(5) - 2), T(d.below(5) - 2)};
        }
        t = {(t.x + T(far)) * scale, (t.y - T(far)) * scale, t.z * scale};
        if (poses == 1) break;
    }
    return s;
}

// --- how it is asked ---------------------------------------------------------------------------------------------------

/// Each layout and traversal is a query to compile anew. The walks of the serial policy are those of openmp, and on a device
/// tests/cuda has tests of them: there the standard layout and the default traversal do.
template <class Policy>
inline constexpr bool has_all_forms = std::same_as<Policy, openmp>;

struct tree_kind {
    int builder, layout;
    bool refitted;

    tree_kind(draws& d, int builders_there)
        : builder(draw_one_of<builders>(d) % builders_there), layout(draw_one_of<layouts>(d)), refitted(d.below(4) == 0) {}
    [[nodiscard]] std::string text() const {
        return std::string(builders[builder].first) + ", " + layouts[layout] + (refitted ? ", refitted" : "");
    }
};

/// use(tree) of a kind over a mesh. A refitted tree was built over the same faces where the mesh is turned inside out.
template <class Policy, scalar T, class Use>
void with_tree(const Policy& on, const mesh<T>& shape, const tree_kind& kind, const Use& use) {
    const bvh_options& options = builders[kind.builder].second;
    const auto set = copy_to(on, shape);
    const auto tree = kind.refitted ? refit(on, make_bvh(on, copy_to(on, scaled(shape, T(-1))), options), set)
                                    : make_bvh(on, set, options);
    if constexpr (!has_all_forms<Policy>) {
        use(tree);
    } else {
        if (kind.layout == 0) use(tree);
        if (kind.layout == 1) use(quantised(on, tree));
        if (kind.layout == 2) use(leafless(on, tree));
        if (kind.layout == 3) use(wide(on, tree));
        if (kind.layout == 4) use(oriented(on, tree));
        if (kind.layout == 5) use(bounded_by<sphere<T>>(on, tree));
        if (kind.layout == 6) use(bounded_by<kdop<T, 18>>(on, tree));
    }
}

template <class Tree>
struct layout_of {
    using type = typename Tree::layout_type;
};
template <class Tree>
struct layout_of<posed_object<Tree>> : layout_of<Tree> {};
template <class Tree, class Layout>
inline constexpr bool has_layout = std::same_as<typename layout_of<Tree>::type, Layout>;
template <class Tree>
inline constexpr bool is_for_both =
    !has_layout<Tree, standard_layout> && !has_layout<Tree, quantised_layout> && !has_layout<Tree, leafless_layout>;
template <class X, class Y>
inline constexpr bool may_meet = has_layout<X, typename layout_of<Y>::type> || (!is_for_both<X> && !is_for_both<Y>);

/// Traversals but the default are for posed trees, and follow the other questions.
template <class Policy, class X>
inline constexpr bool may_choose = has_all_forms<Policy> && is_posed<X>;

template <traversal Traversal, class Policy, class X, class Y>
bool is_walked_right(const Policy& on, const X& x, const Y& y, const pair_list& expected) {
    const int depth = static_cast<int>(expected.size() % (most_start_depth + 1));
    return to_host(pairs(on, x, y, query_options<keep_all, Traversal>{.start_depth = depth})) == expected;
}

/// Whether a query of two trees is right. Questions other than for pairs are for the standard layout: each is a query to
/// compile anew.
template <class Policy, class X, class Y>
bool is_right(const Policy& on, const X& x, const Y& y, int question, const pair_list& expected) {
    if constexpr (has_layout<X, standard_layout> && has_layout<Y, standard_layout>) {
        if (question == 2) return to_host(pairs<exact>(on, x, y)) == expected;
        if (question == 3) return count(on, x, y) == expected.size();
        if (question == 4) return any(on, x, y) == !expected.empty();
        if constexpr (may_choose<Policy, X>) {
            if (question == one_tree + 1) return is_walked_right<traversal::one_first>(on, x, y, expected);
            if (question == one_tree + 2) return is_walked_right<traversal::larger_first>(on, x, y, expected);
            if (question == one_tree + 3) return is_walked_right<traversal::alternate>(on, x, y, expected);
            if (question == one_tree + 4) return is_walked_right<traversal::breadth_first>(on, x, y, expected);
        }
    }
    if constexpr (may_meet<X, Y>) {
        pair_list found = to_host(pairs(on, x, y, {.sorted = question != 1}));
        if (question == 1) std::sort(found.begin(), found.end());
        return found == expected;
    } else {
        return false;
    }
}

template <class Policy, scalar T>
bool run(const Policy& on, draws& d, const random_scene<T>& s, const pair_list& expected, std::string& told) {
    constexpr int builders_there = host_policy<Policy> ? static_cast<int>(std::size(builders)) : device_builders;
    tree_kind of_a(d, builders_there), of_b(d, builders_there);
    if (!has_all_forms<Policy>) of_a.layout = of_b.layout = 0;
    if (of_a.layout >= first_for_both || of_b.layout >= first_for_both) {
        of_a.layout = of_b.layout = std::max(of_a.layout, of_b.layout);
    }
    int question = draw_one_of<questions>(d);
    const bool in_one_frame = s.a.pose == rigid<T>{} && s.b.pose == rigid<T>{} && d.below(2) == 0;
    if (question > one_tree && (!has_all_forms<Policy> || in_one_frame)) question = 0;
    if (question > one_tree) of_a.layout = of_b.layout = 0;
    if (question > 1 && question < one_tree && (of_a.layout != 0 || of_b.layout != 0)) question = 0;
    told += std::string(questions[question]) + "; a: " + kind_names[static_cast<int>(s.kind_a)] + ", " + of_a.text() +
            "; b: " + kind_names[static_cast<int>(s.kind_b)] + ", " + of_b.text() + (in_one_frame ? "; not posed" : "");
    bool right = false;
    with_tree(on, s.a.shape, of_a, [&](const auto& a) {
        if (question == one_tree) {
            right = to_host(pairs(on, posed(a, s.a.pose), posed(s.b.shape, s.b.pose))) == expected;
            return;
        }
        with_tree(on, s.b.shape, of_b, [&](const auto& b) {
            right = in_one_frame ? is_right(on, a, b, question, expected)
                                 : is_right(on, posed(a, s.a.pose), posed(b, s.b.pose), question, expected);
        });
    });
    return right;
}

}  // namespace random_runs

/// ask(d, s, expected, told) has a scene asked on a policy, says how in `told`, and returns whether the answer is right.
template <scalar T, class Ask>
void check_random_runs(const Ask& ask) {
    using namespace random_runs;
    constexpr std::uint64_t stream = sizeof(T) == 4 ? 87 : 88;
    const std::uint64_t runs = sample_count() / 10;  // 500, or what ABUT_SAMPLES says
    std::uint64_t meet = 0, hits = 0;
    for (std::uint64_t k = 0; k < runs; ++k) {
        draws d(sample_seed, stream, k);
        const random_scene<T> s = make_scene<T>(d);
        const pair_list expected = exact_pairs(s.a, s.b);
        std::string told;
        const bool right = ask(d, s, expected, told);
        meet += expected.empty() ? 0 : 1;
        hits += expected.size();
        CAPTURE(sample_seed, stream, k, told, s.a.shape.size(), s.b.shape.size(), expected.size());
        CHECK(right);
    }
    std::printf("random runs: seed %llu, stream %llu, %llu of %llu pairs of meshes meet, %llu hits\n",
                static_cast<unsigned long long>(sample_seed), static_cast<unsigned long long>(stream),
                static_cast<unsigned long long>(meet), static_cast<unsigned long long>(runs),
                static_cast<unsigned long long>(hits));
    CHECK(meet * 3 > runs);
    CHECK(meet * 20 < runs * 19);
    CHECK(hits > 50 * runs);
}

}  // namespace abut::test
