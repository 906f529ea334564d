// SPDX-License-Identifier: MIT
#pragma once

// A stream as who answers questions about pairs (question.hpp): a call puts its work there and returns. The engine is
// that of the calls that wait (search.hpp). What differs is the room: here it has a fixed size, which the caller gives, and
// counts stay on the device. Where that is not enough, a state says so, and `wait` mends it or throws. For policies that
// work on a device.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/contacts.hpp>
#include <abut/collide/query.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut {

/// @defgroup async Queries without a wait
///
/// `any_async`, `count_async`, `pairs_async` and `contacts_async` put a query into the stream of a `cuda` policy and return
/// before it has run. What it finds goes into an `async_result` or an `async_value`, which the caller makes beforehand.
/// Kernels that come later in the stream may read it there. `wait` gives what the call without `_async` returns, bit for
/// bit.
///
/// @par Memory
/// Arguments lie on the policy's device: sets, views, single shapes, and indices. A set in host memory does not compile;
/// `copy_to` brings it over. Both results own device memory of a fixed size. Each call takes memory for its own use in the
/// order of the stream, and gives it back so: 8 bytes for each pair that may be left open (see async_result), of impacts 16; some
/// 17 MB for two trees; and to make a list 16 bytes for each pair of its capacity, somewhat more where it sorts.
///
/// @par What has to live
/// Until the stream has done the work, and until `wait` where that is called: the result, and what a view or a filter points
/// to. The result keeps the sets and indices of the last call that it was given to, and no async_index. Those that were made in another stream
/// are given back in that one, so keep them until the work is done. Elements may change when the work is done, and not
/// before; `wait` looks at them again if the state says `undecided`.
///
/// @par Graphs
/// All four calls may be captured into a CUDA graph. Each launch of it asks again, about what then lies in the memory of the
/// views. Before the capture, make the results and ask the same once: kernels are loaded by their first call, and the box
/// around a tree is read by the first call with a pose. A call's own memory is the graph's then, and no launch after the
/// first takes more from the system. CUDA lets such a graph have one executable at a time. `wait` cannot be captured.
///
/// @par What is not looked at
/// A call that waits looks at the elements of views, and at placed coordinates. These calls do not. Numbers in a view have
/// to be finite, radii not negative, faces have to name vertices that are there, and a pose must not make coordinates
/// overflow: the answer means nothing otherwise, and a face may read memory that is not there. Sets were checked when they
/// were made.
///
/// @par What there is not
/// Lists of posed pairs, bodies, visitors, queries by row but `nearest` (float), `raycast` and `raycast_any`, impacts of meshes
/// without an index, grids under a pose, `breadth_first`, `from_front`, `static_partition`, a `schedule_report`, and
/// `discard_sideways`. The last two throw, the others do not compile.
///
/// @par Errors
/// - `error`: a result, a set or an index lies on another device; `start_depth` is out of range; or a report or
///   `discard_sideways` is asked for.
/// - `invalid_geometry`: a pose is no rotation, or a single shape is none.
/// - `capacity_error`: a view has 2^31 elements or more. `wait` throws it where more was found than there is room for.
/// - `std::bad_alloc`, `cuda_error`. What goes wrong in a kernel is reported by a later call.
///
/// @par Synchronisation
/// The four calls do not wait for the stream, but the first one of a tree with a pose, which reads a box. Loading a kernel
/// may wait for the whole device. `wait` and `read_state` wait for the policy's stream.
///
/// @par Example
/// @snippet async.cu async
///@{

/// What is known of a list when the stream has made it; read by `read_state`, or on the device.
struct async_state {
    /// Elements that the list has: no more than its capacity.
    std::uint64_t size = 0;
    /// Elements that were found. Where this is more than the capacity, the rest is missing: ask again with that much room.
    std::uint64_t needed = 0;
    /// Pairs of which the device does not know whether they touch. Neither size nor needed counts them. If they are more
    /// than the capacity for open pairs, that was too small. If not, their coordinates are more than 2^124 apart in one
    /// pair, which is for the host to decide. `wait` gives the whole answer in both cases.
    std::uint64_t undecided = 0;
};

