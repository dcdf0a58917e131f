#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Moves camera and light in a real window, by mouse and by keys alone.
#
#     use_navigation.sh PENUMBRA PERSON FRAME_LOG_LIBRARY        exit status 77: left out, a tool is missing
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

doubleClick() { hand mousemove "$1" "$2"; hand click --repeat 2 --delay 40 1; }
shortly() { hand keydown "$1"; frames 3; hand keyup "$1"; }
isFirst() { # a step that must lead back to the first picture
    "$@"
    last=$(picture) || fail "no picture after: $*"
    differ "$first" "$last" && fail "not as at first after: $*"
    return 0
}

# A near light of some size, so that each of its movements shows.
start --size 1000x640 --technique pcss --light 3,6,4,0,0.5,0 --light-shape disk --light-size 0.8
first=$(picture) || fail "F12 wrote no picture"
last=$first

changes drag 400 400 480 430
changes drag 400 400 480 430 2
changes hold shift drag 400 400 450 380
changes hold ctrl drag 400 400 400 440
changes drag 400 400 430 390 3
changes wheel 400 400 2
changes doubleClick 300 500
isFirst hand key Home
for key in Left Up Page_Up; do changes hand key "$key"; done
for key in shift+Right ctrl+Down shift+Up; do changes hand key "$key"; done
for key in w a s d e q; do changes shortly "$key"; done
keeps hand key equal # flies faster from now on
changes shortly w
changes hand key f
isFirst hand key c # the first of the scene's cameras is its own

changes hold l drag 400 400 460 420
changes hold l wheel 400 400 2
changes hold l hold shift drag 400 400 430 420
changes hold l hand key Left
changes hold l hand key Page_Down
changes hold l shortly e
changes hand key period
changes hand key comma
changes hold l doubleClick 300 500
changes hold l hand key Home # the scene's own
first=$last
changes hand key Left
isFirst hand key Home
changes hold l drag 400 400 430 380
isFirst hold l hand key c # the first of the scene's lights is its own

keeps hand key g # the handles are not of the picture
"$person" close "$window"
ended "closing the window"

# A light that faces away from the camera, a metre wide, in the middle of the view. At 8 metres a metre is a sixth of the
# view's height.
start --size 1280x720 --technique hard --camera 0,2,8,0,2,0 --light 0,2,0,0,2,-4 --light-shape disk --light-size 1.5
eval "$(xdotool getwindowgeometry --shell "$window")"
size=$(sizeOf "$(picture)")
x=$((${size%x*} / 2)) y=$((HEIGHT - ${size#*x} / 2)) radius=$((${size#*x} * 75 / 663))
last=$(picture)
keeps drag "$x" "$y" "$x" "$y"
hand key g
changes drag $((x + radius)) "$y" $((x + radius + 30)) "$y" # the edge
changes drag "$x" "$y" $((x + 60)) $((y - 50)) # the target lies behind the centre
changes drag $((x + 60)) $((y - 50)) "$x" "$y"
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
