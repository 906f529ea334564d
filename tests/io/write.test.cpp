// SPDX-License-Identifier: MIT
#include <abut/io/write.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <abut/io/read.hpp>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::write_cases {

namespace {

struct id_pair {
    std::uint32_t a, b;
};
struct signed_pair {
    std::int64_t a;
    int b;
};

const std::vector<abut::vec3<float>> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<std::array<std::uint32_t, 3>> halves{{0, 1, 2}, {0, 2, 3}};
const std::filesystem::path full = "/dev/full";  // a device that is always full

}  // namespace

TEMPLATE_TEST_CASE("write_ply: what is written is read back, bit for bit", "", float, double) {
    const io_test::scratch folder;
    using limits = std::numeric_limits<TestType>;
    const std::vector<abut::vec3<TestType>> vertices{{TestType(0.1), limits::max(), limits::denorm_min()},
                                                     {-limits::max(), TestType(-0.0), limits::min()},
                                                     {1, 2, 3},
                                                     {4, 5, 6}};
    const std::vector<std::array<std::uint32_t, 3>> faces{{0, 1, 2}, {3, 3, 3}};
    const std::vector<std::uint8_t> hit{0, 7};
    const std::vector<float> depth{0.5f, 1};
    const std::vector<std::int32_t> group{-1, 2};
    const std::vector<double> time{0.25, 1};
    const std::vector<std::uint32_t> id{1, 4000000000};
    for (const bool more : {false, true}) {
        abut::io::ply_options options;
        if (more)
            options = {.hit = hit, .face_properties = {{"depth", depth}, {"group", group}, {"time", time}, {"id", id}}};
        abut::io::write_ply(folder / "a.ply", abut::mesh<TestType>{vertices, faces}, options);
        const auto read = abut::io::read_mesh_data<TestType>(folder / "a.ply");
        CHECK(read.vertices == vertices);
        CHECK(std::signbit(read.vertices[1].y));
        CHECK(read.faces == faces);
        const auto view = abut::io::read_mesh<TestType>(folder / "a.ply").view();
        CHECK(view.size() == 2);
    }
}

TEMPLATE_TEST_CASE("write_obj, write_off: what is written is read back, bit for bit", "", float, double) {
    const io_test::scratch folder;
    using limits = std::numeric_limits<TestType>;
    const std::vector<abut::vec3<TestType>> vertices{{TestType(0.1), limits::max(), limits::denorm_min()},
                                                     {-limits::max(), TestType(-0.0), limits::min()},
                                                     {TestType(1) / 3, 2, 1e10},
                                                     {4, 5, 6}};
    const std::vector<std::array<std::uint32_t, 3>> faces{{0, 1, 2}, {3, 3, 3}};
    for (const char* name : {"a.obj", "a.OFF"}) {
        abut::io::write_mesh(folder / name, abut::mesh<TestType>{vertices, faces});
        const auto read = abut::io::read_mesh_data<TestType>(folder / name);
        CHECK(read.vertices == vertices);
        CHECK(std::signbit(read.vertices[1].y));
        CHECK(read.faces == faces);
    }
}

