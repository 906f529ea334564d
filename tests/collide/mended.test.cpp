// SPDX-License-Identifier: MIT

// Meshes as they come: welded by a distance, turned to agree, measured. The oracles are brute force over all vertices in unbounded
// integers, flooding from face to face, and rationals for what is rounded.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/rational.hpp"

namespace abut::test::mended {

namespace {

template <class T>
struct bare_mesh {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    [[nodiscard]] abut::mesh<T> made() const { return {vertices, faces}; }
};

template <class T>
auto place_of(const vec3<T>& p) {
    return std::tuple(p.x, p.y, p.z);
}

/// The rule, from its words: over all vertices, in integers.
template <class T>
std::vector<std::uint32_t> welded_by_rule(const std::vector<vec3<T>>& vertices, double distance) {
    std::vector<double> numbers{distance};
    for (const auto& p : vertices) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    const std::vector<integer> whole = to_integers(numbers);
    const auto squared = [&](std::uint32_t u, std::uint32_t v) {
        integer sum = 0;
        for (std::size_t k = 1; k < 4; ++k) {
            const integer d = whole[3 * u + k] - whole[3 * v + k];
            sum += d * d;
        }
        return sum;
    };
    const integer most = whole[0] * whole[0];
    std::vector<std::uint32_t> order(vertices.size()), kept, to(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto u, auto v) { return place_of(vertices[u]) < place_of(vertices[v]); });
    for (const std::uint32_t v : order) {
        if (std::none_of(kept.begin(), kept.end(), [&](std::uint32_t r) { return squared(r, v) <= most; })) kept.push_back(v);
    }
    for (const std::uint32_t v : order) {
        to[v] = kept[0];
        for (const std::uint32_t r : kept) {
            if (squared(r, v) < squared(to[v], v)) to[v] = r;
        }
    }
    return to;
}

template <class T>
void check_weld(const bare_mesh<T>& m, double distance) {
    const auto to = welded_by_rule(m.vertices, distance);
    const auto plain = m.made();
    const auto found = welded(serial{}, plain, distance);
    REQUIRE(found.vertex_of.size() == m.vertices.size());
    std::vector<vec3<T>> kept;
    for (std::uint32_t v = 0; v < to.size(); ++v) {
        if (to[v] == v) kept.push_back(m.vertices[v]);
    }
    const auto view = found.mesh.view();
    REQUIRE(view.vertices.count == kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) CHECK(place_of(view.vertices[i]) == place_of(kept[i]));
    for (std::uint32_t v = 0; v < to.size(); ++v) CHECK(place_of(kept[found.vertex_of[v]]) == place_of(m.vertices[to[v]]));
    REQUIRE(found.mesh.size() == m.faces.size());
    for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
        CHECK(found.face_of[f] == f);
        for (std::size_t k = 0; k < 3; ++k) CHECK(corners_at(view.faces, f)[k] == found.vertex_of[m.faces[f][k]]);
    }
    // What is dropped.
    const auto few = welded(openmp{.threads = 2}, plain, distance, {.drop_collapsed = true, .drop_duplicates = true});
    CHECK(few.vertex_of == found.vertex_of);
    std::vector<std::uint32_t> left;
    std::set<std::set<std::uint32_t>> seen;
    for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
        std::set<std::uint32_t> three;
        for (const std::uint32_t v : m.faces[f]) three.insert(found.vertex_of[v]);
        if (three.size() == 3 && seen.insert(three).second) left.push_back(f);
    }
    CHECK(few.face_of == left);
    CHECK(few.mesh.size() == left.size());
}

