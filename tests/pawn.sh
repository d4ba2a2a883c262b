#!/usr/bin/env bash
# Builds the white pawn of scenes/pawn.json by hand in the real window, in at most 25 gestures, most of them in the
# viewport, and compares what it saves with the example.
#
#   tests/pawn.sh PROGRAM [FOLDER FOR PICTURES]
set -euo pipefail

program=$(realpath "$1")
pictures=${2:-}
root=$(cd "$(dirname "$0")/.." && pwd)
# shellcheck source=tests/desktop.sh
source "$root/tests/desktop.sh"
pause=${PAUSE:-0.6}
screen=1280x800
preferences '{"skips_welcome": true}'
show_screen $screen
open_editor
spread_window $screen
sleep 4

gestures=0 in_viewport=0
counted() { gestures=$((gestures + 1)); [ "$1" = panel ] || in_viewport=$((in_viewport + 1)); }
picture() { [ -z "$pictures" ] || { mkdir -p "$pictures"; sleep "${SETTLE:-3}"; import -window root "$pictures/pawn-$1.png"; }; }
file=$work/pawn.isolith
saved() { save_objects "$1" || { picture wrong; return 1; }; }
# The middle of the viewport, and the buttons of the toolbar.
MIDDLE_X=${MIDDLE_X:-602} MIDDLE_Y=${MIDDLE_Y:-385}
BOX=${BOX:-"138 51"} CYLINDER=${CYLINDER:-"171 51"} CONE=${CONE:-"204 51"} TORUS=${TORUS:-"237 51"} SPHERE=${SPHERE:-"105 51"}

# A drag with Ctrl from one place of the screen to another; the wheel turns by some notches before the button is released.
drag() {
    local notches=${5:-0} button=4 step
    [ "$notches" -ge 0 ] || { button=5; notches=$((-notches)); }
    xdotool mousemove "$1" "$2"; sleep "$pause"
    xdotool keydown ctrl mousedown 1; sleep 0.2
    for step in 1 2 3 4; do
        xdotool mousemove $(($1 + ($3 - $1) * step / 4)) $(($2 + ($4 - $2) * step / 4)); sleep 0.1
    done
    sleep "$pause"
    if [ "$notches" != 0 ]; then
        # A click of the wheel's button counts twice on this screen: as it is pressed and as it is released.
        xdotool click --repeat $((notches / 2)) --delay 60 "$button"; sleep "$pause"
        counted viewport
    fi
    xdotool mouseup 1 keyup ctrl; sleep "$pause"
    counted viewport
}
# Pixels of the screen for thousandths of a meter, rounded.
at_x() { awk -v v="$1" -v o="$zero_x" -v s="$scale" 'BEGIN { printf "%d", o + v * s + 0.5 }'; }
at_y() { awk -v v="$1" -v o="$zero_y" -v s="$scale" 'BEGIN { printf "%d", o - v * s + 0.5 }'; }
# Draws from the middle of a base to a corner, in meters.
draw() { drag "$(at_x 0)" "$(at_y "$1")" "$(at_x "$2")" "$(at_y "$3")" "${4:-0}"; }

# From the front, closer to a point above the pawn's middle, with steps of 5 mm, drawing.
xdotool mousemove "$MIDDLE_X" "$((MIDDLE_Y + 1))"; sleep "$pause"
keys 1; counted viewport
xdotool mousemove "$MIDDLE_X" "$((MIDDLE_Y - 146))"; sleep "$pause"
xdotool click --repeat 3 --delay 80 4; sleep 2; counted viewport
keys F3; letters "snap lengths: 0.005"; keys Return; counted panel; counted panel
xdotool mousemove "$MIDDLE_X" "$((MIDDLE_Y - 50))"; sleep "$pause"
keys p; counted viewport

