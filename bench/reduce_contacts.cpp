// SPDX-License-Identifier: MIT
//
// usage: bench_reduce_contacts [--json=OUT.json] [--mesh=FILE]
//
// How much of the cone of contacts is left by the two methods of reduce_contacts. Scenes: mesh_on_mesh, FILE or a torus
// against a turned copy of itself (bench/meshes_scene.hpp); box_on_plane, a box of 12 x 12 squares a side that has sunk into
// a plane of such squares; and sphere_in_ring. Names: SCENE/METHOD/N, at most N contacts, METHOD binning or extremes;
// SCENE/bins/N, binning alone with N cells an axis. Counters share and worst:
//
// The measure. Each contact is a point of six dimensions: its normal, and the normal's torque about the middle of all
// contacts, by half the longest side of the box around them. In 1,000 random directions of that space, the support of a set
// of contacts is how far any of them reaches, or 0. "share" is the sum over directions of the reduced set's supports by that
// of all contacts; "worst" is the largest share missing in one direction, of the largest support of all.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "meshes_scene.hpp"
#include "results.hpp"

namespace {

using contact = abut::contact<float>;
using six = std::array<double, 6>;

std::vector<six> wrenches(const std::vector<contact>& contacts, const std::vector<contact>& all) {
    auto box = abut::empty_box<float>();
    for (const auto& c : all) box = abut::merge(box, abut::bounds(c.point));
    const double lower[3] = {double(box.lower.x), double(box.lower.y), double(box.lower.z)};
    const double upper[3] = {double(box.upper.x), double(box.upper.y), double(box.upper.z)};
    double half = 0;
    for (int k = 0; k < 3; ++k) half = std::max(half, (upper[k] - lower[k]) / 2);
    std::vector<six> w;
    for (const auto& c : contacts) {
        const double n[3] = {double(c.normal.x), double(c.normal.y), double(c.normal.z)};
        const double p[3] = {(double(c.point.x) - (lower[0] + upper[0]) / 2) / half,
                             (double(c.point.y) - (lower[1] + upper[1]) / 2) / half,
                             (double(c.point.z) - (lower[2] + upper[2]) / 2) / half};
        w.push_back({n[0], n[1], n[2], p[1] * n[2] - p[2] * n[1], p[2] * n[0] - p[0] * n[2], p[0] * n[1] - p[1] * n[0]});
    }
    return w;
}

struct kept_share {
    double share, worst;
};

kept_share measure(const std::vector<contact>& all, const std::vector<contact>& few) {
    std::mt19937_64 engine(1);
    const auto normal = [&] {  // the same numbers on every standard library
        const auto draw = [&] { return (static_cast<double>(engine() >> 11) + 0.5) * 0x1p-53; };
        return std::sqrt(-2 * std::log(draw())) * std::cos(2 * std::acos(-1.0) * draw());
    };
    const auto of_all = wrenches(all, all), of_few = wrenches(few, all);
    double sum_all = 0, sum_few = 0, largest = 0, missing = 0;
    for (int k = 0; k < 1000; ++k) {
        six d{};
        double square = 0;
        for (double& x : d) x = normal(), square += x * x;
        const auto support = [&](const std::vector<six>& w) {
            double most = 0;
            for (const six& x : w) {
                double value = 0;
                for (std::size_t i = 0; i < 6; ++i) value += x[i] * d[i];
                most = std::max(most, value / std::sqrt(square));
            }
            return most;
        };
        const double h = support(of_all), g = support(of_few);
        sum_all += h;
        sum_few += g;
        largest = std::max(largest, h);
        missing = std::max(missing, h - g);
    }
    return {sum_few / sum_all, missing / largest};
}

/// The plane z = 0 over [-side, side]^2, or a box's surface: squares of two triangles each.
void add_square(std::vector<abut::triangle<float>>& to, const double (&o)[3], const double (&u)[3], const double (&v)[3],
                int cells) {
    const auto at = [&](int i, int j) {
        const double s = double(i) / cells, t = double(j) / cells;
        return abut::vec3<float>{float(o[0] + s * u[0] + t * v[0]), float(o[1] + s * u[1] + t * v[1]),
                                 float(o[2] + s * u[2] + t * v[2])};
    };
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            to.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            to.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
}

std::vector<contact> box_on_plane() {
    std::vector<abut::triangle<float>> box, ground;
    const double bottom = -0.01, h = 1, c = 0.5;
    add_square(box, {-c, -c, bottom}, {0, 2 * c, 0}, {2 * c, 0, 0}, 12);
    add_square(box, {-c, -c, bottom}, {2 * c, 0, 0}, {0, 0, h}, 12);
    add_square(box, {c, -c, bottom}, {0, 2 * c, 0}, {0, 0, h}, 12);
    add_square(box, {c, c, bottom}, {-2 * c, 0, 0}, {0, 0, h}, 12);
    add_square(box, {-c, c, bottom}, {0, -2 * c, 0}, {0, 0, h}, 12);
    add_square(ground, {-1.03, -1.01, 0}, {2, 0.1, 0}, {-0.1, 2, 0}, 17);
    return to_host(contacts(abut::openmp{}, abut::triangle_soup<float>(box), abut::triangle_soup<float>(ground)));
}

std::vector<contact> sphere_in_bowl() {
    // Half a torus' hole: many normals, around the sphere.
    const abut::test::torus<float> shape(96, 48, 1, 0.4);
    const abut::mesh<float> bowl(shape.vertices, shape.faces);
    return to_host(contacts(abut::openmp{}, abut::sphere<float>{{0, 0, 0.3F}, 0.8F}, bowl));
}

void add(bench::results& out, const std::string& name, const std::vector<contact>& all) {
    abut::execution::buffer<contact, abut::host_space> copy(abut::serial{}, all.size());
    std::memcpy(static_cast<void*>(copy.data()), all.data(), all.size() * sizeof(contact));
    const abut::result<contact, abut::host_space> found(std::move(copy));
    const auto row = [&](const std::string& method, std::size_t n, const abut::reduce_options& options) {
        const auto few = to_host(reduce_contacts(abut::openmp{}, found, options));
        const kept_share k = measure(all, few);
        out.add(bench::joined({name, method, std::to_string(n)}), {{"contacts", static_cast<double>(all.size())},
                                                                   {"kept", static_cast<double>(few.size())},
                                                                   {"share", k.share},
                                                                   {"worst", k.worst}});
    };
    for (const std::size_t most : {4u, 8u, 16u, 32u}) {
        row("binning", most, {.most = most, .method = abut::contact_reduction::binning});
        row("extremes", most, {.most = most, .method = abut::contact_reduction::extremes});
    }
    for (const int bins : {2, 3, 4, 8}) row("bins", static_cast<std::size_t>(bins), {.bins = bins});
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const std::string mesh = bench::take_argument(argc, argv, "--mesh");
        const auto pair =
            meshes_scene::make_pair(mesh.empty() ? meshes_scene::unit_torus() : meshes_scene::read_surface(mesh));
        bench::results out("bench_reduce_contacts");
        out.describe("mesh", mesh.empty() ? "torus" : mesh.substr(mesh.find_last_of('/') + 1));
        const abut::openmp on;
        const auto tree = make_bvh(on, abut::mesh<float>(pair.a.vertices, pair.a.faces));
        add(out, "mesh_on_mesh", to_host(contacts(on, tree, posed(tree, pair.pose))));
        add(out, "box_on_plane", box_on_plane());
        add(out, "sphere_in_ring", sphere_in_bowl());
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_reduce_contacts: %s\n", problem.what());
        return 1;
    }
}
