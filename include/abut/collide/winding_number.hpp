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

#include <abut/collide/nearest.hpp>
#include <abut/collide/winding_index.hpp>
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

/// The sum of one point, through an index.
///
/// What may be off by most is looked at more closely first, until all together may be off by no more than the tolerance. So
/// a list holds nodes that wait, with what each may be off by, and those above a level are opened; the level falls by a
/// quarter at a time. Where the list is full, the walk begins again, depth first: all nodes above a level are opened, and
/// the level falls until the rest is off by no more than the tolerance. Either way the order of the sum depends on the index
/// and the point alone.
template <scalar T>
class winding_walk {
    using one_double = contact_math::one_double;

public:
    ABUT_HD winding_walk(const winding_view<T>& in, const vec3<T>& p)
        : in_(in),
          p_(p),
          from_{in.unit.of(static_cast<double>(p.x)), in.unit.of(static_cast<double>(p.y)),
                in.unit.of(static_cast<double>(p.z))} {}

    /// All triangles, in the order of the index.
    ABUT_HD double add_all() {
        for (std::size_t k = 0; k < in_.block_count; ++k) add_block(static_cast<std::uint32_t>(k));
        return sum_.total();
    }
    ABUT_HD double add_within(double tolerance) {
        if ((in_.root & winding_node::of_block) != 0) return add_all();
        // Less for what is rounded in sums of bounds.
        tolerance = plain_product(tolerance, 1 - 0x1p-20);
        double level = tolerance;
        if (!open_largest(tolerance, level)) {
            sum_ = {};
            while (!walk_down<false>(level, tolerance)) level = plain_product(level, 0.25);
            walk_down<true>(level, tolerance);
            return sum_.total();
        }
        for (int k = 0; k < waiting_; k += 4) add_far(slot_ + k, waiting_ - k);
        return sum_.total();
    }

private:
    static constexpr int room = 512;
    static_assert(room >= bvh_max_depth * 3 + 1);

    ABUT_HD void add_block(std::uint32_t block) {
        double shares[4];
        solid_angle_shares(in_.blocks[block], p_, shares);
        for (const double share : shares) sum_.add(share);
    }

    /// What the far fields of a node's children may be off by.
    ABUT_HD void bound(const winding_node& node, double (&error)[4]) const {
#if ABUT_VECTORS
        using number = contact_math::four_doubles;
        const vec3<number> v{number::load(node.center[0]) - number::of(from_.x),
                             number::load(node.center[1]) - number::of(from_.y),
                             number::load(node.center[2]) - number::of(from_.z)};
        far_error(dot(v, v), number::load(node.radius), number::load(node.weight)).high.store(error);
#else
        for (int k = 0; k < 4; ++k) {
            const vec3<one_double> v = way_to(node, k);
            error[k] = far_error(dot(v, v), one_double{node.radius[k]}, one_double{node.weight[k]}).high;
        }
#endif
    }
    [[nodiscard]] ABUT_HD vec3<one_double> way_to(const winding_node& node, int k) const {
        return {one_double::difference(node.center[0][k], from_.x), one_double::difference(node.center[1][k], from_.y),
                one_double::difference(node.center[2][k], from_.z)};
    }

    /// Adds the far fields of the first four slots of a list.
    ABUT_HD void add_far(const std::uint32_t* slots, int count) {
#if ABUT_VECTORS
        using number = contact_math::four_doubles;
        const std::uint32_t a = slots[0], b = slots[count > 1 ? 1 : 0], c = slots[count > 2 ? 2 : 0], d = slots[count > 3 ? 3 : 0];
        const double *const ta = in_.terms[a].of, *const tb = in_.terms[b].of, *const tc = in_.terms[c].of,
                            *const td = in_.terms[d].of;
        const auto center = [&](int axis) {
            const auto of = [&](std::uint32_t slot) { return in_.nodes[slot / 4].center[axis][slot % 4]; };
            return number{number::row::of(of(a), of(b), of(c), of(d))};
        };
        const vec3<number> v{center(0) - number::of(from_.x), center(1) - number::of(from_.y), center(2) - number::of(from_.z)};
        double value[4];
        far_value(v, [&](int k) { return number{number::row::of(ta[k], tb[k], tc[k], td[k])}; }).high.store(value);
        for (int k = 0; k < 4 && k < count; ++k) sum_.add(value[k]);
#else
        for (int k = 0; k < 4 && k < count; ++k) {
            const double* const term = in_.terms[slots[k]].of;
            const auto at = [&](int j) { return one_double{term[j]}; };
            sum_.add(far_value(way_to(in_.nodes[slots[k] / 4], static_cast<int>(slots[k] % 4)), at).high);
        }
#endif
    }