# What an eye sees at the grid: where the origin is, and how large a meter. A box over the height of the picture says it,
# and is taken back. Between its ends nothing is off by more than half a millimeter.
click $BOX
LOW=660 HIGH=90 RIGHT=802
xdotool mousemove "$MIDDLE_X" "$LOW"; sleep "$pause"
xdotool mousedown 1; sleep 0.3
for step in 1 2 3 4; do xdotool mousemove $((MIDDLE_X + 50 * step)) $((LOW + (HIGH - LOW) * step / 4)); sleep 0.1; done
xdotool mousemove "$RIGHT" "$HIGH"; sleep "$pause"
xdotool mouseup 1; sleep "$pause"
saved 1
numbers_of() { grep -o "\"$1\": *\[[^]]*" "$file" | tail -n 1 | tr -d '[,' ; }
read -r _ _ height _ < <(numbers_of size)
read -r _ x y _ < <(numbers_of translation)
scale=$(awk -v h="$height" -v p="$((LOW - HIGH))" 'BEGIN { print p / h }')
zero_x=$(awk -v x="$x" -v s="$scale" -v m="$MIDDLE_X" 'BEGIN { print m - x * s }')
zero_y=$(awk -v y="$y" -v h="$height" -v s="$scale" -v p="$LOW" 'BEGIN { print p + (y - h / 2) * s }')
keys ctrl+z
picture begin

click $CYLINDER; counted panel
draw 0.76 0.11 0.9
draw 0 0.375 0.13 10
click $TORUS; counted panel
draw 0.13 0.325 0.24
click $CONE; counted panel
draw 0.18 0.27 0.34 12
draw 0.27 0.185 0.73 4
click $SPHERE; counted panel
draw 0.78 0.205 1.19
xdotool mousemove "$(at_x 0.6)" "$(at_y 0.6)"; sleep "$pause"
keys shift+a; letters ellipsoid; keys Return; counted viewport; counted panel
draw 0.735 0.215 0.815
saved 7
picture parts

# One group; its blend is dragged by its dot, which is right of and below the seam of the first two parts.
keys ctrl+a; counted panel
keys u; counted panel
SEAM=${SEAM:-0.445}
saved 7
picture group
drag "$(awk -v x="$(at_x 0)" 'BEGIN { printf "%d", x + 27 * 0.9 / 1.0018 + 0.5 }')" "$(awk -v y="$(at_y "$SEAM")" 'BEGIN { printf "%d", y + 27 * 0.44 / 1.0018 + 0.5 }')" \
    "$(awk -v x="$(at_x 0.06287)" 'BEGIN { printf "%d", x + 27 * 0.9 / 1.0018 + 0.5 }')" "$(awk -v y="$(at_y "$(awk -v s="$SEAM" 'BEGIN { print s - 0.03074 }')")" 'BEGIN { printf "%d", y + 27 * 0.44 / 1.0018 + 0.5 }')"
keys r y; letters 20; keys Return; counted viewport
# The sun is turned, too.
for _ in $(seq 200); do
    saved 7
    [ "$(grep -c '"rotation"' "$file")" != 2 ] || break
    sleep 0.5
done
picture done

# Every number of the pawn: those of the example with theirs, rounded to 2 mm; the order of the parts is another.
numbers() {
    awk '/"name": *"(White pawn|Group)"/ { on = 1 } /"name": *"Black pawn"/ { on = 0 } on' "$1" |
        grep -oE '"(radius|height|rounding|major_radius|minor_radius|bottom_radius|top_radius)": *-?[0-9.]+|"(radii|translation|rotation)": *\[[^]]*' |
        tr -d '":[,' | sort
}
echo "$gestures gestures, $in_viewport of them in the viewport"
numbers "$file" >"$work/drawn"
numbers "$root/scenes/pawn.json" >"$work/wanted"
paste -d ' ' "$work/wanted" "$work/drawn" | awk '
    NF % 2 || $1 != $(NF / 2 + 1) { print "another parameter: " $0; wrong = 1; next }
    { for (i = 2; i <= NF / 2; i++) { d = $i - $(NF / 2 + i); if (d < 0) d = -d; if (d > 0.0021) { print "differs: " $0; wrong = 1 } } }
    { count += NF / 2 - 1 }
    END { print count " numbers compared"; exit wrong || count < 40 }' || { sed 's/^/drawn: /' "$work/drawn"; exit 1; }
[ -s "$work/errors" ] && sed 's/^/stderr: /' "$work/errors"
[ "$gestures" -le 25 ]
[ $((2 * in_viewport)) -gt "$gestures" ]
