#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/view.sh [--gallery | SCENE.glb...]
#
# Installs what is missing from the distribution's packages (Debian 12, Ubuntu 24.04 or newer) and from npm, makes the page of
# docs/viewer, build/viewer/viewer.html, and builds two examples. They write scenes into it: two meshes with their contacts, and
# a cloth that falls on a ball. Each is one HTML file that a browser opens from the disk. Last, a picture is taken of each, where
# chromium is there, and all paths are printed. One page, index.html, leads to all scenes.
# With --gallery it builds all examples, and docs/viewer/gallery.cpp: scenes of all that the demo runs, of solids, sweeps and a safe step.
# With names of files it puts these scenes into the page instead, and builds no example.
# ABUT_MESH names the mesh of the pair; by default a real one in ../shared/data, if that is there, or else two tori.
set -eu
caller=$(pwd)
cd "$(dirname "$0")/.."
. cmake/common.sh

gallery=no
if [ "${1:-}" = --gallery ]; then gallery=yes; shift; fi
for scene in "$@"; do (cd "$caller" && [ -r "$scene" ]) || fail "$scene: cannot be read"; done

# shellcheck disable=SC2086
want_packages $viewer_packages
sh docs/viewer/build.sh || fail 'there is no page without node, npm and its packages'
page=$(pwd)/build/viewer/viewer.html
out=$(pwd)/build/viewer/scenes
mkdir -p "$out"

chromium=''
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then chromium=$(command -v "$name"); break; fi
done
pages=''
if [ $# -gt 0 ]; then
    for scene in "$@"; do
        name=$(basename "$scene" .glb)
        (cd "$caller" && node "$out/../../../docs/viewer/embed.mjs" "$page" "$scene" "$out/$name.html")
        pages="$pages $name"
    done
else
    need_packages g++ cmake ninja-build libcli11-dev
    programs='mesh_vs_mesh cloth_ccd'
    if [ $gallery = yes ]; then programs="$programs spheres_vs_mesh triangle_vs_many clash"; fi
    say "building in build/view: $programs"
    # -Og: what they do here is soon done, and compiling takes longer.
    cmake --preset default -B build/view -DABUT_TESTS=OFF -DABUT_BENCH=OFF -DABUT_WERROR=OFF -DABUT_CUDA=OFF \
        -DABUT_QUICK_EXAMPLES=ON >build/view.log 2>&1 ||
        { cat build/view.log; fail 'configuring failed'; }
    # shellcheck disable=SC2086
    cmake --build build/view --parallel "$jobs" --target $programs

    mesh=${ABUT_MESH:-../shared/data/meshes/armadillo_27674.ply}
    say 'scenes'
    if [ -n "${ABUT_MESH:-}" ] || [ -r "$mesh" ]; then
        build/view/docs/examples/mesh_vs_mesh "$mesh" --pose 0 1 0 35 0.6 0.05 0.1 --no-output --view "$out/mesh_pair.html" >"$out/mesh_pair.txt"
    else
        printf 'there is no %s: the pair is two tori\n' "$mesh"
        build/view/docs/examples/mesh_vs_mesh --no-output --view "$out/mesh_pair.html" >"$out/mesh_pair.txt"
    fi
    build/view/docs/examples/cloth_ccd --no-output --view "$out/cloth.html" >"$out/cloth.txt"
    pages='mesh_pair cloth'
    if [ $gallery = yes ]; then
        build/view/docs/examples/spheres_vs_mesh --no-output --view "$out/spheres.html" >"$out/spheres.txt"
        build/view/docs/examples/triangle_vs_many --no-output --view "$out/triangle.html" >"$out/triangle.txt"
        build/view/docs/examples/clash --no-output --view "$out/clash.html" >"$out/clash.txt"
        "${CXX:-g++}" -std=c++20 -O1 -Iinclude docs/viewer/gallery.cpp -o build/view/gallery
        build/view/gallery "$out"
        pages="$pages spheres triangle clash"
        for name in rings patches sweeps safe_step; do
            node docs/viewer/embed.mjs "$page" "$out/$name.glb" "$out/$name.html"
            pages="$pages $name"
        done
    fi
fi

for name in $pages; do
    [ -s "$out/$name.html" ] || fail "$out/$name.html was not written"
    rm -f "$out/$name.png" "$out/$name-small.png"
    if [ -n "$chromium" ]; then
        node docs/viewer/shoot.mjs build/viewer "$chromium" "$out/$name.html" "$out/$name.png"
        node docs/viewer/shoot.mjs build/viewer "$chromium" "$out/$name.html" "$out/$name-small.png" light 560x380 @canvas
    fi
done
# shellcheck disable=SC2086
node docs/viewer/gallery.mjs "$out" $pages

say 'done; the page that leads to all scenes'
printf '  %s\n' "$out/index.html"
say 'pages to open in a browser, and pictures of them'
for name in $pages; do
    printf '  %s\n' "$out/$name.html"
    if [ -n "$chromium" ]; then printf '  %s\n' "$out/$name.png"; fi
done
[ -n "$chromium" ] || printf 'there are no pictures: there is no chromium\n'
