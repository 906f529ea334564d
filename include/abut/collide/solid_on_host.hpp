// SPDX-License-Identifier: MIT
#pragma once

// Solids on the host: the faces of arguments and of bodies where they are placed, boxes around them, and what two solids have in
// common of which no faces pass through each other. `relation` and `penetration` ask for these when faces alone do not decide.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/crossings.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/solid_surface.hpp>
#include <abut/collide/touching_bodies.hpp>
#include <abut/index/bvh.hpp>

namespace abut::detail {

// --- faces and boxes

template <class View, scalar T>
struct copy_face {
    View shapes;
    mesh_face<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const corner_ids v = vertices_of_shape(shapes, static_cast<std::uint32_t>(i));
        out[i] = {shapes[i], {v.of[0], v.of[1], v.of[2]}};
    }
};
/// The faces of an operand, where they are placed, in host memory.
template <class Policy, class Operand>
auto faces_on_host(const Policy& on, const Operand& x) {
    const auto shapes = x.shapes();
    using T = typename std::remove_const_t<decltype(shapes)>::scalar_type;
    execution::buffer_of<Policy, mesh_face<T>> faces(on, shapes.size());
    for_each_index(on, shapes.size(), copy_face<std::remove_const_t<decltype(shapes)>, T>{shapes, faces.data()});
    std::vector<mesh_face<T>> here(shapes.size());
    download(on, faces.data(), here.size(), here.data());
    return here;
}

template <scalar T>
aabb<T> box_of(const std::vector<mesh_face<T>>& faces) {
    aabb<T> box = empty_box<T>();
    for (const auto& f : faces) box = merge(box, bounds(f.corners));
    return box;
}

/// The faces of two arguments in host memory.
template <class Policy, class X, class Y>
auto faces_of_both(const Policy& on, const X& x, const Y& y, const char* function) {
    return std::pair(faces_on_host(on, make_operand(on, x, function)), faces_on_host(on, make_operand(on, y, function)));
}

/// Whether no inner point of one box is one of the other. Then solids within them have none in common.
template <scalar T>
constexpr bool are_beside(const aabb<T>& a, const aabb<T>& b) {
    const auto are = [](T lower_a, T upper_a, T lower_b, T upper_b) { return upper_a <= lower_b || upper_b <= lower_a; };
    return are(a.lower.x, a.upper.x, b.lower.x, b.upper.x) || are(a.lower.y, a.upper.y, b.lower.y, b.upper.y) ||
           are(a.lower.z, a.upper.z, b.lower.z, b.upper.z);
}

/// Whether boxes are beside each other but for roundings, which are small beside their sizes. Saves looking more closely.
template <scalar T>
constexpr bool are_nearly_beside(const aabb<T>& a, const aabb<T>& b) {
    const auto are = [](T lower_a, T upper_a, T lower_b, T upper_b) {
        const T common = std::min(upper_a, upper_b) - std::max(lower_a, lower_b);
        return common <= T(0x1p-8) * std::min(upper_a - lower_a, upper_b - lower_b);
    };
    return are(a.lower.x, a.upper.x, b.lower.x, b.upper.x) || are(a.lower.y, a.upper.y, b.lower.y, b.upper.y) ||
           are(a.lower.z, a.upper.z, b.lower.z, b.upper.z);
}

// --- a solid

/// A solid on the host. Not for several threads at a time.
template <scalar T>
class solid_on_host {
public:
    solid_on_host(std::vector<mesh_face<T>> faces, const char* function, const std::string& element = "face")
        : surface_(std::move(faces), function, element) {}

