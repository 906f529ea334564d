// SPDX-License-Identifier: MIT
#pragma once

// crossings, self_crossings: where the faces of one mesh and those of another, or of one mesh, cross: points, segments and
// polygons. They are `pairs` and `self_pairs` with another answer, as contacts are. What joins them to curves is
// collide/curves.hpp.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/narrow/crossing_points.hpp>
#include <abut/shape/crossing.hpp>

namespace abut {

/// @defgroup crossings Where surfaces cross
///
/// `crossings` of two arguments, and `self_crossings` of one: of each pair of faces that meet what they have in common.
/// `curves` joins that to lines.
///
/// @par Memory
/// Arguments as in @ref queries. Crossings lie in the policy's memory, 120 bytes each in float and 192 in double.
///
/// @par Errors
/// Those of @ref queries.
///
/// @par Synchronisation
/// Each call returns when its crossings are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp crossings
///@{

namespace detail {

template <scalar T>
ABUT_HD constexpr const triangle<T>& triangle_of(const triangle<T>& t) {
    return t;
}
template <scalar T>
ABUT_HD constexpr const triangle<T>& triangle_of(const mesh_face<T>& f) {
    return f.corners;
}

/// Which corners two triangles share; on a device it leaves `unknown` what is too much for its registers.
template <arithmetic A, scalar T>
ABUT_HD constexpr shared_corners shared_by(const triangle<T>& s, const triangle<T>& t) {
    if constexpr (!std::same_as<A, exact>) {
        if (const shared_corners first = certified_corners(s, t); first.is_known()) return first;
    }
    const shared_corners found = exact_corners(s, t);
#if !ABUT_DEVICE_CODE
    if (!found.is_known()) return corners_at_any_span(s, t);
#endif
    return found;
}

/// Writes what is known of corners into a crossing, whose other members stay.
template <scalar T>
ABUT_HD constexpr void put_corners(const shared_corners& all, const triangle<T>& s, const triangle<T>& t, crossing<T>& out) {
    out.count = static_cast<unsigned char>(all.count());
    if (!all.is_known()) return;
    out.coplanar = all.is_flat() ? 1 : 0;
    for (int i = 0; i < all.count(); ++i) {
        out.in_a[i] = static_cast<unsigned char>(all.in_first(i));
        out.in_b[i] = static_cast<unsigned char>(all.in_second(i));
        out.points[i] = point_of_corner(all, i, s, t);
    }
}

/// A judge that knows what two triangles have in common.
template <arithmetic A, class Judge>
struct naming_crossings : Judge {
    bool of_one_mesh;

    template <class View>
    ABUT_HD auto answer(const View& both, std::uint64_t key) const {
        const auto s = both.shape_a(key);
        const auto t = both.shape_b(key);
        using T = std::remove_cvref_t<decltype(triangle_of(s).a.x)>;
        crossing<T> found{};
        const corner_ids a = both.vertices_a(key), b = both.vertices_b(key);
        for (int k = 0; k < 3; ++k) {
            found.vertices_a[k] = a.of[k];
            found.vertices_b[k] = b.of[k];
        }
        found.of_one_mesh = of_one_mesh ? 1 : 0;
        put_corners(shared_by<A>(triangle_of(s), triangle_of(t)), triangle_of(s), triangle_of(t), found);
        return both.tagged(key, found);
    }
};

/// The crossing in what is found: itself, or that of an entry.
template <class Found>
ABUT_HD constexpr auto& crossing_in(Found& found) {
    if constexpr (requires { found.common; }) {
        return found.common;
    } else {
        return found;
    }
}

template <class Found>
struct is_left_open {
    const Found* found;
    ABUT_HD bool operator()(std::size_t i) const {
        return crossing_in(found[i]).count == shared_corners::unknown().count();
    }
};
struct gather_keys {
    const std::uint64_t *which, *keys;
    std::uint64_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = keys[which[i]]; }
};
template <class Found>
struct scatter_found {
    const std::uint64_t* which;
    const Found* found;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[which[i]] = found[i]; }
};
template <class View, class Found>
struct finish_crossing {
    const fetched_pairs<View>& pairs;
    Found* found;
    void operator()(std::size_t i) const {
        const auto &s = triangle_of(pairs[i].a), &t = triangle_of(pairs[i].b);
        put_corners(shared_by<exact>(s, t), s, t, crossing_in(found[i]));
    }
};

