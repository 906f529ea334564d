// SPDX-License-Identifier: MIT
#pragma once

// The whole of the program spheres_vs_mesh but its policies: which spheres touch which triangles of a mesh. It is written
// once; spheres_vs_mesh.cpp and spheres_vs_mesh.cu say what runs it. The calls that matter are in `solve`.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>
#include <abut/io/write.hpp>

#include "program.hpp"
#include "scene.hpp"
#include "view.hpp"

namespace spheres_vs_mesh {

/// `auto` takes brute force where there are fewer spheres or fewer triangles than this, and a BVH elsewhere: building the
/// tree costs about as much as testing each triangle against so many spheres (measured: docs/results/spheres.md).
inline constexpr std::size_t brute_force_below = 50;

struct settings : example::common_settings {
    std::string index = "auto";
    std::string mesh_file, spheres_file;
    std::optional<double> radius;
    std::optional<std::size_t> generate;
    std::uint64_t seed = scene::seed;
    std::string out_pairs = "spheres_vs_mesh_pairs.csv", out_mesh = "spheres_vs_mesh_hits.ply";
};

// --- the scene ---------------------------------------------------------------------------------------------------------

/// Everything that a run needs, in host memory: a mesh, and spheres of one radius or of many.
template <abut::scalar T>
struct input {
    abut::mesh<T> mesh;
    std::variant<abut::equal_spheres<T>, abut::spheres<T>> spheres;
};

/// The box of all vertices, in double.
template <abut::scalar T>
abut::aabb<double> box_of(const std::vector<abut::vec3<T>>& points) {
    abut::aabb<double> box{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& p = points[i];
        const abut::vec3<double> at{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
        if (i == 0) box = {at, at};
        box.lower = {std::min(box.lower.x, at.x), std::min(box.lower.y, at.y), std::min(box.lower.z, at.z)};
        box.upper = {std::max(box.upper.x, at.x), std::max(box.upper.y, at.y), std::max(box.upper.z, at.z)};
    }
    return box;
}

/// The mean length of the triangles' sides: spheres of that radius meet a handful of triangles, or none.
template <abut::scalar T>
double mean_side(const scene::surface<T>& mesh) {
    double sum = 0;
    for (const auto& f : mesh.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& p = mesh.vertices[f[i]];
            const auto& q = mesh.vertices[f[(i + 1) % 3]];
            sum += std::hypot(static_cast<double>(p.x) - static_cast<double>(q.x),
                              static_cast<double>(p.y) - static_cast<double>(q.y),
                              static_cast<double>(p.z) - static_cast<double>(q.z));
        }
    }
    return mesh.faces.empty() ? 1 : sum / (3 * static_cast<double>(mesh.faces.size()));
}

/// Spheres from a file. Which of the two forms it has is the user's to say, by giving a radius or not; a message that names
/// the function for the other form is made to name the option.
template <abut::scalar T>
std::variant<abut::equal_spheres<T>, abut::spheres<T>> read_spheres(const settings& s) {
    try {
        if (s.radius) return abut::io::read_equal_spheres<T>(s.spheres_file, static_cast<T>(*s.radius));
        return abut::io::read_spheres<T>(s.spheres_file);
    } catch (const abut::io_error& e) {
        const std::string what = e.what();
        const std::size_t advice = what.find(" (spheres ");
        if (advice == std::string::npos) throw;
        throw abut::error(what.substr(0, advice) +
                          (s.radius ? " (such a file is read without --radius)" : " (with --radius R, x,y,z will do)"));
    }
}

/// Reads or makes the scene, and makes checked sets of it.
template <abut::scalar T>
input<T> make_input(const settings& s, example::stopwatch& watch) {
    const bool embedded = s.mesh_file.empty();
    scene::surface<T> surface;
    std::vector<abut::vec3<T>> centers;
    double radius = 0;
    input<T> in;
    watch.time("read", [&] {
        if (embedded) {
            surface = scene::torus<T>();
        } else {
            auto data = abut::io::read_mesh_data<T>(s.mesh_file);
            surface = {std::move(data.vertices), std::move(data.faces)};
        }
        if (!s.spheres_file.empty()) {
            in.spheres = read_spheres<T>(s);
        } else if (embedded) {
            radius = s.radius.value_or(scene::radius);
            const double at = scene::cube_side / 2;
            centers = scene::points_in<T>({{-at, -at, -at}, {at, at, at}}, s.generate.value_or(scene::sphere_count), s.seed);
        } else {
            radius = s.radius.value_or(mean_side(surface));
            auto box = box_of(surface.vertices);
            box.lower = {box.lower.x - radius, box.lower.y - radius, box.lower.z - radius};
            box.upper = {box.upper.x + radius, box.upper.y + radius, box.upper.z + radius};
            centers = scene::points_in<T>(box, s.generate.value_or(1'000'000), s.seed);
        }
    });
    watch.time("check", [&] {
        in.mesh = {surface.vertices, surface.faces};
        if (s.spheres_file.empty()) in.spheres = abut::equal_spheres<T>(centers, static_cast<T>(radius));
    });
    return in;
}

// --- the query ---------------------------------------------------------------------------------------------------------

struct outcome {
    std::vector<abut::index_pair> pairs;  // (triangle, sphere)
    std::size_t index_bytes = 0;
};

/// The heart of it: sets into the policy's memory, an index over the triangles, the query, and the pairs back. `make_index`
/// is make_bvh, make_grid or nothing.
template <abut::arithmetic A, class Policy, class Mesh, class Spheres, class MakeIndex>
outcome solve(const Policy& on, const Mesh& host_mesh, const Spheres& host_spheres, const MakeIndex& make_index, int repeat,
              example::stopwatch& watch) {
    constexpr bool elsewhere = !abut::host_policy<Policy>;
    if (elsewhere) watch.time("start device", [&] { synchronize(on); });
    const auto bring = [&] { return std::pair(abut::copy_to(on, host_mesh), abut::copy_to(on, host_spheres)); };
    const auto [mesh, spheres] = elsewhere ? watch.time("upload", bring) : bring();

    outcome found;
    for (example::series runs(repeat); runs.more();) {
        const auto index = watch.time("build", [&, &mesh = mesh] {
            auto made = make_index(on, mesh);
            synchronize(on);
            return made;
        });
        const auto hits = watch.time("query", [&, &spheres = spheres] { return abut::pairs<A>(on, index, spheres); });
        if (!runs.is_last()) continue;
        if constexpr (requires { index.bytes(); }) found.index_bytes = index.bytes();
        const auto fetch = [&] { return abut::to_host(hits); };
        found.pairs = elsewhere ? watch.time("download", fetch) : fetch();
    }
    return found;
}

/// Which index `auto` means for this scene.
inline std::string chosen_index(const settings& s, std::size_t spheres, std::size_t triangles) {
    if (s.index != "auto") return s.index;
    return std::min(spheres, triangles) < brute_force_below ? "none" : "bvh";
}

// --- what comes out ----------------------------------------------------------------------------------------------------

/// Of spheres that touch nothing, so many are shown.
inline constexpr std::size_t most_others_shown = 2000;

/// The mesh, the spheres that touch it and some others, and the pairs.
template <abut::scalar T>
void write_view(const settings& s, const input<T>& in, const std::vector<abut::index_pair>& pairs,
                const std::vector<std::uint8_t>& triangle_hit, const std::vector<std::uint8_t>& sphere_hit) {
    const example::selection triangles(triangle_hit, example::most_faces_shown, example::most_faces_shown);
    const std::size_t most = std::min(example::most_spheres_shown, example::count_set(sphere_hit) + most_others_shown);
    const example::selection spheres(sphere_hit, most, most_others_shown);
    abut::io::gltf_scene scene;
    const auto a = example::add_selected(scene, "mesh", in.mesh, triangles);
    const auto b =
        std::visit([&](const auto& set) { return example::add_selected(scene, "spheres", set, spheres); }, in.spheres);
    const auto shows = [&](const auto& pair) { return triangles.shows(pair.a) && spheres.shows(pair.b); };
    scene.add_pairs(a, b, example::shown_results(scene, "pairs", pairs, shows), {.of = pairs.size()});
    example::write_view(s.view, scene);
}

template <class Program, abut::scalar T>
void run_as(const settings& s) {
    const auto begin = std::chrono::steady_clock::now();
    example::stopwatch watch;
    const auto in = make_input<T>(s, watch);
    const std::size_t triangles = in.mesh.size();
    const std::size_t spheres = std::visit([](const auto& set) { return set.size(); }, in.spheres);
    const std::string index = chosen_index(s, spheres, triangles);

    outcome found;
    const auto run = [&](const auto& on) {
        const auto with = [&]<class A>() {
            std::visit(
                [&](const auto& set) {
                    const auto bvh = [](const auto& policy, const auto& mesh) { return abut::make_bvh(policy, mesh); };
                    const auto grid = [](const auto& policy, const auto& mesh) { return abut::make_grid(policy, mesh); };
                    const auto none = [](const auto&, const auto& mesh) { return mesh; };
                    if (index == "bvh") found = solve<A>(on, in.mesh, set, bvh, s.repeat, watch);
                    if (index == "grid") found = solve<A>(on, in.mesh, set, grid, s.repeat, watch);
                    if (index == "none") found = solve<A>(on, in.mesh, set, none, s.repeat, watch);
                },
                in.spheres);
        };
        example::choose(typename Program::arithmetics{}, s.arithmetic, with);
    };
    Program::with_policy(s.policy(), s.threads, run);

    std::vector<std::uint8_t> triangle_hit(triangles, 0), sphere_hit(spheres, 0);
    for (const auto& pair : found.pairs) triangle_hit[pair.a] = sphere_hit[pair.b] = 1;
    const auto write = [&] {
        watch.time("write", [&] {
            abut::io::write_pairs(s.out_pairs, found.pairs, {"triangle", "sphere"});
            abut::io::write_mesh(s.out_mesh, in.mesh, {.hit = triangle_hit});
        });
    };
    example::write_and_print(!s.no_output, write, [&](bool written) {
        const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - begin;
        const auto line = [](const char* what, std::size_t n) { std::printf("%-18s %12zu\n", what, n); };
        std::printf("%s, %s, %s arithmetic on %s, index %s\n", s.mesh_file.empty() ? "embedded torus" : s.mesh_file.c_str(),
                    s.policy().c_str(), s.arithmetic.c_str(), s.scalar.c_str(), index.c_str());
        line("spheres", spheres);
        if (const auto* const equal = std::get_if<abut::equal_spheres<T>>(&in.spheres)) {
            std::printf("%-18s %12g\n", "radius", static_cast<double>(equal->view().radius));
        }
        line("triangles", triangles);
        line("pairs", found.pairs.size());
        line("triangles hit", example::count_set(triangle_hit));
        line("spheres hit", example::count_set(sphere_hit));
        line("bytes of the index", found.index_bytes);
        std::printf("time in ms%s\n", s.repeat > 1 ? " (build and query: median of the runs)" : "");
        watch.print();
        std::printf("  %-16s %12.3f\n", "all of it", whole.count());
        if (written) std::printf("written: %s, %s\n", s.out_pairs.c_str(), s.out_mesh.c_str());
        if (!s.view.empty()) write_view(s, in, found.pairs, triangle_hit, sphere_hit);
    });
}

// --- the command line --------------------------------------------------------------------------------------------------

template <class Program>
void describe(CLI::App& app, settings& s) {
    app.description(
        "Which spheres touch which triangles of a mesh? Decided exactly by default.\n\n"
        "Without --mesh: a closed torus of 62,976 triangles and 1,703,244 spheres of radius 3.\n"
        "With --mesh and without --spheres: spheres in the mesh's box, by default 1,000,000 with the mean\n"
        "length of the triangles' sides as radius.\n" +
        std::string(Program::note));
    app.add_option("--mesh", s.mesh_file, "Read the mesh from an .obj, .ply, .stl, .off, .glb or .gltf file")
        ->type_name("FILE");
    const auto file =
        app.add_option("--spheres", s.spheres_file, "Read the spheres from a .csv file: x,y,z,r; or x,y,z, with --radius")
            ->type_name("FILE");
    app.add_option("--radius", s.radius, "Radius of all spheres")->type_name("R");
    app.add_option("--generate", s.generate, "Make N spheres")
        ->type_name("N")
        ->check(CLI::Range(std::size_t{1}, std::size_t{2'147'483'647}))
        ->excludes(file);
    app.add_option("--seed", s.seed, "Seed of the spheres that are made")->excludes(file)->capture_default_str();
    example::add_policy<Program>(app, s);
    app.add_option("--index", s.index, "How pairs are found; auto: none for fewer than 50 spheres or triangles, else bvh")
        ->check(CLI::IsMember({"auto", "bvh", "grid", "none"}))
        ->capture_default_str();
    example::add_types<Program>(app, s, "pairs");
    example::add_repeat(app, s, "Build and query");
    app.add_option("--out-pairs", s.out_pairs, "Write the pairs (triangle,sphere; both count from 0) here")
        ->type_name("FILE.csv")
        ->capture_default_str();
    app.add_option("--out-mesh", s.out_mesh, "Write the mesh here, as .ply or .vtp, its triangles marked where hit")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_flag("--no-output", s.no_output, "Write no files");
    example::add_view(app, s);
}

/// What CLI11 does not check.
inline void check(const settings& s) {
    if (s.radius && !(std::isfinite(*s.radius) && *s.radius >= 0))
        throw example::usage_error("--radius: expected 0 or more");
    example::check_threads(s);
    // Now, not after minutes of work.
    for (const auto& file : {s.mesh_file, s.spheres_file}) {
        if (!file.empty() && !std::filesystem::exists(file)) throw example::usage_error(file + ": no such file");
    }
    example::check_view(s);
    if (s.no_output) return;
    example::require_mesh_format("--out-mesh", s.out_mesh);
    for (const auto& file : {s.out_pairs, s.out_mesh}) example::require_writable(file);
}

/// `Program` names itself, its policies, and the types that it is compiled for. Returns the exit status.
template <class Program>
int main(int argc, char** argv) {
    settings s;
    s.policies = {Program::policies().front()};
    const auto work = [&]<class T>() {
        run_as<Program, T>(s);
        return 0;
    };
    return example::run<Program>(
        argc, argv, s, [&](CLI::App& app) { describe<Program>(app, s); }, [&] { check(s); }, work);
}

}  // namespace spheres_vs_mesh
