#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/reference.sh [FOLDER]
#
# Makes the API reference from the headers: FOLDER/html/index.html, by default below build/reference. Needs doxygen, which is
# installed from Debian's or Ubuntu's packages where it is missing. Fails where a public name has no comment.
set -eu
case ${1:-} in -*) sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
folder=${1:-}
[ -z "$folder" ] || { mkdir -p "$folder" && folder=$(cd "$folder" && pwd); }
cd "$(dirname "$0")/.."
. cmake/common.sh

need_packages doxygen
: "${folder:=$(pwd)/build/reference}"
mkdir -p "$folder"
version=$(sed -n 's/^#define ABUT_VERSION_[A-Z]* \([0-9]*\)$/\1/p' include/abut/config.hpp | paste -sd. -)
{
    cat docs/reference/Doxyfile
    printf 'PROJECT_NUMBER = %s\nOUTPUT_DIRECTORY = "%s"\n' "$version" "$folder"
} | doxygen - || fail 'a comment is missing or cannot be read, as said above'
say "the reference is $folder/html/index.html"
