// SPDX-License-Identifier: MIT
//
// usage: bench_trade_scenes [--json=FILE] [--data=FOLDER] [--frames=N] [--spheres=N]
//
// What a whole scene loses to `fast`: its answers against those of `filtered`, which are right. FOLDER has meshes/ and ccd/;
// what is not there is left out, with a message. On one thread. Names:
//
//   scene/NAME/SCALAR     a query of pairs: filtered_ms, fast_ms; pairs that touch; lost, which fast misses, and invented,
//   which
//                         do not touch. NAME is spheres_mesh (docs/examples/scene.hpp), turned/MESH, a mesh and itself
//                         turned and moved, or onto_itself/MESH.
//   ccd/NAME/SCALAR       a step of a real scene with itself: impacts, lost, invented, and time_error, the most by which the
//                         times of impacts that both find differ, of the step.
//   frames/NAME/SCALAR    contacts of a mesh with one that moves, N frames of it. NAME is turning, a torus that
//                         turns through a copy of it, or sliding, a sheet that slides on its own plane, so that all of it
//                         is within rounding of contact. frames_that_differ and first_that_differs (-1: none); pairs, lost
//                         and invented over all frames, and most_in_a_frame of both. Depths are in thousandths of the mesh's
//                         extent: deepest, deepest_lost, and deepest_invented, what contacts says of pairs that do not
//                         touch. changed are contacts that both find and that differ in a bit. normal_degrees is the most by
//                         which the sum of a frame's normals, weighted by depth, turns.
//   frames/cloth/SCALAR   N steps of a cloth that falls on a ball (docs/examples/falling_cloth.hpp), each asked both ways:
//                         impacts, lost, invented, time_error and frames as above; first_time_differs counts steps whose
//                         earliest impact has another time. A second cloth obeys fast alone: apart_after is the first step
//                         in which the cloths are not the same, apart their largest distance at the end, of the cloth's
//                         side. touch_at_end are the pairs of faces of that cloth and the ball that touch then, of which the
//                         other cloth (filtered_touch_at_end) is to have none.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "../docs/examples/falling_cloth.hpp"
#include "../docs/examples/scene.hpp"
#include "results.hpp"

namespace {

const abut::serial on;

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

/// Processor time of the fastest of five runs, in ms.
template <class Work>
double timed(const Work& work) {
    double best = 1e300;
    for (int i = 0; i < 5; ++i) {
        const std::clock_t start = std::clock();
        work();
        best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return best;
}

/// What is in `a` and not in `b`; both in order.
template <class List, class Less>
List without(const List& a, const List& b, const Less& less) {
    List rest;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest), less);
    return rest;
}

template <class X, class Y>
void pairs_of_scene(bench::results& out, const std::string& name, const X& a, const Y& b) {
    std::vector<abut::index_pair> right, fast;
    const double filtered_ms = timed([&] { right = to_host(abut::pairs<abut::filtered>(on, a, b)); });
    const double fast_ms = timed([&] { fast = to_host(abut::pairs<abut::fast>(on, a, b)); });
    out.add(name, {{"filtered_ms", filtered_ms},
                   {"fast_ms", fast_ms},
                   {"pairs", static_cast<double>(right.size())},
                   {"lost", static_cast<double>(without(right, fast, std::less<>{}).size())},
                   {"invented", static_cast<double>(without(fast, right, std::less<>{}).size())}});
}

template <abut::scalar T>
struct surface {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;

    explicit surface(const abut::mesh<T>& mesh) {
        const auto view = mesh.view();
        for (std::size_t i = 0; i < view.vertices.count; ++i) vertices.push_back(view.vertices[i]);
        for (std::size_t i = 0; i < view.size(); ++i) faces.push_back(view.faces[i]);
    }
    explicit surface(const scene::surface<T>& s) : vertices(s.vertices), faces(s.faces) {}

