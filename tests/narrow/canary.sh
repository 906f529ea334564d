#!/bin/sh
# SPDX-License-Identifier: MIT
#
# canary.sh COMPILER: compiles canary.cpp twice, so that products and sums may be joined and so that they may not, and
# compares what the two print: distances and contacts are to have the same bits. Exits 77 where the compiler is not g++, one
# being enough, or the processor does not join them, or GMP and MPFR are not here.

here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
compiler=$1
case $(basename "$compiler") in
    g++* | c++*) ;;
    *) echo "skipped: g++ is asked" && exit 77 ;;
esac
if ! grep -q -w fma /proc/cpuinfo 2>/dev/null; then
    echo "skipped: this processor does not join products and sums"
    exit 77
fi
if ! printf '#include <mpfr.h>\n' | "$compiler" -x c++ -fsyntax-only - 2>/dev/null; then
    echo "skipped: MPFR is not here"
    exit 77
fi
# build NAME FLAGS...
build() {
    name=$1
    shift
    "$compiler" -std=c++20 "$@" -I"$here/../../include" -I"$here/.." "$here/canary.cpp" -o "$work/$name" -lmpfr -lgmp &&
        "$work/$name" >"$work/$name.out" || exit 1
}
build apart -O1 -ffp-contract=off
build joined -O2 -mfma -ffp-contract=fast
cat "$work/apart.out"
if ! diff "$work/apart.out" "$work/joined.out"; then
    echo "FAILED: $compiler: other bits where products and sums are joined"
    exit 1
fi
echo "passed: $compiler"
