// SPDX-License-Identifier: MIT
#pragma once

// A face of a mesh that knows which vertices it has, for questions between faces of one mesh. As a shape it is its triangle.

#include <cstdint>

#include <abut/config.hpp>
#include <abut/shape/place_word.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/reach.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// Corners, and a number for the vertex at each: two faces share the vertices whose numbers both have. Where all numbers are
/// `by_place`, in both faces, vertices go by their places instead.
template <scalar T>
struct mesh_face {
    using scalar_type = T;
    static constexpr std::uint32_t by_place = static_cast<std::uint32_t>(-1);

    triangle<T> corners;
    std::uint32_t vertex[3];
};

template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const mesh_face<T>& f) {
    return abut::bounds(f.corners);
}
template <scalar T>
ABUT_HD auto reach_of(const mesh_face<T>& f) {
    return abut::reach_of(f.corners);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const mesh_face<T>& f) {
    return abut::is_valid(f.corners);
}
template <scalar T>
ABUT_HD constexpr mesh_face<T> place(const rigid<T>& pose, const mesh_face<T>& f) {
    return {abut::place(pose, f.corners), {f.vertex[0], f.vertex[1], f.vertex[2]}};
}

}  // namespace abut::detail
