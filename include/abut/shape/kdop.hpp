// SPDX-License-Identifier: MIT
#pragma once

// Discrete oriented polytopes: the space between K/2 pairs of parallel planes, whose normals are the coordinate axes and
// sums of them (J. Klosowski et al., Efficient collision detection using bounding volume hierarchies of k-DOPs, 1998).
// Normals are vectors of -1, 0 and 1 and no unit vectors: planes are then sums of two or three coordinates, rounded
// outward.
//
// Under a pose, each slab of one polytope is compared with how far the other reaches along that normal n. In the other's
// frame that is a vector m, and m is a sum of three of the polytope's own normals with weights that are not negative: the
// same sum of its planes bounds m . x for all x in it. So K slabs are compared, and no linear program is solved.
//
// Its error, with the notation of relative_pose.hpp: |n| <= 1.7321, |m| <= 1.738 and the sum of |m|'s coordinates is below
// 3.02. m is off by 3.5 e a coordinate, and as a sum of weights times normals by 12.1 e more; the bound itself is a sum of
// three products, whose magnitudes add up to M: 5 e M. n . t carries 9 e |t|, the sums that are compared 2 e of their
// magnitudes. From b's normals to a's frame, R^T R - 1 counts too: 3 dev(R) Q, of the 7 dev(R) Q in 1.75 slack that nothing
// else needs. The code takes 1.75 slack + e (24 (|x| + |t|) + 8 M + 4 |planes|) with |x| from
// the polytope's own box.

#include <cstddef>
#include <type_traits>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut {

/// @addtogroup volumes
///@{

/// All x with lower[i] <= n_i . x <= upper[i]. The normals n_i, in order: x, y, z; for K = 14 and 26 the diagonals (1, 1,
/// 1), (1, 1, -1), (1, -1, 1), (1, -1, -1); for K = 18 and 26 (1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0,
/// 1, -1).
template <scalar T, int K>
    requires(K == 14 || K == 18 || K == 26)
struct kdop {
    T lower[std::size_t{K / 2}];  ///< of n_i . x, for each normal in that order
    T upper[std::size_t{K / 2}];  ///< likewise
};

namespace detail {

/// Coordinates -1, 0 or 1, not all 0.
struct kdop_normal {
    int x, y, z;
};

template <int K>
inline constexpr bool has_diagonals = K == 14 || K == 26;

template <int K>
ABUT_HD constexpr kdop_normal normal_of(int i) {
    if (i < 3) return {i == 0, i == 1, i == 2};
    i -= 3;
    if (has_diagonals<K>) {
        if (i < 4) return {1, i < 2 ? 1 : -1, i % 2 == 0 ? 1 : -1};
        i -= 4;
    }
    const int sign = i % 2 == 0 ? 1 : -1;
    return i < 2 ? kdop_normal{1, sign, 0} : i < 4 ? kdop_normal{1, 0, sign} : kdop_normal{0, 1, sign};
}

/// The number of a normal whose first coordinate that is not 0 is 1.
template <int K>
ABUT_HD constexpr int number_of(const kdop_normal& n) {
    const int not_zero = (n.x != 0) + (n.y != 0) + (n.z != 0), last_is_negative = n.z < 0;
    if (not_zero == 1) return n.x != 0 ? 0 : n.y != 0 ? 1 : 2;
    if (not_zero == 3) return 3 + 2 * (n.y < 0) + last_is_negative;
    const int first = has_diagonals<K> ? 7 : 3;
    return n.z == 0 ? first + (n.y < 0) : n.y == 0 ? first + 2 + last_is_negative : first + 4 + last_is_negative;
}

/// A sum of coordinates with signs, rounded up. Sums with 0 are exact.
template <scalar T>
ABUT_HD constexpr T along_up(const kdop_normal& n, const vec3<T>& p) {
    const auto term = [](int sign, T x) { return sign == 0 ? T(0) : sign < 0 ? -x : x; };
    return add_up(add_up(term(n.x, p.x), term(n.y, p.y)), term(n.z, p.z));
}

/// Bounds on m . x over a polytope, and the sum of the magnitudes that they were added up from.
template <scalar T>
struct kdop_reach {
    T least, most, magnitude;

