# A screen and a home of one's own for a script that drives the real program; to be sourced, with `set -euo pipefail`.
#
# Afterwards `work` is a folder that goes at the end, and no setting of the user is read or written.
# shellcheck shell=bash

work=$(mktemp -d)
server='' editor='' window=''
export HOME=$work/home XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data XDG_CONFIG_HOME=$work/config XDG_RUNTIME_DIR=$work/run
# No bus, so no file dialogs but our own.
export DBUS_SESSION_BUS_ADDRESS=disabled:
unset WAYLAND_DISPLAY
mkdir -p -m 700 "$HOME" "$XDG_STATE_HOME" "$XDG_DATA_HOME" "$XDG_CONFIG_HOME" "$XDG_RUNTIME_DIR"

# The preferences of the next editor, as JSON.
preferences() {
    mkdir -p -m 700 "$XDG_STATE_HOME/isolith"
    printf '%s' "$1" >"$XDG_STATE_HOME/isolith/preferences.json"
}

# Shows a screen of this size, WIDTHxHEIGHT.
show_screen() {
    rm -f "$work/display"
    Xvfb -displayfd 3 -screen 0 "${1}x24" -nolisten tcp -noreset 3>"$work/display" 2>/dev/null &
    server=$!
    for _ in $(seq 100); do [ ! -s "$work/display" ] || break; sleep 0.1; done
    [ -s "$work/display" ] || { echo "Xvfb does not start" >&2; exit 1; }
    DISPLAY=:$(cat "$work/display")
    export DISPLAY
}

# Starts the program with these arguments and gives the keyboard to its window, which has no window manager to do so. Its
# messages are in `work/errors`.
open_editor() {
    "$program" "$@" >"$work/output" 2>"$work/errors" &
    editor=$!
    window=
    for _ in $(seq 600); do
        window=$(xdotool search --onlyvisible --pid "$editor" 2>/dev/null | tail -n 1 || true)
        [ -z "$window" ] || break
        kill -0 "$editor" 2>/dev/null || break
        sleep 0.1
    done
    [ -n "$window" ] || { echo "there is no window: $(cat "$work/errors")" >&2; return 1; }
    xdotool windowfocus "$window"
}

# Spreads the window over a screen of this size, WIDTHxHEIGHT.
spread_window() { xdotool windowmove "$window" 0 0 windowsize "$window" "${1%x*}" "${1#*x}"; }

close_desktop() {
    [ -z "$editor" ] || kill "${1:--TERM}" "$editor" 2>/dev/null || true
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    [ -z "$editor" ] || wait "$editor" 2>/dev/null || true
    server='' editor=''
}
trap 'close_desktop -KILL; rm -rf "$work"' EXIT

# Keys, letters and clicks, each followed by a pause of `pause` seconds.
pause=${PAUSE:-0.3}
keys() { xdotool key --delay 40 "$@"; sleep "$pause"; }
letters() { xdotool type --delay 20 -- "$1"; sleep "$pause"; }
click() { xdotool mousemove "$1" "$2"; sleep "$pause"; xdotool click "${3:-1}"; sleep "$pause"; }

# Saves the new scene as `file`, and waits until all that was typed is in it, so many objects: a slow machine is behind.
save_objects() {
    keys ctrl+s
    if [ ! -e "$file" ]; then
        keys ctrl+a; letters "$file"; keys Return
    fi
    for _ in $(seq 900); do
        [ "$(grep -c '"object"' "$file" 2>/dev/null || true)" != "$1" ] || return 0
        sleep 1
    done
    echo "the file does not hold $1 objects" >&2
    return 1
}
