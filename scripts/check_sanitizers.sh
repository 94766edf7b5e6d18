#!/usr/bin/env bash
# Builds with sanitizers and runs the tests.
#   scripts/check_sanitizers.sh asan|asan-all|tsan [options of CMake]
#   asan      address and undefined-behaviour sanitizer: the embedded library, the kernels, which run emulated, and live;
#             without whole pipelines, whose stages are tested one by one
#   asan-all  the same with them, files and pictures, and the commands
#   tsan      thread sanitizer: what is about threads, recordings, cameras, and every kernel, whose threads are threads to it
# Left out by label: slow, whose short siblings take the same ways through the code, real data and browsers.
set -euo pipefail
cd "$(dirname "$0")/.."

programs=(test_embedded test_cuda test_live)
with='.'
without='^$'
case ${1:-} in
  asan) without='^(.*/)?(CarryOver|CrossSection|(Cuda)?Pipeline[A-Za-z]*|CudaPreset|EngineAgreement|RoadModelScene|RenderTruth)[.]' ;;
  asan-all) programs+=(test_io test_flight test_cli) ;;
  tsan)
    programs=(test_embedded test_cuda test_live test_flight)
    with='^(threads|cuda|live|flight)$'
    ;;
  *)
    sed -n '2,/^set/s/^# *//p' "$0" >&2
    exit 2
    ;;
esac
preset=${1%-all}
shift

cmake --preset "$preset" "$@"
cmake --build --preset "$preset" -j "$(nproc)" --target "${programs[@]}"
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp"
./scripts/run_tests.sh "build-$preset" --label-regex "$with" --label-exclude '^(slow|real_data|browser)$' \
  --exclude-regex "$without"
echo "Sanitizers: $preset is good."