TEST_CASE("write_stl, write_obj, write_off: the files, byte for byte, and what they refuse") {
    const io_test::scratch folder;
    const abut::mesh<double> mesh{{{0, 0, 0}, {2, 0, 0}, {0, 0.1, 0}, {1e-50, 0, 0}}, {{0, 2, 1}, {0, 1, 3}}};
    abut::io::write_mesh(folder / "a.obj", mesh);
    CHECK(io_test::content(folder / "a.obj") == "v 0 0 0\nv 2 0 0\nv 0 0.1 0\nv 1e-50 0 0\nf 1 3 2\nf 1 2 4\n");
    abut::io::write_mesh(folder / "a.off", mesh.view());
    CHECK(io_test::content(folder / "a.off") == "OFF\n4 2 0\n0 0 0\n2 0 0\n0 0.1 0\n1e-50 0 0\n3 0 2 1\n3 0 1 3\n");
    abut::io::write_mesh(folder / "a.stl", mesh);
    const std::string stl = io_test::content(folder / "a.stl");
    REQUIRE(stl.size() == 84 + 2 * 50);
    CHECK(stl.substr(0, 5) != "solid");
    CHECK(stl.substr(80, 4) == std::string("\2\0\0\0", 4));
    float z = 0;  // of the first normal
    std::memcpy(&z, stl.data() + 92, sizeof z);
    CHECK(z == -1);
    const auto read = abut::io::read_mesh_data<float>(folder / "a.stl");
    CHECK(read.vertices == std::vector<abut::vec3<float>>{{0, 0, 0}, {0, 0.1f, 0}, {2, 0, 0}, {0, 0, 0}, {2, 0, 0}, {0, 0, 0}});
    CHECK(read.faces == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 4, 5}});

    const std::vector<std::uint8_t> hit{0, 1};
    for (const char* name : {"b.stl", "b.obj", "b.off"}) {
        CHECK(io_test::refusal([&] { abut::io::write_mesh(folder / name, mesh, {.hit = hit}); })
                  .find("expected .ply or .vtp for a mesh with values") != std::string::npos);
        CHECK(!std::filesystem::exists(folder / name));
    }
    CHECK(io_test::refusal([&] { abut::io::write_stl(folder / "b.stl", abut::mesh<double>{{{0, 0, 1e39}}, {{0, 0, 0}}}); })
              .find("expected coordinates that float can hold, found 1e+39 in vertex 0") != std::string::npos);
    const std::vector<std::array<std::uint32_t, 3>> wrong{{0, 1, 4}};
    const abut::mesh_view<float> bad(square.data(), square.size(), wrong.data(), 1);
    CHECK(io_test::refusal([&] { abut::io::write_obj(folder / "b.obj", bad); })
              .find("expected vertex indices below 4, found 4 in face 0") != std::string::npos);
    CHECK(io_test::refusal([&] { abut::io::write_mesh(folder / "b.dae", square, halves); })
              .find("expected a file name that ends with .ply, .vtp, .stl, .obj or .off") != std::string::npos);
    if (std::filesystem::exists(full)) {
        CHECK(io_test::refusal([&] { abut::io::write_off(full, mesh); }).find("cannot be written") != std::string::npos);
    }
}

