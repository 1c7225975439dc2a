#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes a scene of random-walk capsules placed many times: FOLDER/walk.capsules and FOLDER/instances.pbrt.

usage: instanced_walk.py FOLDER [CAPSULES] [SIDE]   (10000 capsules, SIDE^2 = 40 x 40 instances by default)
"""
import math
import random
import sys


def main():
    folder, count, side = sys.argv[1], int((sys.argv + ["10000"])[2]), 40
    if len(sys.argv) > 3:
        side = int(sys.argv[3])
    rng = random.Random(1)
    with open(f"{folder}/walk.capsules", "w") as out:
        for walk in range(max(1, count // 100)):
            p = [rng.uniform(-0.45, 0.45) for _ in range(3)]
            for _ in range(min(100, count)):
                z, phi = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
                s = math.sqrt(1 - z * z)
                q = [max(-0.5, min(0.5, a + 0.03 * d)) for a, d in zip(p, (s * math.cos(phi), s * math.sin(phi), z))]
                out.write("<{:.6f}, {:.6f}, {:.6f}> <{:.6f}, {:.6f}, {:.6f}> 0.003\n".format(*p, *q))
                p = q
    with open(f"{folder}/instances.pbrt", "w") as out:
        out.write(f"LookAt 0 {-0.9 * side} {0.8 * side}  0 0 0  0 0 1\n")
        out.write('Camera "perspective" "float fov" 50\nFilm "rgb" "integer xresolution" 640 "integer yresolution" 360\n')
        out.write('Sampler "zsobol" "integer pixelsamples" 16\nIntegrator "path" "integer maxdepth" 5\nWorldBegin\n')
        out.write('LightSource "infinite" "rgb L" [1 1 1]\nMaterial "diffuse" "rgb reflectance" [0.7 0.4 0.2]\n')
        out.write('ObjectBegin "walk"\nShape "capsules" "string filename" "walk.capsules"\nObjectEnd\n')
        for i in range(side):
            for j in range(side):
                x, y = (i - 0.5 * side) * 1.1, (j - 0.5 * side) * 1.1
                out.write(f"AttributeBegin Translate {x:.4f} {y:.4f} 0 Rotate {rng.uniform(0, 360):.3f} 0 0 1 ")
                out.write('ObjectInstance "walk" AttributeEnd\n')


main()
