// SPDX-License-Identifier: MIT
#pragma once

// --view FILE: the scene of an example as a page that a browser opens, or as binary glTF. What is too much for a browser is
// left out, and that is said.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/io/write_html.hpp>

#include "program.hpp"

namespace example {

/// How much a scene holds: a set of more shapes is shown in part.
inline constexpr std::size_t most_faces_shown = 1'000'000, most_spheres_shown = 100'000, most_results_shown = 1'000'000;

inline void add_view(CLI::App& app, common_settings& s) {
    app.add_option("--view", s.view,
                   "Write what is to be seen here: .html, a page that a browser opens from the disk, made with\n"
                   "`sh cmake/view.sh`; or .glb, binary glTF")
        ->type_name("FILE");
}
inline std::string view_extension(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}
/// Refuses what add_view's option cannot mean, before the work.
inline void check_view(const common_settings& s) {
    if (s.view.empty()) return;
    const std::string extension = view_extension(s.view);
    if (extension != ".html" && extension != ".glb") {
        throw usage_error("--view: " + s.view + ": expected a name that ends with .html or .glb");
    }
    require_writable(s.view);
}

// --- what is shown of a set --------------------------------------------------------------------------------------------

/// The shapes that are shown: those that are hit come first, and others are spread over the set.
class selection {
public:
    /// Of all shapes if there are at most `most` of them; otherwise of `most`, at most `others` of which are not hit.
    selection(std::vector<std::uint8_t> hit, std::size_t most, std::size_t others) : hit_(std::move(hit)) {
        if (hit_.size() <= most) return;
        const std::size_t hits = std::min(count_set(hit_), most);
        const std::size_t room = std::min(others, most - hits), rest = hit_.size() - count_set(hit_);
        std::size_t taken = 0, passed = 0, filled = 0;
        shown_.resize(hit_.size());
        for (std::size_t i = 0; i < hit_.size(); ++i) {
            if (hit_[i] != 0) {
                shown_[i] = taken < hits ? 1 : 0;
                taken += shown_[i];
            } else if (++passed; passed * room / rest > filled) {  // the k-th of them where k / room of the rest have passed
                shown_[i] = 1;
                ++filled;
            }
            if (shown_[i] != 0) ids_.push_back(static_cast<std::uint32_t>(i));
        }
        for (std::size_t k = 0; k < ids_.size(); ++k) hit_[k] = hit_[ids_[k]];
        whole_ = hit_.size();
        hit_.resize(ids_.size());
    }
    [[nodiscard]] bool is_whole() const { return shown_.empty(); }
    [[nodiscard]] bool shows(std::size_t i) const { return shown_.empty() || shown_[i] != 0; }
    [[nodiscard]] const std::vector<std::uint32_t>& ids() const { return ids_; }
    [[nodiscard]] abut::io::gltf_set_options options() const { return {.hit = hit_, .ids = ids_, .of = whole_}; }
    /// What is left out of the set of this name, for the reader of the scene and of what the program prints.
    void tell(abut::io::gltf_scene& scene, const std::string& name) const {
        if (is_whole()) return;
        const std::string text = name + ": " + std::to_string(ids_.size()) + " of " + std::to_string(whole_) +
                                 " shapes are shown, " + std::to_string(count_set(hit_)) + " of them hit";
        std::printf("view: %s\n", text.c_str());
        scene.add_note(text);
    }

private:
    std::vector<std::uint8_t> hit_, shown_;
    std::vector<std::uint32_t> ids_;
    std::size_t whole_ = 0;
};

/// These shapes of a set.
///@{
template <abut::scalar T>
abut::mesh<T> part_of(const abut::mesh<T>& set, const std::vector<std::uint32_t>& ids) {
    const auto view = set.view();
    std::vector<abut::vec3<T>> vertices(view.vertices.count);
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = view.vertices[v];
    std::vector<abut::face> faces;
    for (const std::uint32_t id : ids) faces.push_back(view.faces[id]);
    return {vertices, faces};
}
template <abut::scalar T>
abut::equal_spheres<T> part_of(const abut::equal_spheres<T>& set, const std::vector<std::uint32_t>& ids) {
    std::vector<abut::vec3<T>> centers;
    for (const std::uint32_t id : ids) centers.push_back(set.view().centers[id]);
    return {centers, set.view().radius};
}
template <abut::shape S>
abut::shapes<S> part_of(const abut::shapes<S>& set, const std::vector<std::uint32_t>& ids) {
    std::vector<S> shapes;
    for (const std::uint32_t id : ids) shapes.push_back(set.view()[id]);
    return {shapes};
}
template <class Set>
abut::moving_set<Set> part_of(const abut::moving_set<Set>& set, const std::vector<std::uint32_t>& ids) {
    return abut::moving(part_of(set.t0(), ids), part_of(set.t1(), ids));
}
template <class Set>
abut::posed_object<Set> part_of(const abut::posed_object<Set>& set, const std::vector<std::uint32_t>& ids) {
    return abut::posed(part_of(set.object, ids), set.pose);
}
///@}

/// Adds what is selected of a set.
template <class Set>
abut::io::gltf_set add_selected(abut::io::gltf_scene& scene, const std::string& name, const Set& set,
                                const selection& which) {
    which.tell(scene, name);
    return scene.add(name, which.is_whole() ? set : part_of(set, which.ids()), which.options());
}

/// Those of `results` of which `shows(result)`, and no more than a scene holds; says how many are left out.
template <class Result, class Shows>
std::vector<Result> shown_results(abut::io::gltf_scene& scene, const char* kind, const std::vector<Result>& results,
                                  const Shows& shows) {
    std::vector<Result> shown;
    for (const Result& r : results) {
        if (shown.size() < most_results_shown && shows(r)) shown.push_back(r);
    }
    if (shown.size() < results.size()) {
        const std::string text =
            std::to_string(shown.size()) + " of " + std::to_string(results.size()) + " " + kind + " are shown";
        std::printf("view: %s\n", text.c_str());
        scene.add_note(text);
    }
    return shown;
}

// --- the file ----------------------------------------------------------------------------------------------------------

/// The page that scenes are put into: named by the environment variable ABUT_VIEWER, or where cmake/view.sh makes it.
inline std::filesystem::path viewer_page() {
    const char* const named = std::getenv("ABUT_VIEWER");
    return named != nullptr && *named != '\0' ? named : ABUT_VIEWER_PAGE;
}

/// Writes the file of --view, and says what was written.
inline void write_view(const std::string& file, const abut::io::gltf_scene& scene) {
    const auto page = viewer_page();
    std::filesystem::path path(file);
    if (view_extension(file) == ".html" && std::filesystem::exists(page)) {
        abut::io::write_html(path, scene, page);
    } else {
        if (view_extension(file) == ".html") {
            path.replace_extension(".glb");
            std::printf("view: there is no page %s, which `sh cmake/view.sh` makes; glTF alone is written\n", page.c_str());
        }
        abut::io::write_gltf(path, scene);
    }
    std::printf("view: %s\n", path.c_str());
}

}  // namespace example
