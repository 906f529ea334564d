// SPDX-License-Identifier: MIT
#pragma once

// What two solids have in common, of which the faces are on the host: for relation, overlaps and contact_patches. Faces that
// cross decide at once (passing_through). Where surfaces only touch, each point in which they do is looked at: near it both
// solids are cones (predicate/solid_cones.hpp). Parts of a surface that do not touch the other one are inside of it or outside
// as one of their vertices is. Where faces, pairs that pass and crossings come from is for those who are asked (ask_solids).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/boundary.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/executor.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/solid_surface.hpp>
#include <abut/collide/winding_regions.hpp>
#include <abut/index/bvh.hpp>
#include <abut/predicate/round_solids.hpp>
#include <abut/shape/check.hpp>

namespace abut {

/// Options of `relation` and `overlaps`.
/// @ingroup solids
struct solid_options {
    /// The caller knows that both are solids, and that is not looked at. Of others the answer means nothing, or
    /// invalid_geometry is thrown. With a rule: that both are closed and, but for `parity`, that faces are turned alike.
    flag known_solid = false;
    /// Takes each as what its surface goes round by this rule: the closure of all points off the surface that `inside` says to
    /// be inside. So faces with inside on both sides of them are in its interior, and those with outside on both are no part of
    /// it. A surface may pass through itself then, touch itself, and have faces without area. If not set, that is refused.
    std::optional<inside_rule> rule{};
};

namespace detail {

/// What of a triangle a segment lies in that runs between two places of it.
ABUT_HD constexpr place_in_triangle place_between(place_in_triangle p, place_in_triangle q) {
    if (p == q) return p;
    if (p > q) return place_between(q, p);
    if (q < side_of_triangle) return side_between(p, q);
    if (q == inside_of_triangle || p >= side_of_triangle) return inside_of_triangle;
    const unsigned from = q - side_of_triangle, to = from == 2 ? 0 : from + 1;
    return p == from || p == to ? q : inside_of_triangle;
}
/// Whether two triangles pass through each other: with points of a segment that is inside of both.
ABUT_HD constexpr bool pass_through(const shared_corners& all) {
    return all.count() == 2 && !all.is_flat() && place_between(all.in_first(0), all.in_first(1)) == inside_of_triangle &&
           place_between(all.in_second(0), all.in_second(1)) == inside_of_triangle;
}

/// Whether two triangles pass through each other.
template <arithmetic A>
struct passes {
    template <scalar T>
    ABUT_HD verdict decide(const triangle<T>& s, const triangle<T>& t) const {
        // In general position triangles that touch do.
        if constexpr (std::same_as<A, exact>) return verdict::unknown;
        return abut::decide<filtered>(s, t);
    }
    template <scalar T>
    ABUT_HD verdict finish(const triangle<T>& s, const triangle<T>& t) const {
        if constexpr (!std::same_as<A, exact>) {
            if (const shared_corners first = certified_corners(s, t); first.is_known()) return to_verdict(pass_through(first));
        }
        const shared_corners found = exact_corners(s, t);
        return found.is_known() ? to_verdict(pass_through(found)) : verdict::unknown;
    }
    template <scalar T>
    bool resolve(const triangle<T>& s, const triangle<T>& t) const {
        return pass_through(shared_by<A>(s, t));
    }
};
struct passing_through : touching {
    template <arithmetic A>
    [[nodiscard]] passes<A> judge() const {
        return {};
    }
};

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
std::vector<triangle<T>> triangles_of_faces(const std::vector<mesh_face<T>>& faces) {
    std::vector<triangle<T>> all;
    all.reserve(faces.size());
    for (const mesh_face<T>& f : faces) all.push_back(f.corners);
    return all;
}

template <scalar T>
aabb<T> box_of(const std::vector<mesh_face<T>>& faces) {
    aabb<T> box = empty_box<T>();
    for (const auto& f : faces) box = merge(box, bounds(f.corners));
    return box;
}

/// The faces of two solids in host memory.
template <scalar T>
using faces_of_solids = std::pair<std::vector<mesh_face<T>>, std::vector<mesh_face<T>>>;

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
void require_simple(const Policy& on, const X& x, const char* function, const std::string& element = "face",
                    coincident_vertices by = coincident_vertices::distinct) {
    const auto pairs = to_host(self_pairs(on, x, {.coincident = by}));
    if (pairs.empty()) return;
    throw invalid_geometry(function, element, pairs.front().a,
                           "the surface passes through itself or touches itself at this face; the other face is",
                           pairs.front().b);
}

/// Whether relation and overlaps take the arguments.
template <class X, class Y>
consteval bool are_solids() {
    constexpr bool are = has_faces<X> && has_faces<Y>;
    static_assert(are, "abut: solids are closed meshes (a mesh, a mesh_view, or a tree of one), boxes, oriented boxes, hulls, spheres and capsules, "
                       "posed or not");
    return are;
}

/// Whether parts of such shapes are taken as a solid: vertices in one place are one there.
template <class Shape>
consteval bool is_solid_in_parts() {
    constexpr bool is = is_triangle<Shape>;
    static_assert(is, "abut: the parts of a solid are triangles");
    return is;
}

template <class Shape>
inline constexpr bool is_round<posed_object<Shape>> = is_round<Shape>;
/// A sphere or a capsule as a capsule. Throws where it is none, or has no volume.
template <class Shape>
auto solid_capsule(const Shape& shape, const char* function) {
    if constexpr (is_posed<Shape>) {
        check(shape.pose, function);
        return solid_capsule(place(shape.pose, shape.object), function);
    } else {
        check(serial{}, single_view<Shape>{shape}, function);
        if (!(shape.radius > 0)) {
            throw invalid_geometry(function, "shape", 0, "a solid has a volume, and this shape has none; its radius is",
                                   static_cast<double>(shape.radius));
        }
        return as_capsule(shape);
    }
}

/// A box around an argument that knows one: a tree, posed or not. Of all space around any other.
template <class X>
auto known_box([[maybe_unused]] const X& x) {
    using T = scalar_of_argument<X>;
    if constexpr (requires { x.bounds(); }) {
        return x.bounds();
    } else if constexpr (requires { world_box(x.pose, x.object.bounds()); }) {
        return world_box(x.pose, x.object.bounds());
    } else {
        constexpr T far = infinity<T>;
        return aabb<T>{{-far, -far, -far}, {far, far, far}};
    }
}

// --- who is asked
//
// A question about two solids has find<T>(solids), and what it is told of them is
//   require_simple()     throws where one of them meets itself
//   has_a(), has_b()     whether they have faces
//   are_beside()         whether boxes that are known share no inner point
//   passes<A>(), touches<A>()    whether faces pass through each other, whether any touch
//   decide<A>(answer, f, touch)  f(here) where all faces are, and its answer for all who ask, or `answer` for the others; of
//                        here are faces_a(), faces_b(), and if it is asked which faces touch, contacts(), each to be called
//                        once, or touches() instead of that
// ask_solids is overloaded for devices (devices/solids.hpp) and ranks (distributed/solids.hpp).

/// Two solids in the memory of a policy.
template <class Policy, class X, class Y>
class solids_by_policy {
    using operand_a = decltype(make_operand(std::declval<const Policy&>(), std::declval<const X&>(), ""));
    using operand_b = decltype(make_operand(std::declval<const Policy&>(), std::declval<const Y&>(), ""));

public:
    using T = scalar_of_argument<X>;
    /// faces: of both on the host, where they are there; or null
    solids_by_policy(const Policy& on, const X& x, const Y& y, const char* function, const faces_of_solids<T>* faces = nullptr)
        : on_(on), x_(x), y_(y), function_(function), faces_(faces), a_(make_operand(on, x, function)), b_(make_operand(on, y, function)),
          pairing_(pair_operands(on_, a_, b_, all_)) {}
    solids_by_policy(const solids_by_policy&) = delete;
    solids_by_policy& operator=(const solids_by_policy&) = delete;

