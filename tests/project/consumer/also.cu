// SPDX-License-Identifier: MIT
//
// A second file of the program: whatever the headers define has to be inline.

#include <abut/cuda.hpp>

#include "also.hpp"

static_assert(abut::execution_policy<abut::cuda>);

std::vector<std::uint32_t> hits_by_cu() { return hits_of_rays<abut::exact>(); }
