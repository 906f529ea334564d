// SPDX-License-Identifier: MIT
// expect: abut: queries between sets of these two shapes are not supported
#include <abut/abut.hpp>

int main() {
    const abut::segments<float> lines;
    return abut::any(abut::serial{}, lines, abut::ray<float>{{0, 0, 0}, {1, 1, 1}});
}
