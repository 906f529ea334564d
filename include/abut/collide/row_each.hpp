// SPDX-License-Identifier: MIT
#pragma once

// any_each and any_within_each of rows: of each shape of a set whether it meets anything of another one. On a host a row looks in
// the index and decides as it goes, until it meets something; many rows look for points in cells (index/point_cells.hpp).
// Elsewhere the pairs of rows are left out that have met something. Not for which shapes they meet: `pairs` tells.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pair_up.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/collide/within.hpp>
#include <abut/error.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/point_cells.hpp>

namespace abut {

/// Options of `any_each` and `any_within_each` of rows. With a filter write `each_options{.filter = f}` (see query_options).
/// @ingroup queries
template <class Filter = keep_all>
struct each_options {
    /// filter(number of the row, id) -> bool: shapes for which it is false are not met. As in query_options. Ranks take none:
    /// rows of other ranks have no numbers there.
    Filter filter = {};
    /// How many rows one after another share an answer, as the links of a robot's state do: 1 if any of them meets anything, and
    /// then no more of them is looked at. The number of rows has to be a multiple of it. Policies alone take groups.
    std::size_t group = 1;
};

namespace detail {

/// A filter of rows, by their numbers, as one of pairs of an id and a row.
template <class Filter, class Numbers>
struct wanted_by_row {
    Filter filter;
    Numbers numbers;
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool operator()(std::uint32_t id, std::uint32_t row) const {
        return filter(static_cast<std::uint32_t>(numbers(row)), id);
    }
};
template <class Numbers>
struct wanted_by_row<keep_all, Numbers> : keep_all {
    wanted_by_row(const keep_all&, const Numbers&) {}
};

template <class Judge, class S, class U>
[[nodiscard]] bool surely_meets(const Judge& judge, const S& s, const U& row) {
    verdict v = judge.decide(s, row);
    if (v == verdict::unknown) v = judge.finish(s, row);
    return v == verdict::unknown ? judge.resolve(s, row) : v == verdict::yes;
}

/// Of each group of rows whether one meets anything, by walks that end at the first shape that is met. On a host, where a judge
/// has all it needs.
template <class Walk, class Shapes, class Rows, class Wanted, class Judge, class Nearness>
struct look_until_met {
    Walk walk;
    Shapes shapes;
    Rows rows;
    Wanted wanted;
    Judge judge;
    Nearness near;
    std::size_t group;
    std::uint8_t* out;

    void operator()(std::size_t g) const {
        bool met = false;
        for (std::size_t i = g * group; i < (g + 1) * group && !met; ++i) {
            const auto row = rows[i];
            auto reach = near.reach(row);
            typename Walk::cursor at;
            if (!walk.may_touch(reach)) continue;
            walk.for_each(reach, at, [] { return false; }, [&](std::uint32_t id) {
                met = wanted(id, static_cast<std::uint32_t>(i)) && surely_meets(judge, shapes[id], row);
                return met ? visit::stop : visit::proceed;
            });
        }
        out[g] = met ? 1 : 0;
    }
};

/// The ball that has just the points that a row meets.
///@{
template <scalar T>
sphere<T> ball_to_meet(const sphere<T>& s, const near_enough_to_touch&) {
    return s;
}
template <scalar T>
sphere<T> ball_to_meet(const vec3<T>& p, const near_enough_to_touch&) {
    return {p, T(0)};
}
template <class Row, scalar T>
    requires requires(const Row& row) { ball_to_meet(row, near_enough_to_touch{}); }
sphere<T> ball_to_meet(const Row& row, const near_in_distance<T>& near) {
    const sphere<T> ball = ball_to_meet(row, near_enough_to_touch{});
    return {ball.center, ball.radius + near.frame.distance};
}
///@}

/// The same of points in cells, of so many rows at a time: of balls first those are found that meet nothing by the cell of their
/// centre alone, then those that have the point that is kept there. The memory of one row is on its way while another is looked at.
template <scalar T, class Shapes, class Rows, class Wanted, class Judge, class Nearness>
struct look_among_points {
    static constexpr std::size_t at_a_time = 64;
    const point_cells<T>* cells;
    Shapes shapes;
    Rows rows;
    Wanted wanted;
    Judge judge;
    Nearness near;
    std::size_t group;
    std::uint8_t* out;

