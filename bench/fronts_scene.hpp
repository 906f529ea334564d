// SPDX-License-Identifier: MIT
#pragma once

// What bench/fronts.cpp and bench/fronts.cu share: meshes that move from frame to frame, and queries with and without a
// front on each frame.
//
// A frame's trees are refitted before the clock starts. Then the query runs without a front and with one, in turns which
// goes first, so that both find the caches alike. Rows hold medians over the frames and the front as the last frame left it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/front.hpp>
#include <abut/experimental/impact_fronts.hpp>

#include "../tests/support/scenes.hpp"
#include "mesh_file.hpp"
#include "results.hpp"

namespace fronts_scene {

using abut::vec3;

struct surface {
    std::vector<vec3<float>> vertices;
    std::vector<abut::face> faces;
};

/// Where the vertices are at a time, and how much a frame adds to it.
struct motion {
    std::vector<abut::face> faces;
    std::function<std::vector<vec3<float>>(double)> at;
};

/// A sheet of 100,352 triangles, rolled up three times, with a wave that runs along it and lets neighbouring turns pass
/// through each other. Time is how far the fastest vertex has moved, in mean edges.
inline motion rolled_sheet() {
    constexpr std::uint32_t n = 224;
    motion m;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            m.faces.push_back({a, b, b + 1});
            m.faces.push_back({a, b + 1, a + 1});
        }
    }
    m.at = [](double time) {
        constexpr double amplitude = 0.011, edge = 0.0063;
        const double phase = time * edge / amplitude;
        std::vector<vec3<float>> vertices;
        for (std::uint32_t i = 0; i <= n; ++i) {
            for (std::uint32_t j = 0; j <= n; ++j) {
                const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n, turn = 18.8495559 * u;
                const double r = 0.05 + 0.05 * u + amplitude * std::sin(20 * v + 31 * u + phase);
                vertices.push_back(
                    {static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)), static_cast<float>(v)});
            }
        }
        return vertices;
    };
    return m;
}

/// A step of a simulation, cut into equal parts: there, back, and there again. Time is in whole steps.
inline motion step_of(const std::string& folder) {
    const auto first = bench::read_surface<surface>(folder + "/frame0.ply");
    const auto second = bench::read_surface<surface>(folder + "/frame1.ply");
    return {first.faces, [first, second](double time) {
                const double back = std::fmod(time, 2.0), s = back <= 1 ? back : 2 - back;
                std::vector<vec3<float>> vertices;
                for (std::size_t i = 0; i < first.vertices.size(); ++i) {
                    const auto &p = first.vertices[i], &q = second.vertices[i];
                    const auto mix = [s](double x, double y) { return static_cast<float>((1 - s) * x + s * y); };
                    vertices.push_back(
                        {mix(double{p.x}, double{q.x}), mix(double{p.y}, double{q.y}), mix(double{p.z}, double{q.z})});
                }
                return vertices;
            }};
}

/// Refuses every pair, but no compiler knows: what is left is the walk.
struct refuse_all {
    std::uint32_t wanted;
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t) const { return a == wanted; }
};

inline double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Times of one query, without a front and with one.
struct race {
    std::vector<double> without, with;
    std::uint64_t found = 0, opened = 0;

    /// `time(work)` gives milliseconds; plain() and from() return how much they found.
    template <class Time, class Plain, class From>
    void frame(int number, const Time& time, const Plain& plain, const From& from) {
        std::uint64_t a = 0, b = 0;
        const auto one = [&] { without.push_back(time([&] { a = plain(); })); };
        const auto other = [&] { with.push_back(time([&] { b = from(); })); };
        number % 2 == 0 ? one() : other();
        number % 2 == 0 ? other() : one();
        if (a != b) throw abut::error("fronts: " + std::to_string(a) + " without, " + std::to_string(b) + " with");
        found = a;
    }
    /// The row of the query; `items` are of all its fronts.
    [[nodiscard]] bench::counters row(const std::vector<const abut::front*>& fronts) const {
        abut::front_report all;
        for (const abut::front* f : fronts) {
            all.items += f->report().items;
            all.rebuilds += f->report().rebuilds;
        }
        return {{"ms", median(with)},
                {"without_ms", median(without)},
                {"worst_ms", *std::max_element(with.begin() + 1, with.end())},
                {"items", static_cast<double>(all.items)},
                {"opened", static_cast<double>(opened / with.size())},
                {"found", static_cast<double>(found)},
                {"rebuilds", static_cast<double>(all.rebuilds)}};
    }
};

