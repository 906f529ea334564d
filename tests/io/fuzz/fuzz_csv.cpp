// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the CSV parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_csv.cpp -o fuzz_csv
//     ./fuzz_csv -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/csv

#include <abut/io/csv.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    fuzz::check_rows([&] {
        for (const auto& s : abut::io::parse_spheres<float>(text, "fuzz")) {
            fuzz::require(fuzz::is_finite(s.center) && s.radius >= 0 && std::isfinite(s.radius));
        }
    });
    fuzz::check_rows([&] {
        for (const auto& s : abut::io::parse_spheres<double>(text, "fuzz")) {
            fuzz::require(fuzz::is_finite(s.center) && s.radius >= 0 && std::isfinite(s.radius));
        }
    });
    fuzz::check_rows([&] {
        for (const auto& center : abut::io::parse_centers<float>(text, "fuzz")) fuzz::require(fuzz::is_finite(center));
    });
    return 0;
}
