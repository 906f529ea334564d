// SPDX-License-Identifier: MIT
#pragma once

// In how many orders each pair of kinds of shapes can be decided, as the compiler at hand finds the functions. Where one
// finds more of them than another, a pair may be decided as what it is not.

#include <abut/abut.hpp>

namespace abut::test {

struct pair_orders {
    int one = 0, both = 0;
    bool operator==(const pair_orders&) const = default;
};

template <class... S>
struct kinds_of_shapes {
    template <class A, class B>
    static consteval void look_at(pair_orders& found) {
        constexpr int orders = (decidable_pair<A, B> ? 1 : 0) + (decidable_pair<B, A> ? 1 : 0);
        if (orders == 1) ++found.one;
        if (orders == 2) ++found.both;
    }
    template <class A>
    static consteval void look_at_all(pair_orders& found) {
        (look_at<A, S>(found), ...);
    }
    /// Of each two kinds twice, and of a kind with itself once.
    static consteval pair_orders count() {
        pair_orders found;
        (look_at_all<S>(found), ...);
        return found;
    }
};

/// In both orders: 10 kinds with themselves, a point and a sphere, and a segment and a capsule. In one order: the other 26
/// pairs of these kinds but cylinders and cones, a ray and a triangle, a hull or each of 5 other solids, a cylinder or a
/// cone with each of 7 kinds, and a cylinder, a cone and a capsule with each other.
template <scalar T>
inline constexpr bool pairs_have_their_orders =
    kinds_of_shapes<sphere<T>, triangle<T>, segment<T>, vec3<T>, aabb<T>, plane<T>, capsule<T>, ray<T>, hull<T>, cylinder<T>,
                    cone<T>>::count() == pair_orders{2 * (26 + 7 + 14 + 3), 10 + 2 * 2};

}  // namespace abut::test
