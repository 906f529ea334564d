// SPDX-License-Identifier: MIT
#pragma once

// raycast: for each of many rays the triangle or solid that it meets first, and when; raycast_any: whether it meets any.
//
// By definition the first is the shape with the least time, as narrow/hit_time.hpp, hull_hit_time.hpp and solid_hit_time.hpp
// give it, and of equal ones the one with the least id. The walk is that of `nearest`: nearer child first, and no farther
// than what is found. Whether there is any is the same walk, which ends at the first hit. raycast_all.hpp has all of them.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/ray_options.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/hull_hit_time.hpp>
#include <abut/narrow/solid_hit_time.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/traverse/from_each.hpp>

namespace abut {

/// What a ray meets first. Where it meets nothing: `no_id` and infinity.
/// @ingroup queries
template <scalar T>
struct ray_hit {
    std::uint32_t id;  ///< of the shape in its set
    T t;               ///< where: at origin + t direction, or a + t (b - a) of a segment

    friend constexpr bool operator==(const ray_hit&, const ray_hit&) = default;
};

/// A `ray_hit` with an id in a set of many parts. Where nothing is met: `no_global_id` and infinity.
/// @ingroup distributed
template <scalar T>
struct global_ray_hit {
    std::uint64_t id;  ///< of the shape
    T t;               ///< where: at origin + t direction, or a + t (b - a) of a segment

    friend constexpr bool operator==(const global_ray_hit&, const global_ray_hit&) = default;
};

/// What a ray meets first of bodies. Where it meets nothing: `no_id` for both numbers and infinity.
/// @ingroup many_bodies
template <scalar T>
struct body_hit {
    std::uint32_t body;  ///< its number
    std::uint32_t id;    ///< of the shape in the body's set
    T t;                 ///< where, as in ray_hit

    friend constexpr bool operator==(const body_hit&, const body_hit&) = default;
};

namespace detail {

/// How a frame sees a line.
template <class Frame, class Line>
ABUT_HD auto line_along(const Frame& frame, const Line& line) {
    const line_of<scalar_type_of<Line>> l(line);
    return line_seen(frame, l.origin, l.direction(), l.last);
}

/// A time as it is reported: no infinity.
template <scalar T>
ABUT_HD T time_as(double time) {
    const double most = static_cast<double>(largest_finite<T>);
    return static_cast<T>(time < most ? time : most);
}

/// Looks for what a line, or something else that goes along one, meets first. `All` has
///   bounds(line, row, id, until)   between which times a shape is met, negative ones where that is not by `until`
///   time(line, id)                 that time, rounded
///   in_scalars                     whether times need only become the right scalars: then they may be off by less than that tells
/// Times are rounded where two shapes are met at nearly the same one, and at the end.
template <class All>
struct look_for_first {
    typename All::line_type line;
    typename All::row_type row;
    double earliest = infinity<double>;  ///< the least time that the first shape so far may have; the sink has the most

