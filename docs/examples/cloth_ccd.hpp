// SPDX-License-Identifier: MIT
#pragma once

// The whole of the program cloth_ccd but its policies: what of a cloth touches itself, or a ball, on the way from one frame
// to the next, and when. It is written once; cloth_ccd.cpp and cloth_ccd.cu say what runs it. The calls that matter are in
// `detector`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>
#include <abut/io/write.hpp>

#include "falling_cloth.hpp"
#include "program.hpp"
#include "view.hpp"

namespace cloth_ccd {

struct settings : example::common_settings {
    std::string frame_0, frame_1;
    int cloth = 40, steps = 60, rebuild = 0, write_every = 10;
    abut::conservative_bounds bounds;
    std::string out = "cloth_ccd";

    [[nodiscard]] bool has_frames() const { return !frame_0.empty(); }
};

// --- the queries -------------------------------------------------------------------------------------------------------

/// The vertices of the feature of the first mesh, and those of the second's.
template <abut::scalar T>
std::array<std::span<const std::uint32_t>, 2> features_of(const abut::impact<T>& i) {
    const std::span<const std::uint32_t> all(i.vertices);
    if (i.kind == abut::feature_pair::vertex_face) return {all.first(1), all.last(3)};
    if (i.kind == abut::feature_pair::face_vertex) return {all.last(3), all.first(1)};
    return {all.first(2), all.last(2)};
}

/// What touches in one step.
template <abut::scalar T>
struct outcome {
    std::vector<abut::impact<T>> itself, ball;  // of the cloth with itself; of the cloth, the first mesh, with the ball

    /// see(vertices, time) of each feature of the cloth that is hit.
    template <class See>
    void for_each_feature(const See& see) const {
        for (const auto& i : itself) {
            for (const auto& feature : features_of(i)) see(feature, i.time);
        }
        for (const auto& i : ball) see(features_of(i)[0], i.time);
    }
    [[nodiscard]] bool is_empty() const { return itself.empty() && ball.empty(); }
    [[nodiscard]] const abut::impact<T>* first() const {
        const abut::impact<T>* found = nullptr;
        for (const auto* list : {&itself, &ball}) {
            for (const auto& i : *list) found = found == nullptr || i.time < found->time ? &i : found;
        }
        return found;
    }
};

/// The heart of it: a mesh that moves step by step, in the policy's memory, and what it touches on its way. The first step
/// makes an index; the next ones bring it to where the mesh is then, until it has become too bad.
template <abut::motion_arithmetic A, class Policy, abut::scalar T>
class detector {
public:
    detector(const Policy& on, const abut::mesh<T>& mesh, const std::optional<abut::mesh<T>>& ball, const settings& s)
        : on_(on), at_t0_(abut::copy_to(on, mesh)), at_t1_(at_t0_), rebuild_(s.rebuild), options_{.bounds = s.bounds} {
        if (ball) ball_ = abut::make_impact_index(on, *ball);
    }

    /// The step from where the mesh is to `positions`.
    outcome<T> look(const std::vector<abut::vec3<T>>& positions, example::stopwatch& watch) {
        at_t1_ = watch.time("upload", [&] { return at_t0_.with_vertices(on_, positions); });
        const auto step = abut::moving(at_t0_, at_t1_);
        if (index_ && !is_worn_) {
            index_ = watch.time("refit", [&] { return abut::refit(on_, *index_, step); });
        } else {
            index_ = watch.time("build", [&] { return abut::make_impact_index(on_, step); });
            age_ = 0;
            is_worn_ = false;
        }
        const auto itself = watch.time("query", [&] { return abut::self_impacts<A>(on_, *index_, options_); });
        outcome<T> found;
        found.itself = watch.time("download", [&] { return abut::to_host(itself); });
        if (!ball_) return found;
        const auto with_ball = watch.time("query", [&] { return abut::impacts<A>(on_, *index_, *ball_, options_); });
        found.ball = watch.time("download", [&] { return abut::to_host(with_ball); });
        return found;
    }
    /// The step is done: the next one begins where it ended. Every so many steps, or if boxes have grown, it begins with a
    /// new index. Results are right without that too; only slower to get.
    void advance(example::stopwatch& watch) {
        at_t0_ = at_t1_;
        ++age_;
        if (rebuild_ > 0) {
            is_worn_ = age_ >= rebuild_;
            return;
        }
        const auto now = watch.time("quality", [&] { return abut::quality(on_, index_->faces()); });
        if (age_ == 1) when_built_ = now;
        is_worn_ = abut::needs_rebuild(when_built_, now);
    }

private:
    using space = abut::space_of<Policy>;