/// What is known of a number or a truth value when the stream has made it. Of a safe step `value` is never late: what is
/// undecided has a bound in its place, and where candidates found no room it is 0.
template <class T>
    requires(std::same_as<T, bool> || std::same_as<T, std::uint64_t> || std::same_as<T, double>)
struct async_value_state {
    T value{};                    ///< the answer if nothing is undecided; otherwise no more than that
    std::uint64_t undecided = 0;  ///< as of async_state; 0 where `value` is true
};

template <class T, memory_space Space>
class async_result;
template <class T, memory_space Space>
class async_value;

namespace detail {

/// What the outcomes of asynchronous calls have in common. The counters are of a loop (execution/work_queue.hpp) with three
/// queues: pairs left open, hits, and what is left for the host.
template <class State, class Answer, memory_space Space>
struct async_room {
    static constexpr std::size_t queues = 3;
    execution::buffer<std::uint64_t, Space> counters;
    execution::buffer<State, Space> state;
    std::uint64_t open_capacity;
    std::function<Answer()> again;  ///< the same query by a call that waits

    template <class Policy>
    async_room(const Policy& policy, std::uint64_t most_open)
        : counters(policy, 2 * queues + 1), state(policy, 1), open_capacity(most_open) {
        fill(policy, state.data(), 1, State{});
    }
    [[nodiscard]] std::uint64_t* counts() { return counters.data() + queues + 1; }

