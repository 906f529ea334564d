// SPDX-License-Identifier: MIT
#pragma once

// Do two convex hulls of points meet? They do if and only if the origin is in the hull of all differences of their points.
// This looks for it as E. Gilbert, D. Johnson and S. Keerthi do (A fast procedure for computing the distance between complex
// objects in three-dimensional space, 1988), in any kind of numbers: a simplex of at most four differences has a point that
// is nearest to the origin; of all differences the one that lies farthest back along the way to that point makes the next
// simplex, together with the feature that the point is on; if even that one lies ahead of the origin, the hulls are apart.
//
// The nearest feature is not found by regions but by what makes it the nearest, which no degenerate simplex confuses: a
// feature whose points are affinely independent, the foot of the origin on which is inside of it, and from which no other
// corner lies back. There always is one (Caratheodory). It is a corner p, if no other corner w has p.(w - p) < 0; or an edge
// from p along e, on which the foot is between the ends, with the way e x (p x e), of degree 3; or a triangle with the
// normal n, on which the foot has positive weights n.(a x b) and so on, with the way n or -n. If it is none of these, the
// origin is inside of a tetrahedron. No sign needs more than degree 4.
//
// In exact numbers it ends. The way to the nearest point v of a simplex is v up to a positive factor. If a difference w has
// v.w <= 0, which is less than v.v, the hull of v and w has points that are nearer than v. So no simplex comes twice.
// In rounded numbers it may not: then it stops where it would take a difference again, or after so many steps.

#include <concepts>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut::detail {

/// The corners of a simplex: corner k is the difference of point a[k] of one hull and point b[k] of the other.
struct difference_simplex {
    std::uint32_t a[4] = {}, b[4] = {};
    int count = 0;

    ABUT_HD constexpr void append(std::uint32_t i, std::uint32_t j) {
        a[count] = i;
        b[count] = j;
        ++count;
    }
    [[nodiscard]] ABUT_HD constexpr bool has(std::uint32_t i, std::uint32_t j) const {
        bool any = false;
        for (int k = 0; k < count; ++k) any = any || (a[k] == i && b[k] == j);
        return any;
    }
};

/// A number in a longer type: one of a type that has no lengths, as it is.
template <class N>
    requires(!requires(const N& n) { n.count; })
ABUT_HD constexpr N held_as(const N& x, const N*) { return x; }
template <int A, int B>
ABUT_HD constexpr rolled_int<A> held_as(const rolled_int<B>& x, const rolled_int<A>*) {
    rolled_int<A> r;
    r.begin(x.count);
    ABUT_ROLLED
    for (int i = 0; i < x.count; ++i) r.limb[i] = x.limb[i];
    return r;
}

/// Where a simplex is nearest to the origin.
enum class nearest_to : unsigned char {
    origin,   ///< it holds it
    feature,  ///< at the corners and along the way that were found
    nothing   ///< no feature seems to be the nearest, as rounded numbers may say
};

/// The nearest feature of a simplex, and the way to it from the origin, of any length.
template <class N>
class nearest_feature {
public:
    using cubic = decltype(N{} * N{} * N{});
    vec3<cubic> way;
    unsigned corners = 0;  ///< a bit for each

    /// Of those that have all the `needed` corners.
    ABUT_HD constexpr nearest_to find(const vec3<N> (&w)[4], int count, unsigned needed) {
        ABUT_ROLLED
        for (corners = 1; corners < 1u << count; ++corners) {
            if ((corners & needed) != needed) continue;
            const nearest_to found = look_at_feature(w, count);
            if (found != nearest_to::nothing) return found;
        }
        return count == 4 ? nearest_to::origin : nearest_to::nothing;  // of which all corners are left
    }

private:
    ABUT_HD constexpr nearest_to look_at_feature(const vec3<N> (&w)[4], int count) {
        int k[3] = {}, n = 0;
        for (int i = 0; i < count; ++i) {
            if ((corners >> i & 1) == 0) continue;
            if (n == 3) return nearest_to::nothing;
            k[n++] = i;
        }
        if (n == 1) return look_at_corner(w, count, k[0]);
        return n == 2 ? look_at_edge(w, count, k[0], k[1]) : look_at_face(w, count, k[0], k[1], k[2]);
    }

    template <class D>
    ABUT_HD static constexpr bool is_zero(const vec3<D>& v) {
        using abut::sign;
        return sign(v.x) == 0 && sign(v.y) == 0 && sign(v.z) == 0;
    }

    /// The feature is the nearest, if no other corner lies back from it.
    template <class D>
    ABUT_HD constexpr nearest_to unless_behind(const vec3<N> (&w)[4], int count, const vec3<D>& along, const vec3<N>& from) {
        ABUT_ROLLED
        for (int i = 0; i < count; ++i) {
            if ((corners >> i & 1) == 0 && sign_of_dot(along, w[i] - from) < 0) return nearest_to::nothing;
        }
        const cubic* const type = nullptr;
        way = {held_as(along.x, type), held_as(along.y, type), held_as(along.z, type)};
        return nearest_to::feature;
    }

