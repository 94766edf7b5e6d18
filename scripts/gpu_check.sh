#!/usr/bin/env bash
# Checks the engine `cuda` on a machine that has a GPU and nothing but CUDA, CMake and a compiler.
#   scripts/gpu_check.sh [build|test|bench|sanitize]...    all of them in this order without a word
#   build     the library, its tests and the benchmark, in build-standalone
#   test      all tests
#   bench     bench_cuda, also as build-standalone/bench_cuda.json
#   sanitize  the tests of the kernels under compute-sanitizer: slow
# A part that fails does not keep the next ones from running; what failed is said at the end (exit 1). Exit 2: something
# that `build` needs is missing.
#
# The sources of GoogleTest and Highway are looked for in ROADSTEREO_GTEST_SOURCE and ROADSTEREO_HIGHWAY_SOURCE, in
# third_party/googletest and third_party/highway, beside the project, and where Debian's package googletest has its own,
# /usr/src/googletest; an installed libhwy-dev serves as well. Copies travel along with the project:
# `cp -r /usr/src/googletest third_party/` is enough, and of Highway its folder hwy. Without GoogleTest there are no
# tests, but a benchmark.
#
# SANITIZERS names the tools (memcheck racecheck initcheck synccheck), SANITIZER_FILTER the tests that run under them, as
# a filter of GoogleTest. PROGRAM_SECONDS is the time that one program has (600); of the benchmark, BENCH_RUNS frames count
# (200).
set -euo pipefail
absolute() { [ -z "$1" ] || realpath -m "$1"; }
googletest=$(absolute "${ROADSTEREO_GTEST_SOURCE:-}")
highway=$(absolute "${ROADSTEREO_HIGHWAY_SOURCE:-}")
cd "$(dirname "$0")/.."

export PATH=$PATH:/usr/local/cuda/bin
build=build-standalone
limit=${PROGRAM_SECONDS:-600}
failures=()
failed() {
  echo "FAILED: $*" >&2
  failures+=("$*")
}

# The first of the folders that has the file; nothing without one.
folder_with() {
  local file=$1 folder
  shift
  for folder in "$@"; do
    [ -n "$folder" ] && [ -f "$folder/$file" ] && realpath "$folder" && return
  done
  return 0
}

build() {
  local tool missing=() tests=ON
  googletest=$(folder_with CMakeLists.txt "$googletest" third_party/googletest ../googletest /usr/src/googletest)
  highway=$(folder_with hwy/highway.h "$highway" third_party/highway ../highway)
  for tool in cmake ctest make "${CXX:-c++}" nvcc; do
    command -v "$tool" >/dev/null || missing+=("$tool")
  done
  [ -n "$highway" ] || pkg-config --exists libhwy 2>/dev/null || missing+=("Highway's sources")
  if [ ${#missing[@]} -gt 0 ]; then
    printf -v list ', %s' "${missing[@]}"
    echo "Missing, also in /usr/local/cuda/bin: ${list#, } (see the head of $0)" >&2
    exit 2
  fi
  if [ -z "$googletest" ]; then
    tests=OFF
    failed "build: no sources of GoogleTest were found, so that there are no tests"
  fi
  # Findings of compute-sanitizer name a line.
  cmake --preset standalone -DROADSTEREO_CUDA=ON -DROADSTEREO_BUILD_TESTS=$tests -DCMAKE_CUDA_FLAGS=-lineinfo \
    -DROADSTEREO_GTEST_SOURCE="$googletest" -DROADSTEREO_HIGHWAY_SOURCE="$highway" &&
    cmake --build --preset standalone -j "$(nproc)" || failed "build"
}

run_tests() {
  local jobs
  if [ ! -x $build/bin/test_cuda ]; then
    failed "test: there is no $build/bin/test_cuda"
    return
  fi
  # Each test is a process with a context of its own, of half a gigabyte: those of a hundred cores fill a GPU, and one
  # that is for one process at a time takes one.
  jobs=$(($(nproc) < 8 ? $(nproc) : 8))
  ! nvidia-smi --query-gpu=compute_mode --format=csv,noheader 2>/dev/null | grep Exclusive >/dev/null || jobs=1
  # Tests of the kernels fail where they would be skipped.
  ROADSTEREO_NEEDS_GPU=1 ./scripts/run_tests.sh $build -j "$jobs" --timeout "$limit" || failed "test"
}

bench() {
  timeout "$limit" $build/bin/bench_cuda "${BENCH_RUNS:-200}" --json $build/bench_cuda.json || failed "bench"
}

sanitize_program() {
  local test=$1 filter=$2 tests tool brief=()
  if ! tests=$(timeout "$limit" "$test" --gtest_list_tests --gtest_filter="$filter"); then
    failed "sanitize: $test does not run"
    return
  fi
  if [[ $tests != *$'\n  '* ]]; then
    [ -n "${SANITIZER_FILTER:-}" ] || failed "sanitize: there are no tests $filter in $test"
    return
  fi
  # To GoogleTest before 1.11 the flag is unknown: it would print its help and run nothing.
  # All of the help is read: under pipefail a program whose reader has gone fails.
  ! timeout "$limit" "$test" --help | grep gtest_brief >/dev/null || brief=(--gtest_brief=1)
  for tool in ${SANITIZERS:-memcheck racecheck initcheck synccheck}; do
    echo "compute-sanitizer: $tool of $(basename "$test")"
    ROADSTEREO_NEEDS_GPU=1 timeout "$limit" compute-sanitizer --tool "$tool" --error-exitcode 1 "$test" \
      --gtest_filter="$filter" "${brief[@]}" || failed "sanitize: $tool of $(basename "$test")"
  done
}

sanitize() {
  if ! command -v compute-sanitizer >/dev/null; then
    failed "sanitize: there is no compute-sanitizer, also in /usr/local/cuda/bin"
    return
  fi
  sanitize_program $build/bin/test_cuda "${SANITIZER_FILTER:-*}"
  sanitize_program $build/bin/test_embedded "${SANITIZER_FILTER:-*cuda*-Slow*}"
}

[ $# -gt 0 ] || set -- build test bench sanitize
for part in "$@"; do
  echo "== $part"
  case $part in
    build) build ;;
    test) run_tests ;;
    bench) bench ;;
    sanitize) sanitize ;;
    *)
      sed -n '2,/^set/s/^# *//p' "$0" >&2
      exit 2
      ;;
  esac
done
if [ ${#failures[@]} -gt 0 ]; then
  printf 'FAILED: %s\n' "${failures[@]}" >&2
  exit 1
fi
echo "GPU: $* good."
