// SPDX-License-Identifier: MIT

// `main` of every test executable, for both generations of Catch2. It leaves with 77, which ctest reports as skipped, where
// what the executable needs is not there and ABUT_REQUIRE does not ask for it.

#if __has_include(<catch2/catch_session.hpp>)
#include <catch2/catch_session.hpp>
#else
#define CATCH_CONFIG_RUNNER
#define CATCH_CONFIG_FAST_COMPILE  // as in catch.hpp
#include <catch2/catch.hpp>
#endif

#include "support/needs.hpp"

#include <cstdio>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
// The OpenMP runtime is not instrumented; archer stands in for what it orders.
extern "C" const char* __tsan_default_options();
extern "C" const char* __tsan_default_options() { return "ignore_noninstrumented_modules=1"; }
#endif
#endif

int main(int argc, char* argv[]) {
    if (const char* missing = abut::test::what_is_missing()) {
        if (abut::test::is_required("device")) {
            std::printf("ABUT_REQUIRE asks for a device: %s\n", missing);
            return 1;
        }
        std::printf("abut skips: %s\n", missing);
        return 77;
    }
    return Catch::Session().run(argc, argv);
}
