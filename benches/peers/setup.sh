#!/usr/bin/env bash
# Puts the peers into a folder of your choice, outside the project: setup.sh FOLDER
#   FOLDER/venv         Mitsuba 3, from PyPI
# Mitsuba's llvm variants want an LLVM library; on Debian 12 with AVX-512 that of libllvm19 works, 15 and 16 abort.
set -eu
folder=${1:?usage: setup.sh FOLDER}
mkdir -p "$folder"
ls /usr/lib/*/libLLVM-19.so >/dev/null 2>&1 || { apt-get update -qq; apt-get install -y -qq libllvm19; }
[ -x "$folder/venv/bin/python" ] || python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q mitsuba numpy
echo "peers ready in $folder"
