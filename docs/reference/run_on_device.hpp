// SPDX-License-Identifier: MIT
#pragma once

// What the examples of the reference that need a device have as their main.

#include <cstdio>

#include <cuda_runtime_api.h>

/// Runs an example; skips it, with exit status 77, where there is no device.
inline int run_on_device(void (*run)()) {
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::puts("abut skips: no CUDA device can be used here");
        return 77;
    }
    run();
    return 0;
}
