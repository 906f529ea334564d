// SPDX-License-Identifier: MIT
//
// The peer: FCL's separating-axis test in double, as its traversal of meshes calls it. Its answers are not exact.

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include "peer.hpp"

namespace {

struct corners {
    fcl::Vector3d of[6];
};

fcl::Vector3d point(const abut::vec3<float>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

corners theirs(const triangle_scene::triangle_pair<float>& pair) {
    const auto& [a, b] = pair;
    return {{point(a.a), point(a.b), point(a.c), point(b.a), point(b.b), point(b.c)}};
}

bool decide(const corners& pair) {
    const auto& p = pair.of;
    return fcl::detail::Intersect<double>::intersect_Triangle(p[0], p[1], p[2], p[3], p[4], p[5]);
}

[[maybe_unused]] const bool registered = triangle_scene::register_peer("fcl", theirs, decide);

}  // namespace
