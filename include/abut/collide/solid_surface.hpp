// SPDX-License-Identifier: MIT
#pragma once

// The surface of a solid on the host: its faces, what lies beyond each edge, which faces are at a vertex, its connected parts,
// and which way their faces are turned. Made of triangles that name their vertices; throws where they bound no solid. What two
// solids have in common is asked of it (collide/relation.hpp).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <abut/arithmetic/big_int.hpp>
#include <abut/arithmetic/whole_numbers.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/error.hpp>
#include <abut/narrow/crossing.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/predicate/shared_corners.hpp>
#include <abut/predicate/solid_cones.hpp>
#include <abut/predicate/zero_area.hpp>
#include <abut/shape/mesh_face.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// The sign of the volume between some faces of a closed surface and a point: positive where they face outwards.
template <scalar T>
class volume_sign {
public:
    volume_sign(const vec3<T>& from, const std::vector<mesh_face<T>>& faces, const std::vector<std::uint32_t>& which)
        : from_(from), faces_(faces), which_(which) {}
    /// 0 only where the volume is.
    [[nodiscard]] int sign() const {
        double sum = 0, most = 0;
        for (const std::uint32_t f : which_) {
            const triangle<T>& t = faces_[f].corners;
            const vec3<double> a = between(widened(from_), widened(t.a)), b = between(widened(from_), widened(t.b)),
                               c = between(widened(from_), widened(t.c));
            sum += dot(cross(a, b), c);
            most += magnitudes(a) * magnitudes(b) * magnitudes(c);
        }
        // Each term is off by less than 20 u of its product, and the sum by u for each.
        const double error = most * (static_cast<double>(which_.size()) + 40) * 0x1p-52 + 0x1p-300;
        if (is_finite(most) && absolute(sum) > error) return sum > 0 ? 1 : -1;
        return exact_sign();
    }

private:
    [[nodiscard]] int exact_sign() const {
        whole_numbers<T> unit;
        unit.look_at(from_);
        for (const std::uint32_t f : which_) {
            const triangle<T>& t = faces_[f].corners;
            unit.look_at(t.a), unit.look_at(t.b), unit.look_at(t.c);
        }
        const vec3<big_int> from = unit(from_);
        big_int sum;
        for (const std::uint32_t f : which_) {
            const triangle<T>& t = faces_[f].corners;
            sum = sum + dot(cross(unit(t.a) - from, unit(t.b) - from), unit(t.c) - from);
        }
        return sum.sign();
    }

    vec3<T> from_;
    const std::vector<mesh_face<T>>& faces_;
    const std::vector<std::uint32_t>& which_;
};

/// Whether the corners of a triangle lie in no line.
template <scalar T>
bool has_area(const triangle<T>& t) {
    return decide_zero_area<filtered>(t) == verdict::no || decide_at_any_span<has_inner_points>(in_a_row(t.a, t.b, t.c).value);
}

template <scalar T>
class solid_surface {
public:
    using id = std::uint32_t;

    /// Of faces with the numbers of their vertices. Throws invalid_geometry in the name of `function` for the first face that
    /// is no part of a closed surface whose edges have two faces each, turned alike; it is called an `element`.
    solid_surface(std::vector<mesh_face<T>> faces, const char* function, const std::string& element = "face")
        : faces_(std::move(faces)) {
        check_faces(function, element);
        find_neighbours(function, element);
        gather_vertices();
        find_parts();
        find_turned_parts(function, element);
    }

    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    [[nodiscard]] const std::vector<mesh_face<T>>& faces() const { return faces_; }
    [[nodiscard]] const triangle<T>& face(id f) const { return faces_[f].corners; }
    [[nodiscard]] std::size_t parts() const { return first_face_of_part_.size(); }
    [[nodiscard]] id part_of(id f) const { return part_[f]; }
    /// A vertex of a part.
    [[nodiscard]] const vec3<T>& vertex_of_part(id part) const { return faces_[first_face_of_part_[part]].corners.a; }

    /// Whether a point that is not on the surface is inside. Looks at all faces.
    [[nodiscard]] bool has_inside(const vec3<T>& v) const {
        bool is = false;
        for (const mesh_face<T>& f : faces_) is ^= is_passed_above(v, f.corners);
        return is;
    }
    /// Whether a face looks into the solid.
    [[nodiscard]] bool is_turned(id f) const { return is_turned_[part_[f]] != 0; }
    /// One more than the largest number of a vertex.
    [[nodiscard]] std::size_t vertex_numbers() const { return first_at_.size() - 1; }
    /// Where a vertex is that a face has.
    [[nodiscard]] const vec3<T>& vertex(id v) const { return end_of(at_[first_at_[v]]); }
    [[nodiscard]] bool is_used(id v) const { return first_at_[v] < first_at_[v + 1]; }

