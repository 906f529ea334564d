// SPDX-License-Identifier: MIT
//
// usage: bench_reduce_contacts [--mesh=FILE]
//
// How much of the cone of contacts is left by the two methods of reduce_contacts at 4, 8, 16 and 32 contacts. Scenes: a mesh
// (FILE, or a torus) against a turned copy of itself (bench/meshes_scene.hpp), a box of 12 x 12 squares a side that has sunk
// into a plane of such squares, and a sphere in a bowl. Prints a table in Markdown.
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
#include <random>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "meshes_scene.hpp"

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

void report(const std::string& name, const std::vector<contact>& all) {
    abut::execution::buffer<contact, abut::host_space> copy(abut::serial{}, all.size());
    std::memcpy(static_cast<void*>(copy.data()), all.data(), all.size() * sizeof(contact));
    const abut::result<contact, abut::host_space> found(std::move(copy));
    for (const auto method : {abut::contact_reduction::binning, abut::contact_reduction::extremes}) {
        const bool binning = method == abut::contact_reduction::binning;
        std::printf("| %s, %zu contacts | %s |", name.c_str(), all.size(), binning ? "binning" : "extremes");
        for (const std::size_t most : {std::size_t{4}, std::size_t{8}, std::size_t{16}, std::size_t{32}}) {
            const auto few = to_host(reduce_contacts(abut::openmp{}, found, {.most = most, .method = method}));
            const kept_share k = measure(all, few);
            std::printf(" %.3f (%.3f) |", k.share, k.worst);
        }
        std::printf("\n");
    }
    for (const int bins : {2, 3, 4, 8}) {
        const auto few = to_host(reduce_contacts(abut::openmp{}, found, {.bins = bins}));
        const kept_share k = measure(all, few);
        std::printf("%s: %d bins keep %zu contacts, %.3f (%.3f)\n", name.c_str(), bins, few.size(), k.share, k.worst);
    }
}

}  // namespace

int main(int argc, char** argv) {
    meshes_scene::surface surface = meshes_scene::unit_torus();
    std::string name = "torus on torus";
    if (argc > 1 && std::strncmp(argv[1], "--mesh=", 7) == 0) {
        const auto read = abut::io::read_mesh<float>(argv[1] + 7);
        surface = {{}, {}};
        const auto view = read.view();
        for (std::size_t i = 0; i < view.vertices.count; ++i) surface.vertices.push_back(view.vertices[i]);
        for (std::size_t i = 0; i < view.faces.count; ++i) surface.faces.push_back(view.faces[i]);
        name = "mesh on mesh";
    }
    const auto pair = meshes_scene::make_pair(std::move(surface));
    const abut::openmp on;
    const auto tree = make_bvh(on, abut::mesh<float>(pair.a.vertices, pair.a.faces));
    std::printf("| scene | method | 4 | 8 | 16 | 32 |\n| --- | --- | --- | --- | --- | --- |\n");
    report(name, to_host(contacts(on, tree, posed(tree, pair.pose))));
    report("box on plane", box_on_plane());
    report("sphere in ring", sphere_in_bowl());
    return 0;
}
