// SPDX-License-Identifier: MIT
//
// usage: bench_trade_solids_cuda [OUT.json]
//
// bench/trade.cpp on CUDA (bench/trade_cuda.hpp): the pairs of shapes that bench/trade.cu lacks. A program of its own for
// the time that it takes to compile.

#include "trade_cuda.hpp"
#include "trade_others.hpp"

int main(int argc, char** argv) {
    return trade::run("bench_trade_solids_cuda", argc, argv, [](const auto& add) { trade::for_each_solid_predicate(add); });
}
