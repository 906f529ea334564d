// SPDX-License-Identifier: MIT
//
// usage: bench_winding MESHES [--json=OUT.json] [--runs=N] [--points=N]
//
// Winding numbers of points in a mesh's box, on one core in float: of all meshes of a folder that are named below, of a ball in
// a box, and of a ball on a floor of two large triangles. A row, MESH/LIBRARY/ACCURACY, is a tolerance of abut's or an accuracy
// of a peer's (bench/winding/, out of ABUT_PEERS). us is processor time, of all threads, for one of N points (5,000), all asked in one call, the
// least of N runs (7) in which the rows take turns; worst and rms are how far the answers to the first 300 are from the sum over all
// triangles; alone is us for a call of one point; make is ms for what is made once. like is us of abut's at the same rms as the
// peer's row, by a power law between abut's two rows around it, over us of the peer.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <time.h>

#include <abut/abut.hpp>

#include "mesh_file.hpp"
#include "results.hpp"
#include "winding/peer.hpp"

namespace {

using winding_peer::ask;
using winding_peer::surface;
using point = abut::vec3<float>;

double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// A ball of radius 1 around the origin, by rings.
void add_ball(surface& s, std::uint32_t rings) {
    const auto first = static_cast<std::uint32_t>(s.vertices.size());
    const double pi = 3.141592653589793;
    for (std::uint32_t i = 0; i <= rings; ++i) {
        for (std::uint32_t k = 0; k < 2 * rings; ++k) {
            const double polar = pi * i / rings, around = pi * k / rings, rho = i == 0 || i == rings ? 0 : std::sin(polar);
            s.vertices.push_back({static_cast<float>(rho * std::cos(around)), static_cast<float>(rho * std::sin(around)),
                                  static_cast<float>(std::cos(polar))});
        }
    }
    for (std::uint32_t i = 0; i < rings; ++i) {
        for (std::uint32_t k = 0; k < 2 * rings; ++k) {
            const std::uint32_t a = first + 2 * rings * i + k, b = first + 2 * rings * i + (k + 1) % (2 * rings),
                                c = a + 2 * rings, d = b + 2 * rings;
            if (i > 0) s.faces.push_back({a, c, b});
            if (i + 1 < rings) s.faces.push_back({b, c, d});
        }
    }
}
/// A cube around it whose sides are of n x n squares, facing outward.
void add_cube(surface& s, std::uint32_t n, float half) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
            const auto first = static_cast<std::uint32_t>(s.vertices.size());
            for (std::uint32_t i = 0; i <= n; ++i) {
                for (std::uint32_t k = 0; k <= n; ++k) {
                    const auto at = [&](std::uint32_t j) { return half * (2 * static_cast<float>(j) / static_cast<float>(n) - 1); };
                    const float x[3] = {static_cast<float>(side) * half, at(i), at(k)};
                    const auto of = [&](int coordinate) { return x[(coordinate - axis + 3) % 3]; };
                    s.vertices.push_back({of(0), of(1), of(2)});
                }
            }
            for (std::uint32_t i = 0; i < n; ++i) {
                for (std::uint32_t k = 0; k < n; ++k) {
                    const std::uint32_t a = first + (n + 1) * i + k, b = a + n + 1, c = a + 1, d = b + 1;
                    s.faces.push_back(side > 0 ? abut::face{a, b, c} : abut::face{a, c, b});
                    s.faces.push_back(side > 0 ? abut::face{b, d, c} : abut::face{b, c, d});
                }
            }
        }
    }
}

struct row {
    std::string library;
    double accuracy;
    ask answer;
    double make;
    double us = 1e300, alone = 1e300, worst = 0, rms = 0;
    std::vector<double> out{};
};

