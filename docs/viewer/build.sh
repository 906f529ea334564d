#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh docs/viewer/build.sh
#
# Makes build/viewer/viewer.html with what is installed: node and npm, whose packages come from package-lock.json; and clang
# with wasm-ld and a libc++ for WebAssembly, without which the page has no special cases. cmake/view.sh installs these.
# The exit status is 77 where there is no node or npm, or npm cannot have the packages.
set -eu
cd "$(dirname "$0")/../.."
out=build/viewer
mkdir -p "$out"

skip() { printf 'viewer: %s\n' "$*"; exit 77; }
command -v node >/dev/null 2>&1 || skip 'there is no node'
command -v npm >/dev/null 2>&1 || skip 'there is no npm'

# --- what npm brings ----------------------------------------------------------------------------------------------------

if ! cmp -s docs/viewer/package-lock.json "$out/installed-lock.json" || [ ! -d "$out/node_modules/three" ]; then
    cp docs/viewer/package.json docs/viewer/package-lock.json "$out"
    (cd "$out" && npm ci --no-audit --no-fund --ignore-scripts >npm.log 2>&1) || { cat "$out/npm.log"; skip 'npm cannot have the packages'; }
    cp docs/viewer/package-lock.json "$out/installed-lock.json"
fi

# --- the library's predicate in WebAssembly ------------------------------------------------------------------------------

# Debian's names: one that is called clang++, or the newest with a number.
clang=''
for name in clang++ clang++-20 clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14; do
    if command -v "$name" >/dev/null 2>&1; then clang=$name; break; fi
done
boost=''
for folder in /usr/include /usr/local/include; do
    if [ -d "$folder/boost/multiprecision" ]; then boost=$folder/boost; break; fi
done
wasm=$out/predicate.wasm
newer=''
if [ -f "$wasm" ]; then
    newer=$(find include/abut/arithmetic include/abut/narrow include/abut/predicate include/abut/shape include/abut/config.hpp \
        tests/predicate docs/viewer/predicate.cpp docs/viewer/build.sh -newer "$wasm" -type f | head -n 1)
fi
if [ -z "$clang" ] || [ -z "$boost" ]; then
    printf 'viewer: no special cases: there is no clang++ or no Boost\n'
    rm -f "$wasm"
elif [ ! -f "$wasm" ] || [ -n "$newer" ]; then
    mkdir -p "$out/include"
    ln -sfn "$boost" "$out/include/boost"  # alone: what else is beside it is not for WebAssembly
    rm -f "$wasm"
    # Exceptions are compiled, so that headers that throw can be; what throws ends the module (predicate.cpp).
    "$clang" --target=wasm32-wasi -mexec-model=reactor -std=c++20 -O2 -fexceptions -fno-rtti -Wl,--strip-all -Iinclude -Itests \
        -isystem "$out/include" -isystem /usr/include/wasm32-wasi/c++/v1 -o "$wasm" docs/viewer/predicate.cpp >"$out/wasm.log" 2>&1 ||
        { head -n 3 "$out/wasm.log"; printf 'viewer: no special cases: %s cannot compile for WebAssembly\n' "$clang"; rm -f "$wasm"; }
fi

node docs/viewer/build.mjs "$out"
