#!/usr/bin/env bash
# Installs, builds and passes all tests: the engine alone (without GL, FFmpeg or JSON) under the address and
# undefined-behaviour sanitizers, then the whole program. tests/README.md says what each label is.
set -euo pipefail
cd "$(dirname "$0")/.."
start=$(date +%s)
jobs=$(nproc)

source sandbox/packages.sh
install_packages tests "${TEST_PACKAGES[@]}"
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)

# test_preset PRESET LABELS: configures, builds, tests.
test_preset() {
  echo "== $1"
  cmake --preset "$1" -DSHATTERBOX_TESTS=ON "${launcher[@]}" >/dev/null
  cmake --build "build/$1" -j "$jobs"
  ctest --test-dir "build/$1" --output-on-failure -j "$jobs" -L "$2"
}

test_preset asan 'unit|robustness|structure'  # -DSHATTERBOX_RENDER=OFF, so the engine alone is built here
test_preset release 'unit|structure|physics|scene|image|robustness'

seconds=$(($(date +%s) - start))
echo "== all passed in $((seconds / 60)) min $((seconds % 60)) s"
