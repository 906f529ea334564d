// SPDX-License-Identifier: MIT
//
// How solids lie to each other whose parts are on many ranks: what one machine says of them, and what their cells say.

#include <abut/mpi.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "collide/solid_cases.hpp"
#include "distributed/world.hpp"

namespace abut::test {

namespace {

/// The faces of a mesh by their corners, and meshes of some of them, whose vertices have numbers in the order in which faces
/// name them.
template <scalar T>
std::vector<triangle<T>> corners_of_faces(const mesh<T>& m) {
    std::vector<triangle<T>> all;
    for (std::size_t f = 0; f < m.size(); ++f) all.push_back(m.view()[f]);
    return all;
}
template <scalar T>
mesh<T> mesh_by_place(const std::vector<triangle<T>>& all) {
    std::map<std::array<T, 3>, std::uint32_t> number;
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    for (const auto& t : all) {
        const vec3<T> corners[3] = {t.a, t.b, t.c};
        std::uint32_t v[3];
        for (int k = 0; k < 3; ++k) {
            const auto& p = corners[k];
            const auto [at, fresh] = number.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(vertices.size()));
            if (fresh) vertices.push_back(p);
            v[k] = at->second;
        }
        faces.push_back({v[0], v[1], v[2]});
    }
    return {vertices, faces};
}

template <scalar T>
bool same_patches(const std::vector<contact_patch<T>>& some, const std::vector<contact_patch<T>>& others) {
    if (some.size() != others.size()) return false;
    for (std::size_t i = 0; i < some.size(); ++i) {
        const auto &p = some[i], &q = others[i];
        if (p.center != q.center || p.normal != q.normal || p.area != q.area || p.depth != q.depth || p.deepest_a != q.deepest_a ||
            p.deepest_b != q.deepest_b || p.points != q.points || p.curves.size() != q.curves.size()) {
            return false;
        }
        for (std::size_t k = 0; k < p.curves.size(); ++k) {
            if (p.curves[k].points != q.curves[k].points || p.curves[k].features_a != q.curves[k].features_a) return false;
        }
    }
    return true;
}

template <scalar T>
std::vector<global_crossing<T>> in_all_parts(const std::vector<crossing<T>>& all) {
    std::vector<global_crossing<T>> out;
    for (const auto& c : all) {
        global_crossing<T> g{c.a, c.b, c.count, c.coplanar, {}, {}, {}};
        std::copy(c.in_a, c.in_a + 6, g.in_a);
        std::copy(c.in_b, c.in_b + 6, g.in_b);
        std::copy(c.points, c.points + 6, g.points);
        out.push_back(g);
    }
    return out;
}

}  // namespace

TEST_CASE("distributed: crossings") {
    const distributed on(world(), serial{});
    std::size_t areas = 0, lines = 0;
    for (std::uint64_t k = 0; k < 16; ++k) {
        draws d(20270514, 9, k);
        const auto [a, b] = draw_two_of_all_kinds(d, k);
        const auto x = corners_of_faces(surface_of<float>(a, frame_of_grid{}, d)), y = corners_of_faces(surface_of<float>(b, frame_of_grid{}, d));
        rigid<float> near;
        near.translation = {k % 2 == 0 ? 0 : 0.375f, 0, 0};
        const auto expected = in_all_parts(to_host(crossings(serial{}, mesh_by_place(x), posed(mesh_by_place(y), near))));
        for (const auto& c : expected) ++(c.count > 2 ? areas : lines);
        const auto part_x = mesh_by_place(part_of(x, divisions[k % 4], on.rank(), on.size()));
        const auto part_y = mesh_by_place(part_of(y, division::uneven, on.rank(), on.size()));
        CHECK((lists_of_all(on.ranks(), to_host(crossings(on, part_x, posed(make_bvh(on.local(), part_y), near)))) == expected));
        CHECK((lists_of_all(on.ranks(), to_host(crossings<exact>(on, make_bvh(on.local(), part_x), posed(part_y, near)))) == expected));
        auto both = x;
        for (const auto& t : y) both.push_back({t.a + near.translation, t.b + near.translation, t.c + near.translation});
        const auto among = in_all_parts(to_host(self_crossings(serial{}, mesh_by_place(both), {.coincident = coincident_vertices::merged})));
        const auto part = mesh_by_place(part_of(both, divisions[k % 4], on.rank(), on.size()));
        CHECK((lists_of_all(on.ranks(), to_host(self_crossings(on, part, {.coincident = coincident_vertices::merged}))) == among));
    }
    CHECK(areas > 100);
    CHECK(lines > 100);
}

TEST_CASE("distributed: relations of solids in parts") {
    const distributed on(world(), serial{});
    std::uint64_t of[8] = {}, wrong = 0, patches = 0;
    for (std::uint64_t k = 0; k < 96; ++k) {
        draws d(20270514, 7, k);
        const auto [a, b] = draw_two_of_all_kinds(d, k);
        const frame_of_grid f = draw_frame(d);
        const auto x = corners_of_faces(surface_of<double>(a, f, d)), y = corners_of_faces(surface_of<double>(b, f, d));
        const division how = divisions[k % 4];
        const auto part_x = mesh_by_place(part_of(x, how, on.rank(), on.size()));
        const auto part_y = mesh_by_place(part_of(y, division::uneven, on.rank(), on.size()));
        const auto tree = make_bvh(on.local(), part_y);
        const solid_relation truth = truth_of(a, b);
        ++of[static_cast<int>(truth)];
        wrong += relation(on, part_x, tree) != truth;
        wrong += relation<exact>(on, part_x, part_y, {.known_solid = true}) != truth;
        wrong += relation(on, triangle_soup<double>(part_of(x, how, on.rank(), on.size())), posed(tree, rigid<double>{}), {.known_solid = true}) != truth;
        wrong += overlaps(on, part_x, tree, {.known_solid = k % 2 == 0}) != (truth > solid_relation::externally_connected);
        const auto one = contact_patches(serial{}, mesh_by_place(x), mesh_by_place(y), {.known_solid = true});
        const auto all = contact_patches(on, part_x, tree, {.known_solid = k % 2 == 1});
        patches += one.size();
        wrong += !on_all(on.ranks(), on.rank() == 0 ? same_patches(all, one) : all.empty());
    }
    CHECK(wrong == 0);
    CHECK(patches > 50);
    for (const std::uint64_t some : of) CHECK(some > 0);
}

