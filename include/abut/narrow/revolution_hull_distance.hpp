// SPDX-License-Identifier: MIT
#pragma once

// The triangle of a convex hull's points that is nearest to a cylinder or a cone that does not touch the hull: its distance
// is the hull's.
//
// A triangle is the nearest if no point makes a nearer one in the place of one of its corners. For if the hull has a nearer
// place, so has the tetrahedron of the triangle and some point; and as the solid does not touch that, the nearest place of
// it is on a face, which has the point. Each step takes the point that lies farthest back along the way, and mostly what
// lies farthest back tells as well that no point makes a nearer one: all of the hull is as far along the way. Where rounding
// leaves that open, all points are tried.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/plain_hull_and_solid.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_hull.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// `measure(triangle)` gives its distance, and the way to it.
template <solid_of_revolution S, class Measure>
class nearest_triangle {
public:
    using T = scalar_type_of<S>;
    triangle<T> best{};

    ABUT_HD constexpr nearest_triangle(const S& s, const hull<T>& h, const Measure& measure) : measure_(measure) {
        const contact_math::common_scale scale(s, h);
        const vec3<double> origin = scale(axis_of(s).a);
        const contact_math::seen_round_solid solid(s, origin, scale);
        typename plain_hull_and_solid<T>::places asked;
        const plain_hull_and_solid<T> x(h, solid, origin, scale, asked);
        const difference_simplex at = x.search();
        best = face_without(h, at, 3);  // also where its distance is above all numbers
        const int faces = at.count == 4 ? 4 : 1;
        for (int but = 0; but < faces; ++but) offer(face_without(h, at, faces == 4 ? but : 3));
        for (bool better = true; better;) {
            if (x.is_nearest_along(way_, distance_)) return;
            better = exchange(h[x.farthest_back(way_)]);
            for (std::size_t k = 0; k < h.count && !better; ++k) better = exchange(h[k]);
        }
    }

private:
    const Measure& measure_;
    double distance_ = infinity<double>;
    vec3<double> way_{0, 0, 0};

    ABUT_HD constexpr bool offer(const triangle<T>& t) {
        const auto found = measure_(t);
        if (!(found.distance < distance_)) return false;
        best = t;
        distance_ = found.distance;
        way_ = found.way;
        return true;
    }
    /// With a point for one of the corners.
    ABUT_HD constexpr bool exchange(const vec3<T>& p) {
        const triangle<T> old = best;
        bool better = offer({p, old.b, old.c});
        better = offer({old.a, p, old.c}) || better;
        return offer({old.a, old.b, p}) || better;
    }
};

}  // namespace abut::detail
