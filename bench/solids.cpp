// SPDX-License-Identifier: MIT
//
// usage: bench_solids MESH... [--json=OUT.json] [--runs=N]
//
// How two solids lie to each other, on one core in float. A row of two meshes, pair/MESH/CASE, in ms, medians of N runs (9):
//
//   any       whether any faces touch
//   overlaps  whether interiors meet, of meshes that are known to be solids; `over` is that over any
//   relation  which of the eight relations it is, of such meshes
//   checked   and of meshes that are not known to be, which are looked at first
//
// Of meshes of more than 100,000 faces there is no such row, since `checked` takes seconds. A row crossings/MESH has the times of
// `pairs`, `crossings` and `curves` of a mesh and its copy, `over` of crossings over pairs, how many crossings and lines there are,
// and how many of these are open.
//
// Of many bodies, scene/NAME: `bodies` of `faces` each, `touching_bodies` and `relation` in ms, `related` pairs that are not
// disconnected, and how many of the answers are wrong: of bricks that fill a block all is known, and balls have their centres.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "ball.hpp"
#include "results.hpp"

namespace {

using abut::solid_relation;
using faces = std::vector<std::array<std::uint32_t, 3>>;
using vertices = std::vector<abut::vec3<float>>;

template <class F>
double median_ms(int runs, const F& f) {
    std::vector<double> all;
    for (int run = 0; run < runs; ++run) {
        const double start = bench::processor_time();
        f();
        all.push_back((bench::processor_time() - start) / 1e6);
    }
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

abut::mesh<float> brick(float x, float y, float z) {
    vertices v;
    for (int i = 0; i < 8; ++i) v.push_back({(i & 1) != 0 ? x : 0, (i & 2) != 0 ? y : 0, (i & 4) != 0 ? z : 0});
    return {std::move(v), {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}}};
}

abut::rigid<float> moved(float x, float y, float z) { return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, y, z}}; }

