// SPDX-License-Identifier: MIT
#pragma once

// Adds the abut::cuda policy. For .cu files compiled by nvcc 13.0 or newer with -std=c++20; needs no other flag.

#include <abut/config.hpp>

// Why not nvcc 12: answers are exact if the compiler keeps the arithmetic as it is written, and ptxas has been seen to make
// wrong code of these headers (docs/numerics/compilers.md). All tests on devices were made with nvcc 13; older ones were
// never tried. Who has to use nvcc 12 says ABUT_ALLOW_UNTESTED_NVCC (config.hpp).
#if !defined(__CUDACC__) || !defined(__CUDACC_VER_MAJOR__)
#error abut/cuda.hpp is for .cu files that nvcc compiles: include abut/abut.hpp in files for other compilers
#include <abut/stopped_by_the_error_above>
#elif __CUDACC_VER_MAJOR__ < 13 && (!ABUT_ALLOW_UNTESTED_NVCC || __CUDACC_VER_MAJOR__ < 12)
#error abut/cuda.hpp needs nvcc 13.0 or newer: exact answers on a device were tested with no older compiler
#include <abut/stopped_by_the_error_above>
#endif

#include <abut/abut.hpp>
#include <abut/collide/async.hpp>
#include <abut/collide/async_index.hpp>
#include <abut/collide/async_motion.hpp>
#include <abut/collide/async_rows.hpp>
#include <abut/execution/cuda_ordered.hpp>
#include <abut/execution/cuda_verbs.hpp>
#if ABUT_ALLOW_UNTESTED_NVCC
#include <abut/collide/device_self_test.hpp>
#endif
