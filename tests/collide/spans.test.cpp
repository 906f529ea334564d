// SPDX-License-Identifier: MIT

// Stretches of rays inside of closed meshes, against an oracle in rationals: between any two times at which the ray meets a
// face's plane or the line of a side, the point in the middle is on a face, or inside by the parity of a way from it that
// meets no edge. It shares no formula with the library, and moves nothing by a little.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/abut.hpp>

#include "support/catch.hpp"

namespace abut::test::stretches_of_rays {

namespace {

using ratio = boost::multiprecision::cpp_rational;
struct place3 {
    ratio x, y, z;
};
place3 operator-(const place3& p, const place3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
place3 at(const place3& p, const place3& d, const ratio& t) { return {p.x + d.x * t, p.y + d.y * t, p.z + d.z * t}; }
place3 cross3(const place3& p, const place3& q) { return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x}; }
ratio dot3(const place3& p, const place3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
template <class T>
place3 exactly(const vec3<T>& p) {
    return {ratio(p.x), ratio(p.y), ratio(p.z)};
}
using face3 = std::array<place3, 3>;

/// 0 outside of the face, 1 on its rim, 2 inside of it; p is in its plane.
int place_in(const place3& p, const face3& f) {
    const place3 n = cross3(f[1] - f[0], f[2] - f[0]);
    int least = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const int s = dot3(n, cross3(f[(k + 1) % 3] - f[k], p - f[k])).sign();
        least = std::min(least, s);
    }
    return least + 1;
}
bool is_on(const place3& p, const std::vector<face3>& faces) {
    return std::any_of(faces.begin(), faces.end(), [&](const face3& f) {
        return dot3(cross3(f[1] - f[0], f[2] - f[0]), p - f[0]) == 0 && place_in(p, f) > 0;
    });
}
bool is_inside(const place3& p, const std::vector<face3>& faces, inside_rule rule) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> any(-1000003, 1000003);
    for (;;) {
        const place3 d{ratio(any(random)), ratio(any(random)), ratio(any(random))};
        int turns = 0;
        bool generic = true;
        for (const face3& f : faces) {
            const place3 n = cross3(f[1] - f[0], f[2] - f[0]);
            const ratio speed = dot3(n, d);
            if (speed == 0) {
                generic = false;
                break;
            }
            const ratio t = dot3(n, f[0] - p) / speed;
            if (t < 0) continue;
            const int in = place_in(at(p, d, t), f);
            if (in == 1) {
                generic = false;
                break;
            }
            if (in == 2) turns += speed.sign();
        }
        if (generic) return rule == inside_rule::parity ? turns % 2 != 0 : rule == inside_rule::nonzero ? turns != 0 : turns > 0;
    }
}

struct stretch {
    ratio from, to;
};
template <class T>
std::vector<stretch> stretches_of(const ray<T>& r, const std::vector<face3>& faces, inside_rule rule) {
    const place3 o = exactly(r.origin), d = exactly(r.direction);
    std::set<ratio> times{0};
    const auto add = [&](const ratio& t) {
        if (t > 0) times.insert(t);
    };
    for (const face3& f : faces) {
        const place3 n = cross3(f[1] - f[0], f[2] - f[0]);
        const ratio speed = dot3(n, d);
        if (speed != 0) {
            const ratio t = dot3(n, f[0] - o) / speed;
            if (t > 0 && place_in(at(o, d, t), f) > 0) times.insert(t);
        } else if (dot3(n, f[0] - o) == 0) {
            for (std::size_t k = 0; k < 3; ++k) {  // where it is on the plane through a side that is upright on the face
                const place3 m = cross3(n, f[(k + 1) % 3] - f[k]);
                if (dot3(m, d) != 0) add(dot3(m, f[k] - o) / dot3(m, d));
            }
        }
    }
    std::vector<stretch> found;
    const std::vector<ratio> in_order(times.begin(), times.end());
    for (std::size_t i = 0; i + 1 < in_order.size(); ++i) {
        const place3 p = at(o, d, (in_order[i] + in_order[i + 1]) / 2);
        if (is_on(p, faces) || !is_inside(p, faces, rule)) continue;
        if (!found.empty() && found.back().to == in_order[i]) {
            found.back().to = in_order[i + 1];
        } else {
            found.push_back({in_order[i], in_order[i + 1]});
        }
    }
    return found;
}

template <class T>
struct bare_mesh {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    [[nodiscard]] abut::mesh<T> made() const { return {vertices, faces}; }
};

/// The surface of some unit cubes, between those that are there and those that are not: edges have two faces or four. Faces look
/// outwards.
template <class T>
bare_mesh<T> cubes(std::mt19937& random, int n, unsigned of_ten) {
    bare_mesh<T> m;
    std::set<std::tuple<int, int, int>> there;
    for (int i = 0; i < n * n * n; ++i) {
        if (random() % 10 < of_ten) there.insert({i % n, i / n % n, i / n / n});
    }
    std::map<std::tuple<int, int, int>, std::uint32_t> number;
    const auto vertex = [&](int x, int y, int z) {
        const auto [it, fresh] = number.try_emplace({x, y, z}, static_cast<std::uint32_t>(m.vertices.size()));
        if (fresh) m.vertices.push_back({static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)});
        return it->second;
    };
    for (const auto& [x, y, z] : there) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) {
                int beyond[3] = {x, y, z};
                beyond[axis] += side == 1 ? 1 : -1;
                if (there.count({beyond[0], beyond[1], beyond[2]}) != 0) continue;
                std::uint32_t v[4];
                for (int k = 0; k < 4; ++k) {
                    int c[3] = {x, y, z};
                    c[axis] += side;
                    c[(axis + 1) % 3] += (k == 1 || k == 2) ? 1 : 0;
                    c[(axis + 2) % 3] += k / 2;
                    v[k] = vertex(c[0], c[1], c[2]);
                }
                if (side == 0) std::swap(v[1], v[3]);
                m.faces.push_back({v[0], v[1], v[2]});
                m.faces.push_back({v[0], v[2], v[3]});
            }
        }
    }
    return m;
}
/// Both in one mesh, the second moved by one and turned inside out if that is asked: faces are there twice, and lie within.
template <class T>
bare_mesh<T> heap(bare_mesh<T> m, const bare_mesh<T>& other, bool inwards) {
    const auto first = static_cast<std::uint32_t>(m.vertices.size());
    for (const auto& v : other.vertices) m.vertices.push_back({v.x + 1, v.y, v.z});
    for (const face& f : other.faces) m.faces.push_back({f[0] + first, f[inwards ? 2 : 1] + first, f[inwards ? 1 : 2] + first});
    return m;
}
template <class T>
bare_mesh<T> tetrahedra(std::mt19937& random, int n) {
    bare_mesh<T> m;
    while (n > 0) {
        vec3<T> c[4];
        for (auto& p : c) p = {static_cast<T>(random() % 4), static_cast<T>(random() % 4), static_cast<T>(random() % 4)};
        if (dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]) == 0) continue;
        const auto first = static_cast<std::uint32_t>(m.vertices.size());
        m.vertices.insert(m.vertices.end(), c, c + 4);
        for (const face& f : {face{0, 2, 1}, face{0, 1, 3}, face{0, 3, 2}, face{1, 2, 3}}) m.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
        --n;
    }
    return m;
}

