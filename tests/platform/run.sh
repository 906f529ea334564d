#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh tests/platform/run.sh [CONFIGURATION...] [--write] [--list] [--help]
#
# Compiles the program of tests/platform for each configuration, runs it, and compares its answers, bit for bit, with
# tests/platform/hashes.txt. Without arguments: all configurations. A line for each says what came out. The page of all lines is
# written to build/platforms/platforms.md, and what compilers and programs said lies beside it.
# Compilers come from the packages of Debian 12. Those for other processors, and libc++, are unpacked below build/platforms/root
# instead of being installed: they conflict with g++-multilib, and one libc++ with another.
# With --write the page goes to docs/results.
# The exit status is 0 if all that ran is equal, 1 if one differs or does not compile, 2 if nothing could be run. What cannot be had
# is skipped, with the reason; not with ABUT_REQUIRE=packages, where it is a failure.
set -u

cd "$(dirname "$0")/../.." || exit 2
. cmake/common.sh

# NAME | compiler | standard | options | package or prefix:WHAT | how to run it
configurations='g++-O0|g++|c++20|-O0|g++|
g++-O2|g++|c++23|-O2|g++|
g++-haswell|g++|c++20|-O3 -march=haswell|g++|
g++-haswell-no-contraction|g++|c++20|-O3 -march=haswell -ffp-contract=off|g++|
clang-14|clang++-14|c++20|-O1|clang-14|
clang-16|clang++-16|c++20|-O2 -march=haswell -ffp-contract=fast|clang-16|
clang-16-libc++|clang++-16|c++20|-O1|clang-16 prefix:libc++-16|
clang-19|clang++-19|c++23|-O2|clang-19|
clang-19-libc++|clang++-19|c++23|-O1 -march=haswell|clang-19 prefix:libc++-19|
arm64|aarch64-linux-gnu-g++-12|c++20|-O2 -static|qemu-user prefix:cross:aarch64-linux-gnu:arm64|qemu-aarch64
riscv64|riscv64-linux-gnu-g++-12|c++20|-O1 -static|qemu-user prefix:cross:riscv64-linux-gnu:riscv64|qemu-riscv64
ppc64le|powerpc64le-linux-gnu-g++-12|c++20|-O1 -static|qemu-user prefix:cross:powerpc64le-linux-gnu:ppc64el|qemu-ppc64le
mingw-w64|x86_64-w64-mingw32-g++-posix|c++20|-O1 -static|g++-mingw-w64-x86-64-posix wine64|wine'

names=$(printf '%s\n' "$configurations" | cut -d'|' -f1)
chosen='' write=no
for argument in "$@"; do
    case $argument in
        --help | -h) sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; exit 0 ;;
        --write) write=yes ;;
        --list) printf '%s\n' "$names"; exit 0 ;;
        *)
            printf '%s\n' "$names" | grep -Fqx -e "$argument" || { printf 'run.sh: no such configuration: %s\n' "$argument" >&2; exit 2; }
            chosen="$chosen $argument"
            ;;
    esac
done
if [ -z "$chosen" ]; then chosen=$names; fi

here=tests/platform
out=build/platforms
mkdir -p $out/debs $out/root
root=$(cd $out/root && pwd)

# --- what is needed ----------------------------------------------------------------------------------------------------

# unpacked PACKAGE...: below root, once.
unpacked() {
    for package in "$@"; do
        [ ! -e "$out/debs/$package.unpacked" ] || continue
        update_lists
        (cd $out/debs && apt-get download -qq "$package" >/dev/null 2>"$package.err") || { reason="no package $package"; return 1; }
        dpkg -x "$out/debs/${package}_"*.deb "$root" || { reason="cannot unpack $package"; return 1; }
        rm -f "$out/debs/${package}_"*.deb
        : >"$out/debs/$package.unpacked"
    done
}

