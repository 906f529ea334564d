// SPDX-License-Identifier: MIT
#pragma once

// Scenes of a simulation's step from shared/data/ccd, whose README.md has the formats: a mesh at two times, and for some of
// them which pairs of features collide in between, and when.

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <abut/io/ply.hpp>

#include "io/support.hpp"
#include "motion.hpp"

namespace abut::test {

/// A mesh at two times; every vertex moves on a straight line at constant speed.
struct ccd_scene {
    std::vector<vec3<double>> t0, t1;
    std::vector<std::array<std::uint32_t, 3>> faces;

    /// The vertex v[0] and the face of v[1], v[2], v[3]; or the edge of v[0], v[1] and that of v[2], v[3].
    [[nodiscard]] motion<double> pair(const std::array<std::uint32_t, 4>& v) const {
        return {{t0[v[0]], t0[v[1]], t0[v[2]], t0[v[3]]}, {t1[v[0]], t1[v[1]], t1[v[2]], t1[v[3]]}};
    }
};

/// What is known of a pair.
struct ccd_truth_row {
    std::array<std::uint32_t, 4> vertices;
    bool hit;
    double time;  // the earliest, within 2^-60 and then rounded; -1 where there is no contact
};

/// The folder of a scene; nothing if the data is not there.
inline std::optional<std::filesystem::path> ccd_folder(const char* scene) {
    const auto meshes = io_test::meshes();
    if (!meshes || !std::filesystem::is_directory(meshes->parent_path() / "ccd" / scene)) return {};
    return meshes->parent_path() / "ccd" / scene;
}

/// Throws io_error for a file that is not there, or not a PLY file.
inline ccd_scene read_ccd_scene(const std::filesystem::path& folder) {
    const auto read = [&](const char* name) {
        return io::parse_ply<double>(io_test::content(folder / name), (folder / name).string());
    };
    io::mesh_data<double> first = read("frame0.ply"), second = read("frame1.ply");
    if (first.faces != second.faces || first.vertices.size() != second.vertices.size()) {
        throw std::runtime_error(folder.string() + ": the frames are not of one mesh");
    }
    return {std::move(first.vertices), std::move(second.vertices), std::move(first.faces)};
}

/// Whether there is truth for the scene, which there is not for all.
inline bool has_ccd_truth(const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / "truth_vf.bin") && std::filesystem::exists(folder / "truth_ee.bin");
}

/// The rows of truth_vf.bin or truth_ee.bin. Throws std::runtime_error for a file that is not as the README says.
inline std::vector<ccd_truth_row> read_ccd_truth(const std::filesystem::path& folder, motion_kind kind) {
    const std::filesystem::path path = folder / (kind == motion_kind::vertex_face ? "truth_vf.bin" : "truth_ee.bin");
    const std::string bytes = io_test::content(path);
    const auto word = [&](std::size_t at) {
        std::int32_t w = 0;
        std::memcpy(&w, bytes.data() + at, 4);
        return w;
    };
    const auto fail = [&] { throw std::runtime_error(path.string() + ": not a file of truth"); };
    if (bytes.size() < 16 || word(0) != 0x54444343 || word(4) != static_cast<int>(kind) || word(8) < 0 || word(12) != 5)
        fail();
    const auto n = static_cast<std::size_t>(word(8));
    if (bytes.size() != 16 + 28 * n) fail();
    std::vector<ccd_truth_row> rows(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 4; ++k) rows[i].vertices[k] = static_cast<std::uint32_t>(word(16 + 20 * i + 4 * k));
        rows[i].hit = word(16 + 20 * i + 16) == 1;
        std::memcpy(&rows[i].time, bytes.data() + 16 + 20 * n + 8 * i, 8);
    }
    return rows;
}

}  // namespace abut::test