    ABUT_CALLS_ANY
    template <class Id, class Best>
    ABUT_HD bool operator()(const All& all, Id id, Best& best) {
        time_bounds time = all.bounds(line, row, id, best.bound());
        if (time.first < 0 || time.first > best.bound()) return false;
        bool is_tie = false;
        if (!(time.last < earliest)) {
            round(all, best);
            if (time.first > best.bound()) return false;
            if (!time.is_one()) time.first = time.last = all.time(line, id);
            is_tie = time.first == best.bound();
            if (!execution::least_value{time.first, id}.comes_before(best.known())) return is_tie;
        }
        earliest = time.first;
        best.offer(time.last, id);
        return is_tie;
    }
    template <class Best>
    ABUT_HD void end(const All& all, std::size_t, Best& best) {
        using T = scalar_type_of<typename All::line_type>;
        if (!all.in_scalars || time_as<T>(earliest) != time_as<T>(best.known().value)) round(all, best);
    }

private:
    template <class Best>
    ABUT_HD void round(const All& all, Best& best) {
        const execution::least_value last = best.known();
        if (earliest == last.value) return;
        earliest = all.time(line, static_cast<typename All::id_type>(last.key));
        best.offer(earliest, last.key);
    }
};

/// Of each line what it meets first.
template <class A, class Walk, class Frame, class Shapes, class Lines, class Wanted>
struct walk_along_lines {
    using line_type = typename Lines::shape_type;
    using row_type = typename Wanted::row_type;
    using id_type = walk_id<Walk>;
    Walk walk;
    Frame frame;
    Shapes shapes;
    Lines lines;
    Wanted wanted;
    bool in_scalars;

    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD time_bounds bounds(const line_type& line, const row_type& row, id_type id, double) const {
        return wanted.template bounds<A>(row, line, shapes[id], id);
    }
    [[nodiscard]] ABUT_HD double time(const line_type& line, id_type id) const { return hit_time_apart<A>(line, shapes[id]); }
    using look = look_for_first<walk_along_lines>;
    ABUT_HD look start(std::size_t i) const { return {lines[i], wanted.row(i)}; }
    ABUT_HD auto seen(std::size_t i) const { return line_along(frame, lines[i]); }

    /// The same as long as plain numbers tell all that is asked. Where they do not it gives up, and all is asked again. So a
    /// device has nothing in a walk that is called out of line, for which it would keep room, and lines in memory.
    struct plain_look {
        typename Lines::shape_type line;
        double earliest = infinity<double>;
        bool has_given_up = false;

        ABUT_CALLS_ANY
        template <class Best>
        ABUT_HD void operator()(const walk_along_lines& all, walk_id<Walk> id, Best& best) {
            const time_bounds time = plain_hit_time_bounds<A>(line, all.shapes[id]);
            if (time.first < 0 || time.first > best.bound()) return;
            if (!(time.last < earliest) && !(time.is_one() && time.last == best.known().value)) {
                has_given_up = true;
                return best.offer(0, id);  // which ends the walk soon
            }
            earliest = time.first;
            best.offer(time.last, id);
        }
        /// False where it has given up.
        template <class Best>
        [[nodiscard]] ABUT_HD bool end(const walk_along_lines& all, Best& best) const {
            using T = typename Lines::scalar_type;
            if (has_given_up) return false;
            const execution::least_value last = best.known();
            if (earliest == last.value || (all.in_scalars && time_as<T>(earliest) == time_as<T>(last.value))) return true;
            const auto again = line;
            best.offer(all.time(again, static_cast<id_type>(last.key)), last.key);
            return true;
        }
    };
    ABUT_HD plain_look start_plainly(std::size_t i) const
        requires std::same_as<Wanted, all_hits_wanted> && requires(const typename Lines::shape_type& line, std::size_t id) {
            plain_hit_time_bounds<A>(line, shapes[id]);
        }
    {
        return {lines[i]};
    }
};

/// Of each line whether it meets anything: the same, which ends at what it meets at all.
template <class A, class Walk, class Frame, class Shapes, class Lines, class Wanted>
struct walk_to_any {
    Walk walk;
    Frame frame;
    Shapes shapes;
    Lines lines;
    Wanted wanted;
    std::uint8_t* out;

    struct look {
        typename Lines::shape_type line;
        typename Wanted::row_type row;
        bool met = false;

