#!/bin/sh
# Builds the fuzz targets with clang and runs each for some seconds: scripts/fuzz.sh [SECONDS, default 60]
# An input that fails is saved as build/fuzz/crash-*; -minimize_crash=1 reduces it. Add the reduced input to
# tests/fuzz/corpus, which every test run replays.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:-60}
scripts/setup.sh fuzz
cmake --preset fuzz >/dev/null
cmake --build build/fuzz --parallel "${JOBS:-$(scripts/jobs.sh)}" \
  --target fuzz_vtk_legacy fuzz_vtu fuzz_gmsh fuzz_surface fuzz_csv fuzz_scene fuzz_urdf fuzz_state fuzz_message
for reader in vtk_legacy vtu gmsh surface csv scene urdf state message; do
  mkdir -p "build/fuzz/corpus/$reader"
  echo "fuzz: $reader, $seconds s"
  build/fuzz/bin/fuzz_$reader -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=4096 \
    -artifact_prefix=build/fuzz/ -print_final_stats=0 -verbosity=0 "build/fuzz/corpus/$reader" "tests/fuzz/corpus/$reader"
done
