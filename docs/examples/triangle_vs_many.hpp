// SPDX-License-Identifier: MIT
#pragma once

// The whole of the program triangle_vs_many but its policies: which of many random triangles does one triangle touch? After
// the console benchmark of Maffina, 2012, where processor and GPU disagreed on one triangle in a thousand. It is written
// once; triangle_vs_many.cpp and triangle_vs_many.cu say what runs it. The calls that matter are in `solve`.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/io/write.hpp>

#include "program.hpp"
#include "scene.hpp"
#include "view.hpp"

namespace triangle_vs_many {

struct settings : example::common_settings {
    std::size_t triangles = 1'000'000;
    double size = 0.55;
    std::uint64_t seed = 2012;
    bool any = false, all = false;
    std::string out = "triangle_vs_many.ply";

    [[nodiscard]] bool asks_any() const { return any || !all; }
    [[nodiscard]] bool asks_count() const { return !any && !all; }
    [[nodiscard]] bool asks_all() const { return all || !any; }
};

// --- the scene ---------------------------------------------------------------------------------------------------------

/// Side of the cube around the origin in which the triangles' centers lie.
inline constexpr double cube_side = 8;

template <abut::scalar T>
inline constexpr abut::triangle<T> reference{{3, -2, -1}, {-1, 3, -2}, {-2, -1, 3}};

/// Triangle i of the sequence that `seed` names: three corners, uniform in a cube of side `size` around a center that is
/// uniform in the scene's cube. The fma keeps compilers from choosing how the last digit is rounded.
template <abut::scalar T>
abut::triangle<T> random_triangle(std::uint64_t seed, std::uint64_t i, double size) {
    const auto drawn = [&](std::uint64_t k) { return scene::uniform(seed, 12 * i + k) - 0.5; };
    const double x = drawn(0) * cube_side, y = drawn(1) * cube_side, z = drawn(2) * cube_side;
    const auto corner = [&](std::uint64_t k) {
        return abut::vec3<T>{static_cast<T>(std::fma(drawn(k), size, x)), static_cast<T>(std::fma(drawn(k + 1), size, y)),
                             static_cast<T>(std::fma(drawn(k + 2), size, z))};
    };
    return {corner(3), corner(6), corner(9)};
}

template <abut::scalar T>
std::vector<abut::triangle<T>> random_triangles(const settings& s) {
    std::vector<abut::triangle<T>> triangles(s.triangles);
    for (std::size_t i = 0; i < s.triangles; ++i) triangles[i] = random_triangle<T>(s.seed, i, s.size);
    return triangles;
}

// --- the queries -------------------------------------------------------------------------------------------------------

/// What one policy says, as far as it was asked.
struct outcome {
    std::string policy;
    example::stopwatch watch;
    std::optional<bool> any;
    std::optional<std::uint64_t> count;
    std::vector<std::uint8_t> hit;  // for each triangle; empty if it was not asked
};

/// The heart of it: the triangles into the policy's memory, where they stay, and the queries.
template <abut::arithmetic A, class Policy, abut::scalar T>
void solve(const Policy& on, const std::vector<abut::triangle<T>>& triangles, const settings& s, outcome& found) {
    using soup = abut::triangle_soup<T, typename Policy::memory_space>;
    const auto ask = [&](const soup& many, example::stopwatch& watch) {
        if (s.asks_any()) found.any = watch.time("any", [&] { return abut::any<A>(on, reference<T>, many); });
        if (s.asks_count()) found.count = watch.time("count", [&] { return abut::count<A>(on, reference<T>, many); });
        if (!s.asks_all()) return;
        const auto hits = watch.time("all", [&] { return abut::pairs<A>(on, reference<T>, many); });
        const auto pairs = watch.time("download", [&] { return abut::to_host(hits); });
        found.hit.assign(triangles.size(), 0);
        for (const auto& pair : pairs) found.hit[pair.b] = 1;
    };
    // Threads, a device and its kernels start when they are first used. That is timed by itself, on a few triangles.
    found.watch.time("start", [&] {
        const std::span<const abut::triangle<T>> few(triangles.data(), std::min<std::size_t>(triangles.size(), 1000));
        example::stopwatch unseen;
        ask(soup(on, few), unseen);
    });
    for (example::series runs(s.repeat); runs.more();) {
        const soup many = found.watch.time("upload and check", [&] { return soup(on, triangles); });
        ask(many, found.watch);
    }
}

// --- do the policies agree? --------------------------------------------------------------------------------------------

/// The triangles of which not all outcomes say the same.
inline std::vector<std::size_t> differences(const std::vector<outcome>& found) {
    std::vector<std::size_t> ids;
    for (std::size_t i = 0; i < found.front().hit.size(); ++i) {
        const auto agrees = [&](const outcome& other) { return other.hit[i] == found.front().hit[i]; };
        if (!std::all_of(found.begin(), found.end(), agrees)) ids.push_back(i);
    }
    return ids;
}

template <abut::scalar T>
void print_difference(std::size_t id, const abut::triangle<T>& t, const std::vector<outcome>& found) {
    std::printf("triangle %zu:", id);
    const auto print = [](const abut::vec3<T>& p) {
        constexpr int digits = std::numeric_limits<T>::max_digits10;
        std::printf(" (%.*g, %.*g, %.*g)", digits, static_cast<double>(p.x), digits, static_cast<double>(p.y), digits,
                    static_cast<double>(p.z));
    };
    print(t.a), print(t.b), print(t.c);
    for (const auto& one : found) std::printf(", %s: %s", one.policy.c_str(), one.hit[id] != 0 ? "hit" : "miss");
    std::printf("\n");
}

/// Says whether all outcomes are the same, and what differs.
template <abut::scalar T>
bool compare(const std::vector<outcome>& found, const std::vector<abut::triangle<T>>& triangles) {
    bool same = true;
    const auto complain = [&](const outcome& one, const char* what, std::uint64_t says, std::uint64_t expected) {
        std::printf("%s: %s is %llu, where %llu is expected\n", one.policy.c_str(), what,
                    static_cast<unsigned long long>(says), static_cast<unsigned long long>(expected));
        same = false;
    };
    const bool any = found.front().any.value_or(false);
    for (const auto& one : found) {
        const bool knows_hits = !one.hit.empty();
        const std::size_t hits = example::count_set(one.hit);
        const bool expected = knows_hits ? hits > 0 : any;
        if (one.any && *one.any != expected) complain(one, "any", *one.any ? 1 : 0, expected ? 1 : 0);
        if (one.count && knows_hits && *one.count != hits) complain(one, "count", *one.count, hits);
    }
    const auto ids = differences(found);
    for (const std::size_t id : ids) print_difference(id, triangles[id], found);
    same = same && ids.empty();
    if (!ids.empty()) {
        std::printf("the policies differ on %zu of %zu triangles\n", ids.size(), triangles.size());
    } else if (!same) {
        std::printf("the answers differ\n");
    } else if (found.size() > 1 && found.front().hit.empty()) {
        std::printf("%zu policies agree\n", found.size());
    } else if (found.size() > 1) {
        std::printf("%zu policies agree on all %zu triangles\n", found.size(), triangles.size());
    }
    return same;
}

// --- what comes out ----------------------------------------------------------------------------------------------------

/// The random triangles, then the reference, which has `reference` 1 and is hit if any of the others is.
template <abut::scalar T>
void write_scene(const std::string& file, std::vector<abut::triangle<T>> triangles, std::vector<std::uint8_t> hit) {
    std::vector<std::uint8_t> is_reference(triangles.size(), 0);
    is_reference.push_back(1);
    hit.push_back(example::count_set(hit) > 0 ? 1 : 0);
    triangles.push_back(reference<T>);
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
    vertices.reserve(3 * triangles.size());
    faces.reserve(triangles.size());
    for (const auto& t : triangles) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        faces.push_back({first, first + 1, first + 2});
        vertices.insert(vertices.end(), {t.a, t.b, t.c});
    }
    abut::io::write_mesh(file, vertices, faces,
                         {.hit = hit, .face_properties = {{"reference", std::span<const std::uint8_t>(is_reference)}}});
}

