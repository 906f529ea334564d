// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <algorithm>
#include <thread>
#include <vector>

#include "execution/verb_cases.hpp"
#include "index/index_cases.hpp"
#include "out_of_memory.hpp"
#include "support/catch.hpp"

using namespace abut;
using execution::buffer;

TEST_CASE("verbs: cuda") { test::check_verbs(abut::cuda{}); }

TEMPLATE_TEST_CASE("bvh: well-formed on cuda, and the tree that serial builds", "", float, double) {
    test::check_trees<TestType>(abut::cuda{});
}

namespace {

triangle_soup<float> some_triangles() {
    test::uniform random(31);
    return triangle_soup<float>(test::random_triangles<float>(20'000, random));
}
spheres<float> some_spheres() {
    test::uniform random(32);
    return spheres<float>(test::random_spheres<float>(20'000, random));
}

}  // namespace

TEST_CASE("memory: a second identical query takes none from the system, and release_memory gives it back") {
    const abut::cuda on;
    const auto soup = copy_to(on, some_triangles());
    const auto balls = copy_to(on, some_spheres());
    const auto query = [&] { return to_host(pairs(on, make_bvh(on, soup), balls)).size(); };
    const std::size_t first = query();
    const std::uint64_t reserved = memory_in_use(on).reserved;
    std::size_t free_before = 0, free_after = 0, total = 0;
    REQUIRE(cudaMemGetInfo(&free_before, &total) == cudaSuccess);
    for (int i = 0; i < 20; ++i) CHECK(query() == first);
    REQUIRE(cudaMemGetInfo(&free_after, &total) == cudaSuccess);
    CHECK(memory_in_use(on).reserved == reserved);
    CHECK(free_after == free_before);
    const std::uint64_t used = memory_in_use(on).used;
    release_memory(on);
    CHECK(memory_in_use(on).reserved < reserved);
    CHECK(memory_in_use(on).used == used);  // the sets are still there
    CHECK(query() == first);
    release_memory(serial{});
}

TEST_CASE("memory: running out is std::bad_alloc, and nothing leaks") {
    const abut::cuda on;
    synchronize(on);
    const std::uint64_t used = memory_in_use(on).used;
    for (int i = 0; i < 3; ++i) {
        CHECK_THROWS_AS((buffer<char, device_space>(on, std::size_t{1} << 50)), std::bad_alloc);
        CHECK_THROWS_AS((buffer<std::uint64_t, device_space>(on, static_cast<std::size_t>(-1) / 2)), std::bad_alloc);
    }
    const auto out_of_memory = [&] {
        // The first allocation of a pair succeeds, the second does not.
        buffer<char, device_space> kept(on, 1 << 20), lost(on, std::size_t{1} << 50);
    };
    CHECK_THROWS_AS(out_of_memory(), std::bad_alloc);
    synchronize(on);
    CHECK(memory_in_use(on).used == used);
    CHECK(cudaGetLastError() == cudaSuccess);
    CHECK(reduce(on, 10, std::uint64_t{0}, test::sum{}, test::identity{}) == 45);  // all is well after
}

TEST_CASE("memory: running out in the middle of a build, a refit and a query is std::bad_alloc, and all is well after") {
    const abut::cuda on;
    test::uniform random(33);
    const triangle_soup<float> host(test::random_triangles<float>(400'000, random)),
        other(test::random_triangles<float>(2000, random));
    test::check_out_of_device_memory("pairs", on, [&] {
        const auto tree = refit(on, make_bvh(on, host), host);
        return to_host(pairs(on, tree, make_bvh(on, other))).size();
    });
}

TEST_CASE("errors: cuda_error names the call and carries CUDA's text") {
    const std::string expected = "cudaSetDevice(99): invalid device ordinal (cudaErrorInvalidDevice)";
    const abut::cuda nowhere{.device = 99};
    try {
        synchronize(nowhere);
        FAIL("no device 99, and no error");
    } catch (const cuda_error& e) {
        CHECK(std::string(e.what()) == expected);
        CHECK(e.code() == cudaErrorInvalidDevice);
    }
    // Whatever comes first: an upload, a build, a query.
    const auto host = some_triangles();
    CHECK_THROWS_WITH(copy_to(nowhere, host), expected);
    CHECK_THROWS_WITH(make_bvh(nowhere, host), expected);
    CHECK_THROWS_WITH(make_grid(nowhere, host), expected);
    CHECK_THROWS_WITH(pairs(nowhere, host, host), expected);
    CHECK_THROWS_WITH(release_memory(nowhere), expected);
    int current = -1;
    CHECK(cudaGetDevice(&current) == cudaSuccess);
    CHECK(current == 0);
    CHECK(cudaGetLastError() == cudaSuccess);
    CHECK(to_host(pairs(abut::cuda{}, host, triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})).size() > 0);
}

TEST_CASE("errors: data of another device is refused, in one line") {
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices < 2) ABUT_SKIP("two devices", "this takes two devices");
    const abut::cuda here{.device = 0}, there{.device = 1};
    const triangle_soup<float> host = some_triangles();
    const auto set = copy_to(here, host);
    const auto tree = make_bvh(here, set);
    const auto expected = to_host(pairs(here, tree, set));
    CHECK(to_host(pairs(there, copy_to(there, set), copy_to(there, set))) == expected);
    const std::string owner = ": the set lies on device 0, the policy works on device 1";
    CHECK_THROWS_WITH(make_bvh(there, set), "abut::make_bvh" + owner);
    CHECK_THROWS_WITH(pairs(there, host, set), "abut::pairs" + owner);
    const std::string index = ": the index lies on device 0, the policy works on device 1";
    CHECK_THROWS_WITH(pairs(there, tree, host), "abut::pairs" + index);
    CHECK_THROWS_WITH(refit(there, tree, host), "abut::refit" + index);
    const std::string view = ": the view is over memory of device 0, the policy works on device 1";
    CHECK_THROWS_WITH(make_bvh(there, set.view()), "abut::make_bvh" + view);
    CHECK_THROWS_WITH(pairs(there, host, set.view()), "abut::pairs" + view);
    CHECK(to_host(pairs(here, tree, set)) == expected);
}

TEST_CASE("sets: on a device they are checked there") {
    const abut::cuda on;
    std::vector<vec3<float>> vertices(100'000, {1, 2, 3});
    vertices[77'777].y = -std::numeric_limits<float>::infinity();
    CHECK_THROWS_WITH((mesh<float, device_space>(on, vertices, std::vector<face>{})),
                      "abut::mesh: vertex 77777: y is not finite (-inf)");
    vertices[77'777].y = 0;
    std::vector<face> faces(1000, {0, 1, 2});
    faces[999][1] = 100'000;
    CHECK_THROWS_WITH((mesh<float, device_space>(on, vertices, faces)),
                      "abut::mesh: face 999: vertex index out of range, there are 100000 vertices (100000)");
    const sphere<double> bad[] = {{{0, 0, 0}, 1}, {{0, 0, 0}, -2}};
    CHECK_THROWS_WITH((spheres<double, device_space>(on, bad)), "abut::spheres: sphere 1: radius is negative (-2)");
}

TEST_CASE("sets: views over device memory are read in place and checked there") {
    const abut::cuda on;
    test::uniform random(3);
    const auto host = test::random_spheres<float>(1000, random);
    buffer<sphere<float>, device_space> balls(on, host.size());
    upload(on, host.data(), host.size(), balls.data());
    const spheres_view<float, device_space> view(balls.data(), balls.size());
    const triangle_soup<float> soup(test::random_triangles<float>(200, random));
    const auto expected = to_host(pairs(serial{}, soup, spheres<float>(host)));
    CHECK(expected.size() > 100);
    CHECK(to_host(pairs(on, soup, view)) == expected);  // the soup is uploaded for the call
    CHECK(to_host(pairs(on, make_bvh(on, soup), view)) == expected);
    sphere<float> bad = host[5];
    bad.radius = -1;
    upload(on, &bad, 1, balls.data() + 5);
    CHECK_THROWS_WITH(pairs(on, soup, view), "abut::pairs: sphere 5: radius is negative (-1)");
}

TEST_CASE("streams: concurrent queries on streams of their own, and on one policy, all agree") {
    const auto soup = some_triangles();
    const auto balls = some_spheres();
    const auto expected = to_host(pairs(openmp{}, make_bvh(openmp{}, soup), balls));
    cudaStream_t stream = nullptr;
    REQUIRE(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess);
    {
        const abut::cuda shared{.stream = stream};
        const auto tree = make_bvh(shared, soup);
        std::vector<int> same(6, 0);
        std::vector<std::thread> threads;
        for (std::size_t k = 0; k < same.size(); ++k) {
            threads.emplace_back([&, k] {
                cudaStream_t own = nullptr;
                if (cudaStreamCreateWithFlags(&own, cudaStreamNonBlocking) != cudaSuccess) return;
                for (int i = 0; i < 5; ++i) {
                    const abut::cuda on = k % 2 ? shared : abut::cuda{.stream = own};
                    same[k] += to_host(pairs(on, tree, balls)) == expected;
                    same[k] += to_host(pairs(on, make_bvh(on, soup), balls)) == expected;
                }
                cudaStreamDestroy(own);
            });
        }
        for (std::thread& t : threads) t.join();
        CHECK(same == std::vector<int>(6, 10));
    }
    cudaStreamDestroy(stream);
}
