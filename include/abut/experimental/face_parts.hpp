// SPDX-License-Identifier: MIT
#pragma once

// What the rules that find pairs of features by pairs of faces know of a mesh, whatever its vertices do: which corners and
// sides of faces are which vertex and edge, and to which face each of these has been given, the first that has it.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/keys.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

/// For each vertex the corners, or for each edge the sides, that are there: 3 f + k of face f, ascending.
struct incidence_view {
    const std::uint32_t *first, *places;
    [[nodiscard]] ABUT_HD std::uint32_t begin(std::size_t i) const { return first[i]; }
    [[nodiscard]] ABUT_HD std::uint32_t end(std::size_t i) const { return first[i + 1]; }
    [[nodiscard]] ABUT_HD std::uint32_t face(std::uint32_t at) const { return places[at] / 3; }
};
template <memory_space Space>
struct incidence {
    shared_array<std::uint32_t, Space> first, places;
    [[nodiscard]] incidence_view view() const { return {first.data(), places.data()}; }
};

/// What a face knows of its features: the edges of its sides, of which a side between a vertex and itself has none; and a
/// bit for each corner k (`<< k`) and each side k (`<< 3 + k`).
struct alignas(16) face_part {
    std::uint32_t edge[3];
    std::uint32_t bits;

    /// Whether the feature has been given to this face, and is told here.
    [[nodiscard]] ABUT_HD bool has_been_given(int feature) const { return (bits >> feature & 1) != 0; }
    /// Whether it is a feature that no lower corner or side of this face is too.
    [[nodiscard]] ABUT_HD bool is_new(int feature) const { return (bits >> (6 + feature) & 1) != 0; }
};
inline constexpr int side_features = 3;  ///< features 0, 1, 2 of a face are its corners; 3, 4, 5 its sides

struct write_face_part {
    strided<abut::face> faces;
    strided<edge> edges;
    face_part* parts;

    ABUT_HD void operator()(std::size_t f) const {
        const corner_ids c = corners_of(faces, f);
        face_part made{{}, 0};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = c.of[k], w = c.of[(k + 1) % 3];
            made.edge[k] = v == w ? 0xffffffff : number_of(v < w ? v : w, v < w ? w : v);
            bool new_corner = true, new_side = v != w;
            for (int before = 0; before < k; ++before) {
                new_corner &= c.of[before] != v;
                new_side &= made.edge[before] != made.edge[k];
            }
            made.bits |= std::uint32_t{new_corner} << (6 + k) | std::uint32_t{new_side} << (6 + side_features + k);
        }
        parts[f] = made;
    }

private:
    /// Edges are in ascending order.
    [[nodiscard]] ABUT_HD std::uint32_t number_of(std::uint32_t lower, std::uint32_t upper) const {
        std::size_t first = 0, n = edges.count;
        while (n > 1) {
            const std::size_t half = n / 2;
            const std::uint32_t* const e = corners_at(edges, first + half);
            const bool is_behind = e[0] < lower || (e[0] == lower && e[1] <= upper);
            first = is_behind ? first + half : first;
            n = is_behind ? n - half : half;
        }
        return static_cast<std::uint32_t>(first);
    }
};

