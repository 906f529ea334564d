// SPDX-License-Identifier: MIT
#pragma once

// What two solids have in common that are taken by how often their surfaces go round a point (inside_rule): surfaces may pass
// through themselves. Exact, on one thread of the host.
//
// All faces of both cut space into cells, and in a cell each solid is everywhere or nowhere. A solid is the closure of its cells.
// A cell that some solid has is bounded, so that it has a corner: a vertex, a point of an edge in another face or edge, or one
// of three faces. Cells at a corner lie beside faces through it. Beside such a face they change only across lines in it
// through the corner: its own sides, and where other faces cut it. So all of them are found by points infinitely near the
// corner: by some e along such a line, to one side of the line by e^2 in the face, to one side of the face by e^3, for
// all e that are small enough. Such a point lies on no plane, and signs are those of the first term that is not 0. How often a
// surface goes round it says the way up from it, which passes through no edge.
//
// Borders of both solids meet if and only if they do in a corner, at which there are cells in and out of either. It lies on both
// surfaces. Other corners of a surface are on one that the other solid does not touch from its faces: if those are connected
// by faces that touch nothing of the other solid, that is in all of them or in none. Then corners are looked at until one cell
// in the surface's own solid is found and one outside.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/arithmetic/big_int.hpp>
#include <abut/arithmetic/whole_numbers.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/solid_surface.hpp>
#include <abut/execution/disjoint_sets.hpp>
#include <abut/index/bvh.hpp>
#include <abut/predicate/round_solids.hpp>
#include <abut/shape/crossing.hpp>
#include <abut/shape/mesh_face.hpp>
#include <abut/shape/set.hpp>

