// SPDX-License-Identifier: MIT
// expect: abut: shapes of one argument go along ways, and those of the other stay
#include <abut/abut.hpp>

int main() {
    const abut::spheres<float> balls;
    const abut::vec3<float> way{0, 0, 1};
    return abut::any(abut::serial{}, abut::moving(balls, way), abut::moving(balls, way));
}
