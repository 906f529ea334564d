// SPDX-License-Identifier: MIT
#include <abut/io/read_parts.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::parts_cases {

namespace {

using faces = std::vector<std::array<std::uint32_t, 3>>;
using points = std::vector<abut::vec3<double>>;

/// Two meshes of one triangle each, of which the second has a name; zeros but for two vertices.
std::string document(const std::string& nodes, const std::string& roots = "[0]") {
    return "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":" + roots + "}],\"nodes\":" + nodes +
           ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]},"
           "{\"name\":\"m\\u00e9\",\"primitives\":[{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0}}]},"
           "{\"primitives\":[{\"mode\":0,\"attributes\":{\"POSITION\":0}}]}],"
           "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
           "\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":1}}}],"
           "\"bufferViews\":[{\"buffer\":0,\"byteLength\":2},{\"buffer\":0,\"byteOffset\":4,\"byteLength\":24}],"
           // 1, 2; (2, 0, 0), (0, 1, 0)
           "\"buffers\":[{\"byteLength\":28,\"uri\":\"data:;base64,AQIAAAAAAEAAAAAAAAAAAAAAAAAAAIA/AAAAAA==\"}]}";
}
auto parse(const std::string& text) { return abut::io::parse_gltf_parts<double>(text, "t.gltf"); }

const points corners{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};

}  // namespace

TEST_CASE("parts of glTF: nodes that turn and move share their mesh, others have one of their own") {
    const std::string nodes =
        "[{\"name\":\"house\",\"mesh\":0,\"translation\":[1,2,3],\"children\":[1,2,3]},"
        "{\"mesh\":0,\"rotation\":[0,0,0.70710678118654752,0.70710678118654752]},"
        "{\"mesh\":1,\"scale\":[1,3,1]},{\"mesh\":2,\"name\":\"points\",\"children\":[4]},{\"name\":\"mirror\",\"mesh\":0,"
        "\"matrix\":[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]";
    const auto scene = parse(document(nodes));
    REQUIRE(scene.parts.size() == 4);
    CHECK(scene.parts[0].name == "house");
    CHECK(scene.parts[1].name.empty());
    CHECK(scene.parts[2].name == "m\xc3\xa9");
    CHECK(scene.parts[3].name == "mirror");
    CHECK(scene.parts[0].mesh == scene.parts[1].mesh);
    CHECK(scene.meshes[scene.parts[0].mesh].vertices == corners);
    CHECK(scene.meshes[scene.parts[0].mesh].faces == faces{{0, 1, 2}});
    CHECK(scene.parts[0].pose == abut::rigid<double>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 2, 3}});
    const abut::vec3<double> turned = place(scene.parts[1].pose, corners[1]);
    CHECK(std::abs(turned.x - 1) + std::abs(turned.y - 4) + std::abs(turned.z - 3) < 1e-15);
    const auto& stretched = scene.meshes[scene.parts[2].mesh];
    CHECK(scene.parts[2].pose == abut::rigid<double>{});
    CHECK(stretched.vertices == points{{1, 2, 3}, {3, 2, 3}, {1, 5, 3}, {1, 2, 3}, {3, 2, 3}, {1, 5, 3}});
    CHECK(stretched.faces == faces{{0, 1, 2}, {3, 4, 5}});
    const auto& mirrored = scene.meshes[scene.parts[3].mesh];
    CHECK(mirrored.vertices == points{{1, 2, 3}, {-1, 2, 3}, {1, 3, 3}});
    CHECK(mirrored.faces == faces{{0, 2, 1}});
    // The same triangles as in one mesh, in the same order.
    const auto whole = abut::io::parse_gltf<double>(document(nodes), "t.gltf");
    points placed;
    for (const auto& part : scene.parts) {
        for (const auto& v : scene.meshes[part.mesh].vertices) placed.push_back(place(part.pose, v));
    }
    REQUIRE(whole.vertices.size() == placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto off = placed[i] - whole.vertices[i];
        CHECK(std::sqrt(dot(off, off)) < 1e-15);
    }
}

