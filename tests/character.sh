#!/usr/bin/env bash
# Builds a robot of 41 parts by hand in the real window, by keys and pointer. Takes a picture after each group of parts, and
# checks the scene that it saves.
#
#   tests/character.sh PROGRAM [FOLDER FOR PICTURES]
set -euo pipefail

program=$(realpath "$1")
pictures=${2:-}
# shellcheck source=tests/desktop.sh
source "$(dirname "$0")/desktop.sh"
screen=1600x1000
preferences '{"skips_welcome": true}'
show_screen $screen
open_editor
spread_window $screen
sleep 4

file=$work/character.isolith
# A picture once it has settled.
picture() {
    save_objects "$parts"
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
