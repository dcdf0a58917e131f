#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses the real program in a real window on a virtual screen, as a person does: pictures, a drag, a dropped file,
# a tiny window, closing.
#
#     use_window.sh PENUMBRA PERSON        exit status 77: left out, a tool is missing
set -euo pipefail
penumbra=$1 person=$2
for tool in Xvfb xdotool; do
    command -v "$tool" >/dev/null || { echo "left out: $tool is not installed"; exit 77; }
done

folder=$(mktemp -d)
server= program=
finish() {
    if [[ -n $program ]]; then kill "$program" 2>/dev/null || true; fi
    if [[ -n $server ]]; then kill "$server" 2>/dev/null || true; fi
    rm -rf "$folder"
}
trap finish EXIT
fail() { echo "FAILED: $*"; cat "$folder/stderr"; exit 1; }

mkdir -p "$folder/home/Pictures"
export HOME=$folder/home PENUMBRA_CONFIG_DIR=$folder/config LIBGL_ALWAYS_SOFTWARE=1
export ASAN_OPTIONS=detect_leaks=0 # graphics drivers keep memory until the end
touch "$folder/stderr"
unset WAYLAND_DISPLAY
# Without -noreset the server starts anew when its last client leaves, and a program that comes just then finds none.
Xvfb -noreset -displayfd 1 -screen 0 1280x720x24 -nolisten tcp >"$folder/display" 2>/dev/null & server=$!
for _ in $(seq 200); do grep -q '^[0-9]' "$folder/display" && break; sleep 0.1; done
export DISPLAY=:$(head -n 1 "$folder/display")
xdotool getdisplaygeometry >/dev/null || { echo "left out: no virtual screen"; exit 77; }

window=
start() {
    "$penumbra" "$@" 2>"$folder/stderr" & program=$!
    for _ in $(seq 300); do
        window=$(xdotool search --onlyvisible --name Penumbra 2>/dev/null | head -n 1 || true) && [[ -n $window ]] && break
        kill -0 "$program" 2>/dev/null || fail "the program ended before it showed a window"
        sleep 0.1
    done
    [[ -n $window ]] || fail "no window"
    xdotool mousemove 400 400
    sleep 2
}
alive() { kill -0 "$program" 2>/dev/null || fail "the program is gone after: $*"; }
ended() { # waits for the end and demands exit status 0
    for _ in $(seq 100); do kill -0 "$program" 2>/dev/null || break; sleep 0.1; done
    kill -0 "$program" 2>/dev/null && fail "still there after: $*"
    status=0
    wait "$program" || status=$?
    program=
    [[ $status == 0 ]] || fail "exit status $status after: $*"
}
pictures() { find "$HOME/Pictures" -name '*.png' -printf '%T@ %p\n' | sort -n | cut -d' ' -f2-; }
picture() { # strikes F12 and names the new file
    local before now
    before=$(pictures | wc -l)
    xdotool mousemove 400 400 key F12
    for _ in $(seq 200); do
        now=$(pictures | wc -l)
        # Files appear whole: they are renamed into place.
        ((now > before)) && { sleep 0.2; pictures | tail -n 1; return; }
        sleep 0.1
    done
    return 1
}
drag() { # from X Y to X2 Y2, slowly enough for a frame in between
    xdotool mousemove "$1" "$2" sleep 0.3 mousedown "${5:-1}" sleep 0.3
    for i in 1 2 3 4 5; do
        xdotool mousemove $(($1 + ($3 - $1) * i / 5)) $(($2 + ($4 - $2) * i / 5)) sleep 0.15
    done
    xdotool mouseup "${5:-1}" sleep 0.5
}
sizeOf() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'; } # of a PNG
differ() { ! cmp -s "$1" "$2"; }
title() { xdotool getwindowname "$window"; }
waitTitle() { for _ in $(seq 100); do [[ $(title) == "$1"* ]] && return; sleep 0.1; done; fail "the title is '$(title)', not '$1'"; }

quad=AACAvwAAAAAAAIC/AACAPwAAAAAAAIC/AACAPwAAAAAAAIA/AACAvwAAAAAAAIA/AAACAAEAAAADAAIA
cat >"$folder/square table.gltf" <<GLTF
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]},
               {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,$quad"}]}
GLTF
echo '{"asset": {"version": "2.0"}, "scene": 7' >"$folder/broken.gltf"

start --size 1280x720
first=$(picture) || fail "F12 wrote no picture"
[[ $(head -c 8 "$first" | od -An -tx1 | tr -d ' ') == 89504e470d0a1a0a ]] || fail "$first is no PNG"
[[ $(basename "$first") == courtyard-*.png ]] || fail "the picture is named $(basename "$first")"
again=$(picture) || fail "F12 wrote no second picture"
differ "$first" "$again" && fail "two pictures of the same thing differ"

# The side panel's end holds the ambient light in its last row and the exposure in the row above.
xdotool mousemove 1000 400 sleep 0.3
for _ in $(seq 60); do xdotool click 5; done
sleep 1
drag 1120 670 1220 670
brighter=$(picture) || fail "no picture after dragging"
differ "$first" "$brighter" || fail "dragging the exposure changed nothing"
drag 400 400 500 430
turned=$(picture) || fail "no picture after orbiting"
differ "$brighter" "$turned" || fail "orbiting the camera changed nothing"
xdotool mousemove 400 400 keydown l sleep 0.3
drag 400 400 500 430
xdotool keyup l
lit=$(picture) || fail "no picture after turning the light"
differ "$turned" "$lit" || fail "turning the light changed nothing"

xdotool windowsize "$window" 60 40
sleep 1.5
alive "60 x 40 pixels"
xdotool windowsize "$window" 1 1
sleep 1.5
alive "1 x 1 pixels"
xdotool windowsize "$window" 1280 720
for _ in $(seq 100); do xdotool getwindowgeometry "$window" | grep -q 1280x720 && break; sleep 0.1; done
sleep 2
alive "the old size"
back=$(picture) || fail "no picture after resizing"
differ "$lit" "$back" && fail "the picture changed by resizing to and fro: $(sizeOf "$lit"), then $(sizeOf "$back")"

"$person" drop "$window" "$folder/broken.gltf" || fail "the window did not take a dropped file"
sleep 1
alive "a broken file"
[[ $(title) == courtyard* ]] || fail "a broken file replaced the scene by '$(title)'"
xdotool mousemove 400 400 key Escape
sleep 1
"$person" drop "$window" "$folder/square%20table.gltf" || fail "the window did not take a dropped file"
waitTitle "square table"
sleep 1
dropped=$(picture) || fail "no picture of the dropped scene"
[[ $(basename "$dropped") == "square table-"* ]] || fail "the picture is named $(basename "$dropped")"
for stroke in b t t h Escape v space r f; do xdotool key "$stroke" sleep 0.5; alive "$stroke"; done
"$person" close "$window"
ended "closing the window"

start --size 1280x720
xdotool key ctrl+q
ended "Ctrl+Q"

# Files that cannot be written are told in the window, not by its end.
touch "$folder/wall"
PENUMBRA_CONFIG_DIR=$folder/wall/config start --size 640x480
rm -r "$HOME/Pictures"
touch "$HOME/Pictures"
xdotool key F12
sleep 1
alive "a picture folder that is none"
xdotool key Escape sleep 0.5 key ctrl+q
ended "Ctrl+Q after a message"
echo "all done"
