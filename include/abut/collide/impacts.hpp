// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts, first_impact: continuous collision. Which vertices of one mesh in motion meet which faces of another,
// which edges meet which edges, and when.
//
// The rule of an index (pair_rule.hpp) says how pairs of features are found. By the default, feature_trees, features have trees
// of their own: faces, in which vertices look, and edges. So each pair is met once, and nothing has to be left out because
// another pair of triangles has it too. A search (search.hpp) leaves pairs that touch, and the few that registers cannot decide;
// what reads both again and writes the time of each pair leaves those out that do not touch.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/face_impacts.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/refit.hpp>
#include <abut/narrow/feature_weights.hpp>
#include <abut/narrow/time_of_impact.hpp>
#include <abut/shape/motion.hpp>
#include <abut/traverse/front.hpp>

namespace abut {

/// Two features that meet. `vertices` are the vertex and the three of the face, in their order; or the two of the first
/// mesh's edge, the smaller first, and the two of the other. In self queries faces never come first, and the smaller edge
/// does. `time` is the earliest in [0, 1] at which they touch; it is a double also of meshes in float.
template <scalar T>
struct impact {
    using scalar_type = T;
    feature_pair kind;
    std::array<std::uint32_t, 4> vertices;
    double time;

    friend constexpr bool operator==(const impact&, const impact&) = default;
};

/// Options of `impacts`, `self_impacts` and `first_impact`.
struct impact_options {
    /// By kind, then by the first feature's number, then by the second's: vertices and faces by their ids, edges in the order
    /// of their vertices. Without it the order is any, and may differ from call to call.
    bool sorted = true;
    /// Of `conservative` alone.
    conservative_bounds bounds = {};
};

/// Where queries of one mesh, or of one pair of them, came to their ends, for each kind of features, for the next step to begin
/// there (traverse/front.hpp). They belong to the topologies of indices, so they are for indices that are refitted.
struct impact_fronts {
    front vertex_face, face_vertex, edge_edge;

    explicit impact_fronts(const front_options& options = {})
        : vertex_face(options), face_vertex(options), edge_edge(options) {}
};

/// A mesh in motion with what `impacts` looks in: its edges, and trees over its faces, its edges and its vertices, of boxes around
/// the whole step. Made by make_impact_index; `refit` brings it to the next step. Immutable; copies share everything.
template <scalar T, memory_space Space>
class impact_index {
public:
    using scalar_type = T;
    using memory_space = Space;
    using mesh_type = moving_set<abut::mesh<T, Space>>;
    using edges_type = moving_set<edge_mesh<T, Space>>;
    using vertices_type = moving_set<points<T, Space>>;

    impact_index(bvh<mesh_type, Space> faces, bvh<edges_type, Space> edges, bvh<vertices_type, Space> vertices)
        : faces_(std::move(faces)), edges_(std::move(edges)), vertices_(std::move(vertices)) {}

