// SPDX-License-Identifier: MIT
#pragma once

// Solids that are asked about many at a time: the entries of a list, or all two bodies of a scene that are near each other. What
// is looked for among faces is looked for in all of them in one go, and what follows is the host's. Here is what any question
// needs (solid_entries), and how lists and scenes of all kinds are asked. The questions are in relation.hpp,
// contact_patches.hpp and penetration.hpp.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <abut/collide/mixed_list.hpp>
#include <abut/collide/mixed_questions.hpp>
#include <abut/collide/solid_regions.hpp>
#include <abut/collide/touching_bodies.hpp>

namespace abut::detail {

/// Shapes of an entry by the number of the entry.
struct names_of_open_entries : names_of_entries_of_bodies {
    template <scalar T>
    ABUT_HD static tagged_crossing<T> tagged(const pair_of_entry& of, const crossing<T>& c) {
        return {of.pair, of.a, of.b, c};
    }
};

/// How a body or an entry is called in messages, by its number in the whole.
template <class Position>
struct name_of_solid {
    const char* what;
    Position position;
    [[nodiscard]] std::string operator()(std::uint32_t i) const { return what + (" " + std::to_string(position(i))) + ", face"; }
};

/// What has been found out of a body, on the host.
template <scalar T>
struct body_on_host {
    std::optional<std::pair<std::vector<mesh_face<T>>, aabb<T>>> faces;  ///< and the box around them
    std::unique_ptr<solid_on_host<T>> solid;
    std::unique_ptr<winding_surface<T>> by_rule;
};

/// Bodies on the host, each made when it is asked for.
template <class Policy, class Index, class Name>
class bodies_on_host {
public:
    using T = typename Index::scalar_type;
    static constexpr bool are_of_triangles = is_triangle<shape_in_world<Index>>;

