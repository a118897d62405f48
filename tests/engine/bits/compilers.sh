#!/usr/bin/env bash
# Builds the engine and one driver with g++ and clang++ at -O1, -O2 and -O3, and compares the hash of every step.
# compilers.sh SOURCE WORK GENERATOR; a quarter of an hour. Work is kept, so a second time compiles what is new.
set -euo pipefail
source=$1 work=$2 generator=$3
mkdir -p "$work"
first=""
status=0
for compiler in g++ clang++; do
  command -v "$compiler" >/dev/null || { echo "$compiler is not here: not compared"; continue; }
  for level in -O2 -O1 -O3; do
    name=$compiler$level
    cmake -S "$source" -B "$work/$name" -G "$generator" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_CXX_FLAGS_RELEASE="$level -DNDEBUG" -DSHATTERBOX_RENDER=OFF -DSHATTERBOX_TESTS=ON -DCMAKE_UNITY_BUILD=ON \
      >"$work/$name.log"
    cmake --build "$work/$name" --target bits_driver >>"$work/$name.log" 2>&1 || { tail -20 "$work/$name.log"; exit 1; }
    "$work/$name/tests/engine/bits/bits_driver" >"$work/$name.hashes"
    if [ -z "$first" ]; then
      first=$name
    elif ! diff "$work/$first.hashes" "$work/$name.hashes" >"$work/$name.diff"; then
      echo "$name differs from $first, first in step $(head -1 "$work/$name.diff" | tr -dc '0-9,' | cut -d, -f1)"
      status=1
      continue
    fi
    echo "$name: $(tail -1 "$work/$name.hashes") after $(wc -l <"$work/$name.hashes") steps"
  done
done
exit $status
