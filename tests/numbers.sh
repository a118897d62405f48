#!/usr/bin/env bash
# Makes tests/NUMBERS.md and its plots: runs all studies (about forty minutes on a free processor) and puts their pages
# together. With names of studies: runs those again, and takes the others' pages as they are.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${SHATTERBOX:-build/release/shatterbox}
pages=build/numbers
names=(motion stress contact step-size refine fragments dynamics scaling)
command -v gnuplot >/dev/null || { echo "the plots need gnuplot (Debian: apt install gnuplot-nox)" >&2; exit 2; }
[ -x "$program" ] || { echo "build $program first" >&2; exit 2; }

mkdir -p "$pages" tests/numbers
for name in "${names[@]}"; do
  if [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || [ ! -e "$pages/$name.md" ]; then
    echo "== $name"
    "$program" study "$name" -o "$pages" >/dev/null
  fi
done

{
  cat <<'HEAD'
# Numbers

Error against run time, measured by the program itself: `bash tests/numbers.sh` makes this page. Times are processor time on one
thread of a shared machine; errors are of the same runs. What each column means is said at each table; sandbox/README.md says
how a study measures. The cheapest setting for an error is the one that took least time of those that reach it and behind which
no finer one misses it: what is right by luck does not count.

| case | what | error at the default | its time | cheapest for 1 % |
|---|---|---|---|---|
HEAD
  for name in "${names[@]}"; do
    sed -n '/<!-- summary -->/,/<!-- end of summary -->/{/<!--/d;p}' "$pages/$name.md" | sed "s/^| /| $name, /"
  done
  echo
  for name in "${names[@]}"; do
    sed -e '/<!-- summary -->/,/<!-- end of summary -->/d' -e 's|](\([a-z_-]*\.png\))|](numbers/\1)|' "$pages/$name.md"
  done
} > tests/NUMBERS.md
cp "$pages"/*.png tests/numbers/
