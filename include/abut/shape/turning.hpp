// SPDX-License-Identifier: MIT
#pragma once

// Bodies that turn: `moving(posed(x, from), posed(x, to))` is a set, an index or one shape on its way from one pose to
// another. What the way is says shape/rigid_motion.hpp.

#include <concepts>
#include <type_traits>
#include <utility>

#include <abut/error.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/rigid_motion.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// An object that goes from one pose to another in the time from 0 to 1, or stays at one. Shares the object's storage.
template <class Object>
struct posed_motion {
    using scalar_type = scalar_type_of<Object>;  ///< float or double

    Object object;               ///< in its own frame
    rigid<scalar_type> from;     ///< its pose at t = 0
    rigid<scalar_type> to;       ///< its pose at t = 1
    turning<scalar_type> about;  ///< about what it turns

    posed_motion() = default;
    /// From one pose to another.
    posed_motion(Object of, const rigid<scalar_type>& pose_at_t0, const rigid<scalar_type>& pose_at_t1,
                 const turning<scalar_type>& turns_about = {})
        : object(std::move(of)), from(pose_at_t0), to(pose_at_t1), about(turns_about) {}
    /// At rest.
    posed_motion(const posed_object<Object>& at) : object(at.object), from(at.pose), to(at.pose), about{} {}  // NOLINT

    /// Number of shapes.
    [[nodiscard]] std::size_t size() const {
        if constexpr (requires { object.size(); }) {
            return object.size();
        } else {
            return 1;
        }
    }
};

/// Whether a type is a posed object in motion.
///@{
template <class X>
inline constexpr bool is_posed_motion = false;
template <class Object>
inline constexpr bool is_posed_motion<posed_motion<Object>> = true;
///@}

namespace detail {

/// Whether two objects are one: the same nodes, or the same shapes; or shapes with equal boxes, which tells slips.
template <class Object>
bool are_one(const Object& a, const Object& b) {
    if constexpr (requires { a.stored(); }) {
        return &a.stored() == &b.stored();
    } else if constexpr (shape<Object>) {
        const auto p = bounds(a), q = bounds(b);
        return p.lower == q.lower && p.upper == q.upper;
    } else if constexpr (requires { a.view(); }) {
        return are_one(a.view(), b.view());
    } else if constexpr (requires { a.vertices.data; }) {
        return a.vertices.data == b.vertices.data && a.size() == b.size();
    } else if constexpr (requires { a.data; }) {
        return a.data == b.data && a.size() == b.size();
    } else {
        return a.size() == b.size();
    }
}

}  // namespace detail

/// A body that turns: `at_t0` and `at_t1` are the same set, index or shape under two poses. A point of the body goes in a
/// straight line at constant speed: the origin of its frame, or `about.centre`. The body turns about that point, at a
/// constant rate and about a constant axis, the shorter way round, or as `about.axis` says. At both ends the poses are those
/// that were given.
///
/// Throws error where the two are different objects. Poses are checked by what takes the motion. Returns at once.
///
///     const auto way = abut::moving(abut::posed(robot, from), abut::posed(robot, to));
template <class Object>
[[nodiscard]] posed_motion<Object> moving(const posed_object<Object>& at_t0, const posed_object<Object>& at_t1,
                                          const turning<typename posed_object<Object>::scalar_type>& about = {}) {
    if (!detail::are_one(at_t0.object, at_t1.object)) throw error("abut::moving: another object at t = 1 than at t = 0");
    return {at_t0.object, at_t0.pose, at_t1.pose, about};
}

///@}

}  // namespace abut
