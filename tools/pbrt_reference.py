#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Scenes in pbrt's text beside pbrt-v4's own pictures of them: a section of docs/validation.md.

usage: PYTHON tools/pbrt_reference.py DATA [--samples N] [--caplet PROGRAM] [NAME ...]

PYTHON has numpy and OpenEXR. DATA: the folder with reference/pbrt. Of each scene there is NAME.pbrt and NAME.exr with the mean and, as
variance.R/G/B, the variance of that mean. Without --samples as many a pixel as SAMPLES says; with names the section is printed, not written."""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import OpenEXR

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/validation.md"
TITLE = "Scenes beside pbrt-v4"
# Beside those of the pictures (1,024 to 3,072), so that our noise is no larger than theirs.
SAMPLES = {"coated": 2048, "sheets": 2048, "textures": 1024, "alpha-normal": 1024, "media": 3072, "grid": 1024, "gobos": 3072, "many-lights": 2048, "glossy": 1024}
# What their pictures are too noisy for: 1 % elsewhere.
BLOCKS = {"gobos": 0.025, "many-lights": 0.025}
SPECTRAL = {"textures"}


def layers_of(file):
    """R G B and their variances, height x width x 3, float64; the variance is None where the file has none."""
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    take = lambda names: np.stack([channels[n].pixels.astype(np.float64) for n in names], axis=-1)
    variance = [f"variance.{c}" for c in "RGB"]
    return take("RGB"), take(variance) if variance[0] in channels else None


def blocks(image, n=8):
    h, w = image.shape[0] // n, image.shape[1] // n
    return image[:h * n, :w * n].reshape(h, n, w, n, 3).mean(axis=(1, 3))


def compared(ours, theirs):
    """Relative difference of the means, rms of blocks (over their grey, or a fiftieth of the mean where that is more), and of z of green: mean, deviation, part beyond 3."""
    (a, va), (b, vb) = ours, theirs
    of = np.maximum(blocks(b).mean(axis=-1, keepdims=True), 0.02 * b.mean())
    rms = np.sqrt(np.mean(((blocks(a) - blocks(b)) / of) ** 2))
    both = (va + vb)[..., 1]
    z = ((a - b)[..., 1][both > 0]) / np.sqrt(both[both > 0])
    return a.mean() / b.mean() - 1, rms, z.mean(), z.std(), np.mean(np.abs(z) > 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--samples", type=int)
    parser.add_argument("--caplet", default=str(ROOT / "build/release/bin/caplet"))
    given = parser.parse_args()
    rows, all_within = [], True
    for name, samples in SAMPLES.items():
        if given.names and name not in given.names:
            continue
        samples = given.samples or samples
        scene = given.data / "reference/pbrt" / f"{name}.pbrt"
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "ours.exr"
            start = time.monotonic()
            subprocess.run([given.caplet, "render", scene, "-o", out, "--spp", str(samples), "--layers", "variance", "--quiet"], check=True)
            seconds = time.monotonic() - start
            ours = layers_of(out)
        theirs = layers_of(scene.with_suffix(".exr"))
        mean, rms, z_mean, z_sd, beyond = compared(ours, theirs)
        noise = ours[1].mean() / theirs[1].mean()
        within = abs(mean) < 0.005 and rms < BLOCKS.get(name, 0.01) and abs(z_mean) < 0.3 and beyond < 0.03
        all_within &= bool(within)
        rows.append(f"| {name} | {samples} | {100 * mean:+.2f} % | {100 * rms:.2f} % | {z_mean:+.2f} | {z_sd:.2f} | {100 * beyond:.1f} % | {noise:.2f} | {seconds:.0f} | {'yes' if within else 'no'} |")
        print(rows[-1], flush=True)
    section = "\n".join([
        f"\n## {TITLE}\n",
        "`tools/pbrt_reference.py` renders scenes of 128 x 128 pixels beside pictures that pbrt-v4",
        "(`volpath`) made of the same text with 1,024 to 3,072 samples a pixel, and their variances. A scene",
        'is "within" when the image mean differs by less than 0.5 %, the means of 8 x 8 blocks by less than 1',
        "% (rms; gobos and many-lights, whose references are noisy, 2.5 %), the mean of z is within 0.3 and",
        "less than 3 % of the pixels are beyond 3. Other seeds of pbrt-v4 against each other give z means of",
        '-0.16 to -0.04 and 0.9 to 2.7 % beyond 3. "Variance" is the mean of Caplet\'s over the mean of',
        "pbrt-v4's, both as stated.\n",
        "| scene | samples | image mean | blocks rms | z mean | z sd | beyond 3 | variance | seconds | within |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---|",
        *rows, ""])
    if not given.names:
        page = PAGE.read_text().rstrip("\n")
        before, _, rest = page.partition(f"\n## {TITLE}\n")
        after = "\n## " + rest.partition("\n## ")[2] if "\n## " in rest else ""
        PAGE.write_text((before.rstrip("\n") + "\n" + section.rstrip("\n") + "\n" + after).rstrip("\n") + "\n")
    return 0 if all_within else 1


if __name__ == "__main__":
    sys.exit(main())
