// SPDX-License-Identifier: MIT
#pragma once

// validate: what a mesh is made of, and what is wrong with it as a surface. Not for what a surface does to itself by its
// place in space: faces that pass through each other are for queries.
//
// Edges are found by sorting half-edges (shape/half_edges.hpp), components and the fans of vertices by union-find over
// what edges connect, duplicate faces and vertices in one place by sorting suspects (shape/equal_elements.hpp), and faces
// without area by a filter in floating point, what it leaves in integers. All of it is loops, sorts and reductions of the
// policy; a list takes a pass of its own only where there is something to list.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/collide/flag.hpp>
#include <abut/collide/mesh_sheets.hpp>
#include <abut/collide/search.hpp>
#include <abut/error.hpp>
#include <abut/execution/disjoint_sets.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/operand.hpp>
#include <abut/predicate/zero_area.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/equal_elements.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/mesh_report.hpp>
#include <abut/shape/set.hpp>

namespace abut {

/// Options of `validate`.
/// @ingroup mesh_checks
struct validate_options {
    /// Area, volume, center of mass, and which way each sheet of faces looks: `mesh_report::measures`. One thread of the host finds them,
    /// under `cuda` from a copy, in some 150 bytes a face of scratch.
    flag measures = false;
};

namespace detail {

template <class X>
inline constexpr bool is_mesh = false;
template <scalar T, memory_space Space>
inline constexpr bool is_mesh<mesh<T, Space>> = true;
template <scalar T, memory_space Space>
inline constexpr bool is_mesh<mesh_view<T, Space>> = true;

// --- edges ----------------------------------------------------------------------------------------------------------------

// What a list is made of: properties of half-edge i. Those of an edge hold for its first half-edge alone.

struct is_boundary {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const { return table.is_edge(i) && table.is_first(i) && !table.goes_on(i, 1); }
};

struct is_nonmanifold {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const { return table.is_edge(i) && table.is_first(i) && table.goes_on(i, 2); }
};

struct is_inconsistent {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const {
        return table.is_edge(i) && table.is_first(i) && table.goes_on(i, 1) && !table.goes_on(i, 2) &&
               table.backward(i) == table.backward(i + 1);
    }
};

struct edge_tally {
    std::uint64_t edges = 0, boundary = 0, nonmanifold = 0, inconsistent = 0, maybe_duplicate = 0, no_edge = 0;

    friend ABUT_HD edge_tally operator+(const edge_tally& a, const edge_tally& b) {
        return {a.edges + b.edges,
                a.boundary + b.boundary,
                a.nonmanifold + b.nonmanifold,
                a.inconsistent + b.inconsistent,
                a.maybe_duplicate + b.maybe_duplicate,
                a.no_edge + b.no_edge};
    }
};

struct tally_edges {
    sorted_half_edges table;
    ABUT_HD edge_tally operator()(std::size_t i) const {
        return {table.is_edge(i) && table.is_first(i),
                is_boundary{table}(i),
                is_nonmanifold{table}(i),
                is_inconsistent{table}(i),
                may_be_duplicate{table}(i),
                !table.is_edge(i)};
    }
};

/// The whole edge, where i is its first half-edge. Doubling steps, then halving: an edge of two faces is short work, and one
/// of a million no long work.
struct mesh_edge_of {
    sorted_half_edges table;
    ABUT_HD mesh_edge operator()(std::uint32_t i) const {
        std::size_t step = 1;
        while (table.goes_on(i, step)) step *= 2;
        std::size_t low = step / 2, high = step;  // goes on so far; no longer so far
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (table.goes_on(i, middle) ? low : high) = middle;
        }
        return {table.lower(i), table.upper(i), static_cast<std::uint32_t>(high), table.face_of(i), table.face_of(i + low)};
    }
};

// --- vertices -------------------------------------------------------------------------------------------------------------

struct vertex_tally {
    std::uint64_t unused = 0, nonmanifold = 0, nonfinite = 0, components = 0;