        ABUT_CALLS_ANY
        template <class Sink>
        ABUT_HD void operator()(const walk_to_any& all, walk_id<Walk> id, Sink& sink) {
            if (met || !all.wanted.template meets<A>(row, line, all.shapes[id], id)) return;
            met = true;
            sink.stop();
        }
        template <class Sink>
        ABUT_HD void end(const walk_to_any& all, std::size_t i, Sink&) const {
            all.out[i] = met ? 1 : 0;
        }
    };
    ABUT_HD look start(std::size_t i) const { return {lines[i], wanted.row(i)}; }
    ABUT_HD auto seen(std::size_t i) const { return line_along(frame, lines[i]); }
};

/// What was met first, as a caller gets it.
template <class Hit>
ABUT_HD Hit named_hit(const execution::least_value& found) {
    using T = decltype(Hit::t);
    const T t = found.key == no_global_id ? infinity<T> : time_as<T>(found.value);
    if constexpr (requires(const Hit& h) { h.body; }) {
        return {body_of_key(found.key), static_cast<std::uint32_t>(found.key), t};
    } else {
        return {static_cast<decltype(Hit::id)>(found.key), t};
    }
}
/// best_of_each that keeps nothing else: what was met is written as soon as it is known.
template <class Hit, memory_space Space>
struct hits_of_each {
    struct sink : execution::best_of_each<Space>::sink {
        Hit* hits;
        ABUT_HD void end(std::size_t i) { hits[i] = named_hit<Hit>(this->mine); }
    };
    Hit* hits;
    double most;

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {{nullptr, most}, hits}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}
};

template <class X>
inline constexpr bool is_grid = false;
template <class Set, memory_space Space>
inline constexpr bool is_grid<grid<Set, Space>> = true;
template <class Object>
inline constexpr bool is_grid<posed_object<Object>> = is_grid<Object>;
template <class Object>
inline constexpr bool is_grid<moved_object<Object>> = is_grid<Object>;

template <class S>
inline constexpr bool is_line = std::same_as<S, ray<scalar_type_of<S>>> || std::same_as<S, segment<scalar_type_of<S>>>;

/// Whether `raycast` takes both arguments.
template <class Policy, class X, class Lines>
consteval bool can_be_met() {
    if constexpr (!can_be_asked_by_rows<Policy, X>() || !can_be_asked<Policy, Lines>()) {
        return false;
    } else {
        using shape_type = typename shape_of_argument<X>::type;
        using line_type = typename shape_of_argument<Lines>::type;
        constexpr bool are = has_hit_time<shape_type, line_type>;
        static_assert(are,
                      "abut: raycast looks for triangles, spheres, boxes, capsules, cylinders, cones or hulls, "
                      "oriented boxes, or shapes that have hit_time(line, shape), as docs/extending.md says");
        constexpr bool has_walk = !is_grid<X>;
        static_assert(has_walk, "abut: raycast takes a tree, a set or one shape, and no grid");
        constexpr bool look = is_line<line_type>;
        static_assert(look, "abut: raycast takes rays or segments: a set of them, a view, or one");
        if constexpr (are && has_walk && look) return have_one_scalar<X, Lines>();
        return false;
    }
}

/// Both operands of a query of rays, which hits are wanted, and what a walk needs of them.
template <class Operand, class Looking, class Wanted = all_hits_wanted>
struct lines_and_shapes {
    using T = typename std::remove_cvref_t<decltype(std::declval<const Operand&>().shapes())>::scalar_type;
    static constexpr bool filters = !takes_copies_alike<Wanted>;
    Operand x;
    Looking looking;
    Wanted wanted = {};

