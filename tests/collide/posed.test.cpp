// SPDX-License-Identifier: MIT

#include "posed_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("queries of posed sets and indices", "", float, double) {
    SECTION("serial") { check_all_posed<TestType>(serial{}); }
    SECTION("openmp") { check_all_posed<TestType>(openmp{.threads = 3}); }
}

/// Large enough for threads to share a walk through both trees.
TEMPLATE_TEST_CASE("two large trees: threads find what a walk for each triangle finds", "", float, double) {
    using T = TestType;
    const torus<T> shape(240, 120, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    const auto tree = make_bvh(serial{}, surface);
    for (const T shift : {T(0), T(0.01), T(1.5)}) {
        rigid<T> pose;
        pose.translation = {shift, shift / 2, shift / 4};
        const pair_list expected = to_host(pairs(serial{}, tree, posed(surface, pose)));
        CAPTURE(shift);
        CHECK(expected.size() > 500);
        CHECK(to_host(pairs(serial{}, tree, posed(tree, pose))) == expected);
        for (const int threads : {2, 3, 7}) {
            const openmp on{.threads = threads};
            CHECK(to_host(pairs(on, tree, posed(tree, pose))) == expected);
            CHECK(count(on, tree, posed(tree, pose)) == expected.size());
            CHECK(any(on, tree, posed(tree, pose)));
        }
    }
}

}  // namespace abut::test
