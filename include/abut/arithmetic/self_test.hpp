// SPDX-License-Identifier: MIT
#pragma once

// What macros do not show, looked for at run time: flush-to-zero and denormals-are-zero modes (some libraries switch them on
// when they are loaded; nvcc's -use_fast_math compiles them in), a rounding mode other than to nearest, and arithmetic that
// breaks error-free transforms. Decisions (`intersects` with `filtered` or `exact`) and culling are right under all of
// these; what depends on them are the transforms of error_free.hpp. And a compiler may take no number for NaN: then what is
// not finite is let in.

#include <cstdint>

#include <abut/arithmetic/error_free.hpp>

namespace abut {

/// What of IEEE arithmetic is in force on the calling thread.
struct arithmetic_report {
    bool gradual_underflow;   ///< denormal results are kept
    bool denormal_inputs;     ///< denormal operands are read as what they are
    bool round_to_nearest;    ///< ties to even
    bool error_free;          ///< transforms return exact errors although their inputs could be contracted
    bool infinities_and_nan;  ///< neither is taken for a finite number

    /// Whether all of it is.
    [[nodiscard]] ABUT_HD constexpr bool passed() const {
        return gradual_underflow && denormal_inputs && round_to_nearest && error_free && infinities_and_nan;
    }
};

namespace detail {

/// A value that the compiler has to fetch at run time, so that no test is decided when it is compiled.
template <scalar T>
ABUT_HD inline T at_run_time(T x) {
    volatile T hidden = x;
    return hidden;
}

/// two_prod as an object.
struct two_prod_of {
    template <scalar T>
    ABUT_HD error_free<T> operator()(T a, T b) const {
        return two_prod(a, b);
    }
};

/// Whether `product`, which is to be two_prod, is right about many numbers whose products have all digits: a library's fma
/// may round twice, which one product in five or twenty shows. Factors are integers, and the check is theirs, modulo 2^64.
template <scalar T, class Product>
ABUT_HD inline bool products_are_right(const Product& product) {
    constexpr int digits = float_format<T>::digits;
    bool right = true;
    std::uint64_t state = 1;
    const auto draw = [&state] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return state >> (64 - digits) | std::uint64_t{1} << (digits - 1) | 1;
    };
    ABUT_ROLLED
    for (int i = 0; i < 200; ++i) {
        const std::uint64_t a = draw(), b = draw();
        const error_free<T> p = product(at_run_time(static_cast<T>(a)), at_run_time(static_cast<T>(b)));
        const binary_parts value = take_apart(p.value);
        const double size = static_cast<double>(absolute(p.error));
        right = right && value.exponent > 0 && value.exponent < 64 &&
                size <= static_cast<double>(std::uint64_t{1} << (value.exponent - 1));
        if (!right) break;
        const auto error = static_cast<std::uint64_t>(static_cast<std::int64_t>(p.error));
        right = a * b == (static_cast<std::uint64_t>(value.mantissa) << value.exponent) + error;
    }
    return right;
}

template <scalar T>
ABUT_HD inline arithmetic_report self_test_of(T smallest_normal, T ulp) {
    using word = typename float_format<T>::word;
    const T normal = at_run_time(smallest_normal), half = at_run_time(T(0.5)), one = at_run_time(T(1));
    const T denormal = at_run_time(ABUT_BIT_CAST(T, word{1})), tie = at_run_time(ulp / 2);
    arithmetic_report r{};
    r.gradual_underflow = ABUT_BIT_CAST(word, at_run_time(normal * half)) != 0;
    r.denormal_inputs = denormal > 0 && static_cast<double>(denormal) > 0;
    const T up = at_run_time(one + tie), down = at_run_time(-one - tie), past = at_run_time(one + T(1.5) * tie);
    r.round_to_nearest = up == one && down == -one && past == one + ulp;
    // x * x is 1 + 2 e + e^2, with e = 1025 ulp, and rounds to 1 + 2 e; a sum that swallows the product sees e^2 too.
    // Two copies of x, since a product that is used elsewhere too is not contracted.
    const T e = at_run_time(1025 * ulp), x = at_run_time(one + e), y = at_run_time(one + e);
    const error_free<T> sum = two_sum(x * x, -one), product = two_prod(y, y);
    r.error_free = sum.value == 2 * e && sum.error == 0 && product.value == one + 2 * e && product.error == e * e &&
                   products_are_right<T>(two_prod_of{});
    // As what is checked of coordinates.
    const T infinite = at_run_time(infinity<T>),
            nan = at_run_time(ABUT_BIT_CAST(T, static_cast<word>(static_cast<word>(-1) >> 1)));
    r.infinities_and_nan = !is_finite(infinite) && !is_finite(-infinite) && !is_finite(nan) && !(nan == nan) && !(nan < one);
    return r;
}

}  // namespace detail

/// Runs the checks for float and double, on the calling thread of the host or of a kernel. Takes a few microseconds,
/// allocates nothing, and throws nothing.
ABUT_HD inline arithmetic_report self_test() {
    const arithmetic_report f = detail::self_test_of<float>(0x1p-126f, 0x1p-23f);
    const arithmetic_report d = detail::self_test_of<double>(0x1p-1022, 0x1p-52);
    return {f.gradual_underflow && d.gradual_underflow, f.denormal_inputs && d.denormal_inputs,
            f.round_to_nearest && d.round_to_nearest, f.error_free && d.error_free,
            f.infinities_and_nan && d.infinities_and_nan};
}

}  // namespace abut
