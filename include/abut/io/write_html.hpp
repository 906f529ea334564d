// SPDX-License-Identifier: MIT
#pragma once

// A page with a scene inside it: one file that a browser opens from the disk, with no server and no network.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/base64.hpp>
#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/write_gltf.hpp>

namespace abut::io {

/// Writes a page that shows a scene: `page`, an HTML file which has once
/// `<script id="abut-scene" type="application/octet-stream;base64"></script>`, with the scene as binary glTF in base64
/// between these tags. `sh cmake/view.sh` makes such a page of docs/viewer. An existing file is replaced. Throws io_error if
/// the page cannot be read or has no such place, and as `write_gltf` does.
///
///     abut::io::write_html("scene.html", scene, "viewer.html");
/// @ingroup files
inline void write_html(const std::filesystem::path& path, const gltf_scene& scene, const std::filesystem::path& page) {
    constexpr std::string_view opening = "<script id=\"abut-scene\" type=\"application/octet-stream;base64\">";
    const std::vector<char> bytes = detail::read_file(page);
    const std::string_view text(bytes.data(), bytes.size());
    const std::string place = std::string(opening) + "</script>";
    const std::size_t at = text.find(place);
    if (at == text.npos || text.find(place, at + 1) != text.npos) {
        throw io_error(page.string(), std::string("expected ") + place + " once, found it " +
                                          (at == text.npos ? "nowhere" : "more than once"));
    }
    detail::output_file file(path);
    file.write(text.substr(0, at + opening.size()));
    detail::base64_writer in_base64(file);
    scene.write(in_base64, path.string());
    in_base64.finish();
    file.write(text.substr(at + opening.size()));
    file.close();
}

}  // namespace abut::io
