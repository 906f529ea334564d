// SPDX-License-Identifier: MIT
// expect: abut: the volumes and the tree's shapes differ in their scalar type
// errors: 5
#include <abut/abut.hpp>

int main() {
    const auto tree = abut::make_bvh(abut::serial{}, abut::triangle_soup<float>{});
    return static_cast<int>(abut::bounded_by<abut::sphere<double>>(abut::serial{}, tree).size());
}