/// Place 3 f + k under its feature; places of no feature sort behind all.
template <bool Sides>
struct write_place {
    strided<abut::face> faces;
    const face_part* parts;
    std::size_t count;  ///< of features
    int place_bits;
    std::uint64_t* keys;
    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t k = i % 3;
        std::uint64_t feature = 0;
        if constexpr (Sides) {
            feature = parts[i / 3].edge[k] == 0xffffffff ? count : parts[i / 3].edge[k];
        } else {
            feature = corners_at(faces, i / 3)[k];
        }
        keys[i] = feature << place_bits | i;
    }
};
/// Where the places of feature i begin among all.
struct find_first_place {
    const std::uint64_t* keys;
    std::size_t count;
    int place_bits;
    std::uint32_t* first;
    ABUT_HD void operator()(std::size_t i) const {
        std::size_t at = 0, n = count;
        while (n > 0) {
            const std::size_t half = n / 2;
            const bool is_behind = (keys[at + half] >> place_bits) < i;
            at = is_behind ? at + half + 1 : at;
            n = is_behind ? n - half - 1 : half;
        }
        first[i] = static_cast<std::uint32_t>(at);
    }
};
struct take_place {
    const std::uint64_t* keys;
    int place_bits;
    std::uint32_t* places;
    ABUT_HD void operator()(std::size_t i) const {
        places[i] = static_cast<std::uint32_t>(keys[i] & ((std::uint64_t{1} << place_bits) - 1));
    }
};
/// Feature i is given to the first of its faces.
struct give_to_face {
    incidence_view of;
    std::uint32_t feature;  ///< 0 of vertices, side_features of edges
    face_part* parts;
    ABUT_HD void operator()(std::size_t i) const {
        if (of.begin(i) == of.end(i)) return;
        const std::uint32_t place = of.places[of.begin(i)];
        execution::atomic_or(&parts[place / 3].bits, 1u << (feature + place % 3));
    }
};
struct has_no_face {
    incidence_view of;
    ABUT_HD bool operator()(std::size_t i) const { return of.begin(i) == of.end(i); }
};

template <bool Sides, class Policy>
incidence<space_of<Policy>> make_incidence(const Policy& on, const strided<abut::face>& faces, const face_part* parts,
                                           std::size_t count) {
    const std::size_t places = 3 * faces.count;
    const int place_bits = id_bits(places);
    execution::buffer_of<Policy, std::uint64_t> keys(on, places);
    for_each_index(on, places, write_place<Sides>{faces, parts, count, place_bits, keys.data()});
    sort_keys(on, keys, place_bits + id_bits(count + 1));
    execution::buffer_of<Policy, std::uint32_t> first(on, count + 1), sorted(on, places);
    for_each_index(on, count + 1, find_first_place{keys.data(), places, place_bits, first.data()});
    for_each_index(on, places, take_place{keys.data(), place_bits, sorted.data()});
    synchronize(on);
    return {shared_array<std::uint32_t, space_of<Policy>>(std::move(first)),
            shared_array<std::uint32_t, space_of<Policy>>(std::move(sorted))};
}

/// What the rules of faces know of a mesh: of its faces and edges, whatever the vertices do.
template <memory_space Space>
struct face_parts {
    shared_array<face_part, Space> parts;
    shared_array<std::uint32_t, Space> loose;  ///< vertices of no face
};
/// And which faces a vertex or an edge has.
template <memory_space Space>
struct feature_incidences {
    incidence<Space> vertices, edges;
};

template <class Policy>
auto make_face_parts(const Policy& on, const strided<abut::face>& faces, const strided<edge>& edges,
                     std::size_t vertex_count, const char* function) {
    using space = space_of<Policy>;
    check_sides(faces.count, function);
    execution::buffer_of<Policy, face_part> parts(on, faces.count);
    for_each_index(on, faces.count, write_face_part{faces, edges, parts.data()});
    feature_incidences<space> all{make_incidence<false>(on, faces, parts.data(), vertex_count),
                                  make_incidence<true>(on, faces, parts.data(), edges.count)};
    for_each_index(on, vertex_count, give_to_face{all.vertices.view(), 0, parts.data()});
    for_each_index(on, edges.count, give_to_face{all.edges.view(), side_features, parts.data()});
    execution::buffer_of<Policy, std::uint64_t> loose(on, vertex_count);
    const std::size_t n = compact(on, vertex_count, has_no_face{all.vertices.view()}, loose.data());
    execution::buffer_of<Policy, std::uint32_t> kept(on, n);
    for_each_index(on, n, take_place{loose.data(), 32, kept.data()});
    synchronize(on);
    face_parts<space> made{shared_array<face_part, space>(std::move(parts)),
                           shared_array<std::uint32_t, space>(std::move(kept))};
    return std::pair(std::move(made), std::move(all));
}

}  // namespace abut::detail
