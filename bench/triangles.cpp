// SPDX-License-Identifier: MIT
//
// usage: bench_triangles --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json [--triangles=N]
//
// Triangles against triangles. N is the largest number of triangles against one, 10,000,000 if it is not given; 35,000,000
// is that of Maffina, 2012, and needs 8 GB of memory. Names:
//
//   pair/ARITHMETIC/SCALAR/PERCENT   pairs with so many hits, decided one by one: new triangles on both sides of each, no
//   box
//                                    test in front; the peers (bench/triangles/) decide the same pairs
//   family/ARITHMETIC/SCALAR/NAME    the families of tests/support/triangle_families.hpp; the counters first, late, word,
//                                    one_limb, two_limbs and any_span are the shares that each stage of `filtered` decides
//   read/SCALAR/POLICY/N             a loop that reads the bytes of N triangles and does nothing else
//   one/QUERY/ARITHMETIC/SCALAR/PERCENT/POLICY/N   one triangle against N; QUERY is count, any or pairs
//   many/QUERY/ARITHMETIC/SCALAR/POLICY/N          N triangles against N others
//
// bench/report.py makes tables of it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "triangle_scene.hpp"

namespace {

namespace test = abut::test;
namespace scene = triangle_scene;
using bench::joined;

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

template <class A>
const char* name_of(A) {
    return std::is_same_v<A, abut::fast> ? "fast" : std::is_same_v<A, abut::filtered> ? "filtered" : "exact";
}
const char* name_of(const abut::serial&) { return "serial"; }
const char* name_of(const abut::openmp&) { return "openmp"; }

// --- pairs, one by one ----------------------------------------------------------------------------------------------------

template <abut::scalar T>
using pairs_of = std::vector<test::triangle_pair<T>>;

/// Made at first use, and the same for each arithmetic.
template <abut::scalar T>
const pairs_of<T>& random_pairs(const scene::hit_share& share) {
    static std::map<std::string, pairs_of<T>> made;
    auto [found, fresh] = made.try_emplace(share.percent);
    for (std::uint64_t i = 0; fresh && i < scene::pair_count; ++i) {
        found->second.push_back(scene::random_pair<T>(share.spread, i));
    }
    return found->second;
}

template <abut::scalar T>
const pairs_of<T>& family_pairs(test::triangle_family family) {
    constexpr std::uint64_t count = 1 << 14;
    static std::map<test::triangle_family, pairs_of<T>> made;
    auto [found, fresh] = made.try_emplace(family);
    for (std::uint64_t i = 0; fresh && i < count; ++i) {
        found->second.push_back(test::make_triangle_pair<T>(scene::seed, family, i));
    }
    return found->second;
}

/// Which stage of `filtered` decides, as shares of all pairs.
template <abut::scalar T>
void note_stages(benchmark::State& state, const pairs_of<T>& pairs) {
    using predicate = abut::detail::triangle_meets_triangle;
    std::uint64_t first = 0, late = 0, word = 0, one_limb = 0, two_limbs = 0, any_span = 0;
    const auto is_late = [](const auto& a, const auto& b) {
        if constexpr (requires { abut::decide_late<abut::filtered>(a, b); }) {
            return abut::decide_late<abut::filtered>(a, b) != abut::verdict::unknown;
        } else {
            return false;
        }
    };
    for (const auto& [a, b] : pairs) {
        const abut::aligned<18> integers(abut::detail::values_of(a, b).value);
        const int width = integers.width();
        ++(abut::decide<abut::filtered>(a, b) != abut::verdict::unknown ? first
           : is_late(a, b)                                              ? late
           : width <= abut::detail::word_digits<predicate>              ? word
           : width <= 59                                                ? one_limb
           : width <= 124                                               ? two_limbs
                                                                        : any_span);
    }
    const auto note = [&](const char* name, std::uint64_t n) {
        state.counters[name] = static_cast<double>(n) / static_cast<double>(pairs.size());
    };
    note("first", first);
    note("late", late);
    note("word", word);
    note("one_limb", one_limb);
    note("two_limbs", two_limbs);
    note("any_span", any_span);
}

template <abut::arithmetic A, abut::scalar T>
void decide_all(benchmark::State& state, const pairs_of<T>& pairs) {
    std::size_t hits = 0;
    for (auto _ : state) {
        hits = 0;
        for (const auto& [a, b] : pairs) hits += abut::intersects<A>(a, b) ? 1 : 0;
        benchmark::DoNotOptimize(hits);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(pairs.size()) * static_cast<std::int64_t>(state.iterations()));
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(pairs.size());
    if constexpr (std::same_as<A, abut::filtered>) note_stages(state, pairs);
}

template <abut::arithmetic A, abut::scalar T>
void pair(benchmark::State& state, const scene::hit_share& share) {
    decide_all<A>(state, random_pairs<T>(share));
}

template <abut::arithmetic A, abut::scalar T>
void family(benchmark::State& state, test::triangle_family which) {
    decide_all<A>(state, family_pairs<T>(which));
}

// --- one against many -----------------------------------------------------------------------------------------------------

enum class kind : int { miss, few, half };
constexpr const char* percent_of(kind k) {
    return k == kind::miss ? "0" : scene::one_shares[k == kind::few ? 0 : 1].percent;
}

/// The first n triangles of a scene. All are kept: runs are interleaved.
const abut::triangle_soup<float>& soup(kind which, std::size_t n) {
    static std::map<std::pair<kind, std::size_t>, abut::triangle_soup<float>> made;
    auto [found, fresh] = made.try_emplace({which, n});
    if (fresh) {
        std::vector<abut::triangle<float>> triangles(n);
        for_each_index(abut::openmp{}, n, [&](std::size_t i) {
            triangles[i] = which == kind::miss
                               ? scene::missing_triangle<float>(i)
                               : scene::random_triangle<float>(scene::one_shares[which == kind::few ? 0 : 1].spread, i);
        });
        found->second = abut::triangle_soup<float>(triangles);
    }
    return found->second;
}

struct count_query {
    static constexpr const char* name = "count";
    template <abut::arithmetic A>
    static std::uint64_t ask(const auto& on, const auto& a, const auto& b) {
        return abut::count<A>(on, a, b);
    }
};
struct any_query {
    static constexpr const char* name = "any";
    template <abut::arithmetic A>
    static std::uint64_t ask(const auto& on, const auto& a, const auto& b) {
        return abut::any<A>(on, a, b) ? 1 : 0;
    }
};
struct pairs_query {
    static constexpr const char* name = "pairs";
    template <abut::arithmetic A>
    static std::uint64_t ask(const auto& on, const auto& a, const auto& b) {
        return abut::pairs<A>(on, a, b).size();
    }
};

template <class Query, abut::arithmetic A, class Policy>
void one(benchmark::State& state, Policy on, kind which, std::size_t n) {
    const auto& many = soup(which, n);
    std::uint64_t found = 0;
    for (auto _ : state) found = Query::template ask<A>(on, scene::reference<float>(), many);
    state.SetItemsProcessed(static_cast<std::int64_t>(n) * static_cast<std::int64_t>(state.iterations()));
    state.counters["found"] = static_cast<double>(found);
}

/// Each thread reads a part. Sums of words, in four chains, since one would wait for itself.
struct sum_of_words {
    const unsigned char* data;
    std::size_t bytes, grain;
    std::uint64_t operator()(std::size_t part) const {
        std::uint64_t sums[4] = {0, 0, 0, 0}, word[4];
        const std::size_t end = std::min(bytes, (part + 1) * grain);
        for (std::size_t at = part * grain; at + sizeof(word) <= end; at += sizeof(word)) {
            std::memcpy(word, data + at, sizeof(word));
            for (int k = 0; k < 4; ++k) sums[k] += word[k];
        }
        return sums[0] + sums[1] + sums[2] + sums[3];
    }
};

template <class Policy>
void read(benchmark::State& state, Policy on, std::size_t n) {
    const auto& many = soup(kind::few, n);
    const std::size_t bytes = n * sizeof(abut::triangle<float>), grain = 1 << 15;
    const sum_of_words part{reinterpret_cast<const unsigned char*>(many.view().shapes.data), bytes, grain};
    const auto plus = [](std::uint64_t a, std::uint64_t b) { return a + b; };
    for (auto _ : state) benchmark::DoNotOptimize(reduce(on, (bytes + grain - 1) / grain, std::uint64_t{0}, plus, part));
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * static_cast<std::int64_t>(state.iterations()));
}