    /// Rows of whole groups that one thread looks at.
    [[nodiscard]] std::size_t in_block() const { return greatest(at_a_time / group, std::size_t{1}) * group; }
    void operator()(std::size_t block) const {
        const std::size_t first = block * in_block(), end = least(first + in_block(), rows.size());
        for (std::size_t g = first / group; g < end / group; ++g) out[g] = 0;
        for (std::size_t begin = first; begin < end; begin += at_a_time) look_at(begin, least(at_a_time, end - begin));
    }

private:
    void look_at(std::size_t begin, std::size_t count) const {
        if constexpr (requires { ball_to_meet(rows[0], near); }) {
            ball_in_cells ball[at_a_time];
            std::uint8_t open[at_a_time];
            std::size_t left = 0, last = 0;
            for (std::size_t k = 0; k < count; ++k) {
                const sphere<T> of_row = ball_to_meet(rows[begin + k], near);
                ball[k] = cells->in_cells(of_row.center, of_row.radius);
                open[left] = static_cast<std::uint8_t>(k);
                left += cells->is_clear(ball[k]) ? 0 : 1;
            }
            for (std::size_t i = 0; i < left; ++i) {
                const std::size_t k = open[i];
                const std::uint32_t at = cells->near(ball[k]);
                const bool met = cells->has_surely(ball[k], at) && is_wanted(cells->id(at), begin + k);
                out[(begin + k) / group] |= met ? 1 : 0;
                open[last] = open[i];
                last += met ? 0 : 1;
            }
            for (std::size_t i = 0; i < last; ++i) look(ball[open[i]], begin + open[i]);
        } else {
            for (std::size_t k = 0; k < count; ++k) {
                if (out[(begin + k) / group] == 0) look(near.reach(rows[begin + k]), begin + k);
            }
        }
    }
    [[nodiscard]] bool is_wanted(std::uint32_t id, std::size_t i) const { return wanted(id, static_cast<std::uint32_t>(i)); }
    void look(const ball_in_cells& ball, std::size_t i) const {
        std::uint8_t met = out[i / group];
        if (met != 0) return;
        cells->for_each(ball, [&](std::uint32_t id, bool surely) {
            met = is_wanted(id, i) && (surely || surely_meets(judge, shapes[id], rows[i])) ? 1 : 0;
            return met == 0;
        });
        out[i / group] = met;
    }
    template <class Reach>
    void look(Reach reach, std::size_t i) const {
        std::uint8_t met = 0;
        cells->for_each(reach.bounds(), [&](std::uint32_t id) {
            const vec3<T> p = shapes[id];
            met = reach(aabb<T>{p, p}) && is_wanted(id, i) && surely_meets(judge, p, rows[i]) ? 1 : 0;
            return met == 0;
        });
        out[i / group] = met;
    }
};

/// Elsewhere: pairs of rows whose group has met nothing yet.
template <class Wanted>
struct until_row_met {
    Wanted wanted;
    std::uint32_t group;
    std::uint32_t* met;  ///< of each group
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t id, std::uint32_t row) const {
        return execution::atomic_load(met + row / group) == 0 && wanted(id, row);
    }
};
struct mark_row {
    std::uint32_t group;
    std::uint32_t* met;
    ABUT_HD visit operator()(const index_pair& of) const {
        execution::atomic_store(met + of.b / group, 1);
        return visit::proceed;
    }
};
struct write_met {
    const std::uint32_t* met;
    std::uint8_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = met[i] != 0 ? 1 : 0; }
};

/// Whether a row, or one of a group, has the relation to any shape: 1 or 0.
template <arithmetic A, class Relation, class Filter>
struct ask_any_met : row_question {
    template <scalar, class>
    using found = std::uint8_t;
    using answer = std::uint8_t;
    static constexpr bool filters = !std::same_as<Filter, keep_all>;
    const char* function;
    Relation relation;
    Filter filter;
    std::size_t group = 1;

