// SPDX-License-Identifier: MIT
//
// usage: bench_triangles_cuda [OUT.json]
//
// bench/triangles.cpp on CUDA, with the same scenes and the same names:
//
//   pair/ARITHMETIC/SCALAR/PERCENT     pairs of a plain kernel that calls `intersects` for each; counters registers, and
//   family/ARITHMETIC/SCALAR/NAME      local_bytes, which is stack and spills of a thread
//   read/SCALAR/cuda/N                 a kernel that reads the bytes of N triangles and does nothing else, in the best of
//                                      several launch shapes
//   one/QUERY/ARITHMETIC/SCALAR/PERCENT/cuda/N   one triangle against N that are resident; QUERY is count, any, pairs,
//                                      unsorted, or copied: a set made from page-locked host memory, then counted
//   copy/SCALAR/cuda/N                 the copy of N triangles from there alone
//   many/QUERY/ARITHMETIC/SCALAR/cuda/N   N triangles against N others
//
// Times are taken with CUDA events around the whole call, so what the host does between kernels is in them. Prints a table,
// and writes JSON in the form of Google Benchmark. Takes about a minute.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <cuda_runtime.h>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "decide_pairs.hpp"
#include "triangle_scene.hpp"

namespace {

using bench::check;
using bench::counters;
using bench::joined;
using bench::scalar_name;
using bench::table;

namespace test = abut::test;
namespace scene = triangle_scene;

template <class T>
using device_buffer = abut::execution::buffer_of<abut::cuda, T>;

// --- one pair for each thread -------------------------------------------------------------------------------------------

template <abut::scalar T>
struct make_random_pair {
    double spread;
    test::triangle_pair<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = scene::random_pair<T>(spread, i); }
};

template <abut::scalar T>
class pair_bench {
public:
    pair_bench(const abut::cuda& on, table& out) : on_(on), out_(out), pairs_(on, most), touches_(on, most) {}

    /// Rows KIND/ARITHMETIC/SCALAR/NAME for pairs that `make(out)` makes one by one.
    template <class Make>
    void add(const char* kind, const std::string& name, const Make& make) {
        for_each_index(on_, most, make(pairs_.data()));
        const auto row = [&](const char* arithmetic) { return joined({kind, arithmetic, scalar_name<T>, name}); };
        add_arithmetic<abut::fast>(row("fast"));
        const double by_filter = add_arithmetic<abut::filtered>(row("filtered"));
        const double by_integers = add_arithmetic<abut::exact>(row("exact"));
        // The two may have decided different numbers of pairs, of which the fewer come first.
        if (by_filter != by_integers) throw abut::error(name + ": filtered and exact disagree");
    }

private:
    static constexpr std::size_t most = std::size_t{1} << 22, least = most / 64;

    /// Returns the number of hits among the first pairs.
    template <abut::arithmetic A>
    double add_arithmetic(const std::string& name) {
        const bench::decide_pair<A, T> decide{pairs_.data(), touches_.data()};
        // Fewer pairs where each takes long, as the widest integers do.
        const auto decide_some = [&] { for_each_index(on_, least, decide); };
        out_.once(decide_some);
        std::size_t n = most;
        const float milliseconds = out_.once(decide_some);
        while (n > least && milliseconds * static_cast<float>(n / least) > 64) n /= 4;
        for_each_index(on_, n, decide);
        const counters says = bench::counters_of_pairs<A, T>(n, bench::count_hits(on_, n, touches_.data()));
        out_.add(name, 0, [&] {
            for_each_index(on_, n, decide);
            return says;
        });
        return bench::count_hits(on_, least, touches_.data());
    }

    abut::cuda on_;
    table& out_;
    device_buffer<test::triangle_pair<T>> pairs_;
    device_buffer<std::uint8_t> touches_;
};

template <abut::scalar T>
void add_pairs(const abut::cuda& on, table& out) {
    pair_bench<T> bench(on, out);
    for (const auto& share : scene::pair_shares) {
        bench.add("pair", share.percent, [&](auto* to) { return make_random_pair<T>{share.spread, to}; });
    }
    for (int f = 0; f < test::triangle_family_count; ++f) {
        const auto family = static_cast<test::triangle_family>(f);
        bench.add("family", test::name_of(family), [&](auto* to) {
            return bench::make_family_pair<T>{scene::seed, family, to};
        });
    }
}

// --- the floor: reading and nothing else ----------------------------------------------------------------------------------

/// Each thread has `InFlight` loads under way. The sum is wanted by nobody, but the compiler cannot know that.
template <int InFlight>
__global__ void read_kernel(const float4* words, std::size_t n, float4* never) {
    const std::size_t step = std::size_t{gridDim.x} * blockDim.x;
    float4 sum{0, 0, 0, 0};
    for (std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x; i < n; i += InFlight * step) {
        float4 loaded[InFlight];
#pragma unroll
        for (int k = 0; k < InFlight; ++k) {
            loaded[k] = i + k * step < n ? words[i + k * step] : float4{0, 0, 0, 0};
        }
#pragma unroll
        for (int k = 0; k < InFlight; ++k) {
            sum.x += loaded[k].x;
            sum.y += loaded[k].y;
            sum.z += loaded[k].z;
            sum.w += loaded[k].w;
        }
    }
    if (sum.x == 0.12345f && sum.y == 0.54321f && sum.z == 0.12543f && sum.w == 0.32154f) *never = sum;
}

