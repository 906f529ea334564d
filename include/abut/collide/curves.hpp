// SPDX-License-Identifier: MIT
#pragma once

// curves: joins crossings (collide/crossings.hpp) to open and closed lines, by the names of their corners and never by
// coordinates. On one thread of the host.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <abut/collide/crossings.hpp>

namespace abut {

/// @addtogroup crossings
///@{

/// A line of crossings: `segments()` segments, of which segment i runs from `points[i]` to the next point.
template <scalar T>
struct curve {
    bool closed = false;                    ///< whether the last point goes on to the first, which is not there twice
    std::vector<vec3<T>> points;            ///< one after another
    std::vector<mesh_feature> features_a;   ///< what each lies in of the first mesh; of self_crossings the lesser feature
    std::vector<mesh_feature> features_b;   ///< and of the second one
    std::vector<index_pair> faces;          ///< pairs of faces that have a segment in common: those of segment 0, of 1, ...
    std::vector<std::uint32_t> first_pair;  ///< where those of each segment begin in `faces`, and the number of all

    /// Number of segments.
    [[nodiscard]] std::size_t segments() const { return first_pair.size() - 1; }
    /// The faces on both sides of segment i, in ascending order: one pair in general position, more where an edge of one mesh
    /// lies in a face of the other, or on an edge.
    [[nodiscard]] std::span<const index_pair> pairs_of(std::size_t i) const {
        return {faces.data() + first_pair[i], first_pair[i + 1] - first_pair[i]};
    }
};

namespace detail {

/// Joins the segments and sides of crossings.
template <scalar T>
class joined_curves {
public:
    using name = std::array<mesh_feature, 2>;
    using id = std::uint32_t;
    /// A segment of a crossing, or a side of a polygon.
    struct side {
        id from, to;  ///< points, the lesser number first
        id of;        ///< the crossing
        bool is_of_area, is_swapped, has_direction;
    };
    /// Sides that are one.
    struct segment {
        id from, to;
        std::size_t first, last;  ///< sides that curves keep
        std::size_t end;          ///< where those of the next segment begin
        bool is_open = true;      ///< not yet in a curve
    };

    explicit joined_curves(std::span<const crossing<T>> all) : all_(all) {
        name_ends();
        merge_sides();
        walk_all();
    }
    std::vector<curve<T>> take() { return std::move(curves_); }

    [[nodiscard]] const crossing<T>& crossing_of(const side& s) const { return all_[s.of]; }
    /// Of all corners, ascending; a point is known by its position among them.
    [[nodiscard]] const std::vector<name>& names() const { return names_; }
    [[nodiscard]] const std::vector<vec3<T>>& points() const { return points_; }
    /// Sides by their points, those of a segment together.
    [[nodiscard]] const std::vector<side>& sides() const { return sides_; }
    [[nodiscard]] const std::vector<segment>& segments() const { return segments_; }
    [[nodiscard]] id point_of(const name& n) const {
        return static_cast<id>(std::lower_bound(names_.begin(), names_.end(), n) - names_.begin());
    }
    static name name_of(const crossing<T>& c, int i) {
        name n{c.feature_a(i), c.feature_b(i)};
        if (c.of_one_mesh != 0 && n[1] < n[0]) std::swap(n[0], n[1]);
        return n;
    }

private:
    void name_ends() {
        struct end {
            name is;
            std::size_t of;  ///< position in sides, twice, and which end; or that of none
            vec3<T> at;
        };
        std::vector<end> ends;
        for (std::size_t k = 0; k < all_.size(); ++k) {
            const crossing<T>& c = all_[k];
            if (c.count == 1) ends.push_back({name_of(c, 0), static_cast<std::size_t>(-1), c.points[0]});
            if (c.count < 2 || c.count > 6) continue;
            for (int i = 0; i < (c.count == 2 ? 1 : c.count); ++i) {
                const int j = i + 1 == c.count ? 0 : i + 1;
                ends.push_back({name_of(c, i), 2 * sides_.size(), c.points[i]});
                ends.push_back({name_of(c, j), 2 * sides_.size() + 1, c.points[j]});
                sides_.push_back({0, 0, static_cast<id>(k), c.count > 2, false, c.count == 2 && c.coplanar == 0});
            }
        }
        std::sort(ends.begin(), ends.end(), [](const end& x, const end& y) {
            return x.is != y.is ? x.is < y.is : x.of < y.of;
        });
        for (const end& e : ends) {
            if (names_.empty() || names_.back() != e.is) {
                names_.push_back(e.is);
                points_.push_back(e.at);
            }
            if (e.of / 2 >= sides_.size()) continue;
            side& of = sides_[e.of / 2];
            (e.of % 2 == 0 ? of.from : of.to) = static_cast<id>(names_.size() - 1);
        }
        for (side& s : sides_) {
            if (s.to < s.from) {
                std::swap(s.from, s.to);
                s.is_swapped = true;
            }
        }
        std::sort(sides_.begin(), sides_.end(), [&](const side& x, const side& y) {
            return x.from != y.from ? x.from < y.from : x.to != y.to ? x.to < y.to : x.of < y.of;
        });
    }

