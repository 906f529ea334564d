// SPDX-License-Identifier: MIT
#pragma once

// with_edges: hulls of many points with the edges that their corners have, so that whatever looks for a farthest point climbs
// along these instead of reading all points (predicate/hull_climb.hpp). Its triangles are what
// `boundary` gives (collide/boundary.hpp).
//
// The hull grows by one point at a time, the farthest of those beyond some face (C. Barber, D. Dobkin, H. Huhdanpaa, The
// quickhull algorithm for convex hulls, 1996). Each point that is not taken yet waits at one face that it is beyond. Which
// points are beyond a face is decided exactly; a point in its plane is not, and so no face gets thin: the edges around what a
// point sees are none of which it lies on the line. What a face's planes leave is a convex surface of triangles, some of
// which may lie in one plane. Of these the edges between are left out, and points at which fewer than three edges are left
// are no corners: where there are any, all begins again with the corners alone, to which edges lead on.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/execution/host.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/hulls.hpp>

namespace abut {

namespace detail {

/// The corners and edges of the convex hull of points, which outlive this. Expected O(n log n) time for points in general,
/// O(n^2) at worst, and some 100 bytes a point.
template <scalar T>
class hull_surface {
    using id = std::uint32_t;
    using numbers = std::array<id, 3>;

public:
    explicit hull_surface(const std::vector<vec3<T>>& points)
        : points_(points), all_(points.data(), points.size()), unit_(all_, all_), at_(points.size(), none) {}

    /// False where the points have no volume.
    bool wrap() {
        id first[4] = {};
        if (!begin(first)) return false;
        raise(first);
        for (std::size_t next = 0; next < faces_.size();) {
            if (faces_[next].waiting.empty()) {
                ++next;
            } else {
                take_in(static_cast<id>(next), farthest_from(faces_[next]));
            }
        }
        return true;
    }
    /// For each point, the others at the ends of its edges, ascending; fewer than three where it is no corner.
    [[nodiscard]] std::vector<std::vector<id>> neighbours() const {
        std::vector<std::vector<id>> of(points_.size());
        for (const face& f : faces_) {
            for (std::size_t k = 0; !f.is_gone && k < 3; ++k) {
                if (side(f, apex(faces_[f.across[k]], f.corner[k])) != 0) of[f.corner[k]].push_back(f.corner[(k + 1) % 3]);
            }
        }
        for (std::vector<id>& list : of) std::sort(list.begin(), list.end());
        return of;
    }

    /// The corners of all triangles, counterclockwise as seen from outside.
    [[nodiscard]] std::vector<numbers> triangles() const {
        std::vector<numbers> all;
        for (const face& f : faces_) {
            if (!f.is_gone) all.push_back(f.corner);
        }
        return all;
    }

private:
    static constexpr id none = ~id{0};
    struct face {
        numbers corner;  ///< counterclockwise, as seen from outside
        numbers across;  ///< the face beyond the edge from this corner to the next
        std::vector<id> waiting;
        bool is_gone = false, is_seen = false;
    };
    struct border {
        id from, to, outside;
    };

