// SPDX-License-Identifier: MIT
#pragma once

// Boxes around shapes. Each is in the file of its shape; what boxes are asked is in aabb.hpp.

#include <abut/shape/aabb.hpp>
#include <abut/shape/primitive.hpp>
