// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts and the first of them on several devices. Where each has the whole meshes, it walks its share of the
// pairs of nodes (search_part in collide/pairing.hpp). Keys of pairs are the same on all, and what is found is merged by
// them. Where a mesh is divided, each device looks at its part. Features on the border of two parts are in both: what two
// devices find of them is the same, bit for bit, and is kept once.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/merge.hpp>
#include <abut/collide/mesh_pieces.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/divide_mesh.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Whether impact queries of several devices take arguments of these types, and self queries one that is whole on each.
template <class Team, class X>
consteval bool can_move_on_devices() {
    static_assert(!is_divided<X>,
                  "abut: impacts of several devices take a mesh that is divided by divide_mesh, not its shapes");
    if constexpr (!is_divided<X>) {
        return can_move<typename Team::local_policy, type_on_device<X>>();
    } else {
        return false;
    }
}
template <class Team, class X>
consteval bool can_move_whole_on_devices() {
    static_assert(!is_divided_mesh<X>,
                  "abut: self_impacts of several devices take a mesh or an index that each device has whole");
    if constexpr (!is_divided_mesh<X>) {
        return can_move_on_devices<Team, X>();
    } else {
        return false;
    }
}
template <class Team, class X, class Y>
consteval bool can_meet_on_devices() {
    if constexpr (can_move_on_devices<Team, X>() && can_move_on_devices<Team, Y>()) {
        return can_meet<typename Team::local_policy, type_on_device<X>, type_on_device<Y>>();
    } else {
        return false;
    }
}

/// What `x` is to a query of it and `Y`: an index on each device.
template <class Y, class Team, class X>
auto impact_operand_on_each(const Team& team, const X& x, const char* function) {
    constexpr pair_rule rule = rule_of<type_on_device<X>, type_on_device<Y>>();
    require_as_many(team, x, function);
    return each_of(team, [&](int k) { return impact_operand<rule>(team[k], on_device(x, k), function); });
}

/// The impacts of indices on each device, or `Within` one.
template <motion_arithmetic A, bool Within, class Team, class Index>
auto impacts_on_devices(const Team& team, const std::vector<Index>& x, const std::vector<Index>& y,
                        const impact_options& options, const char* function) {
    using local = typename Team::local_policy;
    using found_type = impact<typename Index::scalar_type>;
    auto there = each_of(team, [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        return impacts_of_indices<A, Within>(team[k], x[i], y[i], options, no_fronts{}, function, share_of(team, k));
    });
    if (there.size() == 1) return std::move(there.front().found);
    found_lists<local, found_type> lists;
    found_lists<local, std::uint64_t> keys;
    for (auto& one : there) {
        lists.push_back(std::move(one.found));
        keys.push_back(std::move(one.keys));
    }
    const auto first = beginnings_of(lists);
    auto all = brought_to_first<Team, found_type>(team, lists, first);
    if (options.sorted && all.size() > 0) {
        const auto order = brought_to_first<Team, std::uint64_t>(team, keys, first);
        all = merged_by(team[0], by_number{}, order.data(), std::move(all), first);
    }
    return result<found_type, space_of<local>>(std::move(all));
}

/// The first of them: each device looks at the same part of the step.
template <motion_arithmetic A, bool Within, class Team, class Index>
auto first_on_devices(const Team& team, const std::vector<Index>& x, const std::vector<Index>& y,
                      const impact_options& options, const char* function) {
    return first_of_step<A>([&](double time) {
        const auto found = each_of(team, [&](int k) {
            const auto i = static_cast<std::size_t>(k);
            return first_until<A, Within>(team[k], x[i], y[i], time, options, no_fronts{}, function, share_of(team, k));
        });
        auto first = found.front();
        for (const auto& one : found) keep_earlier(first, one);
        return first;
    });
}

// --- of divided meshes ---------------------------------------------------------------------------------------------------

/// Ids of the features of two parts in the whole meshes.
struct ids_of_features {
    part_ids vertices_a, faces_a, vertices_b, faces_b;
};
/// The features of an impact in the whole meshes, in the order of results: each is a vertex, a face or the two vertices of
/// an edge. Edges are in the order of their vertices.
struct feature_places {
    std::uint32_t kind, a[2], b[2];

