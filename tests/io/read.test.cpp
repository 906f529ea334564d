// SPDX-License-Identifier: MIT
#include <abut/io/read.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "io/support.hpp"
#include "support/catch.hpp"

namespace io_test::read_cases {

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

struct truth {
    const char* file;
    std::size_t vertices, faces;
    std::size_t open, bad;      // edges in one triangle, and in more than two
    std::array<double, 6> box;  // lowest, highest, to six digits
};

// The table that comes with the data; its counts and boxes were not made by these readers.
const std::vector<truth> truths{
    {"armadillo_2766.ply", 1385, 2766, 0, 0, {-0.419226, -0.498459, -0.382466, 0.421781, 0.500453, 0.379794}},
    {"armadillo_27674.ply", 13839, 27674, 0, 0, {-0.419375, -0.499742, -0.381398, 0.419098, 0.499953, 0.381004}},
    {"armadillo_99994.ply", 49999, 99994, 0, 0, {-0.419306, -0.499612, -0.381011, 0.418968, 0.499778, 0.381157}},
    {"armadillo_138376.ply", 69190, 138376, 0, 0, {-0.419306, -0.499612, -0.381011, 0.418968, 0.499778, 0.381157}},
    {"armadillo_345944.ply", 172974, 345944, 0, 0, {-0.419324, -0.499612, -0.381011, 0.419031, 0.499813, 0.381157}},
    {"armadillo_rollers326.ply", 10491, 20978, 0, 0, {-0.524729, 0.200002, -0.349703, 0.417437, 0.852461, 0.412886}},
    {"stanford-bunny.ply", 35947, 69451, 223, 0, {-0.09469, 0.032987, -0.061874, 0.061009, 0.187321, 0.0588}},
    {"fandisk.ply", 6475, 12946, 0, 0, {0, 12.6055, -2.68026, 4.8279, 17.85, 0}},
    {"ogre.ply", 62194, 124008, 236, 0, {-15.61, -0.008192, -5.456, 15.61, 32.03, 4.267}},
    {"spot.obj", 2930, 5856, 0, 0, {-0.471552, -0.736784, -0.668909, 0.471552, 0.953646, 1.049}},
    {"cow.obj", 2903, 5804, 0, 0, {-4.44583, -3.63704, -1.70141, 5.99809, 2.75972, 1.70141}},
    {"teapot.obj", 3644, 6320, 1036, 0, {-3, 0, -2, 3.434, 3.15, 2}},
    {"suzanne.obj", 507, 968, 42, 1, {-3.86125, 0.267311, 3.25233, -1.12688, 2.23606, 4.95545}},
    {"env.obj", 6540, 2180, 6540, 0, {-3004.5, -3004.5, -14.5, 2987.5, 3004.5, 2987.5}},
    {"rob.obj", 648, 216, 648, 0, {-500, -605, -425, 500, 605, 425}}};

template <class T>
std::array<double, 6> box_of(const std::vector<abut::vec3<T>>& vertices) {
    std::array<T, 6> box{vertices[0].x, vertices[0].y, vertices[0].z, vertices[0].x, vertices[0].y, vertices[0].z};
    for (const auto& v : vertices) {
        const std::array<T, 3> p{v.x, v.y, v.z};
        for (std::size_t i = 0; i < 3; ++i) {
            box[i] = std::min(box[i], p[i]);
            box[i + 3] = std::max(box[i + 3], p[i]);
        }
    }
    std::array<double, 6> result{};
    std::copy(box.begin(), box.end(), result.begin());
    return result;
}

/// Edges in one triangle, and edges in more than two.
std::array<std::size_t, 2> open_and_bad(const std::vector<std::array<std::uint32_t, 3>>& faces) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& f : faces) {
        for (std::size_t i = 0; i < 3; ++i)
            edges.push_back({std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])});
    }
    std::sort(edges.begin(), edges.end());
    std::array<std::size_t, 2> result{};
    for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
        while (next < edges.size() && edges[next] == edges[i]) ++next;
        if (next - i == 1) ++result[0];
        if (next - i > 2) ++result[1];
    }
    return result;
}

}  // namespace

TEMPLATE_TEST_CASE("read_mesh: real files have the counts and boxes that are known of them", "", float, double) {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    for (const truth& known : truths) {
        INFO(known.file);
        const auto data = abut::io::read_mesh_data<TestType>(*folder / known.file);
        CHECK(data.vertices.size() == known.vertices);
        CHECK(data.faces.size() == known.faces);
        CHECK(open_and_bad(data.faces) == std::array<std::size_t, 2>{known.open, known.bad});
        const auto box = box_of(data.vertices);
        for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(box[i] - known.box[i]) <= 5.1e-6 * std::abs(known.box[i]));
        const auto mesh = abut::io::read_mesh<TestType>(*folder / known.file);
        CHECK(mesh.size() == known.faces);
        CHECK(std::none_of(data.faces.begin(), data.faces.end(),
                           [](const auto& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }));
    }
}

