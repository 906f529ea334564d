// SPDX-License-Identifier: MIT
#pragma once

// nearest: for each of many points the nearest shape of a set, or the nearest few, the point on it, and the distance.
//
// By definition the answer is the shape with the least squared distance, as narrow/nearest_point.hpp computes it, and of
// equal ones the one with the least id; the nearest few come in that order. Everything else here moves time and no answer:
// which index there is, in what order the points are taken.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/judge.hpp>
#include <abut/collide/nearest_group.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/ordered_look.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/index/ties.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/traverse/ordered_walk.hpp>

namespace abut {

/// A `neighbor` with an id in a set of many parts. Where there are no shapes at all: `no_global_id`, the point asked about
/// and infinity.
/// @ingroup distributed
template <scalar T>
struct global_neighbor {
    std::uint64_t id;  ///< of the shape
    vec3<T> point;     ///< on the shape, in the world
    T distance;        ///< from the point asked about, rounded to T

    friend constexpr bool operator==(const global_neighbor&, const global_neighbor&) = default;
};

/// A `neighbor` among bodies. Where there are no shapes both numbers are `no_id`.
/// @ingroup many_bodies
template <scalar T>
struct body_neighbor {
    std::uint32_t body;  ///< its number
    std::uint32_t id;    ///< of the shape in the body's set
    vec3<T> point;       ///< on the shape, in the world
    T distance;          ///< from the point asked about, rounded to T

    friend constexpr bool operator==(const body_neighbor&, const body_neighbor&) = default;
};

/// Options of `nearest`. With a filter write `nearest_options{.filter = f}` (see query_options).
/// @ingroup queries
template <class Filter = keep_all>
struct nearest_options {
    /// How many of the nearest shapes.
    std::size_t count = 1;
    /// filter(number of the point, id) -> bool, of bodies filter(number of the point, body, id): shapes for which it is
    /// false are not there. As in query_options. Ranks take none: points of other ranks have no numbers there.
    Filter filter = {};
};

namespace detail {

/// All shapes, or of each row those that a filter keeps. `Bodies` says that shapes have keys of bodies.
struct all_shapes_wanted {
    [[nodiscard]] ABUT_HD bool operator()(std::size_t, std::uint64_t) const { return true; }
};
template <class Filter, class Numbers, bool Bodies>
struct some_shapes_wanted {
    Filter filter;
    Numbers numbers;
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool operator()(std::size_t row, std::uint64_t key) const {
        const auto number = static_cast<std::uint32_t>(numbers(row)), id = static_cast<std::uint32_t>(key);
        if constexpr (Bodies) {
            return filter(number, body_of_key(key), id);
        } else {
            return filter(number, id);
        }
    }
};
template <bool Bodies, class Filter, class Rows>
auto shapes_wanted(const Filter& filter, const Rows& rows) {
    if constexpr (std::same_as<Filter, keep_all>) {
        return all_shapes_wanted{};
    } else {
        const auto numbers = numbers_of(rows);
        return some_shapes_wanted<Filter, std::remove_const_t<decltype(numbers)>, Bodies>{filter, numbers};
    }
}

/// A walk through an index from each of many points, in an order of theirs. (To begin each with what is nearest to the one
/// before was tried. It spares a walk one node in sixty: nearest first, the first shape that it meets is good enough.)
template <class Walk, class Frame, shape_view Shapes, shape_view Points, class Judge, class Wanted>
struct walk_from_points {
    static_assert(measuring_judge<Judge, typename Shapes::shape_type, typename Points::shape_type>);
    Walk walk;
    Frame frame;
    Shapes shapes;
    Points points;
    Judge judge;
    const std::uint32_t* order;  ///< null for their own
    Wanted wanted;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        const std::size_t row = order == nullptr ? i : order[i];
        const auto p = points[row];
        auto reach = frame.ball_around(p);
        walk(reach, best, [&](walk_id<Walk> id) {
            if (!wanted(row, id)) return false;
            const double value = judge.measure(shapes[id], p, best.bound());
            const bool is_tie = value == best.bound();
            best.offer(value, id);
            if constexpr (requires { walk.copies_with(id); Best::keeps_few; }) offer_copies(value, id, best);
            return is_tie;
        });
    }
    ABUT_INLINE void prefetch(std::size_t i) const {
        if (order != nullptr) prefetch_shape(points, order[i], 0);
    }

private:
    /// A walk that passes over copies comes to the first of them alone; of the few nearest others may be wanted.
    template <class Best>
    ABUT_HD void offer_copies([[maybe_unused]] double value, [[maybe_unused]] walk_id<Walk> key,
                              [[maybe_unused]] Best& best) const {
#if !ABUT_DEVICE_CODE
        const std::uint32_t* const next = walk.copies_with(key);
        if (next == nullptr) return;
        auto id = static_cast<std::uint32_t>(key);
        const auto first = static_cast<std::uint64_t>(key - id);
        while (next[id] != known_below::none && !best.known().comes_before({value, first + id})) {
            best.offer(value, first + (id = next[id]));
        }
#endif
    }
};

/// Every shape against one of the points.
template <shape_view Shapes, shape_view Points, class Judge>
struct measure_each_shape {
    Shapes shapes;
    Points points;
    std::size_t point;
    Judge judge;
    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        best.offer(judge.measure(shapes[i], points[point], best.bound()), i);
    }
};

