// SPDX-License-Identifier: MIT
#include <abut/io/ply.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::ply_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;
using points = std::vector<abut::vec3<double>>;

template <class T = double>
auto parse(const std::string& data) {
    return abut::io::parse_ply<T>(data, "t.ply");
}
template <class T = float>
std::string refusal(const std::string& data) {
    return io_test::refusal([&] { parse<T>(data); });
}

/// Bytes of a PLY file, in either order.
class bytes {
public:
    explicit bytes(std::string header, bool big) : data_(std::move(header)), big_(big) {}
    template <class V>
    bytes& put(V value) {
        char raw[sizeof(V)];
        std::memcpy(raw, &value, sizeof value);
        if (big_ == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof raw);
        data_.append(raw, sizeof raw);
        return *this;
    }
    bytes& put_real(const std::string& type, double value) {
        if (type == "char" || type == "int8") return put(static_cast<std::int8_t>(value));
        if (type == "uchar" || type == "uint8") return put(static_cast<std::uint8_t>(value));
        if (type == "short" || type == "int16") return put(static_cast<std::int16_t>(value));
        if (type == "ushort" || type == "uint16") return put(static_cast<std::uint16_t>(value));
        if (type == "int" || type == "int32") return put(static_cast<std::int32_t>(value));
        if (type == "uint" || type == "uint32") return put(static_cast<std::uint32_t>(value));
        if (type == "float" || type == "float32") return put(static_cast<float>(value));
        return put(value);
    }
    [[nodiscard]] const std::string& data() const { return data_; }

private:
    std::string data_;
    bool big_;
};

const std::string ascii_head = "ply\nformat ascii 1.0\n";
std::string vertices(int count, const std::string& type = "float") {
    return "element vertex " + std::to_string(count) + "\nproperty " + type + " x\nproperty " + type + " y\nproperty " +
           type + " z\n";
}
std::string list(int count) {
    return "element face " + std::to_string(count) + "\nproperty list uchar int vertex_indices\n";
}
const std::string end = "end_header\n";
const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string binary_head(bool big) { return std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n"; }

}  // namespace

TEST_CASE("ply: ASCII, with more elements and properties than are used") {
    std::string text = io_test::content(io_test::seeds() / "ply/ascii.ply");
    for (const bool crlf : {false, true}) {
        if (crlf) text = io_test::content(io_test::seeds() / "ply/ascii_crlf.ply");
        REQUIRE(text.size() > 100);
        const auto mesh = parse(text);
        CHECK(mesh.vertices == points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}});
        CHECK(mesh.faces == faces{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}});
    }
}