struct read_shape {
    int in_flight, threads;
    unsigned blocks;
};

void read(const abut::cuda& on, const read_shape& shape, const float4* words, std::size_t n, float4* never) {
    const auto kernel = shape.in_flight == 1 ? read_kernel<1> : shape.in_flight == 4 ? read_kernel<4> : read_kernel<8>;
    kernel<<<shape.blocks, static_cast<unsigned>(shape.threads), 0, on.stream>>>(words, n, never);
    check(cudaGetLastError(), "read_kernel");
}

/// Adds the row of the fastest shape and returns its median.
double add_read(const abut::cuda& on, table& out, const std::string& name, const void* data, std::size_t bytes) {
    const auto* const words = static_cast<const float4*>(data);
    const std::size_t n = bytes / sizeof(float4);
    device_buffer<float4> never(on, 1);
    const auto processors = static_cast<unsigned>(abut::execution::detail::multiprocessors(abut::execution::device_of(on)));
    read_shape best{};
    float best_time = 0;
    for (const int in_flight : {1, 4, 8}) {
        for (const int threads : {256, 512, 1024}) {
            const std::size_t at_once = static_cast<std::size_t>(threads) * static_cast<std::size_t>(in_flight);
            const auto whole = static_cast<unsigned>((n + at_once - 1) / at_once);
            const unsigned resident = processors * 2048 / static_cast<unsigned>(threads);
            for (const unsigned blocks : {whole, std::min(whole, resident / 2), std::min(whole, resident)}) {
                const read_shape shape{in_flight, threads, std::max(blocks, 1u)};
                float fastest = 0;
                for (int run = 0; run < 5; ++run) {
                    const float time = out.once([&] { read(on, shape, words, n, never.data()); });
                    if (run == 1 || (run > 1 && time < fastest)) fastest = time;
                }
                if (best.threads == 0 || fastest < best_time) {
                    best = shape;
                    best_time = fastest;
                }
            }
        }
    }
    return out.add(name, 0, [&] {
        read(on, best, words, n, never.data());
        return counters{{"bytes", static_cast<double>(bytes)},
                        {"loads_in_flight", static_cast<double>(best.in_flight)},
                        {"threads", static_cast<double>(best.threads)},
                        {"blocks", static_cast<double>(best.blocks)}};
    });
}

// --- one against many -----------------------------------------------------------------------------------------------------

/// Page-locked host memory.
class pinned {
public:
    explicit pinned(std::size_t bytes) { check(cudaHostAlloc(&data_, bytes, cudaHostAllocDefault), "cudaHostAlloc"); }
    pinned(const pinned&) = delete;
    pinned& operator=(const pinned&) = delete;
    ~pinned() { cudaFreeHost(data_); }
    [[nodiscard]] void* data() const { return data_; }

private:
    void* data_ = nullptr;
};

template <abut::scalar T>
struct make_triangle {
    double spread;
    bool misses;
    std::uint64_t stream;
    abut::triangle<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = misses ? scene::missing_triangle<T>(i) : scene::random_triangle<T>(spread, i, stream);
    }
};

/// Makes triangles on the device and leaves them in host memory.
template <abut::scalar T>
std::span<const abut::triangle<T>> generate(const abut::cuda& on, std::size_t n, double spread, bool misses,
                                            std::uint64_t stream, const pinned& to) {
    device_buffer<abut::triangle<T>> made(on, n);
    for_each_index(on, n, make_triangle<T>{spread, misses, stream, made.data()});
    auto* const triangles = static_cast<abut::triangle<T>*>(to.data());
    made.read(triangles);
    return {triangles, n};
}

template <abut::scalar T>
using resident_soup = abut::triangle_soup<T, abut::device_space>;

struct count_query {
    static constexpr const char* name = "count";
    template <abut::arithmetic A>
    static std::uint64_t ask(const abut::cuda& on, const auto& a, const auto& b) {
        return abut::count<A>(on, a, b);
    }
};
struct any_query {
    static constexpr const char* name = "any";
    template <abut::arithmetic A>
    static std::uint64_t ask(const abut::cuda& on, const auto& a, const auto& b) {
        return abut::any<A>(on, a, b) ? 1 : 0;
    }
};
struct pairs_query {
    static constexpr const char* name = "pairs";
    template <abut::arithmetic A>
    static std::uint64_t ask(const abut::cuda& on, const auto& a, const auto& b) {
        return abut::pairs<A>(on, a, b).size();
    }
};
struct unsorted_query {
    static constexpr const char* name = "unsorted";
    template <abut::arithmetic A>
    static std::uint64_t ask(const abut::cuda& on, const auto& a, const auto& b) {
        return abut::pairs<A>(on, a, b, {.sorted = false}).size();
    }
};