    [[nodiscard]] std::size_t size() const { return looking.shapes().size(); }
    [[nodiscard]] bool has_nothing() const { return size() == 0 || x.shapes().size() == 0; }
    /// A functor Walk<A, ...>: of the walk, the frame, the shapes, the lines and the hits, and what else it is made of. Its
    /// parameters are plain classes: clang 19 takes no template of constrained ones for a template of parameters constrained
    /// alike.
    template <template <class, class, class, class, class, class> class Walk, arithmetic A, class... Rest>
    [[nodiscard]] auto walk(const Rest&... rest) const {
        const length_unit<T> unit{};
        return Walk<A, decltype(ordered_walk_of(x)), decltype(frame_of(x, unit)), decltype(x.shapes()),
                    decltype(looking.shapes()), Wanted>{
            ordered_walk_of(x), frame_of(x, unit), x.shapes(), looking.shapes(), wanted, rest...};
    }
};
template <class Operand, class Looking>
lines_and_shapes(const Operand&, const Looking&) -> lines_and_shapes<Operand, Looking>;
template <class Operand, class Looking, class Wanted>
lines_and_shapes(const Operand&, const Looking&, const Wanted&) -> lines_and_shapes<Operand, Looking, Wanted>;
/// The same, with the hits that options want.
template <class Operand, class Looking, class Options>
auto lines_that_want(const Operand& x, const Looking& looking, const Options& options) {
    constexpr bool are_bodies = std::same_as<operand_id<Operand>, body_and_id>;
    return lines_and_shapes{x, looking, hits_wanted<are_bodies>(options, looking)};
}

/// Of arguments.
template <class Policy, class X, class Lines>
auto bring_lines_and_shapes(const Policy& on, const X& index, const Lines& rays, const char* function) {
    auto x = make_operand(on, index, function);
    return lines_and_shapes{std::move(x), make_operand(on, rays, function)};
}

/// Offers `best` what each line meets first.
template <arithmetic A, class Policy, class Both, class Best>
void walk_to_first_hits(const Policy& on, const Both& both, bool in_scalars, Best& best) {
    from_each each{both.template walk<walk_along_lines, A>(in_scalars)};
    [[maybe_unused]] const auto watch = watch_ties<Policy, !Both::filters>(64, false, each.all.walk, both.x);
    for_each_ordered(on, both.size(), each, best);
}
/// Finds what each line meets first. finish(found) takes it: found[i] is of line i; with no shapes or no lines `found` is
/// null. in_scalars: values need only become the right scalars; they may not be the times, rounded to doubles.
template <arithmetic A, class Policy, class Both, class Finish>
auto look_for_first_hits(const Policy& on, const Both& both, bool in_scalars, const Finish& finish) {
    if (both.has_nothing()) return finish(nullptr);
    execution::best_of_each<space_of<Policy>> best(on, both.size(), both.wanted.most());
    walk_to_first_hits<A>(on, both, in_scalars, best);
    return finish(best.data());
}

/// Writes whether each line meets anything.
template <arithmetic A, class Policy, class Both>
void look_for_any_hits(const Policy& on, const Both& both, std::uint8_t* out) {
    if (both.has_nothing()) return fill(on, out, both.size(), std::uint8_t{0});
    auto until = both.wanted.until();
    for_each_ordered(on, both.size(), from_each{both.template walk<walk_to_any, A>(out)}, until);
}

/// Whether a line in the world may meet something of a part that is not later than `last`.
template <class Line, scalar T>
ABUT_HD bool may_meet(const Line& line, const part_bounds<T>& part, double last) {
    const line_of<T> l(line);
    auto reach = reach_of_line(world_frame<T>{}, l.origin, l.direction(), l.last);
    reach.shrink_to(last);
    return may_keep(part, reach);
}

/// Lines ask, by any of the questions about them.
template <class Options, class Question>
struct question_of_lines : row_question {
    static constexpr bool filters = has_filter<Options>;
    template <scalar>
    static constexpr bool takes_in_stream = true;
    Options options = {};

