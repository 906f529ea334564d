// SPDX-License-Identifier: MIT
#pragma once

// first_meeting, first_meetings, any_each: when bodies that turn meet, and which shapes. By definition the first is the pair
// of shapes with the least time, as narrow/turning_time.hpp computes it of the two alone, and of equal ones the one with the
// least ids. Trees only pass over what comes no nearer than the tolerance by then (traverse/turning_walk.hpp). Each entry of
// a list is walked by one thread of a host, or by a warp of a device (turning_group.hpp).

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/placed.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/turning_group.hpp>
#include <abut/error.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/narrow/turning_time.hpp>
#include <abut/shape/turning.hpp>
#include <abut/traverse/turning_walk.hpp>

namespace abut {

/// What two bodies in motion meet first: two shapes and when. Where they do not meet: `no_id`, and infinite numbers.
/// @ingroup motion
struct meeting {
    double time;      ///< from 0 to 1: before it no shapes touch
    std::uint32_t a;  ///< id of the first body's shape
    std::uint32_t b;  ///< id of the second one's
    double distance;  ///< no less than what is between the two at that time; mostly the tolerance at most

    friend constexpr bool operator==(const meeting&, const meeting&) = default;
};

/// Options of `first_meeting` and its like.
/// @ingroup motion
struct meeting_options {
    /// A length, above 0: how near shapes that are met are to each other, at most.
    double tolerance = 0;
};

/// Two bodies, each in motion or at rest: `moving(posed(index, from), posed(index, to))`, or `posed(index, pose)`. Any
/// number of entries of a list may share an index.
/// @ingroup motion
template <class IndexA, class IndexB = IndexA>
struct moving_pair {
    static_assert(!std::is_const_v<IndexA> && !std::is_const_v<IndexB>,
                  "abut: moving_pair of the type of a const index: leave out const where the index is made, or write "
                  "moving_pair<std::remove_const_t<decltype(index)>>");
    posed_motion<IndexA> a;  ///< the first one
    posed_motion<IndexB> b;  ///< the second one
};

namespace detail {

/// An entry of a list in the policy's memory.
struct turning_entry {
    turning_pair both{};
    turning_bounds bounds{};  ///< of all shapes
    int looks = 0;            ///< how often it pays to look whether anything touches at a time
};

/// The first of an entry, or any.
template <bool Any, class IndexA, class IndexB>
struct first_of_entry {
    const placed_object<IndexA>* objects_a;
    const placed_object<IndexB>* objects_b;
    const std::uint32_t *object_of_a, *object_of_b;
    const turning_entry* entries;
    double tolerance;

    struct best_so_far {
        meeting found{infinity<double>, no_id, no_id, infinity<double>};
        [[nodiscard]] ABUT_HD double until() const { return found.time < 1 ? found.time : 1; }
        [[nodiscard]] ABUT_HD bool may_come_first(double time, std::uint32_t a, std::uint32_t b) const {
            return time < found.time || (time == found.time && (a < found.a || (a == found.a && b < found.b)));
        }
        ABUT_HD bool offer(const turning_time& t, std::uint32_t a, std::uint32_t b) {
            if (t.time <= 1 && may_come_first(t.time, a, b)) found = {t.time, a, b, t.distance};
            return !Any || !(found.time <= 1);
        }
    };
    struct only_at {
        double time;
        bool touch = false;
        [[nodiscard]] ABUT_HD double until() const { return time; }
    };
    /// Of ways that are long for their bodies what touches at a time or two is sooner found than what meets first.
    [[nodiscard]] ABUT_HD static double time_of_look(int k) { return k == 0 ? 1 : k == 1 ? 0.5 : k == 2 ? 0.25 : 0.75; }
    [[nodiscard]] ABUT_HD meeting operator()(std::size_t i) const {
        const placed_object<IndexA>& a = objects_a[object_of_a[i]];
        const placed_object<IndexB>& b = objects_b[object_of_b[i]];
        const turning_pair& both = entries[i].both;
        best_so_far best;
        const turning_walk<decltype(a.tree), decltype(b.tree)> walk{a.tree, b.tree};
        if constexpr (Any) {
            const int looks = entries[i].looks;
            for (int k = 0; k < looks; ++k) {
                only_at instant{time_of_look(k)};
                walk(
                    both, entries[i].bounds, 0, instant,
                    [&](std::uint32_t id_a, std::uint32_t id_b, double) {
                        instant.touch = touch_at_time(a.shapes[id_a], b.shapes[id_b], both, tolerance, instant.time);
                        return !instant.touch;
                    },
                    static_cast<float>(instant.time));
                if (instant.touch) return {instant.time, 0, 0, 0};
            }
        }
        walk(both, entries[i].bounds, tolerance, best, [&](std::uint32_t id_a, std::uint32_t id_b, double from) {
            if (!best.may_come_first(from, id_a, id_b)) return true;
            return best.offer(turning_time_of(a.shapes[id_a], b.shapes[id_b], both, tolerance, from, best.until()), id_a,
                              id_b);
        });
        return best.found;
    }

