// SPDX-License-Identifier: MIT
#pragma once

// first_meetings and touching_bodies of scenes of bodies that move and turn: which bodies meet, when, and which of their shapes. Boxes
// around the whole ways tell which two may; each two of these are an entry of the list form (turning.hpp), whose answers they get.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/bodies.hpp>
#include <abut/collide/executor.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/touching_bodies.hpp>
#include <abut/collide/turning.hpp>
#include <abut/shape/turning_reach.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// A scene on its way from one frame to another: each of its bodies goes from its pose in the first to that in the second, as
/// `moving(posed(x, from), posed(x, to))` does. Shares what both scenes share.
template <class Index>
struct bodies_motion {
    using index_type = Index;                          ///< what bodies are of
    using scalar_type = typename Index::scalar_type;  ///< float or double

    bodies<Index> at_t0;  ///< under the poses at t = 0
    bodies<Index> at_t1;  ///< under those at t = 1

    /// Number of bodies.
    [[nodiscard]] std::size_t size() const { return at_t0.size(); }
};

/// A scene that moves: `at_t1` is `refit(on, at_t0, poses)`, or another refit of the same scene. Bodies turn about the origins of
/// their frames, the shorter way round. Throws error where the two were not refitted from one scene. Returns at once.
///
///     const auto frame = abut::moving(scene, abut::refit(on, scene, poses));
template <class Index>
[[nodiscard]] bodies_motion<Index> moving(const bodies<Index>& at_t0, const bodies<Index>& at_t1) {
    const auto &from = detail::parts_of_bodies::of(at_t0), &to = detail::parts_of_bodies::of(at_t1);
    if (from.placed.objects != to.placed.objects) {
        throw error("abut::moving: another scene at t = 1 than at t = 0; expected one that refit has made of it");
    }
    return {at_t0, at_t1};
}

/// What two bodies of a scene in motion meet first: `meeting` with the numbers of the bodies.
struct body_meeting {
    std::uint32_t body_a;  ///< position of the first body
    std::uint32_t body_b;  ///< position of the second one: within one scene it is higher
    meeting first;         ///< which of their shapes meet, and when

    friend constexpr bool operator==(const body_meeting&, const body_meeting&) = default;
};

/// Options of `first_meetings` and `touching_bodies` of scenes in motion.
template <class Filter = keep_all>
struct scene_meeting_options {
    /// As in meeting_options.
    double tolerance = 0;
    /// filter(body, body) -> bool, on the calling thread: two bodies for which it is false do not meet.
    Filter filter = {};
};

///@}

namespace detail {

/// A body's box on its whole way, with `far` around it. Between two of nine times each point is off from its chord by no more than an
/// eighth of the greatest second derivative times the square of the time between.
template <scalar T>
aabb<T> box_on_way(const rigid_motion& m, const aabb<T>& box, double far) {
    const turned_box turned(box, m.centre);
    const double radius = turning_bounds::radius(m, box);
    const turning_bounds bounds({m, m}, radius, radius);
    const int parts = m.is_still() ? 1 : m.angle == 0 && !(m.off > 0) ? 1 : 8;
    vec3<double> lower{infinity<double>, infinity<double>, infinity<double>}, upper{-infinity<double>, -infinity<double>, -infinity<double>};
    for (int k = 0; k <= parts; ++k) {
        const turned_frame at = m.frame(static_cast<double>(k) / parts);
        const vec3<double> middle = at.place(turned.middle),
                           half{plain_dot(absolute(at.rows[0]), turned.half), plain_dot(absolute(at.rows[1]), turned.half),
                                plain_dot(absolute(at.rows[2]), turned.half)};
        lower = least(lower, plain_step(middle, -1.0, half));
        upper = greatest(upper, plain_step(middle, 1.0, half));
    }
    const double bend = plain_sum(turned.bend(m, m.frame(0)), bounds.bend), grown = far + bounds.margin + bend / (4.0 * parts * parts);
    const auto rounded_to = [](double x, double towards) {
        constexpr double most = static_cast<double>(largest_finite<T>);
        const T near = static_cast<T>(std::min(std::max(x, -most), most));
        const bool is_inside = towards > 0 ? static_cast<double>(near) < x : static_cast<double>(near) > x;
        return is_inside ? std::nextafter(near, static_cast<T>(towards > 0 ? largest_finite<T> : -largest_finite<T>)) : near;
    };
    return {{rounded_to(lower.x - grown, -1), rounded_to(lower.y - grown, -1), rounded_to(lower.z - grown, -1)},
            {rounded_to(upper.x + grown, 1), rounded_to(upper.y + grown, 1), rounded_to(upper.z + grown, 1)}};
}

/// The motions of all bodies of a scene, in host memory, and the boxes of those that have shapes.
template <class Index>
struct scene_ways {
    using T = typename Index::scalar_type;

