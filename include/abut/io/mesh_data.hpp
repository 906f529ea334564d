// SPDX-License-Identifier: MIT
#pragma once

// What a mesh file holds, as the parsers return it, and how a polygon becomes triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/collide/flag.hpp>
#include <abut/io/error.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::io {

/// @addtogroup files
///@{

/// How readers of meshes take files that are not quite in order.
struct read_options {
    /// Passes over what others' programs write and no geometry needs: faces of fewer than three corners, further values in a
    /// row, and what follows after the last row. By default such files are refused. What is passed over is counted
    /// (`mesh_data::skipped`).
    flag lenient = false;
};

/// What a lenient reader has passed over.
struct skipped_parts {
    std::size_t faces = 0;  ///< of fewer than three corners
    std::size_t rows = 0;   ///< rows that went on after their last value; the rows themselves are read
    std::size_t bytes = 0;  ///< after the last row

    friend constexpr bool operator==(const skipped_parts&, const skipped_parts&) = default;
};

/// Vertices in the file's order, coordinates finite; triangles in the file's order, all indices below the number of
/// vertices. A file of points alone has no faces.
template <scalar T>
struct mesh_data {
    std::vector<vec3<T>> vertices;                    ///< in units of the file
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< three vertex indices each, from 0
    skipped_parts skipped{};                          ///< nothing, unless the file was read leniently
};

/// A part of a scene: a mesh, and where it is.
template <scalar T>
struct mesh_part {
    std::string name;      ///< as the file has it; may be that of other parts too
    std::size_t mesh = 0;  ///< number of its mesh
    rigid<T> pose{};       ///< from the mesh's frame to the scene's
};

/// Parts of a scene, and their meshes, each once however many parts have it.
template <scalar T>
struct parts_data {
    std::vector<mesh_data<T>> meshes;  ///< by number
    std::vector<mesh_part<T>> parts;  ///< in the order of the file
};

///@}

namespace detail {

/// A polygon of more than three corners that lies in the faces as a fan: `corners - 2` triangles from `first` on.
struct fanned_polygon {
    std::size_t first;
    std::size_t corners;
};

/// Polygons that need more are refused: clipping ears takes quadratic time, for spirals cubic.
inline constexpr std::size_t most_corners_clipped = 1024;

/// Where in a file something is: a line, or a byte of binary data.
struct file_place {
    std::size_t number;
    bool is_line;
};
/// Where a polygon is that may have to be refused, by its first triangle.
struct place_of_polygon {
    std::size_t first;
    file_place place;
};

struct point2 {
    double x, y;
};

/// Twice the signed area of a triangle. Rounded: what it decides is how a polygon is cut, never whether shapes touch.
inline double area2(point2 a, point2 b, point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The polygon's corners in the plane where its area is largest, counterclockwise, within [-1, 1] (so that no product
/// overflows or vanishes); empty if it has no area, or coordinates so large that differences overflow.
template <scalar T>
std::vector<point2> flatten(const std::vector<vec3<T>>& polygon) {
    std::vector<vec3<double>> p(polygon.size());
    double extent = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const vec3<T>& a = polygon[i];
        const vec3<T>& o = polygon[0];
        p[i] = {static_cast<double>(a.x) - static_cast<double>(o.x), static_cast<double>(a.y) - static_cast<double>(o.y),
                static_cast<double>(a.z) - static_cast<double>(o.z)};
        extent = std::fmax(extent, std::fmax(std::fabs(p[i].x), std::fmax(std::fabs(p[i].y), std::fabs(p[i].z))));
    }
    if (!(extent > 0) || !std::isfinite(extent)) return {};
    for (auto& a : p) a = {a.x / extent, a.y / extent, a.z / extent};
    vec3<double> normal{0, 0, 0};  // Newell's, which also suits polygons that are not quite flat
    for (std::size_t i = 0; i < p.size(); ++i) normal = normal + cross(p[i], p[(i + 1) % p.size()]);

    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    std::vector<point2> flat(p.size());
    if (x == 0 && y == 0 && z == 0) return {};
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (z >= x && z >= y)
            flat[i] = normal.z > 0 ? point2{p[i].x, p[i].y} : point2{p[i].y, p[i].x};
        else if (y >= x)
            flat[i] = normal.y > 0 ? point2{p[i].z, p[i].x} : point2{p[i].x, p[i].z};
        else
            flat[i] = normal.x > 0 ? point2{p[i].y, p[i].z} : point2{p[i].z, p[i].y};
    }
    return flat;
}

/// Whether the fan from the first corner covers the polygon and nothing else: no triangle of it turns the other way.
inline bool fan_is_right(const std::vector<point2>& flat) {
    for (std::size_t i = 1; i + 1 < flat.size(); ++i) {
        if (area2(flat[0], flat[i], flat[i + 1]) < 0) return false;
    }
    return true;
}

