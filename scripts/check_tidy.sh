#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy over the library and the command line. Needs the build folder of scripts/test.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ ! -f build/compile_commands.json ]; then
  echo "build/compile_commands.json is missing: run scripts/test.sh first" >&2
  exit 2
fi
# The compile commands come from GCC, some of whose warning options clang does not know. The analyzer follows paths
# through the library alone: it takes a third of the time, and the sanitizers see the command line.
tidy() {
  local folder=$1
  shift
  find "$folder" -name '*.cpp' -print0 | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build --quiet \
    --extra-arg=-Wno-unknown-warning-option "$@"
}
tidy src
tidy apps '--checks=-clang-analyzer-*'
echo "Tidy: good."
