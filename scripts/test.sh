#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests. ROADSTEREO_WERROR=ON makes warnings errors.
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/install_deps.sh
cmake --preset release -DROADSTEREO_BUILD_TESTS=ON -DROADSTEREO_BUILD_BENCHMARKS=ON \
  -DROADSTEREO_WERROR="${ROADSTEREO_WERROR:-OFF}"
cmake --build --preset release -j "$(nproc)"
ctest --test-dir build --output-on-failure -j "$(nproc)"
