// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <cstdio>
#include <vector>

#include "expect.hpp"

namespace {

const abut::mesh<float> tetrahedron{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
const abut::spheres<float> balls{{{{1, 1, -2}, 2}, {{9, 9, 9}, 1}, {{4, 0, 0}, 0}}};

//! [queries]
// A filter and a visitor are functors. For cuda they are trivially copyable and marked ABUT_HD.
struct not_ball_0 {
    ABUT_HD bool operator()(std::uint32_t, std::uint32_t ball) const { return ball != 0; }
};
struct mark_ball {
    bool* marked;
    ABUT_HD abut::visit operator()(abut::index_pair pair) const {
        marked[pair.b] = true;
        return abut::visit::proceed;
    }
};

void query() {
    const abut::serial on;
    const auto index = abut::make_bvh(on, tetrahedron);
    for (const auto [face, ball] : abut::to_host(abut::pairs(on, index, balls))) {
        std::printf("face %u touches ball %u\n", face, ball);
    }
    expect(abut::any(on, index, balls));
    expect(abut::count(on, index, balls) == 4);
    expect(abut::count<abut::exact>(on, tetrahedron, balls) == 4);  // without an index, integers at once

    const abut::query_options<not_ball_0> some{.sorted = false, .filter = {}};
    expect(abut::count(on, index, balls, some) == 3);

    bool marked[3] = {};
    abut::for_each_pair(on, index, balls, mark_ball{marked});
    expect(marked[0] && !marked[1] && marked[2]);

    abut::rigid<float> up;  // moves by 5 along z, turns nothing
    up.translation = {0, 0, 5};
    expect(!abut::any(on, abut::posed(index, up), balls));
}
//! [queries]

void query_lists() {
    abut::rigid<float> here, near, far;
    near.translation = {2, 0, 0};
    far.translation = {9, 0, 0};
    //! [lists]
    const abut::serial on;
    auto part = abut::make_bvh(on, tetrahedron);  // not const: its type is that of the list's elements
    const std::vector<abut::posed_pair<decltype(part)>> list{{abut::posed(part, here), abut::posed(part, near)},
                                                             {abut::posed(part, here), abut::posed(part, far)}};
    expect(abut::any(on, list));
    for (const auto& hit : abut::to_host(abut::pairs(on, list))) {
        expect(hit.pair == 0);  // the entry; hit.a and hit.b are faces
    }
    expect(abut::to_host(abut::within(on, list, 5)).back().pair == 1);  // whose two are 5 apart
    //! [lists]
    expect(abut::count(on, list) == abut::contacts(on, list).size());
}

void query_bodies() {
    abut::rigid<float> here, near, far;
    near.translation = {2, 0, 0};
    far.translation = {9, 0, 0};
    //! [many_bodies]
    const abut::serial on;
    auto part = abut::make_bvh(on, tetrahedron);  // not const, as for a list of pairs
    const std::vector<abut::posed_object<decltype(part)>> bodies{abut::posed(part, here), abut::posed(part, near),
                                                                 abut::posed(part, far)};
    expect(abut::any(on, bodies));
    for (const auto& hit : abut::to_host(abut::pairs(on, bodies))) {
        expect(hit.body_a == 0 && hit.body_b == 1);  // hit.a and hit.b are faces of theirs
    }
    auto scene = abut::make_bodies(on, bodies);  // for more than one question
    scene = abut::refit(on, scene, std::vector{here, far, near});
    for (const auto& touch : abut::to_host(abut::contacts(on, scene))) expect(touch.body_b == 2);
    expect(abut::count_within(on, scene, 5) > abut::count(on, scene));  // bodies 0 and 1, and 1 and 2
    auto ball = abut::make_bvh(on, abut::spheres<float>({{{0, 0, 0}, 1}}));
    const auto mixed = abut::make_bodies(on, bodies, std::vector{abut::posed(ball, near)});  // balls beside meshes
    expect(abut::touching_bodies(on, mixed).size() == 3);  // bodies 0 and 1, and the ball, which is body 3, with both
    //! [many_bodies]
    expect(abut::count(on, bodies) == abut::count(on, scene) && abut::count(on, scene) > 0);
}

void query_itself() {
    //! [self_collision]
    // Faces 0 and 1 share an edge, and face 2 pierces face 0.
    const abut::mesh<float> folded{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {1, 1, -1}, {1, 1, 1}, {1, 2, 1}},
                                   {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}}};
    const auto found = abut::to_host(abut::self_pairs(abut::serial{}, folded));
    expect(found.size() == 1 && found[0] == abut::index_pair{0, 2});  // neighbours are not reported
    //! [self_collision]
}