    /// The state. Waits for the stream.
    template <class Policy>
    [[nodiscard]] State read(const Policy& on) const {
        State now;
        download(on, state.data(), 1, &now);
        return now;
    }
};

/// As `search`, but that nobody waits: leaves counts in the room.
template <class Policy, class Pairing, class Judge, class Queue, class Room>
void search_async(const Policy& on, const Pairing& pairing, const Judge& judge, const Queue& hits, Room& room) {
    using view = typename Pairing::view_type;
    static_assert(pair_judge<Judge, typename view::shape_type_a, typename view::shape_type_b>,
                  "abut: search: the judge is no pair_judge (collide/judge.hpp) of these shapes");
    const view both = pairing.view();
    const std::uint64_t all = std::uint64_t{both.a.size()} * both.b.size();
    execution::buffer_of<Policy, std::uint64_t> open(on, std::min(room.open_capacity, all));
    fill(on, room.counters.data(), room.counters.size(), std::uint64_t{0});
    execution::async_queue<Queue> found{hits, {room.counters.data(), room.counts(), open.data(), open.size()}};
    execution::capped_queue<std::uint64_t, space_of<Policy>> hard(static_cast<std::uint64_t*>(nullptr), 0);
    const key_judge<view, Judge> decide{both, judge, {}};
    pairing.judge_candidates(on, [&](const auto& loop) { loop(decide, found, hard); });
}

/// Of the counts of a loop: pairs that were not decided.
ABUT_HD inline std::uint64_t undecided_of(const std::uint64_t* counts, std::uint64_t open_capacity) {
    return counts[0] > open_capacity ? counts[0] : counts[2];
}

struct write_list_state {
    const std::uint64_t* counts;
    std::uint64_t capacity, open_capacity;
    async_state* out;
    ABUT_HD void operator()(std::size_t) const {
        const std::uint64_t found = counts[1];
        *out = {found < capacity ? found : capacity, found, undecided_of(counts, open_capacity)};
    }
};

template <class T>
struct write_value_state {
    const std::uint64_t* counts;
    std::uint64_t open_capacity;
    async_value_state<T>* out;
    ABUT_HD void operator()(std::size_t) const {
        const T value = static_cast<T>(counts[1]);
        const bool is_known = std::same_as<T, bool> && value;
        *out = {value, is_known ? 0 : undecided_of(counts, open_capacity)};
    }
};

/// The answers to as many keys as there are.
template <class View, class Judge, class Answer>
struct answer_found {
    answer_key<View, Judge, Answer> answer;
    const async_state* state;
    ABUT_HD void operator()(std::size_t i) const {
        if (i < state->size) answer(i);
    }
};

/// Candidates that a result of this type lets wait by itself.
template <class T>
inline constexpr std::uint64_t most_open_of = execution::most_open_at_first;
template <>
inline constexpr std::uint64_t most_open_of<double> = std::uint64_t{1} << 23;

/// Throws where a result lies on another device.
template <class Policy, class Outcome>
void check_outcome(const Policy& on, const Outcome& into, const std::string& function) {
    if (into.device() == device_of(on)) return;
    throw error(function + ": the result lies on device " + std::to_string(into.device()) + ", the policy works on device " +
                std::to_string(device_of(on)));
}

/// What results let queries reach.
struct async_parts {
    template <class Outcome>
    static auto& room(Outcome& outcome) {
        return outcome.room_;
    }
    template <class Outcome>
    static auto* items(Outcome& outcome) {
        return outcome.items_.data();
    }
};

template <class Policy, class Pairing, class Judge, class T>
void list_async(const Policy& on, const Pairing& pairing, const Judge& judge, async_result<T, space_of<Policy>>& into) {
    using view = typename Pairing::view_type;
    auto& room = async_parts::room(into);
    const std::size_t capacity = into.capacity();
    const int bits = std::max(pairing.key.bits(), 1);
    execution::buffer_of<Policy, std::uint64_t> keys(on, capacity);
    // Places that stay empty hold the largest key: behind the keys that were found, or equal to the last of them.
    if (pairing.options.sorted) fill(on, keys.data(), capacity, (std::uint64_t{1} << bits) - 1);
    const execution::capped_queue<std::uint64_t, space_of<Policy>> hits(keys.data(), capacity);
    search_async(on, pairing, judge, hits, room);
    if (pairing.options.sorted) sort_keys(on, keys, bits);
    async_state* const state = room.state.data();
    for_each_index(on, 1, write_list_state{room.counts(), capacity, room.open_capacity, state});
    const answer_key<view, Judge, T> answer{pairing.view(), judge, keys.data(), async_parts::items(into)};
    for_each_index(on, capacity, answer_found<view, Judge, T>{answer, state});
}

/// Whether a call that does not wait takes an argument that a call takes which waits.
template <class Policy, class X>
consteval bool can_be_asked_async() {
    if constexpr (is_posed<X>) {
        using object = decltype(X::object);
        if constexpr (is_index<object>) {
            constexpr bool is_tree = indexed_operand<object>::has_tree;
            static_assert(is_tree, "abut: a grid under a pose is for calls that wait: make a tree of the set, or place it");
            return is_tree;
        } else {
            return can_be_asked_async<Policy, object>();
        }
    } else if constexpr (shape<X> || is_index<X>) {
        return true;
    } else {
        constexpr bool there = std::same_as<typename X::memory_space, space_of<Policy>>;
        static_assert(there,
                      "abut: a call that does not wait takes sets that lie on the device: copy_to(policy, set) first");
        return there;
    }
}
/// Whether it takes the arguments: two, or one that is asked about alone.
template <class Form>
inline constexpr bool has_async = false;
template <class X, class Y>
inline constexpr bool has_async<two<X, Y>> = true;
template <class X>
inline constexpr bool has_async<alone<X>> = true;
template <class Policy, class X, class Y>
consteval bool are_asked_async(std::type_identity<two<X, Y>>) {
    constexpr bool x = can_be_asked_async<Policy, X>(), y = can_be_asked_async<Policy, Y>();
    return x && y;
}
template <class Policy, class X>
consteval bool are_asked_async(std::type_identity<alone<X>>) {
    return can_be_asked_async<Policy, X>();
}
template <class Options>
inline constexpr bool is_one_loop = false;
template <class Filter, traversal Traversal, schedule Schedule>
inline constexpr bool is_one_loop<query_options<Filter, Traversal, Schedule>> =
    Traversal != traversal::breadth_first && Traversal != traversal::from_front && Schedule != schedule::static_partition;
/// Whether a policy has a stream.
template <class Policy>
consteval bool has_stream() {
    constexpr bool on_device = !host_policy<Policy>;
    static_assert(on_device, "abut: calls that do not wait are for cuda; a host's policy has nothing to wait for");
    return on_device;
}
template <class Policy, class Question, class Form, class Options>
consteval bool can_ask_async() {
    constexpr bool on_device = has_stream<Policy>();
    constexpr bool has_form = has_async<Form> && Question::kind != answer_kind::visits;
    static_assert(has_form, "abut: lists, bodies and visitors need the host between their kernels: they are for calls that wait");
    static_assert(!has_form || is_one_loop<Options>,
                  "abut: breadth_first, from_front and static_partition need the host between their kernels: they "
                  "are for calls that wait");
    if constexpr (on_device && has_form && is_one_loop<Options>) {
        if constexpr (Form::template can_be_asked<Policy, Question, decltype(Options::filter)>()) {
            return are_asked_async<Policy>(std::type_identity<Form>{});
        }
    }
    return false;
}

}  // namespace detail

