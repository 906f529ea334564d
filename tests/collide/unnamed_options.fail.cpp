// SPDX-License-Identifier: MIT
// expect: abut: braces in a call do not tell the type of a filter: write abut::query_options{.filter = f}
#include <cstdint>

#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> m;
    const auto later = [](std::uint32_t a, std::uint32_t b) { return a < b; };
    return abut::any(abut::serial{}, m, m, {.filter = later}) ? 1 : 0;
}
