#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# The pictures of scenes/materials.pbrt, hair.pbrt, smoke.pbrt and motion.pbrt in README and docs. pictures.sh [CAPLET [SAMPLES]]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
caplet=${1:-$root/build/release/bin/caplet}
samples=${2:-48}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for name in materials hair smoke motion; do
  size=960x540
  [ $name != hair ] || size=640x360
  [ $name != smoke ] || size=480x300
  [ $name != motion ] || size=560x315
  "$caplet" render "$root/scenes/$name.pbrt" -o "$folder/$name.exr" --preview "$root/docs/images/$name.png" --size $size --spp "$samples"
done