template <class T>
std::vector<ray<T>> lattice_rays(std::mt19937& random, std::size_t n, int extent) {
    std::vector<ray<T>> rays;
    while (rays.size() < n) {
        const auto half = [&] { return static_cast<T>(static_cast<int>(random() % (2 * static_cast<unsigned>(extent) + 5)) - 2) / 2; };
        const auto way = [&] { return static_cast<T>(static_cast<int>(random() % 5) - 2); };
        const T x = half(), y = half(), z = half(), dx = way(), dy = way(), dz = way();
        if (dx != 0 || dy != 0 || dz != 0) rays.push_back({{x, y, z}, {dx, dy, dz}});
    }
    return rays;
}

template <class T>
std::size_t check_spans(const bare_mesh<T>& m, const std::vector<ray<T>>& rays, inside_rule rule = inside_rule::parity) {
    std::vector<face3> faces;
    for (const face& f : m.faces) faces.push_back({exactly(m.vertices[f[0]]), exactly(m.vertices[f[1]]), exactly(m.vertices[f[2]])});
    const auto part = m.made();
    const abut::rays<T> all(rays);
    const auto tree = make_bvh(serial{}, part);
    const inside_options by{.rule = rule, .check = false};
    const auto found = spans(serial{}, tree, all, by);
    CHECK((spans(openmp{.threads = 2}, part, all, by) == found));
    CHECK((spans<exact>(serial{}, tree, all.view(), {.known_closed = true, .rule = rule}) == found));
    CHECK((spans(serial{}, posed(tree, rigid<T>{}), all, by) == found));
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        const auto expected = stretches_of(rays[i], faces, rule);
        for (const stretch& s : expected) {
            REQUIRE(k < found.size());
            const auto& f = found[k++];
            CHECK(f.ray == i);
            CHECK(f.from == Approx(static_cast<double>(s.from)).epsilon(1e-6));
            CHECK(f.to == Approx(static_cast<double>(s.to)).epsilon(1e-6));
            const auto touches = [&](std::uint32_t id, const ratio& t) {
                return id < faces.size() && is_on(at(exactly(rays[i].origin), exactly(rays[i].direction), t), {faces[id]});
            };
            CHECK(touches(f.leave, s.to));
            if (f.enter != ray_span<T>::no_face) {
                CHECK(touches(f.enter, s.from));
            } else {
                CHECK(s.from == 0);
                CHECK_FALSE(is_on(exactly(rays[i].origin), faces));
            }
        }
        if (k < found.size()) CHECK(found[k].ray > i);
    }
    CHECK(k == found.size());
    return k;
}

}  // namespace

