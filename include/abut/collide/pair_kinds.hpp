// SPDX-License-Identifier: MIT
#pragma once

// Which pairs of shapes a query is about, where it is made of queries of parts of sets: those that touch, and those that are no
// farther apart than a distance. A kind has
//   pair_up(on, a, b, options, function)   a pairing of all that may be such pairs
//   judge<A>()                             decides whether they are
//   names<A>()                             the same, and knows their ids
//   operator()(bounds)                     where shapes have to be to make such a pair with one of a part

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/within.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

struct pairs_that_touch : as_near_as_boxes {
    template <class Policy, class X, class Y, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, const Y& b, const Options& options, const char* function) const {
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
};

struct pairs_within {
    double distance;

    template <class Policy, class X, class Y, class Options>
    [[nodiscard]] auto pair_up(const Policy& on, const X& a, const Y& b, const Options& options, const char* function) const {
        return pair_up_within(on, a, b, distance, options, function);
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
};

}  // namespace abut::detail