/// The answers, each where its point is: `count` for each.
template <class Found, shape_view Shapes, shape_view Points>
struct write_neighbors {
    using T = typename Points::scalar_type;
    Shapes shapes;
    Points points;
    length_unit<T> unit;
    const std::uint32_t* order;
    const execution::least_value* found;  ///< null for none
    Found* out;
    std::size_t count = 1;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t point = count == 1 ? i : i / count;
        const std::size_t k = order == nullptr ? point : order[point];
        const std::size_t to = count == 1 ? k : k * count + (i - point * count);
        const vec3<T> p = points[k];
        const std::uint64_t key = found == nullptr ? no_global_id : found[i].key;
        neighbor<T> near{no_id, p, infinity<T>};
        if (key != no_global_id) near = neighbor_of(p, shapes[key], static_cast<std::uint32_t>(key), unit);
        if constexpr (requires(const Found& n) { n.body; }) {
            out[to] = {body_of_key(key), near.id, near.point, near.distance};
        } else {
            out[to] = near;
        }
    }
};

template <class X>
inline constexpr bool is_row_of_points = array_like<X> && !shape_view<X>;

/// Whether `nearest` takes both arguments.
template <class Policy, class X, class Points>
consteval bool can_be_near() {
    if constexpr (!can_be_asked_by_rows<Policy, X>()) {
        return false;
    } else {
        using shape_type = typename shape_of_argument<X>::type;
        constexpr bool is = approachable<shape_type>;
        static_assert(
            is, "abut: nearest needs nearest_point(shape, p) in the namespace of the shape, as docs/extending.md says");
        if constexpr (is_row_of_points<Points>) {
            return is_row<vec3<scalar_type_of<shape_type>>, element_of<Points>>() && is;
        } else if constexpr (!can_be_asked<Policy, Points>()) {
            return false;
        } else {
            using point = typename shape_of_argument<Points>::type;
            constexpr bool are = std::same_as<point, vec3<scalar_type_of<point>>>;
            static_assert(are, "abut: nearest looks from points: a set or a row of vec3, or one");
            if constexpr (are) return have_one_scalar<X, Points>() && is;
            return false;
        }
    }
}

/// Points as an operand: a set of points, a view of one, one point, or a row of them in host memory, which may be another
/// library's (shape/rows.hpp).
template <scalar T, class Policy, class Points>
auto make_points(const Policy& on, const Points& points, const char* function) {
    if constexpr (is_row_of_points<Points>) {
        const auto row = rows_as<vec3<T>>(points, function);
        if constexpr (host_policy<Policy>) {
            return make_operand(on, shapes_view<vec3<T>>(row.data(), row.size()), function);
        } else {
            return make_operand(on, shapes<vec3<T>, space_of<Policy>>(on, row), function);
        }
    } else {
        return make_operand(on, points, function);
    }
}

/// Fewer points than these look at a plain set one at a time, and the shapes are shared out among threads.
inline constexpr std::size_t few_points = 64;
/// As many points as these, or more, are taken along a curve: neighbours walk through the same nodes, or look together.
template <class Policy>
inline constexpr std::size_t many_points = looks_in_groups<Policy> ? 64 : 4096;

