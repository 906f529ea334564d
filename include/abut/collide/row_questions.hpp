// SPDX-License-Identifier: MIT
#pragma once

// Questions that many points or lines ask, each by itself, of shapes that may lie in parts, on several devices or ranks:
// what is nearest, what a line meets first, whether it meets anything, whether a point is inside. Each part answers all that
// it is asked, and answers of two parts become one, so that nothing depends on how shapes are divided.
//
// A question has
//   answer                          what one part says of a row; a row has per_row() of them
//   ask(on, x, rows, ids, out)      what shapes x answer to rows, both operands, in the policy's memory; ids(i) is the id in the
//                                   whole set of the part's shape i
//   merge(best, other)              takes into a row's answers those that another part gives
//   may_change(row, best, part)     whether a part, of which the boxes are known, may have an answer that changes these

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/ray_reach.hpp>

namespace abut {

/// The id of no shape in a set of many parts.
/// @ingroup distributed
inline constexpr std::uint64_t no_global_id = static_cast<std::uint64_t>(-1);

namespace detail {

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

/// Whether a part may hold what a reach keeps (shrinking_reach).
template <scalar T, class Reach>
ABUT_HD bool may_keep(const part_bounds<T>& part, const Reach& reach) {
    if (!reach.keeps(reach.least_in(part.around))) return false;
    bool may = false;
    for (std::size_t k = 0; k < part_boxes; ++k) {
        const aabb<T>& box = part.groups[k];
        may |= box.lower.x <= box.upper.x && reach.keeps(reach.least_in(box));
    }
    return may;
}
/// Whether a line in the world may meet something of a part that is not later than `last`.
template <class Line, scalar T>
ABUT_HD bool may_meet(const Line& line, const part_bounds<T>& part, double last) {
    const line_of<T> l(line);
    auto reach = reach_of_line(world_frame<T>{}, l.origin, l.direction(), l.last);
    reach.shrink_to(last);
    return may_keep(part, reach);
}

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
        if (found == nullptr || found[i].key >= no_id) return;
        const auto id = static_cast<std::uint32_t>(found[i].key);
        const neighbor<T> near = neighbor_of(p, shapes[id], id, unit);
        out[to] = {found[i].value, ids(id), near.point, near.distance};
    }
};

/// Which shapes are nearest to a point, the nearest first.
template <scalar T>
struct ask_nearest {
    using answer = measured_neighbor<T>;
    length_unit<T> unit;
    std::size_t count = 1;

    [[nodiscard]] ABUT_HD std::size_t per_row() const { return count; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        const auto there = x.shapes();
        const auto from = rows.shapes();
        using shapes_type = std::remove_const_t<decltype(there)>;
        using points_type = std::remove_const_t<decltype(from)>;
        const auto write = [&](const std::uint32_t* order, const execution::least_value* found) {
            for_each_index(
                on, from.size() * count,
                write_measured<shapes_type, points_type, Ids>{there, from, unit, ids, order, found, out, count});
            synchronize(on);
        };
        if (count == 1) {
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
};

template <class Ids>
struct write_named {
    const execution::least_value* found;  ///< null for none
    Ids ids;
    execution::least_value* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = {};
        if (found == nullptr || found[i].key >= no_id) return;
        out[i] = {found[i].value, ids(static_cast<std::uint32_t>(found[i].key))};
    }
};

/// What a line meets first: its time and its id.
template <arithmetic A>
struct ask_first_hit {
    using answer = execution::least_value;

    [[nodiscard]] ABUT_HD std::size_t per_row() const { return 1; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        const lines_and_shapes both{x, rows};
        look_for_first_hits<A>(on, both, false, [&](const execution::least_value* found) {
            for_each_index(on, both.size(), write_named<Ids>{found, ids, out});
            synchronize(on);
        });
    }
    ABUT_HD void merge(answer* best, const answer* other) const { best->offer(other->value, other->key); }
    template <class Line, scalar T>
    ABUT_HD bool may_change(const Line& line, const answer* best, const part_bounds<T>& part) const {
        return may_meet(line, part, best->value);
    }
};

/// Whether a line meets anything: 1 or 0.
template <arithmetic A>
struct ask_any_hit {
    using answer = std::uint8_t;

    [[nodiscard]] ABUT_HD std::size_t per_row() const { return 1; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids&, answer* out) const {
        look_for_any_hits<A>(on, lines_and_shapes{x, rows}, out);
        synchronize(on);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        if (*other != 0) *best = 1;
    }
    template <class Line, scalar T>
    ABUT_HD bool may_change(const Line& line, const answer* best, const part_bounds<T>& part) const {
        return *best == 0 && may_meet(line, part, infinity<double>);
    }
};

/// Where a point is: of a part, whether the way up from it crosses an odd number of the part's triangles.
template <arithmetic A>
struct ask_inside {
    using answer = containment;

    [[nodiscard]] ABUT_HD std::size_t per_row() const { return 1; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids&, answer* out) const {
        look_upward<A>(on, x, rows, out);
        synchronize(on);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        const bool is_on = *best == containment::on_surface || *other == containment::on_surface;
        *best = is_on ? containment::on_surface : *best == *other ? containment::outside : containment::inside;
    }
    template <scalar T>
    ABUT_HD bool may_change(const vec3<T>& p, const answer* best, const part_bounds<T>& part) const {
        return *best != containment::on_surface && may_meet(ray<T>{p, {0, 0, 1}}, part, infinity<double>);
    }
};

// All that lines meet is no answer of a fixed size: each part gives a list in order, and lists are merged.

struct timed_hit {
    double time;
    std::uint64_t id;
    std::uint32_t line;
};
struct by_line_and_time {
    ABUT_HD bool operator()(const timed_hit& x, const timed_hit& y) const {
        if (x.line != y.line) return x.line < y.line;
        return x.time < y.time || (x.time == y.time && x.id < y.id);
    }
};
/// With the numbers of lines and ids of all (look_for_all_hits).
template <class Lines, class Ids>
struct name_timed_hit {
    Lines lines;
    Ids ids;
    ABUT_HD timed_hit operator()(std::size_t line, const execution::least_value& hit) const {
        return {hit.value, ids(static_cast<std::uint32_t>(hit.key)), static_cast<std::uint32_t>(lines(line))};
    }
};
struct same_number {
    ABUT_HD std::size_t operator()(std::size_t i) const { return i; }
};

template <class Question>
struct merge_answers {
    Question question;
    const typename Question::answer* other;
    typename Question::answer* best;
    ABUT_HD void operator()(std::size_t row) const {
        question.merge(best + row * question.per_row(), other + row * question.per_row());
    }
};

}  // namespace detail

}  // namespace abut
