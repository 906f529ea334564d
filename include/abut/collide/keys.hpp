// SPDX-License-Identifier: MIT
#pragma once

// Pairs as numbers: how two ids are packed into one, and what kernels see of two operands by such a number. Not how pairs
// are found: routes.hpp.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/collide/options.hpp>
#include <abut/config.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

/// Number of bits that ids below n need.
constexpr int id_bits(std::size_t n) { return bits_up_to(n > 0 ? n - 1 : 0); }

/// A pair travels as one number, a's id above b's, in as few bits as the sets need: sorting is then a short radix sort.
struct pair_key {
    int a_bits, b_bits;

    [[nodiscard]] int bits() const { return a_bits + b_bits; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t a, std::uint32_t b) const {
        return std::uint64_t{a} << b_bits | b;
    }
    [[nodiscard]] ABUT_HD std::uint32_t a(std::uint64_t key) const { return static_cast<std::uint32_t>(key >> b_bits); }
    [[nodiscard]] ABUT_HD std::uint32_t b(std::uint64_t key) const {
        return static_cast<std::uint32_t>(key & ((std::uint64_t{1} << b_bits) - 1));
    }
    [[nodiscard]] ABUT_HD index_pair unpack(std::uint64_t key) const { return {a(key), b(key)}; }
};

/// A set of one shape.
template <class View>
inline constexpr bool is_single = false;
template <class Shape, memory_space Space>
inline constexpr bool is_single<single_view<Shape, Space>> = true;

/// What a kernel sees of a pairing: the shapes of both operands by the key of a pair, and which pairs are wanted.
template <shape_view A, shape_view B, class Filter>
struct pair_view {
    using shape_type_a = typename A::shape_type;
    using shape_type_b = typename B::shape_type;
    A a;
    B b;
    pair_key key;
    Filter filter;

    [[nodiscard]] ABUT_HD shape_type_a shape_a(std::uint64_t k) const { return a[key.a(k)]; }
    [[nodiscard]] ABUT_HD shape_type_b shape_b(std::uint64_t k) const { return b[key.b(k)]; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t id_a, std::uint32_t id_b) const { return key.pack(id_a, id_b); }
    [[nodiscard]] ABUT_HD index_pair ids(std::uint64_t k) const { return key.unpack(k); }
    /// The vertices of triangles.
    [[nodiscard]] ABUT_HD corner_ids vertices_a(std::uint64_t k) const { return vertices_of_shape(a, key.a(k)); }
    [[nodiscard]] ABUT_HD corner_ids vertices_b(std::uint64_t k) const { return vertices_of_shape(b, key.b(k)); }
    /// The same of a contact.
    template <class Contact>
    [[nodiscard]] ABUT_HD Contact tagged(std::uint64_t k, Contact c) const {
        c.a = key.a(k);
        c.b = key.b(k);
        return c;
    }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t id_a, std::uint32_t id_b) const { return filter(id_a, id_b); }
    ABUT_INLINE void prefetch(std::uint64_t k, int step) const {
        prefetch_shape(a, key.a(k), step);
        prefetch_shape(b, key.b(k), step);
    }
};

// Of a row of one operand and what it finds in the other; `RowsAreB` says whose shapes the rows are.

template <bool RowsAreB, class Ids>
ABUT_HD std::uint64_t pack_row(const Ids& ids, std::uint32_t row, std::uint32_t found) {
    return RowsAreB ? ids.pack(found, row) : ids.pack(row, found);
}
ABUT_CALLS_ANY
template <bool RowsAreB, class Ids>
ABUT_HD bool is_wanted_by_row(const Ids& ids, std::uint32_t row, std::uint32_t found) {
    return RowsAreB ? ids.wanted(found, row) : ids.wanted(row, found);
}

}  // namespace abut::detail
