#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Holds a technique to the truth and to another technique in a real window, as a person does: switches the truth on and
# waits for numbers, drags the wipe, flips, looks at errors, measures a penumbra, puts two techniques side by side.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

# Places in a window of 1280x720; the view is 875x689 pixels, 32 below the top.
compare="355 16" technique_b="521 133" scene="1000 52" copy="1085 110"
rmse="800 548 60 18" plot="650 340 210 115" cancel="826 690" cancel_text="800 680 54 20"

press() { xdotool mousemove $1 $2 sleep 0.1 mousedown 1 sleep 0.1 mouseup 1; frames 4; }
look() { "$person" look "$window" $1; }
count() { look "$1" | tr -s ' ' '\n' | grep -cE "$2" || true; } # pixels of such a colour
# On dark paper, more bright pixels than a dash has.
figure() { (($(count "$rmse" '^([2-4].){3}$') > 400 && $(count "$rmse" '^([c-f].){3}$') > 20)); }
looksOther() { [[ $(look "$2" | cksum) != "$1" ]]; }
same() { differ "$1" "$2" && fail "$3" || true; }
again() { # the same picture comes of what its file tells
    "$penumbra" capture --like "$1" -o "$folder/again.png" >/dev/null 2>"$folder/stderr" || fail "--like failed"
    differ "$1" "$folder/again.png" && fail "--like made another picture than $1" || true
}
eye() { grep -a -o '"camera":{[^}]*}' "$1" | head -n 1; }

start two-boxes --technique pcss --size 1280x720
plain=$(picture) || fail "no picture"

# --- the truth and its numbers
figure && fail "there are numbers before they were asked for"
hand key y
until_ figure
press $cancel # the truth stays as it is, so that pictures can be compared
until_ looksOther "$(printf '' | cksum)" "$cancel_text"
last=$plain
keeps true # the truth alone changes nothing of the picture

# --- compared with the technique
changes hand key 1
half=$last
changes drag 437 300 650 300 # the line
differ "$half" "$last" || fail "the line cannot be dragged"
hand key 2
same "$plain" "$(picture)" "a flip does not begin with the technique alone"
changes hand key 2
truth=$last
changes hand key x
same "$plain" "$last" "X does not flip back"
differ "$plain" "$truth" || fail "the truth looks like the technique"
changes hand key 4
map=$last
changes hand key 4 # ten times as strong
hand key 0
now=$(picture)
same "$plain" "$now" "0 does not show the technique alone again"
[[ -n $(eye "$now") && $(eye "$now") == "$(eye "$plain")" ]] || fail "dragging the line moved the camera"

# --- the ruler
without=$(look "$plot" | cksum)
hand key u
until_ looksOther "$without" "$plot"
frames 4
before=$(look "$plot" | cksum)
drag 525 308 600 480 # an end of it
until_ looksOther "$before" "$plot"
same "$plain" "$(picture)" "dragging the ruler moved the camera"
hand key u

# --- technique B
press $compare
press $technique_b
hand key Escape
last=$plain
changes true   # the error map that was chosen last
changes hand key 1 # hard shadows to the right
again "$last"
press $scene # folds it, so that what is below stands still
press $copy
same "$plain" "$(picture)" "a technique differs from its copy"
hand key 3
file=$(picture) || fail "no picture of two side by side"
[[ $(sizeOf "$file") == 874x689 ]] || fail "two pictures side by side are $(sizeOf "$file")"
again "$file"
hand key 0
hand key y
figure && fail "there are numbers after the truth was switched off"
same "$plain" "$(picture)" "in the end the picture is another one"
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
