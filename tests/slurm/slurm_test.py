#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Renders shares and frames by tools/slurm on a Slurm cluster of one node, preempts tasks, and compares the merged picture.

usage: slurm_test.py CAPLET
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "films"))
from exr_chunks import chunks  # noqa: E402

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools/slurm"
SHARES = 16
SCENE = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 160 "integer yresolution" 120
Sampler "independent" "integer pixelsamples" {samples}
WorldBegin
LightSource "infinite"
Shape "capsule" "point3 p0" [-.5 0 0] "point3 p1" [.5 0 0] "float radius" 0.6
"""
# Requeued jobs wait until their credentials have expired (cred_expire, seconds).
CONFIG = """ClusterName=caplet
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={node_port}
SlurmUser=root
SlurmdUser=root
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=2,bf_interval=2
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
KillWait=20
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=node NodeHostname=localhost NodeAddr=127.0.0.1 CPUs=2
PartitionName=low Nodes=node Default=YES PriorityTier=1 MaxTime=60
PartitionName=high Nodes=node PriorityTier=10 PreemptMode=OFF MaxTime=60
"""


def skip(why):
    print(f"skipped: {why}", flush=True)
    sys.exit(77)


def free_ports(count):
    import socket
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def until(what, condition, seconds=300):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"after {seconds} s not yet: {what}")
        time.sleep(0.2)


class Cluster:
    """Slurm's daemons, with all their files in a folder."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        port, node_port = free_ports(2)
        (folder / "slurm.conf").write_text(CONFIG.format(folder=folder, port=port, node_port=node_port))
        for name in ("state", "spool"):
            (folder / name).mkdir()
        (folder / "key").write_bytes(os.urandom(64))
        (folder / "key").chmod(0o600)
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        self.start("munged", "--foreground", "--force", f"--key-file={folder}/key", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munge.pid",
                   f"--log-file={folder}/munge.log", f"--seed-file={folder}/munge.seed")
        until("munged is there", (folder / "munge.socket").exists, 30)
        self.start("slurmctld", "-D", "-i")
        self.start("slurmd", "-D", "-N", "node")
        until("the node is idle", lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T", check=False), 60)

    def start(self, *command):
        log = open(self.folder / f"{command[0]}.out", "w")
        self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))

    def ask(self, *command, check=True, **variables):
        result = subprocess.run(command, env={**self.environment, **variables}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if check and result.returncode != 0:
            raise RuntimeError(f"{command}: {result.stdout}")
        return result.stdout

    def waits(self):
        """The jobs that are not done yet."""
        return self.ask("squeue", "-h", "-r", "-o", "%i %T %r").split("\n")[:-1]

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()


def shares(cluster, caplet, folder):
    (folder / "scene.pbrt").write_text(SCENE.format(samples=SHARES * 400))
    program = folder / "program"
    program.write_text(f'#!/bin/bash\necho "$1 ${{SLURM_ARRAY_TASK_ID:-}} ${{SLURM_RESTART_COUNT:-0}}" >> {folder}/runs\nexec {caplet} "$@"\n')
    program.chmod(0o755)
    runs = lambda: [line.split() for line in (folder / "runs").read_text().splitlines()] if (folder / "runs").exists() else []
    cluster.ask(TOOLS / "shares.sh", str(SHARES), folder / "scene.pbrt", folder / "sum.exr", "--variance", CAPLET=str(program), CHECKPOINT="0.2")
    until("a share has a checkpoint", lambda: any(folder.glob("sum.shares/share-*.film")))
    cluster.ask("sbatch", "--partition=high", "-n", "2", "--wrap", "sleep 1", "-o", "/dev/null")
    until("tasks were preempted and run again", lambda: any(len(run) == 3 and run[2] != "0" for run in runs()))
    until("all is done", lambda: not cluster.waits(), 600)
    again = sorted({run[1] for run in runs() if len(run) == 3 and run[2] != "0"})
    for log in sorted(folder.glob("sum.shares/*.log")):
        if text := log.read_text().strip():
            print(f"{log.name}: {text}")
    if not (folder / "sum.exr").exists():
        raise RuntimeError(f"there is no merged picture: {sorted(p.name for p in folder.glob('sum.shares/*'))}")
    subprocess.run([caplet, "render", folder / "scene.pbrt", "--variance", "--film", folder / "one.film", "-q"], check=True)
    subprocess.run([caplet, "merge", folder / "one.film", "-o", folder / "one.exr", "-q"], check=True)
    if chunks(folder / "one.exr") != chunks(folder / "sum.exr"):
        raise RuntimeError("the merged picture is not that of one render")
    # It is another one with a sample less.
    subprocess.run([caplet, "render", folder / "scene.pbrt", "--variance", "--samples", f"1:{SHARES * 400}", "--film", folder / "less.film", "-q"], check=True)
    subprocess.run([caplet, "merge", folder / "less.film", "-o", folder / "less.exr", "-q"], check=True)
    if chunks(folder / "less.exr") == chunks(folder / "one.exr"):
        raise RuntimeError("the comparison sees nothing")
    return again


def limit(cluster, caplet, folder, program):
    """What comes before a time limit: USR1, to the shell of the batch script."""
    job = cluster.ask(TOOLS / "shares.sh", "1", folder / "scene.pbrt", folder / "limit.exr", "--spp", "4000", CAPLET=program, CHECKPOINT="0.2").split()[0]
    film = folder / "limit.shares/share-1.film"
    until("the share has a checkpoint", film.exists)
    cluster.ask("scancel", "--batch", "--signal=USR1", f"{job}_1")
    until("the picture is there", (folder / "limit.exr").exists)
    times = (folder / "limit.shares/share-1.log").read_text().count("interrupted")
    samples = json.loads(subprocess.run([caplet, "film", film, "--json"], check=True, stdout=subprocess.PIPE).stdout)["samples"]
    if times != 1 or samples != [[0, 4000]]:
        raise RuntimeError(f"stopped {times} times, and has {samples}")


def frames(cluster, caplet, folder):
    (folder / "frames").mkdir()
    cluster.ask(TOOLS / "frames.sh", "1-3", folder / "scene.pbrt", folder / "frames/out.##.png", "--turntable", "3", "--spp", "4", CAPLET=caplet)
    until("the frames are done", lambda: not cluster.waits())
    subprocess.run([caplet, "render", folder / "scene.pbrt", "--turntable", "3", "--spp", "4", "-o", folder / "here.##.png", "-q"], check=True)
    for number in (1, 2, 3):
        if (folder / f"frames/out.{number:02}.png").read_bytes() != (folder / f"here.{number:02}.png").read_bytes():
            raise RuntimeError(f"frame {number} is another picture")


def main():
    if not os.environ.get("CAPLET_THOROUGH"):
        skip("a cluster is started by ./run test --all alone")
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")]
    if missing:
        skip(f"Slurm is not installed ({', '.join(missing)})")
    if os.geteuid() != 0:
        skip("Slurm's daemons need root")
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    caplet = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "slurm").mkdir()
        cluster = Cluster(folder / "slurm")
        try:
            again = shares(cluster, caplet, folder)
            limit(cluster, caplet, folder, str(folder / "program"))
            frames(cluster, caplet, folder)
        finally:
            cluster.stop()
        print(f"tasks {', '.join(again)} of {SHARES} were preempted and went on")
    return 0


if __name__ == "__main__":
    sys.exit(main())