# installed PACKAGE...: only where nothing has to be removed for it.
installed() {
    for package in "$@"; do
        [ -n "$(missing_of "$package")" ] || continue
        update_lists
        plan=$(apt-get install -s -y --no-install-recommends "$package" 2>&1) || { reason="no package $package"; return 1; }
        if printf '%s\n' "$plan" | grep -q '^Remv'; then
            reason="$package would remove $(printf '%s\n' "$plan" | sed -n 's/^Remv \([^ ]*\).*/\1/p' | tr '\n' ' ')"
            return 1
        fi
        as_root apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends "$package" >"$out/apt.log" 2>&1 ||
            { reason="apt-get could not install $package"; return 1; }
    done
}

# bring NEED...: packages, and parts below root; sets `extra` to options that they take, or `reason` and fails.
bring() {
    extra='' reason=''
    for need in "$@"; do
        case $need in
            prefix:libc++-*)
                v=${need##*-}
                unpacked "libc++-$v-dev" "libc++1-$v" "libc++abi-$v-dev" "libc++abi1-$v" "libunwind-$v" "libunwind-$v-dev" || return 1
                lib=$root/usr/lib/llvm-$v
                extra="-nostdinc++ -isystem $lib/include/c++/v1 -nostdlib++ -L$lib/lib -Wl,-rpath,$lib/lib -Wl,-rpath,$root/usr/lib/$(uname -m)-linux-gnu -lc++ -lc++abi"
                ;;
            prefix:cross:*)
                triplet=$(printf '%s' "$need" | cut -d: -f3) arch=$(printf '%s' "$need" | cut -d: -f4)
                # What the compiler itself links is what g++ 12 for this machine links.
                installed g++-12 || return 1
                unpacked "g++-12-$triplet" "gcc-12-$triplet" "cpp-12-$triplet" "binutils-$triplet" "libc6-dev-$arch-cross" \
                    "libc6-$arch-cross" "linux-libc-dev-$arch-cross" "libstdc++-12-dev-$arch-cross" \
                    "libgcc-12-dev-$arch-cross" "libstdc++6-$arch-cross" "libgcc-s1-$arch-cross" || return 1
                ;;
            *) installed "$need" || return 1 ;;
        esac
    done
}

# --- one configuration after another -----------------------------------------------------------------------------------

seconds() { awk -v a="$1" -v b="$(date +%s.%N)" 'BEGIN { printf "%.0f", b - a }'; }

processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
log=$out/platforms.md
{
    printf '<!-- SPDX-License-Identifier: MIT -->\n# Platforms\n\n'
    printf 'Written by `sh tests/platform/run.sh`. Each line is a program that asks what [tests/platform](../../tests/platform) asks and\n'
    printf 'compares all bits with a table made on x86-64.\n\n'
    printf '%s, commit %s, %s, %s jobs at a time.\n\n' "$(date -u +%Y-%m-%d)" "$commit" "${processor:-unknown processor}" "$jobs"
    printf '```text\n%-27s %-18s %-42s %6s %6s  %s\n' configuration compiler options compile run answers
} >$log

expected=$(grep -c '^[^#]' $here/hashes.txt)
parts=$((jobs < 4 ? jobs : 4))
equal=0 bad=0 skipped=0
line() { # of the log and of the screen
    printf '%-27s %-18s %-42s %4s s %4s s  %s\n' "$@" | tee -a $log
}

