// SPDX-License-Identifier: MIT
#pragma once

// The engine of all queries: who pairs up (pairing.hpp, list.hpp), what is decided (judge.hpp), and where it goes (the sinks
// of execution/work_queue.hpp). A search judges all candidates of a pairing and leaves what it finds in a sink.
//
// What a judge's first try leaves open waits in room of a fixed size: 256 pairs of a thread of the host, which finishes them
// when they are so many, and some million pairs of a device, which has a kernel for them. So memory does not grow with the
// number of pairs. Pairs whose coordinates are too far apart for integers in registers (2^124 in one pair) are resolved on
// the host.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/collide/judge.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::detail {

template <class Policy>
using key_queue = execution::work_queue<std::uint64_t, space_of<Policy>>;

/// A pair with its shapes, on its way to the host.
template <class View>
struct whole_pair {
    typename View::shape_type_a a;
    typename View::shape_type_b b;
    std::uint64_t key;
};

template <class View>
struct fetch_pair {
    View both;
    const std::uint64_t* keys;
    whole_pair<View>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = keys[i];
        out[i] = {both.shape_a(key), both.shape_b(key), key};
    }
};

struct report_key {
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD void operator()(std::size_t i, Hits& hits) const {
        report(hits, keys[i]);
    }
};

/// Resolves on the host what a device left there, most_pairs at a time, and reports what was found from the device.
template <class Policy, class View, class Judge, class Hits>
void resolve_on_host(const Policy& on, const View& both, const Judge& judge, const std::uint64_t* keys, std::size_t n,
                     std::size_t most_pairs, Hits& hits) {
    for (std::size_t first = 0; first < n && !execution::is_over(hits); first += most_pairs) {
        const std::size_t some = std::min(n - first, most_pairs);
        std::vector<whole_pair<View>> pairs(some);  // first: nothing may throw while the keys are being read
        execution::buffer_of<Policy, whole_pair<View>> gathered(on, some);
        for_each_index(on, some, fetch_pair<View>{both, keys + first, gathered.data()});
        download(on, gathered.data(), some, pairs.data());
        std::vector<std::uint64_t> found;
        for (const auto& pair : pairs) {
            if (judge.resolve(pair.a, pair.b)) found.push_back(pair.key);
        }
        execution::buffer_of<Policy, std::uint64_t> there(on, found.size());
        upload(on, found.data(), found.size(), there.data());
        for_each_index(on, found.size(), report_key{there.data()}, hits);
    }
}

/// Runs the loops of a search, each of which judges candidates: loop(judge, sinks...) is a verb of the policy.
template <class Policy, class View, class Judge, class Hits>
class judged_loops {
public:
    judged_loops(const Policy& on, const View& both, const Judge& judge, std::uint64_t most_pairs, Hits& hits)
        : on_(on), judge_{both, judge, {}}, most_pairs_(std::max<std::size_t>(most_pairs, 1)), hits_(hits) {}

    template <class Loop>
    void operator()(const Loop& loop) const {
        if constexpr (host_policy<Policy>) {
            loop(judge_, hits_);
        } else {
            run(loop, {});
        }
    }
    [[nodiscard]] bool is_over() const { return execution::is_over(hits_); }

private:
    /// On a device. Where a loop leaves more open than may wait, none of it has been finished: then it runs again for each
    /// part of that.
    template <class Loop>
    void run(const Loop& loop, part_of_open part) const {
        judge_key<View, Judge> judge = judge_;
        judge.part = part;
        execution::capped_queue<std::uint64_t, space_of<Policy>> hard(on_, execution::most_open);
        const std::uint64_t unfinished = loop(judge, hits_, hard);
        if (unfinished == 0) {
            return resolve_on_host(on_, judge.both, judge.judge, hard.data(), hard.pushed(), most_pairs_, hits_);
        }
        const auto more = static_cast<std::uint32_t>(2 * unfinished / execution::most_open + 1);
        for (std::uint32_t k = 0; k < more && !is_over(); ++k) {
            run(loop, part.split(k, more));
        }
    }

    const Policy& on_;
    judge_key<View, Judge> judge_;
    std::size_t most_pairs_;
    Hits& hits_;
};

/// Judges all candidates of a pairing and leaves what it finds in `hits`: a queue of keys, a count, a flag or a visitor.
/// Waits for the outcome.
template <class Policy, class Pairing, class Judge, class Hits>
void search(const Policy& on, const Pairing& pairing, const Judge& judge, Hits& hits) {
    using view = typename Pairing::view_type;
    static_assert(pair_judge<Judge, typename view::shape_type_a, typename view::shape_type_b>,
                  "abut: search: the judge is no pair_judge (collide/judge.hpp) of these shapes");
    pairing.judge_candidates(
        on, judged_loops<Policy, view, Judge, Hits>(on, pairing.view(), judge, pairing.options.most_pairs, hits));
}

/// A judge that `may_report_more` than there is, since what reads the pairs that were found looks at them again: so nothing is
/// left to the host here. On a device candidates are gathered first, as many as find room, and then judged, each stage with
/// full warps: a walk that decides would hold the registers of both.
template <class Judge>
inline constexpr bool judges_apart = requires { requires Judge::may_report_more; };

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
/// The first try of candidates, and what it leaves.
template <class View, class Judge>
struct try_gathered {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Hits, class Open>
    ABUT_HD void operator()(std::size_t i, Hits& hits, Open& open) const {
        const verdict v = judge.decide(both.shape_a(keys[i]), both.shape_b(keys[i]));
        if (v == verdict::yes) hits.push(keys[i]);
        if (v == verdict::unknown) open.push(keys[i]);
    }
};
template <class View, class Judge>
struct finish_gathered {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD void operator()(std::size_t i, Hits& hits) const {
        if (judge.finish(both.shape_a(keys[i]), both.shape_b(keys[i])) != verdict::no) hits.push(keys[i]);
    }
};

