// SPDX-License-Identifier: MIT
//
// Coal's shapes in double, each kind of pair looked up once, as ComputeCollision and ComputeDistance do, with its own tolerances.
// Where shapes meet it is not asked how deep unless contacts are asked for.

#include <functional>
#include <memory>
#include <vector>

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/collision_object.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include "arm.hpp"
#include "peer.hpp"

namespace {

using namespace peers;

std::shared_ptr<coal::ShapeBase> made(const shape& s) {
    switch (s.of) {
        case kind::sphere: return std::make_shared<coal::Sphere>(s.radius);
        case kind::capsule: return std::make_shared<coal::Capsule>(s.radius, 2 * s.half);
        case kind::box: return std::make_shared<coal::Box>(2 * s.halves.x, 2 * s.halves.y, 2 * s.halves.z);
        case kind::cylinder: return std::make_shared<coal::Cylinder>(s.radius, 2 * s.half);
        case kind::cone: return std::make_shared<coal::Cone>(s.radius, 2 * s.half);
        case kind::hull: break;
    }
    const auto points = std::make_shared<std::vector<coal::Vec3s>>();
    const auto faces = std::make_shared<std::vector<coal::Triangle>>();
    for (const vec3& p : s.points) points->emplace_back(p.x, p.y, p.z);
    for (const auto& f : s.faces) faces->emplace_back(f[0], f[1], f[2]);
    return std::make_shared<coal::Convex<coal::Triangle>>(points, static_cast<unsigned>(points->size()), faces,
                                                          static_cast<unsigned>(faces->size()));
}

coal::Transform3s made(const abut::rigid<double>& pose) {
    coal::Matrix3s m;
    for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = pose.rotation[i];
    return {m, coal::Vec3s(pose.translation.x, pose.translation.y, pose.translation.z)};
}

vec3 made(const coal::Vec3s& p) { return {p[0], p[1], p[2]}; }

/// Its poses are made before anything is timed: the first call of each list pays for that.
struct poses_of {
    std::vector<coal::Transform3s> a, b;
    void take(const std::vector<pose_pair>& poses) {
        if (a.size() == poses.size()) return;
        for (const pose_pair& p : poses) {
            a.push_back(made(p.a));
            b.push_back(made(p.b));
        }
    }
};

ask make(const shape& first, const shape& second, question asked) {
    const auto a = made(first), b = made(second);
    const auto kept = std::make_shared<poses_of>();
    if (asked == question::distance) {
        coal::DistanceRequest request(true, false);
        return [=](const std::vector<pose_pair>& poses, std::vector<answer>& out) {
            kept->take(poses);
            const coal::ComputeDistance compute(a.get(), b.get());
            coal::DistanceResult result;
            for (std::size_t i = 0; i < poses.size(); ++i) {
                result.clear();
                const double length = compute(kept->a[i], kept->b[i], request, result);
                out[i] = {length <= 0, length, made(result.nearest_points[0]), made(result.nearest_points[1]), made(result.normal)};
            }
        };
    }
    const coal::CollisionRequest request(asked == question::contact ? coal::CONTACT : coal::NO_REQUEST, 1);
    return [=](const std::vector<pose_pair>& poses, std::vector<answer>& out) {
        kept->take(poses);
        const coal::ComputeCollision compute(a.get(), b.get());
        coal::CollisionResult result;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            result.clear();
            out[i].touch = compute(kept->a[i], kept->b[i], request, result) != 0;
            if (asked != question::contact || !out[i].touch) continue;
            const coal::Contact& c = result.getContact(0);
            out[i] = {true, -c.penetration_depth, made(c.nearest_points[0]), made(c.nearest_points[1]), made(c.normal)};
        }
    };
}

// --- states of an arm

/// Objects of a scene, each made once; links are moved.
struct arm_objects {
    std::vector<coal::CollisionObject> room, links;
    std::vector<std::size_t> numbers;  ///< of the room's, to which its objects point