void measure(const surface& s, bench::results& results, std::size_t count, int runs, const point& lower, const point& upper) {
    std::vector<point> points;
    std::uint64_t state = 7;
    const auto between = [&](float low, float high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<float>(state >> 40) * 0x1p-24f;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const float x = between(lower.x, upper.x), y = between(lower.y, upper.y), z = between(lower.z, upper.z);
        points.push_back({x, y, z});
    }
    const std::vector<point> few(points.begin(), points.begin() + std::min<std::ptrdiff_t>(300, static_cast<std::ptrdiff_t>(count)));
    const abut::serial on;
    const abut::mesh<float> mesh(s.vertices, s.faces);
    const auto truth = abut::winding_number(on, mesh, few).to_host();

    std::vector<row> rows;
    {
        const double start = processor_time();
        const auto tree = abut::wide(on, abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah}));
        const auto index = abut::make_winding_index(on, tree);
        const double made = processor_time() - start;
        for (const double tolerance : {1e-3, 100.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 1e-2, 3e-3, 3e-4}) {
            rows.push_back({"abut", tolerance, [index](const auto& from, double accuracy, std::vector<double>& out) {
                                const auto found = abut::winding_number(abut::serial{}, index, from, {.tolerance = accuracy});
                                std::copy(found.begin(), found.end(), out.begin());
                            },
                            made});
        }
    }
    for (const auto& peer : winding_peer::libraries()) {
        const double start = processor_time();
        const ask answer = peer.make(s);
        const double made = processor_time() - start;
        for (const double accuracy : peer.accuracies) {
            rows.push_back({peer.name, accuracy, answer, made});
        }
    }
    const std::vector<point> one(1, points[0]);
    std::vector<double> of_one(1);
    for (int run = 0; run < runs; ++run) {
        for (row& r : rows) {
            r.out.resize(count);
            double start = processor_time();
            r.answer(points, r.accuracy, r.out);
            r.us = std::min(r.us, (processor_time() - start) / static_cast<double>(count));
            start = processor_time();
            r.answer(one, r.accuracy, of_one);
            r.alone = std::min(r.alone, processor_time() - start);
        }
    }
    for (row& r : rows) {
        double squares = 0;
        for (std::size_t i = 0; i < few.size(); ++i) {
            const double off = std::abs(r.out[i] - truth[i]);
            r.worst = std::max(r.worst, off);
            squares += off * off;
        }
        r.rms = std::sqrt(squares / static_cast<double>(few.size()));
    }
    // abut's time at another error, between two of its rows; beyond them that of the last.
    std::vector<row> ours;
    for (const row& r : rows) {
        if (r.library == "abut") ours.push_back(r);
    }
    std::sort(ours.begin(), ours.end(), [](const row& a, const row& b) { return a.rms < b.rms; });
    const auto time_at = [&](double rms) {
        std::size_t k = 0;
        while (k + 1 < ours.size() && ours[k + 1].rms < rms) ++k;
        if (rms <= ours[0].rms) return ours[0].us;
        if (k + 1 == ours.size()) return ours[k].us;
        const double t = std::log(rms / ours[k].rms) / std::log(ours[k + 1].rms / ours[k].rms);
        return ours[k].us * std::pow(ours[k + 1].us / ours[k].us, t);
    };
    for (const row& r : rows) {
        char accuracy[32];
        std::snprintf(accuracy, sizeof accuracy, "%g", r.accuracy);
        bench::counters counters{{"us", r.us}, {"worst", r.worst}, {"rms", r.rms}, {"alone", r.alone}, {"make", 1e-3 * r.make},
                                 {"faces", static_cast<double>(s.faces.size())}};
        if (r.library != "abut") counters.push_back({"like", time_at(r.rms) / r.us});
        results.add(bench::joined({s.name, r.library, accuracy}), counters);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    std::string folder, json;
    int runs = 7;
    std::size_t count = 5000;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument.rfind("--json=", 0) == 0) {
            json = argument.substr(7);
        } else if (argument.rfind("--runs=", 0) == 0) {
            runs = std::stoi(argument.substr(7));
        } else if (argument.rfind("--points=", 0) == 0) {
            count = static_cast<std::size_t>(std::stoul(argument.substr(9)));
        } else {
            folder = argument;
        }
    }
    if (folder.empty() || runs < 1 || count < 1) {
        std::fprintf(stderr, "usage: bench_winding MESHES [--json=OUT.json] [--runs=N] [--points=N]\n");
        return 2;
    }
    bench::results results("bench_winding");
    for (const auto& peer : winding_peer::libraries()) results.describe(peer.name, peer.version);
    const auto in_box = [&](const surface& s) {
        point lower = s.vertices.at(0), upper = lower;
        for (const point& p : s.vertices) {
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
        measure(s, results, count, runs, lower, upper);
    };
    for (const char* name : {"armadillo_345944", "stanford-bunny", "fandisk"}) {
        const auto path = std::filesystem::path(folder) / (std::string(name) + ".ply");
        if (!std::filesystem::exists(path)) continue;
        surface s = bench::read_surface<surface>(path.string());
        s.name = name;
        in_box(s);
    }
    surface boxed{"boxed_ball", {}, {}};
    add_ball(boxed, 60);
    add_cube(boxed, 40, 2);
    in_box(boxed);
    for (const float half : {0.0f, 4.0f, 1000.0f}) {
        surface floor{half == 0 ? "ball" : "ball_on_floor_" + std::to_string(static_cast<int>(half)), {}, {}};
        add_ball(floor, 155);
        if (half > 0) {
            const auto first = static_cast<std::uint32_t>(floor.vertices.size());
            floor.vertices.insert(floor.vertices.end(), {{-half, -half, -1}, {half, -half, -1}, {half, half, -1}, {-half, half, -1}});
            floor.faces.insert(floor.faces.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
        }
        measure(floor, results, count, runs, {-1, -1, -1}, {1, 1, 1});
    }
    if (!json.empty()) results.write(json);
    return 0;
} catch (const std::exception& failure) {
    std::fprintf(stderr, "bench_winding: %s\n", failure.what());
    return 1;
}
