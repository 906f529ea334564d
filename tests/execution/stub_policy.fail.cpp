// SPDX-License-Identifier: MIT
// expect: abut: this policy lacks a verb
// errors: 3
#include <abut/abut.hpp>

// It names its memory, waits and gives memory back, and has no loop.
struct stub : abut::execution::policy_base {
    using memory_space = abut::host_space;
};
void synchronize(const stub&) {}
void release_memory(const stub&) {}

bool touch(const abut::mesh<float>& a, const abut::mesh<float>& b) { return abut::any(stub{}, a, b); }