    /// Number of faces.
    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    [[nodiscard]] int device() const { return faces_.device(); }
    [[nodiscard]] const mesh_type& mesh() const { return faces_.set(); }
    [[nodiscard]] const bvh<mesh_type, Space>& faces() const { return faces_; }
    [[nodiscard]] const bvh<edges_type, Space>& edges() const { return edges_; }
    [[nodiscard]] const bvh<vertices_type, Space>& vertices() const { return vertices_; }

private:
    bvh<mesh_type, Space> faces_;
    bvh<edges_type, Space> edges_;
    bvh<vertices_type, Space> vertices_;
};

/// An index of a mesh in motion, or of one at rest, in the policy's memory: an impact_index, or by one of the rules of faces a
/// face_impact_index. Queries go by the rule of the index that they are given, and by feature_trees where there is none. Returns
/// when it is there. Throws as `edges` and make_bvh do.
///
///     const auto index = abut::make_impact_index<abut::pair_rule::orphan_sets>(on, step);
///     const auto found = abut::self_impacts(on, index);
template <pair_rule Rule = pair_rule::feature_trees, execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto make_impact_index(const Policy& on, const moving_set<mesh<T, Space>>& set, const bvh_options& options = {}) {
    constexpr const char* function = "abut::make_impact_index";
    const auto resident = detail::make_resident(on, set, function);
    if constexpr (Rule == pair_rule::feature_trees) {
        return impact_index<T, space_of<Policy>>(make_bvh(on, resident, options), make_bvh(on, edges(on, resident), options),
                                                 make_bvh(on, vertices(resident), options));
    } else {
        return detail::make_face_impact_index<Rule>(on, resident, options, function);
    }
}
template <pair_rule Rule = pair_rule::feature_trees, execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto make_impact_index(const Policy& on, const mesh<T, Space>& at_rest, const bvh_options& options = {}) {
    return make_impact_index<Rule>(on, moving_set<mesh<T, Space>>(at_rest, at_rest), options);
}

namespace detail {

/// A mesh in motion in the policy's memory, if it has the faces of an index.
template <class Policy, class Index, class Set>
auto resident_of_index(const Policy& on, const Index& index, const Set& set) {
    constexpr const char* function = "abut::refit";
    auto resident = make_resident(on, set, function);
    check_motion_sizes(index.mesh().t0().view(), resident.t0().view(), function);
    check_elements(on, index.mesh().t0().view(), resident.t0().view(), function);
    return resident;
}
/// The same edges over the vertices of another step.
template <scalar T, memory_space Space>
moving_set<edge_mesh<T, Space>> edges_over(const moving_set<edge_mesh<T, Space>>& edges, const moving_set<mesh<T, Space>>& step) {
    const auto at = [&](const mesh<T, Space>& time) { return set_parts::with_points(edges.t0(), vertices(time)); };
    return {at(step.t0()), at(step.t1())};
}

}  // namespace detail

/// The index of another step of the same mesh: its trees have the topology of `index`, its boxes are those of `set`, which has
/// the same faces. Returns when it is there. Results are right however far the mesh has moved; `quality` of the trees tells when
/// to make a new index. Throws error for other faces, and as `refit` of a tree does.
template <execution_policy Policy, scalar T, memory_space Space, memory_space From>
[[nodiscard]] impact_index<T, Space> refit(const Policy& on, const impact_index<T, Space>& index,
                                           const moving_set<mesh<T, From>>& set) {
    const auto resident = detail::resident_of_index(on, index, set);
    return {refit(on, index.faces(), resident), refit(on, index.edges(), detail::edges_over(index.edges().set(), resident)),
            refit(on, index.vertices(), vertices(resident))};
}
template <execution_policy Policy, scalar T, memory_space Space, pair_rule Rule, memory_space From>
[[nodiscard]] face_impact_index<T, Space, Rule> refit(const Policy& on, const face_impact_index<T, Space, Rule>& index,
                                                      const moving_set<mesh<T, From>>& set) {
    const auto resident = detail::resident_of_index(on, index, set);
    return {refit(on, index.faces(), resident), detail::edges_over(index.edges(), resident), index.parts(), index.orphans()};
}

namespace detail {

/// A judge of two features in motion. It lets pass what registers cannot decide: the time will tell. But for `exact`, which
/// decides nothing in registers, a host resolves each pair, so that its candidates are not kept.
template <motion_arithmetic A>
struct touch_in_motion {
    static constexpr bool may_report_more = true;
    conservative_bounds bounds;

    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        if constexpr (!are_features<S, U>) {
            return (*this).decide(t, s);
        } else if constexpr (arithmetic<A>) {
            using abut::decide;
            return decide<A>(s, t);
        } else {
            if (bounds.separation > 0) return verdict::unknown;
            const verdict v = abut::decide<filtered>(s, t);
            return v == verdict::no ? v : verdict::unknown;
        }
    }
    template <class S, class U>
    ABUT_HD verdict finish(const S& s, const U& t) const {
        if constexpr (!are_features<S, U>) {
            return (*this).finish(t, s);
        } else if constexpr (std::same_as<A, filtered>) {
            return decide_late<filtered>(s, t) == verdict::no ? verdict::no : verdict::yes;
        } else if constexpr (std::same_as<A, conservative>) {
            return to_verdict(time_in_registers<A, is_moving_edge<S>>(points_of(s, t), bounds) >= 0);
        } else {
            return verdict::unknown;
        }
    }
    template <class S, class U>
    bool resolve(const S& s, const U& t) const {
        if constexpr (are_features<S, U>) {
            return abut::resolve(s, t);
        } else {
            return abut::resolve(t, s);
        }
    }
};

/// Pairs of ids that have no vertex in common.
struct share_no_vertex_with_face {
    strided<face> faces;
    ABUT_HD bool operator()(std::uint32_t v, std::uint32_t f) const {
        const std::uint32_t* const corner = corners_at(faces, f);
        return v != corner[0] && v != corner[1] && v != corner[2];
    }
};
struct share_no_vertex_with_edge {
    strided<edge> edges;
    ABUT_HD bool operator()(std::uint32_t i, std::uint32_t j) const {
        const std::uint32_t *const a = corners_at(edges, i), *const b = corners_at(edges, j);
        return a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1];
    }
};

