// SPDX-License-Identifier: MIT
#pragma once

// winding_number: how often a surface of triangles, which need not be closed, goes round each of many points.
//
// By definition the sum of the solid angles of all triangles over 4 pi, with the sign of the side that the point is on
// (A. Jacobson, L. Kavan, O. Sorkine-Hornung: Robust Inside-Outside Segmentation using Generalized Winding Numbers, 2013).
// A point is one thread's work, which adds up in a fixed order, through an index (winding_index.hpp) or all triangles.

#include <cmath>
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
/// What may be off by most is looked at more closely first, until all together may be off by no more than the tolerance. A
/// list holds the nodes that were opened, with what each of their children may be off by. Children above a level are opened,
/// a generation after another, and the level falls. Where the list is full, the walk begins again, depth first: all above a level
/// is opened, and the level falls until the rest is off by no more than the tolerance. Either way the order of the sum
/// depends on the index and the point alone.
template <scalar T>
class winding_walk {
public:
    ABUT_HD winding_walk(const winding_view<T>& in, const vec3<T>& p) : in_(in), p_(p), from_(in.frame.of(widened(p))) {
        const double from[3] = {from_.x, from_.y, from_.z};
        for (int axis = 0; axis < 3; ++axis) winding::write_floats(from[axis], high_[axis], low_[axis]);
    }

    /// All triangles, in the order of the index.
    ABUT_HD double add_all() {
        for (std::size_t k = 0; k < in_.block_count; ++k) add_block(static_cast<std::uint32_t>(k));
        return near_.total();
    }
    /// In floats, where what these may lose is within the tolerance.
    ABUT_HD double add_within(double tolerance) {
        if ((in_.root & winding_node::of_block) != 0 || !(tolerance > 1e-15)) return add_all();
        return tolerance > 0x1p-12 ? add_far_fields<float>(tolerance) : add_far_fields<double>(tolerance);
    }

private:
    static constexpr int room = 512;
    static_assert(room >= 3 * bvh_max_depth + 1);
    ABUT_HD void add_block(std::uint32_t block) {
        double shares[4];
        solid_angle_shares(in_.blocks[block], p_, shares);
        for (const double share : shares) near_.add(share);
    }

    template <scalar F>
    ABUT_HD double add_far_fields(double tolerance) {
        // Less for what is rounded in sums of bounds, of 512 floats at most.
        tolerance = plain_product(tolerance, 1 - 0x1p-14);
        double level = plain_product(tolerance, 0.0625);
        if (open_largest<F>(tolerance, level)) {
            for (int i = 0; i < count_; ++i) add_far<F>(node_[i], error_[i]);
        } else {
            for (double left = infinity<double>; !(left <= tolerance);) {
                if (left < infinity<double>) level = plain_product(0.6, level_for(level, tolerance / left));
                near_ = {};
                for (double& far : far_) far = 0;
                left = walk_down<F>(level);
            }
        }
        near_.add(plain_sum(plain_sum(far_[0], far_[1]), plain_sum(far_[2], far_[3])));
        return near_.total();
    }

    /// The level at which what is left is a share of what is left at another: of N nodes 1 / N^3 each, about.
    ABUT_HD static double level_for(double level, double share) {
        return plain_product(level, plain_product(share, std::sqrt(share)));
    }

