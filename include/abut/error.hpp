// SPDX-License-Identifier: MIT
#pragma once

// What abut throws. Running out of memory, on the host or on a device, is `std::bad_alloc`; `cuda_error` lives with the
// CUDA policy (execution/cuda.hpp), since nothing else needs the CUDA headers.

#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace abut {

/// @defgroup errors Errors
///
/// What the library throws, all derived from `abut::error`, beside `std::bad_alloc`.
///@{

/// Base of all exceptions of the library.
class error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Input that is no geometry: a coordinate that is not finite, a negative radius, a face index out of range.
/// The message reads `function: element index: problem (value)`, as in `abut::mesh: vertex 17: z is not finite (nan)`.
class invalid_geometry : public error {
public:
    /// The message is made of these, as above.
    invalid_geometry(const std::string& function, const std::string& element, std::size_t index, const std::string& problem,
                     double value);

    /// The public function that refused the input.
    [[nodiscard]] const std::string& function() const noexcept { return function_; }
    /// Index of the first bad element (a vertex, face, triangle or sphere, as the message says).
    [[nodiscard]] std::size_t index() const noexcept { return index_; }
    /// The offending value: a coordinate, a radius, or a face's vertex index.
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    std::string function_;
    std::size_t index_;
    double value_;
};

/// A set or a result larger than its index type can number, or larger than a cap that the caller set.
class capacity_error : public error {
public:
    using error::error;
};

namespace detail {

/// What an error names, by a function that is called only where there is one: lists have a name for each entry.
template <class Make>
struct name_when_needed {
    const Make& make;
    operator std::string() const { return make(); }  // NOLINT
};
template <class Make>
name_when_needed(const Make&) -> name_when_needed<Make>;

inline std::string shortest(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

}  // namespace detail

inline invalid_geometry::invalid_geometry(const std::string& function, const std::string& element, std::size_t index,
                                          const std::string& problem, double value)
    : error(function + ": " + element + " " + std::to_string(index) + ": " + problem + " (" + detail::shortest(value) + ")"),
      function_(function),
      index_(index),
      value_(value) {}

///@}

}  // namespace abut
