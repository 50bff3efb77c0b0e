#!/bin/sh
# Configures and builds one preset of CMakePresets.json:
#   scripts/build.sh [PRESET [-DOPTION=VALUE... TARGET...]]      release and everything, unless named
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -eq 0 ] || shift
jobs=${JOBS:-$(scripts/jobs.sh)}

# Tests and benchmarks need packages of their own: a new tree has them when an option asks for them.
# A tree that has them keeps them.
options=""
[ -e "build/$preset/CMakeCache.txt" ] || options="-DSINEW_TESTS=OFF -DSINEW_BENCHMARKS=OFF"
targets=""
for argument in "$@"; do
  case $argument in
    -D*) options="$options $argument" ;;
    *) targets="$targets $argument" ;;
  esac
done

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# shellcheck disable=SC2086  # one word an option or a target
if ! cmake --preset "$preset" $options >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
# shellcheck disable=SC2086
cmake --build --preset "$preset" --parallel "$jobs" ${targets:+--target $targets}
