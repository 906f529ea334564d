// SPDX-License-Identifier: MIT
#include <abut/io/write_vtp.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::write_vtp_cases {

// A small reader of what is written here: elements and attributes by plain search, base64 by table.

namespace {

using attributes = std::map<std::string, std::string>;

struct data_array {
    attributes head;
    std::string bytes;  // without the count before them
    bool count_is_right = false;

    template <class V>
    [[nodiscard]] std::vector<V> as() const {
        std::vector<V> values(bytes.size() / sizeof(V));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(V));
        return values;
    }
};

std::string decoded(std::string_view text) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bool well_formed = text.size() % 4 == 0;
    std::string bytes;
    for (std::size_t i = 0; i + 4 <= text.size(); i += 4) {
        std::uint32_t group = 0;
        std::size_t padding = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const bool pads = text[i + k] == '=';
            const auto digit = pads ? 0 : digits.find(text[i + k]);
            well_formed = well_formed && digit != digits.npos && (pads ? i + 4 == text.size() : padding == 0);
            padding += pads ? 1 : 0;
            group = group << 6 | static_cast<std::uint32_t>(digit & 63);
        }
        for (std::size_t k = 0; k < 3 - std::min<std::size_t>(padding, 2); ++k) {
            bytes += static_cast<char>(group >> (16 - 8 * k) & 255);
        }
        well_formed = well_formed && padding <= 2;
    }
    CHECK(well_formed);
    return bytes;
}

attributes attributes_of(std::string_view tag) {
    attributes found;
    for (std::size_t at = 0; (at = tag.find("=\"", at)) != tag.npos;) {
        const std::size_t start = tag.rfind(' ', at) + 1, end = tag.find('"', at + 2);
        found[std::string(tag.substr(start, at - start))] = std::string(tag.substr(at + 2, end - at - 2));
        at = end;
    }
    return found;
}

/// The start of an element and what is between it and its end.
std::pair<attributes, std::string> element(const std::string& text, const std::string& name) {
    const std::size_t start = text.find("<" + name), inner = text.find('>', start) + 1, end = text.find("</" + name + ">");
    REQUIRE(start != text.npos);
    REQUIRE(end != text.npos);
    return {attributes_of(std::string_view(text).substr(start, inner - start)), text.substr(inner, end - inner)};
}

std::vector<data_array> arrays(const std::string& text) {
    std::vector<data_array> all;
    for (std::string rest = text; rest.find("<DataArray") != rest.npos;) {
        const auto [head, content] = element(rest, "DataArray");
        data_array array{head, decoded(content), false};
        REQUIRE(array.bytes.size() >= 8);
        std::uint64_t count = 0;
        std::memcpy(&count, array.bytes.data(), 8);
        array.bytes.erase(0, 8);
        array.count_is_right = count == array.bytes.size();
        all.push_back(array);
        rest = rest.substr(rest.find("</DataArray>") + 1);
    }
    return all;
}

template <class T>
std::vector<T> flat(const std::vector<abut::vec3<T>>& points) {
    std::vector<T> numbers;
    for (const auto& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

template <class V>
bool same_bits(const std::vector<V>& a, const std::vector<V>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(V)) == 0;
}

const std::vector<abut::vec3<float>> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<abut::face> halves{{0, 1, 2}, {0, 2, 3}};

}  // namespace

