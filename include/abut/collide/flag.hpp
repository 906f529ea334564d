// SPDX-License-Identifier: MIT
#pragma once

// A member of options that is true or false, and nothing else that C++ would take for it. A lambda that captures nothing
// becomes a pointer, and a pointer becomes a bool: so braces without a name would drop a filter in silence.

#include <concepts>
#include <type_traits>

#include <abut/config.hpp>

namespace abut {

namespace detail {

/// What becomes a bool as a bool does: bools, integers, and what converts to one of them. Pointers and functions do not.
template <class B>
concept truth_value = std::convertible_to<B, int> && !std::floating_point<B>;

/// What is said of anything else.
template <class B>
consteval void refuse_as_flag() {
    static_assert(sizeof(B) == 0,
                  "abut: this option is true or false: name the one that is meant, as in abut::query_options{.filter = f} or "
                  "{.sorted = false}");
}

}  // namespace detail

/// @addtogroup queries
///@{

/// A bool among options. It is made of bools and integers; anything else does not compile, a filter or a pointer least of
/// all.
///
///     const bool fast = true;
///     const abut::query_options<> options{.sorted = !fast};
///     if (options.sorted) return;
class flag {
public:
    /// False.
    constexpr flag() = default;
    /// Of a bool or an integer.
    template <detail::truth_value B>
    ABUT_HD constexpr flag(B value) : value_(static_cast<bool>(value)) {}
    /// Of nothing else: does not compile.
    template <class B>
        requires(!detail::truth_value<B>)
    ABUT_HD constexpr flag(const B&) {
        detail::refuse_as_flag<B>();
    }

    /// The bool.
    ABUT_HD constexpr operator bool() const { return value_; }

private:
    bool value_ = false;
};

///@}

}  // namespace abut
