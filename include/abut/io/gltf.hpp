// SPDX-License-Identifier: MIT
#pragma once

// glTF 2.0, .glb and .gltf: the triangles of a file's scene, each mesh where its nodes put it. docs/reference/formats.md has
// the exact rules.
//
// Not by tinygltf (Debian: libtinygltf-dev): it takes the document apart and leaves it to its user whether an accessor lies
// inside its buffer, wants images to be decoded or switched off, and has no place in the file for what is wrong.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/gltf_arrays.hpp>
#include <abut/io/mesh_data.hpp>

namespace abut::io {
namespace detail {

/// The upper three rows of a transform's matrix.
struct gltf_transform {
    std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    [[nodiscard]] vec3<double> operator()(const vec3<double>& p) const {
        if (is_identity()) return p;  // with the signs of its zeros
        const auto row = [&](const std::array<double, 4>& r) { return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]; };
        return {row(rows[0]), row(rows[1]), row(rows[2])};
    }
    /// First `inner`, then this one.
    [[nodiscard]] gltf_transform operator*(const gltf_transform& inner) const {
        gltf_transform made;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                made.rows[i][j] = j == 3 ? rows[i][3] : 0;
                for (std::size_t k = 0; k < 3; ++k) made.rows[i][j] += rows[i][k] * inner.rows[k][j];
            }
        }
        return made;
    }
    [[nodiscard]] bool is_identity() const { return rows == gltf_transform{}.rows; }
    [[nodiscard]] vec3<double> column(std::size_t j) const { return {rows[0][j], rows[1][j], rows[2][j]}; }
    [[nodiscard]] bool mirrors() const { return dot(cross(column(0), column(1)), column(2)) < 0; }
    /// Whether it only turns and moves, as far as numbers of seven digits say.
    [[nodiscard]] bool is_rigid() const {
        constexpr double tolerance = 1e-6;
        bool is = !mirrors();
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = i; j < 3; ++j) {
                is = is && std::fabs(dot(column(i), column(j)) - (i == j ? 1 : 0)) <= tolerance;
            }
        }
        return is;
    }
    /// Of a translation, a rotation as a quaternion x, y, z, w, and factors along the axes.
    static gltf_transform of(const std::array<double, 3>& t, const std::array<double, 4>& q,
                             const std::array<double, 3>& s) {
        const auto [x, y, z, w] = q;
        gltf_transform made;
        made.rows = {{{s[0] * (1 - 2 * (y * y + z * z)), s[1] * 2 * (x * y - w * z), s[2] * 2 * (x * z + w * y), t[0]},
                      {s[0] * 2 * (x * y + w * z), s[1] * (1 - 2 * (x * x + z * z)), s[2] * 2 * (y * z - w * x), t[1]},
                      {s[0] * 2 * (x * z - w * y), s[1] * 2 * (y * z + w * x), s[2] * (1 - 2 * (x * x + y * y)), t[2]}}};
        return made;
    }
};

/// Walks over the scene's nodes and adds their meshes, one after another, or each as a part of its own.
template <scalar T>
class gltf_meshes {
public:
    gltf_meshes(std::string_view data, const std::string& file, const load_file& load)
        : file_(file), in_(data, file, load) {}

