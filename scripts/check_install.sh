#!/usr/bin/env bash
# Installs the release build into a folder of its own, and builds and runs examples/minimal against it.
set -euo pipefail
cd "$(dirname "$0")/.."

prefix=$PWD/build/installed
rm -rf "$prefix" build/example
cmake --install build --prefix "$prefix" >/dev/null
cmake -G Ninja -S examples/minimal -B build/example -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix"
cmake --build build/example -j "$(nproc)"
build/example/minimal
"$prefix/bin/roadstereo" --version
echo "Install: good."