    /// What the far fields of a node's children may be off by; below 0 of those that are not there.
    template <scalar F>
    ABUT_INLINE ABUT_HD void bound(std::uint32_t number, float* error) const {
        constexpr bool is_float = std::same_as<F, float>;
        const winding_node& node = in_.nodes[number];
#if ABUT_VECTORS
        using row = four_rounded<float>;
        const auto v = ways_to<row>(node, 0);
        const row none = row::of(0), noise = is_float ? row::load_aligned(node.noise) : none,
                  of_high = is_float ? row::load_aligned(node.noise_of_high) : none;
        far_error(dot(v, v), row::load_aligned(node.radius), row::load_aligned(node.weight), noise, of_high).value.store(error);
#else
        using row = one_rounded<float>;
        for (int k = 0; k < 4; ++k) {
            const auto v = ways_to<row>(node, k);
            const row noise{is_float ? node.noise[k] : 0.0f}, of_high{is_float ? node.noise_of_high[k] : 0.0f};
            error[k] = far_error(dot(v, v), row{node.radius[k]}, row{node.weight[k]}, noise, of_high).value;
        }
#endif
        if (node.count == 4) return;
        for (std::uint32_t k = node.count; k < 4; ++k) error[k] = -1;
    }
    /// From the point to the centres of a node's children, of all or of child k. Between floats a difference of parts that are
    /// close is exact, so that it is off by 2^-22 of itself.
    ///@{
    template <class N>
    [[nodiscard]] ABUT_INLINE ABUT_HD static N row_of(const float* from, int k) {
        if constexpr (std::same_as<N, one_rounded<float>>) {
            return {from[k]};
        } else {
            return N::load_aligned(from);
        }
    }
    template <class N>
    [[nodiscard]] ABUT_INLINE ABUT_HD vec3<N> ways_to(const winding_node& node, int k) const {
        const auto one = [&](int axis) {
            return (row_of<N>(node.center[axis], k) - N::of(high_[axis])) + (row_of<N>(node.center_low[axis], k) - N::of(low_[axis]));
        };
        return {one(0), one(1), one(2)};
    }
    ///@}
#if ABUT_VECTORS
    /// Coefficients, which are read where they are needed.
    struct rows_of_floats {
        const float (*high)[4];
        ABUT_INLINE four_rounded<float> operator[](int k) const { return four_rounded<float>::load_aligned(high[k]); }
    };
    struct rows_of_doubles {
        const float (*high)[4], (*low)[4];
        ABUT_INLINE four_rounded<double> operator[](int k) const {
            return in_doubles(four_rounded<float>::load(high[k])) + in_doubles(four_rounded<float>::load(low[k]));
        }
    };
    [[nodiscard]] ABUT_INLINE vec3<four_rounded<double>> long_ways_to(const winding_node& node) const {
        using wide = four_rounded<double>;
        const auto row = [](const float* from) { return in_doubles(four_rounded<float>::load(from)); };
        const auto one = [&](int axis, double from) { return (row(node.center[axis]) + row(node.center_low[axis])) - wide::of(from); };
        return {one(0, from_.x), one(1, from_.y), one(2, from_.z)};
    }
#endif
    [[nodiscard]] ABUT_HD vec3<one_rounded<double>> long_way_to(const winding_node& node, int k) const {
        const double from[3] = {from_.x, from_.y, from_.z};
        one_rounded<double> way[3];
        for (int axis = 0; axis < 3; ++axis) {
            const double center = plain_sum(static_cast<double>(node.center[axis][k]), static_cast<double>(node.center_low[axis][k]));
            way[axis] = {plain_sum(center, -from[axis])};
        }
        return {way[0], way[1], way[2]};
    }

    /// Adds the far fields of a node's children that were not opened: each to a sum of its own.
    template <scalar F>
    ABUT_INLINE ABUT_HD void add_far(std::uint32_t number, const float* error) {
        constexpr bool is_float = std::same_as<F, float>;
        const winding_node& node = in_.nodes[number];
        const far_terms& terms = in_.terms[number];
#if ABUT_VECTORS
        using wide = four_rounded<double>;
        using single = four_rounded<float>;
        wide kept;
        const single off = single::load_aligned(error), radius = single::load_aligned(node.radius);
        if constexpr (is_float) {
            const single value = far_value(ways_to<single>(node, 0), radius, rows_of_floats{terms.high});
            kept = in_doubles(select(off < single::of(0), single::of(0), value));
        } else {
            const wide value = far_value(long_ways_to(node), in_doubles(radius), rows_of_doubles{terms.high, terms.low});
            kept = select(in_doubles(off) < wide::of(0), wide::of(0), value);
        }
        (wide::load(far_) + kept).value.store(far_);
#else
        for (int k = 0; k < 4; ++k) {
            if (error[k] < 0) continue;
            one_rounded<F> term[far_terms::count];
            for (int j = 0; j < far_terms::count; ++j) {
                term[j].value = terms.high[j][k];
                if (!is_float) term[j].value = plain_sum(term[j].value, static_cast<F>(terms.low[j][k]));
            }
            one_rounded<F> value;
            if constexpr (is_float) {
                value = far_value(ways_to<one_rounded<float>>(node, k), one_rounded<F>{node.radius[k]}, term);
            } else {
                value = far_value(long_way_to(node, k), one_rounded<F>{node.radius[k]}, term);
            }
            far_[k] = plain_sum(far_[k], static_cast<double>(value.value));
        }
#endif
    }

