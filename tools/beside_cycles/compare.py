# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Denoised pictures of equal time beside Cycles: FLIP and PSNR of four scenes, each against its renderer's own reference.

usage: compare.py FOLDER [--seconds 1,4] [--reference 4096] [--height 180] [--scenes neuron,hair,gallery,smoke] [--rounds 3]

Needs PyPI's OpenEXR and flip-evaluator, bpy (CYCLES_PYTHON names its interpreter), Debian's python3-openvdb
(OPENVDB_PYTHON names the interpreter that has it) and what `caplet render --denoise` needs. CAPLET names the program.
Both renderers take turns. Seconds are those of a whole run without those of a run of one sample that is not denoised, so
loading does not count. Pictures are compared in sRGB, clipped to a display's range.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

import numpy as np
import OpenEXR
from flip_evaluator import evaluate

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent.parent / "scenes"
FILES = {"neuron": "neuron.swc", "hair": "hair.pbrt", "gallery": "gallery.pbrt", "smoke": "smoke.pbrt"}
SHAPE = {"neuron": 16 / 9, "hair": 16 / 9, "gallery": 16 / 9, "smoke": 8 / 5}

VDB = """
import sys
import numpy as np
import pyopenvdb
grid = pyopenvdb.FloatGrid()
grid.copyFromArray(np.load(sys.argv[1]))
low, step = [float(v) for v in sys.argv[3:6]], [float(v) for v in sys.argv[6:9]]
grid.transform = pyopenvdb.createLinearTransform([[step[0], 0, 0, 0], [0, step[1], 0, 0], [0, 0, step[2], 0], [*low, 1]])
grid.name = "density"
pyopenvdb.write(sys.argv[2], grids=[grid])
"""


def smoke_grid(folder):
    """The file's grid, interpolated linearly inside its capsule, as OpenVDB."""
    text = (SCENES / "smoke.pbrt").read_text()
    begin = text.index('"float density" [') + len('"float density" [')
    coarse = np.array(text[begin:text.index("]", begin)].split(), float).reshape(6, 4, 4)  # z, y, x
    low, size, n = np.array([-2.6, -1, 0]), np.array([2, 2, 2.4]), np.array([64, 64, 80])
    at = [(np.arange(n[i]) + 0.5) / n[i] for i in range(3)]

    def lerp(values, axis, t, count):
        s = np.clip(t * count - 0.5, 0, count - 1)
        i = np.minimum(s.astype(int), count - 2)
        f = (s - i).reshape([-1 if k == axis else 1 for k in range(3)])
        return np.take(values, i, axis) * (1 - f) + np.take(values, i + 1, axis) * f

    fine = lerp(lerp(lerp(coarse, 0, at[2], 6), 1, at[1], 4), 2, at[0], 4).transpose(2, 1, 0)
    x, y, z = np.meshgrid(*(low[i] + size[i] * at[i] for i in range(3)), indexing="ij")
    inside = (x + 1.6)**2 + y**2 + (z - np.clip(z, 0.95, 1.5))**2 < 0.81
    np.save(folder / "smoke.npy", (fine * inside).astype(np.float32))
    step = size / n
    subprocess.run([os.environ.get("OPENVDB_PYTHON", "/usr/bin/python3"), "-c", VDB, folder / "smoke.npy", folder / "smoke.vdb",
                    *map(str, low + step / 2), *map(str, step)], check=True)


def prepare(folder, program):
    for name in FILES.values():
        text = (SCENES / name).read_text()
        (folder / name).write_text(text.replace('"spectrum eta" "glass-BK7"', '"float eta" 1.5168'))  # Cycles' glass has no dispersion
    subprocess.run([program, "convert", "-q", folder / "neuron.swc", folder / "neuron.pbrt"], check=True)
    text = (folder / "neuron.pbrt").read_text()
    light = text[text.index("AttributeBegin"):text.index("AttributeEnd")]
    (folder / "sky.pbrt").write_text('Camera "spherical" "string mapping" "equirectangular"\nFilm "rgb" "integer xresolution" 1024 "integer yresolution" 512\n'
                                     'Sampler "sobol" "integer pixelsamples" 16\nWorldBegin\n' + light + "AttributeEnd\n")
    subprocess.run([program, "render", "-q", folder / "sky.pbrt", "-o", folder / "sky.exr"], check=True)
    picture = read(folder / "sky.exr")
    rows, columns = picture.shape[:2]
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    around, up = -(u - 0.5) * 2 * math.pi, (v - 0.5) * math.pi  # Blender's, from the lowest row
    x, y, z = np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)
    row = np.clip(np.arccos(np.clip(y, -1, 1)) / math.pi * rows, 0, rows - 1).astype(int)
    column = (np.arctan2(z, x) / (2 * math.pi) % 1 * columns).astype(int) % columns
    np.save(folder / "sky.npy", picture[row, column])
    smoke_grid(folder)