    friend ABUT_HD vertex_tally operator+(const vertex_tally& a, const vertex_tally& b) {
        return {a.unused + b.unused, a.nonmanifold + b.nonmanifold, a.nonfinite + b.nonfinite, a.components + b.components};
    }
};

struct is_unused {
    const std::uint32_t* fans_of_vertex;
    ABUT_HD bool operator()(std::size_t v) const { return fans_of_vertex[v] == 0; }
};
struct has_many_fans {
    const std::uint32_t* fans_of_vertex;
    ABUT_HD bool operator()(std::size_t v) const { return fans_of_vertex[v] > 1; }
};
template <scalar T>
struct is_nonfinite {
    strided<vec3<T>> vertices;
    ABUT_HD bool operator()(std::size_t v) const { return !is_valid(vertices[v]); }
};

template <scalar T>
struct tally_vertices {
    strided<vec3<T>> vertices;
    const std::uint32_t* fans_of_vertex;
    execution::disjoint_sets components;
    ABUT_HD vertex_tally operator()(std::size_t v) const {
        const bool unused = is_unused{fans_of_vertex}(v);
        return {unused, has_many_fans{fans_of_vertex}(v), is_nonfinite<T>{vertices}(v), !unused && components.is_root(v)};
    }
};

// --- faces without area ---------------------------------------------------------------------------------------------------

template <class View>
struct shape_at {
    View shapes;
    ABUT_HD auto operator()(std::uint32_t i) const { return shapes[i]; }
};

/// Stage 1: what is not certain to have an area is late.
template <class View>
struct suspect_area {
    View mesh;
    ABUT_CALLS_ANY
    template <class Late>
    ABUT_HD void operator()(std::size_t f, Late& late) const {
        if (!is_in_range(corners_of(mesh.faces, f), mesh.vertices.count)) return;
        if (decide_zero_area<filtered>(mesh[f]) != verdict::no) late.push(static_cast<std::uint32_t>(f));
    }
};

/// Stage 2: in integers of fixed width.
template <class View>
struct settle_area {
    View mesh;
    const std::uint32_t* late;
    ABUT_CALLS_ANY
    template <class Flat, class Wide>
    ABUT_HD void operator()(std::size_t i, Flat& flat, Wide& wide) const {
        const auto t = mesh[late[i]];
        if (!is_valid(t)) return;
        const verdict v = decide_zero_area<exact>(t);
        if (v == verdict::yes) flat.push(late[i]);
        if (v == verdict::unknown) wide.push(late[i]);
    }
};

template <class Policy>
using id_queue = execution::work_queue<std::uint32_t, space_of<Policy>>;

template <class Policy, class View>
std::vector<std::uint32_t> find_zero_area(const Policy& on, const View& mesh) {
    id_queue<Policy> late(on), flat(on), wide(on);
    for_each_index(on, mesh.size(), suspect_area<View>{mesh}, late);
    for_each_index(on, late.size(), settle_area<View>{mesh, late.data()}, flat, wide);
    auto ids = flat.take();
    sort_keys(on, ids, id_bits(mesh.size()));
    auto found = downloaded<Policy, std::uint32_t>(on, ids);
    if (wide.size() > 0) {  // stage 3 is the host's, as in queries: it takes a large stack
        const auto triangles =
            downloaded<Policy, typename View::shape_type>(on, evaluated(on, shape_at<View>{mesh}, wide.data(), wide.size()));
        std::vector<std::uint32_t> left(wide.size());
        download(on, wide.data(), left.size(), left.data());
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (resolve_zero_area(triangles[i])) found.push_back(left[i]);
        }
        std::sort(found.begin(), found.end());
    }
    return found;
}

// --- all of it ------------------------------------------------------------------------------------------------------------

struct is_out_of_range {
    strided<face> faces;
    std::size_t vertex_count;
    ABUT_HD bool operator()(std::size_t f) const { return !is_in_range(corners_of(faces, f), vertex_count); }
};
struct has_repeated_index {
    strided<face> faces;
    std::size_t vertex_count;
    ABUT_HD bool operator()(std::size_t f) const {
        const corner_ids c = corners_of(faces, f);
        return is_in_range(c, vertex_count) && repeats_index(c);
    }
};

/// What half-edges tell, and what they connect.
template <class Policy, class View>
void report_edges(const Policy& on, const View& mesh, const execution::disjoint_sets& fans,
                  const execution::disjoint_sets& components, mesh_report& report) {
    const half_edge_table<Policy> sorted(on, mesh, id_bits(mesh.vertices.count));
    const sorted_half_edges table = sorted.view();
    const std::size_t n = table.count;
    const edge_tally tally = reduce(on, n, edge_tally{}, add_up_tallies{}, tally_edges{table});
    report.edges = tally.edges;
    report.boundary_edges = listed(on, n, tally.boundary, is_boundary{table}, mesh_edge_of{table});
    report.nonmanifold_edges = listed(on, n, tally.nonmanifold, is_nonmanifold{table}, mesh_edge_of{table});
    report.inconsistent_edges = listed(on, n, tally.inconsistent, is_inconsistent{table}, mesh_edge_of{table});
    report.duplicate_faces = find_duplicates(on, table, tally.maybe_duplicate);

    const std::size_t no_triangle = tally.no_edge / 3, vertices = mesh.vertices.count;
    report.faces_out_of_range = listed(on, mesh.size(), no_triangle, is_out_of_range{mesh.faces, vertices});
    report.faces_with_repeated_index = listed(on, mesh.size(), no_triangle, has_repeated_index{mesh.faces, vertices});
    for_each_index(on, n, connect{table, fans, components});
}