template <class T>
bare_mesh<T> random_mesh(std::mt19937& random, std::size_t n, int kind) {
    bare_mesh<T> m;
    std::uniform_int_distribution<int> lattice(0, 6), exponent(std::numeric_limits<T>::min_exponent - 20, std::numeric_limits<T>::max_exponent - 2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t i = 0; i < n; ++i) {
        const auto one = [&]() -> T {
            if (kind == 0) return static_cast<T>(lattice(random));
            if (kind == 1) return static_cast<T>(unit(random));
            if (kind == 2) return std::ldexp(static_cast<T>(unit(random) - 0.5), exponent(random));
            return static_cast<T>(1 + std::ldexp(lattice(random), 1 - std::numeric_limits<T>::digits));
        };
        const T x = one(), y = one(), z = one();
        m.vertices.push_back({x, y, z});
    }
    std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(n - 1));
    for (std::size_t i = 0; i < 2 * n; ++i) {
        const std::uint32_t a = any(random), b = any(random), c = any(random);
        m.faces.push_back({a, b, c});
    }
    return m;
}

/// As three.js makes it: seam and poles have vertices of their own, which sines and cosines put somewhat apart.
bare_mesh<double> sphere_of_patches(std::uint32_t around, std::uint32_t up, double radius) {
    bare_mesh<double> m;
    for (std::uint32_t j = 0; j <= up; ++j) {
        for (std::uint32_t i = 0; i <= around; ++i) {
            const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * j / up;
            m.vertices.push_back({-radius * std::cos(a) * std::sin(b), radius * std::cos(b), radius * std::sin(a) * std::sin(b)});
        }
    }
    for (std::uint32_t j = 0; j < up; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = j * (around + 1) + i + 1, b = a - 1, c = b + around + 1, d = c + 1;
            if (j != 0) m.faces.push_back({a, b, d});
            if (j != up - 1) m.faces.push_back({b, c, d});
        }
    }
    return m;
}

template <class T>
bare_mesh<T> box(const vec3<T>& l, const vec3<T>& u) {
    return {{{l.x, l.y, l.z}, {u.x, l.y, l.z}, {u.x, u.y, l.z}, {l.x, u.y, l.z}, {l.x, l.y, u.z}, {u.x, l.y, u.z}, {u.x, u.y, u.z}, {l.x, u.y, u.z}},
            {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}};
}
template <class T>
void append(bare_mesh<T>& to, const bare_mesh<T>& m, bool turned = false) {
    const auto first = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), m.vertices.begin(), m.vertices.end());
    for (const face& f : m.faces) to.faces.push_back({f[0] + first, f[turned ? 2 : 1] + first, f[turned ? 1 : 2] + first});
}

/// Six times the volume and the center's numerator, in units of the numbers' own.
template <class T>
struct sums_in_integers {
    integer volume = 0, center[3] = {0, 0, 0};
    explicit sums_in_integers(const bare_mesh<T>& m, int shift) {
        const auto whole = [&](T x) { return static_cast<std::int64_t>(std::ldexp(static_cast<double>(x), shift)); };
        for (const face& f : m.faces) {
            integer p[3][3];
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& v = m.vertices[f[k]];
                p[k][0] = whole(v.x), p[k][1] = whole(v.y), p[k][2] = whole(v.z);
            }
            integer det = 0;
            for (int k = 0; k < 3; ++k) det += p[0][k] * (p[1][(k + 1) % 3] * p[2][(k + 2) % 3] - p[1][(k + 2) % 3] * p[2][(k + 1) % 3]);
            volume += det;
            for (int k = 0; k < 3; ++k) center[k] += det * (p[0][k] + p[1][k] + p[2][k]);
        }
    }
};

}  // namespace

TEMPLATE_TEST_CASE("welded by a distance: the rule over all vertices, in integers", "", float, double) {
    std::mt19937 random(54);
    std::size_t moved = 0;
    for (int round = 0; round < 60; ++round) {
        const auto m = random_mesh<TestType>(random, static_cast<std::size_t>(40 + round % 3 * 20), round % 4);
        for (const double share : {0.0, 1e-3, 0.1, 0.25, 0.5}) {
            double distance = share;
            if (round % 4 == 0) distance = share * 8;  // 0.8, 2 and 4 on a lattice: ties, and distances of the lattice
            if (round % 4 == 2) distance = std::abs(static_cast<double>(m.vertices[static_cast<std::size_t>(round % 40)].x)) * (share > 0.3 ? 1 : share);
            if (round % 4 == 3) distance = std::ldexp(share * 8, 1 - std::numeric_limits<TestType>::digits);
            CAPTURE(round, distance);
            check_weld(m, distance);
            moved += welded(serial{}, m.made(), distance).mesh.view().vertices.count < m.vertices.size() ? 1 : 0;
        }
    }
    CHECK(moved > 100);
}

