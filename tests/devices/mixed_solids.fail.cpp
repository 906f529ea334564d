// SPDX-License-Identifier: MIT
// expect: abut: bodies of several kinds are asked by one policy; ask several devices or ranks about each two kinds
#include "host_team.hpp"

#include <abut/devices/solids.hpp>
#include <abut/index/quantised.hpp>

int main() {
    const abut::serial on;
    const auto tree = abut::make_bvh(on, abut::mesh<float>());
    const std::vector some{abut::posed(tree, {})};
    const std::vector others{abut::posed(abut::quantised(on, tree), {})};
    return static_cast<int>(abut::relation(abut::test::host_team<abut::serial>(2), abut::make_bodies(on, some, others)).size());
}
