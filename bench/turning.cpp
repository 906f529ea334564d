// SPDX-License-Identifier: MIT
//
// usage: bench_turning DATA [--json=OUT.json] [--motions=N] [--runs=N]
//
// Motions of a robot in a room, which turn (meshes/rob.obj and env.obj of DATA), on one core: by abut in one call, and by
// FCL's continuousCollide, one call each, in one run. N motions (1,000) of three kinds, short: edges of a road map, 300 long
// and half a radian at most, that begin free; long: to any pose, from one that is free; anywhere: from any pose to any
// other, of which half begin in contact. The tolerance is 0.1; the room is 6,000 wide. Rows:
//
//   KIND/abut           ms of all, the median of N runs (5), and how many meet
//   KIND/abut_any       the same of the yes or no alone
//   KIND/fcl_naive      FCL's default, which looks at ten poses; missed: meetings that abut proves and FCL says are none
//   KIND/fcl_advance    FCL's conservative advancement
//
// late: times more than 0.01 later than abut's; phantom: said to meet, where abut proves that nothing does and no pose of
// 2,000 intersects.
//
// missed is counted against abut's answer where the robot and the room intersect at one of 2,000 poses on the way (certain):
// so are abut's own.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fcl/fcl.h>

#include <abut/collide/query.hpp>
#include <abut/collide/turning.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/set.hpp>

#include "mesh_file.hpp"
#include "results.hpp"
#include "turning_scene.hpp"

namespace {

using mesh = abut::mesh<float>;
using fcl_model = fcl::BVHModel<fcl::OBBRSSd>;

using turning_scene::surface;
using turning_scene::tolerance;

std::shared_ptr<fcl_model> model_of(const surface& s) {
    auto m = std::make_shared<fcl_model>();
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> faces;
    for (const auto& v : s.vertices) vertices.emplace_back(v.x, v.y, v.z);
    for (const auto& f : s.faces) faces.emplace_back(f[0], f[1], f[2]);
    m->beginModel();
    m->addSubModel(vertices, faces);
    m->endModel();
    return m;
}
fcl::Transform3d transform_of(const abut::rigid<float>& p) {
    fcl::Transform3d t = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) t.linear()(i, j) = static_cast<double>(p.rotation[3 * i + j]);
    }
    t.translation() = fcl::Vector3d(static_cast<double>(p.translation.x), static_cast<double>(p.translation.y),
                                    static_cast<double>(p.translation.z));
    return t;
}

template <class F>
double median_ms(int runs, const F& f) {
    std::vector<double> all;
    for (int i = 0; i < runs; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        f();
        all.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

void compare(bench::results& out, const turning_scene::kind& of, const surface& robot, const surface& room, std::size_t n, int runs) {
    const abut::serial on;
    const std::string kind = of.name;
    const auto of_robot = abut::make_bvh(on, mesh(robot.vertices, robot.faces), turning_scene::how_built),
               of_room = abut::make_bvh(on, mesh(room.vertices, room.faces), turning_scene::how_built);
    const auto fcl_robot = model_of(robot), fcl_room = model_of(room);
    const auto list = turning_scene::pairs_of(turning_scene::motions_of(of, of_robot, of_room, n), of_robot, of_room);
    const auto found = abut::to_host(abut::first_meetings(on, list, {tolerance}));
    // What surely meets: at one of many poses on the way they intersect.
    std::vector<char> surely(n);
    std::size_t met = 0, missed = 0, certain = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto motion = abut::detail::make_rigid_motion(list[i].a.from, list[i].a.to, list[i].a.about, "bench");
        const bool is_met = found[i].a != abut::no_id;
        for (int k = 0; k <= 2000 && !surely[i]; ++k) {
            const auto frame = motion.frame(k / 2000.0);
            abut::rigid<float> pose;
            for (int j = 0; j < 3; ++j) {
                const double numbers[3] = {frame.rows[j].x, frame.rows[j].y, frame.rows[j].z};
                for (int c = 0; c < 3; ++c) pose.rotation[3 * j + c] = static_cast<float>(numbers[c]);
            }
            pose.translation = {static_cast<float>(frame.at.x), static_cast<float>(frame.at.y),
                                static_cast<float>(frame.at.z)};
            if (abut::any(on, abut::posed(of_robot, pose), of_room)) surely[i] = 1;
        }
        met += is_met, certain += surely[i], missed += surely[i] && !is_met;
    }
    const double ms = median_ms(runs, [&] { (void)abut::first_meetings(on, list, {tolerance}); });
    const auto number = [](auto x) { return static_cast<double>(x); };
    out.add(bench::joined({kind, "abut"}),
            {{"ms", ms}, {"met", number(met)}, {"certain", number(certain)}, {"missed", number(missed)}});
    const double any_ms = median_ms(runs, [&] { (void)abut::any_each(on, list, {tolerance}); });
    out.add(bench::joined({kind, "abut_any"}), {{"ms", any_ms}});
    for (const auto& [name, solver] :
         {std::pair{"fcl_naive", fcl::CCDC_NAIVE}, std::pair{"fcl_advance", fcl::CCDC_CONSERVATIVE_ADVANCEMENT}}) {
        std::vector<double> toc(n);
        const double fcl_ms = median_ms(solver == fcl::CCDC_NAIVE ? runs : 1, [&, kind_of = solver] {
            for (std::size_t i = 0; i < n; ++i) {
                fcl::ContinuousCollisionRequestd request;
                request.ccd_solver_type = kind_of;
                request.ccd_motion_type = fcl::CCDM_LINEAR;
                fcl::ContinuousCollisionResultd result;
                const auto rest = fcl::Transform3d::Identity();
                fcl::continuousCollide(fcl_robot.get(), transform_of(list[i].a.from), transform_of(list[i].a.to),
                                       fcl_room.get(), rest, rest, request, result);
                toc[i] = result.is_collide ? result.time_of_contact : 2;
            }
        });
        std::size_t fcl_missed = 0, late = 0, says = 0, phantom = 0;
        for (std::size_t i = 0; i < n; ++i) {
            says += toc[i] <= 1;
            fcl_missed += surely[i] && toc[i] > 1;
            phantom += toc[i] <= 1 && !surely[i] && found[i].a == abut::no_id;
            late += surely[i] && toc[i] <= 1 && found[i].a != abut::no_id && toc[i] > found[i].time + 0.01;
        }
        out.add(bench::joined({kind, name}), {{"ms", fcl_ms},
                                              {"met", number(says)},
                                              {"missed", number(fcl_missed)},
                                              {"late", number(late)},
                                              {"phantom", number(phantom)},
                                              {"over", fcl_ms / ms}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string json = bench::take_argument(argc, argv, "--json"),
                          motions = bench::take_argument(argc, argv, "--motions", "1000"),
                          runs = bench::take_argument(argc, argv, "--runs", "5");
        const std::string data = argc > 1 ? argv[1] : ".";
        const auto robot = bench::read_surface<surface>(data + "/meshes/rob.obj"),
                   room = bench::read_surface<surface>(data + "/meshes/env.obj");
        bench::results out("bench_turning");
        for (const auto& of : turning_scene::kinds) compare(out, of, robot, room, std::stoul(motions), std::stoi(runs));
        if (!json.empty()) out.write(json);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_turning: %s\n", e.what());
        return 1;
    }
}
