// SPDX-License-Identifier: MIT

// Shapes from outside: the solid cylinder of docs/examples, whose exact answers are checked against clipping in rationals,
// and a small shape without a template, in a view of its own. Neither is in the library's namespace. Queries with them,
// indexed on either side, say what a plain loop over intersects<exact> says.

#include "../../docs/examples/cylinder.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace stones {

/// A ball by another name: what it answers is the library's word on spheres.
struct pebble {
    using scalar_type = float;
    abut::vec3<float> at;
    float size;

    [[nodiscard]] constexpr abut::sphere<float> ball() const { return {at, size}; }
};

constexpr abut::aabb<float> bounds(const pebble& p) { return abut::bounds(p.ball()); }
constexpr pebble place(const abut::rigid<float>& pose, const pebble& p) { return {abut::place(pose, p.at), p.size}; }

template <abut::arithmetic A>
constexpr abut::verdict decide(const pebble& p, const abut::triangle<float>& t) {
    return abut::decide<A>(p.ball(), t);
}
constexpr bool resolve(const pebble& p, const abut::triangle<float>& t) { return abut::resolve(p.ball(), t); }

/// Two pebbles, in one order that is the other as well.
template <abut::arithmetic A>
constexpr abut::verdict decide(const pebble& p, const pebble& q) {
    return abut::decide<A>(p.ball(), q.ball());
}
constexpr bool resolve(const pebble& p, const pebble& q) { return abut::resolve(p.ball(), q.ball()); }

/// Pebbles on a lattice, which are nowhere in memory.
struct heap {
    using scalar_type = float;
    using shape_type = pebble;
    using memory_space = abut::host_space;

    std::size_t side;
    float size_of_each;

    [[nodiscard]] std::size_t size() const { return side * side * side; }
    pebble operator[](std::size_t i) const {
        return {{static_cast<float>(i % side), static_cast<float>(i / side % side), static_cast<float>(i / side / side)},
                size_of_each};
    }
};

}  // namespace stones

namespace {

using namespace abut;
template <scalar T>
using pillar = plant::cylinder<T>;  // abut has a cylinder of its own
using pair_list = std::vector<index_pair>;

static_assert(shape<pillar<float>> && shape<pillar<double>> && !placeable<pillar<float>>);
static_assert(decidable_pair<pillar<float>, triangle<float>> && !decidable_pair<triangle<float>, pillar<float>>);
static_assert(!decidable_pair<pillar<float>, triangle<double>> && !decidable_pair<pillar<float>, sphere<float>>);
static_assert(placeable<stones::pebble> && shape_view<stones::heap> && decidable_pair<stones::pebble, stones::pebble>);
static_assert(intersects(pillar<float>{{0, 0, 0}, 1, 2}, triangle<float>{{1, -1, 1}, {1, 1, 1}, {3, 0, 1}}));

// --- the oracle: clips the triangle to the pillar's heights, and measures what is left from above, in rationals
// ------------

using rational = boost::multiprecision::cpp_rational;

struct rational_point {
    rational x, y, z;
};

/// The part of a polygon with sign * (z - height) >= 0.
std::vector<rational_point> clipped(const std::vector<rational_point>& polygon, const rational& height, int sign) {
    std::vector<rational_point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const rational_point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const rational over_p = sign * (p.z - height), over_q = sign * (q.z - height);
        if (over_p >= 0) kept.push_back(p);
        if ((over_p < 0 && over_q > 0) || (over_p > 0 && over_q < 0)) {
            const rational t = over_p / (over_p - over_q);
            kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), height});
        }
    }
    return kept;
}

/// Whether the polygon, seen from above, has a point within sqrt(square) of the origin.
bool reaches(const std::vector<rational_point>& polygon, const rational& square) {
    int left = 0, right = 0;
    rational area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const rational_point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const rational dx = q.x - p.x, dy = q.y - p.y, length = dx * dx + dy * dy;
        rational t = 0;
        if (length > 0) t = std::clamp<rational>(-(p.x * dx + p.y * dy) / length, 0, 1);
        const rational x = p.x + t * dx, y = p.y + t * dy;
        if (x * x + y * y <= square) return true;
        const rational turn = p.x * q.y - p.y * q.x;
        area += turn;
        left += turn > 0;
        right += turn < 0;
    }
    return area != 0 && (left == 0 || right == 0);
}

template <class T>
bool oracle(const pillar<T>& c, const triangle<T>& t) {
    std::vector<rational_point> polygon;
    for (const vec3<T>& p : {t.a, t.b, t.c}) {
        polygon.push_back(
            {rational(p.x) - rational(c.foot.x), rational(p.y) - rational(c.foot.y), rational(p.z) - rational(c.foot.z)});
    }
    polygon = clipped(clipped(polygon, 0, 1), rational(c.height), -1);
    return reaches(polygon, rational(c.radius) * rational(c.radius));
}

