// SPDX-License-Identifier: MIT
#pragma once

// Who runs an algorithm and where its memory lies. A policy comes first in every call and is always given, never guessed.
// `serial` and `openmp` are here; `cuda` is in execution/cuda.hpp, since it needs the CUDA toolkit.
//
// A policy has a small closed set of verbs, free functions found by argument-dependent lookup. Everything above this layer
// is written once on top of them. `on` is the policy, `n` a number of indices, and functors are as their roles ask
// (execution/roles.hpp). Loops run concurrently and in no order. With queues (execution/work_queue.hpp) a loop returns when
// their contents are complete; what a functor leaves in its k-th sink is then in the k-th queue.
//
// These a policy supplies itself:
//
//   for_each_index(on, n, f)                f(i) for every i < n
//   for_each_index(on, n, f, queue...)      f(i, sink...) for every i < n
//
// and, if it works in other memory than the host's:
//
//   upload(on, from, n, to)                 from the caller's host memory to the policy's
//   download(on, from, n, to)               back
//   require_access(on, p, function)         throws if the policy cannot read memory at p
//   require_callable(on, f, args...)        does nothing; does not compile if the policy could not call f(args...)
//   device_of(on)                           the CUDA device that the policy works on; -1 for the host
//   synchronize(on)                         waits for all that was asked of the policy
//   release_memory(on)                      gives pooled memory back to the system
//   for_each_group(on, n, f)                f(group) for all groups of neighbouring indices, 256 or 32 as f says, of which the
//                                           last may have fewer (execution/group.hpp)
//
// These it gets, made of the ones above (execution/generic.hpp; for_each_ordered in host memory alone), and may supply
// better ones:
//
//   concurrency(on)                         about how many indices are worked on at a time; a hint, 1 or more
//   for_each_task(on, n, f)                 for_each_index for work that is long and of uneven length
//   for_each_indirect(on, n, f, queue...)   for_each_index with a number of indices that lies at `n` in the policy's memory,
//                                           where an earlier loop leaves it: the host need not wait to learn it
//   for_each_candidate(on, n, walk, judge, queue...)
//                                           judges all candidates that the walks of every i < n find
//   for_each_descendant(on, expand, judge, queue...)
//                                           judges all candidates that items find, from the seeds down
//   for_each_descendant(on, scheduled, expand, judge, queue...)
//                                           the same by a schedule (execution/schedule.hpp), if the policy has that one
//   for_each_ordered(on, n, walk, best)     walk(i, sink) for every i < n, each by one thread, which decides where it walks:
//                                           nearest first. The sink takes what it finds by sink.offer(value, key), and
//                                           sink.bound(), which shrinks meanwhile, tells what is still worth looking at: all
//                                           that is not above. `best` is of each index or of all (execution/ordered.hpp). A
//                                           walk that takes long says so by its `grain`, how many go together; one that
//                                           can stop where it waits for memory, by in_steps() and pays_in_steps(); and one
//                                           that can take neighbours as one, by in_bundles()
//   for_each_tiled(on, n, m, tile, queue...)
//                                           judges all pairs of n rows and m columns that pass. Rows stream by; columns are
//                                           kept close to the cores, in tiles. What a judge leaves open waits in room of a
//                                           fixed size until it is finished. Where more is left open than finds room, none of
//                                           it is finished; these three return how many that are, and else 0
//   reduce(on, n, init, combine, f)         combine over f(i), returned on the host; init is the identity of combine
//   reduce_into(on, n, out, init, combine, f)  the same, left in the policy's memory at `out`
//   exclusive_scan(on, values, n)           in place over n + 1 values; the last becomes the total
//   sort_keys(on, keys, bits)               unsigned keys below 2^bits in a buffer, ascending
//   sort_by_key(on, keys, values, bits)     the same, stable, carrying values
//   compact(on, n, test, out)               the i with test(i), ascending, to out; returns their number
//   fill(on, out, n, value)                 copies of value
//   copy(on, from, n, to)                   within the policy's memory
//
// reduce, the loops with queues, for_each_ordered with one best of all, compact, download and synchronize wait for the
// result; the others may return before it is there, and so do loops on a device whose first queue is an async_queue.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/execution/roles.hpp>
#include <abut/execution/schedule.hpp>

