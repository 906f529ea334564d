// SPDX-License-Identifier: MIT
#pragma once

// A mesh in motion of which each device has a part, for what is too large for one of them: `divide_mesh` gives each some of
// the faces, with their vertices. Vertices, and edges, that faces of several parts have are in all of these.

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/impacts.hpp>
#include <abut/collide/mesh_pieces.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/team.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/set.hpp>

namespace abut {

/// @addtogroup devices
///@{

/// A mesh at rest or in motion, of which each device has a part, or an impact index of each part.
template <class X>
class divided_mesh {
public:
    using scalar_type = typename X::scalar_type;                         ///< float or double
    using memory_space = typename X::memory_space;                       ///< where parts lie
    using ids_type = detail::shared_array<std::uint32_t, memory_space>;  ///< an array of ids

    /// Of parts that the devices have, one for each in their order: meshes, meshes in motion (moving) or indices of such. In
    /// the whole mesh the faces and the vertices of the first part come first, then those of the second, and so on: each
    /// part has vertices of its own. Nothing is copied. Throws capacity_error for 2^32 - 1 vertices or faces or more in all.
    explicit divided_mesh(std::vector<X> parts) : parts_(std::move(parts)) {
        std::size_t vertices = 0;
        for (const X& part : parts_) {
            first_vertex_.push_back(static_cast<std::uint32_t>(vertices));
            first_face_.push_back(static_cast<std::uint32_t>(size_));
            vertices += detail::mesh_in_motion(part).t0().view().vertices.count;
            size_ += part.size();
            if (vertices >= no_id || size_ >= no_id) {
                throw capacity_error("abut::divided_mesh: parts of " + std::to_string(vertices) + " vertices and " +
                                     std::to_string(size_) + " faces; expected fewer than 2^32 - 1 in all");
            }
        }
    }
    /// The same, and for each vertex and each face of a part the id in the whole mesh, ascending.
    divided_mesh(std::vector<X> parts, std::vector<ids_type> vertex_ids, std::vector<ids_type> face_ids)
        : divided_mesh(std::move(parts)) {
        vertex_ids_ = std::move(vertex_ids);
        face_ids_ = std::move(face_ids);
    }
    /// What is made of the parts of `whole`: indices of them.
    template <class Y>
    divided_mesh(std::vector<X> parts, const divided_mesh<Y>& whole)
        : divided_mesh(std::move(parts), whole.vertex_ids_, whole.face_ids_) {}

    /// What lies on the k-th device.
    [[nodiscard]] const X& operator[](int k) const { return parts_[static_cast<std::size_t>(k)]; }
    /// The ids of its vertices and of its faces in the whole mesh, as that device reads them.
    ///@{
    [[nodiscard]] part_ids vertex_ids(int k) const { return ids(vertex_ids_, first_vertex_, k); }
    [[nodiscard]] part_ids face_ids(int k) const { return ids(face_ids_, first_face_, k); }
    ///@}
    /// Number of devices.
    [[nodiscard]] int devices() const { return static_cast<int>(parts_.size()); }
    /// Number of faces of the whole mesh.
    [[nodiscard]] std::size_t size() const { return size_; }

private:
    template <class>
    friend class divided_mesh;

    static part_ids ids(const std::vector<ids_type>& all, const std::vector<std::uint32_t>& first, int k) {
        const auto i = static_cast<std::size_t>(k);
        return all.empty() ? part_ids{nullptr, first[i]} : part_ids{all[i].data(), 0};
    }

    std::vector<X> parts_;
    std::vector<std::uint32_t> first_vertex_, first_face_;  ///< ids of the parts' first ones, where there are no others
    std::vector<ids_type> vertex_ids_, face_ids_;
    std::size_t size_ = 0;
};

///@}

namespace detail {

template <class X>
inline constexpr bool is_divided_mesh<divided_mesh<X>> = true;

/// A piece of a mesh with the ids of its vertices and faces, in a policy's memory.
template <class Policy, scalar T>
struct mesh_piece {
    execution::buffer_of<Policy, vec3<T>> at_t0, at_t1;
    execution::buffer_of<Policy, std::uint32_t> vertex_ids;
    execution::buffer_of<Policy, face> faces;
    execution::buffer_of<Policy, std::uint32_t> face_ids;

