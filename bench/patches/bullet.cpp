// SPDX-License-Identifier: MIT
//
// Bullet's manifolds of two meshes (GImpact), whose contacts it keeps from frame to frame: a row SCENE/bullet of bench_patches.
// The mean of points and normals, and the largest depth, as of contacts.

#include "peer.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wshadow"
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#pragma GCC diagnostic pop

namespace {

using patches_peer::answer;
using patches_peer::scene;

struct body {
    btTriangleMesh faces;
    std::unique_ptr<btGImpactMeshShape> shape;
    btCollisionObject object;

    explicit body(const abut::mesh<float>& mesh) {
        const auto view = mesh.view();
        const auto at = [&](std::uint32_t i) { return btVector3(view.vertices[i].x, view.vertices[i].y, view.vertices[i].z); };
        for (std::size_t f = 0; f < view.size(); ++f) faces.addTriangle(at(view.faces[f][0]), at(view.faces[f][1]), at(view.faces[f][2]));
        shape = std::make_unique<btGImpactMeshShape>(&faces);
        shape->setMargin(0);
        shape->updateBound();
        object.setCollisionShape(shape.get());
        // Which bodies move is a solver's matter; two that do not are not looked at.
        object.setCollisionFlags(0);
    }
};

struct world {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btCollisionWorld all{&dispatcher, &broadphase, &configuration};
    body a, b;

    explicit world(const scene& s) : a(s.a), b(s.b) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
        all.addCollisionObject(&a.object);
        all.addCollisionObject(&b.object);
    }
    ~world() {
        all.removeCollisionObject(&a.object);
        all.removeCollisionObject(&b.object);
    }
    world(const world&) = delete;
    world& operator=(const world&) = delete;

    answer at(const abut::rigid<float>& pose) {
        const float* const r = pose.rotation;
        a.object.setWorldTransform(btTransform(btMatrix3x3(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]),
                                               btVector3(pose.translation.x, pose.translation.y, pose.translation.z)));
        a.shape->postUpdate();
        all.performDiscreteCollisionDetection();
        answer found;
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            const btPersistentManifold& m = *dispatcher.getManifoldByIndexInternal(i);
            const double way = m.getBody0() == &a.object ? 1 : -1;
            for (int k = 0; k < m.getNumContacts(); ++k) {
                const btManifoldPoint& p = m.getContactPoint(k);
                if (p.getDistance() > 0) continue;
                const btVector3 &n = p.m_normalWorldOnB, c = (p.getPositionWorldOnA() + p.getPositionWorldOnB()) / 2;
                found.normal = found.normal + abut::vec3<double>{way * double(n.x()), way * double(n.y()), way * double(n.z())};
                found.center = found.center + abut::vec3<double>{double(c.x()), double(c.y()), double(c.z())};
                found.depth = std::max(found.depth, -double(p.getDistance()));
                ++found.found;
            }
        }
        found.is_known = found.found > 0;
        if (!found.is_known) return found;
        found.center = abut::scale(1.0 / static_cast<double>(found.found), found.center);
        const double l = std::sqrt(abut::dot(found.normal, found.normal));
        if (l > 0) found.normal = abut::scale(1 / l, found.normal);
        return found;
    }
};

patches_peer::method make(const scene& s) {
    return [w = std::make_shared<world>(s)](const abut::rigid<float>& pose) { return w->at(pose); };
}

[[maybe_unused]] const bool is_registered = (patches_peer::peers().emplace_back("bullet", make), true);

}  // namespace
