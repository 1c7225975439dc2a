#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Whether the variance that pictures state is the one they have: a section of docs/validation.md.

usage: PYTHON tools/error_coverage.py [--seeds N] [--samples N | --noise X] [--data DATA] [SCENE ...]

PYTHON has numpy and caplet (PYTHONPATH=build/release/python). Each scene is rendered at most 128 pixels wide with N seeds. With scenes,
or to a noise, the section is printed, not written; to a noise a column says what the pictures' true noise is over the one asked for."""
import argparse
import pathlib
import textwrap

import caplet
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/validation.md"
TITLE = "Stated errors"
SCENES = ["capsules.pbrt", "gallery.pbrt", "materials.pbrt", "hair.pbrt", "smoke.pbrt", "instances.pbrt", "neuron.swc", "walker.xml", "lattice.3mf",
          "reference/capsule-light-room.pbrt"]
OF_DATA = ["reference/mitsuba/cornell.pbrt", "reference/pbrt/many-lights.pbrt"]


def pictures(path, samples, noise, seeds):
    """R G B and their stated variances, of each seed: two arrays of seeds x height x width x 3."""
    scene = caplet.load(str(path))
    if noise:
        scene.sampler("sobol")
    width, height = scene.size
    size = (min(128, width), max(1, round(min(128, width) * height / width)))
    means, variances = [], []
    for seed in range(seeds):
        image = caplet.render(scene, spp=None if noise else samples, noise=noise, size=size, seed=seed, progress=False)
        means.append(image.rgb.astype(np.float64))
        variances.append(image.variance.astype(np.float64))
    return np.array(means), np.array(variances)


def compared(means, variances):
    """Stated over true variance (of all pixels and channels, and the median pixel), and the share of the 95 % intervals with the true mean:
    that of the other seeds, whose own error widens the interval."""
    seeds = len(means)
    true = means.var(axis=0, ddof=1)
    noisy = true.mean(axis=-1) > 0
    others = (means.sum(axis=0) - means) / (seeds - 1)
    half = 1.96 * np.sqrt(variances + true / (seeds - 1))
    within = (np.abs(means - others) <= half)[:, noisy]
    stated = variances.mean(axis=0)
    typical = np.median(stated.mean(axis=-1)[noisy] / true.mean(axis=-1)[noisy])
    return stated.mean() / true.mean(), typical, within.mean()


def around(values):
    """The sum over the pixels at most 3 away."""
    sums = np.pad(values, 4).cumsum(0).cumsum(1)[:-1, :-1]
    return sums[7:, 7:] - sums[:-7, 7:] - sums[7:, :-7] + sums[:-7, :-7]


def true_noise(means):
    """The noise of pictures (host/film/noise.h) whose true mean and variance are those of the seeds."""
    g = means[..., 1]
    mean, variance = g.mean(axis=0), g.var(axis=0, ddof=1)
    seen = (variance > 0).astype(float)
    luminance = around(mean * seen) / np.maximum(around(seen), 1) + 0.25 * (mean * seen).sum() / seen.sum()
    return np.sqrt((variance / luminance**2 * seen).sum() / seen.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--noise", type=float)
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    given = parser.parse_args()
    scenes = given.scenes or [ROOT / "scenes" / name for name in SCENES] + [given.data / name for name in OF_DATA]
    text = (f"`tools/error_coverage.py` renders scenes, at most 128 pixels wide, with {given.seeds} seeds of {given.samples} samples a pixel. "
            "\"Stated / true\" is the mean of the layer `variance` over the variance of the seeds: of the whole picture, and of the median pixel, "
            "which states more than it has where it shares the estimates of noisier ones. \"Hold\" is the share of the pixels' 95 % intervals "
            "(1.96 roots of `variance`) that hold the mean of all other seeds.")
    lines = [
        *textwrap.wrap(text, 100), "",
        "| scene | stated / true, mean | median pixel | hold |", "|---|---:|---:|---:|"]
    for scene in scenes:
        means, variances = pictures(scene, given.samples, given.noise, given.seeds)
        mean, typical, within = compared(means, variances)
        lines.append(f"| {scene.stem} | {mean:.2f} | {typical:.2f} | {100 * within:.1f} % |")
        if given.noise:
            lines[-1] += f" {true_noise(means) / given.noise:.2f} |"
        print(lines[-1], flush=True)
    text = "\n".join(lines) + "\n"
    if given.scenes or given.noise:
        return
    page = PAGE.read_text()
    before, _, rest = page.partition(f"## {TITLE}\n")
    after = rest.partition("\n## ")[2]
    PAGE.write_text(f"{before.rstrip()}\n\n## {TITLE}\n\n{text}" + (f"\n## {after}" if after else ""))


if __name__ == "__main__":
    main()
