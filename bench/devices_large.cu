// SPDX-License-Identifier: MIT
//
// usage: bench_devices_large_cuda [OUT.json [TRIANGLES [AROUND]]]
//
// What several devices are for, made where it is asked about: nothing goes through host memory.
//
//   one       one triangle against TRIANGLES (2 x 10^9: 72 GB), 1 % of which touch it; divided, each device makes its part
//   mesh      the pair of bench/meshes_scene.hpp enlarged: a torus of AROUND x AROUND / 2 quads (10,000: 100 million
//             triangles) against its turned copy; copied, and divided
//   corner    16,777,216 triangles against as many, 15 of 16 of them in a corner of 1/32 of the side; copied, and divided
//
// by `cuda`, by cuda_devices of that device, and of all devices. Rows devices_large/QUERY/SCENE/POLICY. Each figure is a
// median of bench/cuda_table.hpp, taken with CUDA events of the first device around the whole call. All answers are compared
// with those of `cuda`, pairs bit for bit; a difference is an error. Row `devices` has their number. Counters: `pairs`;
// `busiest`, what the device that found most found, over an equal share; and where a floor is known `floor_ms`, what one
// device takes to read the scene.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <abut/cuda_devices.hpp>

#include "cuda_table.hpp"
#include "meshes_scene.hpp"
#include "triangle_scene.hpp"