    ABUT_NOINLINE ABUT_HD constexpr nearest_to look_at_corner(const vec3<N> (&w)[4], int count, int k) {
        return is_zero(w[k]) ? nearest_to::origin : unless_behind(w, count, w[k], w[k]);
    }
    ABUT_NOINLINE ABUT_HD constexpr nearest_to look_at_edge(const vec3<N> (&w)[4], int count, int k, int l) {
        const vec3<N>&p = w[k], &q = w[l];
        const vec3<N> e = q - p;
        if (sign_of_dot(e, p) >= 0 || sign_of_dot(e, q) <= 0) return nearest_to::nothing;
        const auto moment = cross(p, e);
        return is_zero(moment) ? nearest_to::origin : unless_behind(w, count, cross(e, moment), p);
    }
    ABUT_NOINLINE ABUT_HD constexpr nearest_to look_at_face(const vec3<N> (&w)[4], int count, int k, int l, int m) {
        const vec3<N>&a = w[k], &b = w[l], &c = w[m];
        const auto normal = cross(b - a, c - a);
        if (sign_of_dot(normal, cross(a, b)) <= 0 || sign_of_dot(normal, cross(b, c)) <= 0 ||
            sign_of_dot(normal, cross(c, a)) <= 0) {
            return nearest_to::nothing;
        }
        const int side = sign_of_dot(normal, a);
        if (side == 0) return nearest_to::origin;
        return side > 0 ? unless_behind(w, count, normal, a) : unless_behind(w, count, cross(c - a, b - a), a);
    }
};

/// Two hulls in numbers of some kind, as the search reads them:
///   difference(i, j)        point i of one less point j of the other
///   look_back(way, i, j)    finds the two points whose difference lies farthest back along a way
///   are_apart(way, i, j)    whether even that difference lies ahead of the origin, for sure
///   holds_origin(w, at)     whether it does, of a simplex that was found to
///   when_lost(at)           what to say where a difference comes again, and nothing else is known
///   most_steps              after which it is lost too
/// They may have way_between_middles(), a way to begin with; and is_enough(w, at), whether the feature that is nearest to the
/// origin, with its corners in `w`, says yes already.
template <class H>
concept hulls_in_numbers = requires(const H& x, const vec3<typename nearest_feature<typename H::number>::cubic>& way,
                                    std::uint32_t& i, const vec3<typename H::number> (&w)[4], const difference_simplex& at) {
    { H::most_steps } -> std::convertible_to<int>;
    { x.difference(i, i) } -> std::same_as<vec3<typename H::number>>;
    { x.look_back(way, i, i) } -> std::same_as<void>;
    { x.are_apart(way, i, i) } -> std::same_as<bool>;
    { x.holds_origin(w, at) } -> std::same_as<verdict>;
    { x.when_lost(at) } -> std::same_as<verdict>;
};

/// What is asked: whether hulls meet, or, if they do not, where they are nearest as well.
enum class sought : bool { meeting, nearest };

/// Whether hulls meet; `no` where they are apart. Begins at a simplex, any one, and leaves there what it came to: of hulls
/// that are apart, and of which the nearest points are sought, the feature that these are on. Its corners are then in `w`.
template <sought What, hulls_in_numbers Hulls>
ABUT_HD constexpr verdict search_origin(const Hulls& x, difference_simplex& at, vec3<typename Hulls::number> (&w)[4]) {
    using number = typename Hulls::number;
    if (at.count == 0) {
        std::uint32_t i = 0, j = 0;
        if constexpr (requires { x.way_between_middles(); }) {
            const auto way = x.way_between_middles();
            x.look_back(way, i, j);
            if constexpr (What == sought::meeting) {
                if (x.are_apart(way, i, j)) return verdict::no;
            }
        }
        at.append(i, j);
    }
    for (int k = 0; k < at.count; ++k) w[k] = x.difference(at.a[k], at.b[k]);
    unsigned needed = 0;
    for (int step = 0; step < Hulls::most_steps; ++step) {
        nearest_feature<number> nearest;
        const nearest_to found = nearest.find(w, at.count, needed);
        if (found == nearest_to::nothing) break;
        const difference_simplex before = at;
        if (nearest.corners < 1u << at.count) {
            at.count = 0;
            for (int k = 0; k < before.count; ++k) {
                if ((nearest.corners >> k & 1) == 0) continue;
                if (at.count != k) w[at.count] = w[k];
                at.append(before.a[k], before.b[k]);
            }
        }
        if (found == nearest_to::origin) return x.holds_origin(w, at);
        if constexpr (requires { x.is_enough(w, at); }) {
            if (x.is_enough(w, at)) return verdict::yes;
        }
        std::uint32_t i = 0, j = 0;
        x.look_back(nearest.way, i, j);
        if constexpr (What == sought::meeting) {
            if (x.are_apart(nearest.way, i, j)) return verdict::no;
        }
        if (before.has(i, j)) break;
        const vec3<number> next = x.difference(i, j);
        if constexpr (What == sought::nearest) {
            if (sign_of_dot(nearest.way, next - w[0]) >= 0) return verdict::no;
        }
        needed = 1u << at.count;
        w[at.count] = next;
        at.append(i, j);
    }
    return x.when_lost(at);
}

}  // namespace abut::detail