    Policy on_;
    abut::mesh<T, space> at_t0_, at_t1_;
    std::optional<abut::impact_index<T, space>> index_, ball_;
    abut::bvh_quality when_built_;
    int rebuild_, age_ = 0;
    bool is_worn_ = false;
    abut::impact_options options_;
};

// --- what comes out ----------------------------------------------------------------------------------------------------

inline constexpr std::array stages{"upload", "build", "refit", "query", "download", "quality"};

/// A row for each step, and at last the medians.
class table {
public:
    explicit table(bool with_ball) : with_ball_(with_ball) {
        std::printf("%4s %7s | %18s |", "", "", "with itself");
        if (with_ball) std::printf(" %24s |", "with the ball");
        std::printf(" %11s | ms%s\n%4s %7s | %8s %9s |", "earliest", with_ball ? ", of all queries of the step" : "",
                    with_ball ? "step" : "run", "queries", "v-f", "e-e");
        if (with_ball) std::printf(" %8s %6s %8s |", "v-f", "f-v", "e-e");
        std::printf(" %11s |", "time");
        for (std::size_t k = 0; k < shown; ++k) std::printf(" %8s", stages[k]);
        std::printf("\n");
    }
    /// Its answers are those to the step's first query.
    template <abut::scalar T>
    void add(int step, int queries, const outcome<T>& found, const example::stopwatch& watch) {
        const auto count = [](const auto& list, abut::feature_pair kind) {
            return static_cast<std::size_t>(std::ranges::count(list, kind, &abut::impact<T>::kind));
        };
        using enum abut::feature_pair;
        std::printf("%4d %7d | %8zu %9zu |", step, queries, count(found.itself, vertex_face),
                    count(found.itself, edge_edge));
        if (with_ball_) {
            std::printf(" %8zu %6zu %8zu |", count(found.ball, vertex_face), count(found.ball, face_vertex),
                        count(found.ball, edge_edge));
        }
        const auto* const first = found.first();
        first == nullptr ? std::printf(" %11s |", "-") : std::printf(" %11.6g |", first->time);
        for (std::size_t k = 0; k < stages.size(); ++k) {
            const auto took = watch.total(stages[k]);
            if (took) times_[k].push_back(*took);
            if (k < shown) took ? std::printf(" %8.3f", *took) : std::printf(" %8s", "-");
        }
        std::printf("\n");
        std::fflush(stdout);
    }
    void print_medians() const {
        std::printf("ms %-12s %10s %10s %8s\n", with_ball_ ? "in a step" : "in a run", "median", "greatest",
                    with_ball_ ? "steps" : "runs");
        for (std::size_t k = 0; k < stages.size(); ++k) {
            auto sorted = times_[k];
            if (sorted.empty()) continue;
            std::ranges::sort(sorted);
            const double median = (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
            std::printf("   %-12s %10.3f %10.3f %8zu\n", stages[k], median, sorted.back(), sorted.size());
        }
    }

private:
    static constexpr std::size_t shown = 5;

    bool with_ball_;
    std::array<std::vector<double>, stages.size()> times_;
};

/// What is known of each vertex and face: in how many impacts it is, itself or by an edge; the earliest time of these, or
/// -1.
struct marks {
    std::vector<std::uint32_t> impacts;
    std::vector<double> time;

