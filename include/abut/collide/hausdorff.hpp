// SPDX-License-Identifier: MIT
#pragma once

// hausdorff: how far two surfaces are from each other at most, between proven bounds. The search is in farthest_point.hpp.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/collide/farthest_point.hpp>
#include <abut/collide/solid_entries.hpp>

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

///@}

namespace detail {

/// Of two surfaces on the host.
template <class Policy, scalar T>
hausdorff_distance hausdorff_of(const Policy& on, const std::vector<triangle<T>>& of_a, const std::vector<triangle<T>>& of_b,
                                const bound_options& options) {
    unit_of_search unit;
    unit.see(of_a);
    unit.see(of_b);
    const double tolerance = unit.tolerance(options.tolerance);
    hausdorff_distance found;
    if (of_a.empty() || of_b.empty()) {
        constexpr double far = infinity<double>;
        if (!of_a.empty()) found.a_from_b.lower = found.a_from_b.upper = far;
        if (!of_b.empty()) found.b_from_a.lower = found.b_from_a.upper = far;
        return found;
    }
    const measured_surface<Policy> x(on, unit.bring(of_a)), y(on, unit.bring(of_b));
    found.a_from_b = unit.back(farthest_search<Policy>(x, y, false).run(tolerance, options.most_pieces));
    found.b_from_a = unit.back(farthest_search<Policy>(y, x, false).run(tolerance, options.most_pieces));
    return found;
}

/// Of each entry of a list (solid_entries.hpp). Surfaces need bound no solid.
struct hausdorff_of_entries {
    static constexpr const char* function = "abut::hausdorff";
    template <scalar>
    using answer = hausdorff_distance;
    bound_options options;

    template <class Entries>
    [[nodiscard]] std::vector<hausdorff_distance> find(Entries& entries) const {
        constexpr bool are = std::remove_cvref_t<decltype(entries.a())>::are_of_triangles && std::remove_cvref_t<decltype(entries.b())>::are_of_triangles;
        static_assert(are, "abut: surfaces are of triangles: meshes, soups, and indices of these");
        std::vector<hausdorff_distance> found;
        if constexpr (are) {
            unit_of_search::check_tolerance(options.tolerance, function);
            for (std::size_t i = 0; i < entries.size(); ++i) {
                found.push_back(hausdorff_of(entries.policy(), triangles_of_faces(entries.a().faces(entries[i].a).first),
                                             triangles_of_faces(entries.b().faces(entries[i].b).first), options));
            }
        }
        return found;
    }
};

}  // namespace detail

/// @addtogroup solids
///@{

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
    detail::unit_of_search::check_tolerance(options.tolerance, function);
    return detail::hausdorff_of(on, detail::triangles_on_host(on, a, function), detail::triangles_on_host(on, b, function), options);
}

/// The same of each entry of a list, in its order: a std::vector of `hausdorff_distance` in host memory. Of several devices each
/// has its share of the entries, and a rank gets those of its own ones. Memory and time are those of one entry after another, and
/// 50 bytes a triangle of each body in float, 90 in double. A message about a pose has the entry.
template <executor On, class IndexA, class IndexB>
[[nodiscard]] std::vector<hausdorff_distance> hausdorff(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                                        const bound_options& options = {}) {
    return ask_solid_list(on, detail::hausdorff_of_entries{options}, list);
}

///@}

}  // namespace abut