    [[nodiscard]] ABUT_HD bool comes_before(const feature_places& other) const {
        if (kind != other.kind) return kind < other.kind;
        for (int k = 0; k < 2; ++k) {
            if (a[k] != other.a[k]) return a[k] < other.a[k];
        }
        return b[0] != other.b[0] ? b[0] < other.b[0] : b[1] < other.b[1];
    }
};
template <scalar T>
struct placed_impact {
    impact<T> found;
    feature_places places;
};
struct by_places {
    template <scalar T>
    ABUT_HD bool operator()(const placed_impact<T>& x, const placed_impact<T>& y) const {
        return x.places.comes_before(y.places);
    }
};
template <scalar T>
struct place_impacts {
    const impact<T>* found;
    const std::uint64_t* keys;
    feature_key key;
    ids_of_features ids;
    placed_impact<T>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const impact<T>& f = found[i];
        const auto* const vertex = reinterpret_cast<const std::uint32_t*>(&f.vertices);
        placed_impact<T> made;
        made.found.kind = f.kind;
        made.found.time = f.time;
        auto* const whole = reinterpret_cast<std::uint32_t*>(&made.found.vertices);
        for (int k = 0; k < 4; ++k)
            whole[k] = is_of_first(f.kind, k) ? ids.vertices_a(vertex[k]) : ids.vertices_b(vertex[k]);
        const std::uint32_t a = key.a(keys[i]), b = key.b(keys[i]);
        made.places = {static_cast<std::uint32_t>(f.kind), {whole[0], whole[1]}, {whole[2], whole[3]}};
        if (f.kind == feature_pair::vertex_face) made.places = {made.places.kind, {whole[0], 0}, {ids.faces_b(b), 0}};
        if (f.kind == feature_pair::face_vertex) made.places = {made.places.kind, {ids.faces_a(a), 0}, {whole[0], 0}};
        out[i] = made;
    }
};
/// Whether impact i is not the one before it.
template <scalar T>
struct is_new_impact {
    const placed_impact<T>* all;
    ABUT_HD bool operator()(std::size_t i) const { return i == 0 || all[i - 1].places.comes_before(all[i].places); }
};
template <scalar T>
struct take_impact {
    const placed_impact<T>* all;
    const std::uint64_t* which;
    impact<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = all[which[i]].found; }
};

/// The ids of what a device has of a mesh; of a whole one they stay as they are.
template <class X>
part_ids vertex_ids_on(const X& x, int k) {
    if constexpr (is_divided_mesh<X>) {
        return x.vertex_ids(k);
    } else {
        return {};
    }
}
template <class X>
part_ids face_ids_on(const X& x, int k) {
    if constexpr (is_divided_mesh<X>) {
        return x.face_ids(k);
    } else {
        return {};
    }
}

/// What a device looks for impacts of: its part of a, or all of it; and as many of b, where that is divided too with what
/// came from others.
template <class Policy, class Index>
struct parts_that_meet {
    struct part_of_b {
        Index index;
        ids_of_features ids;
        mesh_piece<Policy, typename Index::scalar_type> piece;  ///< has the ids, where it came
    };
    Index a;
    std::vector<part_of_b> b;
};

/// What all devices look at, of which one or both are divided.
template <class Team, class X, class Y, class Nearness>
auto parts_that_meet_on_each(const Team& team, const X& x, const Y& y, const Nearness& near, const char* function) {
    using local = typename Team::local_policy;
    using T = typename type_on_device<X>::scalar_type;
    constexpr pair_rule rule = rule_of<type_on_device<X>, type_on_device<Y>>();
    const auto indices_a = impact_operand_on_each<Y>(team, x, function);
    const auto indices_b = impact_operand_on_each<X>(team, y, function);
    using index_type = typename std::remove_cvref_t<decltype(indices_a)>::value_type;
    using piece = mesh_piece<local, T>;
    const auto ids_of = [&](int k) {
        return ids_of_features{vertex_ids_on(x, k), face_ids_on(x, k), vertex_ids_on(y, k), face_ids_on(y, k)};
    };
    std::vector<std::vector<piece>> packed;  // [from][to]
    if constexpr (is_divided_mesh<X> && is_divided_mesh<Y>) {
        const auto bounds_of = [&](const auto& indices) {
            return each_of(team,
                           [&](int k) { return bounds_of_mesh_part(team[k], indices[static_cast<std::size_t>(k)].mesh()); });
        };
        const auto bounds_a = bounds_of(indices_a), bounds_b = bounds_of(indices_b);
        packed = each_of(team, [&](int from) {
            const local& on = team[from];
            const ids_of_features ids = ids_of(from);
            mesh_pieces<local, T> pieces(on, indices_b[static_cast<std::size_t>(from)].mesh());
            std::vector<piece> for_each(static_cast<std::size_t>(team.size()));
            for (int to = 0; to < team.size(); ++to) {
                const auto there = grown(bounds_a[static_cast<std::size_t>(to)], near);
                if (to == from || !there.is_near(bounds_b[static_cast<std::size_t>(from)])) continue;
                const auto size = pieces.count_near(there);
                piece some(on, static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]));
                pieces.write_near(there, some.arrays());
                for_each_index(on, some.vertex_ids.size(), gather_ids{ids.vertices_b, some.vertex_ids.data()});
                for_each_index(on, some.face_ids.size(), gather_ids{ids.faces_b, some.face_ids.data()});
                for_each[static_cast<std::size_t>(to)] = std::move(some);
            }
            synchronize(on);
            return for_each;
        });
    }
    return each_of(team, [&](int k) {
        const local& on = team[k];
        const auto i = static_cast<std::size_t>(k);
        parts_that_meet<local, index_type> all{indices_a[i], {}};
        all.b.push_back({indices_b[i], ids_of(k), {}});
        for (int step = 1; step < team.size() && !packed.empty(); ++step) {
            const int other = (k + step) % team.size();
            piece& there = packed[static_cast<std::size_t>(other)][i];
            if (there.vertex_ids.size() == 0) continue;
            piece here = there.copied_to(
                on, [&](const auto* p, std::size_t n, const local& to, auto* q) { copy_across(team[other], p, n, to, q); });
            there = {};
            const auto mesh = here.take_mesh();
            ids_of_features ids = ids_of(k);
            ids.vertices_b = {here.vertex_ids.data(), 0};
            ids.faces_b = {here.face_ids.data(), 0};
            all.b.push_back({make_impact_index<rule>(on, mesh), ids, std::move(here)});
        }
        return all;
    });
}

