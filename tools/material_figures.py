#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Renders the figures of docs/materials.md: one scene for all materials, docs/images/materials/NAME.png.

usage: tools/material_figures.py [--caplet PROGRAM] [--spp N] [NAME ...]      without names: all"""
from figure_frame import framed, run

MATERIALS = {
    "diffuse": 'Material "diffuse" "rgb reflectance" [0.7 0.25 0.15]',
    "conductor": 'Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.05',
    "dielectric": 'Material "dielectric" "spectrum eta" "glass-BK7"',
    "thindielectric": 'Material "thindielectric" "float eta" 1.5',
    "diffusetransmission": 'Material "diffusetransmission" "rgb reflectance" [0.15 0.3 0.1] "rgb transmittance" [0.3 0.45 0.1]',
    "coateddiffuse": 'Material "coateddiffuse" "rgb reflectance" [0.65 0.08 0.05] "float roughness" 0.02',
    "coatedconductor": 'Material "coatedconductor" "spectrum conductor.eta" "metal-Cu-eta" "spectrum conductor.k" "metal-Cu-k" '
                       '"float conductor.roughness" 0.2 "float interface.roughness" 0.01',
    "mix": 'MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [0.1 0.2 0.5]\n'
           'MakeNamedMaterial "b" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.02\n'
           'Texture "squares" "float" "checkerboard" "float uscale" 12 "float vscale" 6 "float tex1" 0.9 "float tex2" 0.1\n'
           'Material "mix" "string materials" ["a" "b"] "texture amount" "squares"',
    "interface": 'MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.05 0.1 0.3] "rgb sigma_s" [2 2 2]\n'
                 'MediumInterface "fog" ""\nMaterial "interface"',
    "hair": 'Material "hair" "float eumelanin" 0.8 "float pheomelanin" 0.5',
    "principled": 'Texture "stripes" "float" "checkerboard" "float uscale" 1 "float vscale" 8 "float tex1" 1 "float tex2" 0\n'
                  'Material "principled" "rgb base_color" [0.75 0.3 0.1] "texture metallic" "stripes" "float roughness" 0.35 '
                  '"float anisotropic" 0.6 "float sheen" 0.5 "float coat" 1 "float coat_roughness" 0.05',
}

BALL = """AttributeBegin
  Translate -0.75 0 1
  Shape "sphere" "float radius" 1
AttributeEnd
Shape "capsule" "point3 p0" [0.9 -0.5 0.35] "point3 p1" [1.7 0.3 1.3] "float radius" [0.35 0.2]
"""
SHEET = """Shape "bilinearmesh" "point3 P" [-1.8 -0.2 0  0.2 -0.6 0  -1.8 -0.2 2  0.2 -0.6 2] "integer indices" [0 1 2 3]
Shape "capsule" "point3 p0" [0.9 -0.5 0.35] "point3 p1" [1.7 0.3 1.3] "float radius" [0.35 0.2] "bool onesided" true
AttributeBegin
  Material "diffuse" "rgb reflectance" [0.15 0.2 0.6]
  Translate -0.7 0.9 0.6
  Shape "sphere" "float radius" 0.6
AttributeEnd
"""


def fibres():
    """A lock of wavy fibres, each a chain of capsules."""
    import math
    out = []
    for i in range(260):
        a, r = i * 2.399963, 0.85 * math.sqrt((i + 0.5) / 260)
        points = []
        for k in range(25):
            s = k / 24
            x = -2.3 + 4.6 * s + 0.06 * math.sin(7 * s + a)
            z = 1 + r * math.sin(a) * (0.75 + 0.35 * s) + 0.2 * math.sin(4 * s) + 0.05 * math.sin(11 * s + 2 * a)
            points.append((x, r * math.cos(a) * (0.75 + 0.35 * s), z))
        for p, q in zip(points, points[1:]):
            out.append('Shape "capsule" "point3 p0" [%.4f %.4f %.4f] "point3 p1" [%.4f %.4f %.4f] "float radius" 0.012' % (p + q))
    return "\n".join(out) + "\n"


def scene(name):
    shapes = fibres() if name == "hair" else SHEET if name in ("thindielectric", "diffusetransmission") else BALL
    return framed('"path" "integer maxdepth" 24', MATERIALS[name] + "\n" + shapes)


if __name__ == "__main__":
    run("materials", MATERIALS, scene)
