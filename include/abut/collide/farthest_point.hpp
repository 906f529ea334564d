// SPDX-License-Identifier: MIT
#pragma once

// How far a point of one surface may be from another one, between proven bounds: the search that `hausdorff` and `penetration`
// have in common. It asks `nearest` for many points at a time, so that any policy runs it; which points these are depends on
// the answers alone, and so all policies ask the same and give the same bits.
//
// Branch and bound over pieces of triangles. The distance from a face is convex, so that over a piece it is greatest in a
// corner of the piece, and the distance from the surface is no greater than that from any one face. The distance from the
// surface also changes by no more than one walks. Both bound it from above. A corner bounds it from below. A piece that cannot
// be farther than what is known is dropped, and the others are cut into four, the most promising first.
//
// All is in units of a power of two, so that the largest coordinate is about 1: no square overflows, and the slack for all
// roundings is one number (`slack`).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/error.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/set.hpp>

namespace abut {

/// @addtogroup solids
///@{

/// A point of one surface, as far from another surface as is known, and how far any other point may be.
struct farthest_point {
    double lower = 0;           ///< proven: some point of the surface is so far away
    double upper = 0;           ///< proven: none is farther away
    vec3<double> point{};       ///< the point that `lower` is of, within a few units of roundoff of its face
    std::uint32_t face = no_id;     ///< of the surface, where the point is; no_id if there is none
    vec3<double> nearest{};     ///< the nearest point of the other surface
    std::uint32_t nearest_face = no_id;  ///< and the face in which that is

    friend constexpr bool operator==(const farthest_point&, const farthest_point&) = default;
};

/// How close bounds have to get, and when the search gives up.
struct bound_options {
    /// How far the bounds may be apart, in units of length; 0: a thousandth of the diagonal of the box around both surfaces.
    /// Below some 2^-42 of the largest coordinate no search gets.
    double tolerance = 0;
    /// How many pieces of triangles are looked at, at most, of each surface. Where these do not do, the bounds are proven all
    /// the same, and farther apart than `tolerance`.
    std::uint64_t most_pieces = std::uint64_t{1} << 20;
};

///@}

namespace detail {

/// For all roundings: midpoints of 40 generations, 4 units of roundoff of `nearest`, and a few of what is computed here.
inline constexpr double slack_of_search = 0x1p-44;

/// A surface in the unit of the search: on the host, and as a tree in the policy's memory.
template <class Policy>
class measured_surface {
public:
    using tree_type = decltype(make_bvh(std::declval<const Policy&>(), copy_to(std::declval<const Policy&>(), triangle_soup<double>())));

    measured_surface(const Policy& on, std::vector<triangle<double>> faces, inside_rule rule = inside_rule::parity)
        : on_(on), faces_(std::move(faces)), rule_(rule), tree_(make_bvh(on, copy_to(on, triangle_soup<double>(faces_)))) {}

    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    [[nodiscard]] const triangle<double>& face(std::size_t i) const { return faces_[i]; }
    [[nodiscard]] const tree_type& tree() const { return tree_; }
    [[nodiscard]] auto nearest_to(const std::vector<vec3<double>>& points) const { return to_host(nearest(on_, tree_, points)); }
    /// Of a closed surface, for each point whether it is inside.
    [[nodiscard]] std::vector<bool> have_inside(const std::vector<vec3<double>>& points) const {
        return are_inside(on_, tree_, points, "abut::penetration", rule_);
    }

private:
    const Policy& on_;
    std::vector<triangle<double>> faces_;
    inside_rule rule_;
    tree_type tree_;
};

inline double length_of(const vec3<double>& v) { return std::sqrt(dot(v, v)); }

/// A point of a triangle that is near p: the nearest one, but for roundings.
inline vec3<double> near_point_of(const triangle<double>& t, const vec3<double>& p) {
    const auto on_segment = [&](const vec3<double>& a, const vec3<double>& b) {
        const vec3<double> u = b - a;
        const double size = dot(u, u), along = size > 0 ? dot(p - a, u) / size : 0;
        return a + std::clamp(along, 0.0, 1.0) * u;
    };
    const vec3<double> ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac);
    const double size = dot(normal, normal);
    if (size > 0) {
        const vec3<double> to = p - t.a;
        const double v = dot(cross(to, ac), normal) / size, w = dot(cross(ab, to), normal) / size;
        if (v >= 0 && w >= 0 && v + w <= 1) return t.a + v * ab + w * ac;
    }
    const vec3<double> ends[] = {on_segment(t.a, t.b), on_segment(t.b, t.c), on_segment(t.c, t.a)};
    vec3<double> best = ends[0];
    for (const vec3<double>& q : ends) {
        if (dot(p - q, p - q) < dot(p - best, p - best)) best = q;
    }
    return best;
}

/// The search. `only_inside`: of those points alone that are inside of the other surface, which is closed.
template <class Policy>
class farthest_search {
public:
    farthest_search(const measured_surface<Policy>& from, const measured_surface<Policy>& to, bool only_inside)
        : from_(from), to_(to), only_inside_(only_inside) {}

