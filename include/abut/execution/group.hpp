// SPDX-License-Identifier: MIT
#pragma once

// Groups of neighbouring indices whose members share memory close to the core (the verb for_each_group): the threads of a
// block or of a warp on a device, a loop on a host. A functor is written once for both: it says what each member does, and
// every such step ends at a barrier.

#include <cstddef>
#include <cstdint>

#include <abut/config.hpp>

namespace abut::execution {

/// Members of a group, if its functor does not say otherwise.
inline constexpr unsigned group_size = 256;
/// Members of the part of a group for which a barrier costs least: a warp. A functor may ask for groups of that size.
inline constexpr unsigned subgroup_size = 32;

/// Of a functor: F::members, where it has that.
template <class F>
inline constexpr unsigned group_size_of = group_size;
template <class F>
    requires requires { F::members + 0u; }
inline constexpr unsigned group_size_of<F> = F::members;

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
/// and it writes nothing but numbers that are the same for all. The last group may have fewer indices, and yet has all
/// members.
template <class Shared, unsigned Size = group_size>
class group {
    static_assert(Size == group_size || Size == subgroup_size);

public:
    std::size_t first;  ///< the index of member 0
    Shared& shared;     ///< of unspecified value at the start

    ABUT_HD group(std::size_t index, Shared& memory) : first(index), shared(memory) {}

    /// f(k) for every k in [begin, end), concurrently and in no order; then a barrier: later calls see what f wrote.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD void each(unsigned begin, unsigned end, const F& f) const {
#if ABUT_DEVICE_CODE
        for (unsigned k = begin + threadIdx.x % Size; k < end; k += Size) f(k);
        wait();
#else
        for (unsigned k = begin; k < end; ++k) f(k);
#endif
    }
    /// f(k) for every member.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD void each(const F& f) const {
        each(0, Size, f);
    }

    /// One T for each member, in registers on a device. Member k alone uses number k.
    template <class T>
    class value {
    public:
        ABUT_HD T& operator[]([[maybe_unused]] unsigned k) {
#if ABUT_DEVICE_CODE
            return of_;
#else
            return of_[k];
#endif
        }

    private:
#if ABUT_DEVICE_CODE
        T of_;
#else
        T of_[Size];
#endif
    };
    /// As `each`, and returns for how many of these k f(k) is true. The barrier adds them up. end - begin <= group_size.
    ABUT_CALLS_ANY
    template <class F>
        requires(Size == group_size)
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
        requires(Size == group_size)
    ABUT_HD void in_subgroup(const Body& body) const {
#if ABUT_DEVICE_CODE
        if (threadIdx.x < subgroup_size) body(subgroup{});
        __syncthreads();
#else
        body(subgroup{});
#endif
    }

    /// Called by all members in one step: put(number) by those for which `is` is true, with the numbers from `count` on, in
    /// the order of the members. `count` goes on by how many these are, and is the same for all when the step ends; within
    /// the step nothing else may read it.
    ABUT_CALLS_ANY
    template <class Put>
        requires(Size == subgroup_size)
    ABUT_HD void append(unsigned& count, bool is, const Put& put) const {
#if ABUT_DEVICE_CODE
        const unsigned those = __ballot_sync(0xffffffff, is);
        if (is) put(count + static_cast<unsigned>(__popc(those & ~(~0u << threadIdx.x % Size))));
        count += static_cast<unsigned>(__popc(those));
#else
        if (is) put(count++);
#endif
    }
    /// The same for each bit that is set in a member's word: put(number, bit). A host goes member by member. On a device the
    /// lowest bits of all members come first, then the second ones, and so on.
    ABUT_CALLS_ANY
    template <class Put>
        requires(Size == subgroup_size)
    ABUT_HD void append_bits(unsigned& count, std::uint32_t word, const Put& put) const {
#if ABUT_DEVICE_CODE
        for (;;) {
            const unsigned before = count;
            append(count, word != 0,
                   [&](unsigned at) { put(at, static_cast<unsigned>(__ffs(static_cast<int>(word))) - 1); });
            if (count == before) break;
            word &= word - 1;
        }
#else
        for (; word != 0; word &= word - 1) put(count++, static_cast<unsigned>(ABUT_LOWEST_BIT(word)));
#endif
    }
    /// The least of f(k) for every member, known to all.
    ABUT_CALLS_ANY
    template <class F>
        requires(Size == subgroup_size)
    [[nodiscard]] ABUT_HD auto least(const F& f) const {
#if ABUT_DEVICE_CODE
        auto x = f(threadIdx.x % Size);
        for (unsigned away = Size / 2; away > 0; away /= 2) {
            const auto other = __shfl_xor_sync(0xffffffff, x, static_cast<int>(away));
            x = other < x ? other : x;
        }
#else
        auto x = f(0u);
        for (unsigned k = 1; k < Size; ++k) {
            const auto other = f(k);
            x = other < x ? other : x;
        }
#endif
        return x;
    }

private:
    ABUT_HD static void wait() {
#if ABUT_DEVICE_CODE
        if constexpr (Size == subgroup_size) {
            __syncwarp();
        } else {
            __syncthreads();
        }
#endif
    }
};

}  // namespace abut::execution
