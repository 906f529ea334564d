// SPDX-License-Identifier: MIT
#pragma once

// Version and the library's macros. There are few: every other header is written in plain C++20, and the code that runs
// on a device is the code that runs on the host. What g++ and clang add to C++ has a name here, and a second way without it.

#define ABUT_VERSION_MAJOR 0
#define ABUT_VERSION_MINOR 2
#define ABUT_VERSION_PATCH 0

// Every header includes this one before it needs C++20. There is no file of the name below: its absence stops the compiler
// right here. It would go on after the #error alone, and print thousands of lines.
#if (!defined(_MSVC_LANG) && __cplusplus < 202002L) || (defined(_MSVC_LANG) && _MSVC_LANG < 202002L)
#error abut needs C++20 or newer: compile with -std=c++20 (in CMake, linking abut::abut asks for it)
#include <abut/stopped_by_the_error_above>
#endif

#if !defined(__cpp_exceptions) && !defined(_CPPUNWIND)
#error abut reports errors by exceptions: compile without -fno-exceptions
#include <abut/stopped_by_the_error_above>
#endif

// ABUT_HD marks a function that may run on the host and on a CUDA device. Such functions call no `constexpr` function of
// the standard library, so that nobody's build needs `--expt-relaxed-constexpr`.
// ABUT_DEVICE marks one that nvcc compiles for a device alone.
// ABUT_DEVICE_CODE is 1 while a compiler makes code for a device.
// ABUT_NOINLINE keeps rarely run code with a large stack frame out of its callers.
#if defined(__CUDACC__)
#define ABUT_HD __host__ __device__
#define ABUT_DEVICE __device__
#else
#define ABUT_HD
#define ABUT_DEVICE
#endif

// ABUT_CALLS_ANY stands before a template that calls what it is given (a filter, a visitor, a queue): on the host that may
// be a plain host function, which nvcc would warn of in code that could run on a device as well. On a device nothing would
// be left of such a call, so what a user gives has to pass the verb require_callable first (execution/policy.hpp).
#if defined(__CUDACC__)
#define ABUT_CALLS_ANY _Pragma("nv_exec_check_disable")
#else
#define ABUT_CALLS_ANY
#endif

#if defined(__CUDA_ARCH__)
#define ABUT_DEVICE_CODE 1
#else
#define ABUT_DEVICE_CODE 0
#endif

// ABUT_ROLLED stands before a loop that nvcc is not to unroll in a kernel: a turn of it is thousands of instructions that
// are rarely run, and each takes time to compile.
#if ABUT_DEVICE_CODE
#define ABUT_ROLLED _Pragma("unroll 1")
#else
#define ABUT_ROLLED
#endif

// ABUT_GNU is 1 where what g++ and clang add to C++ is used, as nvcc does with one of them. Elsewhere each name below has a
// second way in plain C++, with the same answers to the bit. Whoever defines ABUT_PORTABLE gets the second ways anywhere.
#if (defined(__GNUC__) || defined(__clang__)) && !defined(ABUT_PORTABLE)
#define ABUT_GNU 1
#else
#define ABUT_GNU 0
#endif

#if defined(__CUDACC__)
#define ABUT_NOINLINE __noinline__
#define ABUT_INLINE inline
#elif ABUT_GNU
#define ABUT_NOINLINE [[gnu::noinline]]
#define ABUT_INLINE [[gnu::always_inline]] inline
#elif defined(_MSC_VER)
#define ABUT_NOINLINE __declspec(noinline)
#define ABUT_INLINE __forceinline
#else
#define ABUT_NOINLINE
#define ABUT_INLINE inline
#endif

// ABUT_BIT_CAST(T, x) and ABUT_CONSTANT_EVALUATED() are std::bit_cast and std::is_constant_evaluated, which nvcc calls in no
// code for a device. MSVC has these builtins too.
#if defined(ABUT_PORTABLE) && !defined(__CUDACC__)
#include <bit>
#include <type_traits>
#define ABUT_BIT_CAST(T, ...) std::bit_cast<T>(__VA_ARGS__)
#define ABUT_CONSTANT_EVALUATED() std::is_constant_evaluated()
#else
#define ABUT_BIT_CAST(T, ...) __builtin_bit_cast(T, __VA_ARGS__)
#define ABUT_CONSTANT_EVALUATED() __builtin_is_constant_evaluated()
#endif

// ABUT_INT128 is 1 where integers of 128 bits are a type of the compiler's. 32-bit processors have none.
#if ABUT_GNU && defined(__SIZEOF_INT128__)
#define ABUT_INT128 1
#else
#define ABUT_INT128 0
#endif

