// SPDX-License-Identifier: MIT
#pragma once

// self_pairs, count_self_pairs: which shapes of one set touch each other; for a mesh, where it passes through or folds onto
// itself. The argument is a set (an owner or a view), or an index over one, posed or not; where it is no index, all shapes
// are compared with all, in tiles.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/collide/options.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/predicate/face_face.hpp>
#include <abut/shape/mesh_face.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// @defgroup self_collision Which shapes of one set touch each other
///
/// `self_pairs` and `count_self_pairs` of a set, a view, or an index over a set, posed or not. For a mesh: where it passes
/// through itself or folds onto itself.
///
/// @par Memory
/// As in @ref queries : sets and indices lie in the policy's memory, a set in host memory is copied for the call under
/// `cuda`, and the result lies in the policy's memory, 8 bytes a pair.
///
/// @par Errors
/// Those of @ref queries.
///
/// @par Synchronisation
/// Each call returns when its answer is complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp self_collision
///@{

/// Which vertices of two faces are one.
enum class coincident_vertices : unsigned char {
    /// Those of one index. Corners of a soup are all different.
    distinct,
    /// Those in one place, where the query's pose puts them: for meshes that were never welded, and soups. -0.0 is 0.0.
    merged
};

/// Options of `self_pairs` and `count_self_pairs`. See query_options, whose members they are but for
/// `coincident`.
template <class Filter = keep_all, traversal Traversal = traversal::both_at_once>
struct self_options {
    /// Pairs sorted by a, then b. Without it their order is any, and may differ from call to call.
    flag sorted = true;
    /// filter(a, b) -> bool, a < b: pairs for which it is false are neither tested nor reported.
    Filter filter = {};
    /// On a device, how many pairs that are too much for it wait for the host at a time.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// As in query_options, of traversal::breadth_first and both_at_once. All other traversals but from_front are
    /// both_at_once here.
    int start_depth = 6;
    /// Of triangles alone.
    coincident_vertices coincident = coincident_vertices::distinct;
    /// Of traversal::from_front alone, as in query_options.
    abut::front* front = nullptr;
};

namespace detail {

/// The triangles of a view as faces that know their vertices: of a mesh its own numbers; others share no vertices, and a
/// number of each shape, from `first` on, stands for its three.
template <shape_view V>
struct faces_view {
    using scalar_type = typename V::scalar_type;
    using shape_type = mesh_face<scalar_type>;
    using memory_space = typename V::memory_space;

    V triangles;
    bool by_place;
    std::uint32_t first;

    [[nodiscard]] ABUT_HD std::size_t size() const { return triangles.size(); }
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const {
        if (by_place) return {triangles[i], {shape_type::by_place, shape_type::by_place, shape_type::by_place}};
        if constexpr (requires { corners_at(triangles.faces, i); }) {
            const std::uint32_t* const vertex = corners_at(triangles.faces, i);
            return {triangles[i], {vertex[0], vertex[1], vertex[2]}};
        } else {
            const auto own = first + static_cast<std::uint32_t>(i);
            return {triangles[i], {own, own, own}};
        }
    }
    ABUT_INLINE void prefetch(std::size_t i, int step) const { prefetch_shape(triangles, i, step); }
};

/// Sees triangles as faces, and other shapes as they are.
struct as_faces {
    bool by_place;
    std::uint32_t first = 0;

    template <shape_view V>
    auto operator()(const V& shapes) const {
        if constexpr (std::same_as<typename V::shape_type, triangle<typename V::scalar_type>>) {
            return faces_view<V>{shapes, by_place, first};
        } else {
            return shapes;
        }
    }
    /// Vertices are placed after they are named.
    template <shape_view V>
    auto operator()(const posed_view<V>& placed) const {
        const auto shapes = (*this)(placed.shapes);
        return posed_view<std::remove_const_t<decltype(shapes)>>{shapes, placed.pose};
    }
};

template <class Filter, traversal Traversal>
query_options<Filter, Traversal> as_query_options(const self_options<Filter, Traversal>& options) {
    return {.sorted = options.sorted,
            .filter = options.filter,
            .most_pairs = options.most_pairs,
            .start_depth = options.start_depth,
            .front = options.front};
}

/// Two shapes of one set have more in common than what they share. Shapes of two parts share no vertices, unless these go by
/// their places: all shapes that come from another part are no faces of a mesh, and their numbers are above those of all
/// vertices and shapes of a set.
struct meeting_beyond_shared : touching {
    bool by_place;

    explicit meeting_beyond_shared(coincident_vertices coincident) : by_place(coincident == coincident_vertices::merged) {}
    template <class S, class U>
    static consteval bool decides() {
        constexpr bool is = decidable<S, U>;
        static_assert(is, "abut: self queries of sets of these shapes are not supported");
        return is;
    }
    [[nodiscard]] as_faces sight() const { return {by_place}; }
    [[nodiscard]] as_faces sight_of_others() const { return {by_place, std::uint32_t{1} << 31}; }
};

}  // namespace detail

/// All pairs of shapes of `x` that touch, each once with a < b, in the policy's memory; sorted by a, then b, unless the
/// options say otherwise. A shape is not paired with itself.
///
/// Two faces of a mesh that share vertices are reported only if they meet in more: in a point that is no vertex that both
/// name, and on no edge between two such vertices. So faces that fold onto each other in one plane are reported, and
/// neighbours are not. The options say which vertices are one. Faces of the same three vertices are reported if they have an
/// area. A face that names a vertex twice, or whose corners lie on a line, is the segment or the point that it spans. With
/// `filtered` and `exact` all of that is decided exactly, for every finite input.
///
/// The answer does not depend on the policy, the thread count or the index. Several devices take what lies on each, or is
/// divided; faces of a mesh that `divide` has divided are triangles, which share no vertices by their numbers. Ranks give
/// `global_pair` of which a is the rank's; the mesh that they are asked about is all parts one after another, each of which
/// has vertices of its own. In both cases {.coincident = coincident_vertices::merged} tells neighbours by their places.
///
///     for (const auto [f, g] : to_host(abut::self_pairs(on, abut::make_bvh(on, mesh)))) mark(f, g);
template <arithmetic A = filtered, executor On, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] auto self_pairs(const On& on, const X& x, const self_options<Filter, Traversal>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::meeting_beyond_shared(options.coincident), detail::all_pairs{}),
                     detail::alone{x}, detail::as_query_options(options), "abut::self_pairs");
}

/// The number of pairs that self_pairs reports; of all ranks together. Stores none of them.
template <arithmetic A = filtered, executor On, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] auto count_self_pairs(const On& on, const X& x, const self_options<Filter, Traversal>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::meeting_beyond_shared(options.coincident), detail::how_many{}),
                     detail::alone{x}, detail::as_query_options(options), "abut::count_self_pairs");
}

///@}

}  // namespace abut