/// Null for their own.
template <class Operand, class Policy, shape_view Points>
execution::buffer_of<Policy, std::uint32_t> order_of_points(const Policy& on, const Points& points) {
    const std::size_t n = points.size();
    if (Operand::is_indexed && n >= many_points<Policy> && n < no_id) return order_on_curve(on, points);
    return {};
}

/// Each point walks by itself. `best` keeps what is nearest to each.
template <class Policy, class Operand, shape_view Points, class Judge, class Best, class Wanted = all_shapes_wanted>
void walk_alone_from_points(const Policy& on, const Operand& x, const Points& points, const Judge& judge,
                            const std::uint32_t* order, Best& best, const Wanted& wanted = {}) {
    auto walk = ordered_walk_of(x);
    const auto frame = frame_of(x, judge.unit);
    const auto there = x.shapes();
    [[maybe_unused]] const auto watch = watch_ties<Policy, std::same_as<Wanted, all_shapes_wanted>>(
        8, requires { Best::sink::keeps_few; }, walk, x);
    using walk_type = walk_from_points<std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                                       std::remove_const_t<decltype(there)>, Points, Judge, Wanted>;
    for_each_ordered(on, points.size(), walk_type{walk, frame, there, points, judge, order, wanted}, best);
}

/// Finds the nearest shape of each point. finish(order, found) takes what was found: found[i] is the least squared distance
/// of point order[i], or i where `order` is null; with no shapes or no points `found` is null.
template <class Policy, class Operand, class Queries, scalar T, class Finish>
auto look_for_nearest(const Policy& on, const Operand& x, const Queries& queries, const length_unit<T>& unit,
                  const Finish& finish) {
    const auto there = x.shapes();
    const auto from = queries.shapes();
    using shapes_type = std::remove_const_t<decltype(there)>;
    using points_type = std::remove_const_t<decltype(from)>;
    const std::size_t n = from.size(), m = there.size();
    if (n == 0 || m == 0) return finish(nullptr, nullptr);

    const measure_distance<T> judge{unit};
    if constexpr (!Operand::is_indexed) {
        if (n < few_points) {
            std::vector<execution::least_value> found;
            for (std::size_t k = 0; k < n; ++k) {
                execution::best_of_all<space_of<Policy>> best(on);
                for_each_ordered(on, m, measure_each_shape<shapes_type, points_type, decltype(judge)>{there, from, k, judge},
                                 best);
                found.push_back(best.least());
            }
            execution::buffer_of<Policy, execution::least_value> values(on, n);
            upload(on, found.data(), n, values.data());
            return finish(nullptr, values.data());
        }
    }
    const auto walk = ordered_walk_of(x);
    const auto order = order_of_points<Operand>(on, from);
    if constexpr (look_in_groups<Policy, std::remove_const_t<decltype(walk)>, typename shapes_type::shape_type>) {
        const auto frame = frame_of(x, unit);
        const walk_from_points<std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>, shapes_type, points_type,
                               measure_distance<T>, all_shapes_wanted>
            by_itself{walk, frame, there, from, judge, order.data(), {}};
        return finish(order.data(),
                      nearest_in_groups(on, walk.tree, frame, there, from, judge, order.data(), by_itself).data());
    } else {
        execution::best_of_each<space_of<Policy>> best(on, n);
        walk_alone_from_points(on, x, from, judge, order.data(), best);
        return finish(order.data(), best.data());
    }
}

/// The same for the `count` nearest: found[count * i], and what follows it, is of point order[i].
template <class Policy, class Operand, class Queries, scalar T, class Finish, class Wanted = all_shapes_wanted>
auto look_for_nearest_few(const Policy& on, const Operand& x, const Queries& queries, const length_unit<T>& unit,
                          std::size_t count, const Finish& finish, const Wanted& wanted = {}) {
    const auto from = queries.shapes();
    if (from.size() == 0 || x.shapes().size() == 0) return finish(nullptr, nullptr);
    const auto order = order_of_points<Operand>(on, from);
    execution::best_few_of_each<space_of<Policy>> best(on, from.size(), count);
    walk_alone_from_points(on, x, from, measure_distance<T>{unit}, order.data(), best, wanted);
    return finish(order.data(), best.data());
}

