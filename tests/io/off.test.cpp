// SPDX-License-Identifier: MIT
#include <abut/io/off.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::off_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;

template <class T = double>
auto parse(const std::string& text) {
    return abut::io::parse_off<T>(text, "t.off");
}
std::string refusal(const std::string& text) {
    return io_test::refusal([&] { parse<float>(text); });
}

const std::string square = "0 0 0\n1 0 0\n1 0.1 0\n0 1 0\n";

}  // namespace

TEST_CASE("off: counts on the first line or the next, with and without edges, comments, colours") {
    for (const std::string head : {"OFF\n4 2 5\n", "OFF 4 2 5\n", "OFF\n# made by hand\n\n 4 2\n", "OFF4 2 0\r\n",
                                   "\xef\xbb\xbfOFF # x\n4 2 0 # y\n", "COFF\n4 2 0\n", "STCNOFF 4 2 0\n"}) {
        INFO(head);
        const auto read = parse(head + "0 0 0 255 0 0\n\n1 0 0 # first\n1 0.1 0\n0 1 0\n4 0 1 2 3\n3 2 1 0 0.5 0.5 0.5 1\n");
        CHECK(read.vertices == std::vector<abut::vec3<double>>{{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}, {0, 1, 0}});
        CHECK(read.faces == faces{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}});
    }
    CHECK(parse<float>("OFF\n4 0 0\n" + square).vertices[2].y == 0.1f);
    CHECK(parse("OFF\n0 0 0\n").vertices.empty());
}

TEST_CASE("off: rows may go on across lines, if all of the text fits that") {
    const std::vector<abut::vec3<double>> corners{{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}, {0, 1, 0}};
    for (const std::string text : {"OFF\n4\n2 0\n0 0\n0 1 0 0 1 0.1\n\n0 # a comment\n0 1 0 4 0 1\n2 3\n3\n2\n1\n0\n",
                                   "OFF 4 2 0 0 0 0 1 0 0 1 0.1 0 0 1 0 4 0 1 2 3 0.5 0.5 0.5\n3 2 1 0 255\n",
                                   "OFF\n4 2 0\n0 0 0 1 0 0\n1 0.1 0 0 1 0\n4 0 1 2 3\n3 2 1 0\n"}) {
        INFO(text);
        const auto read = parse(text);
        CHECK(read.vertices == corners);
        CHECK(read.faces == faces{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}});
    }
    // A number too few or too many is refused as before, by the line.
    CHECK(refusal("OFF\n4 1 0\n0 0\n1 0 0\n1 0.1 0\n0 1 0\n3 0 1 2\n") ==
          "t.off:3: expected the z coordinate of a vertex, found the end of the line");
    CHECK(refusal("COFF\n1 0 0\n0 0\n0\n") == "t.off:3: expected the z coordinate of a vertex, found the end of the line");
    const std::string short_row = "OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n";
    CHECK(io_test::refusal([&] { abut::io::parse_off<float>(short_row, "t.off", {.lenient = true}); }) ==
          "t.off:4: expected the z coordinate of a vertex, found the end of the line");
}

TEST_CASE("off: polygons that are not convex are cut") {
    const auto read = parse("OFF\n4 1 0\n0 0 0\n4 0 0\n1 1 0\n0 4 0\n4 1 2 3 0\n");
    CHECK(read.faces == faces{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("off: a polygon of too many corners that is not convex is refused with its line") {
    std::string saw = "OFF\n2000 2 0\n", face = "2000";
    for (int i = 0; i < 2000; ++i) {
        saw += std::to_string(i < 1999 ? i : 1000) + " " + std::to_string(i < 1999 ? i % 2 : -1000000) + " 0\n";
        face += " " + std::to_string(i);
    }
    CHECK(refusal(saw + "3 0 1 2\n" + face + "\n") ==
          "t.off:2004: expected polygons that are convex or have at most 1024 corners, found one with 2000");
}

TEST_CASE("off: every malformed line is refused with its number") {
    CHECK(refusal("") == "t.off:1: expected 'OFF' at the start of an OFF file, found the end of the file");
    CHECK(refusal("8 6 12\n") == "t.off:1: expected 'OFF' at the start of an OFF file, found '8'");
    CHECK(refusal("4OFF\n") == "t.off:1: expected 'OFF' at the start of an OFF file, found '4OFF'");
    CHECK(refusal("nOFF\n3\n") == "t.off:1: expected vertices of three coordinates (OFF, COFF, NOFF, STOFF), found 'n'");
    CHECK(refusal("OFF BINARY\n") == "t.off:1: expected OFF as text, found 'BINARY'");
    CHECK(refusal("OFF\n4 x 0\n") == "t.off:2: expected the number of faces, up to 2147483647, found 'x'");
    CHECK(refusal("OFF\n4000000000 1 0\n") ==
          "t.off:2: expected the number of vertices, up to 2147483647, found '4000000000'");
    CHECK(refusal("OFF\n2000000000 1 0\n0 0 0\n") ==
          "t.off:3: expected 2000000000 vertices, at least 6 bytes each, found 6 bytes");
    CHECK(refusal("OFF\n1 100000000 0\n0 0 0\n3 0 0 0\n") ==
          "t.off:4: expected 100000000 faces, at least 8 bytes each, found 8 bytes");
    CHECK(refusal("OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n") ==
          "t.off:4: expected the z coordinate of a vertex, found the end of the line");
    CHECK(refusal("OFF\n4 1 0\n0 0 0 red\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n") ==
          "t.off:3: expected a number or the end of the line, found 'red'");
    CHECK(refusal("OFF\n1 1 0\n0 nan 0\n3 0 0 0\n") ==
          "t.off:3: expected a finite number (the y coordinate of a vertex), found 'nan'");
    CHECK(refusal("OFF\n4 1 0\n" + square + "3 0 1 4\n") == "t.off:7: expected a vertex index below 4, found '4'");
    CHECK(refusal("OFF\n4 1 0\n" + square + "3 0 1 -1\n") == "t.off:7: expected a vertex index, found '-1'");
    CHECK(refusal("OFF\n4 1 0\n" + square + "4 0 1 2\n") == "t.off:7: expected a vertex index, found the end of the line");
    CHECK(refusal("OFF\n4 1 0\n" + square + "2 0 1 2 3\n") == "t.off:7: expected a face of at least 3 corners, found '2'");
    CHECK(refusal("OFF\n4 1 0\n" + square + "3 0 1 2\n3 0 1 2\n") ==
          "t.off:8: expected the end of the file after the last face, found '3'");
    CHECK(refusal(std::string("\xff\xfeO\0", 4)) == "t.off: expected text in ASCII or UTF-8, found UTF-16");
}

TEST_CASE("off: leniently, faces of two corners and rows too many are passed over and counted") {
    const std::string text = "OFF\n4 3 0\n" + square + "2 0 1\n3 0 1 2\n1 3\n3 0 1 3\n";
    const auto read = abut::io::parse_off<float>(text, "t.off", {.lenient = true});
    CHECK(read.faces == faces{{0, 1, 2}});
    CHECK(read.skipped == abut::io::skipped_parts{2, 0, 8});
}

}  // namespace io_test::off_cases
