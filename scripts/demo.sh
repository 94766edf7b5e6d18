#!/usr/bin/env bash
# From a bare machine to pictures: installs what is missing, builds, makes a synthetic road, inspects it.
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/install_deps.sh
# An existing build keeps its options.
options=()
[ -f build/CMakeCache.txt ] || options=(-DROADSTEREO_BUILD_TESTS=OFF -DROADSTEREO_BUILD_BENCHMARKS=OFF)
cmake --preset release "${options[@]}"
cmake --build --preset release -j "$(nproc)" --target roadstereo_program

build/bin/roadstereo synth --scene demo --output demo/road
build/bin/roadstereo inspect demo/road/left.png demo/road/right.png --calibration demo/road/calibration.yaml \
  --output demo/result

echo
echo "Report (open it in a browser), and pictures:"
for file in report.html overlay.png sheet.png disparity_color.png transformed_color.png; do
  echo "  $PWD/demo/result/$file"
done