    explicit marks(std::size_t n) : impacts(n, 0), time(n, -1) {}
    void add(std::size_t i, double t) {
        ++impacts[i];
        if (time[i] < 0 || t < time[i]) time[i] = t;
    }
};

/// The faces over an edge, and what impacts say of them.
class face_marker {
public:
    explicit face_marker(const std::vector<abut::face>& faces) : faces_(faces) {
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) faces_of_[edge_of(faces_[f][k], faces_[f][(k + 1) % 3])].push_back(f);
        }
    }
    [[nodiscard]] const std::vector<abut::face>& faces() const { return faces_; }
    template <abut::scalar T>
    [[nodiscard]] marks of_vertices(std::size_t vertices, const outcome<T>& found) const {
        marks made(vertices);
        found.for_each_feature([&](const auto& feature, double time) {
            for (const std::uint32_t v : feature) made.add(v, time);
        });
        return made;
    }
    template <abut::scalar T>
    [[nodiscard]] marks of_faces(const outcome<T>& found) const {
        marks made(faces_.size());
        found.for_each_feature([&](const auto& feature, double time) {
            if (feature.size() == 1) return;
            for (const std::uint32_t f : faces_of_.at(edge_of(feature[0], feature[1]))) {
                if (feature.size() == 2 || std::ranges::equal(faces_[f], feature)) made.add(f, time);
            }
        });
        return made;
    }

private:
    static std::pair<std::uint32_t, std::uint32_t> edge_of(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

    std::vector<abut::face> faces_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> faces_of_;
};

/// 0 or 1 for each.
inline std::vector<std::uint8_t> hits_of(const marks& m) {
    std::vector<std::uint8_t> hit(m.impacts.size());
    std::ranges::transform(m.impacts, hit.begin(), [](std::uint32_t n) { return n > 0 ? 1 : 0; });
    return hit;
}

/// Writes PREFIX_part.ply and .vtp: a frame, its vertices and faces marked where they are hit.
class writer {
public:
    writer(const settings& s, const face_marker& marker) : s_(s), marker_(marker) {}

    template <abut::scalar T>
    void write(const std::string& part, const std::vector<abut::vec3<T>>& positions, const outcome<T>& found) {
        const marks of_vertices = marker_.of_vertices(positions.size(), found), of_faces = marker_.of_faces(found);
        const std::vector<std::uint8_t> hit = hits_of(of_faces);
        const auto properties = [](const marks& m) -> std::vector<abut::io::property> {
            return {{"impacts", std::span<const std::uint32_t>(m.impacts)}, {"time", std::span<const double>(m.time)}};
        };
        write_both(part, positions, marker_.faces(),
                   {.hit = hit, .face_properties = properties(of_faces), .vertex_properties = properties(of_vertices)});
    }
    template <abut::scalar T>
    void write_both(const std::string& part, const std::vector<abut::vec3<T>>& positions,
                    const std::vector<abut::face>& faces, const abut::io::mesh_options& options) {
        for (const char* extension : {".ply", ".vtp"}) {
            if (failure_) return;
            last_ = s_.out + "_" + part + extension;
            if (written_++ == 0) first_ = last_;
            try {
                abut::io::write_mesh(last_, positions, faces, options);
            } catch (...) {
                failure_ = std::current_exception();  // steps go on, and their figures are printed
            }
        }
    }
    /// Says what was written, or throws what went wrong.
    void print() const {
        std::fflush(stdout);
        if (failure_) std::rethrow_exception(failure_);
        std::printf("written: %s to %s, %d files\n", first_.c_str(), last_.c_str(), written_);
    }

private:
    const settings& s_;
    const face_marker& marker_;
    std::string first_, last_;
    int written_ = 0;
    std::exception_ptr failure_;
};

/// The impacts of which all vertices are shown: those of the cloth by `shown`.
template <abut::scalar T>
std::vector<abut::impact<T>> shown_impacts(abut::io::gltf_scene& scene, const std::vector<abut::impact<T>>& impacts,
                                           bool with_itself, const std::vector<std::uint8_t>& shown) {
    return example::shown_results(scene, "impacts", impacts, [&](const abut::impact<T>& i) {
        const auto features = features_of(i);
        const auto is_shown = [&](std::uint32_t v) { return shown[v] != 0; };
        return std::ranges::all_of(features[0], is_shown) && (!with_itself || std::ranges::all_of(features[1], is_shown));
    });
}

/// The vertices of the faces that are shown.
inline std::vector<std::uint8_t> shown_vertices(const std::vector<abut::face>& faces, const example::selection& which,
                                                std::size_t vertices) {
    std::vector<std::uint8_t> shown(vertices);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (!which.shows(f)) continue;
        for (const std::uint32_t v : faces[f]) shown[v] = 1;
    }
    return shown;
}

