// SPDX-License-Identifier: MIT
//
// Meshes in motion of which each of several policies has a part: their impacts are those of the whole meshes, bit for bit,
// and each comes once, also of features on the border of two parts.

#include "devices/host_team.hpp"

#include "devices/device_cases.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace abut::test {

namespace {

using device_cases::message_of;
using device_cases::shaken;

/// A ball's surface with each tenth face twice, and vertices that no face has, some near it.
template <scalar T>
surface_data<T> odd_surface(int levels, double radius) {
    auto data = ball_surface<T>(levels, radius);
    const std::size_t faces = data.faces.size(), vertices = data.vertices.size();
    for (std::size_t i = 0; i < faces; i += 10) data.faces.push_back(data.faces[i]);
    for (std::size_t i = 0; i < vertices; i += 3) data.vertices.push_back(data.vertices[i]);
    const auto last = static_cast<std::uint32_t>(vertices - 1);
    data.faces.push_back({last, last, 0});
    data.faces.push_back({1, 1, 1});
    return data;
}

/// The parts of a divided mesh one after another, each with vertices of its own.
template <scalar T>
moving_set<mesh<T>> one_after_another(const std::vector<moving_set<mesh<T>>>& parts) {
    std::vector<vec3<T>> t0, t1;
    std::vector<face> faces;
    for (const auto& part : parts) {
        const auto first = static_cast<std::uint32_t>(t0.size());
        const auto at_t0 = part.t0().view(), at_t1 = part.t1().view();
        for (std::size_t i = 0; i < at_t0.vertices.count; ++i) {
            t0.push_back(at_t0.vertices[i]);
            t1.push_back(at_t1.vertices[i]);
        }
        for (std::size_t i = 0; i < at_t0.faces.count; ++i) {
            const auto [a, b, c] = at_t0.faces[i];
            faces.push_back({first + a, first + b, first + c});
        }
    }
    const mesh<T> first(t0, faces);
    return moving(first, first.with_vertices(serial{}, t1));
}

/// The parts have the faces of the whole mesh, once, as many as the others, and just the vertices of these.
template <class Team, scalar T, class Divided>
void check_parts(const Team& team, const moving_set<mesh<T>>& whole, const Divided& parts) {
    std::vector<int> faces(whole.size());
    std::set<std::uint32_t> vertices;
    bool same = true, used = true;
    const auto w0 = whole.t0().view(), w1 = whole.t1().view();
    std::size_t least = whole.size(), most = 0;
    for (int k = 0; k < team.size(); ++k) {
        const auto p0 = parts[k].t0().view(), p1 = parts[k].t1().view();
        least = std::min(least, p0.faces.count);
        most = std::max(most, p0.faces.count);
        std::vector<int> named(p0.vertices.count);
        for (std::uint32_t i = 0; i < p0.faces.count; ++i) {
            const std::uint32_t id = parts.face_ids(k)(i);
            ++faces[id];
            for (std::size_t c = 0; c < 3; ++c) {
                same = same && parts.vertex_ids(k)(p0.faces[i][c]) == w0.faces[id][c];
                named[p0.faces[i][c]] = 1;
            }
        }
        for (std::uint32_t i = 0; i < p0.vertices.count; ++i) {
            const std::uint32_t id = parts.vertex_ids(k)(i);
            same = same && p0.vertices[i].x == w0.vertices[id].x && p1.vertices[i].y == w1.vertices[id].y;
            used = used && (named[i] == 1 || k == 0);
            vertices.insert(id);
        }
    }
    CHECK((same && used && vertices.size() == w0.vertices.count && most - least <= 1));
    CHECK(std::all_of(faces.begin(), faces.end(), [](int n) { return n == 1; }));
}

template <scalar T, class Team>
void check_divided_impacts(const Team& team) {
    const auto a = shaken(odd_surface<T>(2, 1.0), vec3<T>{T(0.5), 0, 0}, 1);
    const auto b = shaken(odd_surface<T>(2, 0.75), vec3<T>{T(-0.5), T(0.25), 0}, 2);
    const auto expected = to_host(impacts(serial{}, a, b));
    CAPTURE(team.size(), expected.size());
    CHECK(expected.size() > 500);
    const auto parts_a = divide_mesh(team, a), parts_b = divide_mesh(team, b);
    check_parts(team, a, parts_a);
    check_parts(team, b, parts_b);
    CHECK((parts_a.size() == a.size() && parts_a.devices() == team.size()));

    CHECK(to_host(impacts(team, parts_a, parts_b)) == expected);
    const auto index_a = make_impact_index(team, parts_a), index_b = make_impact_index(team, parts_b);
    CHECK(to_host(impacts(team, index_a, index_b)) == expected);
    CHECK(to_host(impacts(team, index_a, parts_b, {.sorted = false})) == expected);
    CHECK(to_host(impacts(team, index_a, make_impact_index(team, b))) == expected);
    CHECK(to_host(impacts(team, a, index_b)) == expected);
    CHECK(to_host(impacts<exact>(team, index_a, index_b)) == expected);
    const impact_options near{.bounds = {.tolerance = 0x1p-10, .separation = 0.0625}};
    CHECK(to_host(impacts<conservative>(team, index_a, index_b, near)) ==
          to_host(impacts<conservative>(serial{}, a, b, near)));
    CHECK(to_host(impacts(team, index_a, divide_mesh(team, b.t0()))) == to_host(impacts(serial{}, a, b.t0())));

    const auto first = first_impact(serial{}, a, b);
    CHECK(first_impact(team, index_a, index_b) == first);
    CHECK(first_impact(team, index_a, b) == first);
    CHECK(first_impact(team, a, parts_b) == first);

    // Later and later, the last not at all. All in front comes at one time, to features of several parts.
    for (const T x0 : {T(-3), T(-12), T(-90)}) {
        const auto data = ball_surface<T>(2, 0.75);
        auto t0 = data.vertices, t1 = data.vertices;
        for (auto& p : t0) p.x += x0;
        for (auto& p : t1) p.x += x0 < T(-80) ? x0 + 1 : T(3);
        const mesh<T> at_t0(t0, data.faces);
        const auto comes = moving(at_t0, at_t0.with_vertices(serial{}, t1));
        const auto arrives = first_impact(serial{}, comes, b);
        CHECK((arrives ? arrives->time > 1.0 / 16 : x0 < T(-80)));
        CHECK(first_impact(team, divide_mesh(team, comes), index_b) == arrives);
        CHECK(first_impact(team, divide_mesh(team, comes), b) == arrives);
        CHECK(first_impact(team, index_b, divide_mesh(team, comes)) == first_impact(serial{}, b, comes));
    }
    const std::vector<vec3<T>> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const mesh<T> square(corners, std::vector<face>{{0, 1, 2}, {0, 2, 3}});
    const auto lifted = [&](T z) {
        auto up = corners;
        for (auto& p : up) p.z = z;
        return square.with_vertices(serial{}, up);
    };
    const auto falls = moving(lifted(1), lifted(-1)), rises = moving(lifted(-1), lifted(1));  // all of it at one time
    CHECK(first_impact(serial{}, falls, rises)->time > 0);
    CHECK(first_impact(team, divide_mesh(team, falls), divide_mesh(team, rises)) == first_impact(serial{}, falls, rises));
    CHECK(to_host(impacts(team, divide_mesh(team, falls), divide_mesh(team, rises))) ==
          to_host(impacts(serial{}, falls, rises)));

    // What only comes near: no part's boxes touch those of another.
    const auto above = lifted(T(0.5)), below = lifted(T(-0.5));
    const impact_options wide{.bounds = {.separation = 1.5}};
    const auto near_each_other = to_host(impacts<conservative>(serial{}, above, below, wide));
    CHECK(near_each_other.size() > 10);
    CHECK(to_host(impacts<conservative>(team, divide_mesh(team, above), divide_mesh(team, below), wide)) == near_each_other);
    CHECK(first_impact<conservative>(team, divide_mesh(team, above), divide_mesh(team, below), wide) ==
          first_impact<conservative>(serial{}, above, below, wide));

    // Parts with vertices of their own.
    std::vector<moving_set<mesh<T>>> given_a, given_b;
    for (int k = 0; k < team.size(); ++k) {
        given_a.push_back(shaken(ball_surface<T>(2, 1.0), vec3<T>{T(0.25) * T(k), 0, 0}, static_cast<unsigned>(k + 3)));
        given_b.push_back(
            k == 1 ? moving_set<mesh<T>>()
                   : shaken(ball_surface<T>(1, 0.75), vec3<T>{0, T(-0.25) * T(k), 0}, static_cast<unsigned>(k + 9)));
    }
    const divided_mesh there_a(given_a), there_b(given_b);
    const auto whole_a = one_after_another(given_a), whole_b = one_after_another(given_b);
    CHECK(to_host(impacts(team, there_a, there_b)) == to_host(impacts(serial{}, whole_a, whole_b)));
    CHECK(first_impact(team, there_a, there_b) == first_impact(serial{}, whole_a, whole_b));

    // Nothing, and fewer faces than there are parts.
    CHECK(impacts(team, parts_a, divide_mesh(team, mesh<T>())).size() == 0);
    CHECK(first_impact(team, divide_mesh(team, mesh<T>()), b) == std::nullopt);
    const mesh<T> one(std::vector<vec3<T>>{{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}, std::vector<face>{{0, 1, 2}});
    CHECK(to_host(impacts(team, index_a, divide_mesh(team, one))) == to_host(impacts(serial{}, a, one)));
    CHECK(to_host(impacts(team, divide_mesh(team, one), index_a)) == to_host(impacts(serial{}, one, a)));
}

/// One mesh with itself: two surfaces that pass through each other, and a sheet that folds onto itself.
template <scalar T, class Team>
void check_divided_self_impacts(const Team& team) {
    const auto a = shaken(odd_surface<T>(2, 1.0), vec3<T>{T(0.5), 0, 0}, 1);
    const auto b = shaken(odd_surface<T>(2, 0.75), vec3<T>{T(-0.5), T(0.25), 0}, 2);
    const auto both = one_after_another(std::vector{a, b});
    const auto expected = to_host(self_impacts(serial{}, both));
    CAPTURE(team.size(), expected.size());
    CHECK(expected.size() > to_host(impacts(serial{}, a, b)).size());
    const auto parts = divide_mesh(team, both);
    CHECK(to_host(self_impacts(team, parts)) == expected);
    const auto index = make_impact_index(team, parts);
    CHECK(to_host(self_impacts(team, index, {.sorted = false})) == expected);
    CHECK(to_host(self_impacts<exact>(team, index)) == expected);
    CHECK(to_host(self_impacts(team, divide_mesh(team, both.t0()))) == to_host(self_impacts(serial{}, both.t0())));
    const impact_options near{.bounds = {.tolerance = 0x1p-10, .separation = 0.0625}};
    CHECK(to_host(self_impacts<conservative>(team, index, near)) == to_host(self_impacts<conservative>(serial{}, both, near)));
    const auto first = first_self_impact(serial{}, both);
    CHECK(first.has_value());
    CHECK(first_self_impact(team, parts) == first);
    CHECK(first_self_impact<exact>(team, index) == first);
    CHECK(first_self_impact<conservative>(team, index, near) == first_self_impact<conservative>(serial{}, both, near));

    // A sheet folds along its middle: late, so that what shares a vertex, which always touches, must not be taken for it.
    constexpr std::uint32_t side = 17;
    std::vector<vec3<T>> flat, folded;
    std::vector<face> faces;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const T x = T(i % side) - T(8), y = T(i / side) - T(8);
        flat.push_back({x, y, x * x / T(64)});
        folded.push_back(x > 0 ? vec3<T>{T(0.25) - x, y + T(0.125), T(1) - x / T(16)} : flat.back());
        if (i % side + 1 < side && i / side + 1 < side) {
            faces.push_back({i, i + 1, i + side + 1});
            faces.push_back({i, i + side + 1, i + side});
        }
    }
    const mesh<T> at_t0(flat, faces);
    const auto folds = moving(at_t0, at_t0.with_vertices(serial{}, folded));
    const auto meets = first_self_impact(serial{}, folds);
    CHECK((meets && meets->time > 0.25));
    const auto sheet = divide_mesh(team, folds);
    CHECK(first_self_impact(team, sheet) == meets);
    const auto of_sheet = to_host(self_impacts(serial{}, folds));
    CHECK(of_sheet.size() > 100);
    CHECK(to_host(self_impacts(team, sheet)) == of_sheet);

    // Parts with vertices of their own, one of them empty.
    std::vector<moving_set<mesh<T>>> given;
    for (int k = 0; k < team.size(); ++k) {
        given.push_back(
            k == 1 ? moving_set<mesh<T>>()
                   : shaken(ball_surface<T>(2, 1.0), vec3<T>{T(0.25) * T(k), 0, 0}, static_cast<unsigned>(k + 3)));
    }
    const divided_mesh there(given);
    const auto whole = one_after_another(given);
    CHECK(to_host(self_impacts(team, there)) == to_host(self_impacts(serial{}, whole)));
    CHECK(first_self_impact(team, there) == first_self_impact(serial{}, whole));

    // Nothing, and fewer faces than there are parts.
    const mesh<T> one(std::vector<vec3<T>>{{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}, std::vector<face>{{0, 1, 2}});
    CHECK(self_impacts(team, divide_mesh(team, mesh<T>())).size() == 0);
    CHECK(self_impacts(team, divide_mesh(team, one)).size() == 0);
    CHECK(first_self_impact(team, divide_mesh(team, one)) == std::nullopt);
}

}  // namespace

TEST_CASE("devices: impacts of a divided mesh with itself") {
    const int n = GENERATE(1, 2, 3, 5);
    check_divided_self_impacts<float>(host_team<serial>(n));
}

TEST_CASE("devices: impacts of a divided mesh with itself, in double, on several threads each") {
    check_divided_self_impacts<double>(host_team<openmp>(3, openmp{.threads = 2}));
}

TEST_CASE("devices: impacts of divided meshes") {
    const int n = GENERATE(1, 2, 3, 5);
    check_divided_impacts<float>(host_team<serial>(n));
}

TEST_CASE("devices: impacts of divided meshes, in double, on several threads each") {
    check_divided_impacts<double>(host_team<openmp>(3, openmp{.threads = 2}));
}

TEST_CASE("devices: impacts of divided meshes: errors") {
    const host_team<serial> two(2), three(3);
    const mesh<float> one(std::vector<vec3<float>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<face>{{0, 1, 2}});
    const auto parts = divide_mesh(two, one);
    CHECK(message_of([&] { (void)impacts(three, parts, one); }) ==
          "abut::impacts: the argument lies on 2 devices, the call is to 3");
    CHECK(message_of([&] { (void)first_impact(three, one, parts); }) ==
          "abut::first_impact: the argument lies on 2 devices, the call is to 3");
    CHECK(message_of([&] { (void)make_impact_index(three, parts); }) ==
          "abut::make_impact_index: the argument lies on 2 devices, the call is to 3");
    CHECK(message_of([&] { (void)self_impacts(three, parts); }) ==
          "abut::self_impacts: the argument lies on 2 devices, the call is to 3");
    CHECK(message_of([&] { (void)first_self_impact(three, parts); }) ==
          "abut::first_self_impact: the argument lies on 2 devices, the call is to 3");
    const impact_options bad{.bounds = {.separation = -1}};
    CHECK(message_of([&] { (void)impacts<conservative>(two, parts, parts, bad); }).find("separation is -1") !=
          std::string::npos);
    CHECK(message_of([&] { (void)first_impact<conservative>(two, parts, parts, bad); }).find("separation is -1") !=
          std::string::npos);
    CHECK(impacts(two, parts, parts).size() == impacts(serial{}, one, one).size());  // and the next call works
}

}  // namespace abut::test
