// SPDX-License-Identifier: MIT
// expect: abut: queries between sets of these two shapes are not supported
#include <abut/abut.hpp>

int main() {
    const abut::triangle_soup<float> soup;
    return abut::any(abut::serial{}, soup, soup);
}
