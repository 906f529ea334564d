// SPDX-License-Identifier: MIT
#pragma once

// welded by a distance: a mesh in which vertices that are no farther apart than that are one. For meshes whose seams are off by
// rounding. What is exactly in one place is welded in shape/welded.hpp, on a device as well; here one thread of the host decides.
//
// A vertex is kept if no kept vertex before it, in the order of coordinates, is within the distance: so kept ones are farther
// apart than that, and a cell that is no wider than four distances has few of them, however many vertices there are.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/big_int.hpp>
#include <abut/collide/flag.hpp>
#include <abut/collide/validate.hpp>
#include <abut/collide/within.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/copy_view.hpp>

namespace abut {

/// Options of `welded` by a distance.
/// @ingroup sets
struct weld_options {
    /// Leaves out faces that have lost a side: two of their corners have become one. A closed mesh stays closed. Faces whose
    /// three corners are on one line stay, since without them the surface would be open there; `validate` lists them.
    flag drop_collapsed = false;
    /// Leaves out all but the first of faces with the same three vertices, either way round.
    flag drop_duplicates = false;
};

/// What `welded` by a distance makes.
/// @ingroup sets
template <scalar T, memory_space Space = host_space>
struct weld_result {
    abut::mesh<T, Space> mesh;             ///< in the policy's memory
    std::vector<std::uint32_t> vertex_of;  ///< of each old vertex, the new one; in host memory
    std::vector<std::uint32_t> face_of;    ///< of each new face, the old one, ascending; in host memory
};

namespace detail {

/// Where |p - a|^2 < |p - b|^2.
template <scalar T>
bool is_nearer(const vec3<T>& p, const vec3<T>& a, const vec3<T>& b) {
    int lowest = 0;
    bool any = false;
    const T all[] = {p.x, p.y, p.z, a.x, a.y, a.z, b.x, b.y, b.z};
    for (const T x : all) {
        if (is_zero(x)) continue;
        const int e = take_apart(x).exponent;
        lowest = any ? std::min(lowest, e) : e;
        any = true;
    }
    const auto squared = [&](T x, T y) {
        const auto whole = [&](T v) {
            if (is_zero(v)) return big_int();
            const auto parts = take_apart(v);
            return big_int(parts.mantissa, parts.exponent - lowest);
        };
        const big_int d = whole(x) - whole(y);
        return d * d;
    };
    const auto length = [&](const vec3<T>& q) { return squared(p.x, q.x) + squared(p.y, q.y) + squared(p.z, q.z); };
    return (length(a) - length(b)).sign() < 0;
}

/// Vertices that are kept, by cells of space. Cells are numbered along an axis by a function that is monotone over all finite
/// numbers: far out, where they would be finer than the numbers, each number is a cell.
template <scalar T>
class kept_vertices {
public:
    kept_vertices(const strided<vec3<T>>& vertices, double distance)
        : vertices_(vertices), distance_(distance), unit_(distance > 0 ? std::ilogb(distance) + 2 : lowest_unit) {
        head_.assign(std::bit_ceil(vertices.count + 1), none);
        next_.assign(vertices.count, none);
    }
    void keep(std::uint32_t v) {
        const vec3<double> p = widened(vertices_[v]);
        std::uint32_t& first = head_[slot_of(cell(p.x), cell(p.y), cell(p.z))];
        next_[v] = std::exchange(first, v);
    }
    /// look(r) of each kept vertex within the distance of v, until it says true. In any order.
    template <class Look>
    bool any_near(std::uint32_t v, const Look& look) const {
        const vec3<T> at = vertices_[v];
        const vec3<double> p = widened(at);
        const double most = std::numeric_limits<double>::max();
        const auto below = [&](double x) { return cell(std::max(x - distance_, -most)); };
        const auto above = [&](double x) { return cell(std::min(x + distance_, most)); };
        for (std::int64_t i = below(p.x); i <= above(p.x); ++i) {
            for (std::int64_t j = below(p.y); j <= above(p.y); ++j) {
                for (std::int64_t k = below(p.z); k <= above(p.z); ++k) {
                    for (std::uint32_t r = head_[slot_of(i, j, k)]; r != none; r = next_[r]) {
                        const vec3<double> q = widened(vertices_[r]);
                        if (cell(q.x) != i || cell(q.y) != j || cell(q.z) != k) continue;  // another cell of the slot
                        if (within(vertices_[r], at, distance_) && look(r)) return true;
                    }
                }
            }
        }
        return false;
    }

private:
    static constexpr std::uint32_t none = static_cast<std::uint32_t>(-1);
    static constexpr int lowest_unit = -1074, whole_bits = 52;

    [[nodiscard]] std::int64_t cell(double x) const {
        const double size = std::abs(x);
        const bool is_whole = unit_ + whole_bits < 1024 && size >= std::ldexp(1.0, unit_ + whole_bits);
        if (!is_whole) return static_cast<std::int64_t>(std::floor(std::ldexp(x, -unit_)));
        const auto bits = [](double y) { return static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(y)); };
        const std::int64_t n = (std::int64_t{1} << whole_bits) + bits(size) - bits(std::ldexp(1.0, unit_ + whole_bits));
        return x < 0 ? -n : n;
    }
    [[nodiscard]] std::size_t slot_of(std::int64_t i, std::int64_t j, std::int64_t k) const {
        std::uint64_t h = 0;
        for (const std::int64_t n : {i, j, k}) {
            h = (h ^ static_cast<std::uint64_t>(n)) * 0x9e3779b97f4a7c15u;
            h ^= h >> 32;
        }
        return h & (head_.size() - 1);
    }

