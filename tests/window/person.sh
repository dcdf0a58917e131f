# SPDX-License-Identifier: MIT
# What a person does at a virtual screen, for the scripts that source this. They are called with
#
#     PENUMBRA PERSON        exit status 77: left out, a tool is missing
set -euo pipefail
penumbra=$1 person=$2
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
export ASAN_OPTIONS=detect_leaks=0 # graphics drivers keep memory until the end
touch "$folder/stderr"
unset WAYLAND_DISPLAY
# Without -noreset the server starts anew when its last client leaves, and a program that comes just then finds none.
Xvfb -noreset -displayfd 1 -screen 0 1280x720x24 -nolisten tcp >"$folder/display" 2>/dev/null & server=$!
for _ in $(seq 200); do grep -q '^[0-9]' "$folder/display" && break; sleep 0.1; done
export DISPLAY=:$(head -n 1 "$folder/display")
xdotool getdisplaygeometry >/dev/null || { echo "left out: no virtual screen"; exit 77; }

window=
start() {
    "$penumbra" "$@" 2>"$folder/stderr" & program=$!
    for _ in $(seq 300); do
        window=$(xdotool search --onlyvisible --name Penumbra 2>/dev/null | head -n 1 || true) && [[ -n $window ]] && break
        kill -0 "$program" 2>/dev/null || fail "the program ended before it showed a window"
        sleep 0.1
    done
    [[ -n $window ]] || fail "no window"
    xdotool mousemove 400 400
    sleep 2
}
alive() { kill -0 "$program" 2>/dev/null || fail "the program is gone after: $*"; }
ended() { # waits for the end and demands exit status 0
    for _ in $(seq 100); do kill -0 "$program" 2>/dev/null || break; sleep 0.1; done
    kill -0 "$program" 2>/dev/null && fail "still there after: $*"
    status=0
    wait "$program" || status=$?
    program=
    [[ $status == 0 ]] || fail "exit status $status after: $*"
}
pictures() { find "$HOME/Pictures" -name '*.png' -printf '%T@ %p\n' | sort -n | cut -d' ' -f2-; }
picture() { # strikes F12 and names the new file
    local before now
    before=$(pictures | wc -l)
    xdotool mousemove 400 400 key F12
    for _ in $(seq 200); do
        now=$(pictures | wc -l)
        # Files appear whole: they are renamed into place.
        ((now > before)) && { sleep 0.2; pictures | tail -n 1; return; }
        sleep 0.1
    done
    return 1
}
drag() { # from X Y to X2 Y2, slowly enough for a frame in between
    xdotool mousemove "$1" "$2" sleep 0.3 mousedown "${5:-1}" sleep 0.3
    for i in 1 2 3 4 5; do
        xdotool mousemove $(($1 + ($3 - $1) * i / 5)) $(($2 + ($4 - $2) * i / 5)) sleep 0.15
    done
    xdotool mouseup "${5:-1}" sleep 0.5
}
sizeOf() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'; } # of a PNG
pixels() { tail -c "+$(grep -abo IDAT "$1" | head -n 1 | cut -d: -f1)" "$1"; } # of a PNG, and all behind them
differ() { ! cmp -s <(pixels "$1") <(pixels "$2"); }
title() { xdotool getwindowname "$window"; }
waitTitle() { for _ in $(seq 100); do [[ $(title) == "$1"* ]] && return; sleep 0.1; done; fail "the title is '$(title)', not '$1'"; }

