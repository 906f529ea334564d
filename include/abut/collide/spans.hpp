// SPDX-License-Identifier: MIT
#pragma once

// spans: the stretches of rays that are inside of a closed mesh. A ray is asked for all faces that it meets, where the policy
// works; what that means for the inside is found on the host. For how far away one face is, ask raycast.
//
// Of a ray that passes through the inner of each face, at times that round to different numbers, how often the surface goes round
// a stretch between hits says the ways in which it passes the faces from there on. Of any other one times are compared as ratios of integers. Between two of them that follow each other the ray
// is in the surface all along, if a face in one plane with it covers the stretch, or meets it nowhere. Then what is true of a
// point there is true of all points near it, and so of one that is moved by (e, e^2, e^3) for all small e > 0. The ray from that
// one passes through the inner of faces alone, and of how many faces decides, by which side of the ray each edge is on: signs
// of determinants, and where these are 0 of the coordinates of edge x direction, which are not all 0 unless the face is in one
// plane with the ray. What it passes through does the ray touch, so that all of them are among the hits.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/arithmetic/big_int.hpp>
#include <abut/arithmetic/whole_numbers.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/predicate/certified_faces.hpp>

namespace abut {

/// A stretch of a ray that is inside of a solid.
/// @ingroup queries
template <scalar T>
struct ray_span {
    /// Where a ray begins or ends inside.
    static constexpr std::uint32_t no_face = static_cast<std::uint32_t>(-1);

    std::uint32_t ray;    ///< its number
    std::uint32_t enter;  ///< the least face that it meets where the stretch begins; no_face where the ray begins inside
    std::uint32_t leave;  ///< the least face that it meets where the stretch ends
    T from;               ///< where it begins, a `t` as in ray_hit; 0 where the ray begins inside
    T to;                 ///< where it ends

    friend constexpr bool operator==(const ray_span&, const ray_span&) = default;
};

/// A `ray_span` with numbers in sets of many parts.
/// @ingroup distributed
template <scalar T>
struct global_ray_span {
    /// Where a ray begins or ends inside.
    static constexpr std::uint64_t no_face = static_cast<std::uint64_t>(-1);

    std::uint64_t ray;    ///< its number among the rays of all ranks
    std::uint64_t enter;  ///< as of ray_span
    std::uint64_t leave;  ///< as of ray_span
    T from;               ///< as of ray_span
    T to;                 ///< as of ray_span

    friend constexpr bool operator==(const global_ray_span&, const global_ray_span&) = default;
};

namespace detail {

/// A face that a ray meets.
template <scalar T>
struct met_face {
    triangle<T> corners;
    double time;
    std::uint64_t id;
    std::uint32_t line;
    [[nodiscard]] T t() const { return time_as<T>(time); }
};
/// With the numbers of lines and ids of all.
template <class Shapes, class Name>
struct name_met_face {
    Shapes shapes;
    Name name;
    ABUT_HD auto operator()(std::size_t line, const execution::least_value& hit) const {
        const timed_hit found = name(line, hit);
        return met_face<typename Shapes::scalar_type>{shapes[static_cast<std::size_t>(hit.key)], found.time, found.id, found.line};
    }
};

/// 1 if a ray certainly passes through the inner of a face the way that the face looks, -1 against it; 0 if neither is certain.
template <scalar T>
int surely_passes(const ray<T>& r, const triangle<T>& t) {
    const vec3<double> a = edge_between<true>(r.origin, t.a), b = edge_between<true>(r.origin, t.b),
                       c = edge_between<true>(r.origin, t.c), d = widened(r.direction);
    const double to_a = magnitudes(a), to_b = magnitudes(b), to_c = magnitudes(c), length = magnitudes(d);
    const double reach = to_a + to_b + to_c + length;
    if (!(reach < difference_limit<double>)) return 0;
    const double ab = dot(cross(a, b), d), bc = dot(cross(b, c), d), ca = dot(cross(c, a), d);
    const double error = determinant_error<double> * greatest(to_a * to_b, to_b * to_c, to_c * to_a) * length + flushed_in_three<T>(reach);
    return least(ab, bc, ca) > error ? 1 : greatest(ab, bc, ca) < -error ? -1 : 0;
}

/// Stretches of one ray, which are told where it begins or ends to be inside.
template <class Span>
class span_writer {
public:
    span_writer(decltype(Span::ray) ray, std::vector<Span>& out) : ray_(ray), out_(out) {}
    template <class Id, scalar T>
    void put(bool is_inside, Id face, T t) {
        if (is_inside == was_inside_) return;
        was_inside_ = is_inside;
        const auto id = static_cast<decltype(Span::enter)>(face);
        if (is_inside) {
            out_.push_back({ray_, id, Span::no_face, t, t});
        } else {
            out_.back().leave = id;
            out_.back().to = t;
        }
    }

private:
    decltype(Span::ray) ray_;
    std::vector<Span>& out_;
    bool was_inside_ = false;
};

/// The stretches of one ray, from all that it meets, in exact numbers.
template <class Span>
class exact_spans {
    using T = decltype(Span::from);
    using number = big_int;
    using way = vec3<big_int>;
    struct time {
        number over, under;  ///< over / under, under > 0

