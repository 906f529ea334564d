// SPDX-License-Identifier: MIT
//
// usage: bench_trade_cuda [OUT.json [others]]
//
// bench/trade.cpp on CUDA: the same pairs and rows, 4,194,304 of each, one a thread, by a plain kernel that calls
// `intersects`; of others than triangles neither convex hulls nor features in motion. The truth is the
// host's `exact`, of the first 65,536, which bench/trade.cpp compares with unbounded integers. Counters registers, and
// local_bytes, which is stack and spills of a thread.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "trade_others.hpp"
#include "trade_pairs.hpp"

namespace {

constexpr std::size_t pair_count = std::size_t{1} << 22, truth_count = std::size_t{1} << 16;

template <class Predicate, abut::scalar T>
using pair_of = decltype(Predicate::template make<T>(trade::input::random, 0));

template <class Predicate, abut::scalar T>
struct make_pair {
    trade::input in;
    pair_of<Predicate, T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = Predicate::template make<T>(in, i); }
};

template <class Predicate, abut::arithmetic A, abut::scalar T>
struct decide_pair {
    const pair_of<Predicate, T>* pairs;
    std::uint8_t* touches;
    ABUT_HD void operator()(std::size_t i) const {
        touches[i] = static_cast<std::uint8_t>(abut::intersects<A>(pairs[i].s, pairs[i].t));
    }
};

template <class Predicate, abut::scalar T>
void add(const abut::cuda& on, bench::table& out, trade::input in) {
    abut::execution::buffer_of<abut::cuda, pair_of<Predicate, T>> pairs(on, pair_count);
    abut::execution::buffer_of<abut::cuda, std::uint8_t> touches(on, pair_count);
    for_each_index(on, pair_count, make_pair<Predicate, T>{in, pairs.data()});
    std::vector<bool> truth;
    for (std::uint64_t i = 0; i < truth_count; ++i) {
        const auto p = Predicate::template make<T>(in, i);
        truth.push_back(abut::intersects<abut::exact>(p.s, p.t));
    }
    const auto note = [&]<abut::arithmetic A>(A) {
        const decide_pair<Predicate, A, T> decide{pairs.data(), touches.data()};
        cudaFuncAttributes kernel{};
        bench::check(cudaFuncGetAttributes(&kernel, abut::execution::detail::for_each_kernel<decide_pair<Predicate, A, T>>),
                     "cudaFuncGetAttributes");
        for_each_index(on, pair_count, decide);
        std::vector<std::uint8_t> answers(pair_count);
        touches.read(answers.data());
        trade::tally tally;
        for (std::size_t i = 0; i < truth_count; ++i) tally.add(answers[i] != 0, truth[i]);
        const double n = static_cast<double>(pair_count);
        const bench::counters says{{"pairs", n},
                                   {"hits", tally.share(tally.hits)},
                                   {"wrong_per_million", 1e6 * tally.share(tally.missed + tally.phantom)},
                                   {"missed_per_million", 1e6 * tally.share(tally.missed)},
                                   {"phantom_per_million", 1e6 * tally.share(tally.phantom)},
                                   {"registers", static_cast<double>(kernel.numRegs)},
                                   {"local_bytes", static_cast<double>(kernel.localSizeBytes)}};
        const std::string name =
            bench::joined({Predicate::name, trade::name_of(in), trade::scalar_name<T>, trade::arithmetic_name<A>});
        out.add(name, 0, [&] {
            for_each_index(on, pair_count, decide);
            return says;
        });
    };
    note(abut::fast{});
    note(abut::filtered{});
    note(abut::exact{});
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_trade_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const auto add_both = [&]<class Predicate>(Predicate) {
            for (const trade::input in : trade::inputs) {
                add<Predicate, float>(on, out, in);
                add<Predicate, double>(on, out, in);
            }
        };
        if (argc > 2 && std::string(argv[2]) == "others") {
            trade::for_each_other_predicate(add_both);
        } else {
            trade::for_each_predicate(add_both);
        }
    });
}
