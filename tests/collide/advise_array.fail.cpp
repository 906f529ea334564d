// SPDX-License-Identifier: MIT
// expect: abut: an array is no set

#include <vector>

#include <abut/abut.hpp>

int main() {
    const std::vector<abut::triangle<float>> soup;
    return abut::advise(abut::serial{}, soup).fast_is_exact;
}
