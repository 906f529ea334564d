// SPDX-License-Identifier: MIT
#pragma once

// Whole files into memory, and checked output through one buffer.

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <abut/config.hpp>
#include <abut/io/error.hpp>

namespace abut::io::detail {

struct close_file {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using file_handle = std::unique_ptr<std::FILE, close_file>;

[[noreturn]] inline void fail_with_errno(const std::string& file, const std::string& what, int code) {
    throw io_error(file, what + ": " + std::generic_category().message(code));
}

/// The bytes of a file, regular or not (a pipe is read to its end). Throws io_error if it cannot be opened or read.
inline std::vector<char> read_file(const std::filesystem::path& path) {
    const std::string name = path.string();
    errno = 0;
    const file_handle file(std::fopen(name.c_str(), "rb"));
    if (!file) fail_with_errno(name, "cannot be opened", errno);
    std::error_code ignored;
    const auto known = std::filesystem::file_size(path, ignored);
    constexpr std::size_t least = 1 << 16;
    if (!ignored && known >= std::numeric_limits<std::ptrdiff_t>::max()) fail_with_errno(name, "cannot be read", EFBIG);
    // The size is a hint. One byte more than it, so that the end of the file shows at the first read.
    std::vector<char> bytes(ignored ? least : static_cast<std::size_t>(known) + 1);
    std::size_t used = 0;
    for (;;) {
        used += std::fread(bytes.data() + used, 1, bytes.size() - used, file.get());
        if (std::ferror(file.get())) fail_with_errno(name, "cannot be read", errno);
        if (used < bytes.size()) break;
        bytes.resize(std::max(least, 2 * bytes.size()));
    }
    bytes.resize(used);
    return bytes;
}

/// A file that is being written. Everything goes through one buffer, and every failure, a full disk included, is an
/// io_error; `close()` has to be called, since only then is it known that all was written.
class output_file {
public:
    explicit output_file(const std::filesystem::path& path) : name_(path.string()), buffer_(std::size_t{1} << 20) {
        errno = 0;
        file_.reset(std::fopen(name_.c_str(), "wb"));
        if (!file_) fail_with_errno(name_, "cannot be written", errno);
        std::setvbuf(file_.get(), nullptr, _IONBF, 0);
    }

    void write(const void* data, std::size_t size) {
        const char* from = static_cast<const char*>(data);
        while (size > 0) {
            if (used_ == buffer_.size()) flush();
            const std::size_t part = std::min(size, buffer_.size() - used_);
            std::memcpy(buffer_.data() + used_, from, part);
            used_ += part;
            from += part;
            size -= part;
        }
    }
    void write(std::string_view text) { write(text.data(), text.size()); }
    void write(char c) {
        if (used_ == buffer_.size()) flush();
        buffer_[used_++] = c;
    }
    void write_decimal(std::integral auto value) {
        constexpr std::size_t longest = 24;
        if (buffer_.size() - used_ < longest) flush();
        used_ = static_cast<std::size_t>(std::to_chars(buffer_.data() + used_, buffer_.data() + buffer_.size(), value).ptr -
                                         buffer_.data());
    }

    void close() {
        flush();
        errno = 0;
        if (std::fclose(file_.release()) != 0) fail_with_errno(name_, "cannot be written", errno);
    }

private:
    void flush() {
        errno = 0;
        if (std::fwrite(buffer_.data(), 1, used_, file_.get()) != used_) fail_with_errno(name_, "cannot be written", errno);
        used_ = 0;
    }

    std::string name_;
    file_handle file_;
    std::vector<char> buffer_;
    std::size_t used_ = 0;
};

}  // namespace abut::io::detail