void two_meshes(const std::string& path, int runs, bench::results& out) {
    const abut::serial on;
    const auto mesh = abut::io::read_mesh<float>(path);
    const auto tree = abut::make_bvh(on, mesh);
    float reach = 0;
    for (std::size_t i = 0; i < mesh.view().vertices.count; ++i) {
        const auto p = mesh.view().vertices[i];
        reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const std::pair<const char*, abut::rigid<float>> cases[] = {
        {"turned", {{1, 0, 0, 0, 0.8F, -0.6F, 0, 0.6F, 0.8F}, {reach / 100, 0, 0}}},
        {"moved_by_a_little", moved(reach * 0x1p-22F, 0, 0)},
        {"the_same", moved(0, 0, 0)},
        {"apart", moved(9 * reach, 0, 0)}};
    for (const auto& [name, pose] : cases) {
        const auto other = abut::posed(tree, pose);
        const int few = std::max(1, runs / 3);
        const double any = median_ms(25 * runs, [&, other = other] { (void)abut::any(on, tree, other); });
        const double overlaps = median_ms(runs, [&, other = other] { (void)abut::overlaps(on, tree, other, {.known_solid = true}); });
        solid_relation found{};
        const double relation = median_ms(few, [&, other = other] { found = abut::relation(on, tree, other, {.known_solid = true}); });
        const double checked = median_ms(few, [&, other = other] { (void)abut::relation(on, tree, other); });
        out.add(bench::joined({"pair", std::filesystem::path(path).stem().string(), name}),
                {{"any", any}, {"overlaps", overlaps}, {"over", overlaps / any}, {"relation", relation}, {"checked", checked},
                 {"found", static_cast<double>(found)}});
    }
}

/// What faces that meet have in common, of a mesh and its copy, turned by 0.4 and moved by a tenth of its width.
void crossings_of(const std::string& path, int runs, bench::results& out) {
    const abut::serial on;
    const auto mesh = abut::io::read_mesh<float>(path);
    const auto view = mesh.view();
    float low = view.vertices[0].x, high = low;
    for (std::size_t i = 0; i < view.vertices.count; ++i) {
        low = std::min(low, view.vertices[i].x);
        high = std::max(high, view.vertices[i].x);
    }
    const float d = (high - low) / 10, c = std::cos(0.4F), s = std::sin(0.4F);
    vertices moved;
    faces same;
    for (std::size_t i = 0; i < view.vertices.count; ++i) {
        const auto p = view.vertices[i];
        moved.push_back({c * p.x - s * p.y + d, s * p.x + c * p.y + d / 2, p.z + d / 3});
    }
    for (std::size_t f = 0; f < view.size(); ++f) same.push_back(view.faces[f]);
    const auto a = abut::make_bvh(on, mesh), b = abut::make_bvh(on, abut::mesh<float>(moved, same));
    const auto found = abut::crossings(on, a, b);
    // In turn, so that both see the same machine.
    std::vector<double> pairs, crossings, curves;
    std::size_t lines = 0, open = 0;
    for (int run = 0; run < 2 * runs; ++run) {
        pairs.push_back(median_ms(1, [&] { (void)abut::pairs(on, a, b); }));
        crossings.push_back(median_ms(1, [&] { (void)abut::crossings(on, a, b); }));
        std::vector<abut::curve<float>> all;
        curves.push_back(median_ms(1, [&] { all = abut::curves(on, found); }));
        lines = all.size();
        open = 0;
        for (const auto& line : all) open += line.closed ? 0 : 1;
    }
    const auto middle = [](std::vector<double>& all) {
        std::sort(all.begin(), all.end());
        return all[all.size() / 2];
    };
    const double of_pairs = middle(pairs), of_crossings = middle(crossings);
    out.add(bench::joined({"crossings", std::filesystem::path(path).stem().string()}),
            {{"faces", static_cast<double>(view.size())}, {"pairs", of_pairs}, {"crossings", of_crossings}, {"over", of_crossings / of_pairs},
             {"curves", middle(curves)}, {"found", static_cast<double>(found.size())}, {"lines", static_cast<double>(lines)},
             {"open", static_cast<double>(open)}});
}

/// `truth(i, j)` says what two bodies are, i < j.
template <class Scene, class Truth>
void scene_of(const std::string& name, const Scene& scene, std::size_t faces_each, const Truth& truth,
              std::uint64_t related, int runs, bench::results& out) {
    const abut::serial on;
    const auto all = abut::make_bodies(on, scene);
    const double touching = median_ms(runs, [&] { (void)abut::touching_bodies(on, all); });
    std::vector<abut::body_relation> found;
    const double relation = median_ms(runs, [&] { found = abut::relation(on, all, {.known_solid = true}); });
    std::uint64_t wrong = found.size() == related ? 0 : 1;
    for (const auto& r : found) wrong += truth(r.body_a, r.body_b) != r.relation;
    out.add(bench::joined({"scene", name}), {{"bodies", static_cast<double>(scene.size())},
                                             {"faces", static_cast<double>(faces_each)},
                                             {"touching", touching},
                                             {"relation", relation},
                                             {"related", static_cast<double>(found.size())},
                                             {"wrong", static_cast<double>(wrong)}});
}

void bricks(int runs, bench::results& out) {
    const abut::serial on;
    const std::array<int, 3> n{20, 25, 20};
    const auto tree = abut::make_bvh(on, brick(2, 1, 0.5F));
    std::vector<abut::posed_object<decltype(abut::make_bvh(on, brick(1, 1, 1)))>> scene;
    std::vector<std::array<int, 3>> at;
    std::uint64_t related = 0;
    for (int x = 0; x < n[0]; ++x) {
        for (int y = 0; y < n[1]; ++y) {
            for (int z = 0; z < n[2]; ++z) {
                at.push_back({x, y, z});
                scene.push_back(abut::posed(tree, moved(2 * static_cast<float>(x), static_cast<float>(y), 0.5F * static_cast<float>(z))));
                for (int k = 0; k < 27; ++k) {
                    const int i = x + k % 3 - 1, j = y + k / 3 % 3 - 1, l = z + k / 9 - 1;
                    related += k > 13 && i >= 0 && j >= 0 && l >= 0 && i < n[0] && j < n[1] && l < n[2];
                }
            }
        }
    }
    scene_of("bricks", scene, 12, [](std::uint32_t, std::uint32_t) { return solid_relation::externally_connected; }, related, runs, out);
}

void balls(int runs, bench::results& out) {
    const abut::serial on;
    const auto large = abut::make_bvh(on, bench::ball(17, 32)), small = abut::make_bvh(on, bench::ball(17, 32));
    std::vector<abut::posed_object<decltype(abut::make_bvh(on, bench::ball(3, 3)))>> scene;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> draw(0, 1);
    std::vector<abut::vec3<double>> at;
    for (int i = 0; i < 10000; ++i) {
        const abut::vec3<float> p{60 * draw(random), 60 * draw(random), 60 * draw(random)};
        at.push_back({p.x, p.y, p.z});
        scene.push_back(abut::posed(i % 2 == 0 ? large : small, moved(p.x, p.y, p.z)));
    }
    // Equal balls overlap if their centres are nearer than this; of the few between that and 2 nothing is said.
    const double surely = 2 * std::cos(3.14159265358979323846 / 17) * std::cos(3.14159265358979323846 / 32);
    const auto truth = [&](std::uint32_t i, std::uint32_t j) {
        const double x = at[i].x - at[j].x, y = at[i].y - at[j].y, z = at[i].z - at[j].z;
        const double apart = std::sqrt(x * x + y * y + z * z);
        return apart < 2 ? solid_relation::partially_overlapping : solid_relation::disconnected;
    };
    std::uint64_t related = 0;
    for (const auto& r : abut::touching_bodies(on, scene)) {
        (void)r;
        ++related;
    }
    std::uint64_t missed = 0;
    std::map<std::uint64_t, bool> seen;
    for (const auto& [a, b] : abut::touching_bodies(on, scene)) seen[std::uint64_t{a} << 32 | b] = true;
    for (std::uint32_t i = 0; i < at.size(); ++i) {
        for (std::uint32_t j = i + 1; j < at.size(); ++j) {
            const double x = at[i].x - at[j].x;
            if (std::abs(x) > 2) continue;
            const double y = at[i].y - at[j].y, z = at[i].z - at[j].z;
            missed += std::sqrt(x * x + y * y + z * z) < surely && !seen.contains(std::uint64_t{i} << 32 | j);
        }
    }
    scene_of("balls", scene, 1024, truth, related + missed, runs, out);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const int runs = std::stoi(bench::take_argument(argc, argv, "--runs", "9"));
        if (argc < 2) throw std::runtime_error("usage: bench_solids MESH... [--json=OUT.json] [--runs=N]");
        bench::results out("bench_solids");
        for (int i = 1; i < argc; ++i) {
            crossings_of(argv[i], runs, out);
            if (abut::io::read_mesh<float>(argv[i]).size() <= 100'000) two_meshes(argv[i], runs, out);
        }
        bricks(std::max(1, runs / 3), out);
        balls(std::max(1, runs / 3), out);
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_solids: %s\n", e.what());
        return 1;
    }
}
