// SPDX-License-Identifier: MIT
#pragma once

// Sets in motion: `moving` makes one of two sets, of which shapes move from where they are in the first to where they are in
// the second (shape/moving_shape.hpp).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/moving_shape.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/shape.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

template <class S>
inline constexpr shape_name name_of<motion<S>>{name_of<S>.one, "abut::moving"};

/// Where the faces or edges of a view lie; of shapes as they are, there are none.
template <shape_view V>
auto elements_of(const V& v) {
    if constexpr (requires { v.faces; }) {
        return v.faces;
    } else if constexpr (requires { v.edges; }) {
        return v.edges;
    } else {
        return nullptr;
    }
}

}  // namespace detail

/// Two views of as many shapes, over the same faces or edges: where shapes are at t = 0 and where at t = 1.
/// @ingroup motion
template <shape_view V>
struct moving_view {
    using scalar_type = typename V::scalar_type;        ///< float or double
    using shape_type = motion<typename V::shape_type>;  ///< what a shape is
    using memory_space = typename V::memory_space;      ///< where the memory lies

    V t0;  ///< where shapes are at t = 0
    V t1;  ///< where they are at t = 1

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return t0.size(); }
    /// Shape i in motion, by value.
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return {t0[i], t1[i]}; }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        detail::prefetch_shape(t0, i, step);
        detail::prefetch_shape(t1, i, step);
    }
};

/// Two sets as one in motion, which shares their storage.
/// @ingroup motion
template <shape_set Set>
class moving_set {
public:
    using scalar_type = typename Set::scalar_type;           ///< float or double
    using shape_type = motion<typename Set::shape_type>;     ///< what a shape is
    using memory_space = typename Set::memory_space;         ///< where the memory lies
    using view_type = moving_view<typename Set::view_type>;  ///< what algorithms read

    /// A set without shapes.
    moving_set() = default;
    /// Without a check, of sets that are known to go together; see `moving`.
    moving_set(Set t0, Set t1) : t0_(std::move(t0)), t1_(std::move(t1)) {}

    /// Where shapes are at t = 0, and where at t = 1.
    ///@{
    [[nodiscard]] const Set& t0() const { return t0_; }
    [[nodiscard]] const Set& t1() const { return t1_; }
    ///@}
    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return t0_.size(); }
    /// What algorithms read; for as long as the set lives.
    [[nodiscard]] view_type view() const { return {t0_.view(), t1_.view()}; }
    /// The CUDA device that the memory lies on; -1 for the host.
    [[nodiscard]] int device() const { return t0_.device(); }

    /// The same in the memory of `to`; see `copy_to`.
    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        return moving_set<decltype(t0_.copied_to(to))>(t0_.copied_to(to), t1_.copied_to(to));
    }

private:
    Set t0_, t1_;
};

namespace detail {

[[noreturn]] inline void refuse_motion(const std::string& function, const std::string& what, std::size_t at_t0,
                                       std::size_t at_t1) {
    throw error(function + ": " + std::to_string(at_t0) + " " + what + " at t = 0, " + std::to_string(at_t1) +
                " at t = 1; expected as many");
}

/// Throws if the shapes of the two do not go together: as many, over as many vertices.
template <shape_view V>
void check_motion_sizes(const V& t0, const V& t1, const char* function) {
    if (t0.size() != t1.size()) refuse_motion(function, "shapes", t0.size(), t1.size());
    if constexpr (requires { t0.vertices; }) {
        if (t0.vertices.count != t1.vertices.count) {
            refuse_motion(function, "vertices", t0.vertices.count, t1.vertices.count);
        }
    }
}

/// A face or an edge, by the first of those that differ.
template <class Element>
[[noreturn]] void refuse_element(const std::string& function, std::size_t i) {
    throw error(function + ": " + (std::tuple_size_v<Element> == 3 ? "face " : "edge ") + std::to_string(i) +
                " has other vertices at t = 1 than at t = 0");
}

template <class Element>
struct differing_element {
    strided<Element> t0, t1;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        const std::uint32_t *const a = corners_at(t0, i), *const b = corners_at(t1, i);
        bool same = true;
        for (std::size_t k = 0; k < std::tuple_size_v<Element>; ++k) same = same && a[k] == b[k];
        return same ? none_is_bad : i;
    }
};

