// SPDX-License-Identifier: MIT
#include <abut/io/gltf.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <abut/io/read.hpp>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::gltf_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;
using points = std::vector<abut::vec3<double>>;

template <class T = double>
auto parse(const std::string& data) {
    return abut::io::parse_gltf<T>(data, "t.glb");
}
template <class T = float>
std::string refusal(const std::string& data) {
    return io_test::refusal([&] { parse<T>(data); });
}

/// Numbers in a row, as a file has them.
class buffer {
public:
    template <class V>
    buffer& put(std::initializer_list<V> values) {
        for (const V value : values) {
            char bytes[sizeof(V)];
            io_test::to_little_endian(value, bytes);
            data.append(bytes, sizeof bytes);
        }
        return *this;
    }
    std::string data;
};

std::string base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

/// A binary file of this JSON and these bytes.
std::string glb(std::string json, std::string bytes) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    buffer file;
    file.data = "glTF";
    file.put<std::uint32_t>(
        {2, static_cast<std::uint32_t>(28 + json.size() + bytes.size()), static_cast<std::uint32_t>(json.size())});
    file.data += "JSON" + json;
    file.put<std::uint32_t>({static_cast<std::uint32_t>(bytes.size())});
    file.data += std::string("BIN\0", 4) + bytes;
    return file.data;
}

/// The JSON of one mesh: five vertices of floats, at byte 0, and six indices of 16 bits, at byte 60. `nodes` are the nodes,
/// all of them in the scene if there is but one; `primitive` goes into the primitive beside its attributes, `more` to the
/// end.
std::string document(const std::string& nodes = "[{\"mesh\":0}]", const std::string& primitive = "\"indices\":1,",
                     const std::string& more = "", const std::string& buffers = "[{\"byteLength\":72}]") {
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":" + nodes +
           ",\"meshes\":[{\"primitives\":[{" + primitive +
           "\"attributes\":{\"POSITION\":0}}]}],"
           "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"},"
           "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60},{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12}],"
           "\"buffers\":" +
           buffers + more + "}";
}
const std::string numbers =
    buffer().put<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.1f, 0, 2}).put<std::uint16_t>({0, 1, 2, 2, 3, 0}).data;
const std::string whole = glb(document(), numbers);

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != text.npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("gltf: triangles, strips and fans, with and without indices") {
    const auto read = parse(whole);
    CHECK(read.vertices == points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {static_cast<double>(0.1f), 0, 2}});
    CHECK(read.faces == faces{{0, 1, 2}, {2, 3, 0}});
    const auto of = [&](const std::string& primitive) {
        return parse(glb(document("[{\"mesh\":0}]", primitive), numbers)).faces;
    };
    CHECK(of("\"indices\":1,\"mode\":4,") == faces{{0, 1, 2}, {2, 3, 0}});
    // The strip 0 1 2 2 3 0 has two triangles that repeat a vertex.
    CHECK(of("\"indices\":1,\"mode\":5,") == faces{{0, 1, 2}, {3, 2, 0}});
    CHECK(of("\"mode\":5,") == faces{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}});
    CHECK(of("\"mode\":6,") == faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    for (const char* mode : {"0", "1", "2", "3"}) CHECK(of("\"mode\":" + std::string(mode) + ",").empty());
}

