// SPDX-License-Identifier: MIT
//
// The peer: Bullet's GImpact in float. Two of its trees of quantised boxes find pairs, which are decided as its collision
// algorithm decides them, by planes and clipping, here with no margin. That is not exact.

#include <cstddef>

#include <BulletCollision/Gimpact/btGImpactQuantizedBvh.h>
#include <BulletCollision/Gimpact/btTriangleShapeEx.h>
#include <benchmark/benchmark.h>

#include "../meshes_scene.hpp"

namespace {

namespace scene = meshes_scene;

class triangles : public btPrimitiveManagerBase {
public:
    explicit triangles(const scene::surface& s) : surface_(s) {}
    bool is_trimesh() const override { return true; }
    int get_primitive_count() const override { return static_cast<int>(surface_.faces.size()); }
    void get_primitive_box(int i, btAABB& box) const override {
        btPrimitiveTriangle t;
        get_primitive_triangle(i, t);
        box.calc_from_triangle(t.m_vertices[0], t.m_vertices[1], t.m_vertices[2]);
    }
    void get_primitive_triangle(int i, btPrimitiveTriangle& t) const override {
        const auto& f = surface_.faces[static_cast<std::size_t>(i)];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& p = surface_.vertices[f[k]];
            t.m_vertices[k].setValue(p.x, p.y, p.z);
        }
        t.m_margin = 0;
    }

private:
    const scene::surface& surface_;
};

struct tree {
    triangles shapes;
    btGImpactQuantizedBvh boxes{&shapes};

    explicit tree(const scene::surface& s) : shapes(s) { boxes.buildSet(); }
};

void query(benchmark::State& state) {
    const tree a(scene::the_pair->a), b(scene::the_pair->b);
    const auto here = btTransform::getIdentity();
    std::size_t found = 0;
    for (auto _ : state) {
        btPairSet candidates;
        btGImpactQuantizedBvh::find_collision(&a.boxes, here, &b.boxes, here, candidates);
        found = 0;
        for (int i = 0; i < candidates.size(); ++i) {
            btPrimitiveTriangle p, q;
            a.shapes.get_primitive_triangle(candidates[i].m_index1, p);
            b.shapes.get_primitive_triangle(candidates[i].m_index2, q);
            p.buildTriPlane();
            q.buildTriPlane();
            GIM_TRIANGLE_CONTACT contact;
            if (p.overlap_test_conservative(q) && p.find_triangle_collision_clip_method(q, contact)) ++found;
        }
    }
    state.counters["pairs"] = static_cast<double>(found);
}

void usual(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly(true)->MinTime(0.01);
}

[[maybe_unused]] const bool added = [] {
    scene::peers().push_back([] {
        usual(benchmark::RegisterBenchmark("build/bullet_gimpact/serial", [](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(tree(scene::the_pair->a).boxes.getNodeCount());
        }));
        usual(benchmark::RegisterBenchmark("unsorted/bullet_gimpact/serial", query));
    });
    return true;
}();

}  // namespace
