// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "collide/contact_cases.hpp"
#include "collide/query_cases.hpp"
#include "cuda/own_stream.hpp"
#include "support/catch.hpp"
#include "support/surfaces.hpp"
#include "support/poses.hpp"

namespace abut::test {

namespace {

/// Triangles and balls, of which some hundred pairs touch.
struct triangles_and_balls {
    triangle_soup<float, device_space> triangles;
    spheres<float, device_space> balls;
};
triangles_and_balls random_sets(const cuda& on, std::size_t n) {
    uniform random(20261123);
    const triangle_soup<float> triangles(random_triangles<float>(n, random));
    const spheres<float> balls(random_spheres<float>(n, random));
    return {copy_to(on, triangles), copy_to(on, balls)};
}

/// The elements that a list has on the device.
template <class T>
std::vector<T> elements_of(const async_result<T>& list, std::uint64_t size) {
    std::vector<T> copy(size);
    REQUIRE(cudaMemcpy(copy.data(), list.data(), size * sizeof(T), cudaMemcpyDeviceToHost) == cudaSuccess);
    return copy;
}

/// Lists without room, with too little, with room for just as many, and for more than are sorted by counting.
template <class X, class Y>
void check_capacities(const cuda& on, const X& a, const Y& b, const pair_list& expected) {
    const std::size_t n = expected.size();
    for (const std::size_t capacity : {std::size_t{0}, std::size_t{1}, n / 2, n - 1}) {
        CAPTURE(capacity, n);
        async_result<index_pair> hits(on, capacity);
        pairs_async(on, a, b, hits);
        const async_state state = read_state(on, hits);
        CHECK(state.size == capacity);
        CHECK(state.needed == n);
        CHECK(state.undecided == 0);
        const pair_list some = elements_of(hits, state.size);
        CHECK(std::is_sorted(some.begin(), some.end()));
        CHECK(std::adjacent_find(some.begin(), some.end()) == some.end());
        CHECK(std::includes(expected.begin(), expected.end(), some.begin(), some.end()));
        CHECK_THROWS_AS(wait(on, hits), capacity_error);
        async_result<index_pair> room(on, state.needed);
        pairs_async(on, a, b, room);
        CHECK(to_host(wait(on, room)) == expected);
    }
    for (const std::size_t capacity : {n, n + 1, 4 * n + 10'000}) {
        CAPTURE(capacity, n);
        async_result<index_pair> hits(on, capacity);
        pairs_async(on, a, b, hits);
        const async_state state = read_state(on, hits);
        CHECK(state.size == n);
        CHECK(state.needed == n);
        CHECK(elements_of(hits, n) == expected);
        CHECK(to_host(wait(on, hits)) == expected);
        pairs_async(on, a, b, hits, {.sorted = false});
        pair_list unsorted = to_host(wait(on, hits));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK(unsorted == expected);
    }
}

/// All four calls give what those give that wait.
template <class X, class Y>
void check_as_waiting(const cuda& on, const X& a, const Y& b) {
    const pair_list expected = to_host(pairs(on, a, b));
    REQUIRE(expected.size() > 20);
    check_capacities(on, a, b, expected);

    async_value<bool> touch(on);
    any_async(on, a, b, touch);
    CHECK(wait(on, touch));
    CHECK(read_state(on, touch).value);
    async_value<std::uint64_t> number(on);
    count_async(on, a, b, number);
    CHECK(read_state(on, number).value == expected.size());
    CHECK(wait(on, number) == expected.size());

    const contact_list<float> expected_contacts = to_host(contacts(on, a, b));
    async_result<contact<float>> found(on, expected.size() + 5000);  // places that stay empty have no shapes to read
    contacts_async(on, a, b, found);
    CHECK(same_bits(to_host(wait(on, found)), expected_contacts));
    contacts_async(on, a, b, found, {.sorted = false});
    CHECK(same_bits(sorted(to_host(wait(on, found))), expected_contacts));
    CHECK(read_state(on, found).needed == expected.size());

    pair_list kept = expected;
    std::erase_if(kept, [](const index_pair& p) { return !id_filter{}(p.a, p.b); });
    async_result<index_pair> filtered_hits(on, expected.size());
    pairs_async(on, a, b, filtered_hits, query_options<id_filter>{});
    CHECK(kept.size() < expected.size());
    CHECK(to_host(wait(on, filtered_hits)) == kept);
}

/// A pose under which some of a scene's shapes still touch.
rigid<float> small_move() {
    draws d(20261123, 7, 0);
    return make_pose<float>(d, 0.2);
}

}  // namespace

TEST_CASE("async: plain sets") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const auto [triangles, balls] = random_sets(on, 300);
    check_as_waiting(on, triangles, balls);
}

TEST_CASE("async: a tree and a set") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const auto [triangles, balls] = random_sets(on, 900);
    check_as_waiting(on, make_bvh(on, triangles), balls);
}

