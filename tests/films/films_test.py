#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Films that outlive what happens to the programs that make them.

usage: films_test.py CAPLET TEST

Exit status 77, with the reason, without CAPLET_THOROUGH.
"""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

from exr_chunks import chunks

SCENE = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 160 "integer yresolution" 120
Sampler "sobol" "integer pixelsamples" {samples}
WorldBegin
LightSource "infinite"
Material "diffuse" "rgb reflectance" [ .7 .5 .3 ]
Shape "capsule" "point3 p0" [-.5 0 0] "point3 p1" [.5 0 0] "float radius" 0.6
"""


class Folder:
    def __init__(self, caplet, folder, samples):
        self.caplet, self.folder, self.samples = caplet, pathlib.Path(folder), samples
        (self.folder / "scene.pbrt").write_text(SCENE.format(samples=samples))

    def start(self, *arguments):
        return subprocess.Popen([self.caplet, *arguments], cwd=self.folder, stderr=subprocess.DEVNULL)

    def run(self, *arguments):
        return subprocess.run([self.caplet, *arguments], cwd=self.folder, check=True, stdout=subprocess.PIPE, text=True).stdout

    def samples_in(self, film):
        return json.loads(self.run("film", film, "--json"))["samples"]

    def expect_picture_of_one_render(self, merged):
        self.run("render", "scene.pbrt", "--film", "one.film", "-q")
        self.run("merge", "one.film", "-o", "one.exr", "-q")
        if chunks(self.folder / merged) != chunks(self.folder / "one.exr"):
            raise RuntimeError(f"{merged} has not the bits of one render")


def SharesThatAreKilledMerge(caplet, folder):
    draw, count = random.Random(5), 64
    here = Folder(caplet, folder, count * 150)
    shares = list(range(1, count + 1))
    killed = set(draw.sample(shares, 20))
    draw.shuffle(shares)
    again = 0
    while shares:
        share = shares.pop()
        process = here.start("render", "scene.pbrt", "--samples", f"{share}/{count}", "--film", f"{share}.film", "--checkpoint", "0.1", "--resume", "-q")
        if share in killed:
            killed.remove(share)
            try:
                process.wait(draw.uniform(0.1, 0.6))
            except subprocess.TimeoutExpired:
                process.send_signal(draw.choice([signal.SIGKILL, signal.SIGTERM]))
        if process.wait() != 0:
            if process.returncode not in (75, -signal.SIGKILL, -signal.SIGTERM):
                raise RuntimeError(f"share {share} ended with {process.returncode}")
            again += 1
            shares.insert(draw.randrange(len(shares) + 1), share)
    if again < 15:
        raise RuntimeError(f"only {again} shares were killed before their end")
    films = [f"{share}.film" for share in range(1, count + 1)]
    draw.shuffle(films)
    here.run("merge", *films, "-o", "sum.exr", "-q")
    here.expect_picture_of_one_render("sum.exr")
    print(f"{again} of {count} shares were killed and started again")


def CheckpointsOutliveKills(caplet, folder):
    here, draw = Folder(caplet, folder, 10**7), random.Random(6)
    done, kills, within = 0, 50, 0
    for _ in range(kills):
        process = here.start("render", "scene.pbrt", "--film", "a.film", "--checkpoint", "0.1", "--resume", "-q")
        end = time.monotonic() + 60
        # The file of a checkpoint that is being written lies beside the film; it is not the one that a run before left.
        old = set(os.listdir(folder))
        while process.poll() is None and time.monotonic() < end:
            new = [name for name in os.listdir(folder) if name not in old and name.startswith(".a.")]
            if new and (here.folder / "a.film").exists() and draw.random() < 0.5:
                time.sleep(draw.uniform(0, 0.01))
                within += any((here.folder / name).exists() for name in new)
                break
        process.kill()
        process.wait()
        samples = here.samples_in("a.film")
        if len(samples) != 1 or samples[0][0] != 0 or samples[0][1] < done:
            raise RuntimeError(f"after {done} samples the film has {samples}")
        done = samples[0][1]
    if within < kills // 4:
        raise RuntimeError(f"only {within} of {kills} kills were in the midst of a checkpoint")
    (here.folder / "scene.pbrt").write_text(SCENE.format(samples=done + 3))
    here.run("render", "scene.pbrt", "--film", "a.film", "--resume", "-q")
    here.run("merge", "a.film", "-o", "a.exr", "-q")
    here.expect_picture_of_one_render("a.exr")
    left = sorted(name for name in os.listdir(folder) if name.startswith("."))
    if left:
        raise RuntimeError(f"left behind: {left}")
    print(f"{kills} kills, {within} of them in the midst of a checkpoint: {done} samples")


def main():
    if not os.environ.get("CAPLET_THOROUGH"):
        print("skipped: takes minutes, for ./run test --all", flush=True)
        return 77
    caplet, test = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        globals()[test](str(pathlib.Path(caplet).resolve()), folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
