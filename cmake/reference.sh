#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/reference.sh [FOLDER]
#
# Makes the API reference from the headers: FOLDER/html/index.html, by default below build/reference. Needs doxygen, which is
# installed from Debian's or Ubuntu's packages where it is missing. Fails where a public name has no comment.
set -eu
name=reference packages=doxygen
. "$(dirname "$0")/doxygen.sh"

{
    cat docs/reference/Doxyfile
    printf 'PROJECT_NUMBER = %s\nOUTPUT_DIRECTORY = "%s"\n' "$version" "$folder"
} | doxygen - || fail 'a comment is missing or cannot be read, as said above'
say "the reference is $folder/html/index.html"
