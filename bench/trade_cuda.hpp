// SPDX-License-Identifier: MIT
#pragma once

// The pairs and rows of bench/trade.cpp on CUDA, 4,194,304 of each, one a thread, by a plain kernel that calls `intersects`
// or `within`. The truth is the host's `exact`, of the first 65,536, which bench/trade.cpp compares with unbounded integers.
// Counters registers, and local_bytes, which is stack and spills of a thread.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "trade_pairs.hpp"

namespace trade {

inline constexpr std::size_t pair_count = std::size_t{1} << 22, truth_count = std::size_t{1} << 16;

template <class Predicate, abut::scalar T>
using pair_of = decltype(Predicate::template make<T>(input::random, 0));

template <class Predicate, abut::scalar T>
struct make_pair {
    input in;
    pair_of<Predicate, T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = Predicate::template make<T>(in, i); }
};

template <class Predicate, abut::arithmetic A, abut::scalar T>
struct decide_pair {
    const pair_of<Predicate, T>* pairs;
    std::uint8_t* touches;
    ABUT_HD void operator()(std::size_t i) const { touches[i] = static_cast<std::uint8_t>(answer<A>(pairs[i])); }
};

/// A row of the first n pairs, which decide(i) decides into touches[i]; the truth of as many as it is known of.
template <class Decide>
void add_row(const abut::cuda& on, bench::table& out, const std::string& name, std::size_t n, const std::vector<bool>& truth,
             const abut::execution::buffer_of<abut::cuda, std::uint8_t>& touches, const Decide& decide) {
    cudaFuncAttributes kernel{};
    bench::check(cudaFuncGetAttributes(&kernel, abut::execution::detail::for_each_kernel<Decide>), "cudaFuncGetAttributes");
    for_each_index(on, n, decide);
    std::vector<std::uint8_t> answers(n);
    touches.read(answers.data());
    tally all;
    for (std::size_t i = 0; i < truth.size(); ++i) all.add(answers[i] != 0, truth[i]);
    const bench::counters says{{"pairs", static_cast<double>(n)},
                               {"hits", all.share(all.hits)},
                               {"wrong_per_million", 1e6 * all.share(all.missed + all.phantom)},
                               {"missed_per_million", 1e6 * all.share(all.missed)},
                               {"phantom_per_million", 1e6 * all.share(all.phantom)},
                               {"registers", static_cast<double>(kernel.numRegs)},
                               {"local_bytes", static_cast<double>(kernel.localSizeBytes)}};
    out.add(name, 0, [&] {
        for_each_index(on, n, decide);
        return says;
    });
}

template <class Predicate, abut::scalar T>
void add(const abut::cuda& on, bench::table& out, input in) {
    abut::execution::buffer_of<abut::cuda, pair_of<Predicate, T>> pairs(on, pair_count);
    abut::execution::buffer_of<abut::cuda, std::uint8_t> touches(on, pair_count);
    for_each_index(on, pair_count, make_pair<Predicate, T>{in, pairs.data()});
    std::vector<bool> truth;
    for (std::uint64_t i = 0; i < truth_count; ++i) {
        truth.push_back(answer<abut::exact>(Predicate::template make<T>(in, i)));
    }
    const auto note = [&]<abut::arithmetic A>(A) {
        const std::string name = bench::joined({Predicate::name, name_of(in), scalar_name<T>, arithmetic_name<A>});
        add_row(on, out, name, pair_count, truth, touches, decide_pair<Predicate, A, T>{pairs.data(), touches.data()});
    };
    note(abut::fast{});
    note(abut::filtered{});
    note(abut::exact{});
}

/// The main of a program: rows of each Predicate for which for_each(add) calls add(Predicate{}).
template <class ForEach>
int run(const char* program, int argc, char** argv, const ForEach& for_each) {
    return bench::run(program, argc, argv, [&](const abut::cuda& on, bench::table& out) {
        for_each([&]<class Predicate>(Predicate) {
            for (const input in : inputs) {
                add<Predicate, float>(on, out, in);
                add<Predicate, double>(on, out, in);
            }
        });
    });
}

}  // namespace trade
