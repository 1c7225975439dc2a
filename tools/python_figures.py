#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Figures of docs/performance.md, "From Python": arrays to hits, beside `caplet pick` on files of the same rays, and pictures one after another.

usage: python_figures.py CAPLET [RAYS [CAPSULES [ROUNDS]]]    (the package is to be importable; defaults 10000000 1000000 5)
       python_figures.py --views                              pictures a second by caplet.render, alone

Both ways take turns; medians are printed. Of Python it is the time of one call of caplet.trace, arrays to arrays, with the scene on the
device; of the program what it says: the time "in all", with reading the rays, sending the scene and writing the hits, and that of the queries alone.
"""
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import caplet


def views(count=40):
    """Pictures of some capsules, each of a camera of its own: by a call of caplet.render."""
    scene = caplet.Scene()
    rng = np.random.default_rng(16)
    p0 = rng.random((1000, 3)) - 0.5
    scene.add_capsules(p0, p0 + rng.normal(0, 0.05, (1000, 3)), 0.01)
    scene.add_light(caplet.lights.infinite())
    for size in ((16, 12), (320, 240)):
        caplet.render(scene, spp=1, size=size)  # compiles
        times = []
        for i in range(count):
            scene.look_at((2 * np.cos(i), 2 * np.sin(i), 0.5), (0, 0, 0))
            start = time.perf_counter()
            caplet.render(scene, spp=1, size=size)
            times.append(time.perf_counter() - start)
        print(f"caplet.render of {size[0]} x {size[1]} pixels, 1 sample, 1000 capsules: {1000 * statistics.median(times):.0f} ms a picture")


def main(program, rays=10_000_000, capsules=1_000_000, rounds=5):
    rng = np.random.default_rng(16)
    p0 = rng.random((capsules, 3), dtype=np.float32)
    p1 = p0 + rng.normal(0, 0.005, (capsules, 3)).astype(np.float32)
    radius = np.full(capsules, 0.001, dtype=np.float32)
    origins = np.empty((rays, 3), dtype=np.float32)
    origins[:] = rng.random((rays, 3), dtype=np.float32) * [1, 1, 0] - [0, 0, 1]
    directions = np.empty((rays, 3), dtype=np.float32)
    directions[:] = rng.normal(0, 0.1, (rays, 3)) + [0, 0, 1]
    made, asked, picked, alone = [], [], [], []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = caplet.Scene()
        scene.add_capsules(p0, p1, radius)
        scene.save(folder / "scene.pbrt")
        np.save(folder / "rays.npy", np.concatenate([origins, directions], axis=1))
        command = [program, "pick", folder / "scene.pbrt", "--rays", folder / "rays.npy", "--out", folder / "hits.npy"]
        for _ in range(rounds):
            start = time.perf_counter()
            scene = caplet.Scene()
            scene.add_capsules(p0, p1, radius)
            made.append(time.perf_counter() - start)
            caplet.trace(scene, origins[:1], directions[:1])  # sends the scene, compiles
            start = time.perf_counter()
            hits = caplet.trace(scene, origins, directions)
            asked.append(time.perf_counter() - start)
            said = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=True).stderr
            picked.append(float(re.search(r"([\d.]+) s in all", said)[1]))
            alone.append(rays / 1e6 / float(re.search(r"([\d.]+) Mrays/s", said)[1]))
            print(f"scene {made[-1]:.3f} s, trace {asked[-1]:.2f} s, pick {picked[-1]:.2f} s: {said.strip()}", file=sys.stderr)
        rows = np.load(folder / "hits.npy", mmap_mode="r")
        assert len(rows) == np.isfinite(hits["t"]).sum()
    print(f"scene of {capsules} capsules from arrays: {statistics.median(made):.2f} s")
    print(f"{rays} rays: caplet.trace {statistics.median(asked):.2f} s, caplet pick {statistics.median(picked):.2f} s in all, "
          f"{statistics.median(alone):.2f} s of it queries; ratio {statistics.median(a / b for a, b in zip(asked, picked)):.2f}, to the queries alone "
          f"{statistics.median(a / b for a, b in zip(asked, alone)):.2f}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--views":
        views()
    else:
        main(sys.argv[1], *map(int, sys.argv[2:]))
