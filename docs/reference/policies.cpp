// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>

#include "expect.hpp"

namespace {

//! [policies]
// Works with each policy, and gives the same answer on each.
template <abut::execution_policy Policy>
std::uint64_t touching(const Policy& on, const abut::mesh<float>& ground, const abut::spheres<float>& balls) {
    const auto index = abut::make_bvh(on, ground);  // in the policy's memory
    return abut::count(on, index, balls);           // waits for the number
}
//! [policies]

}  // namespace

int main() {
    const abut::mesh<float> ground{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {8, 8, 0}}, {{0, 1, 2}, {1, 3, 2}}};
    const abut::spheres<float> balls{{{{1, 1, 2}, 2}, {{4, 4, 3}, 3}, {{4, 4, 9}, 1}}};
    expect(touching(abut::serial{}, ground, balls) == 3);
    expect(touching(abut::openmp{.threads = 2}, ground, balls) == 3);
}
