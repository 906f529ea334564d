// SPDX-License-Identifier: MIT
#pragma once

// The oracle for shapes that go along vectors, in rationals. It shares no formula with the library: the point of a hull that
// is nearest to the origin is found by the algorithm of Wolfe (Finding the nearest point in a polytope, 1976) on Gram
// matrices, and is proven each time by the condition that no corner lies back from it.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/predicate/hull_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::test {

using rational = boost::multiprecision::cpp_rational;
struct rational_point {
    rational x, y, z;
};
inline rational inner(const rational_point& a, const rational_point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline rational_point difference(const rational_point& a, const rational_point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <scalar T>
rational_point to_rational(const vec3<T>& p) {
    return {rational(p.x), rational(p.y), rational(p.z)};
}

/// Solves a linear system by elimination; false where it is singular.
inline bool solved(std::vector<std::vector<rational>> m, std::vector<rational>& x) {
    const std::size_t n = m.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        while (pivot < n && m[pivot][k] == 0) ++pivot;
        if (pivot == n) return false;
        std::swap(m[k], m[pivot]);
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k || m[i][k] == 0) continue;
            const rational f = m[i][k] / m[k][k];
            for (std::size_t j = k; j <= n; ++j) m[i][j] -= f * m[k][j];
        }
    }
    x.resize(n);
    for (std::size_t k = 0; k < n; ++k) x[k] = m[k][n] / m[k][k];
    return true;
}

/// The square of the distance of a hull of points from the origin; negative if no proof was found, which fails every test.
inline rational least_square(const std::vector<rational_point>& p) {
    std::vector<std::size_t> support{0};
    std::vector<rational> weight{1};
    for (int step = 0; step < 1000; ++step) {
        rational_point x{0, 0, 0};
        for (std::size_t k = 0; k < support.size(); ++k) {
            const rational_point& q = p[support[k]];
            x = {x.x + weight[k] * q.x, x.y + weight[k] * q.y, x.z + weight[k] * q.z};
        }
        const rational square = inner(x, x);
        std::size_t back = 0;
        rational least = inner(x, p[0]);
        for (std::size_t i = 1; i < p.size(); ++i) {
            const rational here = inner(x, p[i]);
            if (here < least) least = here, back = i;
        }
        if (least >= square) return square;
        support.push_back(back);
        weight.push_back(0);
        for (;;) {
            const std::size_t n = support.size();
            std::vector<std::vector<rational>> m(n + 1, std::vector<rational>(n + 2));
            for (std::size_t i = 0; i < n; ++i) {
                for (std::size_t j = 0; j < n; ++j) m[i][j] = inner(p[support[i]], p[support[j]]);
                m[i][n] = m[n][i] = 1;
            }
            m[n][n + 1] = 1;
            std::vector<rational> w;
            if (!solved(m, w)) return -1;
            w.pop_back();
            rational share = 1;
            for (std::size_t i = 0; i < n; ++i) {
                if (w[i] <= 0 && weight[i] - w[i] > 0) share = std::min(share, rational(weight[i] / (weight[i] - w[i])));
            }
            bool dropped = false;
            std::vector<std::size_t> left;
            std::vector<rational> of_left;
            for (std::size_t i = 0; i < n; ++i) {
                const rational here = weight[i] + share * (w[i] - weight[i]);
                if (here <= 0) {
                    dropped = true;
                    continue;
                }
                left.push_back(support[i]);
                of_left.push_back(here);
            }
            support = left, weight = of_left;
            if (!dropped) break;
        }
    }
    return -1;
}

/// Whether a point is no farther from a shape than `near`.
template <scalar T, class S>
bool is_near(const vec3<T>& p, const S& s, const rational& near) {
    const auto core = detail::core_points_of(s);
    std::vector<rational_point> seen;
    for (std::size_t i = 0; i < core.as_hull().count; ++i) seen.push_back(difference(to_rational(core.as_hull()[i]), to_rational(p)));
    const rational square = least_square(seen), reach = near + rational(detail::radius_around_core(s));
    return square >= 0 && square <= reach * reach;
}

