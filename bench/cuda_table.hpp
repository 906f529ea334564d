// SPDX-License-Identifier: MIT
#pragma once

// What the benchmarks on CUDA share: a clock of CUDA events, a table of medians that is printed as it fills and written as
// JSON in the form of Google Benchmark, and the floor of the machine. A median is of 21 runs after two that are not counted;
// of 11 where one takes more than 20 ms, and of 3 where it takes more than 200 ms.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

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

using counters = std::vector<std::pair<std::string, double>>;

struct row {
    std::string name;
    double median, best;  // ms
    bench::counters counters;
};

class table {
public:
    explicit table(const abut::cuda& on) : on_(on) {}

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
        rows_.push_back({name, median, times[0], found});
        print(rows_.back());
        return median;
    }

    void write(const char* path) const {
        cudaDeviceProp device{};
        check(cudaGetDeviceProperties(&device, abut::execution::device_of(on_)), "cudaGetDeviceProperties");
        const auto memory = memory_in_use(on_);
        std::FILE* const file = std::fopen(path, "w");
        if (file == nullptr) throw abut::error(std::string(path) + ": cannot be written");
        std::fprintf(file,
                     "{\"context\": {\"device\": \"%s\", \"cuda\": %d, \"pool_reserved\": %llu, \"pool_peak\": %llu},\n",
                     device.name, CUDART_VERSION, static_cast<unsigned long long>(memory.reserved),
                     static_cast<unsigned long long>(memory.used_peak));
        std::fprintf(file, " \"benchmarks\": [");
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const row& r = rows_[i];
            std::fprintf(file, "%s\n  {\"name\": \"%s_median\", \"run_name\": \"%s\", \"aggregate_name\": \"median\", ",
                         i == 0 ? "" : ",", r.name.c_str(), r.name.c_str());
            std::fprintf(file, "\"real_time\": %.9g, \"cpu_time\": %.9g, \"time_unit\": \"ms\", \"best_ms\": %.9g", r.median,
                         r.median, r.best);
            for (const auto& [key, value] : r.counters) std::fprintf(file, ", \"%s\": %.17g", key.c_str(), value);
            std::fprintf(file, "}");
        }
        std::fprintf(file, "\n]}\n");
        if (std::fclose(file) != 0) throw abut::error(std::string(path) + ": cannot be written");
    }

private:
    static void print(const row& r) {
        std::printf("%-38s %11.4f ms  (best %.4f)", r.name.c_str(), r.median, r.best);
        for (const auto& [key, value] : r.counters) std::printf("  %s %.9g", key.c_str(), value);
        std::printf("\n");
        std::fflush(stdout);
    }

    abut::cuda on_;
    stopwatch watch_;
    std::vector<row> rows_;
};

/// Parts of a benchmark's name with slashes between them.
inline std::string joined(std::initializer_list<std::string> parts) {
    std::string name;
    for (const auto& part : parts) {
        if (!name.empty()) name += '/';
        name += part;
    }
    return name;
}

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
    const double copied = rate("floor/copy", 2.0 * bytes, [&] { copy(on, from.data(), words, to.data()); });
    const double read = rate("floor/read", bytes, [&] {
        if (reduce(on, words, std::uint64_t{0}, either{}, word_at{from.data()}) != 1) throw abut::error("floor: wrong sum");
    });
    rate("floor/call", 8, [&] { (void)reduce(on, std::size_t{1}, std::uint64_t{0}, either{}, word_at{from.data()}); });
    out.bandwidth = read;
    std::printf("copy %.0f GB/s, read %.0f GB/s\n", copied * 1e-6, read * 1e-6);
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
            table out(on);
            measure_floor(on, out);
            body(on, out);
            const auto memory = memory_in_use(on);
            std::printf("pool: %llu bytes reserved, at most %llu in use\n", static_cast<unsigned long long>(memory.reserved),
                        static_cast<unsigned long long>(memory.used_peak));
            if (argc > 1) out.write(argv[1]);
        }
        check(cudaStreamDestroy(stream), "cudaStreamDestroy");
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s: %s\n", program, e.what());
        return 1;
    }
}

}  // namespace bench
