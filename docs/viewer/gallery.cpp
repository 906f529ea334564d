// SPDX-License-Identifier: MIT
//
// usage: gallery FOLDER
//
// Scenes for the page of docs/viewer, which the examples do not have: rings.glb, two rings that cross and the move that parts
// them; patches.glb, a table that stands in a floor; sweeps.glb, capsules that go through a room; safe_step.glb, a block that
// falls past a shelf, and how far it may. cmake/view.sh --gallery runs it.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/write_gltf.hpp>

namespace {

using point = abut::vec3<double>;
const abut::serial on;  // all of it is small

/// Up is y, as the page has it.
point at(double x, double depth, double height) { return {x, height, -depth}; }

/// Boxes as one mesh. Their z is up.
abut::mesh<double> boxes(const std::vector<abut::aabb<double>>& all) {
    std::vector<point> vertices;
    std::vector<abut::face> faces;
    for (const auto& box : all) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        for (std::uint32_t k = 0; k < 8; ++k) {
            const auto end = [&](std::uint32_t bit, double low, double high) { return (k >> bit & 1) != 0 ? high : low; };
            vertices.push_back(at(end(0, box.lower.x, box.upper.x), end(1, box.lower.y, box.upper.y), end(2, box.lower.z, box.upper.z)));
        }
        for (const auto& f : abut::io::detail::box_corners()) faces.push_back({first + f[0], first + f[1], first + f[2]});
    }
    return {std::move(vertices), std::move(faces)};
}

/// A ring around z, or around y.
abut::mesh<double> ring(const point& middle, double radius, double tube, bool upright) {
    constexpr std::uint32_t n = 64, m = 24;
    const double turn = 2 * std::acos(-1.0);
    std::vector<point> vertices;
    std::vector<abut::face> faces;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            const double r = radius + tube * std::cos(turn * j / m), h = tube * std::sin(turn * j / m);
            const double c = r * std::cos(turn * i / n), s = r * std::sin(turn * i / n);
            vertices.push_back(middle + (upright ? point{c, -h, s} : point{c, s, h}));
            const std::uint32_t next = (i + 1) % n * m, up = (j + 1) % m;
            faces.push_back({i * m + j, next + j, next + up});
            faces.push_back({i * m + j, next + up, i * m + up});
        }
    }
    return {std::move(vertices), std::move(faces)};
}

abut::mesh<double> moved(const abut::mesh<double>& mesh, const point& by) {
    std::vector<point> vertices;
    for (std::size_t i = 0; i < mesh.view().vertices.count; ++i) vertices.push_back(mesh.view().vertices[i] + by);
    return mesh.with_vertices(on, vertices);
}

abut::io::gltf_scene crossing_rings() {
    const auto flat = ring({0, 0, 0}, 4, 1, false), upright = ring({2, 0, 0}, 3, 1, true);
    const auto crossings = abut::crossings(on, flat, abut::make_bvh(on, upright));
    std::vector<std::uint8_t> of_flat(flat.size()), of_upright(upright.size());
    for (const auto& c : crossings) of_flat[c.a] = of_upright[c.b] = 1;
    const auto depth = abut::penetration(on, flat, upright);
    abut::io::gltf_scene scene;
    const auto a = scene.add("flat", abut::moving(flat, moved(flat, depth.move)), {.hit = of_flat});
    const auto b = scene.add("upright", upright, {.hit = of_upright});
    scene.add_curves("where they cross", abut::curves(on, crossings));
    scene.add_move("the way out", point{-5, 0, 0}, depth.move);
    scene.add_pairs(a, b, crossings);
    return scene;
}

abut::io::gltf_scene table_in_floor() {
    std::vector<abut::aabb<double>> parts{{{-3, -2, 2}, {3, 2, 2.4}}};
    for (const auto& [x, y] : {std::pair{-2.9, -1.9}, std::pair{2.5, -1.9}, std::pair{-2.9, 1.5}, std::pair{2.5, 1.5}}) {
        parts.push_back({{x, y, -0.1 - 0.02 * x}, {x + 0.4, y + 0.4, 2}});
    }
    const auto table = boxes(parts), floor = boxes({{{-5, -4, -1}, {5, 4, 0}}});
    abut::io::gltf_scene scene;
    scene.add("table", table);
    scene.add("floor", floor);
    scene.add_patches("patches", abut::contact_patches(on, table, floor, {.known_solid = true}));
    return scene;
}

abut::io::gltf_scene sweeps_in_a_room() {
    const auto room = boxes({{{-9, -9, -0.5}, {9, 9, 0}}, {{4, -9, 0}, {4.5, 9, 5}}, {{-2, 3, 0}, {1, 4, 3}}});
    const abut::capsules<double> movers{{{at(-6, -4, 1), at(-6, -4, 2)}, 0.8},
                                        {{at(-6, 3, 1), at(-6, 3, 2)}, 0.8},
                                        {{at(0, -2, 4), at(1, -2, 4)}, 0.5},
                                        {{at(-6, 7, 1), at(-6, 7, 2)}, 0.8}};
    const abut::points<double> ways{at(12, 1, 0), at(8, 1, 0), at(1, 0, -5), at(6, 0, 0)};
    const auto hits = abut::sweep(on, abut::make_bvh(on, room), movers, ways);
    abut::io::gltf_scene scene;
    const auto met = scene.add("room", room);
    scene.add_sweep("movers", movers, ways, hits, met);
    return scene;
}

abut::io::gltf_scene safe_step_of_a_block() {
    const auto block = boxes({{{-1, -1, 3}, {1, 1, 5}}}), shelf = boxes({{{0.5, -3, 0}, {6, 3, 0.5}}});
    const auto falling = abut::moving(block, moved(block, at(-0.5, 0, -6))), still = abut::moving(shelf, shelf);
    abut::io::gltf_scene scene;
    const auto a = scene.add("block", falling), b = scene.add("shelf", still);
    scene.add_impacts(a, b, abut::impacts(on, falling, still));
    scene.add_safe_step(a, b, abut::safe_step(on, falling, still));
    return scene;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    const std::filesystem::path folder = arguments[1];
    abut::io::write_gltf(folder / "rings.glb", crossing_rings());
    abut::io::write_gltf(folder / "patches.glb", table_in_floor());
    abut::io::write_gltf(folder / "sweeps.glb", sweeps_in_a_room());
    abut::io::write_gltf(folder / "safe_step.glb", safe_step_of_a_block());
}
