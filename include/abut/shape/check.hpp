// SPDX-License-Identifier: MIT
#pragma once

// Finds what is no geometry: shapes that are not valid (shape/shape.hpp), vertex indices out of range, too many elements.
// Runs where the data lies, so device memory is checked on the device.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>
#include <abut/shape/view.hpp>
#include <abut/shape/xyz_view.hpp>

namespace abut::detail {

inline constexpr std::size_t none_is_bad = static_cast<std::size_t>(-1);

/// Index i if shape i is not valid, otherwise the largest index.
template <shape_view V>
struct bad_shape {
    V shapes;
    ABUT_HD std::size_t operator()(std::size_t i) const { return is_valid(shapes[i]) ? none_is_bad : i; }
};

/// Likewise of a face or an edge whose vertices are not all there.
template <std::size_t N>
struct bad_corners {
    strided<std::array<std::uint32_t, N>> elements;
    std::uint32_t vertex_count;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        const std::uint32_t* const corner = corners_at(elements, i);
        bool good = true;
        for (std::size_t k = 0; k < N; ++k) good = good && corner[k] < vertex_count;
        return good ? none_is_bad : i;
    }
};

struct minimum {
    ABUT_HD std::size_t operator()(std::size_t a, std::size_t b) const { return b < a ? b : a; }
};

template <shape_view V>
struct fetch_shape {
    V shapes;
    std::size_t which;
    typename V::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = shapes[which]; }
};

/// What is wrong with a shape that is not valid, as an exception. Of a shape in motion: what is wrong at one of its two
/// times. Of a shape of the caller's own: what is wrong with its box, or else that its own is_valid says no.
template <shape S>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const S& s) {
    shape_flaw flaw;
    if constexpr (requires { s.t0, s.t1; }) {
        // Of a conditional expression nvcc does not see that it never returns.
        if (!is_valid(s.t0)) refuse(function + ": at t = 0", element, i, s.t0);
        refuse(function + ": at t = 1", element, i, s.t1);
    } else if constexpr (tells_flaw<S>) {
        flaw = flaw_of(s);
    } else {
        const aabb<scalar_type_of<S>> box = bounds(s);
        flaw = flaw_of(box);
        if (!flaw) flaw = {"is_valid refuses it; its least x is", static_cast<double>(box.lower.x)};
    }
    throw invalid_geometry(function, element, i, std::string(flaw.of) + flaw.what, flaw.value);
}

/// The first shape that is not valid, or none_is_bad.
template <class Policy, shape_view V>
std::size_t first_bad(const Policy& on, const V& view) {
    return reduce(on, view.size(), none_is_bad, minimum{}, bad_shape<V>{view});
}
/// Shape i, on the host.
template <class Policy, shape_view V>
typename V::shape_type fetched(const Policy& on, const V& view, std::size_t i) {
    typename V::shape_type shape;
    execution::buffer_of<Policy, typename V::shape_type> copy(on, 1);
    for_each_index(on, 1, fetch_shape<V>{view, i, copy.data()});
    download(on, copy.data(), 1, &shape);
    return shape;
}

/// Throws if a shape is not valid, with the first such.
template <class Policy, shape_view V>
void check_shapes(const Policy& on, const V& view, const char* function, const char* element) {
    const std::size_t bad = first_bad(on, view);
    if (bad != none_is_bad) refuse(function, element, bad, fetched(on, view, bad));
}

/// Likewise of an array, which the policy has to be able to read.
template <class Policy, shape S>
void check_array(const Policy& on, const strided<S>& array, const char* function, const char* element) {
    require_access(on, array.data, function);
    see_writes_to(array.data);
    check_shapes(on, shapes_view<S, space_of<Policy>>(array.first(), array.count, array.stride), function, element);
}
template <class Policy, scalar T, memory_space Space>
void check_array(const Policy& on, const xyz_points_view<T, Space>& points, const char* function, const char* element) {
    require_access(on, points.x, function);
    require_access(on, points.y, function);
    require_access(on, points.z, function);
    check_shapes(on, points, function, element);
}

inline void check_count(std::size_t count, const char* function) {
    // Ids have 32 bits, and an index needs one of them for itself.
    if (count >= (std::size_t{1} << 31)) {
        throw capacity_error(std::string(function) + ": " + std::to_string(count) +
                             " elements; a set holds fewer than 2^31");
    }
}

/// Shapes over shared vertices, each given by the numbers of N of them.
template <class Policy, class Vertices, std::size_t N>
void check_indexed(const Policy& on, const Vertices& vertices, const strided<std::array<std::uint32_t, N>>& elements,
                   const char* function, const char* element) {
    check_count(elements.count, function);
    check_count(vertices.count, function);
    check_array(on, vertices, function, "vertex");
    const auto vertex_count = static_cast<std::uint32_t>(vertices.count);
    require_access(on, elements.data, function);
    see_writes_to(elements.data);
    const std::size_t bad = reduce(on, elements.count, none_is_bad, minimum{}, bad_corners<N>{elements, vertex_count});
    if (bad == none_is_bad) return;
    std::array<std::uint32_t, N> corners;
    download(on, &elements[bad], 1, &corners);
    std::size_t k = 0;
    while (corners[k] < vertex_count) ++k;
    std::string problem = "vertex index out of range, there are " + std::to_string(vertex_count) + " vertices";
    const auto as_signed = static_cast<std::int32_t>(corners[k]);
    if (as_signed < 0) problem += "; as a signed number it is " + std::to_string(as_signed);
    throw invalid_geometry(function, element, bad, problem, corners[k]);
}

// What a view has to hold: each throws in the name of `function`.

/// A view of the caller's own. Where its memory lies is the caller's to know.
template <class Policy, shape_view V>
void check(const Policy& on, const V& view, const char* function) {
    check_count(view.size(), function);
    check_shapes(on, view, function, name_of<typename V::shape_type>.one);
}
template <class Policy, shape S, memory_space Space>
void check(const Policy& on, const shapes_view<S, Space>& view, const char* function) {
    static_assert(!refers_to_memory<S> || std::same_as<Space, host_space>,
                  "abut: hulls one by one lie in host memory; make a set, abut::hulls, which has its points with it");
    check_count(view.size(), function);
    check_array(on, view.shapes, function, name_of<S>.one);
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const mesh_view<T, Space>& view, const char* function) {
    check_indexed(on, view.vertices, view.faces, function, "face");
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const edge_mesh_view<T, Space>& view, const char* function) {
    check_indexed(on, view.vertices, view.edges, function, "edge");
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const equal_spheres_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    const sphere<T> first{{0, 0, 0}, view.radius};
    if (!is_valid(first)) refuse(function, "sphere", 0, first);
    check_array(on, view.centers, function, "sphere");
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const xyz_points_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    check_array(on, view, function, "point");
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const xyz_spheres_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    check_array(on, view.centers, function, "sphere");
    require_access(on, view.radii, function);
    check_shapes(on, view, function, "sphere");
}
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const xyz_mesh_view<T, Space>& view, const char* function) {
    check_indexed(on, view.vertices, view.faces, function, "face");
}
template <class Policy, shape S, memory_space Space>
void check(const Policy&, const single_view<S, Space>& view, const char* function) {
    if (!is_valid(view.shape)) refuse(function, "shape", 0, view.shape);
}

}  // namespace abut::detail
