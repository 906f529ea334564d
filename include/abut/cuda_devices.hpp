// SPDX-License-Identifier: MIT
#pragma once

// Adds abut::cuda_devices: queries on several CUDA devices of one host. For .cu files, as abut/cuda.hpp.

#include <abut/cuda.hpp>

#include <abut/devices/bodies.hpp>
#include <abut/devices/distance.hpp>
#include <abut/devices/impacts.hpp>
#include <abut/devices/query.hpp>
#include <abut/devices/rows.hpp>
#include <abut/devices/solids.hpp>
#include <abut/execution/cuda_devices.hpp>
