// SPDX-License-Identifier: MIT
#pragma once

// Which cheaper choice cannot be wrong for given sets. Everything that `advise` says follows from what it reads of all
// numbers of the sets, by a proof that stands beside the rule. What has no proof is not said.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/collide/operand.hpp>
#include <abut/execution/policy.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// What `advise` found. Each flag says yes only where that is proven; no means "not proven", and costs at most time.
struct advice {
    /// `any<fast>`, `count<fast>`, `pairs<fast>` and `for_each_pair<fast>` of these sets give the answers of `exact`: every
    /// value that they compute is a floating-point number, and nothing is rounded. Holds while the sets rest and are not
    /// posed. For triangles against triangles or segments, and spheres against spheres; no for all other shapes.
    bool fast_is_exact = false;
    /// All numbers are floats: sets of float hold the same shapes in half of the memory, and `filtered` and `exact` find the
    /// same pairs. `fast_is_exact` speaks of the sets as they are: ask again about those of float. Yes for sets of float.
    bool floats_suffice = false;
    /// All spheres of each set have one radius: `equal_spheres` holds the same. No for other shapes and for empty sets.
    bool equal_radii = false;
    /// All numbers are multiples of 2^grid_exponent; 0 where all of them are 0.
    int grid_exponent = 0;
    /// No two coordinates of one axis are further apart than this many such multiples; infinity beyond the range of double.
    double grid_extent = 0;
};

namespace detail {

/// What is read of the numbers of some shapes.
template <scalar T>
struct number_facts {
    aabb<T> box = empty_box<T>();
    T least_radius = infinity<T>, greatest_radius = -1;
    int unit = 1 << 20;  ///< all numbers are multiples of 2^unit
    bool floats = true;

    ABUT_HD constexpr void add_number(T x) {
        const binary_parts parts = take_apart(x);
        if (parts.mantissa != 0 && parts.exponent < unit) unit = parts.exponent;
        if constexpr (std::same_as<T, double>) floats = floats && is_float(parts);
    }
    ABUT_HD constexpr void add(const vec3<T>& p) {
        add_number(p.x);
        add_number(p.y);
        add_number(p.z);
        box = merge(box, aabb<T>{p, p});
    }
    ABUT_HD constexpr void add_radius(T r) {
        add_number(r);
        least_radius = r < least_radius ? r : least_radius;
        greatest_radius = r > greatest_radius ? r : greatest_radius;
    }

private:
    /// By bits: g++ 12, when it vectorises, may leave out the rounding of a number that is narrowed and widened again.
    ABUT_HD static constexpr bool is_float(const binary_parts& x) {
        const std::int64_t size = x.mantissa < 0 ? -x.mantissa : x.mantissa;
        if (size == 0) return true;
        const int width = static_cast<int>(ABUT_BIT_CAST(std::uint64_t, static_cast<double>(size)) >> 52) - 1022;
        return width <= 24 && x.exponent >= -149 && x.exponent + width <= 128;
    }
};

template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const vec3<T>& p) {
    facts.add(p);
}
template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const triangle<T>& t) {
    facts.add(t.a);
    facts.add(t.b);
    facts.add(t.c);
}
template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const segment<T>& s) {
    facts.add(s.a);
    facts.add(s.b);
}
template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const aabb<T>& box) {
    facts.add(box.lower);
    facts.add(box.upper);
}
template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const sphere<T>& s) {
    facts.add(s.center);
    facts.add_radius(s.radius);
}
template <scalar T>
ABUT_HD constexpr void add_shape(number_facts<T>& facts, const capsule<T>& c) {
    add_shape(facts, c.axis);
    facts.add_radius(c.radius);
}

template <shape_view Shapes>
struct facts_of_shape {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    ABUT_HD number_facts<T> operator()(std::size_t i) const {
        number_facts<T> facts;
        add_shape(facts, shapes[i]);
        return facts;
    }
};

struct join_facts {
    template <scalar T>
    ABUT_HD number_facts<T> operator()(const number_facts<T>& a, const number_facts<T>& b) const {
        number_facts<T> all;
        all.box = merge(a.box, b.box);
        all.least_radius = least(a.least_radius, b.least_radius);
        all.greatest_radius = greatest(a.greatest_radius, b.greatest_radius);
        all.unit = a.unit < b.unit ? a.unit : b.unit;
        all.floats = a.floats && b.floats;
        return all;
    }
};

/// The degree of what `fast` computes to decide a pair: how many differences of coordinates one of its products has. 0 for
/// pairs of which rounds_nothing has no proof.
template <class S, class U>
inline constexpr int proven_degree = 0;
template <scalar T>
inline constexpr int proven_degree<triangle<T>, triangle<T>> = 3;
template <scalar T>
inline constexpr int proven_degree<triangle<T>, segment<T>> = 3;
template <scalar T>
inline constexpr int proven_degree<segment<T>, triangle<T>> = 3;
template <scalar T>
inline constexpr int proven_degree<sphere<T>, sphere<T>> = 2;

