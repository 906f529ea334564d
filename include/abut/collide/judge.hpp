// SPDX-License-Identifier: MIT
#pragma once

// What is decided of a pair of shapes that come near each other. A judge decides in stages: a first try in registers, where
// the pair is found; what that leaves open is finished later, with more effort; and a host resolves what is too much for the
// registers of a device. A judge also says what is known of a pair that it found. `touch` is the judge of most queries;
// contacts have one that decides alike and says more. Queries for what is least have judges that measure.

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/intersects.hpp>

namespace abut {

/// A judge of pairs of an S and a U, in this order. All functions are pure, and all but `resolve` run on devices as well.
///   decide(s, t)   the first try; `unknown` leaves the pair open
///   finish(s, t)   of a pair that is open; `unknown` only where `resolve` is needed
///   resolve(s, t)  the last word, on the host
template <class J, class S, class U>
concept pair_judge = requires(const J& judge, const S& s, const U& t) {
    { judge.decide(s, t) } -> std::same_as<verdict>;
    { judge.finish(s, t) } -> std::same_as<verdict>;
    { judge.resolve(s, t) } -> std::same_as<bool>;
};

/// A judge that measures an S from a U, for queries that look for what is least.
///   measure(s, u, bound)  0 or more; what is more than `bound` need not be known, and is any number above it
template <class J, class S, class U>
concept measuring_judge = requires(const J& judge, const S& s, const U& u, double bound) {
    { judge.measure(s, u, bound) } -> std::same_as<double>;
};

namespace detail {

/// Predicates are written for one order of two shapes.
template <class S, class U>
inline constexpr bool decidable = decidable_pair<S, U> || decidable_pair<U, S>;

/// Whether two shapes have a point in common.
template <arithmetic A>
struct touch {
    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        if constexpr (!decidable_pair<S, U>) {
            return (*this).decide(t, s);
        } else {
            using abut::decide;  // and those beside a shape of the caller's own
            const verdict v = decide<A>(s, t);
#if ABUT_DEVICE_CODE
            // Neighbours in a mesh, of which there may be millions, do not wait for the kernel that finishes.
            if constexpr (std::same_as<A, filtered> && requires { share_a_corner(s, t); }) {
                if (v == verdict::unknown && share_a_corner(s, t)) return verdict::yes;
            }
#endif
            return v;
        }
    }
    template <class S, class U>
    ABUT_HD verdict finish(const S& s, const U& t) const {
        if constexpr (std::same_as<A, exact>) {
            return verdict::unknown;  // the first try was all that registers can do
        } else if constexpr (decidable_pair<S, U>) {
            return decide_open<A>(s, t);
        } else {
            return decide_open<A>(t, s);
        }
    }
    template <class S, class U>
    bool resolve(const S& s, const U& t) const {
        using abut::resolve;
        if constexpr (decidable_pair<S, U>) {
            return resolve(s, t);
        } else {
            return resolve(t, s);
        }
    }
};

/// Some of the pairs that a first try leaves open: those whose keys fall into a part of `parts`; or all, where that is 0. A
/// loop over a part is for what it leaves open alone.
struct part_of_open {
    std::uint32_t part = 0, parts = 0;

    [[nodiscard]] ABUT_HD bool is_all() const { return parts == 0; }
    [[nodiscard]] ABUT_HD bool holds(std::uint64_t key) const {
        return is_all() || (key * 0x9e3779b97f4a7c15u >> 32) % parts == part;
    }
    /// Part k of `more` that this is divided into.
    [[nodiscard]] part_of_open split(std::uint32_t k, std::uint32_t more) const {
        return is_all() ? part_of_open{k, more} : part_of_open{part + k * parts, more * parts};
    }
};

// What to do with a pair that was found, for each kind of sink (execution/work_queue.hpp).

ABUT_CALLS_ANY
template <class Sink>
ABUT_HD void report(Sink& hits, std::uint64_t key) {
    if constexpr (requires { hits.push(key); }) {
        hits.push(key);
    } else if constexpr (requires { hits.add(1); }) {
        hits.add(1);
    } else {
        hits.raise();
    }
}

/// A judge of pairs by their keys, as the verbs of a policy take one: `both` finds the shapes of a key.
template <class View, class Judge>
struct key_judge {
    View both;
    Judge judge;
    part_of_open part;

    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD bool operator()(std::uint64_t key, Hits& hits, auto&...) const {
        return decide(key, both.shape_a(key), both.shape_b(key), hits);
    }
    /// The same, of shapes that are at hand.
    ABUT_CALLS_ANY
    template <class S, class U, class Hits>
    ABUT_HD bool decide(std::uint64_t key, const S& s, const U& t, Hits& hits) const {
        const verdict v = judge.decide(s, t);
        if (v == verdict::yes && part.is_all()) report(hits, key);
        return v != verdict::unknown || !part.holds(key);
    }

    /// On the host, where it is resolved at once if need be.
    template <class Hits>
    void finish(std::uint64_t key, Hits& hits) const {
        const auto s = both.shape_a(key);
        const auto t = both.shape_b(key);
        const verdict v = judge.finish(s, t);
        if (v == verdict::unknown ? judge.resolve(s, t) : v == verdict::yes) report(hits, key);
    }
    /// On a device: what it cannot finish goes to `hard`.
    ABUT_CALLS_ANY
    template <class Hits, class Hard>
    ABUT_HD void finish(std::uint64_t key, Hits& hits, Hard& hard) const {
        const verdict v = judge.finish(both.shape_a(key), both.shape_b(key));
        if (v == verdict::yes) report(hits, key);
        if (v == verdict::unknown) hard.push(key);
    }

    /// A hint that the pair will be decided soon; see shape_view.
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const { both.prefetch(key, step); }
};

}  // namespace detail

}  // namespace abut
