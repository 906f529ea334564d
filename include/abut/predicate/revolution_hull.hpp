// SPDX-License-Identifier: MIT
#pragma once

// Does a cylinder or a cone touch a convex hull of points? It does if and only if its axis meets the hull, or a triangle of
// three of the points, which may be equal, meets it. For where they have a point in common and the axis misses the hull, the
// solid reaches out of it, through a face.
//
// The search of gjk.hpp, in double, ends with a way on which both are apart, or near the points that make that triangle. If
// those do not tell, the two mostly come closer than rounding, as shapes do that lie on each other. Then triangles of a few
// corners there are asked, and ways that are across these and the axis, in integers. Only then all triangles are. Of these
// one corner at least is no farther ahead than the solid reaches, along any way: a point of both is no farther, and so is a
// corner of its triangle.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_hull.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/solid_on_ways.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// A hull and a solid whose axis has a length, as gjk.hpp reads two hulls, in double. Of the solid the points are those that
/// were asked for: an end of the axis, and from there to the rim. Where it is not `Certified`, all is taken as it is
/// rounded.
template <bool Certified, solid_of_revolution S>
class hull_and_solid {
public:
    using T = scalar_type_of<S>;
    using number = double;
    static constexpr int most_steps = points_of_solid::room - 1;

    /// Of the solid and what is within `reach` of it, where the search asks whether both are apart.
    ABUT_HD constexpr hull_and_solid(const hull<T>& h, const S& s, const hull<T>& axis, points_of_solid& asked,
                                     double reach = 0)
        : both_(h, axis), solid_(s), asked_(asked), reach_(reach) {}

    [[nodiscard]] ABUT_HD constexpr vec3<double> axis() const { return solid_.axis; }
    [[nodiscard]] ABUT_HD constexpr vec3<double> way_between_middles() const { return both_.way_between_middles(); }
    [[nodiscard]] ABUT_HD constexpr vec3<double> difference(std::uint32_t i, std::uint32_t j) const {
        return both_.difference(i, asked_.end[j]) - asked_.to_rim[j];
    }
    ABUT_HD constexpr void look_back(const vec3<double>& way, std::uint32_t& i, std::uint32_t& j) const {
        std::uint32_t end = 0;
        const vec3<double> one = of_size_1(way);
        both_.look_back(one, i, end);
        end = end_on(one, i, end);
        j = asked_.append(end, solid_.to_rim(one, end));
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<double>& way, std::uint32_t i, std::uint32_t j) const {
        return is_ahead(of_size_1(way), i, asked_.end[j]);
    }
    ABUT_HD constexpr verdict holds_origin(const vec3<double> (&)[4], const difference_simplex& at) const {
        return when_lost(at);
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const {
        return Certified ? verdict::unknown : verdict::yes;
    }

    /// Of `n` points those that are not certain to be ahead of the solid on a way.
    ///@{
    [[nodiscard]] ABUT_HD constexpr std::size_t count_near(const vec3<double>& way, std::size_t n) const {
        std::size_t near = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (is_near(way, i)) ++near;
        }
        return near;
    }
    [[nodiscard]] ABUT_HD constexpr bool is_near(const vec3<double>& way, std::size_t i) const {
        const auto at = static_cast<std::uint32_t>(i);
        const vec3<double> one = of_size_1(way);
        const std::uint32_t end = both_.ahead(one, at, 1) < both_.ahead(one, at, 0) ? 1 : 0;
        return !is_ahead(one, at, end_on(one, at, end));
    }
    ///@}

private:
    /// The end at which the solid is farthest along a way of size 1, where the axis is so at `end`.
    [[nodiscard]] ABUT_HD constexpr std::uint32_t end_on(const vec3<double>& one, std::uint32_t i, std::uint32_t end) const {
        if (!solid_.is_cone) return end;
        return both_.ahead(one, i, 1) - solid_.reach(one, 1) < both_.ahead(one, i, 0) ? 1 : 0;
    }
    /// How far a point is ahead of all of the solid, which is farthest at this end, on a way of size 1.
    [[nodiscard]] ABUT_HD constexpr double ahead_of(const vec3<double>& one, std::uint32_t i, std::uint32_t end) const {
        return both_.ahead(one, i, end) - solid_.reach(one, end);
    }
    [[nodiscard]] ABUT_HD constexpr bool is_ahead(const vec3<double>& one, std::uint32_t i, std::uint32_t end) const {
        double ahead = ahead_of(one, i, end);
        if (reach_ > 0) ahead -= reach_ * square_root(dot(one, one));
        if constexpr (!Certified) return ahead > 0;
        return solid_.is_known && is_more_than_lost<T>(ahead, size());
    }

protected:
    [[nodiscard]] ABUT_HD constexpr double size() const { return both_.size() + solid_.radius + reach_; }
    [[nodiscard]] ABUT_HD constexpr double reach() const { return reach_; }
    [[nodiscard]] ABUT_HD constexpr bool is_known() const { return solid_.is_known; }

private:
    hulls_in_floats<true, T> both_;
    solid_beside_axis<S> solid_;
    points_of_solid& asked_;
    double reach_;
};

