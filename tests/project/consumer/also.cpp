// SPDX-License-Identifier: MIT

#include "also.hpp"

std::vector<std::uint32_t> hits_by_cpp() { return hits_of_rays<abut::filtered>(); }
