#!/usr/bin/env bash
# Runs the tests with the address and undefined-behaviour sanitizers, and those of the embedded library with the thread
# sanitizer. Left out, because sanitizers make them last too long: the experiments of `evaluate`, the tests on real data
# and in a browser, and the largest comparisons with the reference engine, whose small ones take the same ways through
# the code. Under the thread sanitizer also what has the same threads as another test: other scenes, presets and
# instruction sets, and the emulated kernels but for two pipelines at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

slow='DamageCommand.Evaluate|odd_large|large_windows|_100$|Peers.Fast|RoadScene|InBrowser|CudaPreset.*/paper|CudaPipeline.Allocates'
same_threads='Cuda(Preset|Coarse|Disp|Grey|Shrink|Guided|Persp|Refine|Road|Robust|Block|Emul|Pipeline.(Takes|Refuses|Goes|Without))|/cuda|EveryPreset.*/(paper|fast)|EveryTarget|NamedScene|OfScene|ReferenceEngine|Synth.Truth|Synth.EveryScene|CrossSection|FindDamage.(Kerb|Intact|Measures)|RowAlignment.FindsTheOffset|Pipeline.(Straight|Corrected|Colour|RollOf|WorksWithout|RowsThat|Refuses)'

check() {
  local preset=$1 left_out=$2
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$(nproc)"
  ctest --test-dir "build-$preset" --output-on-failure -j "$(nproc)" --label-exclude real_data --exclude-regex "$left_out"
}

export UBSAN_OPTIONS=print_stacktrace=1
check asan "$slow|CudaPipeline.TwoInTwo"
check tsan "$slow|$same_threads"
echo "Sanitizers: good."
