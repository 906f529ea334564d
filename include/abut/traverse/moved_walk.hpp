// SPDX-License-Identifier: MIT
#pragma once

// A walk through an index all of whose shapes go along a way. What looks in it looks there from all along the way back.

#include <utility>

#include <abut/arithmetic/error_free.hpp>
#include <abut/shape/moved.hpp>
#include <abut/shape/reach.hpp>

namespace abut::detail {

template <class Walk>
struct moved_walk {
    using scalar_type = typename Walk::scalar_type;
    using T = scalar_type;
    using cursor = typename Walk::cursor;

    Walk walk;
    vec3<T> way;

    /// False if the query touches nothing in the index.
    template <class Reach>
    ABUT_HD bool may_touch(Reach& reach) const {
        auto back = seen_back(reach);
        return walk.may_touch(back);
    }
    /// As the walk of the index at rest.
    template <class Reach, class Cursor, class Rests, class Visitor>
    ABUT_HD bool for_each(Reach& reach, Cursor& at, const Rests& rests, Visitor&& visitor) const {
        auto back = seen_back(reach);
        return walk.for_each(back, at, rests, std::forward<Visitor>(visitor));
    }

private:
    template <class Reach>
    ABUT_HD auto seen_back(const Reach& reach) const {
        const aabb<T> box = reach.bounds();
        const auto grown = box_growth<T>::by({-way.x, -way.y, -way.z});
        const vec3<T> &down = grown.down, &up = grown.up;
        return reach_of(aabb<T>{{add_down(box.lower.x, down.x), add_down(box.lower.y, down.y), add_down(box.lower.z, down.z)},
                                {add_up(box.upper.x, up.x), add_up(box.upper.y, up.y), add_up(box.upper.z, up.z)}});
    }
};

}  // namespace abut::detail
