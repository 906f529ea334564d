// SPDX-License-Identifier: MIT
#pragma once

// What readers and writers of files throw. Its message is made for the user of a program: it names the file, the place in
// it, what was expected there and what was found.

#include <cstddef>
#include <optional>
#include <string>

#include <abut/error.hpp>

namespace abut {

/// A file that cannot be read or written, or whose content is malformed or truncated. The message reads
/// `path: what` (the file as a whole), `path:12: what` (a line of text) or `path: byte 123: what` (binary data).
/// @ingroup errors
class io_error : public error {
public:
    /// Of the file as a whole.
    explicit io_error(const std::string& file, const std::string& what) : error(file + ": " + what), file_(file) {}

    /// Of a line of a text file (or of a PLY header); lines count from 1.
    [[nodiscard]] static io_error at_line(const std::string& file, std::size_t line, const std::string& what) {
        io_error result(file, what, file + ":" + std::to_string(line) + ": " + what);
        result.line_ = line;
        return result;
    }
    /// Of a place in binary data; bytes count from 0, from the start of the file.
    [[nodiscard]] static io_error at_byte(const std::string& file, std::size_t byte, const std::string& what) {
        io_error result(file, what, file + ": byte " + std::to_string(byte) + ": " + what);
        result.byte_ = byte;
        return result;
    }

    /// The file's name, as the caller gave it.
    [[nodiscard]] const std::string& file() const noexcept { return file_; }
    /// The line, if the error concerns one.
    [[nodiscard]] std::optional<std::size_t> line() const noexcept { return line_; }
    /// The byte, if the error concerns one.
    [[nodiscard]] std::optional<std::size_t> byte() const noexcept { return byte_; }

private:
    io_error(const std::string& file, const std::string&, const std::string& message) : error(message), file_(file) {}

    std::string file_;
    std::optional<std::size_t> line_;
    std::optional<std::size_t> byte_;
};

}  // namespace abut
