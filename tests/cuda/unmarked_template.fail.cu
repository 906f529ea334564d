// SPDX-License-Identifier: MIT
// expect: calling a __host__ function.*filter::operator.*functors_for_the_policy_cuda_have_to_be_marked_ABUT_HD
#include <cstdint>

#include <abut/execution/cuda.hpp>

struct filter {
    bool operator()(auto a, auto b) const { return a < b; }
};
void pass() { require_callable(abut::cuda{}, filter{}, std::uint32_t{}, std::uint32_t{}); }
