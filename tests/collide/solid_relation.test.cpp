// SPDX-License-Identifier: MIT
#include <abut/collide/relation.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

struct tally {
    std::uint64_t asked = 0, wrong = 0, of[8] = {};

    void note(solid_relation said, solid_relation truth) {
        ++asked;
        ++of[static_cast<int>(truth)];
        if (said != truth && wrong++ < 3) std::printf("said %s, is %s\n", name_of(said), name_of(truth));
    }
    void print(const char* what) const {
        std::printf("%s: %llu pairs;", what, static_cast<unsigned long long>(asked));
        for (int i = 0; i < 8; ++i) std::printf(" %s %llu", name_of(static_cast<solid_relation>(i)), static_cast<unsigned long long>(of[i]));
        std::printf("\n");
    }
};

constexpr solid_relation inverse(solid_relation r) {
    switch (r) {
        case solid_relation::tangential_part: return solid_relation::tangential_part_inverse;
        case solid_relation::nontangential_part: return solid_relation::nontangential_part_inverse;
        case solid_relation::tangential_part_inverse: return solid_relation::tangential_part;
        case solid_relation::nontangential_part_inverse: return solid_relation::nontangential_part;
        default: return r;
    }
}

}  // namespace

TEMPLATE_TEST_CASE("relation: boxes of a grid, against their cells", "", float, double) {
    tally all;
    const serial on;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 2, 100000);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270514, 1, k);
        const auto box = [&] {
            cells c;
            const int most = 1 + d.below(5);
            const grid_place size{1 + d.below(most), 1 + d.below(most), 1 + d.below(most)};
            for (int x = 0; x < size[0]; ++x) {
                for (int y = 0; y < size[1]; ++y) {
                    for (int z = 0; z < size[2]; ++z) c.in.insert({x, y, z});
                }
            }
            for (int& x : c.offset) x = d.below(4);
            return c;
        };
        const cells a = box();
        cells b = box();
        if (k % 16 == 0) b = a;
        if (k % 8 == 1) {  // within the other one, most often
            b.in = a.in;
            const grid_place last = *a.in.rbegin();
            const bool apart = d.below(2) == 0;
            std::erase_if(b.in, [&](const grid_place& c) {
                bool is_at_side = false;
                for (std::size_t i = 0; i < 3; ++i) is_at_side |= c[i] == 0 || (apart && c[i] == last[i]);
                return is_at_side;
            });
            if (b.in.empty()) continue;
            b.offset = a.offset;
            if (!apart) {
                for (int& x : b.offset) x -= d.below(2);
            }
        }
        const frame_of_grid f = draw_frame(d);
        const mesh<TestType> x = surface_of<TestType>(a, f, d), y = surface_of<TestType>(b, f, d);
        all.note(relation(on, x, y, {.known_solid = true}), truth_of(a, b));
        all.note(relation(on, y, x, {.known_solid = true}), truth_of(b, a));
    }
    all.print("boxes");
    CHECK(all.wrong == 0);
    for (const std::uint64_t n : all.of) CHECK((n > 0 || count < 1000));
}

TEMPLATE_TEST_CASE("relation: sets of cells with holes, hollows and handles, against their cells", "", float, double) {
    tally all;
    const serial on;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 4, 100000);
    std::uint64_t unlike = 0;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270514, 2, k);
        const auto [a, b] = draw_two_sets(d, k);
        const frame_of_grid f = draw_frame(d);
        const mesh<TestType> x = surface_of<TestType>(a, f, d, d.below(2) == 0), y = surface_of<TestType>(b, f, d, d.below(2) == 0);
        const solid_relation said = relation(on, x, y, {.known_solid = d.below(2) == 0});
        all.note(said, truth_of(a, b));
        if (k % 8 == 1) {
            const auto tree = make_bvh(openmp{.threads = 2}, y);
            unlike += relation<exact>(openmp{.threads = 2}, x, tree) != said || relation(on, tree, x) != inverse(said);
            const bool meet = said != solid_relation::disconnected && said != solid_relation::externally_connected;
            unlike += overlaps(on, x, tree) != meet;
        }
    }
    all.print("cells");
    CHECK(all.wrong == 0);
    CHECK(unlike == 0);
    for (const std::uint64_t n : all.of) CHECK((n > 0 || count < 1000));
}

