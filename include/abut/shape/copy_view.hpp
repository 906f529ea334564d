// SPDX-License-Identifier: MIT
#pragma once

// copy_to of a view: the set that owns a copy of what the view sees. And how the library makes sets of parts that it has
// checked.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/hulls.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

/// What the library makes of parts that it has checked.
struct set_parts {
    template <scalar T, memory_space Space>
    static points<T, Space> vertices_of(const mesh<T, Space>& mesh) {
        points<T, Space> all;
        all.values_ = mesh.vertices_;
        return all;
    }
    template <scalar T, memory_space Space>
    static edge_mesh<T, Space> edge_mesh_of(const points<T, Space>& vertices, execution::buffer<edge, Space> edges) {
        edge_mesh<T, Space> made;
        made.vertices_ = vertices.values_;
        made.elements_ = shared_array<edge, Space>(std::move(edges));
        return made;
    }
    /// The same faces or edges over other vertices.
    template <shape_view View>
    static indexed_set<View> with_points(const indexed_set<View>& elements,
                                         const points<typename View::scalar_type, typename View::memory_space>& vertices) {
        indexed_set<View> made;
        made.vertices_ = vertices.values_;
        made.elements_ = elements.elements_;
        return made;
    }
    /// The faces or edges of a set, wherever it lies. Waits for the copy.
    template <class Set>
    static auto elements_to_host(const Set& set) {
        return set.elements_.to_host();
    }
    template <scalar T, memory_space Space>
    static mesh<T, Space> mesh_of(execution::buffer<vec3<T>, Space> vertices, execution::buffer<face, Space> faces) {
        mesh<T, Space> made;
        made.vertices_ = shared_array<vec3<T>, Space>(std::move(vertices));
        made.elements_ = shared_array<face, Space>(std::move(faces));
        return made;
    }
    template <shape Shape, memory_space Space>
    static shapes<Shape, Space> shapes_of(execution::buffer<Shape, Space> values) {
        shapes<Shape, Space> made;
        made.values_ = shared_array<Shape, Space>(std::move(values));
        return made;
    }
    template <scalar T, memory_space Space>
    static hulls<T, Space> hulls_of(execution::buffer<vec3<T>, Space> points,
                                    execution::buffer<std::uint32_t, Space> offsets,
                                    execution::buffer<std::uint32_t, Space> edges = {}) {
        hulls<T, Space> made;
        made.points_ = shared_array<vec3<T>, Space>(std::move(points));
        made.offsets_ = shared_array<std::uint32_t, Space>(std::move(offsets));
        made.edges_ = shared_array<std::uint32_t, Space>(std::move(edges));
        return made;
    }
    /// The same hulls with edges, as collide/hull_edges.hpp has them.
    template <scalar T>
    static hulls<T> with_edges(hulls<T> set, std::span<const std::uint32_t> edges) {
        set.edges_ = shared_array<std::uint32_t, host_space>(serial{}, edges);
        return set;
    }
    template <scalar T, memory_space Space>
    static equal_spheres<T, Space> equal_spheres_of(execution::buffer<vec3<T>, Space> centers, T radius) {
        equal_spheres<T, Space> made;
        made.centers_ = shared_array<vec3<T>, Space>(std::move(centers));
        made.radius_ = radius;
        return made;
    }
};

template <class Elements, class T>
struct copy_element {
    Elements from;
    T* to;
    ABUT_HD void operator()(std::size_t i) const { to[i] = from[i]; }
};

/// Elements of a view one after another.
template <class T, class Policy, class Elements>
execution::buffer_of<Policy, T> side_by_side(const Policy& on, const Elements& from, std::size_t n) {
    execution::buffer_of<Policy, T> to(on, n);
    for_each_index(on, n, copy_element<Elements, T>{from, to.data()});
    return to;
}

/// The set of a view that has been checked, in the same memory.
template <class Policy, shape_view View>
auto set_of(const Policy& on, const View& view) {
    using T = typename View::scalar_type;
    using space = space_of<Policy>;
    if constexpr (requires { requires std::same_as<decltype(view.faces), strided<face>>; }) {
        return set_parts::mesh_of<T, space>(side_by_side<vec3<T>>(on, view.vertices, view.vertices.count),
                                            side_by_side<face>(on, view.faces, view.faces.count));
    } else if constexpr (requires { requires std::same_as<decltype(view.edges), strided<edge>>; }) {
        const auto vertices =
            set_parts::shapes_of<vec3<T>, space>(side_by_side<vec3<T>>(on, view.vertices, view.vertices.count));
        return set_parts::edge_mesh_of(vertices, side_by_side<edge>(on, view.edges, view.edges.count));
    } else if constexpr (std::same_as<View, hulls_view<T, space>>) {
        return set_parts::hulls_of<T, space>(side_by_side<vec3<T>>(on, view.points, view.points.count),
                                             side_by_side<std::uint32_t>(on, view.offsets, view.offsets.count),
                                             side_by_side<std::uint32_t>(on, view.edges, view.edges.count));
    } else if constexpr (std::same_as<View, equal_spheres_view<T, space>>) {
        return set_parts::equal_spheres_of<T, space>(side_by_side<vec3<T>>(on, view.centers, view.centers.count),
                                                     view.radius);
    } else {
        using shape_type = typename View::shape_type;
        return set_parts::shapes_of<shape_type, space>(side_by_side<shape_type>(on, view, view.size()));
    }
}

}  // namespace detail

/// @addtogroup sets
///@{

/// A set in the memory of `to` that owns a copy of what a view sees: a mesh of a mesh_view or an xyz_mesh_view, and so on;
/// of other views `shapes`, each with all its numbers. Data in device memory stays on its device. The view is over memory of
/// `to`, or of the host. Checks the elements first, as a set's constructor does, and throws as that; returns when the copy
/// is done.
template <execution_policy Policy, shape_view View>
[[nodiscard]] auto copy_to(const Policy& to, const View& view) {
    using space = typename View::memory_space;
    static_assert(
        std::same_as<space, space_of<Policy>> || std::same_as<space, host_space>,
        "abut: a host policy cannot read a view in device memory; make a set of it there, with a policy of the device");
    if constexpr (std::same_as<space, space_of<Policy>>) {
        detail::check(to, view, "abut::copy_to");
        auto set = detail::set_of(to, view);
        synchronize(to);
        return set;
    } else {
        return copy_to(to, copy_to(serial{}, view));
    }
}

///@}

}  // namespace abut