        time(number n, number d) : over(d.sign() < 0 ? -n : n), under(d.sign() < 0 ? -d : d) {}
        friend bool operator<(const time& s, const time& t) { return (s.over * t.under - t.over * s.under).sign() < 0; }
    };
    struct event {
        time at;
        std::size_t hit;
        bool is_end;
    };

public:
    exact_spans(const ray<T>& r, const met_face<T>* hits, std::size_t n) : hits_(hits), n_(n), begin_(n), end_(n), passes_(n, 0) {
        whole_numbers<T> of_places, of_direction;
        of_direction.look_at(r.direction);
        of_places.look_at(r.origin);
        for (std::size_t k = 0; k < n; ++k) {
            const triangle<T>& t = hits[k].corners;
            of_places.look_at(t.a), of_places.look_at(t.b), of_places.look_at(t.c);
        }
        along_ = of_direction(r.direction);
        const way from = of_places(r.origin);
        std::vector<event> events;
        events.push_back({time(number(), number(1)), n, false});
        for (std::size_t k = 0; k < n; ++k) {
            const triangle<T>& t = hits[k].corners;
            const way to[3] = {of_places(t.a) - from, of_places(t.b) - from, of_places(t.c) - from};
            look_at(k, to, events);
        }
        std::sort(events.begin(), events.end(), [](const event& x, const event& y) { return x.at < y.at; });
        std::size_t rank = 0;
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (i > 0 && events[i - 1].at < events[i].at) ++rank;
            if (events[i].hit < n) (events[i].is_end ? end_ : begin_)[events[i].hit] = rank;
        }
        ranks_ = rank + 1;
    }
    void append(inside_rule rule, span_writer<Span> to) const {
        std::vector<std::int32_t> turns(ranks_ + 1, 0);  // of faces passed from rank i on: how often the surface goes round what is before
        std::vector<int> covered(ranks_ + 1, 0);         // stretches in the surface that begin at rank i, less those that end
        std::vector<std::size_t> first(ranks_, n_);      // the hit of the least face at a rank
        for (std::size_t k = 0; k < n_; ++k) {
            turns[begin_[k]] += passes_[k];
            ++covered[begin_[k]];
            --covered[end_[k]];
            std::size_t& least = first[begin_[k]];
            if (least == n_ || hits_[k].id < hits_[least].id) least = k;
        }
        for (std::size_t i = ranks_; i-- > 0;) turns[i] += turns[i + 1];
        int in_surface = 0;
        for (std::size_t i = 0; i < ranks_; ++i) {
            in_surface += covered[i];
            const bool is_inside = in_surface == 0 && is_in_by(rule, turns[i + 1]);
            if (const std::size_t k = first[i]; k < n_) {
                to.put(is_inside, hits_[k].id, hits_[k].t());
            } else {
                to.put(is_inside, Span::no_face, T{0});
            }
        }
    }

private:
    void look_at(std::size_t k, const way (&to)[3], std::vector<event>& events) {
        number side[3], speed;
        for (std::size_t i = 0; i < 3; ++i) {
            side[i] = dot(along_, cross(to[i], to[(i + 1) % 3]));
            speed = speed + side[i];
        }
        if (speed.sign() != 0) {
            const time at(dot(to[2], cross(to[0], to[1])), speed);
            events.push_back({at, k, false});
            events.push_back({at, k, true});
            int sides = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const way turn = cross(to[i] - to[(i + 1) % 3], along_);
                const int signs[4] = {side[i].sign(), turn.x.sign(), turn.y.sign(), turn.z.sign()};
                const int* sign = signs;
                while (*sign == 0) ++sign;
                sides += *sign;
            }
            passes_[k] = static_cast<signed char>(sides / 3);  // all alike, or it does not pass
            return;
        }
        // In one plane with the ray: from where to where it is in the face.
        std::vector<time> ends;
        for (std::size_t i = 0; i < 3; ++i) {
            const way &p = to[i], &q = to[(i + 1) % 3], edge = q - p, turn = cross(along_, edge), beside = cross(p, along_);
            const number* const of_turn[3] = {&turn.x, &turn.y, &turn.z};
            int axis = 0;
            while (axis < 3 && of_turn[axis]->sign() == 0) ++axis;
            const auto of = [&axis](const way& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
            if (axis == 3) {  // the side is along the ray, or a point
                if (beside.x.sign() != 0 || beside.y.sign() != 0 || beside.z.sign() != 0) continue;
                axis = along_.x.sign() != 0 ? 0 : along_.y.sign() != 0 ? 1 : 2;
                for (const way* const v : {&p, &q}) ends.emplace_back(of(*v), of(along_));
                continue;
            }
            const int sense = of(turn).sign();
            if (of(beside).sign() * sense < 0 || of(cross(q, along_)).sign() * sense > 0) continue;
            ends.emplace_back(of(cross(p, edge)), of(turn));
        }
        const time start(number(), number(1));
        const auto clipped = [&](const time& t) { return t < start ? start : t; };
        events.push_back({clipped(*std::min_element(ends.begin(), ends.end())), k, false});
        events.push_back({clipped(*std::max_element(ends.begin(), ends.end())), k, true});
    }
    const met_face<T>* hits_;
    std::size_t n_, ranks_ = 0;
    way along_;
    std::vector<std::size_t> begin_, end_;  ///< of each hit, among the different times
    std::vector<signed char> passes_;           ///< as of surely_passes
};

/// The stretches of one ray, from the n > 0 faces that it meets, in their order. `passes` is scratch.
template <class Span, scalar T>
void append_spans(const ray<T>& r, decltype(Span::ray) number, const met_face<T>* hits, std::size_t n, inside_rule rule,
                  std::vector<signed char>& passes, std::vector<Span>& out) {
    if (is_zero(r.direction.x) && is_zero(r.direction.y) && is_zero(r.direction.z)) return;
    span_writer<Span> to(number, out);
    passes.assign(n, 0);
    std::int32_t turns = 0;
    bool is_plain = hits[0].t() > 0;
    for (std::size_t k = 0; k < n && is_plain; ++k) {
        passes[k] = static_cast<signed char>(surely_passes(r, hits[k].corners));
        turns += passes[k];
        is_plain = passes[k] != 0 && (k == 0 || hits[k - 1].t() < hits[k].t());
    }
    if (!is_plain) return exact_spans<Span>(r, hits, n).append(rule, to);
    to.put(is_in_by(rule, turns), Span::no_face, T{0});
    for (std::size_t k = 0; k < n; ++k) {
        turns -= passes[k];
        to.put(is_in_by(rule, turns), hits[k].id, hits[k].t());
    }
}

template <arithmetic A>
struct ask_spans : question_of_lines<no_ray_options, ask_spans<A>> {
    template <scalar T, class Id>
    using found = by_id<Id, ray_span<T>, ray_span<T>, global_ray_span<T>>;
    template <scalar T>
    using item = met_face<T>;
    static constexpr const char* function = "abut::spans";
    inside_options surface;

