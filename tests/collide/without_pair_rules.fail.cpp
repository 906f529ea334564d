// SPDX-License-Identifier: MIT
// expect: abut: this pair_rule is in another header: include <abut/experimental/pair_rules.hpp>

#include <abut/abut.hpp>

int main() {
    using namespace abut;
    const auto tree = make_bvh(serial{}, triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const mesh<float> at_rest({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    (void)tree;
    return static_cast<int>(make_impact_index<pair_rule::orphan_sets>(serial{}, at_rest).size());
}
