// SPDX-License-Identifier: MIT
//
// usage: bench_peers [--json=OUT.json] [--runs=N] [--poses=N] [--only=TEXT]
//
// abut beside libraries that no distribution packages, out of the checkouts below ABUT_PEERS (bench/peers.cmake), on one core
// in double: convex shapes two at a time, both turned at random in N poses (1,000) in which they touch and as many in which they do
// not. Rows, of names that contain TEXT:
//
//   boolean/A_B/LIBRARY   all poses; wrong is what abut::exact answers otherwise
//   distance/A_B/LIBRARY  those apart
//   contact/A_B/LIBRARY   those that touch
//   ties/A_B/LIBRARY      booleans of shapes that touch in one point, and of such as are a unit in the last place nearer or farther.
//                         What is right is known from how they are made
//   states/SCENE/LIBRARY  which of 10,000 states of an arm of eight links collide: in a room of 100 boxes, and with a mesh of 20,000
//                         triangles; ns of a state. Of Coal a plain loop, one that looks at boxes first, and its tree of boxes. wrong
//                         is what abut::exact answers otherwise
//
// ns is the median of N runs (15) over the poses, in which the libraries take turns; over is abut's over the library's; wrong and worst
// are what bench/peers/judge.hpp says, of so many answers.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <abut/collide/hull_edges.hpp>

#include "peers/abut.hpp"
#include "peers/arm.hpp"
#include "peers/draws.hpp"
#include "peers/judge.hpp"
#include "peers/peer.hpp"
#include "results.hpp"

namespace {

using namespace peers;

/// An ellipsoid, by an octahedron whose faces are divided: 18, 66, 258, 1,026 points. Numbers are rounded to 2^-20.
shape ellipsoid(int divisions) {
    shape s{"", kind::hull};
    std::vector<vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    s.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int i = 0; i < divisions; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t p, std::uint32_t q) {
            const auto [at, fresh] = middles.try_emplace({p < q ? p : q, p < q ? q : p}, points.size());
            if (fresh) {
                const vec3 m = points[p] + points[q];
                points.push_back((1 / std::sqrt(dot(m, m))) * m);
            }
            return at->second;
        };
        std::vector<abut::face> finer;
        for (const auto& [p, q, r] : s.faces) {
            const std::uint32_t pq = middle(p, q), qr = middle(q, r), rp = middle(r, p);
            finer.insert(finer.end(), {{p, pq, rp}, {pq, q, qr}, {rp, qr, r}, {pq, qr, rp}});
        }
        s.faces = finer;
    }
    const auto rounded = [](double x) { return std::nearbyint(x * 0x1p20) * 0x1p-20; };
    for (const vec3& p : points) s.points.push_back({rounded(1.25 * p.x), rounded(p.y), rounded(0.75 * p.z)});
    s.name = "hull" + std::to_string(s.points.size());
    for (const vec3& p : s.points) {
        if (outside(s, {}, p) > 1e-15L) throw std::logic_error("a hull's faces are not its own");
    }
    return s;
}

shape with_edges(shape s) {
    const abut::hulls<double> alone(std::vector<std::vector<vec3>>{s.points});
    s.with_edges = std::make_shared<const abut::hulls<double>>(abut::with_edges(alone));
    s.name += "-with-edges";
    return s;
}

/// So many that touch, by abut::exact, and as many that do not, each mixed.
struct posed {
    std::vector<pose_pair> all, apart, touching;
};
posed poses_of(const shape& a, const shape& b, std::size_t n) {
    posed out;
    draws d;
    const ask exact = abut_answers<abut::exact>(a, b, question::boolean);
    std::vector<answer> one(1);
    while (out.touching.size() < n || out.apart.size() < n) {
        const std::vector<pose_pair> p{{d.turned({d(-1, 1), d(-1, 1), d(-1, 1)}), {}}};
        std::vector<pose_pair> q = p;
        q[0].b = d.turned(p[0].a.translation + d(0.3, 4) * d.way());
        exact(q, one);
        auto& into = one[0].touch ? out.touching : out.apart;
        if (into.size() == n) continue;
        into.push_back(q[0]);
        out.all.push_back(q[0]);
    }
    return out;
}

