// SPDX-License-Identifier: MIT
#pragma once

// Pieces of a mesh in motion, as one rank or device hands them to another: some of its faces with their vertices, and
// vertices by themselves, in their order in the mesh. So features of a piece have the order of those of the mesh.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/impact_index.hpp>
#include <abut/collide/parts.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/shape/motion.hpp>

namespace abut::detail {

template <scalar T, memory_space Space>
moving_set<mesh<T, Space>> mesh_in_motion(const mesh<T, Space>& at_rest) {
    return {at_rest, at_rest};
}
template <scalar T, memory_space Space>
moving_set<mesh<T, Space>> mesh_in_motion(const moving_set<mesh<T, Space>>& set) {
    return set;
}
template <class Index>
    requires is_impact_index<Index>
auto mesh_in_motion(const Index& index) { return index.mesh(); }

/// The boxes of a part during the step, `size` being that of its vertices, which faces may have or not.
template <class Policy, scalar T, memory_space Space>
part_bounds<T> bounds_of_mesh_part(const Policy& on, const moving_set<mesh<T, Space>>& mesh) {
    part_bounds<T> part = bounds_of_part(on, vertices(mesh).view());
    const part_bounds<T> of_faces = bounds_of_part(on, mesh.view());
    for (std::size_t k = 0; k < part_boxes; ++k) part.groups[k] = merge(part.groups[k], of_faces.groups[k]);
    return part;
}

template <class Test>
struct mark_vertices {
    Test wanted;
    std::uint32_t* marks;
    ABUT_HD void operator()(std::size_t i) const { marks[i] = wanted(i) ? 1 : 0; }
};
template <class Test>
struct mark_corners {
    Test wanted;
    strided<face> faces;
    std::uint32_t* marks;
    ABUT_HD void operator()(std::size_t i) const {
        if (!wanted(i)) return;
        const std::uint32_t* const corner = corners_at(faces, i);
        for (int k = 0; k < 3; ++k) execution::atomic_store(marks + corner[k], 1);
    }
};
struct is_marked {
    const std::uint32_t* marks;
    ABUT_HD bool operator()(std::size_t i) const { return marks[i] != 0; }
};
struct pack_face {
    strided<face> faces;
    const std::uint32_t *ids, *numbers;  ///< of faces; of vertices in the piece
    face* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t* const corner = corners_at(faces, ids[i]);
        auto* const to = reinterpret_cast<std::uint32_t*>(out + i);
        for (int k = 0; k < 3; ++k) to[k] = numbers[corner[k]];
    }
};

/// Where a piece is written, in the policy's memory.
template <scalar T>
struct piece_arrays {
    vec3<T>*at_t0, *at_t1;
    std::uint32_t* vertex_ids;
    face* faces;
    std::uint32_t* face_ids;
};

/// Pieces of a mesh, one after another. face(i) and vertex(i) tell of each whether its face or its vertex i is wanted; a
/// face brings its vertices along.
template <class Policy, scalar T>
class mesh_pieces {
public:
    using space = space_of<Policy>;
    using mesh_type = moving_set<mesh<T, space>>;
    using sizes = std::array<std::uint64_t, 2>;  ///< of vertices, of faces

    mesh_pieces(const Policy& policy, mesh_type mesh) : on_(policy), mesh_(std::move(mesh)) {}

    template <class Face, class Vertex>
    [[nodiscard]] sizes count(const Face& face, const Vertex& vertex) {
        mark(face, vertex);
        sizes size{};
        size[0] = reduce(on_, vertex_count(), std::uint64_t{0}, add_up_tallies{}, one_if<is_marked>{{marks_.data()}});
        size[1] = reduce(on_, mesh_.size(), std::uint64_t{0}, add_up_tallies{}, one_if<Face>{face});
        return size;
    }
    /// As many as have been counted.
    template <class Face, class Vertex>
    void write(const Face& face, const Vertex& vertex, const piece_arrays<T>& out) {
        const auto at_t0 = vertices(mesh_.t0()).view(), at_t1 = vertices(mesh_.t1()).view();
        using points_type = std::remove_const_t<decltype(at_t0)>;
        mark(face, vertex);
        const std::size_t n = compact(on_, vertex_count(), is_marked{marks_.data()}, out.vertex_ids);
        exclusive_scan(on_, marks_.data(), vertex_count());  // marks become numbers
        const std::size_t m = compact(on_, mesh_.size(), face, out.face_ids);
        for_each_index(on_, m, pack_face{faces(), out.face_ids, marks_.data(), out.faces});
        for_each_index(on_, n, pack_shape<points_type>{at_t0, out.vertex_ids, out.at_t0});
        for_each_index(on_, n, pack_shape<points_type>{at_t1, out.vertex_ids, out.at_t1});
    }
    /// What comes near a part of another mesh.
    ///@{
    [[nodiscard]] sizes count_near(const part_bounds<T>& there) { return count(near_faces(there), near_vertices(there)); }
    void write_near(const part_bounds<T>& there, const piece_arrays<T>& out) {
        write(near_faces(there), near_vertices(there), out);
    }
    ///@}

private:
    [[nodiscard]] std::size_t vertex_count() const { return mesh_.t0().view().vertices.count; }
    [[nodiscard]] strided<face> faces() const { return mesh_.t0().view().faces; }
    [[nodiscard]] auto near_faces(const part_bounds<T>& there) const {
        return comes_near<typename mesh_type::view_type, part_bounds<T>>{mesh_.view(), there};
    }
    [[nodiscard]] auto near_vertices(const part_bounds<T>& there) const {
        const auto points = vertices(mesh_).view();
        return comes_near<std::remove_const_t<decltype(points)>, part_bounds<T>>{points, there};
    }
    /// The vertices of a piece.
    template <class Face, class Vertex>
    void mark(const Face& face, const Vertex& vertex) {
        if (marks_.size() == 0) marks_ = execution::buffer_of<Policy, std::uint32_t>(on_, vertex_count() + 1);
        for_each_index(on_, vertex_count(), mark_vertices<Vertex>{vertex, marks_.data()});
        for_each_index(on_, mesh_.size(), mark_corners<Face>{face, faces(), marks_.data()});
    }

    const Policy& on_;
    mesh_type mesh_;
    execution::buffer_of<Policy, std::uint32_t> marks_;
};

}  // namespace abut::detail
