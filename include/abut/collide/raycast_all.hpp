// SPDX-License-Identifier: MIT
#pragma once

// raycast_all: for each of many rays all triangles or solids that it meets, in the order in which it meets them.
//
// The rays walk once to count what each meets, and those that meet more than a few walk again to write it where it belongs.
// So memory is what the answer takes, and room for those few. Each ray then brings its own hits into order.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/raycast.hpp>

namespace abut {

/// One of the shapes that a ray meets.
/// @ingroup queries
template <scalar T>
struct hit_of_ray {
    std::uint32_t ray;  ///< its number
    std::uint32_t id;   ///< of the shape in its set
    T t;                ///< where, as in ray_hit

    friend constexpr bool operator==(const hit_of_ray&, const hit_of_ray&) = default;
};

/// A `hit_of_ray` with numbers in sets of many parts.
/// @ingroup distributed
template <scalar T>
struct global_hit_of_ray {
    std::uint64_t ray;  ///< its number among the rays of all ranks
    std::uint64_t id;   ///< of the shape
    T t;                ///< where, as in ray_hit

    friend constexpr bool operator==(const global_hit_of_ray&, const global_hit_of_ray&) = default;
};

/// One of the shapes of bodies that a ray meets.
/// @ingroup many_bodies
template <scalar T>
struct body_hit_of_ray {
    std::uint32_t ray;   ///< its number
    std::uint32_t body;  ///< the body's
    std::uint32_t id;    ///< of the shape in the body's set
    T t;                 ///< where, as in ray_hit

    friend constexpr bool operator==(const body_hit_of_ray&, const body_hit_of_ray&) = default;
};

namespace detail {

/// So many hits of a line are kept as they are counted.
inline constexpr std::uint64_t kept_hits = 4;

/// Counts what each line meets.
template <class A, class Walk, class Frame, class Shapes, class Lines, class Wanted>
struct count_along_lines {
    Walk walk;
    Frame frame;
    Shapes shapes;
    Lines lines;
    Wanted wanted;
    std::uint64_t* counts;
    execution::least_value* few;

    struct look {
        typename Lines::shape_type line;
        typename Wanted::row_type row;
        execution::least_value* few;
        std::uint64_t count = 0;

        ABUT_CALLS_ANY
        template <class Sink>
        ABUT_HD void operator()(const count_along_lines& all, walk_id<Walk> id, Sink&) {
            const double time = all.wanted.template time<A>(row, line, all.shapes[id], id);
            if (time >= 0 && count < kept_hits) few[count] = {time, id};
            if (time >= 0) ++count;
        }
        template <class Sink>
        ABUT_HD void end(const count_along_lines& all, std::size_t i, Sink&) const {
            all.counts[i] = count;
        }
    };
    ABUT_HD look start(std::size_t i) const { return {lines[i], wanted.row(i), few + kept_hits * i}; }
    ABUT_HD auto seen(std::size_t i) const { return line_along(frame, lines[i]); }
};

/// Brings a line's hits into their order, where they lie: as they come they nearly are (Shell, 1959).
ABUT_HD inline void sort_hits(execution::least_value* hits, std::uint64_t n) {
    std::uint64_t gap = n / 2;
    while (gap > 0) {
        for (std::uint64_t i = gap; i < n; ++i) {
            const execution::least_value at = hits[i];
            std::uint64_t k = i;
            for (; k >= gap; k -= gap) {
                if (hits[k - gap].comes_before(at)) break;
                hits[k] = hits[k - gap];
            }
            hits[k] = at;
        }
        gap = gap == 2 ? 1 : gap * 5 / 11;
    }
}

/// Writes what each line meets, from the place of its first hit on.
template <class A, class Walk, class Frame, class Shapes, class Lines, class Wanted>
struct write_along_lines {
    Walk walk;
    Frame frame;
    Shapes shapes;
    Lines lines;
    Wanted wanted;
    const std::uint64_t* first;
    const execution::least_value* few;
    execution::least_value* hits;

    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& sink) const {
        execution::least_value* const mine = hits + first[i];
        const std::uint64_t counted = first[i + 1] - first[i];
        if (counted <= kept_hits) {
            for (std::uint64_t k = 0; k < counted; ++k) mine[k] = few[kept_hits * i + k];
            return sort_hits(mine, counted);
        }
        const auto line = lines[i];
        const auto row = wanted.row(i);
        std::uint64_t count = 0;
        line_reach_of<Walk, typename Lines::scalar_type> reach(line_along(frame, line));
        walk(reach, sink, [&](walk_id<Walk> id) {
            const double time = wanted.template time<A>(row, line, shapes[id], id);
            if (time >= 0 && count < counted) mine[count++] = {time, id};
        });
        // `fast` may decide otherwise the second time, where a compiler contracts what it inlines.
        while (count < counted) mine[count++] = {};
        sort_hits(mine, counted);
    }
};

/// Hit k, by name(line, time and id) as `Hit`.
template <class Hit, class Name>
struct write_all_hits {
    const std::uint64_t* first;
    std::size_t lines;
    const execution::least_value* hits;
    Name name;
    Hit* out;