    [[nodiscard]] const solid_surface<T>& surface() const { return surface_; }
    /// Whether points that are not on the surface are inside.
    [[nodiscard]] std::vector<bool> have_inside(std::vector<vec3<T>> vertices) const {
        const serial on;
        if (!tree_ && vertices.size() <= few) {
            std::vector<bool> are;
            for (const vec3<T>& v : vertices) are.push_back(surface_.has_inside(v));
            return are;
        }
        if (!tree_) {
            std::vector<triangle<T>> corners;
            corners.reserve(surface_.size());
            for (const mesh_face<T>& f : surface_.faces()) corners.push_back(f.corners);
            tree_.emplace(make_bvh(on, triangle_soup<T>(std::move(corners))));
        }
        return are_inside(on, *tree_, vertices, "abut::relation");
    }

private:
    using tree_type = decltype(make_bvh(serial{}, triangle_soup<T>()));

    static constexpr std::size_t few = 8;  ///< points for which all faces are looked at sooner than a tree is made
    solid_surface<T> surface_;
    mutable std::optional<tree_type> tree_;
};

/// What of a triangle a segment lies in that runs between two places of it.
ABUT_HD constexpr place_in_triangle place_between(place_in_triangle p, place_in_triangle q) {
    if (p == q) return p;
    if (p > q) return place_between(q, p);
    if (q < side_of_triangle) return side_between(p, q);
    if (q == inside_of_triangle || p >= side_of_triangle) return inside_of_triangle;
    const unsigned from = q - side_of_triangle, to = from == 2 ? 0 : from + 1;
    return p == from || p == to ? q : inside_of_triangle;
}
/// What two solids have in common of which no faces pass through each other, from what faces do have in common, until that is
/// enough.
template <scalar T, class Enough>
common_regions regions_of_solids(const solid_on_host<T>& a, const solid_on_host<T>& b, std::span<const crossing<T>> contacts,
                                 const Enough& is_enough) {
    const solid_surface<T>&of_a = a.surface(), &of_b = b.surface();
    std::vector<char> touched_a(of_a.parts(), 0), touched_b(of_b.parts(), 0);
    struct contact_place {
        std::array<mesh_feature, 2> name;
        std::uint32_t face_a, face_b;
        place_in_triangle in_a, in_b;
    };
    std::vector<contact_place> places;
    for (crossing<T> c : contacts) {
        const auto add = [&](place_in_triangle in_a, place_in_triangle in_b) {
            c.in_a[0] = static_cast<unsigned char>(in_a);
            c.in_b[0] = static_cast<unsigned char>(in_b);
            places.push_back({{c.feature_a(0), c.feature_b(0)}, c.a, c.b, in_a, in_b});
        };
        const crossing<T> all = c;
        for (int i = 0; i < all.count; ++i) {
            add(all.in_a[i], all.in_b[i]);
            const int j = i + 1 == all.count ? 0 : i + 1;
            if (i < j || all.count > 2) add(place_between(all.in_a[i], all.in_a[j]), place_between(all.in_b[i], all.in_b[j]));
        }
        if (all.count > 2) add(inside_of_triangle, inside_of_triangle);
        touched_a[of_a.part_of(c.a)] = touched_b[of_b.part_of(c.b)] = 1;
    }
    std::sort(places.begin(), places.end(), [](const auto& p, const auto& q) { return p.name < q.name; });
    common_regions found;
    for (std::size_t i = 0; i < places.size() && !is_enough(found); ++i) {
        const contact_place& p = places[i];
        if (i > 0 && p.name == places[i - 1].name) continue;
        found |= regions_of_cones(of_a.cone_at(p.face_a, p.in_a), of_b.cone_at(p.face_b, p.in_b));
    }
    // Parts that touch nothing.
    const auto look_at_parts = [&](const solid_surface<T>& of, const std::vector<char>& touched, const solid_on_host<T>& other,
                                   const common_regions& if_inside, const common_regions& if_outside) {
        std::vector<vec3<T>> vertices;
        for (std::uint32_t p = 0; p < of.parts(); ++p) {
            if (touched[p] == 0) vertices.push_back(of.vertex_of_part(p));
        }
        if (vertices.empty() || is_enough(found)) return;
        for (const bool is : other.have_inside(std::move(vertices))) found |= is ? if_inside : if_outside;
    };
    look_at_parts(of_a, touched_a, b, {true, false, true}, {false, true, false});
    look_at_parts(of_b, touched_b, a, {true, true, false}, {false, false, true});
    return found;
}

