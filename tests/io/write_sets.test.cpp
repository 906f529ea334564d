// SPDX-License-Identifier: MIT
#include <abut/io/write_sets.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <abut/collide/crossings.hpp>
#include <abut/collide/curves.hpp>
#include <abut/io/read.hpp>
#include <abut/io/write_gltf.hpp>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::write_sets_cases {

namespace {

using abut::vec3;

/// The bytes of a number, and of several.
template <class... V>
std::string bytes(V... values) {
    std::string made;
    const auto put = [&](auto value) {
        char raw[sizeof value];
        io_test::to_little_endian(value, raw);
        made.append(raw, sizeof raw);
    };
    (put(values), ...);
    return made;
}
using u8 = std::uint8_t;

}  // namespace

TEST_CASE("write_spheres: points with a radius, byte for byte") {
    const io_test::scratch folder;
    const abut::spheres<double> set{{{{1, 2, 0.1}, 0.3}, {{-1, 0, 0}, 0}}};
    const std::vector<u8> hit{0, 3};
    const std::vector<std::int32_t> group{-1, 5};
    abut::io::write_spheres(folder / "a.ply", set, {.hit = hit, .properties = {{"group", group}}});
    CHECK(io_test::content(folder / "a.ply") ==
          "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
          "property double radius\nproperty uchar hit\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
          "property int group\nend_header\n" +
              bytes(1.0, 2.0, 0.1, 0.3, u8{0}, u8{217}, u8{217}, u8{217}, -1) +
              bytes(-1.0, 0.0, 0.0, 0.0, u8{1}, u8{230}, u8{85}, u8{13}, 5));
    const abut::equal_spheres<float> equal{std::vector<vec3<float>>{{1, 2, 3}}, 4};
    abut::io::write_spheres(folder / "b.ply", equal.view());
    CHECK(
        io_test::content(folder / "b.ply").ends_with("property float radius\nend_header\n" + bytes(1.0f, 2.0f, 3.0f, 4.0f)));
    CHECK(abut::io::read_mesh_data<float>(folder / "b.ply").vertices == std::vector<vec3<float>>{{1, 2, 3}});
    abut::io::write_spheres(folder / "c.vtp", equal);
    CHECK(io_test::content(folder / "c.vtp").find("Name=\"radius\"") != std::string::npos);
    CHECK(io_test::refusal([&] {
              abut::io::write_spheres(folder / "d.ply", equal, {.hit = hit});
          }).ends_with("expected 1 values of 'hit', one for each shape, found 2"));
    CHECK(io_test::refusal([&] {
              abut::io::write_spheres(folder / "d.ply", set, {.properties = {{"radius", group}}});
          }).ends_with("expected properties of different names, found 'radius' again"));
    CHECK_FALSE(std::filesystem::exists(folder / "d.ply"));
}

TEST_CASE("write_segments: vertices and edges, byte for byte, and as lines") {
    const io_test::scratch folder;
    const abut::segments<float> set{{{{0, 0, 0}, {1, 0.1f, 0}}, {{5, 5, 5}, {5, 5, 5}}}};
    const std::vector<u8> hit{1, 0};
    const std::vector<double> length{1.005, 0};
    abut::io::write_segments(folder / "a.PLY", set, {.hit = hit, .properties = {{"length", length}}});
    CHECK(io_test::content(folder / "a.PLY") ==
          "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
          "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty uchar hit\nproperty uchar red\n"
          "property uchar green\nproperty uchar blue\nproperty double length\nend_header\n" +
              bytes(0.0f, 0.0f, 0.0f, 1.0f, 0.1f, 0.0f, 5.0f, 5.0f, 5.0f, 5.0f, 5.0f, 5.0f) +
              bytes(0, 1, u8{1}, u8{230}, u8{85}, u8{13}, 1.005) + bytes(2, 3, u8{0}, u8{217}, u8{217}, u8{217}, 0.0));
    CHECK(abut::io::read_mesh_data<float>(folder / "a.PLY").vertices.size() == 4);
    const std::vector<abut::edge> edges{{2, 0}};
    abut::io::write_segments(folder / "b.vtp",
                             abut::edge_mesh<double>{std::vector<vec3<double>>{{1, 2, 3}, {0, 0, 0}, {4, 5, 6}}, edges});
    const std::string text = io_test::content(folder / "b.vtp");
    CHECK(text.find("NumberOfPoints=\"2\" NumberOfVerts=\"0\" NumberOfLines=\"1\"") != std::string::npos);
    CHECK(text.find("<Lines>\n") != std::string::npos);
    CHECK(io_test::refusal([&] {
              abut::io::write_segments(folder / "c.ply", set, {.properties = {{"vertex1", length}}});
          }).ends_with("expected properties of different names, found 'vertex1' again"));
}

