// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type

#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> a;
    const abut::mesh<double> b;
    return abut::advise(abut::serial{}, a, b).fast_is_exact;
}
