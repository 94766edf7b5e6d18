#!/usr/bin/env bash
# Builds the Python package in the release tree, runs its tests, checks the types of the example, and tests the wheel in a
# virtual environment of its own, and the maps of the engine cuda with emulated kernels.
#   scripts/check_python.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/.."

build=$(realpath -m "${1:-build}")
python=/usr/bin/python3  # Debian's, which has Debian's numpy
[ -f "$build/CMakeCache.txt" ] || cmake --preset release -B "$build"
cmake -B "$build" -DROADSTEREO_PYTHON=ON -DPython3_EXECUTABLE="$python" -DROADSTEREO_BUILD_TESTS=ON
cmake --build "$build" -j "$(nproc)" --target roadstereo_python roadstereo_program
ctest --test-dir "$build" --output-on-failure --label-regex '^python$' --no-tests=error

export MYPY_CACHE_DIR=$build/mypy
(cd python && mypy --strict examples roadstereo)

ROADSTEREO_BUILD=$build "$python" -m build --wheel --no-isolation --outdir "$build/wheel" python
rm -rf "$build/wheel/venv"
"$python" -m venv --system-site-packages "$build/wheel/venv"
"$build/wheel/venv/bin/pip" install --quiet --no-index "$build"/wheel/roadstereo-*.whl
for test in python/tests/test_*.py; do
  (cd / && "$build/wheel/venv/bin/python" -B "$OLDPWD/$test")
done

options=()
for part in BUILD_TESTS BUILD_BENCHMARKS EVALUATE GEO CERES GSTREAMER ROS2 DDS; do options+=("-DROADSTEREO_$part=OFF"); done
cmake -G Ninja -S . -B "$build/emulated" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DROADSTEREO_CUDA=EMULATED \
  -DROADSTEREO_PYTHON=ON -DPython3_EXECUTABLE="$python" "${options[@]}"
cmake --build "$build/emulated" -j "$(nproc)" --target roadstereo_python
PATH=$build/bin:$PATH PYTHONPATH=$build/emulated/python "$python" -B python/tests/test_device_maps.py
echo "Python: good."
