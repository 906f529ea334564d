// SPDX-License-Identifier: MIT
// long to compile
//
// Ranks that work on a device, each on the same one here: the answers of one machine. The host's tests are in
// tests/distributed; here it is that parts, messages and results lie in device memory. Once messages go through the host, and
// once MPI reads devices.
#include <abut/cuda.hpp>
#include <abut/mpi.hpp>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "cuda/aware_mpi.hpp"
#include "distributed/world.hpp"
#include "support/catch.hpp"

namespace abut::test {

namespace {

struct keep_some {
    ABUT_HD bool operator()(std::uint64_t a, std::uint64_t b) const { return (a + 3 * b) % 5 != 0; }
};
struct count_globally {
    std::uint64_t* visits;
    ABUT_HD visit operator()(global_pair) const {
        execution::atomic_add(visits, std::uint64_t{1});
        return visit::proceed;
    }
};

struct shapes_of_scene {
    std::vector<triangle<float>> triangles;
    std::vector<sphere<float>> spheres;
    std::vector<vec3<float>> centers;
};
shapes_of_scene make_scene(std::size_t n) {
    std::mt19937 random(41);
    std::uniform_real_distribution<float> place(0, 6);
    shapes_of_scene all;
    for (std::size_t i = 0; i < n; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        all.triangles.push_back({{x, y, z}, {x + 0.5f, y, z}, {x, y + 0.5f, z + 0.5f}});
        all.spheres.push_back({{z, x, y}, 0.3f});
        all.centers.push_back({y, z, x});
    }
    return all;
}

}  // namespace

TEST_CASE("distributed: cuda") {
    make_mpi_aware(GENERATE(false, true));
    const distributed on(world(), cuda{});
    const auto all = make_scene(3000);
    const triangle_soup<float> whole_a(all.triangles);
    const spheres<float> whole_b(all.spheres);
    const triangle_soup<float> a(part_of(all.triangles, division::even, on.rank(), on.size()));
    const spheres<float> b(part_of(all.spheres, division::uneven, on.rank(), on.size()));
    const auto tree = make_bvh(on.local(), a);

    std::vector<global_pair> expected, some;
    for (const index_pair& pair : pairs(serial{}, whole_a, whole_b)) {
        expected.push_back({pair.a, pair.b});
        if (keep_some{}(pair.a, pair.b)) some.push_back({pair.a, pair.b});
    }
    CHECK(expected.size() > 1000);
    CHECK(lists_of_all(on.ranks(), pairs(on, tree, b).to_host()) == expected);
    CHECK(lists_of_all(on.ranks(), pairs(on, a, make_bvh(on.local(), b)).to_host()) == expected);
    CHECK(lists_of_all(on.ranks(), pairs(on, tree, b, query_options{.filter = keep_some{}}).to_host()) == some);
    CHECK(count(on, tree, b) == expected.size());
    CHECK(any(on, a, b));

    execution::buffer_of<cuda, std::uint64_t> visits(on.local(), 1);
    fill(on.local(), visits.data(), 1, std::uint64_t{0});
    for_each_pair(on, tree, b, count_globally{visits.data()});
    std::vector<std::uint64_t> mine(1);
    visits.read(mine.data());
    std::uint64_t total = 0;
    for (const std::uint64_t n : lists_of_all(on.ranks(), mine)) total += n;
    CHECK(total == expected.size());

    std::vector<global_contact<float>> touching;
    for (const auto& c : contacts(serial{}, whole_a, whole_b)) touching.push_back({c.a, c.b, c.point, c.normal, c.depth});
    CHECK(lists_of_all(on.ranks(), contacts(on, tree, b).to_host()) == touching);

    std::vector<global_neighbor<float>> near;
    for (const auto& n : nearest(serial{}, whole_a, all.centers)) near.push_back({n.id, n.point, n.distance});
    const auto centers = part_of(all.centers, division::uneven, on.rank(), on.size());
    CHECK(lists_of_all(on.ranks(), nearest(on, tree, centers).to_host()) == near);

    // Divided anew, with the ids that they had.
    const auto part_a = redistribute(on, a);
    const auto part_b = redistribute(on, b);
    const auto ids_a = lists_of_all(on.ranks(), part_a.ids.to_host()), ids_b = lists_of_all(on.ranks(), part_b.ids.to_host());
    std::vector<global_pair> found;
    for (const global_pair& p : lists_of_all(on.ranks(), pairs(on, make_bvh(on.local(), part_a.set), part_b.set).to_host())) {
        found.push_back({ids_a[p.a], ids_b[p.b]});
    }
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
    CHECK((messages_on_devices > 0) == (mpi_is_aware && on.size() > 1));
}

TEST_CASE("distributed: what points and rays ask, and distances, cuda") {
    make_mpi_aware(GENERATE(false, true));
    const distributed on(world(), cuda{});
    const auto& ranks = on.ranks();
    const auto all = make_scene(1500);
    const triangle_soup<float> whole(all.triangles);
    const spheres<float> whole_b(all.spheres);
    const triangle_soup<float> a(part_of(all.triangles, division::even, on.rank(), on.size()));
    const spheres<float> b(part_of(all.spheres, division::uneven, on.rank(), on.size()));
    const auto tree = make_bvh(on.local(), a);
    std::vector<ray<float>> lines;
    for (const vec3<float>& p : all.centers) lines.push_back({p, {p.y - 3, p.z - 3, p.x - 3}});
    const rays<float> all_rays(lines), from(part_of(lines, division::uneven, on.rank(), on.size()));

    std::vector<global_ray_hit<float>> first;
    for (const auto& hit : raycast(serial{}, whole, all_rays)) {
        first.push_back({hit.id == no_id ? no_global_id : std::uint64_t{hit.id}, hit.t});
    }
    CHECK((lists_of_all(ranks, raycast(on, tree, from).to_host()) == first));
    CHECK((lists_of_all(ranks, raycast_any(on, tree, from).to_host()) == raycast_any(serial{}, whole, all_rays).to_host()));
    std::vector<global_hit_of_ray<float>> hits;
    for (const auto& hit : raycast_all(serial{}, whole, all_rays)) hits.push_back({hit.ray, hit.id, hit.t});
    CHECK((lists_of_all(ranks, raycast_all(on, tree, from).to_host()) == hits && hits.size() > 1000));

    std::vector<global_neighbor<float>> near;
    for (const auto& n : nearest(serial{}, make_bvh(serial{}, whole), all.centers, 3)) near.push_back({n.id, n.point, n.distance});
    const auto centers = part_of(all.centers, division::uneven, on.rank(), on.size());
    CHECK((lists_of_all(ranks, nearest(on, tree, centers, 3).to_host()) == near));

    std::vector<global_pair> close;
    for (const index_pair& pair : within(serial{}, whole, whole_b, 0.1)) close.push_back({pair.a, pair.b});
    CHECK(lists_of_all(ranks, within(on, tree, make_bvh(on.local(), b), 0.1).to_host()) == close);
    std::vector<global_pair> touching;
    for (const index_pair& pair : self_pairs(serial{}, whole_b)) touching.push_back({pair.a, pair.b});
    CHECK((lists_of_all(ranks, self_pairs(on, make_bvh(on.local(), b)).to_host()) == touching && touching.size() > 1000));

    // Two entries of each rank's part.
    rigid<float> here, there;
    there.translation = {0.25f, -0.125f, 0};
    const auto whole_tree = make_bvh(serial{}, a);
    using listed = std::remove_const_t<decltype(tree)>;
    using listed_alone = std::remove_const_t<decltype(whole_tree)>;
    const std::vector<posed_pair<listed>> list(2, {posed(tree, here), posed(tree, there)});
    const std::vector<posed_pair<listed_alone>> alone(2, {posed(whole_tree, here), posed(whole_tree, there)});
    std::vector<global_tagged_pair> entries;
    for (const tagged_pair& of : pairs(serial{}, alone)) {
        entries.push_back({2 * static_cast<std::uint64_t>(on.rank()) + of.pair, of.a, of.b});
    }
    CHECK(on_all(ranks, pairs(on, list).to_host() == entries));

    const sphere<float> far{{20, 3, 3}, 1};
    const auto apart = distance(serial{}, whole, far);
    const auto found = distance(on, tree, spheres<float>(on.rank() == 0 ? std::vector<sphere<float>>{far} : std::vector<sphere<float>>{}));
    CHECK(on_all(ranks, found && found->a == apart->a && found->distance == apart->distance && found->distance > 0));
    CHECK((messages_on_devices > 0) == (mpi_is_aware && on.size() > 1));
}

TEST_CASE("distributed: impacts, cuda") {
    make_mpi_aware(GENERATE(false, true));
    const distributed on(world(), cuda{});
    const auto all = make_scene(800);
    std::vector<vec3<float>> vertices, moved;
    std::vector<face> faces;
    for (const auto& t : all.triangles) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        for (const vec3<float>& v : {t.a, t.b, t.c}) {
            vertices.push_back(v);
            moved.push_back({v.x + 0.25f, v.y, v.z - 0.5f});
        }
        faces.push_back({first, first + 1, first + 2});
    }
    const auto step_of = [&](int rank, int ranks) {
        const auto mine = part_of(faces, division::even, rank, ranks);
        const std::size_t first = mine.empty() ? 0 : mine.front()[0], count = 3 * mine.size();
        const auto cut_of = [&](const std::vector<vec3<float>>& points) {
            const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
            return std::vector<vec3<float>>(begin, begin + static_cast<std::ptrdiff_t>(count));
        };
        std::vector<face> own;
        for (std::uint32_t i = 0; i < mine.size(); ++i) own.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        const mesh<float> at_t0(cut_of(vertices), own);
        return moving(at_t0, at_t0.with_vertices(serial{}, cut_of(moved)));
    };
    const auto whole = step_of(0, 1), mine = step_of(on.rank(), on.size());
    std::vector<global_impact<float>> expected;
    for (const auto& i : impacts(serial{}, whole, whole.t1())) {
        expected.push_back({i.kind, {i.vertices[0], i.vertices[1], i.vertices[2], i.vertices[3]}, i.time});
    }
    CHECK(expected.size() > 100);
    auto found = lists_of_all(on.ranks(), impacts(on, mine, mine.t1()).to_host());
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
    CHECK(found == expected);
    CHECK((messages_on_devices > 0) == (mpi_is_aware && on.size() > 1));
}

}  // namespace abut::test
