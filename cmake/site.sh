#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/site.sh [FOLDER]
#
# Makes a site of README.md, docs and the reference, with a field that finds names, pages and topics: FOLDER/html/index.html, by
# default below build/site. It needs no server and no network. Needs doxygen and python3, which are installed from Debian's or Ubuntu's
# packages where they are missing.
set -eu
case ${1:-} in -*) sed -n '/^# usage/,/^set/s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
folder=${1:-}
[ -z "$folder" ] || { mkdir -p "$folder" && folder=$(cd "$folder" && pwd); }
cd "$(dirname "$0")/.."
. cmake/common.sh

need_packages doxygen python3
: "${folder:=$(pwd)/build/site}"
mkdir -p "$folder"
version=$(sed -n 's/^#define ABUT_VERSION_[A-Z]* \([0-9]*\)$/\1/p' include/abut/config.hpp | paste -sd. -)
python3 -B docs/reference/site.py "$(pwd)" "$folder" "$version"
doxygen "$folder/Doxyfile" 2>"$folder/warnings.txt" || { cat "$folder/warnings.txt"; fail 'doxygen failed'; }
cp -R "$folder/files" "$folder/html/files"
say "the site is $folder/html/index.html"
