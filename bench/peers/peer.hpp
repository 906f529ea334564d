// SPDX-License-Identifier: MIT
#pragma once

// What the libraries of bench_peers share: shapes in their own frames, the questions, and the form in which each answers. Not for
// what only one of them has.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <abut/shape/hulls.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/view.hpp>

namespace peers {

using vec3 = abut::vec3<double>;

enum class kind { sphere, capsule, box, cylinder, cone, hull };

/// A convex shape of about the size 1 whose axis, if it has one, is z. All numbers are short.
struct shape {
    std::string name;
    kind of;
    double radius = 0;              ///< of a sphere, a capsule, a cylinder, the base of a cone
    double half = 0;                ///< of the axis; the middle is the origin, the apex of a cone is at +half
    vec3 halves{0, 0, 0};           ///< of a box
    std::vector<vec3> points{};     ///< of a hull
    std::vector<abut::face> faces{};  ///< of a hull, seen from outside counterclockwise
    std::shared_ptr<const abut::hulls<double>> with_edges{};  ///< of a hull, if abut gets it with edges
};

struct pose_pair {
    abut::rigid<double> a, b;
};

enum class question { boolean, distance, contact };

/// Of a boolean only `touch`. Of a distance the points and how far apart they are; of a contact the unit normal from a to b and the
/// depth, if they touch.
struct answer {
    bool touch = false;
    double length = 0;
    vec3 point_a{0, 0, 0}, point_b{0, 0, 0}, normal{0, 0, 0};
};

/// Answers all, into a list that is as long: one call, so that its own cost is none.
using ask = std::function<void(const std::vector<pose_pair>&, std::vector<answer>&)>;

struct library {
    std::string name, version;
    std::function<ask(const shape& a, const shape& b, question)> make;
};

/// abut first.
inline std::vector<library>& libraries() {
    static std::vector<library> all;
    return all;
}

}  // namespace peers