TEST_CASE("distributed: stretches of rays inside") {
    const distributed on(world(), serial{});
    std::size_t stretches = 0;
    for (std::uint64_t k = 0; k < 8; ++k) {
        draws d(20270514, 8, k);
        const auto x = surface_of<float>(draw_two_sets(d, k).first, frame_of_grid{}, d);
        const auto lines = draw_rays_of_grid<float>(d, 600);
        std::vector<global_ray_span<float>> expected;
        const auto global = [](std::uint32_t id) { return id == ray_span<float>::no_face ? global_ray_span<float>::no_face : std::uint64_t{id}; };
        const inside_options by{.known_closed = true, .rule = k % 2 == 0 ? inside_rule::parity : inside_rule::positive};
        for (const auto& s : spans(serial{}, x, rays<float>(lines), by)) expected.push_back({s.ray, global(s.enter), global(s.leave), s.from, s.to});
        stretches += expected.size();
        const auto part = mesh_by_place(part_of(corners_of_faces(x), divisions[k % 4], on.rank(), on.size()));
        const rays<float> mine(part_of(lines, divisions[k / 4], on.rank(), on.size()));
        CHECK((lists_of_all(on.ranks(), spans(on, part, mine, by)) == expected));
        CHECK((lists_of_all(on.ranks(), spans<exact>(on, make_bvh(on.local(), part), mine, by)) == expected));
        CHECK_THROWS_AS(spans(on, part, mine), error);
    }
    CHECK(stretches > 400);
}

TEST_CASE("distributed: relations of lists, and what is no solid") {
    const distributed on(world(), serial{});
    const mesh<float> part({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    const auto tree = make_bvh(serial{}, part);
    std::vector<posed_pair<std::remove_const_t<decltype(tree)>>> list;
    for (int i = 0; i < 13; ++i) {
        rigid<float> away;
        away.translation = {static_cast<float>(i) / 2, 0, 0};
        list.push_back({posed(tree, rigid<float>{}), posed(tree, away)});
    }
    const auto expected = relation(serial{}, list);
    CHECK(expected.front() == solid_relation::equal);
    CHECK(expected[8] == solid_relation::externally_connected);
    const auto mine_of_list = part_of(list, division::uneven, on.rank(), on.size());
    CHECK(lists_of_all(on.ranks(), relation(on, mine_of_list)) == expected);
    CHECK(lists_of_all(on.ranks(), overlaps(on, mine_of_list)) == overlaps(serial{}, list));
    std::vector<std::size_t> number, number_of_mine;
    for (const auto& some : contact_patches(serial{}, list)) number.push_back(some.size());
    for (const auto& some : contact_patches(on, mine_of_list)) number_of_mine.push_back(some.size());
    CHECK(lists_of_all(on.ranks(), number_of_mine) == number);
    std::vector<double> depth, depth_of_mine;
    for (const auto& some : penetration(serial{}, list, {.tolerance = 0.1})) depth.push_back(some.least);
    for (const auto& some : penetration(on, mine_of_list, {.tolerance = 0.1})) depth_of_mine.push_back(some.least);
    CHECK(lists_of_all(on.ranks(), depth_of_mine) == depth);
    std::vector<global_tagged_crossing<float>> common;
    for (const auto& c : to_host(crossings(serial{}, list))) common.push_back({c.pair, c.a, c.b, c.common});
    CHECK(common.size() > 50);
    CHECK((lists_of_all(on.ranks(), to_host(crossings(on, mine_of_list))) == common));
    // All but one face, on the last rank alone.
    const mesh<float> open({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}), none;
    const auto& mine = on.rank() + 1 == on.size() ? open : none;
    std::string said;
    try {
        (void)relation(on, mine, on.rank() == 0 ? part : none);
    } catch (const error& e) {
        said = e.what();
    }
    CHECK(on_all(on.ranks(), said.find("the mesh is not closed") != std::string::npos));
    // Two that pass through each other, of one solid.
    auto twice = corners_of_faces(part);
    for (const auto& t : corners_of_faces(part)) twice.push_back({t.a + vec3<float>{1, 1, 1}, t.b + vec3<float>{1, 1, 1}, t.c + vec3<float>{1, 1, 1}});
    said = "";
    try {
        (void)overlaps(on, mesh_by_place(part_of(twice, division::even, on.rank(), on.size())), on.rank() == 0 ? part : none);
    } catch (const error& e) {
        said = e.what();
    }
    CHECK(on_all(on.ranks(), said.find("passes through itself") != std::string::npos));
    CHECK(relation(on, none, none) == solid_relation::disconnected);
}

}  // namespace abut::test
