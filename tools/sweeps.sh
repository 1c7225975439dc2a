#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# sweeps.sh RAYS: build/release/sweeps/sweeps.md and the plots of docs/numerics.md, by the built caplet_sweeps and gnuplot. ./run sweeps builds and calls it.
# Exit status: 0, 1 when a hit is beyond its bound (the page says where), 2 for wrong usage.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$root/build/release/sweeps
images=$root/docs/images/numerics
code=0
mkdir -p "$folder"
"$root/build/release/bin/caplet_sweeps" "${1:?RAYS: how many a cell}" "$folder/sweeps.md" "$folder" || code=$?
[ "$code" != 2 ] || exit 2
mkdir -p "$images"
for script in "$folder"/*.gp; do (cd "$folder" && gnuplot "$script"); done
cp "$folder"/*.png "$images"
exit "$code"