def read(file):
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return np.stack([channels[next(n for n in channels if n == c or n.endswith(".Combined." + c))].pixels for c in "RGB"], 2).astype(np.float32)


def cycles(folder, name, size, samples, seed, denoise):
    out = folder / f"cycles-{name}-{samples}-{seed}.exr"
    ran = subprocess.run([os.environ["CYCLES_PYTHON"], HERE / "cycles_scenes.py", name, folder, *map(str, size), out, str(samples), str(seed), str(int(denoise))],
                         capture_output=True, text=True)
    if ran.returncode or "seconds" not in ran.stdout:
        sys.exit(ran.stdout[-2000:] + ran.stderr[-4000:])
    return float(ran.stdout.rsplit("seconds", 1)[1].split()[0]), read(out)


def ours(folder, program, name, size, samples, seed, denoise):
    out = folder / f"caplet-{name}-{samples}-{seed}.exr"
    seconds = []
    for count in (1, samples):
        subprocess.run([program, "render", "-q", folder / FILES[name], "--size", "x".join(map(str, size)), "--spp", str(count), "--seed", str(seed),
                        *(["--denoise"] if denoise and len(seconds) else []), "-o", out, "--stats", folder / "stats.json"], check=True)
        seconds.append(json.loads((folder / "stats.json").read_text())["seconds"]["total"])
    return seconds[1] - seconds[0], read(out)


def display(rgb):
    rgb = np.clip(rgb, 0, 1)
    return np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * np.maximum(rgb, 0.0031308)**(1 / 2.4) - 0.055).astype(np.float32)


def samples_for(render, seconds):
    """The samples that take so long, denoising and all: by two trials."""
    few, many = 4, 16
    while (spent := render(many)[0]) < seconds / 2 and many < 65536:
        few, many = many, many * 4
    base = render(few)[0]
    rate = (spent - base) / (many - few)
    return max(1, round(many + (seconds - spent) / rate))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seconds", default="1,4")
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("--height", type=int, default=180)
    parser.add_argument("--scenes", default=",".join(FILES))
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    program = os.environ.get("CAPLET", "caplet")
    given.folder.mkdir(parents=True, exist_ok=True)
    prepare(given.folder, program)
    for name in given.scenes.split(","):
        size = round(given.height * SHAPE[name]), given.height
        ways = {"caplet": lambda n, s, d: ours(given.folder, program, name, size, n, s, d), "cycles": lambda n, s, d: cycles(given.folder, name, size, n, s, d)}
        truths = {}
        for way, render in ways.items():
            kept = given.folder / f"reference-{way}-{name}-{given.height}-{given.reference}.npy"
            if not kept.exists():
                np.save(kept, render(given.reference, 1000, False)[1])
            truths[way] = display(np.load(kept))
        for seconds in map(float, filter(None, given.seconds.split(","))):
            counts = {way: samples_for(lambda n: render(n, 7, True), seconds) for way, render in ways.items()}
            found = {way: [] for way in ways}
            for seed in range(given.rounds):
                for way, render in ways.items():
                    took, rgb = render(counts[way], seed, True)
                    made = display(rgb)
                    np.save(given.folder / f"{way}-{name}-{seconds:g}.npy", made)
                    error = evaluate(truths[way], made, "LDR")[1]
                    found[way].append((took, float(error), -10 * math.log10(np.mean((made - truths[way])**2))))
            for way in ways:
                took, flip, psnr = (statistics.median(column) for column in zip(*found[way]))
                print(json.dumps({"scene": name, "renderer": way, "asked": seconds, "samples": counts[way], "seconds": round(took, 2), "flip": round(flip, 4),
                                  "psnr": round(psnr, 2)}), flush=True)


main()
