// SPDX-License-Identifier: MIT
#pragma once

// Sets that give builders trouble, and comparisons of whole trees, for the tests of builders, layouts and refit.

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <abut/index/lbvh.hpp>

#include "support/scenes.hpp"

namespace abut::test {

template <class T>
struct named_soup {
    std::string name;
    triangle_soup<T> set;
};

/// Small triangles at given places.
template <class T>
triangle_soup<T> soup_at(const std::vector<vec3<T>>& places, T size) {
    std::vector<triangle<T>> triangles;
    for (const auto& p : places) triangles.push_back({p, {p.x + size, p.y, p.z}, {p.x, p.y + size, p.z}});
    return triangle_soup<T>(triangles);
}

template <class T>
std::vector<named_soup<T>> hard_sets(std::size_t n) {
    uniform random(17);
    constexpr T huge = std::numeric_limits<T>::max(), tiny = std::numeric_limits<T>::denorm_min();
    const auto places = [&](auto&& at) {
        std::vector<vec3<T>> all(n);
        for (std::size_t i = 0; i < n; ++i) all[i] = at(i);
        return all;
    };
    const auto whole = [](std::size_t i) { return static_cast<T>(i); };
    std::vector<named_soup<T>> sets;
    sets.push_back({"coincident", soup_at<T>(places([](std::size_t) { return vec3<T>{1, 2, 3}; }), T(0.5))});
    sets.push_back({"points in one place", soup_at<T>(places([](std::size_t) { return vec3<T>{1, 2, 3}; }), T(0))});
    sets.push_back({"in a line, sorted", soup_at<T>(places([&](std::size_t i) { return vec3<T>{whole(i), 0, 0}; }), T(0))});
    sets.push_back({"in a line, sorted downwards", soup_at<T>(places([&](std::size_t i) {
                                                                  return vec3<T>{0, 0, -whole(i)};
                                                              }),
                                                              T(2))});
    sets.push_back({"powers of two", soup_at<T>(places([](std::size_t i) {
                                                    return vec3<T>{std::ldexp(T(1), -static_cast<int>(i % 1100)), 0, 0};
                                                }),
                                                T(0))});
    sets.push_back({"powers of two, in order",
                    soup_at<T>(places([&](std::size_t i) {
                                   return vec3<T>{0, std::ldexp(T(1), 100 - static_cast<int>(i * 200 / n)), 0};
                               }),
                               T(0))});
    sets.push_back(
        {"denormal", soup_at<T>(places([&](std::size_t i) {
                                    return vec3<T>{whole(i % 10) * tiny, whole(i / 10 % 10) * tiny, whole(i / 100) * tiny};
                                }),
                                tiny)});
    sets.push_back({"one far outlier",
                    soup_at<T>(places([&](std::size_t i) {
                                   return i == n / 2 ? vec3<T>{huge / 4, -huge / 4, huge / 4} : random.point<T>(-1, 1);
                               }),
                               T(0.1))});
    sets.push_back({"huge", soup_at<T>(places([&](std::size_t) {
                                           const auto p = random.point<T>(-1, 1);
                                           return vec3<T>{p.x * huge, p.y * huge, p.z * huge};
                                       }),
                                       T(1))});
    std::vector<triangle<T>> nested;
    for (std::size_t i = 0; i < n; ++i) {
        const T x = huge / static_cast<T>(i + 1);
        nested.push_back({{-x, -x, 0}, {x, -x, tiny}, {0, x, -x}});
    }
    sets.push_back({"nested, to the largest number", triangle_soup<T>(nested)});
    sets.push_back({"random", triangle_soup<T>(random_triangles<T>(n, random))});
    return sets;
}

/// Spheres some of whose boxes end at infinity.
template <class T>
spheres<T> endless_spheres(std::size_t n) {
    constexpr T huge = std::numeric_limits<T>::max();
    uniform random(23);
    std::vector<sphere<T>> balls;
    for (std::size_t i = 0; i < n; ++i) {
        const auto p = random.point<T>(-1, 1);
        balls.push_back({p, T(0.1)});
        if (i % 7 == 0) balls.back() = {{p.x * huge, p.y, p.z * huge}, huge};
        if (i % 31 == 0) balls.back() = {{0, 0, 0}, huge};
    }
    return spheres<T>(balls);
}

/// Whether two trees in host memory are the same bits: -0 is not 0.
template <class Nodes>
bool same_bits(const Nodes& a, const Nodes& b) {
    const auto same_box = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    if (a.nodes.size() != b.nodes.size() || a.root.size() != b.root.size()) return false;
    for (std::size_t i = 0; i < a.root.size(); ++i) {
        const auto &x = a.root.data()[i], &y = b.root.data()[i];
        if (!same_box(x.bounds, y.bounds) || !(x.child == y.child)) return false;
    }
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        const auto &x = a.nodes.data()[i], &y = b.nodes.data()[i];
        for (const int side : {0, 1}) {
            if (!same_box(x.bounds[side], y.bounds[side]) || !(x.child[side] == y.child[side])) return false;
        }
    }
    return true;
}

}  // namespace abut::test
