#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Loads a scene of 100 MB beside the one that is shown: the window stays alive, Cancel and bad files keep what there is,
# and memory stays in bounds.
#
#     use_loading.sh PENUMBRA PERSON FRAME_LOG_LIBRARY BIG_SCENE        exit status 77: left out, a tool is missing
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"
bigScene=$4

memory() { awk '/^VmHWM/ { print $2 * 1024 }' "/proc/$program/status"; } # most bytes ever held
spread() { # of frames from line $1 to $2 of the log: count; median, 95th percentile and longest of column $3
    sed -n "$1,$2p" "$folder/frames" | sort -k"$3" -n | awk -v k="$3" '{ work[NR] = $k } END {
        printf "%d %.0f %.0f %.0f\n", NR, work[int((NR + 1) / 2)], work[int(NR * 0.95 + 0.5)], work[NR] }'
}
tell() { # what, from line, to line
    local count median most longest own
    read -r count median most longest < <(spread "$2" "$3" 2)
    read -r _ own < <(spread "$2" "$3" 3)
    echo "frames $1: $count, median $median ms, 95th percentile $most ms, longest $longest ms"
    echo "    without the wait for a processor: ${own// / \/ } ms"
}
read -r geometry decoded < <("$bigScene" "$folder/big.glb" 100)
head -c 60000000 "$folder/big.glb" >"$folder/cut.glb"

start --size 1280x720 --technique hard

# What is seen in the view's lower left corner, where the bar is, and above it, which a message dims.
low() { "$person" look "$window" 20 645 200 50 | cksum; }
high() { "$person" look "$window" 20 60 40 40 | cksum; }
barShown() { [[ $(low) != "$noBar" ]]; }
barGone() { [[ $(low) == "$noBar" ]]; }
dimmed() { [[ $(high) != "$clear" ]]; }
cleared() { [[ $(high) == "$clear" ]]; }
hand mousemove 640 20
noBar=$(low) clear=$(high)
last=$(picture) || fail "F12 wrote no picture"
hand mousemove 640 20

# What a frame costs with nothing to load, while the mouse keeps it going.
from=$(shown)
for i in $(seq 40); do xdotool mousemove $((300 + 5 * i)) 650; frames 1; done
to=$(shown)
tell "without loading" "$from" "$to"
read -r _ _ _ longest < <(spread "$from" "$to" 3)

baseline=$(memory)

# Cancelled by Escape and by its button: the old scene stays.
for cancel in "key Escape" "mousemove 425 684 click 1"; do
    "$person" drop "$window" "$folder/big.glb" || fail "the window did not take a dropped file"
    until_ barShown
    hand $cancel
    hand mousemove 640 20
    until_ barGone # and the message about it
    [[ $(title) == courtyard* ]] || fail "a cancelled scene came all the same: $(title)"
done
keeps true

# A file that ends too soon: a message, and the old scene stays.
"$person" drop "$window" "$folder/cut.glb" || fail "the window did not take a dropped file"
until_ dimmed
hand key Escape
until_ cleared
[[ $(title) == courtyard* ]] || fail "half a file came: $(title)"
keeps true

from=$(shown)
"$person" drop "$window" "$folder/big.glb" || fail "the window did not take a dropped file"
waitTitle big
frames 10 # the first of the new scene take longest
to=$(shown)
tell "while loading 100 MB" "$from" "$to"
read -r count _ _ longest2 < <(spread "$from" "$to" 3)
((count > 10)) || fail "only $count frames while the scene was loading"
# A quiet machine shows no frame of 50 ms more; here only what a busy one cannot bring about is an error.
((longest2 <= longest + 300)) || fail "a frame took $longest2 ms while loading, $longest ms at most before"
peak=$(memory)
awk -v peak="$peak" -v base="$baseline" -v data=$((geometry + decoded)) 'BEGIN {
    printf "memory: %.0f MB above the baseline for %.0f MB of vertices and pictures, %.2f times\n",
        (peak - base) / 1e6, data / 1e6, (peak - base) / data
    exit !(peak - base <= 3 * data) }' || fail "too much memory"
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
