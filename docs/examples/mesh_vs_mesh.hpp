// SPDX-License-Identifier: MIT
#pragma once

// The whole of the program mesh_vs_mesh but its policies: two meshes, the second where a pose puts it; are they sound, which
// of their triangles touch, and where. It is written once; mesh_vs_mesh.cpp and mesh_vs_mesh.cu say what runs it. The calls
// that matter are in `solve`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/collide/contacts.hpp>
#include <abut/collide/reduce_contacts.hpp>
#include <abut/io/read.hpp>
#include <abut/io/write.hpp>

#include "program.hpp"
#include "scene.hpp"
#include "view.hpp"

namespace mesh_vs_mesh {

struct settings : example::common_settings {
    std::string file_a, file_b;
    std::vector<double> pose;
    int bins = 8;
    bool progress = false;
    std::string out = "mesh_vs_mesh";
};

// --- the scene ---------------------------------------------------------------------------------------------------------

/// Two tori of this many quads around and across, the second tilted and shifted so that it leans through the first.
inline constexpr std::uint32_t around = 96, across = 48;
inline const std::vector<double> embedded_pose{1, 0, 0, 75, 60, 10, 5};

template <abut::scalar T>
struct input {
    std::string name_a, name_b;
    abut::mesh<T> a, b;
    abut::rigid<T> pose;
};

/// The pose of an axis, an angle in degrees and a translation. Its matrix is made in long double and rounded once: trees
/// cull best where a rotation is one to the last places.
template <abut::scalar T>
abut::rigid<T> pose_of(const std::vector<double>& numbers) {
    if (numbers.empty()) return {};
    const double length = std::hypot(numbers[0], numbers[1], numbers[2]);
    const long double half = static_cast<long double>(numbers[3]) / 360 * 3.141592653589793238462643383279502884L;
    const long double w = std::cos(half), s = length > 0 ? std::sin(half) / static_cast<long double>(length) : 0;
    const long double x = s * numbers[0], y = s * numbers[1], z = s * numbers[2], n = w * w + x * x + y * y + z * z;
    const std::array<long double, 9> rotation{
        1 - 2 * (y * y + z * z) / n, 2 * (x * y - w * z) / n,     2 * (x * z + w * y) / n,
        2 * (x * y + w * z) / n,     1 - 2 * (x * x + z * z) / n, 2 * (y * z - w * x) / n,
        2 * (x * z - w * y) / n,     2 * (y * z + w * x) / n,     1 - 2 * (x * x + y * y) / n};
    abut::rigid<T> pose;
    for (std::size_t i = 0; i < 9; ++i) pose.rotation[i] = static_cast<T>(rotation[i]);
    pose.translation = {static_cast<T>(numbers[4]), static_cast<T>(numbers[5]), static_cast<T>(numbers[6])};
    return pose;
}

/// Reads or makes the scene. Sets are checked when they are made.
template <abut::scalar T>
input<T> make_input(const settings& s) {
    if (s.file_a.empty()) {
        const auto ring = scene::torus<T>(around, across);
        const abut::mesh<T> torus{ring.vertices, ring.faces};
        return {"embedded torus", "embedded torus", torus, torus, pose_of<T>(s.pose.empty() ? embedded_pose : s.pose)};
    }
    const auto first = abut::io::read_mesh<T>(s.file_a);
    if (s.file_b.empty()) return {s.file_a, s.file_a, first, first, pose_of<T>(s.pose)};
    return {s.file_a, s.file_b, first, abut::io::read_mesh<T>(s.file_b), pose_of<T>(s.pose)};
}

// --- the queries -------------------------------------------------------------------------------------------------------

template <abut::scalar T>
struct outcome {
    abut::mesh_report report_a, report_b;
    std::vector<abut::index_pair> pairs;  // (triangle of a, triangle of b), sorted
    std::vector<abut::contact<T>> contacts, reduced;
};

/// The heart of it: both meshes into the policy's memory, what they are made of, a tree over each in its own frame, and the
/// queries, of which the second mesh is posed.
template <abut::arithmetic A, class Policy, abut::scalar T>
outcome<T> solve(const Policy& on, const input<T>& in, const settings& s, example::stopwatch& watch) {
    constexpr bool elsewhere = !abut::host_policy<Policy>;
    if (elsewhere) watch.time("start device", [&] { synchronize(on); });
    const auto bring = [&] { return std::pair(abut::copy_to(on, in.a), abut::copy_to(on, in.b)); };
    const auto [mesh_a, mesh_b] = elsewhere ? watch.time("upload", bring) : bring();

    outcome<T> found;
    watch.time("validate", [&, &mesh_a = mesh_a, &mesh_b = mesh_b] {
        found.report_a = abut::validate(on, mesh_a);
        found.report_b = abut::validate(on, mesh_b);
    });
    for (example::series runs(s.repeat); runs.more();) {
        const auto [a, b] = watch.time("build both trees", [&, &mesh_a = mesh_a, &mesh_b = mesh_b] {
            const std::pair trees(abut::make_bvh(on, mesh_a), abut::make_bvh(on, mesh_b));
            synchronize(on);
            return trees;
        });
        const auto& tree = a;
        const auto moved = abut::posed(b, in.pose);
        const auto hits = watch.time("pairs", [&] { return abut::pairs<A>(on, tree, moved); });
        const auto contacts = watch.time("contacts", [&] { return abut::contacts<A>(on, tree, moved); });
        const abut::reduce_options cells{.bins = s.bins, .method = abut::contact_reduction::binning};
        const auto reduce = [&] { return abut::reduce_contacts(on, contacts, cells); };
        if (s.bins > 0) found.reduced = abut::to_host(watch.time("reduce", reduce));
        if (!runs.is_last()) continue;
        const auto fetch = [&] {
            found.pairs = abut::to_host(hits);
            found.contacts = abut::to_host(contacts);
        };
        elsewhere ? watch.time("download", fetch) : fetch();
    }
    return found;
}

// --- what comes out ----------------------------------------------------------------------------------------------------

/// PREFIX_part.ply and PREFIX_part.vtp, written by write(path).
template <class Write>
void write_both(const settings& s, const std::string& part, std::vector<std::string>& written, const Write& write) {
    for (const char* extension : {".ply", ".vtp"}) {
        written.push_back(s.out + "_" + part + extension);
        write(written.back());
    }
}

/// The mesh where the pose puts it, which is what was decided on. Its triangles say whether and how often they are hit.
template <abut::scalar T>
void write_mesh(const std::string& path, const abut::mesh<T>& mesh, const abut::rigid<T>& pose,
                const std::vector<std::uint32_t>& times_hit) {
    const auto view = mesh.view();
    std::vector<abut::vec3<T>> vertices(view.vertices.count);
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = place(pose, view.vertices[v]);
    std::vector<abut::face> faces(view.size());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = view.faces[f];
    std::vector<std::uint8_t> hit(view.size());
    for (std::size_t f = 0; f < hit.size(); ++f) hit[f] = times_hit[f] > 0 ? 1 : 0;
    abut::io::write_mesh(path, vertices, faces,
                         {.hit = hit, .face_properties = {{"pairs", std::span<const std::uint32_t>(times_hit)}}});
}

/// Contacts as points, with their normals, depths and the triangles that they are of.
template <abut::scalar T>
void write_contacts(const std::string& path, const std::vector<abut::contact<T>>& contacts) {
    std::vector<abut::vec3<T>> points, normals;
    std::vector<T> depths;
    std::vector<std::uint32_t> a, b;
    for (const auto& c : contacts) {
        points.push_back(c.point);
        normals.push_back(c.normal);
        depths.push_back(c.depth);
        a.push_back(c.a);
        b.push_back(c.b);
    }
    abut::io::write_points(path, points, {.normals = normals, .properties = {{"depth", depths}, {"a", a}, {"b", b}}});
}

/// How often each triangle is in a pair.
template <class Side>
std::vector<std::uint32_t> count_hits(const std::vector<abut::index_pair>& pairs, std::size_t triangles, const Side& side) {
    std::vector<std::uint32_t> hits(triangles, 0);
    for (const auto& pair : pairs) ++hits[pair.*side];
    return hits;
}

/// Both meshes where they lie, with the triangles that are hit marked, and what touches.
template <abut::scalar T>
void write_view(const settings& s, const input<T>& in, const outcome<T>& found, const std::vector<std::uint32_t>& hits_a,
                const std::vector<std::uint32_t>& hits_b) {
    const auto select = [](const std::vector<std::uint32_t>& hits) {
        std::vector<std::uint8_t> hit(hits.size());
        std::ranges::transform(hits, hit.begin(), [](std::uint32_t n) { return n > 0 ? 1 : 0; });
        return example::selection(hit, example::most_faces_shown / 2, example::most_faces_shown / 2);
    };
    const auto of_a = select(hits_a), of_b = select(hits_b);
    abut::io::gltf_scene scene;
    const auto a = example::add_selected(scene, "a", in.a, of_a);
    const auto b = example::add_selected(scene, "b", abut::posed(in.b, in.pose), of_b);
    const auto shows = [&](const auto& r) { return of_a.shows(r.a) && of_b.shows(r.b); };
    const auto pairs = example::shown_results(scene, "pairs", found.pairs, shows);
    const auto contacts = example::shown_results(scene, "contacts", found.contacts, shows);
    scene.add_pairs(a, b, pairs, {.of = found.pairs.size()});
    scene.add_contacts(a, b, contacts, {.of = found.contacts.size()});
    example::write_view(s.view, scene);
}

inline void print_report(const char* which, const std::string& name, const abut::mesh_report& r) {
    const auto said = [](bool yes) { return yes ? "yes" : "no"; };
    std::printf("mesh %s: %s\n", which, name.c_str());
    std::printf("  vertices %llu, edges %llu, triangles %llu, components %llu, V - E + F = %lld\n",
                static_cast<unsigned long long>(r.vertices), static_cast<unsigned long long>(r.edges),
                static_cast<unsigned long long>(r.faces), static_cast<unsigned long long>(r.components),
                static_cast<long long>(r.euler_characteristic));
    std::printf("  closed: %s, manifold: %s, oriented: %s\n", said(r.closed()), said(r.manifold()), said(r.oriented()));
    const std::pair<const char*, std::size_t> defects[] = {
        {"open edges", r.boundary_edges.size()},
        {"edges of more than two triangles", r.nonmanifold_edges.size()},
        {"edges with inconsistent sides", r.inconsistent_edges.size()},
        {"triangles with a repeated index", r.faces_with_repeated_index.size()},
        {"triangles without area", r.zero_area_faces.size()},
        {"duplicate triangles", r.duplicate_faces.size()},
        {"unused vertices", r.unused_vertices.size()},
        {"vertices of more than one fan", r.nonmanifold_vertices.size()},
        {"vertices in the place of another", r.coincident_vertices.size()}};
    for (const auto& [what, n] : defects) {
        if (n > 0) std::printf("  %s: %zu\n", what, n);
    }
}

template <class Program, abut::scalar T>
void run_as(const settings& s) {
    example::stopwatch watch(s.progress);
    const auto in = watch.time("read", [&] { return make_input<T>(s); });
    outcome<T> found;
    Program::with_policy(s.policy(), s.threads, [&](const auto& on) {
        example::choose(typename Program::arithmetics{}, s.arithmetic,
                        [&]<class A>() { found = solve<A>(on, in, s, watch); });
    });

    const auto hits_a = count_hits(found.pairs, in.a.size(), &abut::index_pair::a);
    const auto hits_b = count_hits(found.pairs, in.b.size(), &abut::index_pair::b);
    std::vector<std::string> written;
    const auto write = [&] {
        watch.time("write", [&] {
            write_both(s, "a", written, [&](const auto& path) { write_mesh(path, in.a, abut::rigid<T>{}, hits_a); });
            write_both(s, "b", written, [&](const auto& path) { write_mesh(path, in.b, in.pose, hits_b); });
            write_both(s, "contacts", written, [&](const auto& path) { write_contacts(path, found.contacts); });
            if (s.bins == 0) return;
            write_both(s, "reduced", written, [&](const auto& path) { write_contacts(path, found.reduced); });
        });
    };
    example::write_and_print(!s.no_output, write, [&](bool all_written) {
        const auto line = [](const char* what, std::size_t n) { std::printf("%-20s %12zu\n", what, n); };
        const auto hit = [](const auto& hits) {
            return hits.size() - static_cast<std::size_t>(std::ranges::count(hits, 0u));
        };
        std::printf("%s, %s arithmetic on %s\n", s.policy().c_str(), s.arithmetic.c_str(), s.scalar.c_str());
        print_report("a", in.name_a, found.report_a);
        print_report("b", in.name_b, found.report_b);
        line("pairs", found.pairs.size());
        line("triangles of a hit", hit(hits_a));
        line("triangles of b hit", hit(hits_b));
        line("contacts", found.contacts.size());
        if (!found.contacts.empty()) {
            const auto deeper = [](const auto& c, const auto& d) { return c.depth < d.depth; };
            const auto& deepest = *std::ranges::max_element(found.contacts, deeper);
            std::printf("%-20s %12g   (triangles %u and %u)\n", "greatest depth", static_cast<double>(deepest.depth),
                        deepest.a, deepest.b);
        }
        if (s.bins > 0) line("reduced contacts", found.reduced.size());
        std::printf("time in ms%s\n", s.repeat > 1 ? " (from the trees on: medians)" : "");
        watch.print();
        if (!s.view.empty()) write_view(s, in, found, hits_a, hits_b);
        if (!all_written) return;
        std::printf("written:");
        for (std::size_t i = 0; i < written.size(); ++i) std::printf("%s %s", i == 0 ? "" : ",", written[i].c_str());
        std::printf("\n");
    });
}

// --- the command line --------------------------------------------------------------------------------------------------

template <class Program>
void describe(CLI::App& app, settings& s) {
    app.description(
        "Where do two meshes touch? Whether they do is decided exactly by default. The second mesh may be moved\n"
        "by a pose.\n\n"
        "Without files: two tori of 9,216 triangles, one leaning through the other. With one file: it against\n"
        "itself.\n" +
        std::string(Program::note));
    app.add_option("a", s.file_a, "Read mesh a from an .obj, .ply, .stl, .off, .glb or .gltf file")->type_name("FILE");
    app.add_option("b", s.file_b, "Read mesh b from such a file")->type_name("FILE");
    app.add_option("--pose", s.pose, "Turn mesh b by ANGLE degrees about the axis X Y Z, then move it by TX TY TZ")
        ->type_name("X Y Z ANGLE TX TY TZ")
        ->expected(7);
    example::add_policy<Program>(app, s);
    example::add_types<Program>(app, s, "pairs");
    app.add_option("--reduce", s.bins, "Reduce contacts with N bins (0: do not)")
        ->type_name("N")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    example::add_repeat(app, s, "Build and query");
    app.add_flag("--progress", s.progress, "Say on stderr when a stage is done");
    app.add_option("--out", s.out,
                   "Write PREFIX_a and PREFIX_b (the meshes, b where the pose puts it, triangles marked where hit),\n"
                   "PREFIX_contacts and PREFIX_reduced (points with normals), each as .ply and .vtp")
        ->type_name("PREFIX")
        ->capture_default_str();
    app.add_flag("--no-output", s.no_output, "Write no files");
    example::add_view(app, s);
}

/// What CLI11 does not check.
inline void check(const settings& s) {
    const auto is_bad = [](double x) { return !std::isfinite(x); };
    if (std::ranges::any_of(s.pose, is_bad)) throw example::usage_error("--pose: expected finite numbers");
    if (!s.pose.empty() && s.pose[3] != 0 && !std::isnormal(std::hypot(s.pose[0], s.pose[1], s.pose[2]))) {
        throw example::usage_error("--pose: expected an axis with a length");
    }
    example::check_threads(s);
    example::check_view(s);
    if (s.no_output) return;
    for (const char* part : {"_a", "_b", "_contacts", "_reduced"}) {
        for (const char* extension : {".ply", ".vtp"}) example::require_writable(s.out + part + extension);
    }
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

}  // namespace mesh_vs_mesh