    ABUT_HD void operator()(std::size_t k) const {
        std::size_t low = 0, high = lines;  // the line is the last one whose first hit is not behind k
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (first[middle] <= k ? low : high) = middle;
        }
        out[k] = name(low, hits[k]);
    }
};
/// Hits as a caller gets them, of lines that are numbered from `first_ray` on.
template <class Hit>
struct name_hit {
    decltype(Hit::ray) first_ray = 0;
    ABUT_HD Hit operator()(std::size_t ray, const execution::least_value& hit) const {
        using T = decltype(Hit::t);
        const auto number = static_cast<decltype(Hit::ray)>(first_ray + ray);
        if constexpr (requires(const Hit& h) { h.body; }) {
            return {number, body_of_key(hit.key), static_cast<std::uint32_t>(hit.key), time_as<T>(hit.value)};
        } else {
            return {number, static_cast<decltype(Hit::id)>(hit.key), time_as<T>(hit.value)};
        }
    }
};

/// All that each line meets, in order, as `name` gives it.
template <arithmetic A, class Hit, class Policy, class Both, class Name>
execution::buffer_of<Policy, Hit> look_for_all_hits(const Policy& on, const Both& both, const Name& name) {
    if (both.has_nothing()) return {};
    const std::size_t n = both.size();
    execution::buffer_of<Policy, std::uint64_t> first(on, n + 1);
    execution::buffer_of<Policy, execution::least_value> few(on, kept_hits * n);
    auto until = both.wanted.until();
    for_each_ordered(on, n, from_each{both.template walk<count_along_lines, A>(first.data(), few.data())}, until);
    exclusive_scan(on, first.data(), n);
    std::uint64_t total = 0;
    download(on, first.data() + n, 1, &total);
    execution::buffer_of<Policy, execution::least_value> hits(on, total);
    for_each_ordered(
        on, n, both.template walk<write_along_lines, A>(std::as_const(first).data(), std::as_const(few).data(), hits.data()),
        until);
    execution::buffer_of<Policy, Hit> out(on, total);
    for_each_index(on, total, write_all_hits<Hit, Name>{first.data(), n, hits.data(), name, out.data()});
    synchronize(on);
    return out;
}

struct timed_hit {
    double time;
    std::uint64_t id;
    std::uint32_t line;
};

/// As a caller gets them.
template <class Hit>
struct write_timed_hits {
    const timed_hit* found;
    name_hit<Hit> name;
    Hit* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = name(found[i].line, {found[i].time, found[i].id}); }
};

/// All that lines meet: no answer of a fixed size. Of parts each gives a list in order, and lists are merged: ask_row_lists.
/// Such a question has item<T>, what is in these lists, and finish<Found>(on, rows, items, first), what becomes of them all.
template <arithmetic A, class Options = no_ray_options>
struct ask_all_hits : question_of_lines<Options, ask_all_hits<A, Options>> {
    template <scalar T, class Id>
    using found = by_id<Id, hit_of_ray<T>, body_hit_of_ray<T>, global_hit_of_ray<T>>;
    template <scalar>
    using item = timed_hit;
    static constexpr const char* function = "abut::raycast_all";

