// SPDX-License-Identifier: MIT
#pragma once

// Sheets of a mesh on the host: faces that are joined by edges of two faces. Which way their faces look, and what they measure.
// `validate` tells it where asked (collide/validate.hpp), and oriented_consistently, below, turns faces by it. Edges of more
// than two faces join nothing. What a solid is, and what of it is hollow, is decided elsewhere (collide/solid_surface.hpp).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <abut/arithmetic/error_free.hpp>
#include <abut/collide/solid_surface.hpp>
#include <abut/error.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/collide/keys.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/mesh_report.hpp>

namespace abut {

/// What `oriented_consistently` makes. Faces and vertices keep their numbers.
/// @ingroup mesh_checks
template <scalar T, memory_space Space = host_space>
struct oriented_result {
    abut::mesh<T, Space> mesh;          ///< in the policy's memory
    std::vector<std::uint32_t> turned;  ///< faces that go round the other way now, ascending; in host memory
};

namespace detail {

/// Of a mesh in host memory. Faces that count for nothing, since they span no triangle, are of no sheet.
template <scalar T>
class mesh_sheets {
public:
    using id = std::uint32_t;
    static constexpr id none = static_cast<id>(-1);

    explicit mesh_sheets(const mesh_view<T, host_space>& mesh) : mesh_(mesh), parent_(mesh.size()), is_odd_(mesh.size(), 0) {
        std::iota(parent_.begin(), parent_.end(), id{0});
        const half_edge_table<serial> sorted(serial{}, mesh, id_bits(mesh.vertices.count));
        const sorted_half_edges table = sorted.view();
        const auto is_inner = [&](std::size_t i) { return table.goes_on(i, 1) && !table.goes_on(i, 2); };
        const auto for_each_edge = [&](const auto& look) {
            for (std::size_t i = 0; i < table.count; ++i) {
                if (table.is_edge(i) && table.is_first(i)) look(i);
            }
        };
        for_each_edge([&](std::size_t i) {
            if (is_inner(i)) join(table.face_of(i), table.face_of(i + 1), table.backward(i) == table.backward(i + 1));
        });
        number_sheets();
        for_each_edge([&](std::size_t i) {
            mesh_sheet& sheet = all_[sheet_[table.face_of(i)]];
            if (!is_inner(i)) {
                for (std::size_t k = 0; k == 0 || table.goes_on(i, k); ++k) all_[sheet_[table.face_of(i + k)]].closed = false;
                return;
            }
            const id f = table.face_of(i), g = table.face_of(i + 1);
            const bool against = table.backward(i) == table.backward(i + 1);
            sheet.oriented = sheet.oriented && !against;
            if (against != (is_odd(f) != is_odd(g))) is_one_sided_[sheet_[f]] = 1;
        });
    }
    [[nodiscard]] std::vector<mesh_sheet>& all() { return all_; }
    [[nodiscard]] id sheet_of(id f) const { return sheet_[f]; }
    /// Whether a face is turned against the first of its sheet.
    [[nodiscard]] bool is_odd(id f) const { return is_odd_[f] != 0; }
    /// Whether no turning of faces makes them agree.
    [[nodiscard]] bool is_one_sided(id sheet) const { return is_one_sided_[sheet] != 0; }
    /// The sign of the volume in each closed sheet, if faces of it are turned as its first.
    [[nodiscard]] std::vector<int> signs() const {
        std::vector<mesh_face<T>> faces(mesh_.size());
        std::vector<std::vector<id>> faces_of(all_.size());
        for (id f = 0; f < faces.size(); ++f) {
            if (sheet_[f] == none || !all_[sheet_[f]].closed || is_one_sided(sheet_[f])) continue;
            const corner_ids c = corners_of(mesh_.faces, f);
            faces[f] = {mesh_[f], {c.of[0], c.of[1], c.of[2]}};
            if (is_odd(f)) std::swap(faces[f].corners.b, faces[f].corners.c);
            faces_of[sheet_[f]].push_back(f);
        }
        std::vector<int> signs(all_.size());
        for (id p = 0; p < signs.size(); ++p) {
            if (faces_of[p].empty()) continue;
            const bool finite = std::all_of(faces_of[p].begin(), faces_of[p].end(), [&](id f) { return is_valid(faces[f]); });
            if (finite) signs[p] = volume_sign<T>(faces[faces_of[p].front()].corners.a, faces, faces_of[p]).sign();
        }
        return signs;
    }

private:
    /// What stands for a face, and whether it is turned against that. All on the way hang there then.
    std::pair<id, bool> root_of(id f) {
        id root = f;
        bool odd = false;
        for (; parent_[root] != root; root = parent_[root]) odd ^= is_odd_[root] != 0;
        for (bool left = odd; parent_[f] != f;) {
            const bool own = std::exchange(is_odd_[f], left) != 0;
            f = std::exchange(parent_[f], root);
            left ^= own;
        }
        return {root, odd};
    }
    void join(id f, id g, bool against) {
        const auto [of_f, f_odd] = root_of(f);
        const auto [of_g, g_odd] = root_of(g);
        if (of_f == of_g) return;
        const auto [lower, upper] = std::minmax(of_f, of_g);
        parent_[upper] = lower;
        is_odd_[upper] = against != (f_odd != g_odd);
    }
    void number_sheets() {
        std::vector<char> odd(mesh_.size(), 0);
        sheet_.assign(mesh_.size(), none);
        for (id f = 0; f < mesh_.size(); ++f) {
            if (!spans_triangle(corners_of(mesh_.faces, f), mesh_.vertices.count)) continue;
            const auto [root, is] = root_of(f);  // the lowest face of its sheet
            odd[f] = is;
            if (root == f) {
                sheet_[f] = static_cast<id>(all_.size());
                all_.push_back({f, 0, true, true, 0});
            }
            sheet_[f] = sheet_[root];
            ++all_[sheet_[f]].faces;
        }
        is_odd_ = std::move(odd);
        is_one_sided_.assign(all_.size(), 0);
    }

