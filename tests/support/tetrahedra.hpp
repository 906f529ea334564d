// SPDX-License-Identifier: MIT
#pragma once

// How often a closed surface goes round a point, in rational numbers and by tetrahedra: the oracle of `inside` and of exact winding
// numbers. No way is followed and nothing is seen along an axis.

#include <array>
#include <cstddef>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/view.hpp>

#include "support/catch.hpp"

namespace abut::test {

struct turns_around {
    int turns;  ///< 0 on the surface
    bool on_surface;
};

/// The tetrahedra from one point, the apex, to each face that hold p count by the side from which they see their face. That p is
/// on no side of theirs that ends in the apex is checked.
template <class T>
turns_around turns_by_tetrahedra(const std::vector<vec3<T>>& vertices, const std::vector<face>& faces, const vec3<T>& p) {
    using number = boost::multiprecision::cpp_rational;
    using point = std::array<number, 3>;
    const point apex{number(1234567, 1000003), number(7654321, 1000033), number(-3141592, 1000037)};
    const auto exactly = [](const vec3<T>& v) { return point{number(v.x), number(v.y), number(v.z)}; };
    const auto volume = [](const point& a, const point& b, const point& c, const point& d) {
        number m[3][3];
        for (std::size_t k = 0; k < 3; ++k) m[0][k] = b[k] - a[k], m[1][k] = c[k] - a[k], m[2][k] = d[k] - a[k];
        const number v = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        return v.sign();
    };
    const point q = exactly(p);
    int turns = 0;
    for (const face& f : faces) {
        const point a = exactly(vertices[f[0]]), b = exactly(vertices[f[1]]), c = exactly(vertices[f[2]]);
        const int whole = volume(apex, a, b, c);
        if (whole == 0) continue;
        const int parts[4] = {volume(q, a, b, c), volume(apex, q, b, c), volume(apex, a, q, c), volume(apex, a, b, q)};
        bool has_opposite = false, has_zero = false;
        for (const int part : parts) has_opposite = has_opposite || part * whole < 0, has_zero = has_zero || part == 0;
        if (has_opposite) continue;
        if (parts[0] == 0) return {0, true};
        REQUIRE(!has_zero);
        turns += whole;
    }
    return {turns, false};
}

}  // namespace abut::test
