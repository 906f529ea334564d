// SPDX-License-Identifier: MIT
#pragma once

// Groups of neighbouring indices whose members share memory close to the core (the verb for_each_group): the threads of a
// block on a device, a loop on a host. A functor is written once for both: it says what each member does, and every such
// step ends at a barrier.

#include <cstddef>

#include <abut/config.hpp>

namespace abut::execution {

/// Members of a group.
inline constexpr unsigned group_size = 256;
/// Members of the part of a group for which a barrier costs least: a warp.
inline constexpr unsigned subgroup_size = 32;

/// Part of a group, for steps of few members (group::in_subgroup).
class subgroup {
public:
    /// As group::each.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD void each(unsigned begin, unsigned end, const F& f) const {
#if ABUT_DEVICE_CODE
        for (unsigned k = begin + threadIdx.x; k < end; k += subgroup_size) f(k);
        __syncwarp();
#else
        for (unsigned k = begin; k < end; ++k) f(k);
#endif
    }
    /// As group::count, of no more than subgroup_size numbers.
    ABUT_CALLS_ANY
    template <class F>
    [[nodiscard]] ABUT_HD unsigned count(unsigned begin, unsigned end, const F& f) const {
#if ABUT_DEVICE_CODE
        const unsigned k = begin + threadIdx.x, lanes = __ballot_sync(0xffffffff, k < end && f(k));
        __syncwarp();
        return static_cast<unsigned>(__popc(lanes));
#else
        unsigned sum = 0;
        for (unsigned k = begin; k < end; ++k) sum += static_cast<unsigned>(f(k));
        return sum;
#endif
    }
};

/// What a functor of for_each_group is called with. All members run the functor together, so what stands outside of these
/// calls has to be the same for all: it may read what an earlier call has left in `shared`, if no later call changes that,
/// and it writes nothing. The last group may have fewer indices, and yet has group_size members.
template <class Shared>
class group {
public:
    std::size_t first;  ///< the index of member 0
    Shared& shared;     ///< of unspecified value at the start

    ABUT_HD group(std::size_t index, Shared& memory) : first(index), shared(memory) {}

    /// f(k) for every k in [begin, end), concurrently and in no order; then a barrier: later calls see what f wrote.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD void each(unsigned begin, unsigned end, const F& f) const {
#if ABUT_DEVICE_CODE
        for (unsigned k = begin + threadIdx.x; k < end; k += group_size) f(k);
        __syncthreads();
#else
        for (unsigned k = begin; k < end; ++k) f(k);
#endif
    }
    /// f(k) for every member.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD void each(const F& f) const {
        each(0, group_size, f);
    }
    /// As `each`, and returns for how many of these k f(k) is true. The barrier adds them up. end - begin <= group_size.
    ABUT_CALLS_ANY
    template <class F>
    [[nodiscard]] ABUT_HD unsigned count(unsigned begin, unsigned end, const F& f) const {
#if ABUT_DEVICE_CODE
        const unsigned k = begin + threadIdx.x;
        return static_cast<unsigned>(__syncthreads_count(k < end && f(k)));
#else
        return subgroup{}.count(begin, end, f);
#endif
    }
    /// body(subgroup), run by subgroup_size members, while the others wait.
    ABUT_CALLS_ANY
    template <class Body>
    ABUT_HD void in_subgroup(const Body& body) const {
#if ABUT_DEVICE_CODE
        if (threadIdx.x < subgroup_size) body(subgroup{});
        __syncthreads();
#else
        body(subgroup{});
#endif
    }
};

}  // namespace abut::execution