/// Features in motion are crowded in places, and work is dealt out evenly again and again (docs/benchmarks.md).
template <class Filter, traversal Traversal>
using feature_options = query_options<Filter, Traversal, schedule::static_partition>;

/// Where the queries of a step begin: at the roots, or at fronts.
struct no_fronts {
    static constexpr traversal way = traversal::both_at_once;
    front *vertex_face = nullptr, *face_vertex = nullptr, *edge_edge = nullptr;
};
struct given_fronts {
    static constexpr traversal way = traversal::from_front;
    front *vertex_face, *face_vertex, *edge_edge;
    explicit given_fronts(impact_fronts& all)
        : vertex_face(&all.vertex_face), face_vertex(&all.face_vertex), edge_edge(&all.edge_edge) {}
};

/// How near boxes of features have to come. Throws where the bounds are no bounds.
template <motion_arithmetic A, scalar T>
auto nearness_of(const conservative_bounds& bounds, const char* function) {
    if constexpr (std::same_as<A, conservative>) {
        if (!(bounds.separation >= 0 && bounds.separation <= static_cast<double>(largest_finite<T>) && bounds.tolerance >= 0)) {
            throw error(std::string(function) + ": separation is " + std::to_string(bounds.separation) + ", tolerance " +
                        std::to_string(bounds.tolerance) + "; expected 0 or more, and finite");
        }
        const T rounded = static_cast<T>(bounds.separation);
        return near_within<T>{static_cast<double>(rounded) < bounds.separation ? next_up(rounded) : rounded};
    } else {
        return near_enough_to_touch{};
    }
}

/// Two features of one kind that are asked about their pairs: a pairing, and how its ids name vertices.
template <feature_pair Kind, class Pairing>
struct pairing_of_features {
    static constexpr feature_pair kind = Kind;
    Pairing pairing;
    strided<face> faces;
    strided<edge> edges_a, edges_b;
};

/// What a kernel sees of one.
template <feature_pair Kind, class View>
struct view_of_features {
    using T = typename View::shape_type_a::scalar_type;
    static constexpr bool are_edges = Kind == feature_pair::edge_edge;
    View both;
    strided<face> faces;
    strided<edge> edges_a, edges_b;
    const std::uint64_t* keys;

    [[nodiscard]] ABUT_HD moving_points<T> points(std::size_t i) const {
        if constexpr (Kind == feature_pair::face_vertex) {
            return points_of(both.shape_b(keys[i]), both.shape_a(keys[i]));
        } else {
            return points_of(both.shape_a(keys[i]), both.shape_b(keys[i]));
        }
    }
    ABUT_HD void write_names(std::size_t i, impact<T>& made) const {
        const std::uint32_t a = both.key.a(keys[i]), b = both.key.b(keys[i]);
        auto* const v = reinterpret_cast<std::uint32_t*>(&made.vertices);
        made.kind = Kind;
        if constexpr (are_edges) {
            const std::uint32_t *const of_a = corners_at(edges_a, a), *const of_b = corners_at(edges_b, b);
            v[0] = of_a[0], v[1] = of_a[1], v[2] = of_b[0], v[3] = of_b[1];
        } else {
            constexpr bool vertex_first = Kind == feature_pair::vertex_face;
            const std::uint32_t* const corner = corners_at(faces, vertex_first ? b : a);
            v[0] = vertex_first ? a : b, v[1] = corner[0], v[2] = corner[1], v[3] = corner[2];
        }
    }
};

/// Writes impact i; counts it where there is none, and hands on i where its time is not known.
template <motion_arithmetic A, class View>
struct write_impact {
    View features;
    conservative_bounds bounds;
    impact<typename View::T>* out;

