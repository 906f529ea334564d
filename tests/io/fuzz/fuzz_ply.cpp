// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the PLY parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_ply.cpp -o fuzz_ply
//     ./fuzz_ply -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/ply

#include <abut/io/ply.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    fuzz::check_mesh<float>([&] { return abut::io::parse_ply<float>(bytes, "fuzz"); });
    fuzz::check_mesh<double>([&] { return abut::io::parse_ply<double>(bytes, "fuzz"); });
    fuzz::check_mesh<float>([&] { return abut::io::parse_ply<float>(bytes, "fuzz", {.lenient = true}); });
    return 0;
}
