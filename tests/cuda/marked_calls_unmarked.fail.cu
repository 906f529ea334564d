// SPDX-License-Identifier: MIT
// What a marked functor calls, nvcc warns of, and nothing in the library hides that; warnings are errors here.
// expect: calling a __host__ function.*less.*filter::operator
#include <cstdint>

#include <abut/config.hpp>
#include <abut/execution/cuda.hpp>

bool less(std::uint32_t a, std::uint32_t b) { return a < b; }
struct filter {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return less(a, b); }
};
void pass() { require_callable(abut::cuda{}, filter{}, std::uint32_t{}, std::uint32_t{}); }
