// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the OFF parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_off.cpp -o fuzz_off
//     ./fuzz_off -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/off

#include <abut/io/off.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    fuzz::check_mesh<float>([&] { return abut::io::parse_off<float>(bytes, "fuzz"); });
    fuzz::check_mesh<double>([&] { return abut::io::parse_off<double>(bytes, "fuzz", {.lenient = true}); });
    return 0;
}
