#!/bin/sh
# SPDX-License-Identifier: MIT
#
# canary.sh [COMPILER...]: compiles canary.cpp as users may, runs it, and checks that fast-math is refused. Compilers are
# names or paths of g++, clang++, nvcc (default: all three) and mingw-w64's g++; one that is absent is skipped, and a line
# says so. nvcc's part runs where there is a device and is compiled elsewhere. Exits 0 if nothing failed, and 77 if no
# compiler was there.

here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=cmake/common.sh
. "$here/../../cmake/common.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0
ran=0

# check COMPILER FLAGS...: builds and runs.
check() {
    compiler=$1
    shift
    ran=1
    if ! "$compiler" -std=c++20 "$@" -I"$here/../../include" "$here/canary.cpp" -o "$work/canary" >"$work/log" 2>&1; then
        echo "FAILED to compile: $compiler $*"
        cat "$work/log"
        failed=1
    elif $wine "$work/canary$suffix"; then
        echo "passed: $compiler $*"
    else
        echo "FAILED: $compiler $*"
        failed=1
    fi
}

# refuse COMPILER FLAGS...: must not compile, and say why.
refuse() {
    compiler=$1
    shift
    ran=1
    if "$compiler" -std=c++20 "$@" -fsyntax-only -I"$here/../../include" "$here/canary.cpp" >"$work/log" 2>&1 ||
        ! grep -q "abut: exact decisions need IEEE arithmetic" "$work/log"; then
        echo "FAILED: $compiler $* is not refused"
        failed=1
    else
        echo "refused: $compiler $*"
    fi
}

# doubt COMPILER FLAGS...: compiles, and the self test says that it should not have.
doubt() {
    compiler=$1
    shift
    ran=1
    if "$compiler" -std=c++20 "$@" -I"$here/../../include" "$here/canary.cpp" -o "$work/canary" >"$work/log" 2>&1 &&
        "$work/canary" 2>&1 | grep -q 'self test 1'; then
        echo "doubted: $compiler $*"
    else
        echo "FAILED: $compiler $* is not seen by the self test"
        failed=1
    fi
}

if [ $# -eq 0 ]; then
    nvcc=nvcc
    command -v nvcc >/dev/null 2>&1 || nvcc=/usr/local/cuda/bin/nvcc
    set -- g++ clang++ "$nvcc"
fi
wine= suffix=
for compiler in "$@"; do
    if ! command -v "$compiler" >/dev/null 2>&1; then
        echo "skipped: $compiler is not there"
        continue
    fi
    native=
    case $(uname -m) in x86_64 | aarch64) native=-march=native ;; esac
    case $(basename "$compiler") in
    *mingw32*)
        # Windows, by wine, where it is here. Its fma is a function that rounds twice, or an instruction.
        wine=$(command -v wine64 || command -v wine || command -v /usr/lib/wine/wine64) || {
            echo "skipped: $compiler needs wine64 to run what it makes"
            continue
        }
        suffix=.exe WINEDEBUG=-all
        export WINEDEBUG
        check "$compiler" -O2 -static
        check "$compiler" -O0 -static
        check "$compiler" -O0 -mfma -static
        check "$compiler" -O3 -mfma -ffp-contract=fast -static
        wine= suffix=
        ;;
    *clang*)
        check "$compiler" -O3 $native
        check "$compiler" -O3 $native -ffp-contract=fast
        check "$compiler" -O3 $native -ffp-contract=fast -DABUT_PORTABLE
        check "$compiler" -O0
        refuse "$compiler" -ffast-math
        refuse "$compiler" -Ofast
        refuse "$compiler" -ffinite-math-only
        # What clang has no macro for, each part alone.
        refuse "$compiler" -funsafe-math-optimizations
        refuse "$compiler" -fassociative-math -fno-signed-zeros -fno-trapping-math
        refuse "$compiler" -freciprocal-math
        refuse "$compiler" -fapprox-func
        refuse "$compiler" -fno-signed-zeros
        doubt "$compiler" -O2 -fno-honor-nans
        ;;
    *nvcc*)
        nvcc=$compiler
        if cuda_device_present; then
            check "$compiler" -x cu -arch=sm_90 --fmad=true
            check "$compiler" -x cu -arch=sm_90 --fmad=false
        else
            check "$compiler" -x cu -arch=compute_90 -Ofc=max
        fi
        ;;
    *)
        check "$compiler" -O3 $native
        check "$compiler" -O3 $native -ffp-contract=fast -flto
        check "$compiler" -O3 $native -ffp-contract=fast -DABUT_PORTABLE
        check "$compiler" -O0
        refuse "$compiler" -ffast-math
        refuse "$compiler" -Ofast
        refuse "$compiler" -ffinite-math-only
        refuse "$compiler" -funsafe-math-optimizations
        refuse "$compiler" -freciprocal-math
        refuse "$compiler" -fno-signed-zeros
        ;;
    esac
done
[ $ran -eq 1 ] || exit 77
exit $failed