/// What a search came to: corners of a simplex, and their differences.
struct found_simplex {
    difference_simplex at;
    vec3<double> w[4];
};

/// The triangle of a simplex's points, of four without number `but`.
template <scalar T>
ABUT_HD constexpr triangle<T> face_without(const hull<T>& h, const difference_simplex& at, int but) {
    const auto corner = [&](int k) {
        const int i = k < but ? k : k + 1;
        return h[at.a[(i < at.count ? i : at.count - 1) & 3]];  // & 3: g++ may not see that there is a corner
    };
    return {corner(0), corner(1), corner(2)};
}

/// Whether a point is strictly beyond the last end of an axis.
struct is_beyond_end {
    static constexpr int degree = 2, points = 3;
    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[9]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1), p = point_at(value, 2);
        return sign_of_dot(p - last, last - first) > 0;
    }
};
template <scalar T>
ABUT_HD constexpr bool all_are_beyond(const hull<T>& h, const vec3<T>& first, const vec3<T>& last) {
    bool all = true;
    ABUT_ROLLED
    for (std::size_t i = 0; i < h.count && all; ++i) {
        const auto value = in_a_row(first, last, h[i]);
        const verdict v = decide_in_limbs<is_beyond_end>(value.value);
        all = v == verdict::unknown ? decide_at_any_span<is_beyond_end>(value.value) : v == verdict::yes;
    }
    return all;
}

/// A way that few of the hull's points are not certain to be ahead of the solid on, and their number.
template <solid_of_revolution S, scalar T>
struct steepest_way {
    vec3<double> way{0, 0, 0};
    std::size_t near;

    ABUT_HD constexpr steepest_way(const hull_and_solid<true, S>& x, const hull<T>& h, const found_simplex& found)
        : near(h.count + 1) {
        const vec3<double>(&w)[4] = found.w;
        double weight[3];
        offer(x, h, nearest_on_feature(w, least(found.at.count, 3), weight));
        offer(x, h, x.axis());
        if (found.at.count > 2) offer(x, h, cross(w[1] - w[0], w[2] - w[0]));
    }

private:
    ABUT_HD constexpr void offer(const hull_and_solid<true, S>& x, const hull<T>& h, const vec3<double>& n) {
        ABUT_ROLLED
        for (int sense = -1; sense < 2; sense += 2) {
            const vec3<double> one = static_cast<double>(sense) * n;
            const std::size_t there = x.count_near(one, h.count);
            if (there < near) near = there, way = one;
        }
    }
};

/// Whether a point x is ahead of all of a solid along n = (b - a) x (q - p): the axis's ends, a, b, p, q, x, the radius.
template <class Solid>
struct is_ahead_of_solid {
    static constexpr int degree = 8;
    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[22]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1), x = point_at(value, 6);
        const auto n = cross(point_at(value, 3) - point_at(value, 2), point_at(value, 5) - point_at(value, 4));
        const auto d = last - first;
        const auto over_first = dot(n, x - first), over_last = dot(n, x - last);
        return and_then(is_positive(over_first), [&] {
            return and_then(is_positive(over_last), [&] {
                const auto rim = scale(value[21], cross(n, d));
                return and_then(is_longer(scale(over_last, d), rim),
                                [&] { return Solid::is_cone ? verdict::yes : is_longer(scale(over_first, d), rim); });
            });
        });
    }
};

/// Whether the answer is yes, by all stages one after another.
template <class Question, scalar T, std::size_t V>
ABUT_HD constexpr bool holds_at_last(const T (&value)[V]) {
    verdict v = ABUT_CONSTANT_EVALUATED() ? verdict::unknown : ask_estimates<Question>(value);
    if (v == verdict::unknown) v = ask_integers<Question>(value);
    return v == verdict::unknown ? decide_at_any_length<asked_exactly<Question>>(value) : v == verdict::yes;
}

