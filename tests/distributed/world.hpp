// SPDX-License-Identifier: MIT
#pragma once

// The ranks that run a test together, and how they divide sets and bring lists together. All ranks run the same cases and
// compare the same lists, so a check fails on all of them or on none, and no rank waits for one that left.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <mpi.h>

#include <abut/mpi.hpp>

#include "support/catch.hpp"

namespace abut::test {

/// MPI is initialised by the first case and finalised at exit.
inline MPI_Comm world() {
    int is = 0;
    MPI_Initialized(&is);
    if (is == 0) {
        MPI_Init(nullptr, nullptr);
        std::atexit([] { MPI_Finalize(); });
    }
    return MPI_COMM_WORLD;
}

/// Where ranks' parts begin: `cut(rank)` of `n` shapes, ascending, from 0 to n.
enum class division { even, all_on_first, all_on_last, uneven };
inline constexpr division divisions[] = {division::even, division::all_on_first, division::all_on_last, division::uneven};

inline std::size_t cut(division how, std::size_t n, int rank, int ranks) {
    const auto r = static_cast<std::size_t>(rank), p = static_cast<std::size_t>(ranks);
    if (r == 0) return 0;
    if (r == p) return n;
    switch (how) {
        case division::even:
            return n * r / p;
        case division::all_on_first:
            return n;
        case division::all_on_last:
            return 0;
        case division::uneven:
            return n * r * r / (p * p) / 2;
    }
    return 0;
}

/// This rank's part.
template <class T>
std::vector<T> part_of(const std::vector<T>& all, division how, int rank, int ranks) {
    const auto at = [&](int r) { return all.begin() + static_cast<std::ptrdiff_t>(cut(how, all.size(), r, ranks)); };
    return {at(rank), at(rank + 1)};
}

/// The ranks' lists one after another, on all ranks.
template <class T>
std::vector<T> lists_of_all(const detail::own_communicator& ranks, const std::vector<T>& mine) {
    std::vector<int> sizes(static_cast<std::size_t>(ranks.size()));
    detail::gather(ranks, static_cast<int>(mine.size() * sizeof(T)), sizes);
    std::vector<int> first;
    int total = 0;
    for (const int size : sizes) {
        first.push_back(total);
        total += size;
    }
    std::vector<T> all(static_cast<std::size_t>(total) / sizeof(T));
    MPI_Allgatherv(mine.data(), static_cast<int>(mine.size() * sizeof(T)), MPI_BYTE, all.data(), sizes.data(), first.data(),
                   MPI_BYTE, ranks.get());
    return all;
}

/// Whether it holds on all ranks: what one rank alone knows may not be checked by that rank alone.
inline bool on_all(const detail::own_communicator& ranks, bool mine) {
    const int value = mine ? 1 : 0;
    int all = 0;
    MPI_Allreduce(&value, &all, 1, MPI_INT, MPI_MIN, ranks.get());
    return all != 0;
}

// What one machine finds, with the ids of a set of many parts.

inline std::uint64_t as_global_id(std::uint32_t id) { return id == no_id ? no_global_id : id; }
template <scalar T>
std::vector<global_neighbor<T>> in_all_parts(const std::vector<neighbor<T>>& all) {
    std::vector<global_neighbor<T>> out;
    for (const auto& n : all) out.push_back({as_global_id(n.id), n.point, n.distance});
    return out;
}
template <scalar T>
std::vector<global_ray_hit<T>> in_all_parts(const std::vector<ray_hit<T>>& all) {
    std::vector<global_ray_hit<T>> out;
    for (const auto& h : all) out.push_back({as_global_id(h.id), h.t});
    return out;
}
template <scalar T>
std::vector<global_hit_of_ray<T>> in_all_parts(const std::vector<hit_of_ray<T>>& all) {
    std::vector<global_hit_of_ray<T>> out;
    for (const auto& h : all) out.push_back({h.ray, h.id, h.t});
    return out;
}
inline std::vector<global_pair> in_all_parts(const std::vector<index_pair>& all) {
    std::vector<global_pair> out;
    for (const index_pair& p : all) out.push_back({p.a, p.b});
    return out;
}
template <scalar T>
std::vector<global_contact<T>> in_all_parts(const std::vector<contact<T>>& all) {
    std::vector<global_contact<T>> out;
    for (const auto& c : all) out.push_back({c.a, c.b, c.point, c.normal, c.depth});
    return out;
}
inline std::vector<global_tagged_pair> in_all_parts(const std::vector<tagged_pair>& all) {
    std::vector<global_tagged_pair> out;
    for (const tagged_pair& p : all) out.push_back({p.pair, p.a, p.b});
    return out;
}
template <scalar T>
std::vector<global_tagged_contact<T>> in_all_parts(const std::vector<tagged_contact<T>>& all) {
    std::vector<global_tagged_contact<T>> out;
    for (const auto& c : all) out.push_back({c.pair, c.a, c.b, c.point, c.normal, c.depth});
    return out;
}

}  // namespace abut::test
