// SPDX-License-Identifier: MIT
#include <abut/io/obj.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::obj_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;

template <class T = double>
auto parse(const std::string& text) {
    return abut::io::parse_obj<T>(text, "t.obj");
}
std::string refusal(const std::string& text) {
    return io_test::refusal([&] { parse<float>(text); });
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("obj: corners in all four forms, comments, names") {
    const auto mesh = parse("# made by hand\nmtllib a.mtl\no part one\n" + square +
                            "vt 0 0\nvn 0 0 1\ng a b\ns off\nusemtl steel # 1\nf 1 2 3\nf 1/1 2/1 3/1\n\n  f\t1//1 2//1 "
                            "3//1  \nf 1/1/1 2/1/1 4/1/1 # x\n"
                            "f 1// 2/ 3//\nl 1 2\np 1\nfo 2 3 4");
    REQUIRE(mesh.vertices.size() == 4);
    CHECK(mesh.vertices[2] == abut::vec3<double>{1, 1, 0});
    CHECK(mesh.faces == faces{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 2}, {1, 2, 3}});
}

TEST_CASE("obj: negative indices count back from the face, positive ones may point ahead") {
    const auto mesh = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nf 1 2 4\nv 0 0 1\nf -1 1 -2\n");
    CHECK(mesh.faces == faces{{0, 1, 2}, {0, 1, 3}, {3, 0, 2}});
}

TEST_CASE("obj: lines end with LF, CR LF or CR, and go on after a backslash") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text = "3 1\nv 0 0 0\n\n# c\nv 1 0 0\nv 0 \\\n1 0\nf 1\\\n2 \\\n 3 \\\n\nl 1 \\\n2\nf 3 2 1";
        for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += end.size()) text.replace(i, 1, end);
        const auto mesh = parse(text);
        CHECK(mesh.vertices == std::vector<abut::vec3<double>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(mesh.faces == faces{{0, 1, 2}, {2, 1, 0}});
    }
}

TEST_CASE("obj: positions are the decimal text rounded once") {
    const std::string text = "v 0.1 1.000000059604644775390625000001 -1e-320\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3\n";
    CHECK(parse<double>(text).vertices[0] == abut::vec3<double>{0.1, 1.000000059604644775390625, -1e-320});
    CHECK(parse<float>(text).vertices[0] == abut::vec3<float>{0.1f, 0x1.000002p0f, 0.0f});
    CHECK(parse<double>(text).vertices[2] == abut::vec3<double>{0, 1, 0});
}

TEST_CASE("obj: stray counts before the first vertex are skipped, a byte order mark too") {
    CHECK(parse("6540 2180\r\n" + square).vertices.size() == 4);
    CHECK(parse("\xef\xbb\xbf" + square).vertices.size() == 4);
    CHECK(refusal(square + "6540 2180\n") == "t.obj:5: expected an OBJ statement (v, f, vt, vn, g, ...), found '6540'");
    CHECK(refusal("6540 many\n") == "t.obj:1: expected an OBJ statement (v, f, vt, vn, g, ...), found '6540'");
}

TEST_CASE("obj: polygons become a fan where that covers them, else they are cut") {
    CHECK(parse(square + "f 1 2 3 4\n").faces == faces{{0, 1, 2}, {0, 2, 3}});
    // An arrowhead, from each of its corners, seen from both sides and in each plane.
    for (const std::string plane : {"xy", "yz", "zx"}) {
        const auto point = [&](int a, int b) {
            const std::string s = std::to_string(a), t = std::to_string(b);
            return "v " + (plane == "xy" ? s + " " + t + " 0" : plane == "yz" ? "0 " + s + " " + t : t + " 0 " + s) + "\n";
        };
        const std::string arrow = point(0, 0) + point(4, 0) + point(1, 1) + point(0, 4);
        for (const std::string face : {"1 2 3 4", "2 3 4 1", "3 4 1 2", "4 1 2 3", "4 3 2 1", "3 2 1 4"}) {
            const auto mesh = parse(arrow + "f " + face + "\n");
            REQUIRE(mesh.faces.size() == 2);
            for (const auto& f : mesh.faces) {  // both have corners 1 and 3: the other diagonal leaves the arrowhead
                CHECK(std::count(f.begin(), f.end(), 0u) == 1);
                CHECK(std::count(f.begin(), f.end(), 2u) == 1);
            }
        }
    }
}