    template <int Room>
    using integers = hulls_in_integers<Room, T, true>;
    /// Calls f with the points in integers of as few limbs as they need.
    template <class F>
    auto with_integers(const F& f) const {
        return unit_.width() + spare_bits <= 128 ? f(integers<2>(all_, all_, unit_)) : f(integers<limbs_of_any<T>>(all_, all_, unit_));
    }
    /// 1 if d is beyond the plane of a, b and c, from where these are counterclockwise; -1 behind, 0 in it.
    [[nodiscard]] int side(id a, id b, id c, id d) const {
        const auto &p = points_[a], &q = points_[b], &r = points_[c], &s = points_[d];
        const int certain = certain_side<T>(relative_to(p, q), relative_to(p, r), relative_to(p, s));
        if (certain != 0) return certain;
        return with_integers([&](const auto& x) { return sign_of_dot(cross(x.between(p, q), x.between(p, r)), x.between(p, s)); });
    }
    [[nodiscard]] int side(const face& f, id d) const { return side(f.corner[0], f.corner[1], f.corner[2], d); }
    [[nodiscard]] bool are_on_line(id a, id b, id c) const {
        const auto &p = points_[a], &q = points_[b], &r = points_[c];
        return with_integers([&](const auto& x) {
            const auto n = cross(x.between(p, q), x.between(p, r));
            return n.x.sign() == 0 && n.y.sign() == 0 && n.z.sign() == 0;
        });
    }
    /// The corner of a face that is not on the edge which ends at `end`, as seen from there.
    [[nodiscard]] static id apex(const face& f, id end) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (f.corner[k] == end) return f.corner[(k + 1) % 3];
        }
        return none;
    }
    /// The point with the greatest value of which `is` is true, or none. It is asked of few.
    template <class Value, class Is>
    [[nodiscard]] id greatest_of(const Value& value, const Is& is) const {
        const auto n = static_cast<id>(points_.size());
        id best = 0;
        double most = -1;
        for (id i = 0; i < n; ++i) {
            if (const double x = value(widened(points_[i])); x > most) most = x, best = i;
        }
        if (is(best)) return best;
        for (id i = 0; i < n; ++i) {
            if (is(i)) return i;
        }
        return none;
    }
    /// Four points that are not in one plane, if there are.
    bool begin(id (&v)[4]) const {
        const auto seen = [&](const vec3<double>& p, id from) { return p - widened(points_[from]); };
        v[1] = greatest_of([&](const auto& p) { return magnitudes(seen(p, v[0])); }, [&](id i) { return !(points_[i] == points_[v[0]]); });
        if (v[1] == none) return false;
        const vec3<double> line = seen(widened(points_[v[1]]), v[0]);
        v[2] = greatest_of([&](const auto& p) { return magnitudes(cross(line, seen(p, v[0]))); },
                           [&](id i) { return !are_on_line(v[0], v[1], i); });
        if (v[2] == none) return false;
        const vec3<double> normal = cross(line, seen(widened(points_[v[2]]), v[0]));
        v[3] = greatest_of([&](const auto& p) { return absolute(dot(normal, seen(p, v[0]))); },
                           [&](id i) { return side(v[0], v[1], v[2], i) != 0; });
        return v[3] != none;
    }
    void raise(id (&v)[4]) {
        if (side(v[0], v[1], v[2], v[3]) > 0) std::swap(v[1], v[2]);
        constexpr id corner[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
        constexpr id across[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
        for (int f = 0; f < 4; ++f) {
            faces_.push_back({{v[corner[f][0]], v[corner[f][1]], v[corner[f][2]]}, {across[f][0], across[f][1], across[f][2]}, {}});
        }
        std::vector<id> rest;
        for (id i = 0; i < points_.size(); ++i) rest.push_back(i);
        have_wait(rest, 0);
    }
    /// Each at the first face from `first` on that it is beyond; what is beyond none is in the hull.
    void have_wait(const std::vector<id>& points, std::size_t first) {
        for (const id i : points) {
            for (std::size_t f = first; f < faces_.size(); ++f) {
                if (side(faces_[f], i) <= 0) continue;
                faces_[f].waiting.push_back(i);
                break;
            }
        }
    }
    /// Of those that wait there, as far as double tells. Any is right.
    [[nodiscard]] id farthest_from(const face& f) const {
        const vec3<double> from = widened(points_[f.corner[0]]),
                           normal = cross(widened(points_[f.corner[1]]) - from, widened(points_[f.corner[2]]) - from);
        id best = f.waiting[0];
        double most = -infinity<double>;
        for (const id i : f.waiting) {
            if (const double x = dot(normal, widened(points_[i]) - from); x > most) most = x, best = i;
        }
        return best;
    }
    /// Point p, which is beyond face `first`: the faces that it is beyond make way for new ones, from their border to p. The
    /// border is one cycle, since the surface is convex.
    void take_in(id first, id p) {
        std::vector<id> seen{first}, hidden;
        std::vector<border> edges;
        faces_[first].is_seen = faces_[first].is_gone = true;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            for (std::size_t e = 0; e < 3; ++e) {
                const face& f = faces_[seen[k]];
                const id beyond = f.across[e];
                face& next = faces_[beyond];
                if (!next.is_seen) {
                    next.is_seen = true;
                    next.is_gone = side(next, p) > 0;
                    (next.is_gone ? seen : hidden).push_back(beyond);
                }
                if (!next.is_gone) edges.push_back({f.corner[e], f.corner[(e + 1) % 3], beyond});
            }
        }
        for (const id f : hidden) faces_[f].is_seen = false;
        const std::size_t made = faces_.size();
        for (const border& b : edges) {
            const auto f = static_cast<id>(faces_.size());
            faces_.push_back({{b.from, b.to, p}, {b.outside, none, none}, {}});
            at_[b.from] = f;
            face& outside = faces_[b.outside];
            for (std::size_t e = 0; e < 3; ++e) {
                if (outside.corner[e] == b.to && outside.corner[(e + 1) % 3] == b.from) outside.across[e] = f;
            }
        }
        for (std::size_t f = made; f < faces_.size(); ++f) {
            const id next = at_[faces_[f].corner[1]];
            faces_[f].across[1] = next;
            faces_[next].across[2] = static_cast<id>(f);
        }
        for (const id f : seen) have_wait(std::exchange(faces_[f].waiting, {}), made);
    }

    const std::vector<vec3<T>>& points_;
    hull<T> all_;
    unit_of_hulls<T> unit_;
    std::vector<face> faces_;
    std::vector<id> at_;  ///< of each point on a border, the new face whose edge begins there
};

/// The corners of a hull, in their order, and appends to `edges` what hull_climb.hpp reads: the numbers of the corners that are
/// first and last in x, y and z, as {first x, y, z, last x, y, z}; where the neighbours of each corner begin, and the last one's
/// end, from the first of the six on; and these. Of points without volume all are left, and nothing is appended.
template <scalar T>
std::vector<vec3<T>> wrapped(std::vector<vec3<T>> points, std::vector<std::uint32_t>& edges) {
    for (;;) {
        hull_surface<T> surface(points);
        if (!surface.wrap()) return points;
        const auto near = surface.neighbours();
        std::vector<vec3<T>> corners;
        std::size_t all = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            all += near[i].size();
            if (near[i].size() >= 3) corners.push_back(points[i]);
        }
        if (corners.size() < points.size()) {
            points = std::move(corners);
            continue;
        }
        const std::size_t begin = edges.size();
        check_count(begin + 7 + points.size() + all, "abut::with_edges");
        edges.resize(begin + 6);
        for (std::uint32_t k = 0; k < 6; ++k) {
            const auto height = [&](std::size_t i) {
                const vec3<T>& p = points[i];
                return (k < 3 ? 1 : -1) * (k % 3 == 0 ? p.x : k % 3 == 1 ? p.y : p.z);
            };
            for (std::uint32_t i = 1; i < points.size(); ++i) {
                if (height(i) < height(edges[begin + k])) edges[begin + k] = i;
            }
        }
        std::size_t next = 7 + points.size();
        for (const auto& list : near) {
            edges.push_back(static_cast<std::uint32_t>(next));
            next += list.size();
        }
        edges.push_back(static_cast<std::uint32_t>(next));
        for (const auto& list : near) edges.insert(edges.end(), list.begin(), list.end());
        return points;
    }
}

}  // namespace detail

