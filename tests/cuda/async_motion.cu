// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cuda/own_stream.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace {

using vertex_list = std::vector<vec3<float>>;
using impact_result = std::vector<impact<float>>;

/// Two bumpy sheets, of which the upper one falls through the lower one.
struct two_sheets {
    vertex_list from, to;
    std::vector<face> faces;

    two_sheets(draws& d, std::uint32_t side, float bumps) {
        for (std::uint32_t sheet = 0; sheet < 2; ++sheet) {
            const auto first = static_cast<std::uint32_t>(from.size());
            for (std::uint32_t i = 0; i < side * side; ++i) {
                const auto bump = [&] { return bumps * static_cast<float>(d.uniform(-0.3, 0.3)); };
                const auto x = static_cast<float>(i % side), y = static_cast<float>(i / side);
                const vec3<float> at{x + bump(), y + bump(), static_cast<float>(sheet) + bump()};
                from.push_back(at);
                to.push_back({at.x + bump(), at.y + bump(), at.z - static_cast<float>(2 * sheet)});
            }
            for (std::uint32_t i = 0; i + 1 < side; ++i) {
                for (std::uint32_t j = 0; j + 1 < side; ++j) {
                    const std::uint32_t at = first + i * side + j;
                    faces.push_back({at, at + 1, at + side});
                    faces.push_back({at + 1, at + side + 1, at + side});
                }
            }
        }
    }
    [[nodiscard]] auto step() const {
        const mesh<float> first(from, faces);
        return moving(first, first.with_vertices(serial{}, to));
    }
};

/// Vertices in memory of a device, which kernels write.
struct vertices_there {
    const cuda& on;
    execution::buffer<vec3<float>, device_space> from, to;

    vertices_there(const cuda& policy, const vertex_list& at_t0, const vertex_list& at_t1)
        : on(policy), from(policy, at_t0.size()), to(policy, at_t1.size()) {
        upload(on, at_t0.data(), at_t0.size(), from.data());
        upload(on, at_t1.data(), at_t1.size(), to.data());
        synchronize(on);
    }
    [[nodiscard]] auto step() const {
        using view = points_view<float, device_space>;
        return moving(view(from.data(), from.size()), view(to.data(), to.size()));
    }
    /// As they are now, as a mesh of its own.
    [[nodiscard]] auto copied(const std::vector<face>& faces) const {
        vertex_list at_t0(from.size()), at_t1(to.size());
        synchronize(on);
        from.read(at_t0.data());
        to.read(at_t1.data());
        const mesh<float> first(at_t0, faces);
        return moving(first, first.with_vertices(serial{}, at_t1));
    }
};

mesh<float> small_ball(float x, float y, float z, float radius) {
    auto ball = ball_surface<float>(2, radius);
    for (auto& v : ball.vertices) v = {v.x + x, v.y + y, v.z + z};
    return {ball.vertices, ball.faces};
}

/// All that a step is asked, with results of its own.
struct step_answers {
    async_result<impact<float>> itself, other, first_itself, first_other;
    async_value<double> safe_itself, safe_other, apart;
    static constexpr conservative_bounds bounds{.tolerance = 1e-3, .separation = 0.05};

    step_answers(const cuda& on, std::size_t capacity)
        : itself(on, capacity), other(on, capacity), first_itself(on, 1), first_other(on, 1), safe_itself(on), safe_other(on),
          apart(on) {}