for name in $chosen; do
    entry=$(printf '%s\n' "$configurations" | awk -F'|' -v n="$name" '$1 == n')
    compiler=$(printf '%s' "$entry" | cut -d'|' -f2) standard=$(printf '%s' "$entry" | cut -d'|' -f3)
    options="-std=$standard $(printf '%s' "$entry" | cut -d'|' -f4)"
    needs=$(printf '%s' "$entry" | cut -d'|' -f5) runner=$(printf '%s' "$entry" | cut -d'|' -f6)
    case $compiler in clang++-14) options=$(printf '%s' "$options" | sed 's/c++23/c++2b/') ;; esac
    # shellcheck disable=SC2086
    if ! bring $needs; then
        skipped=$((skipped + 1))
        line "$name" "$compiler" "$options" - - "skipped: $reason"
        continue
    fi
    # What is unpacked has its own libraries beside it, and is found without ldconfig: the assembler's, for one.
    libraries=''
    if [ -x "$root/usr/bin/$compiler" ]; then compiler=$root/usr/bin/$compiler libraries=$root/usr/lib/$(uname -m)-linux-gnu; fi
    if [ "$runner" = wine ]; then
        # Debian calls it by one of these names.
        for runner in wine64 wine64-stable wine /usr/lib/wine/wine64; do ! command -v $runner >/dev/null 2>&1 || break; done
    fi
    case $options in
        *haswell*)
            if ! grep -q -w avx2 /proc/cpuinfo || ! grep -q -w fma /proc/cpuinfo; then
                skipped=$((skipped + 1))
                line "$name" "${compiler##*/}" "$options" - - 'skipped: this processor has no AVX2'
                continue
            fi
            ;;
    esac
    version=$("$compiler" -dumpfullversion 2>/dev/null || "$compiler" -dumpversion)
    tree=$out/$name
    rm -rf "$tree"
    mkdir -p "$tree"
    start=$(date +%s.%N)
    # Options for the linker go to the compiler too, which may say that it has no use for them.
    # shellcheck disable=SC2086
    if ! printf '%s\n' $here/*.cpp | LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} xargs -P "$jobs" -I{} sh -c '
            source=$1 tree=$2 compiler=$3
            shift 3
            exec nice -n 10 "$compiler" "$@" -c "$source" -o "$tree/$(basename "$source" .cpp).o"' \
            - {} "$tree" "$compiler" $options -Iinclude ${extra%% -nostdlib++*} >"$tree/log" 2>&1 ||
        ! LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} "$compiler" $options "$tree"/*.o ${extra:+-nostdlib++ ${extra#*-nostdlib++}} -o "$tree/platform.exe" >>"$tree/log" 2>&1; then
        bad=$((bad + 1))
        line "$name" "${compiler##*/} $version" "$options" "$(seconds "$start")" - 'does not compile'
        grep -m 3 -E 'error|undefined' "$tree/log"
        continue
    fi
    compiled=$(seconds "$start") start=$(date +%s.%N)
    # Two that find no folder of wine's settings would both make it.
    if [ "$name" = mingw-w64 ]; then
        WINEDEBUG=-all WINEPREFIX=$root/wine $runner "$tree/platform.exe" --only nothing >/dev/null 2>>"$tree/log" || true
    fi
    # Some processes beside each other: qemu takes twenty times as long as the processor itself.
    part=0 running=''
    while [ $part -lt $parts ]; do
        # shellcheck disable=SC2086
        WINEDEBUG=-all WINEPREFIX=$root/wine nice -n 10 $runner "$tree/platform.exe" --part $part $parts $here/hashes.txt \
            >"$tree/answers.$part" 2>>"$tree/log" &
        running="$running $!" part=$((part + 1))
    done
    status=0
    for process in $running; do wait "$process" || status=$?; done
    cat "$tree"/answers.* >"$tree/answers"
    ran=$(seconds "$start")
    rows=$(tr -d '\r' <"$tree/answers" | awk '/^equal: / { n += $2 } END { print n + 0 }')
    if [ $status = 0 ] && [ "$rows" = "$expected" ]; then
        equal=$((equal + 1))
        line "$name" "${compiler##*/} $version" "$options" "$compiled" "$ran" "equal, $rows rows"
    else
        bad=$((bad + 1))
        line "$name" "${compiler##*/} $version" "$options" "$compiled" "$ran" \
            "$(grep -c '^differs' "$tree/answers") rows differ, $rows of $expected are equal (exit status $status)"
        tr -d '\r' <"$tree/answers" | grep '^differs' | head -n 20
    fi
done

printf '\n%s equal, %s not, %s skipped; the page is %s\n' $equal $bad $skipped $log
printf '```\n' >>$log
if [ $write = yes ]; then cp $log docs/results/platforms.md; fi
if [ $bad != 0 ]; then exit 1; fi
if [ $skipped != 0 ] && is_required packages; then exit 1; fi
if [ $equal = 0 ]; then exit 2; fi
