// SPDX-License-Identifier: MIT
#include <abut/collide/curves.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <abut/io/read.hpp>

#include "collide/crossing_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"
#include "support/needs.hpp"
#include "support/samples.hpp"

// Crossings of real meshes against CGAL's exact kernel: which faces meet, what each corner of the common part is, and where. And
// curves of them: all segments are in one, and none ends but at an edge that has not two faces. With ABUT_SAMPLES above 100,000
// all meshes of the data, in 50 poses each.

namespace abut::test {

namespace {

using exact_kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using exact_point = exact_kernel::Point_3;
using exact_triangle = exact_kernel::Triangle_3;

/// Whether a point is what is said: in the vertex, on the edge between its ends, or within the triangle.
bool is_in_place(const exact_triangle& t, unsigned char place, const exact_point& p) {
    if (place < 3) return t.vertex(place) == p;
    const auto on_side = [&](int k) { return exact_kernel::Segment_3(t.vertex(k), t.vertex((k + 1) % 3)).has_on(p); };
    const auto is_vertex = [&] { return t.vertex(0) == p || t.vertex(1) == p || t.vertex(2) == p; };
    if (place < 6) return on_side(place - 3) && !is_vertex();
    return t.has_on(p) && !on_side(0) && !on_side(1) && !on_side(2);
}

struct crossing_tally {
    std::uint64_t pairs = 0, segments = 0, wrong = 0, curves = 0, closed = 0, broken = 0;

