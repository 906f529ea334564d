// SPDX-License-Identifier: MIT
//
// A fuzz target (libFuzzer, AFL++) of the glTF parser: whatever the bytes, it returns a sound result or throws
// io_error. Build and run, from the root of the repository:
//
//     clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined -Iinclude tests/io/fuzz/fuzz_gltf.cpp -o fuzz_gltf
//     ./fuzz_gltf -max_total_time=600 -max_len=4096 -timeout=10 corpus tests/io/seeds/gltf

#include <abut/io/gltf.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    fuzz::check_mesh<float>([&] { return abut::io::parse_gltf<float>(bytes, "fuzz"); });
    fuzz::check_mesh<double>([&] { return abut::io::parse_gltf<double>(bytes, "fuzz"); });
    fuzz::check_rows([&] {
        const auto scene = abut::io::parse_gltf_parts<float>(bytes, "fuzz");
        for (const auto& part : scene.parts) {
            fuzz::require(part.mesh < scene.meshes.size() && fuzz::is_finite(part.pose.translation));
            for (const float x : part.pose.rotation) fuzz::require(std::isfinite(x));
        }
        for (const auto& mesh : scene.meshes) fuzz::check_mesh<float>([&] { return mesh; });
    });
    return 0;
}
