// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"

static_assert(abut::execution_policy<abut::cuda>);
static_assert(!abut::host_policy<abut::cuda>);

TEMPLATE_TEST_CASE("queries: cuda", "", float, double) { abut::test::check_all_queries<TestType>(abut::cuda{}); }
