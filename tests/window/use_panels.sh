#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses the panels of the real program with mouse and keyboard: typed values, resets, presets, pictures of view and window,
# the folder of pictures, the table of timings, a picture dropped on the window.
source "$(dirname "${BASH_SOURCE[0]}")/person.sh"

click() { xdotool mousemove "$1" "$2" sleep 0.15 mousedown 1 sleep 0.2 mouseup 1 sleep 0.25; }
# Ctrl+click on a slider, then a value.
enter() { xdotool mousemove "$1" "$2" keydown ctrl sleep 0.25 mousedown 1 sleep 0.2 mouseup 1 keyup ctrl sleep 0.25 \
    type --delay 40 "$3"; xdotool key Return sleep 0.3; }
type() { xdotool type --delay 40 "$1"; xdotool sleep 0.2; }
facts() { grep -a -o '{"program".*}}*' "$1" | head -n 1; }
told() { [[ $(facts "$1") == *"$2"* ]] || fail "$3: $(basename "$1") tells no $2 but $(facts "$1")"; }
newest() { find "$1" -name "$2" -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d' ' -f2-; }
waitFor() { # FILE PATTERN: until the folder FILE holds a file of that name
    for _ in $(seq 100); do [[ -n $(newest "$1" "$2") ]] && return; sleep 0.1; done
    fail "no file $2 in $1"
}
gone() { for _ in $(seq 50); do [[ -e $1 ]] || return 0; sleep 0.1; done; fail "$1 is still there"; }
there() { for _ in $(seq 50); do [[ -e $1 ]] && return 0; sleep 0.1; done; fail "there is no $1"; }

# Sections folded above another do not move it when they change. Rows are 29 pixels high.
scene=52 technique=81 parameters=110
slider=1135 reset=1243 # of the rows below, from left to right
firstGroup=145 searchTaps=174 filterTaps=232 slopeBias=534 resetAll=598

start two-boxes --technique pcss --size 1280x720
click 1000 $scene
click 1000 $technique

# --- parameters
enter $slider $searchTaps 33
file=$(picture) || fail "no picture after typing a value"
told "$file" '"search-taps":33' "typing a value"
drag 1089 $filterTaps 1180 $filterTaps
file=$(picture) || fail "F12 wrote no picture"
facts "$file" | grep -q '"filter-taps":16' && fail "dragging a slider changed nothing"
click $reset $searchTaps
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"search-taps":16' "the reset of one value"
facts "$file" | grep -q '"filter-taps":16' && fail "the reset of one value reset another one"
enter $slider $slopeBias 1.25
click $reset $firstGroup
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"filter-taps":16' "the reset of a group"
told "$file" '"slope-bias":1.25' "the reset of another group"
enter $slider $searchTaps 65
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"search-taps":16' "a value out of range"
enter $slider $searchTaps 64
click 920 $resetAll
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"search-taps":16' "the reset of all"
told "$file" '"slope-bias":0.05' "the reset of all"

# --- presets
own=$PENUMBRA_CONFIG_DIR/presets/pcss
enter $slider $searchTaps 48
click 1000 $parameters # folds it
presets=139 choice=168 name=197 buttons=226
click 1000 $presets
click 1140 $name
type "mine"
click 925 $buttons # save
there "$own/mine.json"
tr -d ' \n' <"$own/mine.json" | grep -qxF '{"technique":"pcss","parameters":{"search-taps":48}}' ||
    fail "the preset holds $(cat "$own/mine.json")"
click 1140 $name
xdotool sleep 0.6 keydown ctrl sleep 0.2 key a sleep 0.2 keyup ctrl sleep 0.6
type "my own"
click 1015 $buttons # rename
there "$own/my own.json"
gone "$own/mine.json"
click 1140 $choice
click 1100 279 # the papers' 32-32: yours, my own, of the papers, 16-16, 32-32
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"search-taps":32,"search":"centred","filter-taps":32' "choosing a preset"
click 1140 $choice
click 1100 213 # my own
file=$(picture) || fail "F12 wrote no picture"
told "$file" '"search-taps":48,"search":"centred","filter-taps":16' "choosing an own preset"
click 1100 $buttons # delete
sleep 0.5
click 1107 284 # the question's "Delete it"
gone "$own/my own.json"
alive "presets"

# --- pictures
view=$(picture) || fail "F12 wrote no picture"
"$penumbra" capture --like "$view" -o "$folder/again.png" >/dev/null 2>"$folder/stderr" || fail "--like failed"
cmp -s "$view" "$folder/again.png" || fail "--like made another picture than $view"
whole=$(saved png xdotool mousemove 400 300 key shift+F12) || fail "Shift+F12 wrote no picture"
[[ $(sizeOf "$whole") == 1280x720 ]] || fail "the picture of the window has $(sizeOf "$whole") pixels"
told "$whole" '"panels":true' "Shift+F12"
by_button=$(saved png click 110 16) || fail "the button Picture wrote none"
told "$by_button" '"panels":false' "the button"
click 153 16 # its menu
whole=$(saved png click 250 64) || fail "the menu wrote no picture of the whole window"
[[ $(sizeOf "$whole") == 1280x720 ]] || fail "the menu's picture of the window has $(sizeOf "$whole") pixels"

# --- a picture dropped on the window brings back what it shows
drag 400 300 470 320
turned=$(picture) || fail "F12 wrote no picture"
differ "$view" "$turned" || fail "orbiting changed nothing"
"$person" drop "$window" "$view" || fail "the window did not take a dropped picture"
sleep 3 # loads beside the view
xdotool mousemove 400 300 sleep 0.5
back=$(picture) || fail "F12 wrote no picture"
differ "$view" "$back" && fail "a dropped picture $view gave another one, $(facts "$back")"
"$person" drop "$window" "$folder/stderr" || true # no picture, no scene
sleep 0.5
alive "a dropped file of no sort"
xdotool key Escape sleep 0.5

# --- another folder, and the table of timings in it
click 153 16
click 200 113 # another folder
sleep 0.5
elsewhere=$folder/elsewhere/deep
click 600 170
xdotool sleep 0.6 keydown ctrl sleep 0.2 key a sleep 0.2 keyup ctrl sleep 0.6
type "$elsewhere"
xdotool key Return
there "$PENUMBRA_CONFIG_DIR/settings.json"
grep -qF "\"$elsewhere\"" "$PENUMBRA_CONFIG_DIR/settings.json" || fail "the settings hold $(cat "$PENUMBRA_CONFIG_DIR/settings.json")"
xdotool mousemove 400 200 sleep 0.3 key t sleep 2
click 818 456 # Export CSV
waitFor "$elsewhere" 'two-boxes-pcss-*-timings.csv'
table=$(newest "$elsewhere" '*.csv')
grep -q '^pcss,cost,,cost,[0-9.]*,[0-9.]*,' "$table" || fail "the table holds no cost: $(cat "$table")"
grep -q '^pcss,image,ShadowMap,pcss.shadow-map,,,1024,1024,1,1,1,DEPTH32F,4194304,' "$table" || fail "no images in $table"
xdotool key ctrl+q
ended "Ctrl+Q"

start --size 640x480 two-boxes
xdotool mousemove 200 200 key F12
waitFor "$elsewhere" 'two-boxes-pcss-*.png'
xdotool key ctrl+q
ended "Ctrl+Q"
echo "all done"
