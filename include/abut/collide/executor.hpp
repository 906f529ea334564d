// SPDX-License-Identifier: MIT
#pragma once

// Who answers a query: a policy at once or in its stream (async.hpp), several devices of one host (devices/), or the ranks of a
// communicator (distributed/). A query has one front, which takes any of them. It hands on a question, the arguments and the options to a
// function of `detail` that each kind of executor overloads for each kind of question: ask_pairs (pairs of shapes), ask_rows
// (what each of many points or lines asks), ask_least (how far two sets are apart), ask_motion (what meets in motion).
// The question is a type of `detail`, so that calls find the overloads of executors whose headers came later.

#include <abut/execution/policy.hpp>
#include <abut/execution/policy_team.hpp>

namespace abut {

namespace detail {

/// Ranks: distributed/communicator.hpp says so.
template <class On>
inline constexpr bool is_ranks = false;
/// Calls that do not wait: async.hpp says so.
template <class On>
inline constexpr bool is_async = false;

}  // namespace detail

/// What queries take as their first argument: a policy (`serial`, `openmp`, `cuda`), several devices (`cuda_devices`), ranks
/// (`distributed`), or a policy's stream in which they do not wait (`async`).
/// @ingroup policies
template <class On>
concept executor = execution_policy<On> || execution::policy_team<On> || detail::is_ranks<On> || detail::is_async<On>;

}  // namespace abut