TEST_CASE("obj: triangles of a nonconvex polygon cover its area, none turned around") {
    // A comb: teeth of width 1 and height 9 on a bar, 12 of them; its first corner sees almost nothing of it.
    std::string text, face = "f";
    double expected = 0;
    std::vector<std::array<double, 2>> ring;
    const int teeth = 12;
    for (int i = 0; i < teeth; ++i) {
        ring.push_back({2.0 * i, 10});
        ring.push_back({2.0 * i, 1});
        ring.push_back({2.0 * i + 1, 1});
        ring.push_back({2.0 * i + 1, 10});
    }
    ring.push_back({2.0 * teeth, 10});
    ring.push_back({2.0 * teeth, 0});
    ring.push_back({0, 0});
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& p = ring[i];
        const auto& q = ring[(i + 1) % ring.size()];
        expected += (p[0] * q[1] - q[0] * p[1]) / 2;
        text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    const auto mesh = parse(text + face + "\n");
    REQUIRE(mesh.faces.size() == ring.size() - 2);
    double area = 0;
    for (const auto& f : mesh.faces) {
        const auto a = mesh.vertices[f[0]], b = mesh.vertices[f[1]], c = mesh.vertices[f[2]];
        const double part = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
        CHECK(part * expected >= 0);
        area += part;
    }
    CHECK(area == expected);  // halves of integers, so exact
}

TEST_CASE("obj: polygons without area, or that cross themselves, stay a fan") {
    CHECK(parse(square + "f 1 1 1 1\n").faces == faces{{0, 0, 0}, {0, 0, 0}});
    CHECK(parse(square + "f 1 2 2 1\n").faces.size() == 2);
    CHECK(parse(square + "f 1 3 2 4\n").faces == faces{{0, 2, 1}, {0, 1, 3}});
    CHECK(parse("v 1.7e308 0 0\nv -1.7e308 0 0\nv 0 1.7e308 0\nv 0 0 1\nf 1 2 3 4\n").faces.size() == 2);
    CHECK(parse(square + "f 1 1 2\n").faces == faces{{0, 0, 1}});  // a degenerate triangle is legal
}

