// SPDX-License-Identifier: MIT
#pragma once

// Arrays of other libraries read as arrays of shapes, without a macro and without a copy: a type that holds the same numbers
// one after another will do. Vertices may be `std::array<float, 3>`, Eigen's `Vector3f`, CUDA's `float3`, a struct of x, y
// and z, or plain floats, three a vertex; spheres four floats, triangles nine, in the order of the shape's own members.
// Faces are three integers. Not for shapes of the caller's own: arrays of those are read as they are.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/shape/form.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// How many numbers of type T, one after another, a P is made of; 0 if it is made of anything else, or cannot be told to be.
template <class P, class T>
consteval std::size_t numbers_in() {
    if constexpr (std::same_as<P, T>) {
        return 1;
    } else if constexpr (std::is_pointer_v<P> || !std::is_trivially_destructible_v<P> || std::ranges::borrowed_range<P>) {
        return 0;  // it points to its numbers
    } else if constexpr (requires(const P& p, int i) {
                             { p[i] } -> std::same_as<const std::remove_cvref_t<decltype(p[i])>&>;
                         }) {
        using element = std::remove_cvref_t<decltype(std::declval<const P&>()[0])>;
        return sizeof(P) % sizeof(element) == 0 ? sizeof(P) / sizeof(element) * numbers_in<element, T>() : 0;
    } else if constexpr (std::is_standard_layout_v<P> && requires(const P& p) {
                             { p.x } -> std::same_as<const T&>;
                             { p.y } -> std::same_as<const T&>;
                             { p.z } -> std::same_as<const T&>;
                         }) {
        const bool in_order = offsetof(P, x) == 0 && offsetof(P, y) == sizeof(T) && offsetof(P, z) == 2 * sizeof(T);
        if constexpr (requires(const P& p) {
                          { p.w } -> std::same_as<const T&>;
                      }) {
            return in_order && offsetof(P, w) == 3 * sizeof(T) && sizeof(P) == 4 * sizeof(T) ? 4 : 0;
        } else {
            return in_order && sizeof(P) == 3 * sizeof(T) ? 3 : 0;
        }
    } else {
        return 0;
    }
}

/// The type of the numbers in a P; void if there are none to be seen.
template <class P>
consteval auto innermost() {
    if constexpr (std::is_arithmetic_v<P>) {
        return std::type_identity<P>{};
    } else if constexpr (requires(const P& p, int i) { p[i]; } && !std::is_pointer_v<P>) {
        return innermost<std::remove_cvref_t<decltype(std::declval<const P&>()[0])>>();
    } else if constexpr (requires(const P& p) { p.x; }) {
        return std::type_identity<std::remove_cvref_t<decltype(std::declval<const P&>().x)>>{};
    } else {
        return std::type_identity<void>{};
    }
}
template <class P>
using number_in = typename decltype(innermost<P>())::type;

/// Shapes that are numbers and nothing else: how many.
template <class S>
inline constexpr std::size_t numbers_of_shape = std::size_t{name_of<S>.numbers};
template <class T, std::size_t n>
inline constexpr std::size_t numbers_of_shape<std::array<T, n>> = n;

/// An array of P holds numbers of type T, `n` of them for each element, or one by one.
template <class P, class T, std::size_t n>
concept holds_numbers = (numbers_in<P, T>() == n && alignof(P) >= alignof(T)) || std::same_as<P, T>;

/// The type of a shape's coordinates; void where a shape is more than numbers.
template <class S>
struct number_of_shape {
    using type = void;
};
template <template <class> class S, scalar T>
    requires(numbers_of_shape<S<T>> > 0)
struct number_of_shape<S<T>> {
    using type = T;
};

/// An array of P can be read as one of S.
template <class P, class S>
concept readable_as = std::same_as<P, S> ||
    (numbers_of_shape<S> > 0 && holds_numbers<P, typename number_of_shape<S>::type, numbers_of_shape<S>>);

/// An array of P holds integers, `n` of them for each element, or one by one.
template <class P, std::size_t n>
concept holds_integers =
    std::integral<number_in<P>> && !std::same_as<number_in<P>, bool> && holds_numbers<P, number_in<P>, n>;
/// And can be read as one of n vertex indices as it is.
template <class P, std::size_t n>
concept index_row = holds_integers<P, n> && sizeof(number_in<P>) == sizeof(std::uint32_t);

