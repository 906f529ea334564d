// SPDX-License-Identifier: MIT
//
// Which balls touch which triangles, on many processes: mpirun -np 4 distributed [number of triangles]
//
// The scene is the same for any number of processes, and so is what is printed.

#include <abut/mpi.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// A number in [0, 1) that belongs to shape i and coordinate k, on whichever rank it is made.
float draw(std::uint64_t i, std::uint64_t k) {
    std::uint64_t x = (i * 16 + k + 1) * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return static_cast<float>(x >> 40) * 0x1p-24f;
}

abut::vec3<float> point(std::uint64_t i, std::uint64_t k) { return {draw(i, k), draw(i, k + 1), draw(i, k + 2)}; }

int run(std::uint64_t n) {
    // Each rank makes a part of the scene: these shapes of all n.
    const abut::distributed on(MPI_COMM_WORLD, abut::openmp{});
    const auto rank = static_cast<std::uint64_t>(on.rank()), ranks = static_cast<std::uint64_t>(on.size());
    const std::uint64_t first = n * rank / ranks, last = n * (rank + 1) / ranks;
    std::vector<abut::triangle<float>> triangles;
    std::vector<abut::sphere<float>> balls;
    for (std::uint64_t i = first; i < last; ++i) {
        const abut::vec3<float> p = point(i, 0), u = point(i, 3), v = point(i, 6);
        // Times a power of two is exact, so that it is the same whether or not a compiler makes an fma of it.
        triangles.push_back({p, p + 0x1p-4f * u, p + 0x1p-4f * v});
        balls.push_back({point(i, 9), 0.01f * (1 + draw(i, 12))});
    }

    // They lie anywhere. Divided anew, each rank has neighbours.
    const auto a = abut::redistribute(on, abut::triangle_soup<float>(triangles));
    const auto b = abut::redistribute(on, abut::spheres<float>(balls));
    const auto tree = abut::make_bvh(on.local(), a.set);

    const std::uint64_t touching = abut::count(on, tree, b.set);
    const auto pairs = abut::pairs(on, tree, b.set);  // of this rank's triangles; ids are positions in the new parts
    const auto deepest = [&] {
        float most = 0;
        for (const auto& c : abut::contacts(on, tree, b.set)) most = c.depth > most ? c.depth : most;
        float of_all = 0;
        MPI_Allreduce(&most, &of_all, 1, MPI_FLOAT, MPI_MAX, MPI_COMM_WORLD);
        return of_all;
    }();
    if (on.rank() == 0) {
        std::printf("triangles  %llu\npairs      %llu\ndeepest    %g\n", static_cast<unsigned long long>(n),
                    static_cast<unsigned long long>(touching), static_cast<double>(deepest));
    }
    return pairs.size() <= touching ? 0 : 1;
}

}  // namespace

int main(int argc, char* argv[]) {
    char* end = nullptr;
    const unsigned long long n = argc > 1 ? std::strtoull(argv[1], &end, 10) : 20'000;
    if (argc > 2 || (argc > 1 && (*end != '\0' || n == 0 || n > 1'000'000'000))) {
        std::fprintf(stderr, "usage: mpirun -np PROCESSES distributed [number of triangles, 1 to 1000000000]\n");
        return 2;
    }
    MPI_Init(&argc, &argv);
    int status = 1;
    try {
        status = run(n);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "distributed: %s\n", e.what());
    }
    MPI_Finalize();
    return status;
}
