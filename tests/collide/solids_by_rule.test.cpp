// SPDX-License-Identifier: MIT
#include <abut/collide/relation.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"
#include "support/samples.hpp"

// Solids that are taken by how often their surfaces go round a point. The oracle counts boxes around each cell of a grid, and looks
// at the eight cells around each of its points.

namespace abut::test {

namespace {

/// Boxes of a grid in one mesh, each turned outwards or inwards, in any place: they overlap, touch and are there twice.
struct box_heap {
    struct part {
        grid_place from, to;
        int turns;
    };
    std::vector<part> parts;
    bool is_welded = false;

    [[nodiscard]] int turns_at(const grid_place& cell) const {
        int turns = 0;
        for (const part& p : parts) {
            bool is_in = true;
            for (std::size_t i = 0; i < 3; ++i) is_in &= p.from[i] <= cell[i] && cell[i] < p.to[i];
            if (is_in) turns += p.turns;
        }
        return turns;
    }
    template <scalar T>
    [[nodiscard]] mesh<T> surface(const frame_of_grid& frame, draws& d) const {
        std::vector<vec3<T>> vertices;
        std::vector<std::array<std::uint32_t, 3>> faces;
        std::map<grid_place, std::uint32_t> number;
        const auto& m = frame.map;
        const bool is_mirrored = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) < 0;
        for (const part& p : parts) {
            cells one;
            one.in.insert({0, 0, 0});
            // A box is a cell whose corners are moved.
            const mesh<double> unit = surface_of<double>(one, {}, d, (p.turns < 0) != is_mirrored);
            if (!is_welded) number.clear();
            std::vector<std::uint32_t> of;
            for (std::size_t v = 0; v < 8; ++v) {
                const vec3<double> c = unit.view().vertices[v];
                const grid_place at{c.x > 0 ? p.to[0] : p.from[0], c.y > 0 ? p.to[1] : p.from[1], c.z > 0 ? p.to[2] : p.from[2]};
                const auto [known, fresh] = number.try_emplace(at, static_cast<std::uint32_t>(vertices.size()));
                if (fresh) vertices.push_back(frame.operator()<T>(at));
                of.push_back(known->second);
            }
            for (std::size_t f = 0; f < unit.size(); ++f) {
                const auto face = unit.view().faces[f];
                faces.push_back({of[face[0]], of[face[1]], of[face[2]]});
            }
        }
        return {std::move(vertices), std::move(faces)};
    }
};

constexpr int grid_end = 7;

bool is_inside_by(inside_rule rule, int turns) {
    return rule == inside_rule::parity ? turns % 2 != 0 : rule == inside_rule::nonzero ? turns != 0 : turns > 0;
}

solid_relation truth_by(inside_rule rule, const box_heap& a, const box_heap& b) {
    const auto in = [&](const box_heap& of, int x, int y, int z) { return is_inside_by(rule, of.turns_at({x, y, z})); };
    bool both = false, first = false, second = false, touch = false;
    for (int x = -1; x <= grid_end; ++x) {
        for (int y = -1; y <= grid_end; ++y) {
            for (int z = -1; z <= grid_end; ++z) {
                const bool is_a = in(a, x, y, z), is_b = in(b, x, y, z);
                both |= is_a && is_b;
                first |= is_a && !is_b;
                second |= is_b && !is_a;
                bool of[4] = {};  // cells around the lower corner: in a, out of a, in b, out of b
                for (int k = 0; k < 8; ++k) {
                    of[in(a, x - k % 2, y - k / 2 % 2, z - k / 4) ? 0 : 1] = true;
                    of[in(b, x - k % 2, y - k / 2 % 2, z - k / 4) ? 2 : 3] = true;
                }
                touch |= of[0] && of[1] && of[2] && of[3];
            }
        }
    }
    if (!both) return touch ? solid_relation::externally_connected : solid_relation::disconnected;
    if (first && second) return solid_relation::partially_overlapping;
    if (second) return touch ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (first) return touch ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    return solid_relation::equal;
}

box_heap draw_heap(draws& d, int most) {
    box_heap heap;
    for (int k = 1 + d.below(most); k > 0; --k) {
        box_heap::part p{};
        const int size = 1 + d.below(6);
        for (std::size_t i = 0; i < 3; ++i) {
            p.from[i] = d.below(5);
            p.to[i] = std::min(p.from[i] + 1 + d.below(size), grid_end);
        }
        p.turns = d.below(4) == 0 ? -1 : 1;
        heap.parts.push_back(p);
        if (d.below(8) == 0) heap.parts.push_back(p);
    }
    heap.is_welded = d.below(2) == 0;
    return heap;
}

/// Two of them. Of some the second has what the rule says of the first, cell by cell, or a cell more or less.
std::pair<box_heap, box_heap> draw_two_heaps(draws& d, std::uint64_t k, inside_rule rule) {
    box_heap a = draw_heap(d, 4), b = draw_heap(d, 3);
    if (k % 4 == 0) {
        b.parts.clear();
        for (int i = 0; i < grid_end * grid_end * grid_end; ++i) {
            const grid_place c{i % grid_end, i / grid_end % grid_end, i / grid_end / grid_end};
            if (is_inside_by(rule, a.turns_at(c))) b.parts.push_back({c, {c[0] + 1, c[1] + 1, c[2] + 1}, 1});
        }
        if (b.parts.empty() || b.parts.size() > 24) b.parts = a.parts;
        if (k % 8 == 0 && b.parts.size() > 1) b.parts.erase(b.parts.begin() + d.below(static_cast<int>(b.parts.size())));
    }
    if (k % 8 == 1) a.parts.push_back({{0, 0, 0}, {7, 7, 7}, 1}), b.parts.resize(1);
    if (k % 3 == 0) std::swap(a, b);
    return {a, b};
}

}  // namespace