    void require_simple() const {
        detail::require_simple(on_, x_, function_);
        detail::require_simple(on_, y_, function_);
    }
    [[nodiscard]] bool has_a() const { return a_.shapes().size() > 0; }
    [[nodiscard]] bool has_b() const { return b_.shapes().size() > 0; }
    [[nodiscard]] bool are_beside() const { return detail::are_beside(known_box(x_), known_box(y_)); }
    template <arithmetic A>
    [[nodiscard]] bool passes() const {
        return ask_for<A>(passing_through{}, whether{}).find(on_, pairing_);
    }
    template <arithmetic A>
    [[nodiscard]] bool touches() const {
        return ask_for<A>(touching{}, whether{}).find(on_, pairing_);
    }
    template <arithmetic A, class Answer, class F>
    [[nodiscard]] Answer decide(const Answer&, const F& f, bool = true) const {
        here<A> all{*this};
        return f(all);
    }

private:
    template <arithmetic A>
    struct here {
        const solids_by_policy& all;
        [[nodiscard]] auto faces_a() const { return all.faces_ != nullptr ? all.faces_->first : faces_on_host(all.on_, all.a_); }
        [[nodiscard]] auto faces_b() const { return all.faces_ != nullptr ? all.faces_->second : faces_on_host(all.on_, all.b_); }
        [[nodiscard]] bool touches() const { return all.template touches<A>(); }
        [[nodiscard]] std::vector<crossing<T>> contacts() const {
            return to_host(ask_for<A>(touching{}, all_crossings{}).find(all.on_, all.pairing_));
        }
    };