struct tally {
    std::size_t hits = 0, misses = 0, filtered_out = 0;

    template <class T>
    void compare(const pillar<T>& c, const triangle<T>& t) {
        const bool expected = oracle(c, t);
        (expected ? hits : misses) += 1;
        const verdict filter = decide<filtered>(c, t);
        filtered_out += filter != verdict::unknown;
        const bool right = intersects<exact>(c, t) == expected && intersects(t, c) == expected &&
                           resolve(c, t) == expected && (filter == verdict::unknown || (filter == verdict::yes) == expected);
        if (right) return;
        CAPTURE(c.foot.x, c.foot.y, c.foot.z, c.radius, c.height, t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y,
                t.c.z, expected);
        CHECK(right);
    }
};

/// Small whole numbers: sides on the wall, corners on the rim, triangles in the ends, and all kinds of degenerate ones.
template <class T>
void check_on_lattice(int count, tally& sum) {
    test::uniform random(41);
    const auto whole = [&](int from, int to) {
        return static_cast<T>(from + static_cast<int>(random.below(std::size_t(to - from + 1))));
    };
    for (int i = 0; i < count; ++i) {
        const auto point = [&] { return vec3<T>{whole(-6, 6), whole(-6, 6), whole(-4, 4)}; };
        const pillar<T> c{{whole(-1, 1), whole(-1, 1), whole(-1, 0)}, whole(0, 5), whole(0, 3)};
        triangle<T> t{point(), point(), point()};
        if (i % 5 == 0) t.b = t.a;
        if (i % 7 == 0) t.c = {t.b.x, t.b.y, whole(-4, 4)};  // upright
        if (i % 11 == 0) t.b.z = t.c.z = t.a.z = c.foot.z + (i % 2 == 0 ? c.height : T(0));
        sum.compare(c, t);
    }
}

template <class T>
void check_at_random(int count, double scale, tally& sum) {
    test::uniform random(43);
    for (int i = 0; i < count; ++i) {
        const auto point = [&] {
            const vec3<T> p = random.point<T>(-3, 3);
            return vec3<T>{static_cast<T>(p.x * scale), static_cast<T>(p.y * scale), static_cast<T>(p.z * scale)};
        };
        const pillar<T> c{point(), static_cast<T>(random(0, 2) * scale), static_cast<T>(random(0, 3) * scale)};
        sum.compare(c, triangle<T>{point(), point(), point()});
    }
}

// --- queries --------------------------------------------------------------------------------------------------------------

template <class X, class Y>
pair_list truth(const X& a, const Y& b) {
    pair_list touching;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (intersects<exact>(a[i], b[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Indexed on either side, on both and on neither.
template <class Policy, class X, class Y>
std::size_t check_queries(const Policy& on, const X& a, const Y& b) {
    const pair_list expected = truth(detail::view_of(a), detail::view_of(b));
    CHECK(to_host(pairs(on, a, b)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, a), b)) == expected);
    CHECK(to_host(pairs<exact>(on, a, make_bvh(on, b))) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, a), make_bvh(on, b))) == expected);
    CHECK(to_host(pairs(on, make_grid(on, a), b)) == expected);
    CHECK(to_host(pairs(on, a, make_grid(on, b))) == expected);
    CHECK(any(on, a, b) == !expected.empty());
    CHECK(count(on, b, a) == expected.size());
    return expected.size();
}

template <class T>
std::vector<pillar<T>> random_cylinders(std::size_t n, test::uniform& random) {
    std::vector<pillar<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> foot = random.point<T>(-1, 1);
        all.push_back({foot, static_cast<T>(random(0, 0.3)), static_cast<T>(i % 9 == 0 ? 0 : random(0, 0.8))});
    }
    return all;
}

template <class T, class Policy>
void check_cylinders(const Policy& on) {
    test::uniform random(47);
    const shapes<pillar<T>> pillars(random_cylinders<T>(150, random));
    const triangle_soup<T> soup(test::random_triangles<T>(200, random));
    CHECK(check_queries(on, pillars, soup) > 200);
    const test::torus<T> ring(16, 8, 0.6, 0.3);
    CHECK(check_queries(on, mesh<T>(ring.vertices, ring.faces), pillars) > 100);
    // One pillar, and the caller's own array of them.
    const pillar<T> one{{0, 0, T(-0.5)}, T(0.5), 1};
    pair_list with_one;
    for (const index_pair& p : truth(soup.view(), single_view<pillar<T>>{one})) with_one.push_back(p);
    CHECK(with_one.size() > 10);
    CHECK(to_host(pairs(on, soup, one)) == with_one);
    CHECK(to_host(pairs(on, make_bvh(on, soup), one)) == with_one);
    struct tree {
        int age;
        pillar<T> stem;
    };
    std::vector<tree> forest;
    for (const pillar<T>& c : random_cylinders<T>(40, random)) forest.push_back({7, c});
    const shapes_view<pillar<T>> stems(&forest[0].stem, forest.size(), sizeof(tree));
    CHECK(to_host(pairs(on, soup, make_bvh(on, stems))) == truth(soup.view(), stems));
}

}  // namespace

