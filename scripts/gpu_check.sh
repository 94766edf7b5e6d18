#!/usr/bin/env bash
# Checks the engine `cuda` on a machine that has a GPU and nothing but CUDA, CMake and a compiler: builds the library, its
# tests and the benchmark, runs the tests, those of the kernels also under compute-sanitizer, and then the benchmark.
#   scripts/gpu_check.sh
# GoogleTest and Highway are built from their sources, whose folders ROADSTEREO_GTEST_SOURCE and ROADSTEREO_HIGHWAY_SOURCE
# name. Debian's package googletest has its own in /usr/src/googletest; `apt-get source highway` fetches Highway's, which
# an installed libhwy-dev does without. Where they are not there, copies in a folder of the project can travel along with
# it: `cp -r /usr/src/googletest DIR` is enough, and of Highway its folder hwy in a DIR.
# SANITIZER_FILTER chooses the tests that run under compute-sanitizer, which is slow: a filter of GoogleTest, '*' is all.
set -euo pipefail
cd "$(dirname "$0")/.."

export PATH=$PATH:/usr/local/cuda/bin
[ -z "${CXX:-}" ] || export CUDAHOSTCXX=${CUDAHOSTCXX:-$CXX}  # nvcc would take the usual g++, maybe too new
filter=${SANITIZER_FILTER:-*}
googletest=${ROADSTEREO_GTEST_SOURCE:-/usr/src/googletest}
highway=${ROADSTEREO_HIGHWAY_SOURCE:-}
missing=()
for tool in cmake ctest make "${CXX:-c++}" nvcc compute-sanitizer; do
  command -v "$tool" >/dev/null || missing+=("$tool")
done
[ -f "$googletest/CMakeLists.txt" ] || missing+=("GoogleTest's sources in $googletest (see ROADSTEREO_GTEST_SOURCE)")
[ -f "$highway/hwy/highway.h" ] || { [ -z "$highway" ] && pkg-config --exists libhwy 2>/dev/null; } ||
  missing+=("Highway's sources (see ROADSTEREO_HIGHWAY_SOURCE)")
if [ ${#missing[@]} -gt 0 ]; then
  printf -v list ', %s' "${missing[@]}"
  echo "Missing, also in /usr/local/cuda/bin: ${list#, }" >&2
  exit 2
fi
cmake --preset standalone -DROADSTEREO_CUDA=ON -DROADSTEREO_GTEST_SOURCE="$googletest" -DROADSTEREO_HIGHWAY_SOURCE="$highway"
cmake --build --preset standalone -j "$(nproc)"
build-standalone/bin/bench_cuda 1 >/dev/null  # says so and stops here where there is no usable GPU
export ROADSTEREO_NEEDS_GPU=1  # tests of the kernels fail where they would be skipped
# Each test is a process with a context of its own, of half a gigabyte: those of a hundred cores fill a GPU.
./scripts/run_tests.sh build-standalone -j "$(($(nproc) < 8 ? $(nproc) : 8))"

sanitize() {
  local test=$1 filter=$2 tests tool
  tests=$("$test" --gtest_list_tests --gtest_filter="$filter")
  if [[ $tests != *$'\n  '* ]]; then
    [ -n "${SANITIZER_FILTER:-}" ] && return  # which leaves nothing of it
    echo "There are no tests $filter in $test" >&2
    return 1
  fi
  for tool in memcheck racecheck initcheck synccheck; do
    echo "compute-sanitizer: $tool of $(basename "$test")"
    compute-sanitizer --tool "$tool" --error-exitcode 1 "$test" --gtest_filter="$filter" --gtest_brief=1
  done
}
sanitize build-standalone/bin/test_cuda "$filter"
sanitize build-standalone/bin/test_embedded "${SANITIZER_FILTER:-*cuda*-Slow*}"

build-standalone/bin/bench_cuda
echo "GPU: good."