    /// Whether the solid is reflex at a side of a face.
    [[nodiscard]] bool is_reflex(id side) const {
        const int sign = volume_sign<T>(end_of(next(next(across_[side]))), faces_, {side / 3}).sign();
        return is_turned(side / 3) ? sign > 0 : sign < 0;
    }

    /// The solid near a point that lies in a vertex, on an edge or in a face of which this is a place in face f.
    [[nodiscard]] solid_cone<T> cone_at(id f, place_in_triangle in) const {
        solid_cone<T> cone;
        const triangle<T>& t = face(f);
        if (in == inside_of_triangle) {
            cone = {{{t.a, t.b}, {t.b, t.c}, {t.c, t.a}}};
        } else if (in >= side_of_triangle) {
            const id side = 3 * f + in - side_of_triangle, other = across_[side];
            const vec3<T> &u = end_of(side), &v = end_of(next(side));
            cone = {{{u, v}, {u, end_of(next(next(side)))}, {v, u}, {u, end_of(next(next(other)))}}};
        } else {
            cone = cone_at_vertex(faces_[f].vertex[in]);
        }
        if (is_turned_[part_[f]]) {
            for (auto& border : cone) std::reverse(border.begin(), border.end());
        }
        return cone;
    }

private:
    /// Whether the way up from a point passes through a face that is not at the point.
    static bool is_passed_above(const vec3<T>& v, const triangle<T>& t) {
        const met_above met = crossing_of<filtered>(v, t);
        return met == met_above::leaving || met == met_above::entering;
    }
    [[nodiscard]] static id next(id side) { return side % 3 == 2 ? side - 2 : side + 1; }
    [[nodiscard]] id vertex_of(id side) const { return faces_[side / 3].vertex[side % 3]; }
    /// Where a side begins.
    [[nodiscard]] const vec3<T>& end_of(id side) const {
        const triangle<T>& t = faces_[side / 3].corners;
        return side % 3 == 0 ? t.a : side % 3 == 1 ? t.b : t.c;
    }

