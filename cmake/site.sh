#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh cmake/site.sh [FOLDER]
#
# Makes a site of README.md, docs and the reference, with a field that finds names, pages and topics, and a page that finds words in the
# text: FOLDER/html/index.html, by default below build/site. It needs no server and no network. Needs doxygen, python3 and libjs-lunr,
# which are installed from Debian's or Ubuntu's packages where they are missing.
set -eu
name=site packages='doxygen python3 libjs-lunr'
. "$(dirname "$0")/doxygen.sh"

python3 -B docs/reference/site.py "$(pwd)" "$folder" "$version" /usr/share/javascript/lunr/lunr.js
doxygen "$folder/Doxyfile" 2>"$folder/warnings.txt" || { cat "$folder/warnings.txt"; fail 'doxygen failed'; }
cp -R "$folder/files" "$folder/html/files"
say "the site is $folder/html/index.html"
