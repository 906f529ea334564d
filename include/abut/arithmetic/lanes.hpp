// SPDX-License-Identifier: MIT
#pragma once

// Four numbers at a time, for tests of boxes on a processor: registers of 16 bytes, which all of x86-64 and 64-bit ARM has,
// by the vector extensions of g++ and clang. g++ 12 makes none of them of a plain loop over four comparisons. Other
// compilers, and nvcc, which allows no vectors in functions that may run on a device, get four registers of one number each;
// results are the same, since each lane is computed like a number on its own.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

#if ABUT_VECTORS
template <scalar T>
struct register_of {
    typedef ABUT_VECTOR_OF(T) type;
};
#else
template <scalar T>
struct register_of {
    using type = T;
};
#endif

/// A register as it is, behind which a compiler cannot look.
template <class Register>
ABUT_INLINE ABUT_HD void hide([[maybe_unused]] Register& r) {
#if !ABUT_DEVICE_CODE
    ABUT_HIDE(r);
#endif
}

/// Answers of four comparisons. Two that are joined are hidden from the compiler: g++ 12 at -O1 makes one comparison of two
/// of the same numbers, and then takes the other to be false wherever else it is used.
template <class Answer, int Registers>
struct lane_mask {
    Answer at[std::size_t{Registers}];

    ABUT_INLINE ABUT_HD friend lane_mask operator&(lane_mask a, const lane_mask& b) {
        for (int i = 0; i < Registers; ++i) {
            if constexpr (Registers < 4) hide(a.at[i]);
            a.at[i] = static_cast<Answer>(a.at[i] & b.at[i]);
        }
        return a;
    }
    ABUT_INLINE ABUT_HD friend lane_mask operator!(lane_mask a) {
        for (int i = 0; i < Registers; ++i) a.at[i] = static_cast<Answer>(a.at[i] == 0);
        return a;
    }
    ABUT_INLINE ABUT_HD friend lane_mask operator|(lane_mask a, const lane_mask& b) {
        for (int i = 0; i < Registers; ++i) {
            if constexpr (Registers < 4) hide(a.at[i]);
            a.at[i] = static_cast<Answer>(a.at[i] | b.at[i]);
        }
        return a;
    }
};

/// Numbers k = 0 ... 3. The register is a template parameter so that what two compilers make of it has two names.
template <scalar T, class Register = typename register_of<T>::type>
struct lanes {
    static constexpr int in_register = static_cast<int>(sizeof(Register) / sizeof(T)), registers = 4 / in_register;
    using mask = lane_mask<decltype(Register{} < Register{}), registers>;

    Register at[std::size_t{registers}];

    /// Four numbers that lie one after another.
    ABUT_INLINE ABUT_HD static lanes load(const T* from) {
        lanes r;
        for (int i = 0; i < registers; ++i) std::memcpy(&r.at[i], from + i * in_register, sizeof(Register));
        return r;
    }
    /// The same where the first lies at a multiple of 16 bytes: then x86-64 needs no instruction of its own for it.
    ABUT_INLINE ABUT_HD static lanes load_aligned(const T* from) {
        return load(static_cast<const T*>(ABUT_ASSUME_ALIGNED(from, 16)));
    }
    /// The same number four times. Not by arithmetic, which may flush a denormal number.
    ABUT_INLINE ABUT_HD static lanes all(T x) {
        lanes r;
        for (Register& one : r.at) {
            if constexpr (in_register == 4) {
                one = Register{x, x, x, x};
            } else if constexpr (in_register == 2) {
                one = Register{x, x};
            } else {
                one = x;
            }
        }
        return r;
    }
    /// Four numbers.
    ABUT_INLINE ABUT_HD static lanes of(T a, T b, T c, T d) {
        lanes r;
        if constexpr (in_register == 4) {
            r.at[0] = Register{a, b, c, d};
        } else if constexpr (in_register == 2) {
            r.at[0] = Register{a, b};
            r.at[1] = Register{c, d};
        } else {
            r.at[0] = a, r.at[1] = b, r.at[2] = c, r.at[3] = d;
        }
        return r;
    }

    /// To four numbers that lie one after another.
    ABUT_INLINE ABUT_HD void store(T* to) const {
        for (int i = 0; i < registers; ++i) std::memcpy(to + i * in_register, &at[i], sizeof(Register));
    }