/// @addtogroup sets
///@{

/// The same hulls in the policy's memory, with edges: of each that has a volume its corners alone, in their order, and which
/// of these are neighbours. What lies inside, in a face or on an edge, and what is there twice, is left out, decided exactly;
/// hulls without volume stay as they are, without edges. Ids stay. Whatever is decided is the same as without edges; what is
/// measured has the same bits as of the same corners without edges. Decisions climb along the edges of hulls that have 128
/// corners or more, distances and contacts from 384 on, in time that grows slowly with their number; of fewer they read all.
/// Edges take about 28 bytes a corner.
///
/// It is done on the host, by one thread, in O(n log n) for most and O(n^2) for some hulls of n points, with some 100 bytes a
/// point meanwhile. Throws std::bad_alloc, and capacity_error above 2^32 numbers. Returns when all is done.
///
///     const auto rocks = abut::with_edges(on, abut::hulls<float>(lists));
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto with_edges(const Policy& policy, const hulls<T, Space>& set) {
    const auto held = set.copied_to(serial{});
    const auto all = held.view();
    const std::size_t n = all.size();
    std::vector<vec3<T>> points;
    std::vector<std::uint32_t> offsets(1, 0), edges(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const hull<T> h = all[i];
        std::vector<vec3<T>> of;
        for (std::size_t k = 0; k < h.count; ++k) of.push_back(h[k]);
        const std::size_t begin = edges.size();
        of = detail::wrapped(std::move(of), edges);
        if (edges.size() > begin) edges[i] = static_cast<std::uint32_t>(begin);
        points.insert(points.end(), of.begin(), of.end());
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    return detail::set_parts::with_edges(hulls<T>(points, offsets), edges).copied_to(policy);
}
/// The same in host memory.
template <scalar T>
[[nodiscard]] hulls<T> with_edges(const hulls<T>& set) {
    return with_edges(serial{}, set);
}

///@}

}  // namespace abut