    template <class X, class Y>
    void ask(const cuda& on, const X& x, const Y& y) {
        self_impacts(async(on, itself), x);
        impacts(async(on, other), x, y);
        first_self_impact(async(on, first_itself), x);
        first_impact(async(on, first_other), x, y);
        safe_self_step(async(on, safe_itself), x);
        safe_step(async(on, safe_other), x, y);
        safe_step(async(on, apart), x, y, bounds);
    }
    /// Whether they are those of a call that waits, about a step and a mesh of the host. Returns how many impacts there are.
    template <class Step, class Mesh>
    std::size_t check(const cuda& on, const Step& x, const Mesh& y) const {
        const impact_result with_itself = to_host(self_impacts(serial{}, x)), with_other = to_host(impacts(serial{}, x, y));
        CHECK(read_state(on, itself).undecided == 0);
        CHECK(read_state(on, itself).needed == with_itself.size());
        CHECK(to_host(wait(on, itself)) == with_itself);
        CHECK(to_host(wait(on, other)) == with_other);
        const auto check_first = [&](const async_result<impact<float>>& found, const auto& expected) {
            const impact_result one = to_host(wait(on, found));
            REQUIRE(one.size() == (expected ? 1u : 0u));
            if (expected) CHECK(one[0] == *expected);
        };
        check_first(first_itself, first_self_impact(serial{}, x));
        check_first(first_other, first_impact(serial{}, x, y));
        // A time that falls on a multiple of 2^-40 is one that kernels do not decide: then there is a bound in its place.
        const auto check_safe = [&](const async_value<double>& found, double expected) {
            const auto now = read_state(on, found);
            CHECK(now.value <= expected);
            CHECK((now.value == expected || (now.undecided == 1 && now.value >= expected - 2e-6)));
            CHECK(wait(on, found) == expected);
        };
        check_safe(safe_itself, safe_self_step(serial{}, x));
        check_safe(safe_other, safe_step(serial{}, x, y));
        // No earlier than the first of the list, and no later than one that is early by nothing.
        const impact_result near = to_host(impacts<conservative>(on, x, y, {.bounds = bounds}));
        double least = 1;
        for (const auto& i : near) least = std::min(least, i.time);
        const double value = read_state(on, apart).value;
        CHECK(value >= least);
        CHECK(value <= safe_step(serial{}, x, y, {.tolerance = 1e-6, .separation = bounds.separation}) + 1e-6);
        return with_itself.size() + with_other.size();
    }
};

bool same_box(const aabb<float>& a, const aabb<float>& b) { return a.lower == b.lower && a.upper == b.upper; }

template <class T>
impact_result to_list(const T& found) {
    return to_host(found);
}

}  // namespace

TEST_CASE("async motion: as calls that wait") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    for (const float bumps : {1.0f, 0.25f}) {
        draws d(20261129, 1, 0);
        const two_sheets sheets(d, 24, bumps);
        const mesh<float> ball = small_ball(11, 12, -0.4f, 2.5f);
        const auto x = make_impact_index(on, sheets.step()), y = make_impact_index(on, ball);
        step_answers answers(on, 100'000);
        answers.ask(on, x, y);
        CHECK(answers.check(on, sheets.step(), ball) > 100);
        CHECK(read_state(on, answers.safe_itself).undecided == 0);
        CHECK(read_state(on, answers.safe_other).undecided == 0);
    }
}

TEST_CASE("async motion: too little room is told") {
    const cuda on;
    draws d(20261129, 2, 0);
    const two_sheets sheets(d, 16, 1);
    const auto index = make_impact_index(on, sheets.step());
    const impact_result expected = to_host(self_impacts(on, index));
    REQUIRE(expected.size() > 100);
    async_result<impact<float>> few(on, 10), as_many(on, expected.size()), unsorted(on, expected.size() + 100);
    self_impacts(async(on, few), index);
    const async_state of_few = read_state(on, few);
    CHECK(of_few.size == 10);
    CHECK(of_few.needed == expected.size());
    CHECK(of_few.undecided == 0);
    CHECK_THROWS_AS(wait(on, few), capacity_error);
    self_impacts(async(on, as_many), index);
    CHECK(to_list(wait(on, as_many)) == expected);
    self_impacts(async(on, unsorted), index, {.sorted = false});
    CHECK(read_state(on, unsorted).needed == expected.size());
    CHECK(to_list(wait(on, unsorted)).size() == expected.size());

    // Of candidates none is tried where not all find room, and none is lost.
    async_result<impact<float>> crowded(on, expected.size(), 100), first(on, 1, 100);
    async_value<double> safe(on, 100);
    self_impacts(async(on, crowded), index);
    first_self_impact(async(on, first), index);
    safe_self_step(async(on, safe), index);
    const async_state state = read_state(on, crowded);
    CHECK(state.needed == 0);
    CHECK(state.undecided > 100);
    CHECK(read_state(on, first).undecided == state.undecided);
    CHECK(read_state(on, safe).undecided == state.undecided);
    CHECK(read_state(on, safe).value == 0);
    CHECK(to_list(wait(on, crowded)) == expected);
    CHECK(to_list(wait(on, first)).at(0) == *first_self_impact(on, index));
    CHECK(wait(on, safe) == safe_self_step(on, index));
    async_result<impact<float>> enough(on, expected.size(), state.undecided);
    self_impacts(async(on, enough), index);
    CHECK(read_state(on, enough).undecided == 0);
    CHECK(to_list(wait(on, enough)) == expected);
}