    ABUT_CALLS_ANY
    template <class None, class Open>
    ABUT_HD void operator()(std::size_t i, None& none, Open& open) const {
        features.write_names(i, out[i]);
        const double time = time_in_registers<A, View::are_edges>(features.points(i), bounds);
        out[i].time = time;
        if (time == time_in_bits::none) none.add(1);
        if (time == time_in_bits::unknown) open.push(i);
    }
};
/// The same where all is known at once.
template <motion_arithmetic A, class View>
struct write_impact_on_host : write_impact<A, View> {
    template <class None>
    void operator()(std::size_t i, None& none) const {
        this->features.write_names(i, this->out[i]);
        this->out[i].time = time_on_host<A, View::are_edges>(this->features.points(i), this->bounds);
        if (this->out[i].time < 0) none.add(1);
    }
};

/// What a device could not decide, on its way to the host; and what the host says.
template <class View>
struct fetch_points {
    View features;
    const std::uint64_t* which;
    moving_points<typename View::T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = features.points(which[i]); }
};
template <scalar T>
struct set_time {
    const std::uint64_t* which;
    const double* times;
    impact<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[which[i]].time = times[i]; }
};

template <scalar T>
struct is_impact {
    const impact<T>* all;
    ABUT_HD bool operator()(std::size_t i) const { return all[i].time >= 0; }
};

/// Writes the impacts of pairs that were found. Returns whether some of these are none.
template <motion_arithmetic A, class Policy, class View>
bool write_impacts(const Policy& on, const View& features, std::size_t count, const conservative_bounds& bounds,
                   impact<typename View::T>* out) {
    using T = typename View::T;
    execution::work_count<space_of<Policy>> none(on);
    key_queue<Policy> open(on, 1024);
    const write_impact<A, View> write{features, bounds, out};
    if constexpr (host_policy<Policy>) {
        for_each_index(on, count, write_impact_on_host<A, View>{write}, none);
    } else {
        for_each_index(on, count, write, none, open);
    }
    const std::size_t n = open.size();
    bool some_are_none = none.total() > 0;
    if (n == 0) return some_are_none;
    std::vector<moving_points<T>> points(n);
    std::vector<double> times(n);
    execution::buffer_of<Policy, moving_points<T>> gathered(on, n);
    for_each_index(on, n, fetch_points<View>{features, open.data(), gathered.data()});
    download(on, gathered.data(), n, points.data());
    for (std::size_t i = 0; i < n; ++i) {
        times[i] = time_on_host<A, View::are_edges>(points[i], bounds);
        some_are_none |= times[i] < 0;
    }
    execution::buffer_of<Policy, double> there(on, n);
    upload(on, times.data(), n, there.data());
    for_each_index(on, n, set_time<T>{open.data(), there.data(), out});
    synchronize(on);  // before what is uploaded is gone
    return some_are_none;
}

/// The impacts of pairs of features that were found, one pairing after another, of which keys[k] are those of the k-th.
template <motion_arithmetic A, scalar T, class Policy, std::size_t N, class... Pairings>
auto impacts_at(const Policy& on, const impact_options& options,
                const std::array<execution::buffer_of<Policy, std::uint64_t>, N>& keys, const Pairings&... features) {
    static_assert(N == sizeof...(Pairings));
    std::size_t total = 0;
    for (const auto& some : keys) total += some.size();
    execution::buffer_of<Policy, impact<T>> all(on, total);
    bool some_are_none = false;
    std::size_t first = 0, k = 0;
    const auto write = [&](const auto& of) {
        const auto both = of.pairing.view();
        using view = view_of_features<std::remove_cvref_t<decltype(of)>::kind, std::remove_const_t<decltype(both)>>;
        const view seen{both, of.faces, of.edges_a, of.edges_b, keys[k].data()};
        some_are_none |= write_impacts<A>(on, seen, keys[k].size(), options.bounds, all.data() + first);
        first += keys[k++].size();
    };
    (write(features), ...);
    result<impact<T>, space_of<Policy>> found(std::move(all));
    return some_are_none ? answers_with(on, found, is_impact<T>{found.data()}) : std::move(found);
}

/// The impacts of pairings of features, one after another.
template <motion_arithmetic A, scalar T, class Policy, class... Pairings>
auto impacts_of(const Policy& on, const impact_options& options, const Pairings&... features) {
    const touch_in_motion<A> judge{options.bounds};
    using keys = std::array<execution::buffer_of<Policy, std::uint64_t>, sizeof...(Pairings)>;
    return impacts_at<A, T>(on, options, keys{find_keys(on, features.pairing, judge)...}, features...);
}

