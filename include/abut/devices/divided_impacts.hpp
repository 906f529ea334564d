// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts and the first of them of meshes of which each device has a part. A device looks for impacts of its
// part of a and its part of b, and of what of other parts of b comes near its part of a. Features on the border of two parts
// are in both: what two devices find of them is the same, bit for bit, and is kept once.
//
// Of a mesh with itself, a device looks for impacts within its part, and for those of its part and what of others comes near
// it. A pair across two parts is met on both devices. A vertex and a face are kept where the vertex is the device's own, and
// two edges where the lesser one is. So each pair is computed in the order in which the whole mesh has it.

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

namespace abut::detail {

/// What `x` is to a query of it and `Y`: an index on each device.
template <class Y, class Team, class X>
auto impact_operand_on_each(const Team& team, const X& x, const char* function) {
    constexpr pair_rule rule = rule_of<type_on_device<X>, type_on_device<Y>>();
    require_as_many(team, x, function);
    return each_of(team, [&](int k) { return impact_operand<rule>(team[k], on_device(x, k), function); });
}

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

/// The parts of a divided mesh as indices, which are made where they are none.
template <class Team, class X>
auto indices_of_parts(const Team& team, const X& x, const char* function) {
    auto indices = impact_operand_on_each<X>(team, x, function);
    return divided_mesh<typename decltype(indices)::value_type>(std::move(indices), x);
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

// Of a mesh with itself.

/// Of the pairs of two parts of a mesh those that are kept, by vertices' ids in the whole mesh.
template <class Pairs>
struct pairs_across : Pairs {
    part_ids ids_a, ids_b;

    [[nodiscard]] ABUT_HD bool wanted(feature_pair kind, std::uint32_t i, std::uint32_t j) const {
        if (kind == feature_pair::face_vertex) return false;
        std::uint32_t first[2] = {}, second[3] = {};
        if (kind == feature_pair::vertex_face) {
            const std::uint32_t* const corner = corners_at(this->b.faces.t0.faces, j);
            first[0] = ids_a(i);
            for (int k = 0; k < 3; ++k) second[k] = ids_b(corner[k]);
            return share_no_vertex(first[0], second);
        }
        const std::uint32_t *const of_a = corners_at(this->a.edges.t0.edges, i), *const of_b =
                                                                                     corners_at(this->b.edges.t0.edges, j);
        for (int k = 0; k < 2; ++k) first[k] = ids_a(of_a[k]), second[k] = ids_b(of_b[k]);
        return share_no_vertex(first, second) && first[0] < second[0];
    }
};
/// A part of a search: what is across two parts of a mesh.
struct across_parts : search_part {
    part_ids ids_a, ids_b;

    template <class Pairs>
    [[nodiscard]] pairs_across<Pairs> asked_of(const Pairs& both) const {
        return {both, ids_a, ids_b};
    }
};

/// look(b, within, part) of each part of b that a device has. `Within` one mesh the first of them is the device's own, which
/// is looked at by itself.
template <bool Within, class Parts, class Look>
void look_at_each(const Parts& mine, const Look& look) {
    for (std::size_t i = 0; i < mine.b.size(); ++i) {
        const auto& b = mine.b[i];
        if constexpr (!Within) {
            look(b, std::false_type{}, search_part{});
        } else if (i == 0) {
            look(b, std::true_type{}, search_part{});
        } else {
            look(b, std::false_type{}, across_parts{{}, b.ids.vertices_a, b.ids.vertices_b});
        }
    }
}

/// The impacts of two meshes, or `Within` one, which is both x and y.
template <motion_arithmetic A, bool Within, class Team, class X, class Y>
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
        look_at_each<Within>(mine, [&](const auto& b, auto within, const auto& part) {
            const auto some =
                impacts_of_indices<A, decltype(within)::value>(on, mine.a, b.index, options, no_fronts{}, function, part);
            execution::buffer_of<local, placed> all(on, some.found.size());
            for_each_index(on, all.size(),
                           place_impacts<T>{some.found.data(), some.keys.data(), some.key, b.ids, all.data()});
            synchronize(on);
            of_parts.emplace_back(std::move(all));
        });
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

/// The first impact of two meshes, or `Within` one, which is both x and y.
template <motion_arithmetic A, bool Within, class Team, class X, class Y>
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
    const auto first_until_time = [&](double time) {
        const auto found = each_of(team, [&](int k) {
            const auto& mine = parts[static_cast<std::size_t>(k)];
            first_type first;
            look_at_each<Within>(mine, [&](const auto& b, auto within, const auto& part) {
                const auto one = first_until<A, decltype(within)::value>(team[k], mine.a, b.index, time, options,
                                                                         no_fronts{}, function, part);
                if (one) keep_earlier(first, placed_there(team[k], *one, b.ids));
            });
            return first;
        });
        first_type first;
        for (const first_type& one : found) keep_earlier(first, one);
        return first;
    };
    return first_of_step<A>(first_until_time, options.bounds);
}

}  // namespace abut::detail
