// SPDX-License-Identifier: MIT
//
// Queries of ranks answer as one machine does that has the whole sets: the same pairs, the same contacts, bit for bit, in
// the same order, however the sets are divided.

#include <abut/mpi.hpp>
#include <abut/experimental/breadth_first.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "distributed/world.hpp"
#include "support/poses.hpp"

namespace abut::test {

namespace {

template <scalar T>
struct scene {
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> spheres;
};

/// Small shapes in a cube, along one axis if `sorted`, so that parts lie side by side; some touch in one point exactly.
template <scalar T>
scene<T> random_scene(std::size_t n, bool sorted, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<T> place(0, 5), length(T(0.1), T(0.8));
    std::uniform_int_distribution<int> cell(0, 10);
    scene<T> all;
    for (std::size_t i = 0; i < n; ++i) {
        vec3<T> p{place(random), place(random), place(random)};
        T r = length(random);
        if (i % 2 == 0) {
            const auto x = static_cast<T>(cell(random)), y = static_cast<T>(cell(random)), z = static_cast<T>(cell(random));
            p = {x / 2, y / 2, z / 2};
            r = T(0.5);
        }
        all.triangles.push_back({p, {p.x + r, p.y, p.z}, {p.x, p.y + r, p.z + (i % 4 == 0 ? T(0) : r)}});
        all.spheres.push_back({{p.z, p.x, p.y}, r / 2});
    }
    if (sorted) {
        const auto by_x = [](const auto& s, const auto& t) { return bounds(s).lower.x < bounds(t).lower.x; };
        std::sort(all.triangles.begin(), all.triangles.end(), by_x);
        std::sort(all.spheres.begin(), all.spheres.end(), by_x);
    }
    return all;
}

std::vector<global_pair> as_global(const std::vector<index_pair>& pairs) {
    std::vector<global_pair> all;
    for (const index_pair& pair : pairs) all.push_back({pair.a, pair.b});
    return all;
}
template <scalar T>
std::vector<global_contact<T>> as_global(const std::vector<contact<T>>& contacts) {
    std::vector<global_contact<T>> all;
    for (const contact<T>& c : contacts) all.push_back({c.a, c.b, c.point, c.normal, c.depth});
    return all;
}

struct keep_some {
    bool operator()(std::uint64_t a, std::uint64_t b) const { return (a + 3 * b) % 5 != 0; }
};

/// Pairs of parts `a` and `b`, against what one machine says of the whole sets.
template <class Local, class A, class B, class WholeA, class WholeB>
std::vector<global_pair> check_pairs(const distributed<Local>& on, const A& a, const B& b, const WholeA& whole_a,
                                     const WholeB& whole_b) {
    const auto expected = as_global(pairs(serial{}, whole_a, whole_b).to_host());
    CHECK(expected.size() > 100);
    CHECK(lists_of_all(on.ranks(), pairs(on, a, b).to_host()) == expected);
    return expected;
}

/// All queries.
template <class Local, class A, class B, class WholeA, class WholeB>
void check_queries(const distributed<Local>& on, const A& a, const B& b, const WholeA& whole_a, const WholeB& whole_b) {
    const auto expected = check_pairs(on, a, b, whole_a, whole_b);
    CHECK(lists_of_all(on.ranks(), pairs<exact>(on, a, b).to_host()) == expected);
    CHECK(count(on, a, b) == expected.size());
    CHECK(any(on, a, b));

    auto unsorted = lists_of_all(on.ranks(), pairs(on, a, b, {.sorted = false}).to_host());
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);

    std::vector<global_pair> some;
    std::copy_if(expected.begin(), expected.end(), std::back_inserter(some),
                 [](const global_pair& pair) { return keep_some{}(pair.a, pair.b); });
    CHECK(some.size() < expected.size());
    CHECK(lists_of_all(on.ranks(), pairs(on, a, b, query_options<keep_some>{.filter = {}}).to_host()) == some);
    CHECK(count(on, a, b, query_options<keep_some>{.filter = {}}) == some.size());
    const auto none = [](std::uint64_t, std::uint64_t) { return false; };
    CHECK(!any(on, a, b, query_options<decltype(none)>{.filter = none}));

    std::vector<global_pair> visited(expected.size());
    std::atomic<std::size_t> visits{0};
    for_each_pair(on, a, b, [&](global_pair pair) {
        const std::size_t k = visits++;
        if (k < visited.size()) visited[k] = pair;
        return visit::proceed;
    });
    visited.resize(std::min<std::size_t>(visits, visited.size()));
    auto all_visited = lists_of_all(on.ranks(), visited);
    std::sort(all_visited.begin(), all_visited.end());
    CHECK(all_visited == expected);

