// SPDX-License-Identifier: MIT
//
// usage: bench_trade_cuda [OUT.json [others]]
//
// bench/trade.cpp on CUDA (bench/trade_cuda.hpp): pairs with a triangle, or with `others` those without and rays. Distances
// are in bench/trade_within.cu, and features in motion in bench/motion.cu.

#include <string>

#include "trade_cuda.hpp"
#include "trade_others.hpp"

int main(int argc, char** argv) {
    return trade::run("bench_trade_cuda", argc, argv, [&](const auto& add) {
        if (argc > 2 && std::string(argv[2]) == "others") {
            trade::for_each_other_predicate(add);
        } else {
            trade::for_each_predicate(add);
        }
    });
}
