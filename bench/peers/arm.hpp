// SPDX-License-Identifier: MIT
#pragma once

// States of a robot's arm for bench_peers: eight links, capsules and boxes in turn, in a room of boxes or against a mesh; and abut's
// answer, which of the states collide. Where the links are is given. A link may touch what is allowed.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>
#include <abut/index/wide.hpp>

#include "abut.hpp"
#include "peer.hpp"

namespace peers {

using collisions = std::vector<std::uint8_t>;

struct arm_scene {
    std::vector<shape> links;                       ///< the even ones capsules, the odd ones boxes
    std::vector<std::vector<abut::rigid<double>>> poses;  ///< of each state, of its links
    std::vector<abut::oriented_box<double>> room;   ///< empty where there is a mesh
    std::vector<vec3> vertices;
    std::vector<abut::face> faces;

    /// The first link stands on the floor, which is the first box.
    [[nodiscard]] ABUT_HD static bool is_allowed(std::size_t link, std::size_t in_room) { return link == 0 && in_room == 0; }
};

/// A library's way to tell which states collide; made once of a scene.
struct arm_checker {
    std::string name;
    std::function<std::function<void(collisions&)>(const arm_scene&)> make;
};
inline std::vector<arm_checker>& arm_checkers() {
    static std::vector<arm_checker> all;
    return all;
}

/// Joints that turn about two axes in turn; the states are on straight ways between random ones, as a planner tries them.
template <class Draws>
arm_scene make_arm(Draws& d, std::size_t states, bool mesh) {
    arm_scene s;
    constexpr std::size_t links = 8;
    for (std::size_t k = 0; k < links; ++k) {
        if (k % 2 == 0) {
            s.links.push_back({"capsule", kind::capsule, 0.0625, 0.125});
        } else {
            s.links.push_back({"box", kind::box, 0, 0, {0.0625, 0.046875, 0.1875}});
        }
    }
    double from[links] = {}, to[links] = {};
    for (std::size_t i = 0; i < states; ++i) {
        if (i % 50 == 0) {
            for (std::size_t k = 0; k < links; ++k) from[k] = d(-1.2, 1.2), to[k] = d(-1.2, 1.2);
        }
        std::vector<abut::rigid<double>> of_links;
        abut::rigid<double> joint{.translation = {0, 0, 0.25}};
        for (std::size_t k = 0; k < links; ++k) {
            const double angle = from[k] + (to[k] - from[k]) * static_cast<double>(i % 50) / 50, c = std::cos(angle), n = std::sin(angle);
            abut::rigid<double> turn;
            if (k % 2 == 0) {
                turn = {.rotation = {1, 0, 0, 0, c, -n, 0, n, c}, .translation = {0, 0, 0}};
            } else {
                turn = {.rotation = {c, 0, n, 0, 1, 0, -n, 0, c}, .translation = {0, 0, 0}};
            }
            joint = compose(joint, turn);
            of_links.push_back(compose(joint, abut::rigid<double>{.translation = {0, 0, 0.1875}}));
            joint = compose(joint, abut::rigid<double>{.translation = {0, 0, 0.375}});
        }
        s.poses.push_back(of_links);
    }
    if (!mesh) {
        s.room.push_back({{0, 0, -0.5}, {3, 3, 0.5}});
        while (s.room.size() < 100) {
            const abut::rigid<double> pose = d.turned({d(-2.5, 2.5), d(-2.5, 2.5), d(0, 3)});
            if (dot(pose.translation, pose.translation) < 1) continue;
            abut::oriented_box<double> box{pose.translation, {d(0.03, 0.25), d(0.03, 0.25), d(0.03, 0.25)}};
            for (int k = 0; k < 9; ++k) box.rotation[k] = pose.rotation[k];
            s.room.push_back(box);
        }
        return s;
    }
    // A tube around the arm's foot, and above it.
    constexpr std::uint32_t around = 200, across = 50;
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = 6.283185307179586 * i / around, v = 6.283185307179586 * j / across, r = 1.5 + 0.5 * std::cos(v);
            s.vertices.push_back({r * std::cos(u), r * std::sin(u), 1 + 0.5 * std::sin(v)});
            const auto at = [&](std::uint32_t p, std::uint32_t q) { return p % around * across + q % across; };
            s.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return s;
}

/// Of row i, which is of link first + 2 * (i % per_state), and what lies there.
struct allowed_links {
    std::size_t first, per_state;
    bool in_room;
    ABUT_HD bool operator()(std::uint32_t row, std::uint32_t id) const {
        return !(in_room && arm_scene::is_allowed(first + 2 * (row % per_state), id));
    }
};

/// A link where it is.
inline abut::capsule<double> capsule_of(const shape& link, const abut::rigid<double>& pose) {
    return place(pose, made<kind::capsule>(link));
}
inline abut::oriented_box<double> box_of(const shape& link, const abut::rigid<double>& pose) {
    abut::oriented_box<double> box{pose.translation, link.halves};
    for (int k = 0; k < 9; ++k) box.rotation[k] = pose.rotation[k];
    return box;
}

/// Links of one kind, of the states that are free so far. What meets the index collides.
template <abut::arithmetic A, class Index, class Rows, class Make>
void check_links(const Index& index, const arm_scene& s, std::size_t first, const Make& make, collisions& out) {
    std::vector<std::uint32_t> open;
    std::vector<Rows> rows;
    open.reserve(s.poses.size());
    rows.reserve(s.poses.size() * s.links.size() / 2);
    for (std::uint32_t i = 0; i < s.poses.size(); ++i) {
        if (out[i] != 0) continue;
        open.push_back(i);
        for (std::size_t k = first; k < s.links.size(); k += 2) rows.push_back(make(s.links[k], s.poses[i][k]));
    }
    const std::size_t per_state = s.links.size() / 2;
    const auto met = abut::any_each<A>(abut::serial{}, index, abut::shapes_view<Rows>(rows.data(), rows.size()),
                                       abut::each_options<allowed_links>{{first, per_state, !s.room.empty()}, per_state});
    for (std::size_t i = 0; i < met.size(); ++i) out[open[i]] = met[i];
}

template <abut::arithmetic A>
std::function<void(collisions&)> abut_arm(const arm_scene& s) {
    const auto checker = [&s](const auto& index) {
        return [&s, index](collisions& out) {
            out.assign(s.poses.size(), 0);
            check_links<A, std::remove_cvref_t<decltype(index)>, abut::capsule<double>>(index, s, 0, capsule_of, out);
            check_links<A, std::remove_cvref_t<decltype(index)>, abut::oriented_box<double>>(index, s, 1, box_of, out);
        };
    };
    const abut::serial on;
    if (s.room.empty()) {
        return checker(wide(on, make_bvh(on, abut::mesh<double>(s.vertices, s.faces), {.builder = abut::bvh_builder::sah})));
    }
    return checker(wide(on, make_bvh(on, abut::oriented_boxes<double>(s.room), {.builder = abut::bvh_builder::sah})));
}

}  // namespace peers