TEMPLATE_TEST_CASE("write_vtp: what is written is there bit for bit", "", float, double) {
    if (std::endian::native == std::endian::big) ABUT_SKIP("order of bytes", "the test reads little-endian numbers");
    using T = TestType;
    const io_test::scratch folder;
    using limits = std::numeric_limits<T>;
    const std::vector<abut::vec3<T>> vertices{{T(0.1), limits::max(), limits::denorm_min()},
                                              {-limits::max(), T(-0.0), limits::min()},
                                              {1, 3 * limits::denorm_min(), 3},
                                              {4, 5, 6}};
    const std::vector<abut::face> faces{{0, 1, 2}, {3, 3, 3}, {2, 1, 3}};
    const std::vector<std::uint8_t> hit{0, 7, 1};
    const std::vector<float> depth{0.5f, 1, std::numeric_limits<float>::denorm_min()};
    const std::vector<std::int32_t> group{-1, 2, 3};
    const std::vector<double> time{0.25, 1, 3};
    const std::vector<std::uint32_t> id{1, 4000000000, 0, 9};
    abut::io::write_vtp(folder / "a.vtp", abut::mesh<T>{vertices, faces},
                        {.hit = hit,
                         .face_properties = {{"depth", depth}, {"group", group}, {"a<b&\"c\">", time}},
                         .vertex_properties = {{"id", id}}});
    const std::string text = io_test::content(folder / "a.vtp"), real = sizeof(T) == 4 ? "Float32" : "Float64";
    CHECK(text.starts_with("<?xml version=\"1.0\"?>\n<VTKFile "));
    CHECK(element(text, "VTKFile").first ==
          attributes{{"type", "PolyData"}, {"version", "1.0"}, {"byte_order", "LittleEndian"}, {"header_type", "UInt64"}});
    CHECK(element(text, "Piece").first == attributes{{"NumberOfPoints", "4"},
                                                     {"NumberOfVerts", "0"},
                                                     {"NumberOfLines", "0"},
                                                     {"NumberOfStrips", "0"},
                                                     {"NumberOfPolys", "3"}});
    for (const data_array& a : arrays(text)) {
        CHECK(a.count_is_right);
        CHECK(a.head.at("format") == "binary");
    }
    const auto points = arrays(element(text, "Points").second);
    REQUIRE(points.size() == 1);
    CHECK(points[0].head.at("type") == real);
    CHECK(points[0].head.at("NumberOfComponents") == "3");
    CHECK(same_bits(points[0].template as<T>(), flat(vertices)));

    const auto polygons = arrays(element(text, "Polys").second);
    REQUIRE(polygons.size() == 2);
    CHECK(polygons[0].head.at("Name") == "connectivity");
    CHECK(polygons[0].head.at("type") == "Int32");
    CHECK(polygons[0].template as<std::int32_t>() == std::vector<std::int32_t>{0, 1, 2, 3, 3, 3, 2, 1, 3});
    CHECK(polygons[1].head.at("Name") == "offsets");
    CHECK(polygons[1].head.at("type") == "Int32");
    CHECK(polygons[1].template as<std::int32_t>() == std::vector<std::int32_t>{3, 6, 9});

    const auto [cell_head, cell_text] = element(text, "CellData");
    CHECK(cell_head == attributes{{"Scalars", "hit"}});
    const auto cells = arrays(cell_text);
    REQUIRE(cells.size() == 4);
    CHECK(cells[0].head.at("type") == "UInt8");
    CHECK(cells[0].template as<std::uint8_t>() == std::vector<std::uint8_t>{0, 1, 1});
    CHECK(cells[1].head.at("Name") == "depth");
    CHECK(same_bits(cells[1].template as<float>(), depth));
    CHECK(cells[2].head.at("type") == "Int32");
    CHECK(cells[2].template as<std::int32_t>() == group);
    CHECK(cells[3].head.at("Name") == "a&lt;b&amp;&quot;c&quot;&gt;");
    CHECK(cells[3].head.at("type") == "Float64");
    CHECK(cells[3].template as<double>() == time);

    const auto [point_head, point_text] = element(text, "PointData");
    CHECK(point_head.empty());
    const auto values = arrays(point_text);
    REQUIRE(values.size() == 1);
    CHECK(values[0].head.at("type") == "UInt32");
    CHECK(values[0].template as<std::uint32_t>() == id);
}

