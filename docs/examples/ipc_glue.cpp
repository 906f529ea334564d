// SPDX-License-Identifier: MIT
//
// usage: ipc_glue [FRAME0 FRAME1]
//
// How much of a step is free of collisions, by the names of the IPC Toolkit: of two sheets that come together, or of a mesh that
// goes from one frame (PLY, OBJ, STL, OFF) to the next.
#include "ipc_glue.hpp"

#include <abut/io/read.hpp>
#include <cstdio>
#include <exception>
#include <set>

// Rows of three or two, as a matrix of Eigen would have them.
template <class Row>
struct table {
    std::vector<Row> data;
    int rows() const { return static_cast<int>(data.size()); }
    auto operator()(int i, int j) const { return data[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; }
};
using position_rows = table<std::array<double, 3>>;
using edge_rows = table<std::array<int, 2>>;
using face_rows = table<std::array<int, 3>>;

namespace ipc = ipc_glue;

void two_sheets() {
    position_rows start{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1.5}}}, end = start;
    for (std::size_t i = 3; i < 6; ++i) end.data[i][2] -= 2;
    const edge_rows e{{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}};
    const face_rows f{{{0, 1, 2}, {3, 4, 5}}};
    const ipc::CollisionMesh mesh(start, e, f);

    ipc::Candidates candidates;
    candidates.build(mesh, start, 0.5);
    std::printf("near at the start: %zu face-vertex, %zu edge-edge\n", candidates.fv_candidates.size(), candidates.ee_candidates.size());
    candidates.build(mesh, start, end, 0);
    for (const auto& c : candidates.fv_candidates) std::printf("face %d meets vertex %d\n", c.face_id, c.vertex_id);
    std::printf("free: %.6f, with 0.1 to keep: %.3f\n", ipc::compute_collision_free_stepsize(mesh, start, end),
                ipc::compute_collision_free_stepsize(mesh, start, end, 0.1));
    std::printf("intersections: %d before, %d after\n", ipc::has_intersections(mesh, start), ipc::has_intersections(mesh, end));
}

void frames(const char* first, const char* second) {
    const auto a = abut::io::read_mesh<double>(first), b = abut::io::read_mesh<double>(second);
    const auto rows = [](const auto& mesh) {
        position_rows p;
        for (std::size_t i = 0; i < mesh.view().vertices.count; ++i) {
            const auto v = mesh.view().vertices[i];
            p.data.push_back({v.x, v.y, v.z});
        }
        return p;
    };
    face_rows f;
    std::set<std::array<int, 2>> all;
    for (std::size_t i = 0; i < a.view().faces.count; ++i) {
        const auto& v = a.view().faces[i];
        f.data.push_back({static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2])});
        for (std::size_t k = 0; k < 3; ++k) {
            const int p = f.data.back()[k], q = f.data.back()[(k + 1) % 3];
            all.insert({p < q ? p : q, p < q ? q : p});
        }
    }
    const edge_rows e{{all.begin(), all.end()}};
    const position_rows start = rows(a), end = rows(b);
    const ipc::CollisionMesh mesh(start, e, f);
    ipc::Candidates candidates;
    candidates.build(mesh, start, end, 0);
    std::printf("%zu face-vertex and %zu edge-edge pairs collide; free: %.17g\n", candidates.fv_candidates.size(),
                candidates.ee_candidates.size(), candidates.compute_collision_free_stepsize(mesh, start, end));
}

int main(int argc, char** argv) try {
    argc == 3 ? frames(argv[1], argv[2]) : two_sheets();
} catch (const std::exception& e) {
    std::fprintf(stderr, "ipc_glue: %s\n", e.what());
    return 1;
}
