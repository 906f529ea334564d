// SPDX-License-Identifier: MIT
#pragma once

// Stands in for the part of the IPC Toolkit that finds candidates and free steps of a mesh with itself: its names, by abut.
// docs/drop-in.md says what is the same and what is not. Matrices are of any type that has rows() and m(row, column), as those
// of Eigen have. Nothing of the toolkit or of Eigen is needed.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <abut/abut.hpp>

namespace ipc_glue {

/// Faces, and the edges that a caller has numbered; each of them is one of a face.
class CollisionMesh {
public:
    /// rest_positions, n x 3, counts vertices; edges is m x 2, faces k x 3.
    template <class Positions, class Edges, class Faces>
    CollisionMesh(const Positions& rest_positions, const Edges& edges, const Faces& faces)
        : vertices_(static_cast<std::size_t>(rest_positions.rows())) {
        for (int f = 0; f < faces.rows(); ++f) {
            faces_.push_back({id(faces, "face", f, 0), id(faces, "face", f, 1), id(faces, "face", f, 2)});
            numbers_of_faces_.emplace(faces_.back(), f);
        }
        std::vector<std::array<std::uint32_t, 2>> of_faces;
        for (const auto& f : faces_) {
            for (std::size_t k = 0; k < 3; ++k) of_faces.push_back(in_order(f[k], f[(k + 1) % 3]));
        }
        std::sort(of_faces.begin(), of_faces.end());
        for (int e = 0; e < edges.rows(); ++e) {
            const auto ends = in_order(id(edges, "edge", e, 0), id(edges, "edge", e, 1));
            if (!std::binary_search(of_faces.begin(), of_faces.end(), ends)) {
                throw std::invalid_argument("ipc_glue::CollisionMesh: edge " + std::to_string(e) + " is of no face");
            }
            numbers_of_edges_.emplace(ends, e);
        }
        for (const auto& ends : of_faces) {
            if (!numbers_of_edges_.contains(ends)) {
                throw std::invalid_argument("ipc_glue::CollisionMesh: the edge of vertices " + std::to_string(ends[0]) + " and " +
                                            std::to_string(ends[1]) + " is not among the edges");
            }
        }
    }

    [[nodiscard]] std::size_t num_vertices() const { return vertices_; }
    [[nodiscard]] std::size_t num_edges() const { return numbers_of_edges_.size(); }
    [[nodiscard]] std::size_t num_faces() const { return faces_.size(); }

    [[nodiscard]] int edge(std::uint32_t a, std::uint32_t b) const { return numbers_of_edges_.at(in_order(a, b)); }
    [[nodiscard]] int face(const std::array<std::uint32_t, 3>& corners) const { return numbers_of_faces_.at(corners); }

    /// Where the mesh is.
    template <class Positions>
    [[nodiscard]] abut::mesh<double> at(const Positions& positions) const {
        return {points(positions), faces_};
    }
    /// How it goes from one place to another.
    template <class From, class To>
    [[nodiscard]] auto moving(const From& from, const To& to) const {
        const abut::mesh<double> start = at(from);
        return abut::moving(start, start.with_vertices(abut::openmp{}, points(to)));
    }

private:
    static std::array<std::uint32_t, 2> in_order(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
    template <class Numbers>
    [[nodiscard]] std::uint32_t id(const Numbers& of, const char* what, int row, int column) const {
        const auto v = of(row, column);
        if (v < 0 || static_cast<std::size_t>(v) >= vertices_) {
            throw std::invalid_argument("ipc_glue::CollisionMesh: " + std::string(what) + " " + std::to_string(row) + " has vertex " +
                                        std::to_string(v) + " of " + std::to_string(vertices_));
        }
        return static_cast<std::uint32_t>(v);
    }
    template <class Positions>
    [[nodiscard]] std::vector<abut::vec3<double>> points(const Positions& positions) const {
        if (static_cast<std::size_t>(positions.rows()) != vertices_) {
            throw std::invalid_argument("ipc_glue::CollisionMesh: " + std::to_string(positions.rows()) + " positions of " +
                                        std::to_string(vertices_) + " vertices");
        }
        std::vector<abut::vec3<double>> p;
        for (int i = 0; i < positions.rows(); ++i) p.push_back({positions(i, 0), positions(i, 1), positions(i, 2)});
        return p;
    }

    std::size_t vertices_;
    std::vector<abut::face> faces_;
    std::map<std::array<std::uint32_t, 2>, int> numbers_of_edges_;
    std::map<std::array<std::uint32_t, 3>, int> numbers_of_faces_;
};

struct EdgeEdgeCandidate {
    int edge0_id, edge1_id;
    friend bool operator==(const EdgeEdgeCandidate&, const EdgeEdgeCandidate&) = default;
};
struct FaceVertexCandidate {
    int face_id, vertex_id;
    friend bool operator==(const FaceVertexCandidate&, const FaceVertexCandidate&) = default;
};

/// The bounds that a step with a distance to keep is asked with.
inline abut::conservative_bounds bounds_of(double min_distance) { return {.tolerance = 1e-4, .separation = min_distance}; }

/// How much of a step is free, from 0 to 1, with at least that distance kept; without one all of it is exact.
template <class From, class To>
double compute_collision_free_stepsize(const CollisionMesh& mesh, const From& vertices_t0, const To& vertices_t1,
                                       double min_distance = 0) {
    return abut::safe_self_step(abut::openmp{}, mesh.moving(vertices_t0, vertices_t1), bounds_of(min_distance));
}
template <class From, class To>
bool is_step_collision_free(const CollisionMesh& mesh, const From& vertices_t0, const To& vertices_t1, double min_distance = 0) {
    return compute_collision_free_stepsize(mesh, vertices_t0, vertices_t1, min_distance) == 1;
}
/// Whether faces pass through each other. Those that only touch in what they share do not.
template <class Positions>
bool has_intersections(const CollisionMesh& mesh, const Positions& vertices) {
    return abut::count_self_pairs(abut::openmp{}, mesh.at(vertices)) > 0;
}

/// Pairs of features that may collide. Those that share a vertex are never there.
class Candidates {
public:
    std::vector<EdgeEdgeCandidate> ee_candidates;
    std::vector<FaceVertexCandidate> fv_candidates;