    explicit arm_objects(const arm_scene& s) {
        for (const auto& box : s.room) {
            abut::rigid<double> pose{.translation = box.center};
            for (int k = 0; k < 9; ++k) pose.rotation[k] = box.rotation[k];
            room.emplace_back(made(shape{"", kind::box, 0, 0, box.half}), made(pose));
        }
        if (s.room.empty()) {
            const auto mesh = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
            std::vector<coal::Vec3s> vertices;
            std::vector<coal::Triangle> faces;
            for (const vec3& p : s.vertices) vertices.emplace_back(p.x, p.y, p.z);
            for (const auto& f : s.faces) faces.emplace_back(f[0], f[1], f[2]);
            mesh->beginModel();
            mesh->addSubModel(vertices, faces);
            mesh->endModel();
            room.emplace_back(mesh);
        }
        for (const shape& link : s.links) links.emplace_back(made(link));
        numbers.resize(room.size());
        for (std::size_t i = 0; i < room.size(); ++i) {
            numbers[i] = i;
            room[i].setUserData(&numbers[i]);
        }
    }
    void move(const arm_scene& s, std::size_t state, std::size_t link) {
        links[link].setTransform(made(s.poses[state][link]));
        links[link].computeAABB();
    }
    bool meet(std::size_t link, coal::CollisionObject& other) {
        result.clear();
        return coal::collide(&links[link], &other, request, result) != 0;
    }
    coal::CollisionRequest request{coal::NO_REQUEST, 1};
    coal::CollisionResult result;
};

/// All links with all of the room, or with those whose boxes meet, until something does.
template <bool Boxes>
std::function<void(collisions&)> arm_by_loop(const arm_scene& s) {
    const auto all = std::make_shared<arm_objects>(s);
    return [&s, all](collisions& out) {
        out.assign(s.poses.size(), 0);
        for (std::size_t i = 0; i < s.poses.size(); ++i) {
            for (std::size_t k = 0; k < s.links.size() && out[i] == 0; ++k) {
                all->move(s, i, k);
                for (std::size_t j = 0; j < all->room.size() && out[i] == 0; ++j) {
                    if (!s.room.empty() && arm_scene::is_allowed(k, j)) continue;
                    if (Boxes && !all->links[k].getAABB().overlap(all->room[j].getAABB())) continue;
                    out[i] = all->meet(k, all->room[j]);
                }
            }
        }
    };
}

/// By its dynamic tree of boxes.
std::function<void(collisions&)> arm_by_tree(const arm_scene& s) {
    struct callback : coal::CollisionCallBackBase {
        arm_objects* all = nullptr;
        std::size_t link = 0;
        bool in_room = false, met = false;
        bool collide(coal::CollisionObject* o1, coal::CollisionObject* o2) override {
            coal::CollisionObject* const other = o1 == &all->links[link] ? o2 : o1;
            if (in_room && arm_scene::is_allowed(link, *static_cast<std::size_t*>(other->getUserData()))) return false;
            met = all->meet(link, *other);
            return met;
        }
    };
    const auto all = std::make_shared<arm_objects>(s);
    const auto tree = std::make_shared<coal::DynamicAABBTreeCollisionManager>();
    for (coal::CollisionObject& o : all->room) tree->registerObject(&o);
    tree->setup();
    return [&s, all, tree](collisions& out) {
        out.assign(s.poses.size(), 0);
        callback each;
        each.all = all.get();
        each.in_room = !s.room.empty();
        for (std::size_t i = 0; i < s.poses.size(); ++i) {
            for (std::size_t k = 0; k < s.links.size() && out[i] == 0; ++k) {
                all->move(s, i, k);
                each.link = k, each.met = false;
                tree->collide(&all->links[k], &each);
                out[i] = each.met;
            }
        }
    };
}

const bool added = [] {
    arm_checkers().push_back({"Coal", arm_by_loop<false>});
    arm_checkers().push_back({"Coal_boxes", arm_by_loop<true>});
    arm_checkers().push_back({"Coal_tree", arm_by_tree});
    libraries().push_back({"Coal", ABUT_COAL_VERSION, make});
    return true;
}();

}  // namespace
