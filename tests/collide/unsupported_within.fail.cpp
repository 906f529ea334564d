// SPDX-License-Identifier: MIT
// expect: `within` takes sets of .*rays go with what they may meet
#include <abut/abut.hpp>

std::uint64_t near(const abut::points<float>& a, const abut::rays<float>& b) {
    return abut::count_within(abut::serial{}, a, b, 1);
}