TEST_CASE("async: two trees, one of which is posed") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const auto [triangles, balls] = random_sets(on, 900);
    check_as_waiting(on, make_bvh(on, triangles), posed(make_bvh(on, balls), small_move()));
}

TEST_CASE("async: a grid, a posed set, a single shape, other ways down two trees") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const auto [triangles, balls] = random_sets(on, 900);
    async_value<std::uint64_t> number(on);
    const auto check_count = [&](const auto& a, const auto& b, const auto& options) {
        const std::uint64_t expected = count(on, a, b, options);
        CHECK(expected > 0);
        count_async(on, a, b, number, options);
        CHECK(wait(on, number) == expected);
    };
    check_count(make_grid(on, triangles), balls, query_options<>{});
    check_count(posed(triangles, small_move()), balls, query_options<>{});
    check_count(balls, triangle<float>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, query_options<>{});
    const auto tree = make_bvh(on, triangles), other = make_bvh(on, triangles);
    check_count(tree, posed(other, small_move()), query_options<keep_all, traversal::larger_first>{});
}

TEST_CASE("async: double") {
    const cuda on;
    uniform random(20261124);
    const auto triangles = copy_to(on, triangle_soup<double>(random_triangles<double>(300, random)));
    const auto balls = copy_to(on, spheres<double>(random_spheres<double>(300, random)));
    const auto tree = make_bvh(on, triangles);
    const pair_list expected = to_host(pairs(on, tree, balls));
    CHECK(expected.size() > 20);
    async_result<index_pair> hits(on, expected.size());
    async_result<contact<double>> found(on, expected.size());
    pairs_async(on, tree, balls, hits);
    contacts_async(on, tree, balls, found);
    CHECK(to_host(wait(on, hits)) == expected);
    CHECK(same_bits(to_host(wait(on, found)), to_host(contacts(on, tree, balls))));
}

TEST_CASE("async: where there is nothing") {
    const cuda on;
    const auto [triangles, balls] = random_sets(on, 100);
    const auto far = make_bvh(on, spheres<float>({{{900, 0, 0}, 1}, {{950, 0, 0}, 1}}));
    const auto none = copy_to(on, spheres<float>());
    async_result<index_pair> hits(on, 10);
    async_value<bool> touch(on);
    async_value<std::uint64_t> number(on);
    CHECK_THROWS_WITH(wait(on, hits), "abut::wait: nothing was asked");
    CHECK_THROWS_WITH(wait(on, touch), "abut::wait: nothing was asked");
    // Something first, so that what is left of it would be seen.
    const auto check_none = [&](const auto& a, const auto& b) {
        pairs_async(on, triangles, balls, hits);
        any_async(on, triangles, balls, touch);
        count_async(on, triangles, balls, number);
        CHECK(wait(on, touch));
        CHECK(wait(on, number) > 0);
        CHECK(read_state(on, hits).needed == wait(on, number));
        pairs_async(on, a, b, hits);
        any_async(on, a, b, touch);
        count_async(on, a, b, number);
        CHECK(to_host(wait(on, hits)).empty());
        CHECK_FALSE(wait(on, touch));
        CHECK(wait(on, number) == 0);
    };
    check_none(triangles, far);
    check_none(triangles, none);
}