    /// What all that is not open may be off by, rounded in floats.
    [[nodiscard]] ABUT_HD double all_of_list() const {
        float four[4] = {};
#if ABUT_VECTORS
        using row = four_rounded<float>;
        row sum = row::of(0);
        for (int i = 0; i < count_; ++i) {
            const row error = row::load_aligned(error_[i]);
            sum = sum + select(error > row::of(0), error, row::of(0));
        }
        sum.value.store(four);
#else
        for (int i = 0; i < count_; ++i) {
            for (int k = 0; k < 4; ++k) four[k] = plain_sum(four[k], greatest(error_[i][k], 0.0f));
        }
#endif
        return static_cast<double>(plain_sum(plain_sum(four[0], four[1]), plain_sum(four[2], four[3])));
    }
    /// Which children are above a level.
    ABUT_HD static unsigned above(const float* error, float level) {
#if ABUT_VECTORS
        using row = lanes<float>;
        typename row::mask which[1] = {row::load_aligned(error) > row::all(level)};
        return bits_of(which);
#else
        unsigned bits = 0;
        for (int k = 0; k < 4; ++k) bits |= (error[k] > level ? 1u : 0u) << k;
        return bits;
#endif
    }

    /// Asks memory for what is read of a node that is opened.
    ABUT_HD void ask_for([[maybe_unused]] std::uint32_t node) const {
#if !ABUT_DEVICE_CODE
        const char* const at = reinterpret_cast<const char*>(in_.nodes + node);
        for (std::size_t line = 0; line < sizeof(winding_node); line += 64) ABUT_PREFETCH(at + line);
#endif
    }
    /// Opens those children of a node that are above a level: blocks are added up, nodes come to the end of the list. False where
    /// it is full.
    ABUT_INLINE ABUT_HD bool open(std::uint32_t number, float* error, float level) {
        for (unsigned which = above(error, level); which != 0; which &= which - 1) {
            const auto k = static_cast<int>(lowest_bit(which));
            const std::uint32_t child = in_.nodes[number].child[k];
            error[k] = -1;
            if ((child & winding_node::of_block) != 0) {
                add_block(child ^ winding_node::of_block);
            } else {
                if (count_ == room) return false;
                ask_for(child);
                node_[count_++] = child;
            }
        }
        return true;
    }
    /// False where the list is full, or will be; `level` is then one that may do for the rest.
    template <scalar F>
    ABUT_HD bool open_largest(double tolerance, double& level) {
        count_ = 1;
        node_[0] = in_.root;
        bound<F>(node_[0], error_[0]);
        for (bool is_first = true;; is_first = false) {
            const double all = all_of_list();
            if (all <= tolerance) return true;
            if (!is_first) {
                // N grows as the root of 1 / share.
                const double share = tolerance / all, more = static_cast<double>(room) / count_;
                const double next = level_for(level, share);
                if (plain_product(plain_product(more, more), share) < 1) {
                    level = plain_product(0.6, next);
                    return false;
                }
                level = greatest(plain_product(0.25, level), least(next, plain_product(0.75, level)));
            }
            // A generation after another, of which bounds are computed together.
            for (int first = 0; first < count_;) {
                const int end = count_;
                for (int i = first; i < end; ++i) {
                    if (!open(node_[i], error_[i], static_cast<float>(level))) {
                        level = plain_product(0.25, level);
                        return false;
                    }
                }
                for (int i = end; i < count_; ++i) bound<F>(node_[i], error_[i]);
                first = end;
            }
        }
    }

