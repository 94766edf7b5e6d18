#!/usr/bin/env bash
# Runs the tests with the address and undefined-behaviour sanitizers, and those of the embedded library with the thread
# sanitizer. Left out, because sanitizers make them last too long: the experiments of `evaluate`, the tests on real data
# and in a browser, and the largest comparisons with the reference engine, whose small ones take the same ways through
# the code. Under the thread sanitizer also what has no threads, or the same as another test: other scenes and presets.
# Threads of emulated kernels are threads to it.
set -euo pipefail
cd "$(dirname "$0")/.."

slow='DamageCommand.Evaluate|odd_large|large_windows|_100$|Peers.Fast|RoadScene|InBrowser|CudaPreset.*/paper|CudaPipeline.Allocates'
same_threads='Cuda(Preset|Pipeline)|EveryPreset.*/(paper|fast)|NamedScene|OfScene|Synth.Truth|Synth.EveryScene|FindDamage.(Kerb|Intact|Measures)|RowAlignment.FindsTheOffset|Pipeline.(Straight|Corrected|Colour|RollOf|WorksWithout|RowsThat|Refuses)'
threaded=(test_alignment test_carry_over test_coarse_search test_damage test_engines test_parallel test_perspective
          test_pipeline test_queues test_refinement test_road_geometry test_road_model test_synth)
kernels=(test_cuda_block test_cuda_coarse test_cuda_disparity_transform test_cuda_emulation test_cuda_grey
         test_cuda_guided_match test_cuda_perspective test_cuda_pipeline test_cuda_refinement test_cuda_road_fit
         test_cuda_road_verification test_cuda_robust_plane)

# check <preset> <tests left out> [<programs, all of them without any>]
check() {
  local preset=$1 left_out=$2 targets=()
  shift 2
  [ $# -eq 0 ] || targets=(--target "$@")
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$(nproc)" "${targets[@]}"
  ctest --test-dir "build-$preset" --output-on-failure -j "$(nproc)" --label-exclude real_data --exclude-regex "$left_out"
}

export UBSAN_OPTIONS=print_stacktrace=1
check asan "$slow"
check tsan "$slow|$same_threads|NOT_BUILT" "${threaded[@]}" "${kernels[@]}"
echo "Sanitizers: good."