template <class Policy, scalar T, memory_space Space>
void report_vertices(const Policy& on, const mesh_view<T, Space>& mesh, const execution::disjoint_sets& fans,
                     const execution::disjoint_sets& components, mesh_report& report) {
    const std::size_t n = mesh.vertices.count;
    id_buffer<Policy> fans_of_vertex(on, n);
    fill(on, fans_of_vertex.data(), n, std::uint32_t{0});
    for_each_index(on, 3 * mesh.size(), count_fans{mesh.faces, n, fans, fans_of_vertex.data()});
    const std::uint32_t* const count = fans_of_vertex.data();
    const vertex_tally tally =
        reduce(on, n, vertex_tally{}, add_up_tallies{}, tally_vertices<T>{mesh.vertices, count, components});
    report.components = tally.components;
    report.unused_vertices = listed(on, n, tally.unused, is_unused{count});
    report.nonmanifold_vertices = listed(on, n, tally.nonmanifold, has_many_fans{count});
    report.nonfinite_vertices = listed(on, n, tally.nonfinite, is_nonfinite<T>{mesh.vertices});
}

template <class Policy, scalar T, memory_space Space>
mesh_report validate_view(const Policy& on, const mesh_view<T, Space>& mesh) {
    mesh_report report;
    report.vertices = mesh.vertices.count;
    report.faces = mesh.faces.count;
    {
        id_buffer<Policy> corner_parents(on, 3 * mesh.size()), vertex_parents(on, mesh.vertices.count);
        const execution::disjoint_sets fans = make_disjoint_sets(on, corner_parents);
        const execution::disjoint_sets components = make_disjoint_sets(on, vertex_parents);
        report_edges(on, mesh, fans, components, report);
        report_vertices(on, mesh, fans, components, report);
    }
    report.coincident_vertices = find_coincident(on, mesh.vertices);
    report.zero_area_faces = find_zero_area(on, mesh);

    const std::uint64_t used = report.vertices - report.unused_vertices.size();
    const std::uint64_t triangles =
        report.faces - report.faces_out_of_range.size() - report.faces_with_repeated_index.size();
    report.euler_characteristic = static_cast<std::int64_t>(used - report.edges + triangles);
    return report;
}

/// The mesh in the policy's memory. A view is taken as it comes: what is wrong with its elements is reported, not refused.
template <class Policy, class Mesh>
auto mesh_to_validate(const Policy& on, const Mesh& mesh) {
    constexpr const char* function = "abut::validate";
    const auto check_sizes = [&](const auto& view) {
        check_count(view.faces.count, function);
        check_count(view.vertices.count, function);
        check_sides(view.faces.count, function);
        require_access(on, view.faces.data, function);
        require_access(on, view.vertices.data, function);
    };
    if constexpr (shape_view<Mesh>) {
        static_assert(std::same_as<typename Mesh::memory_space, space_of<Policy>>,
                      "abut::validate: this view is over other memory than the policy works in");
        check_sizes(mesh);
        return mesh;
    } else {
        auto set = make_resident(on, mesh, function);
        check_sizes(set.view());
        return set;
    }
}

}  // namespace detail

/// @defgroup mesh_checks What is wrong with a mesh
///
/// `validate` and what it reports: edges, fans, components, and faces and vertices that are not as they should be.
///@{

/// What there is of a mesh and what is wrong with it (shape/mesh_report.hpp): edges, boundary, edges of more than two
/// faces, orientation, fans, components, Euler characteristic; faces that repeat an index, have no area or occur twice;
/// vertices that are unused or in one place. All of it exact, and bit for bit the same on each policy and number of threads.
/// Volume, area, center and which way faces look, where options ask for them.
///
/// `mesh` is a mesh or a mesh_view. Sets have been checked when they were made, and hold neither indices out of range nor
/// numbers that are not finite. A view is not checked as other queries do, but both are listed.
///
/// @par Memory
/// The mesh lies in the policy's memory; one in host memory is uploaded for the call under `cuda`. The report lies in host
/// memory. Scratch takes 84 bytes a face and 16 a vertex.
///
/// @par Errors
/// - `capacity_error`: 2^31 vertices or more, or more than 1,431,655,765 faces, whose half-edges have 32 bits for their
///   numbers.
/// - `error`: a set or a view lies on another device.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the report is complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp validate
template <execution_policy Policy, class Mesh>
[[nodiscard]] mesh_report validate(const Policy& on, const Mesh& mesh, const validate_options& options = {}) {
    static_assert(detail::is_mesh<Mesh>, "abut::validate: expected a mesh or a mesh_view, of float or double");
    if constexpr (detail::is_mesh<Mesh>) {
        const auto resident = detail::mesh_to_validate(on, mesh);
        mesh_report report = detail::validate_view(on, detail::view_of(resident));
        if (options.measures) {
            const auto here = detail::set_of(on, detail::view_of(resident)).copied_to(serial{});
            report.measures = detail::measures_of(here.view());
        }
        return report;
    } else {
        return {};
    }
}

///@}

}  // namespace abut
