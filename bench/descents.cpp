// SPDX-License-Identifier: MIT
//
// usage: bench_descents [MESH...]
//
// Which of two trees to descend first: boxes compared, and the time that the walk takes on one core, for each traversal,
// over the pair of bench/meshes_scene.hpp made of each mesh (PLY or OBJ; without one a torus). A plain recursion counts, the
// library walks, with a filter that refuses every pair, so that nothing is decided. Then the boxes that both at once
// compares by depth, as tables of Markdown.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "meshes_scene.hpp"

namespace {

using tree = abut::bvh<abut::mesh<float>, abut::host_space>;
using abut::traversal;

constexpr const char* names[] = {"both at once", "one first", "larger first", "alternate", "breadth first"};

/// Refuses every pair, but no compiler knows.
struct refuse_all {
    std::uint32_t wanted;
    bool operator()(std::uint32_t a, std::uint32_t) const { return a == wanted; }
};

struct tally {
    std::uint64_t tests = 0, leaves = 0;
    std::vector<std::uint64_t> by_depth = std::vector<std::uint64_t>(2 * abut::bvh_max_depth + 1, 0);
};

float surface(const abut::aabb<float>& box) {
    const auto d = box.upper - box.lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

template <traversal Rule>
struct descent {
    tree::view_type a, b;
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
            if (Rule == traversal::one_first) open_y = false;
            if (Rule == traversal::larger_first) (surface(box_x) >= surface(box_y) ? open_y : open_x) = false;
            if (Rule == traversal::alternate) (last_was_x ? open_x : open_y) = false;
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

/// Median of 11 runs.
template <traversal Traversal>
double ms_of(const tree& a, const tree& b) {
    const abut::query_options<refuse_all, Traversal> options{.filter = {0xffffffff}, .start_depth = 0};
    std::array<double, 11> times;
    for (double& t : times) {
        const auto start = std::chrono::steady_clock::now();
        const std::uint64_t none = count(abut::serial{}, a, b, options);
        t = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        if (none != 0) throw abut::error("bench_descents: a pair that was refused");
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

template <traversal Traversal>
void print_row(const tree& a, const tree& b, const tally& seen) {
    std::printf("| %s | %llu | %.2f | %llu |\n", names[static_cast<int>(Traversal)],
                static_cast<unsigned long long>(seen.tests), ms_of<Traversal>(a, b),
                static_cast<unsigned long long>(seen.leaves));
}

template <traversal Traversal>
tally print_row(const tree& a, const tree& b) {
    tally seen;
    const auto x = a.view(), y = b.view();
    descent<Traversal>{x, y, seen}.meet(x.root(), x.root_bounds(), y.root(), y.root_bounds(), 0, false);
    print_row<Traversal>(a, b, seen);
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
        print_row<traversal::one_first>(a, b);
        print_row<traversal::larger_first>(a, b);
        print_row<traversal::alternate>(a, b);
        const tally seen = print_row<traversal::both_at_once>(a, b);
        print_row<traversal::breadth_first>(a, b, seen);  // from the roots, it compares the same boxes
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
