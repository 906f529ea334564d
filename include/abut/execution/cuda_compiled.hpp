// SPDX-License-Identifier: MIT
#pragma once

// Of the verbs of `cuda` those parts that know few types, so that they can be compiled once: execution/cuda_cub.hpp defines
// them, and the target abut::cuda_verbs has them compiled for the types that queries use. With ABUT_CUDA_VERBS_COMPILED,
// which linking that target defines, they are only declared here.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/execution/cuda.hpp>

namespace abut::execution::detail {

/// What abut::cuda_verbs has compiled: sorts of these keys, which carry these values.
template <class T>
concept compiled_type = std::same_as<T, std::uint32_t> || std::same_as<T, std::uint64_t>;

/// Complete where execution/cuda_cub.hpp is included, and then any type will do.
template <class... Types>
struct cub_of;
template <class... Types>
concept can_compile = (compiled_type<Types> && ...) || requires { sizeof(cub_of<Types...>); };

/// Sorts n keys, with `other` for as many more. Returns whether they are in `other` then.
template <class Key>
bool sort_keys_of(const cuda& on, Key* keys, Key* other, std::size_t n, int bits);

/// The same of keys and values.
struct moved_pairs {
    bool keys, values;
};
template <class Key, class Value>
moved_pairs sort_pairs_of(const cuda& on, Key* keys, Key* other_keys, Value* values, Value* other_values, std::size_t n,
                          int bits);

/// Sums of what is before each, in place.
template <class T>
void scan_of(const cuda& on, T* values, std::size_t n);

/// The places of the bits that are set among the first n, in ascending order, and their number.
template <class Index>
void select_of(const cuda& on, const std::uint32_t* words, std::size_t n, Index* out, std::uint64_t* count);

}  // namespace abut::execution::detail
