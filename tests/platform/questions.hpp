// SPDX-License-Identifier: MIT
#pragma once

// What is asked, by the source that asks: several, so that none takes long to compile or much memory.

#include "tables.hpp"

namespace platform {

void ask_triangles(table&);
void ask_simple(table&);
void ask_hulls(table&);
void ask_revolution(table&);
void ask_revolution_pairs(table&);
void ask_motion(table&);
void ask_rays(table&);
void ask_points(table&);
void ask_meshes(table&);
void ask_bodies(table&);

}  // namespace platform