// --- many against many ----------------------------------------------------------------------------------------------------

const abut::triangle_soup<float>& one_of_two(std::uint64_t stream, std::size_t n) {
    static std::map<std::pair<std::uint64_t, std::size_t>, abut::triangle_soup<float>> made;
    auto [found, fresh] = made.try_emplace({stream, n});
    if (fresh) {
        std::vector<abut::triangle<float>> triangles;
        for (std::uint64_t i = 0; i < n; ++i)
            triangles.push_back(scene::random_triangle<float>(scene::many_spread, i, stream));
        found->second = abut::triangle_soup<float>(triangles);
    }
    return found->second;
}

template <class Query, abut::arithmetic A, class Policy>
void many(benchmark::State& state, Policy on, std::size_t n) {
    const auto &a = one_of_two(scene::stream_of_a, n), &b = one_of_two(scene::stream_of_b, n);
    std::uint64_t found = 0;
    for (auto _ : state) found = Query::template ask<A>(on, a, b);
    state.SetItemsProcessed(static_cast<std::int64_t>(n * n) * static_cast<std::int64_t>(state.iterations()));
    state.counters["found"] = static_cast<double>(found);
}

// --- the list -------------------------------------------------------------------------------------------------------------

/// One run takes about so many milliseconds; long ones run once in a repetition.
template <class... Arguments>
benchmark::internal::Benchmark* add(const std::string& name, int times, double milliseconds, Arguments&&... arguments) {
    auto* const b = benchmark::RegisterBenchmark(name.c_str(), std::forward<Arguments>(arguments)...);
    b->Unit(benchmark::kMillisecond)->Repetitions(times)->ReportAggregatesOnly(true);
    return milliseconds > 5 ? b->Iterations(1) : b->MinTime(0.01);
}

