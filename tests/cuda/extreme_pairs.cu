// SPDX-License-Identifier: MIT
// long to compile
//
// Each kind of pairs of support/extremes.hpp that a device makes and decides alone, in a kernel of its own. The points of hulls lie
// elsewhere, and of features in motion the last stage is the host's: extremes.cu asks about both.
#include <abut/cuda.hpp>

#include <cstdio>
#include <string>

#include "cuda/decisions.hpp"
#include "support/catch.hpp"
#include "support/extremes.hpp"
#include "support/samples.hpp"

namespace abut::test {

template <class T, class Kind>
struct extreme_pairs {
    extreme_step step;
    [[nodiscard]] std::string name() const {
        return Kind::name() + ' ' + name_of(step.what) + ' ' + std::to_string(step.value);
    }
    ABUT_HD auto make(std::size_t i) const { return make_extreme_pair<Kind, T>(sample_seed, step, i); }
};

/// tests/collide/extremes.test.cpp says that the host is right.
template <class T, class Kind>
void check_extremes() {
    const std::size_t n = static_cast<std::size_t>(sample_count()) / 5 + 1;
    std::size_t wrong_fast = 0, all = 0;
    for (const extreme what : extremes) {
        std::size_t hits = 0, total = 0;
        for (const extreme_step& step : steps_of<T>(what)) {
            const decision_counts counts = check_decisions<T>(extreme_pairs<T, Kind>{step}, n);
            hits += counts.hits;
            wrong_fast += counts.wrong_fast;
            total += n;
        }
        CAPTURE(Kind::name(), name_of(what), total);
        CHECK(is_share_above(0.1, hits, total));
        CHECK(is_share_above(0.1, total - hits, total));
        all += total;
    }
    std::printf("%s: fast is wrong of %zu in %zu\n", Kind::name().c_str(), wrong_fast, all);
    CHECK(is_share_above(0.05, wrong_fast, all));
}

TEMPLATE_TEST_CASE("pairs at extremes: cuda decides every step as the host does", "", float, double) {
    for_each_kind(first_extreme_kinds{}, []<class Kind>(Kind) {
        if constexpr (!Kind::moving) check_extremes<TestType, Kind>();
    });
    for_each_kind(other_extreme_kinds{}, []<class Kind>(Kind) { check_extremes<TestType, Kind>(); });
}

}  // namespace abut::test