/// Whether `fast` rounds nothing. Let all numbers be multiples of u = 2^unit, and coordinates of one axis at most E u apart,
/// and let T have p digits. Then differences of coordinates are multiples of u up to E u.
///
/// Triangles and segments (certified_triangles.hpp, exact_triangles.hpp): each sign is that of a determinant of three
/// vectors from one corner. A coordinate of the first two's cross product is twice the area of a triangle in a square of
/// side E u, so at most E^2 u^2; the determinant and the sums on the way to it are multiples of u^3 up to 3 E^3 u^3. With 3
/// E^3 <= 2^p all are numbers of T, if u^3 is normal and 2^p u^3 finite.
///
/// Spheres (sphere_sphere.hpp): |d|^2 is a multiple of u^2 up to 3 E^2 u^2, and (r + s)^2 one up to (2 R)^2 with R the
/// largest radius. 3 E^2 <= 2^p and 2 R <= 2^(p / 2) u are enough.
///
/// What is computed exactly does not depend on the rounding mode, nor on whether products are contracted.
template <int Degree, scalar T>
bool rounds_nothing(const number_facts<T>& facts, double extent) {
    constexpr int digits = float_format<T>::digits, least_exponent = std::same_as<T, float> ? -126 : -1022;
    constexpr int greatest_exponent = std::same_as<T, float> ? 127 : 1023;
    if (Degree * facts.unit < least_exponent || Degree * facts.unit + digits > greatest_exponent) return false;
    if (Degree == 2 && static_cast<double>(facts.greatest_radius) > std::ldexp(1.0, facts.unit + digits / 2 - 1))
        return false;
    return 3 * (Degree == 3 ? extent * extent * extent : extent * extent) <= std::ldexp(1.0, digits);
}

/// How many units the numbers of an axis are apart, at most. Exact below 2^53: a difference of multiples of a unit is one,
/// and larger ones are rounded to no less than 2^53.
template <scalar T>
double extent_in_units(const number_facts<T>& facts) {
    const auto length = [&](T lower, T upper) {
        return lower <= upper ? std::ldexp(static_cast<double>(upper) - static_cast<double>(lower), -facts.unit) : 0.0;
    };
    const aabb<T>& box = facts.box;
    return greatest(length(box.lower.x, box.upper.x), length(box.lower.y, box.upper.y), length(box.lower.z, box.upper.z));
}

template <scalar T>
struct facts_of_set {
    number_facts<T> facts;
    bool holds_spheres;

    [[nodiscard]] bool has_one_radius() const { return facts.least_radius == facts.greatest_radius; }
};

/// Whether `advise` takes it.
template <class Policy, class X>
consteval bool can_be_read() {
    if constexpr (!can_be_asked<Policy, X>()) {
        return false;
    } else if constexpr (is_posed<X>) {
        static_assert(
            !is_posed<X>,
            "abut::advise: posed coordinates are rounded, and nothing is proven of them; ask about the set at rest");
        return false;
    } else {
        using shape_type = typename shape_of_argument<X>::type;
        constexpr bool is = requires(number_facts<scalar_type_of<shape_type>> & facts, const shape_type& s) {
            add_shape(facts, s);
        };
        static_assert(is, "abut::advise: knows triangles, segments, points, spheres, capsules and boxes that do not move");
        return is;
    }
}

template <class Policy, class Operand>
auto facts_of(const Policy& on, const Operand& x) {
    const auto shapes = x.shapes();
    using shapes_type = std::remove_const_t<decltype(shapes)>;
    using T = typename shapes_type::scalar_type;
    return facts_of_set<T>{reduce(on, shapes.size(), number_facts<T>{}, join_facts{}, facts_of_shape<shapes_type>{shapes}),
                           std::same_as<typename shapes_type::shape_type, sphere<T>>};
}

template <int Degree, scalar T>
advice advice_for(const facts_of_set<T>& a, const facts_of_set<T>& b) {
    number_facts<T> all = join_facts{}(a.facts, b.facts);
    if (all.unit == number_facts<T>{}.unit) all.unit = 0;  // no number but 0
    advice said;
    said.grid_exponent = all.unit;
    said.grid_extent = extent_in_units(all);
    said.floats_suffice = all.floats;
    said.equal_radii = (a.holds_spheres || b.holds_spheres) && (!a.holds_spheres || a.has_one_radius()) &&
                       (!b.holds_spheres || b.has_one_radius());
    if constexpr (Degree > 0) said.fast_is_exact = rounds_nothing<Degree>(all, said.grid_extent);
    return said;
}

}  // namespace detail

/// Which cheaper choice cannot be wrong in queries of a with b: sets, views, indices or single shapes at rest, of triangles,
/// segments, points, spheres, capsules or boxes. Reads each number once.
///
///     const auto said = abut::advise(on, voxels, tool);
///     const auto n = said.fast_is_exact ? abut::count<abut::fast>(on, voxels, tool) : abut::count(on, voxels, tool);
///
/// @ingroup queries
template <execution_policy Policy, class A, class B>
[[nodiscard]] advice advise(const Policy& on, const A& a, const B& b) {
    if constexpr (!detail::can_be_read<Policy, A>()) {
        return {};
    } else if constexpr (!detail::can_be_read<Policy, B>()) {
        return {};
    } else if constexpr (detail::have_one_scalar<A, B>()) {
        constexpr const char* function = "abut::advise";
        const auto x = detail::make_operand(on, a, function);
        const auto y = detail::make_operand(on, b, function);
        using S = typename decltype(x.shapes())::shape_type;
        using U = typename decltype(y.shapes())::shape_type;
        return detail::advice_for<detail::proven_degree<S, U>>(detail::facts_of(on, x), detail::facts_of(on, y));
    } else {
        return {};
    }
}

/// The same of a set with itself.
///
/// @ingroup queries
template <execution_policy Policy, class A>
[[nodiscard]] advice advise(const Policy& on, const A& a) {
    if constexpr (detail::can_be_read<Policy, A>()) {
        const auto x = detail::make_operand(on, a, "abut::advise");
        using S = typename decltype(x.shapes())::shape_type;
        const auto facts = detail::facts_of(on, x);
        return detail::advice_for<detail::proven_degree<S, S>>(facts, facts);
    } else {
        return {};
    }
}

}  // namespace abut
