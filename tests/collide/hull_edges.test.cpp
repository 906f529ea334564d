// SPDX-License-Identifier: MIT
#include <abut/collide/hull_edges.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/collide/query.hpp>
#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/predicate/kept_points.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/hulls.hpp"
#include "support/rational.hpp"

// Hulls with edges against the same without: which points are corners, by a linear program in integers; the farthest point
// along random and adversarial ways, by reading all; and the bits of what is decided and measured.

namespace {

using namespace abut;

template <scalar T>
using list = std::vector<vec3<T>>;

template <scalar T>
list<T> ellipsoid(std::size_t n, test::draws& d, T scale) {
    list<T> points;
    while (points.size() < n) {
        const double x = d.uniform(-1, 1), y = d.uniform(-1, 1), z = d.uniform(-1, 1), r = std::sqrt(x * x + y * y + z * z);
        if (r > 0.1 && r < 1) points.push_back({static_cast<T>(x / r) * scale, static_cast<T>(0.8 * y / r) * scale, static_cast<T>(0.6 * z / r) * scale});
    }
    return points;
}
/// All points of a grid of n^3, of which eight are corners.
template <scalar T>
list<T> grid_points(int n) {
    list<T> points;
    for (int i = 0; i < n * n * n; ++i) points.push_back({static_cast<T>(i % n), static_cast<T>(i / n % n), static_cast<T>(i / n / n)});
    return points;
}
/// Two equal polygons: many corners in two planes.
template <scalar T>
list<T> prism(std::size_t n) {
    list<T> points;
    for (std::size_t i = 0; i < 2 * n; ++i) {
        // On a parabola: exact.
        const T x = static_cast<T>(i % n);
        points.push_back({x, x * x, i < n ? T(0) : T(1000)});
    }
    return points;
}
template <scalar T>
list<T> lattice(std::size_t n, int width, test::draws& d) {
    list<T> points;
    const auto number = [&] { return static_cast<T>(d.below(width)); };
    for (std::size_t i = 0; i < n; ++i) {
        const T x = number(), y = number();
        points.push_back({x, y, number()});
    }
    return points;
}
template <scalar T>
vec3<T> far_number(test::draws& d) {
    const auto number = [&] { return std::ldexp(static_cast<T>(d.uniform(-1, 1)), static_cast<int>(d.below(200)) - 100); };
    const T x = number(), y = number();
    return {x, y, number()};
}

template <scalar T>
bool is_corner(const list<T>& points, const vec3<T>& p) {
    list<T> others;
    for (const auto& q : points) {
        if (!(q == p)) others.push_back(q);
    }
    return others.empty() || !test::oracle::hulls_intersect(others, list<T>{p});
}
bool comes_first(const auto& p, const auto& q) { return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z; }

/// Corners are those of a linear program, in the order of the input.
template <scalar T>
void check_corners(const list<T>& points, bool has_volume) {
    const auto made = with_edges(hulls<T>(std::vector<list<T>>{points}));
    const hull<T> h = made.view()[0];
    CHECK((h.edges != nullptr) == has_volume);
    if (!has_volume) {
        REQUIRE(h.count == points.size());
        return;
    }
    list<T> expected, found;
    for (const auto& p : points) {
        if (is_corner(points, p)) expected.push_back(p);
    }
    for (std::size_t i = 0; i < h.count; ++i) found.push_back(h[i]);
    std::sort(expected.begin(), expected.end(), [](const auto& p, const auto& q) { return comes_first(p, q); });
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    std::sort(found.begin(), found.end(), [](const auto& p, const auto& q) { return comes_first(p, q); });
    CHECK(found == expected);
}

/// What a climb finds is what reading all finds, wherever it begins; and the box and the largest coordinate.
template <scalar T>
void check_climbs(const hull<T>& h, test::draws& d) {
    REQUIRE(h.edges != nullptr);
    detail::hull_climb<T> climb;
    climb.begin(h);
    const vec3<double> origin = detail::widened(h[h.count / 2]);
    climb.see_from(origin);
    const auto seen = [&](std::size_t i) {
        const vec3<double> p = detail::widened(h[i]);
        return vec3<double>{detail::plain_sum(p.x, -origin.x), detail::plain_sum(p.y, -origin.y), detail::plain_sum(p.z, -origin.z)};
    };
    aabb<double> box = empty_box<double>();
    for (std::size_t i = 0; i < h.count; ++i) box = merge(box, bounds(seen(i)));
    CHECK(climb.box().lower == box.lower);
    CHECK(climb.box().upper == box.upper);
    const auto far = detail::greatest(detail::absolute(box.lower), detail::absolute(box.upper));
    CHECK(climb.largest() == detail::greatest(far.x, far.y, far.z));
    CHECK(climb.size() >= climb.largest());
    std::vector<bool> reached(h.count, false);
    for (int k = 0; k < 400; ++k) {
        vec3<double> way{d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1)};
        const auto any = [&] { return seen(static_cast<std::size_t>(d.below(static_cast<int>(h.count)))); };
        if (k % 4 == 1) way = cross(any() - any(), any() - any());                               // across a face, perhaps
        if (k % 4 == 2) way = {double(d.below(3)) - 1, double(d.below(3)) - 1, double(d.below(3)) - 1};  // across many
        if (k % 8 == 3) way = 1e-200 * way;
        double least = infinity<double>, found = least;
        std::uint32_t first = 0, at = 0;
        for (std::size_t i = 0; i < h.count; ++i) {
            const vec3<double> p = seen(i);
            const double x = detail::plain_sum(detail::plain_sum(detail::plain_product(way.x, p.x), detail::plain_product(way.y, p.y)),
                                               detail::plain_product(way.z, p.z));
            if (x < least) least = x, first = static_cast<std::uint32_t>(i);
        }
        climb.look_back(way, found, at);
        if (found != least || at != first) FAIL("farthest point " << first << ", found " << at << " on way " << k);
        reached[at] = true;
        at = 7;
        climb.look_back(way, found, at);
        if (found != least || at != 7) FAIL("none is farther than the farthest");
    }
    CHECK(std::count(reached.begin(), reached.end(), true) > 3);
}

