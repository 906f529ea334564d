// SPDX-License-Identifier: MIT
#pragma once

// The engine of all queries: who pairs up (pairing.hpp, list.hpp), what is decided (judge.hpp), and where it goes (the sinks
// of execution/work_queue.hpp). A search judges all candidates of a pairing and leaves what it finds in a sink.
//
// What a judge's first try leaves open waits in room of a fixed size: 256 pairs of a thread of the host, which finishes them
// when they are so many, and up to eight million pairs of a device, which has a kernel for them. So memory does not grow with the
// number of pairs. Pairs whose coordinates are too far apart for integers in registers (2^124 in one pair) are resolved on
// the host.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
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

template <class View, class Judge>
struct resolve_whole {
    const whole_pair<View>* pairs;
    const Judge& judge;
    unsigned char* touch;
    void operator()(std::size_t i) const { touch[i] = judge.resolve(pairs[i].a, pairs[i].b); }
};

/// Pairs by their keys, with their shapes, in host memory: with copies of what shapes of a device refer to.
template <class View>
class fetched_pairs {
public:
    template <class Policy>
    fetched_pairs(const Policy& policy, const View& both, const std::uint64_t* keys, std::size_t n) : pairs_(n) {
        // Nothing may throw while the keys are being read.
        execution::buffer_of<Policy, whole_pair<View>> gathered(policy, n);
        for_each_index(policy, n, fetch_pair<View>{both, keys, gathered.data()});
        download(policy, gathered.data(), n, pairs_.data());
        for (whole_pair<View>& p : pairs_) {
            bring_over(policy, p.a);
            bring_over(policy, p.b);
        }
    }
    [[nodiscard]] const whole_pair<View>& operator[](std::size_t i) const { return pairs_[i]; }
    [[nodiscard]] const whole_pair<View>* data() const { return pairs_.data(); }

private:
    template <class Policy, class S>
    void bring_over([[maybe_unused]] const Policy& on, [[maybe_unused]] S& shape) {
        if constexpr (refers_to_memory<S> && !std::same_as<space_of<Policy>, host_space>) {
            using point = std::remove_reference_t<decltype(*shape.points)>;
            std::vector<unsigned char>& bytes = referred_.emplace_back((shape.count - 1) * shape.stride + sizeof(point));
            const void* const there = shape.points;
            download(on, static_cast<const unsigned char*>(there), bytes.size(), bytes.data());
            const void* const here = bytes.data();
            shape.points = static_cast<point*>(here);
        }
    }

    std::vector<whole_pair<View>> pairs_;
    std::vector<std::vector<unsigned char>> referred_;
};

/// Resolves on all threads of the host what a device left there, most_pairs at a time, or a few of shapes that refer to
/// memory, and reports what was found from the device.
template <class Policy, class View, class Judge, class Hits>
void resolve_on_host(const Policy& on, const View& both, const Judge& judge, const std::uint64_t* keys, std::size_t n,
                     std::size_t most_pairs, Hits& hits) {
    if constexpr (refers_to_memory<typename View::shape_type_a> || refers_to_memory<typename View::shape_type_b>) {
        most_pairs = std::min<std::size_t>(most_pairs, 64);
    }
    for (std::size_t first = 0; first < n && !execution::is_over(hits); first += most_pairs) {
        const std::size_t some = std::min(n - first, most_pairs);
        const fetched_pairs<View> pairs(on, both, keys + first, some);
        std::vector<unsigned char> touch(some);
        for_each_task(openmp{}, some, resolve_whole<View, Judge>{pairs.data(), judge, touch.data()});
        std::vector<std::uint64_t> found;
        for (std::size_t i = 0; i < some; ++i) {
            if (touch[i] != 0) found.push_back(pairs[i].key);
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
    judged_loops(const Policy& policy, const View& both, const Judge& judge, std::uint64_t most_pairs, Hits& hits)
        : on_(policy), judge_{both, judge, {}}, most_pairs_(std::max<std::size_t>(most_pairs, 1)), hits_(hits) {}

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
        key_judge<View, Judge> judge = judge_;
        judge.part = part;
        execution::capped_queue<std::uint64_t, space_of<Policy>> hard(on_, execution::most_open_at_first);
        const std::uint64_t unfinished = loop(judge, hits_, hard);
        if (hard.pushed() > hard.capacity()) throw std::bad_alloc();
        if (unfinished == 0) {
            return resolve_on_host(on_, judge.both, judge.judge, hard.data(), hard.pushed(), most_pairs_, hits_);
        }
        const auto more = static_cast<std::uint32_t>(2 * unfinished / execution::most_open + 1);
        for (std::uint32_t k = 0; k < more && !is_over(); ++k) {
            run(loop, part.split(k, more));
        }
    }

    const Policy& on_;
    key_judge<View, Judge> judge_;
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
    key_queue<Policy> hits(on, pairing.likely_hits());
    search(on, pairing, judge, hits);
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
