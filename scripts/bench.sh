#!/bin/sh
# Runs every benchmark program of the release build, one after the other. Arguments go to each:
#   scripts/bench.sh --benchmark_filter=trunk
set -eu
cd "$(dirname "$0")/.."
found=no
for program in build/release/bin/*_benchmark; do
  [ -x "$program" ] || continue
  found=yes
  echo "== $(basename "$program")"
  "$program" "$@"
done
if [ "$found" = no ]; then
  echo "bench: no program build/release/bin/*_benchmark was built; run 'make build' first" >&2
  exit 1
fi
