#!/bin/sh
# SPDX-License-Identifier: MIT
#
# canary.sh COMPILER: compiles canary.cpp twice, with what the compiler adds to C++ and without (ABUT_PORTABLE), and compares
# what the two print: answers are to have the same bits. The compiler is g++ or clang++; others exit 77, skipped.

here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
compiler=$1
case $(basename "$compiler") in
    *g++* | *clang++* | c++*) ;;
    *) echo "skipped: g++ and clang++ are asked" && exit 77 ;;
esac
native=
case $(uname -m) in x86_64 | aarch64) native=-march=native ;; esac
# build NAME FLAGS...
build() {
    name=$1
    shift
    "$compiler" -std=c++20 "$@" -I"$here/../../include" "$here/canary.cpp" -o "$work/$name" &&
        "$work/$name" >"$work/$name.out" || exit 1
}
build usual -O1
build portable -O1 -DABUT_PORTABLE $native -ffp-contract=fast
cat "$work/usual.out"
if ! grep -q 'self test: passed' "$work/usual.out" || ! diff "$work/usual.out" "$work/portable.out"; then
    echo "FAILED: $compiler: other bits without what it adds to C++"
    exit 1
fi
echo "passed: $compiler"
