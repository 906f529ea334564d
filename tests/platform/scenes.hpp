// SPDX-License-Identifier: MIT
#pragma once

// Sets and meshes for whole queries, of the same bits everywhere.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <abut/shape/set.hpp>

#include "inputs.hpp"

namespace platform {

/// Families of elements that lie near each other: their places in the 16 that samples take turns in (inputs).
inline constexpr std::uint64_t scene_families[] = {0, 2, 3, 6, 9, 10};

/// n shapes of one family; `family` is one of scene_families.
template <class S>
std::vector<S> shapes_of_family(std::uint64_t stream, std::uint64_t family, std::uint64_t n) {
    std::vector<S> made;
    for (std::uint64_t i = 1; i <= n; ++i) {
        // A multiple of 256 would be a sample of all exponents.
        const std::uint64_t index = 16 * (i + i / 16) + family;
        inputs<abut::scalar_type_of<S>> in(stream, index % 256 == 0 ? index + 16 : index);
        (void)in.point();  // what follows may touch it
        made.push_back(in.template shape<S>());
    }
    return made;
}

/// The surface of some cubes of a lattice of `side`^3: a closed mesh, with edges of four faces where cubes meet so. With
/// `moves` its vertices are a little off the lattice, and in general position.
template <abut::scalar T>
abut::mesh<T> cubes(std::uint64_t stream, int side, bool moves) {
    inputs<T> in(stream, 16);
    const auto place = [side](int x, int y, int z) {
        return static_cast<std::size_t>((x * (side + 2) + y) * (side + 2) + z);
    };
    std::vector<bool> filled(static_cast<std::size_t>((side + 2) * (side + 2) * (side + 2)), false);
    for (int x = 1; x <= side; ++x) {
        for (int y = 1; y <= side; ++y) {
            for (int z = 1; z <= side; ++z) filled[place(x, y, z)] = in.below(5) < 3;
        }
    }
    std::map<std::size_t, std::uint32_t> numbers;
    std::vector<abut::vec3<T>> vertices;
    const auto vertex = [&](const int(&p)[3]) {
        const auto [at, is_new] = numbers.emplace(place(p[0], p[1], p[2]), static_cast<std::uint32_t>(vertices.size()));
        if (is_new) {
            const auto number = [&](int k) {
                return static_cast<T>(1024 * k + (moves ? in.below(255) - 127 : 0)) * T(0x1p-9);
            };
            const T x = number(2 * p[0] - side), y = number(2 * p[1] - side);
            vertices.push_back({x, y, number(2 * p[2] - side)});
        }
        return at->second;
    };
    std::vector<abut::face> faces;
    for (int x = 0; x <= side; ++x) {
        for (int y = 0; y <= side; ++y) {
            for (int z = 0; z <= side; ++z) {
                for (int axis = 0; axis < 3; ++axis) {
                    const bool here = filled[place(x, y, z)],
                               there = filled[place(x + (axis == 0), y + (axis == 1), z + (axis == 2))];
                    if (here == there) continue;
                    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                    std::uint32_t corner[4];
                    for (int k = 0; k < 4; ++k) {
                        int p[3] = {x, y, z};
                        p[u] -= k == 0 || k == 3, p[v] -= k == 0 || k == 1;
                        corner[k] = vertex(p);
                    }
                    const int b = here ? 1 : 3, d = here ? 3 : 1;
                    faces.push_back({corner[0], corner[b], corner[2]});
                    faces.push_back({corner[0], corner[2], corner[d]});
                }
            }
        }
    }
    return abut::mesh<T>(vertices, faces);
}

/// A sheet of side^2 squares with heights and small moves along all axes; `phase` draws other ones for the same faces.
template <abut::scalar T>
abut::mesh<T> sheet(std::uint64_t stream, std::uint64_t phase, int side, bool on_lattice) {
    inputs<T> in(stream, 16 * phase + 1);
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
    for (int i = 0; i <= side; ++i) {
        for (int j = 0; j <= side; ++j) {
            const auto number = [&](int k, int spread) {
                const int by = on_lattice ? 512 * (in.below(3) - 1) : in.below(2 * spread) - spread;
                return static_cast<T>(1024 * k + by) * T(0x1p-10);
            };
            const T x = number(i, 900), y = number(j, 900);
            vertices.push_back({x, y, number(0, 1500)});
        }
    }
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const auto at = [side](int x, int y) { return static_cast<std::uint32_t>(x * (side + 1) + y); };
            faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return abut::mesh<T>(vertices, faces);
}

}  // namespace platform