namespace {

using abut::device_space;
using bench::counters;
using bench::joined;
using bench::table;

using soup = abut::triangle_soup<float, device_space>;
using mesh = abut::mesh<float, device_space>;

/// What was found by one device, to compare with.
struct expected {
    std::vector<abut::index_pair> pairs;
    void check(const std::string& name, const std::vector<abut::index_pair>& found) {
        if (pairs.empty()) pairs = found;
        if (found.empty() || found != pairs) throw abut::error(name + ": other pairs than those of cuda");
    }
    void check(const std::string& name, std::uint64_t count) const {
        if (count != pairs.size()) throw abut::error(name + ": another number of pairs than cuda finds");
    }
};

std::string row(const char* query, const char* scene, const char* policy) {
    return joined({"devices_large", query, scene, policy});
}

/// Sorted pairs and their number, by one policy or by several.
template <class Policy, class A, class B>
void add(const Policy& on, const char* scene, const char* policy, const A& a, const B& b, double bytes, expected& truth,
         table& out) {
    truth.check(row("pairs", scene, policy), abut::to_host(abut::pairs(on, a, b)));
    counters says{{"pairs", static_cast<double>(truth.pairs.size())}};
    if constexpr (abut::execution::policy_team<Policy>) {
        std::size_t most = 0;
        for (const auto& there : abut::pairs_by_device(on, a, b)) most = std::max(most, there.size());
        says.emplace_back("busiest", static_cast<double>(most) * on.size() / static_cast<double>(truth.pairs.size()));
    }
    out.add(row("pairs", scene, policy), bytes, [&] {
        if (abut::pairs(on, a, b).size() != truth.pairs.size()) throw abut::error("another number of pairs");
        return says;
    });
    out.add(row("count", scene, policy), bytes, [&] {
        truth.check(row("count", scene, policy), abut::count(on, a, b));
        return says;
    });
}

// --- one against many -----------------------------------------------------------------------------------------------------

struct make_triangle {
    std::uint64_t first;
    ABUT_HD abut::triangle<float> operator()(std::size_t i) const {
        return triangle_scene::random_triangle<float>(triangle_scene::one_shares[0].spread, first + i);
    }
};

void add_one(const abut::cuda& on, const abut::cuda_devices& alone, const abut::cuda_devices& all, std::size_t n,
             table& out) {
    const double bytes = static_cast<double>(n) * sizeof(abut::triangle<float>);
    const auto reference = triangle_scene::reference<float>();
    expected truth;
    {
        const soup whole(on, n, make_triangle{0});
        add(on, "one", "cuda", reference, whole, bytes, truth, out);
        add(alone, "one", "one_device", reference, abut::divided(std::vector{whole}), bytes, truth, out);
    }
    release_memory(on);
    if (all.size() == 1) return;
    std::vector<soup> parts;
    std::size_t first = 0;
    for (int k = 0; k < all.size(); ++k) {
        const std::size_t last = n / static_cast<std::size_t>(all.size()) * static_cast<std::size_t>(k + 1);
        const std::size_t count = (k + 1 == all.size() ? n : last) - first;
        parts.emplace_back(all[k], count, make_triangle{first});
        first += count;
    }
    add(all, "one", "all_devices", reference, abut::divided(std::move(parts)), bytes, truth, out);
}

// --- mesh against mesh ----------------------------------------------------------------------------------------------------

/// As meshes_scene::unit_torus, under a pose.
struct make_vertex {
    std::uint32_t around, across;
    abut::rigid<float> pose;
    ABUT_HD abut::vec3<float> operator()(std::size_t k) const {
        constexpr double turn = 6.283185307179586, major = 0.35, minor = 0.15;
        const double u = turn * static_cast<double>(k / across) / around,
                     v = turn * static_cast<double>(k % across) / across;
        const double r = major + minor * std::cos(v);
        return abut::place(pose, abut::vec3<float>{static_cast<float>(r * std::cos(u)), static_cast<float>(r * std::sin(u)),
                                                   static_cast<float>(minor * std::sin(v))});
    }
};
struct make_face {
    std::uint32_t around, across;
    abut::face* to;
    ABUT_HD void operator()(std::size_t k) const {
        const auto i = static_cast<std::uint32_t>(k / 2 / across), j = static_cast<std::uint32_t>(k / 2 % across);
        const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
        const std::uint32_t at = i * across + j, opposite = next_i * across + next_j;
        to[k] = k % 2 == 0 ? abut::face{at, next_i * across + j, opposite} : abut::face{at, opposite, i * across + next_j};
    }
};

mesh torus(const abut::cuda& on, std::uint32_t around, const abut::rigid<float>& pose) {
    const std::uint32_t across = around / 2;
    const std::size_t n = std::size_t{around} * across;
    const abut::points<float, device_space> vertices(on, n, make_vertex{around, across, pose});
    abut::execution::buffer_of<abut::cuda, abut::face> faces(on, 2 * n);
    for_each_index(on, 2 * n, make_face{around, across, faces.data()});
    return copy_to(
        on, abut::mesh_view<float, device_space>(vertices.view().shapes.first(), n, std::as_const(faces).data(), 2 * n));
}
abut::replicated<mesh> torus_on_each(const abut::cuda_devices& team, std::uint32_t around, const abut::rigid<float>& pose) {
    std::vector<mesh> copies;
    for (int k = 0; k < team.size(); ++k) copies.push_back(torus(team[k], around, pose));
    return abut::replicated(std::move(copies));
}

void add_mesh(const abut::cuda& on, const abut::cuda_devices& alone, const abut::cuda_devices& all, std::uint32_t around,
              table& out) {
    const abut::rigid<float> turned = meshes_scene::turned(meshes_scene::unit_torus(), 0.3);
    expected truth;
    const auto add_pair = [&](const auto& policy, const char* scene, const char* name, const auto& a, const auto& b) {
        out.add(row("build_and_pairs", scene, name), 0, [&] {
            const auto found = abut::pairs(policy, abut::make_bvh(policy, a), abut::make_bvh(policy, b)).size();
            return counters{{"triangles", static_cast<double>(a.size())}, {"pairs", static_cast<double>(found)}};
        });
        add(policy, scene, name, abut::make_bvh(policy, a), abut::make_bvh(policy, b), 0, truth, out);
    };
    add_pair(on, "mesh", "cuda", torus(on, around, {}), torus(on, around, turned));
    add_pair(alone, "mesh", "one_device", torus_on_each(alone, around, {}), torus_on_each(alone, around, turned));
    if (all.size() == 1) return;
    add_pair(all, "mesh", "all_devices", torus_on_each(all, around, {}), torus_on_each(all, around, turned));
    add_pair(all, "mesh_divided", "all_devices", abut::divide(all, torus(all[0], around, {})),
             abut::divide(all, torus(all[0], around, turned)));
}

// --- a crowded corner -----------------------------------------------------------------------------------------------------

struct make_in_corner {
    std::uint64_t stream;
    ABUT_HD abut::triangle<float> operator()(std::size_t i) const {
        constexpr double corner = 1.0 / 32, size = 0.00022;
        abut::test::draws d(triangle_scene::seed, stream, i);
        auto center = triangle_scene::cube(d, i % 16 == 0 ? 1 : corner);
        if (i % 16 != 0) center = {center.x - 1 + corner, center.y - 1 + corner, center.z - 1 + corner};
        return triangle_scene::triangle_around<float>(d, center, size);
    }
};

abut::replicated<soup> corner_on_each(const abut::cuda_devices& team, std::uint64_t stream) {
    std::vector<soup> copies;
    for (int k = 0; k < team.size(); ++k) copies.emplace_back(team[k], std::size_t{1} << 24, make_in_corner{stream});
    return abut::replicated(std::move(copies));
}

void add_corner(const abut::cuda& on, const abut::cuda_devices& alone, const abut::cuda_devices& all, table& out) {
    const auto a = corner_on_each(all, 31), b = corner_on_each(all, 32);
    expected truth;
    add(on, "corner", "cuda", abut::make_bvh(on, a[0]), abut::make_bvh(on, b[0]), 0, truth, out);
    const auto alone_a = abut::replicated(std::vector{a[0]}), alone_b = abut::replicated(std::vector{b[0]});
    add(alone, "corner", "one_device", abut::make_bvh(alone, alone_a), abut::make_bvh(alone, alone_b), 0, truth, out);
    if (all.size() == 1) return;
    add(all, "corner", "all_devices", abut::make_bvh(all, a), abut::make_bvh(all, b), 0, truth, out);
    const auto parts_a = abut::make_bvh(all, abut::divide(all, a[0])),
               parts_b = abut::make_bvh(all, abut::divide(all, b[0]));
    add(all, "corner_divided", "all_devices", parts_a, parts_b, 0, truth, out);
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t triangles = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2'000'000'000;
    const auto around = static_cast<std::uint32_t>(argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 10'000);
    return bench::run("bench_devices_large_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const abut::cuda_devices all, alone({abut::execution::device_of(on)});
        const auto release_all = [&] {
            for (int k = 0; k < all.size(); ++k) release_memory(all[k]);
        };
        out.note("devices", {{"count", static_cast<double>(all.size())}});
        add_corner(on, alone, all, out);
        release_all();
        add_mesh(on, alone, all, around, out);
        release_all();
        add_one(on, alone, all, triangles, out);
    });
}
