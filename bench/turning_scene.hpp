// SPDX-License-Identifier: MIT
#pragma once

// What bench/turning.cpp and bench/turning.cu share: motions of FCL's robot in its room, which is 6,000 wide. Short: edges of a road map,
// 300 long and half a radian at most, that begin free. Long: to any pose, from one that is free. Anywhere: from any pose to any other.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/collide/query.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/set.hpp>

namespace turning_scene {

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};

struct kind {
    const char* name;
    bool is_short, begins_free;
};
inline constexpr std::array<kind, 3> kinds{{{"short", true, true}, {"long", false, true}, {"anywhere", false, false}}};

inline constexpr double tolerance = 0.1;
inline constexpr abut::bvh_options how_built{.builder = abut::bvh_builder::sah};

struct motion {
    abut::rigid<float> from, to;
};

class numbers {
public:
    double between(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_ = 20190819;
};

inline abut::rigid<float> pose_of(const std::array<double, 4>& q, const abut::vec3<double>& at) {
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double w = q[0] / n, x = q[1] / n, y = q[2] / n, z = q[3] / n;
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    abut::rigid<float> p;
    for (int i = 0; i < 9; ++i) p.rotation[i] = static_cast<float>(m[i]);
    p.translation = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
    return p;
}

/// n motions of a kind.
template <class Index>
std::vector<motion> motions_of(const kind& of, const Index& robot, const Index& room, std::size_t n) {
    numbers draw;
    std::vector<motion> all;
    while (all.size() < n) {
        std::array<double, 4> q{}, r{};
        double length = 0;
        for (double& x : q) x = draw.between(-1, 1), length += x * x;
        if (length > 1 || length < 0.01) continue;
        const abut::vec3<double> at{draw.between(-3000, 3000), draw.between(-3000, 3000), draw.between(0, 2987)};
        abut::vec3<double> to{draw.between(-3000, 3000), draw.between(-3000, 3000), draw.between(0, 2987)};
        for (double& x : r) x = draw.between(-1, 1);
        if (of.is_short) {
            // A turn by half a radian at most is one by a quaternion that is a tenth off.
            for (std::size_t i = 0; i < 4; ++i) r[i] = q[i] + 0.1 * std::sqrt(length) * r[i];
            to = {at.x + draw.between(-170, 170), at.y + draw.between(-170, 170), at.z + draw.between(-170, 170)};
        }
        // A half turn goes round either way, and is refused.
        const double cosine = q[0] * r[0] + q[1] * r[1] + q[2] * r[2] + q[3] * r[3];
        if (cosine * cosine < 1e-6 * length * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3])) continue;
        const motion m{pose_of(q, at), pose_of(r, to)};
        if (of.begins_free && abut::any(abut::serial{}, abut::posed(robot, m.from), room)) continue;
        all.push_back(m);
    }
    return all;
}

/// The same as pairs of a motion and the room at rest.
template <class Index>
std::vector<abut::moving_pair<Index>> pairs_of(const std::vector<motion>& motions, const Index& robot, const Index& room) {
    std::vector<abut::moving_pair<Index>> list;
    for (const motion& m : motions) {
        list.push_back({abut::moving(abut::posed(robot, m.from), abut::posed(robot, m.to)), abut::posed(room, abut::rigid<float>{})});
    }
    return list;
}

}  // namespace turning_scene
