// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

#include "collide/traversal_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("traversals: cuda") {
    const cuda on;
    check_traversal<float, traversal::one_first>(on);
    check_traversal<float, traversal::larger_first>(on);
    check_traversal<float, traversal::alternate>(on);
    check_traversal<float, traversal::breadth_first>(on);
}

TEST_CASE("traversals: other forms of a query: cuda") { check_walked_forms<float, traversal::breadth_first>(cuda{}); }

TEST_CASE("traversals: start depths: cuda") { check_start_depths(cuda{}); }

}  // namespace abut::test
