#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests.
#   scripts/test.sh [options of CMake] [-- options of ctest]
set -euo pipefail
cd "$(dirname "$0")/.."

options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  options+=("$1")
  shift
done
[ $# -eq 0 ] || shift

./scripts/install_deps.sh
cmake --preset release -DROADSTEREO_BUILD_TESTS=ON -DROADSTEREO_BUILD_BENCHMARKS=ON "${options[@]}"
cmake --build --preset release -j "$(nproc)"
./scripts/run_tests.sh build "$@"
