// SPDX-License-Identifier: MIT
#pragma once

// contact_patches: where two solids meet, as few numbers for each region: a plane, an area, a depth and the corners of the
// region. Made of crossings, not of contacts of single faces. The regions are those of collide/patch_regions.hpp. Not for
// distances, nor for the least move that separates two solids.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <abut/collide/crossings.hpp>
#include <abut/collide/curves.hpp>
#include <abut/collide/patch_regions.hpp>
#include <abut/collide/relation.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut {

/// Options of `contact_patches`.
/// @ingroup solids
struct patch_options {
    /// As in `solid_options`.
    flag known_solid = false;
    /// No more points of a patch than this: 4, 8 or 16 are looked for, in as many directions; 4 at least.
    std::size_t most_points = 8;
};

/// A corner of a patch.
/// @ingroup solids
template <scalar T>
struct patch_point {
    vec3<T> point;  ///< in the patch's plane
    T depth;        ///< how far what is there lies beyond the plane, in the other solid; 0 on a curve

    friend constexpr bool operator==(const patch_point&, const patch_point&) = default;
};

/// A region in which two solids meet. All numbers are the world's.
/// @ingroup solids
template <scalar T>
struct contact_patch {
    std::vector<curve<T>> curves;         ///< where the surfaces cross, in the order of `abut::curves`; none of a point
    vec3<T> center;                       ///< of the area; of a line or a point its middle
    vec3<T> normal;                       ///< from b to a, of length 1; or 0 where no side is the right one
    T area;                               ///< of the region as seen along the normal
    T depth;                              ///< from the lowest point of a to the highest of b in the region, along the normal
    vec3<T> deepest_a;                    ///< the lowest point of a's surface in b; the middle of those within 2^-20 of
                                          ///< the region's size
    vec3<T> deepest_b;                    ///< the highest point of b's surface in a
    std::vector<patch_point<T>> points;   ///< corners, as they lie around the normal
};

/// Two bodies whose surfaces meet, and their patches.
/// @ingroup solids
template <scalar T>
struct body_patches {
    std::uint32_t body_a;                   ///< position of the first body
    std::uint32_t body_b;                   ///< position of the second one, which is higher
    std::vector<contact_patch<T>> patches;  ///< one at least; their normals point from body_b to body_a
};

namespace detail {

/// What is said of one region.
template <scalar T>
class patch_of_region {
public:
    using N = contact_math::one_double;
    using vec = vec3<N>;

    /// A segment, and how often it bounds the region (`border_weight`).
    struct border {
        vec3<T> from, to;
        double weight;
    };
    std::vector<curve<T>> curves;
    std::vector<border> borders;
    std::vector<vec3<T>> points, vertices_a, vertices_b;  ///< of both surfaces; of a's in b; of b's in a
    /// A face, 1 where it looks to a, else -1, and what of it the region has: a segment, or a point twice.
    struct face {
        triangle<T> corners;
        double way;
        vec3<T> from, to;
    };
    std::vector<face> faces;

