// SPDX-License-Identifier: MIT
// options: -D__CUDACC__ -D__CUDACC_VER_MAJOR__=12
// expect: abut/cuda.hpp needs nvcc 13.0 or newer
// errors: 2
#include <abut/cuda.hpp>

int main() { return abut::any(abut::cuda{}, abut::mesh<float>(), abut::mesh<float>()) ? 1 : 0; }