inline void print_settings(const settings& s) {
    std::printf("%s, %s arithmetic on %s", s.policy().c_str(), s.arithmetic.c_str(), s.scalar.c_str());
    if (s.arithmetic == "conservative") {
        std::printf(", tolerance %g, separation %g", s.bounds.tolerance, s.bounds.separation);
    }
    std::printf("\n");
}

inline void print_size(const char* what, std::size_t vertices, std::size_t faces) {
    std::printf("%s: vertices %zu, faces %zu\n", what, vertices, faces);
}

// --- two frames --------------------------------------------------------------------------------------------------------

/// Positions in the scalar type; says whether they were others in the file.
template <abut::scalar T>
std::vector<abut::vec3<T>> rounded(const std::vector<abut::vec3<double>>& positions, bool& changed) {
    std::vector<abut::vec3<T>> made;
    made.reserve(positions.size());
    for (const auto& p : positions) {
        const abut::vec3<T> q{static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)};
        changed |= q.x != p.x || q.y != p.y || q.z != p.z;
        made.push_back(q);
    }
    return made;
}

template <abut::scalar T>
std::vector<abut::vec3<T>> positions_of(const abut::mesh<T>& mesh) {
    const auto view = mesh.view();
    std::vector<abut::vec3<T>> made(view.vertices.count);
    for (std::size_t v = 0; v < made.size(); ++v) made[v] = view.vertices[v];
    return made;
}

template <abut::motion_arithmetic A, class Policy, abut::scalar T>
void run_frames(const Policy& on, const settings& s) {
    const auto read_0 = abut::io::read_mesh<double>(s.frame_0), read_1 = abut::io::read_mesh<double>(s.frame_1);
    const auto checked = abut::moving(read_0, read_1);  // as many vertices, and the same faces
    bool changed = false;
    const auto at_t0 = rounded<T>(positions_of(read_0), changed), at_t1 = rounded<T>(positions_of(read_1), changed);
    std::vector<abut::face> faces(checked.size());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = read_0.view().faces[f];

    print_settings(s);
    std::printf("%s to %s\n", s.frame_0.c_str(), s.frame_1.c_str());
    print_size("mesh", at_t0.size(), faces.size());
    if (changed) std::printf("coordinates were rounded to float; --scalar double takes them as they are\n");
    detector<A, Policy, T> detect(on, abut::mesh<T>(at_t0, faces), std::nullopt, s);
    outcome<T> found;
    table rows(false);
    for (example::series runs(s.repeat); runs.more();) {
        example::stopwatch watch;
        found = detect.look(at_t1, watch);
        rows.add(runs.number(), 1, found, watch);
    }
    if (const auto* const i = found.first()) {
        const auto [a, b] = features_of(*i);
        const bool of_edges = i->kind == abut::feature_pair::edge_edge;
        std::printf("first: %s", of_edges ? "edge" : "vertex");
        for (const auto v : a) std::printf(" %u", v);
        std::printf(" and %s", of_edges ? "edge" : "face");
        for (const auto v : b) std::printf(" %u", v);
        std::printf(" at t = %.12f\n", i->time);
    }
    if (s.repeat > 1) rows.print_medians();
    const face_marker marker(faces);
    if (!s.view.empty()) {
        const example::selection which(hits_of(marker.of_faces(found)), example::most_faces_shown,
                                       example::most_faces_shown);
        const abut::mesh<T> mesh(at_t0, faces);
        abut::io::gltf_scene scene;
        const auto set =
            example::add_selected(scene, "mesh", abut::moving(mesh, mesh.with_vertices(abut::serial{}, at_t1)), which);
        const auto impacts = shown_impacts(scene, found.itself, true, shown_vertices(faces, which, at_t0.size()));
        scene.add_impacts(set, set, impacts, {.of = found.itself.size()});
        example::write_view(s.view, scene);
    }
    if (s.no_output) return;
    writer out(s, marker);
    out.write("t0", at_t0, found);
    out.write("t1", at_t1, found);
    out.print();
}

