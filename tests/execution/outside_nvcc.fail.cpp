// SPDX-License-Identifier: MIT
// expect: abut/cuda.hpp is for .cu files that nvcc compiles
// errors: 2
#include <abut/cuda.hpp>

int main() { return abut::any(abut::cuda{}, abut::mesh<float>(), abut::mesh<float>()) ? 1 : 0; }
