// SPDX-License-Identifier: MIT
#pragma once

// What several policies that work together have to be, for who asks no more of them. team.hpp has the threads that drive
// them.

#include <concepts>

#include <abut/config.hpp>

namespace abut::execution {

class crew;  // team.hpp

/// Policies that work together. team[k] is the k-th, for 0 <= k < team.size(), of which there is one at least. All are of
/// the type `local_policy`. team.threads() drives them. copy_across(from, p, n, to, q) copies n elements from memory of the
/// policy `from` to that of `to`, both of that type, and returns when they are there. They have to be complete: it does not
/// wait for what `from` is doing.
template <class Team>
concept policy_team = requires(const Team& team, int k) {
    typename Team::local_policy;
    { team.size() } -> std::same_as<int>;
    { team[k] } -> std::convertible_to<const typename Team::local_policy&>;
    { team.threads() } -> std::same_as<crew&>;
};

}  // namespace abut::execution
