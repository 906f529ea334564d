// SPDX-License-Identifier: MIT
#pragma once

// Who does what of work that makes work (for_each_descendant, execution/policy.hpp): schedules, what they take, and what
// they report of themselves. They move speed, never results.

#include <cstdint>

namespace abut {

/// @addtogroup queries
///@{

/// How blocks of a device, or threads of a host, share out work of which nobody knows how much will come of it: pairs of
/// nodes of two trees that are walked down together. docs/hierarchies.md says which policy has which.
enum class schedule : unsigned char {
    /// Each works on what it has, and fetches from one list that all share when that runs out. After a few steps all that
    /// blocks hold goes back to such a list, once (cuda_expand.hpp). On a host the list holds the first levels (host.hpp).
    shared_list,
    /// Each has a queue of its own, and nobody fetches. When enough of them have nothing, a round ends, a kernel deals
    /// everything out evenly, and the next round begins (Lauterbach, Mo and Manocha 2010; cuda_partition.hpp).
    static_partition,
    /// Each has a deque, in which all lies that it has. It takes from the bottom, and where its own is empty it steals from
    /// the top of another's (Arora, Blumofe and Plaxton 1998; Cederman and Tsigas 2009; host_stealing.hpp). On a device for
    /// comparisons: <abut/experimental/cuda_work_stealing.hpp>.
    work_stealing,
    /// The same in three levels: a stack in shared memory, the block's deque for what is too much for that, and what it has
    /// stolen from many deques at once, which stays where it lies until it is needed (da Silva 2013; cuda_stealing.hpp).
    lazy_work_stealing
};

/// What a schedule did in the last loop that it ran. A field that says nothing about a schedule is 0.
struct schedule_report {
    schedule ran = schedule::shared_list;  ///< where a policy lacks the one that was asked for, this is not that one
    std::uint64_t workers = 0;             ///< blocks of a device, threads of a host
    std::uint64_t steps = 0;               ///< of all workers; in a step a block takes up to 256 items, a thread up to 32
    std::uint64_t items = 0;               ///< that were expanded; where a block found the end early, not all
    std::uint64_t steals = 0;              ///< times that a worker took something from another's deque
    std::uint64_t stolen = 0;              ///< items in those
    std::uint64_t failed_steals = 0;       ///< times that it looked in other deques and came back with nothing
    std::uint64_t offers = 0;              ///< times that a worker put items where others could take them
    std::uint64_t transfers = 0;           ///< lazily stolen: times that some of it came to a block's stack
    /// Items in those; of the shared list and the static partition, items that went from one kernel to the next.
    std::uint64_t transferred = 0;
    std::uint64_t overflows = 0;           ///< times that a queue had no room, so that a worker kept what it had
    std::uint64_t rounds = 0;              ///< launches of the kernel that expands
    std::uint64_t balances = 0;            ///< launches of the kernel that deals out evenly
    /// How much of the workers' time went by without work. Of stealing blocks, in cycles, from a worker's beginning to its
    /// end; of threads, in turns of looking for work; of a static partition, in steps that a block could have done until the
    /// busiest of the round was done. Of the shared list it is not measured, and negative.
    double idle_share = -1;
};

/// What a schedule takes. The defaults are for use; other values are for measurements and tests.
struct schedule_options {
    /// Blocks on a device; 0, or more than it holds at a time: as many as it holds. A host takes no notice.
    std::uint32_t most_blocks = 0;
    /// Items, some 8 bytes each, that a worker's queue has room for outside of its own memory; 0: 4096, or of a static
    /// partition on a device what fits into a block's shared memory. A queue that is full costs speed and drops nothing: who
    /// cannot put items there keeps them, and goes deep before it goes wide. A static partition makes room for all seeds.
    std::uint32_t queue_capacity = 0;
    /// Where to put what the last loop did; null: nowhere. In the host's memory, written before the query returns.
    schedule_report* report = nullptr;
};

///@}

namespace execution {

/// A schedule as an argument of for_each_descendant, so that only what is asked for is compiled.
template <schedule Schedule>
struct scheduled : schedule_options {};

}  // namespace execution

}  // namespace abut