    contact_patch<T> measured(std::size_t most_points) {
        contact_patch<T> p{};
        find_unit();
        const vec middle = middle_of_borders();
        vec sum{};
        N of_sizes{}, length{};
        std::vector<vec> fans;
        for (const border& s : borders) {
            const vec from = local(s.from) - middle, to = local(s.to) - middle;
            const vec fan = N{s.weight / 2} * cross(from, to);
            fans.push_back(fan);
            sum = sum + fan;
            of_sizes = of_sizes + root(dot(fan, fan));
            length = length + root(dot(to - from, to - from));
        }
        const N area = root(dot(sum, sum));
        // Coordinates are off by units in their last place: of an area that is no larger than this makes of its border, and of
        // one whose parts cancel, the normal says nothing.
        const N unsure = length * N{largest_} * N{sizeof(T) == 4 ? 0x1p-20 : 0x1p-48} + of_sizes * N{0x1p-12};
        const bool is_area = unsure < area;
        const point normal = is_area ? unit_vector(vec{-sum.x, -sum.y, -sum.z}) : normal_of_faces(length.high > 0);
        const vec n = contact_math::as<N>(normal);
        vec center = middle;
        if (is_area) {
            vec moved{};
            N total{}, of_parts{};
            for (std::size_t i = 0; i < fans.size(); ++i) {
                const N part = -dot(fans[i], n);
                moved = moved + (part / N{3}) * (local(borders[i].from) - middle + (local(borders[i].to) - middle));
                total = total + part;
                of_parts = of_parts + N{absolute(part.high)};
            }
            // Of a region bent so far that parts are seen from behind, that is none of its points: by and by the middle is taken.
            const N part = N{8} * (total / of_parts) - N{1};
            const N share{least(1.0, part.high)};
            if (share.high > 0) center = middle + (share / total) * moved;
        }
        p.curves = std::move(curves);
        p.center = world(center);
        p.normal = {rounded(static_cast<T>(normal.x)), rounded(static_cast<T>(normal.y)), rounded(static_cast<T>(normal.z))};
        p.area = size_of(contact_math::scaled(contact_math::scaled(area.high, exponent_), exponent_));
        find_depth(n, p);
        if (!contact_math::is_zero(normal)) find_points(n, center, most_points, p);
        return p;
    }

private:
    using point = contact_math::point;
    static T size_of(double x) { return rounded_within<T>(x); }

    /// Of all points, about their box's middle, in units in which it has a size of about 1.
    void find_unit() {
        aabb<T> box = empty_box<T>();
        for (const auto* all : {&points, &vertices_a, &vertices_b}) {
            for (const vec3<T>& p : *all) box = merge(box, bounds(p));
        }
        const point l = widened(box.lower), u = widened(box.upper);
        origin_ = {l.x / 2 + u.x / 2, l.y / 2 + u.y / 2, l.z / 2 + u.z / 2};
        const double size = contact_math::largest_of({u.x / 2 - l.x / 2, u.y / 2 - l.y / 2, u.z / 2 - l.z / 2});
        exponent_ = size > 0 ? contact_math::exponent_of(size) : 0;
        largest_ = contact_math::scaled(std::max(contact_math::largest_of(l), contact_math::largest_of(u)), -exponent_);
    }
    [[nodiscard]] vec local(const vec3<T>& p) const {
        return contact_math::scaled_vector(contact_math::between<N>(origin_, widened(p)), -exponent_);
    }
    [[nodiscard]] vec3<T> world(const vec& v) const {
        const point p = contact_math::rounded_off(contact_math::as<N>(origin_) + contact_math::scaled_vector(v, exponent_));
        return {size_of(p.x), size_of(p.y), size_of(p.z)};
    }

    /// Of the segments by their lengths; of the points, if there are none.
    [[nodiscard]] vec middle_of_borders() const {
        vec sum{};
        N total{};
        for (const border& s : borders) {
            const vec from = local(s.from), to = local(s.to), way = to - from;
            const N length = root(dot(way, way));
            sum = sum + (length / N{2}) * (from + to);
            total = total + length;
        }
        if (!(total.high > 0)) {
            for (const vec3<T>& p : points) sum = sum + local(p);
            total = {static_cast<double>(points.size())};
        }
        return {sum.x / total, sum.y / total, sum.z / total};
    }
    /// Of the faces of b, and against those of a: by the lengths of their segments, if there are some.
    [[nodiscard]] point normal_of_faces(bool by_length) const {
        vec sum{};
        for (const face& f : faces) {
            const vec way = local(f.to) - local(f.from);
            const N weight = by_length ? root(dot(way, way)) : N{1};
            sum = sum + weight * N{f.way} * contact_math::as<N>(unit_normal_of(f.corners));
        }
        return dot(sum, sum).high > 0x1p-20 ? unit_vector(sum) : point{};
    }

