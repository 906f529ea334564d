// SPDX-License-Identifier: MIT
#pragma once

// FCL as an oracle for meshes, in double. It is right for pairs in general position only: transforms are to be rounded into
// the vertices before, and of its contacts only the ids count, of which a pair may have several.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <fcl/fcl.h>

#include <abut/collide/options.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/view.hpp>

namespace abut::test {

using fcl_model = std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>>;

inline fcl_model make_fcl_model(const mesh_view<double>& mesh, const rigid<double>& pose = {}) {
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; i < mesh.vertices.count; ++i) {
        const vec3<double> v = place(pose, mesh.vertices[i]);
        vertices.emplace_back(v.x, v.y, v.z);
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const face& f = mesh.faces[i];
        triangles.emplace_back(f[0], f[1], f[2]);
    }
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
}

/// All pairs of triangles that FCL finds, sorted, each once.
inline std::vector<index_pair> fcl_pairs(const fcl_model& a, const fcl_model& b) {
    const fcl::Transform3d identity = fcl::Transform3d::Identity();
    fcl::CollisionResultd result;
    fcl::collide(a.get(), identity, b.get(), identity, fcl::CollisionRequestd(100'000'000, false), result);
    std::vector<index_pair> pairs;
    for (std::size_t k = 0; k < result.numContacts(); ++k) {
        const auto& contact = result.getContact(k);
        pairs.push_back({static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// How far apart two models are that do not touch.
inline double fcl_distance(const fcl_model& a, const fcl_model& b) {
    const fcl::Transform3d identity = fcl::Transform3d::Identity();
    fcl::DistanceResultd result;
    return fcl::distance(a.get(), identity, b.get(), identity, fcl::DistanceRequestd(), result);
}

}  // namespace abut::test