TEST_CASE("gltf: nodes put meshes where they are, and mirrors turn them around") {
    const auto at = [&](const std::string& nodes) { return parse(glb(document(nodes), numbers)); };
    CHECK(at("[{\"mesh\":0,\"translation\":[1,2,3],\"scale\":[2,2,2]}]").vertices[2] == abut::vec3<double>{3, 4, 3});
    // A quarter turn around z, then the parent's shift.
    const auto turned =
        at("[{\"children\":[1],\"translation\":[10,0,0]},{\"mesh\":0,\"rotation\":[0,0,0.7071067811865476,0."
           "7071067811865476]}]");
    CHECK(turned.vertices[1].x == Approx(10));
    CHECK(turned.vertices[1].y == Approx(1));
    CHECK(turned.faces[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    const auto mirrored = at("[{\"mesh\":0,\"matrix\":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}]");
    CHECK(mirrored.vertices[1] == abut::vec3<double>{4, 0, 0});
    CHECK(mirrored.faces[0] == std::array<std::uint32_t, 3>{0, 2, 1});
    // A mesh of two nodes is there twice, in the order of the nodes; nodes outside of the scene are not.
    const auto twice = at("[{\"children\":[2,1]},{\"mesh\":0,\"translation\":[0,0,7]},{\"mesh\":0},{\"mesh\":0}]");
    CHECK(twice.vertices.size() == 10);
    CHECK(twice.vertices[5].z == 7);
    CHECK(twice.faces[3] == std::array<std::uint32_t, 3>{7, 8, 5});
}

TEST_CASE("gltf: as text, with buffers inside or beside it") {
    const io_test::scratch folder;
    const auto inside =
        document("[{\"mesh\":0}]", "\"indices\":1,", "",
                 "[{\"byteLength\":72,\"uri\":\"data:application/octet-stream;base64," + base64(numbers) + "\"}]");
    CHECK(abut::io::read_mesh_data<float>(folder.file("a.gltf", inside)).faces == faces{{0, 1, 2}, {2, 3, 0}});
    CHECK(abut::io::read_mesh<double>(folder.file("a.GLB", whole)).size() == 2);
    folder.file("b c.bin", numbers);
    const auto beside = [&](const std::string& uri) {
        return document("[{\"mesh\":0}]", "\"indices\":1,", "", "[{\"byteLength\":72,\"uri\":\"" + uri + "\"}]");
    };
    CHECK(abut::io::read_mesh_data<float>(folder.file("b.gltf", beside("b%20c.bin"))).faces.size() == 2);
    CHECK(abut::io::read_mesh_data<float>(folder.file("b.gltf", beside("./b\\u0020c.bin"))).faces.size() == 2);
    for (const std::string uri : {"../b.bin", "/etc/passwd", "x/../../b.bin", "file:b.bin", "%2e%2e/b.bin", ""}) {
        const auto path = folder.file("c.gltf", beside(uri));
        CHECK(io_test::refusal([&] {
                  abut::io::read_mesh_data<float>(path);
              }).find("expected data, or the path of a file in the same folder") != std::string::npos);
    }
    const auto path = folder.file("d.gltf", beside("none.bin"));
    CHECK(io_test::refusal([&] {
              abut::io::read_mesh_data<float>(path);
          }).starts_with((folder / "none.bin").string() + ": cannot be opened"));
    CHECK(refusal(beside("b.bin")).find("expected a buffer within the file") != std::string::npos);
    CHECK(refusal(beside("data:;base64,AAA*")).find("expected data in base64") != std::string::npos);
    CHECK(refusal(beside("data:;base64,AAAA")).find("expected a buffer of 72 bytes, of which 3 are there") !=
          std::string::npos);
}

TEST_CASE("gltf: strides, integers of each size, instances") {
    const std::string strided =
        buffer().put<float>({0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}).data;  // 12 of each 16 bytes; the last row ends early
    const std::string head = "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],";
    const std::string tail = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],";
    CHECK(parse(glb(head + tail +
                        "\"nodes\":[{\"mesh\":0}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
                        "\"type\":\"VEC3\"}],"
                        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":44,\"byteStride\":16}],\"buffers\":[{\"byteLength\":"
                        "44}]}",
                    strided))
              .vertices == points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const std::string small = buffer().put<std::int8_t>({0, 0, 0, 127, -128, 1, 0, 64, 0}).data;
    const auto quantised = [&](const std::string& normalised) {
        return parse(glb(head + tail + "\"nodes\":[{\"mesh\":0}],\"accessors\":[{\"bufferView\":0,\"componentType\":5120," +
                             normalised +
                             "\"count\":3,\"type\":\"VEC3\"}],\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
                             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":9}],\"buffers\":[{\"byteLength\":9}]}",
                         small));
    };
    CHECK(quantised("").vertices[1] == abut::vec3<double>{127, -128, 1});
    CHECK(quantised("\"normalized\":true,").vertices[1] == abut::vec3<double>{1, -1, 1.0 / 127});
    const std::string placed = buffer().put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, 6, 6, 6}).data;
    const auto many =
        parse(glb(head + tail +
                      "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2],\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":"
                      "{\"TRANSLATION\":1}}}}],"
                      "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
                      "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
                      "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60}],\"buffers\":[{\"byteLength\":60}]}",
                  placed));
    CHECK(many.faces == faces{{0, 1, 2}, {3, 4, 5}});
    CHECK(many.vertices[4] == abut::vec3<double>{14, 12, 12});
}

