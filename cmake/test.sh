#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/test.sh [--clang] [--tsan] [--asan] [--headers] [--bench] [--full] [--all] [--help]
#
# Installs what is missing from the distribution's packages (Debian 12, Ubuntu 24.04 or newer), builds the tests and runs
# them, all in one run of ctest. With no argument:
#   g++, Release, warnings as errors: all tests, the examples, each header alone, the syntax of bench/*.cpp, the
#   include graph, an outside project;
#   the .cu files, if nvcc 13.0 or newer is there; where no device is present they are compiled to PTX alone, without
#   optimisation, but for those that take minutes, and each counts as a test that is skipped;
#   the address and undefined behaviour sanitizers on execution, traverse and io, with hardly any optimisation. io is tested
#   by them alone, and traverse/modes.test.cpp without them: --asan and --full build both both ways.
# More, each beside what is above:
#   --clang     the same tests built by clang (no .cu files), its warnings as errors
#   --tsan      the OpenMP paths under clang's thread sanitizer
#   --asan      the address and undefined behaviour sanitizers on all layers
#   --headers   each header alone with g++, clang and nvcc; the syntax of bench/*.cpp with g++ and clang
#   --bench     the benchmarks are built too (they are not run)
#   --full      1,000,000 samples for each family and scalar instead of 5,000; tables go to docs/results; all of it at -O3
#   --all       all of these but --full
# Environment: ABUT_SAMPLES (samples for each family and scalar), ABUT_RESULTS (folder for tables), ABUT_REQUIRE_CUDA=1
# (no nvcc is a failure), ABUT_REQUIRE (what no test may be skipped for want of: data, device, validator, viewer; test.sh adds
# what is there. With packages, what apt-get could not install is a failure too, and npm where its registry answers).
set -eu

usage() { sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; }

clang=no tsan=no asan=some headers=no bench=no full=no
for argument in "$@"; do
    case $argument in
        --clang) clang=yes ;;
        --tsan) tsan=yes ;;
        --asan) asan=all ;;
        --headers) headers=yes ;;
        --bench) bench=yes ;;
        --full) full=yes ;;
        --all) clang=yes tsan=yes asan=all headers=yes bench=yes ;;
        --help | -h) usage; exit 0 ;;
        *) printf 'test.sh: no such argument: %s\n' "$argument" >&2; usage >&2; exit 2 ;;
    esac
done

cd "$(dirname "$0")/.."
. cmake/common.sh

if is_required data && [ ! -d "${ABUT_DATA:-../shared/data}" ]; then
    fail "ABUT_REQUIRE asks for data: there is no folder ${ABUT_DATA:-../shared/data}"
fi

# --- packages ----------------------------------------------------------------------------------------------------------

need_packages g++ cmake ninja-build python3 catch2 librapidcheck-dev libboost-dev
wanted='libgmp-dev libmpfr-dev libcgal-dev libfcl-dev libeigen3-dev libcli11-dev nlohmann-json3-dev pkg-config
    libbenchmark-dev doxygen libopenmpi-dev openmpi-bin'
if [ $bench = yes ]; then wanted="$wanted libembree-dev libbullet-dev libnanoflann-dev"; fi
# shellcheck disable=SC2086
want_packages $wanted ccache $viewer_packages
# The Khronos validator of glTF, for the tests of its writer.
if command -v npm >/dev/null 2>&1 && [ ! -d build/npm/node_modules/gltf-validator ]; then
    mkdir -p build/npm
    npm install --prefix build/npm --no-audit --no-fund --loglevel=error gltf-validator@2.0.0-dev.3.10 \
        >build/npm.log 2>&1 || {
        # No answer from npm's registry is no fault of the project.
        if is_required packages && npm ping >/dev/null 2>&1; then
            cat build/npm.log
            fail 'ABUT_REQUIRE asks for packages: npm could not install gltf-validator'
        fi
        printf 'npm could not install gltf-validator; what needs it is skipped\n'
    }
fi
if [ $clang = yes ] || [ $tsan = yes ] || [ $headers = yes ]; then
    need_packages clang
    major=$(clang++ -dumpversion | cut -d. -f1)
    need_packages "libomp-$major-dev"
    want_packages "libclang-rt-$major-dev"
fi
find_nvcc

# What is here may not be missing for a test (docs/building.md).
# shellcheck disable=SC2086
installed=$(installed_of $wanted)
require=${ABUT_REQUIRE:-}
if [ -d ../shared/data ]; then require="$require data"; fi
if cuda_device_present; then require="$require device"; fi
if [ -d build/npm/node_modules/gltf-validator ]; then
    require="$require validator"
    # npm, which has brought that, brings what the page is made of.
    # shellcheck disable=SC2086
    if [ -z "$(missing_of $viewer_packages)" ]; then require="$require viewer"; fi
