#!/usr/bin/env bash
# Everything that can be checked on this machine: what .ci/run has no time for as well. To be run before an issue is called
# done; it takes about two hours on two cores. CONTRIBUTING.md says which check is for what.
#   scripts/check_all.sh
set -euo pipefail
cd "$(dirname "$0")/.."

times=()
part() {
  local start=$SECONDS
  echo "== $*"
  "$@"
  times+=("$(printf '%5d s  %s' $((SECONDS - start)) "$*")")
}

# Builds a preset in its folder and runs its tests.
preset() {
  local name=$1
  shift
  cmake --preset "$name" -DROADSTEREO_WERROR=ON "$@"
  cmake --build --preset "$name" -j "$(nproc)"
  ./scripts/run_tests.sh "build-$name"
}

# nvcc compiles every kernel, for one kind of GPU; only a GPU can run them (gpu_check.sh).
nvcc() {
  if ! PATH=$PATH:/usr/local/cuda/bin command -v nvcc >/dev/null; then
    echo "There is no nvcc: kernels are compiled by the host's compiler only"
    return
  fi
  CUDAARCHS=75-real cmake -G Ninja -S . -B build-nvcc -DCMAKE_BUILD_TYPE=Release -DROADSTEREO_EMBEDDED_ONLY=ON \
    -DROADSTEREO_CUDA=ON -DROADSTEREO_WERROR=ON
  cmake --build build-nvcc -j "$(nproc)"
}

part ./scripts/install_deps.sh --all-checks
part ./scripts/check_format.sh
part ./scripts/check_layers.py
part ./scripts/test.sh -DROADSTEREO_WERROR=ON -DROADSTEREO_CUDA=OFF
part ./scripts/check_figures.sh build/bin/roadstereo
part cmake --build build --target docs
part ./scripts/check_tidy.sh --all
part ./scripts/check_install.sh
part ./scripts/check_python.sh
part ./scripts/make_packages.sh
part ./scripts/check_packages.sh
# Without precompiled headers: a source includes what it uses.
part ./scripts/check_sanitizers.sh asan-all -DROADSTEREO_WERROR=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
part ./scripts/check_sanitizers.sh tsan -DROADSTEREO_WERROR=ON
part ./scripts/check_tbb_threads.sh
part preset emulated
part preset standalone -DROADSTEREO_GTEST_SOURCE=/usr/src/googletest \
  -DROADSTEREO_HIGHWAY_SOURCE="${ROADSTEREO_HIGHWAY_SOURCE:-}"
part ./scripts/fuzz.sh
part cmake --build build --target live_player
part ./scripts/soak.py
part nvcc
export ROADSTEREO_WERROR=ON
part ./scripts/check_aarch64.sh
printf '%s\n' "${times[@]}"
