// SPDX-License-Identifier: MIT
#pragma once

// What the peers that ask Embree for points share: a scene of triangles, and the usual closest-point test in single
// precision.

#include <cstring>
#include <stdexcept>
#include <vector>

#include "../docs/examples/scene.hpp"
#include "embree.hpp"

namespace embree_peer {

using vec = abut::vec3<float>;

inline vec minus(const vec& p, const vec& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
inline vec along(const vec& p, float s, const vec& d) { return {p.x + s * d.x, p.y + s * d.y, p.z + s * d.z}; }
inline float inner(const vec& p, const vec& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

/// The point of triangle abc that is closest to p, by Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5).
inline vec closest_point(const vec& p, const vec& a, const vec& b, const vec& c) {
    const vec ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
    const float d1 = inner(ab, ap), d2 = inner(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const vec bp = minus(p, b);
    const float d3 = inner(ab, bp), d4 = inner(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, d1 / (d1 - d3), ab);
    const vec cp = minus(p, c);
    const float d5 = inner(ab, cp), d6 = inner(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, d2 / (d2 - d6), ac);
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return along(b, (d4 - d3) / (d4 - d3 + d5 - d6), minus(c, b));
    const float scale = 1 / (va + vb + vc);
    return along(along(a, vb * scale, ab), vc * scale, ac);
}

/// A tree over the triangles of a surface, for one thread.
class embree_scene {
public:
    /// robust: rays do not slip through edges.
    explicit embree_scene(const scene::surface<float>& mesh, bool robust = false) : device_(rtcNewDevice("threads=1")) {
        if (device_ == nullptr) throw std::runtime_error("Embree gives no device");
        scene_ = rtcNewScene(device_);
        if (robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        copy_in(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
        copy_in(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.faces);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    embree_scene(const embree_scene&) = delete;
    embree_scene& operator=(const embree_scene&) = delete;
    ~embree_scene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    [[nodiscard]] RTCScene get() const { return scene_; }

private:
    template <class Element>
    static void copy_in(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<Element>& values) {
        static_assert(sizeof(Element) == 12);
        void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), values.size());
        std::memcpy(to, values.data(), values.size() * sizeof(Element));
    }

    RTCDevice device_;
    RTCScene scene_ = nullptr;
};

}  // namespace embree_peer