    mesh_view<T, host_space> mesh_;
    std::vector<id> parent_, sheet_;
    std::vector<char> is_odd_, is_one_sided_;
    std::vector<mesh_sheet> all_;
};

/// Sums in doubles, of coordinates that are made smaller by a power of two, so that nothing overflows on the way.
template <scalar T>
mesh_measures measures_of(const mesh_view<T, host_space>& mesh) {
    mesh_measures m;
    mesh_sheets<T> sheets(mesh);
    const std::vector<int> signs = sheets.signs();
    for (std::size_t p = 0; p < signs.size(); ++p) {
        if (sheets.all()[p].oriented) sheets.all()[p].volume_sign = signs[p];
    }
    m.sheets = std::move(sheets.all());

    double most = 0;
    const auto counts = [&](std::size_t f) { return spans_triangle(corners_of(mesh.faces, f), mesh.vertices.count) && is_valid(mesh[f]); };
    for (std::size_t f = 0; f < mesh.size(); ++f) {
        if (!counts(f)) continue;
        const triangle<T> t = mesh[f];
        const vec3<T> corners[] = {t.a, t.b, t.c};
        for (const vec3<T>& p : corners) {
            most = greatest(most, greatest(static_cast<double>(absolute(p.x)), static_cast<double>(absolute(p.y)), static_cast<double>(absolute(p.z))));
        }
    }
    if (most == 0) return m;
    const int unit = std::ilogb(most) + 2;
    const auto scaled = [&](const vec3<T>& p) {
        const auto one = [&](T x) { return std::ldexp(static_cast<double>(x), -unit); };
        return vec3<double>{one(p.x), one(p.y), one(p.z)};
    };
    const auto minus = [](const vec3<double>& p, const vec3<double>& q) {
        return vec3<double>{plain_sum(p.x, -q.x), plain_sum(p.y, -q.y), plain_sum(p.z, -q.z)};
    };
    const auto beside = [](double a, double b, double c, double d) { return plain_sum(plain_product(a, b), -plain_product(c, d)); };
    const auto across = [&](const vec3<double>& p, const vec3<double>& q) {
        return vec3<double>{beside(p.y, q.z, p.z, q.y), beside(p.z, q.x, p.x, q.z), beside(p.x, q.y, p.y, q.x)};
    };
    const auto along = [](const vec3<double>& p, const vec3<double>& q) {
        return plain_sum(plain_sum(plain_product(p.x, q.x), plain_product(p.y, q.y)), plain_product(p.z, q.z));
    };
    vec3<double> from{};
    bool is_first = true;
    struct {
        long_sum area, volume, x, y, z;
    } sum;
    for (std::size_t f = 0; f < mesh.size(); ++f) {
        if (!counts(f)) continue;
        const triangle<T> t = mesh[f];
        if (std::exchange(is_first, false)) from = scaled(t.a);
        const vec3<double> a = minus(scaled(t.a), from), b = minus(scaled(t.b), from), c = minus(scaled(t.c), from);
        const vec3<double> normal = across(minus(scaled(t.b), scaled(t.a)), minus(scaled(t.c), scaled(t.a)));
        sum.area.add(std::sqrt(along(normal, normal)));
        const double volume = along(across(a, b), c);
        sum.volume.add(volume);
        sum.x.add(plain_product(volume, plain_sum(plain_sum(a.x, b.x), c.x)));
        sum.y.add(plain_product(volume, plain_sum(plain_sum(a.y, b.y), c.y)));
        sum.z.add(plain_product(volume, plain_sum(plain_sum(a.z, b.z), c.z)));
    }
    const double volume = sum.volume.total();
    m.area = std::ldexp(sum.area.total() / 2, 2 * unit);
    const bool is_solid = std::all_of(m.sheets.begin(), m.sheets.end(), [](const mesh_sheet& p) { return p.volume_sign != 0; });
    if (!is_solid || volume == 0) return m;
    m.volume = std::ldexp(volume / 6, 3 * unit);
    const auto center = [&](const long_sum& s, double at) { return std::ldexp(plain_sum(s.total() / (4 * volume), at), unit); };
    m.center_of_mass = {center(sum.x, from.x), center(sum.y, from.y), center(sum.z, from.z)};
    return m;
}

template <class Policy, scalar T>
oriented_result<T, space_of<Policy>> orient(const Policy& on, const mesh_view<T, host_space>& old, const char* function) {
    check_sides(old.size(), function);
    mesh_sheets<T> sheets(old);
    for (std::uint32_t p = 0; p < sheets.all().size(); ++p) {
        if (!sheets.is_one_sided(p)) continue;
        throw invalid_geometry(function, "face", sheets.all()[p].first_face,
                               "the sheet of the surface with this face has one side only, as a strip that is twisted once; its faces are", sheets.all()[p].faces);
    }
    const std::vector<int> signs = sheets.signs();
    oriented_result<T, space_of<Policy>> made;
    std::vector<vec3<T>> vertices(old.vertices.count);
    std::vector<face> faces(old.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = old.vertices[v];
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const corner_ids c = corners_of(old.faces, f);
        faces[f] = {c.of[0], c.of[1], c.of[2]};
        const std::uint32_t p = sheets.sheet_of(f);
        if (p == mesh_sheets<T>::none || sheets.is_odd(f) == (signs[p] < 0)) continue;
        std::swap(faces[f][1], faces[f][2]);
        made.turned.push_back(f);
    }
    made.mesh = mesh<T, space_of<Policy>>(on, std::span<const vec3<T>>(vertices), std::span<const face>(faces));
    return made;
}

}  // namespace detail

/// @addtogroup sets
///@{

/// The same mesh with faces turned so that two faces at an edge go along it in opposite directions. Faces of a sheet, those that
/// edges of two faces join, agree with each other then; a sheet that is closed faces outwards, by the exact sign of its volume;
/// another one, and one without volume, as its first face did. Edges of more than two faces join nothing: what is on one side
/// of them does not know of the other. A hollow faces outwards of itself as well, into the solid: `inside` and `relation` do
/// not mind, `winding_number` does. Faces that name a vertex twice stay as they are.
///
/// @par Memory
/// The mesh lies in the policy's memory and the list in the host's. One thread of the host decides on each policy, in some 150
/// bytes a face of scratch. Under `cuda` the mesh is downloaded.
///
/// @par Errors
/// `invalid_geometry`: a sheet has one side only (the message has its first face); of a view, as queries. `capacity_error`:
/// more than 1,431,655,765 faces. `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the mesh is there; under `cuda` it waits for the policy's stream.
///
///     const auto part = abut::oriented_consistently(on, mesh).mesh;
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] oriented_result<T, space_of<Policy>> oriented_consistently(const Policy& on, const mesh<T, Space>& mesh) {
    static_assert(std::same_as<Space, space_of<Policy>> || std::same_as<Space, host_space>,
                  "abut: a host policy cannot read a set in device memory; copy_to(policy, set) brings it over");
    const auto here = mesh.copied_to(serial{});
    return detail::orient(on, here.view(), "abut::oriented_consistently");
}
/// Of a view, which is checked.
template <execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] oriented_result<T, space_of<Policy>> oriented_consistently(const Policy& on, const mesh_view<T, Space>& mesh) {
    return oriented_consistently(on, copy_to(on, mesh));
}

///@}

}  // namespace abut