/// Says what was expected instead of P; false, so that nothing else is said.
template <class S, class P>
consteval bool is_row() {
    static_assert(readable_as<P, S>,
                  "abut: expected an array whose elements are the shape's numbers and nothing else, in its scalar type: for "
                  "vertices three (abut::vec3<T>, std::array<T, 3>, a struct of x, y, z) or T itself; convert other types, "
                  "as double to float, first");
    return readable_as<P, S>;
}
template <std::size_t n, class P>
consteval bool holds_indices() {
    static_assert(
        holds_integers<P, n>,
        "abut: expected an array of vertex indices: of abut::face, std::array<int, 3> and the like (of edges: of two), "
        "or of integers one by one");
    return holds_integers<P, n>;
}
template <std::size_t n, class P>
consteval bool is_index_row() {
    static_assert(!holds_integers<P, n> || index_row<P, n>,
                  "abut: a view reads vertex indices of 32 bits as they are; make a set of others, which copies them");
    return holds_indices<n, P>() && index_row<P, n>;
}

/// Bytes from one element of S to the next in an array of P, which holds its numbers one by one if it is one of numbers.
template <class S, class P>
inline constexpr std::size_t row_stride = std::is_arithmetic_v<P> ? sizeof(S) : sizeof(P);

/// A container, or a span, whose elements lie in memory one after another.
template <class R>
concept array_like = std::ranges::contiguous_range<const R> && std::ranges::sized_range<const R>;
template <array_like R>
using element_of = std::remove_cv_t<std::ranges::range_value_t<const R>>;

/// `numbers` numbers, one by one, as elements of `each`.
inline std::size_t count_rows(std::size_t numbers, std::size_t each, const char* function) {
    if (numbers % each != 0) {
        throw error(std::string(function) + ": an array of " + std::to_string(numbers) +
                    " numbers; expected a multiple of " + std::to_string(each));
    }
    return numbers / each;
}

/// What was written through other types before this is read through ours after it: compilers may take types for a proof that
/// memory differs, and this asks them not to.
ABUT_HD inline void see_writes_to([[maybe_unused]] const void* memory) {
#if !ABUT_DEVICE_CODE
    ABUT_REREAD_ALL(memory);
#endif
}

/// The caller's array in host memory, as one of S. Throws error, in the name of `function`, where numbers are left over, and
/// where elements hold a pointer to their numbers.
template <class S, array_like R>
std::span<const S> rows_as(const R& rows, const char* function) {
    using P = element_of<R>;
    const P* const first = std::ranges::data(rows);
    const std::size_t n = std::ranges::size(rows);
    see_writes_to(first);
    if constexpr (std::same_as<P, S>) {
        return {first, n};
    } else if constexpr (std::is_arithmetic_v<P>) {
        return {reinterpret_cast<const S*>(first), count_rows(n, numbers_of_shape<S>, function)};
    } else {
        if constexpr (requires { (*first)[0]; }) {
            if (n > 0 && static_cast<const void*>(std::addressof((*first)[0])) != static_cast<const void*>(first)) {
                throw error(std::string(function) +
                            ": the elements of the array point to their numbers, and do not hold them");
            }
        }
        return {reinterpret_cast<const S*>(first), n};
    }
}

/// The caller's indices in host memory, `n` for each element, of which there are `vertices`. Throws as rows_as does, and
/// invalid_geometry for a negative one and one that is too large, with the number that the caller wrote.
template <std::size_t n, array_like R>
std::vector<std::array<std::uint32_t, n>> indices_of(const R& rows, std::size_t vertices, const char* function,
                                                     const char* element) {
    using P = element_of<R>;
    using number = number_in<P>;
    const auto all = rows_as<std::array<number, n>>(rows, function);
    std::vector<std::array<std::uint32_t, n>> made(all.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            const auto v = +all[i][k];  // of a character, the number
            if (std::cmp_less(v, 0) || std::cmp_greater_equal(v, vertices)) {
                throw invalid_geometry(function, element, i,
                                       "vertex index out of range, there are " + std::to_string(vertices) + " vertices",
                                       static_cast<double>(v));
            }
            made[i][k] = static_cast<std::uint32_t>(v);
        }
    }
    return made;
}

}  // namespace detail

}  // namespace abut