    template <class Policy, class X, class Rows, bool Whole>
    static consteval bool takes() {
        static_assert(!is_bodies<X>, "abut: rows are asked about a set, an index or a shape; bodies are asked as a list of pairs");
        if constexpr (is_bodies<X>) {
            return false;
        } else if constexpr (!can_both_be_asked<Policy, X, Rows>()) {
            return false;
        } else if constexpr (!Relation::template decides<typename shape_of_argument<X>::type,
                                                         typename shape_of_argument<Rows>::type>()) {
            return false;
        } else {
            return is_row_filter<Policy, Filter, false>();
        }
    }
    template <class Policy, class X, class Rows>
    void check(const Policy&, const X&, const Rows& rows, const char*) const {
        relation.check(function);
        if (const std::size_t n = rows.shapes().size(); group == 0 || n % group != 0) {
            throw error(std::string(function) + ": group is " + std::to_string(group) + "; expected a divisor of the number of rows, " +
                        std::to_string(n));
        }
    }
    template <scalar T, class Policy, class Rows>
    auto make_rows(const Policy& on, const Rows& rows, const char*) const {
        return make_operand(on, rows, function);
    }
    template <class Policy, class X, class Rows>
    auto at_once(const Policy& on, const X& x, const Rows& rows, double) const {
        execution::buffer_of<Policy, answer> out(on, rows.shapes().size() / group);
        ask(on, x, rows, same_key{}, out.data());
        return result<answer, space_of<Policy>>(std::move(out));
    }
    template <scalar T>
    [[nodiscard]] ask_any_met in_parts(double) const {
        return *this;
    }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        using T = typename std::remove_cvref_t<decltype(x.shapes())>::scalar_type;
        const auto mine = filter_in_part(filter, ids);
        const wanted_by_row<std::remove_const_t<decltype(mine)>, decltype(numbers_of(rows))> wanted{mine, numbers_of(rows)};
        const auto near = relation.template nearness<T>();
        const auto judge = relation.template judge<A>();
        const std::size_t n = rows.shapes().size(), groups = n / group;
        if (n == 0 || x.shapes().size() == 0) {
            fill(on, out, groups, answer{0});
            return;
        }
        if constexpr (host_policy<Policy>) {
            using shapes_type = decltype(x.shapes());
            using rows_type = decltype(rows.shapes());
            if constexpr (std::same_as<typename shapes_type::shape_type, vec3<T>>) {
                using look = look_among_points<T, shapes_type, rows_type, decltype(wanted), decltype(judge), decltype(near)>;
                const auto among = [&](const point_cells<T>& cells) {
                    const look all{&cells, x.shapes(), rows.shapes(), wanted, judge, near, group, out};
                    for_each_index(on, (n + all.in_block() - 1) / all.in_block(), all);
                };
                if constexpr (requires { x.clearances(); }) {
                    if (x.clearances() != nullptr && x.clearances()->is_there()) return among(*x.clearances());
                }
                // Of fewer rows the cells would cost more than they save: they take as long as half a walk for each point.
                if (n >= (Operand::is_indexed ? 2 * x.shapes().size() : 16)) {
                    const point_cells<T> cells(x.shapes(), n);
                    if (cells.is_there()) return among(cells);
                }
            }
            if constexpr (Operand::is_indexed) {
                for_each_index(on, groups, look_until_met<decltype(x.walk()), shapes_type, rows_type, decltype(wanted), decltype(judge),
                                                          decltype(near)>{x.walk(), x.shapes(), rows.shapes(), wanted, judge, near,
                                                                          group, out});
                return;
            }
        }
        if constexpr (!host_policy<Policy> || !Operand::is_indexed) {
            const auto each = static_cast<std::uint32_t>(group);
            execution::buffer_of<Policy, std::uint32_t> met(on, groups);
            fill(on, met.data(), groups, std::uint32_t{0});
            const query_options<until_row_met<std::remove_const_t<decltype(wanted)>>> options{.filter = {wanted, each, met.data()}};
            visited_by(mark_row{each, met.data()}).template find<A>(on, pair_operands(on, x, rows, options, near), relation);
            for_each_index(on, groups, write_met{met.data(), out});
        }
        synchronize(on);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        if (*other != 0) *best = 1;
    }
    template <class Row, scalar T>
    ABUT_HD bool may_change(const Row& row, const answer* best, const part_bounds<T>& part) const {
        return *best == 0 && part.reaches(relation.template nearness<T>().reach(row).bounds());
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(const answer& met) const {
        return met;
    }
};

template <executor On, class Question, class X, class Rows>
auto ask_each(const On& on, const Question& question, const X& index, const Rows& rows) {
    if constexpr (!execution_policy<On>) {
        if (question.group != 1) throw error(std::string(question.function) + ": rows are in groups; policies alone take these");
    }
    return ask_rows(on, question, index, rows);
}

}  // namespace detail

/// Which of `rows` meet anything: a `result` of `std::uint8_t`, in the order of the rows, 1 where a row touches a shape of
/// `index` and the filter wants the two, else 0. It is what `pairs` says of them, and takes less time: a row is looked at no
/// more once it has met something. So thousands of states of a robot, each of some spheres, are one call.
///
/// With `each_options{.group = k}` it is one answer of each k rows one after another, and so of each state.
///
/// `index` is a tree of any layout, a grid, a set, a view or one shape, posed or not; `rows` is a set, a view or one shape: of
/// any two shapes that `pairs` takes. On a host `wide` trees are the fastest; for spheres against points a grid that keeps clearances
/// (grid_options) is.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one. Of ranks (@ref distributed) a rank's own rows
/// look in all parts.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 1 byte a row, or a group of rows. Where there is no index, and
/// on a device, the call takes 4 bytes a row, or group, more. On a host it takes up to 37 bytes a point more, where many rows look for points and these keep
/// no clearances (grid_options).
///
/// @par Errors
/// As in @ref queries; and `error` where the number of rows is no multiple of the group, or where several devices or ranks get one.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
///
///     const auto collides = abut::to_host(abut::any_each(on, room, links));  // spheres of all states, one after another
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rows, class Filter = keep_all>
    requires(!detail::scene<X>)
[[nodiscard]] auto any_each(const On& on, const X& index, const Rows& rows, const each_options<Filter>& options = {}) {
    return detail::ask_each(
        on, detail::ask_any_met<A, detail::touching, Filter>{{}, "abut::any_each", {}, options.filter, options.group}, index, rows);
}

/// Which of `rows` come within a distance of anything: as `any_each`, of shapes that are no farther apart than `distance`, which
/// is as in `within`.
/// @ingroup within
template <arithmetic A = filtered, executor On, class X, class Rows, class Filter = keep_all>
    requires(!detail::scene<X>)
[[nodiscard]] auto any_within_each(const On& on, const X& index, const Rows& rows, double distance,
                                   const each_options<Filter>& options = {}) {
    return detail::ask_each(on,
                            detail::ask_any_met<A, detail::within_distance, Filter>{
                                {}, "abut::any_within_each", detail::within_distance(distance), options.filter, options.group},
                            index, rows);
}

}  // namespace abut