    template <class Policy, class X, class Lines, bool Whole>
    static consteval bool takes() {
        constexpr bool has = has_faces<X> || (!Whole && std::same_as<typename shape_of_argument<X>::type, triangle<scalar_of_argument<X>>>);
        static_assert(has, "abut::spans: expected a closed mesh: a mesh, a mesh_view, or a tree of one, posed or not; in parts triangles");
        if constexpr (has) {
            constexpr bool are = std::same_as<typename shape_of_argument<Lines>::type, ray<scalar_of_argument<X>>>;
            static_assert(are, "abut::spans: expected rays, of the scalar type of the mesh");
            return are && can_be_met<Policy, X, Lines>();
        } else {
            return false;
        }
    }
    template <class Policy, class X, class Lines>
    void check(const Policy& on, const X& x, const Lines& lines, const char* holder) const {
        // Hits in parts come together, so that any rule will do there.
        const inside_rule rule = holder == nullptr ? surface.rule : inside_rule::parity;
        const ask_inside<A> look{{}, function, {.known_closed = surface.known_closed, .rule = rule, .check = surface.check}};
        look.check(on, x, lines, holder);
    }
    template <class Policy, class X, class Lines>
    auto at_once(const Policy& on, const X& x, const Lines& lines, double) const {
        using T = typename std::remove_cvref_t<decltype(lines.shapes())>::scalar_type;
        const result<met_face<T>, space_of<Policy>> met(ask(on, x, lines, name_timed_hit{same_number{}, same_key{}}));
        return this->template finish<ray_span<T>>(on, lines, met, 0);
    }
    template <class Policy, class X, class Lines, class Name>
    auto ask(const Policy& on, const X& x, const Lines& lines, const Name& name) const {
        const auto shapes = x.shapes();
        using view = std::remove_const_t<decltype(shapes)>;
        return look_for_all_hits<A, met_face<typename view::scalar_type>>(on, lines_that_want(x, lines, no_ray_options{}),
                                                                          name_met_face<view, Name>{shapes, name});
    }
    template <class Found, class Policy, class Lines, class Met>
    std::vector<Found> finish(const Policy& on, const Lines& lines, const Met& all_met, decltype(Found::ray) first_ray) const {
        std::vector<Found> all_spans;
        std::vector<signed char> passes;
        const std::size_t n = all_met.size();
        if (n == 0) return all_spans;
        const auto asked = lines.shapes();
        using line = typename std::remove_const_t<decltype(asked)>::shape_type;
        const auto met = to_host(all_met);
        const auto all = downloaded<Policy, line>(on, side_by_side<line>(on, asked, asked.size()));
        for (std::size_t first = 0, last = 0; first < n; first = last) {
            const std::uint32_t number = met[first].line;
            while (last < n && met[last].line == number) ++last;
            append_spans<Found>(all[number], first_ray + number, met.data() + first, last - first, surface.rule, passes, all_spans);
        }
        return all_spans;
    }
};

}  // namespace detail

