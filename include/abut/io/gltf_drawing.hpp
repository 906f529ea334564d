// SPDX-License-Identifier: MIT
#pragma once

// How shapes are drawn in glTF: which points and corners are read of a set, colours, flat normals, and balls and boxes as
// triangles. What is drawn is for the eye; what was decided stands in the scene's results.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/arithmetic/vec.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/view.hpp>

namespace abut::io::detail {

using colour = std::array<std::uint8_t, 4>;  ///< red, green, blue, opacity, in linear light, as glTF has them

/// Of the usual numbers of screens (sRGB, by its power law of 2.2).
inline colour linear_colour(int red, int green, int blue) {
    const auto linear = [](int c) { return static_cast<std::uint8_t>(std::lround(255 * std::pow(c / 255.0, 2.2))); };
    return {linear(red), linear(green), linear(blue), 255};
}
/// The same as in PLY.
inline colour hit_colour() { return linear_colour(230, 85, 13); }
/// One for each set, in turn.
inline colour plain_colour(std::size_t set) {
    constexpr int colours[6][3] = {{150, 178, 205}, {217, 205, 160}, {158, 196, 150},
                                   {200, 170, 205}, {170, 205, 205}, {190, 190, 190}};
    const auto& c = colours[set % 6];
    return linear_colour(c[0], c[1], c[2]);
}

/// Of length 1, on the side from which a, b, c are counterclockwise; some direction where the triangle has no area.
inline std::array<float, 3> flat_normal(const vec3<double>& a, const vec3<double>& b, const vec3<double>& c) {
    const vec3<double> u = b - a, v = c - a;
    // Both are scaled to 1 before they are multiplied: no product overflows or vanishes.
    const auto greatest = [](const vec3<double>& p) {
        return std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z)));
    };
    const double of_u = greatest(u), of_v = greatest(v);
    if (!(of_u > 0) || !(of_v > 0)) return {0, 0, 1};
    const vec3<double> n = cross((1 / of_u) * u, (1 / of_v) * v);
    const double length = std::sqrt(dot(n, n));
    if (!(length > 0)) return {0, 0, 1};
    return {static_cast<float>(n.x / length), static_cast<float>(n.y / length), static_cast<float>(n.z / length)};
}

/// A ball of radius 1 around the origin: 20 triangles, each divided into four so many times. Its corners lie on the ball.
struct ball_mesh {
    std::vector<float> positions;
    std::vector<std::uint16_t> corners;

