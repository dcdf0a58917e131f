#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The window stays alive: minimised, hidden, resized, with larger text, and with pictures that take seconds.
#
#     use_life.sh PENUMBRA PERSON FRAME_LOG_LIBRARY        exit status 77: left out, a tool is missing
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

resting() { # nothing shown and next to no work done for two seconds
    local frames before after
    for _ in $(seq 20); do # until it has noticed
        frames=$(shown)
        sleep 0.3
        [[ $(shown) == "$frames" ]] && break
    done
    before=$(used)
    sleep 2
    after=$(used)
    [[ $(shown) == "$frames" ]] || fail "$1: it goes on showing frames"
    awk -v a="$before" -v b="$after" 'BEGIN { exit !(b - a < 0.05) }' || fail "$1: it works from $before s to $after s"
}
sized() { [[ $(sizeOf "$(picture)") == "$1" ]]; }

start --size 1280x720 --technique pcf
last=$(picture) || fail "F12 wrote no picture"
size=$(sizeOf "$last")
"$person" minimise "$window"
resting "minimised"
"$person" restore "$window"
frames 6
keeps true
xdotool windowunmap "$window"
resting "hidden"
xdotool windowmap "$window"
frames 6
keeps true

for _ in 1 2 3 4 5; do hand key ctrl+equal; done
larger=$(sizeOf "$(picture)")
((${larger%x*} < ${size%x*})) || fail "larger text left the view as wide as it was: $larger, $size"
for _ in $(seq 20); do hand key ctrl+minus; done
alive "the smallest text"
hand key ctrl+0
frames 4
keeps true

for size in 700x500 300x900 60x40 1x1 1200x300; do
    xdotool windowsize "$window" "${size%x*}" "${size#*x}"
    frames 3
done
xdotool windowsize "$window" 1280 720
frames 6
keeps true
xdotool key ctrl+q
ended "Ctrl+Q"

# A picture that takes long: the window answers meanwhile, and what it shows at last is what `capture` makes.
slow=(--technique pcf --set shape=gaussian --set kernel=63)
start --size 1280x720 "${slow[@]}"
frames 10
before=$(shown)
hand mousemove 500 400
hand mousedown 1
for i in $(seq 12); do xdotool mousemove $((500 + 5 * i)) $((400 + i)); frames 3; done
hand mouseup 1
after=$(shown)
tail -n $((after - before)) "$folder/frames" | sort -k2 -n | awk '{ work[NR] = $2 } END {
    printf "frames while a dear picture is dragged: %d, median %.0f ms, 95th percentile %.0f ms, longest %.0f ms\n",
        NR, work[int((NR + 1) / 2)], work[int(NR * 0.95)], work[NR] }'
hand key Home
kept=$(picture) || fail "no picture of the slow technique"
"$penumbra" capture courtyard "${slow[@]}" --size "$(sizeOf "$kept")" -o "$folder/captured.png" 2>/dev/null
xdotool key ctrl+q
ended "Ctrl+Q during a slow picture"
differ "$kept" "$folder/captured.png" && fail "the picture in bands is not the captured one"
echo "all done"
