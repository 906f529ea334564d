// SPDX-License-Identifier: MIT
#pragma once

// welded: a mesh in which vertices in one place are one. For meshes that were written a patch or a triangle at a time, which
// to queries that go by the vertices' numbers are open all over. Only equal coordinates count: nothing is moved, and no
// tolerance is taken.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/equal_elements.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

/// to[i[k]] = value[k]
struct scatter_ids {
    const std::uint32_t *at, *value;
    std::uint32_t* to;
    ABUT_HD void operator()(std::size_t k) const { to[at[k]] = value[k]; }
};
/// Whether a vertex is the first in its place.
struct is_first_in_place {
    const std::uint32_t* first;
    ABUT_HD bool operator()(std::size_t i) const { return first[i] == i; }
};
/// Moves the vertices that stay up, and notes where they went.
template <scalar T>
struct move_kept_vertex {
    strided<vec3<T>> from;
    const std::uint32_t* kept;
    std::uint32_t* number;
    vec3<T>* to;
    ABUT_HD void operator()(std::size_t k) const {
        number[kept[k]] = static_cast<std::uint32_t>(k);
        to[k] = from[kept[k]];
    }
};
struct renumber_face {
    strided<face> from;
    const std::uint32_t *first, *number;
    face* to;
    ABUT_HD void operator()(std::size_t f) const {
        const corner_ids c = corners_of(from, f);
        auto* const corner = reinterpret_cast<std::uint32_t*>(to + f);
        for (int k = 0; k < 3; ++k) corner[k] = number[first[c.of[k]]];
    }
};

/// The welded mesh of a view that has been checked.
template <class Policy, scalar T, memory_space Space>
mesh<T, Space> weld(const Policy& on, const mesh_view<T, Space>& mesh) {
    const auto repeated = find_repeated_places(on, mesh.vertices);
    const std::size_t n = mesh.vertices.count;
    id_buffer<Policy> first(on, n), kept(on, n), number(on, n);
    for_each_index(on, n, execution::write_index<std::uint32_t>{first.data()});
    for_each_index(on, repeated.later.size(), scatter_ids{repeated.later.data(), repeated.first.data(), first.data()});
    kept.shrink(compact(on, n, is_first_in_place{first.data()}, kept.data()));
    execution::buffer_of<Policy, vec3<T>> vertices(on, kept.size());
    execution::buffer_of<Policy, face> faces(on, mesh.size());
    for_each_index(on, kept.size(), move_kept_vertex<T>{mesh.vertices, kept.data(), number.data(), vertices.data()});
    for_each_index(on, faces.size(), renumber_face{mesh.faces, first.data(), number.data(), faces.data()});
    synchronize(on);
    return set_parts::mesh_of(std::move(vertices), std::move(faces));
}

}  // namespace detail

/// @addtogroup sets
///@{

/// The same mesh with one vertex for each place, in the policy's memory. Of vertices with equal coordinates (-0.0 equals
/// 0.0) the one with the least index stays. Vertices keep their order, those of no face too. Faces keep theirs and name the
/// vertices that stayed. A face whose corners were in one place names one twice, and is kept, so that ids of faces mean what
/// they meant. The same on every policy.
///
/// Scratch takes up to 60 bytes a vertex. Throws std::bad_alloc and cuda_error.
///
///     const auto pairs = abut::self_pairs(on, abut::make_bvh(on, abut::welded(on, mesh)));
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] mesh<T, space_of<Policy>> welded(const Policy& on, const mesh<T, Space>& mesh) {
    static_assert(std::same_as<Space, space_of<Policy>> || std::same_as<Space, host_space>,
                  "abut: a host policy cannot read a set in device memory; copy_to(policy, set) brings it over");
    const auto resident = mesh.copied_to(on);
    return detail::weld(on, resident.view());
}
/// Of a view, which is checked: throws invalid_geometry as queries do.
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] mesh<T, Space> welded(const Policy& on, const mesh_view<T, Space>& mesh) {
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: this view is over other memory than the policy works in; make a set of it first");
    detail::check(on, mesh, "abut::welded");
    return detail::weld(on, mesh);
}

///@}

}  // namespace abut