TEST_CASE("async: what the device does not decide is said, and decided by who waits") {
    const cuda on;
    // In one plane: the first try leaves most pairs open.
    const auto flat = copy_to(on, coplanar_triangles<float>(100));
    const pair_list expected = to_host(pairs(on, flat, flat));
    REQUIRE(expected.size() > 100 * 100 / 2);
    std::uint64_t open = 0;
    for (const std::uint64_t room : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{100}}) {
        CAPTURE(room);
        async_result<index_pair> hits(on, expected.size(), room);
        pairs_async(on, flat, flat, hits);
        const async_state state = read_state(on, hits);
        CHECK(state.undecided > room);
        CHECK(state.needed + state.undecided >= expected.size());
        CHECK(to_host(wait(on, hits)) == expected);
        async_value<std::uint64_t> number(on, room);
        count_async(on, flat, flat, number);
        CHECK(read_state(on, number).undecided == state.undecided);
        CHECK(wait(on, number) == expected.size());
        async_result<index_pair> small(on, expected.size() - 1, room);
        pairs_async(on, flat, flat, small);
        CHECK_THROWS_WITH(wait(on, small), "abut::wait: " + std::to_string(expected.size()) +
                                               " elements were found; there is room for " +
                                               std::to_string(expected.size() - 1));
        open = state.undecided;
    }
    // The number that was told is enough.
    async_result<index_pair> hits(on, expected.size(), open);
    pairs_async(on, flat, flat, hits);
    CHECK(read_state(on, hits).undecided == 0);
    CHECK(elements_of(hits, expected.size()) == expected);

    // Coordinates too far apart for integers in registers.
    constexpr float huge = 0x1p126f, tiny = 0x1p-149f;
    std::vector<triangle<float>> wide;
    std::vector<sphere<float>> balls;
    for (int i = 0; i < 40; ++i) {
        const float k = static_cast<float>(i);
        wide.push_back({{huge, k * tiny, 0}, {-huge, k * tiny, 0}, {0, huge, 0}});
        balls.push_back({{0, 0, k * tiny}, static_cast<float>(i % 7) * tiny});
    }
    const auto a = copy_to(on, triangle_soup<float>(wide));
    const auto b = copy_to(on, spheres<float>(balls));
    const pair_list touching = to_host(pairs(serial{}, triangle_soup<float>(wide), spheres<float>(balls)));
    REQUIRE(!touching.empty());
    async_result<index_pair> far(on, touching.size());
    pairs_async(on, a, b, far);
    const async_state state = read_state(on, far);
    CHECK(state.undecided > 0);
    CHECK(state.undecided <= 40 * 40);
    CHECK(to_host(wait(on, far)) == touching);
    async_value<std::uint64_t> number(on);
    count_async(on, a, b, number);
    CHECK(wait(on, number) == touching.size());
    async_value<bool> touch(on);
    any_async(on, a, b, touch);
    const auto known = read_state(on, touch);
    CHECK((known.value || known.undecided > 0));
    CHECK(wait(on, touch));
}

namespace {

/// Runs until *go, or for some seconds: then it says so.
__global__ void spin(const volatile int* go, volatile int* gave_up) {
    const long long since = clock64();
    while (*go == 0) {
        if (clock64() - since > 20'000'000'000) {
            *gave_up = 1;
            return;
        }
    }
}

/// Moves each vertex.
__global__ void shift(vec3<float>* vertices, std::size_t n, float x) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < n) vertices[i].x += x;
}

}  // namespace

