// SPDX-License-Identifier: MIT
//
// libigl's fast_winding_number of triangles, as its own function calls it: in floats, of the second order, with an accuracy of 2.

#include <memory>

#include <igl/FastWindingNumberForSoups.h>

#include "peer.hpp"

namespace {

using point = igl::FastWindingNumber::HDK_Sample::UT_Vector3T<float>;
using tree = igl::FastWindingNumber::HDK_Sample::UT_SolidAngle<float, float>;

/// The tree refers to both lists.
struct made {
    std::vector<point> points;
    std::vector<int> corners;
    tree of;
};
point point_of(const abut::vec3<float>& p) {
    point q;
    q[0] = p.x, q[1] = p.y, q[2] = p.z;
    return q;
}

const bool added = [] {
    winding_peer::libraries().push_back(
        {"libigl", ABUT_LIBIGL_VERSION, {2, 1, 1.5, 3, 4, 6, 8}, [](const winding_peer::surface& s) -> winding_peer::ask {
             const auto index = std::make_shared<made>();
             for (const auto& p : s.vertices) index->points.push_back(point_of(p));
             for (const auto& f : s.faces) {
                 for (int k = 0; k < 3; ++k) index->corners.push_back(static_cast<int>(f[static_cast<std::size_t>(k)]));
             }
             index->of.init(static_cast<int>(s.faces.size()), index->corners.data(), static_cast<int>(s.vertices.size()),
                            index->points.data(), 2);
             return [index](const std::vector<abut::vec3<float>>& from, double accuracy, std::vector<double>& out) {
                 for (std::size_t i = 0; i < from.size(); ++i) {
                     const float angle = index->of.computeSolidAngle(point_of(from[i]), static_cast<float>(accuracy));
                     out[i] = static_cast<double>(angle) / (4 * 3.141592653589793);
                 }
             };
         }});
    return true;
}();

}  // namespace
