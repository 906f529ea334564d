// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/impact_scenes.hpp"
#include "support/catch.hpp"

// Apart from impacts.cu, so that two processes compile them.

TEST_CASE("impacts: cuda, double") {
    abut::test::check_all_impacts<double, abut::test::ways::exact_too>(abut::cuda{});
    abut::test::check_large_impacts<double>(abut::cuda{});
}

TEST_CASE("impacts: the truth of the scenes: cuda") {
    using abut::test::ccd_folder, abut::test::check_scene;
    for (const char* name : {"cloth-funnel", "cloth-ball", "armadillo-rollers"}) {
        if (!ccd_folder(name)) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
        check_scene<double>(abut::cuda{}, name);
    }
}
