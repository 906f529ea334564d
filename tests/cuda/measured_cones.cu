// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "cuda/measured_solids.hpp"
#include "support/catch.hpp"

TEST_CASE("distances and contacts, cone<float>: cuda measures every family as the host does") {
    abut::test::check_all_measured<abut::cone<float>>(abut::cuda{});
}
