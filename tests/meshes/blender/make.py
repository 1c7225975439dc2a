#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What Blender's importer of glTF makes of looks.gltf: looks.json, which blender_test.cpp compares with ours.

usage: PYTHON tests/meshes/blender/make.py

PYTHON has bpy, which is Blender as a module of the package index; looks.json says of which version its numbers are. Powers of lamps are in watts: a point or
spot of I watts per steradian has 4 pi I, and a sun's energy is its irradiance. Matrices are of Blender's world, whose z is up: (x, y, z) there is (x, -z, y)
of the file's. Lamps and cameras look along -z of their own."""
import json
import pathlib

import bpy

FOLDER = pathlib.Path(__file__).resolve().parent


def rounded(value):
    """As many digits as the floats of Blender have."""
    if isinstance(value, (int, float)):
        return float(f"{value:.7g}")
    return [rounded(one) for one in value]


def material(of):
    node = next(n for n in of.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    names = ["Base Color", "Metallic", "Roughness", "IOR", "Alpha", "Anisotropic", "Transmission Weight", "Coat Weight", "Coat Roughness", "Sheen Weight",
             "Sheen Tint", "Emission Color", "Emission Strength"]
    return {name: rounded(node.inputs[name].default_value) for name in names}


def lamp(of):
    out = {"type": of.data.type, "energy": rounded(of.data.energy), "color": rounded(of.data.color), "matrix": rounded(of.matrix_world)}
    if of.data.type == "SPOT":
        out |= {"spot_size": rounded(of.data.spot_size), "spot_blend": rounded(of.data.spot_blend)}
    return out


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(FOLDER / "looks.gltf"))
    objects = bpy.data.objects
    out = {
        "materials": {m.name: material(m) for m in bpy.data.materials},
        "lamps": {o.name: lamp(o) for o in objects if o.type == "LIGHT"},
        "cameras": {o.name: {"angle_y": rounded(o.data.angle_y), "matrix": rounded(o.matrix_world)} for o in objects if o.type == "CAMERA"},
    }
    rows = [f'  "{kind}": {{\n' + ",\n".join(f'    "{name}": {json.dumps(of)}' for name, of in sorted(out[kind].items())) + "\n  }"
            for kind in ("materials", "lamps", "cameras")]
    (FOLDER / "looks.json").write_text(f'{{\n  "blender": "{bpy.app.version_string}",\n' + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    main()
