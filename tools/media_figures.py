#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Renders the figures of docs/media.md: one scene for all media, docs/images/media/NAME.png.

usage: tools/media_figures.py [--caplet PROGRAM] [--spp N] [NAME ...]      without names: all"""
import math
import struct

from figure_frame import framed, run

PLACE = "AttributeBegin\nTranslate -1.2 -1 0.02 Scale 2.4 2 2\n"


def cells(n, value):
    return " ".join("%.4g" % max(0.0, value((i % n + 0.5) / n, (i // n % n + 0.5) / n, (i // (n * n) + 0.5) / n)) for i in range(n ** 3))


def blob(x, y, z):
    r = math.dist((x, y, z), (0.5, 0.5, 0.5))
    return max(0.0, 0.5 - r) * (6 + 6 * math.sin(17 * x) * math.sin(13 * y + 1) * math.sin(15 * z + 2))


def colors(n, value):
    return " ".join("%.3g %.3g %.3g" % value((i % n + 0.5) / n, (i // n % n + 0.5) / n, (i // (n * n) + 0.5) / n) for i in range(n ** 3))


def nanovdb(density, side):
    """A NanoVDB file's bytes: density(x, y, z) at voxels of the unit cube, side of them (a multiple of 8, up to 128) along each side."""
    leaves = [(x, y, z) for x in range(side // 8) for y in range(side // 8) for z in range(side // 8)]
    root, upper = 736, 736 + 64 + 32
    lower = upper + 8256 + 262144
    first = lower + 1088 + 32768
    memory = bytearray(first + 2144 * len(leaves))

    def put(at, kind, *values):
        struct.pack_into("<" + kind, memory, at, *values)
    put(0, "Q", 0x304244566F6E614E)
    for k in range(3):
        put(296 + 88 + 32 * k, "d", 1 / side)
    put(296 + 264, "6d", 0, 0, 0, 1, 1, 1)
    put(636, "I", 1)
    put(672 + 24, "Q", root - 672)
    put(root + 24, "I", 1)
    put(root + 64, "Qq", 0, upper - root)
    put(upper + 32 + 4096, "B", 1)
    put(upper + 8256, "q", lower - upper)
    for n, (x, y, z) in enumerate(leaves):
        index, at = x << 8 | y << 4 | z, first + 2144 * n
        memory[lower + 32 + 512 + index // 8] |= 1 << index % 8
        put(lower + 1088 + 8 * index, "q", at - lower)
        for i in range(512):
            put(at + 96 + 4 * i, "f", density(*((8 * a + b + 0.5) / side for a, b in zip((x, y, z), (i >> 6, i >> 3 & 7, i & 7)))))
    head = struct.pack("<QIHH", 0x304244566F6E614E, 32 << 21, 1, 0)
    told = bytearray(176)
    struct.pack_into("<QQ", told, 0, len(memory), len(memory))
    struct.pack_into("<I", told, 32, 1)
    struct.pack_into("<I", told, 136, 8)
    return head + bytes(told) + b"density\0" + bytes(memory)


BALL = """AttributeBegin
  %s
  Translate -0.9 0 1
  Shape "sphere" "float radius" 1
AttributeEnd
AttributeBegin
  %s
  Shape "capsule" "point3 p0" [0.8 -0.6 0.4] "point3 p1" [1.7 0.2 1.4] "float radius" [0.4 0.25]
AttributeEnd
"""
BOX = """AttributeBegin
  Material "interface"
  MediumInterface "m" ""
  Shape "box" "point3 p0" [-1.2 -1 0.02] "point3 p1" [1.2 1 2.02]
AttributeEnd
"""

MEDIA = {
    "homogeneous": 'MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [0.3 0.1 0.02] "rgb sigma_s" [1 1.6 2.6] "float g" 0.4\n'
                   'MakeNamedMedium "n" "string type" "homogeneous" "string preset" "Lemon Tea Powder" "float scale" 0.5\n' +
                   BALL % ('Material "interface" MediumInterface "m" ""', 'Material "dielectric" "float eta" 1.4 MediumInterface "n" ""'),
    "uniformgrid": PLACE + 'MakeNamedMedium "m" "string type" "uniformgrid" "integer nx" 24 "integer ny" 24 "integer nz" 24 "float density" [' + cells(24, blob) +
                   '] "rgb sigma_a" [0.5 0.5 0.5] "rgb sigma_s" [7 7 7] "float g" 0.3\nAttributeEnd\n' + BOX,
    "rgbgrid": PLACE + 'MakeNamedMedium "m" "string type" "rgbgrid" "integer nx" 16 "integer ny" 16 "integer nz" 16 "rgb sigma_a" [' +
               colors(16, lambda x, y, z: (0.6 * blob(x, y, z) * (1 - x), 0.6 * blob(x, y, z) * x, 0.6 * blob(x, y, z) * z)) + '] "rgb sigma_s" [' +
               colors(16, lambda x, y, z: (5 * blob(x, y, z) * x, 5 * blob(x, y, z) * (1 - x), 4 * blob(x, y, z))) + ']\nAttributeEnd\n' + BOX,
    "cloud": 'AttributeBegin\nTranslate -1.2 -1 0.02 Rotate 90 1 0 0 Scale 2.4 2 -2\nMakeNamedMedium "m" "string type" "cloud" "point3 p0" [0 0.5 0] "point3 p1" [1 1 1] "float density" 2 '
             '"rgb sigma_a" [0.1 0.1 0.1] "rgb sigma_s" [12 12 12] "float g" 0.5\nAttributeEnd\n' + BOX.replace("0.02", "1.03").replace("2.02", "2.02"),
    "nanovdb": PLACE + 'MakeNamedMedium "m" "string type" "nanovdb" "string filename" "m.nvdb" "rgb sigma_a" [0.5 0.5 0.5] "rgb sigma_s" [5 6 8] "float g" 0.2\n'
               'AttributeEnd\n' + BOX,
    "subsurface": BALL % ('Material "subsurface" "rgb reflectance" [0.8 0.5 0.35] "rgb mfp" [0.25 0.12 0.06]',
                          'Material "subsurface" "string name" "Skin1" "float scale" 8'),
}


def scene(name):
    return framed('"volpath" "integer maxdepth" 100', MEDIA[name] + "\n")


def files(name, folder):
    if name == "nanovdb":
        (folder / "m.nvdb").write_bytes(nanovdb(blob, 48))


if __name__ == "__main__":
    run("media", MEDIA, scene, files)