TEST_CASE("obj: a polygon of many corners is a fan if that is right, and refused if not") {
    std::string convex, face = "f";
    for (int i = 0; i < 2000; ++i) {
        convex += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    CHECK(parse(convex + face + "\n").faces.size() == 1998);
    std::string saw;
    for (int i = 0; i < 1999; ++i) saw += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
    saw += "v 1000 -1000000 0\n";
    CHECK(refusal(saw + face + "\n") ==
          "t.obj:2001: expected polygons that are convex or have at most 1024 corners, found one with 2000");
    // Of two large ones that which is refused, and the line that it begins on.
    const std::string both = convex + saw + face + "\nf 1 2 3\nf 1 2 3 4\n";
    std::string of_saw = "f";
    for (int i = 0; i < 2000; ++i) of_saw += (i == 1000 ? " \\\n -" : " -") + std::to_string(2000 - i);
    CHECK(refusal(both + of_saw + "\n") ==
          "t.obj:4004: expected polygons that are convex or have at most 1024 corners, found one with 2000");
}

TEST_CASE("obj: what some programs write beside it") {
    CHECK(parse(square + "t 0 0\ngroup one two\nf 1 2 3\n" + std::string(37, '\0')).faces == faces{{0, 1, 2}});
    CHECK(refusal(square + std::string("f 1 2 3\n\0\nf 1 2 4\n", 18)) ==
          "t.obj:6: expected an OBJ statement (v, f, vt, vn, g, ...), found '\\x00'");
    const auto cloud = parse(square);
    CHECK(cloud.vertices.size() == 4);
    CHECK(cloud.faces.empty());
    CHECK(refusal(std::string("\xff\xfev\0 \0", 6)) == "t.obj: expected text in ASCII or UTF-8, found UTF-16");
    CHECK(refusal(std::string("#\0 \0v\0", 6)) == "t.obj: expected text in ASCII or UTF-8, found UTF-16");
}

TEST_CASE("obj: leniently, long rows and faces of two corners are passed over and counted") {
    const auto lenient = [](const std::string& text) {
        return abut::io::parse_obj<double>(text, "t.obj", {.lenient = true});
    };
    const auto read = lenient("v 0 0 0 1 1 1 1 1 1\nv 1 0 0 1 1\nv 0 1 0 1\nf 1 2\nf -1\nf\nf 1 2 3\nf 3/1 2/1 1/1\n");
    CHECK(read.faces == faces{{0, 1, 2}, {2, 1, 0}});
    CHECK(read.skipped == abut::io::skipped_parts{3, 2, 0});
    CHECK(io_test::refusal([&] { lenient("v 0 0 0 x\n"); }) ==
          "t.obj:1: expected the end of the vertex, a weight or a colour, found 'x'");
    CHECK(io_test::refusal([&] { lenient(square + "f 1 5\n"); }) ==
          "t.obj:5: expected a vertex index from 1 to 4 (or from -1 to -4), found '5'");
}

TEST_CASE("obj: every malformed line is refused with its number") {
    CHECK(refusal("") == "t.obj:1: expected vertices ('v x y z') in an OBJ file, found the end of the file");
    CHECK(refusal("# nothing\n") == "t.obj:2: expected vertices ('v x y z') in an OBJ file, found the end of the file");
    CHECK(refusal("v 1 2\n") == "t.obj:1: expected the z coordinate of a vertex, found the end of the line");
    CHECK(refusal("v 1 2 # 3\n") == "t.obj:1: expected the z coordinate of a vertex, found '#'");
    CHECK(refusal("\nv 1 2 3\nv 1 2") == "t.obj:3: expected the z coordinate of a vertex, found the end of the file");
    CHECK(refusal("v 1 foo 3\n") == "t.obj:1: expected the y coordinate of a vertex, found 'foo'");
    CHECK(refusal("v 1 0,5 3\n") == "t.obj:1: expected the y coordinate of a vertex, found '0,5'");
    CHECK(refusal("v nan 0 3\n") == "t.obj:1: expected a finite number (the x coordinate of a vertex), found 'nan'");
    CHECK(refusal("v 0 0 1e39\n") == "t.obj:1: expected a finite number (the z coordinate of a vertex), found '1e39'");
    CHECK(refusal("v 0 0 0 x\n") == "t.obj:1: expected the end of the vertex, a weight or a colour, found 'x'");
    CHECK(refusal("v 0 0 0 1 1 1 1 1\n") == "t.obj:1: expected the end of the vertex, a weight or a colour, found '1'");
    CHECK(refusal("v 0 0 0 1 1\n") ==
          "t.obj:1: expected x, y, z, and then a weight, a colour of three numbers or both, found the end of the line");
    CHECK(refusal(square + "f 1 2\n") == "t.obj:5: expected a face of at least 3 corners, found the end of the line");
    CHECK(refusal(square + "f") == "t.obj:5: expected a face of at least 3 corners, found the end of the file");
    CHECK(refusal(square + "f 1 2 0\n") == "t.obj:5: expected a vertex index from 1 to 4 (or from -1 to -4), found '0'");
    CHECK(refusal(square + "f 1 2 -5\n") == "t.obj:5: expected a vertex index from 1 to 4 (or from -1 to -4), found '-5'");
    CHECK(refusal(square + "f 1 2 99999999999\n") ==
          "t.obj:5: expected a vertex index from 1 to 4 (or from -1 to -4), found '99999999999'");
    CHECK(refusal(square + "f 1 2 5\nf 1 2 9\nv 0 0 0\nf 7 1 2") ==
          "t.obj:6: expected a vertex index from 1 to 5 (or from -1 to -5), found '9'");
    for (const std::string corner : {"1.5", "a", "1/a", "1/1/1/1", "1/1/b", "/1", "//", "1#"}) {
        CHECK(refusal(square + "f 1 2 " + corner + "\n") ==
              "t.obj:5: expected a corner as v, v/vt, v//vn or v/vt/vn, found '" + corner + "'");
    }
    CHECK(refusal("V 1 2 3\n") == "t.obj:1: expected an OBJ statement (v, f, vt, vn, g, ...), found 'V'");
    CHECK(refusal("ply\n") == "t.obj:1: expected an OBJ statement (v, f, vt, vn, g, ...), found 'ply'");
    CHECK(refusal(std::string("\0\1\2", 3)) ==
          "t.obj:1: expected an OBJ statement (v, f, vt, vn, g, ...), found '\\x00\\x01\\x02'");
    CHECK(refusal(square + "surf 0 1 0 1 1\n") ==
          "t.obj:5: expected polygons (free-form surfaces are not supported), found 'surf'");
    CHECK(refusal("call other.obj\n") ==
          "t.obj:1: expected one file (other files and commands are not called), found 'call'");
    CHECK(refusal(square + "g name\\\nf 1 2 3 4 9\n") ==
          "t.obj:6: expected a vertex index from 1 to 4 (or from -1 to -4), found '9'");
}

}  // namespace io_test::obj_cases