/// Those that a device has left open, on all threads of the host.
template <class Policy, class View, class Found>
void finish_on_host(const Policy& on, const View& both, const execution::buffer_of<Policy, std::uint64_t>& keys,
                    const result<Found, space_of<Policy>>& all) {
    const std::size_t n = all.size();
    execution::buffer_of<Policy, std::uint64_t> which(on, n);
    const std::size_t open = compact(on, n, is_left_open<Found>{all.data()}, which.data());
    if (open == 0) return;
    execution::buffer_of<Policy, std::uint64_t> open_keys(on, open);
    for_each_index(on, open, gather_keys{which.data(), keys.data(), open_keys.data()});
    const fetched_pairs<View> pairs(on, both, open_keys.data(), open);
    execution::buffer_of<Policy, Found> there(on, open);
    for_each_index(on, open, gather_answers<Found>{all.data(), which.data(), there.data()});
    std::vector<Found> found(open);
    download(on, there.data(), open, found.data());
    for_each_task(openmp{}, open, finish_crossing<View, Found>{pairs, found.data()});
    upload(on, found.data(), open, there.data());
    for_each_index(on, open, scatter_found<Found>{which.data(), there.data(), const_cast<Found*>(all.data())});
    synchronize(on);
}

template <class S>
inline constexpr bool is_triangle = false;
template <scalar T>
inline constexpr bool is_triangle<triangle<T>> = true;

/// Their crossings.
struct all_crossings {
    static constexpr answer_kind kind = answer_kind::list;
    bool of_one_mesh = false;
    template <class Form, scalar T>
    using found_type = typename Form::template crossing_type<T>;

    template <class S, class U>
    static consteval bool takes() {
        constexpr bool can = is_triangle<S> && is_triangle<U>;
        static_assert(can, "abut: crossings are those of triangles: of meshes, soups and single triangles");
        return can;
    }
    template <arithmetic A, class Relation>
    [[nodiscard]] auto judge(const Relation& how) const {
        using judges = decltype(how.template judge<A>());
        return naming_crossings<A, judges>{how.template judge<A>(), of_one_mesh};
    }
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] auto find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        const auto names = judge<A>(how);
        const auto keys = find_keys(on, pairing, names);
        auto all = answers_to(on, pairing, names, keys);
        if constexpr (!host_policy<Policy>) finish_on_host(on, pairing.view(), keys, all);
        return all;
    }
    template <class Form, class Policy>
    static auto nothing() {
        return result<typename Form::template crossing_type<float>, space_of<Policy>>();
    }
};

}  // namespace detail

/// What each face of `a` has in common with each face of `b` that it meets: a `result` of `crossing`, one for each pair that
/// `pairs` reports of the same arguments, sorted by a, then b, unless the options say otherwise. Under a pose all numbers are
/// the world's.
///
/// With `filtered` and `exact` all is exact but the coordinates: whether a crossing is a point, a segment or a polygon, how
/// many corners it has, and what each lies in: a vertex, an edge or the inside of a face of either. A corner that lies in a
/// vertex has its coordinates. Another one lies on an edge: its coordinates are rounded, each off by at most 3 u M in double
/// and (1 + 2^-4) u M in float, where u is the unit roundoff and M the largest magnitude of the edge's coordinates. They
/// depend on the edge and what it passes alone, so corners of one name have the same bits in all crossings, on each policy.
/// A face without area is the segment between its two vertices farthest apart, or its first vertex. Crossings of `fast` may
/// have no corners.
///
/// Arguments are those of `pairs`, of triangles: sets, views, single triangles and indices, posed or not. Vertices of
/// a mesh that is divided among devices count as those of a soup. Of ranks (@ref distributed) these are a `global_crossing` for each
/// pair of the rank's own a-shapes, which has no numbers of vertices; of a list a `global_tagged_crossing`.
///
///     for (const auto& c : abut::crossings(abut::openmp{}, mesh, abut::posed(other, there))) {
///         if (c.count == 2) use(c.points[0], c.points[1]);
///     }
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all>
    requires(!detail::scene<X>)
[[nodiscard]] auto crossings(const On& on, const X& a, const Y& b, const query_options<Filter>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_crossings{}), detail::two{a, b}, options,
                     "abut::crossings");
}

/// The same of a list, a `result` of `tagged_crossing`, which has the entry's position; or of bodies, of `body_crossing`.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto crossings(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_crossings{}), detail::whole(scene), options,
                     "abut::crossings");
}

/// What faces of one mesh have in common that meet in more than the vertices that they share: one crossing for each pair that
/// `self_pairs` reports, a < b, with what they share. Else as `crossings`.
template <arithmetic A = filtered, executor On, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] auto self_crossings(const On& on, const X& x, const self_options<Filter, Traversal>& options = {}) {
    return ask_pairs(on,
                     detail::ask_for<A>(detail::meeting_beyond_shared(options.coincident), detail::all_crossings{true}),
                     detail::alone{x}, detail::as_query_options(options), "abut::self_crossings");
}

///@}

}  // namespace abut
