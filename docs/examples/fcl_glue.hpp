// SPDX-License-Identifier: MIT
#pragma once

// In place of fcl::continuousCollide for two meshes, by its name and with FCL's own models, transforms, requests and results. The
// answer is certified: never late, and what is told to be free is proven to be. Copy it and change it.

#include <fcl/fcl.h>

#include <abut/abut.hpp>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace fcl_glue {

/// A mesh of FCL with a tree of its own, which is made once. The model's vertices and faces are copied.
class Model {
public:
    template <class BV>
    explicit Model(const fcl::BVHModel<BV>& of) : index_(abut::make_bvh(abut::serial{}, mesh_of(of), {.builder = abut::bvh_builder::sah})) {}

    [[nodiscard]] const auto& index() const { return index_; }
    /// The length of the diagonal of the box around it.
    [[nodiscard]] double size() const {
        const auto box = index_.bounds();
        return (fcl::Vector3d(box.upper.x, box.upper.y, box.upper.z) - fcl::Vector3d(box.lower.x, box.lower.y, box.lower.z)).norm();
    }

private:
    using mesh = abut::mesh<double>;
    template <class BV>
    static mesh mesh_of(const fcl::BVHModel<BV>& of) {
        std::vector<abut::vec3<double>> vertices;
        std::vector<abut::face> faces;
        for (int i = 0; i < of.num_vertices; ++i) vertices.push_back({of.vertices[i][0], of.vertices[i][1], of.vertices[i][2]});
        for (int i = 0; i < of.num_tris; ++i) {
            const auto& t = of.tri_indices[i];
            faces.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
        }
        return mesh(vertices, faces);
    }
    decltype(abut::make_bvh(abut::serial{}, mesh{})) index_;
};

/// The axis and the angle by which a body turns from one transform to another.
inline Eigen::AngleAxisd turn_between(const fcl::Transform3d& from, const fcl::Transform3d& to) {
    return Eigen::AngleAxisd(to.linear() * from.linear().transpose());
}
/// Where a body is at a time: its origin goes in a straight line, and it turns about that at a constant rate. It is the motion of
/// FCL's CCDM_LINEAR, and of abut.
inline fcl::Transform3d transform_at(const fcl::Transform3d& from, const fcl::Transform3d& to, double t) {
    const Eigen::AngleAxisd turn = turn_between(from, to);
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = Eigen::AngleAxisd(t * turn.angle(), turn.axis()).toRotationMatrix() * from.linear();
    at.translation() = (1 - t) * from.translation() + t * to.translation();
    return at;
}
inline abut::rigid<double> pose_of(const fcl::Transform3d& t) {
    abut::rigid<double> pose;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) pose.rotation[3 * i + j] = t.linear()(i, j);
    }
    pose.translation = {t.translation().x(), t.translation().y(), t.translation().z()};
    return pose;
}
inline auto motion_of(const Model& model, const fcl::Transform3d& from, const fcl::Transform3d& to) {
    // A half turn has no shorter way round. It goes the one that transform_at goes.
    abut::turning<double> about;
    const Eigen::AngleAxisd turn = turn_between(from, to);
    if (turn.angle() > 3) about.axis = {turn.axis().x(), turn.axis().y(), turn.axis().z()};
    return abut::moving(abut::posed(model.index(), pose_of(from)), abut::posed(model.index(), pose_of(to)), about);
}

/// Two models, each of which goes from one transform to another.
struct Query {
    const Model* o1;
    fcl::Transform3d tf1_beg, tf1_end;
    const Model* o2;
    fcl::Transform3d tf2_beg, tf2_end;
};

/// Of each query whether the two meet, when first, and where both are then. By any policy of the host: `abut::openmp{}` takes all
/// cores. Of the request only `toc_err` is looked at: at the time that is told the two are no farther apart than that share of
/// the larger model's size.
template <abut::execution_policy Policy>
std::vector<fcl::ContinuousCollisionResultd> continuousCollide(const Policy& on, const std::vector<Query>& queries,
                                                               const fcl::ContinuousCollisionRequestd& request) {
    using index = std::remove_cvref_t<decltype(queries.front().o1->index())>;
    std::vector<abut::moving_pair<index>> list;
    double size = 0;
    for (const Query& q : queries) {
        size = std::max({size, q.o1->size(), q.o2->size()});
        list.push_back({motion_of(*q.o1, q.tf1_beg, q.tf1_end), motion_of(*q.o2, q.tf2_beg, q.tf2_end)});
    }
    std::vector<fcl::ContinuousCollisionResultd> results(queries.size());
    if (queries.empty()) return results;
    const auto found = abut::to_host(abut::first_meetings(on, list, {.tolerance = request.toc_err * size}));
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        fcl::ContinuousCollisionResultd& result = results[i];
        result.is_collide = found[i].a != abut::no_id;
        result.time_of_contact = result.is_collide ? found[i].time : 1;
        result.contact_tf1 = transform_at(q.tf1_beg, q.tf1_end, result.time_of_contact);
        result.contact_tf2 = transform_at(q.tf2_beg, q.tf2_end, result.time_of_contact);
    }
    return results;
}
/// The same of one, as FCL has it: the time, or 1 where they do not meet.
inline double continuousCollide(const Model* o1, const fcl::Transform3d& tf1_beg, const fcl::Transform3d& tf1_end, const Model* o2,
                                const fcl::Transform3d& tf2_beg, const fcl::Transform3d& tf2_end,
                                const fcl::ContinuousCollisionRequestd& request, fcl::ContinuousCollisionResultd& result) {
    result = continuousCollide(abut::serial{}, {{o1, tf1_beg, tf1_end, o2, tf2_beg, tf2_end}}, request).front();
    return result.time_of_contact;
}

}  // namespace fcl_glue
