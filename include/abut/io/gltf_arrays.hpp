// SPDX-License-Identifier: MIT
#pragma once

// The numbers of a glTF file: its JSON and its buffers, and the accessors that say what lies where in them. gltf.hpp makes
// meshes of it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <abut/io/base64.hpp>
#include <abut/io/error.hpp>
#include <abut/io/json.hpp>
#include <abut/io/stl.hpp>
#include <abut/io/text.hpp>

namespace abut::io {

/// Gives the bytes of a file that another one names, by its relative path.
/// @ingroup files
using load_file = std::function<std::vector<char>(const std::string& path)>;

namespace detail {

/// The JSON of a file and its binary chunk, if it has one.
struct gltf_parts {
    std::string_view json;
    std::size_t json_at = 0;  // in the file
    std::optional<std::string_view> binary;
};

/// Takes the chunks of a .glb file apart; a .gltf file is JSON alone.
inline gltf_parts gltf_chunks(std::string_view data, const std::string& file) {
    if (!data.starts_with("glTF")) {
        const std::size_t mark = data.starts_with("\xef\xbb\xbf") ? 3 : 0;
        return {data.substr(mark), mark, {}};
    }
    const auto fail = [&](std::size_t byte, const std::string& what) { throw io_error::at_byte(file, byte, what); };
    const auto word = [&](std::size_t at) -> std::uint32_t {
        if (at + 4 > data.size()) fail(data.size(), "expected more of a binary glTF file, found the end of the file");
        return get_little_endian<std::uint32_t>(data.data() + at);
    };
    if (const auto version = word(4); version != 2) {
        fail(4, "expected version 2 of binary glTF, found " + std::to_string(version));
    }
    if (const std::uint64_t length = word(8); length != data.size()) {
        fail(8, "expected a length of " + std::to_string(data.size()) + " bytes, which the file has, found " +
                    std::to_string(length));
    }
    gltf_parts parts;
    for (std::size_t at = 12, number = 0; at < data.size(); ++number) {
        const std::uint64_t length = word(at);
        const std::uint32_t kind = word(at + 4);
        at += 8;
        if (length > data.size() - at) {
            fail(at - 8,
                 "expected a chunk of " + std::to_string(length) + " bytes, found " + std::to_string(data.size() - at));
        }
        const std::string_view chunk = data.substr(at, static_cast<std::size_t>(length));
        if (number == 0) {
            if (kind != 0x4e4f534a) fail(at - 4, "expected JSON as the first chunk of binary glTF");
            parts.json = chunk;
            parts.json_at = at;
        } else if (number == 1 && kind == 0x004e4942) {
            parts.binary = chunk;
        }
        at += static_cast<std::size_t>(length);
    }
    if (parts.json_at == 0) fail(data.size(), "expected a chunk of JSON, found the end of the file");
    return parts;
}

/// Elements of a buffer: `count` of them, each of so many numbers of one type.
struct gltf_elements {
    const char* data = nullptr;
    std::size_t count = 0, stride = 0, components = 0;
    int type = 0;
    bool is_normalised = false;
    std::vector<std::uint32_t> replaced{};  // of a sparse accessor: these elements, in order, are others
    const char* others = nullptr;
    std::size_t others_stride = 0;

    [[nodiscard]] const char* at(std::size_t i) const {
        const auto found = std::lower_bound(replaced.begin(), replaced.end(), i);
        if (found == replaced.end() || *found != i) return data + i * stride;
        return others + static_cast<std::size_t>(found - replaced.begin()) * others_stride;
    }
    /// Number k of element i. Normalised integers stand for numbers from -1 or 0 to 1.
    [[nodiscard]] double real(std::size_t i, std::size_t k) const {
        if (type == 5126) return static_cast<double>(get_little_endian<float>(at(i) + 4 * k));
        const double value = static_cast<double>(whole(i, k));
        if (!is_normalised) return value;
        constexpr std::array<double, 4> most{127, 255, 32767, 65535};
        return std::fmax(value / most[static_cast<std::size_t>(type - 5120)], -1.0);
    }
    [[nodiscard]] std::int64_t whole(std::size_t i, std::size_t k) const {
        const char* const bytes = at(i);
        switch (type) {
            case 5120:
                return static_cast<std::int8_t>(bytes[k]);
            case 5121:
                return static_cast<std::uint8_t>(bytes[k]);
            case 5122:
                return get_little_endian<std::int16_t>(bytes + 2 * k);
            case 5123:
                return get_little_endian<std::uint16_t>(bytes + 2 * k);
            default:
                return get_little_endian<std::uint32_t>(bytes + 4 * k);
        }
    }
};

/// The document, and its buffers, which are decoded or loaded when they are first used.
class gltf_reader : public json_reader {
public:
    gltf_reader(std::string_view data, const std::string& file, const load_file& load)
        : gltf_reader(gltf_chunks(data, file), file, load) {}

