#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""f |cos| of Mitsuba 3's `principled`, and of its `roughdielectric` for our coat: principled.json, for principled_test.cpp, which sees them in pictures.

usage: PYTHON tests/render/mitsuba/principled.py

PYTHON has mitsuba and numpy; principled.json says of which version its numbers are. Directions are (dp/du, dp/dv, normal); wo is toward who looks, which Mitsuba calls wi. They are
near the normal and the lobes narrow, so that ways to mask facets which differ by the product of both directions' hidden parts agree to 3e-4."""
import json
import pathlib

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
FOLDER = pathlib.Path(__file__).resolve().parent
RNG = np.random.default_rng(11)


def direction(low, high, down=False):
    theta, phi = np.radians(RNG.uniform(low, high)), RNG.uniform(0, 2 * np.pi)
    return np.round([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), -np.cos(theta) if down else np.cos(theta)], 4)


def unit(v):
    return v / np.linalg.norm(v)


def value(bsdf, wo, wi):
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(*unit(wo))
    return mi.load_dict(bsdf).eval(mi.BSDFContext(), si, mi.Vector3f(*unit(wi)))[0]


def row(name, text, bsdf, wo, wi, scale=1.0):
    return {"name": name, "parameters": text, "wo": wo.tolist(), "wi": wi.tolist(), "value": float(f"{scale * value(bsdf, wo, wi):.6g}")}


def principled(base, **of):
    """Our text and Mitsuba's dictionary of the same parameters."""
    text = f'"rgb base_color" [{base} {base} {base}] ' + " ".join(f'"float {k}" {v}' for k, v in of.items())
    return text, {"type": "principled", "base_color": {"type": "rgb", "value": base}, **of}


def rows():
    kinds = {
        "plastic": principled(0.6, roughness=0.4, eta=1.5),
        "index": principled(0.3, roughness=0.35, eta=1.9),
        "metal": principled(0.7, roughness=0.4, metallic=1.0, eta=1.5),
        "brushed": principled(0.7, roughness=0.4, anisotropic=0.8, metallic=1.0, eta=1.5),
        "brushed a little": principled(0.5, roughness=0.4, anisotropic=0.25, metallic=1.0, eta=1.5),
        "brushed plastic": principled(0.2, roughness=0.4, anisotropic=0.6, eta=1.6),
        "half metal": principled(0.5, roughness=0.4, metallic=0.4, eta=1.5),
        "tint": principled(0.4, roughness=0.4, spec_tint=0.6, eta=1.5),
        "sheen": principled(0.2, roughness=0.5, sheen=1.0, eta=1.4),
        "half sheen": principled(0.2, roughness=0.5, sheen=0.5, eta=1.4),
        "glass": principled(0.9, roughness=0.4, spec_trans=1.0, eta=1.5),
        "half glass": principled(0.5, roughness=0.4, spec_trans=0.5, eta=1.5, metallic=0.2),
    }
    for name, (text, bsdf) in kinds.items():
        for _ in range(4):
            wo = direction(5, 40)
            # Mirrored about a normal that facets have, or anywhere where the sheen is seen.
            wi = direction(55, 75) if "sheen" in name else unit(2 * np.dot(unit(wo), m := unit(direction(0, 12))) * m - unit(wo))
            yield row(name, text, bsdf, wo, np.round(wi, 4))
        if "glass" in name:
            for _ in range(3):
                wo = direction(5, 40)
                yield row(f"through {name}", text, bsdf, wo, np.round(unit(-wo + np.array([0.1, -0.15, 0]) * RNG.uniform(-1, 1)), 4))
    # A base that reflects nothing, below an interface that reflects nothing.
    for coat, roughness, eta in ((1.0, 0.3, 1.5), (0.6, 0.4, 1.5), (1.0, 0.4, 1.9), (0.25, 0.2, 2.5)):
        text = f'"rgb base_color" [0 0 0] "float eta" 1.001 "float coat" {coat} "float coat_roughness" {roughness} "float coat_eta" {eta}'
        bsdf = {"type": "roughdielectric", "distribution": "ggx", "alpha": roughness**2, "int_ior": eta, "ext_ior": 1.0}
        for _ in range(3):
            wo = direction(5, 45)
            m = unit(direction(0, 6))
            yield row("coat", text, bsdf, wo, np.round(2 * np.dot(unit(wo), m) * m - unit(wo), 4), coat)


def main():
    lines = ",\n    ".join(json.dumps(one) for one in rows())
    (FOLDER / "principled.json").write_text(f'{{\n  "mitsuba": "{mi.__version__}",\n  "rows": [\n    {lines}\n  ]\n}}\n')


if __name__ == "__main__":
    main()
