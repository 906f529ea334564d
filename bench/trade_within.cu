// SPDX-License-Identifier: MIT
//
// usage: bench_trade_within_cuda [OUT.json]
//
// bench/trade.cpp on CUDA (bench/trade_cuda.hpp): pairs that are asked whether they are within a distance. A program of its
// own, which takes as long to compile as bench/trade.cu.

#include "trade_cuda.hpp"
#include "trade_others.hpp"

int main(int argc, char** argv) {
    return trade::run("bench_trade_within_cuda", argc, argv,
                      [](const auto& add) { trade::for_each_distance_predicate(add); });
}
