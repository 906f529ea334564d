// SPDX-License-Identifier: MIT
//
// usage: bench_cores --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json
//
// How `openmp` scales, on quiet cores and on busy ones. Times are by the wall's clock, but for the
// model's. Names:
//
//   OPERATION/serial/LOAD            on the calling thread; LOAD is quiet, or busy: a thread spins for each processor
//   OPERATION/openmp/THREADS/LOAD    the same on threads
//   OPERATION/modelled/THREADS       a bound on what so many cores could do (below); counters serial_share, loops
//
// The bound: loops run on one thread, which takes the time of each range. A list schedule of these times tells how long a
// loop would take on THREADS cores of which none waits for memory or for another, and what is outside of loops is serial. So
// it says which share of an operation is serial, on any machine.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"
#include "google.hpp"

namespace cores {

/// That the processor has spent on this thread. The clock's would have what others take from it.
double seconds_of_thread() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Threads of a model, and what loops have taken so far: on one thread, and by the model.
struct modelled : abut::execution::policy_base {
    using memory_space = abut::host_space;
    struct account {
        double measured = 0, makespan = 0;
        std::uint64_t loops = 0;
    };
    int threads;
    account* sum;
};

int concurrency(const modelled& on) { return on.threads; }

/// Each range goes to the thread that is free first.
template <class F>
void for_each_range(const modelled& on, std::size_t n, std::size_t grain, const F& f) {
    std::vector<double> busy_until(static_cast<std::size_t>(on.threads));
    for (std::size_t begin = 0; begin < n; begin += grain) {
        const auto first = std::min_element(busy_until.begin(), busy_until.end());
        const double from = seconds_of_thread();
        f(static_cast<int>(first - busy_until.begin()), begin, std::min(begin + grain, n));
        const double time = seconds_of_thread() - from;
        *first += time;
        on.sum->measured += time;
    }
    on.sum->makespan += *std::max_element(busy_until.begin(), busy_until.end());
    ++on.sum->loops;
}

static_assert(abut::execution_policy<modelled>);

}  // namespace cores

namespace {

/// As many threads as processors that do nothing but spin, as long as this is there.
class load {
public:
    explicit load(bool is) {
        for (unsigned k = 0; is && k < std::thread::hardware_concurrency(); ++k) {
            threads_.emplace_back([this] {
                while (!over_.load(std::memory_order_relaxed)) {
                }
            });
        }
    }
    ~load() {
        over_ = true;
        for (auto& t : threads_) t.join();
    }

private:
    std::atomic<bool> over_{false};
    std::vector<std::thread> threads_;
};

// --- operations: what is there before, and what is timed
// -------------------------------------------------------------------

template <std::uint32_t Around, std::uint32_t Across>
const abut::mesh<float>& ring() {
    static const abut::mesh<float> made = [] {
        const auto surface = scene::torus<float>(Around, Across);
        return abut::mesh<float>(surface.vertices, surface.faces);
    }();
    return made;
}
const abut::mesh<float>& small_mesh() { return ring<128, 108>(); }  // 27,648 triangles
const abut::mesh<float>& scene_mesh() { return ring<scene::torus_around, scene::torus_across>(); }
const abut::mesh<float>& large_mesh() { return ring<558, 310>(); }  // 345,960

const abut::equal_spheres<float>& spheres() {
    static const abut::equal_spheres<float> made(scene::centers<float>(), static_cast<float>(scene::radius));
    return made;
}

std::uint32_t scrambled(std::size_t i) { return static_cast<std::uint32_t>(i * 0x9e3779b97f4a7c15u >> 34); }

template <class Policy>
auto tree_of_scene(const Policy& on) {
    return abut::make_bvh(on, scene_mesh());
}

struct validate {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy&) { small_mesh(); }
        std::size_t operator()(const Policy& on) { return abut::validate(on, small_mesh()).edges; }
    };
};
struct build {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy&) { large_mesh(); }
        std::size_t operator()(const Policy& on) { return abut::make_bvh(on, large_mesh()).bytes(); }
    };
};
struct build_and_pairs {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy&) { spheres(), scene_mesh(); }
        std::size_t operator()(const Policy& on) { return abut::pairs(on, tree_of_scene(on), spheres()).size(); }
    };
};
template <bool Sorted>
struct pairs_of_scene {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy& on) : tree(tree_of_scene(on)) { spheres(); }
        std::size_t operator()(const Policy& on) { return abut::pairs(on, tree, spheres(), {.sorted = Sorted}).size(); }
        decltype(tree_of_scene(std::declval<Policy>())) tree;
    };
};
/// Two rings of 345,960 triangles, of which one is turned: many pairs.
template <bool Store>
struct meshes {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy& on) : tree(abut::make_bvh(on, large_mesh())) {}
        std::size_t operator()(const Policy& on) {
            const abut::rigid<float> pose{{0.8f, -0.6f, 0, 0.6f, 0.8f, 0, 0, 0, 1}, {0.5f, 0.25f, 0.125f}};
            if constexpr (Store)
                return abut::pairs(on, tree, posed(tree, pose), {.sorted = false}).size();
            else
                return abut::count(on, tree, posed(tree, pose));
        }
        decltype(abut::make_bvh(std::declval<Policy>(), large_mesh())) tree;
    };
};
template <std::size_t N>
struct sort_keys_of {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy& on) : keys(on, N) {}
        std::size_t operator()(const Policy& on) {
            for_each_index(on, N, write{keys.data()});
            sort_keys(on, keys, 30);
            return keys.data()[N / 2];
        }
        struct write {
            std::uint32_t* out;
            void operator()(std::size_t i) const { out[i] = scrambled(i); }
        };
        abut::execution::buffer<std::uint32_t, abut::host_space> keys;
    };
};
struct exclusive_scan_of_many {
    template <class Policy>
    struct on_policy {
        static constexpr std::size_t n = 4'000'000;
        explicit on_policy(const Policy&) : values(n + 1, 1) {}
        std::size_t operator()(const Policy& on) {
            exclusive_scan(on, values.data(), n);
            return values[n];
        }
        std::vector<std::uint32_t> values;
    };
};
struct compact_many {
    template <class Policy>
    struct on_policy {
        static constexpr std::size_t n = 4'000'000;
        explicit on_policy(const Policy&) : kept(n) {}
        std::size_t operator()(const Policy& on) {
            return compact(
                on, n, [](std::size_t i) { return scrambled(i) % 3 == 0; }, kept.data());
        }
        std::vector<std::uint32_t> kept;
    };
};

