// SPDX-License-Identifier: MIT
//
// The peer: FCL's convex bodies in double, by each of its two solvers. It wants faces too, and climbs along them.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include "peer.hpp"

namespace {

std::shared_ptr<fcl::Convexd> convex(const hulls_peer::body& b) {
    const auto points = std::make_shared<std::vector<fcl::Vector3d>>();
    for (const auto& p : b.points) points->emplace_back(p.x, p.y, p.z);
    const auto faces = std::make_shared<std::vector<int>>();
    for (const auto& f : b.faces) {
        faces->push_back(3);
        for (const auto v : f) faces->push_back(static_cast<int>(v));
    }
    return std::make_shared<fcl::Convexd>(points, static_cast<int>(b.faces.size()), faces, true);
}

fcl::Transform3d transform(const abut::rigid<double>& pose) {
    fcl::Transform3d t = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) t.linear()(i, j) = pose.rotation[3 * i + j];
    }
    t.translation() << pose.translation.x, pose.translation.y, pose.translation.z;
    return t;
}

const bool added = [] {
    for (const auto& [solver, name] : {std::pair{fcl::GST_LIBCCD, "libccd"}, std::pair{fcl::GST_INDEP, "indep"}}) {
        const auto kind = solver;
        hulls_peer::add(std::string("intersects/fcl_") + name, [kind](const hulls_peer::body& b) {
            return [kind, shape = convex(b)](const abut::rigid<double>& pose) {
                const fcl::CollisionRequestd request(1, false, 1, false, true, kind);
                fcl::CollisionResultd result;
                return fcl::collide(shape.get(), fcl::Transform3d::Identity(), shape.get(), transform(pose), request,
                                    result) > 0;
            };
        });
        hulls_peer::add(std::string("distance/fcl_") + name, [kind](const hulls_peer::body& b) {
            return [kind, shape = convex(b)](const abut::rigid<double>& pose) {
                fcl::DistanceRequestd request(true);
                request.gjk_solver_type = kind;
                fcl::DistanceResultd result;
                return fcl::distance(shape.get(), fcl::Transform3d::Identity(), shape.get(), transform(pose), request,
                                     result) <= 0;
            };
        });
    }
    return true;
}();

}  // namespace
