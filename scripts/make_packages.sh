#!/usr/bin/env bash
# Makes Debian packages (library, development files, command, Python) in build-packages. check_packages.sh tests them.
#   scripts/make_packages.sh [CMake options]    PACKAGES_BUILD names another folder than build-packages
set -euo pipefail
cd "$(dirname "$0")/.."

build=$(realpath -m "${PACKAGES_BUILD:-build-packages}")
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DBUILD_SHARED_LIBS=ON \
  -DCMAKE_UNITY_BUILD=ON -DROADSTEREO_CUDA=OFF -DROADSTEREO_BUILD_TESTS=OFF -DROADSTEREO_BUILD_BENCHMARKS=OFF \
  -DROADSTEREO_PYTHON=ON -DPython3_EXECUTABLE=/usr/bin/python3 -DROADSTEREO_PYTHON_DIR=lib/python3/dist-packages "$@"
cmake --build "$build" -j "$(nproc)"
rm -f "$build"/*.deb
(cd "$build" && cpack -G DEB)
for package in "$build"/*.deb; do
  dpkg-deb --field "$package" Package Version Depends
done