    mesh_data<T> read() {
        walk([this](const json_value&, const json_value& mesh, const gltf_transform& here) {
            add(in_.item("meshes", mesh), here);
        });
        return std::move(mesh_);
    }
    parts_data<T> read_parts() {
        parts_data<T> made;
        std::vector<std::optional<std::size_t>> known;  // of each mesh of the file, where it is among those made
        const auto take = [&] {
            made.meshes.push_back(std::move(mesh_));
            mesh_ = {};
            return made.meshes.size() - 1;
        };
        walk([&](const json_value& node, const json_value& number, const gltf_transform& here) {
            const json_value& mesh = in_.item("meshes", number);
            mesh_part<T> part{name_of(node, mesh), 0, {}};
            if (!here.is_rigid()) {
                add(mesh, here);
                part.mesh = take();
            } else {
                known.resize(in_.root_items("meshes"));
                auto& place = known[static_cast<std::size_t>(in_.whole(number, "a mesh", known.size() - 1))];
                if (!place) add(mesh, {}), place = take();
                part.mesh = *place;
                for (std::size_t i = 0; i < 9; ++i) part.pose.rotation[i] = static_cast<T>(here.rows[i / 3][i % 3]);
                const vec3<double> to = here.column(3);
                part.pose.translation = {static_cast<T>(to.x), static_cast<T>(to.y), static_cast<T>(to.z)};
                if (!std::isfinite(part.pose.translation.x) || !std::isfinite(part.pose.translation.y) ||
                    !std::isfinite(part.pose.translation.z)) {
                    in_.refuse(number, "finite places of meshes");
                }
            }
            if (!made.meshes[part.mesh].faces.empty()) made.parts.push_back(std::move(part));
        });
        return made;
    }

private:
    /// visit(node, mesh, transform) for each node that has a mesh, as often as it is there.
    template <class Visit>
    void walk(const Visit& visit) {
        refuse_extensions();
        const json_value* const nodes = in_.find(in_.root(), "nodes", json_kind::array);
        is_used_.resize(nodes == nullptr ? 0 : nodes->items.size());
        if (const json_value* const roots = roots_of_scene()) push(*roots, gltf_transform{});
        while (!waiting_.empty()) {
            const auto [number, outer] = waiting_.back();
            waiting_.pop_back();
            node(*number, outer, visit);
        }
    }
    [[nodiscard]] std::string name_of(const json_value& node, const json_value& mesh) const {
        for (const json_value* const one : {&node, &mesh}) {
            if (const json_value* const name = in_.find(*one, "name", json_kind::string)) return json_unescaped(name->text);
        }
        return "";
    }
    /// Those without which the positions would not be what the file means. What concerns looks alone may be required.
    void refuse_extensions() const {
        const json_value* const required = in_.find(in_.root(), "extensionsRequired", json_kind::array);
        if (required == nullptr) return;
        for (const json_value& name : required->items) {
            bool is_known = name.text == "KHR_mesh_quantization" || name.text == "EXT_mesh_gpu_instancing";
            for (const char* looks : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"}) {
                is_known = is_known || name.text.starts_with(looks);
            }
            if (!is_known) in_.refuse(name, "no extension that changes how meshes are stored");
        }
    }
    /// The nodes of the scene that the file names, or of its first one; null if it has none.
    [[nodiscard]] const json_value* roots_of_scene() const {
        const json_value* const scenes = in_.find(in_.root(), "scenes", json_kind::array);
        const json_value* const named = in_.find(in_.root(), "scene", json_kind::number);
        if (named == nullptr && (scenes == nullptr || scenes->items.empty())) return nullptr;
        const json_value& scene = named != nullptr ? in_.item("scenes", *named) : scenes->items.front();
        return in_.find(scene, "nodes", json_kind::array);
    }
    void push(const json_value& numbers, const gltf_transform& outer) {
        for (std::size_t i = numbers.items.size(); i-- > 0;) waiting_.emplace_back(&numbers.items[i], outer);
    }

    template <std::size_t N>
    std::array<double, N> numbers(const json_value& node, std::string_view name,
                                  const std::array<double, N>& otherwise) const {
        const json_value* const found = in_.find(node, name, json_kind::array);
        if (found == nullptr) return otherwise;
        if (found->items.size() != N) in_.refuse(*found, std::to_string(N) + " numbers");
        std::array<double, N> made;
        for (std::size_t i = 0; i < N; ++i) made[i] = in_.real(found->items[i]);
        return made;
    }
    gltf_transform transform_of(const json_value& node) const {
        if (in_.find(node, "matrix") == nullptr) {
            return gltf_transform::of(numbers<3>(node, "translation", {0, 0, 0}), numbers<4>(node, "rotation", {0, 0, 0, 1}),
                                      numbers<3>(node, "scale", {1, 1, 1}));
        }
        const auto m = numbers<16>(node, "matrix", {});  // column by column
        gltf_transform made;
        for (std::size_t i = 0; i < 3; ++i) made.rows[i] = {m[i], m[4 + i], m[8 + i], m[12 + i]};
        return made;
    }