/// Whether all of a hull is ahead of a solid along (b - a) x (q - p), or along the opposite.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool are_apart_along(const S& s, const hull<T>& h, const vec3<T>& a, const vec3<T>& b,
                                                     const vec3<T>& p, const vec3<T>& q) {
    using question = is_ahead_of_solid<typename questions_of<S>::type>;
    const segment<T> axis = axis_of(s);
    ABUT_ROLLED
    for (int sense = 0; sense < 2; ++sense) {
        bool all = true;
        ABUT_ROLLED
        for (std::size_t i = 0; i < h.count && all; ++i) {
            const vec3<T>&from = sense == 0 ? a : b, &to = sense == 0 ? b : a;
            all = holds_at_last<question>(in_a_row(axis.a, axis.b, from, to, p, q, h[i], s.radius).value);
        }
        if (all) return true;
    }
    return false;
}

/// The few corners of a hull that are nearest to where a solid is farthest along a way, of those that the way leaves.
template <solid_of_revolution S, scalar T>
class nearest_corners {
public:
    ABUT_HD constexpr nearest_corners(const hull_and_solid<true, S>& x, const hull<T>& h, const vec3<double>& way) {
        std::uint32_t i = 0, j = 0;
        x.look_back(way, i, j);
        double size[most]{};
        for (i = 0; i < h.count; ++i) {
            if (!x.is_near(way, i)) continue;
            const vec3<double> apart = x.difference(i, j);
            const double here = dot(apart, apart);
            if (count_ == most && !(here < size[most - 1])) continue;
            int k = count_ < most ? count_++ : most - 1;
            for (; k > 0 && here < size[k - 1]; --k) size[k] = size[k - 1], corner_[k] = corner_[k - 1];
            size[k] = here, corner_[k] = h[i];
        }
    }

    [[nodiscard]] ABUT_HD constexpr std::size_t size() const { return static_cast<std::size_t>(count_); }
    [[nodiscard]] ABUT_HD constexpr const vec3<T>& operator[](std::size_t i) const { return corner_[i]; }
    /// Whether the two are apart along the normal of a face of three of them, across an edge of two and the axis, or from
    /// the axis towards one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool are_apart(const S& s, const hull<T>& h) const {
        const segment<T> axis = axis_of(s);
        const vec3<T> none{0, 0, 0};
        ABUT_ROLLED
        for (int i = 0; i < count_; ++i) {
            const vec3<T> beside = tangent_at(axis, axis.a, corner_[i], corner_[i]);
            if (are_apart_along(s, h, axis.a, axis.b, none, beside)) return true;
            ABUT_ROLLED
            for (int j = i + 1; j < count_; ++j) {
                if (are_apart_along(s, h, corner_[i], corner_[j], axis.a, axis.b)) return true;
                ABUT_ROLLED
                for (int end = 0; end < 2; ++end) {
                    const vec3<T> tangent = tangent_at(axis, end == 0 ? axis.a : axis.b, corner_[i], corner_[j]);
                    if (are_apart_along(s, h, corner_[i], corner_[j], none, tangent)) return true;
                }
                ABUT_ROLLED
                for (int k = j + 1; k < count_; ++k) {
                    if (are_apart_along(s, h, corner_[i], corner_[j], corner_[i], corner_[k])) return true;
                }
            }
        }
        return false;
    }

private:
    /// Across the axis and the way from it to where the edge from p to q passes the plane of an end, or to p; as it is
    /// rounded.
    ABUT_HD static constexpr vec3<T> tangent_at(const segment<T>& axis, const vec3<T>& end, const vec3<T>& p,
                                                const vec3<T>& q) {
        const vec3<double> d = relative_to(axis.a, axis.b), from = relative_to(end, p), to = relative_to(end, q);
        const double s = dot(from, d), t = dot(to, d);
        const vec3<double> at = s != t ? (t / (t - s)) * from - (s / (t - s)) * to : from, way = cross(at, d);
        const double size = magnitudes(way);
        if (!(size > 0x1p-900 && size < 0x1p900)) return {0, 0, 0};
        const vec3<double> one = (1 / size) * way;
        return {static_cast<T>(one.x), static_cast<T>(one.y), static_cast<T>(one.z)};
    }

    static constexpr int most = 8;
    vec3<T> corner_[most]{};
    int count_ = 0;
};

/// By the search, and by the triangle and the axis, which are asked one stage.
template <arithmetic A, solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict search_solid(const S& s, const hull<T>& h) {
    constexpr bool certified = !std::same_as<A, fast>;
    const corner_hull<T, 2> axis = points_of(axis_of(s));
    found_simplex found;
    const hull<T> ends = axis.as_hull();
    points_of_solid asked;
    const verdict met = search_origin<sought::meeting>(hull_and_solid<certified, S>(h, s, ends, asked), found.at, found.w);
    if (met != verdict::unknown) return met;
    const int faces = found.at.count == 4 ? 4 : 1;
    for (int but = 0; but < faces; ++but) {
        if (decide<A>(s, face_without(h, found.at, faces == 4 ? but : 3)) == verdict::yes) return verdict::yes;
    }
    return decide<A>(h, axis_of(s)) == verdict::yes ? verdict::yes : verdict::unknown;
}