    /// `known` has place for as many bodies, and may know them already.
    bodies_on_host(const Policy& on, const placed_bodies<Index>& all, const char* function, const Name& name, body_on_host<T>* known)
        : on_(on), objects_(*all.objects), function_(function), name_(name), object_of_(all.size()), poses_(all.size()), known_(known),
          one_part_(all.objects->indices.size()), is_closed_(one_part_.size(), 0) {
        download(on, all.objects->object_of.data(), all.size(), object_of_.data());
        download(on, all.poses->data(), all.size(), poses_.data());
    }
    const solid_on_host<T>& operator[](std::uint32_t i) {
        auto& solid = known_[i].solid;
        if (!solid) solid = std::make_unique<solid_on_host<T>>(faces(i).first, function_, name_(i));
        return *solid;
    }
    /// The faces of a body, and the box around them.
    const std::pair<std::vector<mesh_face<T>>, aabb<T>>& faces(std::uint32_t i) {
        auto& known = known_[i].faces;
        if (!known) {
            const auto shapes = view_of(objects_.indices[object_of_[i]].set());
            const placed_shapes<std::remove_const_t<decltype(shapes)>> placed{{shapes, poses_[i]}};
            auto all = faces_on_host(on_, placed);
            const aabb<T> box = box_of(all);
            known.emplace(std::move(all), box);
        }
        return *known;
    }
    /// Throws where a body is not closed that is to be taken by a rule. That is the same of all bodies of an index.
    void require_turns_of(std::uint32_t i, inside_rule rule) {
        if (std::exchange(is_closed_[object_of_[i]], 1) == 0) require_turns(faces(i).first, rule, function_, name_(i));
    }
    /// A body that is taken by a rule.
    const winding_surface<T>& by_rule(std::uint32_t i) {
        auto& surface = known_[i].by_rule;
        if (!surface) surface = std::make_unique<winding_surface<T>>(faces(i).first);
        return *surface;
    }
    /// A box around a body, which may be larger than that around its faces.
    [[nodiscard]] aabb<T> known_box(std::uint32_t i) const {
        return world_box(poses_[i], objects_.indices[object_of_[i]].bounds());
    }
    /// Whether a body's surface is of one part. It is the same of all bodies of an index.
    bool has_one_part(std::uint32_t i) {
        std::optional<bool>& has = one_part_[object_of_[i]];
        if (!has) has = (*this)[i].surface().parts() <= 1;
        return *has;
    }
    /// Throws where the surface of a body's index passes through itself.
    void require_solids(const std::vector<index_pair>& entries, bool second) {
        std::vector<char> looked(objects_.indices.size(), 0);
        for (const index_pair& e : entries) {
            const std::uint32_t i = second ? e.b : e.a, object = object_of_[i];
            if (std::exchange(looked[object], 1) != 0) continue;
            require_simple(on_, objects_.indices[object], function_, name_(i));
            (void)(*this)[i];
        }
    }

private:
    template <class View>
    struct placed_shapes {
        posed_view<View> placed;
        [[nodiscard]] const posed_view<View>& shapes() const { return placed; }
    };
    const Policy& on_;
    const placed_objects<Index>& objects_;
    const char* function_;
    Name name_;
    std::vector<std::uint32_t> object_of_;
    std::vector<rigid<T>> poses_;
    body_on_host<T>* known_;
    std::vector<std::optional<bool>> one_part_;  ///< of each index
    std::vector<char> is_closed_;                ///< of each index: that was looked at
};

/// What faces of entries have in common, which is taken entry by entry, in their order.
template <scalar T>
class contacts_of_entries {
public:
    explicit contacts_of_entries(std::vector<tagged_crossing<T>> all) : all_(std::move(all)) {}
    /// Of entry i, which is higher than the last one. Good until the next call.
    [[nodiscard]] std::span<const crossing<T>> of(std::size_t i) {
        some_.clear();
        while (next_ < all_.size() && all_[next_].pair < i) ++next_;
        for (; next_ < all_.size() && all_[next_].pair == i; ++next_) {
            some_.push_back(all_[next_].common);
            some_.back().a = all_[next_].a;
            some_.back().b = all_[next_].b;
        }
        return some_;
    }

private:
    std::vector<tagged_crossing<T>> all_;
    std::size_t next_ = 0;
    std::vector<crossing<T>> some_;
};

/// The entries of a pairing of bodies (list_pairing.hpp), as questions of two solids see them.
template <class Policy, class Pairing, class Position>
class solid_entries {
    template <class Index>
    using side = bodies_on_host<Policy, Index, name_of_solid<Position>>;
    using index_a = std::remove_cvref_t<decltype(std::declval<const Pairing&>().a.objects->indices.front())>;
    using index_b = std::remove_cvref_t<decltype(std::declval<const Pairing&>().b.objects->indices.front())>;

public:
    using T = typename Pairing::T;

    /// `what`: how a body is called in messages, by its position of either side. `known_a` and `known_b` have what is known of the
    /// bodies of either side, and keep what is found out; or null.
    solid_entries(const Policy& on, const Pairing& pairing, const char* function, const char* what, const Position& position_a,
                  const Position& position_b, body_on_host<T>* known_a = nullptr, body_on_host<T>* known_b = nullptr)
        : on_(on), pairing_(pairing), function_(function), bodies_(pairing.members.size()),
          own_(known_a == nullptr ? pairing.a.size() + pairing.b.size() : 0),
          a_(on, pairing.a, function, {what, position_a}, known_a == nullptr ? own_.data() : known_a) {
        download(on, pairing.bodies.data(), bodies_.size(), bodies_.data());
        const bool is_one = static_cast<const void*>(pairing.a.objects.get()) == static_cast<const void*>(pairing.b.objects.get()) &&
                            static_cast<const void*>(pairing.a.poses.get()) == static_cast<const void*>(pairing.b.poses.get());
        if (is_one) return;
        b_.emplace(on, pairing.b, function, name_of_solid<Position>{what, position_b},
                   known_b == nullptr ? own_.data() + pairing.a.size() : known_b);
    }
    solid_entries(const solid_entries&) = delete;
    solid_entries& operator=(const solid_entries&) = delete;

    [[nodiscard]] const Policy& policy() const { return on_; }
    [[nodiscard]] std::size_t size() const { return bodies_.size(); }
    /// Which two bodies an entry is of.
    [[nodiscard]] const index_pair& operator[](std::size_t i) const { return bodies_[i]; }
    /// All bodies of the first side.
    [[nodiscard]] auto& a() { return a_; }
    /// And of the second one, which may be the same.
    [[nodiscard]] auto& b() {
        if constexpr (std::same_as<index_a, index_b>) {
            return b_ ? *b_ : a_;
        } else {
            return *b_;
        }
    }

