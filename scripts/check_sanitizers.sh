#!/usr/bin/env bash
# Runs the tests with the address and undefined-behaviour sanitizers, and those of the embedded library with the thread
# sanitizer. Left out, because sanitizers make them last too long: the tests on real data, and the largest comparisons
# with the reference engine and the experiments of `evaluate`, whose small ones take the same ways through the code.
set -euo pipefail
cd "$(dirname "$0")/.."

slow='DamageCommand.Evaluate|odd_large|large_windows|_100$|Peers.Fast|RoadScene|Evaluate\.(Ablation|Synth|Sigma|Roll|Lambda|Blur|Kitti|Flatness|Middlebury)'

check() {
  local preset=$1
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$(nproc)"
  ctest --test-dir "build-$preset" --output-on-failure -j "$(nproc)" --label-exclude real_data --exclude-regex "$slow"
}

export UBSAN_OPTIONS=print_stacktrace=1
check asan
check tsan
echo "Sanitizers: good."
