// SPDX-License-Identifier: MIT
#pragma once

// Elements of a mesh that are equal to earlier ones: faces with the same vertices, vertices in the same place. Both are
// found in the same way: few are suspects, the suspects are sorted by all that makes them equal, and equal ones then stand
// together. So a mesh that is full of them, or was built to mislead, costs some sorts and no more.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/align.hpp>
#include <abut/shape/mesh_report.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/place_word.hpp>
#include <abut/shape/shape.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

// --- lists ----------------------------------------------------------------------------------------------------------------

template <class Policy>
using id_buffer = execution::buffer_of<Policy, std::uint32_t>;

struct add_up_tallies {
    template <class Tally>
    ABUT_HD Tally operator()(const Tally& a, const Tally& b) const {
        return a + b;
    }
};

struct same_id {
    ABUT_HD std::uint32_t operator()(std::uint32_t i) const { return i; }
};

/// out[k] = f(ids[k])
template <class F, class T>
struct evaluate_at {
    F f;
    const std::uint32_t* ids;
    T* out;
    ABUT_HD void operator()(std::size_t k) const { out[k] = f(ids[k]); }
};

template <class Policy, class F>
auto evaluated(const Policy& on, const F& f, const std::uint32_t* ids, std::size_t n) {
    using value = decltype(f(std::uint32_t{}));
    execution::buffer_of<Policy, value> out(on, n);
    for_each_index(on, n, evaluate_at<F, value>{f, ids, out.data()});
    return out;
}

template <class Policy, class T>
std::vector<T> downloaded(const Policy& on, const execution::buffer_of<Policy, T>& values) {
    std::vector<T> copy(values.size());
    download(on, values.data(), values.size(), copy.data());
    return copy;
}

/// f(i), on the host, for the i below n with test(i), ascending. Their number is at most `most`.
template <class Policy, class Test, class F = same_id>
auto listed(const Policy& on, std::size_t n, std::size_t most, const Test& test, const F& f = {}) {
    using value = decltype(f(std::uint32_t{}));
    if (most == 0) return std::vector<value>{};
    id_buffer<Policy> ids(on, most);
    ids.shrink(compact(on, n, test, ids.data()));
    return downloaded<Policy, value>(on, evaluated(on, f, ids.data(), ids.size()));
}

/// Where the run of equal elements begins that i is in. equal(j), for j <= i, says whether element j equals element i.
template <class Equal>
ABUT_HD std::size_t first_of_run(std::size_t i, const Equal& equal) {
    std::size_t begin = 0;
    while (begin < i) {
        const std::size_t middle = begin + (i - begin) / 2;
        if (equal(middle)) {
            i = middle;
        } else {
            begin = middle + 1;
        }
    }
    return i;
}

/// All but the first of equal elements, ascending, each with the first.
template <class Policy>
struct repeats {
    id_buffer<Policy> later, first;
};

template <class Same>
struct equals_one_before {
    Same same;
    const std::uint32_t* ids;
    ABUT_HD bool operator()(std::size_t i) const { return i > 0 && same(ids[i - 1], ids[i]); }
};

template <class Same>
struct write_repeats {
    Same same;
    const std::uint32_t *ids, *at;
    std::uint32_t *later, *first;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t i = at[k];
        later[k] = ids[i];
        first[k] = ids[first_of_run(i, [&](std::size_t j) { return same(ids[j], ids[i]); })];
    }
};

/// Of elements whose equals stand together, each such run ascending. same(a, b) says whether two are equal.
template <class Policy, class Same>
repeats<Policy> find_repeats(const Policy& on, const id_buffer<Policy>& ids, const Same& same) {
    id_buffer<Policy> at(on, ids.size());
    const std::size_t n = compact(on, ids.size(), equals_one_before<Same>{same, ids.data()}, at.data());
    repeats<Policy> found{id_buffer<Policy>(on, n), id_buffer<Policy>(on, n)};
    for_each_index(on, n, write_repeats<Same>{same, ids.data(), at.data(), found.later.data(), found.first.data()});
    sort_by_key(on, found.later, found.first, 32);
    return found;
}