    const auto touching = as_global(contacts(serial{}, whole_a, whole_b).to_host());
    CHECK(lists_of_all(on.ranks(), contacts(on, a, b).to_host()) == touching);
}

template <class Local, scalar T>
void check_scene(const distributed<Local>& on, const scene<T>& all, division how_a, division how_b) {
    CAPTURE(static_cast<int>(how_a), static_cast<int>(how_b), on.size());
    const triangle_soup<T> whole_a(all.triangles);
    const spheres<T> whole_b(all.spheres);
    const triangle_soup<T> a(part_of(all.triangles, how_a, on.rank(), on.size()));
    const spheres<T> b(part_of(all.spheres, how_b, on.rank(), on.size()));
    const auto tree_a = make_bvh(on.local(), a);
    const auto tree_b = make_bvh(on.local(), b);
    check_queries(on, tree_a, b, whole_a, whole_b);
    check_pairs(on, a, b, whole_a, whole_b);
    check_pairs(on, a, tree_b, whole_a, whole_b);
    check_pairs(on, tree_a, tree_b, whole_a, whole_b);
    check_pairs(on, tree_b, a, whole_b, whole_a);
    check_pairs(on, make_grid(on.local(), b), a.view(), whole_b, whole_a);
}

}  // namespace

TEST_CASE("distributed: pairs, counts, visits and contacts of all parts") {
    const bool sorted = GENERATE(true, false);
    for (const division how : divisions) {
        const distributed on(world(), serial{});
        check_scene(on, random_scene<float>(400, sorted, 1), how, division::even);
        check_scene(on, random_scene<float>(400, sorted, 2), division::uneven, how);
    }
}

TEST_CASE("distributed: on threads, in double") {
    const distributed on(world(), openmp{2});
    check_scene(on, random_scene<double>(700, true, 3), division::even, division::uneven);
}

TEST_CASE("distributed: placed parts of meshes") {
    const distributed on(world());
    const auto all = random_scene<double>(2000, false, 4);
    std::vector<vec3<double>> vertices;
    std::vector<face> faces;
    for (const auto& t : all.triangles) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        vertices.insert(vertices.end(), {t.a, t.b, t.c});
        faces.push_back({first, first + 1, first + 2});
    }
    const auto mine = part_of(faces, division::even, on.rank(), on.size());
    const mesh<double> whole(vertices, faces), part(vertices, mine);
    rigid<double> pose{};
    construction::set_rotation(pose, 0.9L, 0.1L, -0.3L, 0.2L);
    pose.translation = {0.25, -0.5, 0.125};
    const auto tree = make_bvh(on.local(), part);
    check_pairs(on, part, posed(part, pose), whole, posed(whole, pose));
    check_pairs(on, tree, posed(tree, pose), whole, posed(whole, pose));
    check_queries(on, posed(tree, pose), tree, posed(whole, pose), whole);
    check_pairs(on, posed(part, pose), tree, posed(whole, pose), whole);
}

