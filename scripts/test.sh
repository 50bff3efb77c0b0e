#!/bin/sh
# Builds one preset and runs its tests: scripts/test.sh [release|dev|asan|tsan|portable]
# The last line is the sum over the C++ and Python tests: "N passed, N failed".
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
jobs=${JOBS:-$(scripts/jobs.sh)}
build=$PWD/build/$preset
results=$build/test-results

scripts/setup.sh test
scripts/build.sh "$preset" -DSINEW_TESTS=ON
rm -rf "$results"
mkdir -p "$results/gtest" "$results/pytest"

export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_init_order=1}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-second_deadlock_stack=1 suppressions=$PWD/tests/tsan.supp}
fixed_addresses=""
if [ "$preset" = tsan ] && setarch "$(uname -m)" -R true 2>/dev/null; then
  # GCC 12's thread sanitizer cannot start if the kernel randomises addresses too widely.
  fixed_addresses="setarch $(uname -m) -R"
fi

status=0
GTEST_OUTPUT=xml:$results/gtest/ $fixed_addresses ctest --test-dir "$build" --parallel "$jobs" \
  --output-on-failure --output-junit "$results/ctest.xml" || status=1

/usr/bin/python3 scripts/count_tests.py "$results" || status=1
exit $status
