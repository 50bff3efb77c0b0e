#!/bin/sh
# Configures and builds one preset of CMakePresets.json:
#   scripts/build.sh [PRESET [-DOPTION=VALUE... TARGET...]]      default: release, all targets
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -eq 0 ] || shift
jobs=${JOBS:-$(scripts/jobs.sh)}

# Tests and benchmarks need more packages, so a new build tree includes them only if an option enables them.
# An existing tree keeps its setting.
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
# shellcheck disable=SC2086  # one word per option or target
if ! cmake --preset "$preset" $options >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
# shellcheck disable=SC2086
cmake --build --preset "$preset" --parallel "$jobs" ${targets:+--target $targets}