/// The rule by which a query of these goes: that of the indices among them.
template <class X>
inline constexpr bool is_impact_index = false;
template <scalar T, memory_space Space>
inline constexpr bool is_impact_index<impact_index<T, Space>> = true;
template <scalar T, memory_space Space, pair_rule Rule>
inline constexpr bool is_impact_index<face_impact_index<T, Space, Rule>> = true;
template <class X, class Y>
consteval pair_rule rule_of() {
    const auto rule = []<class Z>(const Z*) {
        if constexpr (requires { Z::rule; }) {
            return Z::rule;
        } else {
            return pair_rule::feature_trees;
        }
    };
    constexpr const X* x = nullptr;
    constexpr const Y* y = nullptr;
    static_assert(!is_impact_index<X> || !is_impact_index<Y> || rule(x) == rule(y),
                  "abut: both indices of a query have to be made by the same pair_rule");
    return is_impact_index<X> ? rule(x) : rule(y);
}

/// What `x` is to an impact query: an index, if need be made for the query.
template <pair_rule Rule, class Policy, class X>
auto impact_operand(const Policy& on, const X& x, const char* function) {
    if constexpr (is_impact_index<X>) {
        static_assert(std::same_as<typename X::memory_space, space_of<Policy>>,
                      "abut: the index lies in other memory than the policy works in; make it with the same policy");
        require_same_device(on, x, function);
        return x;
    } else {
        static_assert(requires { make_impact_index<Rule>(on, x); },
                      "abut: impacts are of meshes, at rest or in motion (abut::moving), or of indices of such, without a pose");
        return make_impact_index<Rule>(on, x);
    }
}

template <feature_pair Kind, class Pairing>
pairing_of_features<Kind, Pairing> features_of(Pairing pairing, strided<face> faces, strided<edge> edges_a, strided<edge> edges_b) {
    return {std::move(pairing), faces, edges_a, edges_b};
}

/// What is left of a pairing when its keys are known.
template <class View>
struct known_pairs {
    View both;
    [[nodiscard]] View view() const { return both; }
};
template <feature_pair Kind, class View, class... Elements>
auto known_features_of(const View& both, const Elements&... elements) {
    return features_of<Kind>(known_pairs<View>{both}, elements...);
}

/// Impacts by the rules of faces.
template <motion_arithmetic A, class Policy, class X, class Nearness>
auto impacts_by_faces(const Policy& on, const X& x, const X& y, const impact_options& options, const Nearness& near) {
    const auto faces_x = x.mesh().t0().view().faces, faces_y = y.mesh().t0().view().faces;
    const auto edges_x = x.edges().t0().view().edges, edges_y = y.edges().t0().view().edges;
    const auto views = features_of_two(x, y);
    return impacts_at<A, typename X::scalar_type>(
        on, options, find_features(on, x, y, touch_in_motion<A>{options.bounds}, near, options.sorted),
        known_features_of<feature_pair::vertex_face>(views.vertex_face, faces_y, strided<edge>{}, strided<edge>{}),
        known_features_of<feature_pair::face_vertex>(views.face_vertex, faces_x, strided<edge>{}, strided<edge>{}),
        known_features_of<feature_pair::edge_edge>(views.edge_edge, strided<face>{}, edges_x, edges_y));
}
template <motion_arithmetic A, class Policy, class X, class Nearness>
auto self_impacts_by_faces(const Policy& on, const X& x, const impact_options& options, const Nearness& near) {
    const auto faces = x.mesh().t0().view().faces;
    const auto edges = x.edges().t0().view().edges;
    const auto views = features_of_two(x, x);
    auto [of_vertices, none, of_edges] = find_features(on, x, touch_in_motion<A>{options.bounds}, near, options.sorted);
    const std::array<execution::buffer_of<Policy, std::uint64_t>, 2> keys{std::move(of_vertices), std::move(of_edges)};
    return impacts_at<A, typename X::scalar_type>(
        on, options, keys,
        known_features_of<feature_pair::vertex_face>(views.vertex_face, faces, strided<edge>{}, strided<edge>{}),
        known_features_of<feature_pair::edge_edge>(views.edge_edge, strided<face>{}, edges, edges));
}