/// One triangle against the sets of growing size that begin with the same triangles.
template <abut::scalar T>
class one_bench {
public:
    one_bench(const abut::cuda& on, table& out, const pinned& memory) : on_(on), out_(out), memory_(memory) {}

    void run() {
        scene_ = generate<T>(on_, scene::most_triangles, 0, true, 0, memory_);
        percent_ = "0";
        for (const std::size_t n : scene::one_sizes) {
            const resident_soup<T> soup(on_, scene_.first(n));
            read_ms_[n] = add_read(on_, out_, joined({"read", scalar_name<T>, "cuda", std::to_string(n)}),
                                   soup.view().shapes.data, n * sizeof(abut::triangle<T>));
            add<any_query, abut::filtered>(soup, "filtered");
        }
        for (const auto& share : scene::one_shares) {
            scene_ = generate<T>(on_, scene::most_triangles, share.spread, false, 2, memory_);
            percent_ = share.percent;
            for (const std::size_t n : scene::one_sizes) {
                const resident_soup<T> soup(on_, scene_.first(n));
                const double fast = add<count_query, abut::fast>(soup, "fast");
                const double filtered = add<count_query, abut::filtered>(soup, "filtered");
                add<any_query, abut::filtered>(soup, "filtered");
                if constexpr (sizeof(T) == 4) {
                    if (add<count_query, abut::exact>(soup, "exact") != filtered)
                        throw abut::error("filtered and exact disagree");
                    add<pairs_query, abut::filtered>(soup, "filtered");
                    add<unsorted_query, abut::filtered>(soup, "filtered");
                }
                if (fast != filtered) std::printf("fast counts %.0f, filtered %.0f\n", fast, filtered);
                if (std::string_view(share.percent) == "1") add_copied(n);
            }
        }
    }

private:
    /// Returns what the query says.
    template <class Query, abut::arithmetic A>
    double add(const resident_soup<T>& soup, const char* arithmetic) {
        std::uint64_t found = 0;
        const std::string n = std::to_string(soup.size());
        out_.add(joined({"one", Query::name, arithmetic, scalar_name<T>, percent_, "cuda", n}), 0, [&] {
            found = Query::template ask<A>(on_, scene::reference<T>(), soup);
            return counters{{"items", static_cast<double>(soup.size())},
                            {"found", static_cast<double>(found)},
                            {"read_ms", read_ms_[soup.size()]}};
        });
        return static_cast<double>(found);
    }

    void add_copied(std::size_t n) {
        const auto triangles = scene_.first(n);
        const std::string tail = joined({"cuda", std::to_string(n)});
        device_buffer<abut::triangle<T>> to(on_, n);
        const double copy_ms = out_.add(joined({"copy", scalar_name<T>, tail}), 0, [&] {
            upload(on_, triangles.data(), n, to.data());
            return counters{{"bytes", static_cast<double>(triangles.size_bytes())}};
        });
        out_.add(joined({"one/copied/filtered", scalar_name<T>, percent_, tail}), 0, [&] {
            const resident_soup<T> soup(on_, triangles);
            const double found = static_cast<double>(abut::count(on_, scene::reference<T>(), soup));
            return counters{{"items", static_cast<double>(n)}, {"found", found}, {"copy_ms", copy_ms}};
        });
    }

    abut::cuda on_;
    table& out_;
    const pinned& memory_;
    std::span<const abut::triangle<T>> scene_;
    std::string percent_;
    std::map<std::size_t, double> read_ms_;
};

// --- many against many ----------------------------------------------------------------------------------------------------

void add_many(const abut::cuda& on, table& out, const pinned& memory) {
    for (const std::size_t n : {2'000u, 20'000u, 30'000u}) {
        const resident_soup<float> a(on, generate<float>(on, n, scene::many_spread, false, scene::stream_of_a, memory));
        const resident_soup<float> b(on, generate<float>(on, n, scene::many_spread, false, scene::stream_of_b, memory));
        const auto add = [&]<abut::arithmetic A>(const char* arithmetic, A) {
            out.add(joined({"many/count", arithmetic, "float/cuda", std::to_string(n)}), 0, [&] {
                const double found = static_cast<double>(abut::count<A>(on, a, b));
                return counters{{"items", static_cast<double>(n) * static_cast<double>(n)}, {"found", found}};
            });
        };
        add("fast", abut::fast{});
        add("filtered", abut::filtered{});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_triangles_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        const pinned memory(scene::most_triangles * sizeof(abut::triangle<double>));
        one_bench<float>(on, out, memory).run();
        add_many(on, out, memory);
        one_bench<double>(on, out, memory).run();
        add_pairs<float>(on, out);
        add_pairs<double>(on, out);
    });
}