    void check_faces(const char* function, const std::string& element) const {
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (has_area(faces_[f].corners)) continue;
            throw invalid_geometry(function, element, f, "the face has no area, so that the solid has no side there; its area is", 0);
        }
    }

    void find_neighbours(const char* function, const std::string& element) {
        const std::size_t sides = 3 * faces_.size();
        const auto ends = [&](id s) {
            const id from = vertex_of(s), to = vertex_of(next(s));
            return std::pair(std::min(from, to), std::max(from, to));
        };
        // By their lesser vertices first, of which each has few.
        id most = 0;
        for (const auto& f : faces_) most = std::max({most, f.vertex[0], f.vertex[1], f.vertex[2]});
        std::vector<id> first_of(std::size_t{most} + 2, 0), order(sides);
        for (id s = 0; s < sides; ++s) ++first_of[ends(s).first + 1];
        for (std::size_t v = 0; v <= most; ++v) first_of[v + 1] += first_of[v];
        for (id s = 0; s < sides; ++s) order[first_of[ends(s).first]++] = s;
        for (std::size_t v = 0, first = 0; v <= most; first = first_of[v++]) {
            std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(first_of[v]), [&](id s, id t) {
                const id x = ends(s).second, y = ends(t).second;
                return x != y ? x < y : s < t;
            });
        }
        across_.assign(sides, 0);
        for (std::size_t i = 0; i < sides;) {
            std::size_t last = i;
            while (last < sides && ends(order[last]) == ends(order[i])) ++last;
            const id first = order[i];
            if (last - i != 2) {
                throw invalid_geometry(function, element, first / 3,
                                       last - i == 1 ? "the mesh is not closed: faces at an edge of this face are"
                                                     : "an edge of this face has not two faces, but",
                                       static_cast<double>(last - i));
            }
            const id second = order[i + 1];
            if (vertex_of(first) == vertex_of(second)) {
                throw invalid_geometry(function, element, first / 3, "faces are turned against each other at an edge of this face; the other one is face",
                                       second / 3);
            }
            across_[first] = second;
            across_[second] = first;
            i = last;
        }
    }

    void gather_vertices() {
        id most = 0;
        for (const auto& f : faces_) most = std::max({most, f.vertex[0], f.vertex[1], f.vertex[2]});
        first_at_.assign(faces_.empty() ? 1 : std::size_t{most} + 2, 0);
        for (id s = 0; s < 3 * faces_.size(); ++s) ++first_at_[vertex_of(s) + 1];
        for (std::size_t v = 0; v + 1 < first_at_.size(); ++v) first_at_[v + 1] += first_at_[v];
        at_.resize(3 * faces_.size());
        std::vector<id> put(first_at_.begin(), first_at_.end() - 1);
        for (id s = 0; s < 3 * faces_.size(); ++s) at_[put[vertex_of(s)]++] = s;
    }

    /// Faces that share vertices are of one part.
    void find_parts() {
        part_.assign(faces_.size(), none);
        std::vector<char> is_known(first_at_.size(), 0);  // of vertices: all their faces are
        std::vector<id> open;
        for (id f = 0; f < faces_.size(); ++f) {
            if (part_[f] != none) continue;
            const auto number = static_cast<id>(first_face_of_part_.size());
            first_face_of_part_.push_back(f);
            part_[f] = number;
            open.push_back(f);
            while (!open.empty()) {
                const id g = open.back();
                open.pop_back();
                for (int k = 0; k < 3; ++k) {
                    const id v = faces_[g].vertex[k];
                    if (std::exchange(is_known[v], 1) != 0) continue;
                    for (id i = first_at_[v]; i < first_at_[v + 1]; ++i) {
                        const id h = at_[i] / 3;
                        if (part_[h] != none) continue;
                        part_[h] = number;
                        open.push_back(h);
                    }
                }
            }
        }
    }

    /// A part that is inside of an even number of others bounds the solid from outside, and its volume has to be positive; else
    /// it bounds a hollow. Where that is not so, its faces are turned inside out.
    void find_turned_parts(const char* function, const std::string& element) {
        is_turned_.assign(parts(), 0);
        std::vector<aabb<T>> box(parts());
        std::vector<std::vector<id>> faces_of(parts());
        for (id p = 0; p < parts(); ++p) box[p] = bounds(face(first_face_of_part_[p]));
        for (id f = 0; f < faces_.size(); ++f) {
            box[part_[f]] = merge(box[part_[f]], bounds(face(f)));
            faces_of[part_[f]].push_back(f);
        }
        for (id p = 0; p < parts(); ++p) {
            const int sign = volume_sign<T>(vertex_of_part(p), faces_, faces_of[p]).sign();
            if (sign == 0) throw invalid_geometry(function, element, first_face_of_part_[p], "the part of the surface with this face encloses a volume of", 0);
            bool is_hollow = false;
            const vec3<T>& v = vertex_of_part(p);
            for (id q = 0; q < parts(); ++q) {
                const auto &lower = box[q].lower, &upper = box[q].upper;
                if (q == p || v.x < lower.x || v.x > upper.x || v.y < lower.y || v.y > upper.y || v.z > upper.z) continue;
                for (const id f : faces_of[q]) {
                    is_hollow ^= is_passed_above(v, face(f));
                }
            }
            is_turned_[p] = (sign > 0) == is_hollow ? 1 : 0;
        }
    }

    /// All that goes from a vertex: a border for each fan of faces.
    [[nodiscard]] solid_cone<T> cone_at_vertex(id v) const {
        solid_cone<T> cone;
        std::vector<id> left(at_.begin() + first_at_[v], at_.begin() + first_at_[v + 1]);
        while (!left.empty()) {
            auto& border = cone.emplace_back();
            const id first = left.back();
            for (id side = first;;) {
                left.erase(std::find(left.begin(), left.end(), side));
                border.push_back({end_of(side), end_of(next(side))});
                side = across_[next(next(side))];
                if (side == first) break;
            }
        }
        return cone;
    }

    static constexpr id none = static_cast<id>(-1);

    std::vector<mesh_face<T>> faces_;
    std::vector<id> across_;              ///< the side beyond each side
    std::vector<id> first_at_, at_;       ///< sides that begin at each vertex
    std::vector<id> part_;                ///< of each face
    std::vector<id> first_face_of_part_;
    std::vector<char> is_turned_;         ///< of each part
};

}  // namespace abut::detail
