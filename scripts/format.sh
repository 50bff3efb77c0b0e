#!/bin/sh
# Formats the project's C++ sources by .clang-format. With --check, it only reports unformatted ones.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh format
mode=-i
if [ "${1:-}" = --check ]; then
  mode="--dry-run --Werror"
fi
git ls-files -z --cached --others --exclude-standard -- '*.cpp' '*.hpp' |
  xargs -0 -r -P "${JOBS:-$(scripts/jobs.sh)}" -n 8 clang-format $mode
