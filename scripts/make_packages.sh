#!/usr/bin/env bash
# Makes Debian packages (library, development files, command, Python) in build-packages, and tests them in a folder of their
# own: unpacked there, the examples are built against the development package, and command and Python package are run.
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

root=$build/root
rm -rf "$root" "$build/example"
for package in "$build"/*.deb; do
  dpkg-deb --field "$package" Package Version Depends
  dpkg-deb --extract "$package" "$root"
done
library=$(dirname "$(find "$root" -name 'libroadstereo.so')")
export LD_LIBRARY_PATH=$library
for example in minimal own_engine; do
  cmake -G Ninja -S "examples/$example" -B "$build/example/$example" -DCMAKE_PREFIX_PATH="$root/usr"
  cmake --build "$build/example/$example"
  "$build/example/$example/$example"
done
# Without CMake.
flags=$(PKG_CONFIG_SYSROOT_DIR=$root PKG_CONFIG_PATH=$library/pkgconfig pkg-config --cflags --libs roadstereo)
read -ra flags <<< "$flags"
c++ -std=c++20 examples/minimal/main.cpp "${flags[@]}" -lroadstereo_synth -o "$build/example/by_hand"
"$build/example/by_hand"
"$root/usr/bin/roadstereo" synth --scene uav --size 320x240 --output "$build/example/road" --quiet
PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 -c "
import roadstereo
road = '$build/example/road/'
pipeline = roadstereo.Pipeline('fast', roadstereo.read_calibration(road + 'calibration.yaml'))
result = pipeline.process(roadstereo.read_frame(road + 'left.png'), roadstereo.read_frame(road + 'right.png'))
assert result.road.status == 'found', result.road.status"
echo "Packages: good."
