// SPDX-License-Identifier: MIT
#pragma once

// What the benchmarks on CUDA share: a clock of CUDA events, a table of medians that is printed as it fills and written as
// bench/results.hpp says, and the floor of the machine. A median is of 21 runs after two that are not counted; of 11 where
// one takes more than 20 ms, and of 3 where it takes more than 200 ms.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "results.hpp"

namespace bench {

inline void check(cudaError_t code, const char* call) {
    if (code != cudaSuccess) throw abut::cuda_error(call, code);
}

class stopwatch {
public:
    stopwatch() {
        check(cudaEventCreate(&start_), "cudaEventCreate");
        check(cudaEventCreate(&stop_), "cudaEventCreate");
    }
    stopwatch(const stopwatch&) = delete;
    stopwatch& operator=(const stopwatch&) = delete;
    ~stopwatch() {
        cudaEventDestroy(start_);
        cudaEventDestroy(stop_);
    }
    /// Milliseconds between events before and after what `work` puts on the stream.
    template <class Work>
    float time(const abut::cuda& on, const Work& work) {
        check(cudaEventRecord(start_, on.stream), "cudaEventRecord");
        work();
        check(cudaEventRecord(stop_, on.stream), "cudaEventRecord");
        check(cudaEventSynchronize(stop_), "cudaEventSynchronize");
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, start_, stop_), "cudaEventElapsedTime");
        return milliseconds;
    }

private:
    cudaEvent_t start_ = nullptr, stop_ = nullptr;
};

class table {
public:
    table(const char* program, const abut::cuda& on) : on_(on), results_(program) {
        cudaDeviceProp device{};
        check(cudaGetDeviceProperties(&device, abut::execution::device_of(on)), "cudaGetDeviceProperties");
        int driver = 0;
        check(cudaDriverGetVersion(&driver), "cudaDriverGetVersion");
        results_.describe("device", device.name);
        results_.describe("cuda", bench::cuda_version(CUDART_VERSION));
        results_.describe("cuda_of_driver", bench::cuda_version(driver));
    }

    /// Bytes a millisecond; 0 until it has been measured.
    double bandwidth = 0;

    /// Milliseconds of one run.
    template <class Work>
    float once(const Work& work) {
        return watch_.time(on_, work);
    }

    /// `work` returns counters, of which `items` gives a rate; `least_bytes` is what it has to move, where that is a floor.
    /// Returns the median in milliseconds.
    template <class Work>
    double add(const std::string& name, double least_bytes, const Work& work) {
        bench::counters found;
        const auto run = [&] { return once([&] { found = work(); }); };
        run();
        const float warm = run();
        const int runs = warm > 200 ? 3 : warm > 20 ? 11 : 21;
        std::vector<float> times;
        for (int i = 0; i < runs; ++i) times.push_back(run());
        std::sort(times.begin(), times.end());
        const double median = times[times.size() / 2];
        if (bandwidth > 0 && least_bytes > 0) found.emplace_back("floor_ms", least_bytes / bandwidth);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].first == "items") found.emplace_back("items_per_second", found[i].second / median * 1e3);
        }
        found.insert(found.begin(), {{"ms", median}, {"best_ms", times[0]}});
        results_.add(name, found);
        return median;
    }
    /// A row that was measured elsewhere.
    void note(const std::string& name, const counters& values) { results_.add(name, values); }

    /// Adds what the library's pool of memory holds, and writes all rows.
    void write(const char* path) {
        const auto memory = memory_in_use(on_);
        note("pool", {{"reserved_bytes", static_cast<double>(memory.reserved)},
                      {"peak_bytes", static_cast<double>(memory.used_peak)}});
        if (path != nullptr) results_.write(path);
    }

private:
    abut::cuda on_;
    stopwatch watch_;
    results results_;
};

struct word_at {
    const std::uint64_t* words;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return words[i]; }
};
struct either {
    ABUT_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a | b; }
};

/// Reads a GiB and copies a GiB; sets the table's bandwidth to the former.
inline void measure_floor(const abut::cuda& on, table& out) {
    constexpr std::size_t words = std::size_t{1} << 27, bytes = words * sizeof(std::uint64_t);
    abut::execution::buffer_of<abut::cuda, std::uint64_t> from(on, words), to(on, words);
    fill(on, from.data(), words, std::uint64_t{1});
    const auto rate = [&](const char* name, double moved, const auto& work) {
        const double milliseconds = out.add(name, moved, [&] {
            work();
            return counters{{"bytes", moved}};
        });
        return moved / milliseconds;
    };
    rate("floor/copy", 2.0 * bytes, [&] { copy(on, from.data(), words, to.data()); });
    const double read = rate("floor/read", bytes, [&] {
        if (reduce(on, words, std::uint64_t{0}, either{}, word_at{from.data()}) != 1) throw abut::error("floor: wrong sum");
    });
    rate("floor/call", 8, [&] { (void)reduce(on, std::size_t{1}, std::uint64_t{0}, either{}, word_at{from.data()}); });
    out.bandwidth = read;
}

/// The main of a benchmark: measures the floor and calls body(on, out) on a stream of its own, then writes the table to the
/// file that the first argument names, if there is one. Returns the exit status.
template <class Body>
int run(const char* program, int argc, char** argv, const Body& body) {
    try {
        cudaStream_t stream = nullptr;
        check(cudaStreamCreate(&stream), "cudaStreamCreate");
        {
            const abut::cuda on{stream};
            table out(program, on);
            measure_floor(on, out);
            body(on, out);
            out.write(argc > 1 ? argv[1] : nullptr);
        }
        check(cudaStreamDestroy(stream), "cudaStreamDestroy");
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s: %s\n", program, e.what());
        return 1;
    }
}

}  // namespace bench