    /// Sides of areas that lie on both sides of a line are inside of what the surfaces share, and so is all that lies there in
    /// their plane.
    void merge_sides() {
        for (std::size_t i = 0, last = 0; i < sides_.size(); i = last) {
            const auto is_other = [&](const side& s) { return s.from != sides_[i].from || s.to != sides_[i].to; };
            last = i;
            while (last < sides_.size() && !is_other(sides_[last])) ++last;
            const auto begin = sides_.begin() + static_cast<std::ptrdiff_t>(i), end = sides_.begin() + static_cast<std::ptrdiff_t>(last);
            const bool is_inside = std::count_if(begin, end, [](const side& s) { return s.is_of_area; }) > 1;
            const auto stays = [&](const side& s) { return !is_inside || all_[s.of].coplanar == 0; };
            const auto kept = std::stable_partition(begin, end, stays);
            const std::size_t count = static_cast<std::size_t>(kept - begin);
            if (count > 0) segments_.push_back({sides_[i].from, sides_[i].to, i, i + count, last});
        }
        first_at_.assign(names_.size() + 1, 0);
        for (const segment& s : segments_) ++first_at_[s.from + 1], ++first_at_[s.to + 1];
        for (std::size_t n = 0; n < names_.size(); ++n) first_at_[n + 1] += first_at_[n];
        at_.resize(2 * segments_.size());
        std::vector<std::size_t> next(first_at_.begin(), first_at_.end() - 1);
        for (std::size_t k = 0; k < segments_.size(); ++k) {
            at_[next[segments_[k].from]++] = static_cast<id>(k);
            at_[next[segments_[k].to]++] = static_cast<id>(k);
        }
    }

    [[nodiscard]] std::size_t degree(id point) const { return first_at_[point + 1] - first_at_[point]; }

    void walk_all() {
        for (id n = 0; n < names_.size(); ++n) {
            if (degree(n) == 2) continue;
            for (std::size_t k = first_at_[n]; k < first_at_[n + 1]; ++k) {
                if (segments_[at_[k]].is_open) walk(n, at_[k]);
            }
        }
        for (id k = 0; k < segments_.size(); ++k) {
            if (segments_[k].is_open) walk(segments_[k].from, k);
        }
    }

    /// From a point along a segment, as far as no other curve begins.
    void walk(id from, id along) {
        std::vector<id> points{from}, way;
        for (id at = from; segments_[along].is_open;) {
            segment& s = segments_[along];
            s.is_open = false;
            way.push_back(along);
            at = s.from == at ? s.to : s.from;
            points.push_back(at);
            if (degree(at) != 2) break;
            const id *const both = at_.data() + first_at_[at];
            along = both[0] == along ? both[1] : both[0];
        }
        const bool closed = points.size() > 2 && points.back() == from && degree(from) == 2;
        if (closed) points.pop_back();
        if (runs_backwards(points, way)) {
            std::reverse(way.begin(), way.end());
            // A closed one still begins with the same point.
            std::reverse(points.begin() + (closed ? 1 : 0), points.end());
        }
        put(points, way, closed);
    }

