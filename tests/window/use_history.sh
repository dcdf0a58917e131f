#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Freezes, steps and runs the history of a technique in a real window, by keys and by mouse; probes a pixel; starts and
# cancels the measurement of a motion.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

# Places in a window of 1280x720.
step="1045 443" run_to="1103 443" beside="640 424 225 76" # of the drawer: what the probe tells beside its chart
measure="690 469" cancel="835 469"

press() { xdotool mousemove $1 $2 sleep 0.05 mousedown 1; frames 2; xdotool mouseup 1; frames 4; }
look() { "$person" look "$window" $1 | cksum; }
frozen() { # whether the hint at the view's upper right says so: only then it reaches that far, in the accent's colour
    (($("$person" look "$window" 722 44 60 14 | tr -s ' ' '\n' | grep -cE '^(d.|e.)(a.|b.)(5.|6.)$') > 8))
}
view="430 240 60 40"

start two-boxes --technique temporal --size 1280x720 --set start=hard --set neighbourhood=off --set map-size=256
told=$(look "$beside")
tells() { [[ $(look "$beside") != "$told" ]]; }
hand key p # probes the pixel under the pointer, too
hand key shift+n
until_ frozen
tells || fail "the probe tells nothing"
last=$(picture) || fail "no picture after 16 frames"
sixteen=$last
keeps frames 8
changes hand key n
changes press $step
changes hand key r # frozen: the first frame
changes press $run_to
until_ frozen
last=$(picture) || fail "no picture after 16 frames again"
differ "$sixteen" "$last" && fail "16 frames are not the same each time"
changes hand key Right # the camera turns, the past stays
until_ frozen
hand key k
before=$(look "$view")
changed() { [[ $(look "$view") != "$before" ]]; }
until_ changed

# --- another pixel: frozen, too, it is drawn again and tells its numbers
hand key k
until_ frozen
told=$(look "$beside")
press 250 250
until_ tells
alive "the probe"

# --- motion, and a technique without a history
hand key j
press $measure
press $cancel
hand key j
xdotool key ctrl+q
ended "Ctrl+Q"

start two-boxes --technique hard --size 1280x720
last=$(picture) || fail "no picture"
hand key k
changes drag 400 150 460 170
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