inline void check_few(std::size_t count, const char* function) {
    if (count == 0) throw error(std::string(function) + ": count is 0, expected 1 or more");
}
inline void check_neighbors(std::size_t points, std::size_t count, const char* function) {
    if (points <= (std::uint64_t{1} << 40) / count) return;
    throw capacity_error(std::string(function) + ": " + std::to_string(count) + " neighbours of " + std::to_string(points) +
                         " points, expected fewer than 2^40 in all");
}

/// A neighbor, and what it was found by.
template <scalar T>
struct measured_neighbor {
    double measure;    ///< the squared distance in the unit of all parts; infinite where there is none
    std::uint64_t id;  ///< in the whole set
    vec3<T> point;
    T distance;

    /// Whether it is nearer, or as near with a smaller id.
    [[nodiscard]] ABUT_HD bool comes_before(const measured_neighbor& other) const {
        return measure < other.measure || (measure == other.measure && id < other.id);
    }
};

/// What one part says: `count` for each point.
template <shape_view Shapes, shape_view Points, class Ids>
struct write_measured {
    using T = typename Points::scalar_type;
    Shapes shapes;
    Points points;
    length_unit<T> unit;
    Ids ids;
    const std::uint32_t* order;
    const execution::least_value* found;  ///< null for none
    measured_neighbor<T>* out;
    std::size_t count;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t point = count == 1 ? i : i / count;
        const std::size_t k = order == nullptr ? point : order[point];
        const std::size_t to = k * count + (i - point * count);
        const vec3<T> p = points[k];
        out[to] = {infinity<double>, no_global_id, p, infinity<T>};
        const std::uint64_t key = found == nullptr ? no_global_id : found[i].key;
        if (key == no_global_id) return;
        const neighbor<T> near = neighbor_of(p, shapes[key], static_cast<std::uint32_t>(key), unit);
        out[to] = {found[i].value, in_whole(ids, key), near.point, near.distance};
    }
};

/// Points ask, by any of the questions about them.
struct question_of_points : row_question {
    template <scalar T, class Policy, class Points>
    auto make_rows(const Policy& on, const Points& points, const char* function) const {
        return make_points<T>(on, points, function);
    }
};

/// What parts are asked: which of their shapes are nearest to a point, the nearest first.
template <scalar T, class Filter = keep_all>
struct nearest_in_parts {
    using answer = measured_neighbor<T>;
    length_unit<T> unit;
    std::size_t count = 1;
    Filter filter = {};

    [[nodiscard]] ABUT_HD std::size_t per_row() const { return count; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        const auto there = x.shapes();
        const auto from = rows.shapes();
        using shapes_type = std::remove_const_t<decltype(there)>;
        using points_type = std::remove_const_t<decltype(from)>;
        const auto write = [&](const std::uint32_t* order, const execution::least_value* found) {
            for_each_index(on, from.size() * count,
                           write_measured<shapes_type, points_type, Ids>{there, from, unit, ids, order, found, out, count});
            synchronize(on);
        };
        if constexpr (!std::same_as<Filter, keep_all>) {
            constexpr bool are_bodies = std::same_as<operand_id<Operand>, body_and_id>;
            look_for_nearest_few(on, x, rows, unit, count, write,
                                 shapes_wanted<are_bodies>(filter_in_part(filter, ids), rows));
        } else if (count == 1) {
            look_for_nearest(on, x, rows, unit, write);
        } else {
            look_for_nearest_few(on, x, rows, unit, count, write);
        }
    }
    /// Both are in order.
    ABUT_HD void merge(answer* best, const answer* other) const {
        std::size_t kept = count, taken = 0;
        while (kept > 0 && other[taken].comes_before(best[kept - 1])) --kept, ++taken;
        for (std::size_t to = kept + taken; taken > 0; --to) {  // what is last of both comes last
            const bool is_taken = kept == 0 || best[kept - 1].comes_before(other[taken - 1]);
            best[to - 1] = is_taken ? other[taken - 1] : best[kept - 1];
            is_taken ? --taken : --kept;
        }
    }
    ABUT_HD bool may_change(const vec3<T>& p, const answer* best, const part_bounds<T>& part) const {
        auto ball = world_frame<T>{unit.length(1)}.ball_around(p);
        if (best[count - 1].id != no_global_id) ball.shrink_to(best[count - 1].measure);
        return may_keep(part, ball);
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(const answer& near) const {
        if constexpr (requires(const Found& n) { n.body; }) {
            return {body_of_key(near.id), static_cast<std::uint32_t>(near.id), near.point, near.distance};
        } else {
            return {static_cast<decltype(Found::id)>(near.id), near.point, near.distance};
        }
    }
};

/// Which shapes are nearest to a point: one, or `Few`.
template <bool Few, class Filter = keep_all>
struct ask_nearest : question_of_points {
    static constexpr bool filters = !std::same_as<Filter, keep_all>;
    template <scalar T, class Id>
    using found = by_id<Id, neighbor<T>, body_neighbor<T>, global_neighbor<T>>;
    const char* function = "abut::nearest";
    std::size_t count = 1;
    Filter filter = {};

