// SPDX-License-Identifier: MIT

// `main` of every test executable, for both generations of Catch2. With ABUT_TEST_NEEDS_DEVICE it leaves with 77, which
// ctest reports as skipped, where no CUDA device is present.

#if __has_include(<catch2/catch_session.hpp>)
#include <catch2/catch_session.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif

#ifdef ABUT_TEST_NEEDS_DEVICE
#include <cuda_runtime_api.h>

#include <cstdio>
#endif

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
// The OpenMP runtime is not instrumented; archer stands in for what it orders.
extern "C" const char* __tsan_default_options();
extern "C" const char* __tsan_default_options() { return "ignore_noninstrumented_modules=1"; }
#endif
#endif

int main(int argc, char* argv[]) {
#ifdef ABUT_TEST_NEEDS_DEVICE
    int devices = 0;
    const cudaError_t status = cudaGetDeviceCount(&devices);
    if (status == cudaErrorNoDevice || status == cudaErrorInsufficientDriver) {
        std::printf("abut skips: no CUDA device (%s)\n", cudaGetErrorString(status));
        return 77;
    }
#endif
    return Catch::Session().run(argc, argv);
}
