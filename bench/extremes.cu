// SPDX-License-Identifier: MIT
//
// usage: bench_extremes_cuda [--json=FILE] [--pairs=N] [--sample=N]
//
// bench/extremes.cpp on CUDA: N pairs are timed at each step, 262,144 unless said otherwise, by the clock around a kernel
// that decides them all; of features in motion 1,024, with the share of the last stage, which is the host's.

#include <chrono>
#include <exception>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "extremes_scene.hpp"

namespace {

struct elapsed_time {
    template <class Work>
    double operator()(const abut::cuda& on, const Work& work) const {
        cudaStreamSynchronize(on.stream);
        const auto start = std::chrono::steady_clock::now();
        work();
        if (const cudaError_t code = cudaStreamSynchronize(on.stream); code != cudaSuccess) {
            throw abut::cuda_error("cudaStreamSynchronize", code);
        }
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
};

}  // namespace

int main(int argc, char** argv) {
    try {
        const extremes_bench::sizes of{1 << 18, 1 << 10, 1000, 64};
        const abut::cuda on;
        cudaDeviceProp device{};
        if (cudaGetDeviceProperties(&device, abut::execution::device_of(on)) != cudaSuccess) {
            throw std::runtime_error("no CUDA device");
        }
        return extremes_bench::run("bench_extremes_cuda", argc, argv, on, elapsed_time{}, of,
                                   {{"device", device.name}, {"cuda", bench::cuda_version(CUDART_VERSION)}});
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_extremes_cuda: %s\n", problem.what());
        return 1;
    }
}
