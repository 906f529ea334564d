// SPDX-License-Identifier: MIT

#include <cmath>
#include <vector>

#include "reduction_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("reduction of contacts", "", float, double) {
    SECTION("serial") { check_all_reductions<TestType>(serial{}); }
    SECTION("openmp") { check_all_reductions<TestType>(openmp{.threads = 3}); }
}

TEST_CASE("reduction of contacts: as the guide says it, what stays is as deep as two cubes are in each other") {
    std::vector<vec3<double>> corners, turned;
    const double c = std::sqrt(0.5), depth = 0.0625;
    for (int i = 0; i < 8; ++i) {
        const vec3<double> p{(i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5};
        corners.push_back(p);
        turned.push_back({c * p.x - c * p.y, c * p.x + c * p.y, p.z + 1 - depth});
    }
    const std::vector<face> faces{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const serial on;
    const mesh<double> below(corners, faces), above(turned, faces);
    const auto few = to_host(reduce_contacts(on, contacts(on, below, above, {.discard_sideways = true}), {.most = 4}));
    CHECK(few.size() == 4);
    for (const auto& contact : few) {
        CHECK(contact.depth == Approx(depth));
        CHECK(contact.normal.z == Approx(-1));
    }
}

}  // namespace abut::test
