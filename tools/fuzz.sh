#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# fuzz.sh [SECONDS [TARGET...]]: builds the fuzz targets (all by default) and runs them side by side, each for SECONDS of a core (60).
# Corpora and failing inputs stay in build/fuzz. Exit status: 0, 1 when a target found something, 2 for wrong usage.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$root/build/fuzz

say() { echo "caplet: $*" >&2; }

# seeds NAME: a fresh folder with the seeds kept for a fuzz target and the repository's files of its kind.
seeds() {
  local kind=${1#fuzz_} to=$folder/seeds/$1 file
  rm -rf "$to"
  mkdir -p "$to"
  # Large inputs are slow ones.
  find "$root/scenes" "$root/tests" -type f -size -5k \( -path "*/fuzz/seeds/$kind/*" -o -name "*.$kind" \) -print0 |
    while IFS= read -r -d '' file; do cp "$file" "$to/$(cksum <"$file" | cut -d' ' -f1)-$(basename "$file")"; done
  echo "$to"
}

# dictionary NAME: a libFuzzer dictionary of the words that the sources of the target's kind name, and of those in tests/fuzz/words.
dictionary() {
  local kind=${1#fuzz_} to=$folder/seeds/$1.dict
  local words=("$root/tests/fuzz/words/all" "$root/tests/fuzz/words/$kind")
  case $kind in 3mf | dae | embree | mjcf | urdf | vtp) words+=("$root/tests/fuzz/words/xml") ;; esac
  mkdir -p "$folder/seeds"
  {
    # Literals that are one word, or a list of words between blanks.
    find "$root/host" -name "*$kind*.cpp" -exec grep -ohE '"([^" \\]+|[^"\\]* )"' {} + | tr -d '"' | tr ' ' '\n' | grep -E '..' || true
    cat "${words[@]}" 2>/dev/null || true
  } | sed -e 's/\\/\\\\/g; s/"/\\"/g; s/.*/"&"/' | sort -u >"$to"
  echo "$to"
}

seconds=${1:-60}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || {
  say "fuzz: SECONDS must be a positive whole number, not '$seconds'"
  exit 2
}
targets=("${@:2}")
if [ ${#targets[@]} = 0 ]; then
  for target in "$root"/tests/fuzz/fuzz_*.cpp; do targets+=("$(basename "$target" .cpp)"); done
fi
for name in "${targets[@]}"; do
  [ -e "$root/tests/fuzz/$name.cpp" ] || {
    say "fuzz: unknown target '$name' (they are tests/fuzz/fuzz_*.cpp)"
    exit 2
  }
done
"$root/run" build fuzz

# All run at the same time; where they outnumber the cores they share them, for so long that each has had its seconds of a core.
wall=$((seconds * ${#targets[@]} / $(nproc)))
wall=$((wall > seconds ? wall : seconds))
say "fuzzing for $wall s: ${targets[*]}"
names=()
for name in "${targets[@]}"; do
  corpus=$folder/corpus/$name
  mkdir -p "$corpus"
  (cd "$folder" && exec "fuzz/$name" -max_total_time="$wall" -print_final_stats=1 -rss_limit_mb=4096 -timeout=20 \
    -dict="$(dictionary "$name")" -artifact_prefix="$folder/$name-" "$corpus" "$(seeds "$name")") >"$folder/$name.log" 2>&1 &
  names[$!]=$name
done
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
bad=0
while [ ${#names[@]} -gt 0 ]; do
  code=0
  wait -n -p pid "${!names[@]}" || code=$?
  name=${names[pid]}
  unset "names[pid]"
  if [ "$code" = 0 ]; then
    echo "$name: clean, $(sed -nE 's/^stat::number_of_executed_units: *//p' "$folder/$name.log") inputs"
  else
    bad=1
    grep -vE '^(#[0-9]+|\s+NEW_FUNC)' "$folder/$name.log" | tail -n 40
    echo "$name: FAILED (build/fuzz/$name.log)"
  fi
done
exit $bad
