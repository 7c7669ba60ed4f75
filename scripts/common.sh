# Sourced by the scripts beside it: the project's root as working folder, the Rust it names, a way to show what runs.
# shellcheck shell=bash
cd "$(dirname "${BASH_SOURCE[0]}")/.."
rust_wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)

# Is version $1 at least version $2?
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# Version of the rustc or cargo ($1) that a plain command would run; nothing where there is none.
version_of() { "$1" --version 2>/dev/null | cut -d ' ' -f 2 || true; }

rust_is_new_enough() {
  local tool found
  for tool in rustc cargo; do
    found=$(version_of "$tool")
    [ -n "$found" ] && at_least "$found" "$rust_wanted" || return 1
  done
}

# A Rust that rustup installed a moment ago is not on the caller's PATH yet.
use_rustup() {
  local bin=${CARGO_HOME:-$HOME/.cargo}/bin
  if [ -x "$bin/cargo" ] && ! rust_is_new_enough; then export PATH="$bin:$PATH"; fi
}

# .cargo/config.toml names the x86-64 folder of Debian's libraries; elsewhere the folder follows the machine.
name_shaderc() {
  local dir
  dir=/usr/lib/$(uname -m)-linux-gnu
  if [ -z "${SHADERC_LIB_DIR:-}" ] && [ "$(uname -m)" != x86_64 ] && [ -d "$dir" ]; then export SHADERC_LIB_DIR=$dir; fi
}

# Shows a command, runs it, says how long it took. Its status stands.
run() {
  local start=$SECONDS status=0
  printf '\n+ %s\n' "$*" >&2
  "$@" || status=$?
  if [ "$status" -ne 0 ]; then printf 'FAILED (exit %s): %s\n' "$status" "$*" >&2; else printf '  %s s\n' $((SECONDS - start)) >&2; fi
  return "$status"
}

# A file ($1) with a part of it made anew ($3): what lies between the two comments that name a script ($2).
between() {
  local first="<!-- scripts/$2: from here -->" last="<!-- scripts/$2: to here -->" mark
  for mark in "$first" "$last"; do
    [ "$(grep -cxF -e "$mark" "$1")" = 1 ] || { printf '%s must have one line %s\n' "$1" "$mark" >&2; return 1; }
  done
  awk -v first="$first" -v last="$last" -v part="$3" '
    $0 == last { inside = 0 }
    !inside
    $0 == first { inside = 1; while ((getline line < part) > 0) print line }' "$1"
}

# The device that a program ($1) renders on, and its kind; $2 is a folder to write into. A name with a comma is quoted.
device_of() {
  "$1" render diffuse --size 8x8 --format csv --out "$2" 2>/dev/null |
    sed -nE '2s/^[^,]*,[^,]*,[^,]*,"?([^"]*)"?,([^,]*)$/\1, a \2 device/p'
}

# Sum of the medians of the stages that make the caustic (or of those that $2 matches), ms, from the samples of a render as CSV ($1).
cost_of() {
  awk -F, -v stages="${2:-^(light|maps|waves)/}" '$1 ~ stages && $2 != "" { print $1, $3 }' "$1" | sort -k 1,1 -k 2,2n | awk '
    $1 != name { add(); name = $1; n = 0 } { ms[++n] = $2 }
    function add() { if (n) sum += (ms[int((n + 1) / 2)] + ms[int((n + 2) / 2)]) / 2 }
    END { add(); if (sum) printf "%.0f", sum; else printf "-" }'
}

use_rustup
name_shaderc