/// The earliest impact, and of equal ones the first.
struct time_and_place {
    double time;
    std::size_t place;
};
struct earlier_of {
    ABUT_HD time_and_place operator()(const time_and_place& a, const time_and_place& b) const {
        return b.time < a.time || (b.time == a.time && b.place < a.place) ? b : a;
    }
};
template <scalar T>
struct time_of_impact_at {
    const impact<T>* all;
    ABUT_HD time_and_place operator()(std::size_t i) const { return {all[i].time, i}; }
};

template <class Policy, scalar T>
std::optional<impact<T>> first_of(const Policy& on, const result<impact<T>, space_of<Policy>>& all) {
    const time_and_place first =
        reduce(on, all.size(), time_and_place{infinity<double>, all.size()}, earlier_of{}, time_of_impact_at<T>{all.data()});
    if (first.place == all.size()) return std::nullopt;
    impact<T> found;
    download(on, all.data() + first.place, 1, &found);
    return found;
}

/// The impacts of two meshes.
template <motion_arithmetic A, class Policy, class X, class Y, class Fronts>
auto impacts_between(const Policy& on, const X& a, const Y& b, const impact_options& options, const Fronts& fronts) {
    constexpr const char* function = "abut::impacts";
    constexpr pair_rule rule = rule_of<X, Y>();
    const auto x = impact_operand<rule>(on, a, function);
    const auto y = impact_operand<rule>(on, b, function);
    using T = typename decltype(x)::scalar_type;
    static_assert(std::same_as<T, typename decltype(y)::scalar_type>,
                  "abut: both sides of a query need the same scalar type, float or double");
    const auto near = nearness_of<A, T>(options.bounds, function);
    if constexpr (rule != pair_rule::feature_trees) {
        static_assert(std::same_as<Fronts, no_fronts>, "abut: fronts are of trees over features, pair_rule::feature_trees");
        return impacts_by_faces<A>(on, x, y, options, near);
    } else {
        const auto faces_x = x.mesh().t0().view().faces, faces_y = y.mesh().t0().view().faces;
        const auto edges_x = x.edges().set().t0().view().edges, edges_y = y.edges().set().t0().view().edges;
        const auto query = [&](front* ends) {
            return feature_options<keep_all, Fronts::way>{.sorted = options.sorted, .front = ends};
        };
        return impacts_of<A, T>(
            on, options,
            features_of<feature_pair::vertex_face>(
                pair_up(on, x.vertices(), y.faces(), query(fronts.vertex_face), function, near), faces_y, {}, {}),
            features_of<feature_pair::face_vertex>(
                pair_up(on, x.faces(), y.vertices(), query(fronts.face_vertex), function, near), faces_x, {}, {}),
            features_of<feature_pair::edge_edge>(pair_up(on, x.edges(), y.edges(), query(fronts.edge_edge), function, near), {},
                                                 edges_x, edges_y));
    }
}

/// The impacts of one mesh with itself.
template <motion_arithmetic A, class Policy, class X, class Fronts>
auto impacts_within(const Policy& on, const X& x, const impact_options& options, const Fronts& fronts) {
    constexpr const char* function = "abut::self_impacts";
    constexpr pair_rule rule = rule_of<X, X>();
    const auto index = impact_operand<rule>(on, x, function);
    using T = typename decltype(index)::scalar_type;
    const auto near = nearness_of<A, T>(options.bounds, function);
    if constexpr (rule != pair_rule::feature_trees) {
        static_assert(std::same_as<Fronts, no_fronts>, "abut: fronts are of trees over features, pair_rule::feature_trees");
        return self_impacts_by_faces<A>(on, index, options, near);
    } else {
        const auto faces = index.mesh().t0().view().faces;
        const auto edges = index.edges().set().t0().view().edges;
        const feature_options<share_no_vertex_with_face, Fronts::way> with_faces{
            .sorted = options.sorted, .filter = {faces}, .front = fronts.vertex_face};
        const feature_options<share_no_vertex_with_edge, Fronts::way> with_edges{
            .sorted = options.sorted, .filter = {edges}, .front = fronts.edge_edge};
        return impacts_of<A, T>(
            on, options,
            features_of<feature_pair::vertex_face>(pair_up(on, index.vertices(), index.faces(), with_faces, function, near),
                                                   faces, {}, {}),
            features_of<feature_pair::edge_edge>(pair_up_self(on, index.edges(), with_edges, function, as_they_are{}, near), {},
                                                 edges, edges));
    }
}

}  // namespace detail