// ABUT_VECTORS is 1 where registers of several numbers are. nvcc allows none in functions that may run on a device.
// ABUT_VECTOR_OF(T) is one of 16 bytes.
#if ABUT_GNU && defined(__GNUC__) && !defined(__CUDACC__)
#define ABUT_VECTORS 1
#define ABUT_VECTOR_OF(T) T __attribute__((vector_size(16)))
#else
#define ABUT_VECTORS 0
#endif

// On a host:
// ABUT_HIDE(x) is where the compiler cannot look behind the number or register x, rounded.
// ABUT_REREAD(object) is where it has to take the object for written, so that it reads it from memory.
// ABUT_REREAD_ALL(address) is the same of all memory, through types of any kind.
// ABUT_PREFETCH(address) asks for memory that will be read. It may be any address.
// ABUT_TRAP() ends the program.
// ABUT_LOWEST_BIT(x) is the number of the lowest bit of an unsigned x that is not 0.
// ABUT_ASSUME_ALIGNED(address, bytes) is the address.
// ABUT_FABS and ABUT_FABSF are |x|, in constant expressions too.
#if ABUT_GNU
#if defined(__SSE2__)
#define ABUT_HIDE(x) __asm__("" : "+x"(x))
#elif defined(__aarch64__)
#define ABUT_HIDE(x) __asm__("" : "+w"(x))
#else
#define ABUT_HIDE(x) __asm__("" : "+m"(x))
#endif
#define ABUT_REREAD(object) __asm__("" : "+m"(object))
#define ABUT_REREAD_ALL(address) __asm__ volatile("" : : "g"(address) : "memory")
#define ABUT_PREFETCH(address) __builtin_prefetch(address)
#define ABUT_TRAP() __builtin_trap()
#define ABUT_LOWEST_BIT(x) __builtin_ctz(x)
#define ABUT_ASSUME_ALIGNED(address, bytes) __builtin_assume_aligned(address, bytes)
#define ABUT_FABS(x) __builtin_fabs(x)
#define ABUT_FABSF(x) __builtin_fabsf(x)
#else
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstdlib>
#define ABUT_HIDE(x) ::abut::detail::through_memory(x)
#define ABUT_REREAD(object) ::abut::detail::shown_to_others(&(object))
#define ABUT_REREAD_ALL(address) ::abut::detail::shown_to_others(address)
#define ABUT_PREFETCH(address) static_cast<void>(address)
#define ABUT_TRAP() std::abort()
#define ABUT_LOWEST_BIT(x) std::countr_zero(x)
#define ABUT_ASSUME_ALIGNED(address, bytes) (address)
#define ABUT_FABS(x) ABUT_BIT_CAST(double, ABUT_BIT_CAST(std::uint64_t, x) & ~(std::uint64_t{1} << 63))
#define ABUT_FABSF(x) ABUT_BIT_CAST(float, ABUT_BIT_CAST(std::uint32_t, x) & ~(std::uint32_t{1} << 31))
namespace abut::detail {
template <class T>
inline void through_memory(T& x) {
    volatile T hidden = x;
    x = hidden;
}
template <class T>
inline void shown_to_others(T* object) {
    // What is read through a pointer that may have changed, and after a signal's handler, is read from memory.
    T* volatile hidden = object;
    static_cast<void>(hidden);
    std::atomic_signal_fence(std::memory_order_seq_cst);
}
}  // namespace abut::detail
#endif

// ABUT_FMA_IS_RIGHT is 1 where std::fma is one rounding. On Windows it is so where it is an instruction: the function of
// mingw-w64 rounds twice. g++ calls the function where it does not optimise.
#if !ABUT_DEVICE_CODE && (defined(ABUT_PORTABLE) || (defined(_WIN32) && !(defined(__FMA__) && defined(__OPTIMIZE__))))
#define ABUT_FMA_IS_RIGHT 0
#else
#define ABUT_FMA_IS_RIGHT 1
#endif

// ABUT_CUDA_VERBS_COMPILED is 1 in programs that link the target abut::cuda_verbs, which defines it: sorts, scans and selections
// on a device are compiled there once.
#if !defined(ABUT_CUDA_VERBS_COMPILED)
#define ABUT_CUDA_VERBS_COMPILED 0
#endif

// ABUT_ALLOW_UNTESTED_NVCC, defined as 1 by who compiles with nvcc 12, lets abut/cuda.hpp go on there. The first call on a device
// in a process then runs a self-test on it, and throws abut::error where the device decides a known pair wrongly.
#if !defined(ABUT_ALLOW_UNTESTED_NVCC)
#define ABUT_ALLOW_UNTESTED_NVCC 0
#endif