/// Throws where a surface passes through itself or touches itself.
template <class Policy, class X>
void require_simple(const Policy& on, const X& x, const char* function, const std::string& element = "face") {
    const auto pairs = to_host(self_pairs(on, x));
    if (pairs.empty()) return;
    throw invalid_geometry(function, element, pairs.front().a,
                           "the surface passes through itself or touches itself at this face; the other face is",
                           pairs.front().b);
}

// --- many of them

/// Bodies on the host, each made when it is asked for.
template <class Policy, class Index>
class bodies_on_host {
public:
    using T = typename Index::scalar_type;

    bodies_on_host(const Policy& on, const placed_bodies<Index>& all, const char* function, const char* what)
        : on_(on), objects_(*all.objects), function_(function), what_(what), object_of_(all.size()), poses_(all.size()),
          faces_(all.size()), made_(all.size()), one_part_(all.objects->indices.size()) {
        download(on, all.objects->object_of.data(), all.size(), object_of_.data());
        download(on, all.poses->data(), all.size(), poses_.data());
    }
    const solid_on_host<T>& operator[](std::uint32_t i) {
        if (!made_[i]) made_[i] = std::make_unique<solid_on_host<T>>(faces(i).first, function_, element(i));
        return *made_[i];
    }
    /// The faces of a body, and the box around them.
    const std::pair<std::vector<mesh_face<T>>, aabb<T>>& faces(std::uint32_t i) {
        if (!faces_[i]) {
            const auto shapes = view_of(objects_.indices[object_of_[i]].set());
            const placed_shapes<std::remove_const_t<decltype(shapes)>> placed{{shapes, poses_[i]}};
            auto all = faces_on_host(on_, placed);
            const aabb<T> box = box_of(all);
            faces_[i].emplace(std::move(all), box);
        }
        return *faces_[i];
    }
    /// A box around a body, which may be larger than that around its faces.
    [[nodiscard]] aabb<T> known_box(std::uint32_t i) const {
        return world_box(poses_[i], objects_.indices[object_of_[i]].bounds());
    }
    /// Whether a body's surface is of one part. It is the same of all bodies of an index.
    bool has_one_part(std::uint32_t i) {
        std::optional<bool>& has = one_part_[object_of_[i]];
        if (!has) has = (*this)[i].surface().parts() <= 1;
        return *has;
    }
    /// Throws where the surface of a body's index passes through itself.
    void require_solids(const std::vector<index_pair>& entries, bool second) {
        std::vector<char> looked(objects_.indices.size(), 0);
        for (const index_pair& e : entries) {
            const std::uint32_t i = second ? e.b : e.a, object = object_of_[i];
            if (std::exchange(looked[object], 1) != 0) continue;
            require_simple(on_, objects_.indices[object], function_, element(i));
            (void)(*this)[i];
        }
    }

private:
    template <class View>
    struct placed_shapes {
        posed_view<View> placed;
        [[nodiscard]] const posed_view<View>& shapes() const { return placed; }
    };
    [[nodiscard]] std::string element(std::uint32_t i) const { return std::string(what_) + " " + std::to_string(i) + ", face"; }

    const Policy& on_;
    const placed_objects<Index>& objects_;
    const char *function_, *what_;
    std::vector<std::uint32_t> object_of_;
    std::vector<rigid<T>> poses_;
    std::vector<std::optional<std::pair<std::vector<mesh_face<T>>, aabb<T>>>> faces_;
    std::vector<std::unique_ptr<solid_on_host<T>>> made_;
    std::vector<std::optional<bool>> one_part_;  ///< of each index
};

}  // namespace abut::detail