TEST_CASE("write_boxes: a closed mesh of each box, with the box's values") {
    const io_test::scratch folder;
    const abut::boxes<float> set{{{{0, 0, 0}, {1, 2, 3}}, {{-1, -1, -1}, {-0.5f, 0.1f, 4}}}};
    const std::vector<u8> hit{0, 1};
    const std::vector<float> depth{0.5f, 2};
    abut::io::write_boxes(folder / "a.ply", set, {.hit = hit, .properties = {{"depth", depth}}});
    const auto read = abut::io::read_mesh_data<float>(folder / "a.ply");
    REQUIRE(read.vertices.size() == 16);
    REQUIRE(read.faces.size() == 24);
    // Outward faces around each box: six times its volume is the sum over faces of a . (b x c).
    std::array<double, 2> volume{};
    for (std::size_t f = 0; f < 24; ++f) {
        std::array<vec3<double>, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(read.faces[f][k] / 8 == f / 12);
            const auto& v = read.vertices[read.faces[f][k]];
            p[k] = {v.x, v.y, v.z};
        }
        volume[f / 12] += dot(p[0], cross(p[1], p[2])) / 6;
    }
    CHECK(volume[0] == Approx(6));
    CHECK(volume[1] == Approx(0.5 * 1.1 * 5));
    const std::string text = io_test::content(folder / "a.ply");
    CHECK(text.ends_with(bytes(u8{1}, u8{230}, u8{85}, u8{13}, std::uint32_t{1}, 2.0f)));
    CHECK(text.find("property uint box\nproperty float depth\nend_header\n") != std::string::npos);
    abut::io::write_boxes(folder / "b.vtp", set.view());
    CHECK(io_test::content(folder / "b.vtp").find("NumberOfPolys=\"24\"") != std::string::npos);
    CHECK(io_test::refusal([&] {
              abut::io::write_boxes(folder / "c.ply", set, {.properties = {{"depth", std::span(depth).first(1)}}});
          }).ends_with("expected 2 values of 'depth', one for each shape, found 1"));
    CHECK(io_test::refusal([&] { abut::io::write_boxes(folder / "c.obj", set); }).ends_with("ends with .ply or .vtp"));
    CHECK_FALSE(std::filesystem::exists(folder / "c.ply"));
}

TEST_CASE("write_curves: the segments of an open and of a closed curve, with their faces") {
    const io_test::scratch folder;
    // A square cuts a tetrahedron, and ends within it.
    const abut::mesh<float> tetrahedron{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const abut::mesh<float> square{{{0.5f, -9, 1}, {9, -9, 1}, {9, 9, 1}, {0.5f, 9, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    const abut::mesh<float> plate{{{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}}, {{0, 1, 2}, {0, 2, 3}}};
    const abut::serial on;
    auto all = abut::curves(on, abut::crossings(on, tetrahedron, square));
    REQUIRE(all.size() == 1);
    CHECK(!all[0].closed);
    for (const auto& c : abut::curves(on, abut::crossings(on, tetrahedron, plate))) all.push_back(c);
    REQUIRE(all.size() == 2);
    CHECK(all[1].closed);
    const std::size_t segments = all[0].segments() + all[1].segments();
    CHECK(all[1].segments() == all[1].points.size());

    abut::io::write_curves(folder / "a.ply", all);
    std::string expected, edges;
    std::int32_t vertex = 0;
    for (std::uint32_t k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < all[k].segments(); ++i) {
            for (const vec3<float>& p : {all[k].points[i], all[k].points[(i + 1) % all[k].points.size()]}) {
                expected += bytes(p.x, p.y, p.z);
            }
            const auto faces = all[k].pairs_of(i)[0];
            edges += bytes(vertex, vertex + 1, k, faces.a, faces.b);
            vertex += 2;
        }
    }
    CHECK(io_test::content(folder / "a.ply")
              .ends_with("element edge " + std::to_string(segments) +
                         "\nproperty int vertex1\nproperty int vertex2\nproperty uint curve\nproperty uint face_a\nproperty uint "
                         "face_b\nend_header\n" +
                         expected + edges));
    abut::io::write_curves(folder / "a.vtp", all);
    CHECK(io_test::content(folder / "a.vtp").find("Name=\"curve\"") != std::string::npos);
    abut::io::write_curves(folder / "b.vtp", std::vector<abut::curve<float>>{});

    abut::io::gltf_scene scene;
    CHECK(scene.add_curves("cut", all).number == 0);
    abut::io::write_gltf(folder / "a.glb", scene);
    const std::string glb = io_test::content(folder / "a.glb");
    CHECK(glb.find("\"kind\":\"segments\"") != std::string::npos);
    CHECK(glb.find("\"role\":\"curves\"") != std::string::npos);
    CHECK(glb.find("\"count\":" + std::to_string(segments)) != std::string::npos);
}

}  // namespace io_test::write_sets_cases