    /// Throws where one of them is no solid.
    void require_solids() {
        a().require_solids(bodies_, false);
        b().require_solids(bodies_, true);
    }
    /// What faces have in common, of those entries that have no mark.
    template <arithmetic A>
    [[nodiscard]] contacts_of_entries<T> contacts(const std::vector<std::uint32_t>& marks) const {
        using closing = until_found_pairing<Pairing, names_of_open_entries>;
        const auto closed = marks_there(marks);
        const typename closing::filter until{{}, pairing_.options.filter, const_cast<std::uint32_t*>(closed.data())};
        auto sorted = with_filter(pairing_.options, until);
        sorted.sorted = true;
        return contacts_of_entries<T>(to_host(all_crossings{}.template find<A>(on_, closing{pairing_, sorted}, touching{})));
    }
    /// What both of each entry have in common, until that is enough, and, if that is asked, whether their surfaces touch. Faces
    /// that pass through each other are looked for first, and no more where they are found.
    template <arithmetic A, class Enough>
    [[nodiscard]] std::vector<regions_and_touch> regions(const solid_options& options, bool whether_touching, const Enough& is_enough) {
        const std::size_t n = size();
        std::vector<regions_and_touch> found(n);
        if (options.rule) {
            for (std::size_t i = 0; i < n; ++i) found[i] = by_rule(bodies_[i], options, is_enough);
            return found;
        }
        if (!options.known_solid) require_solids();
        // Boxes beside each other: all that is asked of them is whether they touch. The others are not looked at then.
        const regions_and_touch of_passing{{true, true, true}, true}, of_apart{{false, true, true}, false};
        std::vector<std::uint32_t> beside(n), not_beside(n);
        for (std::size_t i = 0; i < n; ++i) {
            beside[i] = are_boxes_beside(bodies_[i]);
            not_beside[i] = beside[i] == 0;
        }
        std::vector<std::uint32_t> touch(n, 0);
        if (whether_touching && std::find(beside.begin(), beside.end(), 1u) != beside.end()) touch = marked<A>(not_beside, touching{});
        const std::vector<std::uint32_t> over = marked<A>(beside, passing_through{});
        contacts_of_entries<T> contacts = this->contacts<A>(over);
        for (std::size_t i = 0; i < n; ++i) {
            if (beside[i] != 0) {
                found[i] = {of_apart.found, touch[i] != 0};
            } else if (over[i] != 0) {
                found[i] = of_passing;
            } else {
                found[i] = by_contacts(bodies_[i], contacts.of(i), is_enough);
            }
        }
        return found;
    }

private:
    [[nodiscard]] execution::buffer_of<Policy, std::uint32_t> marks_there(const std::vector<std::uint32_t>& marks) const {
        execution::buffer_of<Policy, std::uint32_t> there(on_, marks.size());
        upload(on_, marks.data(), marks.size(), there.data());
        return there;
    }
    /// The marks, with one more of each entry of which two faces are in the relation.
    template <arithmetic A, class Relation>
    [[nodiscard]] std::vector<std::uint32_t> marked(const std::vector<std::uint32_t>& marks, const Relation& how) const {
        auto there = marks_there(marks);
        mark_entries<A>(on_, pairing_, how, there.data());
        std::vector<std::uint32_t> here(marks.size());
        download(on_, there.data(), here.size(), here.data());
        return here;
    }
    [[nodiscard]] bool are_boxes_beside(const index_pair& e) {
        const aabb<T> known_a = a().known_box(e.a), known_b = b().known_box(e.b);
        return are_beside(known_a, known_b) || (are_nearly_beside(known_a, known_b) && are_beside(a().faces(e.a).second, b().faces(e.b).second));
    }
    template <class Enough>
    [[nodiscard]] regions_and_touch by_rule(const index_pair& e, const solid_options& options, const Enough& is_enough) {
        if (!options.known_solid) {
            a().require_turns_of(e.a, *options.rule);
            b().require_turns_of(e.b, *options.rule);
        }
        if (!overlaps(a().faces(e.a).second, b().faces(e.b).second)) return {{false, true, true}, false};
        return winding_regions<T>(a().by_rule(e.a), b().by_rule(e.b), *options.rule).find(is_enough);
    }
    /// Of two of which no faces pass through each other.
    template <class Enough>
    [[nodiscard]] regions_and_touch by_contacts(const index_pair& e, std::span<const crossing<T>> some, const Enough& is_enough) {
        const regions_and_touch of_apart{{false, true, true}, !some.empty()};
        const aabb<T>&box_a = a().faces(e.a).second, &box_b = b().faces(e.b).second;
        if (are_beside(box_a, box_b)) return of_apart;
        if (some.empty() && !contains(box_a, box_b) && !contains(box_b, box_a) && a().has_one_part(e.a) && b().has_one_part(e.b)) return of_apart;
        const solid_on_host<T>&x = a()[e.a], &y = b()[e.b];
        if (x.surface().size() == 0 || y.surface().size() == 0) return of_apart;
        return {regions_of_solids<T>(x, y, some, is_enough), !some.empty()};
    }