    template <class Policy, class X, class Points, bool Whole>
    static consteval bool takes() {
        if constexpr (!can_be_near<Policy, X, Points>()) {
            return false;
        } else if constexpr (filters) {
            return is_row_filter<Policy, Filter, is_bodies<X>>();
        } else {
            return true;
        }
    }
    template <class Policy, class X, class Points>
    void check(const Policy&, const X&, const Points& points, const char*) const {
        check_few(count, function);
        check_neighbors(points.shapes().size(), count, function);
    }
    template <class Policy, class X, class Points>
    [[nodiscard]] double largest(const Policy& on, const X& x, const Points& points) const {
        const auto from = points.shapes();
        return std::same_as<typename decltype(from)::scalar_type, float> ? 0 : largest_coordinate(on, x, from);
    }
    template <class Policy, class X, class Points>
    auto at_once(const Policy& on, const X& x, const Points& points, double largest) const {
        using T = typename decltype(points.shapes())::scalar_type;
        using row = found<T, operand_id<X>>;
        const auto unit = unit_of_magnitude<T>(largest);
        const auto finish = [&](const std::uint32_t* order, const execution::least_value* near) {
            execution::buffer_of<Policy, row> out(on, points.shapes().size() * count);
            write(on, x, points, unit, order, near, out.data());
            synchronize(on);
            return result<row, space_of<Policy>>(std::move(out));
        };
        if constexpr (Few) {
            constexpr bool are_bodies = std::same_as<operand_id<X>, body_and_id>;
            return look_for_nearest_few(on, x, points, unit, count, finish, shapes_wanted<are_bodies>(filter, points));
        } else {
            return look_for_nearest(on, x, points, unit, finish);
        }
    }
    /// Whether the unit does not have to be found out first.
    template <scalar T>
    static constexpr bool takes_in_stream = std::same_as<T, float>;
    template <class Policy, class X, class Points, class Row>
    void in_stream(const Policy& on, const X& x, const Points& points, Row* out) const {
        const auto from = points.shapes();
        const length_unit<float> unit{};
        const auto finish = [&](const std::uint32_t* order, const execution::least_value* near) {
            write(on, x, points, unit, order, near, out);
        };
        if constexpr (Few) {
            look_for_nearest_few(on, x, points, unit, count, finish, shapes_wanted<false>(filter, points));
        } else if (from.size() == 0 || x.shapes().size() == 0) {
            finish(nullptr, nullptr);
        } else {
            // Each alone: groups need the host between their kernels.
            const auto order = order_of_points<X>(on, from);
            execution::best_of_each<space_of<Policy>> best(on, from.size());
            walk_alone_from_points(on, x, from, measure_distance<float>{unit}, order.data(), best);
            finish(order.data(), best.data());
        }
    }
    template <scalar T>
    [[nodiscard]] nearest_in_parts<T, Filter> in_parts(double largest) const {
        return {unit_of_magnitude<T>(largest), count, filter};
    }

private:
    template <class Policy, class X, class Points, scalar T, class Row>
    void write(const Policy& on, const X& x, const Points& points, const length_unit<T>& unit, const std::uint32_t* order,
               const execution::least_value* near, Row* out) const {
        const auto there = x.shapes();
        const auto from = points.shapes();
        using writer = write_neighbors<Row, std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(from)>>;
        for_each_index(on, from.size() * count, writer{there, from, unit, order, near, out, count});
    }
};

}  // namespace detail

