// SPDX-License-Identifier: MIT
#pragma once

// Sets of shapes that own their memory. Views of the caller's arrays are in view.hpp.

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/rows.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

/// An immutable array in a memory space, shared by its copies.
template <class T, memory_space Space>
class shared_array {
public:
    shared_array() = default;
    template <execution_policy Policy>
    shared_array(const Policy& policy, std::span<const T> values) {
        auto fresh = std::make_shared<execution::buffer<T, Space>>(policy, values.size());
        upload(policy, values.data(), values.size(), fresh->data());
        values_ = std::move(fresh);
    }
    explicit shared_array(execution::buffer<T, Space> values)
        : values_(std::make_shared<const execution::buffer<T, Space>>(std::move(values))) {}

    [[nodiscard]] const T* data() const { return values_ ? values_->data() : nullptr; }
    [[nodiscard]] std::size_t size() const { return values_ ? values_->size() : 0; }
    [[nodiscard]] int device() const { return values_ ? values_->device() : -1; }

    /// In the memory of `to`: this array itself if it lies there already, otherwise a copy. Waits for it.
    template <execution_policy Policy>
    [[nodiscard]] shared_array<T, space_of<Policy>> copied_to(const Policy& to) const {
        if constexpr (std::same_as<space_of<Policy>, Space>) {
            if (size() == 0 || device() == device_of(to)) return *this;
        }
        const std::vector<T> values = to_host();
        shared_array<T, space_of<Policy>> copy(to, values);
        synchronize(to);
        return copy;
    }
    /// Waits for the copy.
    [[nodiscard]] std::vector<T> to_host() const {
        std::vector<T> values(size());
        if (values_) values_->read(values.data());
        return values;
    }

private:
    std::shared_ptr<const execution::buffer<T, Space>> values_;
};

/// What stands in braces, for as long as the call lasts that they are written in.
template <class S>
constexpr std::span<const S> span_of(std::initializer_list<S> values) {
    return {values.begin(), values.size()};
}

/// Makes sets of arrays that have been checked, and takes such arrays out (shape/features.hpp).
struct set_parts;

/// Shape i of a set is make(i).
template <class Shape, class Make>
struct put_shape {
    Make make;
    Shape* to;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const { to[i] = make(i); }
};

}  // namespace detail

/// @defgroup sets Sets
///
/// What queries ask about. `shapes<Shape>` holds shapes as they are: `triangle_soup`, `spheres`, `points`, `segments`,
/// `capsules`, `cylinders`, `cones`, `boxes` and `oriented_boxes` are its names for the library's own. `equal_spheres` shares
/// a radius, `mesh` and `edge_mesh` share vertices. `vertices`, `edges` and `welded` make sets of a mesh. A shape's id is its
/// position in the set, from 0. A set is checked when it is made and never changes after that. Empty sets are legal.
///
/// @par Memory
/// A constructor copies its input from host memory to that of the policy, or to the host's where no policy is given. Input
/// is vectors and spans of the library's types, or another library's array of the same numbers (shape/rows.hpp). Copies of a
/// set share the storage, which lives as long as a set or an index uses it. `copy_to` brings a set to another memory. Under
/// `cuda` the stream that it was made in has to outlive it.
///
/// @par Errors
/// - `invalid_geometry`, with the index and the value of the first bad element: a coordinate is not finite, a radius is
///   negative, a vertex index is out of range, a box is inside out.
/// - `error`: plain numbers of another library's array are no multiple of what a shape takes, or its elements only point to
///   their numbers; `with_vertices` got another number of vertices.
/// - `capacity_error`: there are 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Each constructor and function returns when its set is complete and checked; under `cuda` it waits for the policy's
/// stream. Then any stream of that device may read it.
///
/// @par Example
/// @snippet sets.cpp sets
///@{

/// Shapes as they are, each with all its numbers: the library's own, or the caller's (docs/extending.md).
template <shape Shape, memory_space Space = host_space>
class shapes {
public:
    using scalar_type = scalar_type_of<Shape>;    ///< float or double
    using shape_type = Shape;                     ///< what a shape is
    using memory_space = Space;                   ///< where the memory lies
    using view_type = shapes_view<Shape, Space>;  ///< what algorithms read

