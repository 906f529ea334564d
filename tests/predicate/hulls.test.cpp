// SPDX-License-Identifier: MIT
#include "support/hulls.hpp"

#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

// The oracle for hulls is checked too, by brute force: hulls meet if and only if the origin is in the hull of all
// differences a_i - b_j, and so in the interior of a simplex of at most four of them (Caratheodory).

namespace {

using namespace abut;
using small_point = vec3<std::int64_t>;
using points = std::vector<small_point>;

std::int64_t volume(const small_point& p, const small_point& q, const small_point& r) { return dot(p, cross(q, r)); }
bool none(const small_point& p) { return p == small_point{0, 0, 0}; }
bool has_sign(std::int64_t x, bool negative) { return negative ? x < 0 : x > 0; }

/// The origin strictly between both
bool inside(const small_point& p, const small_point& q) { return none(cross(p, q)) && dot(p, q) < 0; }

/// In the plane of all three, with positive areas of one orientation
bool inside(const small_point& p, const small_point& q, const small_point& r) {
    const small_point pq = cross(p, q), qr = cross(q, r), rp = cross(r, p);
    return volume(p, q, r) == 0 && dot(pq, qr) > 0 && dot(qr, rp) > 0;
}

/// With positive volumes of one orientation
bool inside(const small_point& p, const small_point& q, const small_point& r, const small_point& s) {
    const std::int64_t v = volume(q, r, s);
    return v != 0 && has_sign(-volume(p, r, s), v < 0) && has_sign(volume(p, q, s), v < 0) &&
           has_sign(-volume(p, q, r), v < 0);
}

bool origin_inside(const points& x) {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (none(x[i])) return true;
        for (std::size_t j = 0; j < i; ++j) {
            if (inside(x[i], x[j])) return true;
            for (std::size_t k = 0; k < j; ++k) {
                if (inside(x[i], x[j], x[k])) return true;
                for (std::size_t l = 0; l < k; ++l) {
                    if (inside(x[i], x[j], x[k], x[l])) return true;
                }
            }
        }
    }
    return false;
}

bool meet_by_force(const points& a, const points& b) {
    points differences;
    for (const small_point& p : a) {
        for (const small_point& q : b) differences.push_back(p - q);
    }
    return origin_inside(differences);
}

std::vector<test::integer_point> widened(const points& x) {
    std::vector<test::integer_point> r;
    for (const small_point& p : x) r.push_back({p.x, p.y, p.z});
    return r;
}

/// An integer of up to `bits` bits, or its negative
test::integer draw_integer(test::draws& d, int bits) {
    test::integer x = 0;
    for (int i = 0; i < bits; i += 64) x = (x << 64) + d.bits();
    x >>= (bits + 63) / 64 * 64 - bits;
    if (d.below(2) == 0) x = -x;
    return x;
}

/// An affine map with entries of `bits` bits. It is invertible, so hulls meet as before, in numbers as wide as one likes.
std::vector<test::integer_point> mapped(const points& x, int bits, test::draws& d) {
    test::integer_point m[3], to;
    do {
        for (test::integer_point* row : {&m[0], &m[1], &m[2], &to}) {
            for (test::integer* e : {&row->x, &row->y, &row->z}) *e = draw_integer(d, bits);
        }
    } while (inner(m[0], {m[1].y * m[2].z - m[1].z * m[2].y, m[1].z * m[2].x - m[1].x * m[2].z,
                          m[1].x * m[2].y - m[1].y * m[2].x}) == 0);
    std::vector<test::integer_point> r;
    for (const test::integer_point& p : widened(x))
        r.push_back({inner(m[0], p) + to.x, inner(m[1], p) + to.y, inner(m[2], p) + to.z});
    return r;
}

points draw_points(test::draws& d, int most, int size) {
    points r(static_cast<std::size_t>(1 + d.below(most)));
    for (small_point& p : r) {
        const int x = d.below(size + 1), y = d.below(size + 1), z = d.below(size + 1);
        p = {x, y, z};
    }
    return r;
}

}  // namespace

