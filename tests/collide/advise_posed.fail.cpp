// SPDX-License-Identifier: MIT
// expect: abut::advise: posed coordinates are rounded

#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> mesh;
    return abut::advise(abut::serial{}, abut::posed(mesh, abut::rigid<float>{})).fast_is_exact;
}
