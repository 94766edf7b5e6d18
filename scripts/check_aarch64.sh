#!/usr/bin/env bash
# Cross-compiles the embedded library for aarch64 and runs its tests, with the NEON target, under qemu. Debian has no
# Highway and GoogleTest for another architecture beside the native ones, so their packages are taken apart (Highway)
# and built from source (GoogleTest).
set -euo pipefail
cd "$(dirname "$0")/.."

build=$PWD/build-aarch64
mkdir -p "$build/packages"
if ! dpkg --print-foreign-architectures | grep -qx arm64; then
  echo "Adding the package lists of arm64"
  as_root=(); [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" dpkg --add-architecture arm64
  "${as_root[@]}" apt-get update -qq
fi
(cd "$build/packages" && for package in libhwy-dev libhwy1; do
  ls "$package"_*_arm64.deb >/dev/null 2>&1 || apt-get download -qq "$package:arm64"
  dpkg-deb -x "$package"_*_arm64.deb "$build/root"
done)

export PKG_CONFIG_LIBDIR=$build/root/usr/lib/aarch64-linux-gnu/pkgconfig
export PKG_CONFIG_SYSROOT_DIR=$build/root
cmake -G Ninja -S . -B "$build" -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/aarch64.cmake" -DCMAKE_BUILD_TYPE=Release \
  -DROADSTEREO_EMBEDDED_ONLY=ON -DROADSTEREO_TBB=OFF -DROADSTEREO_CUDA=OFF -DROADSTEREO_BUILD_BENCHMARKS=OFF \
  -DROADSTEREO_GTEST_SOURCE=/usr/src/googletest -DROADSTEREO_WERROR="${ROADSTEREO_WERROR:-OFF}"
cmake --build "$build" -j "$(nproc)" --target roadstereo test_embedded
# Emulated, the sweeps over many scenes last too long; what is vector code is tested whole.
filter='*Target*:*Engine*:Frame*:Image*:Parallel*:Perspective*:AddShift*:Plan*:IrlsPlaneFit*:SearchPlane*:Median*:*Roll*'
filter+='-Slow*:*tiles*:*/reference*:ReferenceEngine*:*Pipeline*:*Geometry*:Scenes*'
qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH="$build/root/usr/lib/aarch64-linux-gnu" \
  "$build/bin/test_embedded" --gtest_filter="$filter" --gtest_brief=1
echo "aarch64: good."
