// SPDX-License-Identifier: MIT
#pragma once

// first_impact, first_self_impact: the earliest of the impacts. A time up to which it is looked for prunes the walk: boxes
// are made around that part of the step alone. The walk finds all pairs that touch in it, and others whose boxes are near
// already. So what is found is the first, or tells how far to look; where nothing is found, the part grows. Where boxes are
// hardly smaller in a part, since most shapes move by little of their size, a walk of it takes what one of the whole step
// takes, and the whole step is looked at.
//
// Of the pairs that a walk finds, few are timed: each has a time before which it is known not to touch, which is cheap, and
// they are taken in the order of these until what is found is earlier than all that are left.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/index/refit.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/box_measure.hpp>
#include <abut/shape/features.hpp>

namespace abut {

namespace detail {

/// Where a coordinate is, from the start of a step on until `time`.
template <scalar T>
struct coordinate_until {
    T lower, upper;

    ABUT_HD coordinate_until(T at_t0, T at_t1, double time) : lower(least(at_t0, at_t1)), upper(greatest(at_t0, at_t1)) {
        const double a = static_cast<double>(at_t0), b = static_cast<double>(at_t1), then = a + time * (b - a);
        const double error = 0x1p-50 * (absolute(a) + absolute(b)) + 0x1p-1000;
        const double below = then - error, above = then + error;
        // Written so that what is no number, where b - a is too large, leaves all of the step.
        if (a <= b && above < b) upper = no_less(above);
        if (a >= b && below > b) lower = -no_less(-below);
    }

private:
    /// A scalar that is not less than a number between two scalars.
    ABUT_HD static T no_less(double x) {
        const T rounded = static_cast<T>(x);
        return static_cast<double>(rounded) < x ? next_up(rounded) : rounded;
    }
};

/// Where a vertex is until a time; all of the step until 1.
template <scalar T>
ABUT_HD aabb<T> box_until(const vec3<T>& p, const vec3<T>& q, double time) {
    const coordinate_until<T> x(p.x, q.x, time), y(p.y, q.y, time), z(p.z, q.z, time);
    return {{x.lower, y.lower, z.lower}, {x.upper, y.upper, z.upper}};
}

/// The boxes of vertices until a time.
template <scalar T>
struct write_vertex_until {
    strided<vec3<T>> t0, t1;
    double time;
    aabb<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = box_until(t0[i], t1[i], time); }
};
/// And of faces or edges, around those of their vertices.
template <scalar T, class Element>
struct write_element_until {
    strided<Element> elements;
    const aabb<T>* vertices;
    aabb<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t* const corner = corners_at(elements, i);
        aabb<T> box = merge(vertices[corner[0]], vertices[corner[1]]);
        if constexpr (std::tuple_size_v<Element> == 3) box = merge(box, vertices[corner[2]]);
        out[i] = box;
    }
};

/// The trees of an index with boxes around a part of the step, from its start on until a time.
template <class Policy, scalar T>
class trees_until {
    using space = space_of<Policy>;
    using boxes = box_view<T, space>;

public:
    trees_until(const Policy& policy, const moving_set<mesh<T, space>>& step, double time)
        : on_(policy), count_(step.t0().view().vertices.count), vertices_(policy, count_) {
        const auto t0 = step.t0().view().vertices, t1 = step.t1().view().vertices;
        for_each_index(on_, count_, write_vertex_until<T>{t0, t1, time, vertices_.data()});
    }
    template <class Set>
    [[nodiscard]] bvh<Set, space> of_vertices(const bvh<Set, space>& tree) const {
        return {tree.set(), refit_storage(on_, tree.stored(), boxes{vertices_.data(), count_})};
    }
    template <class Set, class Element>
    [[nodiscard]] bvh<Set, space> of_elements(const bvh<Set, space>& tree, const strided<Element>& elements) const {
        execution::buffer_of<Policy, aabb<T>> made(on_, elements.count);
        for_each_index(on_, elements.count, write_element_until<T, Element>{elements, vertices_.data(), made.data()});
        return {tree.set(), refit_storage(on_, tree.stored(), boxes{made.data(), elements.count})};
    }

private:
    const Policy& on_;
    std::size_t count_;
    execution::buffer_of<Policy, aabb<T>> vertices_;
};

template <class Policy, scalar T, memory_space Space>
impact_index<T, Space> until(const Policy& on, const impact_index<T, Space>& index, double time) {
    const trees_until<Policy, T> trees(on, index.mesh(), time);
    return {trees.of_elements(index.faces(), index.mesh().t0().view().faces),
            trees.of_elements(index.edges(), index.edges().set().t0().view().edges), trees.of_vertices(index.vertices())};
}

