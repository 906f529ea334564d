// SPDX-License-Identifier: MIT
// expect: abut: reduce_contacts takes the contacts of one pair of bodies
#include <vector>

#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const auto ball = abut::make_bvh(on, abut::spheres<float>{{{0, 0, 0}, 1}});
    const auto scene = abut::make_bodies(on, std::vector{abut::posed(ball, abut::rigid<float>())});
    abut::reduce_contacts(on, abut::contacts(on, scene), {.most = 4});
}