template <motion_arithmetic A, class Team, class X, class Y>
auto impacts_of_divided(const Team& team, const X& x, const Y& y, impact_options options, const char* function) {
    using local = typename Team::local_policy;
    using T = typename type_on_device<X>::scalar_type;
    using placed = placed_impact<T>;
    options.sorted = true;  // so that what was found twice is next to itself
    const auto parts = parts_that_meet_on_each(team, x, y, nearness_of<A, T>(options.bounds, function), function);
    auto lists = each_of(team, [&](int k) {
        const local& on = team[k];
        const auto& mine = parts[static_cast<std::size_t>(k)];
        found_lists<local, placed> of_parts;
        for (const auto& b : mine.b) {
            const auto some =
                impacts_of_indices<A, false>(on, mine.a, b.index, options, no_fronts{}, function, search_part{});
            execution::buffer_of<local, placed> all(on, some.found.size());
            for_each_index(on, all.size(),
                           place_impacts<T>{some.found.data(), some.keys.data(), some.key, b.ids, all.data()});
            synchronize(on);
            of_parts.emplace_back(std::move(all));
        }
        return joined<local, placed>(on, std::move(of_parts), true, by_places{});
    });
    const local& first = team[0];
    const auto all = on_first(team, std::move(lists), true, by_places{});
    execution::buffer_of<local, std::uint64_t> which(first, all.size());
    const std::size_t n = compact(first, all.size(), is_new_impact<T>{all.data()}, which.data());
    execution::buffer_of<local, impact<T>> kept(first, n);
    for_each_index(first, n, take_impact<T>{all.data(), which.data(), kept.data()});
    synchronize(first);
    return result<impact<T>, space_of<local>>(std::move(kept));
}

/// An impact in the whole meshes. The tables of ids lie where the policy works, so it reads them.
template <class Policy, scalar T>
placed_impact<T> placed_there(const Policy& on, const keyed_impact<T>& one, const ids_of_features& ids) {
    execution::buffer_of<Policy, impact<T>> found(on, 1);
    execution::buffer_of<Policy, std::uint64_t> key(on, 1);
    execution::buffer_of<Policy, placed_impact<T>> there(on, 1);
    upload(on, &one.found, 1, found.data());
    upload(on, &one.key, 1, key.data());
    for_each_index(on, 1, place_impacts<T>{found.data(), key.data(), one.keys, ids, there.data()});
    placed_impact<T> placed;
    download(on, there.data(), 1, &placed);
    return placed;
}

template <motion_arithmetic A, class Team, class X, class Y>
auto first_of_divided(const Team& team, const X& x, const Y& y, const impact_options& options, const char* function) {
    using T = typename type_on_device<X>::scalar_type;
    using first_type = std::optional<placed_impact<T>>;
    const auto parts = parts_that_meet_on_each(team, x, y, nearness_of<A, T>(options.bounds, function), function);
    const auto keep_earlier = [](first_type& first, const first_type& one) {
        if (!one) return;
        const bool earlier = !first || one->found.time < first->found.time ||
                             (one->found.time == first->found.time && by_places{}(*one, *first));
        if (earlier) first = one;
    };
    return first_of_step<A>([&](double time) {
        const auto found = each_of(team, [&](int k) {
            const auto& mine = parts[static_cast<std::size_t>(k)];
            first_type first;
            for (const auto& b : mine.b) {
                const auto one =
                    first_until<A, false>(team[k], mine.a, b.index, time, options, no_fronts{}, function, search_part{});
                if (one) keep_earlier(first, placed_there(team[k], *one, b.ids));
            }
            return first;
        });
        first_type first;
        for (const first_type& one : found) keep_earlier(first, one);
        return first;
    });
}

}  // namespace detail