    template <class Found, class Policy, class Lines>
    static auto finish(const Policy& on, const Lines&, const result<timed_hit, space_of<Policy>>& hits, decltype(Found::ray) first) {
        execution::buffer_of<Policy, Found> out(on, hits.size());
        for_each_index(on, hits.size(), write_timed_hits<Found>{hits.data(), {first}, out.data()});
        synchronize(on);
        return result<Found, space_of<Policy>>(std::move(out));
    }
    template <class Policy, class X, class Lines>
    auto at_once(const Policy& on, const X& x, const Lines& lines, double) const {
        const auto both = lines_that_want(x, lines, this->options);
        using hit = found<typename std::remove_const_t<decltype(both)>::T, operand_id<X>>;
        return result<hit, space_of<Policy>>(look_for_all_hits<A, hit>(on, both, name_hit<hit>{}));
    }
    /// The list of one part: name(line, time and id) of each hit.
    template <class Policy, class X, class Lines, class Name>
    auto ask(const Policy& on, const X& x, const Lines& lines, const Name& name) const {
        return look_for_all_hits<A, timed_hit>(on, lines_that_want(x, lines, options_in_part(this->options, name.ids)),
                                               name);
    }
};
template <execution_policy Policy, class Question, class X, class Rows>
auto ask_row_lists(const Policy& on, const Question& question, const X& index, const Rows& rows) {
    return ask_rows(on, question, index, rows);
}

struct by_line_and_time {
    template <class Item>
    ABUT_HD bool operator()(const Item& x, const Item& y) const {
        if (x.line != y.line) return x.line < y.line;
        return x.time < y.time || (x.time == y.time && x.id < y.id);
    }
};
/// With the numbers of lines and ids of all.
template <class Lines, class Ids>
struct name_timed_hit {
    Lines lines;
    Ids ids;
    ABUT_HD timed_hit operator()(std::size_t line, const execution::least_value& hit) const {
        return {hit.value, in_whole(ids, hit.key), static_cast<std::uint32_t>(lines(line))};
    }
};
template <class Lines, class Ids>
name_timed_hit(const Lines&, const Ids&) -> name_timed_hit<Lines, Ids>;

}  // namespace detail

/// All shapes of `index` that each of `rays` meets: a `result` of `hit_of_ray`, sorted by the ray's number, then by t, then
/// by id. The first hit of a ray is that of `raycast`. A ray that meets nothing has none.
///
/// Arguments, and what is decided exactly, are those of `raycast`. Order is that of the times as `raycast` compares them, in
/// double, also where t is a float. A ray through an edge meets both faces at it.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one, which holds 48 bytes a hit besides. Of
/// ranks
/// (@ref distributed) a row is a `global_hit_of_ray` of the rank's own rays, and the lists of all ranks, one after another,
/// are the list of one machine; a rank holds the hits of others' rays in its part until all rays have come, 24 bytes each,
/// besides its own, of which it holds 48 bytes more, and 2^31 hits or more of one rank's rays in one other part are a
/// `capacity_error`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 12 bytes a hit in float and 16 in double. Scratch takes 72
/// bytes a ray and 16 a hit. To take less, ask for some rays at a time: a view of a part of them will do.
///
/// @par Errors
/// Those of `raycast`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp raycast_all
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays>
[[nodiscard]] auto raycast_all(const On& on, const X& index, const Rays& rays) {
    return ask_row_lists(on, detail::ask_all_hits<A>{}, index, rays);
}
/// The same of hits that options keep.
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays, class Filter = keep_all>
[[nodiscard]] auto raycast_all(const On& on, const X& index, const Rays& rays, const raycast_options<Filter>& options) {
    return ask_row_lists(on, detail::ask_all_hits<A, raycast_options<Filter>>{{{}, options}}, index, rays);
}

}  // namespace abut