    template <class Policy, class X, class Lines, bool Whole>
    static consteval bool takes() {
        if constexpr (!can_be_met<Policy, X, Lines>()) {
            return false;
        } else if constexpr (has_filter<Options>) {
            return is_row_filter<Policy, decltype(Options::filter), is_bodies<X>>();
        } else {
            return true;
        }
    }
    template <class Policy, class X, class Lines>
    void check(const Policy&, const X&, const Lines&, const char*) const {
        detail::check(options, Question::function);
    }
    /// Until when a part may have something for a line that has met what it has.
    [[nodiscard]] ABUT_HD double last(double met) const {
        if constexpr (requires { options.most_t; }) {
            return least(met, options.most_t);
        } else {
            return met;
        }
    }
    template <scalar T, class Policy, class Lines>
    auto make_rows(const Policy& on, const Lines& lines, const char* function) const {
        return make_operand(on, lines, function);
    }
};

template <class Ids>
struct write_named {
    const execution::least_value* found;  ///< null for none
    Ids ids;
    execution::least_value* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = {};
        if (found == nullptr || found[i].key == no_global_id) return;
        out[i] = {found[i].value, in_whole(ids, found[i].key)};
    }
};

/// What a line meets first: its time and its id.
template <arithmetic A, class Options = no_ray_options>
struct ask_first_hit : question_of_lines<Options, ask_first_hit<A, Options>> {
    template <scalar T, class Id>
    using found = by_id<Id, ray_hit<T>, body_hit<T>, global_ray_hit<T>>;
    using answer = execution::least_value;
    static constexpr const char* function = "abut::raycast";

    template <class Policy, class X, class Lines>
    auto at_once(const Policy& on, const X& x, const Lines& lines, double) const {
        using hit = found<typename std::remove_cvref_t<decltype(x.shapes())>::scalar_type, operand_id<X>>;
        execution::buffer_of<Policy, hit> out(on, lines.shapes().size());
        in_stream(on, x, lines, out.data());
        synchronize(on);
        return result<hit, space_of<Policy>>(std::move(out));
    }
    template <class Policy, class X, class Lines, class Hit>
    void in_stream(const Policy& on, const X& x, const Lines& lines, Hit* out) const {
        const auto both = lines_that_want(x, lines, this->options);
        if (both.has_nothing()) return fill(on, out, both.size(), named_hit<Hit>({}));
        hits_of_each<Hit, space_of<Policy>> best{out, both.wanted.most()};
        walk_to_first_hits<A>(on, both, true, best);
    }
    template <scalar T>
    [[nodiscard]] ask_first_hit in_parts(double) const {
        return *this;
    }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        const auto both = lines_that_want(x, rows, options_in_part(this->options, ids));
        look_for_first_hits<A>(on, both, false, [&](const execution::least_value* met) {
            for_each_index(on, both.size(), write_named<Ids>{met, ids, out});
            synchronize(on);
        });
    }
    ABUT_HD void merge(answer* best, const answer* other) const { best->offer(other->value, other->key); }
    template <class Line, scalar T>
    ABUT_HD bool may_change(const Line& line, const answer* best, const part_bounds<T>& part) const {
        return may_meet(line, part, this->last(best->value));
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(const answer& met) const {
        return named_hit<Found>(met);
    }
};

/// Whether a line meets anything: 1 or 0.
template <arithmetic A, class Options = no_ray_options>
struct ask_any_hit : question_of_lines<Options, ask_any_hit<A, Options>> {
    template <scalar, class>
    using found = std::uint8_t;
    using answer = std::uint8_t;
    static constexpr const char* function = "abut::raycast_any";

    template <class Policy, class X, class Lines>
    auto at_once(const Policy& on, const X& x, const Lines& lines, double) const {
        execution::buffer_of<Policy, answer> out(on, lines.shapes().size());
        ask(on, x, lines, same_key{}, out.data());
        return result<answer, space_of<Policy>>(std::move(out));
    }
    template <class Policy, class X, class Lines>
    void in_stream(const Policy& on, const X& x, const Lines& lines, answer* out) const {
        look_for_any_hits<A>(on, lines_that_want(x, lines, this->options), out);
    }
    template <scalar T>
    [[nodiscard]] ask_any_hit in_parts(double) const {
        return *this;
    }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids& ids, answer* out) const {
        look_for_any_hits<A>(on, lines_that_want(x, rows, options_in_part(this->options, ids)), out);
        synchronize(on);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        if (*other != 0) *best = 1;
    }
    template <class Line, scalar T>
    ABUT_HD bool may_change(const Line& line, const answer* best, const part_bounds<T>& part) const {
        return *best == 0 && may_meet(line, part, this->last(infinity<double>));
    }
};

}  // namespace detail