    void fail(const char* what, std::uint32_t a, std::uint32_t b) {
        if (wrong++ < 5) std::printf("%s: faces %u and %u\n", what, a, b);
    }
    /// `theirs` is what the exact kernel says that the faces of c have in common.
    template <class Theirs>
    void compare(const crossing<float>& c, const triangle<float>& s, const triangle<float>& t, const exact_triangle& their_s,
                 const exact_triangle& their_t, const Theirs& theirs) {
        std::vector<exact_point> corners;
        if (const auto* point = std::get_if<exact_point>(&theirs)) corners = {*point};
        if (const auto* segment = std::get_if<exact_kernel::Segment_3>(&theirs)) corners = {segment->source(), segment->target()};
        if (const auto* part = std::get_if<exact_triangle>(&theirs)) corners = {part->vertex(0), part->vertex(1), part->vertex(2)};
        if (const auto* part = std::get_if<std::vector<exact_point>>(&theirs)) corners = *part;
        segments += c.count == 2;
        if (corners.size() != c.count) return fail("another number of corners", c.a, c.b);
        double largest = 0;
        for (const vec3<float>& p : {s.a, s.b, s.c, t.a, t.b, t.c}) {
            for (const float x : {p.x, p.y, p.z}) largest = std::max(largest, std::abs(static_cast<double>(x)));
        }
        // The bound of docs/crossings.md.
        const exact_kernel::FT most(1.0625 * 0x1p-24 * largest);
        for (int i = 0; i < c.count; ++i) {
            const vec3<float>& p = c.points[i];
            const exact_point at(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
            const bool found = std::any_of(corners.begin(), corners.end(), [&](const exact_point& q) {
                return is_in_place(their_s, c.in_a[i], q) && is_in_place(their_t, c.in_b[i], q) && CGAL::abs(q.x() - at.x()) <= most &&
                       CGAL::abs(q.y() - at.y()) <= most && CGAL::abs(q.z() - at.z()) <= most;
            });
            if (!found) fail("a corner is elsewhere", c.a, c.b);
        }
    }
};

exact_triangle theirs(const triangle<float>& t) {
    const auto point = [](const vec3<float>& p) {
        return exact_point(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    };
    return {point(t.a), point(t.b), point(t.c)};
}

void compare_crossings(const mesh<float>& still, const mesh<float>& other, crossing_tally& tally) {
    const serial on;
    const auto found = crossings(on, make_bvh(on, still), make_bvh(on, other));
    std::map<std::pair<std::uint32_t, std::uint32_t>, const crossing<float>*> ours;
    for (const crossing<float>& c : found) ours[{c.a, c.b}] = &c;
    using box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
    const auto boxes_of = [](const mesh<float>& of) {
        std::vector<box> all;
        for (std::uint32_t f = 0; f < of.size(); ++f) {
            const aabb<float> b = bounds(triangle<float>(of.view()[f]));
            const auto l = detail::widened(b.lower), u = detail::widened(b.upper);
            all.emplace_back(CGAL::Bbox_3(l.x, l.y, l.z, u.x, u.y, u.z), f);
        }
        return all;
    };
    auto of_a = boxes_of(still), of_b = boxes_of(other);
    std::uint64_t known = 0;
    CGAL::box_intersection_d(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), [&](const box& x, const box& y) {
        const std::uint32_t a = x.info(), b = y.info();
        const triangle<float> s = still.view()[a], t = other.view()[b];
        const exact_triangle their_s = theirs(s), their_t = theirs(t);
        if (their_s.is_degenerate() || their_t.is_degenerate()) {
            known += ours.contains({a, b});
            return;
        }
        const auto common = CGAL::intersection(their_s, their_t);
        const auto at = ours.find({a, b});
        if ((at != ours.end()) != bool(common)) return tally.fail("only one finds that they meet", a, b);
        if (!common) return;
        ++known;
        boost::apply_visitor([&](const auto& part) {
            using all = std::variant<exact_point, exact_kernel::Segment_3, exact_triangle, std::vector<exact_point>>;
            tally.compare(*at->second, s, t, their_s, their_t, all(part));
        }, *common);
    });
    tally.pairs += found.size();
    if (known != found.size()) tally.fail("pairs whose boxes do not meet", 0, 0);
}

void check_curves(const mesh<float>& still, const mesh<float>& other, crossing_tally& tally) {
    const serial on;
    const auto faces_at_edges = [](const mesh<float>& of) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
        for (std::size_t f = 0; f < of.size(); ++f) {
            const auto v = of.view().faces[f];
            for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax(v[k], v[(k + 1) % 3])];
        }
        return count;
    };
    const auto found = crossings(on, make_bvh(on, still), make_bvh(on, other));
    const auto lines = curves(on, found);
    std::uint64_t segments = 0, in_curves = 0;
    bool is_general = true;
    for (const crossing<float>& c : found) {
        segments += c.count == 2;
        is_general &= c.count == 2;
        for (int i = 0; i < c.count; ++i) is_general &= c.feature_a(i).part == mesh_part::in_face || c.feature_b(i).part == mesh_part::in_face;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges_a, edges_b;
    for (const curve<float>& line : lines) {
        ++tally.curves;
        tally.closed += line.closed;
        for (std::size_t i = 0; i < line.segments(); ++i) in_curves += line.pairs_of(i).size();
        if (line.segments() != line.points.size() - (line.closed ? 0 : 1)) ++tally.broken;
        if (line.closed || !is_general) continue;
        if (edges_a.empty()) edges_a = faces_at_edges(still), edges_b = faces_at_edges(other);
        const auto is_border = [](const mesh_feature& f, auto& edges) {
            return f.part == mesh_part::on_edge && edges[{f.first, f.second}] != 2;
        };
        for (const std::size_t end : {std::size_t{0}, line.points.size() - 1}) {
            if (!is_border(line.features_a[end], edges_a) && !is_border(line.features_b[end], edges_b)) ++tally.broken;
        }
    }
    if (is_general && in_curves != segments) ++tally.broken;
}

}  // namespace

TEST_CASE("crossings: of real meshes, what CGAL's exact kernel says of each pair, and no curve broken") {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const bool all = sample_count() > 100000;
    std::vector<std::filesystem::path> files{*folder / "armadillo_2766.ply", *folder / "teapot.obj"};
    if (all) {
        files.clear();
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder->parent_path())) {
            const auto extension = entry.path().extension();
            if (extension == ".obj" || extension == ".ply") files.push_back(entry.path());
        }
        std::sort(files.begin(), files.end());
    }
    std::uint64_t wrong = 0, broken = 0, scenes = 0, segments = 0;
    for (const auto& file : files) {
        const auto still = io::read_mesh<float>(file);
        float reach = 0;
        for (std::size_t i = 0; i < still.view().vertices.count; ++i) reach = std::max(reach, std::abs(still.view().vertices[i].x));
        crossing_tally tally;
        for (std::uint64_t k = 0; k < (all ? 50u : 2u); ++k) {
            draws d(20261129, 1, k);
            const auto other = turned_and_moved(still, d, static_cast<double>(reach) / 4);
            compare_crossings(still, other, tally);
            check_curves(still, other, tally);
            ++scenes;
        }
        std::printf("%s: %zu faces, %llu pairs, %llu segments, %llu wrong, %llu curves, %llu closed, %llu broken\n",
                    file.lexically_relative(folder->parent_path()).string().c_str(), still.size(), static_cast<unsigned long long>(tally.pairs),
                    static_cast<unsigned long long>(tally.segments), static_cast<unsigned long long>(tally.wrong),
                    static_cast<unsigned long long>(tally.curves), static_cast<unsigned long long>(tally.closed),
                    static_cast<unsigned long long>(tally.broken));
        std::fflush(stdout);
        wrong += tally.wrong;
        broken += tally.broken;
        segments += tally.segments;
    }
    CHECK(wrong == 0);
    CHECK(broken == 0);
    CHECK(segments > 100 * scenes / 2);
}

}  // namespace abut::test