    [[nodiscard]] const json_value& root() const { return root_; }

    /// Item `number` of one of the document's lists.
    [[nodiscard]] const json_value& item(std::string_view list, const json_value& number) const {
        const json_value* const found = find(root_, list, json_kind::array);
        const std::size_t size = found == nullptr ? 0 : found->items.size();
        if (size == 0) refuse(number, "'" + std::string(list) + "' in the file, which has none");
        return found->items[whole(number, ("a number of '" + std::string(list) + "'").c_str(), size - 1)];
    }

    /// How many items one of the document's lists has.
    [[nodiscard]] std::size_t root_items(std::string_view list) const {
        const json_value* const found = find(root_, list, json_kind::array);
        return found == nullptr ? 0 : found->items.size();
    }

    /// What an accessor, by its number, says is there. `type` is its form ("VEC3"), of so many components.
    gltf_elements elements(const json_value& number, std::string_view type, std::size_t components) {
        const json_value& accessor = item("accessors", number);
        const json_value& form = get(accessor, "type", json_kind::string);
        if (form.text != type) refuse(form, "'" + std::string(type) + "'");
        gltf_elements made;
        made.type = component_type(accessor);
        made.components = components;
        const json_value* const normalised = find(accessor, "normalized", json_kind::boolean);
        made.is_normalised = normalised != nullptr && normalised->text == "true" && made.type < 5124;
        const json_value& count = get(accessor, "count", json_kind::number);
        made.count = static_cast<std::size_t>(whole(count, "a count", most_bytes));

        const std::size_t size = component_size(made.type) * components;
        if (find(accessor, "bufferView") != nullptr) {
            const stretch found = part_of_view(accessor, made.count, size, true);
            made.data = found.data;
            made.stride = found.stride;
        } else {
            // Zeros, by the format. No bytes stand for them, so their number has a bound of its own.
            static constexpr std::array<char, 64> zeros{};
            constexpr std::size_t most = 1 << 24;
            if (made.count > most) refuse(count, "at most 16777216 elements of an accessor without a buffer view");
            made.data = zeros.data();
        }
        if (const json_value* const sparse = find(accessor, "sparse", json_kind::object)) replace(made, *sparse, size);
        return made;
    }

private:
    gltf_reader(const gltf_parts& parts, const std::string& file, const load_file& load)
        : json_reader(parts.json, file, parts.json_at), load_(load), binary_(parts.binary) {
        root_ = parse();
        if (root_.kind != json_kind::object) refuse(root_, "an object");
        const json_value& version = get(get(root_, "asset", json_kind::object), "version", json_kind::string);
        if (!version.text.starts_with("2.")) refuse(version, "version 2 of glTF");
        loaded_.resize(root_items("buffers"));
    }

    static constexpr std::uint64_t most_bytes = std::numeric_limits<std::uint32_t>::max();

    /// Elements of a buffer view, one every `stride` bytes.
    struct stretch {
        const char* data;
        std::size_t stride;
    };
    /// Those of an accessor or of a part of one, `count` of `size` bytes each.
    stretch part_of_view(const json_value& owner, std::size_t count, std::size_t size, bool may_have_gaps) {
        const json_value& view = item("bufferViews", get(owner, "bufferView", json_kind::number));
        const std::string_view buffer = bytes_of(get(view, "buffer", json_kind::number));
        const std::uint64_t begin = whole(view, "byteOffset", 0, most_bytes), length = whole(view, "byteLength", 0, most_bytes);
        if (begin + length > buffer.size()) {
            refuse(view, "a part of its buffer, which has " + std::to_string(buffer.size()) + " bytes");
        }
        const std::size_t stride = may_have_gaps ? static_cast<std::size_t>(whole(view, "byteStride", size, most_bytes)) : size;
        const std::uint64_t offset = whole(owner, "byteOffset", 0, most_bytes);
        // One element takes all of its components; from one to the next it is a stride. 2^32 strides of 2^32 bytes fit.
        const std::uint64_t needed = count == 0 ? 0 : std::uint64_t{count - 1} * stride + size;
        if (stride < size || offset > length || needed > length - offset) {
            refuse(owner, "a part of its buffer view, which has " + std::to_string(length) + " bytes");
        }
        return {buffer.data() + begin + offset, stride};
    }

