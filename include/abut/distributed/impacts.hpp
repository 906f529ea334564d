// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts and the first of them of meshes in motion whose parts lie on many ranks. What comes to a rank are
// pieces of b: the faces that come near its part of a during the step, with their vertices. The features of a piece have the
// order of those of the whole part, and are all that a piece adds, so each pair is met once and has the same bits.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/mesh_pieces.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/query.hpp>

#include <mpi.h>

namespace abut::detail {

/// Pieces of a mesh in motion that come near the parts of other ranks. use(rank, piece, ids) is called for what comes from a
/// rank; ids are those of its vertices there, in memory of the policy's that is used again after it.
template <class Local, scalar T, class Use>
class mesh_parcels {
public:
    using space = space_of<Local>;
    using sizes = typename mesh_pieces<Local, T>::sizes;

    mesh_parcels(const Local& local, const moving_set<mesh<T, space>>& mesh, const parts_of_set<T>& looking, const Use& use)
        : local_(local), pieces_(local, mesh), looking_(looking), use_(use) {}

    [[nodiscard]] sizes measure(int to) { return pieces_.count_near(looking_[to]); }
    void make_room(const sizes& out, const sizes& in) {
        out_.emplace(local_, out);
        in_.emplace(local_, in);
        face_ids_ = execution::buffer_of<Local, std::uint32_t>(local_, static_cast<std::size_t>(out[1]));
    }
    void pack(int to, const sizes& size) {
        const auto n = static_cast<std::size_t>(size[0]), m = static_cast<std::size_t>(size[1]);
        pieces_.write_near(looking_[to], {out_->at_t0.there(), out_->at_t1.there(), out_->ids.there(), out_->faces.there(),
                                          face_ids_.data()});
        out_->at_t0.bring_here(local_, n);
        out_->at_t1.bring_here(local_, n);
        out_->ids.bring_here(local_, n);
        out_->faces.bring_here(local_, m);
    }
    /// What could not be packed is sent all the same.
    void give_up() {
        out_->at_t0.give_up();
        out_->at_t1.give_up();
        out_->ids.give_up();
        out_->faces.give_up();
    }
    template <class F>
    void send(const sizes& size, const F& f) {
        hand_over(*out_, size, f);
    }
    template <class F>
    void receive(const sizes& size, const F& f) {
        hand_over(*in_, size, f);
    }
    void unpack(int from, const sizes& size) {
        const auto n = static_cast<std::size_t>(size[0]), m = static_cast<std::size_t>(size[1]);
        using points = std::span<const vec3<T>>;
        const mesh<T, space> at_t0(local_, points(in_->at_t0.on_host(local_, n), n),
                                   std::span<const face>(in_->faces.on_host(local_, m), m));
        in_->ids.bring_there(local_, n);
        use_(from, moving_set(at_t0, at_t0.with_vertices(local_, points(in_->at_t1.on_host(local_, n), n))),
             in_->ids.there());
        synchronize(local_);
    }

private:
    struct room {
        message_room<Local, vec3<T>> at_t0, at_t1;
        message_room<Local, std::uint32_t> ids;
        message_room<Local, face> faces;
        room(const Local& local, const sizes& size)
            : at_t0(local, static_cast<std::size_t>(size[0])),
              at_t1(local, static_cast<std::size_t>(size[0])),
              ids(local, static_cast<std::size_t>(size[0])),
              faces(local, static_cast<std::size_t>(size[1])) {}
    };

    template <class F>
    void hand_over(room& all, const sizes& size, const F& f) {
        f(all.at_t0.here(), size[0], point_type_.get());
        f(all.at_t1.here(), size[0], point_type_.get());
        f(all.ids.here(), size[0], MPI_UINT32_T);
        f(all.faces.here(), size[1], face_type_.get());
    }