/// The earliest impact, and of equal ones the first.
struct time_and_place {
    double time;
    std::size_t place;
};
struct earlier_of {
    ABUT_HD time_and_place operator()(const time_and_place& a, const time_and_place& b) const {
        return b.time < a.time || (b.time == a.time && b.place < a.place) ? b : a;
    }
};
template <scalar T>
struct time_of_impact_at {
    const impact<T>* all;
    ABUT_HD time_and_place operator()(std::size_t i) const { return {all[i].time, i}; }
};
/// An impact and the key of its pair, of such keys.
template <scalar T>
struct keyed_impact {
    impact<T> found;
    std::uint64_t key;
    feature_key keys;
};
/// Keeps the earlier of two, and of equal ones that with the smaller key.
template <scalar T>
void keep_earlier(std::optional<keyed_impact<T>>& first, const std::optional<keyed_impact<T>>& one) {
    if (!one) return;
    const double a = first ? first->found.time : infinity<double>, b = one->found.time;
    if (b < a || (b == a && one->key < first->key)) first = one;
}
/// The first of some.
template <class Policy, scalar T, memory_space Space>
std::optional<keyed_impact<T>> first_of(const Policy& on, const keyed_impacts<T, Space>& all) {
    const std::size_t n = all.found.size();
    const time_and_place first =
        reduce(on, n, time_and_place{infinity<double>, n}, earlier_of{}, time_of_impact_at<T>{all.found.data()});
    if (first.place == n) return std::nullopt;
    keyed_impact<T> found{{}, 0, all.key};
    download(on, all.found.data() + first.place, 1, &found.found);
    download(on, all.keys.data() + first.place, 1, &found.key);
    return found;
}

/// The judge of what may be first: a time before which two features do not touch, or come near, a multiple of 2^-6 that is
/// not above what time_in_motion says. Halving stops sooner here, and goes the same way up to there. Parts of 2^-20 took
/// twice the time on a core, longer than to time all pairs.
struct no_sooner_in_motion {
    static constexpr int bits = 6;
    static constexpr double coarse = 0x1p-6;
    conservative_bounds bounds;

    template <motion_arithmetic A>
    static no_sooner_in_motion of(const conservative_bounds& asked) {
        return {{std::same_as<A, filtered> ? coarse : std::max(coarse, asked.tolerance), asked.separation}};
    }
    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        return time_in_motion<conservative>{bounds}.decide(s, t);
    }
    template <class S, class U>
    ABUT_HD double time(const S& s, const U& t) const {
        const auto points = points_of(s, t);
        const motion_filter<is_moving_edge<S>> filter(points);
        if (bounds.separation == 0 && come_together(points)) return filter.start_apart() ? 1 : 0;
        return filter.conservative_time(bounds.separation, bounds.tolerance);
    }
    template <class S, class U>
    double time_on_host(const S& s, const U& t) const {
        return time(s, t);
    }
};
/// Such times as numbers to sort by.
struct rank_of_time {
    const double* times;
    std::uint64_t* ranks;
    ABUT_HD void operator()(std::size_t i) const {
        ranks[i] = static_cast<std::uint64_t>(times[i] / no_sooner_in_motion::coarse);
    }
};
template <motion_arithmetic A, class View>
struct time_keys {
    View both;
    time_in_motion<A> judge;
    const std::uint64_t* keys;
    double* times;
    ABUT_HD void operator()(std::size_t i) const { times[i] = both.with_shapes(keys[i], time_by<time_in_motion<A>>{judge}); }
};
template <motion_arithmetic A, class View>
struct time_keys_on_host {
    View both;
    time_in_motion<A> judge;
    const std::uint64_t* keys;
    double* times;
    void operator()(std::size_t i) const { times[i] = both.with_shapes(keys[i], time_on_host_by<time_in_motion<A>>{judge}); }
};

