# Isolith. `make run` and `make test` are all that a fresh Debian or Ubuntu machine with Rust needs.

SHELL := /bin/bash
.PHONY: help run test nightly window pictures platforms lint bench gpu-static golden scenes setup
.DEFAULT_GOAL := help

# Vulkan drivers want a private folder and complain where there is none.
ifeq ($(strip $(XDG_RUNTIME_DIR)),)
RUNTIME_DIR := $(shell d="$${TMPDIR:-/tmp}/isolith-runtime-$$(id -u)"; mkdir -m 700 "$$d" 2>/dev/null; [ -O "$$d" ] && echo "$$d")
ifneq ($(RUNTIME_DIR),)
export XDG_RUNTIME_DIR := $(RUNTIME_DIR)
endif
endif

help: ## Show this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 20

# Built for speed, as `make bench` is: the two share their build, as `make test` and `make lint` share theirs.
run: setup ## Open the editor on the showcase scene; without a display, render it to showcase.png
	cargo run --release -- scenes/showcase.json

test: lint ## Check formatting and lints, then run every test
	cargo test --workspace --lib --tests
	cargo test --workspace --doc

# 200 times the points of `make test`: a million for each repetition against its copies. Numerical stress by all methods.
# 50 real editors under Xvfb are driven by keys and killed: that takes half an hour and installs xvfb and xdotool.
nightly: setup ## Test fields at very many points, and kill editors while they are driven
	ISOLITH_TIMES=200 cargo test --test tests -- contract:: stress::
	cargo build
	tests/recovery.sh 50

# What only a window shows, slow on purpose. Pictures of what went wrong, and of some steps, are in target/window.
window: setup ## Drive the program in a window of its own at one frame a second, and look at what it saves
	@bash -euo pipefail -c "$$WINDOW_TOOLS"
	cargo build
	tests/window.sh target/debug/isolith target/window
	tests/pawn.sh target/debug/isolith target/window

# A screen is 1280x800, 1920x1080 or 2560x1440; the pictures are in target/pictures.
pictures: setup ## Take pictures of all panels in both themes, and of a robot built by hand, to be looked at
	@bash -euo pipefail -c "$$WINDOW_TOOLS"
	cargo build
	tests/pictures.sh target/debug/isolith target/pictures
	tests/character.sh target/debug/isolith target/pictures

# No program is linked, so no libraries of those systems are needed.
platforms: ## Check that everything compiles for Windows and macOS
	rustup target add x86_64-pc-windows-gnu aarch64-apple-darwin
	cargo check --workspace --target x86_64-pc-windows-gnu
	cargo check --workspace --target aarch64-apple-darwin

lint: setup ## Check formatting and lints only
	@cargo fmt --version >/dev/null 2>&1 && cargo clippy --version >/dev/null 2>&1 || rustup component add rustfmt clippy
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

bench: setup ## Measure speed and accuracy; tables go into benches/README.md, charts into target/bench
	cargo bench --bench frame
	cargo bench --bench report
	cargo run --release -- bench --output target/bench
	cargo run --release -- bench --growth --methods tape,straight-line,auto --output target/bench
	cargo run --release -- bench --blends --methods auto --output target/bench
	cargo run --release -- bench --stress --output target/bench

gpu-static: setup ## Compile every shader for two graphics cards, without one; the table goes into benches/README.md
	ISOLITH_ACCEPT_GPU_STATIC=1 cargo test --workspace --test limits

golden: setup ## Accept the pictures of all scenes as they are rendered now
	ISOLITH_ACCEPT_GOLDEN=1 cargo test --test tests -- golden::
	git status --short tests/golden

scenes: setup ## Write the example scenes anew
	cargo run -- gallery scenes

setup:
	@bash -euo pipefail -c "$$SETUP"

# What must be there before the first build: a linker for Rust, a Vulkan loader with a driver (Mesa's
# lavapipe works on every processor), and the libraries that a window loads when it opens.
define SETUP
PATH="$PATH:/sbin:/usr/sbin"
if ! command -v cargo >/dev/null; then
    echo "Rust is missing. Install it with rustup, then run make again." >&2
    exit 1
fi
if [ "$(uname -s)" != Linux ]; then
    if [ "$(uname -s)" = Darwin ] && ! xcode-select -p >/dev/null 2>&1; then
        echo "A linker is missing. Run: xcode-select --install" >&2
        exit 1
    fi
    exit 0
fi

missing=()
libraries="$(ldconfig -p 2>/dev/null || true)"
library() { grep -qF "$1" <<<"$libraries" || missing+=("$2"); }
driver() {
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    local root
    for root in /etc /usr/share /usr/local/etc /usr/local/share "${XDG_DATA_HOME:-$HOME/.local/share}"; do
        ! compgen -G "$root/vulkan/icd.d/*.json" >/dev/null || return 0
    done
    missing+=(mesa-vulkan-drivers)
}
command -v cc >/dev/null || missing+=(gcc libc6-dev)
driver
library libvulkan.so.1 libvulkan1
library libX11.so.6 libx11-6
library libX11-xcb.so.1 libx11-xcb1
library libXcursor.so.1 libxcursor1
library libXi.so.6 libxi6
library libXrandr.so.2 libxrandr2
library libxkbcommon.so.0 libxkbcommon0
library libxkbcommon-x11.so.0 libxkbcommon-x11-0
library libwayland-client.so.0 libwayland-client0
[ "${#missing[@]}" != 0 ] || exit 0

if ! command -v apt-get >/dev/null; then
    echo "Isolith needs what Debian calls: ${missing[*]}" >&2
    echo "Install it with your system's package manager, then run make again. For example:" >&2
    echo "  Fedora  dnf install gcc mesa-vulkan-drivers vulkan-loader libX11 libX11-xcb libXcursor libXi libXrandr libxkbcommon-x11 libwayland-client" >&2
    echo "  Arch    pacman -S gcc vulkan-swrast vulkan-icd-loader libx11 libxcursor libxi libxrandr libxkbcommon-x11 wayland" >&2
    exit 1
fi
as_root=(env DEBIAN_FRONTEND=noninteractive)
[ "$(id -u)" = 0 ] || as_root=(sudo "${as_root[@]}")
echo "Installing what is missing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq || echo "The package lists could not be refreshed; going on with those at hand." >&2
"${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" </dev/null
endef
export SETUP := $(value SETUP)

# A screen without a monitor, and what presses keys and takes pictures there.
define WINDOW_TOOLS
missing=()
command -v Xvfb >/dev/null || missing+=(xvfb)
command -v xdotool >/dev/null || missing+=(xdotool)
command -v import >/dev/null || missing+=(imagemagick)
[ "${#missing[@]}" != 0 ] || exit 0
if ! command -v apt-get >/dev/null; then
    echo "This needs what Debian calls: ${missing[*]}" >&2
    exit 1
fi
as_root=(env DEBIAN_FRONTEND=noninteractive)
[ "$(id -u)" = 0 ] || as_root=(sudo "${as_root[@]}")
"${as_root[@]}" apt-get update -qq || true
"${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" </dev/null
endef
export WINDOW_TOOLS := $(value WINDOW_TOOLS)