/// Where a shape ends along an axis: that point alone, or a face around it, and the shape holds what is behind it.
vec3 end_of(const shape& s, int axis, double sign) {
    if (axis == 2) {
        return {0, 0, sign * (s.of == kind::sphere    ? s.radius
                              : s.of == kind::capsule ? s.half + s.radius
                              : s.of == kind::box     ? s.halves.z
                              : s.of == kind::hull    ? 0.75
                                                      : s.half)};
    }
    if (s.of == kind::cone) return {sign * s.radius, 0, -s.half};
    return {sign * (s.of == kind::box ? s.halves.x : s.of == kind::hull ? 1.25 : s.radius), 0, 0};
}

/// Shapes as they are in their frames, b moved until its end meets that of a, a unit in the last place more or less, or just so.
/// `touch` of the list is what is right.
std::pair<std::vector<pose_pair>, std::vector<bool>> ties_of(const shape& a, const shape& b) {
    std::pair<std::vector<pose_pair>, std::vector<bool>> out;
    for (int i = 0; i < 300; ++i) {
        const int axis = i % 2 == 0 ? 0 : 2, steps = i / 2 % 3 - 1;
        const double sign = i / 6 % 2 == 0 ? 1 : -1;
        vec3 to = end_of(a, axis, sign) - end_of(b, axis, -sign);
        double& along = axis == 0 ? to.x : to.z;
        for (int k = 0; k < std::abs(steps); ++k) along = std::nextafter(along, steps < 0 ? 0 : 8 * along);
        pose_pair p;
        p.b.translation = to;
        out.first.push_back(p);
        out.second.push_back(steps <= 0);
    }
    return out;
}

