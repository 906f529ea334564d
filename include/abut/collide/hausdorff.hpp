// SPDX-License-Identifier: MIT
#pragma once

// hausdorff: how far two surfaces are from each other at most, between proven bounds. The search is in farthest_point.hpp.

#include <algorithm>

#include <abut/collide/farthest_point.hpp>

namespace abut {

/// @addtogroup solids
///@{

/// How far two surfaces are from each other.
struct hausdorff_distance {
    farthest_point a_from_b;  ///< of the points of a, the one that is farthest from b
    farthest_point b_from_a;  ///< and the other way round

    /// Some point of one surface is so far from the other one.
    [[nodiscard]] double lower() const { return std::max(a_from_b.lower, b_from_a.lower); }
    /// No point of either is farther from the other surface.
    [[nodiscard]] double upper() const { return std::max(a_from_b.upper, b_from_a.upper); }
};

/// The Hausdorff distance of two surfaces, in both directions, between proven bounds: `lower` and `upper` differ by
/// `options.tolerance` or less, unless the search has looked at `options.most_pieces` pieces. `a` and `b` are meshes, soups,
/// views or indices of these, posed or not; under a pose it is measured of the placed coordinates. Where one has no
/// triangles both are infinite in the direction from the other one, and 0 where both have none. The same bits on every policy,
/// for every index and number of threads.
///
/// Both are copied to the host and turned into trees of doubles: some 300 bytes a triangle, and 160 for each piece that is
/// looked at. The search itself is one thread of the host; the policy finds nearest points. Returns when all is known; under
/// `cuda` it waits for the policy's stream.
///
/// Throws `error` for a tolerance that is negative or not finite, and as @ref queries do.
///
///     const auto d = abut::hausdorff(on, mesh, other, {.tolerance = 1e-4});
///     std::printf("between %g and %g\n", d.lower(), d.upper());
///
/// Source: N. Aspert, D. Santa-Cruz, T. Ebrahimi, MESH: measuring errors between surfaces using the Hausdorff distance, 2002,
/// has the definition; the bounds are those of M. Tang, M. Lee, Y. Kim, Interactive Hausdorff distance computation for general
/// polygonal models, 2009, with the distance from one face for that from the surface.
template <execution_policy Policy, class X, class Y>
[[nodiscard]] hausdorff_distance hausdorff(const Policy& on, const X& a, const Y& b, const bound_options& options = {}) {
    constexpr const char* function = "abut::hausdorff";
    const auto of_a = detail::triangles_on_host(on, a, function);
    const auto of_b = detail::triangles_on_host(on, b, function);
    detail::unit_of_search unit;
    unit.see(of_a);
    unit.see(of_b);
    const double tolerance = unit.tolerance(options.tolerance, function);
    hausdorff_distance found;
    if (of_a.empty() || of_b.empty()) {
        constexpr double far = infinity<double>;
        if (!of_a.empty()) found.a_from_b.lower = found.a_from_b.upper = far;
        if (!of_b.empty()) found.b_from_a.lower = found.b_from_a.upper = far;
        return found;
    }
    const detail::measured_surface<Policy> x(on, unit.bring(of_a)), y(on, unit.bring(of_b));
    found.a_from_b = unit.back(detail::farthest_search<Policy>(x, y, false).run(tolerance, options.most_pieces));
    found.b_from_a = unit.back(detail::farthest_search<Policy>(y, x, false).run(tolerance, options.most_pieces));
    return found;
}

///@}

}  // namespace abut
