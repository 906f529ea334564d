// SPDX-License-Identifier: MIT
#pragma once

// Views of separate arrays of coordinates, and sets that own a copy of what a view sees: the same answers and the same
// refusals as of views and sets of the library's own types, on every policy.

#include <cstring>
#include <limits>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// An array in a policy's memory.
template <class Policy, class T>
execution::buffer_of<Policy, T> array_in(const Policy& on, const std::vector<T>& values) {
    execution::buffer_of<Policy, T> there(on, values.size());
    upload(on, values.data(), values.size(), there.data());
    return there;
}

/// A torus and balls, once with coordinates side by side and once apart.
template <class T, class Policy>
struct apart {
    using space = space_of<Policy>;
    torus<T> ring{12, 7, 1.0, 0.3};
    std::vector<sphere<T>> balls;
    execution::buffer_of<Policy, T> x, y, z, center_x, center_y, center_z, radii;
    execution::buffer_of<Policy, face> faces;

    explicit apart(const Policy& on) {
        uniform random(20261123);
        balls = random_spheres<T>(150, random);
        const auto one = [&](const auto& points, auto number) {
            std::vector<T> values;
            for (const auto& p : points) values.push_back(number(p));
            return array_in(on, values);
        };
        x = one(ring.vertices, [](const vec3<T>& p) { return p.x; });
        y = one(ring.vertices, [](const vec3<T>& p) { return p.y; });
        z = one(ring.vertices, [](const vec3<T>& p) { return p.z; });
        faces = array_in(on, ring.faces);
        center_x = one(balls, [](const sphere<T>& s) { return s.center.x; });
        center_y = one(balls, [](const sphere<T>& s) { return s.center.y; });
        center_z = one(balls, [](const sphere<T>& s) { return s.center.z; });
        radii = one(balls, [](const sphere<T>& s) { return s.radius; });
    }
    [[nodiscard]] xyz_points_view<T, space> points() const { return {x.data(), y.data(), z.data(), x.size()}; }
    [[nodiscard]] xyz_mesh_view<T, space> mesh() const { return {points(), faces.data(), faces.size()}; }
    [[nodiscard]] xyz_spheres_view<T, space> spheres() const {
        return {center_x.data(), center_y.data(), center_z.data(), radii.data(), radii.size()};
    }
    [[nodiscard]] xyz_spheres_view<T, space> equal_spheres(T radius) const {
        return {center_x.data(), center_y.data(), center_z.data(), center_x.size(), radius};
    }
};

template <class T, class Policy>
void check_xyz_views(const Policy& on) {
    const apart<T, Policy> views(on);
    const auto mesh = copy_to(on, abut::mesh<T>(views.ring.vertices, views.ring.faces));
    const auto balls = copy_to(on, abut::spheres<T>(views.balls));
    std::vector<vec3<T>> centers;
    for (const sphere<T>& s : views.balls) centers.push_back(s.center);
    const T radius = T(0.125);
    const auto equal = copy_to(on, abut::equal_spheres<T>(centers, radius));

    const auto expected = to_host(pairs(on, mesh, balls));
    REQUIRE(expected.size() > 50);
    CHECK(to_host(pairs(on, views.mesh(), views.spheres())) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, views.mesh()), views.spheres())) == expected);
    CHECK(to_host(pairs(on, views.mesh(), make_grid(on, views.spheres()))) == expected);
    const auto expected_of_equal = to_host(pairs(on, mesh, equal));
    CHECK(expected_of_equal.size() > 10);
    CHECK(expected_of_equal != expected);
    CHECK(to_host(pairs(on, views.mesh(), views.equal_spheres(radius))) == expected_of_equal);

    // Points of the mesh, each of which is a corner of faces.
    CHECK(to_host(pairs(on, mesh, views.points())) == to_host(pairs(on, mesh, vertices(mesh))));
    // Faces know their vertices: neighbours are no pair, as they would be in a soup.
    CHECK(count_self_pairs(on, mesh) == 0);
    CHECK(count_self_pairs(on, views.mesh()) == 0);
    CHECK(count(on, views.mesh(), views.mesh()) > views.ring.faces.size());

    const abut::xyz_mesh_view<T, space_of<Policy>> none;
    CHECK(count(on, none, views.spheres()) == 0);
}

/// Writes one number.
template <class T>
struct write_number {
    T* at;
    T value;
    ABUT_HD void operator()(std::size_t) const { *at = value; }
};

