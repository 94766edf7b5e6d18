#!/usr/bin/env bash
# The embedded library's tests of threads with oneTBB under the thread sanitizer. The sanitizer must see inside oneTBB, which
# is therefore built from Debian's source package, of the version that is installed.
#   scripts/check_tbb_threads.sh [options of CMake]
set -euo pipefail
cd "$(dirname "$0")/.."

build=$PWD/build-tsan-tbb
tbb=$build/onetbb
mkdir -p "$tbb/lists"
if [ ! -d "$tbb/installed" ]; then
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  printf 'deb-src http://deb.debian.org/debian %s main\n' "$release" "$release-updates" > "$tbb/sources.list"
  printf 'deb-src http://deb.debian.org/debian-security %s-security main\n' "$release" >> "$tbb/sources.list"
  lists=(-o "Dir::Etc::sourcelist=$tbb/sources.list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$tbb/lists")
  apt-get "${lists[@]}" update -qq
  (cd "$tbb" && apt-get "${lists[@]}" source --download-only -qq onetbb)
  mkdir -p "$tbb/source"
  tar xf "$tbb"/onetbb_*.orig.tar.* -C "$tbb/source" --strip-components=1
  cmake -G Ninja -S "$tbb/source" -B "$tbb/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DCMAKE_INSTALL_PREFIX="$tbb/installed"
  cmake --build "$tbb/build" -j "$(nproc)"
  cmake --install "$tbb/build" >/dev/null
fi

cmake --preset tsan -B "$build" -DROADSTEREO_TBB=ON -DTBB_DIR="$(dirname "$(find "$tbb/installed" -name TBBConfig.cmake)")" \
  -DROADSTEREO_EMBEDDED_ONLY=ON -DROADSTEREO_CUDA=OFF "$@"
cmake --build "$build" -j "$(nproc)" --target test_embedded
export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp"
./scripts/run_tests.sh "$build" --label-regex '^threads$' --label-exclude '^slow$'
echo "Threads with oneTBB: good."
