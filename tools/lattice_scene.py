#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes scenes/lattice.3mf: body-centred cells whose beams are thinner towards the top, balls at their middles, a plate below and above.

usage: lattice_scene.py [FILE]
"""
import pathlib
import sys
import zipfile

CELL, CELLS = 10.0, (8, 4, 4)  # millimetres
RELATIONS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/lattice.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""
TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""


def radius(z):
    return 1.2 - 0.7 * z / (CELL * CELLS[2])


def lattice():
    numbers, vertices, beams, balls = {}, [], [], []

    def vertex(*p):
        if p not in numbers:
            numbers[p] = len(vertices)
            vertices.append(p)
        return numbers[p]

    for i in range(CELLS[0]):
        for j in range(CELLS[1]):
            for k in range(CELLS[2]):
                middle = tuple(CELL * (n + 0.5) for n in (i, j, k))
                balls.append((vertex(*middle), 2.2 * radius(middle[2])))
                for corner in range(8):
                    end = tuple(CELL * (n + (corner >> axis & 1)) for axis, n in enumerate((i, j, k)))
                    beams.append((vertex(*middle), vertex(*end), radius(middle[2]), radius(end[2])))
    text = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>\n' for x, y, z in vertices)
    rods = "".join(f'<b:beam v1="{a}" v2="{c}" r1="{r:.4g}" r2="{s:.4g}"/>\n' for a, c, r, s in beams)
    spheres = "".join(f'<bb:ball vindex="{at}" r="{r:.4g}" p="1"/>\n' for at, r in balls)
    return (f"<vertices>\n{text}</vertices>\n"
            '<b:beamlattice minlength="0.001" radius="1" cap="sphere" pid="1" pindex="0" ballmode="mixed" ballradius="1">\n'
            f"<b:beams>\n{rods}</b:beams>\n<bb:balls>\n{spheres}</bb:balls>\n</b:beamlattice>\n")


def plate():
    wide, deep = CELL * CELLS[0], CELL * CELLS[1]
    corners = [(x, y, z) for z in (-2, 0) for y in (-3, deep + 3) for x in (-3, wide + 3)]
    faces = ((0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5))
    text = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>\n' for x, y, z in corners)
    return f"<vertices>\n{text}</vertices>\n<triangles>\n" + "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>\n' for a, b, c in faces) + "</triangles>\n"


def model():
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
  xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"
  xmlns:bb="http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07" requiredextensions="b bb">
<resources>
<basematerials id="1"><base name="beams" displaycolor="#9FB3C4"/><base name="balls" displaycolor="#E08A3C"/>
<base name="plates" displaycolor="#5A6470"/></basematerials>
<object id="2" name="lattice"><mesh>
{lattice()}</mesh></object>
<object id="3" name="plate" pid="1" pindex="2"><mesh>
{plate()}</mesh></object>
</resources>
<build><item objectid="2"/><item objectid="3"/><item objectid="3" transform="1 0 0 0 1 0 0 0 1 0 0 {CELL * CELLS[2] + 2:g}"/></build>
</model>
"""


def main(path):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        for name, text in (("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS), ("3D/lattice.model", model())):
            package.writestr(zipfile.ZipInfo(name), text, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1] / "scenes/lattice.3mf")
