// SPDX-License-Identifier: MIT
// expect: abut: this filter is called as filter\(row, id\) const, two std::uint32_t, and returns bool
#include <abut/abut.hpp>

int main() {
    const auto filter = [](std::uint32_t) { return true; };
    const abut::raycast_options<decltype(filter)> options{.filter = filter};
    for (const auto& hit : abut::raycast(abut::serial{}, abut::mesh<float>(), abut::rays<float>(), options)) (void)hit.t;
}
