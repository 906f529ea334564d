// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the CSV parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_csv.cpp -o fuzz_csv
//     ./fuzz_csv -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/csv

#include <abut/io/csv.hpp>
#include <abut/io/read_parts.hpp>

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
    fuzz::check_rows([&] {
        const auto no_mesh = [](const std::string&) { return abut::io::mesh_data<float>{}; };
        const auto scene = abut::io::parse_parts<float>(text, "fuzz", no_mesh);
        for (const auto& part : scene.parts) {
            fuzz::require(part.mesh < scene.meshes.size() && fuzz::is_finite(part.pose.translation));
            for (const float x : part.pose.rotation) fuzz::require(std::isfinite(x));
        }
    });
    return 0;
}