/// All pairs of a vertex of one mesh and a face of the other, and of two edges, that touch during the step, each once, with
/// the earliest time at which they do. `a` and `b` are meshes in motion (`moving`), meshes at rest, or indices of either
/// (make_impact_index). In the policy's memory, 32 bytes each; sorted as impact_options says.
///
/// With `filtered`, the default, and `exact` no pair is missed and none is invented, for every finite input, degenerate and
/// coplanar motion as well; times are never later than the true ones and within 10^-12 of them. The same bits on every
/// policy. `fast` promises nothing. `conservative` misses none, and tells within its bounds when they come near. Two meshes
/// that intersect all the time without a contact of such features, as one inside the other, have no impact.
///
/// Returns when the answer is there. Throws invalid_geometry, error (an index on another device), capacity_error,
/// std::bad_alloc and cuda_error.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     for (const auto& i : to_host(abut::impacts(on, step, ball))) use(i.kind, i.vertices, i.time);
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto impacts(const Policy& on, const X& a, const Y& b, const impact_options& options = {}) {
    return detail::impacts_between<A>(on, a, b, options, detail::no_fronts{});
}
/// The same from fronts, which are left at this step's ends.
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto impacts(const Policy& on, const X& a, const Y& b, const impact_options& options, impact_fronts& fronts) {
    return detail::impacts_between<A>(on, a, b, options, detail::given_fronts(fronts));
}

/// The impacts of one mesh with itself: of all pairs that have no vertex index in common. Vertices that coincide in place but not
/// by index touch. `x` is a mesh in motion, or an index of one. Otherwise as `impacts`.
template <motion_arithmetic A = filtered, execution_policy Policy, class X>
[[nodiscard]] auto self_impacts(const Policy& on, const X& x, const impact_options& options = {}) {
    return detail::impacts_within<A>(on, x, options, detail::no_fronts{});
}
template <motion_arithmetic A = filtered, execution_policy Policy, class X>
[[nodiscard]] auto self_impacts(const Policy& on, const X& x, const impact_options& options, impact_fronts& fronts) {
    return detail::impacts_within<A>(on, x, options, detail::given_fronts(fronts));
}

/// The earliest of the impacts, or none: of several at one time, the first in their order.
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto first_impact(const Policy& on, const X& a, const Y& b, impact_options options = {}) {
    options.sorted = true;
    return detail::first_of(on, impacts<A>(on, a, b, options));
}
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto first_impact(const Policy& on, const X& a, const Y& b, impact_options options, impact_fronts& fronts) {
    options.sorted = true;
    return detail::first_of(on, impacts<A>(on, a, b, options, fronts));
}

/// Where the features of an impact touch (narrow/feature_weights.hpp). `a` and `b` are the meshes of the query as moving views, of
/// a self query the same one twice; reads their vertices, on hosts and devices.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     for (const auto& i : abut::self_impacts(on, step)) use(i, abut::weights_of(i, step.view(), step.view()));
template <scalar T, memory_space Space>
[[nodiscard]] ABUT_HD feature_weights weights_of(const impact<T>& found, const moving_view<mesh_view<T, Space>>& a,
                                                 const moving_view<mesh_view<T, Space>>& b) {
    const auto* const v = reinterpret_cast<const std::uint32_t*>(&found.vertices);
    const auto point = [](const auto& m, std::uint32_t i) {
        return motion<vec3<T>>{m.t0.vertices[i], m.t1.vertices[i]};
    };
    const auto edge_of = [&](const auto& m, std::uint32_t i, std::uint32_t j) {
        const auto from = point(m, i), to = point(m, j);
        return motion<segment<T>>{{from.t0, to.t0}, {from.t1, to.t1}};
    };
    if (found.kind == feature_pair::edge_edge) return weights_at(edge_of(a, v[0], v[1]), edge_of(b, v[2], v[3]), found.time);
    const bool vertex_first = found.kind == feature_pair::vertex_face;
    const auto &of_vertex = vertex_first ? a : b, &of_face = vertex_first ? b : a;
    const auto x = point(of_face, v[1]), y = point(of_face, v[2]), z = point(of_face, v[3]);
    return weights_at(point(of_vertex, v[0]), motion<triangle<T>>{{x.t0, y.t0, z.t0}, {x.t1, y.t1, z.t1}}, found.time);
}

}  // namespace abut
