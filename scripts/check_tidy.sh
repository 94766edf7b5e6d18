#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy.
#   scripts/check_tidy.sh        the sources that a change touches
#   scripts/check_tidy.sh --all  the library and the command line, with the analyzer
# A change is what differs from the merge base with origin/main. Where HEAD is origin/main itself, as in a fresh clone, it
# is the last 20 commits. A changed header counts as the source of its name. Of a change of more than 10 sources the 10
# that were changed last are looked at: scripts/check_all.sh looks at the rest.
set -euo pipefail
cd "$(dirname "$0")/.."

# Each source by itself, and without precompiled headers, which clang does not read when they are GCC's.
cmake -S . -B build/tidy -G Ninja -DCMAKE_BUILD_TYPE=Release -DROADSTEREO_CUDA=OFF -DCMAKE_UNITY_BUILD=OFF \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null

# Standard input: files, one a line. Only what this build compiles: there may be no CUDA, for example. Clang 14 does not
# know the coroutines of GCC's library.
tidy() {
  while read -r file; do
    if grep -q co_await "$file" 2>/dev/null; then continue; fi
    if grep -qF "\"file\": \"$PWD/$file\"" build/tidy/compile_commands.json; then printf '%s\0' "$file"; fi
  done | xargs -0 -r -n 1 -P "$(nproc)" \
    clang-tidy -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option "$@"
}

# Commits since the change began, and what is not committed yet; the file that was changed last comes first.
changed() {
  local base depth
  base=$(git merge-base HEAD origin/main 2>/dev/null || git rev-parse HEAD)
  if [ "$base" = "$(git rev-parse HEAD)" ]; then
    depth=$(git rev-list --count --first-parent HEAD)
    base=$(git rev-parse "HEAD~$((depth > 20 ? 20 : depth - 1))")
  fi
  { git diff --name-only HEAD
    git log --format= --name-only "$base..HEAD"; } |
    grep -E '^(src|apps)/.*\.[ch]pp$' | sed 's/\.hpp$/.cpp/' | awk '!seen[$0]++' | head -n 10 || true
}

# The analyzer follows paths through the embedded library and takes a third of the time there; the sanitizers see what
# it finds. Elsewhere it mostly follows paths through other libraries.
if [ "${1:-}" = --all ]; then
  if cmake --build build/tidy --target help | grep -q roadstereo_dds_types; then
    cmake --build build/tidy --target roadstereo_dds_types >/dev/null  # a generated header
  fi
  find src -name '*.cpp' -not -path 'src/io/*' | tidy
  find src/io apps -name '*.cpp' | tidy '--checks=-clang-analyzer-*'
else
  files=$(changed)
  printf '%s\n' "$files" | tidy '--checks=-clang-analyzer-*'
  echo "Tidy: $(printf '%s\n' "$files" | grep -c .) changed sources."
fi
echo "Tidy: good."
