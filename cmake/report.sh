#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/report.sh [--quick] [--into-docs] [--cpu] [--cuda] [--only NAME]... [--data DIR] [--jobs N] [--bin DIR]
#                           [--from DIR] [--no-install]
#
# Measures, and makes tables and plots of it. Installs what is missing (Debian 12, Ubuntu 24.04 or newer), builds the
# benchmarks in build/report, runs them, and writes build/report/report.md with plots beside it, of this machine.
#
#   --quick       few benchmarks, small sizes: a few minutes, most of them for the compiler
#   --into-docs   all tables and plots of README.md and docs/ are rewritten from what was measured; what was not measured here
#                 (a device, say) stays. The results are kept in bench/results
#   --cpu --cuda  only the benchmarks of the processor, or of the device. Without either: both, where nvcc and a device are
#   --only NAME   only the benchmarks of that name in the table below
#   --data DIR    folder with meshes/ and ccd/ (../shared/data); what needs it is left out where it is not there
#   --jobs N      so many benchmarks of the processor run at once (1); those of a device run one after another
#   --bin DIR     programs are there already: nothing is installed or built. For a machine without compilers or network: bring
#                 the programs and this script there, and build/report/results back
#   --from DIR    nothing is run: the results are those in DIR, with folders cpu and cuda
#   --no-install  fails where a package is missing
#
# ABUT_PEERS is a folder of checkouts of libraries that are no packages (bench/peers.cmake): bench_peers goes without what is not there.
set -eu
here=$(pwd)
cd "$(dirname "$0")/.."
# shellcheck source=cmake/common.sh
. cmake/common.sh

