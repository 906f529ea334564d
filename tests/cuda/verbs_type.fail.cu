// SPDX-License-Identifier: MIT
// options: -DABUT_CUDA_VERBS_COMPILED=1
// expect: abut: sort_keys: the target abut::cuda_verbs has it for 32 and 64 bit keys: for others include <abut/execution/cuda_cub.hpp>
#include <cstdint>

#include <abut/execution/cuda_verbs.hpp>

int main() {
    const abut::cuda on;
    abut::execution::buffer<std::uint16_t, abut::device_space> keys(on, 8);
    sort_keys(on, keys, 16);
}
