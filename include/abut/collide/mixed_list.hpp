// SPDX-License-Identifier: MIT
#pragma once

// Lists whose entries are of several kinds: one answer of each entry of a vector of std::variant of posed_pairs. Entries of one
// kind are asked in one call (list_each.hpp, list_distance.hpp), and their answers go to their places. Not for questions to which
// an entry has many answers, and not for several devices or ranks.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <abut/collide/list_distance.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/error.hpp>
#include <abut/shape/check.hpp>

namespace abut {

namespace detail {

/// Where entries of one kind are in the whole list.
struct places_of_entries {
    const std::uint32_t *on_host, *there;
    std::size_t operator()(std::size_t i) const { return on_host[i]; }
    template <class Found>
    ABUT_HD Found named(Found found) const {
        found.pair = there[found.pair];
        return found;
    }
};
template <class Found>
struct write_to_places {
    const Found* found;
    const std::uint32_t* places;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[places[i]] = found[i]; }
};

/// Of executors other than a policy.
template <class On>
consteval bool refuse_mixed_list() {
    static_assert(sizeof(On) == 0, "abut: lists of several kinds are asked by one policy; ask several devices or ranks about each kind");
    return false;
}

/// f(entries, places) of the entries of each kind that the list has, `places` of which says where they are in it.
template <class... A, class... B, class F>
void for_each_kind_of_entries(const std::vector<std::variant<posed_pair<A, B>...>>& list, const char* function, const F& f) {
    check_count(list.size(), function);
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].valueless_by_exception()) {
            throw error(std::string(function) + ": entry " + std::to_string(i) + " of the list holds no pair");
        }
    }
    const auto ask_kind = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
        std::vector<std::variant_alternative_t<K, std::variant<posed_pair<A, B>...>>> some;
        std::vector<std::uint32_t> places;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i].index() != K) continue;
            some.push_back(std::get<K>(list[i]));
            places.push_back(static_cast<std::uint32_t>(i));
        }
        if (!some.empty()) f(some, places);
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) { (ask_kind(std::integral_constant<std::size_t, K>()), ...); }
    (std::index_sequence_for<A...>());
}

template <class Policy, class Each, class... A, class... B, class Options>
auto ask_mixed_entries(const Policy& on, const Each& each, const std::vector<std::variant<posed_pair<A, B>...>>& list,
                       const Options& options, const char* function) {
    using T = typename std::tuple_element_t<0, std::tuple<A...>>::scalar_type;
    constexpr bool alike = (std::same_as<T, typename A::scalar_type> && ...);
    static_assert(alike, "abut: the entries of a list have one scalar type, float or double");
    using first_form = std::tuple_element_t<0, std::tuple<form_of_list<A, B>...>>;
    using found_type = typename Each::template found_type<first_form>;
    if constexpr (alike && (Each::template can_be_asked<Policy, form_of_list<A, B>>() && ...)) {
        execution::buffer_of<Policy, found_type> out(on, list.size());
        for_each_kind_of_entries(list, function, [&](const auto& some, const std::vector<std::uint32_t>& places) {
            execution::buffer_of<Policy, std::uint32_t> there(on, places.size());
            upload(on, places.data(), places.size(), there.data());
            const places_of_entries position{places.data(), there.data()};
            const auto write = [&](const auto& own_options) {
                const auto found = each.find(on, whole(some), own_options, function, position);
                for_each_index(on, some.size(), write_to_places<found_type>{found.data(), there.data(), out.data()});
                synchronize(on);
            };
            if constexpr (names_filter<Options>) {
                write(options_of_part(options, position));
            } else {
                write(options);
            }
        });
        return result<found_type, space_of<Policy>>(std::move(out));
    } else {
        return result<found_type, space_of<Policy>>();
    }
}

}  // namespace detail

/// @addtogroup lists
///@{

/// `any_each`, `count_each`, `any_within_each` and `distance` of a list whose entries are of several kinds, each a std::variant
/// of the posed_pairs that it may be, under one policy. An entry is answered as in a list of its kind, in the place that it has
/// here, and filters and errors are told of entries by their places. All have one scalar type. Kinds are asked one after
/// another, each in one call, whose memory and errors are those of a list; the answers are written once more. `error` where an
/// entry is valueless. Returns when all is complete.
///@{
template <arithmetic A = filtered, execution_policy Policy, class... X, class... Y, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto any_each(const Policy& on, const std::vector<std::variant<posed_pair<X, Y>...>>& list,
                            const list_options<Filter, Schedule>& options = {}) {
    return detail::ask_mixed_entries(on, detail::whether_of_each<A, detail::touching>{}, list, options, "abut::any_each");
}
template <arithmetic A = filtered, execution_policy Policy, class... X, class... Y, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto count_each(const Policy& on, const std::vector<std::variant<posed_pair<X, Y>...>>& list,
                              const list_options<Filter, Schedule>& options = {}) {
    return detail::ask_mixed_entries(on, detail::count_of_each<A, detail::touching>{}, list, options, "abut::count_each");
}
template <arithmetic A = filtered, execution_policy Policy, class... X, class... Y, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto any_within_each(const Policy& on, const std::vector<std::variant<posed_pair<X, Y>...>>& list, double distance,
                                   const list_options<Filter, Schedule>& options = {}) {
    const detail::whether_of_each<A, detail::within_distance> each{{detail::within_distance(distance)}};
    return detail::ask_mixed_entries(on, each, list, options, "abut::any_within_each");
}
template <execution_policy Policy, class... X, class... Y>
[[nodiscard]] auto distance(const Policy& on, const std::vector<std::variant<posed_pair<X, Y>...>>& list,
                            const distance_options& options = {}) {
    return detail::ask_mixed_entries(on, detail::distance_of_each{}, list, options, "abut::distance");
}
///@}

///@}

}  // namespace abut