TEST_CASE("ply: binary in both byte orders, every type, faces before vertices") {
    const std::vector<std::string> reals{"char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
                                         "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
    for (const bool big : {false, true}) {
        for (std::size_t i = 0; i < reals.size(); ++i) {
            const std::string real = reals[i];
            const std::string count = reals[(i + 3) % 6], index = reals[8 + (i + 1) % 6];  // integers of both spellings
            const std::string end_of_line = i % 2 == 0 ? "\n" : "\r\n";
            std::string header =
                binary_head(big) + "comment none\nobj_info none\nelement face 2\nproperty float weight\nproperty list " +
                count + " " + index + (i % 3 == 0 ? " vertex_index\n" : " vertex_indices\n") +
                "property list uchar double more\nelement other 3\nproperty list ushort short s\nelement nothing 7\n" +
                "element vertex 4\nproperty " + real + " z\nproperty uchar between\nproperty " + real +
                " x\nproperty list char int skipped\nproperty " + real + " y\n" + end;
            if (i % 2 == 1) {
                for (std::size_t at = 0; (at = header.find('\n', at)) != header.npos; at += 2) header.replace(at, 1, "\r\n");
            }
            bytes file(header, big);
            file.put(1.5f);
            file.put_real(count, 3).put_real(index, 0).put_real(index, 1).put_real(index, 3);
            file.put(std::uint8_t{0});
            file.put(2.5f);
            file.put_real(count, 4).put_real(index, 3).put_real(index, 2).put_real(index, 1).put_real(index, 0);
            file.put(std::uint8_t{2}).put(1.0).put(std::numeric_limits<double>::quiet_NaN());
            for (std::uint16_t n = 0; n < 3; ++n) {
                file.put(n);
                for (std::uint16_t k = 0; k < n; ++k) file.put(std::int16_t{-1});
            }
            for (const auto& p : points{{0, 0, 0}, {10, 0, 1}, {10, 100, 2}, {0, 100, 3}}) {
                file.put_real(real, p.z).put(std::uint8_t{9}).put_real(real, p.x);
                file.put(std::int8_t{1}).put(7);
                file.put_real(real, p.y);
            }
            INFO(real << " " << count << " " << index << " big " << big);
            const auto mesh = parse(file.data());
            CHECK(mesh.vertices == points{{0, 0, 0}, {10, 0, 1}, {10, 100, 2}, {0, 100, 3}});
            CHECK(mesh.faces == faces{{0, 1, 3}, {3, 2, 1}, {3, 1, 0}});
            CHECK(parse<float>(file.data()).faces == mesh.faces);
            // However short the file is cut, there is an error that names the byte, or the header's line.
            for (std::size_t size = 0; size < file.data().size(); ++size) {
                const std::string message = refusal(file.data().substr(0, size));
                CHECK(message.find("expected") != message.npos);
                if (size >= header.size()) CHECK(message.rfind("t.ply: byte ", 0) == 0);
            }
            CHECK(refusal(file.data() + "x") == "t.ply: byte " + std::to_string(file.data().size()) +
                                                    ": expected the end of the file after the last row, found 1 more byte");
        }
    }
}

TEST_CASE("ply: header lines may end with CR alone") {
    std::string text = ascii_head + vertices(3) + list(1) + end + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    for (char& c : text) {
        if (c == '\n') c = '\r';
    }
    CHECK(parse(text).faces == faces{{0, 1, 2}});
}

TEST_CASE("ply: positions round once, from text or from double") {
    const std::string text =
        ascii_head + vertices(1, "double") + list(0) + end + "0.1 1.000000059604644775390625000001 -1e-320\n";
    CHECK(parse<double>(text).vertices[0] == abut::vec3<double>{0.1, 1.000000059604644775390625, -1e-320});
    CHECK(parse<float>(text).vertices[0] == abut::vec3<float>{0.1f, 0x1.000002p0f, 0.0f});
    bytes file(binary_head(false) + vertices(1, "double") + list(0) + end, false);
    file.put(0.1).put(0x1.fffffefffffffp127).put(-1e-320);
    CHECK(parse<float>(file.data()).vertices[0] == abut::vec3<float>{0.1f, std::numeric_limits<float>::max(), 0.0f});
    CHECK(parse<double>(file.data()).vertices[0].y == 0x1.fffffefffffffp127);
}

TEST_CASE("ply: a nonconvex polygon is cut, a convex one is a fan") {
    const std::string text = ascii_head + vertices(4) + list(2) + end + "0 0 0\n4 0 0\n1 1 0\n0 4 0\n4 1 2 3 0\n4 0 1 2 3\n";
    const auto mesh = parse(text);
    for (const auto& f : mesh.faces)
        CHECK((std::count(f.begin(), f.end(), 0u) == 1 && std::count(f.begin(), f.end(), 2u) == 1));
    CHECK(parse(ascii_head + vertices(4) + list(1) + end + square + "4 0 1 2 3\n").faces == faces{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("ply: a polygon of too many corners that is not convex is refused with its line or byte") {
    const std::string properties =
        "element vertex 2000\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
        "property list ushort int vertex_indices\nend_header\n";
    std::string text = "ply\nformat ascii 1.0\n" + properties, face = "2000";
    bytes binary("ply\nformat binary_little_endian 1.0\n" + properties, false);
    const std::size_t header = binary.data().size();
    for (int i = 0; i < 2000; ++i) {
        const int x = i < 1999 ? i : 1000, y = i < 1999 ? i % 2 : -1000000;
        text += std::to_string(x) + " " + std::to_string(y) + " 0\n";
        face += " " + std::to_string(i);
        binary.put(static_cast<float>(x)).put(static_cast<float>(y)).put(0.0f);
    }
    binary.put(std::uint16_t{3}).put(0).put(1).put(2).put(std::uint16_t{2000});
    for (int i = 0; i < 2000; ++i) binary.put(i);
    const std::string what = "expected polygons that are convex or have at most 1024 corners, found one with 2000";
    CHECK(refusal(text + "3 0 1 2\n" + face + "\n") == "t.ply:2011: " + what);
    CHECK(refusal(binary.data()) == "t.ply: byte " + std::to_string(header + 24000 + 14) + ": " + what);
}

TEST_CASE("ply: empty meshes are legal") {
    const auto mesh = parse(ascii_head + vertices(0) + list(0) + end);
    CHECK(mesh.vertices.empty());
    CHECK(mesh.faces.empty());
}

TEST_CASE("ply: a promise that the file cannot keep allocates nothing") {
    const std::string many = "element vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string binary = binary_head(false) + many + list(1) + end;
    CHECK(refusal(binary + std::string(40, '\0')) ==
          "t.ply: byte " + std::to_string(binary.size()) +
              ": expected 4294967295 rows of element 'vertex', at least 12 bytes each, found 40 bytes");
    CHECK(refusal(ascii_head + many + list(1) + end + "0 0 0\n") ==
          "t.ply:10: expected 4294967295 rows of element 'vertex', at least 6 bytes each, found 6 bytes");
    const std::string faces =
        binary_head(false) + vertices(0) + "element face 18446744073709551615\nproperty list int int vertex_index\n";
    CHECK(refusal(faces + end + "1234") ==
          "t.ply: byte " + std::to_string((faces + end).size()) +
              ": expected 18446744073709551615 rows of element 'face', at least 4 bytes each, "
              "found 4 bytes");
    const std::string head =
        binary_head(false) + vertices(0) + "element face 1\nproperty list uint int vertex_indices\n" + end;
    CHECK(refusal(bytes(head, false).put(std::uint32_t{4000000000}).put(0).data()) ==
          "t.ply: byte " + std::to_string(head.size() + 4) +
              ": expected a list of 4000000000 values of 4 bytes, found 4 bytes");
    CHECK(refusal(ascii_head + "element vertex 4294967296\nproperty int x\nproperty int y\nproperty int z\n" + list(0) +
                  end) == "t.ply:9: expected at most 4294967295 vertices, found 4294967296");
}

TEST_CASE("ply: a header of very many properties is read in time") {
    std::string header = ascii_head + "element vertex 0\n";
    for (int i = 0; i < 120'000; ++i) header += "property float p" + std::to_string(i) + "\n";
    header += "property float x\nproperty float y\nproperty float z\nelement face 0\n";
    header += "property list uchar int vertex_indices\nend_header\n";
    const auto begin = std::chrono::steady_clock::now();
    CHECK(parse(header).vertices.empty());
    // Its names were once compared all with all, which took 16 s.
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(5));
}

TEST_CASE("ply: every malformed header is refused with its line") {
    const std::string rest = vertices(3) + list(1) + end;
    CHECK(refusal("") == "t.ply:1: expected 'ply' in the first line of a PLY file, found the end of the file");
    CHECK(refusal("plyx\n") == "t.ply:1: expected 'ply' in the first line of a PLY file, found 'plyx'");
    CHECK(refusal("ply\n") == "t.ply:2: expected 'end_header', found the end of the file");
    CHECK(refusal("ply\n" + rest) == "t.ply:8: expected a format line before 'end_header', found 'end_header'");
    CHECK(refusal("ply\nformat ascii 2.0\n") == "t.ply:2: expected version 1.0, found '2.0'");
    CHECK(refusal("ply\nformat text 1.0\n") ==
          "t.ply:2: expected format ascii, binary_little_endian or binary_big_endian, found 'text'");
    CHECK(refusal(ascii_head + "format ascii 1.0\n") == "t.ply:3: expected one format line, found 'format'");
    CHECK(refusal(ascii_head + "format\n" + rest).rfind("t.ply:3: ", 0) == 0);
    CHECK(refusal(ascii_head + "element vertex 3\nelements vertex 3\n") ==
          "t.ply:4: expected a line of a PLY header (format, element, property, comment, end_header), found 'elements'");
    CHECK(refusal(ascii_head + "element vertex -3\n") == "t.ply:3: expected the number of elements, found '-3'");
    CHECK(refusal(ascii_head + "element vertex 3 4\n") == "t.ply:3: expected the end of the line, found '4'");
    CHECK(refusal(ascii_head + "element\nx") == "t.ply:3: expected the name of an element, found the end of the line");
    CHECK(refusal(ascii_head + "element a 1\nelement a 2\n") == "t.ply:4: expected elements of different names, found 'a'");
    CHECK(refusal(ascii_head + "property int x\n") ==
          "t.ply:3: expected an element before its properties, found 'property'");
    CHECK(refusal(ascii_head + "element a 1\nproperty int64 x\n") ==
          "t.ply:4: expected a type (char, uchar, short, ushort, int, uint, float, double), found 'int64'");
    CHECK(refusal(ascii_head + "element a 1\nproperty list float int x\n") ==
          "t.ply:4: expected an integer type for the length of a list, found 'float'");
    CHECK(refusal(ascii_head + "element a 1\nproperty int\nx") ==
          "t.ply:4: expected the name of a property, found the end of the line");
    CHECK(refusal(ascii_head + "element a 1\nproperty int x\nproperty int x\n") ==
          "t.ply:5: expected properties of different names, found 'x'");
    CHECK(refusal(ascii_head + list(0) + end) ==
          "t.ply:5: expected an element 'vertex' in the header of a mesh, found 'end_header'");
    CHECK(refusal(ascii_head + "element vertex 1\nproperty int x\nproperty int y\n" + end) ==
          "t.ply:6: expected a scalar property 'z' of 'vertex' in the header of a mesh, found 'end_header'");
    CHECK(refusal(ascii_head + vertices(1) + "element face 1\nproperty list uchar float vertex_indices\n" + end) ==
          "t.ply:9: expected a list of integers 'vertex_indices' of 'face' in the header of a mesh, found 'end_header'");
    CHECK(refusal(ascii_head + vertices(1) + list(1) + "property list uchar int vertex_index\n" + end) ==
          "t.ply:10: expected one of 'vertex_indices' and 'vertex_index', not both, in the header of a mesh, found "
          "'end_header'");
    CHECK(
        refusal(ascii_head + vertices(1) + "element tristrips 1\nproperty list int float vertex_indices\n" + end) ==
        "t.ply:9: expected a list of integers 'vertex_indices' of 'tristrips' in the header of a mesh, found 'end_header'");
}

TEST_CASE("ply: comments that lack their keyword, where no element can be meant") {
    const std::string rest = vertices(3) + list(1) + end + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    CHECK(parse(ascii_head + "made by hand\n\n" + rest).faces.size() == 1);
    CHECK(parse(ascii_head + vertices(3) + "comment a long one\nthat goes on\nand on\n" + list(1) + end +
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
              .faces.size() == 1);
    // Before the format, or where a property is misspelt, it is none.
    CHECK(refusal("ply\nmade by hand\nformat ascii 1.0\n" + rest).starts_with("t.ply:2: expected a line of a PLY header"));
    CHECK(
        refusal(ascii_head + "element vertex 3\npropery float w\n").starts_with("t.ply:4: expected a line of a PLY header"));
    CHECK(refusal(ascii_head + "comment x\nelement vertex 3\n\npropery float w\n").starts_with("t.ply:6: expected a line"));
}

TEST_CASE("ply: a file without faces is a cloud of points") {
    const auto cloud = parse(ascii_head + vertices(2) + "property float nx\n" + end + "1 2 3 0\n4 5 6 0\n");
    CHECK(cloud.vertices == points{{1, 2, 3}, {4, 5, 6}});
    CHECK(cloud.faces.empty());
}

TEST_CASE("ply: triangle strips, with restarts") {
    const std::string strips = "element tristrips 2\nproperty list int int vertex_indices\n";
    const std::string rows = "9 0 1 2 3 -1 3 2 1 -1\n6 0 1 1 2 3 4\n";
    const auto read = parse(ascii_head + vertices(5) + strips + end + square + "2 2 2\n" + rows);
    // The second strip goes through vertex 1 twice: its first two triangles have no three corners, and they count for the
    // turns of the others.
    CHECK(read.faces == faces{{0, 1, 2}, {2, 1, 3}, {3, 2, 1}, {1, 2, 3}, {3, 2, 4}});
    bytes binary(binary_head(false) + vertices(3) + "element tristrips 1\nproperty list uchar int vertex_indices\n" + end,
                 false);
    for (int i = 0; i < 9; ++i) binary.put(static_cast<float>(i));
    CHECK(parse(binary.put('\5').put(0).put(1).put(2).put(-1).put(0).data()).faces == faces{{0, 1, 2}});
    CHECK(refusal(ascii_head + vertices(4) + strips + end + square + "3 0 1 -2\n")
              .find("expected a vertex index below 4, found '-2'") != std::string::npos);
    CHECK(refusal(ascii_head + vertices(4) + list(1) + end + square + "3 0 1 -1\n").find("found '-1'") != std::string::npos);
}

TEST_CASE("ply: leniently, long rows, rows too many and faces of two corners are passed over and counted") {
    const auto lenient = [](const std::string& data) {
        return abut::io::parse_ply<double>(data, "t.ply", {.lenient = true});
    };
    const auto read = lenient(ascii_head + vertices(4) + list(4) + end + "0 0 0 9\n1 0 0\n1 1 0 nonsense\n0 1 0\n" +
                              "3 0 1 2 255 0 0\n2 0 1\n0\n3 0 2 3\n3 1 2 3\n\n4 5\n");
    CHECK(read.faces == faces{{0, 1, 2}, {0, 2, 3}});
    CHECK(read.skipped == abut::io::skipped_parts{2, 3, 13});
    bytes binary(binary_head(true) + vertices(1) + list(2) + end, true);
    binary.put(1.0f).put(2.0f).put(3.0f).put('\2').put(0).put(0).put('\3').put(0).put(0).put(0).put('x');
    CHECK(lenient(binary.data()).faces == faces{{0, 0, 0}});
    CHECK(lenient(binary.data()).skipped == abut::io::skipped_parts{1, 0, 1});
    CHECK(parse(ascii_head + vertices(1) + list(0) + end + "1 2 3\n").skipped == abut::io::skipped_parts{});
    // What is missing or wrong is refused all the same.
    const auto message = [&](const std::string& data) { return io_test::refusal([&] { lenient(data); }); };
    CHECK(message(ascii_head + vertices(1) + list(0) + end + "100 200\n") ==
          "t.ply:10: expected the z coordinate of a vertex, found the end of the line");
    CHECK(message(ascii_head + vertices(1) + list(1) + end + "1 2 3\n2 0 7\n") ==
          "t.ply:11: expected a vertex index below 1, found '7'");
}

TEST_CASE("ply: UTF-16 is named") {
    const std::string expected = "t.ply: expected text in ASCII or UTF-8, found UTF-16";
    CHECK(refusal(std::string("\xff\xfep\0l\0y\0", 8)) == expected);
    CHECK(refusal(std::string("\xfe\xff\0p\0l\0y", 8)) == expected);
    CHECK(refusal(std::string("p\0l\0y\0", 6)) == expected);
    CHECK(refusal(std::string("\0p\0l\0y", 6)) == expected);
}

TEST_CASE("ply: every malformed row of text is refused with its line") {
    const std::string head = ascii_head + vertices(4) + list(1) + end;  // rows of vertices from line 10 on
    CHECK(refusal(head + "0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n") ==
          "t.ply:11: expected the z coordinate of a vertex, found the end of the line");
    CHECK(refusal(head + "0 0 0\n1 0 0 7\n1 1 0\n0 1 0\n3 0 1 2\n") == "t.ply:11: expected the end of the line, found '7'");
    CHECK(refusal(head + "0 0 0\n1 0 inf\n1 1 0\n0 1 0\n3 0 1 2\n") ==
          "t.ply:11: expected a finite number (the z coordinate of a vertex), found 'inf'");
    CHECK(refusal(head + square + "3 0 1 4\n") == "t.ply:14: expected a vertex index below 4, found '4'");
    CHECK(refusal(head + square + "3 0 1 -1\n") == "t.ply:14: expected a vertex index below 4, found '-1'");
    CHECK(refusal(head + square + "3 0 1 1.0\n") == "t.ply:14: expected a vertex index, found '1.0'");
    CHECK(refusal(head + square + "3 0 1 3000000000\n") ==
          "t.ply:14: expected a vertex index from -2147483648 to 2147483647, found '3000000000'");
    CHECK(refusal(head + square + "2 0 1\n") == "t.ply:14: expected a face of at least 3 corners, found '2'");
    CHECK(refusal(head + square + "3 0 1\n") == "t.ply:14: expected a vertex index, found the end of the line");
    CHECK(refusal(head + square + "256 0 1\n") ==
          "t.ply:14: expected the number of corners of a face from 0 to 255, found '256'");
    CHECK(refusal(head + square + "4 0 1 2 3\n\n3 0 1 2\n") ==
          "t.ply:16: expected the end of the file after the last row, found '3'");
    CHECK(refusal(head + "0 0 0\n1 0 0\n1 1 0" + std::string(10, ' ') + "\n") ==
          "t.ply:13: expected the x coordinate of a vertex, found the end of the file");
    CHECK(refusal(ascii_head + vertices(1, "short") + list(0) + end + "1 40000 0\n") ==
          "t.ply:10: expected the y coordinate of a vertex from -32768 to 32767, found '40000'");
    const std::string more = ascii_head + vertices(1) + "property uchar tag\nproperty list char int tags\n" + list(0) + end;
    CHECK(refusal(more + "0 0 0 x 0\n") == "t.ply:12: expected a number for the property 'tag', found 'x'");
    CHECK(refusal(more + "0 0 0 1 -2\n") == "t.ply:12: expected the length of a list, found '-2'");
    CHECK(refusal(more + "0 0 0 1 2 1\n") ==
          "t.ply:12: expected a number for the property 'tags', found the end of the line");
}

TEST_CASE("ply: every malformed value in binary is refused with its byte") {
    const std::string head = binary_head(true) + vertices(1, "double") + list(1) + end;
    const auto at = [&](std::size_t byte) { return "t.ply: byte " + std::to_string(head.size() + byte) + ": "; };
    const auto nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal(bytes(head, true).put(0.0).put(nan).put(0.0).put('\3').put(0).put(0).put(0).data()) ==
          at(8) + "expected a finite y coordinate of a vertex, found nan");
    const auto large = bytes(head, true).put(0.0).put(0.0).put(-1e39).put('\3').put(0).put(0).put(0).data();
    CHECK(refusal<float>(large) == at(16) + "expected a finite z coordinate of a vertex, found -1e+39");
    CHECK(refusal<double>(large) == "accepted");
    CHECK(refusal(bytes(head, true).put(0.0).put(0.0).put(0.0).put('\3').put(0).put(1).put(0).data()) ==
          at(29) + "expected a vertex index below 1, found 1");
    CHECK(refusal(bytes(head, true).put(0.0).put(0.0).put(0.0).put('\3').put(0).put(-2).put(0).data()) ==
          at(29) + "expected a vertex index below 1, found -2");
    CHECK(refusal(bytes(head, true).put(0.0).put(0.0).put(0.0).put('\2').put(0).put(0).put(0).data()) ==
          at(24) + "expected a face of at least 3 corners, found 2");
    CHECK(refusal(bytes(head, true).put(0.0).put(0.0).put(0.0).data()) ==
          at(24) + "expected 1 rows of element 'face', at least 1 byte each, found 0 bytes");
    CHECK(refusal(bytes(head, true).put(0.0).put(0.0).put(0.0).put('\3').put(0).put(0).put('\0').data()) ==
          at(25) + "expected a list of 3 values of 4 bytes, found 9 bytes");
}

}  // namespace io_test::ply_cases