/// Cuts a simple polygon into triangles of its corner numbers by clipping ears. Corners on a straight line give triangles
/// without area, so that all corners stay in use. Returns less than n - 2 triangles if no ear is left, as with a polygon
/// that crosses itself.
inline std::vector<std::array<std::size_t, 3>> clip_ears(const std::vector<point2>& flat) {
    std::vector<std::size_t> ring(flat.size());
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;
    std::vector<std::array<std::size_t, 3>> ears;

    const auto is_ear = [&](std::size_t at, bool flat_too) {
        const std::size_t n = ring.size();
        const std::size_t previous = ring[(at + n - 1) % n], tip = ring[at], next = ring[(at + 1) % n];
        const point2 a = flat[previous], b = flat[tip], c = flat[next];
        const double area = area2(a, b, c);
        if (area < 0 || (area == 0 && !flat_too)) return false;
        if (area == 0) return (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) >= 0;  // on the line, not a spike
        for (const std::size_t other : ring) {
            const point2 p = flat[other];
            if (other == previous || other == tip || other == next) continue;
            // A bridge to a hole repeats corners; those at the ear's own corners do not lie in it.
            if ((p.x == a.x && p.y == a.y) || (p.x == b.x && p.y == b.y) || (p.x == c.x && p.y == c.y)) continue;
            if (area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0) return false;
        }
        return true;
    };

    std::size_t at = 0;
    while (ring.size() > 2) {
        bool found = false;
        for (const bool flat_too : {false, true}) {
            for (std::size_t tried = 0; tried < ring.size() && !found; ++tried, at = (at + 1) % ring.size()) {
                if (!is_ear(at, flat_too)) continue;
                const std::size_t n = ring.size();
                ears.push_back({ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]});
                ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
                found = true;
                at %= ring.size();
                break;
            }
            if (found) break;
        }
        if (!found) break;
    }
    return ears;
}

/// Replaces the fans that do not cover their polygon by triangles that do. Throws io_error if such a polygon has more than
/// `most_corners_clipped` corners: `large` says where these are. One that crosses itself has no right answer, and stays a
/// fan.
template <scalar T>
void cut_polygons(mesh_data<T>& mesh, const std::vector<fanned_polygon>& polygons,
                  const std::vector<place_of_polygon>& large, const std::string& file) {
    std::vector<vec3<T>> positions;
    std::vector<std::uint32_t> corners;
    for (const fanned_polygon& polygon : polygons) {
        auto* const fan = mesh.faces.data() + polygon.first;
        corners.assign({fan[0][0], fan[0][1]});
        for (std::size_t i = 0; i + 2 < polygon.corners; ++i) corners.push_back(fan[i][2]);
        positions.clear();
        for (const std::uint32_t corner : corners) positions.push_back(mesh.vertices[corner]);

        const auto flat = flatten(positions);
        if (flat.empty() || fan_is_right(flat)) continue;
        if (polygon.corners > most_corners_clipped) {
            const auto is_it = [&](const place_of_polygon& one) { return one.first == polygon.first; };
            const file_place at = std::find_if(large.begin(), large.end(), is_it)->place;
            const std::string what = "expected polygons that are convex or have at most " +
                                     std::to_string(most_corners_clipped) + " corners, found one with " +
                                     std::to_string(polygon.corners);
            throw at.is_line ? io_error::at_line(file, at.number, what) : io_error::at_byte(file, at.number, what);
        }
        const auto ears = clip_ears(flat);
        if (ears.size() != polygon.corners - 2) continue;
        for (std::size_t i = 0; i < ears.size(); ++i) {
            fan[i] = {corners[ears[i][0]], corners[ears[i][1]], corners[ears[i][2]]};
        }
    }
}

/// Collects faces: polygons as fans from their first corner, to be looked at again when all vertices are known.
template <scalar T>
class face_collector {
public:
    face_collector(mesh_data<T>& mesh, const std::string& file) : mesh_(mesh), file_(file) {}

    /// `corner(i)` gives the vertex index of corner i; at least three corners.
    template <class Corner>
    void add(std::size_t corners, const Corner& corner, file_place place) {
        if (corners > most_corners_clipped) large_.push_back({mesh_.faces.size(), place});
        const std::uint32_t first = corner(0);
        std::uint32_t previous = corner(1);
        if (corners > 3) polygons_.push_back({mesh_.faces.size(), corners});
        for (std::size_t i = 2; i < corners; ++i) {
            const std::uint32_t next = corner(i);
            mesh_.faces.push_back({first, previous, next});
            previous = next;
        }
    }
    /// The triangles of a strip: every second one is turned around. Those that name a vertex twice join strips, and are no
    /// faces.
    template <class Corner>
    void add_strip(std::size_t corners, const Corner& corner) {
        for (std::size_t i = 2; i < corners; ++i) {
            const std::uint32_t a = corner(i - 2), b = corner(i - 1), c = corner(i);
            if (a == b || b == c || a == c) continue;
            mesh_.faces.push_back(i % 2 == 0 ? std::array{a, b, c} : std::array{b, a, c});
        }
    }
    void finish() { cut_polygons(mesh_, polygons_, large_, file_); }

private:
    mesh_data<T>& mesh_;
    const std::string& file_;
    std::vector<fanned_polygon> polygons_;
    std::vector<place_of_polygon> large_;
};

}  // namespace detail
}  // namespace abut::io
