#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What a render takes in time and memory, by the number of capsules.

usage: scale.py PROGRAM [--most N] [--limit BYTES]

Renders 1280 x 960 pixels of 4 samples of tractograms (.tck, 99 capsules a track, coloured by direction) of 10^3, 10^4, ... up to
N (10^7) capsules, which are made here, and prints a table: seconds of loading, of the tree and of rendering, and bytes a capsule of
the whole process at its peak and on the device; then of a tree file of the same (`caplet build`) seconds in all and to the first
sample of every pixel. `--limit`: each of them is in a control group of so much memory, which root can make. Needs numpy.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

POINTS = 100  # of a track


def write_tracks(path, capsules):
    """Writes tracks of slowly turning directions, which begin anywhere in a cube of 200 mm."""
    tracks = -(-capsules // (POINTS - 1))
    rng = numpy.random.default_rng(1)
    with open(path, "wb") as out:
        out.write(f"mrtrix tracks\ndatatype: Float32LE\ncount: {tracks}\nfile: . 200\nEND\n".encode().ljust(200, b"\0"))
        for first in range(0, tracks, 10000):
            count = min(10000, tracks - first)
            start = rng.uniform(-100, 100, (count, 1, 3))
            direction = rng.normal(size=(count, 1, 3))
            direction /= numpy.linalg.norm(direction, axis=2, keepdims=True)
            turns = numpy.cumsum(rng.normal(size=(count, POINTS, 3)), 1) / 30
            points = numpy.full((count, POINTS + 1, 3), numpy.nan, "<f4")  # a NaN ends a track
            points[:, :POINTS] = start + numpy.cumsum(0.5 * (direction + turns), 1)
            out.write(points.tobytes())
        out.write(numpy.full(3, numpy.inf, "<f4").tobytes())


def control_group(limit):
    """Makes a control group of so much memory, and returns the file that takes its processes' numbers."""
    for root, name in (("/sys/fs/cgroup/memory", "memory.limit_in_bytes"), ("/sys/fs/cgroup", "memory.max")):
        group = pathlib.Path(root) / "caplet_scale"
        if not pathlib.Path(root).is_dir():
            continue
        group.mkdir(exist_ok=True)
        if (group / name).exists():
            (group / name).write_text(str(limit))
            return group / "cgroup.procs"
        group.rmdir()
    sys.exit("scale.py: there is no control group of memory")


def run(group, *arguments):
    """Runs in the group."""
    enter = (lambda: group.write_text(str(os.getpid()))) if group else None
    subprocess.run(arguments, check=True, preexec_fn=enter)


def render(program, scene, folder, group):
    """Renders, and returns the statistics."""
    stats = folder / "stats.json"
    run(group, program, "render", scene, "-o", folder / "out.exr", "--size", "1280x960", "--spp", "4", "--quiet", "--stats", stats)
    return json.loads(stats.read_text())


def first_sample(stats):
    """Seconds from the start of the program to the first sample of every pixel."""
    seconds = stats["seconds"]
    return seconds["total"] - seconds["render"] - seconds["write"] + stats["first_pass_seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--most", type=float, default=1e7)
    parser.add_argument("--limit", type=float)
    options = parser.parse_args()
    group = control_group(int(options.limit)) if options.limit else None
    print("| capsules | loading, s | tree, s | rendering, s | all, s | bytes each | on the device | tree file: all, s | first sample, s |\n"
          "|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene, capsules = folder / "tracks.tck", 1000
        while capsules <= options.most:
            write_tracks(scene, capsules)
            stats = render(options.program, scene, folder, group)
            seconds = stats["seconds"]
            tree = folder / "tracks.tree"
            run(group, options.program, "build", scene, tree, "--size", "1280x960", "--quiet")
            of_tree = render(options.program, tree, folder, group)
            print(f"| {capsules:,} | {seconds['load']:.2f} | {seconds['build']:.2f} | {seconds['render']:.2f} | {seconds['total']:.2f} | "
                  f"{stats['peak_bytes'] / capsules:.1f} | {stats['peak_device_bytes'] / capsules:.1f} | {of_tree['seconds']['total']:.2f} | {first_sample(of_tree):.2f} |", flush=True)
            capsules *= 10
    if group:
        print("most memory of the group:", (group.parent / "memory.max_usage_in_bytes").read_text().strip()
              if (group.parent / "memory.max_usage_in_bytes").exists() else "see memory.peak")
        group.parent.rmdir()


if __name__ == "__main__":
    main()