    template <class Visit>
    void node(const json_value& number, const gltf_transform& outer, const Visit& visit) {
        const json_value& node = in_.item("nodes", number);
        const auto index = static_cast<std::size_t>(in_.whole(number, "a node", is_used_.size() - 1));
        if (is_used_[index]) in_.refuse(number, "a node that no other one has as its child, nor the scene twice");
        is_used_[index] = true;
        const gltf_transform here = outer * transform_of(node);
        if (const json_value* const mesh = in_.find(node, "mesh", json_kind::number)) {
            for (const gltf_transform& inner : instances(node)) visit(node, *mesh, here * inner);
        }
        if (const json_value* const children = in_.find(node, "children", json_kind::array)) push(*children, here);
    }
    /// Where a node has its mesh: at one place, unless EXT_mesh_gpu_instancing says at many.
    std::vector<gltf_transform> instances(const json_value& node) {
        const json_value* const extensions = in_.find(node, "extensions", json_kind::object);
        const json_value* const many =
            extensions == nullptr ? nullptr : in_.find(*extensions, "EXT_mesh_gpu_instancing", json_kind::object);
        if (many == nullptr) return {gltf_transform{}};
        const json_value& attributes = in_.get(*many, "attributes", json_kind::object);
        const auto array = [&](std::string_view name, std::string_view type, std::size_t components) {
            const json_value* const found = in_.find(attributes, name, json_kind::number);
            return found == nullptr ? gltf_elements{} : in_.elements(*found, type, components);
        };
        const gltf_elements t = array("TRANSLATION", "VEC3", 3), q = array("ROTATION", "VEC4", 4),
                            s = array("SCALE", "VEC3", 3);
        const std::size_t count = std::max(t.count, std::max(q.count, s.count));
        for (const gltf_elements* one : {&t, &q, &s}) {
            if (one->data != nullptr && one->count != count) in_.refuse(attributes, "attributes of as many instances each");
        }
        std::vector<gltf_transform> made;
        made.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const auto at = [&](const gltf_elements& e, std::size_t k, double otherwise) {
                return e.data == nullptr ? otherwise : e.real(i, k);
            };
            made.push_back(gltf_transform::of({at(t, 0, 0), at(t, 1, 0), at(t, 2, 0)},
                                              {at(q, 0, 0), at(q, 1, 0), at(q, 2, 0), at(q, 3, 1)},
                                              {at(s, 0, 1), at(s, 1, 1), at(s, 2, 1)}));
        }
        return made;
    }

    void add(const json_value& mesh, const gltf_transform& here) {
        for (const json_value& primitive : in_.get(mesh, "primitives", json_kind::array).items) {
            const std::uint64_t mode = in_.whole(primitive, "mode", 4, 6);
            if (mode < 4) continue;  // points and lines
            const json_value& attributes = in_.get(primitive, "attributes", json_kind::object);
            const json_value* const number = in_.find(attributes, "POSITION", json_kind::number);
            if (number == nullptr) {
                continue;  // nothing is drawn, says the format
            }
            const gltf_elements positions = in_.elements(*number, "VEC3", 3);
            const std::size_t first = mesh_.vertices.size();
            constexpr std::size_t most = 0x7fffffff;
            if (positions.count > most - first) in_.refuse(*number, "at most 2147483647 vertices in all");
            for (std::size_t i = 0; i < positions.count; ++i) mesh_.vertices.push_back(placed(positions, i, here, *number));
            if (const json_value* const indices = in_.find(primitive, "indices", json_kind::number)) {
                const gltf_elements corners = in_.elements(*indices, "SCALAR", 1);
                if (corners.type != 5121 && corners.type != 5123 && corners.type != 5125) {
                    in_.refuse(*indices, "indices that are unsigned integers");
                }
                for (std::size_t i = 0; i < corners.count; ++i) {
                    if (static_cast<std::uint64_t>(corners.whole(i, 0)) < positions.count) continue;
                    in_.refuse(*indices, "indices below " + std::to_string(positions.count) + "; number " +
                                             std::to_string(i) + " is " + std::to_string(corners.whole(i, 0)) +
                                             ", in accessor");
                }
                add_faces(
                    mode, corners.count, here.mirrors(),
                    [&](std::size_t i) {
                        return static_cast<std::uint32_t>(first + static_cast<std::size_t>(corners.whole(i, 0)));
                    },
                    *indices);
            } else {
                add_faces(
                    mode, positions.count, here.mirrors(),
                    [&](std::size_t i) { return static_cast<std::uint32_t>(first + i); }, *number);
            }
        }
    }
    vec3<T> placed(const gltf_elements& positions, std::size_t i, const gltf_transform& here, const json_value& at) const {
        const vec3<double> p = here({positions.real(i, 0), positions.real(i, 1), positions.real(i, 2)});
        const vec3<T> made{static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)};
        if (!std::isfinite(made.x) || !std::isfinite(made.y) || !std::isfinite(made.z)) {
            in_.refuse(at, "finite positions; number " + std::to_string(i) + " is not, in accessor");
        }
        return made;
    }
    template <class Corner>
    void add_faces(std::uint64_t mode, std::size_t corners, bool is_mirrored, const Corner& corner, const json_value& at) {
        const std::size_t first = mesh_.faces.size();
        face_collector<T> faces(mesh_, file_);
        if (mode == 4) {
            if (corners % 3 != 0)
                in_.refuse(at, "three corners for each triangle, not " + std::to_string(corners) + " in all, in accessor");
            for (std::size_t i = 0; i < corners; i += 3) mesh_.faces.push_back({corner(i), corner(i + 1), corner(i + 2)});
        } else if (mode == 5) {
            faces.add_strip(corners, corner);
        } else {
            for (std::size_t i = 2; i < corners; ++i) mesh_.faces.push_back({corner(0), corner(i - 1), corner(i)});
        }
        if (!is_mirrored) return;
        for (std::size_t f = first; f < mesh_.faces.size(); ++f) std::swap(mesh_.faces[f][1], mesh_.faces[f][2]);
    }

    const std::string& file_;
    gltf_reader in_;
    mesh_data<T> mesh_;
    std::vector<bool> is_used_;
    std::vector<std::pair<const json_value*, gltf_transform>> waiting_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the bytes of a glTF 2.0 file, .glb or .gltf; `file` is its name in messages. The triangles of the scene's meshes,