    const Local& local_;
    mesh_pieces<Local, T> pieces_;
    const parts_of_set<T>& looking_;
    const Use& use_;
    message_type<vec3<T>> point_type_;
    message_type<face> face_type_;
    execution::buffer_of<Local, std::uint32_t> face_ids_;
    std::optional<room> out_, in_;
};

/// Impacts with vertex numbers of the whole meshes, and by what those of several ranks are sorted.
template <scalar T>
struct name_impacts_globally {
    const impact<T>* found;
    const std::uint64_t* found_keys;
    feature_key key;
    global_ids ids;  ///< of vertices
    global_impact<T>* out;
    std::uint64_t* keys;

    ABUT_HD void operator()(std::size_t i) const {
        const impact<T>& f = found[i];
        const auto* const local = reinterpret_cast<const std::uint32_t*>(&f.vertices);
        out[i].kind = f.kind;
        out[i].time = f.time;
        auto* const global = reinterpret_cast<std::uint64_t*>(&out[i].vertices);
        for (int k = 0; k < 4; ++k) {
            global[k] = is_of_first(f.kind, k) ? ids.first_a + local[k] : ids(0, local[k]).b;
        }
        keys[i] = static_cast<std::uint64_t>(f.kind) << 32 | key.a(found_keys[i]);
    }
};

/// Of the pairs of two ranks' parts of one mesh those that one of them is asked: each vertex with the other's faces, and
/// edges if its own come first.
template <class Pairs>
struct pairs_of_ranks : Pairs {
    bool edges;
    [[nodiscard]] ABUT_HD bool wanted(feature_pair kind, std::uint32_t, std::uint32_t) const {
        return kind == feature_pair::vertex_face || (kind == feature_pair::edge_edge && edges);
    }
};
struct between_ranks : search_part {
    bool edges;
    template <class Pairs>
    [[nodiscard]] pairs_of_ranks<Pairs> asked_of(const Pairs& both) const {
        return {both, edges};
    }
};

/// Asks this rank's part of x and its part of y, and what comes of other ranks' parts of y: ask(rank, a, b, ids, within,
/// part), of indices and of vertices' ids. `Within` one mesh y is x. All ranks call it; it throws on all or on none.
template <motion_arithmetic A, bool Within, class Local, class X, class Y, class Ask>
void ask_all_meshes(const distributed<Local>& on, const X& x, const Y& y, const impact_options& options,
                    const char* function, const Ask& ask) {
    using T = typename X::scalar_type;
    constexpr pair_rule rule = rule_of<X, Y>();
    const own_communicator& ranks = on.ranks();
    const Local& local = on.local();
    const int me = ranks.rank();
    attempts attempt;
    const auto bring = [&] { return impact_operands<Within>(local, x, y, function); };
    std::optional<decltype(bring())> here;
    part_bounds<T> part_a, part_b;
    parts_of_set<T> parts_a, parts_b;
    parcel_room<std::array<std::uint64_t, 2>> room;
    attempt([&] {
        parts_a.make_room(ranks.size());
        parts_b.make_room(ranks.size());
        room.make_room(ranks.size());
        const auto near = nearness_of<A, T>(options.bounds, function);
        here.emplace(bring());
        part_a = grown(bounds_of_mesh_part(local, here->first.mesh()), near);
        part_b = bounds_of_mesh_part(local, here->second.mesh());
    });
    attempt.settle(ranks);
    const auto& a = here->first;
    parts_a.gather(ranks, part_a);
    parts_b.gather(ranks, part_b);
    const auto ids_of = [&](int rank, const std::uint32_t* ids) {
        return global_ids{parts_a.first_of(me), parts_b.first_of(rank), ids};
    };
    attempt([&] { ask(me, a, here->second, ids_of(me, nullptr), std::bool_constant<Within>{}, whole_search{}); });
    const auto use = [&](int rank, const auto& piece, const std::uint32_t* ids) {
        const auto b = make_impact_index<rule>(local, piece);
        if constexpr (Within) {
            ask(rank, a, b, ids_of(rank, ids), std::false_type{}, between_ranks{{}, me < rank});
        } else {
            ask(rank, a, b, ids_of(rank, ids), std::false_type{}, whole_search{});
        }
    };
    const auto goes = [&](int from, int to) { return parts_a[to].is_near(parts_b[from]); };
    mesh_parcels<Local, T, decltype(use)> parcels(local, here->second.mesh(), parts_a, use);
    exchange_parcels(on, attempt, room, goes, parcels);
}

template <class Local, motion_arithmetic A, bool Within, class X, class Y>
auto ask_motion(const distributed<Local>& on, const ask_impacts<A, Within>& question, const X& x, const Y& y,
                const impact_options& options) {
    if constexpr (can_collide<Within, Local, X, Y>()) {
        using T = typename X::scalar_type;
        const char* const function = question.function;
        const Local& local = on.local();
        found_by_rank<Local, global_impact<T>> all;
        ask_all_meshes<A, Within>(
            on, x, y, options, function,
            [&](int rank, const auto& a, const auto& b, const global_ids& ids, auto within, const auto& part) {
                const auto some =
                    impacts_of_indices<A, decltype(within)::value>(local, a, b, options, no_fronts{}, function, part);
                all.add(local, rank, some.found.size(), [&](global_impact<T>* out, std::uint64_t* keys) {
                    for_each_index(local, some.found.size(),
                                   name_impacts_globally<T>{some.found.data(), some.keys.data(), some.key, ids, out, keys});
                });
            });
        return joined(on, all, options.sorted, 34);
    } else {
        return result<global_impact<float>, space_of<Local>>();
    }
}

/// The first impact that a rank knows, and where it stands in the order of all.
template <scalar T>
struct first_on_rank {
    global_impact<T> found{};
    std::uint64_t place[5] = {static_cast<std::uint64_t>(-1)};  ///< kind; a's rank and feature, b's. None is the last.