void query_contacts() {
    const abut::serial on;
    //! [contacts]
    for (const auto& c : abut::to_host(abut::contacts(on, tetrahedron, balls))) {
        std::printf("face %u, ball %u: %g deep at %g %g %g\n", c.a, c.b, c.depth, c.point.x, c.point.y, c.point.z);
    }
    const auto few = abut::reduce_contacts(on, abut::contacts(on, tetrahedron, balls), {.most = 2});
    expect(few.size() == 2);
    //! [contacts]
}

void query_nearest() {
    //! [nearest]
    const std::vector<abut::vec3<float>> points{{1, 1, -3}, {9, 0, 0}};
    const auto near = abut::to_host(abut::nearest(abut::serial{}, tetrahedron, points));
    expect(near[0].id == 0 && near[0].distance == 3);                              // below face 0
    expect(near[1].point == abut::vec3<float>{4, 0, 0} && near[1].distance == 5);  // from a corner
    //! [nearest]
    //! [nearest few]
    const std::vector<abut::vec3<float>> cloud{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}, {5, 0, 0}};
    const auto tree = abut::make_bvh(abut::serial{}, abut::points<float>(cloud));
    const auto few = abut::to_host(abut::nearest(abut::serial{}, tree, cloud, 3));  // itself, and two more, of each
    expect(few[0].id == 0 && few[1].id == 1 && few[2].id == 2 && few[2].distance == 3);
    //! [nearest few]
}

void query_distance() {
    const abut::serial on;
    //! [distance]
    const abut::triangle<float> above{{1, 1, 7}, {2, 1, 7}, {1, 2, 9}};
    const auto apart = abut::distance(on, abut::make_bvh(on, tetrahedron), above);
    expect(apart && apart->b == 0 && apart->distance == abut::distance(on, tetrahedron, above)->distance);
    expect(!abut::distance(on, tetrahedron, above, {.below = 1}));          // nothing is nearer than 1
    expect(abut::distance(on, tetrahedron, tetrahedron)->distance == 0);    // it touches itself
    expect(abut::distance(above, abut::vec3<float>{1, 1, 4}).distance == 3);  // of two shapes
    //! [distance]
}

void query_within() {
    const abut::serial on;
    //! [within]
    const abut::points<float> cloud({{0, 0, 0}, {3, 4, 0}, {0, 0, 9}});
    const auto tree = abut::make_bvh(on, cloud);
    for (const auto [i, j] : abut::to_host(abut::self_within(on, tree, 5))) std::printf("points %u and %u\n", i, j);
    expect(abut::count_self_within(on, tree, 4.999) == 0);                  // 5 is the distance, exactly
    const auto near = abut::to_host(abut::within(on, tetrahedron, tree, 5));  // faces and points
    expect(near.size() == abut::count_within(on, tetrahedron, tree, 5));
    expect(abut::any_within(on, tetrahedron, abut::vec3<float>{1, 1, -3}, 3));     // of face 0
    expect(abut::within(abut::vec3<float>{3, 4, 0}, abut::vec3<float>{0, 0, 0}, 5));  // of two shapes
    //! [within]
}

void query_rays() {
    //! [raycast]
    const abut::rays<float> rays({{{1, 1, -3}, {0, 0, 2}}, {{9, 9, 9}, {1, 0, 0}}});
    const auto hits = abut::to_host(abut::raycast(abut::serial{}, tetrahedron, rays));
    expect(hits[0].id == 0 && hits[0].t == 1.5f);  // face 0, from below
    expect(hits[1].id == abut::no_id);             // nothing
    //! [raycast]
    //! [raycast_detailed]
    const auto detailed = abut::to_host(abut::raycast_detailed(abut::serial{}, tetrahedron, rays, {.most_t = 2}));
    expect(detailed[0].hit == hits[0] && detailed[0].side == abut::ray_side::front && detailed[0].weights.x > 0);
    //! [raycast_detailed]
    //! [sweep]
    const abut::spheres<float> moved_balls({{{1, 1, -4}, 1}, {{9, 9, 9}, 1}});
    const abut::points<float> ways({{0, 0, 6}, {1, 0, 0}});
    const auto touched = abut::to_host(abut::sweep(abut::serial{}, tetrahedron, moved_balls, ways));
    expect(touched[0].id == 0 && touched[0].t == 0.5f);  // face 0, from below, when the centre is at -1
    expect(touched[0].normal == abut::vec3<float>{0, 0, -1});
    expect(touched[1].id == abut::no_id);                // nothing
    //! [sweep]
    //! [raycast_any]
    const abut::segments<float> to_light({{{1, 1, -3}, {1, 1, 9}}, {{1, 1, -3}, {1, 1, -1}}});
    const auto in_shadow = abut::raycast_any(abut::serial{}, tetrahedron, to_light);
    expect(in_shadow[0] == 1 && in_shadow[1] == 0);
    //! [raycast_any]
    //! [raycast_all]
    const auto all = abut::to_host(abut::raycast_all(abut::serial{}, tetrahedron, rays));
    expect(all.size() == 2 && all[0] == abut::hit_of_ray<float>{0, 0, 1.5f});  // ray 0 enters at face 0
    expect(all[1].ray == 0 && all[1].t == 2.5f);                               // and leaves
    //! [raycast_all]
}