// --- a cloth falls on a ball -------------------------------------------------------------------------------------------

/// Holds back vertices that are hit, or a feature of which is: `part` is how much of its way each may go. The first time
/// that is to shortly before the impact; if that made them hit something else, they stay where they are. Returns whether any
/// is held back more than before: then the step has changed, and has to be looked at again.
///
/// That ends, since a step later every impact is of a vertex that still moves, and that one stays from then on. (Under
/// `conservative` what stays may be reported for being near, and changes nothing.)
template <abut::scalar T>
bool hold_back(const outcome<T>& found, bool is_first, std::vector<double>& part) {
    std::vector<double> next = part;
    found.for_each_feature([&](const auto& feature, double time) {
        for (const auto v : feature) next[v] = std::min(next[v], is_first ? 0.9 * time : 0);
    });
    const bool more = next != part;
    part = std::move(next);
    return more;
}

/// Pairs of faces that touch in one frame: of the cloth, beyond what neighbours share, and of cloth and ball.
template <abut::scalar T>
void print_touching(const abut::mesh<T>& cloth, const abut::mesh<T>& ball) {
    const abut::serial on;
    const auto index = abut::make_bvh(on, cloth);
    std::printf("pairs of faces that touch at the end: %llu of the cloth, %llu of cloth and ball\n",
                static_cast<unsigned long long>(abut::count_self_pairs(on, index)),
                static_cast<unsigned long long>(abut::count(on, index, ball)));
}

/// What --view shows of a fall: where the cloth was at some of the steps' ends, and the impacts of the last step.
template <abut::scalar T>
class fall {
public:
    /// Where all steps would be too much, each so manyth of them is kept, and the last two.
    fall(const settings& s, const falling_cloth<T>& cloth)
        : s_(s),
          mesh_(cloth.positions(), cloth.faces()),
          last_(mesh_),
          every_(1 + static_cast<int>(cloth.faces().size() * static_cast<std::size_t>(s.steps) / most_moving_faces)) {
        if (!s.view.empty()) frames_.push_back(mesh_);
    }
    void add(int step, const std::vector<abut::vec3<T>>& positions) {
        if (s_.view.empty()) return;
        const bool was_kept = (step - 1) % every_ == 0;
        before_ = was_kept ? std::nullopt : std::optional(last_);
        last_ = mesh_.with_vertices(abut::serial{}, positions);
        if (step % every_ == 0) frames_.push_back(last_);
        last_step_ = step;
    }
    void write(const outcome<T>& found, const face_marker& marker, const abut::mesh<T>& ball) {
        if (s_.view.empty()) return;
        if (last_step_ % every_ != 0) {
            if (before_) frames_.push_back(*before_);
            frames_.push_back(last_);
        } else if (before_) {
            frames_.insert(frames_.end() - 1, *before_);
        }
        const example::selection which(hits_of(marker.of_faces(found)), example::most_faces_shown,
                                       example::most_faces_shown);
        abut::io::gltf_scene scene;
        tell(scene, "impacts are those of the last step, on the way that the cloth wanted to go; what is hit was held back");
        if (every_ > 1) {
            tell(scene, "of " + std::to_string(last_step_) + " steps, the ends of " + std::to_string(frames_.size() - 1) +
                            " are shown: each " + std::to_string(every_) + "th, and the last two");
        }
        which.tell(scene, "cloth");
        if (!which.is_whole()) {
            for (auto& frame : frames_) frame = example::part_of(frame, which.ids());
        }
        const auto cloth = scene.add_frames("cloth", frames_, which.options());
        const auto of_ball = scene.add("ball", ball);
        const auto shown = shown_vertices(marker.faces(), which, mesh_.view().vertices.count);
        const auto add = [&](abut::io::gltf_set other, const auto& impacts, bool with_itself) {
            scene.add_impacts(cloth, other, shown_impacts(scene, impacts, with_itself, shown),
                              {.of = impacts.size(), .step = frames_.size() - 2});
        };
        add(cloth, found.itself, true);
        add(of_ball, found.ball, false);
        example::write_view(s_.view, scene);
    }

private:
    /// Faces times frames: 36 bytes each.
    static constexpr std::size_t most_moving_faces = 2'000'000;

