// SPDX-License-Identifier: MIT
#pragma once

// Several devices as those who answer questions about pairs (collide/question.hpp): any, count, pairs, for_each_pair,
// contacts, within and the others, of two arguments, one, lists and bodies. Each device is asked for its share of the
// arguments (ask_shares), and merge.hpp makes one list of what they find.

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/turning.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/merge.hpp>
#include <abut/execution/team.hpp>

namespace abut {

/// An entry of a list for several devices: two indices that each device has, each under a pose. Write
/// `posed_pair<decltype(gear)>{posed(gear, here), posed(gear, there)}`, where `gear` is what make_bvh of several devices
/// made.
/// @ingroup devices
template <class IndexA, class IndexB>
struct posed_pair<replicated<IndexA>, replicated<IndexB>> {
    replicated<posed_object<IndexA>> a;  ///< the first one
    replicated<posed_object<IndexB>> b;  ///< the second one
};
/// The same of two indices in motion, or at rest: `moving_pair<decltype(gear)>{moving(posed(gear, from), posed(gear, to)),
/// posed(gear, there)}`.
/// @ingroup devices
template <class IndexA, class IndexB>
struct moving_pair<replicated<IndexA>, replicated<IndexB>> {
    replicated<posed_motion<IndexA>> a;  ///< the first one
    replicated<posed_motion<IndexB>> b;  ///< the second one
};

namespace detail {

template <class Found, class Ids>
struct rename_found {
    const Found* found;
    Ids ids;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const {
        Found renamed = found[i];
        const index_pair pair = ids(renamed.a, renamed.b);
        renamed.a = pair.a;
        renamed.b = pair.b;
        out[i] = renamed;
    }
};

/// What was found of a device's shapes, with ids of the whole sets.
template <class Policy, class Found, class Ids>
auto renamed(const Policy& on, const result<Found, space_of<Policy>>& found, const Ids& ids) {
    execution::buffer_of<Policy, Found> out(on, found.size());
    for_each_index(on, found.size(), rename_found<Found, Ids>{found.data(), ids, out.data()});
    synchronize(on);
    return result<Found, space_of<Policy>>(std::move(out));
}

/// Pairs of ids as numbers in their order, and back.
struct number_pairs {
    const index_pair* pairs;
    std::uint64_t* numbers;
    ABUT_HD void operator()(std::size_t i) const { numbers[i] = std::uint64_t{pairs[i].a} << 32 | pairs[i].b; }
};
struct pairs_of_numbers {
    const std::uint64_t* numbers;
    index_pair* pairs;
    ABUT_HD void operator()(std::size_t i) const {
        pairs[i] = {static_cast<std::uint32_t>(numbers[i] >> 32), static_cast<std::uint32_t>(numbers[i])};
    }
};
/// Brings pairs in order. `shapes` is the number of the shapes whose ids these are.
template <class Policy>
auto in_order(const Policy& on, const result<index_pair, space_of<Policy>>& found, std::size_t shapes) {
    execution::buffer_of<Policy, std::uint64_t> numbers(on, found.size());
    execution::buffer_of<Policy, index_pair> out(on, found.size());
    for_each_index(on, found.size(), number_pairs{found.data(), numbers.data()});
    sort_keys(on, numbers, 32 + id_bits(shapes));
    for_each_index(on, found.size(), pairs_of_numbers{numbers.data(), out.data()});
    synchronize(on);
    return result<index_pair, space_of<Policy>>(std::move(out));
}


/// The same options for one of several devices, of which each has a query of its own.
template <class Options>
Options options_of_one(Options options) {
    options.scheduling.report = nullptr;
    if constexpr (requires { options.front; }) options.front = nullptr;
    return options;
}

// What of a pairing's names is said in the whole arguments: `renamed` of what was found, in order if it was; and `visitor`, of
// which `stopped` may be kept from one query of a device to its next.

/// Names are those of the whole.
struct own_names {
    template <class Policy, class List>
    static List renamed(const Policy&, List found, bool) {
        return found;
    }
    template <class Visitor>
    static const Visitor& visitor(const Visitor& v, std::uint32_t*) {
        return v;
    }
};
/// Of two arguments, of which one is divided. Ids ascend in each part, so the order stays.
struct names_of_parts : ids_of_parts {
    template <class Policy, class List>
    auto renamed(const Policy& on, const List& found, bool) const {
        return detail::renamed(on, found, static_cast<const ids_of_parts&>(*this));
    }
    template <class Visitor>
    auto visitor(const Visitor& v, std::uint32_t* stopped) const {
        return visitor_by_whole_ids<Visitor, ids_of_parts>{v, *this, stopped};
    }
};
/// Of one that is divided.
struct names_of_own_parts {
    ordered_ids ids;
    bool is_one_part;  ///< in which ids ascend
    std::size_t shapes;
    template <class Policy, class List>
    auto renamed(const Policy& on, const List& found, bool in_order) const {
        auto list = detail::renamed(on, found, ids);
        return in_order && !is_one_part ? detail::in_order(on, list, shapes) : std::move(list);
    }
};
/// Positions of a device's entries in the whole list.
struct entries_of_part {
    std::uint32_t part, parts;
    [[nodiscard]] ABUT_HD std::uint32_t operator()(std::size_t i) const {
        return static_cast<std::uint32_t>(i * parts + part);
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(Found of) const {
        of.pair = (*this)(of.pair);
        return of;
    }
};
template <class Found>
struct put_entries {
    const Found* found;
    entries_of_part position;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[position(i)] = found[i]; }
};
/// Of some entries of a list.
struct names_of_entries_there {
    entries_of_part position;
    template <class Policy, class List>
    auto renamed(const Policy& on, const List& found, bool) const {
        return found_of_part(on, found, position);
    }
    template <class Visitor>
    auto visitor(const Visitor& v, std::uint32_t*) const {
        return call_of_part<Visitor, entries_of_part>{v, position};
    }
};

/// A form of arguments as one device sees it.
template <class Form>
struct form_there;
template <class X, class Y>
struct form_there<two<X, Y>> : std::type_identity<two<type_on_device<X>, type_on_device<Y>>> {};
template <class X>
struct form_there<alone<X>> : std::type_identity<alone<type_on_device<X>>> {};
template <class IndexA, class IndexB>
struct form_there<form_of_list<replicated<IndexA>, replicated<IndexB>>>
    : std::type_identity<form_of_list<IndexA, IndexB>> {};
template <class IndexA, class IndexB>
struct form_there<form_of_motions<replicated<IndexA>, replicated<IndexB>>>
    : std::type_identity<form_of_motions<IndexA, IndexB>> {};
template <class Index>
struct form_there<form_of_bodies<replicated<bodies<Index>>>> : std::type_identity<form_of_bodies<bodies<Index>>> {};
template <class A, class B>
struct form_there<form_of_bodies<bodies_between<replicated<A>, replicated<B>>>>
    : std::type_identity<form_of_bodies<bodies_between<A, B>>> {};

// ask_shares(team, relation, form, options, function, in_order, is_over, ask): ask(k, pairing, names) on each device, on a
// thread of its own, once or several times, so that all pairs are looked at, each once; no more of them once is_over(k).

template <class Team, class Relation, class X, class Y, class Options, class IsOver, class Ask>
void ask_shares(const Team& team, const Relation& how, const two<X, Y>& both, const Options& options, const char* function,
                bool, const IsOver& is_over, const Ask& ask) {
    using T = scalar_of_argument<type_on_device<X>>;
    arguments_on_each<Team, X, Y> there(team, both.a, both.b, function);
    const auto near = how.template nearness<T>();
    there(
        [&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
            const auto here = with_filter(options_of_one(options), filter_here(options.filter, ids));
            const auto pairing = in_part(pair_up(team[k], a, b, here, function, near), part);
            if constexpr (is_divided<X> || is_divided<Y>) {
                ask(k, pairing, names_of_parts{ids});
            } else {
                ask(k, pairing, own_names{});
            }
        },
        is_over, [&](const auto& bounds) { return grown(bounds, near); });
}
template <class Team, class Relation, class X, class Options, class IsOver, class Ask>
void ask_shares(const Team& team, const Relation& how, const alone<X>& one, const Options& options, const char* function,
                bool, const IsOver&, const Ask& ask) {
    using T = scalar_of_argument<type_on_device<X>>;
    const auto near = how.template nearness<T>();
    const auto itself_there = [&](int k, const auto& x, const auto& filter) {
        return pair_up_self(team[k], x, with_filter(options_of_one(options), filter), function, how.sight(), near);
    };
    if constexpr (is_divided<X>) {
        ask_parts_themselves(
            team, one.x, function, [&](const auto& bounds) { return grown(bounds, near); },
            [&](int k, const auto& part, const auto& other, const ordered_ids& ids) {
                const auto filter = filter_here(options.filter, ids);
                if constexpr (std::same_as<std::remove_cvref_t<decltype(other)>, itself>) {
                    ask(k, itself_there(k, part, filter), names_of_own_parts{ids, true, one.x.size()});
                } else {
                    const auto here = with_filter(options_of_one(options), filter);
                    ask(k, pair_up_with_others(team[k], part, other, how, here, function),
                        names_of_own_parts{ids, false, one.x.size()});
                }
            });
    } else {
        require_as_many(team, one.x, function);
        execution::on_each(team, [&](int k) {
            ask(k, in_part(itself_there(k, on_device(one.x, k), options.filter), share_of(team, k)), own_names{});
        });
    }
}
/// Entries are dealt out one by one, so that neighbours, which are often alike, fall to different devices.
template <class Team, template <class, class> class Entry, class IndexA, class IndexB, class Ask>
void share_entries(const Team& team, const std::vector<Entry<replicated<IndexA>, replicated<IndexB>>>& list,
                   const char* function, const Ask& ask) {
    for (const auto& entry : list) {
        require_as_many(team, entry.a, function);
        require_as_many(team, entry.b, function);
    }
    execution::on_each(team, [&](int k) {
        const entries_of_part position{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(team.size())};
        std::vector<Entry<IndexA, IndexB>> mine;
        for (std::size_t i = position(0); i < list.size(); i = position(mine.size())) {
            mine.push_back({list[i].a[k], list[i].b[k]});
        }
        ask(k, whole(mine), position);
    });
}
template <class Team, class Relation, class A, class B, class Options, class IsOver, class Ask>
void ask_shares(const Team& team, const Relation& how, const form_of_list<A, B>& all, const Options& options,
                const char* function, bool, const IsOver&, const Ask& ask) {
    share_entries(team, all.list, function, [&](int k, const auto& mine, const entries_of_part& position) {
        const auto here = options_of_part(options_of_one(options), position);
        ask(k, mine.pair_up(team[k], how, here, false, function, position), names_of_entries_there{position});
    });
}
/// Each device has all bodies, walks its share of the tree over them, and asks about the bodies that it finds near each other.
template <class Team, class Relation, class Bodies, class Options, class IsOver, class Ask>
void ask_shares(const Team& team, const Relation& how, const form_of_bodies<Bodies>& all, const Options& options,
                const char* function, bool in_order, const IsOver&, const Ask& ask) {
    if constexpr (is_bodies_between<Bodies>) {
        require_as_many(team, all.all.a, function);
        require_as_many(team, all.all.b, function);
    } else {
        require_as_many(team, all.all, function);
    }
    execution::on_each(team, [&](int k) {
        const auto bodies_there = [&] {
            if constexpr (is_bodies_between<Bodies>) {
                return between(all.all.a[k], all.all.b[k]);
            } else {
                return all.all[k];
            }
        }();
        const typename form_there<form_of_bodies<Bodies>>::type there{bodies_there};
        ask(k, there.pair_up(team[k], how, options_of_one(options), in_order, function, share_of(team, k)), own_names{});
    });
}

/// Whether several devices take the question, its arguments and its options.
template <class Options>
inline constexpr bool walks_both_at_once = true;
template <class Filter, traversal Traversal, schedule Schedule>
inline constexpr bool walks_both_at_once<query_options<Filter, Traversal, Schedule>> = Traversal == traversal::both_at_once;
template <class Team, class Question, class Form, class Options>
consteval bool can_ask_devices_for_pairs() {
    static_assert(walks_both_at_once<Options>, "abut: queries of several devices walk both_at_once");
    return walks_both_at_once<Options> &&
           form_there<Form>::type::template can_be_asked<typename Team::local_policy, Question, decltype(Options::filter)>();
}

/// The lists that the devices have found, one each, in order if the options say so.
template <class Team, class Question, class Form, class Options>
auto lists_of_devices(const Team& team, const Question& question, const Form& form, const Options& options,
                      const char* function) {
    using local = typename Team::local_policy;
    using there = typename form_there<Form>::type;
    using found = typename Question::answer_type::template found_type<there, typename scalar_of_form<there>::type>;
    std::vector<found_lists<local, found>> lists(static_cast<std::size_t>(team.size()));
    question.relation.check(function);
    ask_shares(team, question.relation, form, options, function, options.sorted, never_over{},
               [&](int k, const auto& pairing, const auto& names) {
                   lists[static_cast<std::size_t>(k)].push_back(
                       names.renamed(team[k], question.find(team[k], pairing), options.sorted));
               });
    const auto one = [&](int k) {
        return joined<local, found>(team[k], std::move(lists[static_cast<std::size_t>(k)]), options.sorted,
                                    typename there::order{});
    };
    if (std::any_of(lists.begin(), lists.end(), [](const auto& some) { return some.size() > 1; })) return each_of(team, one);
    found_lists<local, found> all;
    for (int k = 0; k < team.size(); ++k) all.push_back(one(k));
    return all;
}

template <execution::policy_team Team, class Question, class Form, class Options>
auto ask_pairs(const Team& team, const Question& question, const Form& form, const Options& options, const char* function) {
    using local = typename Team::local_policy;
    using there = typename form_there<Form>::type;
    using answer = typename Question::answer_type;
    if constexpr (!can_ask_devices_for_pairs<Team, Question, Form, Options>()) {
        return answer::template nothing<there, local>();
    } else if constexpr (Question::kind == answer_kind::list) {
        return on_first(team, lists_of_devices(team, question, form, options, function), options.sorted,
                        typename there::order{});
    } else if constexpr (Question::kind == answer_kind::total) {
        using value = decltype(answer::template nothing<there, local>());
        std::atomic<std::uint64_t> sum{0};
        const auto ask = [&](int k, const auto& pairing, const auto&) { sum += question.find(team[k], pairing); };
        question.relation.check(function);
        if constexpr (std::same_as<answer, whether>) {
            ask_shares(team, question.relation, form, options, function, false, [&](int) { return sum.load() > 0; }, ask);
        } else {
            ask_shares(team, question.relation, form, options, function, false, never_over{}, ask);
        }
        return static_cast<value>(sum.load());
    } else {
        const auto& visitor_of = question.answer.visitor;
        using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
        if constexpr (is_visitor<local, visitor, typename there::pair_type>()) {
            question.relation.check(function);
            std::vector<visitor> visitors;
            for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
            const auto stopped = each_of(team, [&](int k) {
                execution::buffer_of<local, std::uint32_t> flag(team[k], 1);
                fill(team[k], flag.data(), 1, std::uint32_t{0});
                return flag;
            });
            const auto flag = [&](int k) {
                return const_cast<std::uint32_t*>(stopped[static_cast<std::size_t>(k)].data());
            };
            const auto has_stopped = [&](int k) {
                std::uint32_t has = 0;
                download(team[k], flag(k), 1, &has);
                return has != 0;
            };
            ask_shares(team, question.relation, form, options, function, false, has_stopped,
                       [&](int k, const auto& pairing, const auto& names) {
                           const auto each = names.visitor(visitors[static_cast<std::size_t>(k)], flag(k));
                           const auto here = ask_for<typename Question::arithmetic_type>(question.relation, visited_by(each));
                           here.find(team[k], pairing);
                       });
        }
    }
}

/// What is said of each entry of a list, in memory of the first device.
template <execution::policy_team Team, class Each, class Form, class Options>
auto ask_entries(const Team& team, const Each& each, const Form& form, const Options& options, const char* function) {
    using local = typename Team::local_policy;
    using there = typename form_there<Form>::type;
    using found_type = typename Each::template found_type<there>;
    if constexpr (Each::template can_be_asked<local, there>()) {
        found_lists<local, found_type> found(static_cast<std::size_t>(team.size()));
        share_entries(team, form.list, function, [&](int k, const auto& mine, const entries_of_part& position) {
            if constexpr (names_filter<Options>) {
                found[static_cast<std::size_t>(k)] =
                    each.find(team[k], mine, options_of_part(options_of_one(options), position), function, position);
            } else {
                found[static_cast<std::size_t>(k)] = each.find(team[k], mine, options, function, position);
            }
        });
        execution::buffer_of<local, found_type> all(team[0], form.list.size());
        for (int k = 0; k < team.size(); ++k) {
            const auto& some = found[static_cast<std::size_t>(k)];
            execution::buffer_of<local, found_type> came(team[0], some.size());
            copy_across(team[k], some.data(), some.size(), team[0], came.data());
            const entries_of_part position{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(team.size())};
            for_each_index(team[0], some.size(), put_entries<found_type>{came.data(), position, all.data()});
            synchronize(team[0]);
        }
        return result<found_type, space_of<local>>(std::move(all));
    } else {
        return result<found_type, space_of<local>>();
    }
}

}  // namespace detail

/// @defgroup devices Several devices
///
/// `abut::cuda_devices` from `<abut/cuda_devices.hpp>` asks a query of several devices at a time. `replicate` puts a set on
/// each of them, `divide` a part of it on each, and `make_bvh` makes a tree of either on each. `any`, `count`, `pairs`,
/// `for_each_pair`, `contacts`, `within` and `distance` take these, posed or not, and sets in host memory and single shapes,
/// which are copied to each device for the call; so do `nearest`, `inside` and `raycast`, and what looks is not divided.
/// Self queries take what is replicated or divided, and queries of bodies what each device has whole. Answers are those of one
/// device, bit for bit.
///
/// A filter runs on every device: what it points to has to be readable on each of them. `schedule_options::report` is left
/// as it is.
///
/// What both arguments have on each device is searched in parts: each device walks an equal share of the pairs of nodes, or
/// of the shapes that look. What is divided is searched where it lies. If both are divided, shapes of b are copied to the
/// devices whose a-shapes they come near, from one other device at a time.
///
/// @par Memory
/// A result lies in memory of the first device, with the copies that it was made of for a moment. `pairs_by_device` leaves
/// it where it was found.
///
/// @par Errors
/// Those of @ref queries, and `error` if an argument lies on another number of devices. An error on one device is thrown
/// when all have ended; if several failed, that of the first of them.
///
/// @par Synchronisation
/// Each call returns when its answer is complete on all devices. Each device is driven by a thread of the host, the first by
/// the caller's.
///
/// @par Example
/// @snippet devices.cu devices
///@{

/// The pairs of `pairs` where they were found: a vector of a `result` for each device. Each pair is in one of them, and each
/// is sorted by a, then b, unless the options say otherwise.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto pairs_by_device(const Team& team, const X& a, const Y& b,
                                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    const auto question = detail::ask_for<A>(detail::touching{}, detail::all_pairs{});
    using asked = std::remove_const_t<decltype(question)>;
    if constexpr (detail::can_ask_devices_for_pairs<Team, asked, detail::two<X, Y>, query_options<Filter, Traversal, Schedule>>()) {
        return detail::lists_of_devices(team, question, detail::two{a, b}, options, "abut::pairs_by_device");
    } else {
        return std::vector<result<index_pair, space_of<typename Team::local_policy>>>();
    }
}

///@}

}  // namespace abut
