#!/usr/bin/env bash
# Drives the real program in a window on a screen of its own, by keys and pointer, at one frame a second: what a slow
# machine does to input. Looks at the files that it saves, at the title and at the end of the process.
#
#   tests/window.sh PROGRAM [FOLDER FOR PICTURES]
#
# Times are long enough for a slow frame and short enough that many events meet in one.
set -euo pipefail

program=$(realpath "$1")
pictures=${2:-}
failures=0
# shellcheck source=tests/desktop.sh
source "$(dirname "$0")/desktop.sh"
export ISOLITH_FRAME_DELAY=1000
screen=1024x640
show_screen $screen

scene=$work/scene.json
fresh() {
    cat >"$scene" <<'SCENE'
{
  "isolith": 1,
  "materials": [{ "id": 1, "name": "Clay", "albedo": [0.5, 0.5, 0.5],
    "specular": 0.2, "shininess": 16.0, "emission": [0.0, 0.0, 0.0] }],
  "next_id": 5,
  "nodes": [
    { "id": 1, "name": "Body", "group": { "operator": "union", "blend": { "kernel": "circular", "radius": 0.0 } } },
    { "id": 2, "parent": 1, "name": "Ball", "object": { "shape": { "type": "sphere", "radius": 0.5 }, "material": 1 } },
    { "id": 3, "name": "Ring", "object": { "shape": { "type": "torus", "major_radius": 1.0, "minor_radius": 0.2 }, "material": 1 } },
    { "id": 4, "name": "Sun", "light": { "color": [1.0, 1.0, 1.0], "intensity": 1.0, "light": { "type": "directional" } } }
  ]
}
SCENE
}

start() {
    open_editor "$scene"
    settle
}

# So many seconds, and about as many frames. A click takes three of them: press, release, and one between.
settle() { sleep "${1:-6}"; }
keys() { xdotool key --delay 15 "$@"; }
letters() { xdotool type --delay 15 "$1"; }
click() { xdotool mousemove "$1" "$2" click 1; }
# Saves, and waits until it has been saved: a busy machine has slower frames still.
save() {
    touch "$work/before"
    keys ctrl+s; settle
    for _ in $(seq 15); do [ "$scene" -nt "$work/before" ] && break; sleep 1; done
}
title() { xdotool getwindowname "$window"; }
picture() { [ -z "$pictures" ] || { mkdir -p "$pictures"; import -window root "$pictures/$1.png"; }; }

check() {
    local what=$1
    shift
    if "$@"; then
        echo "ok    $what"
    else
        echo "WRONG $what"
        picture "wrong-$(tr -c '[:alnum:]\n' - <<<"$what")"
        failures=$((failures + 1))
    fi
}
# What the saved scene says of a node.
node() {
    awk -v name="\"name\": \"$1\"" '
        /^    \{/ { block = "" }
        { block = block $0 "\n" }
        /^    \}/ && index(block, name) { printf "%s", block }' "$scene"
}
holds() { node "$1" | grep -qE "$2"; }
lacks() { ! holds "$@"; }
exists() { grep -q "\"name\": \"$1\"" "$scene"; }
gone() { ! exists "$1"; }

# Places in the window: rows of the tree, fields of the inspector of an object, something in the picture.
row() { echo 120 $((ROWS + 24 * $1)); }
ROWS=145
BODY=0 BALL=1 RING=2
FIELD_X="850 305"
PICTURE_CORNER="330 420"
FILE_MENU="69 17"
EMPTY_ROOM="120 250"

run() {
    fresh
    start
    picture start
    local width height
    read -r width height < <(xdotool getwindowgeometry "$window" | awk '/Geometry/ { split($2, s, "x"); print s[1], s[2] }')
    check "the window fits the screen: $width x $height of $screen" [ "$width" -le 1024 -a "$height" -le 640 ]

    # Digits, Tab, digits, all in one frame.
    click $(row $BALL); settle
    click $FIELD_X; letters 1; keys Tab; letters 25; keys Tab; letters 3; keys Return; settle 20
    picture digits
    save
    check "typed digits land where they were typed" holds Ball '"translation": \[1.0, 25.0, 3.0\]'

    click $FIELD_X; letters 7; keys Escape; settle 8; save
    check "Escape cancels a number" holds Ball '"translation": \[1.0, 25.0, 3.0\]'

    click $FIELD_X; settle; letters 1/0; keys Return; settle; picture one-by-zero; save
    check "1/0 keeps the value" holds Ball '"translation": \[1.0, 25.0, 3.0\]'

    click $FIELD_X; settle; letters 8; keys ctrl+s; settle 10
    check "Ctrl S takes the number being typed" holds Ball '"translation": \[8.0, 25.0, 3.0\]'

    # What is selected shows in what H hides.
    click $FILE_MENU; keys Escape; settle; keys h; settle; save
    check "Escape on a menu keeps the selection" holds Ball '"visible": false'
    click $FILE_MENU; settle; picture menu; click $PICTURE_CORNER; settle; keys h; settle; save
    check "a click beside a menu keeps the selection" lacks Ball '"visible": false'
    click $FILE_MENU; settle; click $FILE_MENU; settle; picture closed; click $PICTURE_CORNER; settle; keys h; settle; save
    check "a click on an open menu's button closes it: the next click deselects" lacks Ball '"visible": false'

    # Locked, then deleted twice.
    click $(row $RING); settle; keys l; settle; keys x; settle; picture locked; save
    check "a locked node is not deleted" exists Ring
    keys l; settle; keys x; settle; keys x; settle; save
    check "an unlocked one is" gone Ring
    check "and nothing is selected afterward" exists Sun
    keys ctrl+z; settle; save
    check "undo brings it back" exists Ring

    # A fast drag: press, move, release within a frame.
    xdotool mousemove $(row $BALL) mousedown 1 mousemove $EMPTY_ROOM mouseup 1; settle 8; picture dropped; save
    check "a row dropped beside the others goes to the top" lacks Ball '"parent"'

    # Files.
    local other=$work/other.json
    echo precious >"$other"
    keys ctrl+shift+s; settle; keys ctrl+a; letters "$other"; keys Return Return; settle 9; picture replace
    check "saving over a file asks" grep -q precious "$other"
    keys Escape; settle; keys Escape; settle
    keys ctrl+shift+s; settle; keys ctrl+a; letters "$work"; keys Return; settle; picture folder
    keys Escape; settle
    check "a folder is no file" [ "$(find "$work" -maxdepth 1 -name '*.json' | wc -l)" = 2 ]
    echo '{' >"$work/broken.json"
    click $(row $BODY); settle; keys h; settle
    keys ctrl+o; settle; keys ctrl+a; letters "$work/broken.json"; keys Return; settle; picture broken
    # No question is open: H shows the node again, and the title says that all is saved.
    keys h; settle; save
    check "a broken file is refused without a question" grep -q '^scene.json – Isolith' <<<"$(title)"

    keys ctrl+q
    check "Ctrl Q ends the program" timeout 30 tail --pid="$editor" -f /dev/null
    local code=0
    wait "$editor" || code=$?
    editor=
    check "with success" [ "$code" = 0 ]
}

run
[ -s "$work/errors" ] && sed 's/^/stderr: /' "$work/errors"
if [ "$failures" != 0 ]; then
    echo "$failures checks failed" >&2
    exit 1
fi
