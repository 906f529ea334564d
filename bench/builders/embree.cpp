// SPDX-License-Identifier: MIT
//
// The peer: builds of Embree's, as bench_meshes has them.

#include "../meshes/embree.cpp"