TEST_CASE("async motion: what kernels do not decide is told, and a safe step is never late") {
    const cuda on;
    draws d(20261129, 3, 0);
    // Vertices meet vertices, and edges lie on edges.
    const two_sheets flat(d, 12, 0);
    const auto index = make_impact_index(on, flat.step());
    const impact_result expected = to_host(self_impacts(on, index));
    REQUIRE(expected.size() > 100);
    async_result<impact<float>> found(on, expected.size()), first(on, 1);
    async_value<double> safe(on);
    self_impacts(async(on, found), index);
    first_self_impact(async(on, first), index);
    safe_self_step(async(on, safe), index);
    const async_state state = read_state(on, found);
    CHECK(state.undecided > 0);
    CHECK(state.needed + state.undecided >= expected.size());
    CHECK(to_list(wait(on, found)) == expected);
    CHECK(to_list(wait(on, first)).at(0) == *first_self_impact(on, index));
    const double exactly = safe_self_step(on, index);
    CHECK(read_state(on, safe).value <= exactly);
    CHECK(read_state(on, safe).value >= exactly - 2e-6);
    CHECK(wait(on, safe) == exactly);
}

TEST_CASE("async motion: nothing, one face, and points alone") {
    const cuda on;
    const mesh<float> one({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, std::vector<face>{{0, 1, 2}});
    const mesh<float> dust(vertex_list{{1, 1, 1}, {9, 9, 9}}, std::vector<face>{}), none;
    step_answers answers(on, 100);
    const auto y = make_impact_index(on, one), empty = make_impact_index(on, none);
    for (const float z : {-2.0f, -3.0f}) {  // at a third of the way, and at a quarter
        const auto falls = moving(dust, dust.with_vertices(serial{}, vertex_list{{1, 1, z}, {9, 9, 5}}));
        const auto x = make_impact_index(on, falls);
        answers.ask(on, x, y);
        CHECK(answers.check(on, falls, one) == 1);
        CHECK(read_state(on, answers.safe_other).undecided == (z == -2 ? 0u : 1u));
        answers.ask(on, y, x);
        CHECK(answers.check(on, moving(one, one), falls) == 1);
    }
    answers.ask(on, y, empty);
    CHECK(answers.check(on, moving(one, one), none) == 0);
}

namespace {

/// A step of a simulation: everything begins where it was to end, and goes on by a wave that `count` moves.
__global__ void next_step(vec3<float>* from, vec3<float>* to, std::size_t n, unsigned* count) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    const auto step = static_cast<float>(*count);
    if (i < n) {
        const vec3<float> at = to[i];
        from[i] = at;
        to[i] = {at.x + 0.01f * (at.y - step), at.y, at.z + (at.z > 0 ? -0.37f : 0.11f) * (1 + 0.1f * step)};
    }
}
__global__ void count_step(unsigned* count) { ++*count; }

}  // namespace

TEST_CASE("async motion: a step is one graph") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    draws d(20261129, 4, 0);
    const two_sheets sheets(d, 20, 1);
    const mesh<float> ball = small_ball(8, 9, -1, 1.5f);
    vertices_there there(on, sheets.from, sheets.from);
    execution::buffer<unsigned, device_space> count(on, 1);
    fill(on, count.data(), 1, 0u);
    const auto with = make_impact_index(on, ball);
    async_index cloth(on, make_impact_index(on, sheets.step()));
    step_answers answers(on, 100'000);
    const unsigned blocks = static_cast<unsigned>(there.from.size() / 256 + 1);
    const auto run = [&] {
        next_step<<<blocks, 256, 0, on.stream>>>(there.from.data(), there.to.data(), there.from.size(), count.data());
        count_step<<<1, 1, 0, on.stream>>>(count.data());
        refit(async(on, cloth), there.step());
        answers.ask(on, cloth.index(), with);
    };
    run();
    std::size_t impacts_in_all = answers.check(on, there.copied(sheets.faces), ball);

    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    REQUIRE(cudaStreamBeginCapture(on.stream, cudaStreamCaptureModeGlobal) == cudaSuccess);
    run();
    REQUIRE(cudaStreamEndCapture(on.stream, &graph) == cudaSuccess);
    REQUIRE(cudaGraphInstantiate(&executable, graph, 0) == cudaSuccess);
    for (int step = 0; step < 5; ++step) {
        CAPTURE(step);
        REQUIRE(cudaGraphLaunch(executable, on.stream) == cudaSuccess);
        impacts_in_all += answers.check(on, there.copied(sheets.faces), ball);
    }
    CHECK(impacts_in_all > 500);
    cudaGraphExecDestroy(executable);
    cudaGraphDestroy(graph);
}