TEST_CASE("async: the host does not wait") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const auto [triangles, balls] = random_sets(on, 900);
    const auto tree = make_bvh(on, triangles);
    const auto other = make_bvh(on, balls);
    const pair_list expected = to_host(pairs(on, tree, other));
    async_result<index_pair> hits(on, expected.size()), in_tree(on, expected.size()), plain(on, expected.size());
    async_result<contact<float>> found(on, expected.size());
    async_value<bool> touch(on);
    async_value<std::uint64_t> number(on);
    const auto ask = [&] {
        pairs_async(on, tree, other, hits);
        pairs_async(on, tree, balls, in_tree);
        pairs_async(on, triangles, balls, plain);
        contacts_async(on, tree, other, found);
        any_async(on, tree, other, touch);
        count_async(on, tree, other, number);
    };
    int* words = nullptr;  // go, gave up
    REQUIRE(cudaHostAlloc(reinterpret_cast<void**>(&words), 2 * sizeof(int), cudaHostAllocMapped) == cudaSuccess);
    words[0] = 1;
    words[1] = 0;
    spin<<<1, 1, 0, on.stream>>>(words, words + 1);
    ask();  // loads all kernels, which may wait
    synchronize(on);

    words[0] = 0;
    spin<<<1, 1, 0, on.stream>>>(words, words + 1);
    ask();
    CHECK(cudaStreamQuery(on.stream) == cudaErrorNotReady);
    cudaGetLastError();  // which that may be reported as
    *static_cast<volatile int*>(words) = 1;
    CHECK(to_host(wait(on, hits)) == expected);
    CHECK(to_host(wait(on, in_tree)) == expected);
    CHECK(to_host(wait(on, plain)) == expected);
    CHECK(to_host(wait(on, found)).size() == expected.size());
    CHECK(wait(on, touch));
    CHECK(wait(on, number) == expected.size());
    CHECK(words[1] == 0);
    cudaFreeHost(words);
}

TEST_CASE("async: a graph asks again about what has moved") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    const torus<float> ring(24, 12, 1.0, 0.3);
    const auto balls = random_sets(on, 400).balls;
    const auto tree = make_bvh(on, balls);
    const auto other = make_bvh(on, random_sets(on, 300).triangles);
    execution::buffer<vec3<float>, device_space> vertices(on, ring.vertices.size());
    execution::buffer<face, device_space> faces(on, ring.faces.size());
    upload(on, ring.vertices.data(), ring.vertices.size(), vertices.data());
    upload(on, ring.faces.data(), ring.faces.size(), faces.data());
    const mesh_view<float, device_space> moving(vertices.data(), vertices.size(), faces.data(), faces.size());

    constexpr std::size_t room = 20'000;
    async_result<index_pair> hits(on, room), plain(on, room), trees(on, room), small(on, 3);
    async_result<contact<float>> found(on, room);
    async_value<bool> touch(on);
    async_value<std::uint64_t> number(on);
    const auto ask = [&] {
        pairs_async(on, moving, tree, hits);
        pairs_async(on, moving, balls, plain);
        pairs_async(on, tree, posed(other, small_move()), trees);
        pairs_async(on, moving, tree, small);
        contacts_async(on, moving, tree, found);
        any_async(on, moving, tree, touch);
        count_async(on, moving, tree, number);
    };
    const unsigned blocks = static_cast<unsigned>(vertices.size() / 256 + 1);
    shift<<<blocks, 256, 0, on.stream>>>(vertices.data(), vertices.size(), 0.0f);
    ask();
    synchronize(on);

    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    REQUIRE(cudaStreamBeginCapture(on.stream, cudaStreamCaptureModeGlobal) == cudaSuccess);
    shift<<<blocks, 256, 0, on.stream>>>(vertices.data(), vertices.size(), 0.125f);
    ask();
    REQUIRE(cudaStreamEndCapture(on.stream, &graph) == cudaSuccess);
    REQUIRE(cudaGraphInstantiate(&executable, graph, 0) == cudaSuccess);
    const pair_list expected_of_trees = to_host(pairs(on, tree, posed(other, small_move())));
    CHECK(!expected_of_trees.empty());
    std::vector<pair_list> seen;
    for (int step = 0; step < 3; ++step) {
        CAPTURE(step);
        REQUIRE(cudaGraphLaunch(executable, on.stream) == cudaSuccess);
        const pair_list of_graph = to_host(wait(on, hits)), of_plain = to_host(wait(on, plain));
        const contact_list<float> contacts_of_graph = to_host(wait(on, found));
        const pair_list expected = to_host(pairs(on, moving, tree));
        CHECK(expected.size() > 20);
        CHECK(of_graph == expected);
        CHECK(of_plain == expected);
        CHECK(same_bits(contacts_of_graph, to_host(contacts(on, moving, tree))));
        CHECK(to_host(wait(on, trees)) == expected_of_trees);
        CHECK(wait(on, touch));
        CHECK(wait(on, number) == expected.size());
        CHECK(read_state(on, small).needed == expected.size());
        CHECK(read_state(on, small).size == 3);
        seen.push_back(expected);
    }
    CHECK(seen[0] != seen[1]);
    CHECK(seen[1] != seen[2]);
    cudaGraphExecDestroy(executable);
    cudaGraphDestroy(graph);
}