    /// Opens all that is above the level, and adds up the rest. Returns by what that may be off.
    template <scalar F>
    ABUT_HD double walk_down(double level) {
        double all = 0;
        node_[0] = in_.root;
        count_ = 1;
        while (count_ > 0) {
            const std::uint32_t number = node_[--count_];
            float* const error = error_[count_];  // nodes that come to the list have none yet
            bound<F>(number, error);
            (void)open(number, error, static_cast<float>(level));
            add_far<F>(number, error);
            const auto of = [&](int k) { return static_cast<double>(greatest(error[k], 0.0f)); };
            all = plain_sum(all, plain_sum(plain_sum(of(0), of(1)), plain_sum(of(2), of(3))));
        }
        return all;
    }

    const winding_view<T>& in_;
    vec3<T> p_;
    vec3<double> from_;
    float high_[3], low_[3];  ///< of from_
    long_sum near_;
    double far_[4] = {};
    int count_;
    // A list of open nodes, and what each of their children may be off by, below 0 where it is open in turn. Not initialised.
    std::uint32_t node_[room];
    alignas(16) float error_[room][4];
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

template <class X>
inline constexpr bool is_winding_index = false;
template <scalar T, memory_space Space>
inline constexpr bool is_winding_index<winding_index<T, Space>> = true;

/// What rows ask of an index that was made before.
template <scalar T, memory_space Space>
struct made_operand {
    static constexpr bool is_indexed = true;
    winding_index<T, Space> index;
};
template <class Policy, scalar T, memory_space Space, class Question>
made_operand<T, Space> make_asked(const Policy& on, const winding_index<T, Space>& x, const Question& question) {
    require_same_device(on, x, question.function);
    return {x};
}

/// Whether `winding_number` takes both arguments.
template <class Policy, class X, class Points>
consteval bool can_wind() {
    static_assert(!is_bodies<X>, "abut: winding_number is of one mesh: ask a body's index, posed");
    if constexpr (is_bodies<X>) {
        return false;
    } else if constexpr (is_winding_index<X>) {
        using view = shapes_view<typename X::shape_type, typename X::memory_space>;
        return lies_there<Policy, X>() && can_be_near<Policy, view, Points>();
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
    const winding_view<T> in{made.nodes.data(), made.terms.data(), made.blocks.data(), made.blocks.size(), made.root, made.frame};
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
        if constexpr (requires { x.shapes(); }) {
            wind_around(on, x, points, tolerance, out.data());
        } else {
            wind_around_made<X>(on, x.index.stored(), points.shapes(), tolerance, out.data());
        }
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
/// point is nearer to an edge than 2^-26 times that edge's length or so (docs/numerics/inside.md). The same bits on every
/// policy and for any number of threads; with a tolerance trees of other shape may give others.
///
/// Several devices (@ref devices) share out the points, and the answer lies in memory of the first one. Triangles are added
/// up in one order: so each device has the whole mesh, and ranks, of which each has a part, do not take this query.
///
/// `mesh` is a mesh, a soup of triangles, a view of either, a triangle, or an index of any layout, posed or not. `points`
/// are as of `nearest`. With a tree each call makes what it looks in; a `winding_index` in its place (`make_winding_index`)
/// has it, and answers are the same bits. What may be off by most is looked at most closely, so time depends on the
/// tolerance and little on the mesh.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 8 bytes a point. With a tree and a tolerance, scratch is what
/// `make_winding_index` takes. Many points take 4 bytes each more. A point takes some 10 kB of the stack.
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