TEMPLATE_TEST_CASE("spans: rays of a lattice through cubes, along faces and edges too", "", float, double) {
    std::mt19937 random(21);
    std::size_t stretches = 0;
    for (int round = 0; round < 30; ++round) {
        const auto m = cubes<TestType>(random, 2 + round % 2, 3 + static_cast<unsigned>(round) % 5);
        if (m.faces.empty()) continue;
        stretches += check_spans(m, lattice_rays<TestType>(random, 60, 3));
    }
    CHECK(stretches > 150);
}

TEMPLATE_TEST_CASE("spans: through tetrahedra that pass through each other, by parity", "", float, double) {
    std::mt19937 random(22);
    std::size_t stretches = 0;
    for (int round = 0; round < 40; ++round) {
        stretches += check_spans(tetrahedra<TestType>(random, 1 + round % 4), lattice_rays<TestType>(random, 50, 3));
    }
    CHECK(stretches > 150);
}

TEMPLATE_TEST_CASE("spans: by rules, through bodies that overlap, touch, and are turned inside out", "", float, double) {
    std::mt19937 random(24);
    std::size_t stretches = 0;
    for (unsigned round = 0; round < 24; ++round) {
        const auto m = round % 2 == 0 ? tetrahedra<TestType>(random, 2 + static_cast<int>(round) % 4)
                                      : heap(cubes<TestType>(random, 2, 7), cubes<TestType>(random, 2, 6), round % 8 == 1);
        const inside_rule rule = round % 3 == 0 ? inside_rule::positive : inside_rule::nonzero;
        stretches += check_spans(m, lattice_rays<TestType>(random, 24, 2), rule);
    }
    CHECK(stretches > 60);
    // Two bodies as one: the ray goes on in what they have in common.
    const auto both = heap(cubes<TestType>(random, 2, 10), cubes<TestType>(random, 2, 10), false);
    const rays<TestType> through({{{-1, TestType(0.5), TestType(0.25)}, {1, 0, 0}}});
    CHECK(spans(serial{}, both.made(), through).size() == 2);
    const auto found = spans(serial{}, both.made(), through, {.rule = inside_rule::nonzero});
    REQUIRE(found.size() == 1);
    CHECK((found[0].from == 1 && found[0].to == 4));
    auto turned = both;
    std::swap(turned.faces[0][0], turned.faces[0][1]);
    CHECK_THROWS_AS(spans(serial{}, turned.made(), through, {.rule = inside_rule::nonzero}), invalid_geometry);
}

