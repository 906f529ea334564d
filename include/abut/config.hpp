// SPDX-License-Identifier: MIT
#pragma once

// Version and the library's macros. There are few: every other header is written in plain C++20, and the code that runs
// on a device is the code that runs on the host.

#define ABUT_VERSION_MAJOR 0
#define ABUT_VERSION_MINOR 1
#define ABUT_VERSION_PATCH 0

// Every header includes this one before it needs C++20. There is no file of the name below: its absence stops the compiler
// right here. It would go on after the #error alone, and print thousands of lines.
#if __cplusplus < 202002L
#error abut needs C++20 or newer: compile with -std=c++20 (in CMake, linking abut::abut asks for it)
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

#if defined(__CUDACC__)
#define ABUT_NOINLINE __noinline__
#define ABUT_INLINE inline
#else
#define ABUT_NOINLINE [[gnu::noinline]]
#define ABUT_INLINE [[gnu::always_inline]] inline
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