/// Of triangles that are not hit, so many are shown.
inline constexpr std::size_t most_others_shown = 20'000;

/// The reference, the triangles that it touches and some others, and the pairs.
template <abut::scalar T>
void write_view(const std::string& file, const std::vector<abut::triangle<T>>& triangles,
                const std::vector<std::uint8_t>& hit) {
    const std::size_t most = std::min(example::most_faces_shown, example::count_set(hit) + most_others_shown);
    const example::selection which(hit, most, most_others_shown);
    std::vector<abut::index_pair> pairs;
    for (std::uint32_t i = 0; i < hit.size(); ++i) {
        if (hit[i] != 0) pairs.push_back({0, i});
    }
    const std::vector<std::uint8_t> is_hit{static_cast<std::uint8_t>(pairs.empty() ? 0 : 1)};
    abut::io::gltf_scene scene;
    const auto a = scene.add("reference", reference<T>, {.hit = is_hit});
    const auto b = example::add_selected(scene, "triangles", abut::triangle_soup<T>(triangles), which);
    const auto shows = [&](const abut::index_pair& pair) { return which.shows(pair.b); };
    scene.add_pairs(a, b, example::shown_results(scene, "pairs", pairs, shows), {.of = pairs.size()});
    example::write_view(file, scene);
}

/// A column for each policy, a row for each stage.
inline void print_times(const settings& s, const std::vector<outcome>& found) {
    std::printf("%-18s", s.repeat > 1 ? "medians in ms" : "time in ms");
    for (const auto& one : found) std::printf(" %12s", one.policy.c_str());
    std::printf("\n");
    for (const char* const stage : {"start", "upload and check", "any", "count", "all", "download"}) {
        if (!found.front().watch.median(stage)) continue;
        std::printf("  %-16s", stage);
        for (const auto& one : found) std::printf(" %12.3f", *one.watch.median(stage));
        std::printf("\n");
    }
}

