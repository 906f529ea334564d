// SPDX-License-Identifier: MIT
#pragma once

// Scenes of many parts: glTF with its nodes, or a CSV file that names mesh files and where each is. docs/files.md has the
// exact rules.

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <abut/io/csv.hpp>
#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/read.hpp>
#include <abut/io/text.hpp>

namespace abut::io {

namespace detail {

/// The rotation of a quaternion, whatever its length.
template <scalar T>
void set_rotation(rigid<T>& pose, const std::array<double, 4>& q) {
    // Divided by the largest first: no product overflows, and none that matters vanishes.
    const double largest = std::fmax(std::fmax(std::fabs(q[0]), std::fabs(q[1])), std::fmax(std::fabs(q[2]), std::fabs(q[3])));
    const double w = q[0] / largest, x = q[1] / largest, y = q[2] / largest, z = q[3] / largest;
    const double s = 2 / (w * w + x * x + y * y + z * z);
    const std::array<double, 9> rotation{1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                                         s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                                         s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    for (std::size_t i = 0; i < 9; ++i) pose.rotation[i] = static_cast<T>(rotation[i]);
}

/// Rows `file,name,x,y,z` or `file,name,x,y,z,qw,qx,qy,qz`.
template <scalar T>
class part_rows {
public:
    part_rows(std::string_view text, const std::string& file) : text_(text, file) { refuse_utf16(text, file); }

    /// add(file, name, pose) of each row.
    template <class Add>
    void run(const Add& add) {
        for (bool is_first = true; text_.to_next_row(); is_first = false) {
            const std::string_view path = word("the file of a mesh");
            comma("the file of a mesh");
            const std::string_view name = word("the name of a part");
            comma("the name of a part");
            if (is_first && path == "file") {
                text_.rest();  // names of columns
            } else {
                row(path, name, add);
            }
            text_.next_line();
        }
    }

private:
    /// Up to the next comma, without blanks around it.
    std::string_view word(const char* what) {
        text_.skip_blanks();
        std::string_view all = text_.up_to(',');
        while (!all.empty() && is_blank(all.back())) all.remove_suffix(1);
        if (all.empty()) text_.fail(what, {});
        return all;
    }
    void comma(const char* after) {
        if (text_.peek() != ',') text_.fail(std::string("',' after ") + after, {});
        text_.advance();
    }
    double number(const char* what) { return text_.template finite<double>(word(what), what); }
    template <class Add>
    void row(std::string_view path, std::string_view name, const Add& add) {
        rigid<T> pose;
        std::array<T, 3> at;
        constexpr std::array<const char*, 3> places{"the x coordinate of a place", "the y coordinate of a place",
                                                    "the z coordinate of a place"};
        for (std::size_t k = 0; k < 3; ++k) {
            if (k > 0) comma(places[k - 1]);
            at[k] = text_.template finite<T>(word(places[k]), places[k]);
        }
        pose.translation = {at[0], at[1], at[2]};
        if (text_.peek() == ',') {
            std::array<double, 4> q;
            for (double& part : q) {
                comma("a number of a quaternion");
                part = number("a number of a quaternion");
            }
            if (q == std::array<double, 4>{}) text_.fail_with("expected a quaternion qw,qx,qy,qz that is not 0");
            set_rotation(pose, q);
        }
        if (!text_.at_line_end()) text_.fail("the end of the line after 5 or 9 columns", {});
        add(std::string(path), std::string(name), pose);
    }

    text_cursor text_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Parts of a CSV text, each row `file,name,x,y,z` or `file,name,x,y,z,qw,qx,qy,qz`: the file of a mesh, a name, a place and
/// a quaternion of any length but 0. A first line whose first column is `file` has names. `load(file)` gives the mesh of a
/// file, and is called once for each. Throws io_error with the line of what is malformed, and what `load` throws.
///
///     const auto scene = abut::io::parse_parts<float>(text, "parts.csv", [](const std::string& file) { return mesh_of(file); });
template <scalar T>
parts_data<T> parse_parts(std::string_view text, const std::string& file,
                          const std::function<mesh_data<T>(const std::string&)>& load) {
    parts_data<T> made;
    std::map<std::string, std::size_t> known;
    detail::part_rows<T>(text, file).run([&](const std::string& path, const std::string& name, const rigid<T>& pose) {
        const auto [place, is_new] = known.try_emplace(path, made.meshes.size());
        if (is_new) made.meshes.push_back(load(path));
        made.parts.push_back({name, place->second, pose});
    });
    return made;
}

/// The parts of a scene, by the file's extension: of .glb and .gltf as `parse_gltf_parts` says; of .csv as `parse_parts`
/// says, with files of meshes in the folder of the CSV file or below it; of any other mesh file one part, which has the
/// file's name. Throws io_error for a file that cannot be read, is malformed, or is named in a CSV file by a path that leads
/// elsewhere.
///
///     const auto scene = abut::io::read_parts<float>("house.glb");
template <scalar T>
parts_data<T> read_parts(const std::filesystem::path& path, const read_options& options = {}) {
    const std::string extension = detail::plain_name(path.extension().string()), name = path.string();
    if (extension == ".csv") {
        const std::vector<char> text = detail::read_file(path);
        return parse_parts<T>({text.data(), text.size()}, name, [&](const std::string& other) {
            const std::filesystem::path beside(other);
            bool is_inside = !beside.is_absolute();
            for (const auto& part : beside) is_inside = is_inside && part != "..";
            if (!is_inside) throw io_error(name, "expected files in the folder of this one, found '" + other + "'");
            return read_mesh_data<T>(path.parent_path() / beside, options);
        });
    }
    if (extension == ".glb" || extension == ".gltf") {
        const std::vector<char> bytes = detail::read_file(path);
        return parse_gltf_parts<T>({bytes.data(), bytes.size()}, name,
                                   [&](const std::string& other) { return detail::read_file(path.parent_path() / other); });
    }
    parts_data<T> made;
    made.meshes.push_back(read_mesh_data<T>(path, options));
    made.parts.push_back({path.filename().string(), 0, {}});
    return made;
}

///@}

}  // namespace abut::io
