// SPDX-License-Identifier: MIT
// expect: calling a .*__host__ function.*functors_for_the_policy_cuda_have_to_be_marked_ABUT_HD
#include <cstdint>
#include <vector>

#include <abut/execution/cuda.hpp>

void pass(std::vector<std::uint32_t>& seen) {
    require_callable(
        abut::cuda{}, [&seen](std::uint32_t a) { seen.push_back(a); }, std::uint32_t{});
}
