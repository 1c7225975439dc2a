#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# The pictures of docs/gallery.md, by the commands that stand there: gallery.sh [CAPLET [NAME...]]. Files of $CAPLET_DATA, the shared test
# data; scenes of this repository without it.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
caplet=${1:-$root/build/release/bin/caplet}
shift || true
wanted=" $* "
cd "$root"
: "${CAPLET_DATA:?the folder of the shared test data}"
export CAPLET_DATA
mkdir -p docs/images/field

# A line of docs/gallery.md that begins with "./run render" is a picture: --preview names it.
grep '^\./run render' docs/gallery.md | while IFS= read -r line; do
  name=$(sed -n 's/.*--preview [^ ]*\/\([^ ]*\)\.png.*/\1/p' <<<"$line")
  if [ "$wanted" != "  " ] && [[ "$wanted" != *" $name "* ]]; then continue; fi
  echo "$name" >&2
  eval "${line/#.\/run/\"$caplet\"} -q" </dev/null
done