    static void tell(abut::io::gltf_scene& scene, const std::string& text) {
        std::printf("view: %s\n", text.c_str());
        scene.add_note(text);
    }

    const settings& s_;
    abut::mesh<T> mesh_, last_;
    int every_, last_step_ = 0;
    std::optional<abut::mesh<T>> before_;  // where the last step began, if that is not kept
    std::vector<abut::mesh<T>> frames_;
};

/// Each step the cloth says where it wants to go, and the impacts say how far it gets. It begins apart from the ball and
/// from itself, and stays so, exactly: the last query of each step has found nothing. This is no simulator: what is hit
/// sticks until it is pulled away, nothing slides or bounces, and momentum is lost.
template <abut::motion_arithmetic A, class Policy, abut::scalar T>
void run_scene(const Policy& on, const settings& s) {
    falling_cloth<T> cloth(s.cloth);
    const auto sphere = ball<T>();
    const abut::mesh<T> ball_mesh(sphere.vertices, sphere.faces);
    print_settings(s);
    print_size("cloth", cloth.positions().size(), cloth.faces().size());
    print_size("ball", sphere.vertices.size(), sphere.faces.size());

    detector<A, Policy, T> detect(on, abut::mesh<T>(cloth.positions(), cloth.faces()), ball_mesh, s);
    const face_marker marker(cloth.faces());
    writer out(s, marker);
    fall<T> seen(s, cloth);
    outcome<T> last;
    if (!s.no_output) out.write_both("ball", sphere.vertices, sphere.faces, {});
    table rows(true);
    for (example::series steps(s.steps); steps.more();) {
        const int step = steps.number();
        example::stopwatch watch;
        std::vector<double> part(cloth.positions().size(), 1);
        watch.time("simulate", [&] { cloth.propose(); });
        const auto wanted = detect.look(cloth.proposed(part), watch);
        int queries = 1;
        for (auto found = wanted; hold_back(found, queries == 1, part); ++queries) {
            found = detect.look(cloth.proposed(part), watch);
        }
        detect.advance(watch);
        cloth.go(part);
        seen.add(step, cloth.positions());
        if (!s.view.empty()) last = wanted;
        rows.add(step, queries, wanted, watch);
        if (!s.no_output && (step % s.write_every == 0 || steps.is_last())) {
            char number[16];
            std::snprintf(number, sizeof number, "%04d", step);
            out.write(number, cloth.positions(), wanted);
        }
    }
    rows.print_medians();
    print_touching(abut::mesh<T>(cloth.positions(), cloth.faces()), ball_mesh);
    seen.write(last, marker, ball_mesh);
    if (!s.no_output) out.print();
}

// --- the command line --------------------------------------------------------------------------------------------------

