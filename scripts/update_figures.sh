#!/usr/bin/env bash
# Runs the experiments and writes their figures into docs/accuracy.json, README.md and docs/: one command after a change of
# the algorithms. All of them take 15 to 30 minutes on two cores; names run a part (scripts/figures.py lists them).
#   scripts/update_figures.sh [PROGRAM [NAME…]]      PROGRAM: build/bin/roadstereo
# $ROADSTEREO_DATA names the real data, if build/ was not configured with them.
set -euo pipefail
cd "$(dirname "$0")/.."

program=${1:-build/bin/roadstereo}
[ $# -eq 0 ] || shift
scripts/figures.py run "$program" "$@"
scripts/figures.py write
