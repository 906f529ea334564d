// SPDX-License-Identifier: MIT
#pragma once

// Small scenes for tests of everything above the predicates, from a seed that each test prints.

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <abut/shape/set.hpp>

namespace abut::test {

/// Numbers in [0, 1) from a seed; the same on every standard library.
class uniform {
public:
    explicit uniform(std::uint64_t seed_value) : engine_(seed_value) {}
    double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double operator()(double lower, double upper) { return lower + (upper - lower) * (*this)(); }
    template <class T>
    vec3<T> point(double lower, double upper) {
        const double x = (*this)(lower, upper), y = (*this)(lower, upper), z = (*this)(lower, upper);
        return {static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
    }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>((*this)() * static_cast<double>(n)); }

private:
    std::mt19937_64 engine_;
};

/// A closed torus around the z axis: `around` times `across` quads, each cut in two.
template <class T>
struct torus {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;

    torus(std::uint32_t around, std::uint32_t across, double major, double minor) {
        const double turn = 2 * std::acos(-1.0);
        const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
        for (std::uint32_t i = 0; i < around; ++i) {
            for (std::uint32_t j = 0; j < across; ++j) {
                const double u = turn * i / around, v = turn * j / across, r = major + minor * std::cos(v);
                vertices.push_back({static_cast<T>(r * std::cos(u)), static_cast<T>(r * std::sin(u)),
                                    static_cast<T>(minor * std::sin(v))});
                faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        }
    }
};

/// Triangles and spheres of sizes spread over several powers of ten, in a box of side 2.
template <class T>
std::vector<triangle<T>> random_triangles(std::size_t n, uniform& random) {
    std::vector<triangle<T>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> at = random.point<T>(-1, 1);
        const double size = std::pow(10.0, random(-3, 0));
        const auto corner = [&] { return at + random.point<T>(-size, size); };
        const vec3<T> a = corner(), b = corner(), c = corner();
        triangles.push_back({a, b, c});
    }
    return triangles;
}

/// Side by side along x. Of their boxes neighbours alone overlap.
template <class T>
std::vector<triangle<T>> chain_of_triangles(int n) {
    std::vector<triangle<T>> chain;
    for (int i = 0; i < n; ++i) {
        const T x = static_cast<T>(i);
        chain.push_back({{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    }
    return chain;
}

/// Two sets, and the second once more where it is far from the first.
template <class T>
struct near_and_away {
    triangle_soup<T> a, b, away;
};

template <class T>
near_and_away<T> random_near_and_away(uniform& random) {
    const std::vector<triangle<T>> a = random_triangles<T>(250, random), b = random_triangles<T>(180, random);
    const vec3<T> far{100, 0, 0};
    std::vector<triangle<T>> away;
    for (const triangle<T>& t : b) away.push_back({t.a + far, t.b + far, t.c + far});
    return {triangle_soup<T>(a), triangle_soup<T>(b), triangle_soup<T>(away)};
}

template <class T>
std::vector<sphere<T>> random_spheres(std::size_t n, uniform& random) {
    std::vector<sphere<T>> spheres;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> center = random.point<T>(-1, 1);
        spheres.push_back({center, i % 17 == 0 ? T(0) : static_cast<T>(std::pow(10.0, random(-2, -0.3)))});
    }
    return spheres;
}

template <class T>
std::vector<T> shuffled(std::vector<T> values, uniform& random) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
    return values;
}

}  // namespace abut::test