TEST_CASE("welded by a distance: numbers of vertices make no difference") {
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
        const auto m = random_mesh<double>(random, 80, round % 4);
        std::vector<std::uint32_t> order(m.vertices.size());
        std::iota(order.begin(), order.end(), 0u);
        std::shuffle(order.begin(), order.end(), random);
        auto other = m;
        for (std::uint32_t v = 0; v < order.size(); ++v) other.vertices[order[v]] = m.vertices[v];
        for (face& f : other.faces) {
            for (auto& v : f) v = order[v];
        }
        const auto a = welded(serial{}, m.made(), 0.3), b = welded(serial{}, other.made(), 0.3);
        REQUIRE(a.mesh.size() == b.mesh.size());
        for (std::uint32_t f = 0; f < a.mesh.size(); ++f) {
            const auto s = a.mesh.view()[f], t = b.mesh.view()[f];
            CHECK((s.a == t.a && s.b == t.b && s.c == t.c));
        }
    }
}

TEST_CASE("welded by a distance: a chain is cut, one place costs no more, and 0 is what welds places") {
    bare_mesh<float> chain;
    for (int i = 0; i < 100; ++i) chain.vertices.push_back({static_cast<float>(i), 0, 0});
    chain.faces = {{0, 1, 2}};
    const auto cut = welded(serial{}, chain.made(), 1.5);
    CHECK(cut.mesh.view().vertices.count == 50);  // 0, 2, 4, ...
    CHECK(cut.vertex_of[3] == 1);                 // as near to 4 as to 2
    CHECK(cut.mesh.size() == 1);
    CHECK(welded(serial{}, chain.made(), 1.5, {.drop_collapsed = true}).mesh.size() == 0);

    bare_mesh<double> many;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 100000; ++i) many.vertices.push_back({i % 2 == 0 ? 1.0 : unit(random), 1, i % 4 == 0 ? 1.0 : unit(random)});
    many.faces = {{0, 1, 2}, {3, 4, 5}};
    const auto all = welded(serial{}, many.made(), 2.0);
    CHECK(all.mesh.view().vertices.count == 1);
    const auto exactly = welded(serial{}, many.made(), 0.0).mesh, as_before = welded(serial{}, many.made());
    REQUIRE(exactly.view().vertices.count == as_before.view().vertices.count);
    for (std::size_t v = 0; v < as_before.view().vertices.count; ++v) REQUIRE(exactly.view().vertices[v] == as_before.view().vertices[v]);
    for (std::size_t f = 0; f < 2; ++f) {
        for (int k = 0; k < 3; ++k) CHECK(corners_at(exactly.view().faces, f)[k] == corners_at(as_before.view().faces, f)[k]);
    }
    CHECK(welded(serial{}, mesh<float>(), 1.0).mesh.size() == 0);
    CHECK_THROWS_AS(welded(serial{}, chain.made(), -1.0), error);
    CHECK_THROWS_AS(welded(serial{}, chain.made(), std::nan("")), error);
    const auto of_view = welded(serial{}, chain.made().view(), 1.5);
    CHECK(of_view.vertex_of == cut.vertex_of);
}

TEST_CASE("welded by a distance: a sphere with a seam and doubled poles is closed") {
    for (const auto& [around, up] : {std::pair(32u, 16u), std::pair(8u, 6u), std::pair(97u, 51u)}) {
        const auto m = sphere_of_patches(around, up, 3).made();
        CHECK_FALSE(validate(serial{}, welded(serial{}, m)).closed());
        const auto part = welded(serial{}, m, 6e-7, {.drop_collapsed = true}).mesh;
        const auto report = validate(serial{}, part, {.measures = true});
        CHECK((report.closed() && report.manifold() && report.oriented()));
        CHECK(report.euler_characteristic == 2);
        CHECK(self_pairs(serial{}, part).size() == 0);
        CHECK(report.measures->outward());
        CHECK(report.measures->volume < 4 * std::numbers::pi / 3 * 27);
        CHECK(report.measures->volume > 0.8 * 4 * std::numbers::pi / 3 * 27);
    }
}

