// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the OBJ parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_obj.cpp -o fuzz_obj
//     ./fuzz_obj -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/obj

#include <abut/io/obj.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    fuzz::check_mesh<float>([&] { return abut::io::parse_obj<float>(text, "fuzz"); });
    fuzz::check_mesh<double>([&] { return abut::io::parse_obj<double>(text, "fuzz"); });
    fuzz::check_mesh<float>([&] { return abut::io::parse_obj<float>(text, "fuzz", {.lenient = true}); });
    return 0;
}
