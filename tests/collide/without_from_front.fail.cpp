// SPDX-License-Identifier: MIT
// expect: abut: this traversal is in another header: include <abut/experimental/front.hpp>

#include <abut/abut.hpp>

int main() {
    using namespace abut;
    const auto tree = make_bvh(serial{}, triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    return any(serial{}, tree, tree, query_options<keep_all, traversal::from_front>{});
}
