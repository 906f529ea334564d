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
/// What may be off by most is looked at more closely first, until all together may be off by no more than the tolerance. A
/// list holds the nodes that were opened, with what each of their children may be off by. Children above a level are opened,
/// and the level falls by a quarter at a time. Where the list is full, the walk begins again, depth first: all above a level
/// is opened, and the level falls until the rest is off by no more than the tolerance. Either way the order of the sum
/// depends on the index and the point alone.
template <scalar T>
class winding_walk {
public:
    ABUT_HD winding_walk(const winding_view<T>& in, const vec3<T>& p) : in_(in), p_(p), from_(in.frame.of(widened(p))) {}

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
    struct opened {
        std::uint32_t node;
        float error[4];  ///< below 0 of what was opened in turn
    };

    ABUT_HD void add_block(std::uint32_t block) {
        double shares[4];
        solid_angle_shares(in_.blocks[block], p_, shares);
        for (const double share : shares) near_.add(share);
    }

    template <scalar F>
    ABUT_HD double add_far_fields(double tolerance) {
        // Less for what is rounded in sums of bounds.
        tolerance = plain_product(tolerance, 1 - 0x1p-20);
        double level = plain_product(tolerance, 0.125);  // there are more nodes than eight
        if (open_largest<F>(tolerance, level)) {
            for (int i = 0; i < count_; ++i) add_far<F>(list_[i]);
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

    /// What the far fields of a node's children may be off by.
    template <scalar F>
    ABUT_HD void bound(opened& at) const {
        constexpr bool is_float = std::same_as<F, float>;
        const winding_node& node = in_.nodes[at.node];
#if ABUT_VECTORS
        using number = four_rounded<float>;
        const auto v = in_floats(ways_to(node));
        const number noise = is_float ? number::load(node.noise) : number::of(0);
        const number of_high = is_float ? number::load(node.noise_of_high) : number::of(0);
        far_error(dot(v, v), number::load(node.radius), number::load(node.weight), noise, of_high).value.store(at.error);
#else
        using number = one_rounded<float>;
        for (int k = 0; k < 4; ++k) {
            const auto v = in_floats(way_to(node, k));
            const number noise{is_float ? node.noise[k] : 0.0f}, of_high{is_float ? node.noise_of_high[k] : 0.0f};
            at.error[k] = far_error(dot(v, v), number{node.radius[k]}, number{node.weight[k]}, noise, of_high).value;
        }
#endif
        if (node.count == 4) return;
        for (std::uint32_t k = node.count; k < 4; ++k) at.error[k] = -1;
    }
#if ABUT_VECTORS
    /// Coefficients, which are read where they are needed.
    struct rows_of_floats {
        const float (*high)[4];
        ABUT_INLINE four_rounded<float> operator[](int k) const { return four_rounded<float>::load(high[k]); }
    };
    struct rows_of_doubles {
        const float (*high)[4], (*low)[4];
        ABUT_INLINE four_rounded<double> operator[](int k) const {
            return in_doubles(four_rounded<float>::load(high[k])) + in_doubles(four_rounded<float>::load(low[k]));
        }
    };
    [[nodiscard]] ABUT_INLINE vec3<four_rounded<double>> ways_to(const winding_node& node) const {
        using wide = four_rounded<double>;
        return {wide::load(node.center[0]) - wide::of(from_.x), wide::load(node.center[1]) - wide::of(from_.y),
                wide::load(node.center[2]) - wide::of(from_.z)};
    }
#endif
    [[nodiscard]] ABUT_HD vec3<one_rounded<double>> way_to(const winding_node& node, int k) const {
        return {{plain_sum(node.center[0][k], -from_.x)},
                {plain_sum(node.center[1][k], -from_.y)},
                {plain_sum(node.center[2][k], -from_.z)}};
    }

    /// Adds the far fields of a node's children that were not opened: each to a sum of its own.
    template <scalar F>
    ABUT_HD void add_far(const opened& at) {
        constexpr bool is_float = std::same_as<F, float>;
        const winding_node& node = in_.nodes[at.node];
        const far_terms& terms = in_.terms[at.node];
#if ABUT_VECTORS
        using wide = four_rounded<double>;
        using single = four_rounded<float>;
        wide kept;
        const single error = single::load(at.error);
        if constexpr (is_float) {
            const single value = far_value(in_floats(ways_to(node)), single::load(node.radius), rows_of_floats{terms.high});
            kept = in_doubles(select(error < single::of(0), single::of(0), value));
        } else {
            const wide value = far_value(ways_to(node), in_doubles(single::load(node.radius)), rows_of_doubles{terms.high, terms.low});
            kept = select(in_doubles(error) < wide::of(0), wide::of(0), value);
        }
        (wide::load(far_) + kept).value.store(far_);
#else
        for (int k = 0; k < 4; ++k) {
            if (at.error[k] < 0) continue;
            one_rounded<F> term[far_terms::count];
            for (int j = 0; j < far_terms::count; ++j) {
                term[j].value = terms.high[j][k];
                if (!is_float) term[j].value = plain_sum(term[j].value, static_cast<F>(terms.low[j][k]));
            }
            one_rounded<F> value;
            if constexpr (is_float) {
                value = far_value(in_floats(way_to(node, k)), one_rounded<F>{node.radius[k]}, term);
            } else {
                value = far_value(way_to(node, k), one_rounded<F>{node.radius[k]}, term);
            }
            far_[k] = plain_sum(far_[k], static_cast<double>(value.value));
        }
#endif
    }

    /// Which children are above a level.
    ABUT_HD static unsigned above(const opened& at, float level) {
#if ABUT_VECTORS
        using row = lanes<float>;
        typename row::mask which[1] = {row::load(at.error) > row::all(level)};
        return bits_of(which);
#else
        unsigned bits = 0;
        for (int k = 0; k < 4; ++k) bits |= (at.error[k] > level ? 1u : 0u) << k;
        return bits;
#endif
    }
    ABUT_HD static double all_of(const opened& at) {
        const auto of = [&](int k) { return static_cast<double>(greatest(at.error[k], 0.0f)); };
        return plain_sum(plain_sum(of(0), of(1)), plain_sum(of(2), of(3)));
    }

    /// Asks memory for what is read of children that are opened.
    ABUT_HD void ask_for([[maybe_unused]] std::uint32_t node, [[maybe_unused]] unsigned which) const {
#if !ABUT_DEVICE_CODE
        for (; which != 0; which &= which - 1) {
            const std::uint32_t child = in_.nodes[node].child[lowest_bit(which)];
            if ((child & winding_node::of_block) != 0) continue;
            const char* const at = reinterpret_cast<const char*>(in_.nodes + child);
            for (std::size_t line = 0; line < sizeof(winding_node); line += 64) ABUT_PREFETCH(at + line);
        }
#endif
    }
    /// False where the list is full, or will be; `level` is then one that may do for the rest.
    template <scalar F>
    ABUT_HD bool open_largest(double tolerance, double& level) {
        count_ = 1;
        list_[0].node = in_.root;
        bound<F>(list_[0]);
        double all = infinity<double>;
        for (;; level = plain_product(level, 0.25)) {
            const auto rounded_level = static_cast<float>(level);
            for (int i = 0; i < count_; ++i) {
                unsigned which = above(list_[i], rounded_level);
                ask_for(list_[i].node, which);
                for (; which != 0; which &= which - 1) {
                    const auto k = static_cast<int>(lowest_bit(which));
                    const std::uint32_t child = in_.nodes[list_[i].node].child[k];
                    double more = -static_cast<double>(list_[i].error[k]);
                    list_[i].error[k] = -1;
                    if ((child & winding_node::of_block) != 0) {
                        add_block(child ^ winding_node::of_block);
                    } else {
                        if (count_ == room) {
                            level = plain_product(0.25, level);
                            return false;
                        }
                        opened& next = list_[count_++];
                        next.node = child;
                        bound<F>(next);
                        more = plain_sum(more, all_of(next));
                    }
                    if (!(all < infinity<double>)) continue;
                    all = plain_sum(all, more);
                    if (all <= tolerance) return true;
                }
            }
            // Infinite ones are gone, and the sum begins again.
            all = 0;
            for (int i = 0; i < count_; ++i) all = plain_sum(all, all_of(list_[i]));
            if (all <= tolerance) return true;
            // N grows as the root of 1 / share.
            const double share = tolerance / all, more = static_cast<double>(room) / count_;
            if (plain_product(plain_product(more, more), share) < 1) {
                level = plain_product(0.6, level_for(level, share));
                return false;
            }
        }
    }

    /// Opens all that is above the level, and adds up the rest. Returns by what that may be off.
    template <scalar F>
    ABUT_HD double walk_down(double level) {
        const auto rounded_level = static_cast<float>(level);
        double all = 0;
        count_ = 0;
        list_[count_++].node = in_.root;
        while (count_ > 0) {
            opened at = list_[--count_];
            bound<F>(at);
            for (unsigned which = above(at, rounded_level); which != 0; which &= which - 1) {
                const auto k = static_cast<int>(lowest_bit(which));
                at.error[k] = -1;
                const std::uint32_t child = in_.nodes[at.node].child[k];
                if ((child & winding_node::of_block) == 0) {
                    list_[count_++].node = child;
                } else {
                    add_block(child ^ winding_node::of_block);
                }
            }
            add_far<F>(at);
            all = plain_sum(all, all_of(at));
        }
        return all;
    }

    const winding_view<T>& in_;
    vec3<T> p_;
    vec3<double> from_;
    long_sum near_;
    double far_[4] = {};
    int count_;
    opened list_[room];  // not initialised
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
/// point is nearer to an edge than 2^-26 times that edge's length or so (docs/numerics.md). The same bits on every policy
/// and for any number of threads; with a tolerance trees of other shape may give others.
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
