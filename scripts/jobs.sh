#!/bin/sh
# Prints the number of compilers to run at once: one per core, each with 1.5 GB of free memory.
set -eu
cores=$(nproc)
kilobytes=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
: "${kilobytes:=4000000}"

# A container may have a lower limit than the machine's memory.
for limit in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
  bytes=$(cat "$limit" 2>/dev/null || true)
  case $bytes in
    ''|*[!0-9]*) continue ;;
  esac
  allowed=$((bytes / 1024))
  [ "$allowed" -ge "$kilobytes" ] || kilobytes=$allowed
done

jobs=$((kilobytes / 1500000))
[ "$jobs" -le "$cores" ] || jobs=$cores
[ "$jobs" -ge 1 ] || jobs=1
echo "$jobs"