    /// The same of a group of threads.
    struct best_of_group : best_so_far {
        double last = 1;  ///< nothing after that counts
        [[nodiscard]] ABUT_HD double until() const { return least(last, best_so_far::until()); }
    };
    using walk_type = turning_walk<decltype(placed_object<IndexA>::tree), decltype(placed_object<IndexB>::tree)>;
    using room = turning_room<walk_type, best_of_group>;
    ABUT_CALLS_ANY
    template <class Group>
    [[nodiscard]] ABUT_HD meeting of_group(const Group& group, std::size_t i, room& shared) const {
        const placed_object<IndexA>& a = objects_a[object_of_a[i]];
        const placed_object<IndexB>& b = objects_b[object_of_b[i]];
        const turning_pair& both = entries[i].both;
        const walk_type walk{a.tree, b.tree};
        const auto look = [&](double begin, double end, double far, const auto& search) {
            group.each(0, 1, [&](unsigned) { shared.best = {{}, end}; });
            const auto has_ended = [](const best_of_group& best) { return Any && best.found.time <= 1; };
            turning_group run(group, shared, walk, both, entries[i].bounds, far, search, has_ended);
            run.run(static_cast<float>(begin));
            const meeting found = shared.best.found;
            group.each([](unsigned) {});  // all have read it
            return found;
        };
        if constexpr (Any) {
            for (int k = 0; k < entries[i].looks; ++k) {
                const double time = time_of_look(k);
                const meeting found = look(time, time, 0, [&](std::uint32_t id_a, std::uint32_t id_b, double, double) {
                    const bool touch = touch_at_time(a.shapes[id_a], b.shapes[id_b], both, tolerance, time);
                    return touch ? turning_time{time, 0} : turning_time{};
                });
                if (found.time <= 1) return found;
            }
        }
        return look(0, 1, tolerance, [&](std::uint32_t id_a, std::uint32_t id_b, double from, double until) {
            return turning_time_of(a.shapes[id_a], b.shapes[id_b], both, tolerance, from, until);
        });
    }
};
/// A meeting, or whether there is one. Of each entry by a thread of a host, or by a group.
template <class Answer, class IndexA, class IndexB>
struct write_meetings {
    using first_type = first_of_entry<std::same_as<Answer, std::uint8_t>, IndexA, IndexB>;
    static constexpr unsigned members = execution::subgroup_size;
    using shared = typename first_type::room;
    first_type first;
    Answer* out;
    void operator()(std::size_t i) const { write(i, first(i)); }
    ABUT_CALLS_ANY
    ABUT_HD void operator()(const execution::group<shared, members>& group) const {
        const std::size_t i = group.first / members;
        const meeting found = first.of_group(group, i, group.shared);
        group.each(0, 1, [&](unsigned) { write(i, found); });
    }

private:
    ABUT_HD void write(std::size_t i, const meeting& found) const {
        if constexpr (std::same_as<Answer, meeting>) {
            out[i] = found;
        } else {
            out[i] = found.time <= 1;
        }
    }
};

inline void check(const meeting_options& options, const std::string& function) {
    if (options.tolerance > 0 && options.tolerance < infinity<double>) return;
    throw error(function + ": the tolerance is " + shortest(options.tolerance) + "; expected a length above 0");
}

/// Throws where the tolerance is so small that rounding may hide it.
inline void check_tolerance(double tolerance, const turning_bounds& both, const auto& where) {
    // So that no square of a volume overflows, and none underflows that matters.
    if (!(both.margin < 0x1p100))
        throw error(std::string(where) + ": coordinates are too large for a motion: 2^138 is the most that is taken");
    if (tolerance >= 8 * both.margin && tolerance > 0x1p-120) return;
    throw error(std::string(where) + ": the tolerance is " + shortest(tolerance) + "; doubles tell " +
                shortest(greatest(8 * both.margin, 0x1p-120)) + " and more, 2^-37 of the sizes of bodies and ways");
}

/// Whether a list can hold both.
template <class Policy, class IndexA, class IndexB>
consteval bool can_turn() {
    if constexpr (can_be_listed<Policy, IndexA, IndexB>()) {
        constexpr bool alike = std::same_as<typename IndexA::scalar_type, typename IndexB::scalar_type>;
        static_assert(alike, "abut: both bodies of a motion have to be of one scalar type");
        constexpr bool are = turnable<typename IndexA::shape_type> && turnable<typename IndexB::shape_type>;
        static_assert(
            are,
            "abut: points, segments, triangles, spheres, capsules, boxes, oriented boxes and hulls can turn; cylinders, "
            "cones, planes and rays cannot");
        return alike && are;
    } else {
        return false;
    }
}

/// An answer of each entry, in the policy's memory; complete when it returns. Errors begin with name(i) of an entry. `InGroups` has
/// a group walk each entry, as a device always does.
template <class Answer, bool InGroups = false, class Policy, class IndexA, class IndexB, class Name>
auto meetings_of(const Policy& on, const std::vector<moving_pair<IndexA, IndexB>>& list, const meeting_options& options,
                 const std::string& function, const Name& name) {
    check(options, function);
    const std::size_t n = list.size();
    const gathered_bodies<IndexA> of_a(n, [&](std::size_t i) {
        return posed_object<IndexA>{list[i].a.object, list[i].a.from};
    });
    const gathered_bodies<IndexB> of_b(n, [&](std::size_t i) {
        return posed_object<IndexB>{list[i].b.object, list[i].b.from};
    });
    std::vector<turning_entry> entries;
    entries.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto motion_of = [&](const auto& body, const char* which) {
            const auto where = [&] { return name(i) + ": " + which; };
            return make_rigid_motion(body.from, body.to, body.about, name_when_needed{where});
        };
        turning_entry& one = entries.emplace_back();
        one.both = {motion_of(list[i].a, "the first body"), motion_of(list[i].b, "the second body")};
        if (list[i].a.size() == 0 || list[i].b.size() == 0) continue;
        const double radius_a = turning_bounds::radius(one.both.a, list[i].a.object.bounds()),
                     radius_b = turning_bounds::radius(one.both.b, list[i].b.object.bounds()),
                     way = plain_length(plain_step(one.both.b.way, -1.0, one.both.a.way));
        one.bounds = turning_bounds(one.both, radius_a, radius_b);
        one.looks = way > 0 ? static_cast<int>(least(2 * way / least(radius_a, radius_b), 4.0)) : 0;
        const auto where = [&] { return name(i); };
        check_tolerance(options.tolerance, one.bounds, name_when_needed{where});
    }
    const auto objects_a = make_objects(on, of_a.indices, of_a.object_of, function.c_str());
    const auto objects_b = make_objects(on, of_b.indices, of_b.object_of, function.c_str());
    execution::buffer_of<Policy, turning_entry> there(on, n);
    upload(on, entries.data(), n, there.data());
    execution::buffer_of<Policy, Answer> out(on, n);
    const write_meetings<Answer, IndexA, IndexB> write{{objects_a->objects.data(), objects_b->objects.data(), objects_a->object_of.data(),
                                                        objects_b->object_of.data(), there.data(), options.tolerance},
                                                       out.data()};
    if constexpr (InGroups || !host_policy<Policy>) {
        for_each_group(on, n * write.members, write);
    } else {
        for_each_task(on, n, write);
    }
    synchronize(on);
    return out;
}
/// A list of motions as a form of arguments (question.hpp).
template <class IndexA, class IndexB>
struct form_of_motions {
    using index_a = IndexA;
    using index_b = IndexB;
    const std::vector<moving_pair<IndexA, IndexB>>& list;
};
template <class IndexA, class IndexB>
struct form_of_scene<std::vector<moving_pair<IndexA, IndexB>>> {
    using type = form_of_motions<IndexA, IndexB>;
};
/// Meetings, or whether there are any, as an answer of each entry (list_each.hpp).
template <class Answer>
struct meetings_of_each {
    template <class>
    using found_type = Answer;
    template <class Policy, class Form>
    static consteval bool can_be_asked() {
        return can_turn<Policy, typename Form::index_a, typename Form::index_b>();
    }
    template <class Policy, class Form, class Positions>
    auto find(const Policy& on, const Form& form, const meeting_options& options, const char* function,
              const Positions& position) const {
        const auto name = [&](std::size_t i) {
            return std::string(function) + ": entry " + std::to_string(position(i)) + " of the list";
        };
        return result<Answer, space_of<Policy>>(meetings_of<Answer>(on, form.list, options, function, name));
    }
};

/// A body of which a query of two is asked, over an index.
template <class Policy, class X>
auto motion_of_argument(const Policy& on, const X& x) {
    if constexpr (is_posed<X>) {
        return motion_of_argument(on, posed_motion<std::remove_cvref_t<decltype(x.object)>>(x));
    } else if constexpr (is_posed_motion<X>) {
        if constexpr (is_tree<std::remove_cvref_t<decltype(x.object)>>) {
            return x;
        } else {
            auto tree = make_bvh(on, x.object);
            return posed_motion<decltype(tree)>(std::move(tree), x.from, x.to, x.about);
        }
    } else {
        return motion_of_argument(on, posed_motion<X>(x, {}, {}));
    }
}

/// One meeting of two bodies.
template <class Policy, class X, class Y>
std::optional<meeting> first_meeting_of(const Policy& on, const X& a, const Y& b, const meeting_options& options) {
    auto of_a = motion_of_argument(on, a);
    auto of_b = motion_of_argument(on, b);
    using index_a = std::remove_cvref_t<decltype(of_a.object)>;
    using index_b = std::remove_cvref_t<decltype(of_b.object)>;
    if constexpr (can_turn<Policy, index_a, index_b>()) {
        const std::vector<moving_pair<index_a, index_b>> list{{std::move(of_a), std::move(of_b)}};
        const std::string function = "abut::first_meeting";
        const auto answer = meetings_of<meeting>(on, list, options, function, [&](std::size_t) { return function; });
        meeting found{};
        download(on, answer.data(), 1, &found);
        if (found.a != no_id) return found;
    }
    return std::nullopt;
}

/// A scene of bodies, in motion or not.
template <class X>
inline constexpr bool is_scene = requires {
    typename X::index_type;
};

}  // namespace detail