    /// Without shapes.
    shapes() = default;
    /// Of these shapes, in host memory.
    shapes(const std::vector<Shape>& values)
        requires std::same_as<Space, host_space>
        : shapes(serial{}, values) {}
    /// Of shapes written in braces: `rays<float>({{origin, direction}})`.
    shapes(std::initializer_list<Shape> values)
        requires std::same_as<Space, host_space>
        : shapes(serial{}, values) {}
    /// Of these shapes, which lie in host memory, in the policy's.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    shapes(const Policy& policy, std::span<const Shape> values) : values_(policy, values) {
        detail::check(policy, view(), detail::name_of<Shape>.set);
    }
    /// The same of shapes in braces.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    shapes(const Policy& policy, std::initializer_list<Shape> values) : shapes(policy, detail::span_of(values)) {}
    /// Of `count` shapes that are made where the policy works: shape i is make(i), for a std::size_t i, called for each
    /// concurrently. Under `cuda` it is a functor marked ABUT_HD, and nothing goes through host memory: for sets that are
    /// larger than it, or whose numbers lie on the device already.
    template <execution_policy Policy, class Make>
        requires(std::same_as<space_of<Policy>, Space> && std::is_invocable_r_v<Shape, const Make&, std::size_t>)
    shapes(const Policy& policy, std::size_t count, const Make& make) {
        require_callable(policy, make, std::size_t{});
        execution::buffer<Shape, Space> values(policy, count);
        for_each_index(policy, count, detail::put_shape<Shape, Make>{make, values.data()});
        values_ = detail::shared_array<Shape, Space>(std::move(values));
        detail::check(policy, view(), detail::name_of<Shape>.set);
    }
    /// Of another library's array: a container or a span of elements that hold the shape's numbers in the order of its
    /// members (std::array<T, 4> for a sphere: center and radius), or of the numbers themselves (shape/rows.hpp).
    template <detail::array_like R>
        requires std::same_as<Space, host_space>
    explicit shapes(const R& values) : shapes(serial{}, values) {}
    /// The same in the policy's memory. The array lies in host memory.
    template <execution_policy Policy, detail::array_like R>
        requires(std::same_as<space_of<Policy>, Space> && !std::convertible_to<const R&, std::span<const Shape>>)
    shapes(const Policy& policy, const R& values) {
        if constexpr (detail::is_row<Shape, detail::element_of<R>>()) {
            *this = shapes(policy, detail::rows_as<Shape>(values, detail::name_of<Shape>.set));
        }
    }

    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    /// What algorithms read; for as long as the set or a copy of it lives.
    [[nodiscard]] view_type view() const { return {values_.data(), values_.size()}; }
    /// The CUDA device that the memory lies on; -1 for the host, and of a default set.
    [[nodiscard]] int device() const { return values_.device(); }

    /// See `copy_to`.
    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        shapes<Shape, space_of<Policy>> copy;
        copy.values_ = values_.copied_to(to);
        return copy;
    }

private:
    template <shape, abut::memory_space>
    friend class shapes;
    friend detail::set_parts;

    detail::shared_array<Shape, Space> values_;
};

/// Triangles that share nothing, three vertices each.
template <scalar T, memory_space Space = host_space>
using triangle_soup = shapes<triangle<T>, Space>;
/// Solid spheres, each with its own radius.
template <scalar T, memory_space Space = host_space>
using spheres = shapes<sphere<T>, Space>;
/// Points, each a vec3.
template <scalar T, memory_space Space = host_space>
using points = shapes<vec3<T>, Space>;
/// Segments that share nothing, two ends each.
template <scalar T, memory_space Space = host_space>
using segments = shapes<segment<T>, Space>;
/// Solid capsules, each with its own radius.
template <scalar T, memory_space Space = host_space>
using capsules = shapes<capsule<T>, Space>;
/// Solid cylinders, each with its own radius.
template <scalar T, memory_space Space = host_space>
using cylinders = shapes<cylinder<T>, Space>;
/// Solid cones, each with its own radius.
template <scalar T, memory_space Space = host_space>
using cones = shapes<cone<T>, Space>;
/// Solid boxes along the axes.
template <scalar T, memory_space Space = host_space>
using boxes = shapes<aabb<T>, Space>;
/// Solid boxes in any direction.
template <scalar T, memory_space Space = host_space>
using oriented_boxes = shapes<oriented_box<T>, Space>;
/// Rays, each with its own origin and direction.
template <scalar T, memory_space Space = host_space>
using rays = shapes<ray<T>, Space>;

/// Solid spheres of one radius, which is stored once.
template <scalar T, memory_space Space = host_space>
class equal_spheres {
public:
    using scalar_type = T;                           ///< float or double
    using shape_type = sphere<T>;                    ///< what a shape is
    using memory_space = Space;                      ///< where the memory lies
    using view_type = equal_spheres_view<T, Space>;  ///< what algorithms read

