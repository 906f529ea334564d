// SPDX-License-Identifier: MIT
#pragma once

// winding_number: how often a surface of triangles, which need not be closed, goes round each of many points.
//
// By definition the sum of the solid angles of all triangles over 4 pi, with the sign of the side that the point is on
// (A. Jacobson, L. Kavan, O. Sorkine-Hornung: Robust Inside-Outside Segmentation using Generalized Winding Numbers, 2013).
// A point is one thread's work, which adds up in a fixed order.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/far_field.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/narrow/solid_angle.hpp>

namespace abut {

/// Options of `winding_number`.
/// @ingroup queries
struct winding_options {
    /// By how much an answer may be off, besides rounding. 0 adds up all triangles. The default is far below 1/2,
    /// which tells inside from outside, and answers are seldom off by a hundredth of it.
    double tolerance = 1e-3;
};

namespace detail {

inline void check_tolerance(double tolerance, const char* function) {
    if (tolerance >= 0 && tolerance < infinity<double>) return;
    throw error(std::string(function) + ": tolerance is " + std::to_string(tolerance) + ", expected 0 or more, and finite");
}

/// A sum of many numbers, as if it had twice as many digits.
struct long_sum {
    double high = 0, low = 0;
    ABUT_HD void add(double x) {
        const error_free<double> s = two_sum(high, x);
        high = s.value;
        low = plain_sum(low, s.error);
    }
    [[nodiscard]] ABUT_HD double total() const { return plain_sum(high, low); }
};

/// All triangles, one after another.
template <shape_view Shapes, shape_view Points>
struct wind_around_all {
    Shapes shapes;
    Points points;
    double* out;

    ABUT_HD void operator()(std::size_t i) const {
        const auto p = points[i];
        long_sum sum;
        for (std::size_t k = 0; k < shapes.size(); ++k) sum.add(solid_angle_share(shapes[k], p));
        out[i] = sum.total();
    }
};

/// A tree's triangles, and together those that are far. From left to right.
template <bvh_layout Tree, shape_view Shapes, shape_view Points>
struct wind_around_tree {
    Tree tree;
    Shapes shapes;
    Points points;
    const winding_moments* moments;  ///< of the nodes
    length_unit<double> unit;        ///< that of the moments
    double tolerance;
    const std::uint32_t* order;  ///< of the points; null for their own
    double* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t k = order == nullptr ? i : order[i];
        const auto p = points[k];
        const auto in_unit = [&](auto x) { return unit.of(static_cast<double>(x)); };
        const vec3<double> from{in_unit(p.x), in_unit(p.y), in_unit(p.z)};
        // Errors are allowed in proportion to area. What some nodes leave over others may use.
        const double per_area = plain_product(tolerance, 1 - 0x1p-20) / moments[tree.root().index()].area;
        double allowed = 0;
        long_sum sum;
        bvh_child pending[bvh_max_depth * (Tree::width - 1) + 1];  // not initialised
        int waiting = 0;
        pending[waiting++] = tree.root();
        while (waiting > 0) {
            const bvh_child child = pending[--waiting];
            if (child.is_leaf()) {
                sum.add(solid_angle_share(shapes[child.index()], p));
                continue;
            }
            const winding_moments& of = moments[child.index()];
            const double most = plain_sum(allowed, plain_product(per_area, of.area));
            seen_from_afar seen;
            if (is_far(of, from, most, seen)) {
                sum.add(seen.value);
                allowed = plain_sum(most, -seen.error);
                continue;
            }
            const auto& node = tree.fetch(child.index());
            for (int slot = tree.children(node); slot-- > 0;) pending[waiting++] = tree.child(node, slot);
        }
        out[k] = sum.total();
    }
};

template <class Operand>
const auto& index_of(const Operand& x) {
    if constexpr (Operand::is_posed) {
        return index_of(x.operand);
    } else {
        return x.index;
    }
}

/// A power of two that brings the largest coordinate to [1, 2), or as near to it as such a number can.
template <scalar T>
length_unit<double> unit_of_far_field([[maybe_unused]] double largest) {
    length_unit<double> unit;
    if (std::same_as<T, float> || !(largest > 0)) return unit;
    const int e = contact_math::exponent_of(least(largest, largest_finite<double>)), k = greatest(-1000, least(1000, -e));
    unit.per_length = contact_math::power_of_two(k);
    unit.unit = contact_math::power_of_two(-k);
    return unit;
}

/// Whether `winding_number` takes both arguments.
template <class Policy, class X, class Points>
consteval bool can_wind() {
    static_assert(!is_bodies<X>, "abut: winding_number is of one mesh: ask a body's index, posed");
    if constexpr (is_bodies<X>) {
        return false;
    } else if constexpr (can_be_near<Policy, X, Points>()) {
        using shape_type = typename shape_of_argument<X>::type;
        constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
        static_assert(are, "abut: winding_number is of triangles: a mesh, a soup of triangles, or an index of them");
        return are;
    } else {
        return false;
    }
}

/// The answers of all points to `out`, in the policy's memory; complete when it returns.
template <class Policy, class Operand, class Rows>
void wind_around(const Policy& on, const Operand& x, const Rows& rows, double tolerance, double* out) {
    const auto there = x.shapes();
    const auto from = rows.shapes();
    using shapes_type = std::remove_const_t<decltype(there)>;
    using points_type = std::remove_const_t<decltype(from)>;
    using T = typename shapes_type::scalar_type;
    if constexpr (Operand::has_tree) {
        if (tolerance > 0 && there.size() > 1 && from.size() > 0) {
            const auto tree = x.tree();
            const double largest = largest_coordinate(on, x);
            const auto unit = unit_of_far_field<T>(largest);
            const auto moments = moments_of_nodes(on, tree, index_of(x).stored().nodes.size(), there, unit, largest);
            const auto order = order_of_points<Operand>(on, from);
            using around_tree = wind_around_tree<std::remove_const_t<decltype(tree)>, shapes_type, points_type>;
            for_each_task(on, from.size(),
                          around_tree{tree, there, from, moments.data(), unit, tolerance, order.data(), out});
            synchronize(on);
            return;
        }
    }
    for_each_task(on, from.size(), wind_around_all<shapes_type, points_type>{there, from, out});
    synchronize(on);
}

/// How often a surface goes round a point. Its sum has one order, so it is no sum of parts.
struct ask_winding_number : question_of_points {
    template <scalar, class>
    using found = double;
    static constexpr const char* function = "abut::winding_number";
    double tolerance;

