// SPDX-License-Identifier: MIT
#pragma once

// The search for pairs of features that touch, with their times. A judge's first try leaves few pairs, and of these the time
// says whether they touch at all: so nothing is decided twice.
//
// A thread of the host does both where a pair is found. On a device there are stages, each with full warps: candidates are
// gathered, as many as find room; a look that costs little sifts out most of them; the first try reads the rest, and the second
// one what that leaves; and what is left then is timed. A walk that does all of it would hold the registers of all. What a device
// cannot time it leaves to the host, which comes when all is found (impacts.hpp).

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/features.hpp>
#include <abut/collide/judge.hpp>
#include <abut/collide/search.hpp>
#include <abut/collide/shares.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/narrow/time_of_impact.hpp>

namespace abut::detail {

/// A judge that tells when two features in motion first touch. Times are 0 or more, time_in_bits::none of features that do
/// not touch, and time_in_bits::unknown where a host has to be asked.
///   decide(s, t)        the first try: `no` of those that do not touch
///   time(s, t)          in registers
///   time_on_host(s, t)  known
/// It may have is_apart(s, t), which costs little, and is_apart_late(s, t), which knows more, both false where they do not know; and
/// sifts(), whether they know of any.
template <class J, class S, class U>
concept timing_judge = requires(const J& judge, const S& s, const U& u) {
    { judge.decide(s, u) } -> std::same_as<verdict>;
    { judge.time(s, u) } -> std::same_as<double>;
    { judge.time_on_host(s, u) } -> std::same_as<double>;
};

/// Of all pairs of features of a view (features.hpp).
template <class J, class View>
concept feature_judge =
    timing_judge<J, typename decltype(View::a.vertices)::shape_type, typename decltype(View::a.faces)::shape_type> &&
    timing_judge<J, typename decltype(View::a.edges)::shape_type, typename decltype(View::a.edges)::shape_type>;

// What such a judge says of the shapes of a pair.

template <class Judge>
struct first_try {
    const Judge& judge;
    template <class S, class U>
    ABUT_INLINE ABUT_HD bool operator()(const S& s, const U& t) const {
        return judge.decide(s, t) != verdict::no;
    }
};
template <class Judge>
struct time_by {
    const Judge& judge;
    template <class S, class U>
    ABUT_HD double operator()(const S& s, const U& t) const {
        return judge.time(s, t);
    }
};
template <class Judge>
struct time_on_host_by {
    const Judge& judge;
    template <class S, class U>
    double operator()(const S& s, const U& t) const {
        return judge.time_on_host(s, t);
    }
};

/// A pair that touches, or whose time is not known yet.
struct timed_key {
    std::uint64_t key;
    double time;
};
template <class Policy>
using timed_queue = execution::work_queue<timed_key, space_of<Policy>>;

/// On a host: judges candidates by their keys, as the verbs of a policy take a judge.
template <class View, class Judge>
struct time_at_once {
    View both;
    Judge judge;