    /// Adds a node's blocks, and puts its other children on the list; returns what these may be off by. There is room.
    ABUT_HD double open(std::uint32_t number) {
        const winding_node& node = in_.nodes[number];
        double error[4], all = 0;
        bound(node, error);
        for (std::uint32_t k = 0; k < node.count; ++k) {
            slot_[waiting_] = 4 * number + k;
            error_[waiting_++] = error[k];
            all = plain_sum(all, error[k]);
        }
        return all;
    }
    /// False where the list is full. `level` is that down to which it came.
    ABUT_HD bool open_largest(double tolerance, double& level) {
        double all = open(in_.root);
        for (;; level = plain_product(level, 0.25)) {
            for (int i = 0; i < waiting_;) {
                if (!(error_[i] > level)) {
                    ++i;
                    continue;
                }
                const std::uint32_t child = in_.nodes[slot_[i] / 4].child[slot_[i] % 4];
                all = plain_sum(all, -error_[i]);
                --waiting_;
                error_[i] = error_[waiting_];
                slot_[i] = slot_[waiting_];
                if ((child & winding_node::of_block) != 0) {
                    add_block(child ^ winding_node::of_block);
                } else {
                    if (waiting_ + 4 > room) return false;
                    all = plain_sum(all, open(child));
                }
                if (all <= tolerance) return true;
            }
            // Infinite ones are gone, and the sum begins again.
            all = 0;
            for (int i = 0; i < waiting_; ++i) all = plain_sum(all, error_[i]);
            if (all <= tolerance) return true;
        }
    }

    /// Opens all nodes above the level. True if the rest is off by no more than the tolerance; adds up only if asked to.
    template <bool Adds>
    ABUT_HD bool walk_down(double level, double tolerance) {
        double all = 0;
        std::uint32_t far[4];
        int count = 0;
        waiting_ = 0;
        slot_[waiting_++] = in_.root;
        while (waiting_ > 0) {
            const std::uint32_t number = slot_[--waiting_];
            const winding_node& node = in_.nodes[number];
            double error[4];
            bound(node, error);
            for (std::uint32_t k = 0; k < node.count; ++k) {
                const std::uint32_t child = node.child[k];
                if (!(error[k] > level)) {
                    all = plain_sum(all, error[k]);
                    if (!Adds) continue;
                    far[count++] = 4 * number + k;
                    if (count == 4) add_far(far, 4), count = 0;
                } else if ((child & winding_node::of_block) == 0) {
                    slot_[waiting_++] = child;
                } else if (Adds) {
                    add_block(child ^ winding_node::of_block);
                }
            }
            if (!Adds && !(all <= tolerance)) return false;
        }
        if (count > 0) add_far(far, count);
        return true;
    }

    const winding_view<T>& in_;
    vec3<T> p_;
    vec3<double> from_;
    long_sum sum_;
    int waiting_ = 0;
    double error_[room];  // these are not initialised
    std::uint32_t slot_[room];
};

/// The triangles of an index.
template <scalar T, shape_view Points>
struct wind_around_index {
    winding_view<T> in;
    Points points;
    double tolerance;
    const std::uint32_t* order;  ///< of the points; null for their own
    double* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t k = order == nullptr ? i : order[i];
        winding_walk<T> walk(in, points[k]);
        out[k] = tolerance > 0 ? walk.add_within(tolerance) : walk.add_all();
    }
};

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

template <class Operand, class Policy, scalar T, memory_space Space, shape_view Points>
void wind_around_made(const Policy& on, const winding_storage<T, Space>& made, const Points& from, double tolerance,
                      double* out) {
    const winding_view<T> in{made.nodes.data(), made.terms.data(), made.blocks.data(), made.blocks.size(), made.root, made.unit};
    const auto order = order_of_points<Operand>(on, from);
    for_each_task(on, from.size(), wind_around_index<T, Points>{in, from, tolerance, order.data(), out});
    synchronize(on);
}

/// The answers of all points to `out`, in the policy's memory; complete when it returns.
template <class Policy, class Operand, class Rows>
void wind_around(const Policy& on, const Operand& x, const Rows& rows, double tolerance, double* out) {
    const auto there = x.shapes();
    const auto from = rows.shapes();
    using shapes_type = std::remove_const_t<decltype(there)>;
    using points_type = std::remove_const_t<decltype(from)>;
    if constexpr (Operand::has_tree) {
        if (tolerance > 0 && from.size() > 0) {
            const auto made = winding_storage_of(on, x);
            return wind_around_made<Operand>(on, made, from, tolerance, out);
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