TEMPLATE_TEST_CASE("oriented_consistently: faces turned at random come back outwards", "", float, double) {
    std::mt19937 random(12);
    bare_mesh<TestType> m;
    append(m, box<TestType>({0, 0, 0}, {3, 2, 1}));
    append(m, box<TestType>({100, 0, 0}, {103, 2, 1}));
    append(m, box<TestType>({0, 0, 50}, {3, 2, 51}));
    bare_mesh<TestType> lid = box<TestType>({0, 90, 0}, {1, 91, 1});
    lid.faces.resize(10);
    append(m, lid);
    for (int round = 0; round < 50; ++round) {
        auto turned = m;
        std::vector<std::uint32_t> which;
        for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
            if (f == 36 || random() % 2 == 0) continue;  // the first of what is open says how
            which.push_back(f);
            std::swap(turned.faces[f][1], turned.faces[f][2]);
        }
        const auto found = oriented_consistently(openmp{.threads = 2}, turned.made());
        CHECK(found.turned == which);
        for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
            const auto* c = corners_at(found.mesh.view().faces, f);
            CHECK((face{c[0], c[1], c[2]}) == m.faces[f]);
        }
        CHECK(validate(serial{}, found.mesh).oriented());
    }
    // Edges of four faces join nothing, and what lies flat has no outside.
    bare_mesh<TestType> two = box<TestType>({0, 0, 0}, {1, 1, 1});
    two.faces.push_back({0, 1, 2});
    CHECK(oriented_consistently(serial{}, two.made()).mesh.size() == 13);
    const bare_mesh<TestType> pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}, {0, 0, 1}}};
    CHECK((oriented_consistently(serial{}, pillow.made().view()).turned == std::vector<std::uint32_t>{1}));
}

TEST_CASE("oriented_consistently: a strip that is twisted once is refused, and one that is twisted twice is not") {
    for (const bool odd : {true, false}) {
        bare_mesh<float> m;
        append(m, box<float>({9, 9, 9}, {10, 10, 10}));
        const std::uint32_t n = 10, first = 8;
        for (std::uint32_t i = 0; i < n; ++i) {
            m.vertices.push_back({static_cast<float>(i), 0, 0});
            m.vertices.push_back({static_cast<float>(i), 1, 0});
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = first + 2 * i, b = a + 1;
            std::uint32_t c = first + 2 * ((i + 1) % n), d = c + 1;
            if (odd && i + 1 == n) std::swap(c, d);
            m.faces.push_back({a, c, b});
            m.faces.push_back({b, c, d});
        }
        if (odd) {
            try {
                const auto none = oriented_consistently(serial{}, m.made());
                FAIL("not refused");
            } catch (const invalid_geometry& e) {
                CHECK(e.index() == 12);
                CHECK(e.value() == 20);
            }
        } else {
            CHECK(oriented_consistently(serial{}, m.made()).turned.empty());
        }
    }
}

