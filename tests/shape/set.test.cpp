// SPDX-License-Identifier: MIT
#include <abut/shape/set.hpp>

#include <cmath>
#include <limits>
#include <type_traits>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

static_assert(shape_set<mesh<float>> && shape_set<triangle_soup<double>> && shape_set<spheres<float>> &&
              shape_set<equal_spheres<double>>);
static_assert(shape_view<mesh_view<double>> && shape_view<spheres_view<float>> && shape_view<single_view<sphere<float>>>);
static_assert(!shape_set<int> && !shape_set<mesh_view<float>> && !shape_view<mesh<float>>);
static_assert(std::is_trivially_copyable_v<mesh_view<float>> && std::is_trivially_copyable_v<equal_spheres_view<double>>);

namespace {

/// Runs `make`, which must throw invalid_geometry about this element.
template <class Make>
void check_refused(const Make& make, const char* function, std::size_t index, double value, const char* message) {
    try {
        make();
        FAIL("accepted");
    } catch (const invalid_geometry& e) {
        CHECK(e.function() == function);
        CHECK(e.index() == index);
        CHECK(((std::isnan(value) && std::isnan(e.value())) || e.value() == value));
        CHECK(std::string(e.what()) == message);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("sets: what is no geometry is refused with its index and value", "", float, double) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN(), inf = std::numeric_limits<T>::infinity();
    const std::vector<vec3<T>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    check_refused([&] { mesh<T>({{0, 0, 0}, {0, nan, inf}}, {}); }, "abut::mesh", 1, nan,
                  "abut::mesh: vertex 1: y is not finite (nan)");
    check_refused([&] { mesh<T>({{0, 0, -inf}}, {}); }, "abut::mesh", 0, -inf,
                  "abut::mesh: vertex 0: z is not finite (-inf)");
    check_refused([&] { mesh<T>(corners, {{0, 1, 2}, {0, 1, 3}, {9, 9, 9}}); }, "abut::mesh", 1, 3,
                  "abut::mesh: face 1: vertex index out of range, there are 3 vertices (3)");
    check_refused([&] { triangle_soup<T>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {1, 0, 0}, {inf, 1, 0}}}); },
                  "abut::triangle_soup", 1, inf, "abut::triangle_soup: triangle 1: x is not finite (inf)");
    check_refused([&] { spheres<T>({{{0, 0, 0}, 1}, {{0, 0, 0}, -2}}); }, "abut::spheres", 1, -2,
                  "abut::spheres: sphere 1: radius is negative (-2)");
    check_refused([&] { spheres<T>({{{0, 0, 0}, nan}}); }, "abut::spheres", 0, nan,
                  "abut::spheres: sphere 0: radius is not finite (nan)");
    check_refused([&] { equal_spheres<T>({}, -1); }, "abut::equal_spheres", 0, -1,
                  "abut::equal_spheres: sphere 0: radius is negative (-1)");
    check_refused([&] { equal_spheres<T>({{0, 0, 0}, {0, 0, nan}}, 1); }, "abut::equal_spheres", 1, nan,
                  "abut::equal_spheres: sphere 1: z is not finite (nan)");
}

TEMPLATE_TEST_CASE("sets: every finite input is legal", "", float, double) {
    using T = TestType;
    constexpr T huge = std::numeric_limits<T>::max(), tiny = std::numeric_limits<T>::denorm_min();
    const mesh<T> extremes({{huge, -huge, tiny}, {-huge, T(-0.0), -tiny}, {0, 0, 0}}, {{0, 1, 2}, {0, 0, 0}, {0, 1, 2}});
    CHECK(extremes.size() == 3);
    CHECK(extremes.view()[0].a == vec3<T>{huge, -huge, tiny});
    CHECK(spheres<T>({{{0, 0, 0}, 0}, {{huge, huge, huge}, huge}}).size() == 2);
    CHECK(mesh<T>().size() == 0);
    CHECK(mesh<T>({}, {}).size() == 0);
    CHECK(spheres<T>().size() == 0);
    CHECK(equal_spheres<T>({}, 0).size() == 0);
}

TEST_CASE("sets: the first bad element is found on any number of threads") {
    std::vector<vec3<float>> centers(100'000, {1, 2, 3});
    for (const std::size_t bad : {std::size_t{99'999}, std::size_t{50'001}, std::size_t{7}}) {
        centers[bad].z = std::numeric_limits<float>::infinity();
        for (const int threads : {1, 2, 7}) {
            try {
                equal_spheres<float>(openmp{.threads = threads}, centers, 1.0f);
                FAIL("accepted");
            } catch (const invalid_geometry& e) {
                CHECK(e.index() == bad);
            }
        }
    }
}

TEST_CASE("sets: copies share their storage") {
    const test::torus<float> shape(8, 6, 2, 1);
    const mesh<float> a(shape.vertices, shape.faces), b = a, c = copy_to(openmp{}, a);
    CHECK(a.view().vertices.data == b.view().vertices.data);
    CHECK(a.view().faces.data == c.view().faces.data);
}

TEST_CASE("views: strided arrays of the caller are read in place") {
    struct vertex {
        vec3<double> position;
        double weight;
    };
    struct grain {
        int id;
        sphere<float> ball;
    };
    const std::vector<vertex> vertices{{{0, 0, 0}, 9}, {{1, 0, 0}, 9}, {{0, 2, 0}, 9}, {{0, 0, 3}, 9}};
    const std::vector<face> faces{{0, 1, 2}, {3, 2, 1}};
    const mesh_view<double> triangles(&vertices[0].position, 4, faces.data(), 2, sizeof(vertex));
    CHECK(triangles.size() == 2);
    CHECK(triangles[1].a == vec3<double>{0, 0, 3});
    CHECK(triangles[1].b == vec3<double>{0, 2, 0});
    const std::vector<grain> grains{{1, {{1, 2, 3}, 4}}, {2, {{5, 6, 7}, 8}}};
    const spheres_view<float> balls(&grains[0].ball, 2, sizeof(grain));
    CHECK(balls[1].center == vec3<float>{5, 6, 7});
    CHECK(balls[1].radius == 8);
}