/// The first of what a search finds, in `filtered` or `conservative`.
template <motion_arithmetic A, class Policy, class View, class Search>
auto first_by_bounds(const Policy& on, const conservative_bounds& bounds, const View& both, const Search& search) {
    using numbers = execution::buffer_of<Policy, std::uint64_t>;
    const time_in_motion<A> judge{bounds};
    timed_pairs<Policy> bounded(on, no_sooner_in_motion::of<A>(bounds), search);
    const std::size_t n = bounded.keys.size();
    numbers ranks(on, n);
    for_each_index(on, n, rank_of_time{bounded.times.data(), ranks.data()});
    sort_by_key(on, ranks, bounded.keys, no_sooner_in_motion::bits + 1);
    std::optional<keyed_impact<typename View::scalar_type>> first;
    std::size_t some = 64;
    for (std::size_t begin = 0; begin < n; begin += some, some = std::min(4 * some, n)) {
        some = std::min(some, n - begin);
        if (first) {
            std::uint64_t rank = 0;
            download(on, ranks.data() + begin, 1, &rank);
            if (static_cast<double>(rank) * no_sooner_in_motion::coarse > first->found.time + last_time_bit) break;
        }
        timed_pairs<Policy> pairs(on, some);
        copy(on, bounded.keys.data() + begin, some, pairs.keys.data());
        sort_keys(on, pairs.keys, both.key.bits());
        if constexpr (host_policy<Policy>) {
            for_each_task(on, some, time_keys_on_host<A, View>{both, judge, pairs.keys.data(), pairs.times.data()});
        } else {
            for_each_index(on, some, time_keys<A, View>{both, judge, pairs.keys.data(), pairs.times.data()});
        }
        keep_earlier(first, first_of(on, impacts_at<A>(on, bounds, both, std::move(pairs), true)));
    }
    return first;
}

/// How much of the step is looked at first, and how much more where nothing touches in it. Where nothing touches at all, the
/// step is looked at twice, or once if the first part is left out.
inline constexpr double first_part_of_step = 0x1p-4, growth_of_part = 16;

/// Half the surfaces of boxes, around the whole step and around its first part.
struct surfaces_of_step {
    double whole = 0, part = 0;
};
struct add_surfaces_of_step {
    ABUT_HD surfaces_of_step operator()(const surfaces_of_step& a, const surfaces_of_step& b) const {
        return {a.whole + b.whole, a.part + b.part};
    }
};
/// Those of every so manyth face, or vertex where there is no face.
template <scalar T>
struct surfaces_in_motion {
    strided<face> faces;
    strided<vec3<T>> t0, t1;
    std::size_t step;

    ABUT_HD surfaces_of_step operator()(std::size_t i) const {
        return {surface(i * step, 1), surface(i * step, first_part_of_step)};
    }

private:
    ABUT_HD double surface(std::size_t i, double time) const {
        const auto box_of = [&](std::size_t vertex) { return box_until(t0[vertex], t1[vertex], time); };
        if (faces.count == 0) return half_surface(half_sides<double>(box_of(i)));
        const std::uint32_t* const corner = corners_at(faces, i);
        return half_surface(half_sides<double>(merge(merge(box_of(corner[0]), box_of(corner[1])), box_of(corner[2]))));
    }
};
/// Whether the boxes of both, or of x alone `Within` one, are so much smaller in the first part of the step that few are
/// near others there, by a sample of them. The answer moves speed alone.
template <bool Within, class Policy, class Index>
bool is_first_part_small(const Policy& on, const Index& x, const Index& y) {
    constexpr std::size_t sample = 4096;
    // On a core, steps of 1.0 and 1.7 took half the time without their part, and one of 2.8 thrice.
    constexpr double much = 2;
    double whole = 0, part = 0;
    const auto add = [&](const Index& index) {
        const auto t0 = index.mesh().t0().view();
        const std::size_t n = t0.faces.count > 0 ? t0.faces.count : t0.vertices.count, step = n / sample + 1;
        const auto t1 = index.mesh().t1().view().vertices;
        const surfaces_in_motion<typename Index::scalar_type> all{t0.faces, t0.vertices, t1, step};
        const auto sum = reduce(on, n / step, surfaces_of_step{}, add_surfaces_of_step{}, all);
        whole += static_cast<double>(step) * sum.whole;
        part += static_cast<double>(step) * sum.part;
    };
    add(x);
    if constexpr (!Within) add(y);
    return !(whole < much * part);
}

