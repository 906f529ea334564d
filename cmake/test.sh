#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/test.sh [LAYER | LAYER/SOURCE]... [--match REGEX] [--project] [--clang] [--gcc] [--tsan] [--asan] [--headers]
#                         [--bench] [--platforms [NAME...]] [--full] [--all] [--help]
#
# Installs what is missing from the distribution's packages (Debian 12, Ubuntu 24.04 or newer), builds the tests and runs
# them, all in one run of ctest. With no argument all tests of all layers (the folders of tests/), and what compilers have to refuse:
#   g++, warnings as errors: arithmetic, shape, predicate at -O3, narrow at -O1, and what runs long of collide and distributed;
#   clang, where it is there or can be installed: execution, index, traverse, devices, io and the rest of collide. It takes
#   less than half of the time of g++ for these. Without it g++ builds all;
#   the .cu files, where nvcc 13.0 or newer and a device are present.
# A part of them:
#   LAYER...           one folder of tests/ or more, built by g++ alone
#   LAYER/SOURCE...    the sources whose names begin so: collide/raycast, predicate/cone
#   --match REGEX      those whose names match it; with a LAYER only that is built
# More, each beside all tests of all layers:
#   --project   the project as a whole: the examples, the code in README and docs, the reference, packages, outside projects, each
#               header alone, the syntax of bench/*.cpp; the .cu files compiled to PTX, where no device is present, but for
#               those that take minutes; the address and undefined behaviour sanitizers on execution, traverse and io. CI runs it
#   --clang     all layers and examples built by clang, each source by itself, its warnings as errors
#   --gcc       all layers built by g++, with nothing left to clang
#   --tsan      the OpenMP paths under clang's thread sanitizer
#   --asan      the address and undefined behaviour sanitizers on all layers
#   --headers   --project, with each header alone by g++, clang and nvcc, and the syntax of bench/*.cpp by g++ and clang
#   --bench     --project, with the benchmarks built (they are not run)
#   --full      1,000,000 samples for each family and scalar instead of 5,000; tables go to docs/results; all of it by g++ at -O3
#   --all       all of these but --full
#   --platforms first of all: a table of the bits of all kinds of answers, on other compilers and processors (tests/platform/run.sh has
#               their names; all without names)
# Environment: ABUT_SAMPLES (samples for each family and scalar), ABUT_RESULTS (folder for tables), ABUT_REQUIRE_CUDA=1
# (no nvcc is a failure), ABUT_REQUIRE (what no test may be skipped for want of: data, device, validator, viewer; test.sh adds
# what is there. With packages, what apt-get could not install is a failure too, and npm where its registry answers).
set -eu

usage() { sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; }

project=no gcc=no clang=no tsan=no asan=no headers=no bench=no full=no platforms=no names='' chosen='' match=''
wanting=''  # the option whose words come next
for argument in "$@"; do
    if [ "$wanting" = match ]; then match=$argument wanting='' && continue; fi
    case $argument in
        --project) project=yes ;;
        --gcc) gcc=yes ;;
        --clang) clang=yes ;;
        --tsan) tsan=yes ;;
        --asan) asan=yes ;;
        --headers) headers=yes project=yes ;;
        --bench) bench=yes project=yes ;;
        --full) full=yes gcc=yes project=yes ;;
        --all) project=yes gcc=yes clang=yes tsan=yes asan=yes headers=yes bench=yes platforms=yes ;;
        --platforms) platforms=yes wanting=platforms && continue ;;
        --match) wanting=match && continue ;;
        --help | -h) usage; exit 0 ;;
        --* ) printf 'test.sh: no such argument: %s\n' "$argument" >&2; usage >&2; exit 2 ;;
        *) if [ "$wanting" = platforms ]; then names="$names $argument" && continue; else chosen="$chosen $argument"; fi ;;
    esac
    wanting=''
done
if [ "$wanting" = match ]; then printf 'test.sh: --match needs a regular expression\n' >&2; exit 2; fi

cd "$(dirname "$0")/.."
. cmake/common.sh