template <scalar T>
rigid<T> pose(int k, T scale) {
    const rigid<T> one{{0, T(-0.6), T(0.8), 1, 0, 0, 0, T(0.8), T(0.6)}, {0, 0, 0}};
    rigid<T> r;
    for (int i = 0; i < k % 7; ++i) r = compose(one, r);
    const T out = scale * static_cast<T>(k % 20) / 8;
    r.translation = {k % 3 == 0 ? out : out / 3, k % 3 == 1 ? -out : out / 4, k % 3 == 2 ? out : 0};
    return r;
}

/// Decisions, distances and contacts have the same bits; says how many touch.
template <scalar T>
int check_bits(const hull<T>& h, T scale) {
    hull<T> plain = h;
    plain.edges = nullptr;
    int touching = 0;
    for (int k = 0; k < 60; ++k) {
        const hull<T> a = place(pose<T>(k, scale), h), b = place(pose<T>(k, scale), plain);
        const bool meet = intersects(h, a);
        touching += meet;
        CHECK(meet == intersects(plain, b));
        const auto x = distance(h, a), y = distance(plain, b);
        CHECK((x.distance == y.distance && x.point_a == y.point_a && x.point_b == y.point_b));
        const sphere<T> ball{{a[0].x, a[0].y, a[0].z}, scale / 8};
        CHECK(intersects(h, ball) == intersects(plain, ball));
        CHECK(distance(h, ball).distance == distance(plain, ball).distance);
        if (!meet) continue;
        const auto c = contact_of(h, a), d = contact_of(plain, b);
        REQUIRE((c && d));
        CHECK((c->point == d->point && c->normal == d->normal && c->depth == d->depth));
    }
    return touching;
}

}  // namespace