namespace {

/// Faces at random over vertices on a lattice, no two in one place: full of neighbours that fold, cross and coincide. They
/// lie along one axis, so that parts lie side by side.
template <scalar T>
std::pair<std::vector<vec3<T>>, std::vector<face>> tangled_mesh(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<vec3<T>> vertices;
    for (int x = 0; x < 24; ++x) {
        for (int k = 0; k < 9; ++k) vertices.push_back({T(x), T(k / 3), T(k % 3)});
    }
    std::vector<face> faces;
    for (std::size_t i = 0; i < n; ++i) {
        const auto first = static_cast<std::uint32_t>(9 * (22 * i / n));
        const auto v = [&] { return first + static_cast<std::uint32_t>(random() % 18); };
        const std::uint32_t a = v(), b = v(), c = v();
        faces.push_back({a, b, c});
    }
    return {vertices, faces};
}

/// The parts of a mesh one after another, each with vertices of its own.
template <scalar T>
mesh<T> with_vertices_of_parts(const std::vector<vec3<T>>& vertices, const std::vector<face>& faces, division how,
                               int ranks) {
    std::vector<vec3<T>> all;
    std::vector<face> moved;
    for (int rank = 0; rank < ranks; ++rank) {
        const auto first = static_cast<std::uint32_t>(all.size());
        all.insert(all.end(), vertices.begin(), vertices.end());
        for (const auto& [a, b, c] : part_of(faces, how, rank, ranks)) moved.push_back({a + first, b + first, c + first});
    }
    return mesh<T>(all, moved);
}

/// self_pairs of this rank's part `x`, against what one machine says of the whole mesh.
template <class Local, class X, class Whole>
void check_self_pairs(const distributed<Local>& on, const X& x, const Whole& whole, coincident_vertices coincident) {
    const auto expected = as_global(self_pairs(serial{}, whole, {.coincident = coincident}).to_host());
    CHECK(expected.size() > 100);
    CHECK(lists_of_all(on.ranks(), self_pairs(on, x, {.coincident = coincident}).to_host()) == expected);
    CHECK(lists_of_all(on.ranks(), self_pairs<exact>(on, x, {.coincident = coincident}).to_host()) == expected);
    CHECK(count_self_pairs(on, x, {.coincident = coincident}) == expected.size());
    auto unsorted = lists_of_all(on.ranks(), self_pairs(on, x, {.sorted = false, .coincident = coincident}).to_host());
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);
    std::vector<global_pair> some;
    std::copy_if(expected.begin(), expected.end(), std::back_inserter(some),
                 [](const global_pair& pair) { return keep_some{}(pair.a, pair.b); });
    const self_options<keep_some> options{.filter = {}, .coincident = coincident};
    CHECK(lists_of_all(on.ranks(), self_pairs(on, x, options).to_host()) == some);
    CHECK(count_self_pairs(on, x, options) == some.size());
}

template <scalar T>
void check_self_pairs_of_parts(division how) {
    const distributed on(world(), serial{});
    CAPTURE(static_cast<int>(how), on.size());
    const auto [vertices, faces] = tangled_mesh<T>(240, 8);
    const mesh<T> whole(vertices, faces), part(vertices, part_of(faces, how, on.rank(), on.size()));
    const mesh<T> side_by_side = with_vertices_of_parts(vertices, faces, how, on.size());
    const auto tree = make_bvh(serial{}, part);
    rigid<T> pose{};
    construction::set_rotation(pose, 0.8L, 0.1L, -0.3L, 0.2L);
    pose.translation = {T(0.25), T(-0.5), T(0.125)};

    using enum coincident_vertices;
    check_self_pairs(on, tree, whole, merged);
    check_self_pairs(on, posed(tree, pose), posed(whole, pose), merged);
    check_self_pairs(on, make_grid(serial{}, part), whole, merged);
    check_self_pairs(on, tree, side_by_side, distinct);
    check_self_pairs(on, part, side_by_side, distinct);
    // No two vertices are in one place, so it is the same whichever are one.
    CHECK(lists_of_all(on.ranks(), self_pairs(on, part, {.coincident = merged}).to_host()) ==
          as_global(self_pairs(serial{}, whole).to_host()));
}

}  // namespace

TEST_CASE("distributed: pairs of shapes of one set") {
    for (const division how : divisions) check_self_pairs_of_parts<float>(how);
    check_self_pairs_of_parts<double>(division::even);
    const distributed on(world(), openmp{2});
    const auto all = random_scene<float>(1300, true, 9);
    const spheres<float> whole(all.spheres), part(part_of(all.spheres, division::even, on.rank(), on.size()));
    const triangle_soup<float> soup(all.triangles),
        part_of_soup(part_of(all.triangles, division::uneven, on.rank(), on.size()));
    check_self_pairs(on, make_bvh(on.local(), part), whole, coincident_vertices::distinct);
    check_self_pairs(on, part_of_soup.view(), soup, coincident_vertices::distinct);
    check_self_pairs(on, make_bvh(on.local(), part_of_soup), soup, coincident_vertices::merged);
    const self_options<keep_all, traversal::breadth_first> by_levels{.start_depth = 3};
    CHECK(lists_of_all(on.ranks(), self_pairs(on, make_bvh(on.local(), part), by_levels).to_host()) ==
          as_global(self_pairs(serial{}, whole).to_host()));
    CHECK(count_self_pairs(on, spheres<float>()) == 0);
    CHECK(count_self_pairs(on, sphere<float>{{0, 0, 0}, 1}) == static_cast<std::uint64_t>(on.size() * (on.size() - 1) / 2));
}