    /// What a sparse accessor has in place of some elements: their numbers, which increase, and their values.
    void replace(gltf_elements& made, const json_value& sparse, std::size_t size) {
        const json_value& count = get(sparse, "count", json_kind::number);
        const auto others = static_cast<std::size_t>(whole(count, "a count of at most all elements", made.count));
        const json_value& places = get(sparse, "indices", json_kind::object);
        gltf_elements numbers;
        numbers.type = component_type(places);
        if (numbers.type != 5121 && numbers.type != 5123 && numbers.type != 5125) {
            refuse(places, "numbers of elements without a sign (5121, 5123, 5125)");
        }
        const stretch found = part_of_view(places, others, component_size(numbers.type), false);
        numbers.data = found.data;
        numbers.stride = found.stride;
        const stretch values = part_of_view(get(sparse, "values", json_kind::object), others, size, false);
        made.others = values.data;
        made.others_stride = values.stride;
        for (std::size_t i = 0; i < others; ++i) {
            const auto one = static_cast<std::uint64_t>(numbers.whole(i, 0));
            if (one >= made.count || (i > 0 && one <= made.replaced.back())) {
                refuse(places, "numbers of elements that increase and are below " + std::to_string(made.count));
            }
            made.replaced.push_back(static_cast<std::uint32_t>(one));
        }
    }

    [[nodiscard]] int component_type(const json_value& owner) const {
        const json_value& component = get(owner, "componentType", json_kind::number);
        const auto type = static_cast<int>(whole(component, "a type of components", 5126));
        if (component_size(type) == 0) refuse(component, "a type of components (5120 to 5123, 5125, 5126)");
        return type;
    }
    static std::size_t component_size(int type) {
        constexpr std::array<std::size_t, 7> sizes{1, 1, 2, 2, 0, 4, 4};
        return type < 5120 ? 0 : sizes[static_cast<std::size_t>(type - 5120)];
    }

    std::string_view bytes_of(const json_value& number) {
        const json_value& buffer = item("buffers", number);
        const auto index = static_cast<std::size_t>(whole(number, "a buffer", loaded_.size() - 1));
        const json_value* const uri = find(buffer, "uri", json_kind::string);
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        const std::uint64_t length = whole(get(buffer, "byteLength", json_kind::number), "a length in bytes", most);
        std::string_view bytes;
        if (uri == nullptr) {
            if (index != 0 || !binary_)
                refuse(buffer, "a buffer with 'uri', or the binary chunk of a .glb file as the first");
            bytes = *binary_;
        } else {
            if (!loaded_[index]) loaded_[index] = load(*uri);
            bytes = {loaded_[index]->data(), loaded_[index]->size()};
        }
        if (length > bytes.size()) {
            refuse(buffer, "a buffer of " + std::to_string(length) + " bytes, of which " + std::to_string(bytes.size()) +
                               " are there");
        }
        return bytes.substr(0, static_cast<std::size_t>(length));
    }

    std::vector<char> load(const json_value& uri) const {
        constexpr std::string_view in_base64 = ";base64,";
        const std::string text = json_unescaped(uri.text);
        if (text.starts_with("data:")) {
            const std::size_t at = text.find(in_base64);
            std::optional<std::vector<char>> bytes;
            if (at != text.npos) bytes = base64_decoded(std::string_view(text).substr(at + in_base64.size()));
            if (!bytes) refuse(uri, "data in base64");
            return std::move(*bytes);
        }
        // Files beside this one, or in folders there: a file that comes from elsewhere shall not name any other.
        const std::string path = without_percents(text);
        const std::filesystem::path relative(path);
        bool is_inside =
            !path.empty() && !relative.is_absolute() && path.find(':') == path.npos && path.find('\0') == path.npos;
        for (const auto& part : relative) is_inside = is_inside && part != "..";
        if (!is_inside) refuse(uri, "data, or the path of a file in the same folder");
        if (!load_) refuse(uri, "a buffer within the file; who has a file's text alone cannot read others");
        return load_(path);
    }
    static std::string without_percents(std::string_view uri) {
        std::string path;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            unsigned code = 0;
            if (uri[i] == '%' && i + 2 < uri.size() &&
                std::from_chars(uri.data() + i + 1, uri.data() + i + 3, code, 16).ptr == uri.data() + i + 3) {
                path += static_cast<char>(code);
                i += 2;
            } else {
                path += uri[i];
            }
        }
        return path;
    }

    const load_file& load_;
    std::optional<std::string_view> binary_;
    json_value root_;
    std::vector<std::optional<std::vector<char>>> loaded_;
};

}  // namespace detail
}  // namespace abut::io