    /// Without spheres.
    equal_spheres() = default;
    /// Of these centers and a radius of 0 or more, in host memory.
    equal_spheres(const std::vector<vec3<T>>& centers, T radius)
        requires std::same_as<Space, host_space>
        : equal_spheres(serial{}, centers, radius) {}
    /// Of these centers, which lie in host memory, in the policy's.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    equal_spheres(const Policy& policy, std::span<const vec3<T>> centers, T radius)
        : centers_(policy, centers), radius_(radius) {
        detail::check(policy, view(), "abut::equal_spheres");
    }
    /// The same of centers in braces.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    equal_spheres(const Policy& policy, std::initializer_list<vec3<T>> centers, T radius)
        : equal_spheres(policy, detail::span_of(centers), radius) {}
    /// Of another library's array of centers: of elements that hold three T, or of T itself.
    template <detail::array_like R>
        requires std::same_as<Space, host_space>
    equal_spheres(const R& centers, T radius) : equal_spheres(serial{}, centers, radius) {}
    /// The same in the policy's memory. The array lies in host memory.
    template <execution_policy Policy, detail::array_like R>
        requires(std::same_as<space_of<Policy>, Space> && !std::convertible_to<const R&, std::span<const vec3<T>>>)
    equal_spheres(const Policy& policy, const R& centers, T radius) {
        if constexpr (detail::is_row<vec3<T>, detail::element_of<R>>()) {
            *this = equal_spheres(policy, detail::rows_as<vec3<T>>(centers, "abut::equal_spheres"), radius);
        }
    }

    /// Number of spheres.
    [[nodiscard]] std::size_t size() const { return centers_.size(); }
    /// What algorithms read; for as long as the set or a copy of it lives.
    [[nodiscard]] view_type view() const { return {centers_.data(), centers_.size(), radius_}; }
    /// The CUDA device that the memory lies on; -1 for the host, and of a default set.
    [[nodiscard]] int device() const { return centers_.device(); }

    /// See `copy_to`.
    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        equal_spheres<T, space_of<Policy>> copy;
        copy.centers_ = centers_.copied_to(to);
        copy.radius_ = radius_;
        return copy;
    }

private:
    template <scalar, abut::memory_space>
    friend class equal_spheres;
    friend detail::set_parts;

    detail::shared_array<vec3<T>, Space> centers_;
    T radius_ = 0;
};

namespace detail {

/// What `indexed_set` has to know of a view: its elements, itself in other memory, and the set's name.
template <class View>
struct indexed_kind;
template <scalar T, memory_space Space>
struct indexed_kind<mesh_view<T, Space>> {
    using element = face;
    static constexpr const char* noun = "face";
    template <memory_space Other>
    using in = mesh_view<T, Other>;
    static constexpr const char* name = "abut::mesh";
};
template <scalar T, memory_space Space>
struct indexed_kind<edge_mesh_view<T, Space>> {
    using element = edge;
    static constexpr const char* noun = "edge";
    template <memory_space Other>
    using in = edge_mesh_view<T, Other>;
    static constexpr const char* name = "abut::edge_mesh";
};

}  // namespace detail

/// Shapes over shared vertices: a mesh or an edge_mesh, by its view.
template <shape_view View>
class indexed_set {
    using kind = detail::indexed_kind<View>;
    using element = typename kind::element;
    using vertex = vec3<typename View::scalar_type>;

public:
    using scalar_type = typename View::scalar_type;    ///< float or double
    using shape_type = typename View::shape_type;      ///< what a shape is
    using memory_space = typename View::memory_space;  ///< where the memory lies
    using view_type = View;                            ///< what algorithms read

    /// Without vertices and without faces or edges.
    indexed_set() = default;
    /// Of vertices, and of faces or edges that name them from 0, in host memory.
    indexed_set(const std::vector<vertex>& vertices, const std::vector<element>& elements)
        requires std::same_as<memory_space, host_space>
        : indexed_set(serial{}, vertices, elements) {}
    /// Of vertices, and of faces or edges, which lie in host memory, in the policy's.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, memory_space>
    indexed_set(const Policy& policy, std::span<const vertex> vertices, std::span<const element> elements)
        : vertices_(policy, vertices), elements_(policy, elements) {
        detail::check(policy, view(), kind::name);
    }
    /// The same of both, or of faces or edges, in braces.
    ///@{
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, memory_space>
    indexed_set(const Policy& policy, std::initializer_list<vertex> vertices, std::initializer_list<element> elements)
        : indexed_set(policy, detail::span_of(vertices), detail::span_of(elements)) {}
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, memory_space>
    indexed_set(const Policy& policy, std::span<const vertex> vertices, std::initializer_list<element> elements)
        : indexed_set(policy, vertices, detail::span_of(elements)) {}
    ///@}
    /// Of other libraries' arrays, containers or spans: of vertices that hold three T, or of T itself; of faces that hold
    /// three integers of any type (edges: two), or of integers. Negative indices are refused like those that are too large.
    template <detail::array_like V, detail::array_like E>
        requires std::same_as<memory_space, host_space>
    indexed_set(const V& vertices, const E& elements) : indexed_set(serial{}, vertices, elements) {}
    /// The same in the policy's memory. The arrays lie in host memory.
    template <execution_policy Policy, detail::array_like V, detail::array_like E>
        requires(std::same_as<space_of<Policy>, memory_space> && !(std::convertible_to<const V&, std::span<const vertex>> &&
                                                                   std::convertible_to<const E&, std::span<const element>>))
    indexed_set(const Policy& policy, const V& vertices, const E& elements) {
        constexpr std::size_t corners = std::tuple_size_v<element>;
        if constexpr (detail::is_row<vertex, detail::element_of<V>>() &&
                      detail::holds_indices<corners, detail::element_of<E>>()) {
            const auto points = detail::rows_as<vertex>(vertices, kind::name);
            if constexpr (std::same_as<detail::number_in<detail::element_of<E>>, std::uint32_t>) {
                *this = indexed_set(policy, points, detail::rows_as<element>(elements, kind::name));
            } else {
                const auto indices = detail::indices_of<corners>(elements, points.size(), kind::name, kind::noun);
                *this = indexed_set(policy, points, std::span<const element>(indices));
            }
        }
    }

