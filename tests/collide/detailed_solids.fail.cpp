// SPDX-License-Identifier: MIT
// expect: abut: raycast_detailed tells where in a triangle a hit is; of solids there is raycast
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::raycast_detailed(abut::serial{}, abut::spheres<float>(), abut::rays<float>()))
        (void)hit.side;
}