/// in the order of its nodes, each where its node puts it: positions are transformed in double and rounded to T. `load`
/// gives the bytes of other files that this one names; without it, such a file is refused. Throws io_error with the byte of
/// what is malformed or missing. A value of its JSON takes 56 bytes; a mesh that many nodes have is there as often, up to
/// 2,147,483,647 vertices.
///
///     const auto mesh = abut::io::parse_gltf<float>({bytes.data(), bytes.size()}, "part.glb");
template <scalar T>
mesh_data<T> parse_gltf(std::string_view data, const std::string& file, const load_file& load = {}) {
    return detail::gltf_meshes<T>(data, file, load).read();
}

/// The same, with each node's mesh as a part of its own, by the node's name or its mesh's; nodes without triangles are left
/// out. A node that turns and moves its mesh, and no more, has it in common with others: the transform is the part's pose,
/// rounded to T. Any other node has a mesh of its own, as `parse_gltf` gives it.
///
///     const auto scene = abut::io::parse_gltf_parts<float>({bytes.data(), bytes.size()}, "house.glb");
template <scalar T>
parts_data<T> parse_gltf_parts(std::string_view data, const std::string& file, const load_file& load = {}) {
    return detail::gltf_meshes<T>(data, file, load).read_parts();
}

///@}

}  // namespace abut::io
