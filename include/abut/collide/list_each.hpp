// SPDX-License-Identifier: MIT
#pragma once

// any_each, count_each: one answer of each entry of a list. An entry is looked at until it is known. How far apart the two of
// an entry are is in list_distance.hpp.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/list.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/within.hpp>
#include <abut/execution/atomic.hpp>

namespace abut {

namespace detail {

/// Wants no more of an entry in which something was found.
template <class Filter>
struct until_found : closes_entries {
    Filter filter;
    std::uint32_t* found;  ///< of each entry
    [[nodiscard]] ABUT_HD bool is_open(std::uint32_t entry) const { return execution::atomic_load(found + entry) == 0; }
    ABUT_CALLS_ANY
    template <class Pair>
    ABUT_HD bool operator()(const Pair& of) const {
        return is_open(of.pair) && filter(of);
    }
};
struct mark_entry {
    std::uint32_t* found;
    template <class Pair>
    ABUT_HD visit operator()(const Pair& of) const {
        execution::atomic_store(found + of.pair, 1);
        return visit::proceed;
    }
};
struct count_entry {
    std::uint64_t* counts;
    ABUT_HD visit operator()(const tagged_pair& of) const {
        execution::atomic_add(counts + of.pair, std::uint64_t{1});
        return visit::proceed;
    }
};
struct write_marks {
    const std::uint32_t* found;
    std::uint8_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = found[i] != 0; }
};

// An answer of each entry has found_type<Form>, what it is; can_be_asked<Policy, Form>(); and find(on, form, options, function,
// position), a `result` with one of each entry.

/// What two shapes of an entry may be asked.
template <arithmetic A, class Relation>
struct relation_of_each {
    Relation relation;
    template <class Policy, class Form>
    static consteval bool can_be_asked() {
        return Form::template can_be_asked<Policy, question<A, Relation, whether>, keep_all>();
    }
};
/// Whether there is any pair.
template <arithmetic A, class Relation>
struct whether_of_each : relation_of_each<A, Relation> {
    template <class>
    using found_type = std::uint8_t;
    template <class Policy, class Form, class Options, class Positions>
    auto find(const Policy& on, const Form& form, const Options& options, const char* function,
              const Positions& position) const {
        const std::size_t n = form.list.size();
        this->relation.check(function);
        execution::buffer_of<Policy, std::uint32_t> found(on, n);
        fill(on, found.data(), n, std::uint32_t{0});
        using filter = until_found<decltype(Options::filter)>;
        const auto until = with_filter(options, filter{{}, options.filter, found.data()});
        visited_by(mark_entry{found.data()})
            .template find<A>(on, form.pair_up(on, this->relation, until, false, function, position), this->relation);
        execution::buffer_of<Policy, std::uint8_t> out(on, n);
        for_each_index(on, n, write_marks{found.data(), out.data()});
        synchronize(on);
        return result<std::uint8_t, space_of<Policy>>(std::move(out));
    }
};
/// How many there are.
template <arithmetic A, class Relation>
struct count_of_each : relation_of_each<A, Relation> {
    template <class>
    using found_type = std::uint64_t;
    template <class Policy, class Form, class Options, class Positions>
    auto find(const Policy& on, const Form& form, const Options& options, const char* function,
              const Positions& position) const {
        const std::size_t n = form.list.size();
        this->relation.check(function);
        execution::buffer_of<Policy, std::uint64_t> counts(on, n);
        fill(on, counts.data(), n, std::uint64_t{0});
        visited_by(count_entry{counts.data()})
            .template find<A>(on, form.pair_up(on, this->relation, options, false, function, position), this->relation);
        synchronize(on);
        return result<std::uint64_t, space_of<Policy>>(std::move(counts));
    }
};

template <class Options>
inline constexpr bool names_filter = requires(const Options& options) {
    options.filter;
};

/// One policy, at once.
template <execution_policy Policy, class Each, class Form, class Options>
auto ask_entries(const Policy& on, const Each& each, const Form& form, const Options& options, const char* function) {
    if constexpr (Each::template can_be_asked<Policy, Form>()) {
        return each.find(on, form, options, function, own_positions{});
    } else {
        return result<typename Each::template found_type<Form>, space_of<Policy>>();
    }
}

}  // namespace detail

/// @addtogroup lists
///@{

/// Which entries collide: a `result` of `std::uint8_t`, one of each entry in their order, 1 where shapes of its two indices
/// touch and the filter wants the pair, else 0. An entry is looked at no more soon after its first such pair. The call takes
/// 4 bytes more an entry. Ranks are told of their own entries.
///
///     const auto collides = abut::to_host(abut::any_each(on, configurations));
template <arithmetic A = filtered, executor On, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto any_each(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                            const list_options<Filter, Schedule>& options = {}) {
    return ask_entries(on, detail::whether_of_each<A, detail::touching>{}, detail::whole(list), options, "abut::any_each");
}

/// How many pairs of shapes of each entry touch, as `count` says of its two indices alone: a `result` of `std::uint64_t`, one
/// of each entry in their order. Ranks are told of their own entries.
template <arithmetic A = filtered, executor On, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto count_each(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                              const list_options<Filter, Schedule>& options = {}) {
    return ask_entries(on, detail::count_of_each<A, detail::touching>{}, detail::whole(list), options, "abut::count_each");
}

/// Which entries come within a distance: as `any_each`, of the pairs that are no farther apart than `distance`.
template <arithmetic A = filtered, executor On, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto any_within_each(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                                   const list_options<Filter, Schedule>& options = {}) {
    return ask_entries(on, detail::whether_of_each<A, detail::within_distance>{{detail::within_distance(distance)}},
                       detail::whole(list), options, "abut::any_within_each");
}

///@}

}  // namespace abut
