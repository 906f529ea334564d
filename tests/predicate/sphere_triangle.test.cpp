// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"

// Every stage against the oracle, family by family. The table goes to stdout, and to sphere-triangle.md in the folder that
// ABUT_RESULTS names.

namespace {

using namespace abut;
using test::family;

}  // namespace

TEST_CASE("sphere and triangle: every stage is right in every family") {
    test::check_every_family<family>(
        "Sphere against triangle", "sphere-triangle.md", false, test::family_count,
        [](family f) { return test::name_of(f); },
        []<class T>(T, family f, std::uint64_t k, test::stage_tally& sum) {
            const auto [s, t] = test::make_pair<T>(test::sample_seed, f, k);
            test::examine_stages<detail::ball_meets_triangle>(s, t, detail::values_of(s, t).value,
                                                              test::oracle::intersects(s, t), k, sum);
        });
}
