// SPDX-License-Identifier: MIT
#pragma once

// Adds the abut::cuda policy. For .cu files compiled by nvcc 13 or newer with -std=c++20; needs no other flag.

#include <abut/abut.hpp>
#include <abut/execution/cuda_ordered.hpp>
#include <abut/execution/cuda_verbs.hpp>