/// Whether a time is the first one at which an oracle says that shapes have touched, rounded to the nearest double, of two as near to
/// the lesser; negative for none.
template <class Oracle>
bool is_first_time(const Oracle& oracle, double time) {
    if (!(time >= 0)) return !oracle.touched_by(1);
    if (time == 0) return oracle.touched_by(0);
    if (time > 1 || !oracle.touched_by(1) || oracle.touched_by(0)) return false;
    const double before = std::nextafter(time, 0.0), after = std::nextafter(time, 2.0);
    const rational low = (rational(before) + rational(time)) / 2, high = (rational(time) + rational(after)) / 2;
    return oracle.touched_by(high) && !oracle.touched_by(low);
}

/// Two shapes, one of which goes along a way.
class sweep_oracle {
public:
    template <class S, class U, scalar T>
    sweep_oracle(const S& s, const U& t, const vec3<T>& way)
        : way_(to_rational(way)),
          r_(rational(detail::radius_around_core(s)) + rational(detail::radius_around_core(t))) {
        const auto a = detail::core_points_of(s);
        const auto b = detail::core_points_of(t);
        for (std::size_t i = 0; i < a.as_hull().count; ++i) {
            for (std::size_t j = 0; j < b.as_hull().count; ++j) {
                differences_.push_back(difference(to_rational(b.as_hull()[j]), to_rational(a.as_hull()[i])));
            }
        }
    }
    [[nodiscard]] bool touched_by(const rational& time) const {
        std::vector<rational_point> all = differences_;
        const rational_point gone{time * way_.x, time * way_.y, time * way_.z};
        for (const rational_point& d : differences_) all.push_back(difference(d, gone));
        const rational square = least_square(all);
        if (square < 0) throw "the oracle has no proof";
        return square <= r_ * r_;
    }
    [[nodiscard]] bool is_first(double time) const { return is_first_time(*this, time); }

private:
    rational_point way_;
    rational r_;
    std::vector<rational_point> differences_;
};

/// A shape that goes along a way, and a plane or the half space below it. The core's points at both ends are the corners of what it
/// has passed. A ball around one of them reaches the plane if the foot of its centre there is not farther than the radius.
class flat_oracle {
public:
    template <class S, scalar T>
    flat_oracle(const S& s, const vec3<T>& way, const vec3<T>& normal, T offset, bool is_solid)
        : way_(to_rational(way)), normal_(to_rational(normal)), offset_(offset), r_(detail::radius_around_core(s)), is_solid_(is_solid) {
        const auto core = detail::core_points_of(s);
        for (std::size_t i = 0; i < core.as_hull().count; ++i) points_.push_back(to_rational(core.as_hull()[i]));
    }
    [[nodiscard]] bool touched_by(const rational& time) const {
        bool over = false, under = false;
        for (const rational& t : {rational(0), time}) {
            for (const rational_point& p : points_) {
                const rational_point at{p.x + t * way_.x, p.y + t * way_.y, p.z + t * way_.z};
                const rational height = inner(normal_, at) - offset_, square = inner(normal_, normal_);
                (height > 0 ? over : under) = true;
                if (height == 0) return true;
                if (square == 0) continue;
                const rational share = height / square;
                const rational_point foot{share * normal_.x, share * normal_.y, share * normal_.z};
                if (inner(foot, foot) <= r_ * r_) return true;
            }
        }
        return is_solid_ ? under : over && under;
    }
    [[nodiscard]] bool is_first(double time) const { return is_first_time(*this, time); }

private:
    rational_point way_, normal_;
    rational offset_, r_;
    bool is_solid_;
    std::vector<rational_point> points_;
};

}  // namespace abut::test