TEMPLATE_TEST_CASE("relation: tetrahedra of a small grid, against planes in integers", "", float, double) {
    tally all;
    const serial on;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count(), 400000);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270514, 3, k);
        const int size = 3 + d.below(4);
        tetrahedron_of_grid a = draw_tetrahedron(d, size), b = k % 16 == 0 ? a : draw_tetrahedron(d, size);
        if (k % 16 == 1) {  // of middles of a's corners
            for (grid_place& p : a) {
                for (int& x : p) x *= 8;
            }
            for (grid_place& p : b) {
                p = {0, 0, 0};
                for (int i = 0; i < 8; ++i) {
                    const grid_place& of = a[static_cast<std::size_t>(i < 4 && k % 32 == 1 ? i : d.below(4))];
                    for (std::size_t c = 0; c < 3; ++c) p[c] += of[c] / 8;
                }
            }
            if (volume_of(b[0], b[1], b[2], b[3]) == 0) continue;
            if (volume_of(b[0], b[1], b[2], b[3]) < 0) std::swap(b[0], b[1]);
        }
        const frame_of_grid f = draw_frame(d);
        all.note(relation(on, surface_of<TestType>(a, f), surface_of<TestType>(b, f), {.known_solid = true}), truth_of(a, b));
        all.note(relation(on, surface_of<TestType>(b, f), surface_of<TestType>(a, f), {.known_solid = true}), truth_of(b, a));
    }
    all.print("tetrahedra");
    CHECK(all.wrong == 0);
    for (const std::uint64_t n : all.of) CHECK((n > 0 || count < 1000));
}

TEMPLATE_TEST_CASE("relation: prisms, boxes without corners, and hulls of a small grid, against planes in integers", "", float, double) {
    tally all;
    const serial on;
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 4, 400000);
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20270514, 6, k);
        const int size = 2 + d.below(4);
        polyhedron a = draw_polyhedron(d, size), b = k % 16 == 0 ? a : draw_polyhedron(d, size);
        if (k % 16 == 0) {  // moved, so that sides still lie in one plane
            const grid_place by{d.below(3) - 1, d.below(2), 0};
            for (grid_place& p : b.at) {
                for (std::size_t c = 0; c < 3; ++c) p[c] += by[c];
            }
        }
        if (k % 16 == 1 || k % 16 == 2) {  // a of three times its size, so that b is within it
            for (grid_place& p : a.at) {
                for (int& x : p) x = 3 * x - size;
            }
            a = polyhedron(std::move(a.at));
        }
        if (k % 4 == 3) {  // each on a lattice of its own, and most with a corner on a corner
            a = turned(a, draw_rotation(d));
            b = turned(b, draw_rotation(d));
            const grid_place &to = a.at[static_cast<std::size_t>(d.below(static_cast<int>(a.at.size())))],
                             from = b.at[static_cast<std::size_t>(d.below(static_cast<int>(b.at.size())))];
            const int aside = d.below(4) == 0 ? d.below(3) : 0;
            for (grid_place& p : b.at) {
                for (std::size_t c = 0; c < 3; ++c) p[c] += to[c] - from[c] + aside;
            }
        }
        const frame_of_grid f = draw_frame(d);
        const mesh<TestType> x = surface_of<TestType>(a, f, d), y = surface_of<TestType>(b, f, d);
        all.note(relation(on, x, y, {.known_solid = k % 8 != 0}), truth_of(a, b));
        all.note(relation(on, y, x, {.known_solid = true}), truth_of(b, a));
    }
    all.print("polyhedra");
    CHECK(all.wrong == 0);
    for (const std::uint64_t n : all.of) CHECK((n > 0 || count < 1000));
}