    void find_depth(const vec& n, contact_patch<T>& p) const {
        const auto farthest = [&](const std::vector<vec3<T>>& more, double way, vec& at) {
            double most = -infinity<double>;
            for (const auto* all : {&points, &more}) {
                for (const vec3<T>& q : *all) most = std::max(most, way * dot(local(q), n).high);
            }
            vec sum{};
            double count = 0;
            for (const auto* all : {&points, &more}) {
                for (const vec3<T>& q : *all) {
                    const vec here = local(q);
                    if (way * dot(here, n).high < (N{most} - N{0x1p-20}).high) continue;
                    sum = sum + here;
                    ++count;
                }
            }
            at = {sum.x / N{count}, sum.y / N{count}, sum.z / N{count}};
            return most;
        };
        vec lowest{}, highest{};
        const double below = farthest(vertices_a, -1, lowest), above = farthest(vertices_b, 1, highest);
        p.deepest_a = world(lowest);
        p.deepest_b = world(highest);
        p.depth = size_of(contact_math::scaled(std::max(0.0, (N{below} + N{above}).high), exponent_));
    }

    /// The points that go farthest in directions about the normal, each turned from the plane by a little to where it is deep, so
    /// that of points that lie above one another the deepest is taken. Ties fall to the least coordinates.
    void find_points(const vec& n, const vec& center, std::size_t most_points, contact_patch<T>& p) const {
        // A direction across the normal, of the first axis that is not along it.
        const point axis = absolute(n.x.high) < 0.75 ? point{1, 0, 0} : point{0, 1, 0};
        const vec a = contact_math::as<N>(axis);
        const vec u = contact_math::as<N>(unit_vector(a - dot(a, n) * n)), v = cross(n, u);
        constexpr double circle[4][2] = {{0.98078528040323044, 0.19509032201612827}, {0.83146961230254524, 0.55557023301960222},
                                         {0.55557023301960222, 0.83146961230254524}, {0.19509032201612827, 0.98078528040323044}};
        struct candidate {
            vec at;
            double depth;
        };
        std::vector<candidate> all;
        const auto add = [&](const std::vector<vec3<T>>& some, double way) {
            for (const vec3<T>& q : some) {
                const vec here = local(q) - center;
                const N height = dot(here, n);
                all.push_back({here - height * n, std::max(0.0, way * height.high)});
            }
        };
        add(points, 0);
        add(vertices_a, -1);
        add(vertices_b, 1);
        const int directions = most_points >= 16 ? 16 : most_points >= 8 ? 8 : 4;
        for (int k = 0; k < 16; k += 16 / directions) {
            const double(&c)[2] = circle[k % 4];
            const N x{k / 4 == 0 ? c[0] : k / 4 == 1 ? -c[1] : k / 4 == 2 ? -c[0] : c[1]},
                y{k / 4 == 0 ? c[1] : k / 4 == 1 ? c[0] : k / 4 == 2 ? -c[1] : -c[0]};
            const vec d = x * u + y * v;
            const candidate* best = nullptr;
            double most = 0;
            const auto key = [](const candidate& q) { return std::array{q.at.x.high, q.at.y.high, q.at.z.high, -q.depth}; };
            for (const candidate& q : all) {
                const double reach = (dot(q.at, d) + N{q.depth / 4}).high;
                if (best == nullptr || reach > most || (!(reach < most) && key(q) < key(*best))) best = &q, most = reach;
            }
            if (best == nullptr) return;
            const patch_point<T> found{world(center + best->at), size_of(contact_math::scaled(best->depth, exponent_))};
            if (p.points.empty() || (p.points.back() != found && p.points.front() != found)) p.points.push_back(found);
        }
    }

