// SPDX-License-Identifier: MIT
//
// The peer: FCL's dynamic tree of boxes over its own shapes in double.

#include <memory>
#include <vector>

#include <fcl/fcl.h>

#include "peer.hpp"

namespace {

using namespace mixed_scene;

struct held {
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
    std::vector<std::uint32_t> numbers;
    fcl::DynamicAABBTreeCollisionManagerd tree;
    std::vector<abut::index_pair> found;

    static fcl::Transform3d placed(const abut::rigid<double>& pose) {
        fcl::Transform3d t = fcl::Transform3d::Identity();
        for (int i = 0; i < 9; ++i) t(i / 3, i % 3) = pose.rotation[i];
        t.translation() = fcl::Vector3d(pose.translation.x, pose.translation.y, pose.translation.z);
        return t;
    }
    explicit held(const crowd& s) : numbers(s.bodies.size()) {
        const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
        mesh->beginModel(static_cast<int>(s.faces.size()), static_cast<int>(s.vertices.size()));
        const auto at = [&](std::uint32_t i) { return fcl::Vector3d(s.vertices[i].x, s.vertices[i].y, s.vertices[i].z); };
        for (const auto& f : s.faces) mesh->addTriangle(at(f[0]), at(f[1]), at(f[2]));
        mesh->endModel();
        for (std::size_t i = 0; i < s.bodies.size(); ++i) {
            const auto shape = shape_of<fcl::CollisionGeometryd, fcl::Boxd, fcl::Capsuled, fcl::Cylinderd, fcl::Sphered>(s.bodies[i], mesh);
            objects.push_back(std::make_unique<fcl::CollisionObjectd>(shape, placed(s.now[i])));
            numbers[i] = static_cast<std::uint32_t>(i);
            objects.back()->setUserData(&numbers[i]);
            tree.registerObject(objects.back().get());
        }
        tree.setup();
    }
    static bool meet(fcl::CollisionObjectd* x, fcl::CollisionObjectd* y, void* data) {
        fcl::CollisionRequestd request(1);
        fcl::CollisionResultd result;
        if (fcl::collide(x, y, request, result) == 0) return false;
        const auto a = *static_cast<std::uint32_t*>(x->getUserData()), b = *static_cast<std::uint32_t*>(y->getUserData());
        static_cast<held*>(data)->found.push_back(a < b ? abut::index_pair{a, b} : abut::index_pair{b, a});
        return false;
    }
    void find() { tree.collide(this, meet); }
};

[[maybe_unused]] const bool added = [] {
    peers().push_back({"fcl", holder_of<held>, "FCL " FCL_VERSION});
    return true;
}();

}  // namespace
