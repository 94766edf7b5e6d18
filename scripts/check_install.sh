#!/usr/bin/env bash
# Installs the release build into a folder of its own, and builds and runs the examples against it.
set -euo pipefail
cd "$(dirname "$0")/.."

prefix=$PWD/build/installed
rm -rf "$prefix" build/example
cmake --install build --prefix "$prefix" >/dev/null
for example in minimal opencv own_engine; do
  cmake -G Ninja -S examples/$example -B build/example/$example -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix"
  cmake --build build/example/$example -j "$(nproc)"
done
build/example/minimal/minimal
build/example/own_engine/own_engine
"$prefix/bin/roadstereo" synth --scene uav --size 320x240 --output build/example/road --quiet
build/example/opencv/disparity build/example/road/left.png build/example/road/right.png build/example/disparity.png
"$prefix/bin/roadstereo" --version
echo "Install: good."