    explicit ball_mesh(int divisions) {
        const double g = (1 + std::sqrt(5.0)) / 2;
        for (const double s : {-1.0, 1.0}) {
            for (const double t : {-g, g}) add({0, s, t}), add({s, t, 0}), add({t, 0, s});
        }
        // Faces of the icosahedron are the triples of corners that are an edge apart.
        const auto is_edge = [&](std::size_t i, std::size_t j) { return dot(at(i), at(j)) > 0.4; };
        for (std::uint16_t i = 0; i < 12; ++i) {
            for (std::uint16_t j = i + 1; j < 12; ++j) {
                for (std::uint16_t k = j + 1; k < 12; ++k) {
                    if (!is_edge(i, j) || !is_edge(j, k) || !is_edge(i, k)) continue;
                    const bool outward = dot(cross(at(j) - at(i), at(k) - at(i)), at(i)) > 0;
                    corners.insert(corners.end(), {i, outward ? j : k, outward ? k : j});
                }
            }
        }
        for (; divisions > 0; --divisions) divide();
    }

private:
    [[nodiscard]] vec3<double> at(std::size_t i) const {
        return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    }
    std::uint16_t add(const vec3<double>& p) {
        const double length = std::sqrt(dot(p, p));
        for (const double x : {p.x, p.y, p.z}) positions.push_back(static_cast<float>(x / length));
        return static_cast<std::uint16_t>(positions.size() / 3 - 1);
    }
    void divide() {
        std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint16_t> middles;
        const auto middle = [&](std::uint16_t i, std::uint16_t j) {
            const auto [place, is_new] = middles.try_emplace(std::minmax(i, j));
            if (is_new) place->second = add(at(i) + at(j));
            return place->second;
        };
        std::vector<std::uint16_t> divided;
        for (std::size_t f = 0; f < corners.size(); f += 3) {
            const std::uint16_t a = corners[f], b = corners[f + 1], c = corners[f + 2];
            const std::uint16_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            divided.insert(divided.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        corners = std::move(divided);
    }
};

/// The corners of the twelve triangles of a box, facing outwards: bit k of a number says which end in coordinate k.
constexpr std::array<std::array<std::uint32_t, 3>, 12> box_corners() {
    return {{{0, 4, 6},
             {0, 6, 2},
             {1, 3, 7},
             {1, 7, 5},
             {0, 1, 5},
             {0, 5, 4},
             {2, 6, 7},
             {2, 7, 3},
             {0, 2, 3},
             {0, 3, 1},
             {4, 5, 7},
             {4, 7, 6}}};
}

/// An arrow from a point: a shaft of four sides, and a head of three tenths of its length, turned outwards.
inline std::vector<triangle<double>> arrow_faces(const vec3<double>& from, const vec3<double>& by) {
    const double length = std::sqrt(dot(by, by));
    const vec3<double> along = (1 / length) * by;
    const vec3<double> aside = std::fabs(along.x) < 0.5 ? vec3<double>{1, 0, 0} : vec3<double>{0, 1, 0};
    const vec3<double> across = cross(along, aside);
    const vec3<double> u = (1 / std::sqrt(dot(across, across))) * across, v = cross(along, u);
    const auto at = [&](double part, double width, int k) {
        const double x = (k + 1) % 4 < 2 ? width : -width, y = k % 4 < 2 ? width : -width;
        return from + part * by + (length * x) * u + (length * y) * v;
    };
    std::vector<triangle<double>> faces;
    for (int k = 0; k < 4; ++k) {
        const vec3<double> a = at(0, 0.04, k), b = at(0, 0.04, k + 1), c = at(0.7, 0.04, k + 1), d = at(0.7, 0.04, k);
        const vec3<double> e = at(0.7, 0.12, k), f = at(0.7, 0.12, k + 1);
        faces.push_back({a, b, c});
        faces.push_back({a, c, d});
        faces.push_back({from, b, a});
        faces.push_back({d, c, f});
        faces.push_back({d, f, e});
        faces.push_back({e, f, from + by});
    }
    return faces;
}

template <scalar T>
vec3<double> in_double(const vec3<T>& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// A surface of N / 3 triangles at most; where it has fewer, some of them are a point.
template <std::size_t N>
struct drawn_surface {
    using scalar_type = double;
    std::array<vec3<double>, N> points;
};

/// Calls f(corner) for the corners of a shape's core, or of the shape.
template <class S, class F>
void for_each_core_corner(const S& s, const F& f) {
    if constexpr (requires { abut::detail::core_of(s).at; }) {
        for (const auto& p : abut::detail::core_of(s).at) f(in_double(p));
    } else if constexpr (requires { abut::detail::points_of(s).at; }) {
        for (const auto& p : abut::detail::points_of(s).at) f(in_double(p));
    } else {
        for (std::size_t i = 0; i < s.count; ++i) f(in_double(s[i]));
    }
}
/// A convex shape: for each corner of a ball the point of the shape that lies farthest in its direction.
template <class S>
drawn_surface<960> convex_surface(const S& s, const ball_mesh& ball) {
    const auto radius = static_cast<double>(abut::detail::radius_around_core(s));
    std::vector<vec3<double>> farthest;
    for (std::size_t k = 0; k < ball.positions.size(); k += 3) {
        const vec3<double> way{ball.positions[k], ball.positions[k + 1], ball.positions[k + 2]};
        vec3<double> best{};
        double most = -std::numeric_limits<double>::infinity();
        for_each_core_corner(s, [&](const vec3<double>& p) {
            if (dot(p, way) > most) best = p, most = dot(p, way);
        });
        farthest.push_back(best + radius * way);
    }
    drawn_surface<960> surface{};
    for (std::size_t k = 0; k < 960; ++k) surface.points[k] = farthest[ball.corners[k]];
    return surface;
}
/// A patch: a fan over its corners, 16 of them at most; a point where it has fewer than three.
template <class P>
drawn_surface<42> patch_surface(const P& patch) {
    drawn_surface<42> surface{};
    surface.points.fill(in_double(patch.center));
    const std::size_t corners = std::min<std::size_t>(patch.points.size(), 16);
    for (std::size_t k = 0; k + 2 < corners; ++k) {
        const std::array<std::size_t, 3> of{0, k + 1, k + 2};
        for (std::size_t j = 0; j < 3; ++j) surface.points[3 * k + j] = in_double(patch.points[of[j]].point);
    }
    return surface;
}

/// What is read of an argument of `gltf_scene::add`, after a check.
template <class Object>
auto gltf_view(const Object& object) {
    constexpr const char* function = "abut::io::gltf_scene::add";
    if constexpr (is_posed<Object>) {
        const auto inner = gltf_view(object.object);
        const posed_view<std::remove_const_t<decltype(inner)>> placed{inner, object.pose};
        abut::detail::check(object.pose, function);
        abut::detail::check(serial{}, placed, function);
        return placed;
    } else if constexpr (shape<Object>) {
        const single_view<Object> one{object};
        abut::detail::check(serial{}, one, function);
        return one;
    } else if constexpr (requires { object.view(); }) {
        return gltf_view(object.view());
    } else {
        static_assert(shape_view<Object>, "abut: a scene takes sets, views, posed and moving ones, and single shapes");
        static_assert(std::same_as<typename Object::memory_space, host_space>, "abut: copy_to brings a set to the host");
        abut::detail::check(serial{}, object, function);
        return object;
    }
}

/// The vertex of a mesh at a corner of face i; corners of shapes that share none count on.
template <class V>
std::uint32_t gltf_corner(const V& v, std::size_t i, std::size_t k) {
    if constexpr (requires { v.faces; }) {
        return corners_at(v.faces, i)[k];
    } else if constexpr (requires { v.pose; }) {
        return gltf_corner(v.shapes, i, k);
    } else if constexpr (requires { v.t0; }) {
        return gltf_corner(v.t0, i, k);
    } else {
        return static_cast<std::uint32_t>(3 * i + k);
    }
}

/// The points that a shape is drawn by.
///@{
template <scalar T>
std::array<vec3<T>, 3> gltf_points(const triangle<T>& t) {
    return {t.a, t.b, t.c};
}
template <scalar T>
std::array<vec3<T>, 2> gltf_points(const segment<T>& s) {
    return {s.a, s.b};
}
template <scalar T>
std::array<vec3<T>, 1> gltf_points(const vec3<T>& p) {
    return {p};
}
template <scalar T>
std::array<vec3<T>, 36> gltf_points(const aabb<T>& box) {
    std::array<vec3<T>, 36> points;
    std::size_t k = 0;
    for (const auto& triangle : box_corners()) {
        for (const std::uint32_t corner : triangle) points[k++] = abut::detail::points_of(box).at[corner];
    }
    return points;
}
///@}

template <std::size_t N>
std::array<vec3<double>, N> gltf_points(const drawn_surface<N>& surface) {
    return surface.points;
}

/// How sets of a kind of shape are called and drawn.
template <class S>
struct gltf_kind;
template <scalar T>
struct gltf_kind<triangle<T>> {
    static constexpr const char* name = "triangles";
    static constexpr int mode = 4;
};
template <scalar T>
struct gltf_kind<aabb<T>> {
    static constexpr const char* name = "boxes";
    static constexpr int mode = 4;
};
template <std::size_t N>
struct gltf_kind<drawn_surface<N>> {
    static constexpr const char* name = "surfaces";
    static constexpr int mode = 4;
};
template <scalar T>
struct gltf_kind<segment<T>> {
    static constexpr const char* name = "segments";
    static constexpr int mode = 1;
};
template <scalar T>
struct gltf_kind<vec3<T>> {
    static constexpr const char* name = "points";
    static constexpr int mode = 0;
};

/// Whether a type is a sphere.
template <class S>
inline constexpr bool is_sphere = false;
template <scalar T>
inline constexpr bool is_sphere<sphere<T>> = true;

}  // namespace abut::io::detail