TEMPLATE_TEST_CASE("extending: a solid pillar's answers are exact", "", float, double) {
    std::printf("pillars against triangles: seeds 41, 43\n");
    tally lattice, random;
    check_on_lattice<TestType>(20'000, lattice);
    check_at_random<TestType>(3'000, 1, random);
    check_at_random<TestType>(500, 1e-30, random);
    check_at_random<TestType>(500, 1e30, random);
    CHECK(lattice.hits > 5'000);
    CHECK(lattice.misses > 5'000);
    CHECK(random.hits > 500);
    CHECK(random.misses > 500);
    CHECK(random.filtered_out > 50);
    // Exponents too far apart for integers of fixed width.
    constexpr TestType huge = std::numeric_limits<TestType>::max() / 4, tiny = std::numeric_limits<TestType>::denorm_min();
    tally wide;
    for (int i = -2; i <= 2; ++i) {
        const TestType k = static_cast<TestType>(i) * tiny;
        wide.compare(pillar<TestType>{{0, 0, 0}, tiny, huge}, {{k, -huge, 1}, {k, huge, 1}, {k, 0, 1}});
        wide.compare(pillar<TestType>{{0, 0, 0}, huge, tiny}, {{huge, -huge, k}, {huge, huge, k}, {huge * 2, 0, k}});
        wide.compare(pillar<TestType>{{0, 0, 0}, tiny, tiny}, {{-huge, k, -huge}, {huge, k, huge}, {0, huge, 0}});
    }
    CHECK(wide.hits >= 5);
    CHECK(wide.misses >= 5);
}

TEST_CASE("extending: pillars in queries, serial") { check_cylinders<double>(serial{}); }

TEST_CASE("extending: pillars in queries, openmp") {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        check_cylinders<float>(openmp{.threads = threads});
    }
}

TEST_CASE("extending: a view of one's own, posed shapes, and shapes of one kind among themselves") {
    const openmp on{.threads = 2};
    test::uniform random(53);
    const stones::heap heap{6, 0.5f};  // neighbours touch
    const auto soup_at = [&](std::size_t n) {
        std::vector<triangle<float>> triangles = test::random_triangles<float>(n, random);
        for (triangle<float>& t : triangles) t = {5.0f * t.a, 5.0f * t.b, 5.0f * t.c};
        return triangle_soup<float>(triangles);
    };
    const triangle_soup<float> soup = soup_at(300);
    CHECK(check_queries(on, heap, soup) > 100);
    CHECK(check_queries(on, heap, heap) == 216 + 2 * 3 * 5 * 36);
    rigid<float> pose;
    pose.rotation[0] = pose.rotation[4] = 0.6f;
    pose.rotation[1] = -0.8f;
    pose.rotation[3] = 0.8f;
    pose.translation = {-1, 2, 0.25f};
    const posed_view<stones::heap> placed{heap, pose};
    const pair_list expected = truth(placed, soup.view());
    CHECK(expected.size() > 50);
    CHECK(to_host(pairs(on, posed(heap, pose), soup)) == expected);
    CHECK(to_host(pairs(on, posed(make_bvh(on, heap), pose), make_bvh(on, soup))) == expected);
    const stones::pebble one{{2, 2, 2}, 1.5f};
    pair_list of_one;
    for (std::uint32_t j = 0; j < soup.size(); ++j) {
        if (intersects<exact>(place(pose, one), soup.view()[j])) of_one.push_back({0, j});
    }
    CHECK(!of_one.empty());
    CHECK(to_host(pairs(on, posed(one, pose), soup)) == of_one);
    CHECK(to_host(pairs(on, posed(one, pose), make_bvh(on, soup))) == of_one);
    CHECK_THROWS_WITH(any(on, soup, stones::pebble{{0, 0, 0}, -1}), "abut::any: shape 0: lower x is above upper x (1)");
    pose.translation.x = std::numeric_limits<float>::max();
    CHECK_THROWS_WITH(any(on, posed(stones::pebble{{0, 0, 0}, std::numeric_limits<float>::max()}, pose), soup),
                      "abut::any: posed shape 0: x is not finite (inf)");
}

TEST_CASE("extending: a pillar that is none is refused by its own is_valid") {
    const std::vector<pillar<float>> bad{{{0, 0, 0}, 1, 1}, {{3, 0, 0}, 1, -1}};
    CHECK_THROWS_WITH(shapes<pillar<float>>(bad), "abut::shapes: shape 1: lower z is above upper z (0)");
    CHECK_THROWS_AS(make_grid(serial{}, pillar<double>{{0, 0, 0}, -1, 1}), invalid_geometry);
}
