// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type, float or double
#include <abut/abut.hpp>

int main() {
    for (const auto& n : abut::nearest(abut::serial{}, abut::mesh<float>(), abut::points<double>())) (void)n.id;
}
