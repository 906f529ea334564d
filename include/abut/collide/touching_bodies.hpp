// SPDX-License-Identifier: MIT
#pragma once

// touching_bodies and bodies_within: which bodies of a scene touch, or come near each other, without the shapes that do. Two
// bodies are looked at until one pair of their shapes is found. An answer (question.hpp) that pairings of bodies give; which
// shapes they are is what `pairs` tells (body_pairs.hpp).

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/within.hpp>

namespace abut {

namespace detail {

/// Two shapes of two bodies, and the number of the entry that the bodies are.
struct pair_of_entry : body_pair {
    std::uint32_t pair;
};
struct names_of_entries_of_bodies {
    ABUT_HD static pair_of_entry pair(std::uint32_t entry, const index_pair& bodies, std::uint32_t a, std::uint32_t b) {
        return {{bodies.a, bodies.b, a, b}, entry};
    }
};

/// A pairing of bodies, of which each two are looked at until something is found, and shapes are named by the number of the
/// entry too.
template <class Pairing, class NamesOfEntries = names_of_entries_of_bodies>
struct until_found_pairing;
template <class Policy, class Names, class IndexA, class IndexB, class Options, class Nearness, class NamesOfEntries>
struct until_found_pairing<list_pairing<Policy, Names, IndexA, IndexB, Options, Nearness>, NamesOfEntries> {
    using filter = until_found<decltype(Options::filter)>;
    using options_type = decltype(with_filter(std::declval<const Options&>(), std::declval<const filter&>()));
    using view_type = list_view<NamesOfEntries, IndexA, IndexB, filter>;

    const list_pairing<Policy, Names, IndexA, IndexB, Options, Nearness>& of;
    options_type options;
    list_key key = of.key;

    [[nodiscard]] view_type view() const {
        return {of.a.view(), of.b.view(), of.bodies.data(), of.members.data(), of.key, options.filter};
    }
    [[nodiscard]] std::size_t likely_hits() const { return of.likely_hits(); }
    template <class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        judge_entries(on, of, view(), options, run);
    }
};

struct has_touched {
    const std::uint32_t* found;
    ABUT_HD bool operator()(std::size_t i) const { return found[i] != 0; }
};
struct gather_bodies {
    const index_pair* bodies;
    const std::uint32_t* which;
    index_pair* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = bodies[which[i]]; }
};

/// Writes 1 for each entry of a pairing of which any two shapes are in the relation. Those that have a 1 are not looked at.
template <arithmetic A, class Policy, class Pairing, class Relation>
void mark_entries(const Policy& on, const Pairing& pairing, const Relation& how, std::uint32_t* found) {
    using closing = until_found_pairing<Pairing>;
    const typename closing::filter until{{}, pairing.options.filter, found};
    visited_by(mark_entry{found}).template find<A>(on, closing{pairing, with_filter(pairing.options, until)}, how);
}

/// All pairs of bodies of which any two shapes are in the relation.
struct all_bodies : of_any_shapes {
    static constexpr answer_kind kind = answer_kind::list;
    template <class, scalar>
    using found_type = index_pair;
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] auto find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        const std::size_t n = pairing.members.size();
        execution::buffer_of<Policy, std::uint32_t> found(on, n);
        fill(on, found.data(), n, std::uint32_t{0});
        mark_entries<A>(on, pairing, how, found.data());
        execution::buffer_of<Policy, std::uint32_t> which(on, n);
        which.shrink(compact(on, n, has_touched{found.data()}, which.data()));
        execution::buffer_of<Policy, index_pair> out(on, which.size());
        for_each_index(on, which.size(), gather_bodies{pairing.bodies.data(), which.data(), out.data()});
        synchronize(on);
        return result<index_pair, space_of<Policy>>(std::move(out));
    }
    template <class, class Policy>
    static auto nothing() {
        return result<index_pair, space_of<Policy>>();
    }
};

/// Scenes of bodies: their form is that of many bodies.
template <class X>
concept scene_of_bodies = many_bodies<X> || is_bodies_between<X> || is_mixed_bodies<X>;

}  // namespace detail

/// @addtogroup many_bodies
///@{

/// Which bodies touch: a `result` of `index_pair`, two bodies each, as `body_pair` names them; sorted by a, then b, unless the
/// options say otherwise. Two bodies are there where `pairs` of the same arguments reports any pair of their shapes, and are
/// looked at no more soon after the first. Takes 4 bytes more for each pair of bodies whose boxes meet than `pairs`, and
/// nothing for pairs of shapes.
///
///     for (const auto [a, b] : to_host(abut::touching_bodies(on, scene))) use(a, b);
template <arithmetic A = filtered, executor On, detail::scene_of_bodies Scene,
          detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto touching_bodies(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_bodies{}), detail::whole(scene), options,
                     "abut::touching_bodies");
}

/// Which bodies are no farther apart than `distance`: the same of the pairs of `within`.
template <arithmetic A = filtered, executor On, detail::scene_of_bodies Scene,
          detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto bodies_within(const On& on, const Scene& scene, double distance, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::all_bodies{}), detail::whole(scene),
                     options, "abut::bodies_within");
}

///@}

}  // namespace abut