TEST_CASE("read_mesh: the extension decides, in any case") {
    const io_test::scratch folder;
    CHECK(abut::io::read_mesh<float>(folder.file("a.OBJ", triangle)).size() == 1);
    CHECK(abut::io::read_mesh<double>(folder.file("a.obj", triangle)).size() == 1);
    CHECK(abut::io::read_mesh<float>(folder.file("a.Ply", io_test::content(io_test::seeds() / "ply/big.ply"))).size() == 3);
    for (const std::string name : {"a.3ds", "a", "obj", "a.obj.gz"}) {
        const auto path = folder.file(name, triangle);
        CHECK(io_test::refusal([&] { abut::io::read_mesh<float>(path); }) ==
              path.string() + ": expected a file name that ends with .obj, .ply, .stl, .off, .glb or .gltf");
    }
}

TEST_CASE("readers: a file that cannot be read is an error that names it") {
    const io_test::scratch folder;
    const auto path = folder / "missing.obj";
    CHECK(io_test::refusal([&] { abut::io::read_mesh<float>(path); }) ==
          path.string() + ": cannot be opened: No such file or directory");
    CHECK(io_test::refusal([&] { abut::io::read_spheres<float>(path); }) ==
          path.string() + ": cannot be opened: No such file or directory");
    std::filesystem::create_directory(folder / "folder.csv");
    CHECK(io_test::refusal([&] { abut::io::read_spheres<float>(folder / "folder.csv"); }) ==
          (folder / "folder.csv").string() + ": cannot be read: Is a directory");
}

TEST_CASE("readers: a file that says it is larger than all memory is an error that names it") {
    // Sparse: it takes no room. Few file systems have files so large; tmpfs does.
    const std::filesystem::path path = "/dev/shm/abut_test_sparse_" + std::to_string(getpid()) + ".obj";
    std::ofstream{path};
    std::error_code failed;
    std::filesystem::resize_file(path, 9'223'372'036'854'775'807, failed);
    if (failed) {
        std::filesystem::remove(path, failed);
        ABUT_SKIP("file system", "no file system here has a file of 2^63 - 1 bytes");
    }
    CHECK(io_test::refusal([&] { abut::io::read_mesh<float>(path); }) == path.string() + ": cannot be read: File too large");
    std::filesystem::remove(path);
}

TEST_CASE("readers: messages carry the path as it was given") {
    const io_test::scratch folder;
    const auto obj = folder.file("a.obj", triangle + "f 1 2\n"), csv = folder.file("a.csv", "1,2,3\n");
    CHECK(io_test::refusal([&] { abut::io::read_mesh<float>(obj); }) ==
          obj.string() + ":5: expected a face of at least 3 corners, found the end of the line");
    CHECK(io_test::refusal([&] { abut::io::read_spheres<float>(csv); }) ==
          csv.string() +
              ":1: expected 4 columns x,y,z,r, found 3 (spheres of one radius: read_equal_spheres(path, radius))");
}

TEST_CASE("read_spheres and read_equal_spheres make sets") {
    const io_test::scratch folder;
    const auto spheres = abut::io::read_spheres<double>(folder.file("a.csv", "x,y,z,r\n1,2,3,4\n5,6,7,0\n"));
    REQUIRE(spheres.size() == 2);
    CHECK(spheres.view()[1].center == abut::vec3<double>{5, 6, 7});
    CHECK(spheres.view()[0].radius == 4);
    const auto path = folder.file("b.csv", "1,2,3\n5,6,7\n");
    const auto equal = abut::io::read_equal_spheres<float>(path, 3);
    REQUIRE(equal.size() == 2);
    CHECK(equal.view()[1].center == abut::vec3<float>{5, 6, 7});
    CHECK(equal.view()[1].radius == 3);
    CHECK_THROWS_AS(abut::io::read_equal_spheres<float>(path, -1), abut::invalid_geometry);
}

TEST_CASE("readers: files larger than one read") {
    const io_test::scratch folder;
    std::string text;
    for (int i = 0; i < 20000; ++i) text += std::to_string(i) + ",0.5,-0.25,1e-3\n";
    const auto spheres = abut::io::read_spheres<float>(folder.file("a.csv", text));
    REQUIRE(spheres.size() == 20000);
    CHECK(spheres.view()[19999].center.x == 19999);
}

// Seeds of the fuzzers and what they found: each is read soundly, or refused with a message; none crashes.
TEST_CASE("readers: seeds and regressions") {
    std::size_t accepted = 0, refused = 0;
    for (const std::string kind : {"obj", "ply", "csv", "stl", "off", "gltf"}) {
        for (const auto& entry : std::filesystem::directory_iterator(io_test::seeds() / kind)) {
            INFO(entry.path().string());
            const std::string message = io_test::refusal([&] {
                if (kind == "csv") {
                    const std::string text = io_test::content(entry.path());
                    try {
                        abut::io::parse_spheres<double>(text, "seed");
                    } catch (const abut::io_error&) {
                        abut::io::parse_centers<float>(text, "seed");
                    }
                } else {
                    abut::io::read_mesh<float>(entry.path());
                    abut::io::read_mesh<double>(entry.path());
                }
            });
            const bool is_accepted = message == "accepted";
            CHECK((is_accepted || message.find("expected") != message.npos));
            (is_accepted ? accepted : refused) += 1;
        }
    }
    std::printf("seeds: %zu read, %zu refused\n", accepted, refused);
    CHECK(accepted >= 24);
    CHECK(refused >= 1);
}

}  // namespace io_test::read_cases