double median(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const std::string only = bench::take_argument(argc, argv, "--only");
        const int runs = std::stoi(bench::take_argument(argc, argv, "--runs", "15"));
        const std::size_t n = std::stoul(bench::take_argument(argc, argv, "--poses", "1000"));
        if (argc > 1) throw std::runtime_error(std::string("no such argument: ") + argv[1]);

        const shape sphere{"sphere", kind::sphere, 0.875}, capsule{"capsule", kind::capsule, 0.5, 0.75};
        const shape box{"box", kind::box, 0, 0, {1, 0.75, 0.5}}, cylinder{"cylinder", kind::cylinder, 0.625, 0.75};
        const shape cone{"cone", kind::cone, 0.75, 0.875};
        const shape hull18 = ellipsoid(1), hull66 = ellipsoid(2), hull258 = ellipsoid(3), hull1026 = ellipsoid(4);
        const shape edges258 = with_edges(hull258), edges1026 = with_edges(hull1026);
        const std::vector<std::pair<const shape*, const shape*>> pairs{
            {&sphere, &sphere},    {&capsule, &sphere},  {&capsule, &capsule},   {&box, &sphere},     {&box, &capsule},
            {&box, &box},          {&box, &cylinder},    {&box, &cone},          {&cylinder, &sphere}, {&cylinder, &capsule},
            {&cylinder, &cylinder}, {&cone, &sphere},     {&cone, &capsule},      {&cone, &cylinder},  {&cone, &cone},
            {&hull66, &sphere},    {&hull66, &capsule},  {&hull66, &box},        {&hull66, &cylinder}, {&hull18, &hull18},
            {&hull66, &hull66},    {&hull258, &hull258}, {&edges258, &edges258}, {&hull1026, &hull1026}, {&edges1026, &edges1026},
            {&edges1026, &sphere}, {&edges1026, &box}};

        std::vector<library> all{{"abut", "", abut_answers<abut::filtered>}};
        all.insert(all.end(), libraries().begin(), libraries().end());
        bench::results out("bench_peers");
        for (std::size_t k = 1; k < all.size(); ++k) out.describe(all[k].name, all[k].version);

        /// Of each library; answers are those of the last run.
        std::vector<std::vector<answer>> answers(all.size());
        const auto timed = [&](const shape& a, const shape& b, question asked, const std::vector<pose_pair>& poses) {
            std::vector<ask> ask_of;
            std::vector<std::vector<double>> times(all.size());
            for (std::size_t k = 0; k < all.size(); ++k) {
                ask_of.push_back(all[k].make(a, b, asked));
                answers[k].assign(poses.size(), {});
                ask_of[k](poses, answers[k]);
            }
            for (int run = 0; run < runs; ++run) {
                for (std::size_t k = 0; k < all.size(); ++k) {
                    const double start = bench::processor_time();
                    ask_of[k](poses, answers[k]);
                    times[k].push_back((bench::processor_time() - start) / static_cast<double>(poses.size()));
                }
            }
            std::vector<double> ns;
            for (auto& t : times) ns.push_back(median(t));
            return ns;
        };
        const auto add = [&](const std::string& row, std::size_t of, const std::vector<double>& ns, const std::vector<verdict>& v) {
            for (std::size_t k = 0; k < all.size(); ++k) {
                out.add(row + "/" + all[k].name, {{"ns", ns[k]},
                                                  {"over", ns[0] / ns[k]},
                                                  {"wrong", static_cast<double>(v[k].wrong)},
                                                  {"of", static_cast<double>(of)},
                                                  {"worst", v[k].worst}});
            }
        };
        for (const auto& [first, second] : pairs) {
            const shape &a = *first, &b = *second;
            const std::string pair = a.name + "_" + b.name;
            if (("/" + pair + "/").find(only) == std::string::npos) continue;
            const posed poses = poses_of(a, b, n);
            const auto wrong_booleans = [&](const std::vector<bool>& right) {
                std::vector<verdict> v(all.size());
                for (std::size_t k = 0; k < all.size(); ++k) {
                    for (std::size_t i = 0; i < right.size(); ++i) v[k].wrong += answers[k][i].touch != right[i];
                }
                return v;
            };

            std::vector<double> ns = timed(a, b, question::boolean, poses.all);
            std::vector<answer> exact(poses.all.size());
            abut_answers<abut::exact>(a, b, question::boolean)(poses.all, exact);
            std::vector<bool> right;
            for (const answer& x : exact) right.push_back(x.touch);
            add("boolean/" + pair, right.size(), ns, wrong_booleans(right));

            ns = timed(a, b, question::distance, poses.apart);
            add("distance/" + pair, n, ns, judged_distances(a, b, poses.apart, answers));
            ns = timed(a, b, question::contact, poses.touching);
            add("contact/" + pair, n, ns, judged_contacts(a, b, poses.touching, answers));

            const auto [tied, truth] = ties_of(a, b);
            ns = timed(a, b, question::boolean, tied);
            add("ties/" + pair, truth.size(), ns, wrong_booleans(truth));
        }
        for (const bool mesh : {false, true}) {
            const std::string scene = mesh ? "mesh" : "room";
            if (("states/" + scene).find(only) == std::string::npos) continue;
            draws d;
            const arm_scene arm = make_arm(d, 10 * n, mesh);
            std::vector<arm_checker> checkers{{"abut", abut_arm<abut::filtered>}};
            checkers.insert(checkers.end(), arm_checkers().begin(), arm_checkers().end());
            collisions right, found;
            abut_arm<abut::exact>(arm)(right);
            double ours = 0;
            for (const auto& [name, make] : checkers) {
                const auto check = make(arm);
                std::vector<double> times;
                for (int run = 0; run < std::min(runs, 5); ++run) {
                    const double start = bench::processor_time();
                    check(found);
                    times.push_back((bench::processor_time() - start) / static_cast<double>(right.size()));
                }
                const double ns = median(times);
                if (name == "abut") ours = ns;
                double wrong = 0, collide = 0;
                for (std::size_t i = 0; i < right.size(); ++i) wrong += found[i] != right[i], collide += right[i];
                out.add("states/" + scene + "/" + name, {{"ns", ns}, {"over", ours / ns}, {"wrong", wrong},
                                                         {"of", static_cast<double>(right.size())}, {"collide", collide}});
            }
        }
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_peers: %s\n", e.what());
        return 1;
    }
}
