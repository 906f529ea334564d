// SPDX-License-Identifier: MIT
//
// The target abut::cuda_verbs: what execution/cuda_compiled.hpp declares, for the types that queries use.

#include <cstddef>
#include <cstdint>

#include <abut/execution/cuda_cub.hpp>

namespace abut::execution::detail {

template bool sort_keys_of(const cuda&, std::uint32_t*, std::uint32_t*, std::size_t, int);
template bool sort_keys_of(const cuda&, std::uint64_t*, std::uint64_t*, std::size_t, int);

template moved_pairs sort_pairs_of(const cuda&, std::uint32_t*, std::uint32_t*, std::uint32_t*, std::uint32_t*, std::size_t,
                                   int);
template moved_pairs sort_pairs_of(const cuda&, std::uint32_t*, std::uint32_t*, std::uint64_t*, std::uint64_t*, std::size_t,
                                   int);
template moved_pairs sort_pairs_of(const cuda&, std::uint64_t*, std::uint64_t*, std::uint32_t*, std::uint32_t*, std::size_t,
                                   int);
template moved_pairs sort_pairs_of(const cuda&, std::uint64_t*, std::uint64_t*, std::uint64_t*, std::uint64_t*, std::size_t,
                                   int);

template void scan_of(const cuda&, std::uint32_t*, std::size_t);
template void scan_of(const cuda&, std::uint64_t*, std::size_t);

template void select_of(const cuda&, const std::uint32_t*, std::size_t, std::uint32_t*, std::uint64_t*);
template void select_of(const cuda&, const std::uint32_t*, std::size_t, std::uint64_t*, std::uint64_t*);

}  // namespace abut::execution::detail
