// SPDX-License-Identifier: MIT

#include <abut/mpi.hpp>

#include <cstdio>

int main(int argc, char* argv[]) {
    MPI_Init(&argc, &argv);
    const abut::distributed on(MPI_COMM_WORLD);
    const abut::sphere<float> ball{{0, 0, 0}, 1};
    std::printf("touching: %d on %d ranks\n", static_cast<int>(abut::count(on, ball, ball)), on.size());
    MPI_Finalize();
}