TEST_CASE("write_ply: the file, byte for byte") {
    const io_test::scratch folder;
    const std::vector<std::uint8_t> hit{0, 1};
    const std::vector<std::int32_t> group{-1, 2};
    abut::io::write_ply(folder / "a.ply", square, halves, {.hit = hit, .face_properties = {{"group", group}}});
    const std::string text = io_test::content(folder / "a.ply");
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar hit\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar hit\nproperty uchar "
        "red\n"
        "property uchar green\nproperty uchar blue\nproperty int group\nend_header\n";
    REQUIRE(text.size() == header.size() + 4 * 13 + 2 * 21);
    CHECK(text.substr(0, header.size()) == header);
    const auto body = text.substr(header.size());
    CHECK(body.substr(13, 13) == std::string("\0\0\x80\x3f\0\0\0\0\0\0\0\0\0", 13));  // vertex 1: (1, 0, 0), in face 0 only
    CHECK(body.substr(26, 13) == std::string("\0\0\x80\x3f\0\0\x80\x3f\0\0\0\0\1", 13));  // vertex 2: (1, 1, 0), in both
    CHECK(body.substr(52, 21) == std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0\0\xd9\xd9\xd9\xff\xff\xff\xff", 21));
    CHECK(body.substr(73, 21) == std::string("\3\0\0\0\0\2\0\0\0\3\0\0\0\1\xe6\x55\x0d\2\0\0\0", 21));
}

TEST_CASE("write_ply: an empty mesh") {
    const io_test::scratch folder;
    abut::io::write_ply(folder / "a.ply", abut::mesh<double>{});
    const auto read = abut::io::read_mesh<double>(folder / "a.ply");
    CHECK(read.size() == 0);
}

TEST_CASE("write_ply: values for other faces and bad names are refused before the file is touched") {
    const io_test::scratch folder;
    const auto refusal = [&](const abut::io::ply_options& options) {
        const std::string message =
            io_test::refusal([&] { abut::io::write_ply(folder / "a.ply", square, halves, options); });
        const auto start = message.find("expected");
        return start == message.npos ? message : message.substr(start);
    };
    const std::vector<std::uint8_t> three(3), two(2), four(4);
    CHECK(refusal({.hit = three}) == "expected 2 values of 'hit', one for each face, found 3");
    CHECK(refusal({.face_properties = {{"depth", std::span<const float>()}}}) ==
          "expected 2 values of 'depth', one for each face, found 0");
    for (const std::string name : {"", "two words", "line\n", "tab\t"}) {
        CHECK(refusal({.face_properties = {{name, std::span<const std::uint8_t>(two)}}}) ==
              "expected the name of a property without blanks, found '" + name + "'");
    }
    CHECK(refusal({.hit = two, .face_properties = {{"red", std::span<const std::uint8_t>(two)}}}) ==
          "expected properties of different names, found 'red' again");
    CHECK(refusal({.vertex_properties = {{"id", std::span<const std::uint8_t>(two)}}}) ==
          "expected 4 values of 'id', one for each vertex, found 2");
    CHECK(refusal({.vertex_properties = {{"x", std::span<const std::uint8_t>(four)}}}) ==
          "expected properties of different names, found 'x' again");
    CHECK_FALSE(std::filesystem::exists(folder / "a.ply"));
}

TEST_CASE("write_ply: values of vertices lie between the position and the faces") {
    const io_test::scratch folder;
    const std::vector<std::uint32_t> id{1, 2, 3, 4000000000};
    abut::io::write_ply(folder / "a.ply", square, halves, {.vertex_properties = {{"id", id}}});
    const std::string text = io_test::content(folder / "a.ply");
    const auto body = text.substr(text.find("end_header\n") + 11);
    CHECK(text.find("property float z\nproperty uint id\nelement face 2\n") != std::string::npos);
    CHECK(body.substr(48, 16) == std::string("\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\x28\x6b\xee", 16));
    CHECK(abut::io::read_mesh_data<float>(folder / "a.ply").faces == halves);
}

TEST_CASE("write_points_ply: the file, byte for byte") {
    const io_test::scratch folder;
    const std::vector<abut::vec3<float>> points{{0, 0, 1}, {2, 0, 0}}, normals{{0, 1, 0}, {-1, 0, 0}};
    const std::vector<double> depth{0.5, -2};
    abut::io::write_points_ply(folder / "a.ply", points, {.normals = normals, .properties = {{"depth", depth}}});
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty double depth\nend_header\n";
    const std::string one("\0\0\x80\x3f", 4), zero(4, '\0'), two("\0\0\0\x40", 4), minus_one("\0\0\x80\xbf", 4);
    CHECK(io_test::content(folder / "a.ply") == header + zero + zero + one + zero + one + zero +
                                                    std::string("\0\0\0\0\0\0\xe0\x3f", 8) + two + zero + zero + minus_one +
                                                    zero + zero + std::string("\0\0\0\0\0\0\0\xc0", 8));
    abut::io::write_points_ply(folder / "b.ply", std::vector<abut::vec3<double>>{});
    CHECK(io_test::content(folder / "b.ply") ==
          "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty double x\nproperty double y\n"
          "property double z\nend_header\n");
}

TEST_CASE("write_mesh and write_points: the extension chooses the format") {
    const io_test::scratch folder;
    const std::vector<std::uint8_t> hit{0, 1};
    const abut::mesh<float> mesh{square, halves};
    abut::io::write_ply(folder / "a.ply", mesh, {.hit = hit});
    abut::io::write_vtp(folder / "a.vtp", mesh, {.hit = hit});
    for (const std::string name : {"b.ply", "b.PLY", "b.vtp", "b.Vtp"}) {
        const auto known = io_test::content(folder / (name[2] == 'p' || name[2] == 'P' ? "a.ply" : "a.vtp"));
        abut::io::write_mesh(folder / name, mesh, {.hit = hit});
        CHECK(io_test::content(folder / name) == known);
        abut::io::write_mesh(folder / name, mesh.view(), {.hit = hit});
        CHECK(io_test::content(folder / name) == known);
        abut::io::write_mesh(folder / name, square, halves, {.hit = hit});
        CHECK(io_test::content(folder / name) == known);
    }
    abut::io::write_points_ply(folder / "a.ply", square);
    abut::io::write_points_vtp(folder / "a.vtp", square);
    for (const std::string name : {".ply", ".vtp"}) {
        abut::io::write_points(folder / ("b" + name), square);
        CHECK(io_test::content(folder / ("b" + name)) == io_test::content(folder / ("a" + name)));
    }
    for (const std::string name : {"a.dae", "a", "vtp"}) {
        const auto path = folder / name;
        CHECK(io_test::refusal([&] { abut::io::write_mesh(path, mesh); }) ==
              path.string() + ": expected a file name that ends with .ply, .vtp, .stl, .obj or .off");
        CHECK(io_test::refusal([&] { abut::io::write_points(path, square); }) ==
              path.string() + ": expected a file name that ends with .ply or .vtp");
        CHECK_FALSE(std::filesystem::exists(path));
    }
}

TEST_CASE("write_points: normals and values for other points are refused before the file is touched") {
    const io_test::scratch folder;
    const std::vector<abut::vec3<float>> two_normals(2);
    const std::vector<float> two(2), four(4);
    for (const std::string name : {"a.ply", "a.vtp"}) {
        const auto refusal = [&](const abut::io::point_options<float>& options) {
            const std::string message = io_test::refusal([&] { abut::io::write_points(folder / name, square, options); });
            const auto start = message.find("expected");
            return start == message.npos ? message : message.substr(start);
        };
        CHECK(refusal({.normals = two_normals}) == "expected 4 values of 'normal', one for each point, found 2");
        CHECK(refusal({.properties = {{"depth", two}}}) == "expected 4 values of 'depth', one for each point, found 2");
        CHECK(refusal({.properties = {{"a b", four}}}) == "expected the name of a property without blanks, found 'a b'");
        CHECK(refusal({.properties = {{"d", four}, {"d", four}}}) ==
              "expected properties of different names, found 'd' again");
        CHECK_FALSE(std::filesystem::exists(folder / name));
    }
}

TEST_CASE("write_pairs: header, ids, any container of pairs") {
    const io_test::scratch folder;
    abut::io::write_pairs(folder / "a.csv", std::vector<id_pair>{{0, 1}, {4294967295u, 10}});
    CHECK(io_test::content(folder / "a.csv") == "a,b\n0,1\n4294967295,10\n");
    abut::io::write_pairs(folder / "b.csv", std::array<signed_pair, 1>{{{std::numeric_limits<std::int64_t>::min(), -1}}},
                          {"triangle", "sphere"});
    CHECK(io_test::content(folder / "b.csv") == "triangle,sphere\n-9223372036854775808,-1\n");
    abut::io::write_pairs(folder / "c.csv", std::vector<id_pair>{});
    CHECK(io_test::content(folder / "c.csv") == "a,b\n");
}

TEST_CASE("write_pairs: across the ends of the buffer") {
    const io_test::scratch folder;
    std::vector<id_pair> pairs(300000);
    std::string expected = "a,b\n";
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        pairs[i] = {i * 7919, i % 1000};
        expected += std::to_string(pairs[i].a) + "," + std::to_string(pairs[i].b) + "\n";
    }
    abut::io::write_pairs(folder / "a.csv", pairs);
    CHECK(io_test::content(folder / "a.csv") == expected);
}

