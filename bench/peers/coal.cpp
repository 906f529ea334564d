// SPDX-License-Identifier: MIT
//
// Coal's shapes in double, each kind of pair looked up once, as ComputeCollision and ComputeDistance do, with its own tolerances.
// Where shapes meet it is not asked how deep unless contacts are asked for.

#include <memory>

#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

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

const bool added = [] {
    libraries().push_back({"Coal", ABUT_COAL_VERSION, make});
    return true;
}();

}  // namespace
