// SPDX-License-Identifier: MIT
#pragma once

// sweep: for each of many shapes that go along vectors the shape that it touches first, when and where.
//
// By definition the first is the shape with the least time, as narrow/sweep_time.hpp gives it, and of equal ones the one with
// the least id. The walk is that of `raycast`, along rays that are as thick as the shapes.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/gathered_sweep.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/narrow/plain_sweep.hpp>
#include <abut/narrow/sweep_time.hpp>
#include <abut/shape/swept.hpp>

namespace abut {

/// A `sweep_hit` with an id in a set of many parts. Where nothing is touched: `no_global_id`, infinity, and zeros.
/// @ingroup distributed
template <scalar T>
struct global_sweep_hit {
    std::uint64_t id;  ///< of the shape that is touched
    T t;               ///< when, as in sweep_hit
    vec3<T> point;     ///< where, as in sweep_hit
    vec3<T> normal;    ///< as in sweep_hit

    friend constexpr bool operator==(const global_sweep_hit&, const global_sweep_hit&) = default;
};

/// Options of `sweep`.
/// @ingroup queries
template <class Filter = keep_all>
struct sweep_options {
    /// filter(number of the row, id) -> bool: shapes for which it is false are not there. As in query_options. Ranks take
    /// none: rows of other ranks have no numbers there.
    Filter filter = {};
};

namespace detail {

/// Shapes and the ways that they go, as one view.
template <shape_view Shapes, shape_view Ways>
struct swept_view {
    using scalar_type = typename Shapes::scalar_type;
    using shape_type = swept<typename Shapes::shape_type>;
    using memory_space = typename Shapes::memory_space;
    Shapes shapes;
    Ways ways;

    [[nodiscard]] ABUT_HD std::size_t size() const { return shapes.size(); }
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return {shapes[i], ways[i]}; }
};
template <operand X, operand Ways>
struct swept_operand {
    static constexpr bool is_indexed = false, has_tree = false, is_posed = false;
    X starts;
    Ways ways;
    using view_type = swept_view<decltype(starts.shapes()), decltype(ways.shapes())>;
    [[nodiscard]] view_type shapes() const { return {starts.shapes(), ways.shapes()}; }
};

/// Of each shape on its way what it touches first, as walk_along_lines.
template <class A, class Walk, class Frame, class Shapes, class Rows, class Wanted>
struct walk_along_ways {
    using line_type = typename Rows::shape_type;
    using row_type = std::size_t;
    using id_type = walk_id<Walk>;
    Walk walk;
    Frame frame;
    Shapes shapes;
    Rows rows;
    Wanted wanted;
    bool in_scalars;

    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD time_bounds bounds(const line_type& mover, row_type row, id_type id, double until) const {
        return wanted(row, id) ? sweep_bounds<A>(mover, shapes[id], until) : time_bounds{-1, -1};
    }
    [[nodiscard]] ABUT_HD double time(const line_type& mover, id_type id) const { return sweep_time<A>(mover, shapes[id]); }
    using look = look_for_first<walk_along_ways>;
    ABUT_HD look start(std::size_t i) const { return {rows[i], i}; }
    ABUT_HD auto seen(std::size_t i) const { return sweep_seen(frame, rows[i]); }

    /// As far as doubles tell.
    [[nodiscard]] ABUT_HD time_bounds bounds_in_doubles(const line_type& mover, id_type id, double until) const {
        return sweep_bounds<A, true>(mover, shapes[id], until);
    }
    /// Whether a device looks in stages (gathered_sweep.hpp).
    static constexpr bool can_gather = std::same_as<Wanted, all_shapes_wanted> && !std::same_as<A, fast> &&
                                       requires(const line_type& mover, const typename Shapes::shape_type& met) {
                                           plain_sweep_bounds(mover, met, 1.0);
                                       };
};

/// What is known of a touch.
template <scalar T>
struct sweep_details {
    execution::least_value met;  ///< the largest key where nothing is
    sweep_place<T> place;
};
template <class Shapes, class Rows, class Ids>
struct write_sweeps {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    Rows rows;
    const execution::least_value* found;  ///< null for none
    Ids ids;
    sweep_details<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = found == nullptr ? no_global_id : found[i].key;
        out[i] = {{}, {{0, 0, 0}, {0, 0, 0}}};
        if (key == no_global_id) return;
        const sweep_place<T> place = sweep_place_of(rows[i], shapes[key], static_cast<double>(time_as<T>(found[i].value)));
        out[i] = {{found[i].value, in_whole(ids, key)}, place};
    }
};

