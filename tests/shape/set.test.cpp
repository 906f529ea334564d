// SPDX-License-Identifier: MIT
#include <abut/shape/set.hpp>

#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/shape/hulls.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/moving_shape.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

static_assert(shape_set<mesh<float>> && shape_set<edge_mesh<float>> && shape_set<equal_spheres<double>> &&
              shape_set<triangle_soup<double>> && shape_set<spheres<float>> && shape_set<points<float>> &&
              shape_set<segments<double>> && shape_set<capsules<float>> && shape_set<cylinders<float>> &&
              shape_set<cones<double>> && shape_set<boxes<float>> &&
              shape_set<shapes<plane<double>>>);
static_assert(shape_view<mesh_view<double>> && shape_view<spheres_view<float>> && shape_view<single_view<sphere<float>>> &&
              shape_view<edge_mesh_view<float>> && shape_view<points_view<double>> && shape_view<segments_view<float>> &&
              shape_view<capsules_view<float>> && shape_view<cylinders_view<double>> && shape_view<cones_view<float>> &&
              shape_view<boxes_view<double>>);
static_assert(!shape_set<int> && !shape_set<mesh_view<float>> && !shape_view<mesh<float>>);
static_assert(std::is_trivially_copyable_v<mesh_view<float>> && std::is_trivially_copyable_v<equal_spheres_view<double>>);
static_assert(std::same_as<triangle_soup<float>, shapes<triangle<float>>>);

// What makes a type a shape, on the least that does and on types that lack one thing each.

namespace other {

template <abut::scalar T>
struct pebble {  // its scalar type is the template's argument
    abut::vec3<T> at;
};
template <abut::scalar T>
constexpr abut::aabb<T> bounds(const pebble<T>& p) {
    return {p.at, p.at};
}

struct brick {  // its scalar type has a name
    using scalar_type = double;
    abut::vec3<double> from;
};
constexpr abut::aabb<double> bounds(const brick& b) { return {b.from, b.from + abut::vec3<double>{2, 1, 1}}; }
constexpr brick place(const abut::rigid<double>&, const brick& b) { return b; }
constexpr bool is_valid(const brick& b) { return b.from.x != 13; }

struct without_scalar {};
constexpr abut::aabb<double> bounds(const without_scalar&) { return {}; }
struct without_bounds {
    using scalar_type = float;
};
struct with_other_bounds {
    using scalar_type = float;
};
constexpr abut::aabb<double> bounds(const with_other_bounds&) { return {}; }
struct not_plain {
    using scalar_type = float;
    std::vector<float> values;
};
inline abut::aabb<float> bounds(const not_plain&) { return {}; }
struct not_default {
    using scalar_type = float;
    explicit not_default(float);
};
inline abut::aabb<float> bounds(const not_default&) { return {}; }
struct of_integers {
    using scalar_type = int;
};

/// A view of one's own: bricks in a row.
struct wall {
    using scalar_type = double;
    using shape_type = brick;
    using memory_space = abut::host_space;
    std::size_t count;
    std::size_t size() const { return count; }
    brick operator[](std::size_t i) const { return {{static_cast<double>(i), 0, 0}}; }
};
struct wall_of_nothing : wall {
    using shape_type = without_bounds;
    without_bounds operator[](std::size_t) const { return {}; }
};

}  // namespace other

static_assert(shape<triangle<float>> && shape<sphere<double>> && shape<vec3<float>> && shape<segment<float>> &&
              shape<aabb<double>> && shape<plane<float>> && shape<capsule<double>>);
static_assert(shape<other::pebble<float>> && shape<other::pebble<double>> && shape<other::brick>);
static_assert(std::same_as<scalar_type_of<other::pebble<float>>, float> &&
              std::same_as<scalar_type_of<other::brick>, double> && std::same_as<scalar_type_of<mesh<float>>, float>);
static_assert(!boundable<other::without_scalar> && !boundable<other::without_bounds> &&
              !boundable<other::with_other_bounds> && !boundable<other::of_integers> && !boundable<int> &&
              !boundable<vec3<int>>);
static_assert(boundable<other::not_plain> && !shape<other::not_plain> && boundable<other::not_default> &&
              !shape<other::not_default>);
static_assert(!shape<mesh<float>> && !shape<mesh_view<float>> && !shape<rigid<float>> && !shape<std::vector<float>>);
static_assert(placeable<triangle<float>> && placeable<vec3<double>> && placeable<capsule<float>> && placeable<cylinder<double>> &&
              placeable<cone<float>> && placeable<other::brick>);
