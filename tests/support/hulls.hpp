// SPDX-License-Identifier: MIT
#pragma once

// The oracle for shapes that are hulls of points (triangles, segments, boxes), in unbounded integers: do two hulls share a
// point? It is a linear program, solved by the simplex method, and knows nothing of planes, normals or sides. Any number of
// points on either side, coinciding, collinear and coplanar ones too.
//
// The program. With l, m >= 0 the hulls share a point where
//     sum over i > 0 of l_i (a_i - a_0) + sum over j > 0 of m_j (b_0 - b_j) = b_0 - a_0
//     l_0 + sum l_i = 1,   m_0 + sum m_j = 1.
// It starts at l_0 = m_0 = 1 with one artificial variable for each coordinate, and lowers the sum of these: the hulls meet
// if and only if that sum reaches 0. Bland's rule (the lowest number enters, and of equals the lowest leaves) ends for every
// input, however degenerate (R. G. Bland, New finite pivoting rules for the simplex method, 1977).
//
// The numbers. Entries are kept as integers over one common denominator, the last pivot: each is then a minor of the first
// tableau, so that each division by the previous denominator leaves no remainder (J. Edmonds, Systems of distinct
// representatives and linear algebra, 1967; E. Bareiss, 1968), and their size has a bound. A minor has at most three rows of
// coordinates, below C, and two of -1, 0 and 1: expanded by the latter it is a sum of at most 10 determinants of degree 3,
// each below 5.2 C^3 (Hadamard). So entries are below 2^6 C^3, and differences of their products below 2^13 C^6.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <abut/arithmetic/wide_int.hpp>
#include <abut/shape/primitive.hpp>

#include "rational.hpp"

namespace abut::test {

/// The program above in the number type N, which need not be bounded but must hold what is said there.
template <class N>
class linear_program {
public:
    /// Neither list is empty. Coordinates may exceed N; differences may not.
    linear_program(const std::vector<integer_point>& a, const std::vector<integer_point>& b)
        : width_(a.size() + b.size() - 1), cells_(rows * width_) {
        for (std::size_t i = 1; i < a.size(); ++i) append(a[i], a[0], 1, 0);
        for (std::size_t j = 1; j < b.size(); ++j) append(b[0], b[j], 0, 1);
        const std::size_t last = width_ - 1;
        set_column(last, b[0], a[0], 1, 1);
        for (std::size_t r = 0; r < 3; ++r) {
            if (!(cell(r, last) < 0)) continue;
            for (std::size_t j = 0; j < width_; ++j) cell(r, j) = -cell(r, j);
        }
    }

    bool feasible() {
        for (;;) {
            if (artificial_sum(width_ - 1) == 0) return true;
            const std::size_t column = entering();
            if (column == nowhere) return false;
            pivot(leaving(column), column);
        }
    }

private:
    static constexpr std::size_t rows = 5, nowhere = ~std::size_t{0};

    N& cell(std::size_t r, std::size_t j) { return cells_[r * width_ + j]; }

    void set_column(std::size_t j, const integer_point& to, const integer_point& from, int l, int m) {
        cell(0, j) = to_number<N>(to.x - from.x);
        cell(1, j) = to_number<N>(to.y - from.y);
        cell(2, j) = to_number<N>(to.z - from.z);
        cell(3, j) = l;
        cell(4, j) = m;
    }

    void append(const integer_point& to, const integer_point& from, int l, int m) {
        set_column(outside_.size(), to, from, l, m);
        outside_.push_back(static_cast<int>(outside_.size()));
    }

    static bool artificial(int variable) { return variable < -2; }

    /// The part of a column that belongs to artificial variables, added up.
    N artificial_sum(std::size_t j) {
        N sum = 0;
        for (std::size_t r = 0; r < rows; ++r) {
            if (artificial(basis_[r])) sum += cell(r, j);
        }
        return sum;
    }

    /// The lowest of the variables whose growth lowers the artificial ones' sum.
    std::size_t entering() {
        std::size_t best = nowhere;
        for (std::size_t j = 0; j < outside_.size(); ++j) {
            if (best != nowhere && outside_[best] < outside_[j]) continue;
            if (artificial_sum(j) > 0) best = j;
        }
        return best;
    }