/// The stretches of each of `rays` that are inside of a closed mesh: a std::vector of `ray_span` in host memory, sorted by the
/// ray's number, then along the ray. A ray that has no point inside has none.
///
/// Inside is what `inside` says by the same `rule`, so that by `nonzero` bodies of one mesh that overlap are one. A stretch goes on
/// where the ray touches the surface in single points and is inside before and after, as where it passes a face within the solid; it
/// ends where the ray leaves, and where it goes on in the surface, in a face or along an edge.
/// So a ray through a vertex where 64 faces meet has one stretch in a sphere; one that touches a solid in a vertex, an edge or
/// a face from outside has none; and one that lies in the common wall of two rooms has none there.
///
/// Number and order are exact, for every finite input, with `filtered` as with `exact`, and all is the same on every policy.
/// Places are the times that `raycast` tells, so that two that differ by less than rounding are equal numbers. `mesh` and
/// `options` are as of `inside`; `rays` as of `raycast`, but no segments. A ray without a direction has no stretch. Segments and lists
/// of bodies are not taken.
///
/// Of several devices (@ref devices) the mesh is on each, or divided; each device finds the hits of its share of the rays, or those
/// in its part. Of ranks (@ref distributed) a row is a `global_ray_span` of the rank's own rays, and the lists of all ranks, one
/// after another, are the list of one machine; hits go where their rays are, as those of `raycast_all`, 56 or 96 bytes each. Of a
/// mesh in parts nobody can see whether it is closed: say `{.known_closed = true}`. Any `rule` will do there too.
///
/// @par Memory
/// As in @ref queries. The result takes 20 bytes a stretch in float and 32 in double. Scratch is that of `raycast_all`, 56 bytes a
/// hit in float and 96 in double beside it, in the policy's memory and in the host's, and that of `inside`.
///
/// @par Errors
/// Those of `inside` and of `raycast`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream. Stretches are found by one thread of
/// the host: some nanoseconds a hit, and some microseconds for each of a ray that meets edges or vertices.
///
///     for (const auto& s : abut::spans(on, tree, rays)) thickness[s.ray] += s.to - s.from;
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Rays>
    requires(!std::same_as<A, fast>)
[[nodiscard]] auto spans(const On& on, const X& mesh, const Rays& rays, const inside_options& options = {}) {
    return ask_row_lists(on, detail::ask_spans<A>{{}, options}, mesh, rays);
}

}  // namespace abut