template <class Filter>
using begun_at = abut::query_options<Filter, abut::traversal::from_front>;
template <class Filter>
using self_begun_at = abut::self_options<Filter, abut::traversal::from_front>;

/// One motion, of `frames` frames that are `step` apart: the mesh with itself, with a still copy, and in continuous motion.
template <class Policy, class Time, class Note>
void race_all(const Policy& on, const Time& time, const Note& note, const std::string& name, const motion& moving,
              double step, int frames) {
    using mesh = abut::mesh<float, abut::space_of<Policy>>;
    const auto mesh_at = [&](double t) { return mesh(on, moving.at(t), moving.faces); };
    auto still_vertices = moving.at(0);
    for (auto& p : still_vertices) p = p + vec3<float>{0.01f, 0.007f, 0.003f};
    const auto still = make_bvh(on, mesh(on, still_vertices, moving.faces));
    auto tree = make_bvh(on, mesh_at(0));
    auto index = abut::make_impact_index(on, abut::moving(mesh_at(0), mesh_at(step)));
    abut::front boxes_self, self, boxes_two, two;
    abut::impact_fronts impacts;
    race race_boxes_self, race_self, race_boxes_two, race_two, race_impacts;
    const refuse_all none{0xffffffff};
    for (int frame = 0; frame < frames; ++frame) {
        const double t = frame * step;
        tree = refit(on, tree, mesh_at(t));
        index = refit(on, index, abut::moving(mesh_at(t), mesh_at(t + step)));
        const auto opened = [](race& r, const abut::front& f) { r.opened += f.report().opened; };
        race_boxes_self.frame(
            frame, time, [&] { return count_self_pairs(on, tree, abut::self_options<refuse_all>{.filter = none}); },
            [&] { return count_self_pairs(on, tree, self_begun_at<refuse_all>{.filter = none, .front = &boxes_self}); });
        opened(race_boxes_self, boxes_self);
        race_self.frame(
            frame, time, [&] { return self_pairs(on, tree).size(); },
            [&] { return self_pairs(on, tree, self_begun_at<abut::keep_all>{.front = &self}).size(); });
        opened(race_self, self);
        race_boxes_two.frame(
            frame, time, [&] { return count(on, tree, still, abut::query_options<refuse_all>{.filter = none}); },
            [&] { return count(on, tree, still, begun_at<refuse_all>{.filter = none, .front = &boxes_two}); });
        opened(race_boxes_two, boxes_two);
        race_two.frame(
            frame, time, [&] { return pairs(on, tree, still).size(); },
            [&] { return pairs(on, tree, still, begun_at<abut::keep_all>{.front = &two}).size(); });
        opened(race_two, two);
        race_impacts.frame(
            frame, time, [&] { return self_impacts(on, index).size(); },
            [&] { return self_impacts(on, index, {}, impacts).size(); });
        opened(race_impacts, impacts.edge_edge);
        opened(race_impacts, impacts.vertex_face);
    }
    note(name + "/self/boxes", race_boxes_self.row({&boxes_self}));
    note(name + "/self/pairs", race_self.row({&self}));
    note(name + "/two/boxes", race_boxes_two.row({&boxes_two}));
    note(name + "/two/pairs", race_two.row({&two}));
    note(name + "/self_impacts", race_impacts.row({&impacts.vertex_face, &impacts.edge_edge}));
}

/// The generated sheet, then the simulations in `folders`.
template <class Policy, class Time, class Note>
void race_scenes(const Policy& on, const Time& time, const Note& note, const std::vector<std::string>& folders, int frames) {
    const motion sheet = rolled_sheet();
    for (const double step : {0.01, 0.1, 1.0}) {
        char text[32];
        std::snprintf(text, sizeof(text), "sheet/%g", step);
        race_all(on, time, note, text, sheet, step, frames);
    }
    for (const std::string& folder : folders) {
        const motion simulated = step_of(folder);
        const std::size_t slash = folder.find_last_of('/');
        const std::string name = slash == std::string::npos ? folder : folder.substr(slash + 1);
        for (const int parts : {100, 10, 2}) {
            race_all(on, time, note, name + "/" + std::to_string(parts), simulated, 1.0 / parts, frames);
        }
    }
}

}  // namespace fronts_scene