fi
export ABUT_REQUIRE="$require"

# --- build trees -------------------------------------------------------------------------------------------------------

# build_tree NAME PRESET CMAKE-ARGUMENT...: configures and builds build/test/NAME.
trees=''
build_tree() {
    name=$1 preset=$2
    shift 2
    say "building build/test/$name (preset $preset)"
    cmake --preset "$preset" -B "build/test/$name" -DABUT_INSTALLED_PACKAGES="$installed" "$@" >"build/test/$name.log" 2>&1 ||
        { cat "build/test/$name.log"; fail "configuring build/test/$name failed"; }
    grep '^-- abut: ' "build/test/$name.log" || true
    cmake --build "build/test/$name" --parallel "$jobs"
    trees="$trees $name"
}

mkdir -p build/test
compilers=$(command -v g++)
if [ $headers = yes ]; then compilers="$compilers;$(command -v clang++);nvcc"; fi
cuda=OFF
if [ -n "$nvcc" ]; then cuda=ON; fi
bench_option=OFF
if [ $bench = yes ]; then bench_option=ON; fi
layers='execution;traverse;io'
# What one of the two trees tests, the other does not build again: readers and writers are tested under the sanitizers, and walks
# in each floating-point mode without them.
elsewhere_gcc=io elsewhere_asan=traverse/modes
if [ $full = yes ] || [ $asan = all ]; then elsewhere_gcc='' elsewhere_asan=''; fi
quick=ON
if [ $full = yes ]; then quick=OFF; fi
# Where no device is present, .cu files are compiled to see that they can be.
quick_device=OFF
if [ $quick = ON ] && ! cuda_device_present; then quick_device=ON; fi
sanitized='-O0 -g1'
# Six sources of a layer are compiled as one: most of it goes into what they share, headers and what is made of templates. A
# compiler then takes up to 3.5 GB.
batch='-DCMAKE_UNITY_BUILD_BATCH_SIZE=6'
together="-DCMAKE_UNITY_BUILD=$quick $batch" together_asan="-DCMAKE_UNITY_BUILD=ON $batch"
if [ $asan = all ]; then layers='' sanitized='-O1 -g1' together_asan=''; fi

# shellcheck disable=SC2086
build_tree gcc default -DCMAKE_CXX_COMPILER=g++ -DABUT_CUDA=$cuda -DABUT_HEADER_COMPILERS="$compilers" -DABUT_BENCH=$bench_option \
    -DABUT_TEST_QUICK=$quick -DABUT_QUICK_EXAMPLES=$quick -DABUT_QUICK_DEVICE_CODE=$quick_device \
    -DABUT_TEST_ELSEWHERE=$elsewhere_gcc $together
# shellcheck disable=SC2086
build_tree asan asan -DCMAKE_CXX_COMPILER=g++ -DABUT_EXAMPLES=OFF -DABUT_TEST_PREFIX='asan/' -DABUT_TEST_LAYERS="$layers" \
    -DABUT_TEST_ELSEWHERE=$elsewhere_asan \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="$sanitized" $together_asan
if [ $clang = yes ]; then
    # --headers has checked them with clang already.
    header_compilers=$(command -v clang++)
    if [ $headers = yes ]; then header_compilers=''; fi
    # shellcheck disable=SC2086
    build_tree clang clang -DABUT_TEST_QUICK=$quick -DABUT_TEST_PREFIX='clang/' -DABUT_HEADER_COMPILERS="$header_compilers" \
        $together
fi
if [ $tsan = yes ]; then
    # shellcheck disable=SC2086
    build_tree tsan tsan -DABUT_EXAMPLES=OFF -DABUT_TEST_PREFIX='tsan/' -DABUT_TEST_LAYERS='execution;shape;index;collide;devices' \
        $together
fi

# --- one run of ctest over all trees -----------------------------------------------------------------------------------

for name in $trees; do printf 'subdirs("../%s")\n' "$name"; done >build/test/subdirs
mkdir -p build/test/all
mv build/test/subdirs build/test/all/CTestTestfile.cmake

timeout=1200
if [ $full = yes ]; then
    : "${ABUT_SAMPLES:=1000000}" "${ABUT_RESULTS:=$(pwd)/docs/results}"
    mkdir -p "$ABUT_RESULTS"
    ABUT_COMMIT=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
    export ABUT_COMMIT
    timeout=100000
fi
: "${ABUT_SAMPLES:=5000}"
export ABUT_SAMPLES
if [ -n "${ABUT_RESULTS:-}" ]; then export ABUT_RESULTS; fi

say "testing with $jobs jobs, ABUT_SAMPLES=$ABUT_SAMPLES"
exec ctest --test-dir build/test/all --parallel "$jobs" --timeout $timeout --no-tests=error --output-on-failure
