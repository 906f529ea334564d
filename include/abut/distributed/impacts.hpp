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
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/query.hpp>
#include <abut/execution/atomic.hpp>

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

template <scalar T, memory_space Space>
moving_set<mesh<T, Space>> mesh_in_motion(const mesh<T, Space>& at_rest) {
    return {at_rest, at_rest};
}
template <scalar T, memory_space Space>
moving_set<mesh<T, Space>> mesh_in_motion(const moving_set<mesh<T, Space>>& set) {
    return set;
}
template <class Index>
    requires is_impact_index<Index>
auto mesh_in_motion(const Index& index) { return index.mesh(); }

/// The boxes of a part during the step, `size` being that of its vertices, which faces may have or not.
template <class Policy, scalar T, memory_space Space>
part_bounds<T> bounds_of_mesh_part(const Policy& on, const moving_set<mesh<T, Space>>& mesh) {
    part_bounds<T> part = bounds_of_part(on, vertices(mesh).view());
    const part_bounds<T> of_faces = bounds_of_part(on, mesh.view());
    for (std::size_t k = 0; k < part_boxes; ++k) part.groups[k] = merge(part.groups[k], of_faces.groups[k]);
    return part;
}

template <shape_view Vertices>
struct mark_vertices {
    comes_near<Vertices> near;
    std::uint32_t* marks;
    ABUT_HD void operator()(std::size_t i) const { marks[i] = near(i) ? 1 : 0; }
};
template <shape_view Faces>
struct mark_corners {
    comes_near<Faces> near;
    std::uint32_t* marks;
    ABUT_HD void operator()(std::size_t i) const {
        if (!near(i)) return;
        const std::uint32_t* const corner = corners_at(near.shapes.t0.faces, i);
        for (int k = 0; k < 3; ++k) execution::atomic_store(marks + corner[k], 1);
    }
};
struct is_marked {
    const std::uint32_t* marks;
    ABUT_HD bool operator()(std::size_t i) const { return marks[i] != 0; }
};
template <shape_view Faces>
struct pack_face {
    Faces faces;
    const std::uint32_t *ids, *numbers;  ///< of faces; of vertices in the piece
    face* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t* const corner = corners_at(faces.t0.faces, ids[i]);
        auto* const to = reinterpret_cast<std::uint32_t*>(out + i);
        for (int k = 0; k < 3; ++k) to[k] = numbers[corner[k]];
    }
};

/// Pieces of a mesh in motion that come near the parts of other ranks. use(rank, piece, ids) is called for what comes from a
/// rank; ids are those of its vertices there, in memory of the policy's that is used again after it.
template <class Local, scalar T, class Use>
class mesh_parcels {
public:
    using space = space_of<Local>;
    using sizes = std::array<std::uint64_t, 2>;  ///< of vertices, of faces

    mesh_parcels(const Local& local, const moving_set<mesh<T, space>>& mesh, const parts_of_set<T>& looking, const Use& use)
        : local_(local), mesh_(mesh), looking_(looking), use_(use) {}

    [[nodiscard]] sizes measure(int to) {
        mark(to);
        const one_if<is_marked> vertex{{marks_.data()}};
        const one_if<comes_near<faces_view>> near_face{{mesh_.view(), looking_[to]}};
        sizes size{};
        size[0] = reduce(local_, vertex_count(), std::uint64_t{0}, add_up_tallies{}, vertex);
        size[1] = reduce(local_, mesh_.size(), std::uint64_t{0}, add_up_tallies{}, near_face);
        return size;
    }
    void make_room(const sizes& out, const sizes& in) {
        out_.emplace(local_, out);
        in_.emplace(local_, in);
        face_ids_ = execution::buffer_of<Local, std::uint32_t>(local_, static_cast<std::size_t>(out[1]));
    }
    void pack(int to, const sizes& size) {
        const auto n = static_cast<std::size_t>(size[0]), m = static_cast<std::size_t>(size[1]);
        const auto at_t0 = vertices(mesh_.t0()).view(), at_t1 = vertices(mesh_.t1()).view();
        using points_type = std::remove_const_t<decltype(at_t0)>;
        mark(to);
        std::uint32_t* const ids = out_->ids.there();
        compact(local_, vertex_count(), is_marked{marks_.data()}, ids);
        exclusive_scan(local_, marks_.data(), vertex_count());  // marks become numbers
        compact(local_, mesh_.size(), comes_near<faces_view>{mesh_.view(), looking_[to]}, face_ids_.data());
        for_each_index(local_, m, pack_face<faces_view>{mesh_.view(), face_ids_.data(), marks_.data(), out_->faces.there()});
        for_each_index(local_, n, pack_shape<points_type>{at_t0, ids, out_->at_t0.there()});
        for_each_index(local_, n, pack_shape<points_type>{at_t1, ids, out_->at_t1.there()});
        out_->at_t0.bring_here(local_, n);
        out_->at_t1.bring_here(local_, n);
        out_->ids.bring_here(local_, n);
        out_->faces.bring_here(local_, m);
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
        const mesh<T, space> at_t0(local_, points(in_->at_t0.here(), n), std::span<const face>(in_->faces.here(), m));
        in_->ids.bring_there(local_, n);
        use_(from, moving_set(at_t0, at_t0.with_vertices(local_, points(in_->at_t1.here(), n))), in_->ids.there());
    }

private:
    using faces_view = typename moving_set<mesh<T, space>>::view_type;

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

    [[nodiscard]] std::size_t vertex_count() const { return mesh_.t0().view().vertices.count; }
    /// The vertices of a piece.
    void mark(int to) {
        if (marks_.size() == 0) marks_ = execution::buffer_of<Local, std::uint32_t>(local_, vertex_count() + 1);
        const auto points = vertices(mesh_).view();
        using points_type = std::remove_const_t<decltype(points)>;
        for_each_index(local_, vertex_count(), mark_vertices<points_type>{{points, looking_[to]}, marks_.data()});
        for_each_index(local_, mesh_.size(), mark_corners<faces_view>{{mesh_.view(), looking_[to]}, marks_.data()});
    }
    template <class F>
    void hand_over(room& all, const sizes& size, const F& f) {
        f(all.at_t0.here(), size[0], point_type_.get());
        f(all.at_t1.here(), size[0], point_type_.get());
        f(all.ids.here(), size[0], MPI_UINT32_T);
        f(all.faces.here(), size[1], face_type_.get());
    }

    const Local& local_;
    moving_set<mesh<T, space>> mesh_;
    const parts_of_set<T>& looking_;
    const Use& use_;
    message_type<vec3<T>> point_type_;
    message_type<face> face_type_;
    execution::buffer_of<Local, std::uint32_t> marks_, face_ids_;
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
            const bool is_a = f.kind == feature_pair::vertex_face   ? k == 0
                              : f.kind == feature_pair::face_vertex ? k != 0
                                                                    : k < 2;
            global[k] = is_a ? ids.first_a + local[k] : ids(0, local[k]).b;
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
