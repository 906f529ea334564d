// SPDX-License-Identifier: MIT
// expect: sets of them are not divided among devices: replicate\(devices, set\) gives each the whole set
#include "host_team.hpp"  // of this folder: nothing else is on the path

#include <abut/devices/divide.hpp>

int main() {
    const auto parts = abut::divide(abut::test::host_team<abut::serial>(2), abut::hulls<float>());
    return static_cast<int>(parts.size());
}
