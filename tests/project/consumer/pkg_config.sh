#!/bin/sh
# SPDX-License-Identifier: MIT
#
# pkg_config.sh CMAKE BUILD WORK VERSION: installs BUILD, moves the install tree, and compiles touch.cpp as pkg-config says.
set -eu
cmake=$1 build=$2 work=$3 version=$4
here=$(cd "$(dirname "$0")" && pwd)

if ! command -v pkg-config >/dev/null 2>&1; then
    echo 'abut skips: there is no pkg-config'
    exit 0
fi
rm -rf "$work"
mkdir -p "$work"
"$cmake" --install "$build" --prefix "$work/first" >"$work/install.log"
mv "$work/first" "$work/moved"
export PKG_CONFIG_PATH="$work/moved/share/pkgconfig"
said=$(pkg-config --modversion abut)
[ "$said" = "$version" ] || { echo "pkg-config says $said, and the version is $version"; exit 1; }
cp "$here/touch.cpp" "$work"
cd "$work"
# shellcheck disable=SC2046
g++ -std=c++20 -O2 -fopenmp $(pkg-config --cflags abut) touch.cpp -o touch
./touch | grep -Fx 'touching: 0 1'