/// Whether shapes touch, by all stages one after another.
template <class S, class U>
ABUT_HD constexpr bool touch_exactly(const S& s, const U& t) {
    verdict v = ABUT_CONSTANT_EVALUATED() ? verdict::unknown : decide<filtered>(s, t);
    if (v == verdict::unknown) v = decide<exact>(s, t);
    return v == verdict::unknown ? resolve(s, t) : v == verdict::yes;
}

/// Whether edge(p, q) or face(p, q, r) holds of any edge or face of n points, one of whose corners is of those that is_first(i)
/// says. All edges are asked first, and each once.
template <class Points, class First, class Edge, class Face>
ABUT_HD constexpr bool any_feature(const Points& p, std::size_t n, const First& is_first, const Edge& edge, const Face& face) {
    const auto is_asked = [&](std::size_t j, std::size_t i) { return j == i || (j < i && is_first(j)); };
    for (std::size_t i = 0; i < n; ++i) {
        if (!is_first(i)) continue;
        for (std::size_t j = 0; j < n; ++j) {
            if ((j == i || !is_asked(j, i)) && edge(p[i], p[j])) return true;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (!is_first(i)) continue;
        for (std::size_t j = 0; j < n; ++j) {
            if (is_asked(j, i)) continue;
            for (std::size_t k = j + 1; k < n; ++k) {
                if (!is_asked(k, i) && face(p[i], p[j], p[k])) return true;
            }
        }
    }
    return false;
}
/// The first argument of it where all points are of those.
struct all_points {
    ABUT_HD constexpr bool operator()(std::size_t) const { return true; }
};

/// Whether a solid, whose axis has a length, touches a hull.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool touches_hull(const S& s, const hull<T>& h) {
    const segment<T> axis = axis_of(s);
    if (!overlaps(bounds(s), bounds(h))) return false;  // where numbers leave the range of the search
    if (touch_exactly(h, axis)) return true;
    if (all_are_beyond(h, axis.a, axis.b) || all_are_beyond(h, axis.b, axis.a)) return false;
    const corner_hull<T, 2> points = points_of(axis);
    const hull<T> ends = points.as_hull();
    points_of_solid asked;
    const hull_and_solid<true, S> x(h, s, ends, asked);
    found_simplex found;
    if (search_origin<sought::meeting>(x, found.at, found.w) == verdict::no) return false;
    const auto edge = [&](const vec3<T>& p, const vec3<T>& q) { return touch_exactly(s, segment<T>{p, q}); };
    const auto face = [&](const vec3<T>& p, const vec3<T>& q, const vec3<T>& r) {
        const triangle<T> t{p, q, r};
        if (!ABUT_CONSTANT_EVALUATED() && decide_in_place<filtered>(capsule_around(s), t) == verdict::no) return false;
        return holds_at_last<revolution_meets_inside<typename questions_of<S>::type>>(
            values_of(axis, s.radius, points_of(t)).value);
    };
    const steepest_way<S, T> steepest(x, h, found);
    const nearest_corners<S, T> few(x, h, steepest.way);
    if (any_feature(few, few.size(), all_points(), edge, face)) return true;
    if (few.are_apart(s, h)) return false;
    return any_feature(h, h.count, [&](std::size_t i) { return x.is_near(steepest.way, i); }, edge, face);
}

}  // namespace detail

/// One stage of the decision, as for two hulls, of a cylinder or a cone and a hull. Its radius is >= 0. `exact` is unknown
/// where it finds no way on which they are apart, and no triangle that touches.
template <arithmetic A, detail::solid_of_revolution S>
ABUT_HD constexpr verdict decide(const S& s, const hull<scalar_type_of<S>>& h) {
    if (detail::is_point(detail::axis_of(s))) return detail::decide_in_place<A>(detail::ball_around(s), h);
    return detail::search_solid<A>(s, h);
}

/// The last stage: decides every finite input. Where hull and solid come closer than rounding and do not touch, it may take
/// as long as there are triangles of points.
template <detail::solid_of_revolution S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const S& s, const hull<scalar_type_of<S>>& h) {
    if (detail::is_point(detail::axis_of(s))) return detail::touch_exactly(detail::ball_around(s), h);
    return detail::touches_hull(s, h);
}

}  // namespace abut