    point origin_{};
    int exponent_ = 0;
    double largest_ = 0;
};

/// The regions of two solids from their crossings.
template <scalar T>
std::vector<contact_patch<T>> patches_of(const solid_on_host<T>& a, const solid_on_host<T>& b, std::span<const crossing<T>> contacts,
                                         std::size_t most_points) {
    using id = std::uint32_t;
    joined_curves<T> all(contacts);
    patch_regions<T> regions(all, a, b);
    std::vector<patch_of_region<T>> found(regions.size());
    for (id p = 0; p < all.points().size(); ++p) found[regions.region_of(p)].points.push_back(all.points()[p]);
    const auto add_vertices = [&](int which, const solid_surface<T>& of, std::vector<vec3<T>> patch_of_region<T>::*to) {
        for (id v = 0; v < of.vertex_numbers(); ++v) {
            if (!of.is_used(v)) continue;
            const id r = regions.region_of_vertex(which, v);
            if (r != patch_regions<T>::none) (found[r].*to).push_back(of.vertex(v));
        }
    };
    const solid_surface<T>&of_a = a.surface(), &of_b = b.surface();
    add_vertices(0, of_a, &patch_of_region<T>::vertices_a);
    add_vertices(1, of_b, &patch_of_region<T>::vertices_b);
    const border_weight<T> weight(all, of_a, of_b);
    for (const auto& s : all.segments()) {
        found[regions.region_of(s.from)].borders.push_back({all.points()[s.from], all.points()[s.to], weight.of(s)});
    }
    for (const crossing<T>& c : contacts) {
        if (c.count == 0 || c.count > 6) continue;
        auto& faces = found[regions.region_of(all.point_of(joined_curves<T>::name_of(c, 0)))].faces;
        const vec3<T>& to = c.points[c.count == 1 ? 0 : 1];
        faces.push_back({of_a.face(c.a), of_a.is_turned(c.a) ? 1.0 : -1.0, c.points[0], to});
        faces.push_back({of_b.face(c.b), of_b.is_turned(c.b) ? -1.0 : 1.0, c.points[0], to});
    }
    for (auto& line : all.take()) {
        auto& to = found[regions.region_of(all.point_of({line.features_a[0], line.features_b[0]}))].curves;
        to.push_back(std::move(line));
    }
    std::vector<contact_patch<T>> patches;
    for (auto& region : found) patches.push_back(region.measured(most_points));
    return patches;
}

/// The patches of two solids.
struct ask_patches {
    static constexpr const char* function = "abut::contact_patches";
    static constexpr bool takes_round = false;
    bool known_solid;
    std::size_t most_points;

    template <scalar T>
    static std::vector<contact_patch<T>> nothing() {
        return {};
    }
    template <class Solids>
    [[nodiscard]] auto find(const Solids& solids) const {
        using T = typename Solids::T;
        using answer = std::vector<contact_patch<T>>;
        if (!known_solid) solids.require_simple();
        if (!solids.has_a() || !solids.has_b()) return answer();
        return solids.template decide<filtered>(answer(), [&](auto& here) {
            const std::vector<crossing<T>> contacts = here.contacts();
            if (known_solid && contacts.empty()) return answer();
            const solid_on_host<T> solid_a(here.faces_a(), function), solid_b(here.faces_b(), function);
            return patches_of<T>(solid_a, solid_b, contacts, most_points);
        });
    }
};
inline ask_patches patches_by(const patch_options& options) {
    if (options.most_points < 4) {
        throw invalid_geometry(ask_patches::function, "most_points", 0, "a patch has up to 4 points at least, not",
                               static_cast<double>(options.most_points));
    }
    return {bool(options.known_solid), options.most_points};
}

/// Those of lists and scenes (solid_entries.hpp).
struct patches_of_entries : ask_patches {
    template <scalar T>
    using answer = std::vector<contact_patch<T>>;
    template <scalar T>
    using told = body_patches<T>;

    template <class Entries>
    [[nodiscard]] auto find(Entries& entries) const {
        using T = typename Entries::T;
        if (!known_solid) entries.require_solids();
        std::vector<answer<T>> found(entries.size());
        auto contacts = entries.template contacts<filtered>(std::vector<std::uint32_t>(entries.size(), 0));
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::span<const crossing<T>> some = contacts.of(i);
            if (some.empty()) continue;
            found[i] = patches_of<T>(entries.a()[entries[i].a], entries.b()[entries[i].b], some, most_points);
        }
        return found;
    }
    template <scalar T>
    static bool is_told(const std::vector<contact_patch<T>>& of) {
        return !of.empty();
    }
    template <scalar T>
    static body_patches<T> tell(const index_pair& of, std::vector<contact_patch<T>> patches) {
        return {of.a, of.b, std::move(patches)};
    }
};

}  // namespace detail

