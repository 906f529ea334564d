// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <vector>

#include "expect.hpp"

int main() {
    const abut::mesh<float> cloth{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}};
    const abut::spheres<float> balls{{{{0, 0, 4}, 1}, {{5, 5, 5}, 1}}};
    const std::vector<abut::vec3<float>> next{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}, {1, 1, 3}};
    //! [indices]
    const abut::openmp on;
    auto tree = abut::make_bvh(on, cloth);
    const auto grid = abut::make_grid(on, balls, {.cell_width = 2});
    expect(!abut::any(on, tree, grid));

    // The mesh at another time, and the tree around it: the topology stays.
    tree = abut::refit(on, tree, cloth.with_vertices(on, next));
    expect(abut::count(on, tree, grid) == 1);

    // Where the tree is queried often: a better one, in a layout for the host.
    const auto better = abut::wide(on, abut::make_bvh(on, tree.set(), {.builder = abut::bvh_builder::sah}));
    expect(abut::count(on, better, balls) == 1);
    expect(abut::quality(better).sah_cost <= abut::quality(tree).sah_cost);
    //! [indices]
}