    std::vector<posed_motion<Index>> of;
    std::vector<aabb<T>> boxes;
    std::vector<std::uint32_t> with_shapes;  ///< the bodies that the boxes are of, ascending

    template <class Policy>
    scene_ways(const Policy& on, const bodies_motion<Index>& scene, double far, const std::string& function) {
        require_same_device(on, scene.at_t0, function.c_str());
        const placed_bodies<Index>&from = parts_of_bodies::of(scene.at_t0).placed, &to = parts_of_bodies::of(scene.at_t1).placed;
        const std::size_t n = from.size();
        std::vector<rigid<T>> poses_t0(n), poses_t1(n);
        std::vector<std::uint32_t> object_of(n);
        download(on, from.poses->data(), n, poses_t0.data());
        download(on, to.poses->data(), n, poses_t1.data());
        download(on, from.objects->object_of.data(), n, object_of.data());
        of.reserve(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Index& index = from.objects->indices[object_of[i]];
            of.emplace_back(index, poses_t0[i], poses_t1[i]);
            const auto name = [&] { return function + ": body " + std::to_string(i); };
            const rigid_motion way = make_rigid_motion(poses_t0[i], poses_t1[i], of.back().about, name_when_needed{name});
            if (index.size() == 0) continue;
            boxes.push_back(box_on_way(way, index.bounds(), far));
            with_shapes.push_back(static_cast<std::uint32_t>(i));
        }
    }
};
template <class Index>
bodies_motion<Index> as_motion(const bodies<Index>& scene) {
    return {scene, scene};
}
template <class Index>
const bodies_motion<Index>& as_motion(const bodies_motion<Index>& scene) {
    return scene;
}

template <class X>
inline constexpr bool is_bodies_motion = false;
template <class Index>
inline constexpr bool is_bodies_motion<bodies_motion<Index>> = true;
/// A scene in motion or at rest, of bodies of one type.
template <class X>
concept scene_on_way = is_bodies_motion<X> || many_bodies<X>;

/// Asks of each two bodies whose boxes meet, as many at a time as a list may have in memory, and adds what is told of them.
template <class Question, class Policy, class IndexA, class IndexB, class Filter>
void ask_bodies_on_way(const Policy& on, const scene_ways<IndexA>& a, const scene_ways<IndexB>& b, const std::vector<index_pair>& near,
                       const scene_meeting_options<Filter>& options, const std::string& function,
                       std::vector<typename Question::found>& found) {
    using answer = typename Question::answer;
    constexpr std::size_t most = 65536;
    std::vector<index_pair> bodies;
    std::vector<moving_pair<IndexA, IndexB>> list;
    std::vector<answer> answers;
    const auto ask = [&] {
        const auto name = [&](std::size_t i) {
            return function + ": bodies " + std::to_string(bodies[i].a) + " and " + std::to_string(bodies[i].b);
        };
        const auto there = meetings_of<answer>(on, list, {options.tolerance}, function, name);
        answers.resize(list.size());
        download(on, there.data(), list.size(), answers.data());
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (Question::is_told(answers[i])) found.push_back(Question::tell(bodies[i], answers[i]));
        }
        list.clear();
        bodies.clear();
    };
    for (const index_pair& boxes : near) {
        const index_pair two{a.with_shapes[boxes.a], b.with_shapes[boxes.b]};
        if (!options.filter(two.a, two.b)) continue;
        bodies.push_back(two);
        list.push_back({a.of[two.a], b.of[two.b]});
        if (list.size() == most) ask();
    }
    if (!list.empty()) ask();
}

