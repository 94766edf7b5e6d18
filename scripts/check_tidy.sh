#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy over the library and the command line. Needs the build folder of scripts/test.sh.
#   scripts/check_tidy.sh [--all]
set -euo pipefail
cd "$(dirname "$0")/.."

if [ ! -f build/compile_commands.json ]; then
  echo "build/compile_commands.json is missing: run scripts/test.sh first" >&2
  exit 2
fi
# The compile commands come from GCC, some of whose warning options clang does not know. Left to --all: the analyzer, which
# follows paths through the embedded library and takes a third of the time there (the sanitizers see what they find), and
# the experiments of `evaluate`.
tidy() {
  # Only what this build compiles: there may be no CUDA, for example.
  while read -r -d '' file; do
    if grep -qF "\"file\": \"$PWD/$file\"" build/compile_commands.json; then printf '%s\0' "$file"; fi
  done | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build --quiet --extra-arg=-Wno-unknown-warning-option "$@"
}
analyzer='-clang-analyzer-*'
experiments=(-not -path 'apps/roadstereo/evaluate/*')
if [ "${1:-}" = --all ]; then
  analyzer=
  experiments=()
fi
find src -name '*.cpp' -not -path 'src/io/*' -print0 | tidy "--checks=$analyzer"
find src/io apps -name '*.cpp' "${experiments[@]}" -print0 | tidy '--checks=-clang-analyzer-*'
echo "Tidy: good."
