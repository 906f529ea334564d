// SPDX-License-Identifier: MIT
#include <abut/collide/validate.hpp>

#include <cstdint>
#include <vector>

#include <abut/io/read.hpp>

#include "io/support.hpp"
#include "shape/feature_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

namespace {

/// What shared/data/README.md says of a file.
struct known_flaws {
    const char* file;
    std::size_t vertices, faces, open, bad;
    std::uint64_t components;  // 0 where it does not say
    std::size_t zero_area, coincident, more_than_one_fan, unused, duplicates;
};

const known_flaws truths[] = {
    {"meshes/armadillo_2766.ply", 1385, 2766, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/armadillo_27674.ply", 13839, 27674, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/armadillo_99994.ply", 49999, 99994, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/armadillo_138376.ply", 69190, 138376, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/armadillo_345944.ply", 172974, 345944, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/armadillo_rollers326.ply", 10491, 20978, 0, 0, 1, 0, 0, 0, 0, 0},
    {"meshes/stanford-bunny.ply", 35947, 69451, 223, 0, 0, 0, 0, 0, 1113, 0},
    {"meshes/fandisk.ply", 6475, 12946, 0, 0, 0, 0, 0, 0, 0, 0},
    {"meshes/ogre.ply", 62194, 124008, 236, 0, 44, 4, 9, 3, 0, 0},
    {"meshes/spot.obj", 2930, 5856, 0, 0, 0, 0, 0, 0, 0, 0},
    {"meshes/cow.obj", 2903, 5804, 0, 0, 0, 0, 0, 1, 0, 0},
    {"meshes/teapot.obj", 3644, 6320, 1036, 0, 0, 0, 403, 38, 0, 0},
    {"meshes/suzanne.obj", 507, 968, 42, 1, 0, 0, 2, 0, 0, 1},
    {"meshes/env.obj", 6540, 2180, 6540, 0, 2180, 0, 4468, 0, 0, 0},
    {"meshes/rob.obj", 648, 216, 648, 0, 216, 0, 507, 0, 0, 0},
    {"ccd/cloth-ball/frame0.ply", 46598, 92230, 960, 0, 2, 0, 0, 0, 0, 0},
    {"ccd/cloth-funnel/frame0.ply", 9450, 18484, 408, 0, 4, 0, 0, 0, 0, 0},
    {"ccd/armadillo-rollers/frame0.ply", 12135, 24242, 0, 0, 7, 0, 0, 0, 0, 0},
    {"ccd/n-body-simulation/frame0.ply", 73960, 146480, 240, 0, 305, 0, 75, 0, 0, 0},
    {"ccd/rod-twist/frame0.ply", 39940, 79864, 0, 0, 4, 0, 0, 0, 0, 0},
};

template <class T>
mesh<T> read(const char* file) {
    return io::read_mesh<T>(io_test::meshes()->parent_path() / file);
}

/// Coincident vertices put into one, by what the report says of them.
mesh<double> welded(const char* file) {
    const auto data = io::read_mesh_data<double>(io_test::meshes()->parent_path() / file);
    std::vector<std::uint32_t> to(data.vertices.size(), 0);
    for (const auto& [vertex, of] : validate(serial{}, mesh<double>(data.vertices, data.faces)).coincident_vertices) {
        to[vertex] = of + 1;
    }
    std::vector<vec3<double>> vertices;
    for (std::size_t v = 0; v < to.size(); ++v) {
        if (to[v] != 0) {
            to[v] = to[to[v] - 1];
        } else {
            vertices.push_back(data.vertices[v]);
            to[v] = static_cast<std::uint32_t>(vertices.size() - 1);
        }
    }
    std::vector<face> faces;
    for (const face& f : data.faces) faces.push_back({to[f[0]], to[f[1]], to[f[2]]});
    return {vertices, faces};
}

}  // namespace

TEMPLATE_TEST_CASE("validate: what is known of the real meshes", "", float, double) {
    if (!io_test::meshes()) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    for (const known_flaws& known : truths) {
        // Rounding their doubles to float may move vertices onto one another, and onto lines.
        const bool of_doubles = std::string_view(known.file).starts_with("ccd/");
        if (sizeof(TestType) == 4 && of_doubles) continue;
        CAPTURE(known.file);
        const mesh<TestType> m = read<TestType>(known.file);
        const mesh_report r = validate(serial{}, m);
        CHECK(r.vertices == known.vertices);
        CHECK(r.faces == known.faces);
        CHECK(r.boundary_edges.size() == known.open);
        CHECK(r.nonmanifold_edges.size() == known.bad);
        CHECK(r.closed() == (known.open == 0 && known.bad == 0));
        if (r.closed()) CHECK(2 * r.edges == 3 * r.faces);
        if (known.components > 0) CHECK(r.components == known.components);
        CHECK(r.faces_with_repeated_index.empty());
        CHECK(r.faces_out_of_range.empty());
        CHECK(r.nonfinite_vertices.empty());
        CHECK(r.zero_area_faces.size() == known.zero_area);
        CHECK(r.coincident_vertices.size() == known.coincident);
        CHECK(r.nonmanifold_vertices.size() == known.more_than_one_fan);
        CHECK(r.unused_vertices.size() == known.unused);
        CHECK(r.duplicate_faces.size() == known.duplicates);
        for (const int threads : {2, 5}) CHECK(validate(openmp{.threads = threads}, m) == r);
    }
}

TEST_CASE("validate: the numbers that shared/data/README.md gives beside the tables") {
    if (!io_test::meshes()) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const auto report = [](const char* file) { return validate(openmp{}, read<double>(file)); };
    CHECK(report("meshes/armadillo_345944.ply").euler_characteristic == 2);
    const mesh_report cow = report("meshes/cow.obj");
    CHECK(cow.euler_characteristic == 1);
    CHECK(cow.closed());
    CHECK_FALSE(cow.manifold());
    CHECK(report("meshes/stanford-bunny.ply").euler_characteristic == 2 - 5);  // one piece with five holes
    CHECK(report("ccd/cloth-ball/frame0.ply").edges == 138'825);
    CHECK(report("ccd/cloth-funnel/frame0.ply").edges == 27'930);
    CHECK(report("ccd/armadillo-rollers/frame0.ply").edges == 36'363);
    CHECK(report("ccd/n-body-simulation/frame0.ply").edges == 219'840);
    CHECK(report("ccd/rod-twist/frame0.ply").edges == 119'796);
    // One triangle occurs twice, with opposite sides.
    const mesh_report suzanne = report("meshes/suzanne.obj");
    REQUIRE(suzanne.duplicate_faces.size() == 1);
    CHECK(suzanne.duplicate_faces[0].reversed);
    CHECK_FALSE(suzanne.oriented());
}

TEST_CASE("validate: welded where its report says that vertices coincide") {
    if (!io_test::meshes()) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const struct {
        const char* file;
        std::size_t vertices, open, bad;
    } cases[] = {{"meshes/teapot.obj", 3241, 160, 0}, {"meshes/env.obj", 2072, 1856, 0}, {"meshes/rob.obj", 141, 96, 27}};
    for (const auto& known : cases) {
        CAPTURE(known.file);
        const mesh_report r = validate(serial{}, welded(known.file));
        CHECK(r.vertices == known.vertices);
        CHECK(r.boundary_edges.size() == known.open);
        CHECK(r.nonmanifold_edges.size() == known.bad);
        CHECK(r.coincident_vertices.empty());
    }
}

TEST_CASE("features: edges and vertices of the real meshes") {
    if (!io_test::meshes()) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    std::size_t read = 0;
    for (const char* file : {"meshes/fandisk.ply", "meshes/stanford-bunny.ply", "meshes/ogre.ply", "meshes/teapot.obj",
                             "meshes/suzanne.obj", "meshes/env.obj"}) {
        CAPTURE(file);
        const auto data = io::read_mesh_data<float>(io_test::meshes()->parent_path() / file);
        read += test::check_features(openmp{.threads = 2}, data.vertices, data.faces);
    }
    CHECK(read > 300'000);
}