    /// In the unit of the search. Without a point if none is found: then `upper` still holds.
    farthest_point run(double tolerance, std::uint64_t most_pieces) {
        begin();
        std::uint64_t looked = 0;
        while (!open_.empty() && most() > found_.lower + tolerance && looked < most_pieces) {
            const std::size_t few = std::clamp<std::size_t>(open_.size() / 8, 64, std::size_t{1} << 14);
            std::vector<piece> next;
            while (next.size() < few && !open_.empty() && open_.front().upper > found_.lower + tolerance) {
                std::pop_heap(open_.begin(), open_.end(), is_less{});
                const piece p = open_.back();
                open_.pop_back();
                if (p.level == most_levels) {
                    stuck_ = std::max(stuck_, p.upper);
                    continue;
                }
                next.push_back(p);
            }
            looked += 4 * next.size();
            divide(next);
        }
        found_.upper = std::max(most(), found_.lower);
        if (found_.lower < 0) found_.lower = 0;
        return found_;
    }

private:
    static constexpr int most_levels = 40;
    struct corner {
        vec3<double> at;
        double distance;         ///< from the other surface
        std::uint32_t face;      ///< the face in which the nearest point is
        bool counts;             ///< whether it may be the farthest one
    };
    struct piece {
        std::array<corner, 3> corners;
        double upper;
        std::uint64_t number;  ///< in the order in which pieces are made
        std::uint32_t face, near;
        int level;
    };
    struct is_less {
        bool operator()(const piece& x, const piece& y) const {
            return x.upper != y.upper ? x.upper < y.upper : x.number > y.number;
        }
    };

