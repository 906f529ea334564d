// SPDX-License-Identifier: MIT
#pragma once

// Sets of shapes that own their memory: mesh, triangle_soup, spheres, equal_spheres. A set is checked when it is made and
// never changes after that; copies share the storage, which lives as long as a set or an index uses it.
//
// Every constructor copies its input into the memory of a policy (the host's, where none is given), checks it there and
// returns when that is done. It throws invalid_geometry with the first bad element's index and value, capacity_error for
// 2^31 elements or more, and std::bad_alloc. Empty sets are legal.

#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

/// An immutable array in a memory space, shared by its copies.
template <class T, memory_space Space>
class shared_array {
public:
    shared_array() = default;
    template <execution_policy Policy>
    shared_array(const Policy& on, std::span<const T> values) {
        auto fresh = std::make_shared<execution::buffer<T, Space>>(on, values.size());
        upload(on, values.data(), values.size(), fresh->data());
        values_ = std::move(fresh);
    }

    [[nodiscard]] const T* data() const { return values_ ? values_->data() : nullptr; }
    [[nodiscard]] std::size_t size() const { return values_ ? values_->size() : 0; }
    [[nodiscard]] int device() const { return values_ ? values_->device() : -1; }

    /// In the memory of `to`: this array itself if it lies there already, otherwise a copy. Waits for it.
    template <execution_policy Policy>
    [[nodiscard]] shared_array<T, space_of<Policy>> copied_to(const Policy& to) const {
        if constexpr (std::same_as<space_of<Policy>, Space>) {
            if (size() == 0 || device() == device_of(to)) return *this;
        }
        std::vector<T> values(size());
        if (values_) values_->read(values.data());
        shared_array<T, space_of<Policy>> copy(to, values);
        synchronize(to);
        return copy;
    }

private:
    std::shared_ptr<const execution::buffer<T, Space>> values_;
};

struct no_check {};

}  // namespace detail

/// Triangles as faces over shared vertices: a surface, not a solid.
template <scalar T, memory_space Space = host_space>
class mesh {
public:
    using scalar_type = T;
    using shape_type = triangle<T>;
    using memory_space = Space;
    using view_type = mesh_view<T, Space>;

    mesh() = default;
    mesh(const std::vector<vec3<T>>& vertices, const std::vector<face>& faces)
        requires std::same_as<Space, host_space>
        : mesh(serial{}, vertices, faces) {}
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    mesh(const Policy& on, std::span<const vec3<T>> vertices, std::span<const face> faces)
        : vertices_(on, vertices), faces_(on, faces) {
        detail::check(on, view(), "abut::mesh");
    }

    /// Number of triangles.
    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    [[nodiscard]] view_type view() const { return {vertices_.data(), vertices_.size(), faces_.data(), faces_.size()}; }
    [[nodiscard]] int device() const { return faces_.device(); }

    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        return mesh<T, space_of<Policy>>(detail::no_check{}, vertices_.copied_to(to), faces_.copied_to(to));
    }

private:
    template <scalar, abut::memory_space>
    friend class mesh;
    mesh(detail::no_check, detail::shared_array<vec3<T>, Space> vertices, detail::shared_array<face, Space> faces)
        : vertices_(std::move(vertices)), faces_(std::move(faces)) {}

    detail::shared_array<vec3<T>, Space> vertices_;
    detail::shared_array<face, Space> faces_;
};

/// Triangles that share nothing, three vertices each.
template <scalar T, memory_space Space = host_space>
class triangle_soup {
public:
    using scalar_type = T;
    using shape_type = triangle<T>;
    using memory_space = Space;
    using view_type = triangle_soup_view<T, Space>;

    triangle_soup() = default;
    triangle_soup(const std::vector<triangle<T>>& triangles)
        requires std::same_as<Space, host_space>
        : triangle_soup(serial{}, triangles) {}
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    triangle_soup(const Policy& on, std::span<const triangle<T>> triangles) : triangles_(on, triangles) {
        detail::check(on, view(), "abut::triangle_soup");
    }