template <class T, class Policy>
void check_xyz_refusals(const Policy& on) {
    apart<T, Policy> views(on);
    const auto with = [&](T* at, T value, T before, const auto& ask, const char* says) {
        for_each_index(on, 1, write_number<T>{at, value});
        CHECK_THROWS_WITH(ask(), says);
        for_each_index(on, 1, write_number<T>{at, before});
    };
    const T nan = std::numeric_limits<T>::quiet_NaN(), infinite = std::numeric_limits<T>::infinity();
    const auto& ring = views.ring.vertices;
    const auto& balls = views.balls;
    const auto of_mesh = [&] { return any(on, views.mesh(), views.spheres()); };
    const auto of_points = [&] { return copy_to(on, views.points()); };
    with(views.x.data() + 5, nan, ring[5].x, of_mesh, "abut::any: vertex 5: x is not finite (nan)");
    with(views.y.data() + 6, infinite, ring[6].y, of_mesh, "abut::any: vertex 6: y is not finite (inf)");
    with(views.z.data() + 7, -infinite, ring[7].z, of_points, "abut::copy_to: point 7: z is not finite (-inf)");
    with(views.center_z.data() + 8, nan, balls[8].center.z, of_mesh, "abut::any: sphere 8: z is not finite (nan)");
    with(views.radii.data() + 9, T(-1), balls[9].radius, of_mesh, "abut::any: sphere 9: radius is negative (-1)");
    CHECK_THROWS_WITH(any(on, views.mesh(), views.equal_spheres(T(-2))), "abut::any: sphere 0: radius is negative (-2)");
    CHECK(any(on, views.mesh(), views.spheres()));  // all is as it was

    auto faces = views.ring.faces;
    faces[3][1] = 84;
    const auto bad = array_in(on, faces);
    const xyz_mesh_view<T, space_of<Policy>> broken(views.points(), bad.data(), bad.size());
    const char* const says = "abut::make_bvh: face 3: vertex index out of range, there are 84 vertices (84)";
    CHECK_THROWS_WITH(make_bvh(on, broken), says);
    CHECK_THROWS_AS(copy_to(on, broken), invalid_geometry);
}

/// Elements of two views on the host.
template <class View>
bool same_shapes(const View& a, const View& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        const auto s = a[i], t = b[i];
        same = std::memcmp(&s, &t, sizeof s) == 0;
    }
    return same;
}

/// Copies of views: of the views' own kinds, with all elements, and on their own.
template <class T, class Policy>
void check_copies_of_views(const Policy& on) {
    using space = space_of<Policy>;
    const apart<T, Policy> views(on);
    const serial host;
    const mesh<T> ring(views.ring.vertices, views.ring.faces);
    const spheres<T> balls(views.balls);

    const auto of_mesh = copy_to(on, views.mesh());
    static_assert(std::same_as<decltype(of_mesh), const mesh<T, space>>);
    CHECK(of_mesh.device() == device_of(on));
    CHECK(same_shapes(copy_to(host, of_mesh).view(), ring.view()));
    CHECK(of_mesh.view().vertices.count == views.ring.vertices.size());
    CHECK(of_mesh.view().faces.data != reinterpret_cast<const std::byte*>(views.faces.data()));

    const auto of_spheres = copy_to(on, views.spheres());
    static_assert(std::same_as<decltype(of_spheres), const spheres<T, space>>);
    CHECK(same_shapes(copy_to(host, of_spheres).view(), balls.view()));
    const auto of_points = copy_to(on, views.points());
    static_assert(std::same_as<decltype(of_points), const points<T, space>>);
    CHECK(same_shapes(copy_to(host, of_points).view(), points<T>(views.ring.vertices).view()));

    // Of the library's own views, strides included.
    const auto stored = array_in(on, views.balls);
    const shapes_view<vec3<T>, space> strided(&stored.data()->center, stored.size(), sizeof(sphere<T>));
    std::vector<vec3<T>> centers;
    for (const sphere<T>& s : views.balls) centers.push_back(s.center);
    CHECK(same_shapes(copy_to(host, copy_to(on, strided)).view(), points<T>(centers).view()));
    const equal_spheres_view<T, space> of_one_radius(&stored.data()->center, stored.size(), T(0.5), sizeof(sphere<T>));
    const auto of_equal = copy_to(on, of_one_radius);
    static_assert(std::same_as<decltype(of_equal), const equal_spheres<T, space>>);
    CHECK(same_shapes(copy_to(host, of_equal).view(), equal_spheres<T>(centers, T(0.5)).view()));
    const auto rim = edges(on, copy_to(on, ring));
    const auto of_edges = copy_to(on, rim.view());
    static_assert(std::same_as<decltype(of_edges), const edge_mesh<T, space>>);
    CHECK(same_shapes(copy_to(host, of_edges).view(), copy_to(host, rim).view()));
    CHECK(of_edges.view().edges.data != rim.view().edges.data);

    // Of the host's memory it is a copy there, and then one in the policy's.
    const auto brought = copy_to(on, ring.view());
    static_assert(std::same_as<decltype(brought), const mesh<T, space>>);
    CHECK(same_shapes(copy_to(host, brought).view(), ring.view()));
    CHECK(copy_to(on, xyz_points_view<T, space>()).size() == 0);
}

}  // namespace abut::test
