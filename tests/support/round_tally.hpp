// SPDX-License-Identifier: MIT
#pragma once

// Every stage of pairs of cylinders, cones and capsules against the truth.

#include <cstdint>

#include <abut/predicate/intersects.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/reach.hpp>

#include "support/stages.hpp"

namespace abut::test {

struct round_tally : decision_tally {
    std::uint64_t touching = 0, failed = 0;  // of the oracle

    round_tally& operator+=(const round_tally& o) {
        decision_tally::operator+=(o);
        touching += o.touching, failed += o.failed;
        return *this;
    }
};

/// Every stage against the truth; `fast` is counted where it is unlike.
template <class S, class U>
void examine_with_truth(const S& s, const U& t, bool truth, round_tally& sum) {
    const verdict lie = to_verdict(!truth), by_filter = decide<filtered>(s, t);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += intersects<fast>(t, s) != truth;
    bool wrong = by_filter == lie || decide<exact>(s, t) == lie || resolve(s, t) != truth || intersects(s, t) != truth ||
                 intersects(t, s) != truth || intersects<exact>(t, s) != truth;
    // What culls may not lose it.
    wrong = wrong || (truth && !(overlaps(bounds(s), bounds(t)) && reach_of(s)(bounds(t)) && reach_of(t)(bounds(s))));
    sum.wrong += wrong;
}

}  // namespace abut::test