TEST_CASE("hulls: all pairs of triangles on the corners of a cube") {
    const auto corner = [](int i) { return small_point{i & 1, i >> 1 & 1, i >> 2}; };
    std::uint64_t pairs = 0, hits = 0, wrong = 0;
    for (int s = 0; s < 512; ++s) {
        for (int t = 0; t < 512; ++t) {
            const points a{corner(s & 7), corner(s >> 3 & 7), corner(s >> 6)},
                b{corner(t & 7), corner(t >> 3 & 7), corner(t >> 6)};
            const bool truth = meet_by_force(a, b);
            ++pairs;
            hits += truth;
            wrong += test::hulls_meet(widened(a), widened(b)) != truth;
        }
    }
    std::printf("hulls: %llu pairs of triangles, %llu hits\n", static_cast<unsigned long long>(pairs),
                static_cast<unsigned long long>(hits));
    CHECK(hits * 10 > pairs);
    CHECK(hits * 10 < 9 * pairs);
    CHECK(wrong == 0);
}

TEST_CASE("hulls: up to 6 points against up to 4 on small lattices, in every number type") {
    std::uint64_t pairs = 0, hits = 0, wrong = 0;
    for (std::uint64_t k = 0; k < 4 * test::sample_count(); ++k) {
        test::draws d(test::sample_seed, 8, k);
        const int size = 1 + d.below(6);
        const points a = draw_points(d, 6, size), b = draw_points(d, 4, size);
        const bool truth = meet_by_force(a, b);
        ++pairs;
        hits += truth;
        wrong += test::hulls_meet(widened(a), widened(b)) != truth;
        wrong += test::linear_program<boost::multiprecision::int512_t>(widened(a), widened(b)).feasible() != truth;
        wrong += test::linear_program<test::integer>(widened(b), widened(a)).feasible() != truth;
        // Both must be mapped alike, so as one list; to widths around each change of the number type, and far beyond.
        int bits = 10 + d.below(24);
        if (d.below(2) == 0) bits += 64;
        if (k % 16 == 0) bits *= 16;
        points both = a;
        both.insert(both.end(), b.begin(), b.end());
        const auto moved = mapped(both, bits, d);
        const auto middle = moved.begin() + static_cast<std::ptrdiff_t>(a.size());
        wrong += test::hulls_meet({moved.begin(), middle}, {middle, moved.end()}) != truth;
    }
    std::printf("hulls: %llu pairs of point sets, seed %llu, %llu hits\n", static_cast<unsigned long long>(pairs),
                static_cast<unsigned long long>(test::sample_seed), static_cast<unsigned long long>(hits));
    CHECK(hits * 10 > pairs);
    CHECK(hits * 10 < 9 * pairs);
    CHECK(wrong == 0);
}

TEST_CASE("hulls: boxes against triangles") {
    std::uint64_t pairs = 0, hits = 0, wrong = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 4; ++k) {
        test::draws d(test::sample_seed, 9, k);
        points ends = draw_points(d, 1, 4), t(3);
        ends.push_back(ends[0] + small_point{d.below(3), d.below(3), d.below(3)});
        points box;
        for (std::size_t i = 0; i < 8; ++i) box.push_back({ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z});
        for (small_point& p : t) p = draw_points(d, 1, 6)[0];
        const bool truth = meet_by_force(box, t);
        ++pairs;
        hits += truth;
        wrong += test::hulls_meet(widened(box), widened(t)) != truth;
        wrong += test::hulls_meet(widened(t), widened(box)) != truth;
    }
    std::printf("hulls: %llu boxes and triangles, seed %llu, %llu hits\n", static_cast<unsigned long long>(pairs),
                static_cast<unsigned long long>(test::sample_seed), static_cast<unsigned long long>(hits));
    CHECK(hits * 10 > pairs);
    CHECK(hits * 10 < 9 * pairs);
    CHECK(wrong == 0);
}
