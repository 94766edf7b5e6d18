#!/usr/bin/env bash
# Fails when a source file is not laid out as .clang-format says; --fix lays it out.
set -euo pipefail
cd "$(dirname "$0")/.."

formatter=$(command -v clang-format-14 || command -v clang-format)
mode=(--dry-run --Werror)
if [ "${1:-}" = --fix ]; then
  mode=(-i)
fi
find apps bench examples include python src tests \( -name '*.[ch]pp' -o -name '*.cu' -o -path '*/emulated/*.h' \) -print0 | xargs -0 "$formatter" "${mode[@]}"
echo "Format: good."