TEST_CASE("writers: a full disk and a path that cannot be written are errors") {
    const std::vector<id_pair> pairs(10);
    const auto missing = std::filesystem::path("no such folder") / "a";
    CHECK(io_test::refusal([&] { abut::io::write_pairs(missing, pairs); }) ==
          missing.string() + ": cannot be written: No such file or directory");
    CHECK(io_test::refusal([&] { abut::io::write_ply(missing, square, halves); }) ==
          missing.string() + ": cannot be written: No such file or directory");
    if (!std::filesystem::exists(full)) return;
    CHECK(io_test::refusal([&] { abut::io::write_pairs(full, pairs); }) ==
          "/dev/full: cannot be written: No space left on device");
    CHECK(io_test::refusal([&] { abut::io::write_pairs(full, std::vector<id_pair>(1000000)); }) ==
          "/dev/full: cannot be written: No space left on device");
    CHECK(io_test::refusal([&] { abut::io::write_ply(full, square, halves); }) ==
          "/dev/full: cannot be written: No space left on device");
    CHECK(io_test::refusal([&] { abut::io::write_vtp(full, square, halves); }) ==
          "/dev/full: cannot be written: No space left on device");
    CHECK(io_test::refusal([&] { abut::io::write_points_vtp(full, std::vector<abut::vec3<double>>(100000)); }) ==
          "/dev/full: cannot be written: No space left on device");
    CHECK(io_test::refusal([&] { abut::io::write_points_ply(full, square); }) ==
          "/dev/full: cannot be written: No space left on device");
}

}  // namespace io_test::write_cases