TEST_CASE("distributed: one shape of each rank, and nothing at all") {
    const distributed on(world(), serial{});
    const sphere<float> mine{{static_cast<float>(on.rank()), 0, 0}, 0.75f};
    std::vector<global_pair> expected;
    for (int a = 0; a < on.size(); ++a) {
        for (int b = std::max(a - 1, 0); b <= std::min(a + 1, on.size() - 1); ++b) {
            expected.push_back({static_cast<std::uint64_t>(a), static_cast<std::uint64_t>(b)});
        }
    }
    CHECK(lists_of_all(on.ranks(), pairs(on, mine, mine).to_host()) == expected);
    const spheres<float> none;
    CHECK(count(on, mine, none) == 0);
    CHECK(count(on, none, mine) == 0);
    CHECK(!any(on, none, none));
    CHECK(on_all(on.ranks(), pairs(on, none, mine).empty()));
}

TEST_CASE("distributed: visit::stop ends the visits of a rank") {
    const distributed on(world(), serial{});
    const auto all = random_scene<float>(400, false, 5);
    const triangle_soup<float> a(part_of(all.triangles, division::even, on.rank(), on.size()));
    const spheres<float> b(part_of(all.spheres, division::even, on.rank(), on.size()));
    std::uint64_t visits = 0;
    for_each_pair(on, a, b, [&](global_pair) {
        ++visits;
        return visit::stop;
    });
    CHECK(on_all(on.ranks(), visits <= 1));
}

namespace {

/// What a call throws on this rank: 0 nothing, 1 what `T` is, 2 distributed_error of rank `of`, 3 anything else.
template <class T, class Call>
int thrown_by(const Call& call, int of) {
    try {
        call();
        return 0;
    } catch (const distributed_error& e) {
        return e.rank() == of ? 2 : 3;
    } catch (const T&) {
        return 1;
    } catch (...) {
        return 3;
    }
}

}  // namespace

TEST_CASE("distributed: a failure of one rank reaches all") {
    const distributed on(world(), serial{});
    const auto all = random_scene<float>(300, false, 6);
    const triangle_soup<float> a(part_of(all.triangles, division::even, on.rank(), on.size()));
    const auto mine = part_of(all.spheres, division::even, on.rank(), on.size());
    const spheres<float> b(mine);
    for (int bad = 0; bad < on.size(); ++bad) {
        CAPTURE(bad);
        const int expected = on.rank() == bad ? 1 : 2;
        {
            auto broken = mine;
            if (on.rank() == bad) broken[0].center.y = std::numeric_limits<float>::quiet_NaN();
            const spheres_view<float> view(broken.data(), broken.size());
            CHECK(on_all(on.ranks(), thrown_by<invalid_geometry>([&] { (void)count(on, a, view); }, bad) == expected));
            CHECK(on_all(on.ranks(), thrown_by<invalid_geometry>([&] { (void)pairs(on, view, a); }, bad) == expected));
        }
        {
            // A filter fails at a pair with a shape from elsewhere, so after messages have begun.
            const std::uint64_t first = cut(division::even, 300, on.rank(), on.size());
            const std::uint64_t last = cut(division::even, 300, on.rank() + 1, on.size());
            const auto fails = [&](std::uint64_t, std::uint64_t id) -> bool {
                if (on.rank() == bad && (on.size() == 1 || id < first || id >= last))
                    throw std::range_error("a pair too many");
                return true;
            };
            const query_options<decltype(fails)> options{.filter = fails};
            CHECK(on_all(on.ranks(), thrown_by<std::range_error>([&] { (void)pairs(on, a, b, options); }, bad) == expected));
            CHECK(on_all(on.ranks(), thrown_by<std::range_error>([&] { (void)any(on, a, b, options); }, bad) != 3));
        }
        {
            auto broken = mine;
            if (on.rank() == bad) broken[0].radius = -1;
            const spheres_view<float> view(broken.data(), broken.size());
            const auto ask = [&] { (void)self_pairs(on, view); };
            CHECK(on_all(on.ranks(), thrown_by<invalid_geometry>(ask, bad) == expected));
        }
        {
            // At a pair with a shape from elsewhere, of which the last rank has none.
            const std::uint64_t last = cut(division::even, 300, on.rank() + 1, on.size());
            const auto fails = [&](std::uint64_t, std::uint64_t id) -> bool {
                if (on.rank() == bad && (bad + 1 == on.size() || id >= last)) throw std::range_error("a pair too many");
                return true;
            };
            const self_options<decltype(fails)> options{.filter = fails};
            const auto ask = [&] { (void)self_pairs(on, a, options); };
            CHECK(on_all(on.ranks(), thrown_by<std::range_error>(ask, bad) == expected));
            CHECK(on_all(on.ranks(),
                         thrown_by<std::range_error>([&] { (void)count_self_pairs(on, a, options); }, bad) == expected));
        }
        // The next call works.
        CHECK(count_self_pairs(on, a) == count_self_pairs(serial{}, triangle_soup<float>(all.triangles)));
        CHECK(count(on, a, b) == count(serial{}, triangle_soup<float>(all.triangles), spheres<float>(all.spheres)));
    }
}

