// SPDX-License-Identifier: MIT
#pragma once

// The pairs of bench/trade.cpp and bench/trade.cu: for each predicate three kinds of input. Pair number i is a pure function
// of i, and the same bits on hosts and devices (tests/support/draws.hpp says how).
//
//   random     in general position
//   touching   one step of the scalar type from contact, to either side
//   lattice    corners on a lattice of 4 x 4 x 4 points, where many pairs touch exactly

#include <cstdint>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>

#include "../tests/support/families.hpp"
#include "../tests/support/other_shapes.hpp"
#include "../tests/support/triangle_families.hpp"

namespace trade {

using abut::test::triangle_family;

enum class input : int { random, touching, lattice };
inline constexpr input inputs[] = {input::random, input::touching, input::lattice};
inline const char* name_of(input in) {
    return in == input::random ? "random" : in == input::touching ? "touching" : "lattice";
}

inline constexpr std::uint64_t seed = 20190819;

template <class S, class U>
struct pair {
    S s;
    U t;
};

struct sphere_triangle {
    static constexpr const char* name = "sphere_triangle";
    template <abut::scalar T>
    ABUT_HD static pair<abut::sphere<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        using abut::test::family;
        const auto p = abut::test::make_pair<T>(seed,
                                                in == input::random     ? family::random
                                                : in == input::touching ? family::tangent_face
                                                                        : family::lattice_4,
                                                i);
        return {p.s, p.t};
    }
};

/// `touching` holds corners and edges in turn that nearly touch a face or an edge.
template <abut::scalar T>
ABUT_HD abut::test::triangle_pair<T> two_triangles(input in, std::uint64_t i) {
    const auto touching = i % 2 == 0 ? triangle_family::vertex_on_face : triangle_family::edge_on_edge;
    return abut::test::make_triangle_pair<T>(seed,
                                             in == input::random     ? triangle_family::random
                                             : in == input::touching ? touching
                                                                     : triangle_family::lattice_4,
                                             i);
}

struct triangle_triangle {
    static constexpr const char* name = "triangle_triangle";
    template <abut::scalar T>
    ABUT_HD static pair<abut::triangle<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        const auto p = two_triangles<T>(in, i);
        return {p.a, p.b};
    }
};

/// An edge of one triangle and the other.
struct segment_triangle {
    static constexpr const char* name = "segment_triangle";
    template <abut::scalar T>
    ABUT_HD static pair<abut::segment<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        const auto p = two_triangles<T>(in, i);
        return {{p.a.a, p.a.b}, p.b};
    }
};

template <template <class> class Shape>
struct shape_triangle {
    template <abut::scalar T>
    ABUT_HD static pair<Shape<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        using abut::test::shape_family;
        const auto touching =
            static_cast<shape_family>(static_cast<int>(shape_family::touching_0) + static_cast<int>(i % 5));
        const auto p = abut::test::make_shape_pair<Shape, T>(seed,
                                                             in == input::random     ? shape_family::random
                                                             : in == input::touching ? touching
                                                                                     : shape_family::lattice_4,
                                                             i);
        return {p.s, p.t};
    }
};
struct box_triangle : shape_triangle<abut::aabb> {
    static constexpr const char* name = "box_triangle";
};
struct plane_triangle : shape_triangle<abut::plane> {
    static constexpr const char* name = "plane_triangle";
};
struct capsule_triangle : shape_triangle<abut::capsule> {
    static constexpr const char* name = "capsule_triangle";
};

/// Calls add(Predicate{}) for each.
template <class Add>
void for_each_predicate(const Add& add) {
    add(triangle_triangle{});
    add(segment_triangle{});
    add(sphere_triangle{});
    add(capsule_triangle{});
    add(box_triangle{});
    add(plane_triangle{});
}

/// Two shapes that are asked whether they are no farther apart than a distance.
template <class S, class U>
struct spaced_pair {
    S s;
    U t;
    double distance;
};

/// The question of a pair.
template <abut::arithmetic A, class Pair>
ABUT_HD bool answer(const Pair& p) {
    if constexpr (requires { p.distance; }) {
        return abut::within<A>(p.s, p.t, p.distance);
    } else {
        return abut::intersects<A>(p.s, p.t);
    }
}

template <class A>
constexpr const char* arithmetic_name = std::is_same_v<A, abut::fast>       ? "fast"
                                        : std::is_same_v<A, abut::filtered> ? "filtered"
                                                                            : "exact";
template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

/// How often answers differ from the truth, a million pairs.
struct tally {
    std::uint64_t pairs = 0, hits = 0, missed = 0, phantom = 0;

    void add(bool answer, bool truth) {
        ++pairs;
        hits += truth;
        missed += truth && !answer;
        phantom += answer && !truth;
    }
    [[nodiscard]] double share(std::uint64_t n) const { return static_cast<double>(n) / static_cast<double>(pairs); }
};

}  // namespace trade
