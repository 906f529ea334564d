// SPDX-License-Identifier: MIT
//
// How much one query looks at in a grid whose cells have the width that make_grid chooses: a bound on boxes, not on time. Points have
// no size to choose by. What is found is compared with a plain loop over whole numbers.
#include <abut/traverse/grid_walk.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/execution/host.hpp>

#include "support/catch.hpp"

using namespace abut;

namespace {

/// A reach that counts the boxes that it is asked about.
template <class Reach>
struct counting_reach {
    Reach reach;
    std::size_t* asked;
    [[nodiscard]] auto bounds() const { return reach.bounds(); }
    template <class Box>
    bool operator()(const Box& box) const {
        ++*asked;
        return reach(box);
    }
};

struct draws {
    std::uint64_t state = 9;
    int operator()(int below) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<int>((state >> 33) % static_cast<std::uint64_t>(below));
    }
};

}  // namespace

TEMPLATE_TEST_CASE("a ball looks at few points of a grid", "", float, double) {
    using T = TestType;
    // In space, in a slab, in a plane, along a line, along a ridge, in one place; each with as many places as points, or more.
    const int sides[][3] = {{30, 30, 30}, {110, 110, 2}, {164, 1, 164}, {1, 1, 27000}, {9000, 3, 1}, {1, 1, 1}};
    constexpr int n = 27000;
    for (const auto& side : sides) {
        draws d;
        std::vector<vec3<int>> at;
        std::vector<vec3<T>> cloud;
        const T unit = static_cast<T>(0x1p-7);
        for (int i = 0; i < n; ++i) {
            at.push_back({d(side[0]), d(side[1]), d(side[2])});
            cloud.push_back({unit * static_cast<T>(at.back().x), unit * static_cast<T>(at.back().y), unit * static_cast<T>(at.back().z)});
        }
        const auto grid = make_grid(serial{}, points<T>(cloud));
        const detail::grid_walk<decltype(grid.view())> walk{grid.view()};
        std::size_t asked = 0, found = 0;
        for (int i = 0; i < 100; ++i) {
            const vec3<int> c{d(side[0]), d(side[1]), d(side[2])};
            const sphere<T> ball{{unit * static_cast<T>(c.x), unit * static_cast<T>(c.y), unit * static_cast<T>(c.z)}, unit * 2};
            std::size_t expected = 0, own = 0;
            for (const auto& p : at) {
                const int x = p.x - c.x, y = p.y - c.y, z = p.z - c.z;
                expected += x * x + y * y + z * z <= 4;
            }
            counting_reach<decltype(reach_of(ball))> reach{reach_of(ball), &asked};
            typename decltype(walk)::cursor from;
            walk.for_each(reach, from, [] { return false; }, [&](std::uint32_t) {
                ++own;
                return visit::proceed;
            });
            CHECK(own == expected);
            found += own;
        }
        // A box of five places a side and a cell around it, by the number of points in each.
        CHECK(found >= 100);
        CHECK(asked <= 30 * found);
    }
}
