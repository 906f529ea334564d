// SPDX-License-Identifier: MIT
// expect: abut: this option is true or false: name the one that is meant, as in abut::query_options{.filter = f}
#include <cstdint>

#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> m;
    const auto never = [](std::uint32_t, std::uint32_t) { return false; };
    return abut::any(abut::serial{}, m, m, abut::query_options<>{never}) ? 1 : 0;
}