TEMPLATE_TEST_CASE("relation by a rule: heaps of boxes, against the cells of a grid", "", float, double) {
    std::uint64_t wrong = 0, of[8] = {};
    const std::uint64_t count = some_samples(40);
    const serial on;
    for (std::uint64_t k = 0; k < count; ++k) {
        draws d(20271129, 1, k);
        const inside_rule rule = std::array{inside_rule::parity, inside_rule::nonzero, inside_rule::positive}[k / 8 % 3];
        const auto [a, b] = draw_two_heaps(d, k, rule);
        const frame_of_grid f = draw_frame(d);
        const mesh<TestType> x = a.surface<TestType>(f, d), y = b.surface<TestType>(f, d);
        const solid_relation truth = truth_by(rule, a, b), said = relation(on, x, y, {.rule = rule});
        ++of[static_cast<int>(truth)];
        if (said != truth && wrong++ < 3) std::printf("%llu: said %s, is %s\n", static_cast<unsigned long long>(k), name_of(said), name_of(truth));
        wrong += overlaps(on, make_bvh(on, x), y, {.known_solid = true, .rule = rule}) != (truth > solid_relation::externally_connected);
    }
    std::printf("heaps: %llu pairs;", static_cast<unsigned long long>(count));
    for (int i = 0; i < 8; ++i) std::printf(" %s %llu", name_of(static_cast<solid_relation>(i)), static_cast<unsigned long long>(of[i]));
    std::printf("\n");
    CHECK(wrong == 0);
    for (int i = 0; i < 8; ++i) CHECK(of[i] > count / 200);
}

TEST_CASE("relation by a rule: a cell whose corners are each of three faces") {
    const serial on;
    draws d(20271129, 3, 0);
    // Three plates cross in one cell, which no diagonal of a side passes. A box that is turned inwards is around them twice: only
    // there the surface goes round once the right way.
    box_heap a, around, away;
    a.parts = {{{1, 0, 0}, {2, 7, 7}, 1}, {{0, 5, 0}, {7, 6, 7}, 1}, {{0, 0, 3}, {7, 9, 4}, 1},
               {{-1, -1, -1}, {8, 10, 8}, -1}, {{-1, -1, -1}, {8, 10, 8}, -1}};
    around.parts = {{{0, 4, 2}, {3, 7, 5}, 1}};
    away.parts = {{{2, 4, 2}, {4, 7, 5}, 1}};
    const solid_options by{.rule = inside_rule::positive};
    const frame_of_grid f = draw_frame(d);
    const auto cell = a.surface<double>(f, d);
    CHECK(relation(on, cell, around.surface<double>(f, d), by) == solid_relation::nontangential_part);
    CHECK(overlaps(on, cell, around.surface<double>(f, d), by));
    CHECK(relation(on, away.surface<double>(f, d), cell, by) == solid_relation::externally_connected);
    CHECK(relation(on, cell, cell, by) == solid_relation::equal);
}

TEST_CASE("relation by a rule: what is refused, and bodies as one by one") {
    const serial on;
    draws d(20271129, 2, 0);
    box_heap heap;
    heap.parts = {{{0, 0, 0}, {3, 3, 3}, 1}, {{2, 0, 0}, {5, 3, 3}, 1}};
    const mesh<double> closed = heap.surface<double>(draw_frame(d), d);
    std::vector<face> faces;
    for (std::size_t f = 0; f < closed.size(); ++f) faces.push_back(closed.view().faces[f]);
    std::vector<vec3<double>> vertices;
    for (std::size_t v = 0; v < closed.view().vertices.count; ++v) vertices.push_back(closed.view().vertices[v]);
    const solid_options by{.rule = inside_rule::nonzero};
    CHECK_THROWS_AS(relation(on, closed, closed), invalid_geometry);
    CHECK(relation(on, closed, closed, by) == solid_relation::equal);

    const mesh<double> open(vertices, std::vector<face>(faces.begin() + 1, faces.end()));
    CHECK_THROWS_AS(relation(on, open, closed, by), invalid_geometry);
    CHECK_THROWS_AS(overlaps(on, closed, open, by), invalid_geometry);
    std::swap(faces[0][1], faces[0][2]);
    const mesh<double> turned(vertices, faces);
    CHECK_THROWS_AS(relation(on, turned, closed, by), invalid_geometry);
    CHECK(relation(on, turned, closed, {.rule = inside_rule::parity}) != solid_relation::disconnected);
    CHECK_THROWS_AS(overlaps(on, sphere<double>{{0, 0, 0}, 1}, closed, by), error);

    const auto tree = make_bvh(on, closed);
    const std::vector<posed_pair<std::remove_cvref_t<decltype(tree)>>> list{{posed(tree, rigid<double>{}), posed(tree, rigid<double>{})}};
    CHECK(relation(on, list, by) == std::vector{solid_relation::equal});
}

}  // namespace abut::test
