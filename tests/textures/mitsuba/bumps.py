#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The normals that Mitsuba 3 bends on a parallelogram by an image of heights and by an image of normals: bumps.json, for bump_test.cpp.

usage: PYTHON tests/textures/mitsuba/bumps.py

PYTHON has mitsuba and numpy; bumps.json says of which version its numbers are. A diffuse surface of reflectance 1 returns the cosine between the bent normal and the light over
pi, and so near the unbent normal, where Mitsuba's shadowing of bumps takes no more than 1e-5: lights there give it. Rows of the images are from the top, where v is 1."""
import json
import pathlib

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
FOLDER = pathlib.Path(__file__).resolve().parent
ORIGIN, A, B = np.array([0.5, -0.25, 1.0]), np.array([2.0, 0.5, 0.25]), np.array([-0.75, 1.5, 0.5])
NORMALS = np.array([[0.1, -0.2, 1.0], [0.3, 0.1, 1.0], [-0.1, 0.15, 1.0], [-0.25, -0.05, 1.0]])
RNG = np.random.default_rng(3)
HEIGHTS = np.round(RNG.uniform(0, 0.5, (4, 4)), 3)  # powers of two, which others are made
MAP = np.round(np.concatenate([RNG.uniform(0.3, 0.7, (3, 4, 2)), RNG.uniform(0.8, 1, (3, 4, 1))], axis=-1), 3)
SPREAD = 0.03  # of the lights
FLAT = np.cross(A, B) / np.linalg.norm(np.cross(A, B))


def bitmap(values):
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(values).astype(np.float32)), "raw": True, "filter_type": "bilinear", "wrap_mode": "repeat"}


def mesh(bsdf, normals):
    props = mi.Properties()
    props["bsdf"] = mi.load_dict(bsdf)
    out = mi.Mesh("parallelogram", 4, 2, has_vertex_normals=normals is not None, has_vertex_texcoords=True, props=props)
    params = mi.traverse(out)
    params["vertex_positions"] = np.array([ORIGIN, ORIGIN + A, ORIGIN + A + B, ORIGIN + B]).ravel()
    params["vertex_texcoords"] = np.array([0, 0, 1, 0, 1, 1, 0, 1], float)
    params["faces"] = np.array([0, 1, 2, 0, 2, 3])
    if normals is not None:
        params["vertex_normals"] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).ravel()
    params.update()
    return mi.load_dict({"type": "scene", "mesh": out})


def bent(scene, u, v):
    p = ORIGIN + u * A + v * B
    si = scene.ray_intersect(mi.Ray3f(mi.Point3f(*(p + 2 * FLAT)), mi.Vector3f(*-FLAT)))
    cosine = lambda x, y: np.pi * si.bsdf().eval(mi.BSDFContext(), si, mi.Vector3f(*(np.array([x, y, 1]) / np.hypot(1, SPREAD))))[0]
    low, high = np.array([cosine(-SPREAD, 0), cosine(0, -SPREAD)]), np.array([cosine(SPREAD, 0), cosine(0, SPREAD)])
    local = np.hypot(1, SPREAD) * np.array([*((high - low) / (2 * SPREAD)), np.mean(high + low) / 2])
    assert abs(np.linalg.norm(local) - 1) < 3e-5, local
    return np.array(si.to_world(mi.Vector3f(*local))).ravel()


def rounded(x):
    return float(f"{x:.5f}")


def main():
    diffuse = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}
    # Its first row of texels is at v = 0.
    bumps = mesh({"type": "bumpmap", "arbitrary": bitmap(HEIGHTS[::-1, :, None]), "bsdf": diffuse}, None)
    maps = mesh({"type": "normalmap", "normalmap": bitmap(MAP[::-1]), "bsdf": diffuse}, NORMALS)
    places = np.round(np.random.default_rng(8).uniform(0.02, 0.98, (12, 2)), 3)
    rows = lambda scene: ",\n    ".join(json.dumps({"uv": [float(u), float(v)], "n": [rounded(x) for x in bent(scene, u, v)]}) for u, v in places)
    one = lambda of: json.dumps(of.tolist())
    (FOLDER / "bumps.json").write_text(f"""{{
  "mitsuba": "{mi.__version__}",
  "origin": {one(ORIGIN)}, "a": {one(A)}, "b": {one(B)},
  "normals": {one(NORMALS)},
  "heights": {one(HEIGHTS)},
  "map": {one(MAP)},
  "bumps": [
    {rows(bumps)}
  ],
  "normal maps": [
    {rows(maps)}
  ]
}}
""")


if __name__ == "__main__":
    main()
