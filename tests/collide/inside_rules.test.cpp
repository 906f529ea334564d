// SPDX-License-Identifier: MIT

// What is inside by other rules than parity, against the boxes that a mesh is made of; doubled bodies, which cancel; and signs of
// distances from open meshes.

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"

namespace abut::test {

namespace {

template <class T>
struct boxes_in_one {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    struct box {
        int l[3], u[3];
        bool turned;
    };
    std::vector<box> all;

    void add(const box& b) {
        all.push_back(b);
        const auto first = static_cast<std::uint32_t>(vertices.size());
        for (unsigned k = 0; k < 8; ++k) {
            const auto at = [&](int axis) { return static_cast<T>((k >> axis & 1u) != 0 ? b.u[axis] : b.l[axis]); };
            vertices.push_back({at(0), at(1), at(2)});
        }
        const face outward[12] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
        for (const face& f : outward) faces.push_back({f[0] + first, f[b.turned ? 2 : 1] + first, f[b.turned ? 1 : 2] + first});
    }
    [[nodiscard]] abut::mesh<T> made() const { return {vertices, faces}; }
};

}  // namespace

TEMPLATE_TEST_CASE("inside by a rule: boxes that overlap, against each box", "", float, double) {
    std::mt19937 random(3);
    std::size_t more_than_one = 0, below_0 = 0;
    for (int round = 0; round < 20; ++round) {
        boxes_in_one<TestType> m;
        for (int k = 0; k < 4; ++k) {
            typename boxes_in_one<TestType>::box b{{0, 0, 0}, {0, 0, 0}, random() % 3 == 0};
            for (int axis = 0; axis < 3; ++axis) {
                b.l[axis] = static_cast<int>(random() % 4);
                b.u[axis] = b.l[axis] + 2 + static_cast<int>(random() % 4);
            }
            m.add(b);
        }
        std::vector<vec3<TestType>> points;
        for (int i = 0; i < 400; ++i) {
            const auto half = [&] { return static_cast<TestType>(random() % 33) / 4; };
            const TestType x = half(), y = half(), z = half();
            points.push_back({x, y, z});
        }
        const auto tree = make_bvh(serial{}, m.made());
        for (const inside_rule rule : {inside_rule::parity, inside_rule::nonzero, inside_rule::positive}) {
            const auto found = to_host(inside(serial{}, tree, points, {.rule = rule}));
            CHECK(to_host(inside(openmp{.threads = 2}, m.made(), points, {.rule = rule})) == found);
            CHECK(to_host(inside<exact>(serial{}, posed(tree, rigid<TestType>{}), points, {.known_closed = true, .rule = rule})) == found);
            const auto signs = to_host(signed_distance(serial{}, tree, points, {.rule = rule}));
            for (std::size_t i = 0; i < points.size(); ++i) {
                const TestType p[3] = {points[i].x, points[i].y, points[i].z};
                int turns = 0;
                bool is_on = false;
                for (const auto& b : m.all) {
                    bool in = true, on_rim = false;
                    for (int axis = 0; axis < 3; ++axis) {
                        const auto l = static_cast<TestType>(b.l[axis]), u = static_cast<TestType>(b.u[axis]);
                        in = in && p[axis] >= l && p[axis] <= u;
                        on_rim = on_rim || p[axis] == l || p[axis] == u;
                    }
                    is_on = is_on || (in && on_rim);
                    turns += in ? b.turned ? -1 : 1 : 0;
                }
                more_than_one += !is_on && turns > 1;
                below_0 += !is_on && turns < 0;
                const bool is_in = rule == inside_rule::parity ? turns % 2 != 0 : rule == inside_rule::nonzero ? turns != 0 : turns > 0;
                REQUIRE(found[i] == (is_on ? containment::on_surface : is_in ? containment::inside : containment::outside));
                CHECK((signs[i].distance < 0) == (!is_on && is_in));
            }
        }
    }
    CHECK(more_than_one > 200);
    CHECK(below_0 > 200);
}

TEST_CASE("inside by a rule: faces that are turned against each other are refused, of parity they are not") {
    boxes_in_one<float> m;
    m.add({{0, 0, 0}, {2, 2, 2}, false});
    std::swap(m.faces[0][0], m.faces[0][1]);
    const std::vector<vec3<float>> points{{1, 1, 1}};
    CHECK(to_host(inside(serial{}, m.made(), points))[0] == containment::inside);
    CHECK_THROWS_AS(inside(serial{}, m.made(), points, {.rule = inside_rule::nonzero}), invalid_geometry);
}

TEST_CASE("inside: a cube whose faces are all there twice is refused if asked, and rooms with a common wall are not") {
    const std::vector<vec3<float>> points{{1, 1, 1}};
    for (const bool turned : {true, false}) {
        boxes_in_one<float> m;
        m.add({{8, 8, 8}, {9, 9, 9}, false});
        m.add({{0, 0, 0}, {2, 2, 2}, false});
        for (std::size_t f = 12; f < 24; ++f) {
            const face c = m.faces[f];
            m.faces.push_back(turned ? face{c[0], c[2], c[1]} : face{c[1], c[2], c[0]});
        }
        CHECK(to_host(inside(serial{}, m.made(), points, {.check = false}))[0] == containment::outside);
        std::string message;
        try {
            (void)inside(openmp{.threads = 2}, make_bvh(serial{}, m.made()), points, {.check = true});
        } catch (const invalid_geometry& e) {
            CHECK(e.index() == 24);
            CHECK(e.value() == 12);
            message = e.what();
        }
        CHECK(message.find("duplicate face") != std::string::npos);
        CHECK_THROWS_AS(spans(serial{}, m.made(), rays<float>({{{1, 1, 1}, {1, 0, 0}}}), {.check = true}), invalid_geometry);
        // Turned alike they go round twice.
        if (!turned) {
            CHECK(to_host(inside(serial{}, m.made(), points, {.rule = inside_rule::positive, .check = true}))[0] == containment::inside);
        } else {
            CHECK_THROWS_AS(inside(serial{}, m.made(), points, {.rule = inside_rule::nonzero, .check = true}), invalid_geometry);
        }
        // A third time: odd again.
        for (std::size_t f = 12; f < 24; ++f) m.faces.push_back(m.faces[f]);
        CHECK(to_host(inside(serial{}, m.made(), points, {.check = true}))[0] == containment::inside);
    }
    boxes_in_one<float> rooms;
    rooms.add({{0, 0, 0}, {2, 2, 2}, false});
    rooms.add({{2, 0, 0}, {4, 2, 2}, false});
    const auto welded_rooms = welded(serial{}, rooms.made());
    const auto report = validate(serial{}, welded_rooms);
    if (report.duplicate_faces.empty()) {  // the wall is cut one way on both sides, or both
        CHECK(report.nonmanifold_edges.size() >= 4);
    }
    CHECK(to_host(inside(serial{}, welded_rooms, points, {.check = true}))[0] == containment::inside);
    // Cut alike.
    const std::uint32_t wall[3] = {1, 3, 5};
    boxes_in_one<float> again = rooms;
    again.faces.push_back({wall[0], wall[1], wall[2]});
    again.faces.push_back({wall[0], wall[2], wall[1]});
    CHECK(to_host(inside(serial{}, again.made(), points, {.check = true}))[0] == containment::inside);
}

TEMPLATE_TEST_CASE("signed_distance of an open mesh: the sign of the winding number", "", float, double) {
    boxes_in_one<TestType> m;
    m.add({{-4, -4, -4}, {4, 4, 4}, false});
    m.faces.erase(m.faces.begin() + 3);  // half of the lid
    std::vector<vec3<TestType>> points{{0, 0, 0}, {0, 0, -3}, {0, 0, -5}, {9, 0, 0}, {-4, 0, 0}, {1, 1, 2}, {0, 0, 9}};
    CHECK_THROWS_AS(signed_distance(serial{}, m.made(), points), invalid_geometry);
    const bool in[7] = {true, true, false, false, false, true, false};
    for (const bool inverted : {false, true}) {
        auto part = m;
        if (inverted) {
            for (face& f : part.faces) std::swap(f[0], f[1]);
        }
        const auto tree = make_bvh(serial{}, part.made());
        const auto found = to_host(signed_distance(serial{}, tree, points, winding_options{.tolerance = 0.1}));
        const auto near = to_host(nearest(serial{}, tree, points));
        for (std::size_t i = 0; i < points.size(); ++i) {
            CHECK(found[i].id == near[i].id);
            CHECK(found[i].distance == (in[i] ? -near[i].distance : near[i].distance));
        }
        CHECK(found[4].distance == 0);
        const auto other = to_host(signed_distance(openmp{.threads = 2}, tree, points, winding_options{.tolerance = 0.1}));
        for (std::size_t i = 0; i < points.size(); ++i) CHECK(other[i].distance == found[i].distance);
    }
}

}  // namespace abut::test