TEST_CASE("distributed: a rank that comes late") {
    const distributed on(world(), serial{});
    const auto all = random_scene<float>(300, true, 7);
    const triangle_soup<float> a(part_of(all.triangles, division::even, on.rank(), on.size()));
    const spheres<float> b(part_of(all.spheres, division::even, on.rank(), on.size()));
    const auto expected =
        as_global(pairs(serial{}, triangle_soup<float>(all.triangles), spheres<float>(all.spheres)).to_host());
    for (int late = 0; late < on.size(); ++late) {
        // Once before the call and once in the middle of it, while others are rounds ahead.
        if (on.rank() == late) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::atomic<int> calls{0};
        const auto dawdles = [&](std::uint64_t, std::uint64_t) {
            if (on.rank() == late && calls++ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
            return true;
        };
        CHECK(lists_of_all(on.ranks(), pairs(on, a, b, query_options<decltype(dawdles)>{.filter = dawdles}).to_host()) ==
              expected);
        CHECK(count(on, a, b) == expected.size());
    }
}

TEST_CASE("distributed: boxes of a part are cut where its shapes jump") {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> off(0, 1);
    std::vector<vec3<double>> places;
    double k = 0;  // each group is far from the others, and they do not lie on one line
    for (const std::size_t n : {1u, 50u, 3u, 900u, 20u, 1u, 400u, 7u, 60u, 33u}) {
        for (std::size_t i = 0; i < n; ++i) places.push_back({10 * k + off(random), k * k + off(random), off(random)});
        ++k;
    }
    const points<double> set(places);
    const auto part = detail::bounds_of_part(serial{}, set.view());
    CHECK(part.size == places.size());
    bool all = true, gaps = true;
    for (std::size_t i = 0; i < places.size(); ++i) {
        all = all && part.reaches(bounds(places[i]));
        if (i == 0 || places[i].x - places[i - 1].x < 5) continue;
        const vec3<double> middle = 0.5 * (places[i] + places[i - 1]);
        gaps = gaps && !part.reaches(bounds(middle));
    }
    CHECK(all);
    CHECK(gaps);
    // Boxes of all space, as of planes, and none at all.
    const std::vector<plane<float>> walls(20, {{0, 0, 1}, 1});
    const shapes_view<plane<float>> view(walls.data(), walls.size());
    CHECK(detail::bounds_of_part(serial{}, view).reaches({{1, 1, 1}, {2, 2, 2}}));
    CHECK(!detail::bounds_of_part(serial{}, points<float>().view()).reaches({{-9, -9, -9}, {9, 9, 9}}));
}

TEST_CASE("distributed: ids above 2^32") {
    // Parts so large take too much memory for a test: here they say that they are.
    const distributed on(world(), serial{});
    constexpr std::uint64_t size = (std::uint64_t{1} << 31) - 1;
    detail::part_bounds<float> part;
    part.size = size;
    detail::parts_of_set<float> parts;
    parts.make_room(on.size());
    parts.gather(on.ranks(), part);
    const auto rank = static_cast<std::uint64_t>(on.rank());
    CHECK(on_all(on.ranks(), parts.first_of(on.rank()) == rank * size));
    const std::uint32_t came[] = {7, 0x7ffffffe};
    const detail::global_ids ids{3 * size, 5 * size, came};
    CHECK(ids(0x7ffffffe, 1) == global_pair{4 * size - 1, 6 * size - 1});
    CHECK(detail::global_ids{3 * size, 5 * size, nullptr}(1, 2) == global_pair{3 * size + 1, 5 * size + 2});
}

TEST_CASE("distributed: what is no communicator") {
    (void)world();
    CHECK_THROWS_WITH(distributed(MPI_COMM_NULL, serial{}), "abut::distributed: the communicator is MPI_COMM_NULL");
    const distributed on(world(), serial{});
    const auto copy = on;
    CHECK(copy.rank() == on.rank());
    CHECK(copy.size() == on.size());
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    CHECK(on.size() == size);
    const distributed alone(MPI_COMM_SELF, serial{});
    const sphere<float> ball{{0, 0, 0}, 1};
    CHECK(alone.size() == 1);
    CHECK(count(alone, ball, ball) == 1);
}

}  // namespace abut::test