void query_crossings() {
    const abut::serial on;
    //! [crossings]
    const abut::mesh<float> square{{{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto found = abut::crossings(on, tetrahedron, square);
    expect(found.size() == abut::count(on, tetrahedron, square));
    const auto lines = abut::curves(on, found);
    expect(lines.size() == 1 && lines[0].closed);
    expect(lines[0].features_a[0].part == abut::mesh_part::on_edge);  // of the tetrahedron
    //! [crossings]
}

void query_relation() {
    const abut::serial on;
    //! [relation]
    const abut::rigid<float> beside{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {4, 0, 0}};
    const auto other = abut::posed(tetrahedron, beside);
    expect(abut::relation(on, tetrahedron, tetrahedron) == abut::solid_relation::equal);
    expect(abut::relation(on, tetrahedron, other) == abut::solid_relation::externally_connected);
    expect(!abut::overlaps(on, tetrahedron, other));
    //! [relation]
}

void query_inside() {
    const abut::serial on;
    //! [inside]
    const std::vector<abut::vec3<float>> points{{1, 1, 1}, {9, 0, 0}, {0, 0, 2}};
    const auto where = abut::inside(on, abut::make_bvh(on, tetrahedron), points);
    expect(where[0] == abut::containment::inside && where[1] == abut::containment::outside);
    expect(where[2] == abut::containment::on_surface);  // on an edge
    //! [inside]
    //! [signed_distance]
    const auto near = abut::signed_distance(on, tetrahedron, points);
    expect(near[0].distance < 0 && near[1].distance == 5 && near[2].distance == 0);
    //! [signed_distance]
    //! [winding_number]
    const std::vector<abut::face> three{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};  // one face is missing
    const abut::mesh<float> open({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, three);
    const auto around = abut::winding_number(on, abut::make_bvh(on, open), points, {.tolerance = 1e-6});
    expect(around[0] > 0.6 && around[1] < 0.1);
    //! [winding_number]
    //! [make_winding_index]
    const auto index = abut::make_winding_index(on, abut::make_bvh(on, open, {.builder = abut::bvh_builder::sah}));
    expect(abut::winding_number(on, index, points[0], {.tolerance = 1e-6})[0] > 0.6);
    //! [make_winding_index]
    //! [winding_number_exact]
    const auto counts = abut::winding_number<abut::exact>(on, tetrahedron, points);
    expect(counts[0].turns == 1 && counts[1].turns == 0 && counts[2].on_surface);
    //! [winding_number_exact]
}

void query_mesh() {
    //! [validate]
    const auto report = abut::validate(abut::serial{}, tetrahedron);
    expect(report.closed() && report.manifold() && report.oriented());
    expect(report.edges == 6 && report.euler_characteristic == 2);
    for (const auto& edge : report.boundary_edges) std::printf("open: %u-%u\n", edge.a, edge.b);
    //! [validate]
}

void query_one_pair() {
    //! [one_pair]
    constexpr abut::triangle<float> floor{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    constexpr abut::sphere<float> ball{{0, 0, 4}, 5};
    static_assert(abut::intersects(ball, floor));  // also at run time, on hosts and devices

    const auto c = abut::contact_of(ball, floor);
    expect(c && c->depth == 1 && c->normal == abut::vec3<float>{0, 0, 1});

    const auto q = abut::nearest_point(floor, {0, 0, 7});
    expect(q == abut::vec3<float>{0, 0, 0});

    const auto falls = abut::moving(abut::vec3<float>{0, 0, 1}, abut::vec3<float>{0, 0, -3});
    expect(abut::time_of_impact(falls, abut::moving(floor, floor)) == 0.25);
    //! [one_pair]
}

void query_patches() {
    const abut::serial on;
    //! [contact_patches]
    const abut::aabb<float> table{{-9, -9, -1}, {9, 9, 0.5f}};
    const auto found = abut::contact_patches(on, tetrahedron, table);
    expect(found.size() == 1 && found[0].depth == 0.5f);
    expect(found[0].curves.size() == 1 && found[0].points.size() == 3);
    //! [contact_patches]
}

}  // namespace

int main() {
    query();
    query_lists();
    query_bodies();
    query_itself();
    query_contacts();
    query_nearest();
    query_distance();
    query_within();
    query_rays();
    query_crossings();
    query_relation();
    query_patches();
    query_inside();
    query_mesh();
    query_one_pair();
}
