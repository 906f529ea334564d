// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type, float or double
#include <abut/abut.hpp>

int main() {
    const abut::triangle_soup<float> soup;
    const abut::spheres<double> balls;
    return abut::any(abut::serial{}, soup, balls);
}
