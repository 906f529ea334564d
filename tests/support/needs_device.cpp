// SPDX-License-Identifier: MIT
#include "support/needs.hpp"

#include <cuda_runtime_api.h>

#include <string>

const char* abut::test::what_is_missing() {
    int devices = 0;
    const cudaError_t status = cudaGetDeviceCount(&devices);
    if (status != cudaErrorNoDevice && status != cudaErrorInsufficientDriver) return nullptr;
    static const std::string reason = std::string("no CUDA device (") + cudaGetErrorString(status) + ")";
    return reason.c_str();
}
