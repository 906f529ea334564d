// SPDX-License-Identifier: MIT
//
// Sets that are divided anew: every shape is there once, all ranks have as many, and they lie along the curve.

#include <abut/mpi.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "distributed/world.hpp"

namespace abut::test {

namespace {

template <class Local, shape S>
void check_redistributed(const distributed<Local>& on, const std::vector<S>& all, division how) {
    CAPTURE(static_cast<int>(how), on.size(), all.size());
    const shapes<S> mine(part_of(all, how, on.rank(), on.size()));
    const auto part = redistribute(on, mine);
    const auto ids = part.ids.to_host();
    CHECK(on_all(on.ranks(), ids.size() == part.set.size()));
    std::vector<std::size_t> size(static_cast<std::size_t>(on.size()));
    detail::gather(on.ranks(), ids.size(), size);
    CHECK(*std::max_element(size.begin(), size.end()) - *std::min_element(size.begin(), size.end()) <= 1);

    bool same = true;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        same = same && ids[i] < all.size();
        if (same) same = std::memcmp(&all[ids[i]], part.set.view().shapes.first() + i, sizeof(S)) == 0;
    }
    CHECK(on_all(on.ranks(), same));

    // One after another they are the whole set in the order of the codes, and of the ids where codes are equal.
    using T = scalar_type_of<S>;
    aabb<T> around = empty_box<T>();
    for (const S& s : all) around = merge(around, bounds(s));
    std::vector<std::pair<std::uint64_t, std::uint64_t>> expected;
    for (std::size_t i = 0; i < all.size(); ++i) {
        expected.emplace_back(detail::morton_code<std::uint64_t>(bounds(all[i]), around), i);
    }
    std::sort(expected.begin(), expected.end());
    const auto found = lists_of_all(on.ranks(), ids);
    CHECK(found.size() == expected.size());
    CHECK(std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                     [](std::uint64_t id, const auto& e) { return id == e.second; }));
}

}  // namespace

TEST_CASE("distributed: sets divided anew") {
    const distributed on(world(), serial{});
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-5, 5);
    std::vector<sphere<float>> balls;
    std::vector<vec3<double>> points;
    for (int i = 0; i < 1003; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        balls.push_back({{x, y, z}, 0.25f});
        points.push_back({std::floor(x), std::floor(y / 4), 1});  // many in one place
    }
    for (const division how : divisions) {
        check_redistributed(on, balls, how);
        check_redistributed(on, points, how);
    }
    check_redistributed(on, std::vector<vec3<double>>(100, {1, 2, 3}), division::uneven);
    check_redistributed(on, std::vector<sphere<float>>{balls[0]}, division::all_on_last);
    check_redistributed(on, std::vector<sphere<float>>{}, division::even);
}

TEST_CASE("distributed: queries of sets divided anew") {
    const distributed on(world(), openmp{2});
    std::mt19937 random(12);
    std::uniform_real_distribution<float> place(0, 6);
    std::vector<vec3<float>> vertices;
    std::vector<face> faces;
    std::vector<sphere<float>> balls;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        vertices.insert(vertices.end(), {{x, y, z}, {x + 0.5f, y, z}, {x, y + 0.5f, z + 0.5f}});
        faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        balls.push_back({{z, x, y}, 0.3f});
    }
    const mesh<float> whole(vertices, faces), part(vertices, part_of(faces, division::uneven, on.rank(), on.size()));
    const spheres<float> part_of_balls(part_of(balls, division::all_on_first, on.rank(), on.size()));
    const auto a = redistribute(on, part);
    const auto b = redistribute(on, part_of_balls.view());
    // With the ids that they had.
    const auto ids_a = lists_of_all(on.ranks(), a.ids.to_host()), ids_b = lists_of_all(on.ranks(), b.ids.to_host());
    std::vector<global_pair> found;
    for (const global_pair& pair : lists_of_all(on.ranks(), pairs(on, make_bvh(on.local(), a.set), b.set).to_host())) {
        found.push_back({ids_a[pair.a], ids_b[pair.b]});
    }
    std::sort(found.begin(), found.end());
    std::vector<global_pair> expected;
    for (const auto& pair : pairs(serial{}, whole, spheres<float>(balls)).to_host()) expected.push_back({pair.a, pair.b});
    CHECK(expected.size() > 100);
    CHECK(found == expected);
}

}  // namespace abut::test