template <class Program>
void describe(CLI::App& app, settings& s) {
    app.description(
        "What of a mesh touches itself on the way from one frame to the next, and when? Vertices move in straight\n"
        "lines. v-f: a vertex and a face, f-v: a face and a vertex, e-e: two edges; pairs that share a vertex are\n"
        "left out. Times go from 0 to 1.\n\n"
        "Without files: a cloth falls on a ball. Vertices that are hit stop shortly before, and the step is looked\n"
        "at again until none is. This is no simulator: what is hit sticks.\n" +
        std::string(Program::note));
    app.add_option("frame0", s.frame_0,
                   "Read the mesh where the step begins from an .obj, .ply, .stl, .off, .glb or .gltf file")
        ->type_name("FILE");
    app.add_option("frame1", s.frame_1, "Read it where the step ends: the same faces")->type_name("FILE");
    app.add_option("--cloth", s.cloth, "Vertices along a side of the embedded cloth")
        ->type_name("N")
        ->check(CLI::Range(2, 2000))
        ->capture_default_str();
    app.add_option("--steps", s.steps, "Steps that it falls")
        ->type_name("N")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_option("--rebuild", s.rebuild, "Make a new index every N steps (0: when its boxes have grown by half)")
        ->type_name("N")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    example::add_policy<Program>(app, s);
    example::add_types<Program>(app, s, "impacts");
    if (Program::has_conservative) {
        app.get_option("--arithmetic")
            ->description(
                "How impacts are decided. filtered and exact agree and are right; conservative misses none and\n"
                "reports more; fast can be wrong");
        app.add_option("--tolerance", s.bounds.tolerance, "Of conservative: how much too early a time may be")
            ->type_name("T")
            ->capture_default_str();
        app.add_option("--separation", s.bounds.separation, "Of conservative: how near is reported")
            ->type_name("D")
            ->capture_default_str();
    }
    example::add_repeat(app, s, "Query the frames");
    app.add_option("--out", s.out,
                   "Write the frames, PREFIX_t0 and PREFIX_t1, or the ball and PREFIX_0010, ..., each as .ply and .vtp;\n"
                   "vertices and faces are marked where they are hit")
        ->type_name("PREFIX")
        ->capture_default_str();
    app.add_option("--write-every", s.write_every, "Write each Nth frame of the embedded cloth, and the last one")
        ->type_name("N")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_flag("--no-output", s.no_output, "Write no files");
    example::add_view(app, s);
}

/// What CLI11 does not check.
inline void check(const CLI::App& app, const settings& s) {
    const auto refuse = [&](std::initializer_list<const char*> names, const char* why) {
        for (const char* name : names) {
            const auto* const option = app.get_option_no_throw(name);
            if (option != nullptr && option->count() > 0) throw example::usage_error(name + std::string(why));
        }
    };
    if (s.has_frames() && s.frame_1.empty()) throw example::usage_error("expected two frames, or none");
    if (s.has_frames()) refuse({"--cloth", "--steps", "--write-every"}, ": goes without files");
    if (!s.has_frames()) refuse({"--repeat"}, ": goes with two files");
    if (s.arithmetic != "conservative") refuse({"--tolerance", "--separation"}, ": goes with --arithmetic conservative");
    const auto is_good = [](double x) { return std::isfinite(x) && x >= 0; };
    if (!is_good(s.bounds.tolerance)) throw example::usage_error("--tolerance: expected 0 or more");
    if (!is_good(s.bounds.separation)) throw example::usage_error("--separation: expected 0 or more");
    const double most = 0.25 * cloth_side / std::max(s.cloth - 1, 1);
    if (!s.has_frames() && s.bounds.separation > most) {
        throw example::usage_error("--separation: expected at most " + std::to_string(most) +
                                   ", a quarter of an edge of the cloth, whose neighbours would come too near otherwise");
    }
    example::check_threads(s);
    example::check_view(s);
    if (s.no_output) return;
    for (const char* part : {"_t0", "_t1", "_ball"}) {
        for (const char* extension : {".ply", ".vtp"}) example::require_writable(s.out + part + extension);
    }
}

/// `Program` names itself, its policies, and the types that it is compiled for. Returns the exit status.
template <class Program>
int main(int argc, char** argv) {
    settings s;
    s.policies = {Program::policies().front()};
    const CLI::App* described = nullptr;
    const auto work = [&]<class T>() {
        Program::with_policy(s.policy(), s.threads, [&]<class Policy>(const Policy& on) {
            example::choose(typename Program::arithmetics{}, s.arithmetic, [&]<class A>() {
                s.has_frames() ? run_frames<A, Policy, T>(on, s) : run_scene<A, Policy, T>(on, s);
            });
        });
        return 0;
    };
    return example::run<Program>(
        argc, argv, s,
        [&](CLI::App& app) {
            described = &app;
            describe<Program>(app, s);
        },
        [&] {
            check(*described, s);
            s.is_series = true;
        },
        work);
}

}  // namespace cloth_ccd
