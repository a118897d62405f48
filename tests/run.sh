#!/usr/bin/env bash
# Installs, builds and passes all tests: the engine and the readers of files under the address and undefined-behaviour
# sanitizers, then the whole program. tests/README.md says what each label is.
set -euo pipefail
cd "$(dirname "$0")/.."
start=$(date +%s)
jobs=$(nproc)

source sandbox/packages.sh
install_packages tests "${TEST_PACKAGES[@]}"
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)

# test_preset PRESET LABEL...: configures, builds what these tests need, tests. A new build folder compiles the files of
# a source folder together, which takes half the time when everything is compiled; one that is there keeps its way.
test_preset() {
  local preset=$1 begin=$SECONDS
  shift
  echo "== $preset"
  local unity=()
  [ -e "build/$preset/CMakeCache.txt" ] || unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
  cmake --preset "$preset" -DSHATTERBOX_TESTS=ON "${unity[@]}" "${launcher[@]}" -DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=mold >/dev/null
  cmake --build "build/$preset" -j "$jobs" --target "${@/#/tests_}"
  echo "== $preset built in $((SECONDS - begin)) s"
  local labels
  labels=$(IFS='|' && echo "$*")
  ctest --test-dir "build/$preset" --output-on-failure -j "$jobs" -L "^($labels)\$"
  echo "== $preset passed in $((SECONDS - begin)) s"
}

test_preset asan unit many robustness readers  # no picture is drawn here
test_preset release many structure physics program scene image robustness

seconds=$(($(date +%s) - start))
echo "== all passed in $((seconds / 60)) min $((seconds % 60)) s"
