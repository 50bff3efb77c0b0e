#!/bin/sh
# Runs the benchmarks of the release build: the step of an inverse controller, stage by stage, compared with
# Eigen's factorisation of the same matrix; then the kernels, contact from Python, and the view.
#   scripts/bench.sh [--steps-only]
# Published meshes are used if SINEW_DATA=FOLDER (default ../shared/data) has them. Results go to
# build/bench/*.json, and the table of each run to build/bench/*.txt. Run it on an idle machine: threads that
# wait for busy cores cost milliseconds.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh bench >&2
scripts/build.sh release -DSINEW_BENCHMARKS=ON sinew sinew_python benchmarks >&2
program=build/release/bin/sinew
data=${SINEW_DATA:-../shared/data}
out=build/bench
scenes=$("${PYTHON:-/usr/bin/python3}" benchmarks/scenes.py "$out" --data "$data")

reports=""
whole_step() {  # SCENE STEPS WARM-UP NAME OPTION...
  scene=$1; steps=$2; warm_up=$3; name=$4
  shift 4
  echo "bench: $name" >&2
  "$program" bench "$scene" --steps "$steps" --warm-up "$warm_up" --json "$out/$name.json" "$@" \
    >"$out/$name.txt"
  reports="$reports $out/$name.json"
}

threads=$(nproc)
[ "$threads" -le 4 ] || threads=4
for scene in $scenes; do
  name=$(basename "$scene" .yaml)
  steps=400; warm_up=400
  [ "$name" != multigait ] || { steps=40; warm_up=40; }
  whole_step "$scene" "$steps" "$warm_up" "$name-1" --threads 1 --compare-eigen
  [ "$threads" -eq 1 ] ||
    whole_step "$scene" "$steps" "$warm_up" "$name-$threads" --threads "$threads"
  case $name in
    *trunk) whole_step "$scene" "$steps" "$warm_up" "$name-exact" --threads 1 --tangent exact ;;
  esac
done
# shellcheck disable=SC2086  # one word per file: no name contains blanks
"${PYTHON:-/usr/bin/python3}" scripts/bench_report.py $reports
[ "${1:-}" != --steps-only ] || exit 0

for kernel in build/release/bin/*_benchmark; do
  [ -x "$kernel" ] || continue
  echo "== $(basename "$kernel")"
  "$kernel" "$@"
done

failed=""
contact() {  # SCRIPT NEEDED_FILE ARGUMENT...: skipped if a file is needed and absent
  script=$1; needed=$2
  shift 2
  if [ -n "$needed" ] && [ ! -e "$needed" ]; then
    echo "== $script.py: skipped, there is no $needed"
    return
  fi
  echo "== $script.py"
  PYTHONPATH=build/release/python "${PYTHON:-/usr/bin/python3}" "benchmarks/$script.py" "$@" \
    >"$out/$script.txt" || failed="$failed $script.py"
  cat "$out/$script.txt"
}

for kind in vertex-face edge-edge; do
  queries=$data/ccd/$(echo "$kind" | tr - _).csv.gz
  if [ ! -e "$queries" ]; then
    echo "== impact_queries $kind: skipped, there is no $queries"
    continue
  fi
  echo "== impact_queries $kind"
  gzip -dc "$queries" | build/release/bin/impact_queries "$kind" || failed="$failed impact_queries"
done
echo "== compliance_cost"
build/release/bin/compliance_cost || failed="$failed compliance_cost"
contact fclib "$data/fclib" "$data/fclib"
contact law "" "$data"
contact lean "$data/trunk/trunk.vtk" "$data"
contact grasp "$data/grasp/cup.vtk" "$data"
contact manipulation "$data/grasp/cup.vtk" "$data"
contact flush_blocks ""
contact sole "$data/multigait/multigait.vtk" "$data"
contact detection ""
contact heaps "" --heaps 4
contact bodies ""
contact control ""

if [ -e web/node_modules/playwright-core ] && [ -x "${SINEW_CHROMIUM:-/usr/bin/chromium}" ]; then
  echo "== the view, in a browser"
  node benchmarks/view.mjs | tee "$out/view.txt"
fi
[ -z "$failed" ] || {
  echo "bench: ended with an error:$failed" >&2
  exit 1
}
