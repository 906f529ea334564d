// SPDX-License-Identifier: MIT
#pragma once

// What a volume encloses, by its stored numbers, in integers of one unit.

#include <vector>

#include <abut/shape/volume.hpp>

#include "rational.hpp"

namespace abut::test {

inline integer product(const integer* a, const integer* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

template <class T>
bool encloses(const sphere<T>& v, const vec3<T>& p) {
    if (v.radius == infinity<T>) return true;
    const std::vector<integer> n = to_integers<T>({p.x, p.y, p.z, v.center.x, v.center.y, v.center.z, v.radius});
    const integer way[3] = {n[0] - n[3], n[1] - n[4], n[2] - n[5]};
    return product(way, way) <= n[6] * n[6];
}
template <class T>
bool encloses(const aabb<T>& v, const vec3<T>& p) {
    return contains(v, bounds(p));
}
template <class T>
bool encloses(const obb<T>& v, const vec3<T>& p) {
    const T h[3] = {v.half_widths.x, v.half_widths.y, v.half_widths.z};
    for (int i = 0; i < 3; ++i) {
        if (h[i] == infinity<T>) continue;
        const std::vector<integer> n = to_integers<T>({p.x, p.y, p.z, v.center.x, v.center.y, v.center.z, h[i]});
        const std::vector<integer> axis = to_integers<T>({v.axes[i].x, v.axes[i].y, v.axes[i].z, 1});
        const integer way[3] = {n[0] - n[3], n[1] - n[4], n[2] - n[5]};
        if (abs(product(axis.data(), way)) > n[6] * axis[3]) return false;
    }
    return true;
}
template <class T, int K>
bool encloses(const kdop<T, K>& v, const vec3<T>& p) {
    for (int i = 0; i < K / 2; ++i) {
        const detail::kdop_normal m = detail::normal_of<K>(i);
        for (const int side : {-1, 1}) {
            const T plane = side > 0 ? v.upper[i] : -v.lower[i];
            if (plane == infinity<T>) continue;
            const std::vector<integer> n = to_integers<T>({p.x, p.y, p.z, plane});
            const integer along = side * (m.x * n[0] + m.y * n[1] + m.z * n[2]);
            if (along > n[3]) return false;
        }
    }
    return true;
}
template <class V, class T>
bool encloses(const V& v, const triangle<T>& t) {
    return encloses(v, t.a) && encloses(v, t.b) && encloses(v, t.c);
}

}  // namespace abut::test