/// Rows with ways apart are an operand by now.
template <class Policy, class Rows>
consteval bool are_rows() {
    if constexpr (operand<Rows>) {
        return true;
    } else {
        return can_be_asked<Policy, Rows>();
    }
}
/// Whether a swept shape may meet another one.
template <class Swept, class Met>
consteval bool can_go_and_be_met() {
    constexpr bool are = sweepable_pair<decltype(Swept::start), Met>;
    static_assert(are,
                  "abut: points, segments, triangles, spheres, capsules, cylinders, cones, boxes, oriented boxes and hulls can be swept, "
                  "and be met; planes and half spaces by these; rays cannot");
    return are;
}
/// Whether `sweep` takes these arguments.
template <class Policy, class X, class Rows>
consteval bool can_be_swept() {
    static_assert(!is_bodies<X>, "abut: sweep looks in a set, an index or one shape, and not in bodies");
    if constexpr (is_bodies<X>) {
        return false;
    } else if constexpr (!can_be_asked_by_rows<Policy, X>()) {
        return false;
    } else if constexpr (!are_rows<Policy, Rows>()) {
        return false;
    } else {
        using met = typename shape_of_argument<X>::type;
        using row = typename shape_of_argument<Rows>::type;
        static_assert(is_swept<row>, "abut: sweep takes shapes and their ways, or shapes that have one each, as shapes<swept<S>>");
        constexpr bool has_walk = !is_grid<X>;
        static_assert(has_walk, "abut: sweep takes a tree, a set or one shape, and no grid");
        if constexpr (is_swept<row> && has_walk && have_one_scalar<X, Rows>()) {
            return can_go_and_be_met<row, met>();
        } else {
            return false;
        }
    }
}

/// What a shape on its way touches first: when, its id, and where.
template <arithmetic A, class Filter, scalar T>
struct sweeps_in_parts;
template <arithmetic A, class Filter>
struct ask_sweep : row_question {
    template <scalar T, class Id>
    using found = by_id<Id, sweep_hit<T>, sweep_hit<T>, global_sweep_hit<T>>;
    static constexpr const char* function = "abut::sweep";
    static constexpr bool filters = !std::same_as<Filter, keep_all>;
    Filter filter = {};

    template <class Policy, class X, class Rows, bool Whole>
    static consteval bool takes() {
        if constexpr (!can_be_swept<Policy, X, Rows>()) {
            return false;
        } else if constexpr (filters) {
            return is_row_filter<Policy, Filter, false>();
        } else {
            return true;
        }
    }
    template <scalar T, class Policy, class Rows>
    auto make_rows(const Policy& on, const Rows& rows, const char* name) const {
        return make_operand(on, rows, name);
    }
    template <class Policy, class X, class Rows>
    auto at_once(const Policy& on, const X& x, const Rows& rows, double) const {
        using T = typename std::remove_cvref_t<decltype(x.shapes())>::scalar_type;
        const auto in_part = in_parts<T>(0);
        execution::buffer_of<Policy, sweep_details<T>> answers(on, rows.shapes().size());
        in_part.find(on, x, rows, same_key{}, true, answers.data());
        using row = found<T, operand_id<X>>;
        return result<row, space_of<Policy>>(named_answers<row>(on, in_part, std::move(answers)));
    }
    template <scalar T>
    [[nodiscard]] sweeps_in_parts<A, Filter, T> in_parts(double) const {
        return {{{}, filter}};
    }
};
template <arithmetic A, class Filter, scalar T>
struct sweeps_in_parts : ask_sweep<A, Filter> {
    using answer = sweep_details<T>;

    /// in_scalars: times need only become the right scalars.
    template <class Policy, class Operand, class Rows, class Ids>
    void find(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, bool in_scalars, answer* out) const {
        const auto shapes = x.shapes();
        const auto movers = rows.shapes();
        using shapes_type = std::remove_const_t<decltype(shapes)>;
        using movers_type = std::remove_const_t<decltype(movers)>;
        using write = write_sweeps<shapes_type, movers_type, Ids>;
        if (movers.size() == 0) return;
        const auto finish = [&](const execution::least_value* met) {
            for_each_index(on, movers.size(), write{shapes, movers, met, ids, out});
            synchronize(on);
        };
        if (shapes.size() == 0) return finish(nullptr);
        const auto wanted = shapes_wanted<false>(filter_in_part(this->filter, ids), rows);
        const auto walk = ordered_walk_of(x);
        const auto frame = frame_of(x, length_unit<T>{});
        using along = walk_along_ways<A, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>, shapes_type,
                                      movers_type, std::remove_const_t<decltype(wanted)>>;
        execution::best_of_each<space_of<Policy>> best(on, movers.size(), 1.0);
        from_each each{along{walk, frame, shapes, movers, wanted, in_scalars}};
        [[maybe_unused]] const auto watch = watch_ties<Policy, !ask_sweep<A, Filter>::filters>(64, false, each.all.walk, x);
        if constexpr (gathers_first<Policy, along>) {
            staged_sweep<Policy, along, decltype(best)>(on, movers.size(), each, best);
        } else {
            for_each_ordered(on, movers.size(), each, best);
        }
        finish(best.data());
    }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        find(on, x, rows, ids, false, out);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        if (other->met.comes_before(best->met)) *best = *other;
    }
    template <class Row>
    ABUT_HD bool may_change(const Row& row, const answer* best, const part_bounds<T>& part) const {
        ray_reach<T> reach(sweep_seen(world_frame<T>{}, row));
        reach.shrink_to(best->met.value);
        return may_keep(part, reach);
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(const answer& of) const {
        const T t = of.met.key == no_global_id ? infinity<T> : time_as<T>(of.met.value);
        return {static_cast<decltype(Found::id)>(of.met.key), t, of.place.point, of.place.normal};
    }
};

}  // namespace detail

