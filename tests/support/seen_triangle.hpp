// SPDX-License-Identifier: MIT
#pragma once

// The oracle for solid angles, in a hundred digits: by the angles between planes, which the library never asks for.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/primitive.hpp>

namespace abut::test {

using angle_number = boost::multiprecision::cpp_bin_float_100;
using angle_vector = std::array<angle_number, 3>;
using angle_rational = boost::multiprecision::cpp_rational;

inline angle_vector angle_cross(const angle_vector& a, const angle_vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline angle_number angle_dot(const angle_vector& a, const angle_vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline angle_number angle_length(const angle_vector& a) { return sqrt(angle_dot(a, a)); }

/// What share of all directions from p a triangle takes, the side that p is on decided in rational numbers; and whether p is
/// off all edges by 2^-26 times the distance of the farther corner. Coordinates other than 0 span no more than 2^250.
struct seen_triangle {
    angle_number share;
    bool is_off_edges = true;

    /// By Girard's theorem: the angles between the planes through p, less pi.
    template <class T>
    seen_triangle(const triangle<T>& t, const vec3<T>& p) {
        const auto exactly = [&](const vec3<T>& v, auto number) {
            using N = decltype(number);
            return std::array<N, 3>{N(v.x) - N(p.x), N(v.y) - N(p.y), N(v.z) - N(p.z)};
        };
        std::array<angle_vector, 3> way;
        std::array<std::array<angle_rational, 3>, 3> m;
        for (std::size_t k = 0; k < 3; ++k) {
            const vec3<T> corner = k == 0 ? t.a : k == 1 ? t.b : t.c;
            way[k] = exactly(corner, angle_number());
            m[k] = exactly(corner, angle_rational());
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const angle_vector &a = way[k], &b = way[(k + 1) % 3];
            const angle_vector edge{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
            angle_number along = -angle_dot(a, edge), distance = std::min(angle_length(a), angle_length(b));
            if (along > 0 && along < angle_dot(edge, edge)) distance = angle_length(angle_cross(a, b)) / angle_length(edge);
            const angle_number farther = std::max(angle_length(a), angle_length(b));
            is_off_edges = is_off_edges && distance >= std::ldexp(1.0, -26) * farther && distance > 0;
        }
        const angle_rational det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                                   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        if (det.sign() == 0) return;
        const angle_number pi = boost::math::constants::pi<angle_number>();
        angle_number sum = -pi;
        for (std::size_t k = 0; k < 3; ++k) {
            const angle_vector left = angle_cross(way[k], way[(k + 1) % 3]), right = angle_cross(way[k], way[(k + 2) % 3]);
            sum += atan2(angle_length(angle_cross(left, right)), angle_dot(left, right));
        }
        share = det.sign() * sum / (4 * pi);
    }
};

}  // namespace abut::test