    [[nodiscard]] abut::mesh<T> as_mesh() const { return {vertices, faces}; }
    [[nodiscard]] abut::aabb<double> box() const {
        abut::aabb<double> b{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
        for (const auto& v : vertices) {
            const abut::vec3<double> p{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
            b.lower = {std::min(b.lower.x, p.x), std::min(b.lower.y, p.y), std::min(b.lower.z, p.z)};
            b.upper = {std::max(b.upper.x, p.x), std::max(b.upper.y, p.y), std::max(b.upper.z, p.z)};
        }
        return b;
    }
    [[nodiscard]] double extent() const {
        const auto b = box();
        return std::max({b.upper.x - b.lower.x, b.upper.y - b.lower.y, b.upper.z - b.lower.z});
    }
    /// Turned around the vertical axis through the middle, and moved by a part of the extent.
    [[nodiscard]] surface turned(double angle, double part) const {
        surface made = *this;
        const auto b = box();
        const double x = 0.5 * (b.lower.x + b.upper.x), z = 0.5 * (b.lower.z + b.upper.z);
        const double c = std::cos(angle), s = std::sin(angle), away = part * extent();
        for (auto& v : made.vertices) {
            const double p = static_cast<double>(v.x) - x, q = static_cast<double>(v.z) - z;
            v = {static_cast<T>(x + c * p - s * q + away), v.y, static_cast<T>(z + s * p + c * q + 0.3 * away)};
        }
        return made;
    }
};

/// A square of 24 x 24 cells in a plane that no axis has, moved within that plane by a part of its side.
template <abut::scalar T>
surface<T> sheet(double part) {
    constexpr int n = 24;
    scene::surface<T> made;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            const double u = static_cast<double>(i) / n + part, v = static_cast<double>(j) / n + 0.3 * part;
            made.vertices.push_back(
                {static_cast<T>(0.8 * u - 0.36 * v), static_cast<T>(0.6 * u + 0.48 * v), static_cast<T>(0.8 * v)});
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const auto at = [&](int k, int l) { return static_cast<std::uint32_t>(k * (n + 1) + l); };
            made.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            made.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return surface<T>(made);
}

// --- features in motion --------------------------------------------------------------------------------------------------

template <abut::scalar T>
using impact_list = std::vector<abut::impact<T>>;

const auto by_features = [](const auto& a, const auto& b) {
    return std::tuple(a.kind, a.vertices) < std::tuple(b.kind, b.vertices);
};

/// How two lists of impacts differ.
struct impact_trade {
    double impacts = 0, lost = 0, invented = 0, time_error = 0;
    bool differs = false, first_time_differs = false;

    impact_trade() = default;
    template <abut::scalar T>
    impact_trade(impact_list<T> right, impact_list<T> fast) {
        const auto first = [](const impact_list<T>& all) {
            double time = 2;
            for (const auto& i : all) time = std::min(time, i.time);
            return time;
        };
        std::sort(right.begin(), right.end(), by_features);
        std::sort(fast.begin(), fast.end(), by_features);
        impacts = static_cast<double>(right.size());
        lost = static_cast<double>(without(right, fast, by_features).size());
        invented = static_cast<double>(without(fast, right, by_features).size());
        for (auto i = right.begin(), j = fast.begin(); i != right.end() && j != fast.end();) {
            if (by_features(*i, *j)) {
                ++i;
            } else if (by_features(*j, *i)) {
                ++j;
            } else {
                time_error = std::max(time_error, std::abs((i++)->time - (j++)->time));
            }
        }
        differs = lost + invented > 0;
        first_time_differs = first(right) != first(fast);
    }
    void add(const impact_trade& x) {
        impacts += x.impacts, lost += x.lost, invented += x.invented;
        time_error = std::max(time_error, x.time_error);
    }
};

template <abut::scalar T>
void ccd_scene(bench::results& out, const std::filesystem::path& folder) {
    const auto step =
        abut::moving(abut::io::read_mesh<T>(folder / "frame0.ply"), abut::io::read_mesh<T>(folder / "frame1.ply"));
    const auto index = abut::make_impact_index(on, step);
    impact_list<T> right, fast;
    const double filtered_ms = timed([&] { right = to_host(abut::self_impacts<abut::filtered>(on, index)); });
    const double fast_ms = timed([&] { fast = to_host(abut::self_impacts<abut::fast>(on, index)); });
    const impact_trade trade(right, fast);
    out.add(bench::joined({"ccd", folder.filename().string(), scalar_name<T>}), {{"filtered_ms", filtered_ms},
                                                                                 {"fast_ms", fast_ms},
                                                                                 {"impacts", trade.impacts},
                                                                                 {"lost", trade.lost},
                                                                                 {"invented", trade.invented},
                                                                                 {"time_error", trade.time_error}});
}

// --- frames --------------------------------------------------------------------------------------------------------------

/// What of a number of frames differs.
struct frame_counter {
    double differ = 0, first = -1, most = 0;

    void add(int frame, double lost, double invented) {
        if (lost + invented == 0) return;
        if (differ++ == 0) first = frame;
        most = std::max(most, lost + invented);
    }
};

/// `place(frame)` is where a second mesh is, whose contacts with `mesh` are asked for.
template <abut::scalar T, class Place>
void moving_mesh(bench::results& out, const char* name, const surface<T>& mesh, int frames, const Place& place) {
    using contact_list = std::vector<abut::contact<T>>;
    const auto by_ids = [](const auto& a, const auto& b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); };
    const auto deepest_of = [](const contact_list& all) {
        double depth = 0;
        for (const auto& c : all) depth = std::max(depth, static_cast<double>(c.depth));
        return depth;
    };
    const auto push = [](const contact_list& all) {
        abut::vec3<double> sum{0, 0, 0};
        for (const auto& c : all) {
            sum = sum + static_cast<double>(c.depth) * abut::vec3<double>{static_cast<double>(c.normal.x),
                                                                          static_cast<double>(c.normal.y),
                                                                          static_cast<double>(c.normal.z)};
        }
        return sum;
    };
    const auto at_rest = abut::make_bvh(on, mesh.as_mesh());
    const double per_mille = 1e3 / mesh.extent();
    frame_counter differing;
    double pairs = 0, lost = 0, invented = 0, changed = 0, deepest = 0, deepest_lost = 0, deepest_invented = 0, degrees = 0;
    for (int frame = 0; frame < frames; ++frame) {
        const auto other = abut::make_bvh(on, place(frame).as_mesh());
        contact_list right = to_host(abut::contacts<abut::filtered>(on, other, at_rest)),
                     fast = to_host(abut::contacts<abut::fast>(on, other, at_rest));
        std::sort(right.begin(), right.end(), by_ids);
        std::sort(fast.begin(), fast.end(), by_ids);
        const contact_list missed = without(right, fast, by_ids), phantom = without(fast, right, by_ids);
        differing.add(frame, static_cast<double>(missed.size()), static_cast<double>(phantom.size()));
        pairs += static_cast<double>(right.size());
        lost += static_cast<double>(missed.size());
        invented += static_cast<double>(phantom.size());
        deepest = std::max(deepest, deepest_of(right));
        deepest_lost = std::max(deepest_lost, deepest_of(missed));
        deepest_invented = std::max(deepest_invented, deepest_of(phantom));
        for (const auto& c : fast) {
            const auto same = std::lower_bound(right.begin(), right.end(), c, by_ids);
            changed += same != right.end() && !by_ids(c, *same) && !(c == *same) ? 1 : 0;
        }
        const auto p = push(right), q = push(fast);
        const auto across = cross(p, q);
        degrees = std::max(degrees, std::atan2(std::sqrt(dot(across, across)), dot(p, q)) * 360 / 6.283185307179586);
    }
    out.add(bench::joined({"frames", name, scalar_name<T>}), {{"frames", static_cast<double>(frames)},
                                                              {"faces", static_cast<double>(mesh.faces.size())},
                                                              {"frames_that_differ", differing.differ},
                                                              {"first_that_differs", differing.first},
                                                              {"pairs", pairs},
                                                              {"lost", lost},
                                                              {"invented", invented},
                                                              {"most_in_a_frame", differing.most},
                                                              {"deepest", per_mille * deepest},
                                                              {"deepest_lost", per_mille * deepest_lost},
                                                              {"deepest_invented", per_mille * deepest_invented},
                                                              {"changed", changed},
                                                              {"normal_degrees", degrees}});
}

/// The features of the cloth in an impact with itself or, first, with the ball.
std::array<std::span<const std::uint32_t>, 2> features_of(abut::feature_pair kind, std::span<const std::uint32_t> all) {
    if (kind == abut::feature_pair::vertex_face) return {all.first(1), all.last(3)};
    if (kind == abut::feature_pair::face_vertex) return {all.last(3), all.first(1)};
    return {all.first(2), all.last(2)};
}

/// A cloth, and what it meets on the way that it wants to go.
template <abut::scalar T>
struct cloth_on_ball {
    cloth_ccd::falling_cloth<T> cloth{48};
    abut::mesh<T> ball;

