// SPDX-License-Identifier: MIT
//
// The peer: Embree's rtcCollide on one thread, over boxes of triangles as its manual has it for user geometry, with our
// exact test at its leaves, so that it finds the same pairs. They come unsorted.

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "../any_scenes.hpp"
#include "../embree.hpp"

namespace {

namespace scene = meshes_scene;

abut::triangle<float> triangle_of(const scene::surface& s, std::size_t i) {
    const auto& f = s.faces[i];
    return {s.vertices[f[0]], s.vertices[f[1]], s.vertices[f[2]]};
}

void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& s = *static_cast<const scene::surface*>(arguments->geometryUserPtr);
    const auto box = abut::bounds(triangle_of(s, arguments->primID));
    RTCBounds& to = *arguments->bounds_o;
    to.lower_x = box.lower.x;
    to.lower_y = box.lower.y;
    to.lower_z = box.lower.z;
    to.upper_x = box.upper.x;
    to.upper_y = box.upper.y;
    to.upper_z = box.upper.z;
}

class tree {
public:
    tree(const scene::surface& s, RTCBuildQuality quality) : device_(rtcNewDevice("threads=1")) {
        if (device_ == nullptr) throw std::runtime_error("Embree gives no device");
        scene_ = rtcNewScene(device_);
        rtcSetSceneBuildQuality(scene_, quality);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(s.faces.size()));
        rtcSetGeometryUserData(geometry, const_cast<scene::surface*>(&s));
        rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    tree(const tree&) = delete;
    tree& operator=(const tree&) = delete;
    ~tree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    [[nodiscard]] RTCScene get() const { return scene_; }

private:
    RTCDevice device_;
    RTCScene scene_ = nullptr;
};

using pair_list = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct outcome {
    const scene::mesh_pair& pair;
    pair_list found;
    bool first_will_do = false;
};

void decide(void* to, RTCCollision* collisions, unsigned n) {
    auto& [pair, found, first_will_do] = *static_cast<outcome*>(to);
    for (unsigned i = 0; i < n; ++i) {
        if (first_will_do && !found.empty()) return;
        const unsigned p = collisions[i].primID0, q = collisions[i].primID1;
        if (abut::intersects(triangle_of(pair.a, p), triangle_of(pair.b, q))) found.emplace_back(p, q);
    }
}

/// rtcCollide, which nothing ends early: after the first hit its callback returns at once.
void query(benchmark::State& state, const scene::mesh_pair& pair, RTCBuildQuality quality, bool first_will_do) {
    const tree a(pair.a, quality), b(pair.b, quality);
    outcome out{pair, {}, first_will_do};
    const auto ask = [&] {
        out.found.clear();
        rtcCollide(a.get(), b.get(), decide, &out);
    };
    if (first_will_do) ask();
    for (auto _ : state) ask();
    state.counters[first_will_do ? "found" : "pairs"] = static_cast<double>(out.found.size());
}

void usual(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->Repetitions(11)->ReportAggregatesOnly(true)->MinTime(0.01);
}

[[maybe_unused]] const bool added = [] {
    scene::peers().push_back([] {
        constexpr std::pair<const char*, RTCBuildQuality> qualities[] = {{"low", RTC_BUILD_QUALITY_LOW},
                                                                         {"medium", RTC_BUILD_QUALITY_MEDIUM}};
        for (const auto& [name, quality] : qualities) {
            usual(benchmark::RegisterBenchmark((std::string("build/embree_") + name + "/serial").c_str(),
                                               [q = quality](benchmark::State& state) {
                                                   for (auto _ : state) {
                                                       const tree t(scene::the_pair->a, q);
                                                       benchmark::DoNotOptimize(t.get());
                                                   }
                                               }));
            usual(benchmark::RegisterBenchmark((std::string("unsorted/embree_") + name + "/serial").c_str(), query,
                                               *scene::the_pair, quality, false));
            for (const scene::any_scene& s : scene::any_scenes) {
                usual(benchmark::RegisterBenchmark(("any/" + s.name + "/baked/embree_" + name).c_str(), query, s.pair,
                                                   quality, true));
            }
        }
    });
    return true;
}();

}  // namespace
