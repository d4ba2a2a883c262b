#!/bin/bash
# Kills real editors while they are driven by keys, starts them again and saves what they offer.
# usage: tests/recovery.sh [KILLS [PROGRAM]]
#
# Each editor opens a scene of its own. Ctrl-A selects all of it once, then every Ctrl-D adds a copy: the number of nodes
# in a scene tells which presses it holds. Between 3 and 11 seconds after the first press the editor is killed with
# signal 9. The next one is to offer what was lost; Enter recovers it, Ctrl-S saves it. What is lost is the time from the
# first press that the saved scene lacks to the kill. More than five seconds, an empty offer, or anything kept after
# saving fails. Every second
# run presses twice as fast.

set -euo pipefail
kills="${1:-50}"
root="$(cd "$(dirname "$0")/.." && pwd)"
program="${2:-$root/target/debug/isolith}"
most_lost_ms=5000

missing=()
command -v Xvfb >/dev/null || missing+=(xvfb)
command -v xdotool >/dev/null || missing+=(xdotool)
if [ "${#missing[@]}" != 0 ]; then
    as_root=(env DEBIAN_FRONTEND=noninteractive)
    [ "$(id -u)" = 0 ] || as_root=(sudo "${as_root[@]}")
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" </dev/null
fi

# shellcheck source=tests/desktop.sh
source "$root/tests/desktop.sh"
show_screen 1280x800

now_ms() { date +%s%3N; }
nodes() { "$program" check "$1" --json | tr -d ' \n' | sed -E 's/.*"nodes":([0-9]+).*/\1/'; }
fail() { echo "FAILED in run $run: $1" >&2; exit 1; }
kept() { find "$XDG_STATE_HOME/isolith/recovery" -name "$1" 2>/dev/null | wc -l; }

start_editor() {
    open_editor "$1" || fail "the editor ended or has no window"
    # Off the viewport, where a copy would follow the pointer.
    xdotool mousemove 640 12
    sleep 2
}

stop_editor() {
    kill -9 "$editor"
    wait "$editor" 2>/dev/null || true
    editor=""
}

worst=0 sum=0 pictures=0 presses=0
for run in $(seq "$kills"); do
    scene="$work/scene$run.json"
    cp "$root/tests/cases/outputs/ball.json" "$scene"
    base="$(nodes "$scene")"
    start_editor "$scene"
    xdotool key --window "$window" ctrl+a
    sleep 0.3
    pressed=()
    until_ms=$(($(now_ms) + 3000 + RANDOM % 8000))
    pause=$([ $((run % 2)) = 0 ] && echo 0.25 || echo 0.5)
    while [ "$(now_ms)" -lt "$until_ms" ]; do
        pressed+=("$(now_ms)")
        xdotool key --window "$window" ctrl+d
        sleep "$pause"
    done
    killed="$(now_ms)"
    stop_editor
    pictures=$((pictures + $(kept picture.png)))
    [ "$(nodes "$scene")" = "$base" ] || fail "the file itself was changed"

    start_editor "$scene"
    xdotool key --window "$window" Return
    sleep 1
    for _ in $(seq 100); do
        xdotool key --window "$window" ctrl+s
        sleep 0.5
        [ "$(nodes "$scene")" = "$base" ] || break
    done
    found=$(($(nodes "$scene") / base - 1))
    [ "$found" -gt 0 ] || fail "nothing was recovered of ${#pressed[@]} presses; kept: $(kept scene.json)"
    [ "$found" -le "${#pressed[@]}" ] || fail "more came back than was pressed"
    lost=0
    [ "$found" = "${#pressed[@]}" ] || lost=$((killed - pressed[found]))
    sleep 1
    [ "$(kept scene.json)" = 0 ] || fail "what is saved is still kept"
    stop_editor
    presses=$((presses + ${#pressed[@]}))
    sum=$((sum + lost))
    [ "$lost" -le "$worst" ] || worst=$lost
    echo "run $run: $found of ${#pressed[@]} copies came back, $lost ms lost"
    [ "$lost" -le "$most_lost_ms" ] || fail "more than five seconds are lost"
done
echo "$kills kills, $presses presses: lost $((sum / kills)) ms on average, $worst ms at most; $pictures pictures kept"
