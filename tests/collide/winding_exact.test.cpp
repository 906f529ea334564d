// SPDX-License-Identifier: MIT
#include <abut/collide/inside.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/winding_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/tetrahedra.hpp"

using namespace abut;

namespace {

/// A rough ball, moved and sized; turned inside out if asked for.
template <class T>
void add_ball(test::surface_data<T>& to, test::uniform& random, const vec3<T>& at, T size, bool inside_out) {
    const auto ball = test::ball_surface<T>(2, 1);
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    for (const auto& v : ball.vertices) to.vertices.push_back(at + size * T(1 + random(-0.2, 0.2)) * v);
    for (const face& f : ball.faces) {
        to.faces.push_back(inside_out ? face{first + f[0], first + f[2], first + f[1]}
                                      : face{first + f[0], first + f[1], first + f[2]});
    }
}

/// Two bodies that overlap, with a hollow in one and a body in the hollow, and one inside out by itself.
template <class T>
test::surface_data<T> overlapping_bodies(test::uniform& random) {
    test::surface_data<T> all;
    add_ball<T>(all, random, {0, 0, 0}, 1, false);
    add_ball<T>(all, random, {T(0.9), T(0.25), 0}, 1, false);
    add_ball<T>(all, random, {T(-0.375), 0, 0}, T(0.375), true);
    add_ball<T>(all, random, {T(-0.375), 0, T(0.0625)}, T(0.125), false);
    add_ball<T>(all, random, {0, T(2.5), 0}, T(0.5), true);
    return all;
}

template <class T>
std::vector<vec3<T>> points_around(const test::surface_data<T>& data, test::uniform& random) {
    std::vector<vec3<T>> points;
    const bool are_few = test::sample_count() < 100000;
    const std::size_t every = are_few ? 20 : 5;
    for (int i = 0; i < (are_few ? 60 : 150); ++i) points.push_back(random.point<T>(-1, 1) + vec3<T>{T(0.5), T(0.75) * T(i % 3 == 0), 0});
    for (int i = 0; i < 40; ++i) points.push_back(vec3<T>{T(-0.375), 0, 0} + random.point<T>(-0.4, 0.4));
    for (std::size_t i = 0; i + 1 < data.vertices.size(); i += every) {
        const vec3<T> a = data.vertices[i], b = data.vertices[i + 1];
        points.push_back(a);
        points.push_back({a.x, a.y, static_cast<T>(random(-1, 1))});
        points.push_back({a.x, b.y, a.z});
        points.push_back({a.x, a.y, std::nextafter(a.z, i / every % 2 == 0 ? T(9) : T(-9))});
    }
    return points;
}

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const invalid_geometry& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEMPLATE_TEST_CASE("winding number: exactly, against tetrahedra in rational numbers", "", float, double) {
    using T = TestType;
    test::uniform random(481);
    const auto data = overlapping_bodies<T>(random);
    const auto points = points_around(data, random);
    const mesh<T> surface(data.vertices, data.faces);
    const auto found = winding_number<exact>(serial{}, make_bvh(serial{}, surface), points).to_host();
    const auto where = inside(serial{}, surface, points).to_host();
    const auto near = winding_number(serial{}, surface, points).to_host();
    std::size_t wrong = 0, off = 0;
    std::array<std::size_t, 5> seen{};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const test::turns_around truth = test::turns_by_tetrahedra(data.vertices, data.faces, points[i]);
        wrong += found[i].turns != truth.turns || found[i].on_surface != truth.on_surface;
        wrong += truth.on_surface != (where[i] == containment::on_surface);
        wrong += (where[i] == containment::inside) != (truth.turns % 2 != 0);
        off += !truth.on_surface && !(std::abs(near[i] - truth.turns) < 1e-6);
        ++seen[truth.on_surface ? 4 : static_cast<std::size_t>(truth.turns + 1)];
    }
    CHECK(wrong == 0);
    CHECK(off == 0);
    for (const std::size_t count : seen) CHECK(count > 3);  // -1, 0, 1, 2 and on the surface
}

TEST_CASE("winding number: exactly, on every policy, in every layout and under a pose") {
    test::uniform random(482);
    const auto data = overlapping_bodies<float>(random);
    const auto points = points_around(data, random);
    const mesh<float> surface(data.vertices, data.faces);
    const auto expected = winding_number<filtered>(serial{}, surface, points).to_host();
    const auto tree = make_bvh(serial{}, surface);
    const auto check = [&](const auto& on, const auto& index) {
        CHECK(winding_number<exact>(on, index, points).to_host() == expected);
        CHECK(winding_number<filtered>(on, index, points, {.known_closed = true}).to_host() == expected);
    };
    check(serial{}, tree);
    check(serial{}, wide(serial{}, tree));
    check(openmp{3}, tree);
    check(serial{}, posed(tree, rigid<float>{}));
    CHECK(winding_number<exact>(serial{}, mesh<float>(), points).to_host() == std::vector<winding_count>(points.size()));
}

TEST_CASE("winding number: exactly, of meshes that are not closed or turned against themselves") {
    auto data = test::ball_surface<float>(1, 1);
    const std::vector<vec3<float>> middle{{0, 0, 0}};
    const auto ask = [&] { return winding_number<exact>(serial{}, mesh<float>(data.vertices, data.faces), middle).to_host(); };
    CHECK(ask() == std::vector<winding_count>{{1, false}});
    const face last = data.faces.back();
    data.faces.back() = {last[0], last[2], last[1]};
    const std::string turned = refusal(ask);
    CHECK(turned.rfind("abut::winding_number: face ", 0) == 0);
    CHECK(turned.find("turned against each other: more go along it one way than the other, by (2)") != std::string::npos);
    CHECK(inside(serial{}, mesh<float>(data.vertices, data.faces), middle).to_host()[0] == containment::inside);
    data.faces.pop_back();
    CHECK(refusal(ask).find("the mesh is not closed: an edge of this face has an odd number of faces (1)") != std::string::npos);
}
