// SPDX-License-Identifier: MIT
#pragma once

// Which crossings of two solids belong together: those that a connected part of a surface joins within the other solid. By
// names of points and by edges that nothing crosses. What is said of each region is in collide/contact_patches.hpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <abut/collide/curves.hpp>
#include <abut/collide/relation.hpp>
#include <abut/collide/solid_surface.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut::detail {

/// Sets of numbers that are joined.
class disjoint_sets {
public:
    using id = std::uint32_t;
    explicit disjoint_sets(std::size_t n) : of_(n) { std::iota(of_.begin(), of_.end(), id{0}); }
    /// The least of a set.
    [[nodiscard]] id find(id x) {
        while (of_[x] != x) x = of_[x] = of_[of_[x]];
        return x;
    }
    void join(id x, id y) {
        x = find(x), y = find(y);
        of_[std::max(x, y)] = std::min(x, y);
    }

private:
    std::vector<id> of_;
};

/// How far it is along a way from a point to another one, in units of that way's size: without overflow. The second one is not
/// longer.
template <scalar T>
double along(const vec3<T>& from, const vec3<T>& to, const vec3<T>& p, const vec3<T>& q) {
    using namespace contact_math;
    const auto halved = [](const vec3<T>& a, const vec3<T>& b) { return plain_difference(scaled(widened(b), -1), scaled(widened(a), -1)); };
    const auto way = halved(from, to);
    const double size = largest_of(way);
    if (!(size > 0)) return 0;
    const int e = -exponent_of(size);
    return plain_dot(scaled(way, e), scaled(halved(p, q), e));
}

/// A vertex of a surface is within the other solid as all are that edges lead to which do not meet its surface: that is known of
/// all of them by one. Points on an edge are joined if what of the edge is between them is within. The points' order there, and
/// the middle of two that nothing else joins, are rounded.
template <scalar T>
class patch_regions {
public:
    using id = std::uint32_t;
    static constexpr id none = static_cast<id>(-1);

    patch_regions(const joined_curves<T>& all, const solid_on_host<T>& a, const solid_on_host<T>& b)
        : all_(all), first_vertex_{static_cast<id>(all.names().size()),
                                   static_cast<id>(all.names().size() + a.surface().vertex_numbers())},
          sets_(all.names().size() + a.surface().vertex_numbers() + b.surface().vertex_numbers()) {
        for (const auto& s : all.sides()) sets_.join(s.from, s.to);
        look_at(0, a.surface(), b);
        look_at(1, b.surface(), a);
        number_regions();
    }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// Of a point.
    [[nodiscard]] id region_of(id point) { return number_[sets_.find(point)]; }
    /// Of a vertex of one of the surfaces, 0 or 1: none if it is not within the other solid, or no region has it.
    [[nodiscard]] id region_of_vertex(int which, id v) {
        const id root = sets_.find(first_vertex_[which] + v);
        return root < first_vertex_[0] ? number_[root] : none;
    }

private:
    using edge = std::array<id, 2>;
    struct edge_point {
        edge of;
        double along;
        id point;
        friend bool operator<(const edge_point& x, const edge_point& y) {
            return x.of != y.of ? x.of < y.of : x.along != y.along ? x.along < y.along : x.point < y.point;
        }
    };

