// SPDX-License-Identifier: MIT

#include <abut/mpi.hpp>
#include <cstdint>
#include <vector>

#include "expect.hpp"

int main(int argc, char* argv[]) {
    MPI_Init(&argc, &argv);
    {
        const std::vector<abut::triangle<float>> triangles{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                                           {{9, 9, 9}, {9, 8, 9}, {8, 9, 9}}};
        const abut::triangle_soup<float> my_triangles(triangles);
        const abut::spheres<float> my_spheres(std::vector<abut::sphere<float>>{{{1, 1, 1}, 1}});
        //! [distributed]
        const abut::distributed on(MPI_COMM_WORLD, abut::openmp{});
        const auto tree = abut::make_bvh(on.local(), my_triangles);  // of this rank's part

        const std::uint64_t all = abut::count(on, tree, my_spheres);  // the same on each rank
        expect(all >= static_cast<std::uint64_t>(on.size()));
        const auto mine = abut::pairs(on, tree, my_spheres);  // of this rank's triangles and the spheres of all ranks
        expect(mine.size() == static_cast<std::size_t>(on.size()));

        const std::vector<abut::vec3<float>> my_points{{1, 1, 3}};
        const auto nearest = abut::nearest(on, tree, my_points).to_host();
        expect(nearest[0].distance == 3);

        const auto part = abut::redistribute(on, my_spheres);  // along a Morton curve
        expect(abut::any(on, tree, part.set));
        //! [distributed]
    }
    MPI_Finalize();
}
