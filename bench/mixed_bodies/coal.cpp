// SPDX-License-Identifier: MIT
//
// The peer: Coal's dynamic tree of boxes over its own shapes in double.

#include <memory>
#include <vector>

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/collision_object.h>
#include <coal/shape/geometric_shapes.h>

#include "peer.hpp"

namespace {

using namespace mixed_scene;

struct held : coal::CollisionCallBackBase {
    std::vector<std::unique_ptr<coal::CollisionObject>> objects;
    std::vector<std::uint32_t> numbers;
    coal::DynamicAABBTreeCollisionManager tree;
    std::vector<abut::index_pair> found;

    static coal::Transform3s placed(const abut::rigid<double>& pose) {
        coal::Matrix3s m;
        for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = pose.rotation[i];
        return {m, coal::Vec3s(pose.translation.x, pose.translation.y, pose.translation.z)};
    }
    explicit held(const crowd& s) : numbers(s.bodies.size()) {
        const auto mesh = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
        std::vector<coal::Vec3s> vertices;
        std::vector<coal::Triangle> faces;
        for (const auto& p : s.vertices) vertices.emplace_back(p.x, p.y, p.z);
        for (const auto& f : s.faces) faces.emplace_back(f[0], f[1], f[2]);
        mesh->beginModel();
        mesh->addSubModel(vertices, faces);
        mesh->endModel();
        for (std::size_t i = 0; i < s.bodies.size(); ++i) {
            const auto shape = shape_of<coal::CollisionGeometry, coal::Box, coal::Capsule, coal::Cylinder, coal::Sphere>(s.bodies[i], mesh);
            objects.push_back(std::make_unique<coal::CollisionObject>(shape, placed(s.now[i])));
            numbers[i] = static_cast<std::uint32_t>(i);
            objects.back()->setUserData(&numbers[i]);
            tree.registerObject(objects.back().get());
        }
        tree.setup();
    }
    bool collide(coal::CollisionObject* x, coal::CollisionObject* y) override {
        const coal::CollisionRequest request(coal::NO_REQUEST, 1);
        coal::CollisionResult result;
        if (coal::collide(x, y, request, result) == 0) return false;
        const auto a = *static_cast<std::uint32_t*>(x->getUserData()), b = *static_cast<std::uint32_t*>(y->getUserData());
        found.push_back(a < b ? abut::index_pair{a, b} : abut::index_pair{b, a});
        return false;
    }
    void find() { tree.collide(this); }
};

[[maybe_unused]] const bool added = [] {
    peers().push_back({"coal", holder_of<held>, "Coal " ABUT_COAL_VERSION});
    return true;
}();

}  // namespace