/// For each of `rays` the shape of `index` that it meets first: a `result` of `ray_hit`, in the order of the rays. Of those
/// that are met at one time it has the least id; where nothing is met, `no_id` and infinity.
///
/// `index` is a tree of any layout, a set, a view or one shape, posed or not: of triangles (a mesh, a triangle_soup), or of
/// spheres, boxes, oriented boxes, capsules, cylinders, cones or hulls, which are solid. `rays` are `rays` or `segments`:
/// a set, a view, or one. Segments are met from their first end to their second, at times from 0 to 1.
/// Triangles are met from both sides, and along their planes; a solid where a ray enters it, and at 0 if the ray begins in it
/// or on its surface. A ray of direction 0 meets what its origin is in, at 0.
///
/// With `filtered` and `exact` whether a ray meets a shape is decided exactly: none slips through a closed mesh, not
/// through an edge and not through a vertex. Times are the true ones rounded to the nearest double, by which they are
/// compared, and then to the scalar type; those above its largest number are that. So shapes that are met at one place
/// are met at one time. The same bits on every policy. A segment meets a shape if and only if `intersects` says so. `fast`
/// is approximate.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one; a divided index is asked in its parts, and
/// each device holds 16 bytes a ray. Of ranks (@ref distributed) a rank's own rays look in all parts, and a row is a
/// `global_ray_hit`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 8 bytes a ray in float and 16 in double. Among many shapes
/// that are equally near a host keeps 8 bytes for each shape with their tree, and takes 4 more for a moment. Under
/// `cuda` the last stage has a stack of 1.7 KB in float and 8.7 KB in double for triangles, and of 4.3 and 23 KB for
/// spheres, boxes, capsules, cylinders and cones. CUDA sets that aside once for all threads that the device holds at a
/// time.
///
/// @par Errors
/// - `invalid_geometry`: a view, a single shape or a ray has a number that is not finite, or a pose is no rotation.
/// - `error`: a set or an index lies on another device.
/// - `capacity_error`: a view has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp raycast
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays>
[[nodiscard]] auto raycast(const On& on, const X& index, const Rays& rays) {
    return ask_rows(on, detail::ask_first_hit<A>{}, index, rays);
}
/// The same of hits that options keep.
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays, class Filter = keep_all>
[[nodiscard]] auto raycast(const On& on, const X& index, const Rays& rays, const raycast_options<Filter>& options) {
    return ask_rows(on, detail::ask_first_hit<A, raycast_options<Filter>>{{{}, options}}, index, rays);
}

/// For each of `rays` whether it meets any shape of `index`: a `result` of `std::uint8_t`, in the order of the rays, 1 or
/// 0. It is 1 where `raycast` of the same arguments finds a hit, and takes less time: a ray ends at the first shape that
/// is found, which need not be the first one that it meets. Segments from a point to a light tell what lies in shadow.
///
/// Arguments, and what is decided exactly, are those of `raycast`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 1 byte a ray.
///
/// @par Errors
/// Those of `raycast`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp raycast_any
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays>
[[nodiscard]] auto raycast_any(const On& on, const X& index, const Rays& rays) {
    return ask_rows(on, detail::ask_any_hit<A>{}, index, rays);
}
/// The same of hits that options keep.
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays, class Filter = keep_all>
[[nodiscard]] auto raycast_any(const On& on, const X& index, const Rays& rays, const raycast_options<Filter>& options) {
    return ask_rows(on, detail::ask_any_hit<A, raycast_options<Filter>>{{{}, options}}, index, rays);
}

}  // namespace abut