    [[nodiscard]] bool is_one() const { return place[0] != static_cast<std::uint64_t>(-1); }
    [[nodiscard]] bool comes_before(const first_on_rank& other) const {
        if (!is_one() || !other.is_one()) return is_one();
        if (found.time != other.found.time) return found.time < other.found.time;
        return std::lexicographical_compare(place, place + 5, other.place, other.place + 5);
    }
};

template <class Local, motion_arithmetic A, bool Within, class X, class Y>
auto ask_motion(const distributed<Local>& on, const ask_first_impact<A, Within>& question, const X& x, const Y& y,
                const impact_options& options) {
    if constexpr (can_collide<Within, Local, X, Y>()) {
        using T = typename X::scalar_type;
        const char* const function = question.function;
        const Local& local = on.local();
        first_on_rank<T> first;
        ask_all_meshes<A, Within>(
            on, x, y, options, function,
            [&](int rank, const auto& a, const auto& b, const global_ids& ids, auto within, const auto& part) {
                const auto some =
                    first_of_indices<A, decltype(within)::value>(local, a, b, options, no_fronts{}, function, part);
                if (!some) return;
                execution::buffer_of<Local, impact<T>> there(local, 1);
                execution::buffer_of<Local, std::uint64_t> key(local, 2);
                execution::buffer_of<Local, global_impact<T>> named(local, 1);
                upload(local, &some->found, 1, there.data());
                upload(local, &some->key, 1, key.data());
                for_each_index(
                    local, 1,
                    name_impacts_globally<T>{there.data(), key.data(), some->keys, ids, named.data(), key.data() + 1});
                first_on_rank<T> one;
                download(local, named.data(), 1, &one.found);
                const std::uint64_t place[5] = {static_cast<std::uint64_t>(one.found.kind),
                                                static_cast<std::uint64_t>(on.rank()), some->keys.a(some->key),
                                                static_cast<std::uint64_t>(rank), some->keys.b(some->key)};
                std::copy(place, place + 5, one.place);
                if (one.comes_before(first)) first = one;
            });
        attempts attempt;
        std::vector<first_on_rank<T>> all;
        attempt([&] { all.resize(static_cast<std::size_t>(on.size())); });
        attempt.settle(on.ranks());
        gather(on.ranks(), first, all);
        for (const first_on_rank<T>& one : all) {
            if (one.comes_before(first)) first = one;
        }
        return first.is_one() ? std::optional(first.found) : std::optional<global_impact<T>>();
    } else {
        return std::optional<global_impact<float>>();
    }
}

}  // namespace abut::detail