    /// Number of faces or edges.
    [[nodiscard]] std::size_t size() const { return elements_.size(); }
    /// What algorithms read; for as long as the set or a copy of it lives.
    [[nodiscard]] view_type view() const {
        return {vertices_.data(), vertices_.size(), elements_.data(), elements_.size()};
    }
    /// The CUDA device that the memory lies on; -1 for the host, and of a default set.
    [[nodiscard]] int device() const { return elements_.device(); }

    /// A set with the same faces or edges, whose storage it shares, over other vertices, as many: where a mesh is at another
    /// time. Copies the vertices from host memory to the policy's, checks them there and returns when that is done. Throws
    /// error for another number of vertices, invalid_geometry, std::bad_alloc, cuda_error. The policy works on the device
    /// that the set lies on: that is not checked.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, memory_space>
    [[nodiscard]] indexed_set with_vertices(const Policy& on, std::span<const vertex> vertices) const {
        if (vertices.size() != vertices_.size()) {
            throw error(std::string(kind::name) + ": with_vertices got " + std::to_string(vertices.size()) +
                        " vertices, expected " + std::to_string(vertices_.size()));
        }
        indexed_set moved;
        moved.vertices_ = detail::shared_array<vertex, memory_space>(on, vertices);
        moved.elements_ = elements_;
        detail::check_array(on, moved.view().vertices, kind::name, "vertex");
        return moved;
    }
    /// Of vertices in braces.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, memory_space>
    [[nodiscard]] indexed_set with_vertices(const Policy& on, std::initializer_list<vertex> vertices) const {
        return with_vertices(on, detail::span_of(vertices));
    }
    /// Of another library's array.
    template <execution_policy Policy, detail::array_like V>
        requires(std::same_as<space_of<Policy>, memory_space> && !std::convertible_to<const V&, std::span<const vertex>>)
    [[nodiscard]] indexed_set with_vertices(const Policy& on, const V& vertices) const {
        if constexpr (detail::is_row<vertex, detail::element_of<V>>()) {
            return with_vertices(on, detail::rows_as<vertex>(vertices, kind::name));
        } else {
            return *this;
        }
    }

    /// See `copy_to`.
    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        indexed_set<typename kind::template in<space_of<Policy>>> copy;
        copy.vertices_ = vertices_.copied_to(to);
        copy.elements_ = elements_.copied_to(to);
        return copy;
    }

private:
    template <shape_view>
    friend class indexed_set;
    friend detail::set_parts;

    detail::shared_array<vertex, memory_space> vertices_;
    detail::shared_array<element, memory_space> elements_;
};

/// Triangles as faces over shared vertices: a surface, not a solid. mesh<float>(vertices, faces).
template <scalar T, memory_space Space = host_space>
using mesh = indexed_set<mesh_view<T, Space>>;
/// Segments as edges over shared vertices. edge_mesh<float>(vertices, edges); `edges` makes one of a mesh
/// (shape/features.hpp).
template <scalar T, memory_space Space = host_space>
using edge_mesh = indexed_set<edge_mesh_view<T, Space>>;

/// A set that owns its memory: it gives a view, and copies of itself in other memory.
template <class S>
concept shape_set = shape_view<typename S::view_type> && std::copyable<S> && requires(const S& set) {
    { set.view() } -> std::same_as<typename S::view_type>;
    { set.device() } -> std::same_as<int>;
};

/// The same set in the memory of `to`: sharing its storage if it lies there already, otherwise a copy. Returns when the copy
/// is done. A copy from one device to another, or from a device to the host, goes through host memory.
template <execution_policy Policy, shape_set Set>
[[nodiscard]] auto copy_to(const Policy& to, const Set& set) {
    return set.copied_to(to);
}

///@}

}  // namespace abut
