// SPDX-License-Identifier: MIT
#pragma once

// Shapes and ways for tests of sweeps: at points of lattices, where ties are many, or anywhere.

#include <cmath>
#include <cstddef>
#include <vector>

#include <abut/shape/bounds.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>

#include "support/samples.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Points of some family: lattices full of ties, or any; far away, or of very different sizes.
template <scalar T>
struct sweep_points {
    uniform& random;
    int family;

    vec3<T> operator()() {
        const auto lattice = [&](int half) {
            const auto one = [&] { return static_cast<T>(static_cast<int>(random.below(2 * static_cast<std::size_t>(half) + 1)) - half); };
            const T x = one(), y = one();
            return vec3<T>{x, y, one()};
        };
        switch (family) {
            case 0: return lattice(2);
            case 1: return T(0.1) * lattice(3);
            case 2: return random.template point<T>(-3, 3);
            case 3: {
                const vec3<T> p = lattice(4);
                return vec3<T>{p.x, p.y, p.z / 3} + vec3<T>{T(1000), T(0.7), T(-333)};
            }
            default: {
                const vec3<T> p = random.template point<T>(-1, 1);
                return vec3<T>{std::ldexp(p.x, static_cast<int>(random.below(40)) - 20), p.y, std::ldexp(p.z, -static_cast<int>(random.below(20)))};
            }
        }
    }
    vec3<T> way() {
        if (family == 0 || family == 1) {
            const vec3<T> w = (*this)();
            return random.below(8) == 0 ? vec3<T>{0, 0, 0} : T(2) * w;
        }
        const vec3<T> p = (*this)();
        return static_cast<T>(1 + random.below(3)) * ((*this)() - p);
    }
    T radius() { return family == 0 ? static_cast<T>(random.below(3)) / 2 : family == 1 ? T(0.1) * static_cast<T>(random.below(5)) : static_cast<T>(std::abs(random.template point<T>(-1, 1).x)); }
};

template <class S>
struct sweep_shape_maker;
template <scalar T>
struct sweep_shape_maker<vec3<T>> {
    template <class P>
    static vec3<T> make(P& p, std::vector<vec3<T>>&) {
        return p();
    }
};
template <scalar T>
struct sweep_shape_maker<segment<T>> {
    template <class P>
    static segment<T> make(P& p, std::vector<vec3<T>>&) {
        const vec3<T> a = p();
        return {a, p()};
    }
};
template <scalar T>
struct sweep_shape_maker<triangle<T>> {
    template <class P>
    static triangle<T> make(P& p, std::vector<vec3<T>>&) {
        const vec3<T> a = p(), b = p();
        return {a, b, p()};
    }
};
template <scalar T>
struct sweep_shape_maker<sphere<T>> {
    template <class P>
    static sphere<T> make(P& p, std::vector<vec3<T>>&) {
        const vec3<T> a = p();
        return {a, p.radius()};
    }
};
template <scalar T>
struct sweep_shape_maker<capsule<T>> {
    template <class P>
    static capsule<T> make(P& p, std::vector<vec3<T>>&) {
        const vec3<T> a = p(), b = p();
        return {{a, b}, p.radius()};
    }
};
template <scalar T>
struct sweep_shape_maker<aabb<T>> {
    template <class P>
    static aabb<T> make(P& p, std::vector<vec3<T>>&) {
        const vec3<T> a = p();
        return merge(bounds(a), bounds(p()));
    }
};
template <scalar T>
struct sweep_shape_maker<oriented_box<T>> {
    template <class P>
    static oriented_box<T> make(P& p, std::vector<vec3<T>>&) {
        const T c = T(0.8), s = T(0.6);
        const vec3<T> at = p(), half = p();
        return {at, {std::abs(half.x), std::abs(half.y), std::abs(half.z)}, {c, -s, 0, s, c, 0, 0, 0, 1}};
    }
};
template <scalar T>
struct sweep_shape_maker<hull<T>> {
    template <class P>
    static hull<T> make(P& p, std::vector<vec3<T>>& room) {
        for (int i = 0; i < 9; ++i) room.push_back(p());
        return {room.data(), room.size()};
    }
};

}  // namespace abut::test