/// @addtogroup solids
///@{

/// The regions in which the surfaces of two solids meet, a patch for each, in host memory: what a solver takes in place of a
/// contact for each pair of faces. Solids are those of `relation`; under a pose all is of the placed coordinates.
///
/// A region is of all that the surfaces have in common, and of what of each surface is inside of the other solid and hangs
/// together with that. So a ring in which a rod sticks has one patch, and a table has one for each foot. Which vertices are
/// inside is decided exactly. Two curves that no vertex joins, but an edge does that passes both, are joined by the middle of
/// the edge between them, which is rounded; two curves in the inside of one face that nothing else joins are two regions. A solid
/// in the other one that does not touch its surface has no patch; nor has a part of one.
///
/// - Plane. The normal is the mean of a's surface in b, turned round: the area vector of the curves (M. Newell's sum), which
///   changes as they do. It points from b to a, as that of a contact. Where the area is no larger than what rounding makes
///   of its border (a point, an edge on a face), it is the mean of the normals of b's faces and of those of a's, turned
///   round. Where these cancel too (a rod all the way through a plate) there is no side, and it is 0.
/// - Area. The length of that vector: the area of the region, seen along the normal. Of a flat contact that of the common
///   polygon; of faces in one plane that both solids are on one side of, half of it counts.
/// - Depth. How far the lowest point of a in b is below the highest of b in a, along the normal: 0 for what only touches. A
///   move of that length separates what is in the region. Not the least one of the solids.
/// - Points. Those of the region, in the plane, that go farthest in 4, 8 or 16 directions, each there once.
///
/// All are rounded, in doubles, by one order of operations: the same bits on each policy and for every index. Patches come in
/// the order of their least names (`curves`), so which faces have which numbers says nothing but that.
///
/// Of several devices and of ranks as of `relation`; there vertices of solids in parts have numbers in the order in which the
/// faces name them. The first rank has all patches, and the others have none. Spheres and capsules are not taken.
///
/// Crossings are the policy's to find. All else is one thread's: sorts of all sides of both, and a tree of them where a
/// surface is in the other. Takes up to 500 bytes a face in host memory, and those of `curves`.
///
/// Throws invalid_geometry for what is no solid, as `relation` does, or if most_points is less than 4; else as `crossings`.
///
///     for (const auto& p : abut::contact_patches(on, mesh, abut::posed(other, there), {.known_solid = true})) {
///         push(p.normal, p.depth, p.points);
///     }
template <executor On, class X, class Y>
[[nodiscard]] auto contact_patches(const On& on, const X& a, const Y& b, const patch_options& options = {}) {
    return ask_solids(on, detail::patches_by(options), a, b);
}

/// The patches of each entry of a list, in its order: a std::vector of std::vector of `contact_patch` in host memory, each as of
/// its two trees alone. Lists are those of `relation`; a rank gets the patches of its own entries. Crossings of all entries are
/// found in one go; what follows is one thread's of the host, or of each device. Each body takes as much there as alone, and is
/// kept for the call. What is no solid is named by its entry.
template <executor On, detail::list_of_pairs List>
[[nodiscard]] auto contact_patches(const On& on, const List& list, const patch_options& options = {}) {
    return detail::answers_of_solids(on, detail::patches_of_entries{detail::patches_by(options)}, list);
}

/// The patches of all bodies of a scene: a std::vector of `body_patches` in host memory, of all two whose surfaces meet, sorted by
/// body_a, then body_b. Scenes and `which` are those of `relation`, and the rest is as of a list.
///
///     for (const auto& [a, b, patches] : abut::contact_patches(on, scene)) use(a, b, patches.front().normal);
template <executor On, detail::scene_of_bodies Scene, class Which = body_options<>>
    requires(detail::are_body_options<Which>)
[[nodiscard]] auto contact_patches(const On& on, const Scene& scene, const patch_options& options = {}, const Which& which = {}) {
    return detail::told_of_solids(on, detail::patches_of_entries{detail::patches_by(options)}, scene, which);
}

///@}

}  // namespace abut