/// The first impact; first_until(time) tells the first of those in a part of the step, which has all that begin in it.
/// `fast` may tell times at which boxes do not meet yet: it looks at the whole step.
template <motion_arithmetic A, class FirstUntil>
auto first_of_step(const FirstUntil& first_until, const conservative_bounds& bounds,
                   double first_part = first_part_of_step) {
    // A time is the true one rounded down, or early by the tolerance. None that is as early by it is missing.
    const double early = last_time_bit + (std::same_as<A, conservative> ? bounds.tolerance : 0);
    for (double time = std::same_as<A, fast> ? 1 : first_part;;) {
        const auto first = first_until(time);
        const double enough = first ? first->found.time + early : growth_of_part * time;
        if (time >= 1 || (first && enough <= time)) return first;
        time = std::min(enough, 1.0);
    }
}
/// The first impact of two indices, or `Within` one, until a time; or the first in a part of the search.
template <motion_arithmetic A, bool Within, class Policy, class Index, class Fronts, class Part = whole_search>
auto first_until(const Policy& on, const Index& x, const Index& y, double time, impact_options options, const Fronts& fronts,
                 const char* function, const Part& part = {}) {
    options.sorted = true;
    const auto during = [&](const Index& all) { return time >= 1 ? all : until(on, all, time); };
    const Index a = during(x);
    const auto first = [&](const Index& b) {
        return with_search_of_indices<A, Within>(
            on, a, b, options, fronts, function, part, [&](const auto& both, const auto& search) {
                if constexpr (std::same_as<A, filtered> || std::same_as<A, conservative>) {
                    return first_by_bounds<A>(on, options.bounds, both, search);
                } else {
                    return first_of(on, impacts_of<A>(on, options, both, search));
                }
            });
    };
    return Within ? first(a) : first(during(y));
}
template <motion_arithmetic A, bool Within, class Policy, class Index, class Fronts, class Part = whole_search>
auto first_of_indices(const Policy& on, const Index& x, const Index& y, const impact_options& options, const Fronts& fronts,
                      const char* function, const Part& part = {}) {
    double first_part = 1;
    if constexpr (!std::same_as<A, fast>) {
        if (is_first_part_small<Within>(on, x, y)) first_part = first_part_of_step;
    }
    const auto until = [&](double time) { return first_until<A, Within>(on, x, y, time, options, fronts, function, part); };
    return first_of_step<A>(until, options.bounds, first_part);
}

/// The first of what an executor found, as a caller gets it.
template <class Found>
auto without_key(const std::optional<Found>& first) {
    using impact_type = decltype(Found::found);
    return first ? std::optional<impact_type>(first->found) : std::optional<impact_type>();
}

/// As ask_impacts.
template <motion_arithmetic A, bool Within>
struct ask_first_impact {
    const char* function = Within ? "abut::first_self_impact" : "abut::first_impact";
};
template <execution_policy Policy, motion_arithmetic A, bool Within, class X, class Y, class Fronts = no_fronts>
auto ask_motion(const Policy& on, const ask_first_impact<A, Within>& question, const X& a, const Y& b,
                const impact_options& options, const Fronts& fronts = {}) {
    if constexpr (can_collide<Within, Policy, X, Y>()) {
        const auto [x, y] = impact_operands<Within>(on, a, b, question.function);
        return without_key(first_of_indices<A, Within>(on, x, y, options, fronts, question.function));
    } else {
        return std::optional<impact<float>>();
    }
}

}  // namespace detail

/// @addtogroup motion
///@{

/// The earliest of the impacts of two meshes as a std::optional<impact<T>>, which is empty if there are none: of several at
/// one time, the first in the order of `impacts`. What is found so far prunes the search: it looks at a first part of the
/// step, and at more where nothing touches in it; or at the whole step at once, where most shapes move by little of their
/// size. For parts the trees are refitted; so under cuda the stream of an index's first such query has to outlive the index
/// (see `refit`). `fast` looks at the whole step. `conservative` leaves out pairs that its list has earlier than its
/// tolerance allows, where boxes show that they are apart; so its first may be later than in the list, and is never late.
/// Arguments, times and errors are those of `impacts`. Fronts are left at the ends of the part of the step that was looked
/// at last.
///
/// Several devices (@ref devices) look at the same part of the step; pieces of divided meshes are of the whole step.
///
///     if (const auto first = abut::first_impact(on, step, ball)) stop_at(first->time);
template <motion_arithmetic A = filtered, executor On, class X, class Y, std::same_as<impact_fronts>... Fronts>
    requires(!detail::goes_on_ways<X> && !detail::goes_on_ways<Y>)
[[nodiscard]] auto first_impact(const On& on, const X& a, const Y& b, const impact_options& options = {},
                                Fronts&... fronts) {
    return ask_motion(on, detail::ask_first_impact<A, false>{}, a, b, options, detail::fronts_of(fronts)...);
}

/// The earliest of the impacts of a mesh with itself, as `self_impacts` has them. Otherwise as `first_impact`.
template <motion_arithmetic A = filtered, executor On, class X, std::same_as<impact_fronts>... Fronts>
[[nodiscard]] auto first_self_impact(const On& on, const X& a, const impact_options& options = {}, Fronts&... fronts) {
    return ask_motion(on, detail::ask_first_impact<A, true>{}, a, a, options, detail::fronts_of(fronts)...);
}

///@}

}  // namespace abut
