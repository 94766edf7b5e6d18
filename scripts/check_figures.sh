#!/usr/bin/env bash
# Runs the experiments of docs/accuracy.json again and fails where a figure is worse by a quarter. Times are not compared.
#   scripts/check_figures.sh [PROGRAM [NAME…]]      PROGRAM: build/bin/roadstereo
# $ROADSTEREO_DATA names the real data, if build/ was not configured with them.
set -euo pipefail
cd "$(dirname "$0")/.."

program=${1:-build/bin/roadstereo}
[ $# -eq 0 ] || shift
scripts/figures.py verify
scripts/figures.py check "$program" "$@"