    /// The row that first reaches 0 as the variable of column j grows. There is one: see `entering`.
    std::size_t leaving(std::size_t j) {
        const std::size_t last = width_ - 1;
        std::size_t best = nowhere;
        for (std::size_t r = 0; r < rows; ++r) {
            if (!(cell(r, j) > 0)) continue;
            if (best != nowhere) {
                const N x = cell(r, last) * cell(best, j), y = cell(best, last) * cell(r, j);
                if (y < x || (y == x && basis_[best] < basis_[r])) continue;
            }
            best = r;
        }
        return best;
    }

    /// Variable outside_[s] takes the place of basis_[r], whose column then stands where its own was.
    void pivot(std::size_t r, std::size_t s) {
        const N p = cell(r, s);
        for (std::size_t i = 0; i < rows; ++i) {
            if (i == r) continue;
            const N factor = cell(i, s);
            for (std::size_t j = 0; j < width_; ++j) {
                if (j == s || (j >= outside_.size() && j + 1 != width_)) continue;
                N x = cell(i, j) * p;
                if (factor != 0) x -= factor * cell(r, j);
                if (denominator_ != 1) x /= denominator_;
                cell(i, j) = x;
            }
            cell(i, s) = -factor;
        }
        cell(r, s) = denominator_;
        denominator_ = p;
        std::swap(basis_[r], outside_[s]);
        if (artificial(outside_[s])) {  // it has served, and never comes back
            for (std::size_t i = 0; i < rows; ++i) cell(i, s) = cell(i, outside_.size() - 1);
            outside_[s] = outside_.back();
            outside_.pop_back();
        }
    }

    std::size_t width_;         // of a row: a column for each variable outside the basis, unused ones, the values
    std::vector<N> cells_;      // over denominator_
    std::vector<int> outside_;  // the variables outside the basis, by column
    int basis_[rows] = {-5, -4, -3, -2, -1};  // the variable of each row: three artificial ones, l_0 and m_0
    N denominator_ = 1;
};

/// Whether the convex hulls of two sets of points have a point in common. Neither is empty.
inline bool hulls_meet(const std::vector<integer_point>& a, const std::vector<integer_point>& b) {
    using int512 = boost::multiprecision::int512_t;  // boost's have a sign beside their bits
    std::size_t bits = 0;                            // all coordinates are below 2^bits
    for (const std::vector<integer_point>* points : {&a, &b}) {
        for (const integer_point& p : *points) {
            for (const integer* x : {&p.x, &p.y, &p.z}) {
                if (*x != 0) bits = std::max<std::size_t>(bits, boost::multiprecision::msb(abs(*x)) + 1);
            }
        }
    }
    // C = 2^(bits + 1), see above: 13 + 6 (bits + 1) bits, and a sign.
    if (bits <= 18) return linear_program<int128>(a, b).feasible();
    if (bits <= 82) return linear_program<int512>(a, b).feasible();
    return linear_program<integer>(a, b).feasible();
}

namespace oracle {

/// Whether the hulls of two sets of floating-point points meet.
template <scalar T>
bool hulls_intersect(const std::vector<vec3<T>>& a, const std::vector<vec3<T>>& b) {
    std::vector<T> values;
    for (const std::vector<vec3<T>>* points : {&a, &b}) {
        for (const vec3<T>& p : *points) values.insert(values.end(), {p.x, p.y, p.z});
    }
    const std::vector<integer> v = to_integers(values);
    std::vector<integer_point> points;
    for (std::size_t i = 0; i < v.size(); i += 3) points.push_back({v[i], v[i + 1], v[i + 2]});
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(a.size());
    return hulls_meet({points.begin(), middle}, {middle, points.end()});
}

template <scalar T>
bool intersects(const triangle<T>& s, const triangle<T>& t) {
    return hulls_intersect<T>({s.a, s.b, s.c}, {t.a, t.b, t.c});
}

template <scalar T>
bool intersects(const segment<T>& s, const triangle<T>& t) {
    return hulls_intersect<T>({s.a, s.b}, {t.a, t.b, t.c});
}

template <scalar T>
bool intersects(const vec3<T>& p, const triangle<T>& t) {
    return hulls_intersect<T>({p}, {t.a, t.b, t.c});
}

}  // namespace oracle

}  // namespace abut::test
