// SPDX-License-Identifier: MIT
// expect: abut: an array is no set: make one of it, as abut::spheres<float>
#include <vector>

#include <abut/abut.hpp>

int main() {
    const std::vector<abut::sphere<float>> balls;
    const auto hits = abut::pairs(abut::serial{}, abut::mesh<float>(), balls);
    return static_cast<int>(abut::to_host(hits).size());
}