TEMPLATE_TEST_CASE("relation: on each policy", "", float, double) {
    check_relations<TestType>(serial{});
    check_relations<TestType>(openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("relation: scenes of bodies and lists", "", float, double) {
    check_scenes_of_solids<TestType>(serial{}, 20);
    check_scenes_of_solids<TestType>(openmp{.threads = 3}, 4);
}

TEST_CASE("relation: a body that is no solid is named") {
    const serial on;
    cells one;
    one.in.insert({0, 0, 0});
    draws d(1, 1, 1);
    const mesh<float> box = surface_of<float>(one, {}, d);
    std::vector<vec3<float>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::size_t i = 0; i < 8; ++i) vertices.push_back(box.view().vertices[i]);
    for (std::size_t i = 0; i < 11; ++i) faces.push_back(box.view().faces[i]);
    const rigid<float> there{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.5F, 0, 0}};
    const auto good = make_bvh(on, box), open = make_bvh(on, mesh<float>(vertices, faces));
    const std::vector scene{posed(good, there), posed(good, there), posed(open, there)};
    try {
        (void)relation(on, scene);
        FAIL("nothing was thrown");
    } catch (const invalid_geometry& e) {
        CHECK(std::string(e.what()).find("abut::relation: body 2, face") == 0);
    }
}

namespace {

/// A box, and the number of the face that a test spoils.
template <scalar T>
mesh<T> box_between(const vec3<T>& lower, const vec3<T>& upper, bool inwards = false) {
    cells one;
    one.in.insert({0, 0, 0});
    draws d(1, 1, 1);
    const mesh<T> unit = surface_of<T>(one, {}, d, inwards);
    std::vector<vec3<T>> vertices;
    for (std::size_t i = 0; i < unit.view().vertices.count; ++i) {
        const vec3<T> p = unit.view().vertices[i];
        vertices.push_back({p.x == 0 ? lower.x : upper.x, p.y == 0 ? lower.y : upper.y, p.z == 0 ? lower.z : upper.z});
    }
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::size_t i = 0; i < unit.size(); ++i) faces.push_back(unit.view().faces[i]);
    return {std::move(vertices), std::move(faces)};
}

template <scalar T>
mesh<T> joined(const mesh<T>& a, const mesh<T>& b) {
    std::vector<vec3<T>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::uint32_t first = 0;
    for (const mesh<T>* const m : {&a, &b}) {
        for (std::size_t i = 0; i < m->view().vertices.count; ++i) vertices.push_back(m->view().vertices[i]);
        for (std::size_t i = 0; i < m->size(); ++i) {
            auto f = m->view().faces[i];
            for (std::uint32_t& v : f) v += first;
            faces.push_back(f);
        }
        first = static_cast<std::uint32_t>(vertices.size());
    }
    return {std::move(vertices), std::move(faces)};
}

}  // namespace

TEMPLATE_TEST_CASE("relation: a wall, by one unit in the last place", "", float, double) {
    using T = TestType;
    const serial on;
    const mesh<T> wall = box_between<T>({0, 0, 0}, {3, 1, 1});
    const auto next_wall = [&](T from) { return relation(on, wall, box_between<T>({from, 0, 0}, {5, 1, 1})); };
    CHECK(next_wall(static_cast<T>(2.95)) == solid_relation::partially_overlapping);
    CHECK(next_wall(std::nextafter(T{3}, T{0})) == solid_relation::partially_overlapping);
    CHECK(next_wall(3) == solid_relation::externally_connected);
    CHECK(next_wall(std::nextafter(T{3}, T{9})) == solid_relation::disconnected);
    for (const T size : {std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::min(), std::numeric_limits<T>::max() / 4}) {
        const mesh<T> a = box_between<T>({0, 0, 0}, {size, size, size}), b = box_between<T>({size, 0, 0}, {2 * size, size, size});
        CHECK(relation(on, a, b) == solid_relation::externally_connected);
        CHECK(relation(on, a, a) == solid_relation::equal);
        CHECK(relation(on, a, box_between<T>({0, 0, 0}, {2 * size, size, size})) == solid_relation::tangential_part);
    }
    // Exponents of all sizes at once.
    const T tiny = std::numeric_limits<T>::min(), huge = std::numeric_limits<T>::max() / 4;
    const mesh<T> needle = box_between<T>({0, 0, 0}, {huge, tiny, 1});
    CHECK(relation(on, needle, box_between<T>({-1, 0, 0}, {huge, tiny, 2})) == solid_relation::tangential_part);
    CHECK(relation(on, needle, box_between<T>({0, tiny, 0}, {huge, 1, 1})) == solid_relation::externally_connected);
    CHECK(relation(on, needle, box_between<T>({0, 2 * tiny, 0}, {huge, 1, 1})) == solid_relation::disconnected);
}

