// SPDX-License-Identifier: MIT
//
// The peer: CGAL's test with exact predicates, which are filtered as ours are. Exact where no triangle is degenerate.

#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "peer.hpp"

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

kernel::Point_3 point(const abut::vec3<float>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
kernel::Triangle_3 theirs(const abut::triangle<float>& t) { return {point(t.a), point(t.b), point(t.c)}; }

[[maybe_unused]] const bool registered = triangle_scene::register_peer(
    "cgal", [](const auto& pair) { return std::pair(theirs(pair.a), theirs(pair.b)); },
    [](const auto& pair) { return CGAL::do_intersect(pair.first, pair.second); });

}  // namespace