TEST_CASE("async motion: a tree is refitted in a graph") {
    const own_stream mine;
    const cuda on{.stream = mine.stream};
    draws d(20261129, 5, 0);
    const two_sheets sheets(d, 20, 1);
    vertices_there there(on, sheets.from, sheets.from);
    execution::buffer<unsigned, device_space> count(on, 1);
    execution::buffer<face, device_space> faces(on, sheets.faces.size());
    fill(on, count.data(), 1, 3u);
    upload(on, sheets.faces.data(), sheets.faces.size(), faces.data());
    const mesh_view<float, device_space> moves(there.to.data(), there.to.size(), faces.data(), faces.size());
    const auto ball = make_bvh(on, small_ball(8, 9, -1, 3));
    const auto before = make_bvh(on, moves);
    const auto box_before = before.bounds();
    async_index tree(on, before);
    const unsigned blocks = static_cast<unsigned>(there.from.size() / 256 + 1);
    async_result<index_pair> hits(on, 20'000);
    const auto run = [&] {
        next_step<<<blocks, 256, 0, on.stream>>>(there.from.data(), there.to.data(), there.from.size(), count.data());
        refit(async(on, tree));
        pairs(async(on, hits), tree.index(), ball);
    };
    run();
    synchronize(on);
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    REQUIRE(cudaStreamBeginCapture(on.stream, cudaStreamCaptureModeGlobal) == cudaSuccess);
    run();
    REQUIRE(cudaStreamEndCapture(on.stream, &graph) == cudaSuccess);
    REQUIRE(cudaGraphInstantiate(&executable, graph, 0) == cudaSuccess);
    for (int step = 0; step < 3; ++step) {
        REQUIRE(cudaGraphLaunch(executable, on.stream) == cudaSuccess);
        const auto expected = to_host(pairs(on, moves, ball));
        CHECK(expected.size() > 20);
        CHECK(to_host(wait(on, hits)) == expected);
        const auto fresh = refit(on, before, moves);
        CHECK(same_box(tree.index().bounds(), fresh.bounds()));
        // Under a pose the box is read when the call is made.
        const auto posed_tree = posed(tree.index(), rigid<float>{.translation = {0.5f, 0, 0}});
        CHECK(to_host(pairs(on, posed_tree, ball)) == to_host(pairs(on, posed(moves, posed_tree.pose), ball)));
    }
    CHECK(same_box(before.bounds(), box_before));
    cudaGraphExecDestroy(executable);
    cudaGraphDestroy(graph);
}

TEST_CASE("async motion: what is refused") {
    const cuda on;
    draws d(20261129, 6, 0);
    const two_sheets sheets(d, 4, 1);
    async_index cloth(on, make_impact_index(on, sheets.step()));
    const execution::buffer<vec3<float>, device_space> some(on, 5);
    const points_view<float, device_space> five(some.data(), 5);
    CHECK_THROWS_WITH(refit(async(on, cloth), moving(five, five)),
                      "abut::refit_async: the index has 32 vertices, the view at t = 0 5");
    async_value<double> safe(on);
    CHECK_THROWS_WITH(safe_self_step(async(on, safe), cloth.index(), {.separation = -1}),
                      Catch::Matchers::StartsWith("abut::safe_self_step_async: separation is -1"));
    CHECK_THROWS_WITH(wait(on, safe), "abut::wait: nothing was asked");
}

}  // namespace abut::test
