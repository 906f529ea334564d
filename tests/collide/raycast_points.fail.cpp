// SPDX-License-Identifier: MIT
// expect: abut: raycast takes rays or segments: a set of them, a view, or one
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::raycast(abut::serial{}, abut::mesh<float>(), abut::points<float>())) (void)hit.t;
}
