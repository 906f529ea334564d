// SPDX-License-Identifier: MIT
#pragma once

// vertices, edges: a mesh's vertices and its edges as sets of their own, for queries and indices. A shape's id is its
// position in the set: of vertex i the number i by which faces name it, of edge i its place in the order of edges.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

/// Writes the sides of face f, all in one direction.
struct write_sides {
    strided<face> faces;
    half_edge_key key;
    std::uint64_t* keys;
    ABUT_HD void operator()(std::size_t f) const {
        const corner_ids c = corners_of(faces, f);
        keys[3 * f] = key.pack(c.of[0], c.of[1], 0) & key.edge_mask();
        keys[3 * f + 1] = key.pack(c.of[1], c.of[2], 0) & key.edge_mask();
        keys[3 * f + 2] = key.pack(c.of[2], c.of[0], 0) & key.edge_mask();
    }
};

/// Whether side i, of sides in order, is the first of its edge. A side between a vertex and itself is none.
struct starts_edge {
    half_edge_key key;
    const std::uint64_t* keys;
    ABUT_HD bool operator()(std::size_t i) const {
        return key.lower(keys[i]) != key.upper(keys[i]) && (i == 0 || keys[i - 1] != keys[i]);
    }
};

struct write_edge {
    half_edge_key key;
    const std::uint64_t* keys;
    const std::uint32_t* first;
    edge* edges;
    ABUT_HD void operator()(std::size_t k) const {
        auto* const end = reinterpret_cast<std::uint32_t*>(edges + k);
        end[0] = key.lower(keys[first[k]]);
        end[1] = key.upper(keys[first[k]]);
    }
};

/// The edges of a mesh that has been checked, in order.
template <class Policy, scalar T, memory_space Space>
execution::buffer_of<Policy, edge> unique_edges(const Policy& on, const mesh_view<T, Space>& mesh) {
    const std::size_t sides = 3 * mesh.size(), vertices = mesh.vertices.count;
    const half_edge_key key{bits_up_to(vertices > 0 ? vertices - 1 : 0)};
    execution::buffer_of<Policy, std::uint64_t> keys(on, sides);
    for_each_index(on, mesh.size(), write_sides{mesh.faces, key, keys.data()});
    sort_keys(on, keys, 2 * key.vertex_bits);
    execution::buffer_of<Policy, std::uint32_t> first(on, sides);
    const std::size_t count = compact(on, sides, starts_edge{key, keys.data()}, first.data());
    check_count(count, "abut::edges");
    execution::buffer_of<Policy, edge> edges(on, count);
    for_each_index(on, count, write_edge{key, keys.data(), first.data(), edges.data()});
    synchronize(on);
    return edges;
}

template <scalar T>
struct copy_vertex {
    strided<vec3<T>> from;
    vec3<T>* to;
    ABUT_HD void operator()(std::size_t i) const { to[i] = from[i]; }
};

}  // namespace detail

/// @addtogroup sets
///@{

/// All vertices of a mesh, those of no face too. Shares the mesh's storage: nothing is copied, checked or thrown.
template <scalar T, memory_space Space>
[[nodiscard]] points<T, Space> vertices(const mesh<T, Space>& mesh) {
    return detail::set_parts::vertices_of(mesh);
}
/// And of a view, as a view over the same array.
template <scalar T, memory_space Space>
[[nodiscard]] points_view<T, Space> vertices(const mesh_view<T, Space>& mesh) {
    return {mesh.vertices.first(), mesh.vertices.count, mesh.vertices.stride};
}

/// The edges of a mesh as an edge_mesh in the policy's memory: each pair of vertices that a face joins once, the smaller
/// first, in ascending order; `edges(on, mesh).view().edges[i]` tells the two of edge i. A side of a face that names one
/// vertex twice is no edge, but its other sides are: all faces count here, where `validate` passes some over.
///
/// Shares the mesh's vertices, where the mesh lies in the policy's memory. Returns when the edges are there; scratch takes
/// up to 60 bytes a face. The order is the same on every policy. Throws capacity_error for more than 1,431,655,765 faces
/// or for 2^31 edges, std::bad_alloc and cuda_error.
///
///     const auto rim = abut::edges(on, mesh);
///     for (const auto [i, f] : to_host(abut::pairs(on, rim, abut::make_bvh(on, other)))) use(rim.view().edges[i], f);
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] edge_mesh<T, space_of<Policy>> edges(const Policy& on, const mesh<T, Space>& mesh) {
    static_assert(std::same_as<Space, space_of<Policy>> || std::same_as<Space, host_space>,
                  "abut: a host policy cannot read a set in device memory; copy_to(policy, set) brings it over");
    detail::check_sides(mesh.size(), "abut::edges");
    const auto resident = mesh.copied_to(on);
    return detail::set_parts::edge_mesh_of(vertices(resident), detail::unique_edges(on, resident.view()));
}
/// Of a view, which is checked: throws invalid_geometry as queries do. The result has a copy of the vertices. Where vertices
/// move and faces stay, edge_mesh_view reads these edges over other vertices.
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] edge_mesh<T, Space> edges(const Policy& on, const mesh_view<T, Space>& mesh) {
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: this view is over other memory than the policy works in; make a set of it first");
    detail::check_sides(mesh.size(), "abut::edges");
    detail::check(on, mesh, "abut::edges");
    execution::buffer_of<Policy, vec3<T>> copy(on, mesh.vertices.count);
    for_each_index(on, copy.size(), detail::copy_vertex<T>{mesh.vertices, copy.data()});
    return detail::set_parts::edge_mesh_of(detail::set_parts::shapes_of(std::move(copy)), detail::unique_edges(on, mesh));
}
/// Of a mesh or a view in host memory, on the calling thread.
///@{
template <scalar T>
[[nodiscard]] edge_mesh<T> edges(const mesh<T>& mesh) {
    return edges(serial{}, mesh);
}
template <scalar T>
[[nodiscard]] edge_mesh<T> edges(const mesh_view<T>& mesh) {
    return edges(serial{}, mesh);
}
///@}

///@}

}  // namespace abut
