#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses the real program in a real window on a virtual screen, as a person does: pictures, a drag, a dropped file,
# a tiny window, closing.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

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