/// One thread is timed by the processor; `openmp` by the wall's clock, since its threads work for it.
template <class Policy, class... Arguments>
void add_on(const Policy&, const std::string& name, int times, double milliseconds, Arguments&&... arguments) {
    auto* const b = add(name, times, milliseconds, std::forward<Arguments>(arguments)...);
    if (std::is_same_v<Policy, abut::openmp>) b->UseRealTime();
}

template <abut::arithmetic A, abut::scalar T>
void add_pairs() {
    for (const auto& share : scene::pair_shares) {
        add(joined({"pair", name_of(A{}), scalar_name<T>, share.percent}), 11, 1, pair<A, T>, share);
    }
}

template <abut::arithmetic A, abut::scalar T>
void add_families() {
    for (int f = 0; f < test::triangle_family_count; ++f) {
        const auto which = static_cast<test::triangle_family>(f);
        add(joined({"family", name_of(A{}), scalar_name<T>, test::name_of(which)}), 5, 1, family<A, T>, which);
    }
}

template <class Query, abut::arithmetic A, class Policy>
void add_one(const Policy& on, kind which, std::size_t n) {
    const std::string name =
        joined({"one", Query::name, name_of(A{}), "float", percent_of(which), name_of(on), std::to_string(n)});
    add_on(on, name, 7, static_cast<double>(n) * 5e-6, one<Query, A, Policy>, on, which, n);
}

template <abut::arithmetic A, class Policy>
void add_arithmetic(const Policy& on, std::size_t n) {
    add_one<any_query, A>(on, kind::miss, n);
    for (const kind which : {kind::few, kind::half}) {
        add_one<count_query, A>(on, which, n);
        if (std::is_same_v<A, abut::filtered>) add_one<pairs_query, abut::filtered>(on, which, n);
    }
}

template <class Query, abut::arithmetic A, class Policy>
void add_many(const Policy& on, std::size_t n) {
    const std::string name = joined({"many", Query::name, name_of(A{}), "float", name_of(on), std::to_string(n)});
    add_on(on, name, n > 10000 ? 3 : 7, static_cast<double>(n) * static_cast<double>(n) * 2e-6, many<Query, A, Policy>, on,
           n);
}

template <class Policy>
void add_policy(const Policy& on, std::size_t most) {
    for (const std::size_t n : scene::one_sizes) {
        if (n > most) continue;
        const std::string name = joined({"read/float", name_of(on), std::to_string(n)});
        add_on(on, name, 7, static_cast<double>(n) * 5e-6, read<Policy>, on, n);
        add_arithmetic<abut::fast>(on, n);
        add_arithmetic<abut::filtered>(on, n);
    }
    for (const std::size_t n : {2'000u, 20'000u}) {
        add_many<count_query, abut::fast>(on, n);
        add_many<count_query, abut::filtered>(on, n);
        add_many<pairs_query, abut::filtered>(on, n);
    }
}

template <abut::scalar T>
void add_scalar() {
    add_pairs<abut::fast, T>();
    add_pairs<abut::filtered, T>();
    add_pairs<abut::exact, T>();
    add_families<abut::fast, T>();
    add_families<abut::filtered, T>();
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t most = std::stoull(bench::take_argument(argc, argv, "--triangles", "10000000"));
    add_scalar<float>();
    add_scalar<double>();
    add_policy(abut::serial{}, most);
    add_policy(abut::openmp{}, most);
    return bench::run_registered("bench_triangles", argc, argv);
}
