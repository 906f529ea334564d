// SPDX-License-Identifier: MIT
#include <abut/io/stl.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::stl_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;

template <class T = double>
auto parse(const std::string& data) {
    return abut::io::parse_stl<T>(data, "t.stl");
}
template <class T = float>
std::string refusal(const std::string& data) {
    return io_test::refusal([&] { parse<T>(data); });
}
auto leniently(const std::string& data) { return abut::io::parse_stl<float>(data, "t.stl", {.lenient = true}); }

/// A binary file of these corners, nine numbers a triangle, whose normals are not numbers.
std::string binary(const std::vector<float>& corners, std::string head = "solid, says the head") {
    head.resize(80, ' ');
    const auto put = [&](auto value) {
        char bytes[sizeof value];
        io_test::to_little_endian(value, bytes);
        head.append(bytes, sizeof bytes);
    };
    put(static_cast<std::uint32_t>(corners.size() / 9));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i % 9 == 0) {
            for (int k = 0; k < 3; ++k) put(std::numeric_limits<float>::quiet_NaN());
        }
        put(corners[i]);
        if (i % 9 == 8) put(std::uint16_t{7});
    }
    return head;
}

const std::string facet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1e0 0 0\n  vertex 0 0.1 0\n endloop\nendfacet\n";

}  // namespace

TEST_CASE("stl: binary, bit for bit, also where the head says solid") {
    const float least = std::numeric_limits<float>::denorm_min(), most = std::numeric_limits<float>::max();
    const std::vector<float> corners{0.1f, -0.0f, least, most, -most, 1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 5, 6, 7};
    for (const std::string head : {"solid x", "exported by hand"}) {
        const auto read = parse<float>(binary(corners, head));
        REQUIRE(read.vertices.size() == 6);
        CHECK(std::memcmp(read.vertices.data(), corners.data(), corners.size() * sizeof(float)) == 0);
        CHECK(read.faces == faces{{0, 1, 2}, {3, 4, 5}});
        CHECK(parse<double>(binary(corners, head)).vertices[0].x == static_cast<double>(0.1f));
    }
    CHECK(parse(binary({})).faces.empty());
}

TEST_CASE("stl: ASCII, several solids, any case, decimals rounded once") {
    const auto read =
        parse("  SOLID a name of\tmore words\n" + facet + "EndSolid a name\n\nsolid\r\n" + facet + facet + "endsolid");
    CHECK(read.faces == faces{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
    CHECK(read.vertices[2] == abut::vec3<double>{0, 0.1, 0});
    CHECK(parse<float>("solid\n" + facet + "endsolid\n").vertices[2].y == 0.1f);
    CHECK(parse("solid\nendsolid\n").faces.empty());
    CHECK(parse("solid part\n" + facet + "endsolidpart\nsolid\n" + facet + "ENDSOLID_2").faces.size() == 2);
    CHECK(parse("\xef\xbb\xbfsolid\nendsolid\n").faces.empty());
}

TEST_CASE("stl: what is malformed is refused with its line or byte") {
    CHECK(refusal("") ==
          "t.stl: byte 0: expected the 84 bytes that a binary STL file begins with, or 'solid', found the end of the file");
    const std::string two = binary(std::vector<float>(18));
    CHECK(refusal(two.substr(0, 183)) == "t.stl: byte 80: expected 2 triangles of 50 bytes, found 99 bytes");
    CHECK(refusal(two + "x") == "t.stl: byte 184: expected the end of the file after the last triangle, found 1 more byte");
    std::vector<float> bad(9);
    bad[4] = std::numeric_limits<float>::infinity();
    CHECK(refusal(binary(bad)) == "t.stl: byte 112: expected a finite y coordinate of a vertex, found inf");
    CHECK(refusal("solid\n" + facet) == "t.stl:9: expected 'facet' or 'endsolid', found the end of the file");
    CHECK(refusal("solid\n" + facet + "endsolid\nmore\n") ==
          "t.stl:10: expected 'solid' or the end of the file, found 'more'");
    CHECK(refusal("solid\nfacet normal 0 0\nouter loop\n") == "t.stl:3: expected a number of a normal, found 'outer'");
    CHECK(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n") ==
          "t.stl:4: expected the z coordinate of a vertex, found 'zero'");
    CHECK(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e39\n") ==
          "t.stl:4: expected a finite number (the z coordinate of a vertex), found '1e39'");
    CHECK(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nvertex 1 1 1\n") ==
          "t.stl:7: expected 'endloop', found 'vertex'");
    CHECK(refusal(std::string("s\0o\0l\0i\0d\0", 10)) == "t.stl: expected text in ASCII or UTF-8, found UTF-16");
}

TEST_CASE("stl: leniently, what follows is passed over and counted") {
    CHECK(leniently(binary(std::vector<float>(9)) + "abc").skipped == abut::io::skipped_parts{0, 0, 3});
    const auto read = leniently("solid\n" + facet + "endsolid\nmore of it\n");
    CHECK(read.faces.size() == 1);
    CHECK(read.skipped == abut::io::skipped_parts{0, 0, 11});
    CHECK(io_test::refusal([] { leniently(binary(std::vector<float>(18)).substr(0, 100)); }) ==
          "t.stl: byte 80: expected 2 triangles of 50 bytes, found 16 bytes");
}

}  // namespace io_test::stl_cases
