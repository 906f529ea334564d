// SPDX-License-Identifier: MIT
#pragma once

// Which pairs of shapes a query is about, where it is made of queries of parts of sets: those that touch, those that are no
// farther apart than a distance, and shapes of one set that meet in more than what they share. A kind has
//   pair_up(on, a, b, options, function)   a pairing of all that may be such pairs; where b is `itself`, of the shapes of a,
//                                          and then of a and another part of the same set
//   judge<A>()                             decides whether they are
//   names<A>()                             the same, and knows their ids
//   operator()(bounds)                     where shapes have to be to make such a pair with one of a part, or in a box
//   nearness<T>(function)                  how near boxes have to come; of lists and of bodies, which pair up by it

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/within.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

/// In place of a second argument: the query is of the first one alone.
struct itself {};

struct pairs_that_touch : as_near_as_boxes {
    template <class Policy, class X, class Y, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, const Y& b, const Options& options,
                               const char* function) const {
        return detail::pair_up(on, a, b, options, function);
    }
    template <arithmetic A>
    [[nodiscard]] touch<A> judge() const {
        return {};
    }
    template <arithmetic A>
    [[nodiscard]] touch_and_name<A> names() const {
        return {};
    }
    template <scalar T>
    [[nodiscard]] near_enough_to_touch nearness(const char*) const {
        return {};
    }
};

/// Of one set alone. Two parts have no vertices in common, unless these go by their places: all shapes that come from
/// another part are no faces of a mesh, and their numbers are above those of all vertices and shapes of a set.
struct pairs_beyond_shared : pairs_that_touch {
    bool by_place;

    explicit pairs_beyond_shared(coincident_vertices coincident) : by_place(coincident == coincident_vertices::merged) {}
    template <class Policy, class X, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, itself, const Options& options, const char* function) const {
        return pair_up_self(on, a, options, function, as_faces{by_place});
    }
    template <class Policy, class X, shape_view Y, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, const Y& came, const Options& options,
                               const char* function) const {
        check_options(on, options, function);
        return pair_operands(on, see(make_operand(on, a, function), as_faces{by_place}),
                             see(make_operand(on, came, function), as_faces{by_place, std::uint32_t{1} << 31}), options);
    }
};

struct pairs_within {
    double distance;

    template <class Policy, class X, class Y, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, const Y& b, const Options& options,
                               const char* function) const {
        if constexpr (std::same_as<Y, itself>) {
            return pair_up_self_within(on, a, distance, options, function);
        } else {
            return pair_up_within(on, a, b, distance, options, function);
        }
    }
    template <arithmetic A>
    [[nodiscard]] come_within<A> judge() const {
        return {distance};
    }
    template <arithmetic A>
    [[nodiscard]] come_within<A> names() const {
        return {distance};
    }
    template <scalar T>
    part_bounds<T> operator()(const part_bounds<T>& part) const {
        return grown_by(part, rounded_up<T>(distance));
    }
    template <scalar T>
    aabb<T> operator()(const aabb<T>& box) const {
        return grown_by(box, rounded_up<T>(distance));
    }
    template <scalar T>
    [[nodiscard]] auto nearness(const char* function) const {
        return near_within<T>(distance, function);
    }
};

}  // namespace abut::detail
