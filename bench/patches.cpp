// SPDX-License-Identifier: MIT
//
// usage: bench_patches MESH... [--json=OUT.json] [--frames=N]
//
// How much the answer to "where do two solids meet" jumps when one of them moves by a thousandth of its size a frame, over
// N frames (1,000). Rows SCENE/METHOD, of scenes
//
//   box    a box that slides on a plate of 32 x 32 squares, a hundredth of its side deep, and rocks by two degrees
//   ball   a ball of 32 x 64 faces twice that rolls over such a plate, and sinks from one to ten hundredths of its radius
//   MESH   a closed mesh that moves through a copy of itself, turned, and turns on its way
//
// and methods
//
//   patches    contact_patches, that of the largest area
//   contacts   all contacts (discard_sideways): the mean of points, the mean normal, and the largest depth
//   reduced    reduce_contacts of these, 4 at most, and the same of what is left
//   bullet     Bullet's manifolds (bench/patches/bullet.cpp), where it is installed
//
// Counters: normal, center, depth: the largest change between two frames, angles in thousandths and lengths in thousandths of the
// body's size, so that 1 is as much as the body moves; *_99: that which 99 of 100 frames do not pass. found: how many contacts or
// patches there are, at most; ms: the median time of a frame, on one core in float.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "ball.hpp"
#include "patches/peer.hpp"
#include "results.hpp"