static_assert(placeable<aabb<float>> && !placeable<plane<float>> && !placeable<other::pebble<float>>);
static_assert(shape_view<other::wall> && !shape_view<other::wall_of_nothing>);

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
    check_refused(
        [&] {
            mesh<T>({{0, 0, 0}, {0, nan, inf}}, {});
        },
        "abut::mesh", 1, nan, "abut::mesh: vertex 1: y is not finite (nan)");
    check_refused(
        [&] {
            mesh<T>({{0, 0, -inf}}, {});
        },
        "abut::mesh", 0, -inf, "abut::mesh: vertex 0: z is not finite (-inf)");
    check_refused(
        [&] {
            mesh<T>(corners, {{0, 1, 2}, {0, 1, 3}, {9, 9, 9}});
        },
        "abut::mesh", 1, 3, "abut::mesh: face 1: vertex index out of range, there are 3 vertices (3)");
    check_refused(
        [&] {
            triangle_soup<T>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {1, 0, 0}, {inf, 1, 0}}});
        },
        "abut::triangle_soup", 1, inf, "abut::triangle_soup: triangle 1: x is not finite (inf)");
    check_refused(
        [&] {
            spheres<T>({{{0, 0, 0}, 1}, {{0, 0, 0}, -2}});
        },
        "abut::spheres", 1, -2, "abut::spheres: sphere 1: radius is negative (-2)");
    check_refused(
        [&] {
            spheres<T>({{{0, 0, 0}, nan}});
        },
        "abut::spheres", 0, nan, "abut::spheres: sphere 0: radius is not finite (nan)");
    check_refused([&] { equal_spheres<T>({}, -1); }, "abut::equal_spheres", 0, -1,
                  "abut::equal_spheres: sphere 0: radius is negative (-1)");
    check_refused(
        [&] {
            equal_spheres<T>({{0, 0, 0}, {0, 0, nan}}, 1);
        },
        "abut::equal_spheres", 1, nan, "abut::equal_spheres: sphere 1: z is not finite (nan)");
}

TEMPLATE_TEST_CASE("sets: of each shape, what is none is refused by its name", "", float, double) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN(), inf = std::numeric_limits<T>::infinity();
    const vec3<T> o{0, 0, 0}, bad{0, 0, inf};
    check_refused(
        [&] {
            points<T>(std::vector<vec3<T>>{o, bad});
        },
        "abut::points", 1, inf, "abut::points: point 1: z is not finite (inf)");
    check_refused(
        [&] {
            segments<T>(std::vector<segment<T>>{{o, o}, {o, bad}});
        },
        "abut::segments", 1, inf, "abut::segments: segment 1: z is not finite (inf)");
    check_refused(
        [&] {
            capsules<T>(std::vector<capsule<T>>{{{o, o}, -1}});
        },
        "abut::capsules", 0, -1, "abut::capsules: capsule 0: radius is negative (-1)");
    check_refused(
        [&] {
            boxes<T>(std::vector<aabb<T>>{{o, o}, {{0, 2, 0}, {0, 1, 0}}});
        },
        "abut::boxes", 1, 2, "abut::boxes: box 1: lower y is above upper y (2)");
    check_refused(
        [&] {
            edge_mesh<T>({o, o}, {{0, 1}, {1, 2}});
        },
        "abut::edge_mesh", 1, 2, "abut::edge_mesh: edge 1: vertex index out of range, there are 2 vertices (2)");
    check_refused(
        [&] {
            shapes<plane<T>>(std::vector<plane<T>>{{o, nan}});
        },
        "abut::shapes", 0, nan, "abut::shapes: plane 0: offset is not finite (nan)");
    check_refused(
        [&] {
            rays<T>(std::vector<ray<T>>{{o, o}, {o, bad}});
        },
        "abut::rays", 1, inf, "abut::rays: ray 1: z is not finite (inf)");
    check_refused(
        [&] {
            shapes<other::pebble<T>>(std::vector<other::pebble<T>>{{o}, {bad}});
        },
        "abut::shapes", 1, inf, "abut::shapes: shape 1: z is not finite (inf)");
    check_refused(
        [&] {
            shapes<other::brick>(std::vector<other::brick>{{{13, 0, 0}}});
        },
        "abut::shapes", 0, 13, "abut::shapes: shape 0: is_valid refuses it; its least x is (13)");
    // Of a shape in motion the message says at which of its two times.
    const segment<T> rest{o, o}, broken{o, bad};
    check_refused(
        [&] {
            shapes(std::vector<motion<segment<T>>>{{rest, rest}, {broken, rest}});
        },
        "abut::moving: at t = 0", 1, inf, "abut::moving: at t = 0: segment 1: z is not finite (inf)");
    check_refused(
        [&] {
            shapes(std::vector<motion<segment<T>>>{{rest, broken}});
        },
        "abut::moving: at t = 1", 0, inf, "abut::moving: at t = 1: segment 0: z is not finite (inf)");
    const other::wall wall{20};
    check_refused([&] { detail::check(serial{}, wall, "abut::any"); }, "abut::any", 13, 13,
                  "abut::any: shape 13: is_valid refuses it; its least x is (13)");
    detail::check(openmp{.threads = 2}, other::wall{13}, "abut::any");
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
    const capsules<float> pills(std::vector<capsule<float>>{{{{0, 0, 0}, {1, 0, 0}}, 2}});
    CHECK(copy_to(openmp{}, pills).view().shapes.data == pills.view().shapes.data);
}