TEST_CASE("async: within and self queries, by the stream in place of the policy") {
    const cuda on;
    const auto from = ball_surface<float>(2, 1.0);
    const mesh<float> set(from.vertices, from.faces);
    const auto tree = make_bvh(on, set);
    rigid<float> away;
    away.translation = {1.75f, 0.5f, 0};
    const auto other = posed(tree, away);
    (void)any(on, tree, other);
    async_result<index_pair> near(on, 200'000), self(on, 200'000);
    async_value<std::uint64_t> counted(on), counted_self(on);
    async_value<bool> is(on), is_not(on);
    within(async(on, near), tree, other, 0.25);
    count_within(async(on, counted), tree, other, 0.25);
    any_within(async(on, is), tree, other, 0.25);
    any_within(async(on, is_not), tree, posed(tree, {.translation = {9, 0, 0}}), 0.25);
    self_within(async(on, self), tree, 0.125);
    count_self_pairs(async(on, counted_self), tree, {.coincident = coincident_vertices::merged});
    const auto expected = to_host(within(on, tree, other, 0.25));
    CHECK(expected.size() > 100);
    CHECK((to_host(wait(on, near)) == expected));
    CHECK(wait(on, counted) == expected.size());
    CHECK(wait(on, is));
    CHECK_FALSE(wait(on, is_not));
    CHECK((to_host(wait(on, self)) == to_host(self_within(on, tree, 0.125))));
    CHECK(wait(on, counted_self) == count_self_pairs(on, tree, {.coincident = coincident_vertices::merged}));
    CHECK_THROWS_WITH(count_within(async(on, counted), tree, other, -1), "abut::count_within_async: distance is -1; expected a "
                                                                         "finite number, 0 or more");
}

TEST_CASE("async: two streams at once") {
    const own_stream one, two;
    const cuda first{.stream = one.stream}, second{.stream = two.stream};
    const auto sets = random_sets(first, 900), others = random_sets(second, 700);
    const auto tree = make_bvh(first, sets.triangles), other = make_bvh(second, others.triangles);
    const pair_list expected = to_host(pairs(first, tree, sets.balls)),
                    expected_of_other = to_host(pairs(second, other, others.balls));
    CHECK(expected != expected_of_other);
    async_result<index_pair> hits(first, expected.size()), hits_of_other(second, expected_of_other.size());
    async_value<std::uint64_t> number(first), number_of_other(second);
    count_async(first, tree, make_bvh(first, sets.balls), number);  // which keeps that tree
    for (int turn = 0; turn < 20; ++turn) {
        pairs_async(first, tree, sets.balls, hits);
        pairs_async(second, other, others.balls, hits_of_other);
        count_async(second, other, others.balls, number_of_other);
    }
    CHECK(to_host(wait(first, hits)) == expected);
    CHECK(to_host(wait(second, hits_of_other)) == expected_of_other);
    CHECK(wait(first, number) == expected.size());
    CHECK(wait(second, number_of_other) == expected_of_other.size());
}

TEST_CASE("async: what calls that do not wait refuse") {
    const cuda on;
    const auto [triangles, balls] = random_sets(on, 100);
    async_result<index_pair> hits(on, 10);
    async_result<contact<float>> found(on, 10);
    const auto tree = make_bvh(on, triangles);
    schedule_report report;
    CHECK_THROWS_WITH(pairs_async(on, tree, tree, hits, {.scheduling = {.report = &report}}),
                      "abut::pairs_async: a schedule reports to calls that wait");
    CHECK_THROWS_WITH(contacts_async(on, triangles, triangles, found, {.discard_sideways = true}),
                      "abut::contacts_async: contacts are discarded by calls that wait");
    CHECK_THROWS_WITH(pairs_async(on, triangles, sphere<float>{{0, 0, 0}, -1}, hits),
                      "abut::pairs_async: shape 0: radius is negative (-1)");
}

}  // namespace abut::test
