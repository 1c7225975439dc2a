# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# What the scripts of figures share. They say $caplet, $samples and $pictures, the folder in docs/images, and read it.
out=$(dirname "$0")/../docs/images/$pictures
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$out"

# Portable pixmaps need no library: 4 x 4 texels.
printf 'P3 4 4 255\n230 60 40 240 200 60 60 160 80 40 90 200 250 250 250 30 30 30 250 250 250 30 30 30 40 90 200 230 60 40 240 200 60 60 160 80 30 30 30 250 250 250 30 30 30 250 250 250\n' > "$folder/tiles.ppm"

# rendered NAME: the scene is on the standard input.
rendered() {
  cat > "$folder/$1.pbrt"
  "$caplet" render "$folder/$1.pbrt" -o none --preview "$out/$1.png" --quiet
}