    template <class Policy, class X, class Points, bool Whole>
    static consteval bool takes() {
        static_assert(Whole,
                      "abut: winding_number adds up triangles in one order, and so takes a mesh that each device has: "
                      "replicate(devices, mesh)");
        if constexpr (Whole) return can_wind<Policy, X, Points>();
        return false;
    }
    template <class Policy, class X, class Points>
    void check(const Policy&, const X&, const Points&, const char*) const {
        check_tolerance(tolerance, function);
    }
    template <class Policy, class X, class Points>
    auto at_once(const Policy& on, const X& x, const Points& points, double) const {
        execution::buffer_of<Policy, double> out(on, points.shapes().size());
        wind_around(on, x, points, tolerance, out.data());
        return result<double, space_of<Policy>>(std::move(out));
    }
};

}  // namespace detail

/// For each of `points` how often the surface of some triangles goes round it: a `result` of doubles, in the order of the
/// points. That is the generalized winding number, the sum over all triangles of the solid angle under which the point sees
/// them, over 4 pi. Of a closed mesh whose faces all face outward it is 1 inside and 0 outside, as near as rounding leaves
/// it; of a surface with holes it goes from one to the other across the holes. Which way faces are turned matters, unlike
/// for `inside`: a face counts with the other sign if it is turned over, and twice if it is there twice.
///
/// A triangle that the point is on contributes 0, the mean of what it contributes on both sides. So on a face of a closed
/// mesh the answer is 1/2, and on an edge or a corner the part of all directions that lead inside. Triangles without area
/// contribute 0. Every finite input has a finite answer.
///
/// Answers are off by no more than `tolerance`, besides rounding. A tree tells what lies far away together: with a tolerance
/// of 0, or without a tree, each point looks at every triangle. Rounding is below 2^-45 for each triangle, save where a
/// point is nearer to an edge than 2^-26 times that edge's length or so (docs/numerics.md). The same bits on every policy
/// and for any number of threads; with a tolerance trees of other shape may give others.
///
/// Several devices (@ref devices) share out the points, and the answer lies in memory of the first one. Triangles are added
/// up in one order: so each device has the whole mesh, and ranks, of which each has a part, do not take this query.
///
/// `mesh` is a mesh, a soup of triangles, a view of either, a triangle, or an index of any layout, posed or not. `points`
/// are as of `nearest`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 8 bytes a point. With a tree and a tolerance, scratch takes
/// 208 bytes a triangle, and 4 bytes a point.
///
/// @par Errors
/// - `error`: the tolerance is below 0, infinite or no number; a set or an index lies on another device.
/// - `invalid_geometry`: a view, a triangle or a row of points holds no geometry, or a pose is no rotation.
/// - `capacity_error`: a view or a row has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp winding_number
///
/// @ingroup queries
template <executor On, class X, class Points>
[[nodiscard]] auto winding_number(const On& on, const X& mesh, const Points& points, const winding_options& options = {}) {
    return ask_rows(on, detail::ask_winding_number{{}, options.tolerance}, mesh, points);
}

}  // namespace abut
