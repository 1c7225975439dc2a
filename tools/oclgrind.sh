#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# oclgrind.sh [SCENE...]: the built program in Oclgrind, which watches each access of the kernels. Three planted faults must be found;
# then of every scene (by default all of the repository) a picture of 8 x 8 pixels as GPUs and as processors make it (the latter in the wide encoding, which traces many rays at once,
# without a processor's own instructions), the crossing behind a pixel, and all crossings of some rays must leave its log empty. ./run oclgrind builds and calls it. Output stays in build/oclgrind.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$root/build/oclgrind
program=$root/build/release/bin/caplet

# What Oclgrind 21.10 needs to understand a kernel: its clang's optimiser makes vector comparisons whose value it takes for 1 instead of -1,
# and the check of uninitialised values crashes on shuffles of three-component vectors that are stored as four.
build_options="-cl-opt-disable -fpreserve-vec3-type"

# watched NAME CAPLET_ARGUMENTS...: passes when the program does and Oclgrind has nothing to say.
watched() {
  local name=$1 start=$SECONDS log=$folder/$1.log
  shift
  rm -f "$log"
  if CAPLET_CACHE=$folder/cache-$name OCL_ICD_VENDORS=$folder/vendors OCLGRIND_NUM_THREADS=1 OCLGRIND_BUILD_OPTIONS=$build_options \
    OCLGRIND_DATA_RACES=1 OCLGRIND_UNINITIALIZED=1 OCLGRIND_CHECK_API=1 OCLGRIND_MAX_ERRORS=20 OCLGRIND_LOG=$log \
    LD_PRELOAD=$folder/keep.so "$program" "$@" >"$folder/$name.out" 2>&1 && [ -e "$log" ] && [ ! -s "$log" ]; then
    echo "oclgrind $name: clean ($((SECONDS - start)) s)"
  else
    head -n 60 "$log" 2>/dev/null || true
    tail -n 5 "$folder/$name.out"
    echo "oclgrind $name: FAILED ($((SECONDS - start)) s; build/oclgrind/$name.log, .out)"
    return 1
  fi
}

# finds NAME LINE TEXT: with LINE put into the stage `extend`, Oclgrind must report TEXT. Else clean logs would mean nothing.
finds() {
  local planted=$folder/planted-$1
  mkdir -p "$planted"
  cp -r "$root/kernels" "$planted"
  sed -i "/^static void traced_hit(/,/^}/ { s|{\$|{ const uint path = g->queues.queue[item];|; s|^}|$2 }| }" "$planted/kernels/stages/extend.cl"
  CAPLET_KERNELS=$planted/kernels watched "planted-$1" render "$root/scenes/capsules.pbrt" -o "$planted/out.exr" --size 2x2 --spp 1 --max-depth 1 \
    >"$planted/output" 2>&1 || true
  if grep -q "$3" "$folder/planted-$1.log"; then
    echo "oclgrind planted-$1: found, as it should be"
  else
    echo "oclgrind planted-$1: NOT FOUND (build/oclgrind/planted-$1.log)"
    return 1
  fi
}

# scene NAME FILE
scene() {
  local code=0
  CAPLET_PROFILE=gpu watched "$1-render" render "$2" -o "$folder/$1.exr" --size 8x8 --spp 2 --max-depth 4 --variance || code=1
  build_options="$build_options -DCAPLET_PORTABLE" \
    watched "$1-wide" render "$2" -o "$folder/$1-wide.exr" --size 8x8 --spp 2 --max-depth 4 --encoding wide || code=1
  watched "$1-pick" pick "$2" --size 8x8 --pixel 3,4 || code=1
  watched "$1-list" pick "$2" --all --limit 1000 --rays "$folder/rays.txt" --out "$folder/$1.csv" || code=1
  return $code
}

scenes=()
for file in "$@"; do scenes+=("$(realpath "$file")"); done
if [ ${#scenes[@]} = 0 ]; then
  scenes=("$root"/scenes/*.* "$root"/scenes/reference/*.pbrt "$root"/tests/render/*.pbrt "$root"/tests/query/*.pbrt)
fi
rm -rf "$folder"
mkdir -p "$folder/vendors"
driver=$(dirname "$(readlink -f "$(command -v oclgrind)")")/../lib/oclgrind/liboclgrind-rt-icd.so
[ -e "$driver" ] || { echo "oclgrind.sh: no $driver (Debian's package oclgrind)" >&2; exit 1; }
realpath "$driver" >"$folder/vendors/oclgrind.icd"
# What Oclgrind 21.10 knows of written bytes: where a buffer takes the number of another that was given back, the other's size, so none is given
# back; and nothing of those that clEnqueueFillBuffer fills (sort bins), so they are written.
cat >"$folder/keep.c" <<'END'
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdlib.h>
#include <string.h>

cl_int clReleaseMemObject(cl_mem memory) {
  (void)memory;
  return CL_SUCCESS;
}

cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void *pattern, size_t pattern_size, size_t offset, size_t size,
                           cl_uint waits, const cl_event *wait_list, cl_event *event) {
  char *bytes = malloc(size);
  if (!bytes) return CL_OUT_OF_HOST_MEMORY;
  for (size_t i = 0; i < size; i += pattern_size) memcpy(bytes + i, pattern, pattern_size);
  const cl_int status = clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, size, bytes, waits, wait_list, event);
  free(bytes);
  return status;
}
END
${CC:-cc} -shared -fPIC "$folder/keep.c" -o "$folder/keep.so"
bad=0 running=0
# The array that `extend` writes its hits into, as the stage names it. What is planted leaves the hits right, so that the device is not refused.
hits=$(grep -oE 'g->[a-z_.]*path_hit' "$root/kernels/stages/extend.cl" | head -n 1)
finds access "$hits[path + 100000000u].t = 0.0f;" "Invalid write" || bad=1
finds race "$hits[0].t = $hits[0].t;" "data race" || bad=1
finds uninitialised "float never[2]; never[1] = 0.0f; if (never[item % 2u] > 0.0f) $hits[path].t = 1.0f;" "ninitialized" || bad=1
# From around to the middle: most scenes lie there.
awk 'BEGIN { srand(1); for (i = 0; i < 24; ++i) { x = 8 * rand() - 4; y = 8 * rand() - 4; z = 8 * rand() - 4;
  print x, y, z, rand() - 0.5 - x, rand() - 0.5 - y, rand() + 0.5 - z } }' >"$folder/rays.txt"
for file in "${scenes[@]}"; do
  case "$file" in *.pbrt | *.swc | *.capsules) ;; *) continue ;; esac
  if [ "$running" -ge "$(nproc)" ]; then
    wait -n || bad=1
    running=$((running - 1))
  fi
  scene "$(basename "$file" | tr . -)" "$file" &
  running=$((running + 1))
done
while [ "$running" -gt 0 ]; do
  wait -n || bad=1
  running=$((running - 1))
done
exit $bad