/// Which of the pairs of boxes that meet are asked about: they are dealt out to several devices one by one.
struct share_of_bodies {
    std::size_t part = 0, parts = 1;
    [[nodiscard]] std::vector<index_pair> of(const std::vector<index_pair>& all) const {
        if (parts == 1) return all;
        std::vector<index_pair> mine;
        for (std::size_t i = part; i < all.size(); i += parts) mine.push_back(all[i]);
        return mine;
    }
};

/// What is found, in the policy's memory.
template <class Found, class Policy>
result<Found, space_of<Policy>> result_of_host(const Policy& on, const std::vector<Found>& found) {
    execution::buffer_of<Policy, Found> there(on, found.size());
    upload(on, found.data(), found.size(), there.data());
    synchronize(on);
    return result<Found, space_of<Policy>>(std::move(there));
}

/// What is asked of each two bodies, and what is said of those that meet.
///@{
struct first_of_bodies {
    using answer = meeting;
    using found = body_meeting;
    static bool is_told(const meeting& first) { return first.a != no_id; }
    static body_meeting tell(const index_pair& bodies, const meeting& first) { return {bodies.a, bodies.b, first}; }
    static index_pair bodies(const body_meeting& of) { return {of.body_a, of.body_b}; }
};
struct whether_bodies_meet {
    using answer = std::uint8_t;
    using found = index_pair;
    static bool is_told(std::uint8_t meet) { return meet != 0; }
    static index_pair tell(const index_pair& bodies, std::uint8_t) { return bodies; }
    static index_pair bodies(const index_pair& of) { return of; }
};
///@}

/// What is found within one scene, or between two, in host memory; or what of it is in a share.
///@{
template <class Question, class Policy, class Scene, class Filter>
auto bodies_that_meet(const Policy& on, const alone<Scene>& all, const scene_meeting_options<Filter>& options, const std::string& function,
                      const share_of_bodies& share = {}) {
    using index = typename Scene::index_type;
    std::vector<typename Question::found> found;
    if constexpr (can_turn<Policy, index, index>()) {
        check(meeting_options{options.tolerance}, function);
        const scene_ways<index> ways(on, as_motion(all.x), options.tolerance, function);
        const boxes<typename index::scalar_type> boxes_of_all(ways.boxes);
        const auto near = to_host(self_pairs(on, make_bvh(on, copy_to(on, boxes_of_all))));
        ask_bodies_on_way<Question>(on, ways, ways, share.of(near), options, function, found);
    }
    return found;
}
template <class Question, class Policy, class SceneA, class SceneB, class Filter>
auto bodies_that_meet(const Policy& on, const two<SceneA, SceneB>& both, const scene_meeting_options<Filter>& options,
                      const std::string& function, const share_of_bodies& share = {}) {
    using index_a = typename SceneA::index_type;
    using index_b = typename SceneB::index_type;
    std::vector<typename Question::found> found;
    if constexpr (can_turn<Policy, index_a, index_b>()) {
        check(meeting_options{options.tolerance}, function);
        const scene_ways<index_a> of_a(on, as_motion(both.a), options.tolerance, function);
        const scene_ways<index_b> of_b(on, as_motion(both.b), options.tolerance, function);
        const boxes<typename index_a::scalar_type> boxes_a(of_a.boxes), boxes_b(of_b.boxes);
        const auto near = to_host(pairs(on, make_bvh(on, copy_to(on, boxes_a)), make_bvh(on, copy_to(on, boxes_b))));
        ask_bodies_on_way<Question>(on, of_a, of_b, share.of(near), options, function, found);
    }
    return found;
}
///@}

