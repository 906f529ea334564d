// SPDX-License-Identifier: MIT
// expect: abut: impacts are of meshes, at rest or in motion
#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> m;
    (void)abut::impacts(abut::serial{}, abut::moving(m, m), abut::posed(m, abut::rigid<float>{}));
}
