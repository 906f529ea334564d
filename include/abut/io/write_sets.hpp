// SPDX-License-Identifier: MIT
#pragma once

// Sets other than meshes as PLY or VTP: segments and curves as edges or lines, boxes as meshes of their faces, spheres as
// points with a radius. Layout: docs/reference/formats.md.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <abut/io/curve_lines.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf_drawing.hpp>
#include <abut/io/property.hpp>
#include <abut/io/write.hpp>
#include <abut/io/write_ply.hpp>
#include <abut/io/write_vtp.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

/// @addtogroup files
///@{

/// What goes into a file of a set besides its shapes; by default nothing.
struct set_options {
    /// For each shape 0 or not: written as `hit`, 0 or 1. PLY has it again as a colour (`red`, `green`, `blue`: orange where
    /// it is set, light grey elsewhere). Empty: nothing of this is written.
    std::span<const std::uint8_t> hit{};
    /// More values for each shape.
    std::vector<property> properties{};
};

///@}

namespace detail {

/// A set or a view of these shapes in host memory.
template <class Set, template <scalar> class Shape>
concept set_of = std::same_as<typename Set::shape_type, Shape<typename Set::scalar_type>> &&
    std::same_as<typename Set::memory_space, host_space>;

template <class Set>
auto view_of(const Set& set) {
    if constexpr (requires { set.view(); }) {
        return set.view();
    } else {
        return set;
    }
}

/// The options as properties of each element, with what is made of `hit`.
class marked_properties {
public:
    marked_properties(const std::string& file, std::size_t shapes, const set_options& options, bool with_colours) {
        if (!options.hit.empty()) {
            check_count(file, "hit", "shape", shapes, options.hit.size());
            constexpr std::array<std::uint8_t, 3> marked{230, 85, 13}, plain{217, 217, 217};
            for (auto& column : columns_) column.reserve(shapes);
            for (const std::uint8_t hit : options.hit) {
                columns_[0].push_back(hit != 0 ? 1 : 0);
                for (std::size_t k = 0; k < 3; ++k) columns_[k + 1].push_back(hit != 0 ? marked[k] : plain[k]);
            }
            constexpr const char* names[] = {"hit", "red", "green", "blue"};
            for (std::size_t k = 0; k < (with_colours ? 4 : 1); ++k) {
                all.push_back({names[k], std::span<const std::uint8_t>(columns_[k])});
            }
        }
        all.insert(all.end(), options.properties.begin(), options.properties.end());
    }
    marked_properties(const marked_properties&) = delete;
    marked_properties& operator=(const marked_properties&) = delete;

