// SPDX-License-Identifier: MIT
#pragma once

// How far apart parts of two sets are, one after another: what `distance` says of whole sets that lie on several devices or
// ranks. First all parts are asked what touches, and where nothing does, what is nearest.

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/distance.hpp>
#include <abut/collide/parts.hpp>
#include <abut/config.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

/// The nearest pair so far, with ids of the whole sets.
template <scalar T>
struct pair_apart {
    double measure = infinity<double>;  ///< as it is compared: 0 of what touches
    std::uint64_t a = static_cast<std::uint64_t>(-1), b = a;  ///< the largest numbers where there is none
    separation<T> found{};                                    ///< its ids say nothing

    [[nodiscard]] bool is_one() const { return a != static_cast<std::uint64_t>(-1); }
    [[nodiscard]] bool comes_before(const pair_apart& other) const {
        if (measure != other.measure) return measure < other.measure;
        return a != other.a ? a < other.a : b < other.b;
    }
};

/// What two ids of a part are called in the whole sets.
template <class Ids>
struct name_pair {
    using pair_type = std::remove_cvref_t<std::invoke_result_t<Ids, std::uint32_t, std::uint32_t>>;
    Ids ids;
    std::uint32_t a, b;
    pair_type* out;
    ABUT_HD void operator()(std::size_t) const { *out = ids(a, b); }
};

/// The least of all parts, which threads ask at a time.
template <scalar T>
class least_apart {
public:
    /// Nothing that is not below `below` is looked for.
    explicit least_apart(double below) : most_(bound_below<T>(below)) {}

    /// What of a pairing touches: ids(a, b) names two shapes of its operands in the whole sets.
    template <class Policy, class Pairing, class Ids>
    void look_for_touch(const Policy& on, Pairing pairing, const Ids& ids) {
        if (is_empty(pairing)) return;
        offer(on, pairing, first_touch(on, pairing), 0, true, ids);
    }
    /// What of a pairing, of which nothing touches, is nearest.
    template <class Policy, class Pairing, class Ids>
    void look_for_nearest(const Policy& on, const Pairing& pairing, const Ids& ids) {
        if (is_empty(pairing)) return;
        const auto least = nearest_pair(on, pairing, bound());
        offer(on, pairing, least.key, least.value, false, ids);
    }

    /// What is farther apart does not matter.
    [[nodiscard]] double bound() const {
        const std::scoped_lock lock(mutex_);
        return best_.measure < most_ ? best_.measure : most_;
    }
    /// How far around shapes those may lie that are as near as that: rounded as the walks of distance.hpp round it.
    [[nodiscard]] T reach() const { return rounded_up<T>(bound() * (1 + 64 * static_cast<double>(unit_roundoff<T>))); }
    /// Something as near was found elsewhere.
    void learn(double measure) {
        const std::scoped_lock lock(mutex_);
        most_ = measure < most_ ? measure : most_;
    }
    [[nodiscard]] pair_apart<T> best() const {
        const std::scoped_lock lock(mutex_);
        return best_;
    }

    /// What a caller gets of the best of all: an optional `separation` or `global_separation`.
    template <class Found>
    static std::optional<Found> answer(const pair_apart<T>& best, double below) {
        if (!(best.is_one() && below > 0 && is_below(best.found, below))) return std::nullopt;
        using id = decltype(Found::a);
        const separation<T>& found = best.found;
        return Found{static_cast<id>(best.a), static_cast<id>(best.b), found.point_a, found.point_b, found.distance};
    }

private:
    template <class Pairing>
    static bool is_empty(const Pairing& pairing) {
        return pairing.a.shapes().size() == 0 || pairing.b.shapes().size() == 0;
    }
    template <class Policy, class Pairing, class Ids>
    void offer(const Policy& on, const Pairing& pairing, std::uint64_t key, double measure, bool touch, const Ids& ids) {
        if (key == no_pair) return;
        const auto pair = named(on, ids, pairing.key.a(key), pairing.key.b(key));
        pair_apart<T> one{measure, pair.a, pair.b, separation_of_key(on, pairing, key, touch)};
        const std::scoped_lock lock(mutex_);
        if (one.comes_before(best_)) best_ = one;
    }

    /// The tables of ids lie where the policy works, so it reads them.
    template <class Policy, class Ids>
    static auto named(const Policy& on, const Ids& ids, std::uint32_t a, std::uint32_t b) {
        using pair_type = typename name_pair<Ids>::pair_type;
        execution::buffer_of<Policy, pair_type> there(on, 1);
        pair_type pair{};
        for_each_index(on, 1, name_pair<Ids>{ids, a, b, there.data()});
        download(on, there.data(), 1, &pair);
        return pair;
    }

    double most_;
    mutable std::mutex mutex_;
    pair_apart<T> best_;
};

/// A query's arguments, ready to be asked how far apart they are.
template <class Policy, class X, class Y>
auto pair_up_apart(const Policy& on, const X& x, const Y& y, const char* function) {
    return pair_up(on, x, y, query_options<before_first_touch<pair_key>>{}, function);
}

}  // namespace abut::detail