    const Policy& on_;
    const Pairing& pairing_;
    const char* function_;
    std::vector<index_pair> bodies_;
    std::vector<body_on_host<T>> own_;
    side<index_a> a_;
    std::optional<side<index_b>> b_;
};

// --- who is asked
//
// A question of solids in lists and scenes has
//   function              the name that errors have
//   answer<T>, told<T>    what it says of an entry of a list, and of two bodies of a scene
//   find(entries)         one answer of each of solid_entries
//   is_told(answer)       whether two bodies of a scene of which that is said are told of
//   tell(bodies, answer)  how
// ask_solid_list and ask_solid_scene are overloaded for devices (devices/solids.hpp) and ranks (distributed/solids.hpp).

template <class Index>
consteval bool are_solid_bodies() {
    constexpr bool are = has_faces<Index>;
    static_assert(are, "abut: solids are closed meshes: trees of meshes");
    return are;
}
/// What a scene is of: its scalars, and whether these are solids.
template <class Scene>
struct solids_in_scene {
    using T = typename index_of_bodies<Scene>::type::scalar_type;
    static consteval bool are() {
        return are_solid_bodies<typename index_of_bodies<Scene>::type>() && are_solid_bodies<typename other_index_of_bodies<Scene>::type>();
    }
};
template <class... Indices>
struct solids_in_scene<mixed_bodies<Indices...>> {
    using T = typename mixed_bodies<Indices...>::scalar_type;
    static consteval bool are() { return (are_solid_bodies<Indices>() && ...); }
};

/// The answers of a list, `position` of which says where an entry is in the whole.
template <execution_policy Policy, class Question, class IndexA, class IndexB, class Position = own_positions>
auto ask_solid_list(const Policy& on, const Question& question, const std::vector<posed_pair<IndexA, IndexB>>& list,
                    const Position& position = {}) {
    const auto pairing = whole(list).pair_up(on, touching{}, list_options<>{}, true, question.function, position);
    solid_entries<Policy, std::remove_const_t<decltype(pairing)>, Position> entries(on, pairing, question.function, "entry", position, position);
    return question.find(entries);
}
/// Of a list of several kinds.
template <execution_policy Policy, class Question, class... A, class... B>
auto ask_solid_list(const Policy& on, const Question& question, const std::vector<std::variant<posed_pair<A, B>...>>& list) {
    using T = typename std::tuple_element_t<0, std::tuple<A...>>::scalar_type;
    std::vector<typename Question::template answer<T>> found(list.size());
    for_each_kind_of_entries(list, question.function, [&](const auto& some, const std::vector<std::uint32_t>& places) {
        auto answers = ask_solid_list(on, question, some, places_of_entries{places.data(), nullptr});
        for (std::size_t i = 0; i < places.size(); ++i) found[places[i]] = std::move(answers[i]);
    });
    return found;
}

/// Positions of bodies in a scene of several kinds.
struct positions_from {
    std::size_t first;
    std::size_t operator()(std::size_t i) const { return first + i; }
};
/// What is told of a scene of one kind, or of two kinds in one of several, in a part of the search. `known`: of all bodies of
/// the scene of several kinds.
template <execution_policy Policy, class Question, class Scene, class Which, class Part = whole_search>
auto ask_solid_scene(const Policy& on, const Question& question, const Scene& scene, const Which& which, const Part& part = {},
                     const bodies_of_parts& names = {}, body_on_host<typename solids_in_scene<Scene>::T>* known = nullptr) {
    const auto pairing = whole(scene).pair_up(on, touching{}, with_filter(which, keep_all{}), true, question.function, part);
    solid_entries<Policy, std::remove_const_t<decltype(pairing)>, positions_from> entries(
        on, pairing, question.function, "body", positions_from{names.first_a}, positions_from{names.first_b},
        known == nullptr ? nullptr : known + names.first_a, known == nullptr ? nullptr : known + names.first_b);
    auto answers = question.find(entries);
    std::vector<typename Question::template told<typename solids_in_scene<Scene>::T>> found;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (question.is_told(answers[i])) found.push_back(question.tell(names.named(entries[i]), std::move(answers[i])));
    }
    return found;
}
template <class Told>
auto order_of_told(const Told& of) {
    if constexpr (std::same_as<Told, index_pair>) {
        return std::pair(of.a, of.b);
    } else {
        return std::pair(of.body_a, of.body_b);
    }
}
/// In the order of bodies.
template <class Told>
void sort_told(std::vector<Told>& all) {
    std::sort(all.begin(), all.end(), [](const Told& x, const Told& y) { return order_of_told(x) < order_of_told(y); });
}
template <execution_policy Policy, class Question, class... Indices, class Which>
auto ask_solid_scene(const Policy& on, const Question& question, const mixed_bodies<Indices...>& all, const Which& which) {
    require_same_device(on, all, question.function);
    using T = typename mixed_bodies<Indices...>::scalar_type;
    std::vector<typename Question::template told<T>> found;
    std::vector<body_on_host<T>> known(all.size());
    for_each_two_parts(all, [&](const auto& two) {
        auto some = ask_solid_scene(on, question, two.scene(), options_of_part(which, two.names), whole_search{}, two.names, known.data());
        std::move(some.begin(), some.end(), std::back_inserter(found));
        return false;
    });
    sort_told(found);
    return found;
}