    std::vector<property> all;

private:
    std::array<std::vector<std::uint8_t>, 4> columns_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Writes spheres, as the extension says (.ply or .vtp, in any case): a point for each, its center, with the value `radius`,
/// which MeshLab and others know. Throws io_error as `write_points` does.
///
///     abut::io::write_spheres("grains.ply", grains, {.hit = hit});
template <detail::set_of<sphere> Set>
void write_spheres(const std::filesystem::path& path, const Set& set, const set_options& options = {}) {
    using T = typename Set::scalar_type;
    const auto view = detail::view_of(set);
    std::vector<vec3<T>> centers(view.size());
    std::vector<T> radii(view.size());
    for (std::size_t i = 0; i < view.size(); ++i) {
        centers[i] = view[i].center;
        radii[i] = view[i].radius;
    }
    const detail::marked_properties marked(path.string(), view.size(), options, !detail::is_vtp(path));
    point_options<T> all{.properties = {{"radius", std::span<const T>(radii)}}};
    all.properties.insert(all.properties.end(), marked.all.begin(), marked.all.end());
    write_points(path, centers, all);
}

/// Writes boxes as a mesh: eight vertices and twelve triangles each, in order, which face outwards. The triangles have the
/// value `box`, the box's id, and what the options say of it. Throws io_error as `write_mesh` does.
///
///     abut::io::write_boxes("cells.ply", boxes);
template <detail::set_of<aabb> Set>
void write_boxes(const std::filesystem::path& path, const Set& set, const set_options& options = {}) {
    using T = typename Set::scalar_type;
    const auto view = detail::view_of(set);
    const std::string file = path.string();
    if (!options.hit.empty()) detail::check_count(file, "hit", "shape", view.size(), options.hit.size());
    detail::check_properties(file, "shape", view.size(), options.properties, {"box"});
    (void)detail::is_vtp(path);  // or PLY; no other form has the values
    if (view.size() > detail::most_written / 12) {
        throw io_error(file, "expected at most 178956970 boxes, found " + std::to_string(view.size()));
    }
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
    std::vector<std::uint8_t> hit;
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < view.size(); ++i) {
        const aabb<T> box = view[i];
        for (unsigned k = 0; k < 8; ++k) vertices.push_back(abut::detail::points_of(box).at[k]);
        for (const auto& corners : detail::box_corners()) {
            face f{};
            for (std::size_t k = 0; k < 3; ++k) f[k] = static_cast<std::uint32_t>(8 * i) + corners[k];
            faces.push_back(f);
        }
        ids.insert(ids.end(), 12, static_cast<std::uint32_t>(i));
        if (!options.hit.empty()) hit.insert(hit.end(), 12, options.hit[i]);
    }
    // Twelve of each value.
    std::vector<std::variant<std::vector<std::uint8_t>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                             std::vector<float>, std::vector<double>>>
        copies;
    copies.reserve(options.properties.size());
    mesh_options all{.hit = hit, .face_properties = {{"box", std::span<const std::uint32_t>(ids)}}};
    for (const property& p : options.properties) {
        std::visit(
            [&](const auto& values) {
                std::vector<typename std::decay_t<decltype(values)>::value_type> repeated;
                for (const auto value : values) repeated.insert(repeated.end(), 12, value);
                copies.emplace_back(std::move(repeated));
            },
            p.values);
        std::visit([&](const auto& values) { all.face_properties.push_back({p.name, std::span(values)}); }, copies.back());
    }
    write_mesh(path, vertices, faces, all);
}

/// Writes segments, as the extension says (.ply or .vtp, in any case): two vertices each, in order, and an element `edge`
/// (PLY) or a line (VTP), which has the values. Throws io_error as `write_mesh` does.
///
///     abut::io::write_segments("rays.ply", segments, {.properties = {{"length", lengths}}});
template <detail::set_of<segment> Set>
void write_segments(const std::filesystem::path& path, const Set& set, const set_options& options = {}) {
    using T = typename Set::scalar_type;
    const auto view = detail::view_of(set);
    const std::string name = path.string();
    const std::size_t n = view.size();
    const bool as_vtp = detail::is_vtp(path);
    if (n > detail::most_written / 2) {
        throw io_error(name, "expected at most 1073741823 segments, found " + std::to_string(n));
    }
    const detail::marked_properties marked(name, n, options, !as_vtp);
    detail::check_properties(name, "shape", n, marked.all, {"vertex1", "vertex2"});
    const auto end = [&](std::size_t i) { return i % 2 == 0 ? view[i / 2].a : view[i / 2].b; };
    if (as_vtp) {
        detail::vtp_file file(path);
        file.piece(2 * n, 0, 0, n);
        file.open("PointData");
        file.close("PointData");
        file.open("CellData", options.hit.empty() ? "" : " Scalars=\"hit\"");
        file.properties(marked.all);
        file.close("CellData");
        file.points(2 * n, end);
        file.cells("Lines", n, 2, [](std::size_t i) { return i; });
        file.finish();
        return;
    }
    detail::output_file file(path);
    detail::ply_header_text header;
    header.element("vertex", 2 * n);
    header.axes<T>("");
    header.element("edge", n);
    for (const char* vertex : {"vertex1", "vertex2"}) header.property_line("int", vertex);
    header.properties(marked.all);
    header.write(file);
    detail::ply_row row;
    for (std::size_t i = 0; i < 2 * n; ++i) {
        row.append(end(i));
        row.write(file);
    }
    for (std::size_t i = 0; i < n; ++i) {
        row.append(static_cast<std::int32_t>(2 * i));
        row.append(static_cast<std::int32_t>(2 * i + 1));
        row.append(marked.all, i);
        row.write(file);
    }
    file.close();
}

/// Writes curves, as `curves` makes them: their segments one after another, as `write_segments` does. Each segment has its
/// `curve`, counted from 0, and the first pair of faces that have it in common, `face_a` and `face_b`.
///
///     abut::io::write_curves("cut.vtp", abut::curves(on, abut::crossings(on, a, b)));
template <std::ranges::input_range Curves>
    requires curve_like<std::ranges::range_value_t<Curves>>
void write_curves(const std::filesystem::path& path, const Curves& curves) {
    const auto lines = detail::lines_of(curves);
    write_segments(path, shapes(lines.segments),
                   {.properties = {{"curve", lines.curve}, {"face_a", lines.face_a}, {"face_b", lines.face_b}}});
}

///@}

}  // namespace abut::io
