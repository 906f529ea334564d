// SPDX-License-Identifier: MIT
#pragma once

// What two solids have in common near a point of both surfaces. Near it each is a cone: all that goes from the point in some
// directions. On a sphere around the point these directions are polygons, whose corners are directions of edges, and whose
// sides are parts of great circles, shorter than half of one. Do two such polygons overlap, or one and what is outside of the
// other? The question is answered in exact numbers: signs of determinants of three differences of points, and of products of
// two cross products. Only on the host.
//
// Interiors overlap if and only if part of one's border is inside of the other, or a part of both borders has both interiors
// on one side. A border is cut by the other one into pieces. If two sides cross, pieces lie on both sides. A border without a
// point on the other one is one piece: where one of its corners is, all of it is. Any other piece begins in a point of both
// borders, where it can be told in a circle of directions around that point: there each polygon is an arc, between the way in
// and the way out of its border, and two open arcs overlap if and only if one begins in the other, or both begin alike.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_triangles.hpp>

namespace abut::detail {

/// The direction from one point to another.
template <scalar T>
struct way {
    vec3<T> from, to;
};

/// A sign that a stage may not know.
struct sign_said {
    int value;
    ABUT_HD static constexpr sign_said unknown() { return {2}; }
};

/// The sign of the determinant of three directions: positive where they turn left.
struct sign_of_three {
    static constexpr int degree = 3, points = 6;
    template <class N>
    ABUT_HD static constexpr sign_said holds(const N (&v)[18]) {
        const auto direction = [&](int i) {
            const N* const p = v + 6 * i;
            return vec3<N>{p[0], p[1], p[2]};
        };
        const auto end = [&](int i) {
            const N* const p = v + 6 * i + 3;
            return vec3<N>{p[0], p[1], p[2]};
        };
        // Named first: of braces around a call nvcc 13.0 makes code that g++ does not take.
        const int sign = sign_of_dot(cross(end(0) - direction(0), end(1) - direction(1)), end(2) - direction(2));
        return {sign};
    }
};
/// The sign of (a x b) . (c x d). Not asked in words, whose squares would not fit two.
struct sign_of_four {
    template <class N>
    ABUT_HD static constexpr sign_said holds(const N (&v)[24]) {
        const auto along = [&](int i) {
            const N* const p = v + 6 * i;
            return vec3<N>{p[3], p[4], p[5]} - vec3<N>{p[0], p[1], p[2]};
        };
        const int sign = sign_of_dot(cross(along(0), along(1)), cross(along(2), along(3)));
        return {sign};
    }
};

template <class Predicate, scalar T, std::size_t V>
int exact_sign(const row_of<T, V>& values) {
    const sign_said found = decide_in_limbs<Predicate>(values.value);
    return found.value != 2 ? found.value : decide_at_any_span<Predicate>(values.value).value;
}

/// Whether two ways are one, or one and its reverse, by their ends: then no third one turns from both.
template <scalar T>
bool are_one_line(const way<T>& a, const way<T>& b) {
    return (a.from == b.from && a.to == b.to) || (a.from == b.to && a.to == b.from);
}

/// In doubles, where that is certain; the bound is that of certified_triangles.hpp.
template <scalar T>
int turn_of(const way<T>& a, const way<T>& b, const way<T>& c) {
    if (are_one_line(a, b) || are_one_line(b, c) || are_one_line(a, c)) return 0;
    const auto row = in_a_row(a.from, a.to, b.from, b.to, c.from, c.to);
    if (!(std::same_as<T, float> && any_subnormal(row.value))) {
        const vec3<double> u = between(widened(a.from), widened(a.to)), v = between(widened(b.from), widened(b.to)),
                           w = between(widened(c.from), widened(c.to));
        const double x = magnitudes(u), y = magnitudes(v), z = magnitudes(w);
        const double turn = dot(cross(u, v), w), error = determinant_error<double> * (x * y) * z + flushed<double>;
        if (x + y + z < difference_limit<double> && absolute(turn) > error) return turn > 0 ? 1 : -1;
    }
    return exact_sign<sign_of_three>(row);
}
template <scalar T>
int product_of_turns(const way<T>& a, const way<T>& b, const way<T>& c, const way<T>& d) {
    if (are_one_line(a, b) || are_one_line(c, d)) return 0;
    const auto row = in_a_row(a.from, a.to, b.from, b.to, c.from, c.to, d.from, d.to);
    if (!(std::same_as<T, float> && any_subnormal(row.value))) {
        const auto along = [](const way<T>& w) { return between(widened(w.from), widened(w.to)); };
        const vec3<double> u = along(a), v = along(b), w = along(c), x = along(d);
        const double size = (magnitudes(u) * magnitudes(v)) * (magnitudes(w) * magnitudes(x));
        // Each component is off by 8 units of roundoff of the product of magnitudes, their products and the sum by a few more.
        const double product = dot(cross(u, v), cross(w, x));
        if (size < 0x1p800 && absolute(product) > 64 * unit_roundoff<double> * size + 0x1p-400) return product > 0 ? 1 : -1;
    }
    return exact_sign<sign_of_four>(row);
}

/// A polygon on the sphere: closed borders of directions, from each to the next a side; its inside is to their right, as seen
/// from outside of the sphere.
template <scalar T>
using solid_cone = std::vector<std::vector<way<T>>>;

/// What of two solids, or cones, is not empty.
struct common_regions {
    bool both = false, first_alone = false, second_alone = false;

