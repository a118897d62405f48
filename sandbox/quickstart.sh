#!/usr/bin/env bash
# From a clean clone to the first video: installs what is missing (Debian 12), builds, runs the ornament.
set -euo pipefail
cd "$(dirname "$0")/.."
start=$(date +%s)

source sandbox/packages.sh
install_packages build "${BUILD_PACKAGES[@]}"

echo "== building"
unity=()  # a first build compiles the files of a folder together, which takes half the time
[ -e build/release/CMakeCache.txt ] || unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
cmake --preset release -DSHATTERBOX_TESTS=OFF "${unity[@]}" >/dev/null
cmake --build --preset release --target shatterbox

echo "== running scenes/ornament.toml"
build/release/shatterbox run scenes/ornament.toml --quality full --size 1280x720 -o ornament.mp4

seconds=$(($(date +%s) - start))
echo "== done in $((seconds / 60)) min $((seconds % 60)) s; the video is $(pwd)/ornament.mp4"
