#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/demo.sh [arguments of spheres_vs_mesh]
#
# Installs what is missing from the distribution's packages (Debian 12, Ubuntu 24.04 or newer), builds
# docs/examples/spheres_vs_mesh, and runs it: on its embedded scene if no arguments are given, with OpenMP, and with CUDA
# too where nvcc 13.0 or newer and a device are present. Without arguments it runs docs/examples/triangle_vs_many as well.
# ABUT_REQUIRE_CUDA=1 fails where nvcc is not.
set -eu
cd "$(dirname "$0")/.."
. cmake/common.sh

need_packages g++ cmake ninja-build libtinyobjloader-dev libcli11-dev
find_nvcc

say 'building docs/examples/spheres_vs_mesh and triangle_vs_many in build/demo'
mkdir -p build
cuda=OFF
targets='spheres_vs_mesh triangle_vs_many'
if [ -n "$nvcc" ]; then
    cuda=ON
    targets="$targets spheres_vs_mesh_cuda triangle_vs_many_cuda"
fi
cmake --preset default -B build/demo -DABUT_TESTS=OFF -DABUT_BENCH=OFF -DABUT_WERROR=OFF -DABUT_CUDA=$cuda >build/demo.log 2>&1 ||
    { cat build/demo.log; fail 'configuring failed'; }
# shellcheck disable=SC2086
cmake --build build/demo --parallel "$jobs" --target $targets

run() {
    say "running $*"
    "$@"
}
mkdir -p build/demo/out
cd build/demo/out
run ../docs/examples/spheres_vs_mesh --policy openmp "$@"
if cuda_device_present && [ -x ../docs/examples/spheres_vs_mesh_cuda ]; then
    run ../docs/examples/spheres_vs_mesh_cuda --policy cuda "$@"
fi
if [ $# = 0 ]; then
    if cuda_device_present; then
        run ../docs/examples/triangle_vs_many_cuda
    else
        run ../docs/examples/triangle_vs_many
    fi
fi
say "done; files written are in $(pwd)"
