// SPDX-License-Identifier: MIT
//
// The peer: FCL's models of oriented boxes and swept spheres, its fastest for distances, with the nearest points. In double,
// for which its code is in the library that the package has, and in float.

#include <memory>

#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include "peer.hpp"

namespace {

using distance_peer::pose;

template <class S>
using model = fcl::BVHModel<fcl::OBBRSS<S>>;

template <class S>
fcl::Vector3<S> point(const abut::vec3<float>& p) {
    return {S(p.x), S(p.y), S(p.z)};
}

template <class S>
std::shared_ptr<model<S>> build(const distance_scene::surface& s) {
    auto m = std::make_shared<model<S>>();
    m->beginModel(static_cast<int>(s.faces.size()), static_cast<int>(s.vertices.size()));
    for (const auto& f : s.faces) {
        m->addTriangle(point<S>(s.vertices[f[0]]), point<S>(s.vertices[f[1]]), point<S>(s.vertices[f[2]]));
    }
    m->endModel();
    return m;
}

template <class S>
void add(const distance_peer::scene& s, const char* name) {
    distance_peer::add(s, name, [a = build<S>(s.a), b = build<S>(s.b)](const pose& p) {
        const auto here = fcl::Transform3<S>::Identity();
        auto there = here;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) there(i, j) = S(p.rotation[3 * i + j]);
        }
        there.translation() = point<S>(p.translation);
        fcl::DistanceResult<S> result;
        fcl::distance(a.get(), here, b.get(), there, fcl::DistanceRequest<S>(true), result);
        return result.min_distance > 0 ? static_cast<double>(result.min_distance) : 0;
    });
}

[[maybe_unused]] const bool added = [] {
    distance_peer::peers().push_back([](const distance_peer::scene& s) {
        add<double>(s, "fcl");
        add<float>(s, "fcl_float");
    });
    return true;
}();

}  // namespace
