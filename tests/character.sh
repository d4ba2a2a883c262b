#!/usr/bin/env bash
# Builds a robot of 41 parts by hand in the real window, by keys and pointer. Takes a picture after each group of parts, and
# checks the scene that it saves.
#
#   tests/character.sh PROGRAM [FOLDER FOR PICTURES]
set -euo pipefail

program=$(realpath "$1")
pictures=${2:-}
work=$(mktemp -d)
export HOME=$work/home XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data XDG_CONFIG_HOME=$work/config XDG_RUNTIME_DIR=$work/run
# No bus, so no file dialogs but our own.
export DBUS_SESSION_BUS_ADDRESS=disabled:
unset WAYLAND_DISPLAY
mkdir -p -m 700 "$HOME" "$XDG_STATE_HOME/isolith" "$XDG_DATA_HOME" "$XDG_CONFIG_HOME" "$XDG_RUNTIME_DIR"
echo '{"skips_welcome": true}' >"$XDG_STATE_HOME/isolith/preferences.json"

Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
editor=
finish() {
    [ -z "$editor" ] || kill "$editor" 2>/dev/null || true
    kill "$server" 2>/dev/null || true
    rm -rf "$work"
}
trap finish EXIT
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
DISPLAY=:$(cat "$work/display")
export DISPLAY

"$program" 2>"$work/errors" &
editor=$!
window=$(timeout 60 xdotool search --sync --onlyvisible --pid "$editor" | head -n 1)
xdotool windowmove "$window" 0 0 windowsize "$window" 1600 1000
# Without a window manager nobody gives the keyboard to it.
xdotool windowfocus "$window"
sleep 4

pause=${PAUSE:-0.3}
keys() { xdotool key --delay 40 "$@"; sleep "$pause"; }
letters() { xdotool type --delay 20 -- "$1"; sleep "$pause"; }
click() { xdotool mousemove "$1" "$2"; sleep "$pause"; xdotool click 1; sleep "$pause"; }
# Saves, and waits until all that was typed so far is in the file: a slow machine is behind.
file=$work/character.isolith
saved() {
    keys ctrl+s
    if [ ! -e "$file" ]; then
        keys ctrl+a; letters "$file"; keys Return
    fi
    for _ in $(seq 900); do
        [ "$(grep -c '"object"' "$file" 2>/dev/null || true)" != "$parts" ] || return 0
        sleep 1
    done
    echo "the file does not hold $parts parts" >&2
    return 1
}
# A picture once it has settled.
picture() {
    saved
    [ -z "$pictures" ] || { mkdir -p "$pictures"; sleep "${SETTLE:-8}"; import -window root "$pictures/$1.png"; }
}

parts=0 gestures=0
# The field of the position along X, in the inspector of an object at the top.
POSITION_X=${POSITION_X:-"1450 241"}

# Types position, rotation and scale: nine numbers, from field to field.
place() {
    local value rest=$#
    click $POSITION_X
    for value in "$@"; do
        keys ctrl+a
        letters "$value"
        rest=$((rest - 1))
        if [ "$rest" -gt 0 ]; then keys Tab; else keys Return; fi
    done
    gestures=$((gestures + 1)) parts=$((parts + 1))
}
# A new shape by its name, in a color of its own.
add() {
    keys F3; letters "$1"; keys Return; sleep "$pause"
    gestures=$((gestures + 1))
    place "${@:2}"
}
# A copy of the last part: it shares the material.
again() {
    keys shift+d
    gestures=$((gestures + 1))
    place "$@"
}
# The same at the other side.
both() {
    again "$@"
    again "-$1" "${@:2}"
}

# Shapes in one clay are drawn faster; the ground is where everything stands.
keys z
add plane 0 0 0 0 0 0 1 1 1

# The body, the belly, the head, the feet and the pack.
add box 0 1.3 0 0 0 0 0.95 0.85 0.6
again 0 0.74 0 0 0 0 0.7 0.26 0.46
again 0 2.2 0 0 0 0 0.8 0.62 0.62
both 0.24 0.09 0.08 0 0 0 0.32 0.18 0.52
again 0 1.35 -0.4 0 0 0 0.6 0.6 0.26
picture boxes

# The chest, the neck, the mouth, the antenna, the ears, arms, fingers, legs and pipes.
add cylinder 0 1.36 0.3 90 0 0 0.5 0.08 0.5
again 0 1.8 0 0 0 0 0.26 0.3 0.26
again 0 2.04 0.31 0 0 90 0.07 0.34 0.07
again 0 2.62 0 0 0 0 0.05 0.3 0.05
both 0.44 2.2 0 0 0 90 0.26 0.12 0.26
both 0.66 1.3 0 0 0 8 0.2 0.5 0.2
both 0.7 0.92 0.14 -35 0 0 0.18 0.42 0.18
both 0.7 0.62 0.38 -35 0 0 0.06 0.2 0.06
both 0.62 0.64 0.36 -35 0 -20 0.06 0.2 0.06
both 0.78 0.64 0.36 -35 0 20 0.06 0.2 0.06
both 0.24 0.38 0 0 0 0 0.22 0.42 0.22
both 0.18 1.72 -0.42 0 0 0 0.14 0.3 0.14
picture cylinders

# The lights: chest, eyes, antenna.
add sphere 0 1.36 0.34 0 0 0 0.32 0.32 0.16
both 0.2 2.26 0.31 0 0 0 0.2 0.2 0.12
again 0 2.8 0 0 0 0 0.16 0.16 0.16
picture lights

# The joints: shoulders, elbows, hands, hips, knees.
add sphere 0.6 1.56 0 0 0 0 0.4 0.4 0.4
again -0.6 1.56 0 0 0 0 0.4 0.4 0.4
both 0.7 1.06 0.03 0 0 0 0.26 0.26 0.26
both 0.7 0.74 0.28 0 0 0 0.26 0.26 0.26
both 0.24 0.58 0 0 0 0 0.28 0.28 0.28
both 0.24 0.24 0.06 0 0 0 0.24 0.24 0.24
# Seen from the front, under the light of the scene.
keys Escape
keys Home
keys z z
SETTLE=${SETTLE_LAST:-60} picture character
[ -z "$pictures" ] || cp "$file" "$pictures/character.isolith"
echo "$parts parts in $gestures gestures"
[ -s "$work/errors" ] && sed 's/^/stderr: /' "$work/errors"
[ "$parts" -ge 40 ]