    [[nodiscard]] bool all() const { return both && first_alone && second_alone; }
    common_regions& operator|=(const common_regions& other) {
        both |= other.both;
        first_alone |= other.first_alone;
        second_alone |= other.second_alone;
        return *this;
    }
};

/// Whether r is on the open side from p to q.
template <scalar T>
bool is_between(const way<T>& p, const way<T>& r, const way<T>& q) {
    return turn_of(p, q, r) == 0 && product_of_turns(p, r, p, q) > 0 && product_of_turns(r, q, p, q) > 0;
}
/// Whether two sides cross in one point, which is none of their ends.
ABUT_HD constexpr bool sides_cross(int p_of_other, int q_of_other, int r_of_other, int s_of_other) {
    return p_of_other * q_of_other < 0 && r_of_other * s_of_other < 0 && p_of_other * r_of_other < 0;
}

/// Around the direction d: whether x lies on the open arc that turns left from a to b, which is not empty.
template <scalar T>
bool is_on_arc(const way<T>& d, const way<T>& a, const way<T>& x, const way<T>& b) {
    const int whole = turn_of(d, a, b), from_a = turn_of(d, a, x), to_b = turn_of(d, x, b);
    if (whole > 0) return from_a > 0 && to_b > 0;
    if (whole == 0) return from_a > 0;  // half of a circle
    return !(to_b <= 0 && from_a <= 0);
}
/// Whether two directions are one around d.
template <scalar T>
bool are_alike_around(const way<T>& d, const way<T>& a, const way<T>& b) {
    return turn_of(d, a, b) == 0 && product_of_turns(d, a, d, b) > 0;
}
/// Whether two open arcs that turn left, from a to b and from e to f, have a direction in common.
template <scalar T>
bool arcs_overlap(const way<T>& d, const way<T>& a, const way<T>& b, const way<T>& e, const way<T>& f) {
    return is_on_arc(d, a, e, b) || is_on_arc(d, e, a, f) || are_alike_around(d, a, e);
}

/// Whether a direction that is on no border is inside of a cone. From it some corner can be seen: there the cone is an arc.
template <scalar T>
bool is_in_cone(const way<T>& u, const solid_cone<T>& cone) {
    const auto is_hidden = [&](const way<T>& p) {
        for (const auto& border : cone) {
            for (std::size_t k = 0; k < border.size(); ++k) {
                const way<T>&r = border[k], &s = border[(k + 1) % border.size()];
                if (is_between(u, r, p)) return true;
                if (sides_cross(turn_of(r, s, u), turn_of(r, s, p), turn_of(u, p, r), turn_of(u, p, s))) return true;
            }
        }
        return false;
    };
    for (const auto& border : cone) {
        for (std::size_t k = 0; k < border.size(); ++k) {
            const way<T>& p = border[k];
            if (product_of_turns(u, p, u, p) == 0 || is_hidden(p)) continue;
            return is_on_arc(p, border[k == 0 ? border.size() - 1 : k - 1], u, border[(k + 1) % border.size()]);
        }
    }
    return false;
}

/// What two cones of one apex have in common, and what each has alone.
template <scalar T>
common_regions regions_of_cones(const solid_cone<T>& a, const solid_cone<T>& b) {
    /// A direction on a border: where it comes from and goes to.
    struct passing {
        const way<T>*in, *at, *out;
    };
    common_regions found;
    std::vector<char> touched_a(a.size(), 0), touched_b(b.size(), 0);
    const auto compare = [&](const passing& p, const passing& q) {
        const way<T>& d = *p.at;
        found.both |= arcs_overlap(d, *p.in, *p.out, *q.in, *q.out);
        found.first_alone |= arcs_overlap(d, *p.in, *p.out, *q.out, *q.in);
        found.second_alone |= arcs_overlap(d, *p.out, *p.in, *q.in, *q.out);
    };
    for (std::size_t l = 0; l < a.size(); ++l) {
        const std::size_t n = a[l].size();
        for (std::size_t i = 0; i < n; ++i) {
            const way<T>&before = a[l][i == 0 ? n - 1 : i - 1], &p = a[l][i], &q = a[l][(i + 1) % n];
            for (std::size_t k = 0; k < b.size(); ++k) {
                const std::size_t m = b[k].size();
                for (std::size_t j = 0; j < m; ++j) {
                    const way<T>&previous = b[k][j == 0 ? m - 1 : j - 1], &r = b[k][j], &s = b[k][(j + 1) % m];
                    const int p_of = turn_of(r, s, p), r_of = turn_of(p, q, r);
                    if (p_of != 0 && r_of != 0) {
                        if (sides_cross(p_of, turn_of(r, s, q), r_of, turn_of(p, q, s))) return {true, true, true};
                        continue;
                    }
                    bool meets = false;
                    if (p_of == 0 && product_of_turns(p, s, r, s) > 0) {
                        const int from_r = product_of_turns(r, p, r, s);
                        if (from_r == 0) compare({&before, &p, &q}, {&previous, &r, &s});
                        if (from_r > 0) compare({&before, &p, &q}, {&r, &p, &s});
                        meets = from_r >= 0;
                    }
                    if (r_of == 0 && is_between(p, r, q)) {
                        compare({&p, &r, &q}, {&previous, &r, &s});
                        meets = true;
                    }
                    if (meets) touched_a[l] = touched_b[k] = 1;
                    if (found.all()) return found;
                }
            }
        }
    }
    for (std::size_t l = 0; l < a.size(); ++l) {
        if (touched_a[l] != 0) continue;
        const bool is_in = is_in_cone(a[l][0], b);
        found |= is_in ? common_regions{true, false, true} : common_regions{false, true, false};
    }
    for (std::size_t k = 0; k < b.size(); ++k) {
        if (touched_b[k] != 0) continue;
        const bool is_in = is_in_cone(b[k][0], a);
        found |= is_in ? common_regions{true, true, false} : common_regions{false, false, true};
    }
    return found;
}

}  // namespace abut::detail
