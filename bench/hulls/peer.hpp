// SPDX-License-Identifier: MIT
#pragma once

// What bench/hulls.cpp and its peer share: bodies, the poses of one of two, and the form of a row.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/shape/rigid.hpp>
#include <abut/shape/view.hpp>

namespace hulls_peer {

/// A convex body of about the size 1, with the faces that the peer asks for.
struct body {
    const char* name;
    std::vector<abut::vec3<double>> points;
    std::vector<abut::face> faces;
};

inline body box() {
    body b{"box",
           {},
           {{0, 2, 1},
            {1, 2, 3},
            {4, 5, 6},
            {5, 7, 6},
            {0, 1, 4},
            {1, 5, 4},
            {2, 6, 3},
            {3, 6, 7},
            {0, 4, 2},
            {2, 4, 6},
            {1, 3, 5},
            {3, 7, 5}}};
    for (int i = 0; i < 8; ++i) b.points.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    return b;
}

/// An ellipsoid, by an octahedron whose faces are divided: 6, 18, 66, 258 points.
inline body ellipsoid(const char* name, int divisions) {
    body b{name,
           {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
           {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int i = 0; i < divisions; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t p, std::uint32_t q) {
            const auto [at, fresh] = middles.try_emplace({p < q ? p : q, p < q ? q : p}, b.points.size());
            if (fresh) {
                const abut::vec3<double> m = b.points[p] + b.points[q];
                b.points.push_back((1 / std::sqrt(dot(m, m))) * m);
            }
            return at->second;
        };
        std::vector<abut::face> finer;
        for (const auto& [p, q, r] : b.faces) {
            const std::uint32_t pq = middle(p, q), qr = middle(q, r), rp = middle(r, p);
            finer.insert(finer.end(), {{p, pq, rp}, {pq, q, qr}, {rp, qr, r}, {pq, qr, rp}});
        }
        b.faces = finer;
    }
    for (abut::vec3<double>& p : b.points) p = {1.25 * p.x, p.y, 0.75 * p.z};
    return b;
}

inline const std::vector<body>& bodies() {
    static const std::vector<body> all{box(), ellipsoid("18_points", 1), ellipsoid("66_points", 2),
                                       ellipsoid("258_points", 3)};
    return all;
}

/// Where the second body is: turned at random and about as far off as the two are large, or along the axes so that two boxes
/// touch in a face, an edge or a corner.
inline std::vector<abut::rigid<double>> poses(bool touching) {
    std::uint64_t state = 12;
    const auto random = [&state](double low, double high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
    };
    std::vector<abut::rigid<double>> all;
    for (int i = 0; i < 1000; ++i) {
        abut::rigid<double> pose;
        if (touching) {
            const auto step = [&random] { return std::floor(random(-2, 3)); };
            const double x = step(), y = step();
            pose.translation = i % 3 == 0   ? abut::vec3<double>{2, x, y}
                               : i % 3 == 1 ? abut::vec3<double>{x, 2, y}
                                            : abut::vec3<double>{x, y, 2};
        } else {
            const double a = random(0, 6.28), b = random(0, 6.28), r = random(1.2, 2.8), h = random(-1, 1),
                         c = random(0, 6.28);
            const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b), w = std::sqrt(1 - h * h);
            pose = {{ca, -sa * cb, sa * sb, sa, ca * cb, -ca * sb, 0, sb, cb},
                    {r * w * std::cos(c), r * w * std::sin(c), r * h}};
        }
        all.push_back(pose);
    }
    return all;
}

/// Adds rows NAME/BODY, of 1,000 poses each; decide(pose) says what is added up as `hits`.
template <class Make>
void add(const std::string& name, const Make& make) {
    for (const body& b : bodies()) {
        for (const bool touching : {false, true}) {
            if (touching && std::string(b.name) != "box") continue;
            const std::string row = name + "/" + b.name + (touching ? "_touching" : "");
            benchmark::RegisterBenchmark(row.c_str(),
                                         [decide = make(b), all = poses(touching)](benchmark::State& state) {
                                             std::size_t hits = 0;
                                             for (auto _ : state) {
                                                 hits = 0;
                                                 for (const auto& pose : all) hits += decide(pose);
                                             }
                                             state.SetItemsProcessed(static_cast<std::int64_t>(all.size()) *
                                                                     static_cast<std::int64_t>(state.iterations()));
                                             state.counters["hits"] = static_cast<double>(hits);
                                         })
                ->Repetitions(5)
                ->ReportAggregatesOnly(true)
                ->Unit(benchmark::kMicrosecond);
        }
    }
}

}  // namespace hulls_peer