/// A list that a stream makes: elements of a fixed capacity and their state, in device memory. Movable, not copyable. One
/// call at a time may use it; calls in one stream come one after another.
template <class T, memory_space Space = device_space>
class async_result {
public:
    using value_type = T;        ///< index_pair, contact, impact, neighbor, ray_hit, std::uint8_t
    using memory_space = Space;  ///< where they lie

    /// Room for `capacity` elements, taken in the order of the policy's stream, which has to outlive it. Not within a
    /// capture. A query may leave `open_capacity` pairs open until a second kernel finishes them: those that its first try
    /// in floating point cannot decide. By itself 2^21; docs/results/trade.md says how many they are. Of impacts these are the
    /// candidates, pairs of features whose boxes meet, by itself 2^23. Does not wait. Throws std::bad_alloc, cuda_error.
    template <works_in<Space> Policy>
    async_result(const Policy& policy, std::size_t capacity, std::uint64_t open_capacity = detail::most_open_of<T>)
        : items_(policy, capacity), room_(policy, open_capacity) {}

    /// Elements that there is room for.
    [[nodiscard]] std::size_t capacity() const { return items_.size(); }
    /// The first element, in device memory. How many of them there are, and whether that is all, is at `state()`.
    [[nodiscard]] const T* data() const { return items_.data(); }
    /// In device memory; each call writes it, as it writes the elements.
    [[nodiscard]] const async_state* state() const { return room_.state.data(); }
    /// The CUDA device.
    [[nodiscard]] int device() const { return room_.state.device(); }

private:
    friend detail::async_parts;

    execution::buffer<T, Space> items_;
    detail::async_room<async_state, result<T, Space>, Space> room_;
};

/// A number or a truth value that a stream makes, `std::uint64_t`, `bool`, or `double` of a safe step: its state alone, in
/// device memory. Movable, not copyable. One call at a time may use it.
template <class T, memory_space Space = device_space>
class async_value {
public:
    using value_type = T;        ///< bool, std::uint64_t or double
    using memory_space = Space;  ///< where it lies

    /// Taken in the order of the policy's stream, which has to outlive it. Not within a capture. `open_capacity` is that of
    /// async_result. Does not wait. Throws std::bad_alloc, cuda_error.
    template <works_in<Space> Policy>
    explicit async_value(const Policy& policy, std::uint64_t open_capacity = detail::most_open_of<T>)
        : room_(policy, open_capacity) {}