namespace {

/// Unit spheres in a row; the one that is named has radius -1.
struct make_sphere {
    std::size_t bad;
    ABUT_HD sphere<float> operator()(std::size_t i) const {
        return {{static_cast<float>(i), 0, 0}, i == bad ? -1.0f : 1.0f};
    }
};

}  // namespace

TEST_CASE("sets: made where the policy works, shape by shape") {
    const spheres<float> row(openmp{}, std::size_t{10'000}, make_sphere{10'000});
    CHECK(row.size() == 10'000);
    bool all = true;
    for (std::size_t i = 0; i < row.size(); ++i) all &= row.view()[i].center.x == static_cast<float>(i);
    CHECK(all);
    CHECK(spheres<float>(serial{}, std::size_t{0}, make_sphere{0}).size() == 0);
    CHECK_THROWS_WITH((spheres<float>(serial{}, std::size_t{5'000}, make_sphere{4'321})),
                      "abut::spheres: sphere 4321: radius is negative (-1)");
}

TEST_CASE("sets: made of a vector, they know their shape") {
    const shapes balls(std::vector<sphere<float>>{{{0, 0, 0}, 1}, {{1, 0, 0}, 1}});
    static_assert(std::same_as<decltype(balls), const spheres<float>>);
    CHECK(balls.size() == 2);
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

TEST_CASE("sets: of shapes in braces, one or more") {
    const serial on;
    const vec3<float> up{0, 0, 1};
    CHECK(rays<float>({{{1, 2, 3}, {0, 0, 1}}}).view()[0].direction == up);
    CHECK(rays<float>({{{1, 2, 3}, {0, 0, 1}}}).size() == 1);
    CHECK(rays<float>(on, {{{1, 2, 3}, {0, 0, 1}}}).size() == 1);
    CHECK(rays<float>({{{0, 0, 0}, {1, 0, 0}}, {{1, 2, 3}, {0, 0, 1}}}).view()[1].direction == up);
    CHECK(boxes<float>({{{0, 0, 0}, {0, 1, 1}}}).size() == 1);
    CHECK_THROWS_AS(boxes<float>({{{1, 0, 0}, {0, 1, 1}}}), invalid_geometry);
    CHECK(boxes<float>{{{0, 0, 0}, {0, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}}.size() == 2);
    CHECK(segments<double>({{{0, 0, 0}, {0, 1, 1}}}).size() == 1);
    CHECK(triangle_soup<float>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}).size() == 1);
    CHECK(spheres<float>({{{0, 0, 0}, 1}}).size() == 1);
    CHECK(capsules<float>({{{{0, 0, 0}, {0, 1, 1}}, 1}}).size() == 1);
    CHECK(points<float>({{1, 2, 3}}).view()[0] == vec3<float>{1, 2, 3});
    CHECK(points<float>(on, {{1, 2, 3}, {4, 5, 6}}).view()[1] == vec3<float>{4, 5, 6});
    CHECK(equal_spheres<float>(on, {{1, 2, 3}}, 1).size() == 1);
    const std::vector<vec3<float>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(mesh<float>(on, corners, {{0, 1, 2}}).size() == 1);
    CHECK(edge_mesh<float>(on, corners, {{0, 1}, {1, 2}}).size() == 2);
    const mesh<float> one(on, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    CHECK(one.with_vertices(on, {{0, 0, 2}, {1, 0, 0}, {0, 1, 0}}).view()[0].a == vec3<float>{0, 0, 2});
    CHECK_THROWS_AS(one.with_vertices(on, {{0, 0, 2}, {1, 0, 0}}), error);
    CHECK(hulls<float>(on, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 3}).size() == 2);
    // What is no list of shapes in braces is as it was.
    const points<float> some({{1, 2, 3}}), copy{some}, of_vector{corners}, with_policy{on, corners}, none{};
    CHECK(copy.size() == 1);
    CHECK(of_vector.size() == 3);
    CHECK(with_policy.size() == 3);
    CHECK(none.size() == 0);
}