TEMPLATE_TEST_CASE("relation: hollows, whichever way their faces are turned", "", float, double) {
    using T = TestType;
    const serial on;
    for (const bool out : {false, true}) {
        for (const bool in : {false, true}) {
            const mesh<T> shell = joined(box_between<T>({0, 0, 0}, {8, 8, 8}, out), box_between<T>({2, 2, 2}, {6, 6, 6}, in));
            CHECK(relation(on, shell, box_between<T>({3, 3, 3}, {5, 5, 5})) == solid_relation::disconnected);
            CHECK(relation(on, shell, box_between<T>({2, 2, 2}, {6, 6, 6})) == solid_relation::externally_connected);
            CHECK(relation(on, shell, box_between<T>({2, 3, 3}, {5, 5, 5})) == solid_relation::externally_connected);
            CHECK(relation(on, shell, box_between<T>({1, 3, 3}, {5, 5, 5})) == solid_relation::partially_overlapping);
            CHECK(relation(on, shell, box_between<T>({1, 1, 1}, {7, 7, 7})) == solid_relation::partially_overlapping);
            CHECK(relation(on, box_between<T>({0, 0, 0}, {1, 1, 1}), shell) == solid_relation::tangential_part);
            CHECK(relation(on, shell, box_between<T>({0, 0, 0}, {8, 8, 8})) == solid_relation::tangential_part);
            CHECK(relation(on, shell, shell) == solid_relation::equal);
            const mesh<T> island = joined(shell, box_between<T>({3, 3, 3}, {5, 5, 5}, in));
            CHECK(relation(on, shell, island) == solid_relation::tangential_part);
            CHECK(relation(on, island, box_between<T>({4, 4, 4}, {T(4.5), T(4.5), T(4.5)})) ==
                  solid_relation::nontangential_part_inverse);
        }
    }
    CHECK(relation(on, mesh<T>(), box_between<T>({0, 0, 0}, {1, 1, 1})) == solid_relation::disconnected);
    CHECK_FALSE(overlaps(on, mesh<T>(), mesh<T>()));
}

TEST_CASE("relation: what is no solid is refused, with a face and the reason") {
    const serial on;
    const mesh<float> good = box_between<float>({0, 0, 0}, {1, 1, 1});
    std::vector<vec3<float>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::size_t i = 0; i < 8; ++i) vertices.push_back(good.view().vertices[i]);
    for (std::size_t i = 0; i < 12; ++i) faces.push_back(good.view().faces[i]);
    const auto message_of = [&](const std::vector<vec3<float>>& v, const std::vector<std::array<std::uint32_t, 3>>& f) -> std::string {
        try {
            (void)relation(on, good, mesh<float>(v, f));
        } catch (const invalid_geometry& e) {
            CHECK(e.function() == "abut::relation");
            return std::string(e.what());
        }
        return "";
    };
    CHECK(message_of(vertices, faces).empty());
    auto open = faces;
    open.pop_back();
    CHECK(message_of(vertices, open).find("not closed") != std::string::npos);
    auto turned = faces;
    std::swap(turned[3][0], turned[3][1]);
    CHECK(message_of(vertices, turned).find("turned against each other") != std::string::npos);
    auto flat = faces;
    flat.push_back({faces[0][0], faces[0][1], faces[0][1]});
    CHECK(message_of(vertices, flat).find("no area") != std::string::npos);
    auto more = faces;
    more.insert(more.end(), {{0, 1, 2}, {0, 2, 1}});
    CHECK(!message_of(vertices, more).empty());
    // Two boxes of one mesh that touch in a corner, and two that overlap.
    for (const float at : {1.0F, 0.5F}) {
        const mesh<float> two = joined(good, box_between<float>({at, at, at}, {2, 2, 2}));
        CHECK_THROWS_AS(overlaps(on, two, good), invalid_geometry);
    }
    CHECK_THROWS_AS(overlaps(on, good, mesh<float>(vertices, open)), invalid_geometry);
}

}  // namespace abut::test