    mesh_piece() = default;
    mesh_piece(const Policy& policy, std::size_t n, std::size_t m)
        : at_t0(policy, n), at_t1(policy, n), vertex_ids(policy, n), faces(policy, m), face_ids(policy, m) {}
    [[nodiscard]] piece_arrays<T> arrays() {
        return {at_t0.data(), at_t1.data(), vertex_ids.data(), faces.data(), face_ids.data()};
    }
    /// A copy elsewhere: hand_over(p, n, to, q) copies n elements.
    template <class To, class HandOver>
    [[nodiscard]] mesh_piece<To, T> copied_to(const To& to, const HandOver& hand_over) const {
        mesh_piece<To, T> there(to, vertex_ids.size(), face_ids.size());
        hand_over(at_t0.data(), at_t0.size(), to, there.at_t0.data());
        hand_over(at_t1.data(), at_t1.size(), to, there.at_t1.data());
        hand_over(vertex_ids.data(), vertex_ids.size(), to, there.vertex_ids.data());
        hand_over(faces.data(), faces.size(), to, there.faces.data());
        hand_over(face_ids.data(), face_ids.size(), to, there.face_ids.data());
        return there;
    }
    /// The mesh, which takes its vertices and faces from here.
    [[nodiscard]] auto take_mesh() {
        const auto t0 = set_parts::mesh_of<T, space_of<Policy>>(std::move(at_t0), std::move(faces));
        return moving_set(t0, set_parts::with_points(t0, set_parts::shapes_of(std::move(at_t1))));
    }
};

// The faces of a part, and the vertices of no face, which are all in one part.

struct set_part {
    const std::uint32_t* order;
    std::size_t count;
    int parts;
    std::uint32_t* part_of;
    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t p = static_cast<std::size_t>(parts), each = count / p, more = count % p;
        // The first `more` parts have one face more than the others.
        const std::size_t part = i < more * (each + 1) ? i / (each + 1) : more + (i - more * (each + 1)) / each;
        part_of[order[i]] = static_cast<std::uint32_t>(part);
    }
};
struct is_in_part {
    const std::uint32_t* part_of;
    std::uint32_t part;
    ABUT_HD bool operator()(std::size_t i) const { return part_of[i] == part; }
};
struct is_every {
    ABUT_HD bool operator()(std::size_t) const { return true; }
};
struct is_without_face {
    const std::uint32_t* has_face;
    bool wanted;
    ABUT_HD bool operator()(std::size_t i) const { return wanted && has_face[i] == 0; }
};

/// Parts of a mesh along a curve, as divide_along_curve makes them of shapes.
template <class Team, class Source, scalar T, class HandOver>
auto divide_faces(const Team& team, const Source& source, const moving_set<mesh<T, space_of<Source>>>& mesh,
                  const HandOver& hand_over) {
    using local = typename Team::local_policy;
    using part_type = moving_set<abut::mesh<T, space_of<local>>>;
    using ids_type = typename divided_mesh<part_type>::ids_type;
    const std::size_t vertex_count = mesh.t0().view().vertices.count;
    execution::buffer_of<Source, std::uint32_t> part_of(source, mesh.size()), has_face(source, vertex_count);
    {
        const auto order = order_on_curve(source, mesh.view());
        for_each_index(source, mesh.size(), set_part{order.data(), mesh.size(), team.size(), part_of.data()});
        fill(source, has_face.data(), vertex_count, std::uint32_t{0});
        for_each_index(source, mesh.size(), mark_corners<is_every>{{}, mesh.t0().view().faces, has_face.data()});
        synchronize(source);
    }
    mesh_pieces<Source, T> pieces(source, mesh);
    std::vector<part_type> parts;
    std::vector<ids_type> vertex_ids, face_ids;
    for (int k = 0; k < team.size(); ++k) {  // one after another: the source has room for one part
        const is_in_part faces{part_of.data(), static_cast<std::uint32_t>(k)};
        const is_without_face alone{has_face.data(), k == 0};
        const auto size = pieces.count(faces, alone);
        mesh_piece<Source, T> packed(source, static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]));
        pieces.write(faces, alone, packed.arrays());
        synchronize(source);
        auto there = packed.copied_to(team[k], hand_over);
        parts.push_back(there.take_mesh());
        vertex_ids.push_back(ids_type(std::move(there.vertex_ids)));
        face_ids.push_back(ids_type(std::move(there.face_ids)));
    }
    return divided_mesh<part_type>(std::move(parts), std::move(vertex_ids), std::move(face_ids));
}

}  // namespace detail

/// @addtogroup devices
///@{

/// Divides a mesh at rest or in motion: each device gets as many faces as the others, or one more, which are neighbours
/// along a Hilbert curve, and their vertices, in the order of their ids. Vertices of no face go to the first device. Of
/// faces and vertices the ids in `set` are kept, 4 bytes each. `set` lies on one of the devices or in host memory; there it
/// may be larger than a device's memory. That side needs besides it 12 bytes a face and 8 a vertex, and room for one part.
/// Returns a `divided_mesh` of moving sets; waits for all. Throws error if the set lies on a device that is none of these.
template <execution::policy_team Team, class Set>
    requires requires(const Set& set) { detail::mesh_in_motion(set); }
[[nodiscard]] auto divide_mesh(const Team& team, const Set& set) {
    const auto mesh = detail::mesh_in_motion(set);
    return detail::where_it_lies(team, mesh, "abut::divide_mesh", [&](const auto& source, const auto& hand_over) {
        return detail::divide_faces<Team, std::remove_cvref_t<decltype(source)>, typename Set::scalar_type>(team, source,
                                                                                                            mesh, hand_over);
    });
}

///@}

}  // namespace abut
