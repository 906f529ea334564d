// SPDX-License-Identifier: MIT
#pragma once

// A mesh that a benchmark is given, in a PLY or OBJ file.

#include <cstddef>
#include <string>

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

}  // namespace bench
