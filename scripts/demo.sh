#!/bin/sh
# The trunk follows a circle with its tip: scripts/demo.sh, after `make build`.
set -eu
cd "$(dirname "$0")/.."
PYTHONPATH=build/release/python MPLBACKEND=Agg exec "${PYTHON:-/usr/bin/python3}" examples/trunk/demo.py "$@"