    template <class Hits>
    bool operator()(std::uint64_t key, Hits&) const {
        return !both.with_shapes(key, first_try<Judge>{judge});
    }
    template <class Hits>
    void finish(std::uint64_t key, Hits& hits) const {
        const double time = both.with_shapes(key, time_on_host_by<Judge>{judge});
        if (time >= 0) hits.push({key, time});
    }
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const { both.prefetch(key, step); }
};
/// The same of a loop whose sink takes candidates.
template <class View, class Judge, class Hits>
struct time_pushed {
    const time_at_once<View, Judge>& judge;
    Hits& hits;
    void push(std::uint64_t key) const {
        if (!judge(key, hits)) judge.finish(key, hits);
    }
};

// On a device. Candidates lie in one room: pairs of a vertex and a face from its beginning on, pairs of edges from its end,
// so that the lanes of a warp do the same.

template <class Policy>
using room_of = execution::buffer_of<Policy, std::uint64_t>;

/// What lies in a room, or in two.
struct gathered_features {
    const std::uint64_t *begin, *end;
    std::size_t of_vertices, of_edges;
    [[nodiscard]] std::size_t count() const { return of_vertices + of_edges; }
};
/// Of one room, from its beginning and from its end.
template <class Room, class Vertices, class Edges>
gathered_features in_room(const Room& room, const Vertices& vertices, const Edges& edges) {
    return {room.data(), room.data() + room.size(), static_cast<std::size_t>(vertices.pushed()),
            static_cast<std::size_t>(edges.pushed())};
}
template <class Queue>
gathered_features in_two_queues(const Queue& vertices, const Queue& edges) {
    return {vertices.data(), edges.data() + edges.size(), vertices.size(), edges.size()};
}

/// Hands on candidates to the sink of their kind.
template <class Vertices, class Edges>
struct push_by_kind {
    feature_key key;
    Vertices& vertices;
    Edges& edges;
    ABUT_HD void push(std::uint64_t k) const {
        if (key.kind(k) == feature_pair::edge_edge) {
            edges.push(k);
        } else {
            vertices.push(k);
        }
    }
};
struct gather_candidate {
    part_of_open part;
    ABUT_CALLS_ANY
    template <class Near>
    ABUT_HD bool operator()(std::uint64_t key, Near& near, auto&...) const {
        if (part.holds(key)) near.push(key);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};
struct gather_features {
    part_of_open part;
    feature_key key;
    ABUT_CALLS_ANY
    template <class Vertices, class Edges>
    ABUT_HD bool operator()(std::uint64_t k, Vertices& vertices, Edges& edges, auto&...) const {
        if (part.holds(k)) push_by_kind<Vertices, Edges>{key, vertices, edges}.push(k);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

/// One of what was gathered, by its place: f(key, whether it is a pair of a vertex and a face).
template <class F>
ABUT_HD void take_gathered(const gathered_features& near, std::size_t i, const F& f) {
    if (i < near.of_vertices) {
        f(near.begin[i], true);
    } else {
        f(*(near.end - 1 - (i - near.of_vertices)), false);
    }
}
template <class Judge>
concept sifting_judge = requires(const Judge& judge) { judge.sifts(); };
/// What a judge says at little cost.
template <class Judge>
struct keep_if_near {
    const Judge& judge;
    template <class S, class U>
    ABUT_INLINE ABUT_HD bool operator()(const S& s, const U& t) const {
        return !judge.is_apart(s, t);
    }
};
template <class View, class Judge>
struct sift_gathered {
    View both;
    Judge judge;
    gathered_features near;
    ABUT_CALLS_ANY
    template <class Vertices, class Edges>
    ABUT_HD void operator()(std::size_t i, Vertices& vertices, Edges& edges) const {
        const keep_if_near<Judge> ask{judge};
        take_gathered(near, i, [&](std::uint64_t key, bool of_vertex) {
            if (of_vertex) {
                if (both.with_vertex(key, ask)) vertices.push(key);
            } else {
                if (both.with_edges(key, ask)) edges.push(key);
            }
        });
    }
};
template <class Judge>
struct keep_if_near_late {
    const Judge& judge;
    template <class S, class U>
    ABUT_HD bool operator()(const S& s, const U& t) const {
        return !judge.is_apart_late(s, t);
    }
};
/// Of what the first try leaves. Most of the rest meets: then all lanes of a warp compute a time.
template <class View, class Judge>
struct sift_late {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Open>
    ABUT_HD void operator()(std::size_t i, Open& open) const {
        if (both.with_shapes(keys[i], keep_if_near_late<Judge>{judge})) open.push(keys[i]);
    }
};
template <class View, class Judge>
struct try_gathered {
    View both;
    Judge judge;
    gathered_features near;
    ABUT_CALLS_ANY
    template <class Open>
    ABUT_HD void operator()(std::size_t i, Open& open) const {
        const first_try<Judge> ask{judge};
        take_gathered(near, i, [&](std::uint64_t key, bool of_vertex) {
            if (of_vertex ? both.with_vertex(key, ask) : both.with_edges(key, ask)) open.push(key);
        });
    }
};
/// A lane in `spread` times one.
template <class View, class Judge>
struct time_gathered {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    std::size_t spread;
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD void operator()(std::size_t i, Hits& hits) const {
        if (i % spread != 0) return;
        const std::uint64_t key = keys[i / spread];
        const double time = both.with_shapes(key, time_by<Judge>{judge});
        if (time != time_in_bits::none) hits.push({key, time});
    }
};

/// Times candidates that have been gathered.
template <class Policy, class View, class Judge>
void time_candidates(const Policy& on, const View& view, const Judge& judge, gathered_features near,
                     timed_queue<Policy>& hits) {
    const vertices_on_way<Policy, View> vertices_of(on, view);
    const auto both = vertices_of.view(view);
    using features = std::remove_const_t<decltype(both)>;
    room_of<Policy> less;
    if constexpr (sifting_judge<Judge>) {
        if (judge.sifts()) {
            less = room_of<Policy>(on, near.count() / 2 + 1024);
            using space = space_of<Policy>;
            execution::capped_queue<std::uint64_t, space> vertices(less.data(), less.size());
            execution::capped_queue_from_end<std::uint64_t, space> edges(less.data(), less.size());
            for_each_index(on, near.count(), sift_gathered<features, Judge>{both, judge, near}, vertices, edges);
            const gathered_features left = in_room(less, vertices, edges);
            if (left.count() <= less.size()) near = left;  // or nothing is sifted out
        }
    }
    const bool is_sifted = less.size() > 0;
    key_queue<Policy> open(on, std::max(near.count() / (is_sifted ? 2 : 8), std::size_t{1} << 16));
    for_each_index(on, near.count(), try_gathered<features, Judge>{both, judge, near}, open);
    if constexpr (sifting_judge<Judge>) {
        if (is_sifted) {
            key_queue<Policy> late(on, std::max(open.size() / 2, std::size_t{1} << 16));
            for_each_index(on, open.size(), sift_late<features, Judge>{both, judge, open.data()}, late);
            open = std::move(late);
        }
    }
    const std::size_t n = open.size();
    const std::size_t spread = spread_of(n);
    for_each_index(on, n * spread, time_gathered<features, Judge>{both, judge, open.data(), spread}, hits);
}

/// Room on a device for candidates of shapes: 128 of each, 2^23 at least and `most` at most.
template <class Policy>
room_of<Policy> room_for_candidates(const Policy& on, std::size_t shapes, std::size_t most) {
    return room_of<Policy>(on, std::clamp(128 * shapes, std::size_t{1} << 23, most));
}

/// Calls gather(part), which gathers the candidates of a part of all and returns how many these are, and pass() when there
/// was room for them; with parts of the part where there was none.
template <class Gather, class Pass>
void gather_in_parts(std::size_t room, const Gather& gather, const Pass& pass, part_of_open part = {}) {
    const std::size_t count = gather(part);
    if (count <= room) return pass();
    const auto more = static_cast<std::uint32_t>(2 * count / room + 1);
    for (std::uint32_t k = 0; k < more; ++k) gather_in_parts(room, gather, pass, part.split(k, more));
}

/// Gathers a part of what loops find, as much as there is room for; run_all(run) runs them. Returns how much there is.
template <class Policy, class Loops>
std::size_t gather_one_kind(const Policy&, const Loops& run_all, part_of_open part, room_of<Policy>& room) {
    std::size_t count = 0;
    run_all([&](const auto& loop) {
        const std::size_t taken = std::min(count, room.size());
        execution::capped_queue<std::uint64_t, space_of<Policy>> near(room.data() + taken, room.size() - taken);
        loop(gather_candidate{part}, near);
        count += static_cast<std::size_t>(near.pushed());
    });
    return count;
}

/// Gathers a part of a pairing's candidates, as many as there is room for; the counts are of all.
template <class Policy, class Pairing>
gathered_features gather(const Policy& on, const Pairing& pairing, part_of_open part, room_of<Policy>& room) {
    using space = space_of<Policy>;
    gathered_features found{room.data(), room.data() + room.size(), 0, 0};
    pairing.judge_candidates(on, [&](const auto& loop) {
        const std::size_t begin = std::min(found.of_vertices, room.size());
        const std::size_t left = room.size() - std::min(found.count(), room.size());
        execution::capped_queue<std::uint64_t, space> vertices(room.data() + begin, left);
        execution::capped_queue_from_end<std::uint64_t, space> edges(room.data() + begin, left);
        loop(gather_features{part, pairing.view().key}, vertices, edges);
        found.of_vertices += static_cast<std::size_t>(vertices.pushed());
        found.of_edges += static_cast<std::size_t>(edges.pushed());
    });
    return found;
}

/// Leaves in `hits` the pairs of a pairing that touch, with their times.
template <class Policy, class Pairing, class Judge>
void search_times(const Policy& on, const Pairing& pairing, const Judge& judge, timed_queue<Policy>& hits) {
    const auto both = pairing.view();
    using view = std::remove_const_t<decltype(both)>;
    static_assert(feature_judge<Judge, view>, "abut: search_times: the judge is no timing_judge of pairs of features");
    if constexpr (host_policy<Policy>) {
        const time_at_once<view, Judge> time{both, judge};
        pairing.judge_candidates(on, [&](const auto& loop) { loop(time, hits); });
    } else {
        auto room = room_for_candidates(on, std::max(both.a.count(), both.b.count()), std::size_t{1} << 27);
        gathered_features near{};
        gather_in_parts(
            room.size(),
            [&](part_of_open part) {
                near = gather(on, pairing, part, room);
                return near.count();
            },
            [&] { time_candidates(on, both, judge, near, hits); });
    }
}

}  // namespace abut::detail
