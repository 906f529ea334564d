// SPDX-License-Identifier: MIT
#include <abut/collide/query.hpp>

#include <algorithm>
#include <cstdio>

#include "collide/extreme_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

using namespace abut;

namespace {

/// Each pair by itself. `many` is how many pairs make up for one of those that take long to decide in truth.
template <class Kind, class T>
void check_extreme_pairs(std::uint64_t many) {
    const std::uint64_t n = std::max<std::uint64_t>(many * test::sample_count() / 250, 1);
    std::size_t wrong_fast = 0, all = 0;
    for (const test::extreme what : test::extremes) {
        std::size_t hits = 0, undecided = 0, unresolved = 0, total = 0;
        for (const test::extreme_step& step : test::steps_of<T>(what)) {
            CAPTURE(Kind::name(), name_of(what), step.value);
            std::size_t wrong_filtered = 0, wrong_exact = 0, wrong_last = 0;
            for (std::uint64_t i = 0; i < n; ++i) {
                const auto p = test::make_extreme_pair<Kind, T>(test::sample_seed, step, i);
                const bool touches = test::touch_in_truth<T>(p);
                const auto& a = test::shape_of(p.a);
                const auto& b = test::shape_of(p.b);
                wrong_filtered += intersects<filtered>(a, b) != touches;
                wrong_exact += intersects<exact>(b, a) != touches;
                wrong_last += resolve(a, b) != touches;
                wrong_fast += intersects<fast>(a, b) != touches;
                hits += touches;
                undecided += decide<filtered>(a, b) == verdict::unknown;
                unresolved += decide<exact>(a, b) == verdict::unknown;
                ++total;
            }
            CHECK(wrong_filtered == 0);
            CHECK(wrong_exact == 0);
            CHECK(wrong_last == 0);
        }
        std::printf("%-17s %-6s %-10s n %zu, hits %.1f %%, left by the filter %.1f %%, by integers in registers %.1f %%\n",
                    Kind::name().c_str(), sizeof(T) == 4 ? "float" : "double", name_of(what), total,
                    100.0 * static_cast<double>(hits) / static_cast<double>(total),
                    100.0 * static_cast<double>(undecided) / static_cast<double>(total),
                    100.0 * static_cast<double>(unresolved) / static_cast<double>(total));
        CAPTURE(Kind::name(), name_of(what), total);
        CHECK(test::is_share_above(0.1, hits, total));
        CHECK(test::is_share_above(0.1, total - hits, total));
        if (what == test::extreme::undecided) CHECK(test::is_share_above(0.2, undecided, total));
        if (what == test::extreme::unresolved) CHECK(test::is_share_above(0.25, unresolved, total));
        all += total;
    }
    CHECK(test::is_share_above(0.05, wrong_fast, all));  // the steps are as hard as they are meant to be
}

}  // namespace

TEMPLATE_TEST_CASE("pairs at extremes", "", float, double) {
    for_each_kind(test::first_extreme_kinds{},
                  []<class Kind>(Kind) { check_extreme_pairs<Kind, TestType>(Kind::moving ? 1 : 10); });
}

TEMPLATE_TEST_CASE("pairs of other shapes at extremes", "", float, double) {
    for_each_kind(test::other_extreme_kinds{}, []<class Kind>(Kind) { check_extreme_pairs<Kind, TestType>(3); });
    for_each_kind(test::hull_extreme_kinds{}, []<class Kind>(Kind) { check_extreme_pairs<Kind, TestType>(3); });
}

TEMPLATE_TEST_CASE("queries at extremes: serial", "", float, double) { test::check_all_extreme_queries<TestType>(serial{}); }

TEMPLATE_TEST_CASE("queries at extremes: openmp", "", float, double) {
    test::check_all_extreme_queries<TestType>(openmp{.threads = 3});
}