/// @addtogroup devices
///@{

/// An impact index on each device, of a mesh at rest or in motion in host memory, or of one that each device has; or of the
/// parts of a divided_mesh. Options are those of `make_impact_index` under one policy. Returns a `replicated` or a
/// `divided_mesh` of indices; waits for all.
template <execution::policy_team Team, class X>
[[nodiscard]] auto make_impact_index(const Team& team, const X& x, const bvh_options& options = {}) {
    if constexpr (detail::can_move_on_devices<Team, X>()) {
        detail::require_as_many(team, x, "abut::make_impact_index");
        auto indices =
            detail::each_of(team, [&](int k) { return make_impact_index(team[k], detail::on_device(x, k), options); });
        if constexpr (detail::is_divided_mesh<X>) {
            return divided_mesh<typename decltype(indices)::value_type>(std::move(indices), x);
        } else {
            return replicated(std::move(indices));
        }
    } else {
        return detail::refused();
    }
}

/// The impacts of two meshes, as under one policy, bit for bit: a `result` of `impact` in memory of the first device.
/// Arguments are replicated meshes, at rest or in motion, replicated indices of such, or meshes in host memory, which are
/// copied to each device for the call; or meshes that are divided (divide_mesh), and indices of their parts. Fronts are not
/// taken.
///
/// Of divided meshes the answer is that of the whole ones, with their vertex numbers, and is always sorted. Where both are
/// divided, pieces of b come to the devices whose parts of a they come near during the step, and all pieces of a device are
/// there at a time: of each other device at most its part, with an index. The first device holds 56 bytes for each impact,
/// three times for a moment, and those of features on the border of two parts more than once.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X, class Y>
[[nodiscard]] auto impacts(const Team& team, const X& a, const Y& b, const impact_options& options = {}) {
    constexpr const char* function = "abut::impacts";
    if constexpr (detail::can_meet_on_devices<Team, X, Y>()) {
        if constexpr (detail::is_divided_mesh<X> || detail::is_divided_mesh<Y>) {
            return detail::impacts_of_divided<A>(team, a, b, options, function);
        } else {
            const auto x = detail::impact_operand_on_each<Y>(team, a, function);
            const auto y = detail::impact_operand_on_each<X>(team, b, function);
            return detail::impacts_on_devices<A, false>(team, x, y, options, function);
        }
    } else {
        return result<impact<float>, space_of<typename Team::local_policy>>();
    }
}

/// The impacts of a mesh with itself, as under one policy; otherwise as `impacts`.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X>
[[nodiscard]] auto self_impacts(const Team& team, const X& x, const impact_options& options = {}) {
    constexpr const char* function = "abut::self_impacts";
    if constexpr (detail::can_move_whole_on_devices<Team, X>()) {
        const auto all = detail::impact_operand_on_each<X>(team, x, function);
        return detail::impacts_on_devices<A, true>(team, all, all, options, function);
    } else {
        return result<impact<float>, space_of<typename Team::local_policy>>();
    }
}

/// The earliest of the impacts, as under one policy: a std::optional<impact<T>>. All devices look at a first part of the
/// step, and at more where nothing touches in it. Arguments are those of `impacts`; pieces of b are of the whole step.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X, class Y>
[[nodiscard]] auto first_impact(const Team& team, const X& a, const Y& b, const impact_options& options = {}) {
    constexpr const char* function = "abut::first_impact";
    if constexpr (detail::can_meet_on_devices<Team, X, Y>()) {
        if constexpr (detail::is_divided_mesh<X> || detail::is_divided_mesh<Y>) {
            return detail::first_of_divided<A>(team, a, b, options, function);
        } else {
            const auto x = detail::impact_operand_on_each<Y>(team, a, function);
            const auto y = detail::impact_operand_on_each<X>(team, b, function);
            return detail::first_on_devices<A, false>(team, x, y, options, function);
        }
    } else {
        return std::optional<impact<float>>();
    }
}

/// The earliest of the impacts of a mesh with itself; otherwise as `first_impact`.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X>
[[nodiscard]] auto first_self_impact(const Team& team, const X& x, const impact_options& options = {}) {
    constexpr const char* function = "abut::first_self_impact";
    if constexpr (detail::can_move_whole_on_devices<Team, X>()) {
        const auto all = detail::impact_operand_on_each<X>(team, x, function);
        return detail::first_on_devices<A, true>(team, all, all, options, function);
    } else {
        return std::optional<impact<float>>();
    }
}

///@}

}  // namespace abut