TEST_CASE("gltf: accessors that are sparse, or have no bytes") {
    // Positions: as in the buffer but for elements 1 and 4, which are others; or zeros but for these.
    const std::string bytes = numbers + buffer().put<std::uint8_t>({1, 4, 0, 0}).put<float>({7, 8, 9, -1, -2, -3}).data;
    const std::string views =
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60},{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":72,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":76,\"byteLength\":24}]";
    const std::string old_views =
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60},{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12}]";
    const std::string sparse =
        "\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":2,\"componentType\":5121},\"values\":{\"bufferView\":3}},";
    const auto file = [&](const std::string& from, const std::string& to) {
        std::string text = replaced(document(), old_views, views);
        text = replaced(text, "{\"byteLength\":72}", "{\"byteLength\":100}");
        return glb(replaced(text, from, to), bytes);
    };
    const std::string accessor = "{\"bufferView\":0,\"componentType\":5126";
    const auto some = parse(file(accessor, "{" + sparse + accessor.substr(1)));
    CHECK(some.vertices[1] == abut::vec3<double>{7, 8, 9});
    CHECK(some.vertices[2] == abut::vec3<double>{1, 1, 0});
    CHECK(some.vertices[4] == abut::vec3<double>{-1, -2, -3});
    CHECK(some.faces == parse(whole).faces);
    const auto rest = parse(file(accessor, "{" + sparse + "\"componentType\":5126"));
    CHECK(rest.vertices == points{{0, 0, 0}, {7, 8, 9}, {0, 0, 0}, {0, 0, 0}, {-1, -2, -3}});
    const auto none = parse(file(accessor, "{\"componentType\":5126"));
    CHECK(none.vertices == points(5, {0, 0, 0}));

    const auto refused = [&](const std::string& from, const std::string& to) {
        const std::string message = refusal(file(accessor, "{" + replaced(sparse, from, to) + accessor.substr(1)));
        return message.substr(message.find("expected"));
    };
    CHECK(refused("\"count\":2", "\"count\":6") == "expected a count of at most all elements from 0 to 5, found '6'");
    for (const std::string from : {"1", "2"}) {  // 4, 0; 0, 0
        CHECK(refused("\"bufferView\":2", "\"byteOffset\":" + from + ",\"bufferView\":2") ==
              "expected numbers of elements that increase and are below 5, found an object");
    }
    CHECK(refused("\"count\":2", "\"count\":5") == "expected a part of its buffer view, which has 4 bytes, found an object");
    CHECK(refused("5121", "5120") == "expected numbers of elements without a sign (5121, 5123, 5125), found an object");
    CHECK(refused("\"bufferView\":3", "\"bufferView\":2") ==
          "expected a part of its buffer view, which has 4 bytes, found an object");
    CHECK(refused("\"values\"", "\"value\"") == "expected 'values' in this object");
    const std::string many = refusal(file(accessor + ",\"count\":5", "{\"componentType\":5126,\"count\":16777217"));
    CHECK(many.find("at most 16777216 elements of an accessor without a buffer view") != many.npos);
}

