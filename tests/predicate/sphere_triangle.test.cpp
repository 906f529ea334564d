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

template <scalar T>
test::stage_tally examine_family(family f) {
    return test::in_threads<test::stage_tally>(
        test::sample_count(), [f](std::uint64_t first, std::uint64_t last, test::stage_tally& sum) {
            for (std::uint64_t i = first; i < last; ++i) {
                const auto [s, t] = test::make_pair<T>(test::seed, f, i);
                const T values[] = {s.center.x, s.center.y, s.center.z, t.a.x, t.a.y, t.a.z,   t.b.x,
                                    t.b.y,      t.b.z,      t.c.x,      t.c.y, t.c.z, s.radius};
                test::examine_stages<detail::ball_meets_triangle>(s, t, values, test::oracle::intersects(s, t), i, sum);
            }
        });
}

}  // namespace

TEST_CASE("sphere and triangle: every stage is right in every family") {
    test::stage_table table("Sphere against triangle", "sphere-triangle.md", false);
    for (int i = 0; i < test::family_count; ++i) {
        const auto f = static_cast<family>(i);
        for (const bool single : {true, false}) {
            const test::stage_tally t = single ? examine_family<float>(f) : examine_family<double>(f);
            table.add(test::name_of(f), single ? "float" : "double", t);
            INFO(test::name_of(f) << (single ? ", float" : ", double"));
            CHECK(t.pairs >= test::sample_count());
            CHECK(t.wrong == 0);
            // A family in which everything touches, or nothing, tests nothing.
            CHECK(test::percent(t.hits, t.pairs) > 5);
            CHECK(test::percent(t.hits, t.pairs) < 95);
        }
    }
}