TEST_CASE("parts of glTF: none, and what is refused") {
    CHECK(parse("{\"asset\":{\"version\":\"2.0\"}}").parts.empty());
    CHECK(parse(document("[{}]")).parts.empty());
    CHECK(io_test::refusal([] { parse(document("[{\"mesh\":3}]")); }).find("a number of 'meshes' from 0 to 2, found '3'") !=
          std::string::npos);
    CHECK(io_test::refusal([] {
              abut::io::parse_gltf_parts<float>(document("[{\"mesh\":0,\"translation\":[1e39,0,0]}]"), "t.gltf");
          }).find("expected finite places of meshes, found '0'") != std::string::npos);
    CHECK(io_test::refusal([] { parse(document("[{\"mesh\":0,\"name\":7}]")); }).find("a string as 'name'") !=
          std::string::npos);
}

TEST_CASE("parts of a table: files, names and poses") {
    const io_test::scratch folder;
    const std::string triangle = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.file("a.obj", triangle);
    folder.file("b c.off", "OFF\n3 1 0\n0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n");
    const auto table = folder.file("parts.csv",
                                   "file,name,x,y,z,qw,qx,qy,qz\n# all of it\n\na.obj, left wall ,1,2,3\n"
                                   "b c.off,right,0,0,0.1, 2e300,0,0,2e300\r\na.obj,left wall,0,0,0,1,0,0,0\n");
    const auto scene = abut::io::read_parts<double>(table);
    REQUIRE(scene.parts.size() == 3);
    CHECK(scene.meshes.size() == 2);
    CHECK(scene.parts[0].name == "left wall");
    CHECK(scene.parts[1].name == "right");
    CHECK(scene.parts[2].mesh == scene.parts[0].mesh);
    CHECK(scene.meshes[1].vertices == corners);
    CHECK(scene.parts[0].pose == abut::rigid<double>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 2, 3}});
    CHECK(scene.parts[1].pose == abut::rigid<double>{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0.1}});
    CHECK(scene.parts[2].pose == abut::rigid<double>{});
    const auto one = abut::io::read_parts<double>(folder / "a.obj");
    REQUIRE(one.parts.size() == 1);
    CHECK(one.parts[0].name == "a.obj");
    CHECK(one.meshes[0].vertices == corners);

    const auto refused = [&](const std::string& row) {
        const auto path = folder.file("bad.csv", "file,name,x,y,z\n" + row);
        const std::string why = io_test::refusal([&] { abut::io::read_parts<float>(path); });
        const std::string file = path.string();
        return why.starts_with(file) ? why.substr(file.size()) : why;
    };
    CHECK(refused("a.obj\n") == ":2: expected ',' after the file of a mesh, found the end of the line");
    CHECK(refused("a.obj,b\n") == ":2: expected ',' after the name of a part, found the end of the line");
    CHECK(refused("a.obj,,1,2,3\n") == ":2: expected the name of a part, found ','");
    CHECK(refused("a.obj,b,1,2\n") == ":2: expected ',' after the y coordinate of a place, found the end of the line");
    CHECK(refused("a.obj,b,1,2,x\n") == ":2: expected the z coordinate of a place, found 'x'");
    CHECK(refused("a.obj,b,1,2,1e39\n") == ":2: expected a finite number (the z coordinate of a place), found '1e39'");
    CHECK(refused("a.obj,b,1,2,3,1\n") == ":2: expected ',' after a number of a quaternion, found the end of the line");
    CHECK(refused("a.obj,b,1,2,3,0,0,0,0\n") == ":2: expected a quaternion qw,qx,qy,qz that is not 0");
    CHECK(refused("a.obj,b,1,2,3,1,0,0,0,0\n") == ":2: expected the end of the line after 5 or 9 columns, found ','");
    CHECK(refused("../a.obj,b,1,2,3\n") == ": expected files in the folder of this one, found '../a.obj'");
    CHECK(refused("none.obj,b,1,2,3\n").find("none.obj: cannot be opened") != std::string::npos);
}

}  // namespace io_test::parts_cases