    [[nodiscard]] double most() const {
        const double of_open = open_.empty() ? 0 : open_.front().upper;
        return std::max({of_open, stuck_, 0.0});
    }
    /// What is known of points, and the farthest of those.
    std::vector<corner> look(const std::vector<vec3<double>>& points, const std::vector<std::uint32_t>& faces) {
        const auto near = to_.nearest_to(points);
        std::vector<bool> inside;
        if (only_inside_) inside = to_.have_inside(points);
        std::vector<corner> all;
        all.reserve(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool counts = !only_inside_ || inside[i];
            all.push_back({points[i], near[i].distance, near[i].id, counts});
            const double lower = near[i].distance - slack_of_search;
            if (!counts || !(lower > found_.lower)) continue;
            found_ = {lower, 0, points[i], faces[i], near[i].point, near[i].id};
        }
        return all;
    }
    void begin() {
        found_ = {};
        found_.lower = only_inside_ ? 0 : -1;
        // Each place once, as vertices are of many faces; and the middle of each face, for a face of the other surface that is
        // near all of it.
        struct place {
            vec3<double> at;
            std::uint32_t of;  ///< three times the face, and the corner
        };
        std::vector<place> places;
        places.reserve(3 * from_.size());
        for (std::uint32_t f = 0; f < from_.size(); ++f) {
            const triangle<double>& t = from_.face(f);
            const vec3<double> all[] = {t.a, t.b, t.c};
            for (const vec3<double>& p : all) places.push_back({p, static_cast<std::uint32_t>(places.size())});
        }
        std::sort(places.begin(), places.end(), [](const place& x, const place& y) {
            const vec3<double>&p = x.at, &q = y.at;
            if (p.x != q.x) return p.x < q.x;
            if (p.y != q.y) return p.y < q.y;
            return p.z != q.z ? p.z < q.z : x.of < y.of;
        });
        std::vector<vec3<double>> points;
        std::vector<std::uint32_t> faces, number(places.size());
        for (const place& p : places) {
            if (points.empty() || !(points.back() == p.at)) points.push_back(p.at), faces.push_back(p.of / 3);
            number[p.of] = static_cast<std::uint32_t>(points.size() - 1);
        }
        places = {};
        const std::size_t corners = points.size();
        for (std::uint32_t f = 0; f < from_.size(); ++f) {
            const triangle<double>& t = from_.face(f);
            points.push_back(0.5 * (0.5 * (t.a + t.b) + t.c));
            faces.push_back(f);
        }
        const std::vector<corner> all = look(points, faces);
        for (std::uint32_t f = 0; f < from_.size(); ++f) {
            const std::uint32_t* const n = &number[3 * f];
            add({all[n[0]], all[n[1]], all[n[2]]}, all[corners + f].face, f, 0);
        }
    }
    void divide(const std::vector<piece>& pieces) {
        std::vector<vec3<double>> points;
        std::vector<std::uint32_t> faces;
        for (const piece& p : pieces) {
            for (std::size_t i = 0; i < 3; ++i) points.push_back(0.5 * (p.corners[i].at + p.corners[(i + 1) % 3].at));
            faces.insert(faces.end(), 3, p.face);
        }
        if (points.empty()) return;
        const std::vector<corner> middles = look(points, faces);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const auto& c = pieces[k].corners;
            const corner &ab = middles[3 * k], &bc = middles[3 * k + 1], &ca = middles[3 * k + 2];
            const int level = pieces[k].level + 1;
            const std::array<corner, 3> parts[] = {{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {ab, bc, ca}};
            for (const auto& part : parts) add(part, pieces[k].near, pieces[k].face, level);
        }
    }
    /// `near` is a face of the other surface that may be near all of the piece.
    void add(const std::array<corner, 3>& corners, std::uint32_t near, std::uint32_t face, int level) {
        const double upper = bound_of(corners, near);
        const std::uint64_t number = made_++;
        if (upper <= std::max(found_.lower, 0.0)) return;
        open_.push_back({corners, upper, number, face, near, level});
        std::push_heap(open_.begin(), open_.end(), is_less{});
    }
    /// No point of the piece that counts is farther away. `near` becomes the face of the other surface that says so.
    [[nodiscard]] double bound_of(const std::array<corner, 3>& c, std::uint32_t& near) const {
        double least = infinity<double>;
        for (std::size_t i = 0; i < 3; ++i) {
            double reach = 0;
            for (std::size_t k = 0; k < 3; ++k) reach = std::max(reach, length_of(c[k].at - c[i].at));
            // From a corner that does not count the way to one that does goes through the other surface.
            least = std::min(least, c[i].counts ? c[i].distance + reach : reach - c[i].distance);
        }
        const std::uint32_t tried[] = {near, c[0].face, c[1].face, c[2].face};
        for (const std::uint32_t face : tried) {
            double of_face = 0;
            for (std::size_t i = 0; i < 3 && of_face < least; ++i) {
                const vec3<double> way = c[i].at - near_point_of(to_.face(face), c[i].at);
                of_face = std::max(of_face, c[i].face == face ? c[i].distance : length_of(way));
            }
            if (of_face < least) least = of_face, near = face;
        }
        return least + slack_of_search;
    }