/// @addtogroup motion
///@{

/// What the two bodies of each entry meet first: a `result` of `meeting`, one of each entry in their order, 32 bytes each.
/// The time is never late: before it no shapes of the two touch. It is early by no more than the tolerance: at that time the
/// two shapes that are named are no farther apart than that, so that shapes that pass each other as near may count as met.
/// A search that has not come so near after 4,096 steps of one 64th of the way ends there: then `distance` says by how much.
/// What touches at the start has the time 0. Where the time is infinite and the ids are `no_id` it is proven that nothing
/// touches from 0 to 1. Of pairs of shapes with equal times the least ids come first, a's before b's.
///
/// A pair's time is a function of the two shapes, both motions and the tolerance alone, in operations that are each rounded:
/// so the same bits on every policy, and with any tree over the same sets, but for tolerances that one tree refuses.
/// docs/turning.md says what the way between two poses is.
///
/// Bodies are indices made by make_bvh of any layout, over points, segments, triangles, spheres, capsules, boxes, oriented
/// boxes and hulls. All but triangles, segments and points are solid; what is inside of a closed mesh does not touch it.
///
/// Of several devices each takes its share of the entries, of indices that `make_bvh` of all of them has made; the answers
/// lie in memory of the first. Ranks are told of their own entries.
///
/// @par Memory
/// Indices lie in the policy's memory, the list in host memory. The call copies 550 bytes an entry to the policy's memory,
/// and needs no more as it works but 8 KB a thread (14 KB with `wide` trees). One thread of a host walks an entry, and 32 of a device.
///
/// @par Errors
/// - `error`, whose message names the entry: the tolerance is not above 0, or below what doubles tell of bodies and ways
///   of that size (2^-37 of it; for a robot of 1 m in a hall of 100 m a few nanometres); a half turn without an axis, or an
///   axis at more than 60 degrees to that of the turn.
/// - `invalid_geometry`, likewise: a pose is no rotation, or a number is not finite.
/// - `error`: an index lies on another device.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
///     std::vector<abut::moving_pair<index>> edges;
///     for (const auto& [p, q] : roadmap) edges.push_back({moving(posed(robot, p), posed(robot, q)), posed(room, here)});
///     for (const auto& m : to_host(abut::first_meetings(on, edges, {.tolerance = 1e-3}))) use(m.time);
template <executor On, class IndexA, class IndexB>
[[nodiscard]] auto first_meetings(const On& on, const std::vector<moving_pair<IndexA, IndexB>>& list, const meeting_options& options) {
    return ask_entries(on, detail::meetings_of_each<meeting>{}, detail::whole(list), options, "abut::first_meetings");
}

