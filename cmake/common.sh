# SPDX-License-Identifier: MIT
#
# What demo.sh, test.sh and view.sh share; they source it. POSIX sh.

say() { printf '\n== %s\n' "$*"; }
fail() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 1; }

# shellcheck disable=SC2034
jobs=$(nproc 2>/dev/null || echo 2)

# is_required WHAT: whether ABUT_REQUIRE, words with spaces between, names it.
is_required() {
    case " ${ABUT_REQUIRE:-} " in *" $1 "*) return 0 ;; esac
    return 1
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        env DEBIAN_FRONTEND=noninteractive "$@"
    elif command -v sudo >/dev/null 2>&1; then
        sudo env DEBIAN_FRONTEND=noninteractive "$@"
    else
        fail "needs root or sudo for: $*"
    fi
}

have_package() {
    # A program of that name will do, whoever installed it.
    case $1 in
        cmake | g++ | clang | ccache | doxygen | python3) command -v "$1" >/dev/null 2>&1 && return 0 ;;
        nodejs) command -v node >/dev/null 2>&1 && return 0 ;;
        npm | chromium) command -v "$1" >/dev/null 2>&1 && return 0 ;;
        ninja-build) command -v ninja >/dev/null 2>&1 && return 0 ;;
    esac
    dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'
}

missing_of() {
    for package in "$@"; do
        have_package "$package" || printf '%s ' "$package"
    done
}

# Once in a run: it takes seconds.
lists_are_new=no
update_lists() {
    [ $lists_are_new = no ] || return 0
    lists_are_new=yes
    as_root apt-get update -qq || printf 'apt-get update failed; going on with the package lists that are there\n'
}

# need_packages PACKAGE...: installs those that are missing, or fails.
need_packages() {
    missing=$(missing_of "$@")
    [ -n "$missing" ] || return 0
    say "installing what is missing: $missing"
    command -v apt-get >/dev/null 2>&1 || fail "no apt-get here; please install the counterparts of: $missing"
    update_lists
    # shellcheck disable=SC2086
    as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null || fail "apt-get could not install: $missing"
}

# want_packages PACKAGE...: the same, but a distribution that lacks one is no failure: what needs it is left out. Where
# ABUT_REQUIRE names packages, it is one.
want_packages() {
    missing=$(missing_of "$@")
    [ -n "$missing" ] || return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        if is_required packages; then fail "ABUT_REQUIRE asks for packages: no apt-get here to install: $missing"; fi
        return 0
    fi
    update_lists
    # shellcheck disable=SC2086
    in_lists=$(apt-cache --no-all-versions show $missing 2>/dev/null | sed -n 's/^Package: //p')
    known=''
    for package in $missing; do
        if printf '%s\n' "$in_lists" | grep -Fqx "$package"; then
            known="$known $package"
        elif is_required packages; then
            fail "ABUT_REQUIRE asks for packages: this distribution has no package $package"
        else
            printf 'this distribution has no package %s; what needs it is left out\n' "$package"
        fi
    done
    # shellcheck disable=SC2086
    [ -z "$known" ] || need_packages $known
}

# installed_of PACKAGE...: those that are installed as packages, with semicolons between.
installed_of() {
    installed=''
    for package in "$@"; do
        if dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed'; then installed="$installed;$package"; fi
    done
    printf '%s' "${installed#;}"
}

# Sets nvcc to the compiler's path if it is 13.0 or newer, else to nothing. Fails instead if ABUT_REQUIRE_CUDA=1.
find_nvcc() {
    nvcc=$(command -v nvcc 2>/dev/null || true)
    if [ -z "$nvcc" ] && [ -x /usr/local/cuda/bin/nvcc ]; then nvcc=/usr/local/cuda/bin/nvcc; fi
    version=''
    if [ -n "$nvcc" ]; then
        version=$("$nvcc" --version 2>/dev/null | sed -n 's/.*release \([0-9][0-9]*\)\..*/\1/p')
    fi
    if [ "${version:-0}" -ge 13 ]; then
        say "CUDA: using $nvcc"
        return 0
    fi
    nvcc=''
    [ "${ABUT_REQUIRE_CUDA:-0}" != 1 ] || fail 'ABUT_REQUIRE_CUDA=1, but there is no nvcc 13.0 or newer'
    say 'CUDA: left out, there is no nvcc 13.0 or newer in PATH or /usr/local/cuda/bin'
}

cuda_device_present() {
    [ -n "$nvcc" ] && command -v nvidia-smi >/dev/null 2>&1 && nvidia-smi -L 2>/dev/null | grep -q '^GPU '
}

# What the page of docs/viewer is made with and shown by: wanted, for without some of it the page has less.
# shellcheck disable=SC2034
viewer_packages='nodejs npm chromium fonts-dejavu-core clang lld wasi-libc libc++-dev-wasm32 libclang-rt-dev-wasm32
    libboost-dev'