    [[nodiscard]] std::size_t size() const { return ee_candidates.size() + fv_candidates.size(); }
    void clear() {
        ee_candidates.clear();
        fv_candidates.clear();
    }

    /// Those no farther apart than twice the radius: decided exactly, so there are none in vain.
    template <class Positions>
    void build(const CollisionMesh& mesh, const Positions& vertices, double inflation_radius) {
        clear();
        const abut::openmp on;
        const abut::mesh<double> at = mesh.at(vertices);
        const auto corners = at.view().faces;
        abut::query_options<no_corner> apart;
        apart.filter = {corners};
        for (const auto [v, f] : abut::to_host(abut::within(on, abut::vertices(at), abut::make_bvh(on, at), 2 * inflation_radius, apart))) {
            fv_candidates.push_back({static_cast<int>(f), static_cast<int>(v)});
        }
        const auto edges = abut::edges(on, at);
        const auto ends = edges.view().edges;
        abut::query_options<no_common_end> unlinked;
        unlinked.filter = {ends};
        for (const auto [a, b] : abut::to_host(abut::self_within(on, abut::make_bvh(on, edges), 2 * inflation_radius, unlinked))) {
            ee_candidates.push_back({mesh.edge(ends[a][0], ends[a][1]), mesh.edge(ends[b][0], ends[b][1])});
        }
    }
    /// Those that touch on the way from t0 to t1, decided exactly; with a radius those that come nearer than twice that, and
    /// few others.
    template <class From, class To>
    void build(const CollisionMesh& mesh, const From& vertices_t0, const To& vertices_t1, double inflation_radius) {
        clear();
        const abut::openmp on;
        const auto step = mesh.moving(vertices_t0, vertices_t1);
        const auto add = [&](const auto& found) {
            for (const auto& i : abut::to_host(found)) {
                const auto& v = i.vertices;
                if (i.kind == abut::feature_pair::vertex_face) {
                    fv_candidates.push_back({mesh.face({v[1], v[2], v[3]}), static_cast<int>(v[0])});
                } else {
                    ee_candidates.push_back({mesh.edge(v[0], v[1]), mesh.edge(v[2], v[3])});
                }
            }
        };
        if (inflation_radius == 0) {
            add(abut::self_impacts(on, step));
        } else {
            add(abut::self_impacts<abut::conservative>(on, step, {.bounds = bounds_of(2 * inflation_radius)}));
        }
    }
    /// Of the whole mesh: what is no candidate of the step does not collide in it.
    template <class From, class To>
    [[nodiscard]] double compute_collision_free_stepsize(const CollisionMesh& mesh, const From& vertices_t0, const To& vertices_t1,
                                                         double min_distance = 0) const {
        return ipc_glue::compute_collision_free_stepsize(mesh, vertices_t0, vertices_t1, min_distance);
    }
    template <class From, class To>
    [[nodiscard]] bool is_step_collision_free(const CollisionMesh& mesh, const From& vertices_t0, const To& vertices_t1,
                                              double min_distance = 0) const {
        return ipc_glue::is_step_collision_free(mesh, vertices_t0, vertices_t1, min_distance);
    }

private:
    using face_array = decltype(std::declval<abut::mesh<double>>().view().faces);
    using edge_array = decltype(abut::edges(abut::openmp{}, std::declval<abut::mesh<double>>()).view().edges);
    struct no_corner {
        face_array faces;
        bool operator()(std::uint32_t v, std::uint32_t f) const {
            return faces[f][0] != v && faces[f][1] != v && faces[f][2] != v;
        }
    };
    struct no_common_end {
        edge_array edges;
        bool operator()(std::uint32_t a, std::uint32_t b) const {
            const auto &e = edges[a], &f = edges[b];
            return e[0] != f[0] && e[0] != f[1] && e[1] != f[0] && e[1] != f[1];
        }
    };
};

}  // namespace ipc_glue