/// The same as a `result`.
template <execution_policy Policy, class Question, class Scenes, class Filter>
auto ask_scenes_on_way(const Policy& on, const Question&, const Scenes& scenes, const scene_meeting_options<Filter>& options, const char* function) {
    return result_of_host(on, bodies_that_meet<Question>(on, scenes, options, function));
}
/// Several devices are in devices/bodies.hpp.
template <class On, class Question, class Scenes, class Filter>
    requires(is_ranks<On> || is_async<On>)
void ask_scenes_on_way(const On&, const Question&, const Scenes&, const scene_meeting_options<Filter>&, const char*) {
    static_assert(execution_policy<On>, "abut: scenes in motion lie on one machine, and need the host: ranks and async take none");
}

}  // namespace detail

/// @addtogroup motion
///@{

/// Which bodies of a scene meet on their ways, when and where first: a `result` of `body_meeting`, sorted by both bodies. Two bodies
/// that are not there meet nothing of each other, which is proven. `scene` is `moving(frame, next_frame)`. Times, shapes and
/// distances of each two are those that the list form of `first_meetings` has of them, with its tolerance: never late. Bodies
/// with `{.filter = f}` false do not meet.
///
/// Boxes around the whole ways tell which bodies may come near each other. Bodies that turn have them from nine poses and a bound
/// of how far off their chords points are.
///
/// @par Memory
/// Scenes lie in the policy's memory, and so does the result, 40 bytes each. The call copies poses to host memory and makes
/// some 500 bytes a body there, 8 bytes for each two bodies whose boxes meet, and a list of no more than 65,536 of these at a
/// time.
///
/// @par Errors
/// Those of the list form, which name the bodies.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
///     const auto next = abut::refit(on, scene, poses);
///     for (const auto& m : abut::to_host(abut::first_meetings(on, abut::moving(scene, next), {.tolerance = 1e-3}))) use(m.first.time);
template <executor On, class Scene, class Filter = keep_all>
    requires detail::is_bodies_motion<Scene>
[[nodiscard]] auto first_meetings(const On& on, const Scene& scene, const scene_meeting_options<Filter>& options) {
    return ask_scenes_on_way(on, detail::first_of_bodies{}, detail::alone<Scene>{scene}, options, "abut::first_meetings");
}
/// The same of each body of `a` and each of `b`, of which one scene may be at rest. body_a is the number in a, body_b in b.
template <executor On, detail::scene_on_way SceneA, detail::scene_on_way SceneB, class Filter = keep_all>
    requires(detail::is_bodies_motion<SceneA> || detail::is_bodies_motion<SceneB>)
[[nodiscard]] auto first_meetings(const On& on, const SceneA& a, const SceneB& b, const scene_meeting_options<Filter>& options) {
    return ask_scenes_on_way(on, detail::first_of_bodies{}, detail::two<SceneA, SceneB>{a, b}, options, "abut::first_meetings");
}

/// Which bodies meet at all on their ways: a `result` of `index_pair`, those of `first_meetings`, in less time. Memory, errors and
/// synchronisation are those of that.
template <executor On, class Scene, class Filter = keep_all>
    requires detail::is_bodies_motion<Scene>
[[nodiscard]] auto touching_bodies(const On& on, const Scene& scene, const scene_meeting_options<Filter>& options) {
    return ask_scenes_on_way(on, detail::whether_bodies_meet{}, detail::alone<Scene>{scene}, options, "abut::touching_bodies");
}
/// The same of two scenes.
template <executor On, detail::scene_on_way SceneA, detail::scene_on_way SceneB, class Filter = keep_all>
    requires(detail::is_bodies_motion<SceneA> || detail::is_bodies_motion<SceneB>)
[[nodiscard]] auto touching_bodies(const On& on, const SceneA& a, const SceneB& b, const scene_meeting_options<Filter>& options) {
    return ask_scenes_on_way(on, detail::whether_bodies_meet{}, detail::two<SceneA, SceneB>{a, b}, options, "abut::touching_bodies");
}

///@}

}  // namespace abut
