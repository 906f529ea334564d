// SPDX-License-Identifier: MIT
#pragma once

// Finds what is no geometry: coordinates that are not finite, negative radii, boxes inside out, vertex indices out of range.
// Runs where the data lies, so device memory is checked on the device.

#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/arithmetic/limits.hpp>
#include <abut/error.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

template <class T>
ABUT_HD bool is_finite(T x) {
    return x >= -largest_finite<T> && x <= largest_finite<T>;  // false for NaN as well
}

template <class T>
ABUT_HD bool is_finite(const vec3<T>& p) {
    return is_finite(p.x) && is_finite(p.y) && is_finite(p.z);
}

template <class T>
ABUT_HD bool is_good(const vec3<T>& p) {
    return is_finite(p);
}
template <class T>
ABUT_HD bool is_good(const triangle<T>& t) {
    return is_finite(t.a) && is_finite(t.b) && is_finite(t.c);
}
template <class T>
ABUT_HD bool is_good(const sphere<T>& s) {
    return is_finite(s.center) && is_finite(s.radius) && s.radius >= 0;
}
template <class T>
ABUT_HD bool is_good(const segment<T>& s) {
    return is_finite(s.a) && is_finite(s.b);
}
template <class T>
ABUT_HD bool is_good(const aabb<T>& box) {
    return is_finite(box.lower) && is_finite(box.upper) && box.lower.x <= box.upper.x && box.lower.y <= box.upper.y &&
           box.lower.z <= box.upper.z;
}
template <class T>
ABUT_HD bool is_good(const plane<T>& p) {
    return is_finite(p.normal) && is_finite(p.offset);
}
template <class T>
ABUT_HD bool is_good(const capsule<T>& s) {
    return is_good(s.axis) && is_finite(s.radius) && s.radius >= 0;
}

/// Index i if element i is bad, otherwise the largest index.
template <class Element>
struct bad_element {
    strided<Element> elements;
    ABUT_HD std::size_t operator()(std::size_t i) const { return is_good(elements[i]) ? static_cast<std::size_t>(-1) : i; }
};

struct bad_face {
    strided<face> faces;
    std::uint32_t vertex_count;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        const auto* const corner = reinterpret_cast<const std::uint32_t*>(faces.data + i * faces.stride);
        const bool good = corner[0] < vertex_count && corner[1] < vertex_count && corner[2] < vertex_count;
        return good ? static_cast<std::size_t>(-1) : i;
    }
};

struct minimum {
    ABUT_HD std::size_t operator()(std::size_t a, std::size_t b) const { return b < a ? b : a; }
};

template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const vec3<T>& p) {
    const bool x = !is_finite(p.x), y = !is_finite(p.y);
    const std::string name = x ? "x" : y ? "y" : "z";
    throw invalid_geometry(function, element, i, name + " is not finite", static_cast<double>(x ? p.x : y ? p.y : p.z));
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const triangle<T>& t) {
    if (!is_finite(t.a)) refuse(function, element, i, t.a);
    if (!is_finite(t.b)) refuse(function, element, i, t.b);
    refuse(function, element, i, t.c);
}
template <class T>
[[noreturn]] void refuse_radius(const std::string& function, const std::string& element, std::size_t i, T radius) {
    const bool negative = radius < 0;
    throw invalid_geometry(function, element, i, negative ? "radius is negative" : "radius is not finite",
                           static_cast<double>(radius));
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const sphere<T>& s) {
    if (!is_finite(s.center)) refuse(function, element, i, s.center);
    refuse_radius(function, element, i, s.radius);
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const segment<T>& s) {
    refuse(function, element, i, is_finite(s.a) ? s.b : s.a);
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const aabb<T>& box) {
    if (!is_finite(box.lower)) refuse(function, element, i, box.lower);
    if (!is_finite(box.upper)) refuse(function, element, i, box.upper);
    const bool x = box.lower.x > box.upper.x, y = box.lower.y > box.upper.y;
    const std::string name = x ? "x" : y ? "y" : "z";
    throw invalid_geometry(function, element, i, "lower " + name + " is above upper " + name,
                           static_cast<double>(x   ? box.lower.x
                                               : y ? box.lower.y
                                                   : box.lower.z));
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const plane<T>& p) {
    if (!is_finite(p.normal)) refuse(function, element, i, p.normal);
    throw invalid_geometry(function, element, i, "offset is not finite", static_cast<double>(p.offset));
}
template <class T>
[[noreturn]] void refuse(const std::string& function, const std::string& element, std::size_t i, const capsule<T>& s) {
    if (!is_good(s.axis)) refuse(function, element, i, s.axis);
    refuse_radius(function, element, i, s.radius);
}

template <class Policy, class Element>
void check_elements(const Policy& on, const strided<Element>& elements, const char* function, const char* name) {
    require_access(on, elements.data, function);
    const std::size_t bad =
        reduce(on, elements.count, static_cast<std::size_t>(-1), minimum{}, bad_element<Element>{elements});
    if (bad == static_cast<std::size_t>(-1)) return;
    Element value;
    download(on, &elements[bad], 1, &value);
    refuse(function, name, bad, value);
}

inline void check_count(std::size_t count, const char* function) {
    // Ids have 32 bits, and an index needs one of them for itself.
    if (count >= (std::size_t{1} << 31)) {
        throw capacity_error(std::string(function) + ": " + std::to_string(count) +
                             " elements; a set holds fewer than 2^31");
    }
}

template <class Policy, class T, class Space>
void check(const Policy& on, const mesh_view<T, Space>& view, const char* function) {
    check_count(view.faces.count, function);
    check_count(view.vertices.count, function);
    check_elements(on, view.vertices, function, "vertex");
    const auto vertex_count = static_cast<std::uint32_t>(view.vertices.count);
    const std::size_t none = static_cast<std::size_t>(-1);
    require_access(on, view.faces.data, function);
    const std::size_t bad = reduce(on, view.faces.count, none, minimum{}, bad_face{view.faces, vertex_count});
    if (bad == none) return;
    face value;
    download(on, &view.faces[bad], 1, &value);
    const std::uint32_t index = value[0] >= vertex_count ? value[0] : value[1] >= vertex_count ? value[1] : value[2];
    throw invalid_geometry(function, "face", bad,
                           "vertex index out of range, there are " + std::to_string(vertex_count) + " vertices", index);
}

template <class Policy, class T, class Space>
void check(const Policy& on, const triangle_soup_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    check_elements(on, view.triangles, function, "triangle");
}

template <class Policy, class T, class Space>
void check(const Policy& on, const spheres_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    check_elements(on, view.spheres, function, "sphere");
}

template <class Policy, class T, class Space>
void check(const Policy& on, const equal_spheres_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    const sphere<T> first{{0, 0, 0}, view.radius};
    if (!is_good(first)) refuse(function, "sphere", 0, first);
    check_elements(on, view.centers, function, "sphere");
}

template <class Policy, class Shape, class Space>
void check(const Policy&, const single_view<Shape, Space>& view, const char* function) {
    if (!is_good(view.shape)) refuse(function, "shape", 0, view.shape);
}

}  // namespace abut::detail