    void look_at(int which, const solid_surface<T>& surface, const solid_on_host<T>& other) {
        const id first = first_vertex_[which];
        std::vector<id> at(surface.vertex_numbers(), none);  // the points that vertices are
        std::vector<edge_point> on_edges;
        for (id p = 0; p < all_.names().size(); ++p) {
            const mesh_feature f = all_.names()[p][static_cast<std::size_t>(which)];
            if (f.part == mesh_part::at_vertex) at[f.first] = p;
            if (f.part != mesh_part::on_edge) continue;
            const vec3<T>& from = surface.vertex(f.first);
            on_edges.push_back({{f.first, f.second}, along(from, surface.vertex(f.second), from, all_.points()[p]), p});
        }
        std::sort(on_edges.begin(), on_edges.end());
        // Each edge once, as the face has it that goes from the lesser vertex to the greater one.
        std::vector<edge> cut;
        for (id f = 0; f < surface.size(); ++f) {
            for (int k = 0; k < 3; ++k) {
                const id u = surface.faces()[f].vertex[k], v = surface.faces()[f].vertex[(k + 1) % 3];
                if (u > v) continue;
                const auto [begin, end] = points_on({u, v}, on_edges);
                if (begin == end && at[u] == none && at[v] == none) {
                    sets_.join(first + u, first + v);
                } else {
                    cut.push_back({u, v});
                }
            }
        }
        const std::vector<char> is_within = which_are_within(first, cut, at, surface, other);
        const auto joins = [&](id v) { return at[v] == none && is_within[sets_.find(first + v) - first] != 0; };
        // All are asked for before any is joined to a point, which would change what `find` says.
        std::vector<edge> joined, between;
        for (const edge& e : cut) {
            const auto [begin, end] = points_on(e, on_edges);
            id last = at[e[0]];
            if (joins(e[0])) joined.push_back({first + e[0], begin != end ? begin->point : at[e[1]]});
            for (auto i = begin; i != end; ++i) {
                if (last != none) between.push_back({last, i->point});
                last = i->point;
            }
            if (joins(e[1])) joined.push_back({first + e[1], last});
            if (at[e[1]] != none && last != none) between.push_back({last, at[e[1]]});
        }
        for (const edge& e : joined) sets_.join(e[0], e[1]);
        std::erase_if(between, [&](const edge& e) { return sets_.find(e[0]) == sets_.find(e[1]); });
        if (between.empty()) return;
        std::vector<vec3<T>> middles;
        for (const edge& e : between) middles.push_back(middle(all_.points()[e[0]], all_.points()[e[1]]));
        const std::vector<bool> are = other.have_inside(std::move(middles));
        for (std::size_t i = 0; i < are.size(); ++i) {
            if (are[i]) sets_.join(between[i][0], between[i][1]);
        }
    }

    static auto points_on(const edge& e, const std::vector<edge_point>& all) {
        const auto begin = std::lower_bound(all.begin(), all.end(), e, [](const edge_point& p, const edge& of) { return p.of < of; });
        auto end = begin;
        while (end != all.end() && end->of == e) ++end;
        return std::pair(begin, end);
    }
    /// Of sets of vertices at edges that the other surface meets, by their least vertices: whether they are within.
    std::vector<char> which_are_within(id first, const std::vector<edge>& cut, const std::vector<id>& at, const solid_surface<T>& surface,
                                       const solid_on_host<T>& other) {
        std::vector<char> is_within(at.size(), 0), is_asked(at.size(), 0);
        std::vector<id> roots;
        std::vector<vec3<T>> vertices;
        for (const edge& e : cut) {
            for (const id v : e) {
                if (at[v] != none) continue;
                const id root = sets_.find(first + v) - first;
                if (std::exchange(is_asked[root], 1) != 0) continue;
                roots.push_back(root);
                vertices.push_back(surface.vertex(root));
            }
        }
        if (roots.empty()) return is_within;
        const std::vector<bool> are = other.have_inside(std::move(vertices));
        for (std::size_t i = 0; i < roots.size(); ++i) is_within[roots[i]] = are[i];
        return is_within;
    }
    static vec3<T> middle(const vec3<T>& p, const vec3<T>& q) {
        return {p.x / 2 + q.x / 2, p.y / 2 + q.y / 2, p.z / 2 + q.z / 2};
    }

    void number_regions() {
        number_.assign(first_vertex_[0], none);
        for (id p = 0; p < first_vertex_[0]; ++p) {
            if (sets_.find(p) == p) number_[p] = static_cast<id>(count_++);
        }
    }

    const joined_curves<T>& all_;
    id first_vertex_[2];  ///< points come first, then vertices of the first surface, and of the second one
    disjoint_sets sets_;
    std::vector<id> number_;  ///< of the least point of each region
    std::size_t count_ = 0;
};

template <scalar T>
contact_math::point unit_normal_of(const triangle<T>& t) {
    using namespace contact_math;
    const auto u = brought_to_one(contact_math::between<two_doubles>(widened(t.a), widened(t.b))),
               v = brought_to_one(contact_math::between<two_doubles>(widened(t.a), widened(t.c)));
    return unit_vector(accurate_cross(u, v));
}