/// Which entries meet anything: a `result` of `std::uint8_t`, one of each entry in their order, 1 where `first_meetings` has
/// a time and else 0. An entry is looked at no more after its first such pair, so that this takes less time. Memory, errors
/// and synchronisation are those of `first_meetings`.
template <executor On, class IndexA, class IndexB>
[[nodiscard]] auto any_each(const On& on, const std::vector<moving_pair<IndexA, IndexB>>& list, const meeting_options& options) {
    return ask_entries(on, detail::meetings_of_each<std::uint8_t>{}, detail::whole(list), options, "abut::any_each");
}

/// What two bodies meet first, as `first_meetings` says of an entry; empty where they are proven to meet nothing. An
/// argument is in motion, `moving(posed(x, from), posed(x, to))`, or at rest, `posed(x, pose)` or x: an index, a set, a view
/// or one shape. A tree is made for the call where x is none. Memory, errors and synchronisation are those of
/// `first_meetings` and `make_bvh`. One thread walks, or 32 of a device: give many motions to one call of that.
///
///     if (abut::first_meeting(on, abut::moving(posed(robot, from), posed(robot, to)), room, {.tolerance = 1e-3}))
///     turn_back();
template <execution_policy Policy, class X, class Y>
[[nodiscard]] std::optional<meeting> first_meeting(const Policy& on, const X& a, const Y& b,
                                                   const meeting_options& options) {
    constexpr bool are_single = !detail::is_scene<X> && !detail::is_scene<Y>;
    static_assert(are_single, "abut: first_meeting is asked of two bodies; of a scene of bodies ask first_meetings(on, moving(scene, "
                              "refit(on, scene, poses)), options)");
    if constexpr (!are_single) {
        return std::nullopt;
    } else {
        return detail::first_meeting_of(on, a, b, options);
    }
}

///@}

}  // namespace abut