namespace {

using vec = abut::vec3<double>;
using faces = std::vector<std::array<std::uint32_t, 3>>;
using vertices = std::vector<abut::vec3<float>>;
using tree = decltype(abut::make_bvh(abut::serial{}, abut::mesh<float>()));

vec wide(const abut::vec3<float>& v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
double length(const vec& v) { return std::sqrt(abut::dot(v, v)); }

using patches_peer::answer;
using patches_peer::scene;

/// A box of n x n squares a side of z, and sides of as many faces as that takes.
abut::mesh<float> slab(const vec& l, const vec& u, int n) {
    vertices v;
    faces f;
    const auto at = [&](int i, int j, int top) { return static_cast<std::uint32_t>((top * (n + 1) + j) * (n + 1) + i); };
    for (const double z : {l.z, u.z}) {
        for (int j = 0; j <= n; ++j) {
            for (int i = 0; i <= n; ++i) {
                v.push_back({static_cast<float>(l.x + (u.x - l.x) * i / n), static_cast<float>(l.y + (u.y - l.y) * j / n), static_cast<float>(z)});
            }
        }
    }
    const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
        f.push_back({p, q, r});
        f.push_back({p, r, s});
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
            quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
        }
        quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
        quad(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
        quad(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
        quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
    }
    return {std::move(v), std::move(f)};
}

/// A turn about y by an angle, and a move.
abut::rigid<float> turned(double angle, const vec& by) {
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    return {{c, 0, s, 0, 1, 0, -s, 0, c}, {static_cast<float>(by.x), static_cast<float>(by.y), static_cast<float>(by.z)}};
}

answer of_patches(const std::vector<abut::contact_patch<float>>& all) {
    answer found;
    found.found = all.size();
    const auto most = std::max_element(all.begin(), all.end(), [](const auto& p, const auto& q) { return p.area < q.area; });
    if (most == all.end()) return found;
    found.is_known = true;
    found.normal = wide(most->normal);
    found.center = wide(most->center);
    found.depth = static_cast<double>(most->depth);
    return found;
}

answer of_contacts(const std::vector<abut::contact<float>>& all) {
    answer found;
    found.found = all.size();
    for (const auto& c : all) {
        found.is_known = true;
        found.normal = found.normal + wide(c.normal);
        found.center = found.center + abut::scale(1.0 / static_cast<double>(all.size()), wide(c.point));
        found.depth = std::max(found.depth, static_cast<double>(c.depth));
    }
    const double l = length(found.normal);
    if (l > 0) found.normal = abut::scale(1 / l, found.normal);
    return found;
}

void run(const scene& s, int frames, bench::results& out) {
    const abut::serial on;
    const tree a = abut::make_bvh(on, s.a), b = abut::make_bvh(on, s.b);
    const auto contacts = [&](const abut::rigid<float>& pose) {
        return abut::contacts(on, abut::posed(a, pose), b, {.discard_sideways = true});
    };
    std::vector<std::pair<std::string, patches_peer::method>> methods{
        {"patches",
         [&](const abut::rigid<float>& pose) {
             return of_patches(abut::contact_patches(on, abut::posed(a, pose), b, {.known_solid = true}));
         }},
        {"contacts", [&](const abut::rigid<float>& pose) { return of_contacts(abut::to_host(contacts(pose))); }},
        {"reduced", [&](const abut::rigid<float>& pose) {
             return of_contacts(abut::to_host(abut::reduce_contacts(on, contacts(pose), {.most = 4})));
         }}};
    for (const auto& [name, make] : patches_peer::peers()) methods.emplace_back(name, make(s));
    for (const auto& [name, method] : methods) {
        std::vector<double> normals, centers, depths, times;
        std::size_t most = 0;
        answer last;
        for (int i = 0; i <= frames; ++i) {
            const auto pose = s.pose(static_cast<double>(i) / frames);
            const double start = bench::processor_time();
            const answer now = method(pose);
            times.push_back((bench::processor_time() - start) / 1e6);
            most = std::max(most, now.found);
            if (last.is_known && now.is_known) {
                const vec across = abut::cross(last.normal, now.normal);
                normals.push_back(1000 * std::atan2(length(across), abut::dot(last.normal, now.normal)));
                centers.push_back(1000 * length(now.center - last.center) / s.size);
                depths.push_back(1000 * std::abs(now.depth - last.depth) / s.size);
            }
            last = now;
        }
        bench::counters row{{"ms", 0}, {"frames", static_cast<double>(normals.size())}, {"found", static_cast<double>(most)}};
        std::sort(times.begin(), times.end());
        row[0].second = times[times.size() / 2];
        const std::pair<const char*, std::vector<double>*> all[] = {{"normal", &normals}, {"center", &centers}, {"depth", &depths}};
        for (const auto& [what, values] : all) {
            if (values->empty()) throw std::runtime_error("nothing meets in " + s.name);
            std::sort(values->begin(), values->end());
            row.emplace_back(what, values->back());
            row.emplace_back(std::string(what) + "_99", (*values)[values->size() * 99 / 100]);
        }
        out.add(bench::joined({s.name, name}), row);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const int frames = std::stoi(bench::take_argument(argc, argv, "--frames", "1000"));
        bench::results out("bench_patches");
        const auto plate = slab({-3, -3, -1}, {3, 3, 0}, 32);
        // Over N frames it moves by N thousandths.
        const double way = frames / 1000.0;
        run({"box", slab({-0.5, -0.5, 0}, {0.5, 0.5, 1}, 8), plate,
             [&](double t) { return turned(0.035 * std::sin(6.28 * t), {way * (t - 0.5), 0.3 * way * t, -0.01}); }, 1},
            frames, out);
        run({"ball", bench::ball(32, 64), plate,
             [&](double t) { return turned(2 * way * t, {2 * way * (t - 0.5), 0.1 * t, 0.99 - 0.09 * t}); }, 2},
            frames, out);
        for (int i = 1; i < argc; ++i) {
            const auto mesh = abut::io::read_mesh<float>(argv[i]);
            const auto box = abut::make_bvh(abut::serial{}, mesh).bounds();
            const double size = static_cast<double>(std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z}));
            const vec middle = abut::scale(0.5, wide(box.lower) + wide(box.upper));
            run({std::filesystem::path(argv[i]).stem().string(), mesh, mesh,
                 [=](double t) {
                     // About the mesh's own middle, from three fifths of its size aside.
                     const double angle = 0.8 + 0.5 * t;
                     const vec at{std::cos(angle) * middle.x + std::sin(angle) * middle.z, middle.y,
                                  -std::sin(angle) * middle.x + std::cos(angle) * middle.z};
                     return turned(angle, middle - at + vec{size * (0.6 - 0.5 * way * t), size * 0.1, 0});
                 },
                 size},
                frames, out);
        }
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_patches: %s\n", e.what());
        return 1;
    }
}
