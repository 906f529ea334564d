// SPDX-License-Identifier: MIT
#pragma once

// schedule::work_stealing of `cuda`, for comparisons: all that a block has lies in its deque, and it steals from one deque
// what it can take in one step. For .cu files, as cuda.hpp; the lazy schedule, which is faster, is there.

#include <abut/execution/cuda_stealing.hpp>
#include <abut/execution/schedule.hpp>

namespace abut::execution::detail {

template <>
struct stealing_rule<schedule::work_stealing> {
    static constexpr unsigned most = 0, keep = 0;
    static constexpr unsigned victims = 1, steal = block_size;
};

}  // namespace abut::execution::detail