    ABUT_INLINE ABUT_HD friend lanes operator+(lanes a, const lanes& b) {
        for (int i = 0; i < registers; ++i) a.at[i] = a.at[i] + b.at[i];
        return a;
    }
    ABUT_INLINE ABUT_HD friend lanes operator-(lanes a, const lanes& b) {
        for (int i = 0; i < registers; ++i) a.at[i] = a.at[i] - b.at[i];
        return a;
    }
    ABUT_INLINE ABUT_HD friend lanes operator*(lanes a, const lanes& b) {
        for (int i = 0; i < registers; ++i) a.at[i] = a.at[i] * b.at[i];
        return a;
    }
    ABUT_INLINE ABUT_HD friend lanes operator/(lanes a, const lanes& b) {
        for (int i = 0; i < registers; ++i) a.at[i] = a.at[i] / b.at[i];
        return a;
    }
    ABUT_INLINE ABUT_HD friend mask operator>=(const lanes& a, const lanes& b) {
        mask r;
        for (int i = 0; i < registers; ++i) r.at[i] = a.at[i] >= b.at[i];
        return r;
    }
    ABUT_INLINE ABUT_HD friend mask operator<=(const lanes& a, const lanes& b) {
        mask r;
        for (int i = 0; i < registers; ++i) r.at[i] = a.at[i] <= b.at[i];
        return r;
    }
    ABUT_INLINE ABUT_HD friend mask operator>(const lanes& a, const lanes& b) {
        mask r;
        for (int i = 0; i < registers; ++i) r.at[i] = a.at[i] > b.at[i];
        return r;
    }
};

/// Without the sign; that of 0 and of NaN may stay.
template <scalar T, class Register>
ABUT_INLINE ABUT_HD lanes<T, Register> absolute(lanes<T, Register> x) {
    for (Register& r : x.at) r = r > -r ? r : -r;
    return x;
}

/// As they are, hidden: a product in them is not contracted into a sum.
template <scalar T, class Register>
ABUT_INLINE ABUT_HD lanes<T, Register> rounded(lanes<T, Register> x) {
    for (Register& r : x.at) hide(r);
    return x;
}

/// The lesser and the greater of each two numbers: the second of two that do not compare, as of single ones (magnitude.hpp).
///@{
template <scalar T, class Register>
ABUT_INLINE ABUT_HD lanes<T, Register> least(lanes<T, Register> a, const lanes<T, Register>& b) {
    for (int i = 0; i < a.registers; ++i) a.at[i] = a.at[i] < b.at[i] ? a.at[i] : b.at[i];
    return a;
}
template <scalar T, class Register>
ABUT_INLINE ABUT_HD lanes<T, Register> greatest(lanes<T, Register> a, const lanes<T, Register>& b) {
    for (int i = 0; i < a.registers; ++i) a.at[i] = a.at[i] > b.at[i] ? a.at[i] : b.at[i];
    return a;
}
///@}

/// Of each two numbers the first where the answer is yes.
template <scalar T, class Register>
ABUT_INLINE ABUT_HD lanes<T, Register> select(const typename lanes<T, Register>::mask& answer, lanes<T, Register> yes,
                                              const lanes<T, Register>& no) {
    for (int i = 0; i < yes.registers; ++i) yes.at[i] = answer.at[i] ? yes.at[i] : no.at[i];
    return yes;
}

/// Bit 4 r + k is lane k of row r.
template <class Answer, int Registers, std::size_t Rows>
ABUT_INLINE ABUT_HD unsigned bits_of(const lane_mask<Answer, Registers> (&rows)[Rows]) {
    if constexpr (Registers == 4) {
        unsigned bits = 0;
        for (int r = 0; r < int{Rows}; ++r) {
            for (int k = 0; k < 4; ++k) bits |= static_cast<unsigned>(rows[r].at[k] != 0) << (4 * r + k);
        }
        return bits;
#if defined(__SSE2__) && ABUT_VECTORS
    } else if constexpr (Rows == 1) {
        const auto& row = rows[0].at;
        if constexpr (Registers == 1) {
            return static_cast<unsigned>(__builtin_ia32_movmskps(ABUT_BIT_CAST(register_of<float>::type, row[0])));
        } else {
            const int low = __builtin_ia32_movmskpd(ABUT_BIT_CAST(register_of<double>::type, row[0])),
                      high = __builtin_ia32_movmskpd(ABUT_BIT_CAST(register_of<double>::type, row[1]));
            return static_cast<unsigned>(low | high << 2);
        }
#endif
    } else {
        // Each lane keeps its own bit, and then all of them are joined; g++ knows no shorter way to a number than this one.
        constexpr int in_register = 4 / Registers;
        Answer all{};
        for (int r = 0; r < int{Rows}; ++r) {
            for (int i = 0; i < Registers; ++i) {
                Answer own{};
                for (int k = 0; k < in_register; ++k) own[k] = 1 << (4 * r + in_register * i + k);
                all |= rows[r].at[i] & own;
            }
        }
        std::uint64_t half[2];
        std::memcpy(half, &all, sizeof half);
        const std::uint64_t both = half[0] | half[1];
        return static_cast<unsigned>(both | both >> 32);
    }
}

/// The lowest bit of a number that is not 0.
ABUT_INLINE ABUT_HD unsigned lowest_bit(unsigned bits) {
#if ABUT_DEVICE_CODE
    return static_cast<unsigned>(__ffs(static_cast<int>(bits))) - 1;
#else
    return static_cast<unsigned>(ABUT_LOWEST_BIT(bits));
#endif
}

}  // namespace abut::detail
