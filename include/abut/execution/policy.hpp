// SPDX-License-Identifier: MIT
#pragma once

// Who runs an algorithm and where its memory lies. A policy comes first in every call and is always given, never guessed.
// `serial` and `openmp` are here; `cuda` is in execution/cuda.hpp, since it needs the CUDA toolkit.
//
// A policy supplies a small closed set of verbs, found by argument-dependent lookup in abut::execution. Everything above
// this layer is written once on top of them. `on` is the policy, `n` a number of indices, functors are trivially copyable
// and their `operator()` is ABUT_HD:
//
//   for_each_index(on, n, f)                f(i) for every i in [0, n), concurrently
//   for_each_index(on, n, f, queue...)      f(i, sink...): what is pushed into sink k is gathered in queue k, complete, in
//                                           no order (execution/work_queue.hpp); returns when all sizes are known
//   for_each_in_groups(on, n, f, settle, late, queue...)
//                                           indices by groups of group_size neighbours from `first` on, who share an
//                                           F::shared close to the core. One after another: f.prepare(first, k, shared) for
//                                           every k < group_size; f.begin(i, shared, ready, late_sink, sink...) for every i
//                                           of the group; f.step(first, k, shared, ready, late_sink) for every k that these
//                                           two push into `ready`, each k < group_size once at most, and a step pushes one
//                                           at most; f.end(first, k, shared, late_sink) for every k < group_size, and
//                                           f.write(first, t, shared) for every t < F::parts * group_size, neighbours side
//                                           by side. When all groups are done, settle(c, sink...) for every c in `late`.
//                                           Functors that write elsewhere take a `late` with room for all, and counts and
//                                           flags alone: queues that overflow begin anew
//   for_each_in_turns(on, n, f)             such groups again, turn by turn: f.load(first, k, shared) for every
//                                           k < group_size; then for t = 0 ... f.turns(shared) - 1 f.step(t, first, k, shared)
//                                           for every k of the index_range f.of_turn(t, shared), no longer than that of the turn
//                                           before nor than group_size; then f.write(first, k, part, shared) for every
//                                           part < F::parts of every k < group_size, neighbours side by side. The last group,
//                                           which may have fewer indices, gets every k too
//   for_each_candidate(on, n, test, walk, decide, settle, late, queue...)
//                                           for every i with test(i): walk(i, emitter, sink...) calls emitter.push(c) for
//                                           each candidate c, and decide(c, late_sink, sink...) is called for it; or else,
//                                           for want of room, c itself goes to the queue `late`. Then settle(c, sink...)
//                                           for every c in `late`
//   for_each_descendant(on, expand, decide, settle, late, queue...)
//                                           work that makes work: expand(item, emitter) for expand.seed(i),
//                                           i < expand.seeds(), and every item that a call adds by emitter.add(k, item), in
//                                           no order; candidates that it pushes by emitter.push(k, c) are decided, and the
//                                           late settled, as above. Within a call each k < expand.most_children, a constant
//                                           (any number, on the host), is used once at most; an item descends from at most
//                                           expand.most_depth others. On the host alone, expand.prefetch(item) is a hint
//                                           that the item comes soon, and decide.prefetch(c, step), which decide need not
//                                           have, that c does: step 0, and some time later 1
//   for_each_tiled(on, n, m, tile, settle, late, queue...)
//                                           tile(row, i, column, j, late_sink, sink...) for all (i, j) of [0, n) x [0, m)
//                                           with tile.passes(reach, column): row = tile.load_row(i), reach =
//                                           tile.reach_of(row), column = tile.load_column(j). Rows stream by; columns are
//                                           kept close to the cores, in tiles. tile.rows_in_memory() is where rows lie one
//                                           after another, or null. Then settle(c, sink...) for every c in `late`
//   reduce(on, n, init, combine, f)         combine over f(i), returned on the host; combine associates and
//                                           commutes, and init is its identity
//   reduce_into(on, n, out, init, combine, f)  the same, left in the policy's memory at `out`
//   exclusive_scan(on, values, n)           in place over n + 1 values; the last becomes the total
//   sort_keys(on, keys, bits)               unsigned keys below 2^bits in a buffer, ascending
//   sort_by_key(on, keys, values, bits)     the same, stable, carrying values
//   compact(on, n, test, out)               the i with test(i), ascending, to out; returns their number
//   fill(on, out, n, value)                 copies of value
//   upload(on, from, n, to), download(on, from, n, to)   between the caller's host memory and the policy's
//   copy(on, from, n, to)                   within the policy's memory
//   require_access(on, p, function)         throws if the policy cannot read memory at p
//   device_of(on)                           the CUDA device that the policy works on; -1 for host policies
//   synchronize(on)                         waits for all of the above
//   release_memory(on)                      gives pooled memory back to the system
//
// reduce, the loops with queues, compact, download and synchronize wait for the result; the others may return
// before it is there.

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace abut {

/// Memory that the host reads and writes.
struct host_space {};
/// Memory of a CUDA device.
struct device_space {};

template <class S>
concept memory_space = std::same_as<S, host_space> || std::same_as<S, device_space>;

namespace execution {

/// Indices of a group in for_each_in_groups; the last one may have fewer.
inline constexpr unsigned group_size = 256;

/// From `begin` to before `end`.
struct index_range {
    unsigned begin, end;
};

/// Runs on the calling thread.
struct serial {
    using memory_space = host_space;
};

/// Runs on OpenMP threads. Compiled without OpenMP it runs on the calling thread, as OpenMP programs do.
struct openmp {
    using memory_space = host_space;
    int threads = 0;  ///< number of threads; 0 leaves it to the OpenMP runtime
};

}  // namespace execution

using execution::openmp;
using execution::serial;

/// A policy names the memory it works in and supplies the verbs above; it is cheap to copy, and any number of host threads
/// may use one policy at a time.
template <class P>
concept execution_policy = std::copyable<P> && memory_space<typename P::memory_space> && requires(const P& on) {
    synchronize(on);
    release_memory(on);
};

template <class P>
using space_of = typename std::remove_cvref_t<P>::memory_space;

/// True for policies that work in host memory.
template <class P>
concept host_policy = std::same_as<space_of<P>, host_space>;

}  // namespace abut