template <class Program, abut::scalar T>
int run_as(const settings& s) {
    example::stopwatch watch;
    const auto triangles = watch.time("generate", [&] { return random_triangles<T>(s); });

    std::vector<outcome> found;
    for (const std::string& policy : s.policies) {
        found.emplace_back().policy = policy;
        Program::with_policy(policy, s.threads, [&](const auto& on) {
            example::choose(typename Program::arithmetics{}, s.arithmetic,
                            [&]<class A>() { solve<A>(on, triangles, s, found.back()); });
        });
    }
    const bool writes = !s.no_output && s.asks_all();
    const auto write = [&] { watch.time("write", [&] { write_scene(s.out, triangles, found.front().hit); }); };
    bool same = true;
    example::write_and_print(writes, write, [&](bool written) {
        std::printf("one triangle against %zu of size %g, seed %llu, %s arithmetic on %s\n", s.triangles, s.size,
                    static_cast<unsigned long long>(s.seed), s.arithmetic.c_str(), s.scalar.c_str());
        if (found.front().any) std::printf("%-18s %12s\n", "any is hit", *found.front().any ? "yes" : "no");
        if (s.asks_all()) {
            const std::size_t hits = example::count_set(found.front().hit);
            std::printf("%-18s %12zu   (%.3f %%)\n", "triangles hit", hits,
                        100 * static_cast<double>(hits) / static_cast<double>(s.triangles));
        }
        print_times(s, found);
        std::printf("outside of the policies\n");
        watch.print();
        if (written) std::printf("written: %s\n", s.out.c_str());
        if (!s.view.empty()) write_view(s.view, triangles, found.front().hit);
        same = compare(found, triangles);
    });
    return same ? 0 : 1;
}

// --- the command line --------------------------------------------------------------------------------------------------

template <class Program>
CLI::Option* describe(CLI::App& app, settings& s) {
    app.description(
        "Which of many random triangles does one triangle touch? Decided exactly by default, on each\n"
        "policy in turn; triangles on which policies differ are listed, and make the exit status 1.\n\n"
        "Without --any and --all it asks all it can: is any triangle hit, how many, and which.\n" +
        std::string(Program::note));
    app.add_option("--triangles", s.triangles, "Make N triangles")
        ->type_name("N")
        ->check(CLI::Range(std::size_t{1}, std::size_t{700'000'000}))  // io writes up to 2^31 vertices
        ->capture_default_str();
    app.add_option("--size", s.size,
                   "Side of the cube in which a triangle's corners are drawn, in a scene of side 8; with 0.55\n"
                   "about 1 % are hit")
        ->type_name("S")
        ->capture_default_str();
    app.add_option("--seed", s.seed, "Seed of the triangles")->capture_default_str();
    app.add_flag("--any", s.any, "Ask whether any triangle is hit (which may stop early), and not which");
    app.add_flag("--all", s.all, "Ask which triangles are hit");
    app.add_option("--policy", s.policies, "What runs it: one, or some, as in serial,openmp")
        ->type_name("NAMES")
        ->delimiter(',')
        ->check(CLI::IsMember(Program::policies()))
        ->capture_default_str();
    example::add_threads<Program>(app, s);
    example::add_types<Program>(app, s, "triangles");
    example::add_repeat(app, s, "Upload and ask");
    const auto out =
        app.add_option("--out", s.out,
                       "Write the scene here, as .ply or .vtp, its triangles marked where hit; not with --any alone")
            ->type_name("FILE")
            ->capture_default_str();
    app.add_flag("--no-output", s.no_output, "Write no file");
    example::add_view(app, s);
    return out;
}

/// What CLI11 does not check.
inline void check(const settings& s, bool names_a_file) {
    if (!(std::isfinite(s.size) && s.size >= 0)) throw example::usage_error("--size: expected 0 or more");
    for (const auto& policy : s.policies) {
        if (std::count(s.policies.begin(), s.policies.end(), policy) > 1) {
            throw example::usage_error("--policy: " + policy + " is there twice");
        }
    }
    example::check_threads(s);
    if (names_a_file && !s.asks_all())
        throw example::usage_error("--out: --any does not find which triangles are hit; add --all");
    if (!s.view.empty() && !s.asks_all()) {
        throw example::usage_error("--view: --any does not find which triangles are hit; add --all");
    }
    example::check_view(s);
    if (s.no_output || !s.asks_all()) return;
    example::require_mesh_format("--out", s.out);
    example::require_writable(s.out);
}

/// `Program` names itself, its policies, and the types that it is compiled for. Returns the exit status.
template <class Program>
int main(int argc, char** argv) {
    settings s;
    s.policies = Program::policies();
    const CLI::Option* out = nullptr;
    const auto describe_all = [&](CLI::App& app) { out = describe<Program>(app, s); };
    const auto check_all = [&] { check(s, out->count() > 0); };
    return example::run<Program>(argc, argv, s, describe_all, check_all, [&]<class T>() { return run_as<Program, T>(s); });
}

}  // namespace triangle_vs_many
