#!/usr/bin/env bash
# Installs with apt what the build needs and is missing, and says what that is. Debian 12, Ubuntu 22.04 or later.
#   scripts/install_deps.sh               compiler, CMake, libraries
#   scripts/install_deps.sh --checks      also what .ci/run needs
#   scripts/install_deps.sh --all-checks  also what scripts/check_all.sh needs: browser, another architecture, Python
set -euo pipefail

geographiclib=libgeographiclib-dev
[ "$(. /etc/os-release; echo "$ID ${VERSION_ID:-}")" != "ubuntu 22.04" ] || geographiclib=libgeographic-dev  # its name there
packages=(build-essential cmake ninja-build pkg-config
          libopencv-dev libtbb-dev libhwy-dev libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libfmt-dev libtiff-dev zlib1g-dev
          libfreetype-dev
          libeigen3-dev libnanoflann-dev
          libgdal-dev libpugixml-dev "$geographiclib"
          libgstreamer-plugins-base1.0-dev librosbag-storage-dev libsqlite3-dev libzstd-dev liblz4-dev
          cyclonedds-dev cyclonedds-tools libboost-dev libceres-dev
          libcpp-httplib-dev libgtest-dev libbenchmark-dev)
checks=(clang-format-14 clang-tidy doxygen python3 gdal-bin libsensor-msgs-dev gstreamer1.0-plugins-base)
ros2_checks=(ament-cmake-xmllint ament-cmake-lint-cmake ament-cmake-flake8 ament-cmake-pep257 rosidl-tools
             rosidl-generator-c-cpp python3-ament-index librosidl-runtime-c-cpp-dev libfastrtps-dev)
case "${1:-}" in
  "") ;;
  --checks) packages+=("${checks[@]}") ;;
  --all-checks) packages+=("${checks[@]}" g++-aarch64-linux-gnu qemu-user googletest mmdebstrap
                           chromium chromium-driver python3-selenium
                           pybind11-dev libdlpack-dev python3-dev python3-numpy python3-matplotlib python3-pil mypy
                           python3-build python3-setuptools python3-wheel python3-venv
                           "${ros2_checks[@]}") ;;
  *) echo "usage: $0 [--checks|--all-checks]" >&2; exit 2 ;;
esac

# ROS 1 bags, DDS and lints of ROS 2: not every distribution has them.
optional=(librosbag-storage-dev libsensor-msgs-dev cyclonedds-dev cyclonedds-tools "${ros2_checks[@]}")

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "Everything needed is installed."
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Missing: ${missing[*]}. Install them as root with: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing with apt: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
for package in "${optional[@]}"; do
  if [[ " ${missing[*]} " == *" $package "* ]] && ! apt-cache show "$package" >/dev/null 2>&1; then
    echo "Going on without $package, which this system does not have"
    missing=($(printf '%s\n' "${missing[@]}" | grep -vx "$package" || true))
  fi
done
[ ${#missing[@]} -gt 0 ] || exit 0
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
