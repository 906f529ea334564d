#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh viewer.sh [PROGRAM]
#
# Builds the page of docs/viewer and tests it: its types, its reader alone, and the page in a real browser. PROGRAM is the
# example mesh_vs_mesh, whose scene is then read and shown too. Where node, npm or chromium is missing it is skipped. Nothing is
# installed but npm's packages, into build/viewer.
set -eu
cd "$(dirname "$0")/../.."

chromium=''
for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null 2>&1; then chromium=$(command -v "$name"); break; fi
done
if [ -z "$chromium" ]; then printf 'abut skips: there is no chromium\n'; exit 0; fi
if sh docs/viewer/build.sh; then :; else
    status=$?
    if [ $status = 77 ]; then printf 'abut skips: no page can be built here\n'; exit 0; fi
    exit $status
fi
if [ ! -s build/viewer/predicate.wasm ]; then printf 'abut skips: nothing here compiles for WebAssembly\n'; exit 0; fi

ABUT_VIEWER=$(pwd)/build/viewer
ABUT_CHROMIUM=$chromium
export ABUT_VIEWER ABUT_CHROMIUM
if [ $# -gt 0 ]; then
    ABUT_SCENE=$ABUT_VIEWER/test_scene.glb
    export ABUT_SCENE
    "$1" --no-output --view "$ABUT_SCENE" >/dev/null
fi
node build/viewer/node_modules/typescript/bin/tsc -p docs/viewer
node --test --test-concurrency=1 tests/project/viewer/read.test.mjs tests/project/viewer/page.test.mjs
