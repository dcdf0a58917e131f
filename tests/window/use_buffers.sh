#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses the buffers panel of the real program in a real window, as a person does: picks images and channels, drags the
# range, zooms, pins, freezes, looks at several at once, saves. What it saves as seen tells what was seen.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

# Places in a window of 1280x720.
scene_depth="100 365" scene_normal="100 414" shadow_map="100 587" shadow="100 663"
two_views="260 328" linked="426 328" fit="330 328"
freeze="625 370" save_png="700 370" save_exr="768 370" channel_list="775 398" colour_list="775 427"
low_end="614 505" low_field="655 528" automatic="617 558"
middle="403 538" # of the view

press() { xdotool mousemove $1 $2 sleep 0.1 mousedown "${3:-1}" sleep 0.1 mouseup "${3:-1}" sleep "${4:-0.3}"; }
seen() { saved png press $save_png || fail "nothing was saved $*"; }

soon() { for _ in $(seq 15); do "$@" && return; sleep 0.2; done; return 1; } # slow machines draw late
not() { ! "$@"; }
view() { xdotool mousemove 640 20 sleep 0.5; "$person" look "$window" 220 367 368 340 | cksum; } # its pixels

start two-boxes --technique hard --size 1280x720
xdotool key b
for _ in $(seq 10); do first=$(tries=100 saved png press $save_png) && break; done # a slow machine may still be starting
[[ -n ${first:-} ]] || fail "the panel saved nothing"

depth_of_light=$(press $shadow_map && seen "of the shadow map")
[[ $(head -c 8 "$depth_of_light" | od -An -tx1 | tr -d ' ') == 89504e470d0a1a0a ]] || fail "$depth_of_light is no PNG"
[[ $(basename "$depth_of_light") == two-boxes-hard-hard.shadow-map-* ]] || fail "named $(basename "$depth_of_light")"
[[ $(sizeOf "$depth_of_light") == 1024x1024 ]] || fail "the shadow map was saved as $(sizeOf "$depth_of_light")"
raw=$(saved exr press $save_exr) || fail "no EXR was saved"
[[ $(head -c 4 "$raw" | od -An -tx1 | tr -d ' ') == 762f3101 ]] || fail "$raw is no OpenEXR file"

press $scene_normal
first=$(seen "of the normals")
press $channel_list
xdotool key Down Down sleep 0.2 key Return sleep 0.3 # below the one that is chosen
press 775 470 1                                       # the list lies below its box
second=$(seen "of another channel")
differ "$first" "$second" || fail "another channel looks the same"

press $scene_depth
plain=$(seen "of the depth")
again=$(seen "of the depth again")
differ "$plain" "$again" && fail "the same image looks different"
drag $low_end 720 505
narrowed=$(seen "after dragging the range")
differ "$plain" "$narrowed" || fail "dragging the histogram's lower end changed nothing"
press $low_field
xdotool key ctrl+a sleep 0.1 type 0.25
xdotool key Tab sleep 0.5
typed=$(seen "after typing an end of the range")
differ "$narrowed" "$typed" || fail "typing an end of the range changed nothing"
press $colour_list
press 775 475
mapped=$(seen "in other colours")
differ "$typed" "$mapped" || fail "another colour map looks the same"

xdotool mousemove $middle
for _ in $(seq 12); do xdotool click 4 sleep 0.05; done
sleep 0.5
near=$(seen "zoomed in")
[[ $(sizeOf "$near") == $(sizeOf "$plain") ]] && fail "zoomed in, all of the image was saved"
drag 403 538 350 520
moved=$(seen "after moving")
differ "$near" "$moved" || fail "dragging the image did not move it"
press $fit
[[ $(sizeOf "$(seen fitted)") == $(sizeOf "$plain") ]] || fail "fitted, not all of the image was saved"

# The pin's frame, in the accent colour, lies round the place that was pressed.
framed() { # whether a pixel left of the middle has the accent's colour
    local colour
    xdotool mousemove 640 20 sleep 0.4
    for colour in $("$person" look "$window" 393 538 9 1); do
        [[ $((16#${colour:0:2})) -gt 200 && $((16#${colour:4:2})) -lt 140 && $((16#${colour:2:2})) -gt 140 ]] && return
    done
    return 1
}
framed && fail "there is a pin before one was set"
press $middle
soon framed || fail "a click pinned nothing"
press $middle 3
soon not framed || fail "a right click did not let the pin go"

press $freeze
still=$(view)
drag 400 150 480 170
sleep 1
[[ $(view) == "$still" ]] || fail "the frozen image changed with the camera"
press $freeze
changed() { [[ $(view) != "$still" ]]; }
soon changed || fail "after freezing the image stayed as it was"

press $two_views
press $shadow # in the first of them
press $linked
alive "two views"
press $automatic
for stroke in b b t b b; do xdotool key "$stroke" sleep 0.4; alive "$stroke"; done
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