    const measured_surface<Policy>&from_, &to_;
    bool only_inside_;
    farthest_point found_;
    std::vector<piece> open_;  // a heap
    double stuck_ = 0;         // of pieces that are too small to be cut
    std::uint64_t made_ = 0;
};

template <class View>
struct copy_triangle {
    View shapes;
    triangle<typename View::scalar_type>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = shapes[i]; }
};
/// The triangles of an argument, where they are placed, in host memory.
template <class Policy, class X>
auto triangles_on_host(const Policy& on, const X& x, const char* function) {
    const auto operand = make_operand(on, x, function);
    const auto shapes = operand.shapes();
    using View = std::remove_const_t<decltype(shapes)>;
    using T = typename View::scalar_type;
    static_assert(std::same_as<typename View::shape_type, triangle<T>> || requires(View v) { triangle<T>(v[0]); },
                  "abut: surfaces are of triangles: meshes, soups, and indices of these");
    execution::buffer_of<Policy, triangle<T>> all(on, shapes.size());
    for_each_index(on, shapes.size(), copy_triangle<View>{shapes, all.data()});
    std::vector<triangle<T>> here(shapes.size());
    download(on, all.data(), here.size(), here.data());
    return here;
}

/// The power of two that brings coordinates to about 1, and the way back.
class unit_of_search {
public:
    template <scalar T>
    void see(const std::vector<triangle<T>>& faces) {
        for (const triangle<T>& t : faces) {
            const vec3<T> corners[] = {t.a, t.b, t.c};
            for (const vec3<T>& p : corners) {
                const vec3<double> q = widened(p);
                largest_ = std::max({largest_, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
                box_ = merge(box_, aabb<double>{q, q});
            }
        }
        std::frexp(largest_, &exponent_);
    }
    template <scalar T>
    [[nodiscard]] std::vector<triangle<double>> bring(const std::vector<triangle<T>>& faces) const {
        std::vector<triangle<double>> all;
        all.reserve(faces.size());
        for (const triangle<T>& t : faces) all.push_back({bring(widened(t.a)), bring(widened(t.b)), bring(widened(t.c))});
        return all;
    }
    [[nodiscard]] vec3<double> bring(const vec3<double>& p) const {
        return {std::ldexp(p.x, -exponent_), std::ldexp(p.y, -exponent_), std::ldexp(p.z, -exponent_)};
    }
    [[nodiscard]] double length(double x) const { return std::ldexp(x, -exponent_); }
    [[nodiscard]] double length_back(double x) const { return std::ldexp(x, exponent_); }
    [[nodiscard]] vec3<double> back(const vec3<double>& p) const {
        return {length_back(p.x), length_back(p.y), length_back(p.z)};
    }
    [[nodiscard]] farthest_point back(farthest_point f) const {
        return {length_back(f.lower), length_back(f.upper), back(f.point), f.face, back(f.nearest), f.nearest_face};
    }
    static void check_tolerance(double asked, const char* function) {
        if (!(asked >= 0) || !(asked < infinity<double>)) {
            throw error(std::string(function) + ": tolerance is " + shortest(asked) + "; expected a finite length, 0 or more");
        }
    }
    /// In the unit of the search, of one that is all right.
    [[nodiscard]] double tolerance(double asked) const {
        const vec3<double> size = bring(box_.upper) - bring(box_.lower);
        return asked > 0 ? length(asked) : 0.001 * length_of(size);
    }

private:
    double largest_ = 0;
    int exponent_ = 0;
    aabb<double> box_ = empty_box<double>();
};

}  // namespace detail

}  // namespace abut
