#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# An installed tree works, also after it was moved, and reads its own shaders: install_test.sh BUILD_FOLDER
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$1" --prefix "$folder/first" >/dev/null
mv "$folder/first" "$folder/second"
program=$folder/second/bin/penumbra
"$program" capture --size 64x48 -o "$folder/picture.png" >/dev/null
[[ -s $folder/picture.png ]] || { echo "the moved program wrote no picture" >&2; exit 1; }
# Without a shader of its own it must not fall back on the source tree.
rm "$folder/second/share/penumbra/shaders/display.glsl"
if message=$("$program" capture --size 64x48 -o "$folder/picture.png" 2>&1 >/dev/null); then
    echo "the installed program read shaders from elsewhere" >&2
    exit 1
fi
[[ $message == *shaders/display.glsl* ]] || { echo "unexpected message: $message" >&2; exit 1; }