/// For each of `points` the nearest shape of `index`: a `result` of `neighbor`, in the order of the points. A neighbor has
/// the shape's id, the point on it, and the distance. Of equal distances it has the least id. Where there are no shapes it
/// has `no_id`, the point asked about, and infinity.
///
/// `index` is a bvh of any layout, a grid, a set, a view or one shape, posed or not. Its shapes have `nearest_point`:
/// triangles, segments, points, and spheres, capsules, cylinders, cones, boxes and hulls, which are solid, so that the
/// distance inside is 0. `points` is a set of points, a view, one point (vec3), or a vector or span of points in host
/// memory, of another library's type as well (shape/rows.hpp).
///
/// The same bits on every policy, for every index and any number of threads. Distances are computed in double; those that
/// differ by less than docs/numerics/distances.md says may be taken for each other. Without an index every point looks at
/// every shape; in a grid, points that are far from all shapes look at many.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one; a divided index is asked in its parts, and
/// each device holds 32 bytes (double: 48) a point. Of ranks (@ref distributed) a rank's own points look in all parts, and a
/// row is a `global_neighbor`; in double, scenes whose coordinates differ by factors beyond 2^250 may differ in the last
/// bits under a pose.
///
/// @par Memory
/// As in @ref queries; a vector or a span of points lies in host memory, and is copied under `cuda`. The result lies in the
/// policy's memory, 20 bytes a point in float and 40 in double. Among many shapes that are
/// equally near a host keeps 8 bytes for each shape with their tree, or takes 12 while it looks for several; and 4 more for
/// a moment.
///
/// @par Errors
/// - `invalid_geometry`: a view, a single shape or a row of points holds no geometry, or a pose is no rotation.
/// - `error`: a set or an index lies on another device.
/// - `capacity_error`: a view or a row has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp nearest
///
/// @ingroup queries
template <executor On, class X, class Points>
[[nodiscard]] auto nearest(const On& on, const X& index, const Points& points) {
    return ask_rows(on, detail::ask_nearest<false>{}, index, points);
}

/// For each of `points` the `count` nearest shapes of `index`: a `result` of `neighbor`, `count` for each point, in the
/// order of the points; those of point i stand at count * i and after. The nearest comes first; of equal distances the least
/// id does. Where there are fewer shapes the last are as `nearest` gives where there are none: `no_id`, the point asked
/// about, and infinity. What `index` and `points` may be, how accurate distances are, and that the answers are the same bits
/// everywhere: as of the nearest one. With a cloud of points as the index these are the neighbours of points among points.
///
/// Of several devices memory is `count` times as much as of the nearest one. Of ranks each gives the same `count`, below
/// 2^31.
///
/// It takes time in proportion to `count` for each shape that comes among the nearest so far: it is meant for counts up to
/// some hundred. All within a distance: `within`.
///
/// @par Memory
/// As in @ref queries; a vector or a span of points lies in host memory, and is copied under `cuda`. The result lies in the
/// policy's memory, 20 bytes for each of count * points in float and 40 in double, and while it is made 16 more.
///
/// @par Errors
/// - `error`: `count` is 0; a set or an index lies on another device.
/// - `invalid_geometry`: a view, a single shape or a row of points holds no geometry, or a pose is no rotation.
/// - `capacity_error`: a view or a row has 2^31 elements or more, or count * points is 2^40 or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp nearest few
///
/// @ingroup queries
template <executor On, class X, class Points>
[[nodiscard]] auto nearest(const On& on, const X& index, const Points& points, std::size_t count) {
    return ask_rows(on, detail::ask_nearest<true>{{}, "abut::nearest", count}, index, points);
}
/// The same of shapes that a filter keeps.
/// @ingroup queries
template <executor On, class X, class Points, class Filter = keep_all>
[[nodiscard]] auto nearest(const On& on, const X& index, const Points& points, const nearest_options<Filter>& options) {
    return ask_rows(on, detail::ask_nearest<true, Filter>{{}, "abut::nearest", options.count, options.filter}, index,
                    points);
}

}  // namespace abut
