#!/usr/bin/env bash
# Takes pictures of the window with every panel and dialog open, in both themes and at three sizes, to be looked at.
#
#   tests/pictures.sh PROGRAM FOLDER [SCENE [SIZES [THEMES]]]
#   tests/pictures.sh PROGRAM FOLDER readme
#
# A size is WIDTHxHEIGHT@SCALE. The screen has no monitor; a name of a picture is THEME-SIZE-PANEL.png. With "readme" it takes
# those of README.md instead.
set -euo pipefail

program=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
root=$(cd "$(dirname "$0")/.." && pwd)
scene=${3:-$root/scenes/character.json}
[ "$scene" = readme ] || scene=$(realpath "$scene")
sizes=${4:-1280x800@1 1920x1080@1 2560x1440@1.5}
themes=${5:-Dark Light}
# Seconds that a picture of the scene may take to settle, and a panel.
settle_scene=${SETTLE_SCENE:-12}
settle_panel=${SETTLE_PANEL:-3}

# shellcheck source=tests/desktop.sh
source "$root/tests/desktop.sh"
pause=0
settle() { sleep "${1:-$settle_panel}"; }
picture() { import -window root "$folder/$theme-$size-$1.png"; }

# Opens the window over the whole screen.
open() {
    local width=${size%%x*} rest=${size#*x}
    local height=${rest%%@*}
    scale=${rest#*@}
    rm -rf "$XDG_STATE_HOME"
    preferences "$(printf '{"skips_welcome": %s, "theme": "%s", "scale": %s}' "${WELCOMES:-true}" "$theme" "$scale")"
    show_screen "${width}x$height"
    open_editor "$@"
    spread_window "${width}x$height"
    xdotool mousemove $((width / 2)) $((height / 2))
}

# A place in points of the user interface.
at() { awk -v x="$1" -v y="$2" -v s="$scale" 'BEGIN { print int(x * s), int(y * s) }'; }

# A picture of what keys open, and closes it again.
opened() {
    local name=$1
    shift
    keys "$@"; settle
    picture "$name"
    keys Escape; settle 0.5
}

# The pictures of README.md: a scene, what is done in it, and how long it may take to settle.
#   shown NAME THEME SIZE SCENE COMMAND...
shown() {
    local name=$1
    theme=$2 size=$3
    open "$root/scenes/$4"
    settle "$settle_scene"
    "${@:5}"
    # Off the picture, so that no mark is under the pointer.
    xdotool mousemove $(at 600 12)
    settle "${SETTLE_LAST:-90}"
    import -window root "$folder/$name.png"
    close_desktop
}
row() { click $(at 110 "$1"); settle; }
# Runs commands by their names, with the pointer over the viewport.
commands() {
    local name
    for name in "$@"; do
        keys F3; settle; letters "$name"; settle; keys Return; settle
    done
}
# Two views, the second in clay.
side_by_side() {
    commands "Two views"
    xdotool mousemove $(at 800 300); settle
    keys z
}
if [ "$scene" = readme ]; then
    shown screenshot Dark 1280x800@1 character.json row 218
    shown light Light 1920x1080@1.5 showcase.json row 170
    shown views Dark 1280x800@1 pawn.json side_by_side
    shown instancing Dark 1280x800@1 ocean.json row 170
    exit 0
fi

for theme in $themes; do
    for size in $sizes; do
        open "$scene"
        settle "$settle_scene"
        picture scene
        # Shapes in one clay are drawn faster behind what is open.
        keys z
        keys ctrl+a; settle; picture all
        click $(at 120 190); settle; picture node
        opened palette shift+a
        opened commands F3
        opened history alt+z
        opened help F1
        opened doctor F10
        opened render F12
        opened preferences ctrl+comma
        click $(at 82 17); settle; picture file; keys Escape; settle 0.5
        click $(at 118 17); settle; picture edit; keys Escape; settle 0.5
        click $(at 192 17); settle; picture view; keys Escape; settle 0.5
        close_desktop
        WELCOMES=false open
        settle "$settle_scene"
        picture welcome
        close_desktop
    done
done
