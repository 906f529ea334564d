// SPDX-License-Identifier: MIT
//
// The peer: Embree's point queries over the same triangles, on one thread, with the usual closest-point test in single
// precision. It is a fast library used as its manual says; its answers are not exact, and not sorted unless sorted here.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include "../../docs/examples/scene.hpp"

namespace {

using vec = abut::vec3<float>;

vec minus(const vec& p, const vec& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
vec along(const vec& p, float s, const vec& d) { return {p.x + s * d.x, p.y + s * d.y, p.z + s * d.z}; }
float inner(const vec& p, const vec& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

/// The point of triangle abc that is closest to p, by Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5).
vec closest_point(const vec& p, const vec& a, const vec& b, const vec& c) {
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

struct scene_data {
    scene::surface<float> mesh = scene::torus<float>();
    std::vector<vec> centers = scene::centers<float>();
};

const scene_data& the_scene() {
    static const scene_data data;
    return data;
}

class embree_scene {
public:
    explicit embree_scene(const scene::surface<float>& mesh) : device_(rtcNewDevice("threads=1")) {
        if (device_ == nullptr) throw std::runtime_error("Embree gives no device");
        scene_ = rtcNewScene(device_);
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

using pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // (triangle, sphere)

struct query {
    const scene::surface<float>& mesh;
    std::uint32_t sphere;
    pairs& found;
};

bool meet(RTCPointQueryFunctionArguments* arguments) {
    auto& q = *static_cast<query*>(arguments->userPtr);
    const auto& f = q.mesh.faces[arguments->primID];
    const vec p{arguments->query->x, arguments->query->y, arguments->query->z};
    const vec to = minus(closest_point(p, q.mesh.vertices[f[0]], q.mesh.vertices[f[1]], q.mesh.vertices[f[2]]), p);
    if (inner(to, to) <= arguments->query->radius * arguments->query->radius)
        q.found.emplace_back(arguments->primID, q.sphere);
    return false;  // the radius has not changed
}

pairs find_pairs(const embree_scene& index, bool sorted) {
    const scene_data& data = the_scene();
    pairs found;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    for (std::size_t i = 0; i < data.centers.size(); ++i) {
        const vec& p = data.centers[i];
        query q{data.mesh, static_cast<std::uint32_t>(i), found};
        RTCPointQuery point{p.x, p.y, p.z, 0, static_cast<float>(scene::radius)};
        rtcPointQuery(index.get(), &point, &context, meet, &q);
    }
    if (sorted) std::sort(found.begin(), found.end());
    return found;
}

void note(benchmark::State& state, std::size_t found) {
    state.counters["pairs"] = static_cast<double>(found);
    state.counters["spheres"] = static_cast<double>(scene::sphere_count);
}

void build(benchmark::State& state) {
    for (auto _ : state) {
        const embree_scene index(the_scene().mesh);
        benchmark::DoNotOptimize(index.get());
    }
}

void query_only(benchmark::State& state, bool sorted) {
    const embree_scene index(the_scene().mesh);
    std::size_t n = 0;
    for (auto _ : state) n = find_pairs(index, sorted).size();
    note(state, n);
}

void build_and_query(benchmark::State& state, bool sorted) {
    std::size_t n = 0;
    for (auto _ : state) n = find_pairs(embree_scene(the_scene().mesh), sorted).size();
    note(state, n);
}

constexpr int repetitions = 11;

[[maybe_unused]] const bool registered = [] {
    const auto usual = [](benchmark::internal::Benchmark* b) {
        b->Repetitions(repetitions)->ReportAggregatesOnly(true)->Unit(benchmark::kMillisecond)->Iterations(1);
    };
    usual(benchmark::RegisterBenchmark("build/embree/serial", build));
    usual(benchmark::RegisterBenchmark("unsorted/embree/serial/1703244", query_only, false));
    usual(benchmark::RegisterBenchmark("pairs/embree/serial/1703244", query_only, true));
    usual(benchmark::RegisterBenchmark("all/embree/serial", build_and_query, true));
    usual(benchmark::RegisterBenchmark("all_unsorted/embree/serial", build_and_query, false));
    return true;
}();

}  // namespace