TEMPLATE_TEST_CASE("with_edges: leaves a hull's corners, and no edges where it has no volume", "", float, double) {
    using T = TestType;
    test::draws d(2026, 2611, 0);
    check_corners(grid_points<T>(3), true);
    check_corners(grid_points<T>(5), true);
    check_corners(prism<T>(20), true);
    for (int k = 0; k < 60; ++k) check_corners(lattice<T>(static_cast<std::size_t>(8 + d.below(40)), 2 + k % 5, d), true);
    auto twice = ellipsoid<T>(30, d, T(1));
    twice.insert(twice.end(), twice.begin(), twice.end());
    check_corners(twice, true);
    for (auto& p : twice) p.z = 0;
    check_corners(twice, false);
    for (auto& p : twice) p.y = 3 * p.x;
    check_corners(twice, false);
    for (auto& p : twice) p = twice[0];
    check_corners(twice, false);
    check_corners(list<T>{{1, 2, 3}}, false);
}

TEMPLATE_TEST_CASE("with_edges: a climb finds what reading all finds", "", float, double) {
    using T = TestType;
    test::draws d(2026, 2811, 0);
    std::vector<list<T>> lists{grid_points<T>(2), grid_points<T>(6), prism<T>(100), ellipsoid<T>(60, d, T(1)), ellipsoid<T>(700, d, T(1e-3)), ellipsoid<T>(400, d, T(1e6))};
    for (int k = 0; k < 8; ++k) lists.push_back(lattice<T>(500, 4 + 40 * k, d));
    for (int k = 0; k < 4; ++k) {
        lists.emplace_back();
        for (int i = 0; i < 50; ++i) lists.back().push_back(far_number<T>(d));
    }
    auto shifted = ellipsoid<T>(300, d, T(1));
    for (auto& p : shifted) p.x += 1000;
    lists.push_back(shifted);
    const auto made = with_edges(hulls<T>(lists));
    REQUIRE(made.size() == lists.size());
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const hull<T> h = made.view()[i];
        CAPTURE(i, h.count);
        check_climbs(h, d);
        for (int k = 1; k < 6; ++k) check_climbs(place(pose<T>(7 * k + k, T(1)), h), d);
    }
}

TEMPLATE_TEST_CASE("with_edges: decisions, distances and contacts have the bits that they have without", "", float, double) {
    using T = TestType;
    test::draws d(2026, 1128, 0);
    const T sizes[] = {T(1), T(1e-3), T(1e5)};
    for (const std::size_t n : {std::size_t{150}, std::size_t{500}, std::size_t{1200}}) {
        for (const T size : sizes) {
            const auto set = with_edges(hulls<T>(std::vector<list<T>>{ellipsoid<T>(n, d, size)}));
            CHECK(check_bits(set.view()[0], size) > 10);
        }
    }
    const auto flats = with_edges(hulls<T>(std::vector<list<T>>{prism<T>(200)}));
    REQUIRE(flats.view()[0].count == 400);
    CHECK(check_bits(flats.view()[0], T(100)) > 10);
}

TEST_CASE("with_edges: sets keep their edges where they are copied, and pairs are those without") {
    test::draws d(2026, 52, 0);
    std::vector<list<double>> lists;
    for (int k = 0; k < 12; ++k) {
        lists.push_back(k % 4 == 0 ? lattice<double>(40, 3, d) : ellipsoid<double>(300, d, 1.0));
        for (auto& p : lists.back()) p = p + vec3<double>{0.9 * k, 0.3 * (k % 3), 0};
    }
    const hulls<double> plain(lists);
    const auto set = with_edges(plain), copy = copy_to(openmp{}, set.view());
    REQUIRE(copy.view()[1].edges != nullptr);
    CHECK(copy.view()[1].edges != set.view()[1].edges);
    const auto found = pairs(serial{}, copy, set);
    CHECK(found.size() > 12);
    CHECK(to_host(found) == to_host(pairs(serial{}, plain, plain)));
    CHECK(with_edges(hulls<double>()).size() == 0);
}
