// SPDX-License-Identifier: MIT
#include <abut/io/csv.hpp>

#include <string>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::csv_cases {

namespace {

template <class T = double>
auto spheres(const std::string& text) {
    return abut::io::parse_spheres<T>(text, "t.csv");
}
template <class T = double>
auto centers(const std::string& text) {
    return abut::io::parse_centers<T>(text, "t.csv");
}
std::string refusal(const std::string& text) {
    return io_test::refusal([&] { spheres<float>(text); });
}
std::string refusal_of_centers(const std::string& text) {
    return io_test::refusal([&] { centers<float>(text); });
}

}  // namespace

TEST_CASE("csv: with and without a header, blanks, comments, every end of line") {
    for (const std::string header : {"", "x,y,z,r\n", "X, Y ,Z,Radius\n", "\"x\",\"y\",\"z\",\"r\"\n",
                                     "cx [m],cy [m],cz [m],size\n", "# x,y,z,r\n\n", "\xef\xbb\xbfx,y,z,r\n"}) {
        for (const std::string end : {"\n", "\r\n", "\r"}) {
            std::string text = header + "1,2,3,4\n\n \t\n# more\n -1.5 ,\t+2e3 , .5,0\t\n0,0,0,0.25";
            for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += end.size()) text.replace(i, 1, end);
            INFO(text);
            const auto read = spheres(text);
            REQUIRE(read.size() == 3);
            CHECK(read[0].center == abut::vec3<double>{1, 2, 3});
            CHECK(read[0].radius == 4);
            CHECK(read[1].center == abut::vec3<double>{-1.5, 2000, 0.5});
            CHECK(read[1].radius == 0);
            CHECK(read[2].radius == 0.25);
        }
    }
}

TEST_CASE("csv: three columns are centers") {
    CHECK(centers("x,y,z\n1,2,3\n4,5,6\n") == std::vector<abut::vec3<double>>{{1, 2, 3}, {4, 5, 6}});
    CHECK(centers("1,2,3") == std::vector<abut::vec3<double>>{{1, 2, 3}});
}

TEST_CASE("csv: nothing is no spheres") {
    CHECK(spheres("").empty());
    CHECK(spheres("x,y,z,r\n").empty());
    CHECK(spheres("\n\n# nothing\n").empty());
}

TEST_CASE("csv: numbers are rounded once") {
    const std::string text = "0.1,1.000000059604644775390625000001,1e-60,1e-45\n";
    const auto read = spheres<float>(text);
    CHECK(read[0].center == abut::vec3<float>{0.1f, 0x1.000002p0f, 0.0f});
    CHECK(read[0].radius == 0x1p-149f);
    CHECK(spheres<double>(text)[0].center.x == 0.1);
}

TEST_CASE("csv: every malformed line is refused with its number") {
    CHECK(refusal("1,2,3\n") ==
          "t.csv:1: expected 4 columns x,y,z,r, found 3 (spheres of one radius: read_equal_spheres(path, radius))");
    CHECK(refusal("x,y,z\n") ==
          "t.csv:1: expected 4 columns x,y,z,r, found 3 (spheres of one radius: read_equal_spheres(path, radius))");
    CHECK(refusal("1,2,3,4\n1,2\n") == "t.csv:2: expected 4 columns x,y,z,r, found 2");
    CHECK(refusal("1,2,3,4,5\n") == "t.csv:1: expected 4 columns x,y,z,r, found more");
    CHECK(refusal("x,y,z,r,name\n") == "t.csv:1: expected 4 columns x,y,z,r, found more");
    CHECK(refusal_of_centers("1,2,3,4\n") ==
          "t.csv:1: expected 3 columns x,y,z, found 4 (spheres with radii of their own: read_spheres(path))");
    CHECK(refusal_of_centers("x,y,z,r\n") ==
          "t.csv:1: expected 3 columns x,y,z, found 4 (spheres with radii of their own: read_spheres(path))");
    CHECK(refusal_of_centers("1,2\n") == "t.csv:1: expected 3 columns x,y,z, found 2");
    CHECK(refusal("id,x,y,z\n0,1,2,3\n") == "t.csv:1: expected the columns x,y,z,r, found 'x' as column 2");
    CHECK(refusal("r,x,y,z\n0,1,2,3\n") == "t.csv:1: expected the columns x,y,z,r, found 'r' as column 1");
    CHECK(refusal("n/a,1,2,3\n") == "t.csv:1: expected either names of columns or numbers, found '1' among names");
    CHECK(refusal("1,2,3,4\nx,y,z,r\n") == "t.csv:2: expected the x coordinate of a center, found 'x'");
    CHECK(refusal("1,2,foo,4\n") == "t.csv:1: expected the z coordinate of a center, found 'foo'");
    CHECK(refusal("1.2.3,2,3,4\n") == "t.csv:1: expected the x coordinate of a center, found '1.2.3'");
    CHECK(refusal("-,2,3,4\n") == "t.csv:1: expected the x coordinate of a center, found '-'");
    CHECK(refusal("\n\n1,,3,4\n") == "t.csv:3: expected the y coordinate of a center, found ','");
    CHECK(refusal("1,2,3,\n") == "t.csv:1: expected the radius of a sphere, found the end of the line");
    CHECK(refusal("1,2,3,") == "t.csv:1: expected the radius of a sphere, found the end of the file");
    CHECK(refusal("1;2;3;4\n") == "t.csv:1: expected the x coordinate of a center, found '1;2;3;4'");
    CHECK(refusal("1 2 3 4\n") == "t.csv:1: expected ',' after the x coordinate of a center, found '2'");
    CHECK(refusal("1,2,3,4 5\n") == "t.csv:1: expected the end of the line, found '5'");
    CHECK(refusal("nan,0,0,1\n") == "t.csv:1: expected a finite number (the x coordinate of a center), found 'nan'");
    CHECK(refusal("0,0,0,inf\n") == "t.csv:1: expected a finite number (the radius of a sphere), found 'inf'");
    CHECK(refusal("0,0,0,1e39\n") == "t.csv:1: expected a finite number (the radius of a sphere), found '1e39'");
    CHECK(refusal("0,0,0,-0.5\n") == "t.csv:1: expected a radius of 0 or more, found -0.5");
    CHECK(refusal(std::string("1,2,3,\0\n", 8)) == "t.csv:1: expected the radius of a sphere, found '\\x00'");
}

}  // namespace io_test::csv_cases
