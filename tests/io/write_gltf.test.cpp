// SPDX-License-Identifier: MIT
#include <abut/io/write_gltf.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <abut/collide/validate.hpp>
#include <abut/io/gltf.hpp>
#include <abut/io/write_html.hpp>
#include <abut/shape/welded.hpp>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::write_gltf_cases {

namespace {

using abut::vec3;
using nlohmann::json;

/// A .glb file, taken apart by another JSON parser than the library's.
struct glb {
    json document;
    std::string binary;

    explicit glb(const abut::io::gltf_scene& scene) : glb(bytes_of(scene)) {}
    explicit glb(const std::string& bytes) {
        REQUIRE(bytes.substr(0, 8) == std::string("glTF\2\0\0\0", 8));
        REQUIRE(number(bytes, 8) == bytes.size());
        const std::size_t length = number(bytes, 12);
        document = json::parse(bytes.substr(20, length));
        if (20 + length < bytes.size()) binary = bytes.substr(28 + length);
    }
    static std::string bytes_of(const abut::io::gltf_scene& scene) {
        struct sink {
            std::string bytes;
            void write(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
        } to;
        scene.write(to, "t.glb");
        return to.bytes;
    }
    static std::size_t number(const std::string& bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    }

    [[nodiscard]] const json& ours() const { return document.at("extras").at("abut"); }
    [[nodiscard]] const json& node(const json& of) const {
        return document.at("nodes").at(of.at("node").get<std::size_t>());
    }
    [[nodiscard]] const json& primitive(const json& node) const {
        return document.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives").at(0);
    }
    /// The numbers of an accessor, whose type they have to have.
    template <class V>
    [[nodiscard]] std::vector<V> numbers(const json& accessor_number) const {
        const json& accessor = document.at("accessors").at(accessor_number.get<std::size_t>());
        const std::map<std::string, std::size_t> sizes{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
        const int type = std::is_same_v<V, float> ? 5126 : sizeof(V) == 1 ? 5121 : sizeof(V) == 2 ? 5123 : 5125;
        REQUIRE(accessor.at("componentType") == type);
        const json& view = document.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
        std::vector<V> values(accessor.at("count").get<std::size_t>() * sizes.at(accessor.at("type")));
        REQUIRE(view.at("byteLength") == values.size() * sizeof(V));
        REQUIRE(view.at("byteOffset").get<std::size_t>() % 4 == 0);
        std::memcpy(values.data(), binary.data() + view.at("byteOffset").get<std::size_t>(), values.size() * sizeof(V));
        return values;
    }
    [[nodiscard]] std::vector<float> floats(const json& of, const char* attribute) const {
        return numbers<float>(primitive(node(of)).at("attributes").at(attribute));
    }
    /// Ids of vertices, each of two halves.
    [[nodiscard]] std::vector<std::uint32_t> ids(const json& of, const char* attribute = "_ID") const {
        std::vector<std::uint32_t> made;
        const auto halves = floats(of, attribute);
        for (std::size_t i = 0; i < halves.size(); i += 2) {
            made.push_back(static_cast<std::uint32_t>(halves[i]) + 65536 * static_cast<std::uint32_t>(halves[i + 1]));
        }
        return made;
    }
};

struct contact {
    std::uint32_t a, b;
    vec3<double> point, normal;
    double depth;
};
struct impact {
    unsigned char kind;
    std::array<std::uint32_t, 4> vertices;
    double time;
};

const abut::mesh<float> corner_of_cube{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                                       {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

template <class T>
std::string refusal(const T& call) {
    try {
        call();
    } catch (const abut::error& e) {
        return e.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("write_gltf: a mesh's corners, ids, normals and colours") {
    if (std::endian::native == std::endian::big) ABUT_SKIP("order of bytes", "the test reads little-endian numbers");
    using limits = std::numeric_limits<float>;
    const std::vector<vec3<float>> vertices{{0.1f, -0.0f, limits::denorm_min()}, {1e30f, 1, 2}, {3, -4, 5}, {0, 0, 7}};
    const std::vector<abut::face> faces{{0, 1, 2}, {3, 2, 1}, {3, 3, 3}};
    const std::vector<std::uint8_t> hit{0, 9, 0};
    abut::io::gltf_scene scene;
    const auto set = scene.add("a \"part\"", abut::mesh<float>{vertices, faces}, {.hit = hit});
    CHECK(set.number == 0);
    const glb file(scene);
    const json& s = file.ours().at("sets").at(0);
    CHECK(s.at("name") == "a \"part\"");
    CHECK(s.at("kind") == "triangles");
    CHECK(s.at("count") == 3);
    CHECK(s.at("moves") == false);
    CHECK(file.primitive(file.node(s)).at("mode") == 4);
    CHECK_FALSE(file.primitive(file.node(s)).contains("indices"));
    std::vector<float> positions;
    std::vector<std::uint32_t> corners;
    for (const auto& f : faces) {
        for (const auto v : f) positions.insert(positions.end(), {vertices[v].x, vertices[v].y, vertices[v].z});
        corners.insert(corners.end(), f.begin(), f.end());
    }
    const auto written = file.floats(s, "POSITION");
    REQUIRE(written.size() == positions.size());
    CHECK(std::memcmp(written.data(), positions.data(), positions.size() * sizeof(float)) == 0);
    CHECK(file.ids(s) == std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, 2, 2, 2});
    CHECK(file.ids(s, "_CORNER") == corners);
    CHECK(file.numbers<std::uint8_t>(s.at("hit")) == std::vector<std::uint8_t>{0, 1, 0});
    const auto normals = file.floats(s, "NORMAL");
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        CHECK(std::hypot(normals[i], normals[i + 1], normals[i + 2]) == Approx(1).margin(1e-6));
    }
    const auto colours = file.numbers<std::uint8_t>(file.primitive(file.node(s)).at("attributes").at("COLOR_0"));
    const auto colour = [&](std::size_t v) { return std::vector<std::uint8_t>(&colours[4 * v], &colours[4 * v] + 4); };
    CHECK(colour(0) == colour(8));
    CHECK(colour(0) != colour(3));
    CHECK(colour(3) == colour(5));
    // The library's own reader finds the same triangles.
    const auto read = abut::io::parse_gltf<float>(glb::bytes_of(scene), "t.glb");
    CHECK(std::memcmp(read.vertices.data(), positions.data(), positions.size() * sizeof(float)) == 0);
    CHECK(read.faces == std::vector<abut::face>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
}

TEST_CASE("write_gltf: posed sets lie where place puts them") {
    const abut::rigid<float> pose{{0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f}, {0.1f, 0.2f, 0.3f}};
    abut::io::gltf_scene scene;
    scene.add("mesh", abut::posed(corner_of_cube, pose));
    scene.add("ball", abut::posed(abut::spheres<float>{{{{1, 2, 3}, 0.5f}}}, pose));
    const glb file(scene);
    const auto written = file.floats(file.ours().at("sets").at(0), "POSITION");
    for (std::size_t f = 0; f < 4; ++f) {
        const auto t = place(pose, corner_of_cube.view()[f]);
        const std::array<vec3<float>, 3> points{t.a, t.b, t.c};
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(vec3<float>{written[9 * f + 3 * k], written[9 * f + 3 * k + 1], written[9 * f + 3 * k + 2]} == points[k]);
        }
    }
    CHECK(file.ids(file.ours().at("sets").at(0), "_CORNER")[1] == 2);
    const json& ball =
        file.document.at("nodes").at(file.node(file.ours().at("sets").at(1)).at("children").at(0).get<std::size_t>());
    CHECK(ball.at("translation").get<std::vector<float>>()[0] == place(pose, vec3<float>{1, 2, 3}).x);
    CHECK(ball.at("scale") == json::array({0.5, 0.5, 0.5}));
}

TEST_CASE("write_gltf: spheres are nodes or instances, and parts of sets have their ids") {
    std::vector<abut::sphere<double>> many(300);
    std::vector<std::uint32_t> ids(300);
    std::vector<std::uint8_t> hit(300);
    for (std::uint32_t i = 0; i < 300; ++i) {
        many[i] = {{0.1 * i, 1, -2}, 0.25 + i};
        ids[i] = 70000 * i;
        hit[i] = i % 7 == 0;
    }
    const std::vector<std::uint32_t> few_ids{5, 99};
    abut::io::gltf_scene scene;
    scene.add("few", abut::equal_spheres<float>{std::vector<vec3<float>>{{1, 2, 3}, {4, 5, 6}}, 0.5f},
              {.ids = few_ids, .of = 100});
    scene.add("many", abut::spheres<double>{many}, {.hit = hit, .ids = ids, .of = 70000 * 300});
    const glb file(scene);
    const json& few = file.ours().at("sets").at(0);
    CHECK(few.at("as") == "nodes");
    CHECK(few.at("of") == 100);
    CHECK(file.numbers<std::uint32_t>(few.at("ids")) == few_ids);
    const json& second = file.document.at("nodes").at(file.node(few).at("children").at(1).get<std::size_t>());
    CHECK(second.at("name") == "few 99");
    CHECK(second.at("extras").at("id") == 99);
    CHECK(second.at("translation") == json::array({4, 5, 6}));
    const json& set = file.ours().at("sets").at(1);
    CHECK(set.at("as") == "instances");
    CHECK(file.document.at("extensionsUsed") == json::array({"EXT_mesh_gpu_instancing"}));
    CHECK_FALSE(file.document.contains("extensionsRequired"));
    const json& attributes = file.node(set).at("extensions").at("EXT_mesh_gpu_instancing").at("attributes");
    const auto centers = file.numbers<float>(attributes.at("TRANSLATION")),
               scales = file.numbers<float>(attributes.at("SCALE"));
    const auto halves = file.numbers<float>(attributes.at("_ID"));
    for (std::size_t i = 0; i < 300; ++i) {
        CHECK(centers[3 * i] == static_cast<float>(many[i].center.x));
        CHECK(scales[3 * i + 1] == static_cast<float>(many[i].radius));
        CHECK(static_cast<double>(halves[2 * i]) + 65536.0 * static_cast<double>(halves[2 * i + 1]) == ids[i]);
    }
    CHECK(file.numbers<std::uint8_t>(attributes.at("_COLOR_0")).size() == 1200);
    // The ball is one: all corners at 1 from its center, each edge of two triangles, seen from outside.
    const auto ball = abut::io::parse_gltf<double>(glb::bytes_of(scene), "t.glb");
    CHECK(ball.faces.size() == 2 * 320 + 300 * 320);
    for (std::size_t v = 0; v < 162; ++v) {
        const auto p = ball.vertices[v] - vec3<double>{1, 2, 3};
        CHECK(std::sqrt(dot(p, p)) == Approx(0.5).epsilon(1e-6));
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t f = 0; f < 320; ++f) {
        for (std::size_t k = 0; k < 3; ++k) ++edges[{ball.faces[f][k], ball.faces[f][(k + 1) % 3]}];
        const auto at = [&](std::size_t k) { return ball.vertices[ball.faces[f][k]] - vec3<double>{1, 2, 3}; };
        CHECK(dot(cross(at(1) - at(0), at(2) - at(0)), at(0)) > 0);
    }
    CHECK(edges.size() == 960);
    for (const auto& [edge, times] : edges) CHECK((times == 1 && edges.count({edge.second, edge.first}) == 1));
}

TEST_CASE("write_gltf: segments, points, boxes, soups and single shapes") {
    const std::vector<vec3<float>> ends{{0, 0, 0}, {1, 2, 3}, {4, 5, 6}};
    const std::vector<abut::edge> edges{{0, 1}, {2, 0}};
    abut::io::gltf_scene scene;
    scene.add("segments", abut::edge_mesh<float>{ends, edges});
    scene.add("points", abut::points<float>{ends});
    scene.add("boxes", abut::boxes<double>{{{{0, 0, 0}, {1, 2, 3}}, {{5, 5, 5}, {6, 6, 6}}}});
    scene.add("soup", abut::triangle_soup<float>{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}});
    scene.add("one", abut::triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    scene.add("none", abut::mesh<float>{});
    const glb file(scene);
    const auto set = [&](std::size_t i) -> const json& { return file.ours().at("sets").at(i); };
    CHECK(set(0).at("kind") == "segments");
    CHECK(file.primitive(file.node(set(0))).at("mode") == 1);
    CHECK(file.floats(set(0), "POSITION") == std::vector<float>{0, 0, 0, 1, 2, 3, 4, 5, 6, 0, 0, 0});
    CHECK(file.ids(set(0)) == std::vector<std::uint32_t>{0, 0, 1, 1});
    CHECK(set(1).at("kind") == "points");
    CHECK(file.primitive(file.node(set(1))).at("mode") == 0);
    CHECK(file.floats(set(1), "POSITION") == std::vector<float>{0, 0, 0, 1, 2, 3, 4, 5, 6});
    CHECK(set(2).at("kind") == "boxes");
    CHECK(file.ids(set(2)).size() == 72);
    // Of each box the volume within the faces, and the normals outwards.
    const auto p = file.floats(set(2), "POSITION"), n = file.floats(set(2), "NORMAL");
    std::array<double, 2> volume{};
    for (std::size_t t = 0; t < 24; ++t) {
        const auto at = [&](const std::vector<float>& from, std::size_t k) {
            return vec3<double>{from[9 * t + 3 * k], from[9 * t + 3 * k + 1], from[9 * t + 3 * k + 2]};
        };
        const auto normal = cross(at(p, 1) - at(p, 0), at(p, 2) - at(p, 0));
        volume[t / 12] += dot(at(p, 0), normal) / 6;
        CHECK(dot(normal, at(n, 0)) == Approx(std::sqrt(dot(normal, normal))));
    }
    CHECK(volume[0] == Approx(6));
    CHECK(volume[1] == Approx(1));
    CHECK(file.ids(set(3), "_CORNER") == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
    CHECK(set(4).at("count") == 1);
    CHECK(set(5).at("count") == 0);
    CHECK_FALSE(file.node(set(5)).contains("mesh"));
    const glb empty{abut::io::gltf_scene{}};
    CHECK(empty.binary.empty());
    CHECK(empty.ours().at("sets").empty());
}

TEST_CASE("write_gltf: motions are morph targets, and frames follow each other") {
    const std::vector<vec3<float>> later{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {0.1f, 0, 9}};
    const auto t1 = corner_of_cube.with_vertices(abut::serial{}, later);
    abut::io::gltf_scene scene;
    scene.add("step", abut::moving(corner_of_cube, t1));
    scene.add_frames("frames", std::vector<abut::mesh<float>>{t1, corner_of_cube, t1});
    const glb file(scene);
    for (std::size_t s = 0; s < 2; ++s) {
        const json& set = file.ours().at("sets").at(s);
        CHECK(set.at("moves") == true);
        CHECK(set.contains("frames") == (s == 1));
        const auto begin = file.floats(set, "POSITION");
        const json& targets = file.primitive(file.node(set)).at("targets");
        REQUIRE(targets.size() == s + 1);
        const auto way = file.numbers<float>(targets.at(0).at("POSITION"));
        const auto& to = s == 0 ? t1 : corner_of_cube;
        for (std::size_t f = 0; f < 4; ++f) CHECK(begin[9 * f + 2] + way[9 * f + 2] == to.view()[f].a.z);
        const json& channel = file.document.at("animations").at(0).at("channels").at(s);
        CHECK(channel.at("target").at("node") == set.at("node"));
        CHECK(channel.at("target").at("path") == "weights");
        const json& sampler =
            file.document.at("animations").at(0).at("samplers").at(channel.at("sampler").get<std::size_t>());
        CHECK(sampler.at("interpolation") == "LINEAR");
        CHECK(file.numbers<float>(sampler.at("input")) == (s == 0 ? std::vector<float>{0, 1} : std::vector<float>{0, 1, 2}));
        CHECK(file.numbers<float>(sampler.at("output")) ==
              (s == 0 ? std::vector<float>{0, 1} : std::vector<float>{0, 0, 1, 0, 0, 1}));
    }
    CHECK(file.document.at("animations").size() == 1);
}

TEST_CASE("write_gltf: pairs, contacts and impacts") {
    abut::io::gltf_scene scene;
    const auto a = scene.add("a", corner_of_cube),
               b = scene.add("b", abut::points<float>{std::vector<vec3<float>>{{1, 1, 1}}});
    struct id_pair {
        std::int64_t a;
        unsigned short b;
    };
    scene.add_pairs(a, b, std::vector<id_pair>{{3, 0}, {4000000000, 7}}, {.of = 9});
    scene.add_contacts(a, b, std::vector<contact>{{1, 0, {1, 2, 3}, {0, 0.6, 0.8}, 0.1}});
    const double time = 0.3;  // the float nearest to it is greater
    scene.add_impacts(a, a, std::vector<impact>{{2, {0, 1, 2, 3}, time}, {0, {9, 8, 7, 6}, 1}, {1, {1, 2, 3, 0}, 0}},
                      {.step = 4});
    scene.add_impacts(a, b, std::vector<impact>(1001));
    scene.add_pairs(b, b, std::vector<id_pair>{});
    scene.add_note("a note");
    const glb file(scene);
    const auto result = [&](std::size_t i) -> const json& { return file.ours().at("results").at(i); };
    const auto of = [&](std::size_t i, const char* name) { return result(i).at("accessors").at(name); };
    CHECK(result(0).at("kind") == "pairs");
    CHECK(result(0).at("b") == 1);
    CHECK(result(0).at("of") == 9);
    CHECK(file.numbers<std::uint32_t>(of(0, "a_ids")) == std::vector<std::uint32_t>{3, 4000000000});
    CHECK(file.numbers<std::uint32_t>(of(0, "b_ids")) == std::vector<std::uint32_t>{0, 7});
    CHECK(file.numbers<float>(of(1, "points")) == std::vector<float>{1, 2, 3});
    CHECK(file.numbers<float>(of(1, "normals")) == std::vector<float>{0, 0.6f, 0.8f});
    CHECK(file.numbers<float>(of(1, "depths")) == std::vector<float>{0.1f});
    const auto line = file.floats(result(1), "POSITION");
    CHECK(std::vector<float>(line.begin(), line.begin() + 3) == std::vector<float>{1, 2, 3});
    const float length = 0.02f * std::sqrt(48.0f);
    CHECK(line[3] == 1);
    CHECK(line[4] == Approx(2 + 0.6f * length));
    CHECK(line[5] == Approx(3 + 0.8f * length));
    CHECK(file.ids(result(1)) == std::vector<std::uint32_t>{0, 0});
    CHECK(result(2).at("step") == 4);
    CHECK(file.numbers<std::uint8_t>(of(2, "kinds")) == std::vector<std::uint8_t>{2, 0, 1});
    CHECK(file.numbers<std::uint32_t>(of(2, "vertices")).at(5) == 8);
    const auto times = file.numbers<float>(of(2, "times"));
    REQUIRE(static_cast<double>(static_cast<float>(time)) > time);
    CHECK(times == std::vector<float>{std::nextafter(static_cast<float>(time), 0.0f), 1, 0});
    CHECK(result(2).at("times_exact") == json::array({"0.3", "1", "0"}));
    CHECK_FALSE(result(3).contains("times_exact"));
    CHECK(result(4).at("count") == 0);
    CHECK(result(4).at("accessors").empty());
    CHECK(file.ours().at("notes") == json::array({"a note"}));
}

TEST_CASE("write_gltf: doubles far from the origin keep their digits") {
    const vec3<double> far_off{4'200'000.125, -510'000.25, 33.5};
    std::vector<vec3<double>> vertices;
    for (int i = 0; i < 12; ++i) vertices.push_back(far_off + vec3<double>{0.001 * i, 0.3 * (i % 3), 0.7 * (i % 2)});
    abut::io::gltf_scene scene;
    const auto a = scene.add("far", abut::mesh<double>{vertices, std::vector<abut::face>{{0, 1, 2}, {9, 10, 11}}});
    scene.add("near", abut::points<double>{std::vector<vec3<double>>{{1, 2, 3}}});
    scene.add_contacts(a, a, std::vector<contact>{{0, 1, far_off, {0, 0, 1}, 1}});
    const glb file(scene);
    const auto origin = file.ours().at("origin").get<std::vector<double>>();
    const json& root = file.document.at("nodes").at(file.document.at("scenes").at(0).at("nodes").at(0).get<std::size_t>());
    CHECK(root.at("translation") == file.ours().at("origin"));
    CHECK(root.at("children").size() == 3);
    CHECK(scene.origin() == vec3<double>{origin[0], origin[1], origin[2]});
    const auto read = abut::io::parse_gltf<double>(glb::bytes_of(scene), "t.glb");
    for (std::size_t k = 0; k < 3; ++k) {
        const auto off = read.vertices[k] - vertices[k];
        CHECK(std::sqrt(dot(off, off)) < 1e-7);  // in floats of the world it would be 0.1
    }
    const auto point = file.numbers<float>(file.ours().at("results").at(0).at("accessors").at("points"));
    CHECK(std::abs(origin[0] + static_cast<double>(point[0]) - far_off.x) < 1e-7);
    // Sets of floats stay as they are, and so does what is near.
    for (const bool is_near : {false, true}) {
        abut::io::gltf_scene other;
        if (is_near) {
            other.add("near", abut::mesh<double>{{{0, 0, 0}, {1, 0, 0}, {0, 15, 0}}, {{0, 1, 2}}});
        } else {
            other.add("far", abut::points<float>{std::vector<vec3<float>>{{1e8f, 1, 1}, {1e8f, 2, 2}}});
        }
        CHECK(other.origin() == vec3<double>{0, 0, 0});
        CHECK_FALSE(glb(other).ours().contains("origin"));
    }
}

TEST_CASE("write_gltf: what a scene cannot hold is refused") {
    abut::io::gltf_scene scene;
    const std::vector<std::uint8_t> three(3);
    const std::vector<std::uint32_t> one{1};
    CHECK(refusal([&] { scene.add("a", corner_of_cube, {.hit = three}); }) ==
          "abut::io::gltf_scene::add: expected 4 values of 'hit', one for each shape, found 3");
    CHECK(refusal([&] { scene.add("a", corner_of_cube, {.ids = one}); }) ==
          "abut::io::gltf_scene::add: expected 4 values of 'ids', one for each shape, found 1");
    CHECK(refusal([&] {
              scene.add("a", abut::points<double>{std::vector<vec3<double>>{{0, 1e39, 2}}});
          }) == "abut::io::gltf_scene::add: expected coordinates that float can hold, found 0, 1e+39, 2");
    CHECK(refusal([&] { scene.add_frames("a", std::vector<abut::mesh<float>>{}); }) ==
          "abut::io::gltf_scene::add_frames: expected at least one frame");
    CHECK(refusal([&] {
              scene.add_frames("a", std::vector<abut::mesh<float>>{corner_of_cube, abut::mesh<float>{}});
          }) == "abut::moving: 4 shapes at t = 0, 0 at t = 1; expected as many");
    CHECK(refusal([&] { scene.add_pairs({0}, {0}, std::vector<contact>{}); }) ==
          "abut::io::gltf_scene::add_pairs: expected a set of this scene, which has 0, found number 0");
    const std::vector<vec3<float>> points(3);
    const std::vector<abut::face> faces{{0, 1, 3}};
    CHECK(refusal([&] {
              scene.add("a", abut::mesh_view<float>(points.data(), 3, faces.data(), 1));
          }).starts_with("abut::io::gltf_scene::add: face 0: "));
    CHECK(refusal([&] {
              abut::io::write_gltf("/dev/null/a.glb", scene);
          }).starts_with("/dev/null/a.glb: cannot be written: "));
}

TEST_CASE("write_gltf: a move is an arrow from its point to its end") {
    for (const vec3<double> by : {vec3<double>{3, 0, 0}, vec3<double>{-1, 2, -2}, vec3<double>{0, 0, 1e-3}}) {
        const vec3<double> from{5, -1, 2};
        const auto faces = abut::io::detail::arrow_faces(from, by);
        REQUIRE(faces.size() == 24);
        std::vector<vec3<double>> corners;
        std::vector<abut::face> numbers;
        for (const auto& t : faces) {
            const auto first = static_cast<std::uint32_t>(corners.size());
            corners.insert(corners.end(), {t.a, t.b, t.c});
            numbers.push_back({first, first + 1, first + 2});
        }
        const auto joined = abut::welded(abut::serial{}, abut::mesh<double>(corners, numbers));
        const auto report = abut::validate(abut::serial{}, joined, {.measures = true});
        CHECK(report.closed());
        CHECK(report.measures->outward());
        const double square = dot(by, by);
        double least = 1, most = 0;
        for (const vec3<double>& p : corners) {
            least = std::min(least, dot(p - from, by) / square);
            most = std::max(most, dot(p - from, by) / square);
        }
        CHECK(least == Approx(0).margin(1e-12));
        CHECK(most == Approx(1));
    }
    abut::io::gltf_scene scene;
    CHECK(scene.add_move("a", {0, 0, 0}, {0, 0.5, 1}).number == 0);
    const glb file(scene);
    const json& set = file.ours().at("sets").at(0);
    CHECK(set.at("count") == 24);
    CHECK(set.at("role") == "move");
    CHECK(set.at("move") == json::array({0, 0.5, 1}));
    for (const vec3<double> by : {vec3<double>{0, 0, 0}, vec3<double>{0, 1e200, 0}}) {
        CHECK(refusal([&] { scene.add_move("a", {0, 0, 0}, by); }) ==
              "abut::io::gltf_scene::add_move: expected a move of a length above 0 whose square is finite");
    }
}

/// What `contact_patches` and `sweep` say, by their members.
struct patch_curve {
    struct pair {
        std::uint32_t a, b;
    };
    std::vector<vec3<double>> points;
    [[nodiscard]] std::size_t segments() const { return points.size(); }
    [[nodiscard]] std::vector<pair> pairs_of(std::size_t) const { return {{0, 0}}; }
};
struct patch {
    struct corner {
        vec3<double> point;
    };
    std::vector<patch_curve> curves;
    vec3<double> center;
    double area, depth;
    std::vector<corner> points;
};
struct sweep_hit {
    std::uint32_t id;
    float t;
    vec3<float> point, normal;
};

TEST_CASE("write_gltf: patches are surfaces with numbers, and their curves") {
    // A rectangle of 2 by 3, a pentagon without a curve, and a point.
    const std::vector<vec3<double>> rectangle{{0, 0, 5}, {2, 0, 5}, {2, 3, 5}, {0, 3, 5}};
    const std::vector<patch> patches{
        {{{rectangle}}, {1, 1.5, 5}, 6, 0.25, {{rectangle[0]}, {rectangle[1]}, {rectangle[2]}, {rectangle[3]}}},
        {{}, {0, 0, 0}, 1, 0, {{{-1, -1, 0}}, {{1, -1, 0}}, {{2, 0, 0}}, {{1, 1, 0}}, {{-1, 1, 0}}}},
        {{}, {7, 8, 9}, 0, 0, {{{7, 8, 9}}}}};
    abut::io::gltf_scene scene;
    CHECK(scene.add_patches("p", patches).number == 0);
    CHECK(scene.add_patches("none", std::vector<patch>{}).number == 2);
    const glb file(scene);
    const json& set = file.ours().at("sets").at(0);
    CHECK(set.at("kind") == "surfaces");
    CHECK(set.at("role") == "patches");
    CHECK(set.at("count") == 3);
    CHECK(file.numbers<float>(set.at("numbers").at("area")) == std::vector<float>{6, 1, 0});
    CHECK(file.numbers<float>(set.at("numbers").at("depth")) == std::vector<float>{0.25f, 0, 0});
    CHECK(file.numbers<std::uint8_t>(set.at("hit")) == std::vector<std::uint8_t>{1, 1, 1});
    const auto positions = file.floats(set, "POSITION");
    const auto ids = file.ids(set);
    REQUIRE(positions.size() == std::size_t{3} * 42 * 3);
    std::array<double, 3> areas{};
    for (std::size_t i = 0; i < ids.size(); i += 3) {
        const float* const p = &positions[3 * i];
        areas[ids[i]] += 0.5 * static_cast<double>((p[3] - p[0]) * (p[7] - p[1]) - (p[4] - p[1]) * (p[6] - p[0]));
    }
    CHECK(areas == std::array<double, 3>{6, 5, 0});
    CHECK(std::vector<float>(positions.end() - 3, positions.end()) == std::vector<float>{7, 8, 9});
    const json& borders = file.ours().at("sets").at(1);
    CHECK(borders.at("name") == "p: borders");
    CHECK(borders.at("role") == "curves");
    CHECK(borders.at("count") == 4);
    CHECK(file.ours().at("sets").at(2).at("count") == 0);
    CHECK_FALSE(file.ours().at("sets").at(2).contains("numbers"));
}

TEST_CASE("write_gltf: shapes that sweep go to where they touch") {
    const abut::capsules<float> movers{{{{0, 0, 2}, {0, 0, 3}}, 1}, {{{5, 0, 0}, {5, 0, 0}}, 0.5f}};
    const abut::points<float> ways{{4, 0, 0}, {0, 2, 0}};
    const std::vector<sweep_hit> hits{{2, 0.75f, {4, 0, 2}, {-1, 0, 0}}, {0xFFFFFFFF, INFINITY, {}, {}}};
    abut::io::gltf_scene scene;
    const auto met = scene.add("met", corner_of_cube);
    CHECK(scene.add_sweep("s", movers, ways, hits, met).number == 1);
    const glb file(scene);
    const json& set = file.ours().at("sets").at(1);
    CHECK(set.at("moves") == true);
    CHECK(file.numbers<std::uint8_t>(set.at("hit")) == std::vector<std::uint8_t>{1, 0});
    const auto positions = file.floats(set, "POSITION");
    const auto moves = file.numbers<float>(file.primitive(file.node(set)).at("targets").at(0).at("POSITION"));
    REQUIRE(positions.size() == std::size_t{2} * 960 * 3);
    REQUIRE(moves.size() == positions.size());
    bool is_on_it = true, is_moved = true;
    float top = 0;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const bool first = i < positions.size() / 2;
        const float x = positions[i] - (first ? 0.0f : 5.0f), y = positions[i + 1], z = positions[i + 2];
        const float up = first ? z - std::clamp(z, 2.0f, 3.0f) : z;
        is_on_it = is_on_it && std::fabs(std::sqrt(x * x + y * y + up * up) - (first ? 1.0f : 0.5f)) < 1e-5f;
        is_moved = is_moved && std::fabs(moves[i] - (first ? 3.0f : 0.0f)) < 1e-5f &&
                   std::fabs(moves[i + 1] - (first ? 0.0f : 2.0f)) < 1e-5f && moves[i + 2] == 0;
        if (first) top = std::max(top, z);
    }
    CHECK(is_on_it);
    CHECK(is_moved);
    CHECK(top > 3.9f);
    const json& lines = file.ours().at("sets").at(2);
    CHECK(lines.at("role") == "ways");
    CHECK(file.floats(lines, "POSITION") ==
          std::vector<float>{0, 0, 2.5f, 3, 0, 2.5f, 3, 0, 2.5f, 4, 0, 2.5f, 5, 0, 0, 5, 2, 0, 5, 2, 0, 5, 2, 0});
    const json& result = file.ours().at("results").at(0);
    CHECK(result.at("kind") == "sweeps");
    CHECK(result.at("count") == 1);
    CHECK(result.at("a") == 1);
    CHECK(result.at("b") == 0);
    const auto of = [&](const char* name) { return result.at("accessors").at(name); };
    CHECK(file.numbers<std::uint32_t>(of("a_ids")) == std::vector<std::uint32_t>{0});
    CHECK(file.numbers<std::uint32_t>(of("b_ids")) == std::vector<std::uint32_t>{2});
    CHECK(file.numbers<float>(of("points")) == std::vector<float>{4, 0, 2});
    CHECK(file.numbers<float>(of("times")) == std::vector<float>{0.75f});
    CHECK(refusal([&] { scene.add_sweep("s", movers, abut::points<float>{{1, 0, 0}}, hits, met); }) ==
          "abut::io::gltf_scene::add_sweep: expected as many ways and hits as shapes, 2, found 1 and 2");
    // Other shapes that can sweep: what is drawn lies in their boxes, and reaches all sides.
    const auto reaches = [&](const auto& shape) {
        const auto surface = abut::io::detail::convex_surface(shape, abut::io::detail::ball_mesh(2));
        abut::aabb<double> box{surface.points[0], surface.points[0]};
        for (const auto& p : surface.points) box = merge(box, abut::aabb<double>{p, p});
        const auto expected = bounds(shape);
        return box.lower == expected.lower && box.upper == expected.upper;
    };
    CHECK(reaches(abut::aabb<double>{{0, 1, 2}, {3, 4, 5}}));
    CHECK(reaches(abut::triangle<double>{{0, 0, 0}, {1, 0, 0}, {0, 1, 4}}));
    CHECK(reaches(abut::segment<double>{{0, 0, 0}, {1, 2, 3}}));
    CHECK(reaches(vec3<double>{1, 2, 3}));
    const std::vector<vec3<double>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}};
    CHECK(reaches(abut::hull<double>(corners.data(), corners.size())));
}

TEST_CASE("write_gltf: how much of a step is free") {
    abut::io::gltf_scene scene;
    const auto a = scene.add("a", corner_of_cube);
    scene.add_safe_step(a, a, 0.3, {.step = 2});
    const glb file(scene);
    const json& result = file.ours().at("results").at(0);
    CHECK(result.at("kind") == "safe_step");
    CHECK(result.at("part") == 0.3);
    CHECK(result.at("step") == 2);
    CHECK(result.at("count") == 0);
    for (const auto& [part, found] : {std::pair{-0.5, "-0.5"}, std::pair{1.5, "1.5"}, std::pair{std::nan(""), "nan"}}) {
        CHECK(refusal([&, wrong = part] { scene.add_safe_step(a, a, wrong); }) ==
              "abut::io::gltf_scene::add_safe_step: expected a part from 0 to 1, found " + std::string(found));
    }
}

TEST_CASE("write_html: the scene lies between the page's tags, in base64") {
    const io_test::scratch folder;
    const std::string opening = "<script id=\"abut-scene\" type=\"application/octet-stream;base64\">", closing = "</script>";
    const auto page = folder.file("page.html", "<html>" + opening + closing + "</html>\n");
    abut::io::gltf_scene scene;
    scene.add("a", corner_of_cube);
    abut::io::write_html(folder / "a.html", scene, page);
    const std::string text = io_test::content(folder / "a.html"), begin = "<html>" + opening, end = closing + "</html>\n";
    REQUIRE(text.starts_with(begin));
    REQUIRE(text.ends_with(end));
    const auto inside = abut::io::detail::base64_decoded(
        std::string_view(text).substr(begin.size(), text.size() - begin.size() - end.size()));
    REQUIRE(inside);
    CHECK(std::string(inside->begin(), inside->end()) == glb::bytes_of(scene));
    const auto none = folder.file("none.html", "<html></html>"),
               two = folder.file("two.html", opening + closing + opening + closing);
    CHECK(io_test::refusal([&] { abut::io::write_html(folder / "b.html", scene, none); }) ==
          none.string() + ": expected " + opening + closing + " once, found it nowhere");
    CHECK(
        io_test::refusal([&] { abut::io::write_html(folder / "b.html", scene, two); }).ends_with("found it more than once"));
    CHECK_FALSE(std::filesystem::exists(folder / "b.html"));
}

TEST_CASE("write_gltf: the Khronos validator finds nothing wrong") {
    const std::string validate = std::filesystem::absolute(io_test::seeds().parent_path() / "validate_gltf.mjs");
    if (std::system(("node '" + validate + "' >/dev/null 2>&1").c_str()) != 0) {
        ABUT_SKIP("validator", "node or npm's gltf-validator is not there (cmake/test.sh brings it)");
    }
    const io_test::scratch folder;
    const std::vector<std::uint8_t> hit{0, 1, 0, 1};
    const auto t1 =
        corner_of_cube.with_vertices(abut::serial{}, std::vector<vec3<float>>{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {0, 0, 9}});
    abut::io::gltf_scene scene;
    const auto a = scene.add("mesh", corner_of_cube, {.hit = hit});
    scene.add("degenerate", abut::triangle<float>{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
    scene.add("few", abut::spheres<float>{{{{0, 0, 0}, 1}, {{1, 1, 1}, 0}}});
    const auto b = scene.add("many", abut::equal_spheres<double>{std::vector<vec3<double>>(2000), 0.5},
                             {.hit = std::vector<std::uint8_t>(2000, 1)});
    scene.add("segments", abut::segments<float>{{{{0, 0, 0}, {1, 0.1f, 1}}}});
    scene.add("points", abut::points<double>{std::vector<vec3<double>>{{0.1, 1e-310, -0.0}}});
    scene.add("boxes", abut::boxes<float>{{{{0, 0, 0}, {0, 1, 2}}}});
    scene.add("none", abut::spheres<float>{});
    const auto m = scene.add("moving", abut::moving(corner_of_cube, t1));
    scene.add_frames("frames", std::vector<abut::mesh<float>>{t1, corner_of_cube, t1});
    scene.add_pairs(a, b, std::vector<contact>(3));
    scene.add_contacts(a, b, std::vector<contact>{{0, 0, {1, 2, 3}, {0, 0, 1}, 1}});
    scene.add_impacts(m, m, std::vector<impact>(2));
    abut::io::write_gltf(folder / "all.glb", scene);
    abut::io::gltf_scene far_off;
    far_off.add("far", abut::mesh<double>{{{1e7, 0, 0}, {1e7 + 1, 0, 0}, {1e7, 1, 0}}, {{0, 1, 2}}});
    abut::io::write_gltf(folder / "far.glb", far_off);
    abut::io::write_gltf(folder / "empty.glb", abut::io::gltf_scene{});
    const auto run = [&](const std::string& names) {
        return std::system(("cd '" + (folder / "").string() + "' && node '" + validate + "' " + names).c_str());
    };
    CHECK(run("all.glb far.glb empty.glb") == 0);
    // And that it does find what is.
    std::string bytes = io_test::content(folder / "far.glb");
    bytes.replace(bytes.find("\"max\":["), 8, "\"max\":[7");
    folder.file("bad.glb", bytes);
    CHECK(run("bad.glb >/dev/null") != 0);
}

}  // namespace io_test::write_gltf_cases