/// The front of a list, and of a scene.
template <class On, class Question, class IndexA, class IndexB>
auto answers_of_solids(const On& on, const Question& question, const std::vector<posed_pair<IndexA, IndexB>>& list) {
    if constexpr (are_solid_bodies<IndexA>() && are_solid_bodies<IndexB>()) {
        return ask_solid_list(on, question, list);
    } else {
        return std::vector<typename Question::template answer<float>>();
    }
}
template <class On, class Question, class... A, class... B>
auto answers_of_solids(const On& on, const Question& question, const std::vector<std::variant<posed_pair<A, B>...>>& list) {
    using T = typename std::tuple_element_t<0, std::tuple<A...>>::scalar_type;
    constexpr bool alike = (std::same_as<T, typename A::scalar_type> && ...);
    static_assert(alike, "abut: the entries of a list have one scalar type, float or double");
    if constexpr (alike && (are_solid_bodies<A>() && ...) && (are_solid_bodies<B>() && ...)) {
        return ask_solid_list(on, question, list);
    } else {
        return std::vector<typename Question::template answer<float>>();
    }
}
template <class On, class Question, class Scene, class Which>
auto told_of_solids(const On& on, const Question& question, const Scene& scene, const Which& which) {
    if constexpr (solids_in_scene<Scene>::are()) {
        return ask_solid_scene(on, question, scene, which);
    } else {
        return std::vector<typename Question::template told<float>>();
    }
}

/// Lists of entries of one kind or of several.
template <class X>
inline constexpr bool is_list_of_pairs = false;
template <class IndexA, class IndexB>
inline constexpr bool is_list_of_pairs<std::vector<posed_pair<IndexA, IndexB>>> = true;
template <class... A, class... B>
inline constexpr bool is_list_of_pairs<std::vector<std::variant<posed_pair<A, B>...>>> = true;
template <class X>
concept list_of_pairs = is_list_of_pairs<X>;

}  // namespace abut::detail
