// SPDX-License-Identifier: MIT

#include "collide/batch_cases.hpp"

TEMPLATE_TEST_CASE("a list of posed pairs: serial and openmp", "", float, double) {
    abut::test::check_batches<TestType>(abut::serial{});
    abut::test::check_batches<TestType>(abut::openmp{3});
    abut::test::check_mixed_batch<TestType>(abut::serial{});
}

TEST_CASE("a list of posed pairs: two layouts, one with four children a node, and trees of one shape") {
    using namespace abut;
    using namespace abut::test;
    const openmp on{2};
    const torus<float> shape(12, 8, 0.7f, 0.3f);
    std::vector<triangle<float>> of_torus;
    for (const face& f : shape.faces) of_torus.push_back({shape.vertices[f[0]], shape.vertices[f[1]], shape.vertices[f[2]]});
    const triangle<float> large{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, turned{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    using tree = decltype(make_bvh(on, triangle_soup<float>()));
    using wide_tree = decltype(wide(on, std::declval<tree>()));
    std::vector<tree> trees;
    std::vector<wide_tree> wide_trees;
    for (const auto& set : {std::vector<triangle<float>>{}, {large}, {large, turned}, of_torus}) {
        trees.push_back(make_bvh(on, triangle_soup<float>(set)));
        wide_trees.push_back(wide(on, trees.back()));
    }
    std::vector<posed_pair<tree, wide_tree>> list;
    std::vector<posed_pair<wide_tree, tree>> reversed;
    std::vector<tagged_pair> expected;
    std::vector<tagged_contact<float>> expected_contacts;
    for (std::uint32_t i = 0; i < 400; ++i) {
        draws d(20261202, 86, i);
        const auto a = posed(trees[i % 4], make_pose<float>(d, 0.2));
        const auto b = posed(wide_trees[i / 4 % 4], make_pose<float>(d, 0.2));
        list.push_back({a, b});
        reversed.push_back({b, a});
        for (const auto& c : contacts(serial{}, a, b)) {
            expected.push_back({i, c.a, c.b});
            expected_contacts.push_back({i, c.a, c.b, c.point, c.normal, c.depth});
        }
    }
    CHECK(expected.size() > 1000);
    CHECK((to_host(pairs(on, list)) == expected));
    CHECK((to_host(contacts(on, list)) == expected_contacts));
    CHECK(count(on, reversed) == expected.size());
    // Entries of one-shape trees alone.
    std::erase_if(list, [](const auto& entry) { return entry.a.size() != 1 && entry.b.size() != 1; });
    std::size_t of_one = 0;
    for (const auto& entry : list) of_one += pairs(serial{}, entry.a, entry.b).size();
    CHECK(of_one > 500);
    CHECK(count(on, list) == of_one);
    CHECK(any(on, list));
}