    /// Whether the first of the segments that have a direction runs against the way.
    [[nodiscard]] bool runs_backwards(const std::vector<id>& points, const std::vector<id>& way) const {
        for (std::size_t i = 0; i < way.size(); ++i) {
            const segment& s = segments_[way[i]];
            for (std::size_t k = s.first; k < s.last; ++k) {
                if (sides_[k].has_direction) return (points[i] == s.from) == sides_[k].is_swapped;
            }
        }
        return false;
    }

    void put(const std::vector<id>& points, const std::vector<id>& way, bool closed) {
        curve<T> c;
        c.closed = closed;
        for (const id p : points) {
            c.points.push_back(points_[p]);
            c.features_a.push_back(names_[p][0]);
            c.features_b.push_back(names_[p][1]);
        }
        c.first_pair.push_back(0);
        for (const id w : way) {
            for (std::size_t k = segments_[w].first; k < segments_[w].last; ++k) {
                c.faces.push_back({all_[sides_[k].of].a, all_[sides_[k].of].b});
            }
            c.first_pair.push_back(static_cast<std::uint32_t>(c.faces.size()));
        }
        curves_.push_back(std::move(c));
    }

    std::span<const crossing<T>> all_;
    std::vector<name> names_;           ///< of points, ascending
    std::vector<vec3<T>> points_;       ///< where they are
    std::vector<side> sides_;           ///< by their points
    std::vector<segment> segments_;     ///< likewise
    std::vector<std::size_t> first_at_; ///< of each point in at_
    std::vector<id> at_;                ///< segments at each point
    std::vector<curve<T>> curves_;
};

}  // namespace detail

/// The curves in which surfaces cross: crossings joined by the names of their corners, in host memory. The crossings are those
/// of one call of `crossings` or `self_crossings` of two arguments or one, or some of them; of a list or bodies, those of one
/// entry. Each segment of a crossing is in one curve, once, also where several pairs of faces have it in common.
///
/// A curve goes on through a point at which two segments meet, and ends where one does, or more than two. Of two closed meshes
/// in general position all are closed. One is open that ends on the border of an open mesh; where surfaces touch along an
/// edge without crossing; where vertices of one place have different numbers, so that neighbours do not know each other (weld
/// the mesh first); and where more than two lines come together, as in a vertex on a surface or a point of three faces.
///
/// Faces in one plane have areas in common. Their curves are the border of all areas together: a side that two areas share is
/// none, and points that are alone are none.
///
/// A curve of segments of planes that cross runs as its crossings do: along the cross product of a's normals and b's. Of
/// meshes whose faces look outwards, that keeps the inside of b to its left, as seen from outside of a. Closed curves begin
/// with their least name. The order of curves depends on the names alone, so it is the same for crossings of each policy.
///
/// Runs on one thread, of crossings in host memory; those of a device are copied. Takes up to 500 bytes a segment. Throws
/// std::bad_alloc and cuda_error.
///
///     for (const auto& c : abut::curves(on, abut::crossings(on, mesh, other))) {
///         std::printf("%zu points, %s\n", c.points.size(), c.closed ? "closed" : "open");
///     }
///@{
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] std::vector<curve<T>> curves(const Policy&, const result<crossing<T>, Space>& crossings) {
    if constexpr (std::same_as<Space, host_space>) {
        return detail::joined_curves<T>(std::span(crossings.data(), crossings.size())).take();
    } else {
        const std::vector<crossing<T>> here = to_host(crossings);
        return detail::joined_curves<T>(std::span<const crossing<T>>(here)).take();
    }
}
/// Of crossings in host memory.
template <execution_policy Policy, scalar T>
[[nodiscard]] std::vector<curve<T>> curves(const Policy&, std::span<const crossing<T>> crossings) {
    return detail::joined_curves<T>(crossings).take();
}
///@}

///@}

}  // namespace abut