/// A loop that finds little by little what 32 MB hold.
struct gather_many {
    template <class Policy>
    struct on_policy {
        explicit on_policy(const Policy&) {}
        std::size_t operator()(const Policy& on) {
            abut::execution::work_queue<std::uint64_t, abut::host_space> found(on);
            for_each_index(
                on, 4'000'000, [](std::size_t i, auto& sink) { sink.push(scrambled(i)); }, found);
            return found.size();
        }
    };
};

/// Additions in registers, about as many at a time as a core can do: how much faster so many processors are than one, where
/// nothing waits for memory. Two that share a core are not two here, and one alone may run at a higher frequency.
struct arithmetic {
    template <class Policy>
    struct on_policy {
        static constexpr std::size_t tasks = 960;
        explicit on_policy(const Policy& on) : sums(on, tasks) {}
        std::size_t operator()(const Policy& on) {
            for_each_task(on, tasks, add{sums.data()});
            return sums.data()[tasks / 2];
        }
        struct add {
            std::uint64_t* out;
            void operator()(std::size_t i) const {
                std::uint64_t a[8] = {i, 1, 2, 3, 4, 5, 6, 7};
                for (int turn = 0; turn < 10'000; ++turn) {
                    for (std::uint64_t& x : a) {
                        x += x << 1;
                        asm volatile("" : "+r"(x));  // so that no compiler finds the sum by itself
                    }
                }
                out[i] = a[0] + a[1] + a[2] + a[3] + a[4] + a[5] + a[6] + a[7];
            }
        };
        abut::execution::buffer<std::uint64_t, abut::host_space> sums;
    };
};

// --- runs --------------------------------------------------------------------------------------------------------------

template <class Operation, class Policy>
void run(benchmark::State& state, Policy on, bool busy) {
    typename Operation::template on_policy<Policy> ask(on);
    benchmark::DoNotOptimize(ask(on));
    const load others(busy);
    for (auto _ : state) benchmark::DoNotOptimize(ask(on));
}

template <class Operation>
void model(benchmark::State& state, int threads) {
    cores::modelled::account sum;
    const cores::modelled on{{}, threads, &sum};
    typename Operation::template on_policy<cores::modelled> ask(on);
    benchmark::DoNotOptimize(ask(on));
    sum = {};
    double serial = 0, all = 0;
    for (auto _ : state) {
        const auto before = sum;
        const double from = cores::seconds_of_thread();
        benchmark::DoNotOptimize(ask(on));
        const double time = cores::seconds_of_thread() - from;
        const double outside = time - (sum.measured - before.measured);
        serial += outside;
        all += time;
        state.SetIterationTime(outside + sum.makespan - before.makespan);
    }
    state.counters["serial_share"] = serial / all;
    state.counters["loops"] = static_cast<double>(sum.loops) / static_cast<double>(state.iterations());
}

void set(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->MinTime(0.02)->Repetitions(9)->ReportAggregatesOnly(true);
}

template <class Operation>
void add(const std::string& name) {
    for (const bool busy : {false, true}) {
        const std::string load = busy ? "/busy" : "/quiet";
        set(benchmark::RegisterBenchmark((name + "/serial" + load).c_str(), run<Operation, abut::serial>, abut::serial{},
                                         busy)
                ->UseRealTime());
        for (const int threads : {1, 2, 4, 8, 16}) {
            const std::string whole = name + "/openmp/" + std::to_string(threads) + load;
            const abut::openmp on{.threads = threads};
            set(benchmark::RegisterBenchmark(whole.c_str(), run<Operation, abut::openmp>, on, busy)->UseRealTime());
        }
    }
    for (const int threads : {1, 4, 16, 64}) {
        const std::string whole = name + "/modelled/" + std::to_string(threads);
        set(benchmark::RegisterBenchmark(whole.c_str(), model<Operation>, threads)->UseManualTime());
    }
}

}  // namespace

int main(int argc, char** argv) {
    add<arithmetic>("arithmetic");
    add<validate>("validate");
    add<build>("build");
    add<build_and_pairs>("build_and_pairs");
    add<pairs_of_scene<true>>("pairs");
    add<pairs_of_scene<false>>("unsorted");
    add<meshes<true>>("meshes_unsorted");
    add<meshes<false>>("meshes_count");
    add<sort_keys_of<345'944>>("sort_keys");
    add<sort_keys_of<40'000>>("sort_few_keys");
    add<exclusive_scan_of_many>("exclusive_scan");
    add<compact_many>("compact");
    add<gather_many>("gather");
    return bench::run_registered("bench_cores", argc, argv);
}
