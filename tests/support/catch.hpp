// SPDX-License-Identifier: MIT
#pragma once

// Catch2, whichever of its two generations the machine has (Debian 12: version 2; Ubuntu 24.04: version 3), and a way to
// skip a case that version 2 lacks.

#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_all.hpp>
using Catch::Approx;
#else
// An exception inside an assertion ends the case, which it would have failed in any case.
#define CATCH_CONFIG_FAST_COMPILE
#include <catch2/catch.hpp>
#endif

#include <cstdio>

#include "needs.hpp"

/// Leaves a test case (at its top level, before any assertion) for want of something: "data", "device", or what nobody may
/// require: "time", "two devices", "order of bytes" or "file system". ctest reports it as skipped, with the reason in its
/// log. Where ABUT_REQUIRE names what is missing, it is a failure.
#define ABUT_SKIP(missing, reason)                                         \
    do {                                                                   \
        if (abut::test::is_required(missing)) FAIL("missing: " << reason); \
        std::printf("abut skips: %s\n", reason);                           \
        std::fflush(stdout);                                               \
        return;                                                            \
    } while (false)
