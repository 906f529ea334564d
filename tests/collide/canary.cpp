// SPDX-License-Identifier: MIT
//
// Prints sums of all answers of shapes and queries of many kinds, to the last bit. canary.sh compares what it prints where
// the library uses what a compiler adds to C++, and where it does without. Integers of each length are asked: lattices are
// ties, and some coordinates are far apart.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include <abut/abut.hpp>
#include <abut/arithmetic/self_test.hpp>

namespace {

/// FNV-1a.
struct sum_of_bits {
    std::uint64_t sum = 14695981039346656037u;

    template <class X>
    void add(X x) {
        unsigned char bytes[sizeof x];
        std::memcpy(bytes, &x, sizeof x);
        for (const unsigned char b : bytes) sum = (sum ^ b) * 1099511628211u;
    }
    template <abut::scalar T>
    void add(const abut::vec3<T>& v) {
        add(v.x), add(v.y), add(v.z);
    }
    template <class S, class U>
    void add_pair(const S& s, const U& t) {
        const bool touches = abut::intersects(s, t);
        add(touches);
        add(abut::intersects<abut::exact>(s, t));
        const auto apart = abut::distance(s, t);
        add(apart.distance), add(apart.point_a), add(apart.point_b);
        if (!touches) return;
        const auto contact = abut::contact_of(s, t);
        add(contact->point), add(contact->normal), add(contact->depth);
    }
    void print(const char* name) const { std::printf("%s: %016llx\n", name, static_cast<unsigned long long>(sum)); }
};

enum class style { random, lattice, spread };

template <abut::scalar T>
class source {
public:
    explicit source(style s) : style_(s) {}

    T number() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        if (style_ == style::lattice) return static_cast<T>(static_cast<int>(state_ >> 61) - 4);
        const T x = static_cast<T>(static_cast<double>(state_ >> 11) * 0x1p-52 - 1);
        return style_ == style::random ? x : std::ldexp(x, static_cast<int>(state_ >> 9 & 31) - 16);
    }
    T size() { return std::abs(number()) / 4; }
    abut::vec3<T> point() {
        const T x = number(), y = number(), z = number();
        return {x, y, z};
    }
    abut::triangle<T> triangle() {
        const auto a = point(), b = point(), c = point();
        return {a, b, c};
    }

private:
    style style_;
    std::uint64_t state_ = 20261128;
};

template <abut::scalar T>
void print_shapes(style s, const char* name) {
    source<T> from(s);
    sum_of_bits sum;
    for (int i = 0; i < 400; ++i) {
        const auto t = from.triangle(), u = from.triangle();
        const auto p = from.point(), q = from.point();
        const T r = from.size();
        abut::vec3<T> corners[8];
        for (auto& c : corners) c = from.point();
        const abut::hull<T> h(corners, 8);
        const abut::sphere<T> ball{p, r};
        const abut::aabb<T> box{abut::detail::least(p, q), abut::detail::greatest(p, q)};
        sum.add_pair(t, u);
        sum.add_pair(ball, t);
        sum.add_pair(box, t);
        sum.add_pair(h, t);
        sum.add_pair(h, ball);
        if (p == q) continue;
        sum.add_pair(abut::capsule<T>{p, q, r}, t);
        if (r == 0) continue;
        sum.add_pair(abut::cylinder<T>{p, q, r}, u);
        sum.add_pair(abut::cone<T>{p, q, r}, ball);
    }
    sum.print(name);
}

template <abut::scalar T>
abut::mesh<T> soup(source<T>& from, std::uint32_t faces) {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> corners;
    for (std::uint32_t i = 0; i < faces; ++i) {
        const auto at = from.point();
        for (int k = 0; k < 3; ++k) {
            const auto by = from.point();
            vertices.push_back({at.x + by.x / 8, at.y + by.y / 8, at.z + by.z / 8});
        }
        corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return {vertices, corners};
}

template <abut::scalar T>
void print_queries(style s, const char* name) {
    const abut::serial on;
    source<T> from(s);
    const auto one = soup(from, 600), other = soup(from, 500);
    const auto a = abut::wide(on, abut::make_bvh(on, one)), b = abut::wide(on, abut::make_bvh(on, other));
    sum_of_bits sum;
    for (const auto& p : abut::to_host(abut::pairs(on, a, b))) sum.add(p.a), sum.add(p.b);
    for (const auto& c : abut::to_host(abut::contacts(on, a, b))) sum.add(c.depth), sum.add(c.point);
    const auto apart = abut::distance(on, a, b);
    sum.add(apart->distance), sum.add(apart->a), sum.add(apart->b);
    std::vector<abut::ray<T>> rays;
    std::vector<abut::vec3<T>> points, then;
    for (int i = 0; i < 300; ++i) {
        const auto p = from.point(), d = from.point();
        points.push_back(p);
        if (d != abut::vec3<T>{}) rays.push_back({p, d});
    }
    for (const auto& h : abut::to_host(abut::raycast(on, a, abut::rays<T>(rays)))) sum.add(h.id), sum.add(h.t);
    for (const auto& n : abut::to_host(abut::nearest(on, a, points))) sum.add(n.id), sum.add(n.distance), sum.add(n.point);
    for (const auto& p : abut::to_host(abut::within(on, a, b, T(0.125)))) sum.add(p.a), sum.add(p.b);
    for (std::size_t i = 0; i < 1800; ++i) then.push_back(from.point());
    const auto step = abut::moving(one, one.with_vertices(on, then));
    const auto first = abut::first_impact(on, step, other);
    sum.add(first->time);
    sum.print(name);
}

template <abut::scalar T>
void print_all(const char* scalar) {
    std::printf("%s\n", scalar);
    print_shapes<T>(style::random, "shapes, random");
    print_shapes<T>(style::lattice, "shapes, lattice");
    print_shapes<T>(style::spread, "shapes, spread");
    print_queries<T>(style::random, "queries, random");
    print_queries<T>(style::lattice, "queries, lattice");
}

}  // namespace

int main() {
    std::printf("self test: %s\n", abut::self_test().passed() ? "passed" : "FAILED");
    print_all<float>("float");
    print_all<double>("double");
}
