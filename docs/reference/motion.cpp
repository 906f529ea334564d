// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <cstdio>
#include <vector>

#include "expect.hpp"

int main() {
    const abut::mesh<float> floor{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
    const abut::mesh<float> cloth{{{1, 1, 1}, {2, 1, 3}, {1, 2, 3}}, {{0, 1, 2}}};
    const std::vector<abut::vec3<float>> then{{1, 1, -1}, {2, 1, 1}, {1, 2, 1}}, last{{1, 1, -3}, {2, 1, -1}, {1, 2, -1}};
    //! [motion]
    const abut::openmp on;
    const auto step = abut::moving(cloth, cloth.with_vertices(on, then));  // from t = 0 to t = 1
    for (const auto& i : abut::to_host(abut::impacts(on, step, floor))) {
        std::printf("at t = %g: vertex %u and face %u %u %u\n", i.time, i.vertices[0], i.vertices[1], i.vertices[2],
                    i.vertices[3]);
    }
    const auto first = abut::first_impact(on, step, floor);
    expect(first && first->kind == abut::feature_pair::vertex_face && first->time == 0.5);
    expect(abut::self_impacts(on, step).empty());

    // For many steps of one mesh: an index, which refit brings to the next step.
    auto index = abut::make_impact_index(on, step);
    index = abut::refit(on, index, abut::moving(step.t1(), cloth.with_vertices(on, last)));
    expect(abut::impacts(on, index, floor).size() == 2);  // the other two vertices arrive
    //! [motion]
}