TEST_CASE("gltf: what is malformed is refused with its byte") {
    CHECK(refusal("") == "t.glb: byte 0: expected a value, found the end of the JSON");
    CHECK(refusal("glTF") == "t.glb: byte 4: expected more of a binary glTF file, found the end of the file");
    CHECK(refusal("[1,2") == "t.glb: byte 4: expected ',' or ']', found the end of the JSON");
    CHECK(refusal("{\"a\" 1}") == "t.glb: byte 5: expected ':', found '1'");
    CHECK(refusal("{a:1}") == "t.glb: byte 1: expected the name of a member in quotes, found 'a'");
    CHECK(refusal("{\"a\":tru}") == "t.glb: byte 5: expected a value, found 't'");
    CHECK(refusal("{\"a\":1} x") == "t.glb: byte 8: expected the end of the JSON, found 'x'");
    CHECK(refusal("\"a\nb\"") == "t.glb: byte 2: expected a character of a string, found '\\x0a'");
    CHECK(refusal("\"a\\") == "t.glb: byte 3: expected '\"', found the end of the JSON");
    CHECK(refusal(std::string(200, '[')).find("expected at most 100 arrays and objects within each other") !=
          std::string::npos);
    CHECK(refusal("[]") == "t.glb: byte 0: expected an object, found an array");
    CHECK(refusal("{}") == "t.glb: byte 0: expected 'asset' in this object");
    CHECK(refusal("{\"asset\":{\"version\":\"1.0\"}}") == "t.glb: byte 20: expected version 2 of glTF, found '1.0'");
    CHECK(refusal("{\"asset\":{\"version\":2}}") == "t.glb: byte 20: expected a string as 'version', found '2'");
    CHECK(parse("{\"asset\":{\"version\":\"2.0\"}}").faces.empty());
    CHECK(refusal(whole.substr(0, whole.size() - 1)).starts_with("t.glb: byte 8: expected a length of "));
    CHECK(refusal(replaced(whole, "glTF\2", "glTF\1")) == "t.glb: byte 4: expected version 2 of binary glTF, found 1");
    CHECK(refusal(replaced(whole, "JSON", "JSOM")) == "t.glb: byte 16: expected JSON as the first chunk of binary glTF");

    const auto of = [](const std::string& from, const std::string& to) {
        const std::string message = refusal(glb(replaced(document(), from, to), numbers));
        return message.substr(message.find("expected"));
    };
    CHECK(of("\"count\":5", "\"count\":6") == "expected a part of its buffer view, which has 60 bytes, found an object");
    CHECK(of("\"count\":5", "\"count\":-1") == "expected a count from 0 to 4294967295, found '-1'");
    CHECK(of("\"count\":5", "\"count\":1.5") == "expected a count from 0 to 4294967295, found '1.5'");
    CHECK(of("\"byteLength\":60", "\"byteLength\":73") ==
          "expected a part of its buffer, which has 72 bytes, found an object");
    CHECK(of("\"byteOffset\":60", "\"byteOffset\":4294967295").starts_with("expected a part of its buffer"));
    CHECK(of("[{\"byteLength\":72}]", "[{\"byteLength\":73}]") ==
          "expected a buffer of 73 bytes, of which 72 are there, found an object");
    CHECK(of("\"buffers\":[{\"byteLength\":72}]", "\"buffers\":[]") ==
          "expected 'buffers' in the file, which has none, found '0'");
    CHECK(of("\"VEC3\"", "\"VEC2\"") == "expected 'VEC3', found 'VEC2'");
    CHECK(of("5126", "5124") == "expected a type of components (5120 to 5123, 5125, 5126), found '5124'");
    CHECK(of("\"indices\":1", "\"indices\":0") == "expected 'SCALAR', found 'VEC3'");
    CHECK(of("\"indices\":1", "\"indices\":2") == "expected a number of 'accessors' from 0 to 1, found '2'");
    CHECK(of("\"mesh\":0", "\"mesh\":1") == "expected a number of 'meshes' from 0 to 0, found '1'");
    CHECK(of("\"mesh\":0", "\"mesh\":0,\"children\":[0]") ==
          "expected a node that no other one has as its child, nor the scene twice, found '0'");
    CHECK(of("\"mesh\":0", "\"mesh\":0,\"scale\":[1,2]") == "expected 3 numbers, found an array");
    CHECK(of("\"mesh\":0", "\"mesh\":0,\"scale\":[1,2,1e999]") == "expected a finite number, found '1e999'");
    CHECK(of("\"mesh\":0", "\"mesh\":0,\"scale\":[1,1,1e300]") ==
          "expected finite positions; number 4 is not, in accessor, found '0'");
    CHECK(of("\"indices\":1", "\"mode\":7,\"indices\":1") == "expected 'mode' from 0 to 6, found '7'");
    CHECK(of("\"indices\":1,", "") == "expected three corners for each triangle, not 5 in all, in accessor, found '0'");
    CHECK(of("\"scene\":0", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"scene\":0") ==
          "expected no extension that changes how meshes are stored, found 'KHR_draco_mesh_compressi...'");
    std::string bad = numbers;
    bad[62] = 5;
    CHECK(refusal(glb(document(), bad)).find("expected indices below 5; number 1 is 5, in accessor, found '1'") !=
          std::string::npos);
    bad = numbers;
    bad[3] = bad[2] = '\x7f';
    bad[2] = '\x80';
    CHECK(refusal(glb(document(), bad)).find("expected finite positions; number 0 is not") != std::string::npos);
    // Every file that is cut off anywhere, or has one byte changed, is read or refused.
    std::size_t refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const char c : {'\0', '\xff', '9', '"'}) {
            std::string changed = whole;
            changed[at] = c;
            refused += refusal(changed) != "accepted";
        }
        refused += refusal(whole.substr(0, at)) != "accepted";
    }
    CHECK(refused > 3 * whole.size());
}

}  // namespace io_test::gltf_cases
