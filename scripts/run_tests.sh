#!/usr/bin/env bash
# Runs the tests of a build folder, says how many were skipped, and fails when those are not the ones that cannot run on
# this machine. What a test needs is a label of it (tests/suites.cmake).
#   scripts/run_tests.sh BUILD [options of ctest]
set -euo pipefail
cd "$(dirname "$0")/.."

build=$1
shift
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
count() { ctest --test-dir "$build" --show-only "$@" | sed -n 's/^Total Tests: //p'; }

missing=()
data=$(cached ROADSTEREO_DATA)
[ -n "$data" ] && [ -d "$data" ] || missing+=(real_data)
[ -x "$(cached ROADSTEREO_OGRINFO)" ] || missing+=(ogrinfo)
grep -qs opencv_rgbd "$(cached OpenCV_DIR)/OpenCVModules.cmake" || missing+=(rgbd)
[ "$(cached GSTREAMER_FOUND)" = 1 ] && compgen -G '/usr/lib/*/gstreamer-1.0/libgstvideotestsrc.so' >/dev/null ||
  missing+=(gstreamer)
command -v chromedriver >/dev/null && /usr/bin/python3 -c 'import selenium' 2>/dev/null || missing+=(browser)
command -v ament_xmllint >/dev/null && command -v rosidl >/dev/null || missing+=(ament)
gpus=$(nvidia-smi --list-gpus 2>/dev/null | grep -c '^GPU' || true)
# To CUDA the list ends at the first that there is not.
[ -z "${CUDA_VISIBLE_DEVICES+set}" ] || gpus=$(tr , '\n' <<<"$CUDA_VISIBLE_DEVICES" |
  awk -v gpus="$gpus" '/^$/ || /^-/ || (/^[0-9]+$/ && $1 >= gpus) { exit } { ++count } END { print count + 0 }')
# Not every system has nvidia-smi; where a GPU is needed, tests without one fail.
[ -z "${ROADSTEREO_NEEDS_GPU+set}" ] || [ "$gpus" -ge 1 ] || gpus=1
if [ "$(cached ROADSTEREO_CUDA)" != EMULATED ]; then  # two GPUs are emulated
  [ "$gpus" -ge 1 ] || missing+=(cuda engine_cuda)
  [ "$gpus" -ge 2 ] || missing+=(two_gpus)
fi
IFS='|'
expected=$(count "$@" --label-regex "^(${missing[*]:-none})\$")
unset IFS

log=$build/Testing/tests.log
mkdir -p "$build/Testing"
good=true
ctest --test-dir "$build" --output-on-failure --no-tests=error -j "$(nproc)" "$@" | tee "$log" || good=false
skipped=$(grep -cE '^[[:space:]]+[0-9]+ - .* \(Skipped\)' "$log" || true)
echo "$build: $skipped tests skipped, $expected expected (missing here: ${missing[*]:-nothing})."
if [ "$skipped" -ne "$expected" ]; then
  echo "That is another number than expected." >&2
  exit 1
fi
$good