/// For each of some shapes that go along vectors, the shape of `index` that it touches first: a `result` of `sweep_hit`, in the
/// order of the shapes. At the time t, from 0 to 1, a shape is moved by t times its way, and not turned. Of those that are
/// touched at one time the hit has the least id; where nothing is touched, `no_id`, infinity, and zeros.
///
/// `index` is a tree of any layout, a set, a view or one shape, posed or not. `moving` are shapes with a way each: a set
/// `shapes<swept<S>>`, a view, or one that `moving(shape, way)` makes. Shapes, on both sides, are points, segments, triangles,
/// spheres, capsules, cylinders, cones, boxes, oriented boxes and hulls, and with one of these planes and half spaces. All but
/// planes, triangles, segments and points are solid, and planes and triangles are touched from both sides. Shapes that touch at the start are touched at 0. A way of 0 asks what is touched at the start.
///
/// With `filtered` and `exact` whether a shape is touched is decided exactly, and places on the way are not rounded for that.
/// Times are the true ones rounded to the nearest double, by which they are compared, and then to the scalar type. So shapes
/// that are touched at one time are known to be. The same bits on every policy. `fast` is approximate.
///
/// Of cylinders and cones that is certified and not exact, whatever is asked. They are never touched later than is told, and
/// what they are said to pass they do not touch. The time is early by 2^-36 of the sizes at most: at it the two are as near as
/// that, but for one of 10,000 to 100,000, where doubles lead no nearer (docs/sweeps.md). Shapes that pass each other as near may
/// count as touched.
///
/// The point lies on the shape that is touched. The normal has length 1 and points out of that shape; it is zero where shapes
/// overlap at the start. Both are computed in double at the time of the touch, and nothing is decided by them. Where a shape
/// is touched in more than one point at a time, as where a box lands on its side, the point is one of them.
///
/// Of several devices (@ref devices) and of ranks (@ref distributed) the executor takes a set of shapes with a way each, which
/// no hulls are; a row of ranks is a `global_sweep_hit`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 32 bytes a row in float and 64 in double; scratch takes up to
/// twice as much. Under `cuda` balls and capsules that go at triangles take up to 150 bytes a row more, and 2 MB at least: they go in
/// stages (collide/gathered_sweep.hpp). There the last stage has a stack of some 27 KB in float, and more than twice that in double. CUDA
/// sets that aside once for all threads that the device holds at a time.
///
/// @par Errors
/// - `invalid_geometry`: a view, a single shape or a way has a number that is not finite, or a pose is no rotation.
/// - `error`: a set or an index lies on another device, or there are not as many ways as shapes.
/// - `capacity_error`: a view has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp sweep
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Moving, class Filter = keep_all>
[[nodiscard]] auto sweep(const On& on, const X& index, const Moving& moving, const sweep_options<Filter>& options = {}) {
    return ask_rows(on, detail::ask_sweep<A, Filter>{{}, options.filter}, index, moving);
}
/// The same of shapes and as many ways, which lie apart: `shapes` is a set, a view or one shape, posed or not, and `ways` are
/// points. By a policy.
/// @ingroup queries
template <arithmetic A = filtered, execution_policy Policy, class X, class Shapes, class Ways, class Filter = keep_all>
    requires(detail::set_like<Ways>)
[[nodiscard]] auto sweep(const Policy& on, const X& index, const Shapes& shapes, const Ways& ways,
                         const sweep_options<Filter>& options = {}) {
    constexpr const char* function = "abut::sweep";
    if constexpr (detail::can_be_asked<Policy, Shapes>() && detail::can_be_asked<Policy, Ways>()) {
        const auto starts = detail::make_operand(on, shapes, function);
        const auto along = detail::make_operand(on, ways, function);
        using way = typename detail::shape_of_argument<Ways>::type;
        constexpr bool are_ways = std::same_as<way, vec3<scalar_type_of<way>>>;
        static_assert(are_ways, "abut: the ways of a sweep are points: a set of them, a view, or one");
        if constexpr (are_ways && detail::have_one_scalar<Shapes, Ways>()) {
            if (starts.shapes().size() != along.shapes().size()) {
                throw error(std::string(function) + ": " + std::to_string(along.shapes().size()) + " ways; expected as many as shapes, " +
                            std::to_string(starts.shapes().size()));
            }
            return ask_rows(on, detail::ask_sweep<A, Filter>{{}, options.filter}, index,
                                    detail::swept_operand<std::remove_const_t<decltype(starts)>, std::remove_const_t<decltype(along)>>{
                                        starts, along});
        } else {
            return detail::no_answer<detail::ask_sweep<A, Filter>, std::uint32_t, space_of<Policy>>();
        }
    } else {
        return detail::no_answer<detail::ask_sweep<A, Filter>, std::uint32_t, space_of<Policy>>();
    }
}

}  // namespace abut