TEMPLATE_TEST_CASE("write_points_vtp: points are cells of their own, with normals", "", float, double) {
    using T = TestType;
    if (std::endian::native == std::endian::big) ABUT_SKIP("order of bytes", "the test reads little-endian numbers");
    const io_test::scratch folder;
    const std::vector<abut::vec3<T>> points{{1, 2, 3}, {4, 5, T(0.1)}}, normals{{0, 0, 1}, {0, T(-0.6), T(0.8)}};
    const std::vector<T> depth{0, T(1e-30)};
    abut::io::write_points_vtp(folder / "a.vtp", points, {.normals = normals, .properties = {{"depth", depth}}});
    const std::string text = io_test::content(folder / "a.vtp");
    CHECK(element(text, "Piece").first == attributes{{"NumberOfPoints", "2"},
                                                     {"NumberOfVerts", "2"},
                                                     {"NumberOfLines", "0"},
                                                     {"NumberOfStrips", "0"},
                                                     {"NumberOfPolys", "0"}});
    const auto [head, content] = element(text, "PointData");
    CHECK(head == attributes{{"Normals", "normal"}});
    const auto values = arrays(content);
    REQUIRE(values.size() == 2);
    CHECK(values[0].head.at("Name") == "normal");
    CHECK(values[0].head.at("NumberOfComponents") == "3");
    CHECK(same_bits(values[0].template as<T>(), flat(normals)));
    CHECK(values[1].head.at("NumberOfComponents") == "1");
    CHECK(same_bits(values[1].template as<T>(), depth));
    CHECK(same_bits(arrays(element(text, "Points").second).at(0).template as<T>(), flat(points)));
    const auto cells = arrays(element(text, "Verts").second);
    REQUIRE(cells.size() == 2);
    CHECK(cells[0].template as<std::int32_t>() == std::vector<std::int32_t>{0, 1});
    CHECK(cells[1].template as<std::int32_t>() == std::vector<std::int32_t>{1, 2});
}

TEST_CASE("write_vtp: nothing in it, and nothing but the mesh") {
    const io_test::scratch folder;
    abut::io::write_vtp(folder / "a.vtp", abut::mesh<double>{});
    const std::string empty = io_test::content(folder / "a.vtp");
    CHECK(element(empty, "Piece").first.at("NumberOfPoints") == "0");
    for (const data_array& a : arrays(empty)) CHECK((a.count_is_right && a.bytes.empty()));
    abut::io::write_points_vtp(folder / "b.vtp", std::vector<abut::vec3<float>>{});
    CHECK(element(io_test::content(folder / "b.vtp"), "Piece").first.at("NumberOfVerts") == "0");
    abut::io::write_vtp(folder / "c.vtp", square, halves);
    const std::string plain = io_test::content(folder / "c.vtp");
    CHECK(element(plain, "CellData").second == "\n");
    CHECK(element(plain, "CellData").first.empty());
    CHECK(element(plain, "PointData").second == "\n");
}

TEST_CASE("write_vtp: base64, and across the ends of the buffer") {
    if (std::endian::native == std::endian::big) ABUT_SKIP("order of bytes", "the test reads little-endian numbers");
    const io_test::scratch folder;
    {
        // RFC 4648, section 10
        abut::io::detail::output_file file(folder / "base64");
        for (const std::string_view text : {"", "f", "fo", "foo", "foob", "fooba", "foobar"}) {
            abut::io::detail::base64_writer out(file);
            for (const char c : text) out.put(c);
            out.finish();
            file.write('.');
        }
        file.close();
        CHECK(io_test::content(folder / "base64") == ".Zg==.Zm8=.Zm9v.Zm9vYg==.Zm9vYmE=.Zm9vYmFy.");
    }
    std::vector<abut::vec3<double>> points(100'001);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = {1.0 / static_cast<double>(i + 1), static_cast<double>(i), -0.0};
    }
    abut::io::write_points_vtp(folder / "a.vtp", points);
    const std::string text = io_test::content(folder / "a.vtp");
    CHECK(same_bits(arrays(element(text, "Points").second).at(0).as<double>(), flat(points)));
}

}  // namespace io_test::write_vtp_cases
