// SPDX-License-Identifier: MIT
//
// usage: fcl_glue [ROBOT ROOM [MOTIONS]]
//
// Motions of a robot in a room (files of meshes, or two that are made), by FCL's continuousCollide and by what stands in for it: how
// many meet, and what FCL misses. A motion meets for certain where FCL itself sees a collision at one of 1,000 poses on the way.
#include <fcl/fcl.h>

#include <abut/io/read.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <random>

#include "fcl_glue.hpp"

using model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<model> model_of(const abut::mesh<double>& mesh) {
    auto made = std::make_shared<model>();
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> faces;
    const auto seen = mesh.view();
    for (std::size_t i = 0; i < seen.vertices.count; ++i) vertices.emplace_back(seen.vertices[i].x, seen.vertices[i].y, seen.vertices[i].z);
    for (std::size_t i = 0; i < seen.faces.count; ++i) faces.emplace_back(seen.faces[i][0], seen.faces[i][1], seen.faces[i][2]);
    made->beginModel();
    made->addSubModel(vertices, faces);
    made->endModel();
    return made;
}
/// A bar, and walls with gaps.
abut::mesh<double> bar() {
    return {{{-2, -0.1, -0.1}, {2, -0.1, -0.1}, {2, 0.1, -0.1}, {-2, 0.1, -0.1}, {-2, -0.1, 0.1}, {2, -0.1, 0.1}, {2, 0.1, 0.1}, {-2, 0.1, 0.1}},
            {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}};
}
abut::mesh<double> walls() {
    std::vector<abut::vec3<double>> vertices;
    std::vector<abut::face> faces;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const auto n = static_cast<std::uint32_t>(vertices.size());
            const double x = 5.0 * i - 7.5, y = 5.0 * j - 10;
            for (const auto& [dy, z] : {std::pair{0.0, -8.0}, {2.0, -8.0}, {2.0, 8.0}, {0.0, 8.0}}) vertices.push_back({x, y + dy, z});
            faces.push_back({n, n + 1, n + 2});
            faces.push_back({n, n + 2, n + 3});
        }
    }
    return {vertices, faces};
}

int main(int argc, char** argv) try {
    const bool has_files = argc > 2;
    const abut::mesh<double> robot = has_files ? abut::io::read_mesh<double>(argv[1]) : bar(),
                             room = has_files ? abut::io::read_mesh<double>(argv[2]) : walls();
    const int motions = argc > 3 ? std::atoi(argv[3]) : 100;
    const auto fcl_robot = model_of(robot), fcl_room = model_of(room);
    const fcl_glue::Model of_robot(*fcl_robot), of_room(*fcl_room);

    // To any pose in the box around the room, from one that is free.
    std::mt19937 random(20190819);
    const auto box = of_room.index().bounds();
    const auto between = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967295.0); };
    const auto draw = [&] {
        fcl::Transform3d t = fcl::Transform3d::Identity();
        const double w = between(-1, 1), x = between(-1, 1), y = between(-1, 1);
        t.linear() = Eigen::Quaterniond(w, x, y, between(-1, 1)).normalized().toRotationMatrix();
        const double at_x = between(box.lower.x, box.upper.x), at_y = between(box.lower.y, box.upper.y);
        t.translation() = fcl::Vector3d(at_x, at_y, between(box.lower.z, box.upper.z));
        return t;
    };
    const auto rest = fcl::Transform3d::Identity();
    const auto touch = [&](const fcl::Transform3d& at) {
        fcl::CollisionRequestd request;
        fcl::CollisionResultd result;
        return fcl::collide(fcl_robot.get(), at, fcl_room.get(), rest, request, result) > 0;
    };
    fcl::ContinuousCollisionRequestd request;
    int met = 0, certain = 0, fcl_met = 0, missed = 0, fcl_missed = 0, fcl_added = 0;
    for (int i = 0; i < motions;) {
        const auto from = draw(), to = draw();
        if (touch(from)) continue;
        ++i;
        fcl::ContinuousCollisionResultd by_abut, by_fcl;
        fcl_glue::continuousCollide(&of_robot, from, to, &of_room, rest, rest, request, by_abut);
        request.ccd_motion_type = fcl::CCDM_LINEAR;
        fcl::continuousCollide(fcl_robot.get(), from, to, fcl_room.get(), rest, rest, request, by_fcl);
        bool is_certain = false;
        for (int k = 0; k <= 1000 && !is_certain; ++k) is_certain = touch(fcl_glue::transform_at(from, to, k / 1000.0));
        met += by_abut.is_collide, fcl_met += by_fcl.is_collide, certain += is_certain;
        missed += is_certain && !by_abut.is_collide, fcl_missed += is_certain && !by_fcl.is_collide;
        fcl_added += by_fcl.is_collide && !by_abut.is_collide;
    }
    std::printf("%d motions, of which %d meet for certain\n", motions, certain);
    std::printf("fcl_glue: %d meet, %d missed\n", met, missed);
    std::printf("FCL:      %d meet, %d missed, %d that are proven to be free\n", fcl_met, fcl_missed, fcl_added);
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "fcl_glue: %s\n", e.what());
    return 1;
}