# A part: folders of tests/, and beginnings of the names of their sources.
layers='' sources=''
for part in $chosen; do
    layer=${part%%/*}
    if [ ! -d "tests/$layer" ] || [ "$layer" = support ]; then fail "there is no layer tests/$layer"; fi
    case $part in
        */?*) ls "tests/$part"*.test.cpp >/dev/null 2>&1 || fail "there is no source tests/$part*.test.cpp"; sources="$sources;$part" ;;
        *) sources="$sources;$layer/" ;;
    esac
    layers="$layers;$layer"
done
layers=${layers#;} sources=${sources#;}

if [ $platforms = yes ]; then
    # shellcheck disable=SC2086
    sh tests/platform/run.sh $names
fi

if is_required data && [ ! -d "${ABUT_DATA:-../shared/data}" ]; then
    fail "ABUT_REQUIRE asks for data: there is no folder ${ABUT_DATA:-../shared/data}"
fi

# --- packages ----------------------------------------------------------------------------------------------------------

need_packages g++ cmake ninja-build python3 catch2 librapidcheck-dev libboost-dev
wanted='libgmp-dev libmpfr-dev libcgal-dev libfcl-dev libeigen3-dev libcli11-dev nlohmann-json3-dev pkg-config
    libbenchmark-dev doxygen libjs-lunr libopenmpi-dev openmpi-bin'
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
if [ $clang = yes ] || [ $tsan = yes ] || [ $headers = yes ]; then need_packages clang; fi
# clang builds what it builds sooner than g++ does, with its own runtime of OpenMP.
share=no
if [ $gcc = no ] && [ -z "$layers" ]; then
    want_packages clang
    if command -v clang++ >/dev/null 2>&1; then share=yes; fi
fi
if [ $share = yes ] || [ $clang = yes ] || [ $tsan = yes ] || [ $headers = yes ]; then
    major=$(clang++ -dumpversion | cut -d. -f1)
    if [ $share = yes ]; then
        want_packages "libomp-$major-dev"
        if [ -n "$(missing_of "libomp-$major-dev")" ]; then share=no; fi
    else
        need_packages "libomp-$major-dev"
    fi
    if [ $tsan = yes ]; then want_packages "libclang-rt-$major-dev"; fi
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
NINJA_STATUS='[%f of %t, %es] '
export NINJA_STATUS
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
quick=ON
if [ $full = yes ]; then quick=OFF; fi
# Where no device is present, .cu files are compiled to see that they can be, and that is the project's matter.
cuda=OFF quick_device=OFF
if [ -n "$nvcc" ] && cuda_device_present; then cuda=ON; fi
bench_option=OFF
if [ $bench = yes ]; then bench_option=ON; fi
# Six sources of a layer are compiled as one: most of it goes into what they share, headers and what is made of templates. g++
# then takes up to 3.5 GB. clang takes a third of that, and twice as many.
batch='-DCMAKE_UNITY_BUILD_BATCH_SIZE=6'
together="-DCMAKE_UNITY_BUILD=$quick $batch"
# What takes long to run is built by g++ with -Og, where clang's -O0 would cost more than it saves.
by_gcc='arithmetic shape predicate narrow distributed cuda'
long_in_collide=' bodies contacts distance extremes hulls impacts inside line_bundles many_within memory meshes nearest on_a_device'
long_in_collide="$long_in_collide pair_rules posed query raycast raycast_solids revolution row_each self_pairs solid_relation"
long_in_collide="$long_in_collide solids_by_rule spans validate winding_exact winding_number within "
elsewhere_gcc='' elsewhere_clang=''
if [ $share = yes ]; then
    elsewhere_gcc='execution;index;traverse;devices;io'
    for source in tests/collide/*.test.cpp; do
        stem=$(basename "$source" .test.cpp)
        case $long_in_collide in
            *" $stem "*) elsewhere_clang="$elsewhere_clang;collide/$stem" ;;
            *) elsewhere_gcc="$elsewhere_gcc;collide/$stem" ;;
        esac
    done
    for layer in $by_gcc; do elsewhere_clang="$elsewhere_clang;$layer"; done
fi

minutes=$((38 / jobs + 1))
if [ -n "$layers" ]; then
    say "building and testing a part: $chosen"
elif [ $project$full$asan$clang$tsan$gcc$headers$bench = nononononononono ]; then
    say "building and testing all layers takes about $minutes minutes with $jobs processors, if nothing was built before"
else
    say "building and testing all layers takes about $minutes minutes with $jobs processors, if nothing was built before; what more was asked for comes on top"
fi

if [ -n "$layers" ]; then
    # shellcheck disable=SC2086
    build_tree part default -DCMAKE_CXX_COMPILER=g++ -DABUT_CUDA=$cuda -DABUT_EXAMPLES=OFF -DABUT_TEST_PROJECT=OFF \
        -DABUT_TEST_LAYERS="$layers" -DABUT_TEST_SOURCES="$sources" $together
else
    # shellcheck disable=SC2086
    build_tree gcc default -DCMAKE_CXX_COMPILER=g++ -DABUT_CUDA=$cuda -DABUT_EXAMPLES=OFF \
        -DABUT_TEST_PROJECT=OFF -DABUT_TEST_QUICK=$quick -DABUT_TEST_ELSEWHERE="$elsewhere_gcc" $together
    if [ $share = yes ]; then
        # shellcheck disable=SC2086
        build_tree clang_share clang -DABUT_EXAMPLES=OFF -DABUT_TEST_PROJECT=OFF -DABUT_TEST_REFUSALS=OFF \
            -DABUT_TEST_ELSEWHERE="${elsewhere_clang#;}" -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12
    fi
fi
if [ $project = yes ]; then
    compilers=$(command -v g++)
    if [ $headers = yes ]; then compilers="$compilers;$(command -v clang++);nvcc"; fi
    project_layers=none
    if [ -n "$nvcc" ] && [ $cuda = OFF ]; then cuda=ON project_layers=cuda; fi
    if [ $quick = ON ] && ! cuda_device_present; then quick_device=ON; fi
    # shellcheck disable=SC2086
    build_tree project default -DCMAKE_CXX_COMPILER=g++ -DABUT_CUDA=$cuda -DABUT_HEADER_COMPILERS="$compilers" \
        -DABUT_BENCH=$bench_option -DABUT_TEST_LAYERS=$project_layers -DABUT_TEST_QUICK=$quick -DABUT_TEST_REFUSALS=OFF \
        -DABUT_QUICK_EXAMPLES=$quick -DABUT_QUICK_DEVICE_CODE=$quick_device $together
fi
if [ $project = yes ] || [ $asan = yes ]; then
    # Hardly any optimisation, where it is only a part.
    layers_asan='execution;traverse;io' sanitized='-O0 -g1' together_asan="-DCMAKE_UNITY_BUILD=ON $batch" elsewhere_asan=traverse/modes
    if [ $full = yes ]; then elsewhere_asan=''; fi
    if [ $asan = yes ]; then layers_asan='' sanitized='-O1 -g1' together_asan='' elsewhere_asan=''; fi
    # shellcheck disable=SC2086
    build_tree asan asan -DCMAKE_CXX_COMPILER=g++ -DABUT_EXAMPLES=OFF -DABUT_TEST_PREFIX='asan/' -DABUT_TEST_LAYERS="$layers_asan" \
        -DABUT_TEST_ELSEWHERE="$elsewhere_asan" -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="$sanitized" $together_asan
fi
if [ $clang = yes ]; then
    # --headers has checked them with clang already.
    header_compilers=$(command -v clang++)
    if [ $headers = yes ]; then header_compilers=''; fi
    build_tree clang clang -DABUT_TEST_QUICK=$quick -DABUT_TEST_PREFIX='clang/' -DABUT_HEADER_COMPILERS="$header_compilers"
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
exec ctest --test-dir build/test/all ${match:+-R "$match"} --parallel "$jobs" --timeout $timeout --no-tests=error --output-on-failure