namespace abut::detail {

inline vec3<big_int> operator+(const vec3<big_int>& a, const vec3<big_int>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3<big_int> operator*(const big_int& s, const vec3<big_int>& v) { return {s * v.x, s * v.y, s * v.z}; }

/// A mesh of faces that know their vertices.
template <scalar T>
mesh<T> mesh_of_faces(const std::vector<mesh_face<T>>& all) {
    std::size_t count = 0;
    for (const auto& f : all) count = std::max<std::size_t>({count, f.vertex[0] + 1u, f.vertex[1] + 1u, f.vertex[2] + 1u});
    std::vector<vec3<T>> vertices(count, vec3<T>{0, 0, 0});
    std::vector<face> faces;
    faces.reserve(all.size());
    for (const auto& f : all) {
        vertices[f.vertex[0]] = f.corners.a;
        vertices[f.vertex[1]] = f.corners.b;
        vertices[f.vertex[2]] = f.corners.c;
        faces.push_back({f.vertex[0], f.vertex[1], f.vertex[2]});
    }
    return {std::move(vertices), std::move(faces)};
}

/// Throws where faces do not go round each point a whole number of times.
template <scalar T>
void require_turns(const std::vector<mesh_face<T>>& faces, inside_rule rule, const char* function, const std::string& element = "face") {
    const mesh<T> all = mesh_of_faces(faces);
    require_closed(serial{}, all.view(), function, rule != inside_rule::parity, false, rule, element);
}

/// A surface that is taken by how often it goes round a point, and where it meets itself. For many pairs with one surface that is
/// found once. Not for several threads at a time.
template <scalar T>
class winding_surface {
public:
    using id = std::uint32_t;

    /// Of faces for which require_turns holds. Those without area bound nothing, and are left out.
    explicit winding_surface(const std::vector<mesh_face<T>>& all) {
        for (const mesh_face<T>& f : all) {
            if (has_area(f.corners)) faces_.push_back(f);
        }
        if (faces_.empty()) return;
        const mesh<T> surface = mesh_of_faces(faces_);
        const auto vertices = surface.view().vertices;
        for (std::size_t v = 0; v < vertices.count; ++v) vertices_.push_back(vertices[v]);
        const serial on;
        tree_.emplace(make_bvh(on, surface));
        own_ = to_host(self_crossings(on, *tree_));
    }
    [[nodiscard]] const std::vector<mesh_face<T>>& faces() const { return faces_; }
    /// By their numbers. Those that no face with an area has are somewhere.
    [[nodiscard]] const std::vector<vec3<T>>& vertices() const { return vertices_; }
    /// What faces of it have in common with each other.
    [[nodiscard]] const std::vector<crossing<T>>& own() const { return own_; }
    /// And with those of another one.
    [[nodiscard]] std::vector<crossing<T>> with(const winding_surface& other) const {
        if (!tree_ || !other.tree_) return {};
        return to_host(crossings(serial{}, *tree_, *other.tree_));
    }
    /// f(face) of all faces that meet a box.
    template <class F>
    void for_each_in(const aabb<T>& box, const F& f) const {
        if (!tree_) return;
        for (const index_pair& found : to_host(pairs(serial{}, *tree_, box))) f(found.a);
    }
    /// The largest z of a face.
    [[nodiscard]] T top() const { return tree_ ? tree_->bounds().upper.z : -infinity<T>; }

private:
    std::vector<mesh_face<T>> faces_;
    std::vector<vec3<T>> vertices_;
    std::optional<decltype(make_bvh(serial{}, mesh<T>()))> tree_;
    std::vector<crossing<T>> own_;
};

/// What two have in common. Both have to be there as long as this is.
template <scalar T>
class winding_regions {
public:
    using id = std::uint32_t;

    winding_regions(const winding_surface<T>& a, const winding_surface<T>& b, inside_rule rule)
        : rule_(rule), of_{&a, &b}, first_of_b_(static_cast<id>(a.faces().size())), first_vertex_of_b_(static_cast<id>(a.vertices().size())),
          top_(std::max(a.top(), b.top())) {
        for (const auto* of : of_) {
            for (const mesh_face<T>& f : of->faces()) unit_.look_at(f.corners.a), unit_.look_at(f.corners.b), unit_.look_at(f.corners.c);
        }
        find_spots();
    }

    /// What both have in common, until that is enough.
    template <class Enough>
    [[nodiscard]] regions_and_touch find(const Enough& is_enough) const {
        regions_and_touch all{{}, false};
        unsigned of_group = 0;
        for (std::size_t i = 0; i < spots_.size() && !is_enough(all.found); ++i) {
            const id group = spots_[i].group;
            if (i == 0 || group == none || group != spots_[i - 1].group) of_group = 0;
            if (group != none && has_both_sides(of_group, group >= first_of_b_)) continue;
            const unsigned cells = cells_at(spots_[i]);
            of_group |= cells;
            all.found |= {(cells & in_both) != 0, (cells & in_first) != 0, (cells & in_second) != 0};
            all.touch |= has_both_sides(cells, false) && has_both_sides(cells, true);
        }
        return all;
    }

private:
    static constexpr id none = static_cast<id>(-1);
    // Cells by what they are in.
    static constexpr unsigned in_none = 1, in_first = 2, in_second = 4, in_both = 8;

    /// Whether there are cells in a solid and out of it.
    static bool has_both_sides(unsigned cells, bool second) {
        const unsigned in = in_both | (second ? in_second : in_first), out = in_none | (second ? in_first : in_second);
        return (cells & in) != 0 && (cells & out) != 0;
    }

    /// A corner of cells: a vertex, the point in two features, or that of three faces.
    struct spot {
        aabb<T> box;                     ///< has the corner
        id group;                        ///< of faces that the other solid does not touch, or none
        std::array<mesh_feature, 2> of;  ///< twice the same, of a vertex
        std::array<id, 3> faces;         ///< of a corner of three
        [[nodiscard]] bool has_three() const { return faces[2] != none; }
        [[nodiscard]] auto name() const { return std::tie(of, faces); }
    };
    /// A point in space, by integers and what divides them, which is positive.
    struct place_in_space {
        vec3<big_int> over;
        big_int under;
    };
    /// A face in integers.
    struct face_in_integers {
        vec3<big_int> corner[3], side[3], normal;
        face_in_integers(const whole_numbers<T>& unit, const triangle<T>& t)
            : corner{unit(t.a), unit(t.b), unit(t.c)}, side{corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]},
              normal(cross(side[0], side[1])) {}
        /// On which side of a side's line a direction goes, or the point at `to` from the side's first corner lies, seen from above.
        [[nodiscard]] int turn(int k, const vec3<big_int>& to) const { return (side[k].x * to.y - side[k].y * to.x).sign(); }
        [[nodiscard]] int height(const vec3<big_int>& to) const { return dot(normal, to).sign(); }
    };
    /// A face of which it depends on where a point near the corner is whether the way up from there passes it: signs of three
    /// turns and of the height, 0 where the corner does not tell.
    struct open_face {
        std::size_t which;
        bool second;
        int up;
        std::array<int, 4> sign;
    };

    // Faces and vertices of both, those of the first one first.
    [[nodiscard]] std::size_t faces() const { return of_[0]->faces().size() + of_[1]->faces().size(); }
    [[nodiscard]] std::size_t vertices() const { return of_[0]->vertices().size() + of_[1]->vertices().size(); }
    [[nodiscard]] const triangle<T>& face(id f) const {
        return f < first_of_b_ ? of_[0]->faces()[f].corners : of_[1]->faces()[f - first_of_b_].corners;
    }
    [[nodiscard]] const vec3<T>& vertex(id v) const {
        return v < first_vertex_of_b_ ? of_[0]->vertices()[v] : of_[1]->vertices()[v - first_vertex_of_b_];
    }
    /// What faces have in common, which have their numbers among those of both.
    struct meeting {
        id a, b;
        int count;
        std::array<mesh_feature, 6> of_a, of_b;
    };
    [[nodiscard]] meeting among_both(const crossing<T>& c, bool a_is_second, bool b_is_second) const {
        const auto named = [&](mesh_feature f, bool is_second) {
            const id by = !is_second ? 0 : f.part == mesh_part::in_face ? first_of_b_ : first_vertex_of_b_;
            f.first += by, f.second += by;
            return f;
        };
        meeting m{c.a + (a_is_second ? first_of_b_ : 0), c.b + (b_is_second ? first_of_b_ : 0), c.count, {}, {}};
        for (int i = 0; i < c.count; ++i) {
            m.of_a[static_cast<std::size_t>(i)] = named(c.feature_a(i), a_is_second);
            m.of_b[static_cast<std::size_t>(i)] = named(c.feature_b(i), b_is_second);
        }
        return m;
    }

    [[nodiscard]] static aabb<T> common_box(const aabb<T>& a, const aabb<T>& b) {
        return {{std::max(a.lower.x, b.lower.x), std::max(a.lower.y, b.lower.y), std::max(a.lower.z, b.lower.z)},
                {std::min(a.upper.x, b.upper.x), std::min(a.upper.y, b.upper.y), std::min(a.upper.z, b.upper.z)}};
    }
    [[nodiscard]] aabb<T> box_of_feature(const mesh_feature& f) const {
        if (f.part == mesh_part::in_face) return bounds(face(f.first));
        const vec3<T>&p = vertex(f.first), &q = vertex(f.second);
        return merge(aabb<T>{p, p}, aabb<T>{q, q});
    }

    void find_spots() {
        std::vector<meeting> found;
        std::vector<char> is_touched(faces(), 0);
        for (const crossing<T>& c : of_[0]->with(*of_[1])) {
            found.push_back(among_both(c, false, true));
            is_touched[found.back().a] = is_touched[found.back().b] = 1;
        }
        for (const bool second : {false, true}) {
            for (const crossing<T>& c : of_[second ? 1 : 0]->own()) found.push_back(among_both(c, second, second));
        }
        id_buffer<serial> parents(serial{}, faces());
        const execution::disjoint_sets groups = execution::make_disjoint_sets(serial{}, parents);
        const auto unite = [&](id f, id g) {
            if (is_touched[f] == 0 && is_touched[g] == 0) groups.unite(f, g);
        };
        std::vector<id> face_at(vertices(), none);  // one that the other solid does not touch, if there is one
        for (id f = 0; f < faces(); ++f) {
            const bool second = f >= first_of_b_;
            for (const id of : of_[second ? 1 : 0]->faces()[second ? f - first_of_b_ : f].vertex) {
                const id v = second ? of + first_vertex_of_b_ : of;
                if (face_at[v] == none || is_touched[face_at[v]] != 0) face_at[v] = f;
                unite(face_at[v], f);
            }
        }
        for (const meeting& c : found) unite(c.a, c.b);
        const auto group_of = [&](std::initializer_list<id> all) {
            for (const id f : all) {
                if (is_touched[f] == 0) return groups.root(f);
            }
            return none;
        };
        for (id v = 0; v < vertices(); ++v) {
            if (face_at[v] == none) continue;
            const mesh_feature at{mesh_part::at_vertex, v, v};
            spots_.push_back({box_of_feature(at), group_of({face_at[v]}), {at, at}, {none, none, none}});
        }
        std::vector<std::vector<id>> cut_by(faces());  // of each face: those of higher numbers that cut it
        for (const meeting& c : found) {
            if (c.count == 2) cut_by[c.a].push_back(c.b);
            for (int i = 0; i < c.count; ++i) {
                mesh_feature p = c.of_a[static_cast<std::size_t>(i)], q = c.of_b[static_cast<std::size_t>(i)];
                if (p.part == mesh_part::at_vertex || q.part == mesh_part::at_vertex) continue;
                if (q < p) std::swap(p, q);
                spots_.push_back({common_box(box_of_feature(p), box_of_feature(q)), group_of({c.a, c.b}), {p, q}, {none, none, none}});
            }
        }
        for (auto& all : cut_by) std::sort(all.begin(), all.end());
        const mesh_feature nothing{mesh_part::in_face, none, none};
        std::vector<id> three;
        for (id f = 0; f < faces(); ++f) {
            for (const id g : cut_by[f]) {
                three.clear();
                std::set_intersection(cut_by[f].begin(), cut_by[f].end(), cut_by[g].begin(), cut_by[g].end(), std::back_inserter(three));
                const aabb<T> box = common_box(bounds(face(f)), bounds(face(g)));
                for (const id h : three) {
                    if (!overlaps(box, bounds(face(h)))) continue;
                    spots_.push_back({common_box(box, bounds(face(h))), group_of({f, g, h}), {nothing, nothing}, {f, g, h}});
                }
            }
        }
        // Each once, in a group if one of its faces is; those in none first.
        std::sort(spots_.begin(), spots_.end(), [](const spot& x, const spot& y) { return std::tuple(x.name(), x.group) < std::tuple(y.name(), y.group); });
        spots_.erase(std::unique(spots_.begin(), spots_.end(), [](const spot& x, const spot& y) { return x.name() == y.name(); }), spots_.end());
        std::stable_sort(spots_.begin(), spots_.end(), [](const spot& x, const spot& y) { return x.group + 1 < y.group + 1; });
    }

    [[nodiscard]] face_in_integers integers_of(id f) const { return {unit_, face(f)}; }
    [[nodiscard]] place_in_space place_of(const spot& s) const {
        place_in_space v{{}, big_int(1)};
        const mesh_feature &p = s.of[0], &q = s.of[1];
        if (s.has_three()) {
            const face_in_integers f = integers_of(s.faces[0]), g = integers_of(s.faces[1]), h = integers_of(s.faces[2]);
            v.under = dot(f.normal, cross(g.normal, h.normal));
            v.over = dot(f.normal, f.corner[0]) * cross(g.normal, h.normal) + dot(g.normal, g.corner[0]) * cross(h.normal, f.normal) +
                     dot(h.normal, h.corner[0]) * cross(f.normal, g.normal);
        } else if (p.part == mesh_part::at_vertex) {
            v.over = unit_(vertex(p.first));
        } else {
            // p is an edge.
            const vec3<big_int> from = unit_(vertex(p.first)), way = unit_(vertex(p.second)) - from;
            big_int part;
            if (q.part == mesh_part::in_face) {
                const face_in_integers f = integers_of(q.first);
                v.under = dot(f.normal, way);
                part = dot(f.normal, f.corner[0] - from);
            } else {
                const vec3<big_int> start = unit_(vertex(q.first)), other = unit_(vertex(q.second)) - start, across = cross(way, other);
                v.under = dot(across, across);
                part = dot(cross(start - from, other), across);
            }
            v.over = v.under * from + part * way;
        }
        if (v.under.sign() < 0) v = {big_int(-1) * v.over, -v.under};
        return v;
    }

    /// Whether a point of a face's plane is in the face.
    static bool has_in_plane(const face_in_integers& f, const vec3<big_int> (&to)[3]) {
        for (int k = 0; k < 3; ++k) {
            if (dot(f.normal, cross(f.side[k], to[k])).sign() < 0) return false;
        }
        return true;
    }
    /// The cells at a corner, by what they are in.
    [[nodiscard]] unsigned cells_at(const spot& s) const {
        const place_in_space v = place_of(s);
        if (v.under.sign() == 0) return 0;
        aabb<T> column = s.box;
        column.upper.z = std::max(column.upper.z, top_);
        std::array<std::int32_t, 2> turns{};  // of faces that are above all points near the corner
        std::vector<face_in_integers> near;
        std::vector<open_face> open;
        std::vector<std::size_t> through;
        bool is_on[2] = {false, false};
        int of_three = 0;
        const auto look_at = [&](id which, bool second) {
            const face_in_integers f = integers_of(which);
            const vec3<big_int> to[3] = {v.over - v.under * f.corner[0], v.over - v.under * f.corner[1], v.over - v.under * f.corner[2]};
            const int up = f.normal.z.sign();
            const std::array<int, 4> sign{f.turn(0, to[0]), f.turn(1, to[1]), f.turn(2, to[2]), f.height(to[0])};
            if (sign[3] == 0 && has_in_plane(f, to)) {
                through.push_back(near.size());
                is_on[second ? 1 : 0] = true;
                of_three += std::find(s.faces.begin(), s.faces.end(), which) != s.faces.end();
            } else if (up == 0) {
                return;
            }
            if (up != 0 && sign[3] != up && sign[0] != -up && sign[1] != -up && sign[2] != -up) {
                if (sign[0] != 0 && sign[1] != 0 && sign[2] != 0 && sign[3] != 0) {
                    turns[second ? 1 : 0] += up;
                    return;
                }
                open.push_back({near.size(), second, up, sign});
            }
            near.push_back(f);
        };
        of_[0]->for_each_in(column, [&](id f) { look_at(f, false); });
        of_[1]->for_each_in(column, [&](id f) { look_at(f + first_of_b_, true); });
        if (s.has_three() && of_three != 3) return 0;
        unsigned cells = 0;
        const auto are_all = [&] {
            return is_on[0] && is_on[1] ? cells == (in_none | in_first | in_second | in_both) : has_both_sides(cells, is_on[1]);
        };
        for (const std::size_t i : through) {
            const face_in_integers& f = near[i];
            const auto look_along = [&](const vec3<big_int>& line) {
                if (!are_all()) cells |= cells_beside(line, f.normal, near, open, turns);
            };
            for (const vec3<big_int>& side : f.side) look_along(side);
            for (const std::size_t j : through) {
                const vec3<big_int> line = cross(f.normal, near[j].normal);
                if (dot(line, line).sign() != 0) look_along(line);
            }
        }
        return cells;
    }

    /// The cells along a line through the corner on both sides of a plane: eight points near it.
    [[nodiscard]] unsigned cells_beside(const vec3<big_int>& line, const vec3<big_int>& normal, const std::vector<face_in_integers>& near,
                                        const std::vector<open_face>& open, const std::array<std::int32_t, 2>& above) const {
        const vec3<big_int> aside = cross(normal, line);
        const vec3<big_int>* const ways[3] = {&line, &aside, &normal};
        // Of each sign which term decides it, and how: terms of 0 do not.
        std::vector<std::array<std::pair<int, int>, 4>> terms;
        for (const open_face& o : open) {
            const face_in_integers& f = near[o.which];
            auto& of = terms.emplace_back();
            for (int k = 0; k < 4; ++k) {
                auto& [term, sign] = of[static_cast<std::size_t>(k)];
                sign = o.sign[static_cast<std::size_t>(k)];
                for (term = 3; sign == 0 && term-- > 0;) sign = k < 3 ? f.turn(k, *ways[2 - term]) : f.height(*ways[2 - term]);
            }
        }
        unsigned cells = 0;
        for (unsigned side = 0; side < 8; ++side) {
            std::array<std::int32_t, 2> turns = above;
            for (std::size_t i = 0; i < open.size(); ++i) {
                const auto sign = [&](std::size_t k) {
                    const auto [term, value] = terms[i][k];
                    return term < 3 && (side >> term & 1u) != 0 ? -value : value;
                };
                const int up = open[i].up;
                if (sign(0) == up && sign(1) == up && sign(2) == up && sign(3) == -up) turns[open[i].second ? 1 : 0] += up;
            }
            const bool in_a = is_in_by(rule_, turns[0]), in_b = is_in_by(rule_, turns[1]);
            cells |= in_a && in_b ? in_both : in_a ? in_first : in_b ? in_second : in_none;
        }
        return cells;
    }

    inside_rule rule_;
    std::array<const winding_surface<T>*, 2> of_;
    id first_of_b_, first_vertex_of_b_;
    T top_;
    whole_numbers<T> unit_;
    std::vector<spot> spots_;
};

}  // namespace abut::detail
