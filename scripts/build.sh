#!/bin/sh
# Configures and builds one preset of CMakePresets.json: scripts/build.sh [release]
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
jobs=${JOBS:-$(scripts/jobs.sh)}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset "$preset" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
cmake --build --preset "$preset" --parallel "$jobs"
