#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# portable_trial_inside.sh alone|beside [SECONDS]: what portable_trial.sh does in a bare system, in the folder of a user. `alone` installs the wheel
# and uses the bundled driver; `beside`, later, tries it with the system's PoCL in the same process.
set -euo pipefail
cd ~
given=$HOME/given
caplet=$HOME/env/bin/caplet
seconds=${2:-60}  # from the wheel to a picture

count_children() { # into $children: seconds of processors that all children took
  times >times.log
  children=$(awk 'NR == 2 {gsub(/[ms]/, " "); print $1 * 60 + $2 + $3 * 60 + $4}' times.log)
}
minus() { awk "BEGIN {printf \"%.1f\", $1 - $2}"; }
step() { # step NAME COMMAND...: its output only where it fails
  local name=$1 start=$EPOCHREALTIME before
  count_children
  before=$children
  shift
  if ! "$@" >out.log 2>&1; then
    echo "FAILED: $name ($*)"
    tail -n 30 out.log
    exit 1
  fi
  count_children
  echo "$name: $(minus $EPOCHREALTIME $start) s, $(minus "$children" "$before") s of processors"
}
has() { grep -q "$1" out.log || { echo "FAILED: its output lacks '$1'"; cat out.log; exit 1; }; }

if [ "$1" = alone ]; then
  for absent in gcc cc clang ld ld.lld; do
    if command -v $absent; then echo "FAILED: this system has $absent"; exit 1; fi
  done
  first=$EPOCHREALTIME
  step "venv" python3 -m venv env
  step "pip install" env/bin/pip install --no-index --find-links "$given" "$given"/caplet-*.whl
  step "render, first" "$caplet" render "$given/neuron.swc" -o neuron.exr --preview neuron.png --size 960x540 --spp 64
  whole=$(minus $EPOCHREALTIME $first)
  echo "wheel to neuron.png: $whole s"
  test -s neuron.png && test -s neuron.exr
  awk "BEGIN {exit !($whole < $seconds)}" || { echo "FAILED: that is more than $seconds s"; exit 1; }
  step "render, again" "$caplet" render "$given/neuron.swc" -o again.exr --preview neuron.png --size 960x540 --spp 64
  step "devices" "$caplet" devices
  has "bundled with Caplet"
  step "doctor" "$caplet" doctor --timeout 60
  has "the bundled one is used"
  has "passes the self-test"
  step "verify" "$caplet" verify --rays 100000
  step "convert" "$caplet" convert "$given/capsules.pbrt" out.pbrt
  step "pick" "$caplet" pick "$given/capsules.pbrt" --pixel 100,100
  # Two processes at once, with an empty cache.
  rm -rf .cache
  "$caplet" render "$given/capsules.pbrt" -o one.exr --size 64x36 --spp 4 >one.log 2>&1 &
  step "two at once" "$caplet" render "$given/capsules.pbrt" -o two.exr --size 64x36 --spp 4
  wait $! || { cat one.log; exit 1; }
  cat >picture.py <<'END'
import caplet, numpy
scene = caplet.Scene()
scene.add_capsules([[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [2, 1, 0]], radius=0.2, color=(0.8, 0.3, 0.1))
image = caplet.render(scene, spp=4, size=(96, 54))
assert image.rgb.shape == (54, 96, 3) and numpy.isfinite(image.rgb).all() and image.rgb.max() > 0
assert image._repr_png_()[:4] == b"\x89PNG"          # what a notebook shows
assert [device["bundled"] for device in caplet.devices()] == [True]
image.save("python.png")
END
  step "python" env/bin/python picture.py
  # A processor that LLVM 15 has no name for, and those without AVX2.
  step "a processor without a name" env POCL_LLVM_CPU_NAME=generic CAPLET_CACHE=$HOME/unknown "$caplet" pick "$given/capsules.pbrt" --pixel 9,9
  for level in sse2 avx avx2; do
    step "functions for $level" env POCL_KERNELLIB_NAME=$level CAPLET_CACHE=$HOME/$level "$caplet" verify --rays 1000
  done
  # The viewer answers.
  "$caplet" view "$given/capsules.pbrt" --port 0 --no-browser >view.log 2>&1 &
  viewer=$!
  for _ in $(seq 100); do
    address=$(grep -o 'http://[^ ]*' view.log | head -n 1 || true)
    [ -n "$address" ] && break
    sleep 0.2
  done
  step "view" python3 -c 'import sys, urllib.request; page = urllib.request.urlopen(sys.argv[1]).read(); assert b"<canvas" in page or b"<html" in page' "$address"
  kill -INT $viewer
  wait $viewer || { echo "FAILED: view"; cat view.log; exit 1; }
  # An image that needs OpenImageIO is refused by name.
  if "$caplet" render "$given/capsules.pbrt" -o a.exr --preview a.jpg --size 8x8 --spp 1 >out.log 2>&1; then echo "FAILED: a.jpg was written"; exit 1; fi
  has "OpenImageIO"
else
  step "devices" "$caplet" devices
  [ "$(grep -c '^[0-9]' out.log)" = 2 ] || { echo "FAILED: not two devices"; cat out.log; exit 1; }
  tail -n 1 out.log | grep -q "bundled with Caplet" || { echo "FAILED: the bundled one is not the last"; exit 1; }
  step "doctor" "$caplet" doctor --timeout 60 --device bundled
  has "offers 1 platform"
  step "bundled, beside" "$caplet" render "$given/neuron.swc" -o beside.exr --size 960x540 --spp 64 --device bundled
  cat >both.py <<'END'
import caplet, numpy
scene = caplet.load("given/capsules.pbrt")
devices = caplet.devices()
assert [device["bundled"] for device in devices] == [False, True], devices
one, two = (caplet.render(scene, spp=4, size=(64, 36), device=i) for i in (0, 1))   # one process
print(devices[0]["driver"], "and", devices[1]["driver"], "equal:", numpy.array_equal(one.rgb, two.rgb))
END
  step "both in one process" env/bin/python both.py
  cat out.log
fi
