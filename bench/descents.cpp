// SPDX-License-Identifier: MIT
//
// usage: bench_descents [--json=OUT.json] [--mesh=FILE]
//
// Which of two trees to descend first: over the pair of bench/meshes_scene.hpp made of FILE (PLY or OBJ; without it a
// torus), on one core. Names:
//
//   walk/BUILDER/TRAVERSAL     the library's walk with a filter that refuses every pair, so that nothing is decided;
//   counters
//                              boxes and leaves: pairs that are compared and met, which a plain recursion counts
//   depth/BUILDER/N            boxes that both_at_once compares at depth N
//   patch/N/TRAVERSAL          a patch of N triangles of the second mesh, first argument, against the first mesh, `sah`

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

#include "meshes_scene.hpp"
#include "results.hpp"

namespace {

using tree = abut::bvh<abut::mesh<float>, abut::host_space>;
using abut::traversal;

constexpr const char* names[] = {"both_at_once", "one_first", "larger_first", "alternate", "breadth_first"};

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
void add_walk(bench::results& out, const std::string& builder, const tree& a, const tree& b, const tally& seen) {
    out.add(bench::joined({"walk", builder, names[static_cast<int>(Traversal)]}),
            {{"ms", ms_of<Traversal>(a, b)},
             {"boxes", static_cast<double>(seen.tests)},
             {"leaves", static_cast<double>(seen.leaves)}});
}

template <traversal Traversal>
tally add_walk(bench::results& out, const std::string& builder, const tree& a, const tree& b) {
    tally seen;
    const auto x = a.view(), y = b.view();
    descent<Traversal>{x, y, seen}.meet(x.root(), x.root_bounds(), y.root(), y.root_bounds(), 0,
                                        true);  // alternate: b first
    add_walk<Traversal>(out, builder, a, b, seen);
    return seen;
}

void add_walks(bench::results& out, const meshes_scene::mesh_pair& pair) {
    const abut::serial on;
    for (const auto& [name, builder] :
         {std::pair("linear", abut::bvh_builder::linear), std::pair("mean_split", abut::bvh_builder::mean_split),
          std::pair("sah", abut::bvh_builder::sah)}) {
        const auto a = make_bvh(on, abut::mesh<float>(pair.a.vertices, pair.a.faces), {.builder = builder});
        const auto b = make_bvh(on, abut::mesh<float>(pair.b.vertices, pair.b.faces), {.builder = builder});
        add_walk<traversal::one_first>(out, name, a, b);
        add_walk<traversal::larger_first>(out, name, a, b);
        add_walk<traversal::alternate>(out, name, a, b);
        const tally seen = add_walk<traversal::both_at_once>(out, name, a, b);
        add_walk<traversal::breadth_first>(out, name, a, b, seen);  // from the roots, it compares the same boxes
        for (std::size_t depth = 0; depth < seen.by_depth.size() && seen.by_depth[depth] > 0; ++depth) {
            out.add(bench::joined({"depth", name, std::to_string(depth)}),
                    {{"boxes", static_cast<double>(seen.by_depth[depth])}});
        }
    }
}

/// The `n` faces of `from` that are nearest to the place where it first touches `other`.
abut::mesh<float> patch(const meshes_scene::surface& from, const tree& whole, const tree& other, std::size_t n) {
    const auto hits = pairs(abut::serial{}, whole, other);
    const abut::vec3<float> center = from.vertices[from.faces[hits.size() > 0 ? hits[0].a : 0][0]];
    const auto away = [&](const auto& face) {
        const auto d = from.vertices[face[0]] - center;
        return dot(d, d);
    };
    auto faces = from.faces;
    n = std::min(n, faces.size());
    std::nth_element(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(n - 1), faces.end(),
                     [&](const auto& x, const auto& y) { return away(x) < away(y); });
    faces.resize(n);
    return abut::mesh<float>(from.vertices, faces);
}

/// A small set beside a large one.
void add_patches(bench::results& out, const meshes_scene::mesh_pair& pair) {
    const abut::serial on;
    const abut::bvh_options by_sah{.builder = abut::bvh_builder::sah};
    const auto a = make_bvh(on, abut::mesh<float>(pair.a.vertices, pair.a.faces), by_sah);
    const auto b = make_bvh(on, abut::mesh<float>(pair.b.vertices, pair.b.faces), by_sah);
    for (const std::size_t n : {70u, 700u, 7000u, 70000u}) {
        const auto small = make_bvh(on, patch(pair.b, b, a, n), by_sah);
        const auto add = [&]<traversal T>() {
            out.add(bench::joined({"patch", std::to_string(n), names[static_cast<int>(T)]}), {{"ms", ms_of<T>(small, a)}});
        };
        add.template operator()<traversal::both_at_once>();
        add.template operator()<traversal::larger_first>();
        add.template operator()<traversal::alternate>();
        add.template operator()<traversal::one_first>();
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const std::string mesh = bench::take_argument(argc, argv, "--mesh");
        const auto pair =
            meshes_scene::make_pair(mesh.empty() ? meshes_scene::unit_torus() : meshes_scene::read_surface(mesh));
        bench::results out("bench_descents");
        out.describe("mesh", mesh.empty() ? "torus" : mesh.substr(mesh.find_last_of('/') + 1));
        add_walks(out, pair);
        add_patches(out, pair);
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_descents: %s\n", problem.what());
        return 1;
    }
}
