#!/usr/bin/env bash
# Builds with sanitizers and runs the tests.
#   scripts/check_sanitizers.sh asan|asan-all|tsan [options of CMake]
#   asan      address sanitizer, and undefined behaviour of numbers: the embedded library and the kernels, which run
#             emulated; of whole pipelines the presets on the device, others by their stages
#   asan-all  the same with them, files and pictures, maps, live and the commands, and all of undefined behaviour: checks
#             of every pointer, most of which the address sanitizer makes too, take a third of the time to compile
#   tsan      thread sanitizer: what is about threads, recordings, cameras, and every kernel, whose threads are threads to it
# Left out by label: slow, whose short siblings take the same ways through the code, real data, browsers and ament.
set -euo pipefail
cd "$(dirname "$0")/.."

programs=(test_embedded test_cuda)
options=()
with='.'
without='^$'
case ${1:-} in
  asan)
    options=(-DROADSTEREO_SANITIZE=address,shift,integer-divide-by-zero,signed-integer-overflow,bounds,bool,enum,builtin)
    without='^(.*/)?(CarryOver|CrossSection|Odometry|RegisterEngine|FindDamage|RecordingFolderFiles|(Cuda)?Pipeline[A-Za-z]*|EngineAgreement|RoadModelScene|RenderTruth|SceneBox|Bonnet|Snow)([.].*)?$'
    ;;
  asan-all) programs+=(test_mapping test_io test_live test_flight test_cli) ;;
  tsan)
    programs+=(test_live test_flight)
    with='^(threads|cuda|live|flight)$'
    ;;
  *)
    sed -n '2,/^set/s/^# *//p' "$0" >&2
    exit 2
    ;;
esac
preset=${1%-all}
shift

cmake --preset "$preset" "${options[@]}" "$@"
cmake --build --preset "$preset" -j "$(nproc)" --target "${programs[@]}"
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp"
./scripts/run_tests.sh "build-$preset" --label-regex "$with" --label-exclude '^(slow|real_data|browser|ament)$' \
  --exclude-regex "$without"
echo "Sanitizers: $preset is good."