    struct found {
        impact_list<T> itself, ball;
    };

    cloth_on_ball() {
        const auto sphere = cloth_ccd::ball<T>();
        ball = abut::mesh<T>(sphere.vertices, sphere.faces);
    }
    [[nodiscard]] abut::mesh<T> now() const { return {cloth.positions(), cloth.faces()}; }

    template <class A>
    [[nodiscard]] found look(const std::vector<double>& part) const {
        const abut::mesh<T> start = now();
        const auto index = abut::make_impact_index(on, abut::moving(start, start.with_vertices(on, cloth.proposed(part))));
        return {to_host(abut::self_impacts<A>(on, index)), to_host(abut::impacts<A>(on, index, ball))};
    }
    /// A step as A sees it: what is hit stops shortly before, until nothing is hit.
    template <class A>
    void step() {
        std::vector<double> part(cloth.positions().size(), 1);
        for (int query = 0; query < 40; ++query) {
            const found hits = look<A>(part);
            std::vector<double> next = part;
            const auto hold = [&](std::span<const std::uint32_t> feature, double time) {
                for (const auto v : feature) next[v] = std::min(next[v], query == 0 ? 0.9 * time : 0.0);
            };
            for (const auto& i : hits.itself) {
                for (const auto& feature : features_of(i.kind, i.vertices)) hold(feature, i.time);
            }
            for (const auto& i : hits.ball) hold(features_of(i.kind, i.vertices)[0], i.time);
            if (next == part) break;
            part = next;
        }
        cloth.go(part);
    }
};

template <abut::scalar T>
void falling(bench::results& out, int frames) {
    cloth_on_ball<T> right, fast;
    impact_trade all;
    frame_counter differing;
    double first_times = 0, apart_after = -1, apart = 0;
    for (int frame = 0; frame < frames; ++frame) {
        right.cloth.propose();
        fast.cloth.propose();
        const std::vector<double> whole(right.cloth.positions().size(), 1);
        const auto a = right.template look<abut::filtered>(whole), b = right.template look<abut::fast>(whole);
        const impact_trade itself(a.itself, b.itself), ball(a.ball, b.ball);
        all.add(itself);
        all.add(ball);
        differing.add(frame, itself.lost + ball.lost, itself.invented + ball.invented);
        first_times += itself.first_time_differs || ball.first_time_differs ? 1 : 0;
        right.template step<abut::filtered>();
        fast.template step<abut::fast>();
        if (apart_after < 0 && right.cloth.positions() != fast.cloth.positions()) apart_after = frame;
    }
    for (std::size_t v = 0; v < right.cloth.positions().size(); ++v) {
        const auto way = right.cloth.positions()[v] - fast.cloth.positions()[v];
        apart = std::max(apart, std::sqrt(static_cast<double>(dot(way, way))) / cloth_ccd::cloth_side);
    }
    out.add(bench::joined({"frames", "cloth", scalar_name<T>}),
            {{"frames", static_cast<double>(frames)},
             {"frames_that_differ", differing.differ},
             {"first_that_differs", differing.first},
             {"impacts", all.impacts},
             {"lost", all.lost},
             {"invented", all.invented},
             {"most_in_a_frame", differing.most},
             {"time_error", all.time_error},
             {"first_time_differs", first_times},
             {"apart_after", apart_after},
             {"apart", apart},
             {"touch_at_end", static_cast<double>(abut::count(on, fast.now(), fast.ball))},
             {"filtered_touch_at_end", static_cast<double>(abut::count(on, right.now(), right.ball))}});
}

// --- all of it -----------------------------------------------------------------------------------------------------------

struct arguments {
    std::filesystem::path data;
    int frames;
    std::size_t spheres;
};

template <abut::scalar T>
void measure(bench::results& out, const arguments& of) {
    const std::string scalar = scalar_name<T>;
    const surface<T> torus(scene::torus<T>());
    pairs_of_scene(out, bench::joined({"scene", "spheres_mesh", scalar}), abut::make_bvh(on, torus.as_mesh()),
                   abut::equal_spheres<T>(scene::centers<T>(of.spheres), static_cast<T>(scene::radius)));
    const auto meshes = [&](const std::string& name, const surface<T>& s) {
        const auto a = abut::make_bvh(on, s.as_mesh());
        pairs_of_scene(out, bench::joined({"scene", "turned", name, scalar}), a,
                       abut::make_bvh(on, s.turned(0.5, 0.05).as_mesh()));
        pairs_of_scene(out, bench::joined({"scene", "onto_itself", name, scalar}), a, a);
    };
    meshes("torus", torus);
    for (const char* name : {"armadillo_27674", "armadillo_345944", "stanford-bunny", "fandisk", "ogre"}) {
        const auto path = of.data / "meshes" / (std::string(name) + ".ply");
        if (!of.data.empty() && std::filesystem::exists(path)) {
            meshes(name, surface<T>(abut::io::read_mesh<T>(path)));
        } else {
            std::printf("skipped: %s is not there\n", path.c_str());
        }
    }
    for (const char* name : {"cloth-ball", "cloth-funnel", "armadillo-rollers", "n-body-simulation", "rod-twist"}) {
        const auto folder = of.data / "ccd" / name;
        if (!of.data.empty() && std::filesystem::exists(folder / "frame0.ply")) {
            ccd_scene<T>(out, folder);
        } else {
            std::printf("skipped: %s is not there\n", folder.c_str());
        }
    }
    const surface<T> ring(scene::torus<T>(64, 48));
    moving_mesh(out, "turning", ring, of.frames,
                [&](int frame) { return ring.turned(6.283185307179586 * frame / of.frames, 0.1); });
    moving_mesh(out, "sliding", sheet<T>(0), of.frames, [&](int frame) { return sheet<T>(1.5 * frame / of.frames); });
    falling<T>(out, of.frames);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const arguments of{bench::take_argument(argc, argv, "--data"),
                           std::stoi(bench::take_argument(argc, argv, "--frames", "1000")),
                           std::stoul(bench::take_argument(argc, argv, "--spheres", std::to_string(scene::sphere_count)))};
        if (argc > 1) throw abut::error(std::string(argv[1]) + ": expected --json, --data, --frames or --spheres");
        bench::results out("bench_trade_scenes");
        measure<float>(out, of);
        measure<double>(out, of);
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_trade_scenes: %s\n", problem.what());
        return 1;
    }
}