/// How often a segment of crossings bounds what of a's surface is in b, as it runs from its first point to its second: 1, -1, 0,
/// and 1/2 less of a face of a that lies in one of b which looks the same way.
///
/// Across the segment each surface is two rays, in one face or two: the first in the face that has the segment along its side, or
/// to the left of it, the second in the other one. The solid b is what is between its second ray and its first one, anticlockwise
/// as seen against the segment's way. On which side of a ray another one is, crossings say: by the cross product of normals.
template <scalar T>
class border_weight {
public:
    border_weight(const joined_curves<T>& all, const solid_surface<T>& a, const solid_surface<T>& b) : all_(all), a_(a), b_(b) {}

    [[nodiscard]] double of(const typename joined_curves<T>::segment& s) const {
        rays r;
        for (std::size_t k = s.first; k < s.end; ++k) look_at(all_.sides()[k], s, r);
        return share(r, 0) - share(r, 1);
    }

private:
    struct rays {
        int turn[2][2] = {};        ///< from a's ray to b's: 1 is anticlockwise, 0 along the same line
        bool is_same[2][2] = {};    ///< areas that both have
        std::uint32_t edge_b = static_cast<std::uint32_t>(-1);  ///< a side of a face of b, if the segment is on an edge
    };

    /// The ray that a face has: 0 or 1, or 2 for both.
    static int ray_of(const solid_surface<T>& of, std::uint32_t f, place_in_triangle in, const vec3<T>& from, const vec3<T>& to) {
        if (in == inside_of_triangle) return 2;
        const triangle<T>& t = of.face(f);
        const vec3<T> corners[3] = {t.a, t.b, t.c};
        const unsigned k = in - side_of_triangle;
        return (along(corners[k], corners[(k + 1) % 3], from, to) > 0) != of.is_turned(f) ? 0 : 1;
    }
    void look_at(const typename joined_curves<T>::side& side, const typename joined_curves<T>::segment& s, rays& r) const {
        const crossing<T>& c = all_.crossing_of(side);
        const int i = corner_of(c, s.from), j = corner_of(c, s.to);
        const vec3<T>&from = all_.points()[s.from], &to = all_.points()[s.to];
        const place_in_triangle in_a = place_between(c.in_a[i], c.in_a[j]), in_b = place_between(c.in_b[i], c.in_b[j]);
        const int of_a = ray_of(a_, c.a, in_a, from, to), of_b = ray_of(b_, c.b, in_b, from, to);
        if (in_b != inside_of_triangle) r.edge_b = 3 * c.b + in_b - side_of_triangle;
        const bool turned_a = a_.is_turned(c.a), turned_b = b_.is_turned(c.b);
        if (side.is_of_area) {
            const bool look_alike = (contact_math::plain_dot(unit_normal_of(a_.face(c.a)), unit_normal_of(b_.face(c.b))) > 0) !=
                                    (turned_a != turned_b);
            // A side of an area is on an edge of a's or of b's.
            const int x = of_a != 2 ? of_a : look_alike ? of_b : 1 - of_b;
            r.is_same[x][look_alike ? x : 1 - x] = true;
        }
        if (!side.has_direction) return;
        const int sign = side.is_swapped != (turned_a != turned_b) ? -1 : 1;
        for (int x = 0; x < 2; ++x) {
            for (int y = 0; y < 2; ++y) {
                if ((of_a == 2 || of_a == x) && (of_b == 2 || of_b == y)) r.turn[x][y] = x == y ? sign : -sign;
            }
        }
    }
    int corner_of(const crossing<T>& c, std::uint32_t point) const {
        for (int i = 0; i < c.count; ++i) {
            if (joined_curves<T>::name_of(c, i) == all_.names()[point]) return i;
        }
        return 0;
    }
    /// Of a's ray: 1 if it is in b, or between both.
    [[nodiscard]] double share(const rays& r, int x) const {
        if (r.is_same[x][x]) return 0.5;
        if (r.is_same[x][1 - x]) return 1;
        const int first = r.turn[x][0], second = r.turn[x][1];
        if (first > 0 && second < 0) return 1;
        if ((first < 0 && second > 0) || r.edge_b == static_cast<std::uint32_t>(-1)) return 0;
        return b_.is_reflex(r.edge_b) ? 1 : 0;
    }

    const joined_curves<T>& all_;
    const solid_surface<T>&a_, &b_;
};

}  // namespace abut::detail
