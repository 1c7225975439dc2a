#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# Renders one picture on a Slurm cluster: an array of N tasks, each a share of the samples, and a job that merges their films.
#
# usage: shares.sh N SCENE OUT.exr [RENDER_OPTION...]
#
# The films and the logs go to the folder OUT.shares beside the picture, which all nodes must see. A task that is preempted, or whose
# node fails, is queued again and goes on from its last checkpoint; so does one that reaches the time limit. CAPLET: the program
# (default: caplet). CHECKPOINT: seconds between checkpoints (default: 300). Slurm's own variables choose the rest, such as
# SBATCH_PARTITION, SBATCH_TIMELIMIT and SLURM_CPUS_PER_TASK. Prints the numbers of both jobs.
set -euo pipefail

if [ $# -lt 3 ]; then
  sed -n '/^# usage/s/^# //p' "$0" >&2
  exit 2
fi
shares=$1 scene=$(realpath -- "$2") out=$(realpath -m -- "$3")
shift 3
folder=${out%.*}.shares
caplet=${CAPLET:-caplet}
mkdir -p "$folder"

# quoted WORD..., path FILE: for a shell.
quoted() { printf "%q " "$@"; }
path() { printf %q "$1"; }

# The shell waits for the program whatever signal comes. USR1 comes before the time limit to the shell alone; TERM comes to all
# processes of the job, so that it need not be passed on.
array=$(sbatch --parsable --array="1-$shares" --requeue --open-mode=append --signal=B:USR1@60 --job-name=caplet \
  --output="$folder/share-%a.log" <<END
#!/bin/bash
trap 'kill -USR1 \$program' USR1
trap : TERM
$(quoted "$caplet" render "$scene" "$@") --quiet --samples \$SLURM_ARRAY_TASK_ID/$shares --resume \\
  --film $(path "$folder")/share-\$SLURM_ARRAY_TASK_ID.film --checkpoint ${CHECKPOINT:-300} &
program=\$!
code=128
while kill -0 \$program 2>/dev/null; do wait \$program; code=\$?; done
# 75: stopped before the end. Where Slurm queues the task again by itself, this finds nothing to do.
[ \$code != 75 ] || scontrol requeue "\$SLURM_JOB_ID"
exit \$code
END
)
merge=$(sbatch --parsable --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --job-name=caplet-merge \
  --output="$folder/merge.log" <<END
#!/bin/bash
exec $(quoted "$caplet") merge $(path "$folder")/share-*.film -o $(quoted "$out")
END
)
echo "$array $merge"
