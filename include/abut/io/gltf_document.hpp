// SPDX-License-Identifier: MIT
#pragma once

// A binary glTF 2.0 file that is being put together: arrays of numbers in one buffer, and the lists of its JSON. It knows
// the format and nothing of collisions; write_gltf.hpp says what goes into it.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <abut/config.hpp>
#include <abut/io/error.hpp>
#include <abut/io/json_text.hpp>
#include <abut/io/property.hpp>

namespace abut::io::detail {

/// What an array is for.
struct gltf_array_options {
    bool is_attribute = false;   ///< of vertices
    bool is_indices = false;     ///< numbers of vertices
    bool has_bounds = false;     ///< positions and times, whose least and greatest values the format wants
    bool is_normalised = false;  ///< integers that stand for numbers from 0 to 1
};

/// What a file has once. Nodes are named by their numbers, as text.
struct gltf_scene_parts {
    std::vector<std::string> roots;       ///< nodes that the scene is of
    std::string translation;              ///< of all of it; empty: none
    std::string animation;                ///< empty: none
    std::string extras;                   ///< of the file
    std::vector<std::string> extensions;  ///< names of those that are used
};

/// The name of a vector of so many components.
inline std::string gltf_type(std::size_t components) {
    return components == 1 ? "\"SCALAR\"" : "\"VEC" + std::to_string(components) + '"';
}

template <class V>
constexpr int gltf_component() {
    if constexpr (std::is_same_v<V, std::uint8_t>)
        return 5121;
    else if constexpr (std::is_same_v<V, std::uint16_t>)
        return 5123;
    else if constexpr (std::is_same_v<V, std::uint32_t>)
        return 5125;
    else
        return 5126;
}

class gltf_document {
public:
    /// An array of elements of so many components each, at least one element; returns its number among the accessors.
    template <class V>
    std::size_t add(const std::vector<V>& values, std::size_t components, const gltf_array_options& options = {}) {
        const std::size_t offset = bytes_.size(), length = values.size() * sizeof(V);
        bytes_.resize(offset + (length + 3) / 4 * 4);  // the next array begins at a multiple of four
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(bytes_.data() + offset, values.data(), length);
        } else {
            for (std::size_t i = 0; i < values.size(); ++i)
                put_little_endian(bytes_.data() + offset + i * sizeof(V), values[i]);
        }
        views_.push_back(json_object({{"buffer", "0"},
                                      {"byteOffset", json_number(offset)},
                                      {"byteLength", json_number(length)},
                                      {"target", options.is_attribute ? "34962"
                                                 : options.is_indices ? "34963"
                                                                      : ""}}));
        const auto bound = [&](auto better) {
            return options.has_bounds ? bounds(values, components, better) : std::string();
        };
        accessors_.push_back(json_object({{"bufferView", json_number(views_.size() - 1)},
                                          {"componentType", json_number(gltf_component<V>())},
                                          {"normalized", options.is_normalised ? "true" : ""},
                                          {"count", json_number(values.size() / components)},
                                          {"type", gltf_type(components)},
                                          {"min", bound([](V a, V b) { return a < b; })},
                                          {"max", bound([](V a, V b) { return a > b; })}}));
        return accessors_.size() - 1;
    }
    /// Adds to one of the JSON's lists; returns the number there.
    ///@{
    std::size_t add_node(const std::string& node) { return push(nodes_, node); }
    std::size_t add_mesh(const std::string& mesh) { return push(meshes_, mesh); }
    std::size_t add_material(const std::string& material) { return push(materials_, material); }
    ///@}

    /// The file: `to` gets write(pointer, bytes) for its parts in order; `file` is its name in messages.
    template <class Output>
    void write(Output& to, const std::string& file, const gltf_scene_parts& parts) const {
        std::string json = header(parts);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const std::size_t chunks = 12 + 8 + json.size(), whole = chunks + (bytes_.empty() ? 0 : 8 + bytes_.size());
        if (whole > std::numeric_limits<std::uint32_t>::max()) {
            throw io_error(file, "expected at most 4294967295 bytes, which is as much as binary glTF holds; found " +
                                     std::to_string(whole));
        }
        const auto number = [&](std::size_t value) {
            char bytes[4];
            put_little_endian(bytes, static_cast<std::uint32_t>(value));
            to.write(bytes, sizeof bytes);
        };
        to.write("glTF", 4);
        number(2);
        number(whole);
        number(json.size());
        to.write("JSON", 4);
        to.write(json.data(), json.size());
        if (bytes_.empty()) return;
        number(bytes_.size());
        to.write("BIN\0", 4);
        to.write(bytes_.data(), bytes_.size());
    }

private:
    static std::size_t push(std::vector<std::string>& list, const std::string& value) {
        list.push_back(value);
        return list.size() - 1;
    }

    template <class V, class Better>
    static std::string bounds(const std::vector<V>& values, std::size_t components, const Better& better) {
        std::vector<V> best(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components));
        for (std::size_t i = components; i < values.size(); ++i) {
            V& so_far = best[i % components];
            if (better(values[i], so_far)) so_far = values[i];
        }
        std::vector<std::string> numbers;
        // A float is written as the double that it is, so that whoever compares finds them equal.
        for (const V value : best) numbers.push_back(json_number(static_cast<double>(value)));
        return json_array(numbers);
    }

    [[nodiscard]] std::string header(const gltf_scene_parts& parts) const {
        const auto list = [](const std::vector<std::string>& values) {
            return values.empty() ? std::string() : json_array(values);
        };
        const std::string version = std::to_string(ABUT_VERSION_MAJOR) + '.' + std::to_string(ABUT_VERSION_MINOR) + '.' +
                                    std::to_string(ABUT_VERSION_PATCH);
        std::vector<std::string> nodes = nodes_, roots = parts.roots;
        if (!parts.translation.empty() && !roots.empty()) {
            nodes.push_back(json_object({{"translation", parts.translation}, {"children", json_array(roots)}}));
            roots = {json_number(nodes.size() - 1)};
        }
        const std::string buffer = json_object({{"byteLength", json_number(bytes_.size())}});
        return json_object({{"asset", json_object({{"version", "\"2.0\""}, {"generator", json_string("abut " + version)}})},
                            {"extensionsUsed", list(parts.extensions)},
                            {"extras", parts.extras},
                            {"scene", "0"},
                            {"scenes", json_list(json_object({{"nodes", list(roots)}}))},
                            {"nodes", list(nodes)},
                            {"meshes", list(meshes_)},
                            {"materials", list(materials_)},
                            {"animations", parts.animation.empty() ? "" : json_list(parts.animation)},
                            {"accessors", list(accessors_)},
                            {"bufferViews", list(views_)},
                            {"buffers", bytes_.empty() ? "" : json_list(buffer)}});
    }

    std::vector<char> bytes_;
    std::vector<std::string> views_, accessors_, nodes_, meshes_, materials_;
};

}  // namespace abut::io::detail
