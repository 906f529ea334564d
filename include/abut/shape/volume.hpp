// SPDX-License-Identifier: MIT
#pragma once

// Bounding volumes behind one concept: `sphere`, `aabb`, `obb` and `kdop` with 14, 18 and 26 planes. What can be asked of
// each, in its own frame or under a pose, is conservative in floating point: no pair that is enclosed is ever lost, for
// any finite input, whatever overflows or underflows.

#include <concepts>
#include <cstddef>
#include <type_traits>

#include <abut/shape/bounding_sphere.hpp>
#include <abut/shape/kdop.hpp>
#include <abut/shape/obb.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut {

/// @defgroup volumes Bounding volumes
///
/// `sphere`, `aabb`, `obb` and `kdop` around triangles: made by `around`, joined by `merge`, and compared by `overlaps` in
/// one frame or under a pose. A volume encloses what it was made around, exactly. All are plain values, on hosts and
/// devices.
///@{

/// Triangles by number: a view of a mesh or a soup, a span, a vector. On a device, one whose members may run there.
template <class R, class T>
concept triangle_range = requires(const R& triangles, std::size_t i) {
    { triangles.size() } -> std::convertible_to<std::size_t>;
    { triangles[i] } -> std::convertible_to<triangle<T>>;
};

namespace detail {

/// A volume's scalar type, and a volume of the same kind with another one.
template <class V>
struct volume_scalar;
template <template <class> class V, scalar T>
struct volume_scalar<V<T>> {
    using type = T;
    template <scalar U>
    using rebound = V<U>;
};
template <scalar T, int K>
struct volume_scalar<kdop<T, K>> {
    using type = T;
    template <scalar U>
    using rebound = kdop<U, K>;
};

/// Whether a volume merged from two is as small as one made around all that they hold.
template <class V>
inline constexpr bool merges_tightly = false;
template <scalar T>
inline constexpr bool merges_tightly<aabb<T>> = true;
template <scalar T, int K>
inline constexpr bool merges_tightly<kdop<T, K>> = true;

template <class T>
struct one_triangle {
    triangle<T> only;
    [[nodiscard]] ABUT_HD constexpr std::size_t size() const { return 1; }
    [[nodiscard]] ABUT_HD constexpr const triangle<T>& operator[](std::size_t) const { return only; }
};

}  // namespace detail

/// The smallest box around triangles. Exact.
template <scalar T, class Triangles>
ABUT_HD constexpr aabb<T> around_all(std::type_identity<aabb<T>>, const Triangles& triangles) {
    return detail::box_around<T>(triangles);
}

/// Plain data that encloses points. All of these run on hosts and devices, take constant time (`around_all`: linear), and
/// may say that volumes overlap that do not, never the reverse. A volume encloses what it was made around, and a merged one
/// what either did, exactly: by its stored numbers, in real arithmetic. (A thread that reads denormals as zero makes volumes
/// that enclose by the numbers as it reads them; bounds.hpp says why that is enough.)
template <class V>
concept bounding_volume = std::is_trivially_copyable_v<V> && requires {
    typename detail::volume_scalar<V>::type;
} && requires(const V& a, const V& b, const relative_pose<typename detail::volume_scalar<V>::type>& pose,
              const detail::one_triangle<typename detail::volume_scalar<V>::type>& triangles) {
    { around_all(std::type_identity<V>{}, triangles) } -> std::same_as<V>;
    { merge(a, b) } -> std::same_as<V>;
    { overlaps(a, b) } -> std::same_as<bool>;        // both in one frame
    { overlaps(a, pose, b) } -> std::same_as<bool>;  // each in the frame of its object
    { bounds(a) } -> std::same_as<aabb<typename detail::volume_scalar<V>::type>>;
};

/// A volume around triangles, at least one: around<obb<float>>(mesh.view()).
template <bounding_volume V, triangle_range<typename detail::volume_scalar<V>::type> Triangles>
ABUT_HD constexpr V around(const Triangles& triangles) {
    return around_all(std::type_identity<V>{}, triangles);
}

/// And around one.
template <bounding_volume V>
ABUT_HD constexpr V around(const triangle<typename detail::volume_scalar<V>::type>& t) {
    return around_all(std::type_identity<V>{}, detail::one_triangle<typename detail::volume_scalar<V>::type>{t});
}

///@}

}  // namespace abut
