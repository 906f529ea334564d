// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cstdio>
#include <string>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/triangle_families.hpp"

namespace abut::test {

/// A needle along a line through o, as narrow as numbers allow.
template <scalar T>
triangle<T> needle_along(draws& d, const construction::point& o, const construction::point& line) {
    using namespace construction;
    const point across = unit(cross_product(line, cube(d, 1)));
    const double width = d.power_of_ten(sizeof(T) == 4 ? -12 : -22, -2);
    const double from = d.uniform(-1, 0), to = d.uniform(0, 1), middle = d.uniform(-1, 1);
    return {round_to<T>(along(o, from, line)), round_to<T>(along(o, to, line)),
            round_to<T>(along(along(o, middle, line), width, across))};
}

/// What doubles alone cannot tell.
TEMPLATE_TEST_CASE("contacts of needles that nearly lie on each other", "", float, double) {
    using T = TestType;
    contact_tally total = check_family("needles on needles", 1500, [&](std::uint64_t i) {
        draws d(20261134, 83, i);
        const auto o = construction::cube(d, 1), line = construction::unit(construction::cube(d, 1));
        const double angle = d.power_of_ten(sizeof(T) == 4 ? -9 : -18, 0);
        const auto other = construction::unit(construction::along(line, angle, construction::cube(d, 1)));
        const auto a = needle_along<T>(d, o, line), b = needle_along<T>(d, o, other);
        return std::pair(a, b);
    });
    check_total("needles", total, 1000);
}

TEMPLATE_TEST_CASE("contacts of two triangles are what they say, in each family", "", float, double) {
    using T = TestType;
    constexpr std::uint64_t seed = 20261124, wanted = 150;
    std::printf("triangle contacts: seed %llu\n", static_cast<unsigned long long>(seed));
    contact_tally total;
    for (int f = 0; f < triangle_family_count; ++f) {
        const auto family = static_cast<triangle_family>(f);
        total += check_family(name_of(family), wanted, [&](std::uint64_t i) {
            const auto p = make_triangle_pair<T>(seed, family, i);
            return std::pair(p.a, p.b);
        });
    }
    check_total("triangles", total, 5000);
}

}  // namespace abut::test
