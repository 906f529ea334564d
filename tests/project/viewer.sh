#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh viewer.sh [PROGRAM]
#
# Builds the page of docs/viewer and tests it: its types, its reader alone, and the page in a real browser. PROGRAM is the
# example mesh_vs_mesh, whose scene is then read and shown too, as are those of docs/viewer/gallery.cpp. Where node, npm or chromium is missing it is skipped, or fails if
# ABUT_REQUIRE names viewer. Nothing is installed but npm's packages, into build/viewer.
set -eu
cd "$(dirname "$0")/../.."

skip() {
    case " ${ABUT_REQUIRE:-} " in
        *' viewer '*) printf 'ABUT_REQUIRE asks for the viewer: %s\n' "$*" >&2; exit 1 ;;
    esac
    printf 'abut skips: %s\n' "$*"
    exit 0
}

chromium=''
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then chromium=$(command -v "$name"); break; fi
done
if [ -z "$chromium" ]; then skip 'there is no chromium'; fi
if sh docs/viewer/build.sh; then :; else
    status=$?
    if [ $status = 77 ]; then skip 'no page can be built here'; fi
    exit $status
fi
if [ ! -s build/viewer/predicate.wasm ]; then skip 'nothing here compiles for WebAssembly'; fi

ABUT_VIEWER=$(pwd)/build/viewer
ABUT_CHROMIUM=$chromium
export ABUT_VIEWER ABUT_CHROMIUM
if [ $# -gt 0 ]; then
    ABUT_SCENE=$ABUT_VIEWER/test_scene.glb
    export ABUT_SCENE
    "$1" --no-output --view "$ABUT_SCENE" >/dev/null
fi
ABUT_GALLERY=$ABUT_VIEWER/test_gallery
export ABUT_GALLERY
mkdir -p "$ABUT_GALLERY"
"${CXX:-c++}" -std=c++20 -O0 -Iinclude docs/viewer/gallery.cpp -o "$ABUT_GALLERY/gallery"
"$ABUT_GALLERY/gallery" "$ABUT_GALLERY"
node build/viewer/node_modules/typescript/bin/tsc -p docs/viewer
node --test --test-concurrency=1 tests/project/viewer/read.test.mjs tests/project/viewer/page.test.mjs
