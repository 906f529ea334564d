// SPDX-License-Identifier: MIT
//
// Trees of bounding volumes around features in motion: pairs of vertices and faces, and of edges, are those of the trees of
// boxes along the axes.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <abut/abut.hpp>

#include <support/catch.hpp>

namespace {

/// A wavy sheet of n x n quads that moves.
template <abut::scalar T>
abut::moving_set<abut::mesh<T>> sheet(std::uint32_t n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<abut::vec3<T>> t0, t1;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) {
            const double x = i + 0.3 * number(random), y = j + 0.3 * number(random), z = 2 * std::sin(0.9 * i) * std::cos(0.7 * j);
            t0.push_back({static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)});
            t1.push_back({static_cast<T>(x + number(random)), static_cast<T>(y + number(random)), static_cast<T>(-z)});
        }
    }
    std::vector<abut::face> faces;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            faces.push_back({a, b, a + 1});
            faces.push_back({b, b + 1, a + 1});
        }
    }
    const abut::mesh<T> first(t0, faces);
    return abut::moving(first, first.with_vertices(abut::serial{}, t1));
}

template <class V, class A, class B>
std::vector<abut::index_pair> pairs_by(const A& a, const B& b) {
    const abut::openmp on;
    return abut::to_host(abut::pairs(on, abut::bounded_by<V>(on, a), abut::bounded_by<V>(on, b)));
}

template <abut::scalar T>
void check_volumes() {
    const abut::openmp on;
    const auto x = abut::make_impact_index(on, sheet<T>(12, 1)), y = abut::make_impact_index(on, sheet<T>(9, 2));
    const auto check = [&on](const auto& a, const auto& b) {
        const auto expected = abut::to_host(abut::pairs(on, a, b));
        REQUIRE(expected.size() > 50);
        CHECK(pairs_by<abut::kdop<T, 14>>(a, b) == expected);
        CHECK(pairs_by<abut::kdop<T, 18>>(a, b) == expected);
        CHECK(pairs_by<abut::kdop<T, 26>>(a, b) == expected);
        CHECK(pairs_by<abut::obb<T>>(a, b) == expected);
        CHECK(pairs_by<abut::sphere<T>>(a, b) == expected);
    };
    check(x.vertices(), y.faces());
    check(x.edges(), y.edges());
}

}  // namespace

TEST_CASE("volumes around features in motion: the same pairs, float", "[collide]") { check_volumes<float>(); }
TEST_CASE("volumes around features in motion: the same pairs, double", "[collide]") { check_volumes<double>(); }
