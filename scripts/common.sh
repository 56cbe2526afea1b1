# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What the scripts share: they run from the root of the repository, say each step in one line, and
# stop at the first failure with one sentence. Sourced, not run.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

logs=build/logs
stamps=cache/stamps
mkdir -p "$logs" "$stamps"

die() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# need COMMAND [PACKAGE]: stops where a command is missing that README's two do not need.
need() { command -v "$1" >/dev/null || die "$1 is not installed (apt-get install ${2:-$1})"; }

# step NAME WHAT COMMAND...: runs a command quietly; on failure shows the end of its output and
# stops. NAME is the log's name, WHAT reads after "could not".
step() {
  local log=$logs/$1.log what=$2 started=$SECONDS
  shift 2
  printf '%s ... ' "$what"
  if "$@" >"$log" 2>&1 </dev/null; then
    echo "done ($((SECONDS - started)) s)"
  else
    echo "failed"
    tail -n 60 "$log" >&2
    die "could not $what; the whole output is in $log"
  fi
}

# Runs a command as root.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo -n "$@"
  else
    echo "neither root nor sudo" >&2
    return 1
  fi
}

# stamped NAME KEY: has the step NAME finished for this KEY (a hash of what it depends on)?
stamped() { [ "$(cat "$stamps/$1" 2>/dev/null)" = "$2" ]; }
stamp() { echo "$2" >"$stamps/$1"; }

# One hash of the contents of all the files named.
hash_of() { cat -- "$@" | sha256sum | cut -d' ' -f1; }

# aloud WHAT COMMAND...: as step, with the command's output on the terminal.
aloud() {
  local what=$1 started=$SECONDS
  shift
  echo "$what:"
  "$@" </dev/null || die "could not $what"
  echo "$what: done ($((SECONDS - started)) s)"
}

# build PRESET [TARGET...]: configures when needed and builds.
build() {
  local preset=$1
  shift
  step "configure-$preset" "configure the $preset build" cmake --preset "$preset"
  step "build-$preset" "build $preset${*:+: $*}" \
    nice cmake --build --preset "$preset" ${*:+--target "$@"}
}
