#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Random walks on a Smith surface of GGX facets (Heitz, Hanika, d'Eon and Dachsbacher 2016), with nothing of Caplet's: how much of the light a
rough metal sends back at all orders, and of the first alone. Needs numpy."""

import numpy as np

rng = np.random.default_rng(3)


def fresnel(c, n, k):
    index = n + 1j * k
    t = np.sqrt(1 - (1 - c * c) / index**2)
    return 0.5 * (np.abs((c - index * t) / (c + index * t)) ** 2 + np.abs((index * c - t) / (index * c + t)) ** 2)


def smith(w, alpha):
    """Lambda of directions that go up or down."""
    a = w[:, 2] / (alpha * np.sqrt(np.maximum(1 - w[:, 2] ** 2, 1e-12)))
    return 0.5 * (-1 + np.sign(a) * np.sqrt(1 + 1 / (a * a)))


def visible(w, alpha):
    u1, u2 = rng.random(len(w)), rng.random(len(w))
    s = w * [alpha, alpha, 1]
    s /= np.linalg.norm(s, axis=1, keepdims=True)
    height = (1 - u2) * (1 + s[:, 2])
    sine = np.sqrt(np.clip(1 - (height - s[:, 2]) ** 2, 0, 1))
    m = np.stack([alpha * (sine * np.cos(2 * np.pi * u1) + s[:, 0]), alpha * (sine * np.sin(2 * np.pi * u1) + s[:, 1]), height], 1)
    return m / np.linalg.norm(m, axis=1, keepdims=True)


def reflected(cosine, alpha, n, k, count=400000):
    """Of all orders, and of the first. Heights are evenly distributed from -1 to 1: half of 1 + h lie below h."""
    w = np.tile([-np.sqrt(1 - cosine**2), 0, -cosine], (count, 1))
    below = np.ones(count)  # the part of the surface that is below the walk
    weight = np.ones(count)
    sums = []
    for order in range(200):
        lam = smith(w, alpha)
        u = rng.random(len(w))
        out = (w[:, 2] > 0) & (u >= 1 - below ** np.where(w[:, 2] > 0, lam, 0))
        sums.append(weight[out].sum() / count)
        w, below, weight, lam, u = w[~out], below[~out], weight[~out], lam[~out], u[~out]
        if not len(w):
            break
        below = np.clip(below / (1 - u) ** (1 / lam), 1e-12, 1)
        m = visible(-w, alpha)
        c = np.clip(-(w * m).sum(1), 0, 1)
        weight = weight * fresnel(c, n, k)
        w = w + 2 * c[:, None] * m
        w /= np.linalg.norm(w, axis=1, keepdims=True)
    return sum(sums), sums[1]


if __name__ == "__main__":
    for n, k in ((0.2, 3.9), (1.5, 1.2), (0.0, 1e4)):
        for alpha in (0.3, 0.6, 1.0):
            print(n, k, "alpha", alpha, ["%.4f, first %.4f" % reflected(c, alpha, n, k) for c in (0.2, 0.5, 0.9)], flush=True)
