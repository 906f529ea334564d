// SPDX-License-Identifier: MIT
#pragma once

// impacts of two meshes in motion whose parts lie on many ranks. What comes to a rank are pieces of b: the faces that come
// near its part of a during the step, with their vertices. The features of a piece have the order of those of the whole
// part, and are all that a piece adds, so each pair is met once and has the same bits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include <abut/collide/impacts.hpp>
#include <abut/collide/mesh_pieces.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/query.hpp>

#include <mpi.h>

namespace abut {

/// An `impact` with vertex numbers in meshes of many parts.
/// @ingroup distributed
template <scalar T>
struct global_impact {
    using scalar_type = T;  ///< of the meshes
    feature_pair kind;      ///< which features
    /// As of `impact`: the vertex and the three of the face; or the two of a's edge and the two of b's.
    std::array<std::uint64_t, 4> vertices;
    double time;  ///< the earliest in [0, 1] at which they touch

    friend constexpr bool operator==(const global_impact&, const global_impact&) = default;
};

namespace detail {

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

template <motion_arithmetic A, class Local, class X, class Y>
auto impacts_of_parts(const distributed<Local>& on, const X& x, const Y& y, const impact_options& options,
                      const char* function) {
    using T = typename X::scalar_type;
    constexpr pair_rule rule = rule_of<X, Y>();
    const own_communicator& ranks = on.ranks();
    const Local& local = on.local();
    attempts attempt;
    const auto bring = [&] {
        auto [a, b] = impact_operands(local, x, y, function);
        return std::pair(std::move(a), std::move(b));
    };
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
    const std::uint64_t first_a = parts_a.first_of(ranks.rank());

    found_by_rank<Local, global_impact<T>> all;
    const auto ask = [&](int rank, const auto& b, const std::uint32_t* ids) {
        const auto some = impacts_of_indices<A, false>(local, a, b, options, no_fronts{}, function);
        const global_ids vertices{first_a, parts_b.first_of(rank), ids};
        all.add(local, rank, some.found.size(), [&](global_impact<T>* out, std::uint64_t* keys) {
            for_each_index(local, some.found.size(),
                           name_impacts_globally<T>{some.found.data(), some.keys.data(), some.key, vertices, out, keys});
        });
    };
    attempt([&] { ask(ranks.rank(), here->second, nullptr); });
    const auto use = [&](int rank, const auto& piece, const std::uint32_t* ids) {
        ask(rank, make_impact_index<rule>(local, piece), ids);
    };
    const auto goes = [&](int from, int to) { return parts_a[to].is_near(parts_b[from]); };
    mesh_parcels<Local, T, decltype(use)> parcels(local, here->second.mesh(), parts_a, use);
    exchange_parcels(on, attempt, room, goes, parcels);
    return joined(on, all, options.sorted, 34);
}

}  // namespace detail

/// All pairs of a vertex and a face, and of two edges, of which the first is in this rank's part of `a` and the second in
/// any part of `b`, that touch during the step, each once, with the earliest time: a `result` of `global_impact`, 48 bytes
/// each, in the local policy's memory. Arguments are this rank's parts, as those of `impacts` under the local policy. The
/// mesh that is asked about is all parts one after another: each has vertices of its own, and vertex numbers begin where
/// those of the rank before end. Vertices on the border of two parts are in both, and so are edges between them.
///
/// Each rank's list is sorted as `impacts` sorts, unless the options say otherwise. Since it is sorted by kind first, the
/// lists of all ranks are those of one machine kind by kind. Times are the same bits.
/// @ingroup distributed
template <motion_arithmetic A = filtered, execution_policy Local, class X, class Y>
[[nodiscard]] auto impacts(const distributed<Local>& on, const X& a, const Y& b, const impact_options& options = {}) {
    if constexpr (detail::can_meet<Local, X, Y>()) {
        return detail::impacts_of_parts<A>(on, a, b, options, "abut::impacts");
    } else {
        return result<global_impact<float>, space_of<Local>>();
    }
}

}  // namespace abut
