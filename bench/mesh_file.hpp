// SPDX-License-Identifier: MIT
#pragma once

// Meshes that benchmarks are given: --mesh=FILE, which Google Benchmark does not know, and what is in a PLY or OBJ file.

#include <cstddef>
#include <string>
#include <string_view>

#include <abut/io/read.hpp>

namespace bench {

/// Surface: any type with vectors `vertices` and `faces`, in float.
template <class Surface>
Surface read_surface(const std::string& path) {
    const auto mesh = abut::io::read_mesh<float>(path);
    const auto view = mesh.view();
    Surface s;
    for (std::size_t i = 0; i < view.vertices.count; ++i) s.vertices.push_back(view.vertices[i]);
    for (std::size_t i = 0; i < view.faces.count; ++i) s.faces.push_back(view.faces[i]);
    return s;
}

/// The FILE of --mesh=FILE, which is taken out of the arguments; empty if there is none.
inline std::string take_mesh_argument(int& argc, char** argv) {
    constexpr std::string_view flag = "--mesh=";
    std::string path;
    int kept = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument.starts_with(flag)) {
            path = argument.substr(flag.size());
        } else {
            argv[kept++] = argv[i];
        }
    }
    argc = kept;
    return path;
}

}  // namespace bench
