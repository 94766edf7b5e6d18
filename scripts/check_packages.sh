#!/usr/bin/env bash
# Installs the Debian packages of make_packages.sh one after the other in a new system (mmdebstrap; the host's release), which
# has nothing else, and uses each there as its user would. The system is deleted at the end.
#   scripts/check_packages.sh    PACKAGES_BUILD names another folder than build-packages
set -euo pipefail
cd "$(dirname "$0")/.."

build=$(realpath "${PACKAGES_BUILD:-build-packages}")
release=$(. /etc/os-release && echo "$VERSION_CODENAME")

# What engines are made of is no symbol of the library.
for library in roadstereo roadstereo_odometry; do
  nm -DC --defined-only "$build/src/lib$library.so" | grep -E ' roadstereo::(cpu|cuda|N_[A-Z0-9_]+)::' || continue
  echo "$build/src/lib$library.so: symbols of engines are visible" >&2
  exit 1
done

cat > "$build/use_packages.sh" <<'EOF'
set -eux
cd /opt
export DEBIAN_FRONTEND=noninteractive
install() { apt-get install --yes --quiet=2 --no-install-recommends "$@" >/dev/null; }
apt-get update --quiet=2

install ./packages/roadstereo_*.deb ./packages/libroadstereo[0-9]*.deb
roadstereo synth --scene uav --size 320x240 --output road --quiet
roadstereo inspect road/left.png road/right.png --output inspected --quiet
test -s inspected/result.json

install ./packages/python3-roadstereo_*.deb
python3 -c "
import roadstereo
pipeline = roadstereo.Pipeline('fast', roadstereo.read_calibration('road/calibration.yaml'))
result = pipeline.process(roadstereo.read_frame('road/left.png'), roadstereo.read_frame('road/right.png'))
assert result.road.status == 'found', result.road.status"

install ./packages/libroadstereo-dev_*.deb g++ cmake ninja-build
for example in minimal own_engine; do
  cmake -G Ninja -S examples/$example -B build/$example
  cmake --build build/$example
  build/$example/$example
done
g++ -std=c++20 examples/minimal/main.cpp $(pkg-config --cflags --libs roadstereo) -lroadstereo_synth -o by_hand
./by_hand
EOF
mmdebstrap --quiet --variant=minbase --include=ca-certificates \
  --customize-hook='mkdir "$1/opt/packages"' \
  --customize-hook="copy-in $(printf '%s ' "$build"/*.deb) /opt/packages" \
  --customize-hook="copy-in examples $build/use_packages.sh /opt" \
  --customize-hook='chroot "$1" sh /opt/use_packages.sh' \
  "$release" /dev/null
echo "Packages: good."
