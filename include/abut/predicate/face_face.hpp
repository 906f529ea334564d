// SPDX-License-Identifier: MIT
#pragma once

// Do two faces of one mesh meet in more than what they share? Each face is a closed set, the segment or the point that it
// spans where it is degenerate. What they share are the vertices of which both name the number, once or more often, and for
// any two of these vertices the segment between them, which is a side of both faces. The faces meet in more if a point of
// both is not among these:
//   no vertex shared     if the triangles have a point in common
//   one                  if they have a point in common beside the vertex
//   two                  if they have one beside the segment, as where they lie in one plane and on one side of it
//   three                if they have an area
// Where two vertices of different numbers lie in one place, their numbers count and not the place.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_faces.hpp>
#include <abut/predicate/coarse_grid.hpp>
#include <abut/predicate/exact_faces.hpp>
#include <abut/predicate/exact_triangles.hpp>
#include <abut/predicate/triangle_triangle.hpp>
#include <abut/predicate/zero_area.hpp>
#include <abut/shape/mesh_face.hpp>
#include <abut/shape/place_word.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Two faces from the vertices that they share on: each of these is the same corner of both.
template <scalar T>
struct faces_in_order {
    int shared;
    triangle<T> s, t;

    ABUT_HD constexpr faces_in_order(const mesh_face<T>& f, const mesh_face<T>& g) : shared(0), s(f.corners), t(g.corners) {
        unsigned twin[3] = {twin_of(f, 0, g), twin_of(f, 1, g), twin_of(f, 2, g)};
        // A vertex that f names again has been found.
        if (twin[2] == twin[0] || twin[2] == twin[1]) twin[2] = none;
        if (twin[1] == twin[0]) twin[1] = none;
        shared = (twin[0] != none) + (twin[1] != none) + (twin[2] != none);
        if (shared == 1) {
            const unsigned i = twin[0] != none ? 0 : twin[1] != none ? 1 : 2;
            s = from_corner(f.corners, i);
            t = from_corner(g.corners, twin[i]);
        } else if (shared == 2) {
            const unsigned alone = twin[0] == none ? 0 : twin[1] == none ? 1 : 2;
            const unsigned first = next(alone), second = next(first);
            s = {corner(f.corners, first), corner(f.corners, second), corner(f.corners, alone)};
            t = {s.a, s.b, corner(g.corners, 3 - twin[first] - twin[second])};
        }
    }

private:
    static constexpr unsigned none = 3;

    ABUT_HD static constexpr unsigned next(unsigned k) { return k == 2 ? 0 : k + 1; }
    ABUT_HD static constexpr triangle<T> from_corner(const triangle<T>& t, unsigned k) {
        const unsigned l = next(k);
        return {corner(t, k), corner(t, l), corner(t, next(l))};
    }
    /// The first corner of g with the vertex that corner i of f has.
    ABUT_HD static constexpr unsigned twin_of(const mesh_face<T>& f, unsigned i, const mesh_face<T>& g) {
        const std::uint32_t v = f.vertex[i];
        if (v != mesh_face<T>::by_place) return v == g.vertex[0] ? 0 : v == g.vertex[1] ? 1 : v == g.vertex[2] ? 2 : none;
        const vec3<T> p = corner(f.corners, i);
        return in_one_place(p, g.corners.a) ? 0 : in_one_place(p, g.corners.b) ? 1 : in_one_place(p, g.corners.c) ? 2 : none;
    }
};

/// What one of the exact stages says: ask(predicate, values).
template <class Ask, scalar T>
ABUT_HD constexpr auto ask_of_faces(const faces_in_order<T>& f, const Ask& ask) {
    const triangle<T>&s = f.s, &t = f.t;
    if (f.shared == 1) return ask(faces_meet_beyond_vertex{}, in_a_row(s.a, s.b, s.c, t.b, t.c).value);
    if (f.shared == 2) return ask(faces_meet_beyond_edge{}, in_a_row(s.a, s.b, s.c, t.c).value);
    if (f.shared == 3) return ask(has_inner_points{}, in_a_row(s.a, s.b, s.c).value);
    return ask(triangle_meets_triangle{}, values_of(s, t).value);
}

struct ask_in_limbs {
    template <class Predicate, scalar T, std::size_t V>
    ABUT_HD constexpr verdict operator()(Predicate, const T (&value)[V]) const {
        return decide_in_limbs<Predicate>(value);
    }
};
struct ask_at_any_span {
    template <class Predicate, scalar T, std::size_t V>
    ABUT_HD constexpr bool operator()(Predicate, const T (&value)[V]) const {
        return decide_at_any_span<Predicate>(value);
    }
};
/// As numbers of type F, which may round.
template <scalar F>
struct ask_in {
    template <class Predicate, scalar T, std::size_t V>
    ABUT_HD constexpr verdict operator()(Predicate, const T (&value)[V]) const {
        F number[V]{};
        for (int i = 0; i < int{V}; ++i) number[i] = static_cast<F>(value[i]);
        return to_verdict(Predicate::holds(number));
    }
};

/// One stage of the decision, as for two triangles.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const mesh_face<T>& f, const mesh_face<T>& g) {
    const faces_in_order<T> pair(f, g);
    if constexpr (std::same_as<A, exact>) {
        return ask_of_faces(pair, ask_in_limbs{});
    } else {
        constexpr bool certified = std::same_as<A, filtered>;
        if (pair.shared == 0) return abut::decide<A>(pair.s, pair.t);
        if (pair.shared == 1) return decide_beyond_vertex<certified>(pair.s, pair.t);
        if (pair.shared == 2) return decide_beyond_edge<certified>(pair.s, pair.t);
        if constexpr (certified) return decide_zero_area<filtered>(pair.s) == verdict::no ? verdict::yes : verdict::unknown;
        return verdict::unknown;
    }
}

/// `fast`, where a determinant came out as 0: in plain arithmetic. Always answers.
template <arithmetic A, scalar T>
requires std::same_as<A, fast> ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const mesh_face<T>& f,
                                                                                   const mesh_face<T>& g) {
    return ask_of_faces(faces_in_order<T>(f, g), ask_in<T>{});
}

/// `filtered`, where the first stage left the pair: as for two triangles, and in double on a coarse grid.
template <arithmetic A, scalar T>
requires std::same_as<A, filtered> ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const mesh_face<T>& f,
                                                                                       const mesh_face<T>& g) {
    const faces_in_order<T> pair(f, g);
    if (pair.shared == 0) return abut::decide_late<filtered>(pair.s, pair.t);
    return on_coarse_grid(pair.s, pair.t) ? ask_of_faces(pair, ask_in<double>{}) : verdict::unknown;
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const mesh_face<T>& f, const mesh_face<T>& g) {
    return ask_of_faces(faces_in_order<T>(f, g), ask_at_any_span{});
}

}  // namespace abut::detail