TEMPLATE_TEST_CASE("validate: what a mesh measures, against integers", "", float, double) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> at(-40, 40), size(1, 30);
    for (int round = 0; round < 200; ++round) {
        bare_mesh<TestType> m;
        const TestType unit = std::ldexp(TestType{1}, round % 5 - 2);
        double area = 0;
        const int boxes = 1 + round % 3;
        std::vector<int> signs;
        for (int k = 0; k < boxes; ++k) {
            const int l[3] = {at(random), at(random), at(random)}, d[3] = {size(random), size(random), size(random)};
            const auto real = [&](int i) { return static_cast<TestType>(i) * unit; };
            const bool inwards = random() % 3 == 0;
            append(m, box<TestType>({real(l[0]), real(l[1]), real(l[2])}, {real(l[0] + d[0]), real(l[1] + d[1]), real(l[2] + d[2])}), inwards);
            signs.push_back(inwards ? -1 : 1);
            area += 2.0 * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]) * unit * unit;
        }
        const auto report = validate(serial{}, m.made(), {.measures = true});
        REQUIRE(report.measures);
        const mesh_measures& found = *report.measures;
        CHECK(validate(openmp{.threads = 2}, m.made().view(), {.measures = true}) == report);
        const sums_in_integers<TestType> sums(m, 2);
        const double volume = static_cast<double>(sums.volume) / 6 / 64;
        CHECK(found.volume == Approx(volume).epsilon(1e-12).margin(1e-9));
        CHECK(found.area == Approx(area).epsilon(1e-13));
        REQUIRE(found.sheets.size() == signs.size());
        for (std::size_t k = 0; k < signs.size(); ++k) {
            const auto first = static_cast<std::uint32_t>(12 * k);
            CHECK((found.sheets[k] == mesh_sheet{first, 12, true, true, signs[k]}));
        }
        CHECK(found.outward() == (std::count(signs.begin(), signs.end(), 1) == boxes));
        if (std::abs(volume) < 1) continue;
        const double of[3] = {found.center_of_mass.x, found.center_of_mass.y, found.center_of_mass.z};
        for (int k = 0; k < 3; ++k) {
            const double center = static_cast<double>(sums.center[k]) / static_cast<double>(sums.volume) / 4 / 4;
            CHECK(of[k] == Approx(center).epsilon(1e-10).margin(1e-8));
        }
    }
}

TEST_CASE("validate: measures of what is open, flat, wrong, large and small") {
    CHECK_FALSE(validate(serial{}, box<float>({0, 0, 0}, {1, 1, 1}).made()).measures);
    auto open = box<double>({0, 0, 0}, {1, 1, 1});
    open.faces.pop_back();
    const auto of_open = *validate(serial{}, open.made(), {.measures = true}).measures;
    CHECK(of_open.volume == 0);
    CHECK(of_open.area == 5.5);
    CHECK((of_open.sheets == std::vector<mesh_sheet>{{0, 11, false, true, 0}}));
    CHECK_FALSE(of_open.outward());
    auto against = box<double>({0, 0, 0}, {1, 1, 1});
    std::swap(against.faces[3][0], against.faces[3][1]);
    CHECK((validate(serial{}, against.made(), {.measures = true}).measures->sheets == std::vector<mesh_sheet>{{0, 12, true, false, 0}}));
    CHECK(validate(serial{}, mesh<float>(), {.measures = true}).measures->sheets.empty());
    for (const double s : {0x1p-300, 0x1p+300}) {
        const auto scaled = *validate(serial{}, box<double>({s, s, s}, {2 * s, 2 * s, 2 * s}).made(), {.measures = true}).measures;
        CHECK(scaled.volume == s * s * s);
        CHECK(scaled.area == 6 * s * s);
        CHECK(scaled.center_of_mass == vec3<double>{1.5 * s, 1.5 * s, 1.5 * s});
    }
    const double s = 0x1p+1020;
    CHECK(validate(serial{}, box<double>({-s, -s, -s}, {s, s, s}).made(), {.measures = true}).measures->volume == std::numeric_limits<double>::infinity());
    // What a view may hold.
    auto bad = box<float>({0, 0, 0}, {1, 1, 1});
    bad.vertices.push_back({std::nanf(""), 0, 0});
    bad.faces.push_back({0, 1, 99});
    bad.faces.push_back({0, 1, 8});
    bad.faces.push_back({2, 2, 3});
    const mesh_view<float> view(bad.vertices.data(), bad.vertices.size(), bad.faces.data(), bad.faces.size());
    CHECK(validate(serial{}, view, {.measures = true}).measures->area == 6);
}

}  // namespace abut::test::mended
