#!/bin/sh
# SPDX-License-Identifier: MIT
#
# deb.sh CMAKE CPACK BUILD WORK VERSION COMPILER: makes the Debian package of BUILD, unpacks it where nothing else is, and builds touch.cpp
# with what lies there.
set -eu
cmake=$1 cpack=$2 build=$3 work=$4 version=$5 compiler=$6
here=$(cd "$(dirname "$0")" && pwd)

if ! command -v dpkg-deb >/dev/null 2>&1; then
    echo 'abut skips: there is no dpkg-deb'
    exit 0
fi
fail() { echo "$*"; exit 1; }
rm -rf "$work"
mkdir -p "$work"
"$cpack" --config "$build/CPackConfig.cmake" -G DEB -B "$work/pack" >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
deb=$(find "$work/pack" -maxdepth 1 -name "libabut-dev_${version}_*.deb")
[ -f "$deb" ] || fail "cpack made no libabut-dev_${version}_*.deb"
[ "$(dpkg-deb -f "$deb" Version)" = "$version" ] || fail "$(dpkg-deb -f "$deb" Version) is not the version"
dpkg-deb -x "$deb" "$work/root"
outside=$(cd "$work/root" && find . -type f | grep -v '^\./usr/\(include/abut/\|lib/\|share/doc/libabut-dev/\|share/pkgconfig/abut\.pc$\)') || true
[ -z "$outside" ] || fail "installed where nothing is to be: $outside"
for file in copyright changelog.gz; do
    [ -f "$work/root/usr/share/doc/libabut-dev/$file" ] || fail "there is no $file"
done
# No file of the package may name the folder where it was made.
if grep -rFl -e "$build" -e "$work" "$work/root"; then fail 'these files name the folder that they were made in'; fi

"$cmake" -S "$here" -B "$work/build" -D CMAKE_CXX_COMPILER="$compiler" -D CONSUMER_WAY=package -D CONSUMER_COMPONENTS=io \
    -D CONSUMER_VERSION="$version" -D CMAKE_PREFIX_PATH="$work/root/usr" -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
grep -F "abut_DIR:PATH=$work/root/usr/" "$work/build/CMakeCache.txt"
"$cmake" --build "$work/build"
"$work/build/touch" | grep -Fx 'touching: 0 1'