usage() { sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0" | sed '$d'; }

# --- the table: results, program, arguments ----------------------------------------------------------------------------
#
# NAME goes to build/report/results/KIND/NAME.json, and from there to bench/results. @D@ stands for the folder of data, $I
# interleaves runs at random. Google Benchmark is told where to write by --benchmark_out, a few programs by --json, those of a
# device by their first argument: {} stands for the file.
table() {
    I=--benchmark_enable_random_interleaving=true
    G='--benchmark_out={} --benchmark_format=console'
    if [ $quick = yes ]; then
        cat <<END
cpu trade bench_trade --json={} --pairs=8192 --runs=5
cpu spheres_mesh bench_spheres_mesh $G $I --benchmark_filter=-openmp|break_even|none
cpu triangles bench_triangles $G $I --triangles=1000000 --benchmark_filter=^(pair|family)/|/serial/
cpu descents bench_descents --json={}
cuda trade bench_trade_cuda {}
cuda spheres_mesh bench_spheres_mesh_cuda {}
END
    else
        cat <<END
cpu trade bench_trade --json={}
cpu trade_others bench_trade --json={} --which=others
cpu motion bench_motion $G --scene=@D@/ccd/cloth-ball --scene=@D@/ccd/cloth-funnel --scene=@D@/ccd/armadillo-rollers
cpu pair_rules bench_pair_rules $G $I --scenes=@D@/ccd --benchmark_filter=-n-body
cpu triangles bench_triangles $G $I --triangles=20000000
cpu builders bench_builders $G $I --mesh=@D@/meshes/armadillo_345944.ply
cpu validate bench_validate $G
cpu families bench_families $G
cpu ties bench_ties $G --mesh=@D@/meshes/armadillo_27674.ply
cpu equal bench_equal --json={}
cpu fronts bench_fronts --json={} --frames=20
cpu spheres_mesh bench_spheres_mesh $G $I
cpu meshes bench_meshes $G $I --mesh=@D@/meshes/armadillo_345944.ply --benchmark_filter=-any/[a-z_]*/.*/
cpu any bench_meshes $G $I --mesh=@D@/meshes/stanford-bunny.ply --benchmark_filter=any/[a-z_]*/.*/
cpu nearest bench_nearest $G $I --mesh=@D@/meshes/armadillo_345944.ply --benchmark_filter=/100000/
cpu distance bench_distance $G $I --meshes=@D@/meshes
cpu within bench_within $G $I --meshes=@D@/meshes
cpu hulls bench_hulls $G $I
cpu peers bench_peers --json={}
cpu winding bench_winding @D@/meshes --json={}
cpu impact_times bench_impact_times @D@/ccd --json={}
cpu turning bench_turning @D@ --json={}
cpu mixed_bodies bench_mixed_bodies $G $I
cpu solids bench_solids @D@/meshes/armadillo_2766.ply @D@/meshes/armadillo_27674.ply @D@/meshes/armadillo_345944.ply --json={}
cpu patches bench_patches @D@/meshes/cow.obj @D@/meshes/fandisk.ply @D@/meshes/armadillo_2766.ply --json={}
cpu raycast bench_raycast $G $I --mesh=@D@/meshes/armadillo_345944.ply
cpu descents bench_descents --json={} --mesh=@D@/meshes/armadillo_345944.ply
cpu descents_138376 bench_descents --json={} --mesh=@D@/meshes/armadillo_138376.ply
cpu descents_27674 bench_descents --json={} --mesh=@D@/meshes/armadillo_27674.ply
cpu descents_2766 bench_descents --json={} --mesh=@D@/meshes/armadillo_2766.ply
cpu meshes_138376 bench_meshes $G $I --mesh=@D@/meshes/armadillo_138376.ply --benchmark_filter=^(build/bvh|pairs|boxes|contacts)/
cpu meshes_27674 bench_meshes $G $I --mesh=@D@/meshes/armadillo_27674.ply --benchmark_filter=^(build/bvh|pairs|boxes|contacts)/
cpu meshes_2766 bench_meshes $G $I --mesh=@D@/meshes/armadillo_2766.ply --benchmark_filter=^(build/bvh|pairs|boxes|contacts)/
cpu reduce_contacts bench_reduce_contacts --json={} --mesh=@D@/meshes/armadillo_345944.ply
cpu extremes bench_extremes --json={}
cpu trade_scenes bench_trade_scenes --json={} --data=@D@
cpu footprint bench_footprint --json={}
cpu bodies bench_bodies $G $I
cpu cores bench_cores $G --benchmark_filter=/quiet|/modelled/16
cpu cores_busy bench_cores $G --benchmark_filter=^(validate|build|sort_few_keys)/.*/busy
cpu distributed bench_distributed --json={}
cuda footprint bench_footprint_cuda {}
cuda trade bench_trade_cuda {}
cuda trade_others bench_trade_cuda {} others
cuda trade_solids bench_trade_solids_cuda {}
cuda trade_within bench_trade_within_cuda {}
cuda trade_hulls bench_trade_hulls_cuda {}
cuda spheres_mesh bench_spheres_mesh_cuda {}
cuda triangles bench_triangles_cuda {}
cuda ties bench_ties_cuda {}
cuda devices bench_devices_cuda {}
cuda devices_large bench_devices_large_cuda {}
cuda devices_divided bench_devices_large_cuda {} 1000000
cuda nearest bench_nearest_cuda --mesh=@D@/meshes/armadillo_345944.ply {}
cuda distance bench_distance_cuda --meshes=@D@/meshes {}
cuda raycast bench_raycast_cuda {} @D@/meshes/armadillo_345944.ply
cuda sweep bench_sweep_cuda {} @D@/meshes/armadillo_345944.ply
cuda solids bench_solids_cuda {} @D@/meshes/armadillo_345944.ply
cuda turning bench_turning_cuda @D@ {}
cuda arm bench_arm_cuda {}
cuda cloth_step bench_cloth_step_cuda @D@/ccd/cloth-ball {}
cuda bodies bench_bodies_cuda {}
cuda validate bench_validate_cuda {}
cuda meshes bench_meshes_cuda {} @D@/meshes/armadillo_345944.ply @D@/meshes/armadillo_2766.ply
cuda meshes_138376 bench_meshes_cuda {} @D@/meshes/armadillo_138376.ply @D@/meshes/armadillo_2766.ply
cuda meshes_27674 bench_meshes_cuda {} @D@/meshes/armadillo_27674.ply @D@/meshes/armadillo_2766.ply
cuda meshes_2766 bench_meshes_cuda {} @D@/meshes/armadillo_2766.ply @D@/meshes/armadillo_2766.ply
cuda builders bench_builders_cuda {} @D@/meshes/armadillo_345944.ply
cuda schedules bench_schedules_cuda {} @D@/meshes/armadillo_345944.ply
cuda motion bench_motion_cuda {} @D@/ccd/cloth-ball @D@/ccd/cloth-funnel @D@/ccd/n-body-simulation @D@/ccd/armadillo-rollers @D@/ccd/rod-twist
cuda motion_flying bench_motion_cuda {}
cuda pair_rules bench_pair_rules_cuda --scenes=@D@/ccd {}
cuda extremes bench_extremes_cuda --json={}
cuda fronts bench_fronts_cuda {} @D@/ccd/cloth-ball @D@/ccd/cloth-funnel
END
    fi
}

# --- arguments ---------------------------------------------------------------------------------------------------------

# in_full PATH: one of the caller's folder, in full.
in_full() { case $1 in /*) printf '%s' "$1" ;; *) printf '%s/%s' "$here" "$1" ;; esac; }
quick=no docs=no kinds='' only='' D=../shared/data at_once=1 bin='' from='' install=yes
while [ $# -gt 0 ]; do
    case $1 in
        --quick) quick=yes ;;
        --into-docs) docs=yes ;;
        --cpu | --cuda) kinds="$kinds ${1#--}" ;;
        --only | --data | --jobs | --bin | --from)
            [ $# -gt 1 ] || fail "$1 wants a value"
            case $1 in
                --only) only="$only $2" ;;
                --data) D=$(in_full "$2") ;;
                --jobs) at_once=$2 ;;
                --bin) bin=$(in_full "$2") ;;
                --from) from=$(in_full "$2") ;;
            esac
            shift
            ;;
        --no-install) install=no ;;
        --help | -h) usage; exit 0 ;;
        *) printf 'report.sh: no such argument: %s\n' "$1" >&2; usage >&2; exit 2 ;;
    esac
    shift
done

asked_for() { [ -z "$2" ] || case " $2 " in *" $1 "*) ;; *) return 1 ;; esac; }

for name in $only; do
    [ "$name" = footprint_build ] || table | cut -d' ' -f2 | grep -qxF -e "$name" ||
        fail "--only $name: there are $(table | cut -d' ' -f2 | sort -u | tr '\n' ' ')"
done

# --- packages and programs ---------------------------------------------------------------------------------------------

results=${from:-build/report/results}
if [ -z "$from" ]; then
    if [ -z "$bin" ]; then
        if [ $install = yes ]; then
            need_packages g++ cmake ninja-build python3 libbenchmark-dev libboost-dev libopenmpi-dev \
                openmpi-bin
            want_packages libembree-dev libnanoflann-dev libcgal-dev libfcl-dev libgmp-dev libmpfr-dev libbullet-dev \
                python3-matplotlib
        fi
        find_nvcc
        cuda=OFF
        if cuda_device_present && asked_for cuda "$kinds"; then cuda=ON; fi
        say 'building the benchmarks in build/report'
        mkdir -p build
        cmake --preset default -B build/report -DABUT_TESTS=OFF -DABUT_EXAMPLES=OFF -DABUT_BENCH=ON -DABUT_WERROR=OFF \
            -DABUT_CUDA=$cuda -DABUT_PEERS="${ABUT_PEERS:-}" >build/report.log 2>&1 || { cat build/report.log; fail 'configuring failed'; }
        grep '^-- abut: ' build/report.log || true
        targets=$(table | while read -r kind name program rest; do
            if asked_for "$name" "$only" && asked_for "$kind" "$kinds" && { [ "$kind" = cpu ] || [ $cuda = ON ]; }; then
                printf '%s\n' "$program"
            fi
        done | sort -u)
        # shellcheck disable=SC2086
        [ -z "$targets" ] || cmake --build build/report --parallel "$jobs" --target $targets
        bin=build/report/bench
    fi
    if [ -z "${ABUT_COMMIT:-}" ]; then
        ABUT_COMMIT=$(git rev-parse --short=9 HEAD 2>/dev/null || echo unknown)
        if [ -n "$(git status --porcelain -- include bench 2>/dev/null)" ]; then ABUT_COMMIT=$ABUT_COMMIT+; fi
    fi
    [ $docs = no ] || [ "$ABUT_COMMIT" != unknown ] ||
        fail '--into-docs wants results that say of which commit they are: there is no git here, so set ABUT_COMMIT'
    : "${ABUT_FLAGS:=-O3 -DNDEBUG}"
    export ABUT_COMMIT ABUT_FLAGS
    # More ranks than cores, and also by root: Open MPI wants to be told, and others take no notice.
    export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_ALLOW_RUN_AS_ROOT=1 \
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

    # --- runs ----------------------------------------------------------------------------------------------------------

    # run_one KIND NAME PROGRAM ARGUMENT...: leaves KIND/NAME.json and .log, and says how long it took.
    run_one() {
        kind=$1 name=$2 program=$3
        shift 3
        if [ ! -x "$bin/$program" ]; then
            [ "$kind" = cuda ] || printf '%s/%s: left out, there is no %s\n' "$kind" "$name" "$bin/$program"
            return 0
        fi
        for argument in "$@"; do
            path=${argument#*=}
            case $path in "$D"/*) [ -e "$path" ] || { printf '%s/%s: left out, there is no %s\n' "$kind" "$name" "$path"; return 0; } ;; esac
        done
        ranks=''
        if [ "$program" = bench_distributed ]; then
            command -v mpirun >/dev/null 2>&1 || { printf '%s/%s: left out, there is no mpirun\n' "$kind" "$name"; return 0; }
            ranks='mpirun -np 8'
        fi
        started=$(date +%s)
        file=$results/$kind/$name.json
        rm -f "$file"
        status=0
        # shellcheck disable=SC2086
        $ranks "$bin/$program" "$@" >"$results/$kind/$name.log" 2>&1 || status=$?
        if [ $status = 0 ] && [ -s "$file" ]; then
            printf '%s/%s: %s s\n' "$kind" "$name" $(($(date +%s) - started))
        else
            rm -f "$file"
            printf '%s/%s: FAILED (%s), see %s\n' "$kind" "$name" $status "$results/$kind/$name.log" | tee -a "$results/failed"
        fi
    }

    say "running, results go to $results"
    mkdir -p "$results/cpu" "$results/cuda"
    running=0
    rm -f "$results/failed"
    table >"$results/table"
    set -f
    while read -r kind name program arguments; do
        if ! asked_for "$kind" "$kinds" || ! asked_for "$name" "$only"; then continue; fi
        file=$results/$kind/$name.json
        # shellcheck disable=SC2086
        set -- $arguments
        for argument in "$@"; do  # the paths are put in after words are split: they may hold spaces
            shift
            case $argument in *@D@*) argument=${argument%%@D@*}$D${argument#*@D@} ;; esac
            case $argument in *'{}'*) argument=${argument%%'{}'*}$file${argument#*'{}'} ;; esac
            set -- "$@" "$argument"
        done
        if [ "$at_once" -gt 1 ] && [ "$kind" = cpu ]; then
            if [ $running -ge "$at_once" ]; then wait; running=0; fi
            run_one "$kind" "$name" "$program" "$@" </dev/null &
            running=$((running + 1))
        else
            if [ $running -gt 0 ]; then wait; running=0; fi
            run_one "$kind" "$name" "$program" "$@" </dev/null
        fi
    done <"$results/table"
    wait
    set +f
    # What compiling costs is measured where there are compilers.
    if [ $quick = no ] && asked_for footprint_build "$only" && asked_for cpu "$kinds" && command -v g++ >/dev/null 2>&1 &&
        command -v python3 >/dev/null 2>&1; then
        python3 -B bench/footprint.py --json="$results/cpu/footprint_build.json" >"$results/cpu/footprint_build.log" 2>&1 ||
            printf 'cpu/footprint_build: FAILED, see %s\n' "$results/cpu/footprint_build.log" | tee -a "$results/failed"
    fi
fi

# --- tables and plots --------------------------------------------------------------------------------------------------

command -v python3 >/dev/null 2>&1 || { say "no python3 here: take $results to where it is, and run with --from"; exit 0; }
python=python3
# The package's, where another Python comes first.
python3 -c 'import matplotlib' 2>/dev/null || [ ! -x /usr/bin/python3 ] || python=/usr/bin/python3
if [ $docs = yes ]; then
    $python -B bench/report.py --take "$results" --write
else
    $python -B bench/report.py --page build/report/report.md "$results"
fi
[ -n "$from" ] || [ ! -s "$results/failed" ] || fail "not all was measured: $(cat "$results/failed")"
say "done; results are in $results"
