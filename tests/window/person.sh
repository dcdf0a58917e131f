# SPDX-License-Identifier: MIT
# What a person does at a virtual screen, for the scripts that source this. They are called with
#
#     PENUMBRA PERSON FRAME_LOG_LIBRARY        exit status 77: left out, a tool is missing
#
# Steps wait for frames and for what they bring about, not for a time, so that a busy machine is only slower.
set -euo pipefail
penumbra=$1 person=$2 frameLogLibrary=$3
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
# Graphics drivers keep memory until the end, and the preloaded library comes before the sanitizer's.
export ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0
touch "$folder/stderr"
unset WAYLAND_DISPLAY
# Without -noreset the server starts anew when its last client leaves, and a program that comes just then finds none.
Xvfb -noreset -displayfd 1 -screen 0 "${screen:-1280x720}x24" -nolisten tcp >"$folder/display" 2>/dev/null & server=$!
for _ in $(seq 200); do grep -q '^[0-9]' "$folder/display" && break; sleep 0.1; done
export DISPLAY=:$(head -n 1 "$folder/display")
xdotool getdisplaygeometry >/dev/null || { echo "left out: no virtual screen"; exit 77; }

window=
start() {
    : >"$folder/frames"
    FRAME_LOG=$folder/frames LD_PRELOAD=$frameLogLibrary "$penumbra" "$@" 2>"$folder/stderr" & program=$!
    for _ in $(seq 300); do
        window=$(xdotool search --onlyvisible --name Penumbra 2>/dev/null | head -n 1 || true) && [[ -n $window ]] && break
        kill -0 "$program" 2>/dev/null || fail "the program ended before it showed a window"
        sleep 0.1
    done
    [[ -n $window ]] || fail "no window"
    xdotool mousemove 400 400
    frames 10
}
alive() { kill -0 "$program" 2>/dev/null || fail "the program is gone after: $*"; }
ended() { # waits for the end and demands exit status 0
    for _ in $(seq 300); do kill -0 "$program" 2>/dev/null || break; sleep 0.1; done
    kill -0 "$program" 2>/dev/null && fail "still there after: $*"
    status=0
    wait "$program" || status=$?
    program=
    [[ $status == 0 ]] || fail "exit status $status after: $*"
}
shown() { wc -l <"$folder/frames"; } # frames so far
frames() { # waits for so many more; a window with nothing to do shows ten a second
    local wanted=$(($(shown) + $1))
    for _ in $(seq 1200); do
        (($(shown) >= wanted)) && return
        kill -0 "$program" 2>/dev/null || fail "the program is gone"
        sleep 0.05
    done
    fail "no frames for a minute"
}
until_() { # waits until a command succeeds
    for _ in $(seq 600); do "$@" && return; alive "$*"; sleep 0.1; done
    fail "waited in vain for: $*"
}
hand() { xdotool "$@"; frames 4; } # does it and lets the program answer
files() { # with that ending, the newest last
    find "$HOME/Pictures" -name "*.$1" -printf '%T@ %p\n' | sort -n | cut -d' ' -f2-
}
saved() { # ENDING, then what to do: names the new file that comes of it; gives up after $tries tenths of a second
    local ending=$1 before now
    before=$(files "$ending" | wc -l)
    "${@:2}"
    for _ in $(seq "${tries:-600}"); do
        now=$(files "$ending" | wc -l)
        # Files appear whole: they are renamed into place.
        ((now > before)) && { files "$ending" | tail -n 1; return; }
        sleep 0.1
    done
    return 1
}
picture() { saved png xdotool key F12; }
drag() { # from X Y to X2 Y2 with a button, with frames in between
    hand mousemove "$1" "$2"
    hand mousedown "${5:-1}"
    for i in 1 2 3 4 5; do
        xdotool mousemove $(($1 + ($3 - $1) * i / 5)) $(($2 + ($4 - $2) * i / 5))
        frames 2
    done
    hand mouseup "${5:-1}"
}
wheel() { # X Y NOTCHES, up if positive
    hand mousemove "$1" "$2"
    local button=$(($3 > 0 ? 4 : 5))
    for _ in $(seq "${3#-}"); do xdotool click "$button"; frames 1; done
    frames 4
}
hold() { # KEY, then what to do while it is down
    local key=$1
    shift
    hand keydown "$key"
    "$@"
    hand keyup "$key"
}
sizeOf() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'; } # of a PNG
pixels() { tail -c "+$(grep -abo IDAT "$1" | head -n 1 | cut -d: -f1)" "$1"; } # of a PNG, and all behind them
differ() { ! cmp -s <(pixels "$1") <(pixels "$2"); }
title() { xdotool getwindowname "$window"; }
titled() { [[ $(title) == "$1"* ]]; }
waitTitle() { until_ titled "$1"; }
# What the newest picture remembers of the camera and the light is compared as pixels: the last picture and what it was.
last=
changes() { # a step that must change the picture
    local now
    "$@"
    now=$(picture) || fail "no picture after: $*"
    differ "$last" "$now" || fail "nothing changed by: $*"
    last=$now
}
keeps() { # a step that must not
    local now
    "$@"
    now=$(picture) || fail "no picture after: $*"
    differ "$last" "$now" && fail "the picture changed by: $*"
    last=$now
}
# Seconds of processor time that the program has used.
used() { awk -v tick="$(getconf CLK_TCK)" '{ print ($14 + $15) / tick }' "/proc/$program/stat"; }
