#!/bin/sh
# Runs clang-tidy (.clang-tidy) on the project's own sources, in parallel, and Doxygen on its headers, whose warnings are
# errors:
#   scripts/lint.sh [FILE...]      default: all sources and headers; with FILEs, clang-tidy only
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh lint
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset lint >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
status=0
if [ $# -eq 0 ]; then
  SINEW_SKIP_SETUP=1 scripts/docs.sh --cpp build/lint/docs >/dev/null || status=1
  # shellcheck disable=SC2046  # one word per file: no name contains blanks
  set -- $("${PYTHON:-/usr/bin/python3}" -c '
import json, os
root = os.getcwd() + os.sep
names = {entry["file"] for entry in json.load(open("build/lint/compile_commands.json"))}
print(*sorted(n[len(root):] for n in names if n.startswith(root) and not n.startswith(root + "build")))')
fi
# The lines with clang-tidy's number of warnings, most of them suppressed, are removed.
# shellcheck disable=SC2016  # expanded by the inner shell
printf '%s\0' "$@" | xargs -0 -P "${JOBS:-$(scripts/jobs.sh)}" -n 1 sh -c '
  status=0
  output=$(clang-tidy -p build/lint --quiet "$0" 2>&1) || status=1
  printf "%s\n" "$output" | sed "/^[0-9]* warnings\{0,1\}.* generated\.$/d; /^$/d"
  exit $status' || status=1
exit $status
