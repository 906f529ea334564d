// SPDX-License-Identifier: MIT
#pragma once

// The shapes that scenes are made of, as plain aggregates. All are closed point sets: touching counts as intersecting. Each
// has a file of its own; hulls, oriented boxes and half spaces have theirs beside them.

#include <abut/shape/aabb.hpp>
#include <abut/shape/capsule.hpp>
#include <abut/shape/cone.hpp>
#include <abut/shape/cylinder.hpp>
#include <abut/shape/plane.hpp>
#include <abut/shape/ray.hpp>
#include <abut/shape/segment.hpp>
#include <abut/shape/sphere.hpp>
#include <abut/shape/triangle.hpp>

/// @defgroup shapes Shapes and poses
///
/// The shapes that scenes are made of, as plain values, and the poses that move them. All are closed sets of points:
/// touching counts. Coordinates, radii and offsets are float or double, in a unit of length of the caller's. Functions here
/// allocate nothing and run on hosts and devices, unless they say otherwise.
