# SPDX-License-Identifier: MIT
#
# What reference.sh and site.sh begin with; they source it, and set `name` and `packages` before. Prints the usage of the script where
# that is asked for, goes to the project's root, brings the packages, and sets `folder`, the script's argument or build/NAME, and
# `version`. POSIX sh.

case ${1:-} in -*) sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
folder=${1:-}
[ -z "$folder" ] || { mkdir -p "$folder" && folder=$(cd "$folder" && pwd); }
cd "$(dirname "$0")/.."
. cmake/common.sh

# shellcheck disable=SC2086,SC2154
need_packages $packages
# shellcheck disable=SC2154
: "${folder:=$(pwd)/build/$name}"
mkdir -p "$folder"
# shellcheck disable=SC2034
version=$(sed -n 's/^#define ABUT_VERSION_[A-Z]* \([0-9]*\)$/\1/p' include/abut/config.hpp | paste -sd. -)
