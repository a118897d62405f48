#!/usr/bin/env bash
# Installs the engine from a build folder into an empty prefix, takes the examples out of engine/README.md, builds them
# as a stranger's project would, and runs them. examples.sh BUILD SOURCE CXX GENERATOR
set -euo pipefail
build=$1 source=$2 compiler=$3 generator=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/prefix" --component engine >/dev/null
mkdir "$work/examples"
# The first line of each block of C++ names its file: "// drop.cpp: ...".
awk -v folder="$work/examples" '
  /^```cpp$/ { is_code = 1; file = ""; next }
  /^```$/    { is_code = 0 }
  is_code    { if (file == "") { file = folder "/" $2; sub(/:$/, "", file) } print > file }
' "$source/engine/README.md"
awk '/^```cmake$/ { is_code = 1; next } /^```$/ { is_code = 0 } is_code' "$source/engine/README.md" \
  >"$work/examples/CMakeLists.txt"

names=()
for file in "$work"/examples/*.cpp; do names+=("$(basename "$file" .cpp)"); done
[ ${#names[@]} -ge 2 ] || { echo "found only ${#names[@]} examples in engine/README.md"; exit 1; }
for name in "${names[@]}"; do
  grep -q "add_executable($name " "$work/examples/CMakeLists.txt" && continue
  printf 'add_executable(%s %s.cpp)\ntarget_link_libraries(%s PRIVATE shatterbox::engine)\n' "$name" "$name" "$name" \
    >>"$work/examples/CMakeLists.txt"
done
cmake -S "$work/examples" -B "$work/build" -G "$generator" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="-O1 -Wall -Wextra -Wshadow -Werror" >/dev/null
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
for name in "${names[@]}"; do
  echo "== $name"
  "$work/build/$name"
done