/// Judges candidates that have been gathered.
template <class Policy, class View, class Judge>
void judge_gathered(const Policy& on, const View& both, const Judge& judge, const std::uint64_t* keys, std::size_t count,
                    key_queue<Policy>& hits) {
    key_queue<Policy> open(on, std::max(count / 8, std::size_t{1} << 16));
    for_each_index(on, count, try_gathered<View, Judge>{both, judge, keys}, hits, open);
    for_each_index(on, open.size(), finish_gathered<View, Judge>{both, judge, open.data()}, hits);
}

/// Room for what such a judge finds, 8 MiB.
inline constexpr std::size_t least_hits_apart = std::size_t{1} << 20;
/// Candidates that are gathered on a device at a time: 128 for each shape, 64 MiB of them at least and 512 at most.
inline constexpr std::size_t least_gathered = std::size_t{1} << 23, most_gathered = std::size_t{1} << 26;

/// Gathers a part of a pairing's candidates in `room`, as many as there is room for. Returns how many there are.
template <class Policy, class Pairing>
std::size_t gather_part(const Policy& on, const Pairing& pairing, part_of_open part,
                        execution::buffer_of<Policy, std::uint64_t>& room) {
    std::size_t count = 0;  // of all loops of a walk
    pairing.judge_candidates(on, [&](const auto& loop) {
        const std::size_t taken = std::min(count, room.size());
        execution::capped_queue<std::uint64_t, space_of<Policy>> near(room.data() + taken, room.size() - taken);
        loop(gather_candidate{part}, near);
        count += static_cast<std::size_t>(near.pushed());
    });
    return count;
}

/// A search by a judge that may report more. Where there are more candidates than may be gathered, it looks for a part of them
/// at a time.
template <class Policy, class Pairing, class Judge>
void search_apart(const Policy& on, const Pairing& pairing, const Judge& judge, key_queue<Policy>& hits,
                  execution::buffer_of<Policy, std::uint64_t>& room, part_of_open part = {}) {
    const std::size_t count = gather_part(on, pairing, part, room);
    if (count <= room.size()) return judge_gathered(on, pairing.view(), judge, room.data(), count, hits);
    const auto more = static_cast<std::uint32_t>(2 * count / room.size() + 1);
    for (std::uint32_t k = 0; k < more; ++k) search_apart(on, pairing, judge, hits, room, part.split(k, more));
}

/// What a judge says of each pair that was found.
template <class View, class Judge, class Answer>
struct answer_key {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    Answer* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = judge.answer(both, keys[i]); }
};

/// The keys of all pairs that a judge finds, ascending if the options say so.
template <class Policy, class Pairing, class Judge>
auto find_keys(const Policy& on, const Pairing& pairing, const Judge& judge) {
    // Where a queue proves too small, its loop runs again.
    key_queue<Policy> hits(on, std::max(pairing.likely_hits(), judges_apart<Judge> ? least_hits_apart : 0));
    if constexpr (judges_apart<Judge> && !host_policy<Policy>) {
        const auto both = pairing.view();
        const std::size_t shapes = std::max(both.a.size(), both.b.size());
        execution::buffer_of<Policy, std::uint64_t> room(on, std::clamp(128 * shapes, least_gathered, most_gathered));
        search_apart(on, pairing, judge, hits, room);
    } else {
        search(on, pairing, judge, hits);
    }
    auto keys = hits.take();
    if (pairing.options.sorted) sort_keys(on, keys, pairing.key.bits());
    return keys;
}

/// The answers of a judge to keys that it found, in their order, in the policy's memory. Waits for them.
template <class Policy, class Pairing, class Judge>
auto answers_to(const Policy& on, const Pairing& pairing, const Judge& judge,
                const execution::buffer_of<Policy, std::uint64_t>& keys) {
    const auto both = pairing.view();
    using view = typename Pairing::view_type;
    using answer = decltype(judge.answer(both, std::uint64_t{}));
    execution::buffer_of<Policy, answer> answers(on, keys.size());
    for_each_index(on, keys.size(), answer_key<view, Judge, answer>{both, judge, keys.data(), answers.data()});
    synchronize(on);
    return result<answer, space_of<Policy>>(std::move(answers));
}

template <class Answer>
struct gather_answers {
    const Answer* from;
    const std::uint64_t* which;
    Answer* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = from[which[i]]; }
};

/// The answers i with test(i), in their order.
template <class Policy, class Answer, class Test>
auto answers_with(const Policy& on, const result<Answer, space_of<Policy>>& all, const Test& test) {
    execution::buffer_of<Policy, std::uint64_t> which(on, all.size());
    const std::size_t n = compact(on, all.size(), test, which.data());
    execution::buffer_of<Policy, Answer> kept(on, n);
    for_each_index(on, n, gather_answers<Answer>{all.data(), which.data(), kept.data()});
    synchronize(on);
    return result<Answer, space_of<Policy>>(std::move(kept));
}

}  // namespace abut::detail
