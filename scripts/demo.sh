#!/bin/sh
# Runs the demo, in which the tip of the trunk follows a circle: scripts/demo.sh, after `make build`.
set -eu
cd "$(dirname "$0")/.."
PYTHONPATH=build/release/python MPLBACKEND=Agg exec "${PYTHON:-/usr/bin/python3}" examples/trunk/demo.py "$@"