    /// In device memory.
    [[nodiscard]] const async_value_state<T>* state() const { return room_.state.data(); }
    /// The CUDA device.
    [[nodiscard]] int device() const { return room_.state.device(); }

private:
    friend detail::async_parts;

    detail::async_room<async_value_state<T>, T, Space> room_;
};

/// A policy's stream as who answers a query, and where it leaves its outcome there: an `async_value` of `bool` for `any` and
/// the like, of `std::uint64_t` for numbers, an `async_result` for lists. The query returns nothing, and does not wait.
/// Queries of pairs of two arguments, or of one alone, take it: any, count, pairs, contacts, within, self_pairs and the others
/// of these: `abut::within(abut::async(on, near), a, b, 0.01)`, where `near` is an `async_result<index_pair>`. So do impacts and
/// first_impact of impact indices, with an `async_result` of `impact` (the first is a list of one, or of none); safe_step, with
/// an `async_value<double>`; nearest, raycast and raycast_any, with an `async_result` of what they answer and room for each row;
/// and their like within one mesh. `refit` takes it with an async_index. Both have to live as long as the call.
template <execution_policy Policy, class Outcome>
class async {
public:
    /// Refers to both.
    async(const Policy& policy, Outcome& into) : on_(policy), into_(into) {}
    /// The policy.
    [[nodiscard]] const Policy& policy() const { return on_; }
    /// Where the outcome goes.
    [[nodiscard]] Outcome& into() const { return into_; }

private:
    const Policy& on_;
    Outcome& into_;
};

namespace detail {

template <class Policy, class Outcome>
inline constexpr bool is_async<async<Policy, Outcome>> = true;

template <class Policy, class Outcome, class Each, class Form, class Options>
void ask_entries(const async<Policy, Outcome>&, const Each&, const Form&, const Options&, const char*) {
    static_assert(sizeof(Form) == 0, "abut: lists need the host between their kernels: they are for calls that wait");
}
template <class Policy, class Outcome, class Question, class Form, class Options>
void ask_pairs(const async<Policy, Outcome>& stream, const Question& question, const Form& form, const Options& options,
               const char* function) {
    if constexpr (can_ask_async<Policy, Question, Form, Options>()) {
        using A = typename Question::arithmetic_type;
        using T = typename Outcome::value_type;
        const Policy& on = stream.policy();
        Outcome& into = stream.into();
        const std::string name = std::string(function) + "_async";
        question.relation.check(name.c_str());
        if (options.scheduling.report != nullptr) throw error(name + ": a schedule reports to calls that wait");
        if constexpr (requires { question.answer.discard_sideways; }) {
            if (question.answer.discard_sideways) throw error(name + ": contacts are discarded by calls that wait");
        }
        check_outcome(on, into, name);
        const auto pairing = form.template pair_up<input::trusted>(on, question.relation, options, false, name.c_str());
        auto& room = async_parts::room(into);
        room.again = [on, pairing, question] { return question.find(on, pairing); };
        if constexpr (Question::kind == answer_kind::list) {
            const auto judge = question.answer.template judge<A>(question.relation);
            using found = decltype(judge.answer(pairing.view(), std::uint64_t{}));
            static_assert(std::same_as<T, found>,
                          "abut: the result is of another type than what is asked for: contacts are of the scalar type of "
                          "their shapes, float or double");
            list_async(on, pairing, judge, into);
        } else {
            using queue = std::conditional_t<std::same_as<T, bool>, execution::work_flag<space_of<Policy>>,
                                             execution::work_count<space_of<Policy>>>;
            search_async(on, pairing, question.relation.template judge<A>(), queue(on), room);
            for_each_index(on, 1, write_value_state<T>{room.counts(), room.open_capacity, room.state.data()});
        }
    }
}

}  // namespace detail