// --- duplicate faces ------------------------------------------------------------------------------------------------------

/// Whether another face may have the same three vertices. It would share all edges, so one of them tells: that of the two
/// smaller vertices. If the edge has two faces, they do if their third vertices are equal; of more faces each may.
struct may_be_duplicate {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const {
        const bool goes_back = !table.is_first(i), goes_ahead = table.goes_on(i, 1);
        if (!table.is_edge(i) || (!goes_back && !goes_ahead)) return false;
        const bool is_second = goes_back && !goes_ahead && table.is_first(i - 1);
        if (is_second || (!goes_back && !table.goes_on(i, 2))) {
            const std::size_t other = is_second ? i - 1 : i + 1;
            // What the keys have of the third vertices saves nearly all reads of faces.
            const bool may = ((table.keys[i] ^ table.keys[other]) & ~half_edge_key::backward_bit) == 0;
            if (!may || table.opposite(i) != table.opposite(other)) return false;
        }
        return table.opposite(i) > table.upper(i);
    }
};

struct opposite_of {
    sorted_half_edges table;
    ABUT_HD std::uint32_t operator()(std::uint32_t i) const { return table.opposite(i); }
};
struct edge_of {
    sorted_half_edges table;
    ABUT_HD std::uint64_t operator()(std::uint32_t i) const { return table.edge(i); }
};
struct face_of_half_edge {
    sorted_half_edges table;
    ABUT_HD std::uint32_t operator()(std::uint32_t i) const { return table.face_of(i); }
};

struct same_vertices {
    strided<face> faces;
    ABUT_HD bool operator()(std::uint32_t f, std::uint32_t g) const {
        const corner_ids a = corners_of(faces, f), b = corners_of(faces, g);
        bool same = true;
        for (const std::uint32_t v : a.of) same = same && (v == b.of[0] || v == b.of[1] || v == b.of[2]);
        return same;  // neither repeats an index
    }
};

/// Whether the vertices of a face ascend, seen from the right one.
ABUT_HD inline bool turns_upwards(const corner_ids& c) {
    return (c.of[0] < c.of[1]) + (c.of[1] < c.of[2]) + (c.of[2] < c.of[0]) == 2;
}

struct write_duplicate {
    strided<face> faces;
    const std::uint32_t *later, *first;
    duplicate_face* out;
    ABUT_HD void operator()(std::size_t k) const {
        const bool reversed = turns_upwards(corners_of(faces, later[k])) != turns_upwards(corners_of(faces, first[k]));
        out[k] = {later[k], first[k], reversed};
    }
};

template <class Policy>
std::vector<duplicate_face> find_duplicates(const Policy& on, const sorted_half_edges& table, std::size_t most) {
    if (most == 0) return {};
    id_buffer<Policy> at(on, most);
    compact(on, table.count, may_be_duplicate{table}, at.data());
    // By edge and third vertex: faces of the same three stand together then, and ascend, since sorts are stable.
    auto third = evaluated(on, opposite_of{table}, at.data(), most);
    sort_by_key(on, third, at, table.key.vertex_bits);
    auto edge = evaluated(on, edge_of{table}, at.data(), most);
    sort_by_key(on, edge, at, 2 * table.key.vertex_bits);
    const auto faces = evaluated(on, face_of_half_edge{table}, at.data(), most);
    const auto found = find_repeats(on, faces, same_vertices{table.faces});
    execution::buffer_of<Policy, duplicate_face> duplicates(on, found.later.size());
    for_each_index(on, duplicates.size(),
                   write_duplicate{table.faces, found.later.data(), found.first.data(), duplicates.data()});
    return downloaded<Policy, duplicate_face>(on, duplicates);
}

// --- vertices in one place ------------------------------------------------------------------------------------------------