    /// weight n . x, for a normal n of the polytope or the negative of one
    template <int K>
    ABUT_HD constexpr void add(const kdop<T, K>& v, T weight, const kdop_normal& n) {
        if (!(weight > 0)) return;  // of a plane at infinity, 0 times is 0
        const int first = n.x != 0 ? n.x : n.y != 0 ? n.y : n.z, i = number_of<K>({n.x * first, n.y * first, n.z * first});
        const T low = weight * (first > 0 ? v.lower[i] : -v.upper[i]),
                high = weight * (first > 0 ? v.upper[i] : -v.lower[i]);
        least += low;
        most += high;
        magnitude += absolute(low) + absolute(high);
    }
};

template <scalar T, int K>
ABUT_HD constexpr kdop_reach<T> reach_along(const kdop<T, K>& v, const vec3<T>& m) {
    // The coordinates by magnitude: a >= b >= c, of axes i, j and k.
    const T size[3] = {absolute(m.x), absolute(m.y), absolute(m.z)};
    const int sign[3] = {m.x < 0 ? -1 : 1, m.y < 0 ? -1 : 1, m.z < 0 ? -1 : 1};
    const int larger = size[1] > size[0], i = size[2] > size[larger] ? 2 : larger, other = (i + 1) % 3, rest = (i + 2) % 3;
    const int j = size[rest] > size[other] ? rest : other, k = 3 - i - j;
    const T a = size[i], b = size[j], c = size[k];
    kdop_reach<T> r{0, 0, 0};
    const auto add = [&](T weight, bool with_i, bool with_j, bool with_k) {
        const auto at = [&](int axis) {
            return (axis == i && with_i) || (axis == j && with_j) || (axis == k && with_k) ? sign[axis] : 0;
        };
        r.add(v, weight, {at(0), at(1), at(2)});
    };
    if constexpr (K == 18) {
        if (a < b + c) {  // between the three edges
            add((a + b - c) / 2, true, true, false);
            add((a + c - b) / 2, true, false, true);
            add((b + c - a) / 2, false, true, true);
        } else {
            add(b, true, true, false);
            add(c, true, false, true);
            add(a - b - c, true, false, false);
        }
    } else {
        add(c, true, true, true);
        if constexpr (K == 26) {
            add(b - c, true, true, false);
            add(a - b, true, false, false);
        } else {
            add(b - c, false, true, false);
            add(a - c, true, false, false);
        }
    }
    return r;
}

/// Whether the slab [lower, upper] may meet the other polytope, which reaches as far as `reach` says and is moved by
/// `shift`. The rest that was rounded adds up to `sum`.
template <scalar T>
ABUT_HD constexpr bool slab_meets(T lower, T upper, const kdop_reach<T>& reach, T shift, T sum, T slack) {
    constexpr T e = 2 * unit_roundoff<T>, flushed = 128 * smallest_normal<T>;
    const T planes = absolute(lower) + absolute(upper);
    const T lost = slack + (e * (24 * sum + 8 * reach.magnitude + 4 * planes) + flushed);
    const bool apart = shift + reach.least > upper + lost || shift + reach.most < lower - lost;
    return !(apart && sum + reach.magnitude + planes < largest_finite<T> / 64);
}

}  // namespace detail

/// A box along the coordinate axes around it: its first three slabs.
template <scalar T, int K>
ABUT_HD constexpr aabb<T> bounds(const kdop<T, K>& v) {
    return {{v.lower[0], v.lower[1], v.lower[2]}, {v.upper[0], v.upper[1], v.upper[2]}};
}

/// The smallest representable polytope around triangles, at least one.
template <scalar T, int K, class Triangles>
ABUT_HD constexpr kdop<T, K> around_all(std::type_identity<kdop<T, K>>, const Triangles& triangles) {
    kdop<T, K> r{};
    for (int i = 0; i < K / 2; ++i) {
        r.lower[i] = infinity<T>;
        r.upper[i] = -infinity<T>;
    }
    detail::for_each_corner<T>(triangles, [&r](const vec3<T>& p) {
        for (int i = 0; i < K / 2; ++i) {
            const detail::kdop_normal n = detail::normal_of<K>(i);
            r.upper[i] = detail::greatest(r.upper[i], detail::along_up(n, p));
            r.lower[i] = detail::least(r.lower[i], -detail::along_up({-n.x, -n.y, -n.z}, p));
        }
    });
    return r;
}

/// The smallest polytope around both. Exact.
template <scalar T, int K>
ABUT_HD constexpr kdop<T, K> merge(const kdop<T, K>& a, const kdop<T, K>& b) {
    kdop<T, K> r{};
    for (int i = 0; i < K / 2; ++i) {
        r.lower[i] = detail::least(a.lower[i], b.lower[i]);
        r.upper[i] = detail::greatest(a.upper[i], b.upper[i]);
    }
    return r;
}

/// Whether no slab of one is beside the other's. False is certain; true is not, because other axes may separate them.
template <scalar T, int K>
ABUT_HD constexpr bool overlaps(const kdop<T, K>& a, const kdop<T, K>& b) {
    for (int i = 0; i < K / 2; ++i) {
        if (a.lower[i] > b.upper[i] || b.lower[i] > a.upper[i]) return false;
    }
    return true;
}

/// Whether polytopes, each in the frame of its object, may hold shapes that meet in the world, as for boxes
/// (relative_pose.hpp): the slabs of each against the other's reach along their normals. False is certain.
template <scalar T, int K>
ABUT_HD constexpr bool overlaps(const kdop<T, K>& a, const relative_pose<T>& pose, const kdop<T, K>& b) {
    using namespace detail;
    const vec3<T>* const r = pose.rotation;
    const vec3<T> t = pose.translation;
    const auto farthest_coordinates = [](const kdop<T, K>& v) {
        const aabb<T> box = bounds(v);
        return magnitudes(greatest(absolute(box.lower), absolute(box.upper)));
    };
    const T moved = magnitudes(t), of_a = farthest_coordinates(a) + moved, of_b = farthest_coordinates(b) + moved;
    const T slack = T(1.75) * pose.slack;
    for (int i = 0; i < K / 2; ++i) {
        const kdop_normal n = normal_of<K>(i);
        const vec3<T> normal{static_cast<T>(n.x), static_cast<T>(n.y), static_cast<T>(n.z)};
        // Of a: n . p = (R^T n) . q + n . t
        const vec3<T> m = normal.x * r[0] + normal.y * r[1] + normal.z * r[2];
        if (!slab_meets(a.lower[i], a.upper[i], reach_along(b, m), dot(normal, t), of_b, slack)) {
            return false;
        }
        // Of b: n . q = (R n) . p - (R n) . t
        const vec3<T> w{dot(r[0], normal), dot(r[1], normal), dot(r[2], normal)};
        if (!slab_meets(b.lower[i], b.upper[i], reach_along(a, w), -dot(w, t), of_a, slack)) {
            return false;
        }
    }
    return true;
}

///@}

}  // namespace abut