    const Policy& on_;
    const X& x_;
    const Y& y_;
    const char* function_;
    const faces_of_solids<T>* faces_;
    operand_a a_;
    operand_b b_;
    query_options<> all_;
    decltype(pair_operands(std::declval<const Policy&>(), std::declval<const operand_a&>(), std::declval<const operand_b&>(),
                           std::declval<const query_options<>&>())) pairing_;
};

/// Triangles with numbers of their corners: those in one place have one number, in the order in which triangles name them.
template <scalar T>
std::vector<mesh_face<T>> faces_by_place(const std::vector<triangle<T>>& all) {
    using id = std::uint32_t;
    const auto corner = [&](id i) -> const vec3<T>& {
        const triangle<T>& t = all[i / 3];
        return i % 3 == 0 ? t.a : i % 3 == 1 ? t.b : t.c;
    };
    const auto before = [&](id i, id j) {
        const vec3<T>&p = corner(i), &q = corner(j);
        return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
    };
    std::vector<id> order(3 * all.size()), first(order.size());
    for (id i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](id i, id j) { return before(i, j) || (!before(j, i) && i < j); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        first[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
    }
    std::vector<mesh_face<T>> faces;
    faces.reserve(all.size());
    id next = 0;
    std::vector<id>& number = order;
    for (id i = 0; i < first.size(); ++i) number[i] = first[i] == i ? next++ : number[first[i]];
    for (id f = 0; f < all.size(); ++f) faces.push_back({all[f], {number[3 * f], number[3 * f + 1], number[3 * f + 2]}});
    return faces;
}

/// Two solids that were in parts, of which all has come to the host: triangles, and ids of those that touch, in order.
template <arithmetic A, scalar T>
class gathered_solids {
public:
    template <class Pair>
    gathered_solids(const std::vector<triangle<T>>& a, const std::vector<triangle<T>>& b, const std::vector<Pair>& touching)
        : faces_a_(faces_by_place(a)), faces_b_(faces_by_place(b)) {
        contacts_.reserve(touching.size());
        for (const Pair& p : touching) {
            const mesh_face<T>&s = faces_a_[p.a], &t = faces_b_[p.b];
            crossing<T> c{};
            c.a = static_cast<std::uint32_t>(p.a);
            c.b = static_cast<std::uint32_t>(p.b);
            std::copy(std::begin(s.vertex), std::end(s.vertex), c.vertices_a);
            std::copy(std::begin(t.vertex), std::end(t.vertex), c.vertices_b);
            put_corners(shared_by<A>(s.corners, t.corners), s.corners, t.corners, c);
            contacts_.push_back(c);
        }
    }
    [[nodiscard]] std::vector<mesh_face<T>> faces_a() { return std::move(faces_a_); }
    [[nodiscard]] std::vector<mesh_face<T>> faces_b() { return std::move(faces_b_); }
    [[nodiscard]] std::vector<crossing<T>> contacts() { return std::move(contacts_); }
    [[nodiscard]] bool touches() const { return !contacts_.empty(); }

private:
    std::vector<mesh_face<T>> faces_a_, faces_b_;
    std::vector<crossing<T>> contacts_;
};

template <execution_policy Policy, class Question, class X, class Y>
auto ask_solids(const Policy& on, const Question& question, const X& x, const Y& y) {
    if constexpr (is_round<X> || is_round<Y>) {
        static_assert(Question::takes_round, "abut: patches are those of meshes, boxes and hulls: spheres and capsules have no faces");
        if constexpr (Question::takes_round) {
            return question.find_round(on, x, y);
        } else {
            return question.template nothing<float>();
        }
    } else if constexpr (is_polytope<X> || is_polytope<Y>) {
        return ask_solids(on, question, as_solid(on, x, question.function), as_solid(on, y, question.function));
    } else if constexpr (are_solids<X, Y>()) {
        return question.find(solids_by_policy<Policy, X, Y>(on, x, y, question.function));
    } else {
        return question.template nothing<float>();
    }
}

/// What two have in common that are taken by a rule, of which require_turns holds, until that is enough.
template <scalar T, class Enough>
regions_and_touch regions_by_rule(const std::vector<mesh_face<T>>& a, const std::vector<mesh_face<T>>& b, inside_rule rule,
                                  const Enough& is_enough) {
    if (!overlaps(box_of(a), box_of(b))) return {{false, true, true}, false};
    const winding_surface<T> of_a(a), of_b(b);
    return winding_regions<T>(of_a, of_b, rule).find(is_enough);
}

/// What two solids have in common, until that is enough, and, if that is asked, whether their surfaces touch.
template <arithmetic A, class Enough>
struct ask_regions {
    using answer = regions_and_touch;
    static constexpr bool takes_round = true;
    const char* function;
    solid_options options;
    bool whether_touching;
    Enough is_enough;

    template <scalar>
    static answer nothing() {
        return {};
    }
    template <class Solids>
    [[nodiscard]] answer find(const Solids& solids) const {
        using T = typename Solids::T;
        const bool known_solid = options.known_solid, has_a = solids.has_a(), has_b = solids.has_b();
        if (options.rule) {
            const auto look = [&](auto& here) {
                const auto faces_a = here.faces_a(), faces_b = here.faces_b();
                for (const auto* of : {&faces_a, &faces_b}) {
                    if (!known_solid) require_turns(*of, *options.rule, function);
                }
                return regions_by_rule(faces_a, faces_b, *options.rule, is_enough);
            };
            return solids.template decide<A>(answer{}, look, false);
        }
        if (!known_solid) solids.require_simple();
        if (!has_a || !has_b) return answer{{false, has_a, has_b}, false};
        const answer of_passing{{true, true, true}, true}, of_apart{{false, true, true}, false};
        if (known_solid && solids.are_beside()) return answer{of_apart.found, whether_touching && solids.template touches<A>()};
        const bool passes = solids.template passes<A>();
        if (known_solid && passes) return of_passing;
        const auto look = [&](auto& here) {
            auto faces_a = here.faces_a(), faces_b = here.faces_b();
            const bool beside = are_beside(box_of(faces_a), box_of(faces_b));
            const auto of_beside = [&] { return answer{of_apart.found, whether_touching && here.touches()}; };
            if (known_solid && beside) return of_beside();
            const solid_on_host<T> solid_a(std::move(faces_a), function), solid_b(std::move(faces_b), function);
            if (passes) return of_passing;
            if (beside) return of_beside();
            const std::vector<crossing<T>> contacts = here.contacts();
            return answer{regions_of_solids<T>(solid_a, solid_b, contacts, is_enough), !contacts.empty()};
        };
        return solids.template decide<A>(of_passing, look, !passes);
    }
    /// Of a round solid and another one: the policy looks for the faces that it meets.
    template <class Policy, class X, class Y>
    [[nodiscard]] answer find_round(const Policy& on, const X& x, const Y& y) const {
        if constexpr (!is_round<X>) {
            answer of = find_round(on, y, x);
            std::swap(of.found.first_alone, of.found.second_alone);
            return of;
        } else if constexpr (is_round<Y>) {
            return regions_of_round(solid_capsule(x, function), solid_capsule(y, function));
        } else if constexpr (is_polytope<Y>) {
            return find_round(on, x, as_solid(on, y, function));
        } else if constexpr (are_solids<Y, Y>()) {
            using T = scalar_of_argument<Y>;
            const bool known_solid = options.known_solid;
            if (options.rule) throw error(std::string(function) + ": no mesh beside a sphere or a capsule is taken by a rule; expected no `rule`");
            const capsule<T> round = solid_capsule(x, function);
            const auto b = make_operand(on, y, function);
            if (!known_solid) require_simple(on, y, function);
            const answer of_apart{{false, true, b.shapes().size() > 0}, false};
            if (b.shapes().size() == 0 || (known_solid && !overlaps(known_box(y), bounds(round)))) return of_apart;
            const solid_on_host<T> solid(faces_on_host(on, b), function);
            std::vector<std::uint32_t> met;
            for (const index_pair& p : to_host(ask_pairs(on, ask_for<A>(touching{}, all_pairs{}), two{y, round}, query_options<>{}, function))) {
                met.push_back(p.a);
            }
            return regions_of_round(round, solid.surface().faces(), met, [&](const vec3<T>& p) { return bool(solid.have_inside({p}).front()); });
        } else {
            return {};
        }
    }
};
template <arithmetic A, class Enough>
ask_regions<A, Enough> regions_until(const char* function, const solid_options& options, bool whether_touching, const Enough& is_enough) {
    return {function, options, whether_touching, is_enough};
}
/// Whether interiors meet.
template <arithmetic A>
auto common_interior(const char* function, const solid_options& options) {
    return regions_until<A>(function, options, false, [](const common_regions& regions) { return regions.both; });
}

}  // namespace detail

}  // namespace abut
