// SPDX-License-Identifier: MIT
#pragma once

// How near shapes have to come to be judged: what one reaches from where it is, and which boxes of two trees are near each
// other, posed or not.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/collide/operand.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/moved.hpp>
#include <abut/shape/reach.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/traverse/pair_walk.hpp>

namespace abut::detail {

/// So near that their boxes touch.
struct near_enough_to_touch {
    template <class S>
    [[nodiscard]] ABUT_HD auto reach(const S& s) const {
        return reach_of(s);
    }
    /// What walks of two posed trees allow for, where the rounding of a relative pose has its share.
    template <scalar T>
    [[nodiscard]] ABUT_HD T slack(T of_rounding) const {
        return of_rounding;
    }
};
/// All boxes that come so near to one, as a frame tells: so it is the same pairs that a walk of two trees finds.
template <scalar T, class Frame>
struct near_reach {
    aabb<T> query;
    Frame frame;
    [[nodiscard]] ABUT_HD aabb<T> bounds() const {
        const auto down = [this](T x) { return add_down(x, -frame.distance); };
        const auto up = [this](T x) { return add_up(x, frame.distance); };
        return {{down(query.lower.x), down(query.lower.y), down(query.lower.z)},
                {up(query.upper.x), up(query.upper.y), up(query.upper.z)}};
    }
    ABUT_HD bool operator()(const aabb<T>& box) const { return frame(query, box); }
};
/// So near that a frame keeps their boxes: near_frame or distance_frame (traverse/pair_walk.hpp).
template <scalar T, class Frame>
struct near_by {
    Frame frame;
    template <class S>
    [[nodiscard]] ABUT_HD auto reach(const S& s) const {
        return near_reach<T, Frame>{bounds(s), frame};
    }
    /// In units of a's frame lengths are off by less than 2^-7 (relative_pose.hpp): of A^T, which stretches the way between
    /// two shapes, and of the axes that boxes are compared along.
    [[nodiscard]] ABUT_HD T slack(T of_rounding) const {
        return add_up(of_rounding, add_up(frame.distance, frame.distance / 64));
    }
};
/// In each coordinate; and along a straight line.
template <scalar T>
using near_in_coordinates = near_by<T, near_frame<T>>;
template <scalar T>
using near_in_distance = near_by<T, distance_frame<T>>;

/// Where an operand with a tree lies: its pose, and the box around its shapes in their frame.
template <scalar T>
struct placement {
    rigid<T> pose;
    aabb<T> around;
};
template <scalar T>
placement(const rigid<T>&, const aabb<T>&) -> placement<T>;
template <class Operand>
auto placement_of(const Operand& x) {
    if constexpr (Operand::is_posed) {
        return placement{x.pose, x.around};
    } else {
        const auto around = x.index.bounds();
        return placement{rigid<decltype(around.lower.x + 0)>{}, around};
    }
}

/// By how much boxes of an operand that goes along a way grow, in its frame.
template <class Operand, scalar T>
box_growth<T> growth_of(const moved_operand<Operand, T>& x) {
    if constexpr (Operand::is_posed) {
        return box_growth<T>::in_frame(x.operand.pose, x.way);
    } else {
        return box_growth<T>::by(x.way);
    }
}
template <class Operand, scalar T>
auto placement_of(const moved_operand<Operand, T>& x) {
    auto at = placement_of(x.operand);
    at.around = growth_of(x)(at.around);
    return at;
}

/// How boxes of two operands' trees are compared.
template <class A, class B>
auto box_overlap_in_frames(const A& a, const B& b) {
    if constexpr (A::is_posed || B::is_posed) {
        const auto at_a = placement_of(a), at_b = placement_of(b);
        return two_frames{make_relative_pose(at_a.pose, at_a.around, at_b.pose, at_b.around)};
    } else {
        return same_frame{};
    }
}
template <class A, class B>
auto box_overlap(const A& a, const B& b) {
    auto frames = box_overlap_in_frames(a, b);
    if constexpr (is_moved_operand<A> || is_moved_operand<B>) {
        // Boxes that have grown are rounded once more.
        if constexpr (requires { frames.b_to_a; }) frames.b_to_a.slack *= 2;
        const auto grown = [&] {
            if constexpr (is_moved_operand<A>) {
                return growth_of(a);
            } else {
                return growth_of(b);
            }
        }();
        return boxes_on_way<is_moved_operand<A>, decltype(frames), decltype(grown.down.x + 0)>{frames, grown};
    } else {
        return frames;
    }
}

/// The same for boxes that may be so far apart.
template <class A, class B, class Nearness>
auto box_overlap(const A& a, const B& b, const Nearness& near) {
    if constexpr (std::same_as<Nearness, near_enough_to_touch>) {
        return box_overlap(a, b);
    } else if constexpr (A::is_posed || B::is_posed) {
        auto frames = box_overlap(a, b);
        frames.b_to_a.slack = near.slack(frames.b_to_a.slack);
        return frames;
    } else {
        return near.frame;
    }
}

}  // namespace abut::detail
