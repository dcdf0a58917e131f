#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses the trade-off panel of the real program with the mouse: measures all techniques, points at a dot, takes its values
# by a click, saves chart and table, cancels, and quits while measuring.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

# Places in a window of 1280x720.
measure_all="650 336" cancel="832 336" save_png="660 444" save_csv="711 444" away="700 650"
chart="12 325 528 385" # x, y, width, height

press() { xdotool mousemove $1 $2; frames 2; xdotool mousedown 1; frames 2; xdotool mouseup 1; frames 2; }
techniques=$("$penumbra" list --json | grep -c '^      "id":')
# Whether the table tells of every technique that it was measured side by side, over 20 frames, in the present view.
measured() {
    sleep 1
    table=$(tries=50 saved csv press $save_csv) || return 1
    (($(grep -cE '^[a-z-]+,.*,20,[0-9.e-]+,[0-9.e-]+,[0-9]+,[0-9]+,true,' "$table") == techniques))
}
# Where the chart has a run of seven pixels of the second technique's colour: its dot. "X Y", or nothing.
dot() {
    set -- $chart
    "$person" look "$window" "$1" "$2" "$3" "$4" | tr -s ' \n' '\n\n' | awk -v left="$1" -v top="$2" -v width="$3" '
        function near(a, b) { return a - b < 12 && b - a < 12 }
        function byte(at) { return 16 * index(digits, substr($1, at, 1)) + index(digits, substr($1, at + 1, 1)) - 17 }
        BEGIN { digits = "0123456789abcdef" }
        {
            run = near(byte(1), 242) && near(byte(3), 121) && near(byte(5), 149) ? run + 1 : 0
            if (run == 7 && !found++) print left + (NR - 1) % width - 3, top + int((NR - 1) / width)
        }'
}

small=(--set light-sampling.samples=2) # all are measured over and over: small maps do
for id in $("$penumbra" list --json | sed -n 's/^      "id": "\(.*\)",$/\1/p' | grep -v none); do
    small+=(--set "$id.map-size=256")
done
start two-boxes --technique pcss --size 1280x720 "${small[@]}"
hand key m
press $measure_all
xdotool mousemove $away
until_ measured
hand mousemove $away

place=$(dot)
[[ -n $place ]] || fail "the chart shows no dot of hard shadows"
plain=$("$person" look "$window" $chart | cksum)
xdotool mousemove $place
frames 4
[[ $("$person" look "$window" $chart | cksum) != "$plain" ]] || fail "pointing at a dot tells nothing"
press $place
view=$(picture) || fail "no picture after a click on a dot"
grep -aqE '"(id|technique)": ?"hard"' "$view" || fail "the click did not choose hard shadows"

hand mousemove $away
png=$(saved png press $save_png) || fail "the chart was not saved"
[[ $(basename "$png") == two-boxes-hard-trade-off-* && $(sizeOf "$png") == 528x385 ]] ||
    fail "the chart was saved as $(basename "$png") of $(sizeOf "$png") pixels"

# Another view has points of its own.
drag 400 150 460 170
hand mousemove $away
ready=$("$person" look "$window" 800 330 60 12 | cksum)
[[ -z $(dot) ]] || fail "points of another view are shown"
press $measure_all
press $cancel
xdotool mousemove $away
stopped() { [[ $("$person" look "$window" 800 330 60 12 | cksum) == "$ready" ]]; } # the button is whole again
until_ stopped
press $measure_all
xdotool key ctrl+q
ended "Ctrl+Q while measuring"
echo "all done"
