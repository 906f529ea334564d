// SPDX-License-Identifier: MIT
#include <abut/abut.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/scenes.hpp"

// The engine with roles from outside: an operand that is a list of balls and nothing else, and a judge that leaves all open.

namespace {

using namespace abut;

/// The least that one side of a pairing has.
struct few_balls {
    static constexpr bool is_indexed = false, has_tree = false, is_posed = false;
    std::vector<sphere<float>> balls;
    [[nodiscard]] auto shapes() const { return shapes_view<sphere<float>>(balls.data(), balls.size()); }
};
static_assert(detail::operand<few_balls>);
static_assert(!detail::operand<std::vector<sphere<float>>> && !detail::operand<spheres<float>>);

struct says_it_is_indexed : few_balls {
    static constexpr bool is_indexed = true;
};
static_assert(!detail::operand<says_it_is_indexed>);

/// Decides nothing where pairs are found; the end is for the host to resolve.
struct late_judge {
    template <class S, class U>
    ABUT_HD verdict decide(const S&, const U&) const {
        return verdict::unknown;
    }
    template <class S, class U>
    ABUT_HD verdict finish(const S&, const U&) const {
        return verdict::unknown;
    }
    template <class S, class U>
    bool resolve(const S& s, const U& t) const {
        return intersects<exact>(s, t);
    }
};
static_assert(pair_judge<late_judge, sphere<float>, triangle<float>>);
static_assert(pair_judge<detail::touch<filtered>, triangle<double>, triangle<double>>);
static_assert(!pair_judge<std::less<>, sphere<float>, triangle<float>>);

}  // namespace

TEST_CASE("search: a judge that leaves all open, and an operand of the caller's") {
    test::uniform random(81);
    few_balls balls;
    for (int i = 0; i < 200; ++i) balls.balls.push_back({random.point<float>(-1, 1), 0.2f});
    const triangle_soup<float> soup(test::random_triangles<float>(300, random));
    const auto check = [&](const auto& on) {
        const auto expected = count(on, spheres<float>(balls.balls), soup);
        CHECK(expected > 100);
        const auto other = detail::make_operand(on, make_bvh(on, soup), "test");
        const detail::pair_key key{detail::id_bits(balls.balls.size()), detail::id_bits(soup.size())};
        const detail::pairing<few_balls, decltype(other), keep_all, traversal::both_at_once, schedule::shared_list> pairing{
            balls, other, key, {}};
        execution::work_count<host_space> hits(on);
        detail::search(on, pairing, late_judge{}, hits);
        CHECK(hits.total() == expected);
    };
    check(serial{});
    check(openmp{3});
}

// What a device does where it has no room for all candidates.
TEST_CASE("what finds no room is gathered in parts, each once") {
    test::draws d(20270306, 97, 0);
    for (const std::uint64_t n : {0u, 100u, 101u, 5000u}) {
        std::vector<std::uint64_t> keys, found, all;
        for (std::uint64_t i = 0; i < n; ++i) keys.push_back(i << d.below(2) * 31 | i);
        std::sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
        constexpr std::size_t room = 100;
        const auto gather = [&](detail::part_of_open part) {
            found.clear();
            std::copy_if(keys.begin(), keys.end(), std::back_inserter(found), [&](std::uint64_t k) { return part.holds(k); });
            return found.size();
        };
        std::size_t most = 0, passes = 0;
        detail::gather_in_parts(room, gather, [&] {
            most = std::max(most, found.size());
            ++passes;
            all.insert(all.end(), found.begin(), found.end());
        });
        std::sort(all.begin(), all.end());
        CAPTURE(n, passes);
        CHECK(all == keys);
        CHECK(most <= room);
        CHECK((passes > 1) == (keys.size() > room));
    }
}
