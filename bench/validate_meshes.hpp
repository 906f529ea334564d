// SPDX-License-Identifier: MIT
#pragma once

// The meshes of bench/validate.cpp and bench/validate.cu: tori, closed and without defects, so that everything is looked at
// and nothing is listed; and the same with vertices and faces in random order, where each read of a neighbour is a cache
// miss.

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <abut/shape/set.hpp>

#include "../tests/support/scenes.hpp"

namespace validate_meshes {

struct size {
    std::uint32_t around, across;
    [[nodiscard]] std::size_t faces() const { return std::size_t{2} * around * across; }
};
/// About as many triangles as the full scan of the Stanford armadillo (345,944), and ten million.
inline constexpr size sizes[] = {{558, 310}, {2500, 2000}};

enum class order { of_the_torus, random };
inline const char* name_of(order o) { return o == order::random ? "random" : "in_order"; }

template <class T>
struct arrays {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
};

template <class T>
arrays<T> make(size n, order o) {
    abut::test::torus<T> shape(n.around, n.across, 2, 1);
    if (o == order::of_the_torus) return {shape.vertices, shape.faces};
    abut::test::uniform random(1);
    std::vector<std::uint32_t> to(shape.vertices.size());
    std::iota(to.begin(), to.end(), 0u);
    to = abut::test::shuffled(to, random);
    arrays<T> made{shape.vertices, abut::test::shuffled(shape.faces, random)};
    for (std::size_t v = 0; v < to.size(); ++v) made.vertices[to[v]] = shape.vertices[v];
    for (abut::face& f : made.faces) f = {to[f[0]], to[f[1]], to[f[2]]};
    return made;
}

}  // namespace validate_meshes
