#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes kernels/bsdf/multiscatter_tables.cl: what one scattering at GGX facets loses, by integration over their visible normals.

usage: PYTHON tools/energy_tables.py

PYTHON has numpy. Takes a minute. The facets are those of Heitz 2014 with height-correlated masking, of the same roughness alpha along u and v.
- Metals that reflect all: rows of sqrt(alpha) from 0 to 1, in each the loss at x = sqrt(c (1 + alpha) / (c + alpha)) from 0 to 1, c the cosine.
- Interfaces of the relative index eta, of what is reflected and refracted together: planes of t from -1 to 1 where
  (eta - 1) / (eta + 1) = sign(t) t^2 / 2, of the same rows.
- The means of each row over a hemisphere, weighted by the cosine."""
import pathlib
import textwrap

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
COSINES, METAL_ROUGHNESSES, ROUGHNESSES, INDICES = 16, 16, 8, 17
SIDE = 200  # of the square of random numbers, whose midpoints are taken


def visible_normals(cosine, alpha):
    """Normals seen from a direction in the xz plane (Dupuy and Benyoub 2023), n x n x 3, and the direction."""
    wo = np.array([np.sqrt(1 - cosine * cosine), 0, cosine])
    u1, u2 = np.meshgrid((np.arange(SIDE) + 0.5) / SIDE, (np.arange(SIDE) + 0.5) / SIDE, indexing="ij")
    w = wo * [alpha, alpha, 1]
    w /= np.linalg.norm(w)
    height = (1 - u2) * (1 + w[2])
    sine = np.sqrt(np.clip(1 - (height - w[2]) ** 2, 0, 1))
    m = np.stack([alpha * (sine * np.cos(2 * np.pi * u1) + w[0]), alpha * sine * np.sin(2 * np.pi * u1), height], -1)
    return m / np.linalg.norm(m, axis=-1, keepdims=True), wo


def smith(w, alpha):
    """Lambda, of directions on either side."""
    return 0.5 * (np.sqrt(1 + alpha * alpha * (w[..., 0] ** 2 + w[..., 1] ** 2) / w[..., 2] ** 2) - 1)


def fresnel(cosine, eta):
    sine2 = (1 - cosine * cosine) / eta**2
    beyond = np.sqrt(np.maximum(0, 1 - sine2))
    parallel = (eta * cosine - beyond) / (eta * cosine + beyond)
    across = (cosine - eta * beyond) / (cosine + eta * beyond)
    return np.where(sine2 >= 1, 1, 0.5 * (parallel**2 + across**2)), beyond


def kept(wo, wi, is_there, alpha):
    """What masking leaves of each direction that is on the side where it belongs."""
    wi = np.where(is_there[..., None], wi, [0, 0, 1.0])
    o, i = smith(wo, alpha), smith(wi, alpha)
    return np.where(is_there, (1 + o) / (1 + o + i), 0)


def loss(cosine, alpha, eta=None):
    m, wo = visible_normals(min(max(cosine, 1e-4), 1.0), max(alpha, 1e-3))
    alpha = max(alpha, 1e-3)
    c = m @ wo
    mirrored = 2 * c[..., None] * m - wo
    reflected = kept(wo, mirrored, (mirrored[..., 2] > 1e-12) & (c > 0), alpha)
    if eta is None:
        return 1 - reflected.mean()
    share, beyond = fresnel(np.clip(c, 0, 1), eta)
    bent = (c / eta - beyond)[..., None] * m - wo / eta
    refracted = kept(wo, bent, (bent[..., 2] < -1e-12) & (c > 0), alpha)
    return 1 - (share * reflected + (1 - share) * refracted).mean()


def rows(count, eta=None):
    """Losses, count x COSINES, and their means."""
    table, means = [], []
    fine = (np.arange(20000) + 0.5) / 20000
    for alpha in np.linspace(0, 1, count) ** 2:
        a = max(alpha, 1e-3)
        x = np.linspace(0, 1, COSINES)
        row = np.array([loss(xx * xx * a / (1 + a - xx * xx), alpha, eta) for xx in x])
        row = np.round(np.maximum(row, 0), 4)
        table.append(row)
        means.append(np.mean(2 * fine * np.interp(np.sqrt(fine * (1 + a) / (fine + a)), x, row)))
    return np.array(table), np.array(means)


def array(name, values):
    text = ", ".join(f"{v:.4f}f" if v else "0.0f" for v in np.asarray(values).ravel())
    return f"__constant float {name}[{np.size(values)}] = {{\n{textwrap.fill(text, 116, initial_indent='    ', subsequent_indent='    ')}}};\n"


def main():
    metal, metal_means = rows(METAL_ROUGHNESSES)
    planes, plane_means = [], []
    for t in np.linspace(-1, 1, INDICES):
        s = np.sign(t) * t * t / 2
        table, means = rows(ROUGHNESSES, (1 + s) / (1 - s))
        planes.append(table)
        plane_means.append(means)
    (ROOT / "kernels/bsdf/multiscatter_tables.cl").write_text(
        "// SPDX-License-Identifier: Apache-2.0\n// Copyright Caplet authors\n//\n"
        "// These tables say what one scattering at GGX facets loses, and the means over a hemisphere.\n// tools/energy_tables.py wrote them, and says of what.\n"
        "#ifndef CAPLET_BSDF_MULTISCATTER_TABLES_CL\n#define CAPLET_BSDF_MULTISCATTER_TABLES_CL\n\n"
        f"#define LOSS_COSINES {COSINES}\n#define METAL_LOSS_ROUGHNESSES {METAL_ROUGHNESSES}\n"
        f"#define INTERFACE_LOSS_ROUGHNESSES {ROUGHNESSES}\n#define INTERFACE_LOSS_INDICES {INDICES}\n\n"
        + array("metal_losses", metal) + array("metal_mean_losses", metal_means)
        + array("interface_losses", planes) + array("interface_mean_losses", plane_means) + "\n#endif\n")


if __name__ == "__main__":
    main()
