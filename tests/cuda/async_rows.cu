// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cuda/own_stream.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace {

__global__ void push_vertices(vec3<float>* vertices, std::size_t n, vec3<float> way) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < n) vertices[i] = vertices[i] + way;
}

std::vector<vec3<float>> random_points_around(draws& d, std::size_t n) {
    std::vector<vec3<float>> made;
    const auto one = [&] { return static_cast<float>(d.uniform(-2, 2)); };
    for (std::size_t i = 0; i < n; ++i) {
        const float x = one(), y = one(), z = one();
        made.push_back({x, y, z});
    }
    return made;
}
std::vector<ray<float>> rays_to_middle(const std::vector<vec3<float>>& from) {
    std::vector<ray<float>> made;
    for (const auto& p : from) made.push_back({p, {0.1f - p.x, -p.y, -p.z}});
    return made;
}
template <class T>
auto on_host(const T& found) {
    return to_host(found);
}

}  // namespace

TEST_CASE("async rows: as calls that wait, and again in a graph about what has moved") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    draws d(20261129, 7, 0);
    const auto ball = ball_surface<float>(3, 1.0);
    const auto from = random_points_around(d, 5000);
    const auto points_there = copy_to(on, points<float>(from));
    const auto rays_there = copy_to(on, rays<float>(rays_to_middle(from)));
    execution::buffer<vec3<float>, device_space> vertices(on, ball.vertices.size());
    execution::buffer<face, device_space> faces(on, ball.faces.size());
    upload(on, ball.vertices.data(), ball.vertices.size(), vertices.data());
    upload(on, ball.faces.data(), ball.faces.size(), faces.data());
    const mesh_view<float, device_space> moves(vertices.data(), vertices.size(), faces.data(), faces.size());
    async_index tree(on, make_bvh(on, moves));
    const auto other = make_bvh(on, mesh<float>(ball.vertices, ball.faces));

    async_result<neighbor<float>> nearest_of(on, from.size()), in_set(on, from.size()), few(on, 3 * from.size() + 7);
    async_result<ray_hit<float>> first(on, from.size() + 7), until(on, from.size());
    async_result<std::uint8_t> any(on, from.size());
    async_result<index_pair> near(on, 100'000);
    const raycast_options<> short_ones{.most_t = 0.75};
    const auto run = [&] {
        push_vertices<<<4, 256, 0, on.stream>>>(vertices.data(), vertices.size(), {0.125f, 0, 0.0625f});
        refit(async(on, tree));
        nearest(async(on, nearest_of), tree.index(), points_there);
        nearest(async(on, in_set), moves, points_there.view());
        nearest(async(on, few), tree.index(), points_there, 3);
        raycast(async(on, first), tree.index(), rays_there);
        raycast(async(on, until), tree.index(), rays_there, short_ones);
        raycast_any(async(on, any), tree.index(), rays_there);
        within(async(on, near), tree.index(), other, 0.125);
    };
    const auto check = [&] {
        const auto expected = on_host(nearest(on, moves, points_there));
        CHECK(on_host(wait(on, nearest_of)) == expected);
        CHECK(on_host(wait(on, in_set)) == expected);
        CHECK(on_host(wait(on, few)) == on_host(nearest(on, moves, points_there, 3)));
        const auto hits = on_host(raycast(on, moves, rays_there));
        CHECK(on_host(wait(on, first)) == hits);
        CHECK(read_state(on, first).size == from.size());
        CHECK(read_state(on, first).undecided == 0);
        CHECK(on_host(wait(on, until)) == on_host(raycast(on, moves, rays_there, short_ones)));
        CHECK(on_host(wait(on, any)) == on_host(raycast_any(on, moves, rays_there)));
        CHECK(on_host(wait(on, near)) == on_host(within(on, moves, other, 0.125)));
        return expected;
    };
    run();
    const auto before = check();
    synchronize(on);
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    REQUIRE(cudaStreamBeginCapture(on.stream, cudaStreamCaptureModeGlobal) == cudaSuccess);
    run();
    REQUIRE(cudaStreamEndCapture(on.stream, &graph) == cudaSuccess);
    REQUIRE(cudaGraphInstantiate(&executable, graph, 0) == cudaSuccess);
    for (int step = 0; step < 3; ++step) {
        REQUIRE(cudaGraphLaunch(executable, on.stream) == cudaSuccess);
        CHECK(check() != before);
    }
    cudaGraphExecDestroy(executable);
    cudaGraphDestroy(graph);
}

TEST_CASE("async rows: nothing there, and what is refused") {
    const cuda on;
    const auto ball = ball_surface<float>(1, 1.0);
    const auto tree = make_bvh(on, mesh<float>(ball.vertices, ball.faces));
    const auto none = copy_to(on, spheres<float>());
    const auto there = copy_to(on, points<float>({{3, 0, 0}, {0, 4, 0}}));
    async_result<neighbor<float>> found(on, 2), one(on, 1);
    CHECK_THROWS_WITH(wait(on, found), "abut::wait: nothing was asked");
    nearest(async(on, found), none, there);
    CHECK(to_host(wait(on, found)) == to_host(nearest(on, none, there)));
    nearest(async(on, found), tree, there);
    CHECK(to_host(wait(on, found)) == to_host(nearest(on, tree, there)));
    CHECK_THROWS_WITH(nearest(async(on, one), tree, there), "abut::nearest_async: there are 2 answers, and room for 1");
    CHECK_THROWS_WITH(nearest(async(on, found), tree, there, 0), "abut::nearest: count is 0, expected 1 or more");
    async_result<ray_hit<float>> hits(on, 1);
    raycast(async(on, hits), tree, ray<float>{{3, 0.1f, 0.2f}, {-1, 0, 0}});
    CHECK(to_host(wait(on, hits)) == to_host(raycast(on, tree, ray<float>{{3, 0.1f, 0.2f}, {-1, 0, 0}})));
    raycast(async(on, hits), none, ray<float>{{3, 0.1f, 0.2f}, {-1, 0, 0}});
    CHECK(to_host(wait(on, hits)) == to_host(raycast(on, none, ray<float>{{3, 0.1f, 0.2f}, {-1, 0, 0}})));
}

}  // namespace abut::test