namespace abut {

/// @defgroup policies Policies and memory
///
/// Who runs a call, and where its memory lies. A policy is the first argument of every call that loops over shapes:
/// `abut::serial`, `abut::openmp`, or `abut::cuda` from `<abut/cuda.hpp>`. It is a small value: copy it, and share it among
/// threads of the host. Results do not depend on it.
///
/// @par Memory
/// `serial` and `openmp` work in host memory, `cuda` in that of its device. What a call returns lies in the policy's memory,
/// unless its type is one of the host's (a number, a vector, a report). Device memory comes from a pool of the library's
/// own, one for each device. It is given back in the order of the stream that it was taken in, so that stream has to outlive
/// the sets, indices and results made in it.
///
/// @par Errors
/// - `cuda_error`: a CUDA call failed. What went wrong in a kernel may be reported by a later call.
/// - `std::bad_alloc`: memory ran out, on the host or on a device.
/// - `capacity_error`: a call under `cuda` needs more memory than `limit_memory` allows.
///
/// `serial` and `openmp` add no errors of their own.
///
/// @par Synchronisation
/// A call that returns a result returns when that is complete: under `cuda` the calling thread waits for the policy's
/// stream, and not for the device. Functions of this group say what they wait for. Streams of different policies are not
/// ordered by the library.
///
/// @par Example
/// @snippet policies.cpp policies
///
/// In a `.cu` file compiled by nvcc:
/// @snippet policies.cu policies
///@{

/// Memory that the host reads and writes.
struct host_space {};
/// Memory of a CUDA device.
struct device_space {};

/// Where memory lies: `host_space` or `device_space`.
template <class S>
concept memory_space = std::same_as<S, host_space> || std::same_as<S, device_space>;

/// The memory in which a policy works.
template <class P>
using space_of = typename std::remove_cvref_t<P>::memory_space;

/// Whether a policy works in this memory.
template <class P, class Space>
concept works_in = std::same_as<space_of<P>, Space>;

/// True for policies that work in host memory.
template <class P>
concept host_policy = works_in<P, host_space>;

///@}

namespace execution {

/// A base for policies outside of this namespace. It is empty: through it calls find the verbs that the policy does not
/// supply itself.
struct policy_base {};

/// Runs on the calling thread. Its name for programs is `abut::serial`.
/// @ingroup policies
struct serial {
    using memory_space = host_space;  ///< host memory
};

/// Runs on OpenMP threads. Compiled without OpenMP it runs on the calling thread, as OpenMP programs do. Its name for
/// programs is `abut::openmp`.
/// @ingroup policies
struct openmp {
    using memory_space = host_space;  ///< host memory
    /// Number of threads; 0 leaves it to the OpenMP runtime. A loop takes one where it has one range of work, and
    /// never more than eight for each processor.
    int threads = 0;
};

template <class T, memory_space Space>
class buffer;
template <memory_space Space>
class work_flag;

/// Has every verb, its own or a default. Asked by execution_policy.
template <class P>
concept has_verbs = requires(const P& on, std::size_t n, const unsigned* from, unsigned* to,
                             buffer<unsigned, space_of<P>>& values, work_flag<space_of<P>>& queue,
                             const archetype::functor& f, const archetype::value& value, const archetype::combine& combine) {
    for_each_index(on, n, f);
    for_each_index(on, n, f, queue);
    for_each_task(on, n, f);
    for_each_indirect(on, from, f, queue);
    for_each_group(on, n, archetype::group_functor{});
    for_each_candidate(on, n, archetype::walk{}, archetype::judge{}, queue);
    for_each_descendant(on, archetype::expander{}, archetype::judge{}, queue);
    for_each_descendant(on, scheduled<schedule::work_stealing>{}, archetype::expander{}, archetype::judge{}, queue);
    for_each_tiled(on, n, n, archetype::tile{}, queue);
    { reduce(on, n, 0u, combine, value) } -> std::same_as<unsigned>;
    reduce_into(on, n, to, 0u, combine, value);
    exclusive_scan(on, to, n);
    sort_keys(on, values, 32);
    sort_by_key(on, values, values, 32);
    { compact(on, n, archetype::test{}, to) } -> std::convertible_to<std::size_t>;
    fill(on, to, n, 0u);
    copy(on, from, n, to);
    upload(on, from, n, to);
    download(on, from, n, to);
    require_access(on, from, "");
    require_callable(on, f, n);
    { device_of(on) } -> std::same_as<int>;
    { concurrency(on) } -> std::same_as<int>;
    synchronize(on);
    release_memory(on);
};

namespace detail {

/// Says in one line what is wrong with a type that means to be a policy.
template <class P>
consteval bool refuse_policy() {
    static_assert(!std::derived_from<P, policy_base>,
                  "abut: this policy lacks a verb: it has to supply for_each_index(on, n, f) and for_each_index(on, n, f, "
                  "queue...), and in other memory than the host's those of memory (execution/policy.hpp)");
    return false;
}

}  // namespace detail

}  // namespace execution

using execution::openmp;
using execution::serial;

/// A policy names the memory it works in and has the verbs above; it is cheap to copy, and any number of host threads may
/// use one policy at a time.
/// @ingroup policies
template <class P>
concept execution_policy = std::copyable<P> && memory_space<typename P::memory_space> &&
    (execution::has_verbs<P> || execution::detail::refuse_policy<P>());

}  // namespace abut