/// `any` in the stream: any(async(on, into), a, b, options).
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void any_async(const Policy& on, const X& a, const Y& b, async_value<bool, space_of<Policy>>& into,
               const query_options<Filter, Traversal, Schedule>& options = {}) {
    any<A>(async(on, into), a, b, options);
}

/// `count` in the stream: the number of pairs that touch and that the filter wants.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void count_async(const Policy& on, const X& a, const Y& b, async_value<std::uint64_t, space_of<Policy>>& into,
                 const query_options<Filter, Traversal, Schedule>& options = {}) {
    count<A>(async(on, into), a, b, options);
}

/// `pairs` in the stream: the pairs that touch, sorted by a, then b, unless the options say otherwise. Where there is not
/// room for all, those that are there are any of them. A sort takes as long as that of a full list: choose the capacity with
/// care.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void pairs_async(const Policy& on, const X& a, const Y& b, async_result<index_pair, space_of<Policy>>& into,
                 const query_options<Filter, Traversal, Schedule>& options = {}) {
    pairs<A>(async(on, into), a, b, options);
}

/// `contacts` in the stream: those of the pairs of `pairs_async`, in their order. `T` is the scalar of the arguments.
/// Options are those of `contacts`, without `discard_sideways`.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, scalar T, class Filter = keep_all>
void contacts_async(const Policy& on, const X& a, const Y& b, async_result<contact<T>, space_of<Policy>>& into,
                    const contact_options<Filter>& options = {}) {
    contacts<A>(async(on, into), a, b, options);
}

/// The state as it is when the policy's stream has done its work. Waits for that. Throws cuda_error.
///@{
template <execution_policy Policy, class T>
[[nodiscard]] async_state read_state(const Policy& on, const async_result<T, space_of<Policy>>& from) {
    return detail::async_parts::room(from).read(on);
}
template <execution_policy Policy, class T>
[[nodiscard]] async_value_state<T> read_state(const Policy& on, const async_value<T, space_of<Policy>>& from) {
    return detail::async_parts::room(from).read(on);
}
///@}

/// The whole answer of the last call, as `pairs` or `contacts` would give it: a copy in the policy's memory. Waits for the
/// policy's stream. Pairs that the device left undecided are decided now, by asking again with a call that waits, in the
/// stream of the last call. Throws capacity_error, with the number that was found, where there was not room for all; error
/// where no call was made; std::bad_alloc, cuda_error.
template <execution_policy Policy, class T>
[[nodiscard]] result<T, space_of<Policy>> wait(const Policy& on, const async_result<T, space_of<Policy>>& from) {
    const auto& room = detail::async_parts::room(from);
    if (!room.again) throw error("abut::wait: nothing was asked");
    const async_state state = room.read(on);
    const auto require_room = [&](std::uint64_t needed) {
        if (needed <= from.capacity()) return;
        throw capacity_error("abut::wait: " + std::to_string(needed) + " elements were found; there is room for " +
                             std::to_string(from.capacity()));
    };
    if (state.undecided > 0) {
        auto all = room.again();
        require_room(all.size());
        return all;
    }
    require_room(state.needed);
    execution::buffer_of<Policy, T> all(on, state.size);
    copy(on, from.data(), state.size, all.data());
    synchronize(on);
    return result<T, space_of<Policy>>(std::move(all));
}

/// The answer of the last call, as `any` or `count` would give it. Waits for the policy's stream, and decides what was left
/// undecided, as above. Throws error where no call was made; std::bad_alloc, cuda_error.
template <execution_policy Policy, class T>
[[nodiscard]] T wait(const Policy& on, const async_value<T, space_of<Policy>>& from) {
    const auto& room = detail::async_parts::room(from);
    if (!room.again) throw error("abut::wait: nothing was asked");
    const auto state = room.read(on);
    return state.undecided > 0 ? room.again() : state.value;
}

///@}

}  // namespace abut
