// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type, float or double
#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> m;
    return abut::first_impact(abut::serial{}, abut::moving(m, m), abut::mesh<double>()).has_value() ? 1 : 0;
}
