// SPDX-License-Identifier: MIT
// expect: abut: leafless is in another header: include <abut/experimental/leafless.hpp>

#include <abut/abut.hpp>

int main() {
    using namespace abut;
    const auto tree = make_bvh(serial{}, triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    return static_cast<int>(leafless(serial{}, tree).size());
}
