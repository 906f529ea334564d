// SPDX-License-Identifier: MIT
#pragma once

// What the tests of readers and writers share: messages of refusals, files that go away, and where test data lies.

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string>
#include <string_view>

#include <abut/io/error.hpp>

namespace io_test {

/// The message of the io_error that `call` throws; "accepted" if it throws nothing.
template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const abut::io_error& error) {
        return error.what();
    }
    return "accepted";
}

/// A folder of its own for each test, removed with all that is in it.
class scratch {
public:
    scratch() {
        std::random_device random;
        path_ = std::filesystem::temp_directory_path() / ("abut_io_" + std::to_string(random()) + std::to_string(random()));
        std::filesystem::create_directories(path_);
    }
    ~scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    scratch(const scratch&) = delete;
    scratch& operator=(const scratch&) = delete;

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    /// Writes a file and returns its path.
    std::filesystem::path file(const std::string& name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

/// The bytes of a number in the order of most binary files.
template <class V>
void to_little_endian(V value, char* bytes) {
    std::memcpy(bytes, &value, sizeof value);
    if (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof value);
}

inline std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The seeds and regressions of a reader, beside this file.
inline std::filesystem::path seeds() { return std::filesystem::path(__FILE__).parent_path() / "seeds"; }

/// The folder of real meshes: in $ABUT_DATA, or where the build was told; nothing if there is none.
inline std::optional<std::filesystem::path> meshes() {
    std::filesystem::path data;
    if (const char* set = std::getenv("ABUT_DATA")) data = set;
#ifdef ABUT_DATA_DIR
    if (data.empty()) data = ABUT_DATA_DIR;
#endif
    if (data.empty() || !std::filesystem::is_directory(data / "meshes")) return {};
    return data / "meshes";
}

}  // namespace io_test
