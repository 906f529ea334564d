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

namespace {

using mesh = abut::mesh<float>;
using index_type = decltype(abut::make_bvh(abut::serial{}, mesh{}));
using fcl_model = fcl::BVHModel<fcl::OBBRSSd>;

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};
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

class numbers {
public:
    double between(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 20190819;
};
abut::rigid<float> pose_of(double (&q)[4], const abut::vec3<double>& at) {
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double w = q[0] / n, x = q[1] / n, y = q[2] / n, z = q[3] / n;
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    abut::rigid<float> p;
    for (int i = 0; i < 9; ++i) p.rotation[i] = static_cast<float>(m[i]);
    p.translation = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
    return p;
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

constexpr double tolerance = 0.1;

void compare(bench::results& out, const std::string& kind, const surface& robot, const surface& room, bool is_short,
             bool begins_free, std::size_t n, int runs) {
    const abut::serial on;
    const abut::bvh_options with{.builder = abut::bvh_builder::sah};
    const auto of_robot = abut::make_bvh(on, mesh(robot.vertices, robot.faces), with),
               of_room = abut::make_bvh(on, mesh(room.vertices, room.faces), with);
    const auto fcl_robot = model_of(robot), fcl_room = model_of(room);
    numbers draw;
    std::vector<abut::moving_pair<index_type>> list;
    while (list.size() < n) {
        double q[4], r[4];
        double length = 0;
        for (double& x : q) x = draw.between(-1, 1), length += x * x;
        if (length > 1 || length < 0.01) continue;
        const abut::vec3<double> at{draw.between(-3000, 3000), draw.between(-3000, 3000), draw.between(0, 2987)};
        abut::vec3<double> to{draw.between(-3000, 3000), draw.between(-3000, 3000), draw.between(0, 2987)};
        for (double& x : r) x = draw.between(-1, 1);
        if (is_short) {
            // A turn by half a radian at most is one by a quaternion that is a tenth off.
            for (int i = 0; i < 4; ++i) r[i] = q[i] + 0.1 * std::sqrt(length) * r[i];
            to = {at.x + draw.between(-170, 170), at.y + draw.between(-170, 170), at.z + draw.between(-170, 170)};
        }
        const auto from = pose_of(q, at), end = pose_of(r, to);
        if (begins_free && abut::any(on, abut::posed(of_robot, from), of_room)) continue;
        list.push_back({abut::moving(abut::posed(of_robot, from), abut::posed(of_robot, end)),
                        abut::posed(of_room, abut::rigid<float>{})});
    }
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
        compare(out, "short", robot, room, true, true, std::stoul(motions), std::stoi(runs));
        compare(out, "long", robot, room, false, true, std::stoul(motions), std::stoi(runs));
        compare(out, "anywhere", robot, room, false, false, std::stoul(motions), std::stoi(runs));
        if (!json.empty()) out.write(json);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_turning: %s\n", e.what());
        return 1;
    }
}
