#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# Renders frames on a Slurm cluster: an array with a task for every frame.
#
# usage: frames.sh A-B SCENE OUT.####.png RENDER_OPTION...
#
# The options choose what moves, such as --turntable 72; for numbered scene files SCENE has their ####. A frame whose picture is there
# is left out, so that the same command goes on after a failure. CAPLET: the program (default: caplet). Slurm's own variables choose
# the rest. Prints the number of the job.
set -euo pipefail

if [ $# -lt 3 ]; then
  sed -n '/^# usage/s/^# //p' "$0" >&2
  exit 2
fi
frames=$1 scene=$(realpath -m -- "$2") out=$(realpath -m -- "$3")
shift 3
mkdir -p "${out%/*}"
quoted() { printf '%q ' "$@"; }
exec sbatch --parsable --array="$frames" --requeue --open-mode=append --job-name=caplet-frames --output="${out%/*}/frame-%a.log" <<END
#!/bin/bash
exec $(quoted "${CAPLET:-caplet}" render "$scene" "$@" -o "$out") --quiet --skip-existing \\
  --frames \$SLURM_ARRAY_TASK_ID-\$SLURM_ARRAY_TASK_ID
END
