// SPDX-License-Identifier: MIT
//
// Additive CCD (M. Li et al., Codimensional Incremental Potential Contact, 2021) as the IPC Toolkit has it, with its own constants: it ends
// where a tenth of the distance at the start is left.

#include <vector>

#include <ipc/ccd/additive_ccd.hpp>

#include "peer.hpp"

namespace {

using namespace impact_peer;

Eigen::Vector3d made(const abut::vec3<double>& p) { return {p.x, p.y, p.z}; }

void times(kind k, const std::vector<features>& all, std::vector<double>& out) {
    const ipc::AdditiveCCD ccd;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto& p = all[i].t0;
        const auto& q = all[i].t1;
        double time = 0;
        const bool hit = k == kind::vertex_face
                             ? ccd.point_triangle_ccd(made(p[0]), made(p[1]), made(p[2]), made(p[3]), made(q[0]), made(q[1]), made(q[2]),
                                                      made(q[3]), time, 0, 1)
                             : ccd.edge_edge_ccd(made(p[0]), made(p[1]), made(p[2]), made(p[3]), made(q[0]), made(q[1]), made(q[2]),
                                                 made(q[3]), time, 0, 1);
        out[i] = hit ? time : -1;
    }
}

const bool added = [] {
    libraries().push_back({"ACCD", ABUT_IPC_TOOLKIT_VERSION, times});
    return true;
}();

}  // namespace