    strided<vec3<T>> vertices_;
    double distance_;
    int unit_;  ///< a cell is 2^unit_ wide, and that is more than two distances
    std::vector<std::uint32_t> head_, next_;
};

/// Of each vertex the one that it becomes.
template <scalar T>
std::vector<std::uint32_t> near_vertices(const strided<vec3<T>>& vertices, double distance) {
    const std::size_t n = vertices.count;
    std::vector<std::uint32_t> order(n), to(n);
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    const auto place = [&](std::uint32_t v) {
        const vec3<T> p = vertices[v];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t u, std::uint32_t v) { return std::tuple(place(u), u) < std::tuple(place(v), v); });
    kept_vertices<T> kept(vertices, distance);
    const auto first_of_place = [&](std::size_t i) { return i == 0 || place(order[i - 1]) != place(order[i]); };
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t v = order[i];
        to[v] = v;
        if (!first_of_place(i)) {
            to[v] = order[i - 1];
        } else if (kept.any_near(v, [&](std::uint32_t r) { to[v] = r; return true; })) {
            continue;
        } else {
            kept.keep(v);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t v = order[i];
        if (!first_of_place(i)) {
            to[v] = to[order[i - 1]];
        } else if (to[v] != v) {
            kept.any_near(v, [&](std::uint32_t r) {
                const bool is_better = r != to[v] && (is_nearer(vertices[v], vertices[r], vertices[to[v]]) ||
                                                      (!is_nearer(vertices[v], vertices[to[v]], vertices[r]) && place(r) < place(to[v])));
                if (is_better) to[v] = r;
                return false;
            });
        }
    }
    return to;
}

template <class Policy, scalar T>
weld_result<T, space_of<Policy>> weld_near(const Policy& on, const mesh_view<T, host_space>& old, double distance,
                                           const weld_options& options, const char* function) {
    check_distance(distance, function);
    weld_result<T, space_of<Policy>> made;
    const std::vector<std::uint32_t> to = near_vertices(old.vertices, distance);
    std::vector<vec3<T>> vertices;
    made.vertex_of.resize(to.size());
    for (std::uint32_t v = 0; v < to.size(); ++v) {
        if (to[v] != v) continue;
        made.vertex_of[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(old.vertices[v]);
    }
    for (std::uint32_t v = 0; v < to.size(); ++v) made.vertex_of[v] = made.vertex_of[to[v]];

    std::vector<face> faces(old.size());
    std::vector<char> is_left(old.size(), 1);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const corner_ids c = corners_of(old.faces, f);
        for (std::size_t k = 0; k < 3; ++k) faces[f][k] = made.vertex_of[c.of[k]];
        if (options.drop_collapsed && repeats_index(corner_ids{{faces[f][0], faces[f][1], faces[f][2]}})) is_left[f] = 0;
    }
    if (options.drop_duplicates) {
        std::vector<std::pair<face, std::uint32_t>> sorted(faces.size());
        for (std::uint32_t f = 0; f < faces.size(); ++f) {
            sorted[f] = {faces[f], f};
            std::sort(sorted[f].first.begin(), sorted[f].first.end());
        }
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            if (sorted[i].first == sorted[i - 1].first) is_left[sorted[i].second] = 0;
        }
    }
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (is_left[f] == 0) continue;
        faces[made.face_of.size()] = faces[f];
        made.face_of.push_back(f);
    }
    faces.resize(made.face_of.size());
    made.mesh = mesh<T, space_of<Policy>>(on, std::span<const vec3<T>>(vertices), std::span<const face>(faces));
    return made;
}

}  // namespace detail

/// @addtogroup sets
///@{

/// The same mesh with vertices that are no farther apart than `distance` made one, and what became of vertices and faces.
///
/// Of all vertices in the order of their coordinates (x, then y, then z), one is kept if none before it that is kept is
/// within the distance; each other one becomes the nearest that is kept, of several at one distance the least in that order.
/// So no vertex moves farther than `distance`, kept ones do not move and are farther apart than that, and which places are
/// kept depends neither on numbers of vertices nor on threads. A chain of vertices, each near the next, does not become one
/// vertex: it is cut into pieces. Distances are compared exactly. With distance 0 vertices are those of `welded(on, mesh)`.
///
/// Vertices that stay keep their order, those of no face too; of those in one place the least number counts. Faces keep
/// theirs, and all are kept unless the options say otherwise.
///
/// A distance above the length of edges takes faces away, and may fold the surface. One of 1e-7 of the extent closes seams
/// that are off by rounding; look at `validate(on, welded(on, mesh, d).mesh)`.
///
/// @par Memory
/// The mesh lies in the policy's memory and the maps in the host's. One thread of the host decides on each policy, in 20
/// bytes a vertex and 30 a face of scratch, also where all vertices are in one place. Under `cuda` the mesh is downloaded.
///
/// @par Errors
/// `error`: the distance is negative, infinite or NaN. `invalid_geometry`, of a view. `std::bad_alloc`, `cuda_error`.
///
///     const auto part = abut::welded(on, mesh, 1e-6, {.drop_collapsed = true}).mesh;
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] weld_result<T, space_of<Policy>> welded(const Policy& on, const mesh<T, Space>& mesh, double distance,
                                                      const weld_options& options = {}) {
    static_assert(std::same_as<Space, space_of<Policy>> || std::same_as<Space, host_space>,
                  "abut: a host policy cannot read a set in device memory; copy_to(policy, set) brings it over");
    const auto here = mesh.copied_to(serial{});
    return detail::weld_near(on, here.view(), distance, options, "abut::welded");
}
/// Of a view, which is checked.
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] weld_result<T, space_of<Policy>> welded(const Policy& on, const mesh_view<T, Space>& mesh, double distance,
                                                      const weld_options& options = {}) {
    return welded(on, copy_to(on, mesh), distance, options);
}

///@}

}  // namespace abut