TEMPLATE_TEST_CASE("spans: at random, and far from even numbers", "", float, double) {
    std::mt19937 random(23);
    std::uniform_real_distribution<TestType> any(-4, 8), way(-1, 1);
    std::size_t stretches = 0;
    for (const int exponent : {0, -90, 70}) {
        for (int round = 0; round < 10; ++round) {
            auto m = tetrahedra<TestType>(random, 3);
            for (auto& v : m.vertices) v = {std::ldexp(v.x + way(random) / 8, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z + way(random) / 8, exponent)};
            std::vector<ray<TestType>> rays;
            for (int i = 0; i < 30; ++i) {
                const vec3<TestType> from{std::ldexp(any(random), exponent), std::ldexp(any(random), exponent), std::ldexp(any(random), exponent)};
                const auto& to = m.vertices[random() % m.vertices.size()];
                rays.push_back({from, i % 3 == 0 ? to - from : vec3<TestType>{std::ldexp(way(random), exponent), std::ldexp(way(random), exponent), std::ldexp(way(random), exponent)}});
            }
            stretches += check_spans(m, rays);
        }
    }
    CHECK(stretches > 50);
}

TEST_CASE("spans: one through the poles of a sphere, none along a wall, two through a hollow") {
    bare_mesh<double> m{{{0, 0, -1}, {0, 0, 1}}, {}};
    const std::uint32_t around = 64, rings = 9;
    for (std::uint32_t j = 0; j < rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * (j + 1) / (rings + 1);
            m.vertices.push_back({std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b)});
            const std::uint32_t v = 2 + j * around + i, next = 2 + j * around + (i + 1) % around;
            if (j == 0) m.faces.push_back({0, next, v});
            if (j + 1 == rings) {
                m.faces.push_back({1, v, next});
            } else {
                m.faces.push_back({v, next, v + around});
                m.faces.push_back({next, next + around, v + around});
            }
        }
    }
    const rays<double> all({{{0, 0, -3}, {0, 0, 2}}, {{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 1}}, {{-2, 0, 1}, {1, 0, 0}}, {{0, 0, 9}, {0, 0, -1}}, {{0, 0, 1}, {0, 0, -1}}});
    CHECK(to_host(raycast_all(serial{}, m.made(), all)).size() > 300);
    const auto found = spans(serial{}, m.made(), all);
    REQUIRE(found.size() == 4);
    CHECK((found[0].ray == 0 && found[0].from == 1 && found[0].to == 2));
    CHECK((found[1] == ray_span<double>{1, ray_span<double>::no_face, found[1].leave, 0, 1}));
    CHECK((found[2].ray == 4 && found[2].from == 8 && found[2].to == 10));
    CHECK((found[3].ray == 5 && found[3].from == 0 && found[3].to == 2 && found[3].enter != ray_span<double>::no_face));

    auto inner = m;
    for (const auto& v : m.vertices) inner.vertices.push_back({v.x / 2, v.y / 2, v.z / 2});
    const auto n = static_cast<std::uint32_t>(m.vertices.size());
    for (const face& f : m.faces) inner.faces.push_back({f[0] + n, f[1] + n, f[2] + n});
    CHECK(spans(serial{}, inner.made(), rays<double>({{{0, 0, -3}, {0, 0, 2}}})).size() == 2);
    CHECK(spans(serial{}, mesh<double>(), all).empty());
    auto open = m;
    open.faces.pop_back();
    CHECK_THROWS_AS(spans(serial{}, open.made(), all), invalid_geometry);
    CHECK(spans(serial{}, m.made(), rays<double>({{{0, 0, 0}, {0, 0, 0}}})).empty());
}

}  // namespace abut::test::stretches_of_rays
