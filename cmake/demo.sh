#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/demo.sh [arguments of spheres_vs_mesh]
#
# Installs what is missing from the distribution's packages (Debian 12, Ubuntu 24.04 or newer), builds the programs of
# docs/examples and runs them on their embedded scenes: spheres against a mesh, one triangle against many, mesh against
# mesh, a cloth that falls on a ball. Where nvcc 13.0 or newer and a device are present it runs them there too. At last it
# lists the files to look at; cmake/view.sh --gallery makes pages of them for a browser.
# With arguments it builds and runs spheres_vs_mesh alone. ABUT_REQUIRE_CUDA=1 fails where nvcc is not.
set -eu
cd "$(dirname "$0")/.."
. cmake/common.sh

need_packages g++ cmake ninja-build libcli11-dev
find_nvcc
programs='spheres_vs_mesh triangle_vs_many mesh_vs_mesh cloth_ccd'
if [ $# -gt 0 ]; then programs=spheres_vs_mesh; fi
targets=$programs
cuda=OFF
if cuda_device_present; then
    cuda=ON
    for program in $programs; do targets="$targets ${program}_cuda"; done
elif [ -n "$nvcc" ]; then
    say 'CUDA: left out, there is no device'
fi

say "building in build/demo: $targets"
mkdir -p build/demo/out
cmake --preset default -B build/demo -DABUT_TESTS=OFF -DABUT_BENCH=OFF -DABUT_WERROR=OFF -DABUT_CUDA=$cuda >build/demo.log 2>&1 ||
    { cat build/demo.log; fail 'configuring failed'; }
# shellcheck disable=SC2086
cmake --build build/demo --parallel "$jobs" --target $targets
cd build/demo/out

run() {
    program=$1
    shift
    say "$program $*"
    "../docs/examples/$program" "$@"
}
# The same job on the device, whose answers are the same: its files would be too.
run_cuda() {
    if [ $cuda = ON ]; then run "$@" --no-output; fi
}

if [ $# -gt 0 ]; then
    run spheres_vs_mesh "$@"
    run_cuda spheres_vs_mesh_cuda "$@"
    exit 0
fi

run spheres_vs_mesh
run_cuda spheres_vs_mesh_cuda
if [ $cuda = ON ]; then run triangle_vs_many_cuda; else run triangle_vs_many; fi
run mesh_vs_mesh
run_cuda mesh_vs_mesh_cuda
run cloth_ccd --write-every 20
run_cuda cloth_ccd_cuda

say 'done; what to look at, in ParaView (.vtp, .ply), MeshLab or Blender (.ply):'
show() { # show WHAT FILE...
    printf '%s\n' "$1"
    shift
    for file in "$@"; do
        [ -s "$file" ] || fail "$file was not written"
        printf '  %s/%s\n' "$(pwd)" "$file"
    done
}
show 'spheres against a torus: the triangles that are hit, and all pairs' spheres_vs_mesh_hits.ply spheres_vs_mesh_pairs.csv
show 'one triangle against a million: those that are hit' triangle_vs_many.ply
show 'two tori: the triangles that are hit; the contacts as points with normals; the few that stand for them' \
    mesh_vs_mesh_a.vtp mesh_vs_mesh_b.vtp mesh_vs_mesh_contacts.vtp mesh_vs_mesh_reduced.vtp
show 'a cloth on a ball, three frames of it: what was in an impact, and when' \
    cloth_ccd_ball.vtp cloth_ccd_0020.vtp cloth_ccd_0040.vtp cloth_ccd_0060.vtp