/// Any 32 bits will do that vertices in one place share and few others do: it costs time where others share them.
template <scalar T>
struct hash_of_place {
    strided<vec3<T>> vertices;
    ABUT_HD std::uint32_t operator()(std::uint32_t v) const {
        const vec3<T> p = vertices[v];
        std::uint64_t h = 0;
        const T coordinates[3] = {p.x, p.y, p.z};
        for (const T x : coordinates) {
            h = (h ^ place_word(x)) * 0x9e3779b97f4a7c15u;
            h ^= h >> 32;
        }
        return static_cast<std::uint32_t>(h);
    }
};

template <scalar T>
struct coordinate_word {
    strided<vec3<T>> vertices;
    int axis;
    ABUT_HD auto operator()(std::uint32_t v) const {
        const vec3<T> p = vertices[v];
        return place_word(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
    }
};

template <scalar T>
struct same_place {
    strided<vec3<T>> vertices;
    ABUT_HD bool operator()(std::uint32_t u, std::uint32_t v) const {
        const vec3<T> p = vertices[u], q = vertices[v];
        return is_valid(p) && in_one_place(p, q);
    }
};

/// Whether a neighbour in a sorted array is equal.
struct has_equal_neighbour {
    const std::uint32_t* keys;
    std::size_t count;
    ABUT_HD bool operator()(std::size_t i) const {
        return (i > 0 && keys[i - 1] == keys[i]) || (i + 1 < count && keys[i] == keys[i + 1]);
    }
};
template <class Test>
struct one_if {
    Test test;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return test(i) ? 1 : 0; }
};

struct id_at {
    const std::uint32_t* ids;
    ABUT_HD std::uint32_t operator()(std::uint32_t i) const { return ids[i]; }
};

struct write_coincident {
    const std::uint32_t *later, *first;
    coincident_vertex* out;
    ABUT_HD void operator()(std::size_t k) const { out[k] = {later[k], first[k]}; }
};

/// The vertices that lie where an earlier one does, each with the first there. What is not finite lies nowhere.
template <class Policy, scalar T>
repeats<Policy> find_repeated_places(const Policy& on, const strided<vec3<T>>& vertices) {
    const std::size_t n = vertices.count;
    id_buffer<Policy> ids(on, n);
    for_each_index(on, n, execution::write_index<std::uint32_t>{ids.data()});
    auto hashes = evaluated(on, hash_of_place<T>{vertices}, ids.data(), n);
    sort_by_key(on, hashes, ids, 32);
    const has_equal_neighbour suspect{hashes.data(), n};
    const std::uint64_t most = reduce(on, n, std::uint64_t{0}, add_up_tallies{}, one_if<has_equal_neighbour>{suspect});
    if (most == 0) return {id_buffer<Policy>(on, 0), id_buffer<Policy>(on, 0)};

    id_buffer<Policy> at(on, most);
    compact(on, n, suspect, at.data());
    auto suspects = evaluated(on, id_at{ids.data()}, at.data(), most);
    // By all bits of all coordinates, so that a hash that was built to collide costs three sorts and no more.
    for (const int axis : {2, 1, 0}) {
        auto words = evaluated(on, coordinate_word<T>{vertices, axis}, suspects.data(), most);
        sort_by_key(on, words, suspects, 8 * static_cast<int>(sizeof(T)));
    }
    return find_repeats(on, suspects, same_place<T>{vertices});
}

template <class Policy, scalar T>
std::vector<coincident_vertex> find_coincident(const Policy& on, const strided<vec3<T>>& vertices) {
    const auto found = find_repeated_places(on, vertices);
    if (found.later.size() == 0) return {};
    execution::buffer_of<Policy, coincident_vertex> coincident(on, found.later.size());
    for_each_index(on, coincident.size(), write_coincident{found.later.data(), found.first.data(), coincident.data()});
    return downloaded<Policy, coincident_vertex>(on, coincident);
}

}  // namespace abut::detail
