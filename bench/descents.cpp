// SPDX-License-Identifier: MIT
//
// usage: bench_descents [MESH...]
//
// Which of two trees to descend first: boxes compared, and the time that comparing takes on one core, for four rules, over
// the pair of bench/meshes_scene.hpp made of each mesh (PLY or OBJ; without one a torus). A plain recursion that decides
// nothing: the library descends both at once (traverse/pair_walk.hpp), and this says why. Then the tests of that rule by
// depth, as tables of Markdown.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "meshes_scene.hpp"

namespace {

using tree_view = abut::bvh_view<float, abut::host_space>;

enum class rule { one_first, larger_first, alternate, both_at_once };
constexpr const char* rule_names[] = {"one first", "larger first", "alternate", "both at once"};

struct tally {
    std::uint64_t tests = 0, leaves = 0;
    std::vector<std::uint64_t> by_depth = std::vector<std::uint64_t>(2 * abut::bvh_max_depth + 1, 0);
};

float surface(const abut::aabb<float>& box) {
    const auto d = box.upper - box.lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

template <rule Rule>
struct descent {
    tree_view a, b;
    tally& seen;

    /// Two subtrees whose boxes meet.
    void meet(abut::bvh_child x, const abut::aabb<float>& box_x, abut::bvh_child y, const abut::aabb<float>& box_y,
              int depth, bool last_was_x) {
        if (x.is_leaf() && y.is_leaf()) {
            ++seen.leaves;
            return;
        }
        bool open_x = !x.is_leaf(), open_y = !y.is_leaf();
        if (open_x && open_y) {
            if (Rule == rule::one_first) open_y = false;
            if (Rule == rule::larger_first) (surface(box_x) >= surface(box_y) ? open_y : open_x) = false;
            if (Rule == rule::alternate) (last_was_x ? open_x : open_y) = false;
        }
        const int sides_x = open_x ? 2 : 1, sides_y = open_y ? 2 : 1;
        for (int i = 0; i < sides_x; ++i) {
            const auto& next_box_x = open_x ? a.bounds(a.fetch(x.index()), i) : box_x;
            for (int j = 0; j < sides_y; ++j) {
                const auto& next_box_y = open_y ? b.bounds(b.fetch(y.index()), j) : box_y;
                ++seen.tests;
                ++seen.by_depth[static_cast<std::size_t>(depth)];
                if (!overlaps(next_box_x, next_box_y)) continue;
                meet(open_x ? a.child(a.fetch(x.index()), i) : x, next_box_x, open_y ? b.child(b.fetch(y.index()), j) : y,
                     next_box_y, depth + 1, open_x);
            }
        }
    }
};

template <rule Rule>
tally measure(const tree_view& a, const tree_view& b, double& ms) {
    std::vector<double> times;
    tally seen;
    for (int run = 0; run < 11; ++run) {
        seen = {};
        const auto start = std::chrono::steady_clock::now();
        descent<Rule>{a, b, seen}.meet(a.root(), a.root_bounds(), b.root(), b.root_bounds(), 0, false);
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(times.begin(), times.end());
    ms = times[times.size() / 2];
    return seen;
}

template <rule Rule>
tally print_row(const tree_view& a, const tree_view& b) {
    double ms = 0;
    tally seen = measure<Rule>(a, b, ms);
    std::printf("| %s | %llu | %.2f | %llu |\n", rule_names[static_cast<int>(Rule)],
                static_cast<unsigned long long>(seen.tests), ms, static_cast<unsigned long long>(seen.leaves));
    return seen;
}

void print_tables(const std::string& path) {
    const auto pair = meshes_scene::make_pair(path.empty() ? meshes_scene::unit_torus() : meshes_scene::read_surface(path));
    const abut::serial on;
    for (const auto& [name, builder] :
         {std::pair("linear", abut::bvh_builder::linear), std::pair("mean_split", abut::bvh_builder::mean_split),
          std::pair("sah", abut::bvh_builder::sah)}) {
        const auto a = make_bvh(on, abut::mesh<float>(pair.a.vertices, pair.a.faces), {.builder = builder});
        const auto b = make_bvh(on, abut::mesh<float>(pair.b.vertices, pair.b.faces), {.builder = builder});
        std::printf(
            "%s, %zu triangles, `%s`\n\n| descend | boxes compared | ms | pairs of leaves |\n| --- | ---: | ---: | ---: |\n",
            path.empty() ? "torus" : path.c_str(), a.size(), name);
        print_row<rule::one_first>(a.view(), b.view());
        print_row<rule::larger_first>(a.view(), b.view());
        print_row<rule::alternate>(a.view(), b.view());
        const tally seen = print_row<rule::both_at_once>(a.view(), b.view());
        std::printf("\nBoth at once, boxes compared by depth:");
        for (std::size_t depth = 0; depth < seen.by_depth.size() && seen.by_depth[depth] > 0; ++depth) {
            std::printf(" %llu", static_cast<unsigned long long>(seen.by_depth[depth]));
        }
        std::printf("\n\n");
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 2) print_tables({});
        for (int i = 1; i < argc; ++i) print_tables(argv[i]);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_descents: %s\n", problem.what());
        return 1;
    }
}
