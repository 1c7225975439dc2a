#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# The README's pictures of scenes/materials.pbrt and scenes/hair.pbrt. pictures.sh [CAPLET [SAMPLES]]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
caplet=${1:-$root/build/release/bin/caplet}
samples=${2:-48}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for name in materials hair; do
  size=960x540
  [ $name = materials ] || size=640x360
  "$caplet" render "$root/scenes/$name.pbrt" -o "$folder/$name.exr" --preview "$root/docs/images/$name.png" --size $size --spp "$samples"
done