/// Throws if two views are of other faces or edges. Views of the same array are not read.
template <class Policy, shape_view V>
void check_elements(const Policy& on, const V& t0, const V& t1, const char* function) {
    if constexpr (!std::same_as<decltype(elements_of(t0)), std::nullptr_t>) {
        const auto a = elements_of(t0), b = elements_of(t1);
        if (a.data == b.data && a.stride == b.stride) return;
        using element = std::remove_cvref_t<decltype(a[0])>;
        const std::size_t bad = reduce(on, a.count, none_is_bad, minimum{}, differing_element<element>{a, b});
        if (bad != none_is_bad) refuse_element<element>(function, bad);
    }
}

/// Likewise of two sets, which are read to the host if they lie on a device.
template <shape_set Set>
void check_elements(const Set& t0, const Set& t1, const char* function) {
    if constexpr (!std::same_as<decltype(elements_of(t0.view())), std::nullptr_t>) {
        const auto a = elements_of(t0.view()), b = elements_of(t1.view());
        if (a.data == b.data) return;
        using element = std::remove_cvref_t<decltype(a[0])>;
        const auto at_t0 = set_parts::elements_to_host(t0), at_t1 = set_parts::elements_to_host(t1);
        const auto [first, second] = std::mismatch(at_t0.begin(), at_t0.end(), at_t1.begin());
        if (first != at_t0.end()) refuse_element<element>(function, static_cast<std::size_t>(first - at_t0.begin()));
    }
}

template <class Policy, shape_view V>
void check(const Policy& on, const moving_view<V>& view, const char* function) {
    check_motion_sizes(view.t0, view.t1, function);
    check(on, view.t0, (std::string(function) + ": at t = 0").c_str());
    check(on, view.t1, (std::string(function) + ": at t = 1").c_str());
    check_elements(on, view.t0, view.t1, function);
}

}  // namespace detail

/// @addtogroup motion
///@{

/// A set in motion: shape i moves from where it is in `t0` to where it is in `t1`, each of its points in a straight line at
/// constant speed, t from 0 to 1. An argument of queries and of make_bvh and refit like any set. The two sets have as many
/// shapes, and meshes and edge meshes the same faces or edges, in the same order; nothing is copied. They lie on one device:
/// that is not checked.
///
/// Throws error where they do not go together. Faces that the two sets do not share (`with_vertices` shares them) are
/// compared, which reads both to the host, and then std::bad_alloc and cuda_error as well. Returns when that is done.
///
///     const auto step = abut::moving(cloth, cloth.with_vertices(abut::serial{}, positions_at_t1));
template <shape_set Set>
[[nodiscard]] moving_set<Set> moving(Set t0, Set t1) {
    detail::check_motion_sizes(t0.view(), t1.view(), "abut::moving");
    detail::check_elements(t0, t1, "abut::moving");
    return {std::move(t0), std::move(t1)};
}
/// Likewise of two views over the caller's arrays, which are checked by what takes the view that this returns.
template <shape_view V>
[[nodiscard]] moving_view<V> moving(const V& t0, const V& t1) {
    return {t0, t1};
}

/// Whether a type is a shape, a view or a set in motion.
///@{
template <class X>
inline constexpr bool is_motion = false;
template <class S>
inline constexpr bool is_motion<motion<S>> = true;
template <class V>
inline constexpr bool is_motion<moving_view<V>> = true;
template <class Set>
inline constexpr bool is_motion<moving_set<Set>> = true;
///@}

/// The vertices of a mesh in motion; shares its storage.
template <scalar T, memory_space Space>
[[nodiscard]] moving_set<points<T, Space>> vertices(const moving_set<mesh<T, Space>>& mesh) {
    return {vertices(mesh.t0()), vertices(mesh.t1())};
}
/// The edges of a mesh in motion, as those of a mesh at rest, in the policy's memory.
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto edges(const Policy& on, const moving_set<mesh<T, Space>>& mesh) {
    auto at_t0 = edges(on, mesh.t0());
    auto at_t1 = detail::set_parts::with_points(at_t0, vertices(mesh.t1().copied_to(on)));
    return moving_set<decltype(at_t0)>(std::move(at_t0), std::move(at_t1));
}

///@}

}  // namespace abut