    [[nodiscard]] std::size_t size() const { return triangles_.size(); }
    [[nodiscard]] view_type view() const { return {triangles_.data(), triangles_.size()}; }
    [[nodiscard]] int device() const { return triangles_.device(); }

    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        return triangle_soup<T, space_of<Policy>>(detail::no_check{}, triangles_.copied_to(to));
    }

private:
    template <scalar, abut::memory_space>
    friend class triangle_soup;
    triangle_soup(detail::no_check, detail::shared_array<triangle<T>, Space> triangles) : triangles_(std::move(triangles)) {}

    detail::shared_array<triangle<T>, Space> triangles_;
};

/// Solid spheres, each with its own radius.
template <scalar T, memory_space Space = host_space>
class spheres {
public:
    using scalar_type = T;
    using shape_type = sphere<T>;
    using memory_space = Space;
    using view_type = spheres_view<T, Space>;

    spheres() = default;
    spheres(const std::vector<sphere<T>>& values)
        requires std::same_as<Space, host_space>
        : spheres(serial{}, values) {}
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    spheres(const Policy& on, std::span<const sphere<T>> values) : spheres_(on, values) {
        detail::check(on, view(), "abut::spheres");
    }

    [[nodiscard]] std::size_t size() const { return spheres_.size(); }
    [[nodiscard]] view_type view() const { return {spheres_.data(), spheres_.size()}; }
    [[nodiscard]] int device() const { return spheres_.device(); }

    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        return spheres<T, space_of<Policy>>(detail::no_check{}, spheres_.copied_to(to));
    }

private:
    template <scalar, abut::memory_space>
    friend class spheres;
    spheres(detail::no_check, detail::shared_array<sphere<T>, Space> values) : spheres_(std::move(values)) {}

    detail::shared_array<sphere<T>, Space> spheres_;
};

/// Solid spheres of one radius, which is stored once.
template <scalar T, memory_space Space = host_space>
class equal_spheres {
public:
    using scalar_type = T;
    using shape_type = sphere<T>;
    using memory_space = Space;
    using view_type = equal_spheres_view<T, Space>;

    equal_spheres() = default;
    equal_spheres(const std::vector<vec3<T>>& centers, T radius)
        requires std::same_as<Space, host_space>
        : equal_spheres(serial{}, centers, radius) {}
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    equal_spheres(const Policy& on, std::span<const vec3<T>> centers, T radius) : centers_(on, centers), radius_(radius) {
        detail::check(on, view(), "abut::equal_spheres");
    }

    [[nodiscard]] std::size_t size() const { return centers_.size(); }
    [[nodiscard]] view_type view() const { return {centers_.data(), centers_.size(), radius_}; }
    [[nodiscard]] int device() const { return centers_.device(); }

    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        return equal_spheres<T, space_of<Policy>>(detail::no_check{}, centers_.copied_to(to), radius_);
    }

private:
    template <scalar, abut::memory_space>
    friend class equal_spheres;
    equal_spheres(detail::no_check, detail::shared_array<vec3<T>, Space> centers, T radius)
        : centers_(std::move(centers)), radius_(radius) {}

    detail::shared_array<vec3<T>, Space> centers_;
    T radius_ = 0;
};

/// A set that owns its memory: it gives a view, and copies of itself in other memory.
template <class S>
concept shape_set = shape_view<typename S::view_type> && std::copyable<S> && requires(const S& set) {
    { set.view() } -> std::same_as<typename S::view_type>;
    { set.device() } -> std::same_as<int>;
};

/// The same set in the memory of `to`: sharing its storage if it lies there already, otherwise a copy. Returns when the copy
/// is done. Throws std::bad_alloc, cuda_error.
template <execution_policy Policy, shape_set Set>
[[nodiscard]] auto copy_to(const Policy& to, const Set& set) {
    return set.copied_to(to);
}

}  // namespace abut
